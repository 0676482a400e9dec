//! What kernels cost, on `courtyard`, in one run.
//!
//! - `four_taps_vs_3x3_loop`: 16 texels by four gathers against a loop over nine single texels, each
//!   compared with its own plane depth in both.
//! - `disk_early_out_vs_full`: the random disk (8 x 8 taps) with its early-out against all taps, and
//!   what that does to the picture.
//! - `vogel_N_vs_M_per_tap`: cost of a tap among N against one among M: 1 where cost is linear.
//!
//! Times are those of the lit pass less those of the same pass without shadows, medians of rounds in
//! which all take turns, so that a machine that slows down slows all. `--quick` takes fewer rounds,
//! and only the kernels of the ratios.

#[path = "../examples/host/mod.rs"]
mod host;

use std::time::Duration;

use host::gpu::Gpu;
use host::pipelines::{LitPipeline, ShadowAccess, visibility_module};
use host::renderer::Renderer;
use host::scene::courtyard;
use host::scene_gpu::SceneGpu;
use shadows::{
    CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, Kernel, PcfDescriptor, PcfSampler,
    PointLight, Radius, RandomDisk, VogelDisk, wgpu,
};

const SIZE: [u32; 2] = [640, 360];

/// Nine single texels around the receiver's own.
const LOOP: &str = "
fn host_visibility(world: vec3f, pixel: vec2f) -> f32 {
    let normal = cross(dpdx(world), dpdy(world));
    let receiver = shadows_cube_receiver(shadows_light, world, normal);
    if receiver.known >= 0.0 {
        return receiver.known;
    }
    let middle = floor(receiver.texel);
    var lit = 0.0;
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let texel = middle + vec2f(f32(x), f32(y));
            lit += shadows_cube_texel(
                shadows_map, shadows_map_sampler, receiver, shadows_light.size, texel,
            );
        }
    }
    return lit / 9.0;
}
";

/// The courtyard with its map drawn.
struct Yard {
    gpu: Gpu,
    renderer: Renderer,
    scene: SceneGpu,
    map: CubeShadowMap,
}

/// One way to shade it.
struct Way {
    lit: LitPipeline,
    group: wgpu::BindGroup,
    times: Vec<Duration>,
}

impl Yard {
    fn new(gpu: Gpu) -> anyhow::Result<Self> {
        let scene = courtyard();
        let scene_gpu = SceneGpu::new(&gpu, &scene)?;
        let renderer = Renderer::new(&gpu, SIZE, &scene, &scene_gpu)?;
        let mut map = CubeShadowMap::new(&gpu.device, &CubeShadowMapDescriptor::default())?;
        let light = PointLight::new(scene.light.truncate(), scene.shadow_near, scene.range);
        let frame = CubeFrame {
            lights: &[light],
            casters: &scene_gpu.casters,
            ..Default::default()
        };
        map.prepare(&gpu.device, &gpu.queue, &frame)?;
        gpu.run(|encoder| {
            map.encode(encoder);
            renderer.draw_ambient(encoder, &scene_gpu);
        });
        Ok(Self {
            gpu,
            renderer,
            scene: scene_gpu,
            map,
        })
    }

    fn way(&self, kernel: Kernel, wgsl: impl Fn(&PcfSampler) -> String) -> anyhow::Result<Way> {
        let descriptor = PcfDescriptor {
            kernel,
            ..Default::default()
        };
        let sampler = PcfSampler::new(&self.gpu.device, &self.gpu.queue, &descriptor)?;
        let lit = self.renderer.lit_pipeline(
            &self.gpu,
            &ShadowAccess {
                module: Some(&wgsl(&sampler)),
                layout: Some(sampler.bind_group_layout()),
                stencil: None,
            },
        );
        let group = sampler.bind_group(&self.gpu.device, &self.map)?;
        Ok(Way {
            lit,
            group,
            times: Vec::new(),
        })
    }

    fn shade(&self, lit: &LitPipeline, group: Option<&wgpu::BindGroup>) -> Duration {
        self.gpu
            .run(|encoder| self.renderer.draw_lit(encoder, &self.scene, lit, group))
    }

