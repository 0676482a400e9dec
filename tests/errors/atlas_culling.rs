//! Which casters go on which tiles, however many there are and however the atlas finds them.

use crate::common::noop;
use crate::common::shapes::{Random, cuboid, sphere};
use glam::{Affine3A, Vec3};
use shadows::{
    AtlasFrame, AtlasLight, Caster, PointLight, ShadowAtlas, ShadowAtlasDescriptor, TileSize, glam,
    wgpu,
};

const LIGHTS: usize = 6;

fn atlas(device: &wgpu::Device) -> ShadowAtlas {
    let descriptor = ShadowAtlasDescriptor {
        layer_size: 64,
        ..Default::default()
    };
    ShadowAtlas::new(device, &descriptor).unwrap()
}

/// A world of casters on a wide floor, all kinds of sizes, and lights that reach a few of them.
struct World {
    device: wgpu::Device,
    queue: wgpu::Queue,
    random: Random,
    meshes: [shadows::CasterMesh; 2],
    lights: Vec<PointLight>,
    casters: Vec<Caster>,
}

impl World {
    fn new() -> Self {
        let (device, queue) = noop();
        let meshes = [cuboid(Vec3::splat(0.3)), sphere(3, 5)].map(|shape| shape.mesh(&device));
        let mut world = Self {
            device,
            queue,
            random: Random::new(77),
            meshes,
            lights: Vec::new(),
            casters: Vec::new(),
        };
        for _ in 0..LIGHTS {
            let light = PointLight::new(world.place(), 4.0);
            world.lights.push(light);
        }
        (0..900).for_each(|_| world.add());
        world
    }

    fn place(&mut self) -> Vec3 {
        self.random.vec3() * Vec3::new(30.0, 3.0, 30.0)
    }

    fn add(&mut self) {
        let size = if self.random.next() > 0.9 { 5.0 } else { 0.5 };
        let transform =
            Affine3A::from_translation(self.place()) * Affine3A::from_scale(Vec3::splat(size));
        let mesh = self.meshes[self.casters.len() % 2].clone();
        self.casters.push(Caster::new(mesh, transform));
    }

    /// Moves all lights, some casters a little, one far; and some come or go.
    fn step(&mut self, step: usize) {
        for i in 0..LIGHTS {
            self.lights[i].position += self.random.vec3() * 2.0;
        }
        for k in 0..5 {
            let at = (step * 131 + k * 37) % self.casters.len();
            let by = self.random.vec3();
            self.casters[at].world_from_object.translation += glam::Vec3A::from(by);
        }
        let far = step * 17 % self.casters.len();
        let to = self.place();
        self.casters[far].world_from_object.translation = to.into();
        match step % 5 {
            0 => (0..7).for_each(|_| self.add()),
            3 => self.casters.truncate(self.casters.len() - 7),
            4 => drop(self.casters.swap_remove(step % self.casters.len())),
            _ => {}
        }
    }

    /// Casters and triangles of every tile; of lights that nothing casts to, none.
    fn tiles(&self, atlas: &mut ShadowAtlas, casters: &[Caster]) -> Vec<Vec<(u32, u64)>> {
        let size = TileSize::Fixed(16);
        let lights: Vec<_> = (self.lights.iter())
            .map(|&light| AtlasLight::new(light).with_size(size))
            .collect();
        let frame = AtlasFrame {
            lights: &lights,
            casters,
            ..Default::default()
        };
        atlas.prepare(&self.device, &self.queue, &frame).unwrap();
        let of = |light| {
            let tiles = atlas.tiles(light, 0);
            let statistics = tiles.iter().map(|tile| tile.statistics);
            let counts: Vec<_> = statistics.map(|of| (of.casters, of.triangles)).collect();
            match counts.iter().all(|count| count.0 == 0) {
                true => Vec::new(),
                false => counts,
            }
        };
        (0..LIGHTS).map(of).collect()
    }
}

#[test]
fn an_atlas_that_has_seen_many_frames_finds_the_casters_that_a_new_one_finds() {
    let mut world = World::new();
    let mut old = atlas(&world.device);
    let (mut touching, mut twin_differs) = (0, 0);
    // A new one looks at each caster; after some 20 of these frames the old one has built its tree.
    for step in 0..60 {
        world.step(step);
        let ours = world.tiles(&mut old, &world.casters);
        let mut new = atlas(&world.device);
        assert_eq!(ours, world.tiles(&mut new, &world.casters), "step {step}");
        touching += ours.iter().flatten().map(|tile| tile.0).sum::<u32>();
        // The broken twin: an atlas that does not know of the first hundred casters.
        let known = &world.casters[100..];
        let mut twin = atlas(&world.device);
        twin_differs += u32::from(ours != world.tiles(&mut twin, known));
    }
    assert!(touching > 60 * 36, "{touching} casters on tiles");
    assert!(twin_differs > 40, "{twin_differs}");
}
