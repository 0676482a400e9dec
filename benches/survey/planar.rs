//! Planar shadows, hard and soft.

use std::time::{Duration, Instant};

use host::gpu::Gpu;
use host::renderer::view;
use host::scene::floor;
use shadows::glam::Vec3;
use shadows::{
    Caster, DirectionalLight, LightShape, PlanarFrame, PlanarLight, PlanarOutline, PlanarReceiver,
    PlanarRectangle, PlanarShadow, PlanarShadowDescriptor, PlanarSoftFrame, PlanarSoftShadow,
    PlanarSoftShadowDescriptor, View, wgpu,
};

use crate::sides::{HALF, kept_vs_moving, many_vs_few, rows};

const SIZE: [u32; 2] = [1280, 720];
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth24PlusStencil8;
/// Of the soft ones.
const SAMPLES: u32 = 4;

fn sun() -> DirectionalLight {
    DirectionalLight::new(Vec3::new(0.4, 1.0, 0.3))
}

fn new(gpu: &Gpu) -> PlanarShadow {
    let descriptor = PlanarShadowDescriptor {
        depth_stencil_format: FORMAT,
        ..Default::default()
    };
    PlanarShadow::new(&gpu.device, &descriptor).expect("the descriptor is in range")
}

fn new_soft(gpu: &Gpu, cache: bool) -> PlanarSoftShadow {
    let descriptor = PlanarSoftShadowDescriptor {
        samples: SAMPLES,
        cache,
        ..Default::default()
    };
    PlanarSoftShadow::new(&gpu.device, &descriptor).expect("the descriptor is in range")
}

fn camera() -> View {
    view(&floor(), SIZE).expect("the camera makes a view")
}

/// How long `prepare` takes.
fn prepare(gpu: &Gpu, planar: &mut PlanarShadow, casters: &[Caster]) -> Duration {
    let frame = PlanarFrame {
        lights: &[PlanarLight::new(sun())],
        planes: &[PlanarReceiver {
            point: Vec3::ZERO,
            normal: Vec3::Y,
            // Everywhere: what the pass clears the stencil to.
            outline: PlanarOutline::Stencil(1),
        }],
        views: &[camera()],
        casters,
    };
    let start = Instant::now();
    planar
        .prepare(&gpu.device, &gpu.queue, &frame)
        .expect("the frame is in range");
    start.elapsed()
}

fn prepare_soft(gpu: &Gpu, soft: &mut PlanarSoftShadow, casters: &[Caster]) -> Duration {
    let frame = PlanarSoftFrame {
        light: sun().into(),
        shape: LightShape::Sphere { radius: 0.05 },
        receiver: PlanarRectangle {
            corner: Vec3::new(-HALF, 0.0, -HALF),
            width: Vec3::Z * 2.0 * HALF,
            height: Vec3::X * 2.0 * HALF,
        },
        casters,
    };
    let start = Instant::now();
    soft.prepare(&gpu.device, &gpu.queue, &frame)
        .expect("the frame is in range");
    start.elapsed()
}

pub fn draws(gpu: &Gpu, rounds: u32) {
    let target = gpu.target(SIZE, FORMAT, 1);
    let target = target.create_view(&Default::default());
    let of = |count| {
        let mut planar = new(gpu);
        prepare(gpu, &mut planar, &rows(gpu, count));
        gpu.run(|encoder| planar.encode(encoder));
        assert_eq!(planar.statistics().casters_drawn, count as u32);
        planar
    };
    many_vs_few("planar_draws_10000_vs_1000", rounds, of, |planar| {
        gpu.run(|encoder| {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &target,
                    depth_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(0.0),
                        store: wgpu::StoreOp::Discard,
                    }),
                    stencil_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(1),
                        store: wgpu::StoreOp::Store,
                    }),
                }),
                ..Default::default()
            });
            planar.render(&mut pass, 0, 0, 0).expect("it is encoded");
        });
    });
}

pub fn soft_draws(gpu: &Gpu, rounds: u32) {
    let of = |count| (new_soft(gpu, false), rows(gpu, count));
    many_vs_few(
        "planar_soft_10000_vs_1000",
        rounds,
        of,
        |(soft, casters)| {
            prepare_soft(gpu, soft, casters);
            gpu.run(|encoder| soft.encode(encoder));
        },
    );
}

pub fn prepares(gpu: &Gpu, rounds: u32) {
    let [mut kept, mut moved] = [new(gpu), new(gpu)];
    let sides = [&mut kept, &mut moved];
    kept_vs_moving(
        "planar_prepare_kept_vs_moving",
        gpu,
        rounds,
        sides,
        |planar, casters| {
            let time = prepare(gpu, planar, casters);
            gpu.run(|encoder| planar.encode(encoder));
            time
        },
    );
    assert_eq!(kept.statistics().uploaded, 0);
    let [mut kept, mut moved] = [new_soft(gpu, true), new_soft(gpu, true)];
    let sides = [&mut kept, &mut moved];
    kept_vs_moving(
        "planar_soft_prepare_kept_vs_moving",
        gpu,
        rounds,
        sides,
        |soft, casters| {
            let time = prepare_soft(gpu, soft, casters);
            gpu.run(|encoder| soft.encode(encoder));
            time
        },
    );
    assert!(!kept.statistics().rendered && moved.statistics().rendered);
}