    fn picture(&self, way: &Way) -> Vec<u8> {
        self.shade(&way.lit, Some(&way.group));
        self.renderer.read_visibility(&self.gpu)
    }
}

fn median(times: &mut [Duration]) -> f64 {
    times.sort_unstable();
    times[times.len() / 2].as_secs_f64() * 1e3
}

fn disk(early_out: bool) -> Kernel {
    Kernel::RandomDisk(RandomDisk {
        around: 8,
        rings: 8,
        early_out,
        ..Default::default()
    })
}

fn vogel(taps: u32) -> Kernel {
    Kernel::Vogel(VogelDisk {
        radius: Radius::Texels(3.0),
        taps,
    })
}

/// How often and how much the early-out changes the picture, in visibility.
fn early_out_error(early: &[u8], full: &[u8]) {
    let differences = || {
        early
            .iter()
            .zip(full)
            .map(|(early, full)| f64::from(early.abs_diff(*full)) / 255.0)
    };
    let wrong = differences().filter(|&difference| difference > 0.0).count();
    let squares: f64 = differences()
        .map(|difference| difference * difference)
        .sum();
    println!(
        "disk early-out: differs at {:.3} % of pixels, by at most {:.3}, root mean square {:.5}",
        100.0 * wrong as f64 / full.len() as f64,
        differences().fold(0.0, f64::max),
        (squares / full.len() as f64).sqrt(),
    );
}

fn main() -> anyhow::Result<()> {
    let quick = std::env::args().any(|arg| arg == "--quick");
    let gpu = match Gpu::new(None) {
        Ok(gpu) => gpu,
        Err(error) => {
            eprintln!("skipped: {error:#}");
            return Ok(());
        }
    };
    println!("adapter {}", host::gpu::describe(&gpu.info));
    let yard = Yard::new(gpu)?;
    let mut names: Vec<String> = ["four taps", "3x3 loop", "disk early-out", "disk full"]
        .map(str::to_owned)
        .to_vec();
    let mut ways = vec![
        yard.way(Kernel::FourTaps, visibility_module)?,
        yard.way(Kernel::Hard, |sampler| sampler.wgsl_module(1) + LOOP)?,
        yard.way(disk(true), visibility_module)?,
        yard.way(disk(false), visibility_module)?,
    ];
    for kernel in Kernel::ALL.into_iter().filter(|_| !quick) {
        names.push(format!("{kernel:?}"));
        ways.push(yard.way(kernel, visibility_module)?);
    }
    const TAPS: [u32; 5] = [4, 8, 16, 32, 64];
    let first_vogel = ways.len();
    for taps in TAPS {
        names.push(format!("vogel {taps}"));
        ways.push(yard.way(vogel(taps), visibility_module)?);
    }
    let mut unshadowed = Vec::new();
    let rounds = if quick { 3 } else { 15 };
    for round in 0..=rounds {
        let bare = yard.shade(yard.renderer.unshadowed(), None);
        let times: Vec<Duration> = ways
            .iter()
            .map(|way| yard.shade(&way.lit, Some(&way.group)))
            .collect();
        if round > 0 {
            // The first round compiles.
            unshadowed.push(bare);
            for (way, time) in ways.iter_mut().zip(times) {
                way.times.push(time);
            }
        }
    }
    let bare = median(&mut unshadowed);
    println!("{bare:8.3} ms without shadows; the others less that:");
    let cost: Vec<f64> = ways
        .iter_mut()
        .map(|way| median(&mut way.times) - bare)
        .collect();
    for (name, cost) in names.iter().zip(&cost) {
        println!("{cost:8.3} ms {name}");
    }
    early_out_error(&yard.picture(&ways[2]), &yard.picture(&ways[3]));
    println!("ratio four_taps_vs_3x3_loop {:.3}", cost[0] / cost[1]);
    println!("ratio disk_early_out_vs_full {:.3}", cost[2] / cost[3]);
    for (pair, taps) in TAPS.windows(2).enumerate() {
        let at = first_vogel + pair;
        let per_tap = cost[at + 1] / cost[at] * f64::from(taps[0]) / f64::from(taps[1]);
        println!(
            "ratio vogel_{}_vs_{}_per_tap {per_tap:.3}",
            taps[1], taps[0]
        );
    }
    Ok(())
}
