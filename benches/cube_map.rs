//! What caching, culling and instancing are worth, in one run.
//!
//! - `all_moving_vs_textbook`: 64 spheres, all moving, faces of 1024 texels: prepare, encode and
//!   wait for the device, against the textbook preset (six unculled passes, distance written by the
//!   fragment shader).
//! - `one_moving_vs_all_moving`, `still_vs_all_moving`: the same scene, one sphere or none moving, the
//!   latter for 33 frames in a row, of which the median counts.
//! - `prepare_still_vs_moving`: `prepare` alone of an atlas for 16 lights and 2,500 casters, none moving
//!   against all moving; the first frame in which none moves.
//! - `flat_prepare_still_vs_moving`: the same for a flat map of a directional light and 10,000 casters;
//!   `flat_vs_cube_prepare_still`: against an atlas's of 16 lights, none of the casters moving.
//! - `one_of_N_vs_still`, `light_among_N_vs_still`: `prepare` with one caster of N, or one light
//!   among them, moving, against none: what moves beside what does not.
//!
//! - `moved_among_1e5_vs_among_1e3`: what 100 casters that move near a light add to `prepare`, among
//!   that many.
//! - `culling_N_vs_linear`: on the CPU alone, a hundredth of N casters and 16 lights moving: the
//!   library's own tree, kept up to date and asked for what each light reaches, against testing every
//!   caster's sphere for each light. `culling_N_vs_compute`: against a compute shader that does so, its
//!   uploads not counted.
//!
//! - `static_layer_vs_redraw`: a heavy part that stands still, 4,608 triangles a face of 1024
//!   texels, with one box moving before each face: its layers copied against drawing all again.
//! - `static_layer_vs_redraw_SIZE_TRIANGLES`: the same by size of face and triangles that stand
//!   still on it, all in one small mesh.
//! - `texels_a_triangle`: how many texels are copied in the time in which a small triangle is drawn,
//!   which is what `StaticLayers::Auto` decides by.
//!
//! Each line `ratio NAME VALUE` is the median, over rounds in which both sides take turns, of one over
//! the other in the same round, so that a machine that slows down slows both. `--quick` takes fewer
//! rounds. All times are wall time: of `prepare` alone on the CPU, of frames until the device is
//! done, for what they are compared with is on the CPU, too.

#[path = "cube_map/culling.rs"]
mod culling;
#[path = "cube_map/flat.rs"]
mod flat;
#[allow(dead_code)] // what other tests need
#[path = "../tests/common/shapes.rs"]
mod shapes;
#[path = "shared/mod.rs"]
mod shared;
#[path = "cube_map/static_layers.rs"]
mod static_layers;

use std::time::{Duration, Instant};

use host::gpu::Gpu;
use host::scene::spheres_moving;
use host::scene_gpu::SceneGpu;
use shadows::glam::{Affine3A, Vec3, Vec3A};
use shadows::{
    AtlasFrame, AtlasLight, Caster, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, PointLight,
    ShadowAtlas, ShadowAtlasDescriptor, TileSize, wgpu,
};
use shapes::cuboid;

fn main() {
    let quick = shared::quick();
    let gpu = match Gpu::new(None) {
        Ok(gpu) => gpu,
        Err(error) => return eprintln!("skipped: {error:#}"),
    };
    println!("adapter {}, clock wall", host::gpu::describe(&gpu.info));
    spheres(&gpu, if quick { 15 } else { 75 });
    static_layers::run(&gpu, if quick { 5 } else { 25 });
    prepare(&gpu, if quick { 15 } else { 75 });
    flat::prepare(&gpu, if quick { 15 } else { 75 });
    for (name, count) in [("1e2", 100), ("1e4", 10_000), ("1e5", 100_000)] {
        one_of_many(&gpu, count, if quick { 5 } else { 25 });
        culling::culling(&gpu, name, count, if quick { 25 } else { 125 });
    }
    moved(&gpu, if quick { 25 } else { 125 });
}

fn median(samples: &[Duration]) -> f64 {
    shared::median(shared::seconds(samples))
}

/// Of rounds in which both took turns.
fn ratio(name: &str, ours: &[Duration], theirs: &[Duration]) {
    let (our, their) = (median(ours) * 1e3, median(theirs) * 1e3);
    println!("{name}: {our:.3} ms / {their:.3} ms");
    let ratio = shared::paired(&shared::seconds(ours), &shared::seconds(theirs));
    println!("ratio {name} {ratio:.4}");
}

