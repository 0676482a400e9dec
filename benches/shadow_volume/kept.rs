//! What a frame costs the CPU in which little or nothing changed.
//!
//! Ten thousand boxes of one mesh under one lamp, all in view, `prepare` alone:
//! - `ratio kept_vs_moving_prepare`: nothing changed, over all boxes moving.
//! - `ratio kept_prepare_vs_maps`: the same over a cube map's `prepare`, nothing having changed.
//! - `ratio camera_vs_moving_prepare`: the camera moved, and nothing else.
//! - `ratio one_vs_moving_prepare`: one box moved.
//! - `ratio prepare_16_lights_vs_1`: sixteen lamps over one, two thousand boxes, nothing changed.

use std::hint::black_box;
use std::time::Instant;

use host::gpu::Gpu;
use host::shapes;
use shadows::glam::camera::rh::{proj::directx as proj, view};
use shadows::glam::{Affine3A, Vec3};
use shadows::mesh::Adjacency;
use shadows::{
    Caster, CasterMesh, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DepthConvention,
    PointLight, ShadowVolumeDescriptor, ShadowVolumeFrame, ShadowVolumeRenderer, View, VolumeLight,
};

use crate::shared::{median, paired};

const COUNT: usize = 10_000;
/// Prepared so often in a row, as one takes less than a clock tells well.
const REPEATS: u32 = 20;

struct Crowd<'a> {
    gpu: &'a Gpu,
    renderer: ShadowVolumeRenderer,
    casters: Vec<Caster>,
    lights: Vec<VolumeLight>,
    views: [View; 2],
}

impl<'a> Crowd<'a> {
    fn new(gpu: &'a Gpu, mesh: &CasterMesh, count: usize, lights: usize) -> Self {
        let camera = |x| {
            let camera = view::look_at_mat4(Vec3::new(x, 9.0, 12.0), Vec3::ZERO, Vec3::Y);
            let projection = proj::perspective_infinite_reverse(0.8, 1.5, 0.1);
            View::new(projection * camera, DepthConvention::InfiniteReverse).expect("a view")
        };
        let place = |n: usize| {
            let at = Vec3::new(
                (n % 100) as f32 * 0.06 - 3.0,
                1.0,
                (n / 100) as f32 * 0.06 - 3.0,
            );
            Affine3A::from_translation(at) * Affine3A::from_scale(Vec3::splat(0.02))
        };
        let casters = (0..count).map(|n| Caster::new(mesh.clone(), place(n)));
        Self {
            gpu,
            renderer: ShadowVolumeRenderer::new(
                &gpu.device,
                &ShadowVolumeDescriptor {
                    depth_stencil_format: shadows::wgpu::TextureFormat::Depth24PlusStencil8,
                    ..Default::default()
                },
            )
            .expect("a device"),
            casters: casters.collect(),
            lights: (0..lights).map(|n| lamp(n).into()).collect(),
            views: [camera(0.0), camera(0.1)],
        }
    }

    /// Microseconds of `prepare` in the view of this number.
    fn prepare(&mut self, view: usize) -> f64 {
        let frame = ShadowVolumeFrame {
            lights: &self.lights,
            views: &[self.views[view].into()],
            casters: &self.casters,
            ..Default::default()
        };
        let start = Instant::now();
        self.renderer
            .prepare(&self.gpu.device, &self.gpu.queue, &frame)
            .expect("a frame");
        start.elapsed().as_secs_f64() * 1e6
    }

    fn encode(&mut self) {
        self.gpu.run(|encoder| self.renderer.encode(encoder));
    }

    /// The same where nothing changed.
    fn kept(&mut self) -> f64 {
        let mut all = 0.0;
        for _ in 0..REPEATS {
            all += self.prepare(0);
            let statistics = self.renderer.statistics();
            assert_eq!(
                [statistics.casters_extracted, statistics.uploaded as u32],
                [0; 2]
            );
            self.renderer
                .encode(&mut self.gpu.device.create_command_encoder(&Default::default()));
        }
        all / f64::from(REPEATS)
    }
}

