//! What kernels cost, on `courtyard`, in one run.
//!
//! - `four_taps_vs_3x3_loop`: 16 texels by four gathers against a loop over nine single texels, each
//!   compared with its own plane depth in both.
//!   What is not counted twice: both read the same texels into the cache, the loop's nine and the
//!   taps' sixteen, and where that is slow (many pictures at once) the ratio is nearer to 1.
//! - `disk_early_out_vs_full`: the random disk (8 x 8 taps) with its early-out against all taps, and
//!   what that does to the picture.
//! - `vogel_N_vs_M_per_tap` and `disk_N_vs_M_per_tap`: cost of a tap among N against one among M: 1
//!   or less where cost grows no faster than taps do.
//!
//! Positions and normals of all pixels are kept in a buffer; what is timed is one full-screen pass
//! that reads them and asks for the visibility, less the same pass that asks nothing: the kernel and
//! nothing else. Both sides of a ratio, and the bare pass, take turns; a ratio is the median of those
//! of the rounds, so that a machine that slows down slows all. Passes are timed between two
//! timestamps on a real GPU that has them, and elsewhere until the device is done; which, is printed.
//! `--quick` takes fewer rounds, and only the kernels of the ratios.

#[path = "shared/mod.rs"]
mod shared;

use host::gpu::Gpu;
use host::pipelines::{LitPipeline, ShadowAccess, visibility_module};
use host::renderer::Renderer;
use host::scene::courtyard;
use host::scene_gpu::SceneGpu;
use host::timer::Timer;
use shadows::{
    CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, Kernel, PcfDescriptor, PcfSampler,
    PointLight, Radius, RandomDisk, VogelDisk, wgpu,
};
use shared::median;

const SIZE: [u32; 2] = [1280, 720];

/// Nine single texels around the receiver's own.
const LOOP: &str = "
fn host_ask(world: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let given = shadows_cube_given(shadows_light, world, normal);
    let receiver = shadows_cube_receiver(shadows_light, world, given);
    if !receiver.asks {
        return select(0.0, 1.0, receiver.lit);
    }
    let middle = shadows_cube_floor(receiver, receiver.texel);
    var lit = 0.0;
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let texel = middle + vec2f(f32(x), f32(y));
            lit += shadows_cube_texel(
                shadows_map, shadows_map_sampler, receiver, texel,
            );
        }
    }
    return lit / 9.0;
}
";

/// The courtyard with its map drawn.
struct Yard {
    gpu: Gpu,
    timer: Timer,
    renderer: Renderer,
    scene: SceneGpu,
    map: CubeShadowMap,
    points_layout: wgpu::BindGroupLayout,
    points: wgpu::BindGroup,
    target: wgpu::TextureView,
}

/// One way to shade it.
struct Way {
    name: String,
    pipeline: wgpu::RenderPipeline,
    group: Option<wgpu::BindGroup>,
    lit: Option<LitPipeline>,
    times: Vec<f64>,
}

/// Puts every pixel's position and normal into a buffer, in the place of a shadow test.
const STORE: &str = "
@group(1) @binding(0) var<storage, read_write> host_points: array<vec4f>;
fn host_visibility(receiver: HostReceiver) -> f32 {
    let at = 2u * (u32(receiver.pixel.y) * 1280u + u32(receiver.pixel.x));
    host_points[at] = vec4f(receiver.world, 1.0);
    host_points[at + 1u] = vec4f(receiver.flat_normal, 0.0);
    return 1.0;
}
";