fn new_map(gpu: &Gpu, descriptor: &CubeShadowMapDescriptor<'_>) -> CubeShadowMap {
    CubeShadowMap::new(&gpu.device, descriptor).expect("the descriptor is in range")
}

/// Prepare, encode and wait.
fn frame(gpu: &Gpu, map: &mut CubeShadowMap, light: PointLight, casters: &[Caster]) -> Duration {
    let frame = CubeFrame::new(light, casters);
    let start = Instant::now();
    map.prepare(&gpu.device, &gpu.queue, &frame)
        .expect("the frame is in range");
    gpu.run(|encoder| map.encode(encoder));
    start.elapsed()
}

fn spheres(gpu: &Gpu, rounds: u32) {
    let scene = spheres_moving(0.0);
    let light = PointLight::new(scene.light().place.truncate(), scene.light().range);
    let mut casters = SceneGpu::new(gpu, &scene).expect("the scene fits").casters;
    let mut textbook = new_map(gpu, &CubeShadowMapDescriptor::textbook());
    let mut map = new_map(gpu, &CubeShadowMapDescriptor::default());
    let [mut book, mut all, mut one, mut still] = [const { Vec::new() }; 4];
    // The first round makes pipelines and textures.
    for round in 0..=rounds {
        let moving = spheres_moving(0.1 * f64::from(round + 1));
        let objects = moving.objects.iter().filter(|object| object.casts);
        for (caster, object) in casters.iter_mut().zip(objects) {
            caster.world_from_object = object.transform;
        }
        let theirs = frame(gpu, &mut textbook, light, &casters);
        let ours = frame(gpu, &mut map, light, &casters);
        let moved = round as usize * 7 % casters.len();
        casters[moved].world_from_object.translation += Vec3A::splat(0.01);
        let once = frame(gpu, &mut map, light, &casters);
        let nothing = many_in_a_row(|| frame(gpu, &mut map, light, &casters));
        if round > 0 {
            book.push(theirs);
            all.push(ours);
            one.push(once);
            still.push(nothing);
        }
    }
    ratio("all_moving_vs_textbook", &all, &book);
    ratio("one_moving_vs_all_moving", &one, &all);
    ratio("still_vs_all_moving", &still, &all);
}

/// The median of 33 in a row, as of a scene that goes on standing still. On a loaded machine whoever
/// has just worked for long is made to wait, 4 ms at once where this was looked into, and the first
/// frame, which takes a tenth of one, would be charged with it: the ratio came to 0.14 instead of
/// 0.004. (To sleep first only lets others have the caches.)
fn many_in_a_row(mut work: impl FnMut() -> Duration) -> Duration {
    let mut times = [(); 33].map(|()| work());
    times.sort_unstable();
    times[times.len() / 2]
}

/// Boxes in a flat world of one a square metre, lights all over it.
struct World {
    casters: Vec<Caster>,
    lights: Vec<PointLight>,
    atlas: ShadowAtlas,
}

impl World {
    fn new(gpu: &Gpu, count: usize, range: f32) -> Self {
        let mesh = cuboid(Vec3::splat(0.2)).mesh(&gpu.device);
        let side = (count as f32).sqrt().ceil();
        let place = |i: usize| {
            let (x, z) = (i as f32 % side, (i as f32 / side).floor());
            Affine3A::from_translation(Vec3::new(x, 0.0, z))
        };
        let lights = (0..16).map(|i| {
            let at = |k: usize| (k as f32 + 0.5) / 4.0 * side;
            PointLight::new(Vec3::new(at(i % 4), 2.0, at(i / 4)), range)
        });
        Self {
            casters: (0..count)
                .map(|i| Caster::new(mesh.clone(), place(i)))
                .collect(),
            lights: lights.collect(),
            atlas: ShadowAtlas::new(&gpu.device, &ShadowAtlasDescriptor::default())
                .expect("the descriptor is in range"),
        }
    }

