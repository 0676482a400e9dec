//! What an atlas costs, in one run.
//!
//! - `atlas_vs_cube_one_light`: one point light over 64 spheres, all moving, faces of 1024 texels: prepare,
//!   encode and wait for the device, through a `ShadowAtlas` over a `CubeShadowMap`.
//!   Layers are as wide as the faces: software drivers take longer to draw into a texture that is wider.
//! - `one_tile_vs_own_map`: one spot of 512 texels among 64 in four layers of 2048, its caster moving: the
//!   tile is drawn in a layer that is otherwise kept, over a `ShadowMap` of that size.
//! - `prepare_kept_vs_moving`: `prepare` alone for 1,000 lights (600 points, 390 spots, 10 suns) and
//!   10,000 casters, nothing moving over everything moving.
//! - `prepare_one_moved_vs_moving`: the same with one caster moving.
//! - `prepare_9_lamps_2500_vs_1250`: 9 lamps, 54 faces, all casters moving: twice the casters over half of
//!   them. Linear in draws is 2.
//!
//! Each line `ratio NAME VALUE` is the median, over rounds in which both sides take turns, of one over the
//! other in the same round. `--quick` takes fewer rounds. All times are wall time.

#[allow(dead_code)] // what other tests need
#[path = "../tests/common/shapes.rs"]
mod shapes;
#[path = "shared/mod.rs"]
mod shared;

use std::time::{Duration, Instant};

use host::gpu::Gpu;
use host::scene::spheres_moving;
use host::scene_gpu::SceneGpu;
use shadows::glam::{Affine3A, Vec3};
use shadows::{
    AtlasFrame, AtlasLight, Cascades, Caster, CubeFrame, CubeShadowMap, DirectionalLight,
    PointLight, ShadowAtlas, ShadowAtlasDescriptor, ShadowFrame, ShadowMap, ShadowMapDescriptor,
    SpotLight, TileSize,
};
use shapes::{Random, cuboid};

fn main() {
    let quick = shared::quick();
    let gpu = match Gpu::new(None) {
        Ok(gpu) => gpu,
        Err(error) => return eprintln!("skipped: {error:#}"),
    };
    println!("adapter {}, clock wall", host::gpu::describe(&gpu.info));
    one_light(&gpu, if quick { 15 } else { 75 });
    one_tile(&gpu, if quick { 15 } else { 75 });
    many_lights(&gpu, if quick { 5 } else { 25 });
    nine_lamps(&gpu, if quick { 15 } else { 75 });
}

fn ratio(name: &str, ours: &[Duration], theirs: &[Duration]) {
    let median = |samples: &[Duration]| 1e3 * shared::median(shared::seconds(samples));
    println!("{name}: {:.3} ms / {:.3} ms", median(ours), median(theirs));
    let ratio = shared::paired(&shared::seconds(ours), &shared::seconds(theirs));
    println!("ratio {name} {ratio:.4}");
}

fn new_atlas(gpu: &Gpu, descriptor: &ShadowAtlasDescriptor<'_>) -> ShadowAtlas {
    ShadowAtlas::new(&gpu.device, descriptor).expect("the descriptor is in range")
}

/// Prepares, encodes and waits: the time of `prepare`, and of all.
fn frame(
    gpu: &Gpu,
    atlas: &mut ShadowAtlas,
    lights: &[AtlasLight],
    casters: &[Caster],
) -> [Duration; 2] {
    let frame = AtlasFrame {
        lights,
        casters,
        ..Default::default()
    };
    let start = Instant::now();
    atlas
        .prepare(&gpu.device, &gpu.queue, &frame)
        .expect("the frame is in range");
    let prepared = start.elapsed();
    gpu.run(|encoder| atlas.encode(encoder));
    [prepared, start.elapsed()]
}

fn one_light(gpu: &Gpu, rounds: u32) {
    let scene = spheres_moving(0.0);
    let light = PointLight::new(scene.light().place.truncate(), scene.light().range);
    let mut casters = SceneGpu::new(gpu, &scene).expect("the scene fits").casters;
    let mut map = CubeShadowMap::new(&gpu.device, &Default::default()).expect("it is in range");
    let mut atlas = new_atlas(gpu, &ShadowAtlasDescriptor::default());
    let lights = [AtlasLight::new(light).with_size(TileSize::Fixed(1024))];
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    // The first round makes pipelines and textures.
    for round in 0..=rounds {
        let moving = spheres_moving(0.1 * f64::from(round + 1));
        let objects = moving.objects.iter().filter(|object| object.casts);
        for (caster, object) in casters.iter_mut().zip(objects) {
            caster.world_from_object = object.transform;
        }
        let start = Instant::now();
        let cube = CubeFrame::new(light, &casters);
        map.prepare(&gpu.device, &gpu.queue, &cube)
            .expect("the frame is in range");
        gpu.run(|encoder| map.encode(encoder));
        let cube = start.elapsed();
        let [_, tiles] = frame(gpu, &mut atlas, &lights, &casters);
        if round > 0 {
            ours.push(tiles);
            theirs.push(cube);
        }
    }
    ratio("atlas_vs_cube_one_light", &ours, &theirs);
}

