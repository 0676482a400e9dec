//! Cases of a sun over a long view, as cascades divide it.

use shadows::glam::{Affine3A, Vec3, Vec4};

use super::Case;
use crate::hard::situation::{Situation, at, sun};
use host::random::Random;
use host::shapes;

pub const CASES: [Case; 2] = [
    Case {
        name: "Very narrow and very wide cameras",
        build: "a sun, fields of view of 0.01 and 170 degrees",
        answer: "equals the reference",
        situations: narrow_and_wide,
        ..Case::EXACT
    },
    Case {
        name: "Sun over a long view",
        build: "casters in a row to the distance; one 400 nearer to the sun; a sun along the view, against it \
            and at N.L 0.05",
        answer: "equals the reference",
        situations: long_view,
        ..Case::EXACT
    },
];

fn narrow_and_wide(random: &mut Random) -> Vec<Situation> {
    [0.01_f32, 170.0]
        .into_iter()
        .map(|degrees| {
            let mut situation = Situation::new(format!("{degrees} degrees"), sun(random), random)
                .caster(&shapes::cube().tilted(), at(-0.6, 1.6, 0.0))
                .caster(&shapes::sphere(12), at(1.2, 1.2, -0.5));
            let camera = &mut situation.scene.camera;
            if degrees < 1.0 {
                // Far enough to see three metres.
                let away = (camera.eye - camera.target).normalize();
                camera.eye = camera.target + away * 2e4;
            }
            camera.fovy = degrees.to_radians();
            situation
        })
        .collect()
}

fn long_view(random: &mut Random) -> Vec<Situation> {
    let eye = Vec3::new(0.5, 2.5, 9.0) + random.point(0.5);
    let target = Vec3::new(0.0, 1.0, -10.0);
    let along = (target - eye).normalize();
    let usual = sun(random).truncate();
    let grazing = Vec3::new(-1.0, 0.05, 0.3 + random.within(-0.1, 0.1));
    [
        ("sun", usual),
        // Not from below the ground.
        ("along", (0.2 * Vec3::Y - along).normalize()),
        ("against", (0.3 * Vec3::Y + along).normalize()),
        ("N.L 0.05", grazing),
    ]
    .into_iter()
    .map(|(what, toward)| {
        let mut situation = Situation::new(what, Vec4::from((toward, 0.0)), random)
            .bare()
            .receiver(&shapes::square(30.0), Affine3A::IDENTITY)
            .camera(eye, target);
        for i in 0..6 {
            let z = 5.0 - 1.1 * (1.5_f32).powi(i);
            let x = if i % 2 == 0 { -1.2 } else { 1.6 };
            let small = Affine3A::from_scale(Vec3::splat(0.5));
            situation = situation.caster(&shapes::cube().tilted(), at(x, 0.95, z) * small);
        }
        let high = Vec3::new(0.3, 0.0, 1.0) + 400.0 * toward.normalize();
        situation.caster(&shapes::sphere(10), Affine3A::from_translation(high))
    })
    .collect()
}
