//! Samplers, and every kernel's receiver: a lit pass over the floor alone, which all shadows fall on,
//! beside that pass without shadows.

use anyhow::Result;
use shadows::{
    AnyMap, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DepthEncoding, Kernel, MapKind,
    PcfDescriptor, PcfSampler, RandomDisk, wgpu, wgsl,
};

use crate::clock::Bench;
use crate::flat::Flat;
use crate::stage::{SIZE, Stage};
use host::gpu::Gpu;
use host::pipelines::{ShadowAccess, visibility_module};
use host::renderer::Renderer;
use host::scene_gpu::SceneGpu;

pub fn all(bench: &mut Bench<'_>, stage: &Stage<'_>) -> Result<()> {
    let gpu = stage.gpu;
    let [spot, ..] = stage.flat_lights();
    let flat = Flat::new(stage, spot.1)?;
    let cube = drawn(stage, stage.cube_map(true)?)?;
    samplers(bench, stage, &cube, &flat)?;
    let mut floor = Floor::new(stage)?;
    let bare = |floor: &mut Floor, encoder: &mut wgpu::CommandEncoder| {
        let unshadowed = floor.host.unshadowed();
        floor.host.draw_lit(encoder, &floor.scene, unshadowed, None);
    };
    bench.gpu("receiver/no shadows", &mut floor, |_| {}, bare);
    let maps = [
        ("cube", AnyMap::from(&cube)),
        ("flat", AnyMap::from(&flat.map)),
    ];
    for (kind, map) in maps {
        for kernel in Kernel::ALL {
            let descriptor = PcfDescriptor {
                kernel,
                map: map.kind(),
                ..Default::default()
            };
            let name = format!("{kind}, {}", name(kernel));
            receiver(bench, gpu, &floor, &name, (map, &descriptor))?;
        }
    }
    let descriptor = PcfDescriptor {
        map: MapKind::Cube(DepthEncoding::LinearDistance),
        textbook: true,
        ..Default::default()
    };
    let textbook = CubeShadowMap::new(&gpu.device, &CubeShadowMapDescriptor::textbook())?;
    let textbook = drawn(stage, textbook)?;
    let read = ((&textbook).into(), &descriptor);
    receiver(bench, gpu, &floor, "cube, textbook", read)
}

/// What receives, without what casts.
struct Floor {
    scene: SceneGpu,
    host: Renderer,
}

impl Floor {
    /// With its depth drawn.
    fn new(stage: &Stage<'_>) -> Result<Self> {
        let mut scene = stage.scene.clone();
        scene.objects.retain(|object| !object.casts);
        let floor = SceneGpu::new(stage.gpu, &scene)?;
        let host = Renderer::new(stage.gpu, SIZE, &scene, &floor)?;
        stage.gpu.run(|encoder| host.draw_ambient(encoder, &floor));
        Ok(Self { scene: floor, host })
    }
}

/// A kernel without its numbers.
fn name(kernel: Kernel) -> String {
    let name = format!("{kernel:?}");
    name.split('(').next().unwrap_or_default().to_owned()
}

fn drawn(stage: &Stage<'_>, mut map: CubeShadowMap) -> Result<CubeShadowMap> {
    let gpu = stage.gpu;
    let frame = CubeFrame::new(stage.point(), &stage.scene_gpu.casters);
    map.prepare(&gpu.device, &gpu.queue, &frame)?;
    gpu.run(|encoder| map.encode(encoder));
    Ok(map)
}

fn samplers(
    bench: &mut Bench<'_>,
    stage: &Stage<'_>,
    cube: &CubeShadowMap,
    flat: &Flat<'_>,
) -> Result<()> {
    let (device, queue) = (&stage.gpu.device, &stage.gpu.queue);
    let make = |kernel, map| {
        let descriptor = PcfDescriptor {
            kernel,
            map,
            ..Default::default()
        };
        PcfSampler::new(device, queue, &descriptor)
    };
    let disk = Kernel::RandomDisk(RandomDisk::default());
    for (name, kernel) in [("one tap", Kernel::Hard), ("random disk", disk)] {
        let name = format!("sampler/PcfSampler::new, {name}");
        let make = |(): &mut ()| make(kernel, MapKind::CUBE);
        bench.cpu(&name, &mut (), |()| {}, make);
    }
    let of_cube = make(disk, MapKind::CUBE)?;
    let of_flat = make(disk, MapKind::FLAT)?;
    bench.cpu(
        "sampler/set_frame",
        &mut 0,
        |_| {},
        |frame| {
            *frame += 1;
            of_cube.set_frame(queue, *frame);
        },
    );
    let group = |(): &mut ()| of_cube.bind_group(device, cube);
    bench.cpu("sampler/bind_group, cube", &mut (), |()| {}, group);
    let group = |(): &mut ()| of_flat.bind_group(device, &flat.map);
    bench.cpu("sampler/bind_group, flat", &mut (), |()| {}, group);
    bench.plain("sampler/wgsl", || of_cube.wgsl());
    bench.plain("sampler/wgsl_module", || of_cube.wgsl_module(1));
    let text = of_cube.wgsl();
    bench.plain("sampler/wgsl::import_module", || {
        wgsl::import_module("shadows::pcf", &text)
    });
    Ok(())
}

fn receiver(
    bench: &mut Bench<'_>,
    gpu: &Gpu,
    floor: &Floor,
    name: &str,
    (map, descriptor): (AnyMap<'_>, &PcfDescriptor<'_>),
) -> Result<()> {
    let sampler = PcfSampler::new(&gpu.device, &gpu.queue, descriptor)?;
    let access = ShadowAccess {
        module: Some(&visibility_module(&sampler)),
        layout: Some(sampler.bind_group_layout()),
        ..Default::default()
    };
    let lit = floor.host.lit_pipeline(gpu, &access);
    let mut group = sampler.bind_group(&gpu.device, map)?;
    let draw = |group: &mut wgpu::BindGroup, encoder: &mut wgpu::CommandEncoder| {
        floor
            .host
            .draw_lit(encoder, &floor.scene, &lit, Some(group));
    };
    bench.gpu(&format!("receiver/{name}"), &mut group, |_| {}, draw);
    Ok(())
}
