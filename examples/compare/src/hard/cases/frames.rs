//! Cases of what happens between frames.

use shadows::glam::{Affine3A, Vec3};

use super::{Case, Course};
use crate::hard::situation::{Situation, at, either};
use host::random::Random;
use host::shapes;

pub const CASES: [Case; 2] = [
    Case {
        name: "Casters come and go",
        build: "the first, a middle one and the last go and come back, one leaves the range, 300 come and go",
        answer: "as a fresh renderer: equals the reference",
        situations: crowd,
        course: Course::ComeAndGo,
        cheap: &["planar", "projected"],
        ..Case::EXACT
    },
    Case {
        name: "Two views in one submission",
        build: "another camera, light and moved casters, prepared and recorded behind the first's",
        answer: "the first as alone: equals the reference",
        situations: crowd,
        course: Course::TwoViews,
        cheap: &["planar", "planar-soft", "projected", "blob"],
        ..Case::EXACT
    },
];

/// Boxes, balls and fins that stand apart.
fn crowd(random: &mut Random) -> Vec<Situation> {
    let shapes = [shapes::cube(), shapes::sphere(10), shapes::fins(3)];
    (0..2)
        .map(|turn| {
            let light = either(random, turn);
            let what = if light.w == 0.0 { "sun" } else { "lamp" };
            let mut situation = Situation::new(what, light, random);
            for n in 0..9_u16 {
                let (x, z) = (f32::from(n % 3) * 2.2 - 2.2, f32::from(n / 3) * 2.2 - 2.2);
                let place = at(x, 0.9, z) * Affine3A::from_scale(Vec3::splat(0.45));
                situation = situation.caster(&shapes[usize::from(n) % 3], place);
            }
            situation
        })
        .collect()
}