fn lamp(n: usize) -> PointLight {
    let turn = n as f32;
    PointLight::new(Vec3::new(2.0 * turn.sin(), 6.0, 2.5 * turn.cos()), 30.0)
}

/// Microseconds that a cube map takes, nothing having changed.
fn maps(gpu: &Gpu, map: &mut CubeShadowMap, casters: &[Caster]) -> f64 {
    let frame = CubeFrame::new(lamp(0), casters);
    // What moved is taken over first.
    map.prepare(&gpu.device, &gpu.queue, &frame)
        .expect("a frame");
    gpu.run(|encoder| map.encode(encoder));
    let start = Instant::now();
    for _ in 0..REPEATS {
        black_box(map.prepare(&gpu.device, &gpu.queue, &frame)).expect("a frame");
        map.encode(&mut gpu.device.create_command_encoder(&Default::default()));
    }
    start.elapsed().as_secs_f64() * 1e6 / f64::from(REPEATS)
}

/// Measures and prints.
pub fn run(gpu: &Gpu, rounds: usize) {
    let shape = shapes::cube();
    let adjacency = Adjacency::new(&shape.positions, &shape.indices).expect("a box");
    let mesh = CasterMesh::new(&gpu.device, &shape.positions, &adjacency).expect("a mesh");
    let mut crowd = Crowd::new(gpu, &mesh, COUNT, 1);
    let mut few = [16, 1].map(|lights| Crowd::new(gpu, &mesh, 2000, lights));
    let descriptor = CubeShadowMapDescriptor {
        size: 64,
        ..Default::default()
    };
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor).expect("a map");
    let [mut moving, mut kept, mut camera, mut one, mut of_maps] = [const { Vec::new() }; 5];
    let mut of_lights = [const { Vec::new() }; 2];
    for round in 0..=rounds {
        for caster in &mut crowd.casters {
            caster.world_from_object.translation.y += 1e-3;
        }
        let moved = crowd.prepare(0);
        assert_eq!(crowd.renderer.statistics().casters_drawn as usize, COUNT);
        crowd.encode();
        let still = crowd.kept();
        crowd.casters[COUNT / 2].world_from_object.translation.y += 1e-3;
        let alone = crowd.prepare(0);
        crowd.encode();
        let seen = crowd.prepare(1);
        crowd.encode();
        crowd.prepare(0);
        crowd.encode();
        let map = maps(gpu, &mut map, &crowd.casters);
        let lights = [0, 1].map(|i| {
            few[i].prepare(0);
            few[i].encode();
            few[i].kept()
        });
        // The first round allocates.
        if round > 0 {
            moving.push(moved);
            kept.push(still);
            one.push(alone);
            camera.push(seen);
            of_maps.push(map);
            of_lights[0].push(lights[0]);
            of_lights[1].push(lights[1]);
        }
    }
    let microseconds = |times: &[f64]| median(times.iter().copied());
    println!(
        "prepare of {COUNT}: all move {:.0} us, nothing {:.0} us, one {:.0} us, the camera {:.0} us; \
         a cube map, nothing: {:.0} us",
        microseconds(&moving),
        microseconds(&kept),
        microseconds(&one),
        microseconds(&camera),
        microseconds(&of_maps)
    );
    println!("ratio kept_vs_moving_prepare {:.4}", paired(&kept, &moving));
    println!("ratio kept_prepare_vs_maps {:.3}", paired(&kept, &of_maps));
    println!("ratio one_vs_moving_prepare {:.4}", paired(&one, &moving));
    println!(
        "ratio camera_vs_moving_prepare {:.3}",
        paired(&camera, &moving)
    );
    let [sixteen, single] = &of_lights;
    println!(
        "ratio prepare_16_lights_vs_1 {:.3}",
        paired(sixteen, single)
    );
}