    /// Time of `prepare` alone; the frame is drawn after.
    fn prepare(&mut self, gpu: &Gpu) -> Duration {
        let size = TileSize::Fixed(16);
        let lights: Vec<_> = (self.lights.iter())
            .map(|&light| AtlasLight::new(light).with_size(size))
            .collect();
        let frame = AtlasFrame {
            lights: &lights,
            casters: &self.casters,
            ..Default::default()
        };
        let start = Instant::now();
        self.atlas
            .prepare(&gpu.device, &gpu.queue, &frame)
            .expect("the frame is in range");
        let time = start.elapsed();
        gpu.run(|encoder: &mut wgpu::CommandEncoder| self.atlas.encode(encoder));
        time
    }
}

fn prepare(gpu: &Gpu, rounds: u32) {
    let mut world = World::new(gpu, 2500, 15.0);
    world.prepare(gpu);
    let (mut moving, mut still) = (Vec::new(), Vec::new());
    for _ in 0..rounds {
        for caster in &mut world.casters {
            caster.world_from_object.translation.y += 0.001;
        }
        moving.push(world.prepare(gpu));
        still.push(world.prepare(gpu));
    }
    ratio("prepare_still_vs_moving", &still, &moving);
}

fn one_of_many(gpu: &Gpu, count: usize, rounds: u32) {
    // Each light reaches about 700 casters, however many there are.
    let mut world = World::new(gpu, count, 15.0);
    world.prepare(gpu);
    let (mut one, mut still, mut light) = (Vec::new(), Vec::new(), Vec::new());
    for round in 0..rounds as usize {
        let moved = round * 7919 % count;
        world.casters[moved].world_from_object.translation.y += 0.01;
        one.push(world.prepare(gpu));
        still.push(world.prepare(gpu));
        world.lights[round % 16].position.y += 0.01;
        light.push(world.prepare(gpu));
    }
    ratio(&format!("one_of_{count}_vs_still"), &one, &still);
    ratio(&format!("light_among_{count}_vs_still"), &light, &still);
}

/// A hundred casters moving near one light, among `count`: medians of `prepare` with and without
/// them moving.
struct Moved {
    world: World,
    nearest: Vec<usize>,
    moved: Vec<Duration>,
    still: Vec<Duration>,
}

impl Moved {
    fn among(gpu: &Gpu, count: usize) -> Self {
        let mut world = World::new(gpu, count, 15.0);
        let centre = 0.5 * (count as f32).sqrt().ceil();
        world.lights = vec![PointLight::new(Vec3::new(centre, 2.0, centre), 15.0)];
        let light = Vec3A::from(world.lights[0].position);
        let mut nearest: Vec<usize> = (0..count).collect();
        let place = |i: &usize| world.casters[*i].world_from_object.translation;
        nearest.sort_by(|a, b| {
            let distance = |i| place(i).distance_squared(light);
            distance(a).total_cmp(&distance(b))
        });
        nearest.truncate(100);
        world.prepare(gpu);
        Self {
            world,
            nearest,
            moved: Vec::new(),
            still: Vec::new(),
        }
    }

    fn round(&mut self, gpu: &Gpu) {
        for &i in &self.nearest {
            self.world.casters[i].world_from_object.translation.y += 0.001;
        }
        self.moved.push(self.world.prepare(gpu));
        self.still.push(self.world.prepare(gpu));
    }

    /// Seconds with a hundred casters moving, and with none.
    fn medians(&mut self) -> [f64; 2] {
        [median(&self.moved), median(&self.still)]
    }
}

fn moved(gpu: &Gpu, rounds: u32) {
    let mut worlds = [1000, 100_000].map(|count| Moved::among(gpu, count));
    for _ in 0..rounds {
        worlds.iter_mut().for_each(|world| world.round(gpu));
    }
    let [few, many] = worlds.each_mut().map(Moved::medians);
    for (name, [moved, still]) in [("1e3", few), ("1e5", many)] {
        let cost = 1e6 * (moved - still);
        println!(
            "100 moved among {name}: {:.1} us, of which {cost:.1} for them",
            1e6 * moved
        );
    }
    let compared = 1e9 * (many[1] - few[1]) / 99_000.0;
    println!("comparing a caster with the last frame's: {compared:.2} ns");
    let ratio = (many[0] - many[1]) / (few[0] - few[1]);
    println!("ratio moved_among_1e5_vs_among_1e3 {ratio:.4}");
}
