//! Many shadows in one texture, and their mip levels.

use super::ask::{Point, ask, ask_changed};
use super::{drawn, lit};
use crate::common::shapes::{Random, square};
use host::gpu::Gpu;
use shadows::glam::{Affine3A, Vec3};
use shadows::{DirectionalLight, ProjectedCaster, Projector};

/// Casters of a few projectors, all under the same sun, each filling its tile but for the margin; the one in
/// the middle of the frame is a small square in a corner of what its tile holds.
fn neighbours(gpu: &Gpu) -> Vec<Vec<ProjectedCaster>> {
    let full = square(4.0).mesh(&gpu.device);
    let caster = |size: f32, at: Vec3| {
        let scale = Affine3A::from_scale(Vec3::splat(size / 4.0));
        let transform = Affine3A::from_translation(at) * scale;
        ProjectedCaster::opaque(shadows::Caster::new(full.clone(), transform))
    };
    let corner = |x: f32, z: f32| caster(0.25, Vec3::new(x, 3.0, z));
    (0..9)
        .map(|index| match index {
            4 => vec![corner(-3.75, -3.75), corner(3.75, 3.75)],
            _ => vec![caster(4.0, Vec3::Y * 3.0)],
        })
        .collect()
}

/// All over a tile and around it, seen through pixels of all sizes.
fn points() -> Vec<Point> {
    let mut random = Random::new(3);
    let point = |index: usize, random: &mut Random| {
        let pixel = 8.0 / 64.0 * ((index % 15) as f32 * 0.5).exp2();
        let position = Vec3::new(random.next(), 0.0, random.next()) * 4.6;
        Point::at(position).seen(Vec3::X * pixel, Vec3::Z * pixel)
    };
    (0..3000).map(|index| point(index, &mut random)).collect()
}

#[test]
fn no_tile_bleeds_into_its_neighbours_on_any_mip_level() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = neighbours(&gpu);
    let light = DirectionalLight::new(Vec3::Y);
    let projector = |casters| Projector::new(light, casters).with_size(64);
    let projectors: Vec<Projector<'_>> = casters.iter().map(|casters| projector(casters)).collect();
    let together = drawn(&gpu, &projectors);
    let alone = drawn(&gpu, &projectors[4..5]);
    assert_eq!(
        (together.statistics().texels, together.statistics().layers),
        (9 * 4096, 1)
    );
    let points = points();
    let expected = ask(&gpu, &alone, 0, &points);
    assert_eq!(ask(&gpu, &together, 4, &points), expected);
    let values = lit(&expected);
    assert!(values.iter().filter(|lit| **lit < 0.999).count() > 300);
    // The broken twin: as a sampler blends by itself, up to the tile's edge and beyond.
    let twin = ask_changed(&gpu, &together, 4, &points, |module| {
        let clamp = "clamp(at, vec2f(0.5), vec2f(side - 0.5))";
        assert!(module.contains(clamp));
        module.replace(clamp, "at")
    });
    let bled = lit(&twin).into_iter().zip(&values);
    let bled = bled.filter(|(twin, right)| (twin - **right).abs() > 0.1);
    assert!(bled.count() > 300);
}

#[test]
fn a_pixel_sees_the_mean_of_what_it_covers() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mesh = square(1.0).mesh(&gpu.device);
    let mut random = Random::new(9);
    let casters: Vec<ProjectedCaster> = (0..40)
        .map(|_| {
            let at = Vec3::new(
                random.next() * 3.8,
                3.0 + random.next(),
                random.next() * 3.8,
            );
            let size = Vec3::splat(0.15 + 0.1 * random.next());
            let transform = Affine3A::from_translation(at) * Affine3A::from_scale(size);
            ProjectedCaster::opaque(shadows::Caster::new(mesh.clone(), transform))
        })
        .collect();
    let light = DirectionalLight::new(Vec3::Y);
    let shadow = drawn(&gpu, &[Projector::new(light, &casters).with_size(128)]);
    let clip = shadow.clip_from_world(0).unwrap();
    let texel = 2.0 / 128.0 / clip.transform_vector3(Vec3::X).x.abs();
    // Over a square of texels, by the finest level at their centres and by one level at its middle.
    let origin = clip.inverse().project_point3(Vec3::ZERO) * Vec3::new(1.0, 0.0, 1.0);
    let mut without = 0.0_f32;
    for level in 1..=5 {
        let width = 1 << level;
        let corner = |step: i32| (step * width) as f32 * texel;
        for (i, k) in (0..16).map(|at| (at % 4 - 2, at / 4 - 2)) {
            let centre = |at: i32| corner(0) + (at as f32 + 0.5) * texel;
            let fine: Vec<Point> = (0..width * width)
                .map(|at| {
                    Vec3::new(
                        corner(i) + centre(at % width),
                        0.0,
                        corner(k) + centre(at / width),
                    )
                })
                .map(|at| Point::at(origin + at))
                .collect();
            let mean =
                lit(&ask(&gpu, &shadow, 0, &fine)).iter().sum::<f32>() / (width * width) as f32;
            let middle =
                Vec3::new(corner(i), 0.0, corner(k)) + Vec3::new(1.0, 0.0, 1.0) * corner(1) * 0.5;
            let pixel = texel * width as f32;
            let coarse = Point::at(origin + middle).seen(Vec3::X * pixel, Vec3::Z * pixel);
            let seen = lit(&ask(
                &gpu,
                &shadow,
                0,
                &[coarse, Point::at(origin + middle)],
            ));
            // Half a step of the format for each level, and the sampler's own.
            let steps = (0.5 * level as f32 + 1.5) / 255.0;
            assert!(
                (seen[0] - mean).abs() < steps,
                "{level} {i} {k}: {} {mean}",
                seen[0]
            );
            without = without.max((seen[1] - mean).abs());
        }
    }
    // The broken twin: without levels a pixel sees one texel.
    assert!(without > 0.3, "{without}");
}
