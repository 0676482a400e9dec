//! Coloured and translucent casters.

use super::ask::{Point, ask};
use super::drawn;
use crate::common::shapes::{Random, cuboid, sphere, square};
use host::gpu::Gpu;
use shadows::glam::{Affine3A, Vec3};
use shadows::{Caster, DirectionalLight, Light, PointLight, ProjectedCaster, Projector};

const PANES: [[f32; 3]; 4] = [
    [0.8, 0.4, 0.2],
    [0.5, 0.9, 1.0],
    [0.3, 0.7, 0.6],
    [1.0, 0.25, 0.75],
];

/// Panes one above another, each a little smaller, so that under their middle all four are passed and at the
/// outside one.
fn panes(gpu: &Gpu) -> Vec<ProjectedCaster> {
    let mesh = square(1.0).mesh(&gpu.device);
    let pane = |(index, transmittance): (usize, [f32; 3])| {
        let (size, height) = (4.0 - index as f32, 1.0 + index as f32);
        let transform =
            Affine3A::from_translation(Vec3::Y * height) * Affine3A::from_scale(Vec3::splat(size));
        ProjectedCaster::new(Caster::new(mesh.clone(), transform), transmittance)
    };
    PANES.into_iter().enumerate().map(pane).collect()
}

#[test]
fn what_comes_through_is_multiplied_in_any_order() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = panes(&gpu);
    let light = DirectionalLight::new(Vec3::Y);
    let points: Vec<Point> = (0..5)
        .map(|ring| Point::at(Vec3::new(4.5 - ring as f32, 0.0, 0.1)))
        .collect();
    let picture = |casters: &[ProjectedCaster]| {
        let shadow = drawn(&gpu, &[Projector::new(light, casters)]);
        ask(&gpu, &shadow, 0, &points)
    };
    let seen = picture(&casters);
    let mut expected = [1.0_f32; 3];
    for (ring, seen) in seen.iter().enumerate() {
        if ring > 0 {
            expected = [0, 1, 2].map(|color| expected[color] * PANES[ring - 1][color]);
        }
        for color in 0..3 {
            // Each pane rounds to the format's steps.
            let off = (seen[color] - expected[color]).abs() * 255.0;
            assert!(
                off <= 0.5 * ring as f32 + 0.02,
                "{ring} {color}: {off} steps"
            );
        }
    }
    for order in [[3, 2, 1, 0], [1, 3, 0, 2], [2, 0, 3, 1]] {
        let casters = order.map(|index: usize| casters[index].clone());
        assert_eq!(picture(&casters), seen, "{order:?}");
    }
    // The broken twins: one pane less, and another colour.
    assert_ne!(picture(&casters[1..]), seen);
    let mut other = panes(&gpu);
    other[2].transmittance[1] -= 8.0 / 255.0;
    assert_ne!(picture(&other), seen);
}

#[test]
fn of_a_solid_the_light_is_taken_once_and_of_a_surface_each_time() {
    let Some(gpu) = Gpu::for_test() else { return };
    let quarter = [0.25, 0.5, 0.75];
    let at = Affine3A::from_translation(Vec3::Y * 2.0);
    let mirrored = at * Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    let solids = [cuboid(Vec3::ONE), sphere(9, 16)];
    let lights: [Light; 2] = [
        DirectionalLight::new(Vec3::new(0.1, 1.0, 0.05)).into(),
        PointLight::new(Vec3::new(0.1, 7.0, 0.0), 100.0).into(),
    ];
    let point = [Point::at(Vec3::new(0.1, 0.0, 0.15))];
    let through = |light: Light, caster: Caster| {
        let casters = [ProjectedCaster::new(caster, quarter)];
        let shadow = drawn(&gpu, &[Projector::new(light, &casters)]);
        ask(&gpu, &shadow, 0, &point)[0]
    };
    let steps = |a: [f32; 3], b: [f32; 3]| {
        [0, 1, 2]
            .map(|color: usize| (a[color] - b[color]).abs() * 255.0)
            .into_iter()
            .fold(0.0, f32::max)
    };
    for light in lights {
        for solid in &solids {
            for transform in [at, mirrored] {
                let seen = through(light, solid.caster(&gpu.device, transform));
                assert!(steps(seen, quarter) < 1.0, "{seen:?}");
            }
            // Without its first triangle, which is no solid: both of its sides.
            let mut open = solid.clone();
            open.indices.drain(..3);
            let seen = through(light, open.caster(&gpu.device, at));
            let twice = quarter.map(|part| part * part);
            assert!(steps(seen, twice) < 1.5, "{seen:?} {twice:?}");
            assert!(steps(twice, quarter) > 40.0);
        }
    }
}

#[test]
fn opaque_casters_among_translucent_ones_let_nothing_through() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut casters = panes(&gpu);
    let wall = square(0.5).caster(&gpu.device, Affine3A::from_translation(Vec3::Y * 2.5));
    casters.insert(2, ProjectedCaster::opaque(wall));
    let shadow = drawn(
        &gpu,
        &[Projector::new(DirectionalLight::new(Vec3::Y), &casters)],
    );
    let mut random = Random::new(2);
    let points: Vec<Point> = (0..100)
        .map(|_| Point::at(Vec3::new(random.next(), 0.0, random.next()) * 0.4))
        .collect();
    assert!(
        ask(&gpu, &shadow, 0, &points)
            .iter()
            .all(|seen| *seen == [0.0; 3])
    );
}
