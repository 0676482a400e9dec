//! Three ways to find the casters that lights reach, by bounding spheres: the map's own tree, one by
//! one, and by a compute shader as indirect draws would have them.

#[allow(dead_code)] // no caster goes here
#[path = "../../src/scene/caster_tree.rs"]
mod caster_tree;
#[path = "compute_culling.rs"]
mod compute;

use std::time::{Duration, Instant};

use caster_tree::CasterSpheres;
use shadows::glam::{DVec3, DVec4, Vec4Swizzles as _};

use crate::{median, ratio};
use host::gpu::Gpu;

/// How far each light reaches; some 700 casters in a flat world of one a square metre.
const RANGE: f64 = 15.0;

/// Rounds in which the tree finds out that it pays.
const FIRST: usize = 12;

/// Each round a hundredth of the casters and all 16 lights move.
pub fn culling(gpu: &Gpu, name: &str, count: usize, rounds: usize) {
    let side = (count as f64).sqrt().ceil();
    let mut spheres: Vec<DVec4> = (0..count)
        .map(|i| DVec4::new(i as f64 % side, 0.0, (i as f64 / side).floor(), 0.35))
        .collect();
    let mut casters = CasterSpheres::default();
    spheres.iter().for_each(|sphere| casters.push(*sphere));
    let compute = gpu
        .support
        .compute
        .then(|| compute::Culling::new(gpu, count));
    let (mut found, mut all) = (Vec::new(), Vec::new());
    let [mut tree, mut linear, mut shader] = [const { Vec::new() }; 3];
    for round in 0..rounds + FIRST {
        let lights = [0.5, 1.5, 2.5, 3.5].map(|k| (k + 0.01 * round as f64) / 4.0 * side);
        let lights = lights.map(|x| lights.map(|z| DVec3::new(x, 2.0, z)));
        let lights = lights.as_flattened();
        let movers = (0..count.div_ceil(100)).map(|k| (k * 7919 + round) % count);
        let place = |sphere: &DVec4| *sphere + DVec4::new(0.3, 0.0, 0.2, 0.0);
        let moved: Vec<_> = movers.map(|i| (i, place(&spheres[i]))).collect();

        let by_tree = timed(|| {
            found.clear();
            moved.iter().for_each(|&(i, to)| casters.set(i, to));
            for light in lights {
                casters.within(*light, RANGE, &mut found);
            }
        });
        let by_one = timed(|| {
            moved.iter().for_each(|&(i, to)| spheres[i] = to);
            one_by_one(&spheres, lights, &mut all);
        });
        if round >= FIRST {
            tree.push(by_tree);
            linear.push(by_one);
            shader.extend(
                compute
                    .as_ref()
                    .map(|compute| compute.time(gpu, &spheres, lights)),
            );
        }
        found.sort_unstable();
        all.sort_unstable();
        assert_eq!(found, all, "the tree lost some");
    }
    ratio(&format!("culling_{name}_vs_linear"), &tree, &linear);
    if !shader.is_empty() {
        let found = compute.map_or(0, |compute| compute.found(gpu));
        println!(
            "the shader found {found} casters in {:.3} ms",
            1e3 * median(&shader)
        );
        ratio(&format!("culling_{name}_vs_compute"), &tree, &shader);
    }
}

fn timed(work: impl FnOnce()) -> Duration {
    let start = Instant::now();
    work();
    start.elapsed()
}

fn one_by_one(spheres: &[DVec4], lights: &[DVec3], all: &mut Vec<u32>) {
    all.clear();
    for light in lights {
        let near = (0..).zip(spheres).filter(|(_, sphere)| {
            let reach = RANGE + sphere.w;
            sphere.xyz().distance_squared(*light) <= reach * reach
        });
        all.extend(near.map(|(i, _): (u32, _)| i));
    }
}
