//! `prepare` of a flat map beside a cube map's, over the same casters.

use std::time::{Duration, Instant};

use shadows::glam::Vec3;
use shadows::{Caster, DirectionalLight, ShadowFrame, ShadowMap, ShadowMapDescriptor};

use crate::{World, median, ratio};
use host::gpu::Gpu;

const CASTERS: usize = 10_000;

struct Flat {
    map: ShadowMap,
    light: DirectionalLight,
}

impl Flat {
    /// Time of `prepare` alone; the frame is drawn after.
    fn prepare(&mut self, gpu: &Gpu, casters: &[Caster]) -> Duration {
        let frame = ShadowFrame::new(self.light, casters);
        let start = Instant::now();
        self.map
            .prepare(&gpu.device, &gpu.queue, &frame)
            .expect("the frame is in range");
        let time = start.elapsed();
        gpu.run(|encoder| self.map.encode(encoder));
        time
    }
}

pub fn prepare(gpu: &Gpu, rounds: u32) {
    let mut world = World::new(gpu, CASTERS, 15.0);
    let descriptor = ShadowMapDescriptor {
        size: 64,
        ..Default::default()
    };
    let mut flat = Flat {
        map: ShadowMap::new(&gpu.device, &descriptor).expect("the descriptor is in range"),
        light: DirectionalLight::new(Vec3::new(0.3, 1.0, 0.2)),
    };
    let [mut moving, mut still, mut cube] = [const { Vec::new() }; 3];
    world.prepare(gpu);
    flat.prepare(gpu, &world.casters);
    for _ in 0..rounds {
        for caster in &mut world.casters {
            caster.world_from_object.translation.y += 0.001;
        }
        world.prepare(gpu);
        moving.push(flat.prepare(gpu, &world.casters));
        still.push(flat.prepare(gpu, &world.casters));
        cube.push(world.prepare(gpu));
    }
    let micros = |times: &[Duration]| 1e6 * median(times);
    println!(
        "flat map, {CASTERS} casters: moving {:.1} us, still {:.1} us; cube map, still {:.1} us",
        micros(&moving),
        micros(&still),
        micros(&cube)
    );
    ratio("flat_prepare_still_vs_moving", &still, &moving);
    ratio("flat_vs_cube_prepare_still", &still, &cube);
}