/// Asks for the visibility of every pixel's point.
const ASK: &str = "
@group(0) @binding(0) var<storage, read> host_points: array<vec4f>;
@vertex
fn screen(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32(i & 1u), f32(i >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment
fn ask(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let at = 2u * (u32(pixel.y) * 1280u + u32(pixel.x));
    return vec4f(host_ask(host_points[at].xyz, host_points[at + 1u].xyz, pixel.xy));
}
";

const BARE: &str = "
fn host_ask(world: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    return world.x + normal.x;
}
";

/// The host's functions around a sampler's own.
fn asking(sampler: &PcfSampler) -> String {
    let pixel = if sampler.takes_pixel() { ", pixel" } else { "" };
    format!(
        "{}
fn host_ask(world: vec3f, normal: vec3f, pixel: vec2f) -> f32 {{
    return shadows_visibility_flat(world, normal{pixel});
}}
",
        sampler.wgsl_module(1)
    )
}

impl Yard {
    fn new(gpu: Gpu) -> anyhow::Result<Self> {
        let scene = courtyard();
        let scene_gpu = SceneGpu::new(&gpu, &scene)?;
        let renderer = Renderer::new(&gpu, SIZE, &scene, &scene_gpu)?;
        let mut map = CubeShadowMap::new(&gpu.device, &CubeShadowMapDescriptor::default())?;
        let light = PointLight::new(scene.light().place.truncate(), scene.light().range);
        let frame = CubeFrame::new(light, &scene_gpu.casters);
        map.prepare(&gpu.device, &gpu.queue, &frame)?;
        gpu.run(|encoder| {
            map.encode(encoder);
            renderer.draw_ambient(encoder, &scene_gpu);
        });
        let (points_layout, points) = keep_points(&gpu, &renderer, &scene_gpu);
        let target = gpu.target(SIZE, wgpu::TextureFormat::R8Unorm, 1);
        Ok(Self {
            target: target.create_view(&Default::default()),
            timer: Timer::new(&gpu),
            gpu,
            renderer,
            scene: scene_gpu,
            map,
            points_layout,
            points,
        })
    }

    fn way(
        &self,
        name: &str,
        kernel: Kernel,
        wgsl: impl Fn(&PcfSampler) -> String,
    ) -> anyhow::Result<Way> {
        let descriptor = PcfDescriptor {
            kernel,
            ..Default::default()
        };
        let sampler = PcfSampler::new(&self.gpu.device, &self.gpu.queue, &descriptor)?;
        let lit = self.renderer.lit_pipeline(
            &self.gpu,
            &ShadowAccess {
                module: Some(&visibility_module(&sampler)),
                layout: Some(sampler.bind_group_layout()),
                ..Default::default()
            },
        );
        Ok(Way {
            name: name.to_owned(),
            pipeline: self.pipeline(&wgsl(&sampler), Some(sampler.bind_group_layout())),
            group: Some(sampler.bind_group(&self.gpu.device, &self.map)?),
            lit: Some(lit),
            times: Vec::new(),
        })
    }

    fn bare(&self) -> Way {
        Way {
            name: "bare".to_owned(),
            pipeline: self.pipeline(BARE, None),
            group: None,
            lit: None,
            times: Vec::new(),
        }
    }

    fn pipeline(&self, wgsl: &str, layout: Option<&wgpu::BindGroupLayout>) -> wgpu::RenderPipeline {
        let device = &self.gpu.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("ask"),
            source: wgpu::ShaderSource::Wgsl((wgsl.to_owned() + ASK).into()),
        });
        let mut layouts = vec![Some(&self.points_layout)];
        layouts.extend(layout.map(Some));
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("ask"),
            layout: Some(
                &device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: Some("ask"),
                    bind_group_layouts: &layouts,
                    immediate_size: 0,
                }),
            ),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("screen"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("ask"),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::TextureFormat::R8Unorm.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    /// Milliseconds of one pass.
    fn time(&self, way: &Way) -> f64 {
        self.timer.time(&self.gpu, |encoder| {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("ask"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &self.target,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            pass.set_pipeline(&way.pipeline);
            pass.set_bind_group(0, &self.points, &[]);
            if let Some(group) = &way.group {
                pass.set_bind_group(1, group, &[]);
            }
            pass.draw(0..3, 0..1);
        })
    }

    fn picture(&self, way: &Way) -> Vec<u8> {
        if let Some(lit) = &way.lit {
            self.gpu.run(|encoder| {
                self.renderer
                    .draw_lit(encoder, &self.scene, lit, way.group.as_ref());
            });
        }
        self.renderer.read_visibility(&self.gpu)
    }
}

/// Draws the scene once, into a buffer of positions and normals.
fn keep_points(
    gpu: &Gpu,
    renderer: &Renderer,
    scene: &SceneGpu,
) -> (wgpu::BindGroupLayout, wgpu::BindGroup) {
    let points = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("points"),
        size: u64::from(SIZE[0] * SIZE[1] * 32),
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    let [write, read] = [false, true].map(|read_only| {
        let layout = gpu
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("points"),
                entries: &[wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Storage { read_only },
                        has_dynamic_offset: false,
                        min_binding_size: None,
                    },
                    count: None,
                }],
            });
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("points"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: points.as_entire_binding(),
            }],
        });
        (layout, group)
    });
    let store = renderer.lit_pipeline(
        gpu,
        &ShadowAccess {
            module: Some(STORE),
            layout: Some(&write.0),
            ..Default::default()
        },
    );
    gpu.run(|encoder| renderer.draw_lit(encoder, scene, &store, Some(&write.1)));
    read
}

