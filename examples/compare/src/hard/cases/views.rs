//! The built-in scenes from anywhere, under a light anywhere.

use shadows::glam::Vec3;

use super::{Case, Expect};
use crate::hard::situation::Situation;
use host::random::Random;
use host::scene::{Scene, courtyard, spheres, teapot};

pub(super) const NEAR_EDGE: &str =
    "an edge or a contact passes within 1/256 pixel of the pixel's centre, where rasterisers round";

pub const CASES: [Case; 3] = [
    Case {
        name: "Spheres from anywhere",
        build: "the scene, random cameras and lights",
        answer: "equals the reference",
        situations: |random| views(spheres(), random),
        volumes: Expect::Rare(NEAR_EDGE),
        maps: Expect::Rare(NEAR_EDGE),
        ..Case::EXACT
    },
    Case {
        name: "Courtyard from anywhere",
        build: "the scene (218k triangles that cast), random cameras and lights",
        answer: "equals the reference",
        situations: |random| views(courtyard(), random),
        volumes: Expect::Rare(NEAR_EDGE),
        maps: Expect::Rare(NEAR_EDGE),
        cheap: &["planar"],
        ..Case::EXACT
    },
    Case {
        name: "Teapot from anywhere",
        build: "the scene, random cameras and lights",
        answer: "equals the reference",
        situations: |random| views(teapot(), random),
        volumes: Expect::Rare(NEAR_EDGE),
        maps: Expect::Rare(NEAR_EDGE),
        ..Case::EXACT
    },
];

/// The scene's own view, eye and light moved by up to a third of their distance from what is
/// looked at.
fn views(scene: Scene, random: &mut Random) -> Vec<Situation> {
    (0..3)
        .map(|view| {
            let mut scene = scene.clone();
            let middle = scene.camera.target;
            let mut moved = |from: Vec3| {
                let reach = from.distance(middle) / 3.0;
                let to = from + random.point(reach);
                Vec3::new(to.x, to.y.max(0.5 * from.y), to.z)
            };
            scene.camera.eye = moved(scene.camera.eye);
            scene.light_mut().place = moved(scene.light().place.truncate()).extend(1.0);
            Situation::of(format!("view {view}"), scene)
        })
        .collect()
}