fn one_tile(gpu: &Gpu, rounds: u32) {
    let mesh = cuboid(Vec3::splat(0.4)).mesh(&gpu.device);
    let place = |i: usize| Vec3::new((i % 8) as f32 * 10.0, 0.0, (i / 8) as f32 * 10.0);
    let mut casters: Vec<Caster> = (0..64)
        .map(|i| Caster::new(mesh.clone(), Affine3A::from_translation(place(i))))
        .collect();
    let spot = |i| SpotLight::new(place(i) + 3.0 * Vec3::Y, Vec3::NEG_Y, 0.5, 6.0);
    let light = |i| AtlasLight::new(spot(i)).with_size(TileSize::Fixed(512));
    let lights: Vec<AtlasLight> = (0..64).map(light).collect();
    let mut atlas = new_atlas(gpu, &ShadowAtlasDescriptor::default());
    let descriptor = ShadowMapDescriptor {
        size: 512,
        ..Default::default()
    };
    let mut map = ShadowMap::new(&gpu.device, &descriptor).expect("it is in range");
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for round in 0..=rounds {
        casters[20].world_from_object.translation.y += 0.001;
        let [_, tile] = frame(gpu, &mut atlas, &lights, &casters);
        let start = Instant::now();
        let own = ShadowFrame::new(spot(20), &casters);
        map.prepare(&gpu.device, &gpu.queue, &own)
            .expect("the frame is in range");
        gpu.run(|encoder| map.encode(encoder));
        if round > 0 {
            theirs.push(start.elapsed());
            ours.push(tile);
        }
    }
    ratio("one_tile_vs_own_map", &ours, &theirs);
}

/// Boxes in a flat world of one a square metre.
fn boxes(gpu: &Gpu, count: usize) -> Vec<Caster> {
    let mesh = cuboid(Vec3::splat(0.2)).mesh(&gpu.device);
    let side = (count as f32).sqrt().ceil();
    let place = |i: usize| Vec3::new(i as f32 % side, 0.0, (i as f32 / side).floor());
    (0..count)
        .map(|i| Caster::new(mesh.clone(), Affine3A::from_translation(place(i))))
        .collect()
}

fn many_lights(gpu: &Gpu, rounds: u32) {
    let mut casters = boxes(gpu, 10_000);
    let mut random = Random::new(1);
    let light = |i: usize| {
        let at = 50.0 * (random.vec3() + 1.0);
        let at = Vec3::new(at.x, 2.0, at.z);
        let light = match i {
            0..600 => AtlasLight::new(PointLight::new(at, 4.0)),
            600..990 => AtlasLight::new(SpotLight::new(at, Vec3::NEG_Y, 0.8, 6.0)),
            _ => {
                let sun = DirectionalLight::new(random.vec3() + 2.0 * Vec3::Y);
                return AtlasLight::directional(sun, Cascades::default())
                    .with_size(TileSize::Fixed(64));
            }
        };
        light.with_size(TileSize::Fixed(16))
    };
    let lights: Vec<AtlasLight> = (0..1000).map(light).collect();
    let mut atlas = new_atlas(gpu, &ShadowAtlasDescriptor::default());
    let [mut moving, mut kept, mut one] = [const { Vec::new() }; 3];
    frame(gpu, &mut atlas, &lights, &casters);
    for round in 0..rounds as usize {
        for caster in &mut casters {
            caster.world_from_object.translation.y += 0.0001;
        }
        moving.push(frame(gpu, &mut atlas, &lights, &casters)[0]);
        frame(gpu, &mut atlas, &lights, &casters);
        kept.push(frame(gpu, &mut atlas, &lights, &casters)[0]);
        casters[round * 7919 % 10_000]
            .world_from_object
            .translation
            .y += 0.01;
        one.push(frame(gpu, &mut atlas, &lights, &casters)[0]);
    }
    ratio("prepare_kept_vs_moving", &kept, &moving);
    ratio("prepare_one_moved_vs_moving", &one, &moving);
}

fn nine_lamps(gpu: &Gpu, rounds: u32) {
    let mut worlds = [2500, 1250].map(|count| {
        let atlas = new_atlas(gpu, &ShadowAtlasDescriptor::default());
        (atlas, boxes(gpu, count))
    });
    let lamp = |i: usize| {
        let at = Vec3::new((i % 3) as f32, 0.2, (i / 3) as f32) * 17.0;
        AtlasLight::new(PointLight::new(at, 100.0)).with_size(TileSize::Fixed(64))
    };
    let lights: Vec<AtlasLight> = (0..9).map(lamp).collect();
    let mut times = [const { Vec::new() }; 2];
    let mut drawn = 0;
    for round in 0..=rounds {
        for ((atlas, casters), times) in worlds.iter_mut().zip(&mut times) {
            for caster in casters.iter_mut() {
                caster.world_from_object.translation.y += 0.0001;
            }
            let [prepared, _] = frame(gpu, atlas, &lights, casters);
            if round > 0 {
                times.push(prepared);
            }
        }
        drawn = worlds[0].0.statistics().casters_in_range;
    }
    println!("{drawn} casters in range of 9 lamps");
    ratio("prepare_9_lamps_2500_vs_1250", &times[0], &times[1]);
}
