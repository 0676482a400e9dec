//! Two sides that are timed in turns, and the casters they have.

use std::time::{Duration, Instant};

use host::gpu::Gpu;
use shadows::Caster;
use shadows::glam::{Affine3A, Vec3};

use crate::ratio;
use crate::shapes::cuboid;

/// Half the side of the square that casters stand on.
pub const HALF: f32 = 8.0;

/// Places for so many in rows on a square, and half the side of each, by which they leave half of the square: the
/// fewer, the larger.
pub fn places(count: usize) -> (impl Iterator<Item = Vec3>, f32) {
    let row = (count as f32).sqrt();
    let step = 2.0 * HALF / row;
    let at = move |i: usize| {
        let [x, z] = [i as f32 % row, i as f32 / row].map(|at| (at.floor() + 0.5) * step - HALF);
        Vec3::new(x, 0.4 * step, z)
    };
    ((0..count).map(at), 0.35 * step)
}

/// So many boxes of one mesh at these places.
pub fn rows(gpu: &Gpu, count: usize) -> Vec<Caster> {
    let (places, half) = places(count);
    let mesh = cuboid(Vec3::splat(half)).mesh(&gpu.device);
    places
        .map(|place| Caster::new(mesh.clone(), Affine3A::from_translation(place)))
        .collect()
}

/// What 10,000 casters take over what 1,000 do. `draw` does the same for both, and is timed.
pub fn many_vs_few<T>(
    name: &str,
    rounds: u32,
    mut of: impl FnMut(usize) -> T,
    mut draw: impl FnMut(&mut T),
) {
    let mut sides = [10_000, 1000].map(|count| (of(count), Vec::new()));
    // The first round makes pipelines.
    for round in 0..=rounds {
        for (side, times) in &mut sides {
            let start = Instant::now();
            draw(side);
            if round > 0 {
                times.push(start.elapsed());
            }
        }
    }
    let [(_, many), (_, few)] = &sides;
    ratio(name, many, few);
}

/// What `prepare` of 10,000 casters takes, none moving over all moving. `step` has one prepared and encoded, and
/// tells how long the first of that took.
pub fn kept_vs_moving<T>(
    name: &str,
    gpu: &Gpu,
    rounds: u32,
    [kept, moved]: [&mut T; 2],
    step: impl Fn(&mut T, &[Caster]) -> Duration,
) {
    let casters = rows(gpu, 10_000);
    let mut moving = casters.clone();
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for round in 0..=rounds {
        for caster in &mut moving {
            caster.world_from_object.translation.y += 0.001;
        }
        let times = [step(kept, &casters), step(moved, &moving)];
        if round > 0 {
            ours.push(times[0]);
            theirs.push(times[1]);
        }
    }
    ratio(name, &ours, &theirs);
}
