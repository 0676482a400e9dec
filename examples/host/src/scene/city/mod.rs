//! A town by day and by night: streets of houses around a market square. Generated and seeded;
//! metres.
//!
//! Blocks of houses stand between avenues along z and streets along x. What is near the camera has
//! all its detail; far houses are the same without sills, frames and railings.

mod car;
mod church;
mod furniture;
mod house;
mod lights;
mod palette;
mod plan;
pub(super) mod roof;
mod rows;
pub(super) mod street;
pub(super) mod walls;

use shadows::glam::{Affine3A, Quat, Vec3, Vec4, vec3};

use super::super::random::Random;
use super::kit::about_y;
use super::{Camera, Light, Mesh, Object, Scene, Sky, Time, square};
use lights::Candidate;

/// The town: about 2,000 objects that cast, of closed meshes. By day under a sun; by night under
/// [`lights::MOST`] lamps, lanterns and windows, of which the first 16 are the street lamps nearest to
/// what the camera looks at.
pub fn city(time: Time) -> Scene {
    let mut city = City::new(time);
    city.ground();
    rows::build(&mut city);
    furniture::build(&mut city);
    city.finish()
}

/// The scene while it is built.
struct City {
    scene: Scene,
    time: Time,
    random: Random,
    lights: Vec<Candidate>,
}

/// Where an object stands: its foot, turned about y by so many radians.
fn stand(foot: Vec3, turn: f32) -> Affine3A {
    Affine3A::from_rotation_translation(about_y(turn), foot)
}

impl City {
    fn new(time: Time) -> Self {
        let mut scene = Scene::empty("city");
        scene.camera = Camera {
            eye: vec3(0.6, 4.9, 64.0),
            target: vec3(5.6, 4.3, 24.0),
            fovy: 46_f32.to_radians(),
            near: 0.1,
        };
        scene.sky = match time {
            Time::Day => Sky {
                horizon: [0.6, 0.71, 0.84],
                zenith: [0.13, 0.3, 0.66],
                ambient: [0.2, 0.235, 0.295],
                haze: 0.0011,
            },
            Time::Night => Sky {
                horizon: [0.016, 0.02, 0.036],
                zenith: [0.0025, 0.004, 0.011],
                ambient: [0.011, 0.014, 0.025],
                haze: 0.002,
            },
        };
        Self {
            scene,
            time,
            random: Random(11),
            lights: Vec::new(),
        }
    }

    fn mesh(&mut self, mesh: Mesh) -> usize {
        self.scene.add_mesh(mesh)
    }

    /// Places a mesh that casts, named after it.
    fn put(&mut self, mesh: usize, transform: Affine3A, albedo: [f32; 3]) {
        self.place(mesh, transform, albedo, [0.0; 3], true);
    }

    /// Places what lets light through: panes and bulbs. It glows by night.
    fn put_glass(&mut self, mesh: usize, transform: Affine3A, albedo: [f32; 3], glow: [f32; 3]) {
        let glow = match self.time {
            Time::Day => [0.0; 3],
            Time::Night => glow,
        };
        self.place(mesh, transform, albedo, glow, false);
    }

    fn place(
        &mut self,
        mesh: usize,
        transform: Affine3A,
        albedo: [f32; 3],
        glow: [f32; 3],
        casts: bool,
    ) {
        let (name, number) = (&self.scene.meshes[mesh].name, self.scene.objects.len());
        self.scene.objects.push(Object {
            name: format!("{name} {number}"),
            mesh,
            transform,
            casts,
            albedo,
            glow,
        });
    }

    /// Places a block between two corners.
    fn put_block(&mut self, block: usize, min: Vec3, max: Vec3, albedo: [f32; 3]) {
        let half = 0.5 * (max - min);
        let foot = vec3(min.x + half.x, min.y, min.z + half.z);
        let scale = vec3(half.x, 2.0 * half.y, half.z);
        let place = Affine3A::from_scale_rotation_translation(scale, Quat::IDENTITY, foot);
        self.put(block, place, albedo);
    }

    /// One of several, at random.
    fn any<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.random.below(of.len())]
    }

    /// The road under everything, what is painted on it, and the blocks with their kerbs.
    fn ground(&mut self) {
        let road = self.mesh(square("road", Vec3::ZERO, 900.0));
        let below = Affine3A::from_translation(vec3(0.0, 0.0, -60.0));
        self.place(road, below, palette::ASPHALT, [0.0; 3], false);
        let paint = self.mesh(square("paint", Vec3::ZERO, 1.0));
        for (min, max) in plan::markings() {
            let middle = 0.5 * (min + max);
            let half = 0.5 * (max - min);
            let place = Affine3A::from_scale_rotation_translation(
                vec3(half.x, 1.0, half.y),
                Quat::IDENTITY,
                vec3(middle.x, 0.006, middle.y),
            );
            self.place(paint, place, palette::PAINT, [0.0; 3], false);
        }
        let block = self.mesh(super::masonry::block());
        for kerb in plan::blocks().map(|block| block.kerb) {
            let [low, high] = [kerb.min, kerb.max];
            let (top, wide) = (plan::PAVEMENT, 0.28);
            self.put_block(
                block,
                vec3(low.x + 0.05, -0.2, low.y + 0.05),
                vec3(high.x - 0.05, top, high.y - 0.05),
                palette::PAVING,
            );
            for [min, max] in [
                [vec3(low.x, -0.2, low.y), vec3(low.x + wide, top, high.y)],
                [vec3(high.x - wide, -0.2, low.y), vec3(high.x, top, high.y)],
                [
                    vec3(low.x + wide, -0.2, low.y),
                    vec3(high.x - wide, top, low.y + wide),
                ],
                [
                    vec3(low.x + wide, -0.2, high.y - wide),
                    vec3(high.x - wide, top, high.y),
                ],
            ] {
                // A little above the pavement, as kerbstones are.
                let max = max + Vec3::Y * 0.012;
                self.put_block(block, min, max, palette::KERB);
            }
        }
    }

    fn finish(mut self) -> Scene {
        let sun = Light {
            color: [1.0, 0.92, 0.78],
            intensity: Some(2.3),
            ..Light::new(Vec4::new(-0.52, 0.74, 0.47, 0.0), 1.0)
        };
        self.scene.lights = match self.time {
            Time::Day => vec![sun],
            Time::Night => lights::chosen(self.lights, &self.scene.camera),
        };
        self.scene
    }
}
