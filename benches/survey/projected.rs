//! Projected shadows.

use std::time::{Duration, Instant};

use host::gpu::Gpu;
use shadows::glam::Vec3;
use shadows::{
    Caster, DirectionalLight, ProjectedCaster, ProjectedFrame, ProjectedShadow,
    ProjectedShadowDescriptor, Projector,
};

use crate::sides::{kept_vs_moving, many_vs_few, rows};

fn new(gpu: &Gpu, cache: bool) -> ProjectedShadow {
    let descriptor = ProjectedShadowDescriptor {
        cache,
        ..Default::default()
    };
    ProjectedShadow::new(&gpu.device, &descriptor).expect("the descriptor is in range")
}

fn opaque(casters: &[Caster]) -> Vec<ProjectedCaster> {
    let casters = casters.iter().cloned();
    casters.map(ProjectedCaster::opaque).collect()
}

/// How long `prepare` of one tile with all casters takes.
fn prepare(gpu: &Gpu, shadow: &mut ProjectedShadow, casters: &[ProjectedCaster]) -> Duration {
    let sun = DirectionalLight::new(Vec3::new(0.4, 1.0, 0.3));
    let projectors = [Projector::new(sun, casters).with_size(1024)];
    let frame = ProjectedFrame {
        projectors: &projectors,
    };
    let start = Instant::now();
    shadow
        .prepare(&gpu.device, &gpu.queue, &frame)
        .expect("the frame is in range");
    start.elapsed()
}

pub fn draws(gpu: &Gpu, rounds: u32) {
    let of = |count| (new(gpu, false), opaque(&rows(gpu, count)));
    many_vs_few(
        "projected_10000_vs_1000",
        rounds,
        of,
        |(shadow, casters)| {
            prepare(gpu, shadow, casters);
            gpu.run(|encoder| shadow.encode(encoder));
        },
    );
}

pub fn prepares(gpu: &Gpu, rounds: u32) {
    let [mut kept, mut moved] = [new(gpu, true), new(gpu, true)];
    let sides = [&mut kept, &mut moved];
    kept_vs_moving(
        "projected_prepare_kept_vs_moving",
        gpu,
        rounds,
        sides,
        |shadow, casters| {
            let time = prepare(gpu, shadow, &opaque(casters));
            gpu.run(|encoder| shadow.encode(encoder));
            time
        },
    );
    assert_eq!(kept.statistics().shadows_kept, 1);
}