fn disk(rings: u32, early_out: bool) -> Kernel {
    Kernel::RandomDisk(RandomDisk {
        around: 8,
        rings,
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
    let quick = shared::quick();
    let gpu = match Gpu::new(None) {
        Ok(gpu) => gpu,
        Err(error) => {
            eprintln!("skipped: {error:#}");
            return Ok(());
        }
    };
    let yard = Yard::new(gpu)?;
    println!(
        "adapter {}, clock {}",
        host::gpu::describe(&yard.gpu.info),
        yard.timer.clock().name()
    );
    let mut ways = vec![
        yard.bare(),
        yard.way("four taps", Kernel::FourTaps, asking)?,
        yard.way("3x3 loop", Kernel::Bilinear, |sampler| {
            sampler.wgsl_module(1) + LOOP
        })?,
    ];
    let mut ratios = vec![("four_taps_vs_3x3_loop".to_owned(), 1, 2, 1.0)];
    for rings in [1, 2, 4, 8] {
        ways.push(yard.way(
            &format!("disk {} full", 8 * rings),
            disk(rings, false),
            asking,
        )?);
        if rings > 1 {
            let name = format!("disk_{}_vs_{}_per_tap", 8 * rings, 4 * rings);
            ratios.push((name, ways.len() - 1, ways.len() - 2, 0.5));
        }
    }
    let full = ways.len() - 1;
    ways.push(yard.way("disk 64 early-out", disk(8, true), asking)?);
    let early = ways.len() - 1;
    ratios.insert(1, ("disk_early_out_vs_full".to_owned(), early, full, 1.0));
    for taps in [4, 8, 16, 32, 64] {
        ways.push(yard.way(&format!("vogel {taps}"), vogel(taps), asking)?);
        if taps > 4 {
            let name = format!("vogel_{taps}_vs_{}_per_tap", taps / 2);
            ratios.push((name, ways.len() - 1, ways.len() - 2, 0.5));
        }
    }
    for kernel in Kernel::ALL.into_iter().filter(|_| !quick) {
        ways.push(yard.way(&format!("{kernel:?}"), kernel, asking)?);
    }
    let rounds = if quick { 7 } else { 31 };
    for round in 0..=rounds {
        for way in &mut ways {
            let time = yard.time(way);
            if round > 0 {
                // The first round compiles.
                way.times.push(time);
            }
        }
    }
    let bare = median(ways[0].times.iter().copied());
    println!("{bare:8.3} ms without shadows; the others less that:");
    for way in &ways[1..] {
        let cost = median(way.times.iter().copied()) - bare;
        println!("{cost:8.3} ms {}", way.name);
    }
    early_out_error(&yard.picture(&ways[early]), &yard.picture(&ways[full]));
    for (name, a, b, scale) in ratios {
        let rounds = (0..rounds).map(|round| {
            let cost = |way: usize| ways[way].times[round] - ways[0].times[round];
            cost(a) / cost(b) * scale
        });
        println!("ratio {name} {:.3}", median(rounds));
    }
    Ok(())
}
