//! What is drawn of a volume is the renderer's choice; what it shadows is not.

use host::one_light::{OneLight, PrepareOne as _};
use shadows::glam::{Affine3A, Quat, Vec3};
use shadows::{
    Caps, Caster, Counter, DepthConvention, Extrusion, HomogeneousLight, Method,
    ShadowVolumeRenderer, Silhouettes, StartFrom, VolumeStatistics, wgpu,
};

use crate::pictures::{at, lamp, mixed, sun};
use crate::shapes;
use crate::stage::{Body, Lens, Savings, Stage};
use host::gpu::Gpu;

pub const TEXTBOOK: Savings = Savings {
    method: Method::ZFail,
    caps: Caps::Full,
    extrusion: Extrusion::Infinite,
    unculled: true,
    silhouettes: Silhouettes::Auto,
    start_from: StartFrom::LightFacing,
    counter: Counter::Stencil,
};

/// Every convention that the device can draw.
pub fn depths(gpu: &Gpu) -> Vec<DepthConvention> {
    let mut depths = vec![DepthConvention::InfiniteReverse];
    if gpu
        .device
        .features()
        .contains(wgpu::Features::DEPTH_CLIP_CONTROL)
    {
        depths.extend([DepthConvention::FiniteReverse, DepthConvention::Standard]);
    }
    depths
}

/// The picture and what it took.
fn draw(gpu: &Gpu, stage: &Stage, savings: Savings) -> (Vec<u8>, VolumeStatistics) {
    let stage = Stage {
        savings,
        ..stage.clone()
    };
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    let casters = stage.casters(gpu);
    let picture = stage.draw_with(gpu, &mut renderer, &casters);
    (picture, renderer.statistics())
}

/// A picture with savings is right, and so is the textbook's; what the savings came to.
fn assert_as_textbook(
    gpu: &Gpu,
    stage: &Stage,
    savings: Savings,
    what: &str,
) -> [VolumeStatistics; 2] {
    let truth = stage.truth();
    let (picture, statistics) = draw(gpu, stage, savings);
    let (full, textbook) = draw(gpu, stage, TEXTBOOK);
    let found = truth.errors(&picture);
    assert!(found.lit > 100 && found.shadowed > 100, "{what}: {found:?}");
    assert_eq!(found.wrong, 0, "{what}: {found:?}");
    assert_eq!(truth.errors(&full).wrong, 0, "{what}, textbook");
    let differ = picture.iter().zip(&full).filter(|(a, b)| a != b).count();
    assert!(differ <= picture.len() / 10_000, "{what}: {differ} differ");
    [statistics, textbook]
}

#[test]
fn a_caster_beside_the_way_to_the_light_is_counted_in_front() {
    let Some(gpu) = Gpu::for_test() else { return };
    for depth in depths(&gpu) {
        for light in [lamp(), sun()] {
            let stage = Stage {
                depth,
                ..mixed(light)
            };
            let what = format!("{depth:?}, {light:?}");
            let [auto, textbook] = assert_as_textbook(&gpu, &stage, Savings::default(), &what);
            assert_eq!((auto.casters_z_pass, auto.casters_z_fail), (2, 0), "{what}");
            assert_eq!(textbook.casters_z_fail, 2, "{what}");
            assert!(auto.draws < textbook.draws, "{what}");
        }
    }
}

/// A camera looking along -z at the ground, and a sheet between it and the light.
fn shaded_camera(light: HomogeneousLight, sheet: Vec3) -> Stage {
    Stage {
        eye: Vec3::new(0.0, 2.0, 4.0),
        target: Vec3::new(0.0, 0.0, -2.0),
        ..Stage::new(
            light,
            vec![
                Body::caster(
                    shapes::square(0.8).tilted(),
                    Affine3A::from_translation(sheet),
                ),
                Body::caster(shapes::cube(), at(-1.5, 1.0, -3.0)),
            ],
        )
    }
}

#[test]
fn a_caster_between_near_plane_and_light_is_counted_behind_and_forced_z_pass_is_wrong() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut forced_and_wrong = Vec::new();
    for light in [
        HomogeneousLight::point(Vec3::new(0.3, 6.0, 4.5)),
        HomogeneousLight::directional(Vec3::new(0.3, 1.0, 0.2)),
    ] {
        for lens in [Lens::Perspective, Lens::Orthographic] {
            for depth in depths(&gpu) {
                if lens == Lens::Orthographic && depth == DepthConvention::InfiniteReverse {
                    continue;
                }
                let stage = Stage {
                    depth,
                    lens,
                    ..shaded_camera(light, Vec3::new(0.0, 3.5, 4.0))
                };
                let what = format!("{light:?}, {lens:?}, {depth:?}");
                let [auto, _] = assert_as_textbook(&gpu, &stage, Savings::default(), &what);
                assert!(auto.casters_z_fail >= 1, "{what}");
                assert!(
                    lens == Lens::Orthographic || auto.casters_z_pass == 1,
                    "{what}"
                );
                let forced = Savings {
                    method: Method::ZPass,
                    ..Default::default()
                };
                let (wrong, statistics) = draw(&gpu, &stage, forced);
                assert_eq!(statistics.casters_z_fail, 0);
                let wrong = stage.truth().errors(&wrong).wrong;
                forced_and_wrong.push((what, wrong));
            }
        }
    }
    eprintln!("{forced_and_wrong:#?}");
    assert!(
        forced_and_wrong.iter().all(|(_, wrong)| *wrong > 300),
        "{forced_and_wrong:#?}"
    );
}

#[test]
fn rays_start_at_the_eye_where_near_faces_are_not_cut() {
    let without = wgpu::Features::CLIP_DISTANCES;
    let Some(gpu) = Gpu::for_test_without(without) else {
        return;
    };
    for depth in depths(&gpu) {
        let stage = a_shadow_between_the_eye_and_the_near_plane(depth);
        let what = format!("{depth:?}");
        let [auto, _] = assert_as_textbook(&gpu, &stage, Savings::default(), &what);
        assert!(auto.casters_z_fail > 0, "{what}");
        let wrong = wrong_by_forced_z_pass(&gpu, &stage);
        assert_eq!(wrong > 300, depth.clips_far(), "{what}: {wrong}");
        assert!(depth.clips_far() || wrong == 0, "{what}: {wrong}");
    }
}

#[test]
fn rays_start_at_the_near_plane_where_faces_are_cut_there() {
    let Some(gpu) = Gpu::for_test() else { return };
    if !(gpu.device.features()).contains(wgpu::Features::CLIP_DISTANCES) {
        eprintln!("skipped: no clip distances");
        return;
    }
    for depth in depths(&gpu) {
        let stage = a_shadow_between_the_eye_and_the_near_plane(depth);
        assert_as_textbook(&gpu, &stage, Savings::default(), &format!("{depth:?}"));
        let wrong = wrong_by_forced_z_pass(&gpu, &stage);
        assert_eq!(wrong, 0, "{depth:?}");
    }
}

fn wrong_by_forced_z_pass(gpu: &Gpu, stage: &Stage) -> usize {
    let forced = Savings {
        method: Method::ZPass,
        ..Default::default()
    };
    stage.truth().errors(&draw(gpu, stage, forced).0).wrong
}

fn a_shadow_between_the_eye_and_the_near_plane(depth: DepthConvention) -> Stage {
    // The near rectangle is far from the eye, and one of two sheets above the space between them.
    let light = HomogeneousLight::directional(Vec3::new(0.5, 1.0, 0.0));
    let mut sheets = shapes::square(0.8);
    for position in &mut sheets.positions {
        position[2] *= 0.5;
    }
    let mut farther = sheets.clone();
    for position in &mut farther.positions {
        position[2] -= 6.0;
    }
    let sheets = sheets.with(&farther);
    let mut stage = shaded_camera(light, Vec3::new(0.5, 3.0, 3.85));
    stage.bodies[1].shape = sheets;
    (stage.depth, stage.near) = (depth, 2.0);
    stage
}

#[test]
fn a_fan_over_the_silhouette_is_as_good_as_the_full_dark_cap() {
    let Some(gpu) = Gpu::for_test() else { return };
    let savings = Savings {
        method: Method::ZFail,
        ..Default::default()
    };
    let low = HomogeneousLight::point(Vec3::new(-3.5, 1.2, 0.4));
    let ring = shapes::sphere(12).cut(|corners| corners.iter().all(|c| c.y.abs() < 0.7));
    for shape in [
        shapes::sphere(12),
        shapes::fins(4),
        ring,
        shapes::sphere(8).turned(|t| t % 3 == 0),
    ] {
        for light in [lamp(), low] {
            // The eye in the volume, looking out through its far end.
            for (eye, target) in [
                (Vec3::new(1.0, 5.0, 9.0), Vec3::new(0.0, 0.5, 0.0)),
                (Vec3::new(1.0, 0.3, -1.2), Vec3::new(6.0, 0.0, -1.0)),
            ] {
                let wall = Affine3A::from_rotation_translation(
                    Quat::from_rotation_z(1.5),
                    Vec3::new(12.0, 0.0, 0.0),
                );
                let mut stage = Stage {
                    eye,
                    target,
                    ..Stage::new(light, vec![Body::caster(shape.clone(), at(0.0, 1.1, 0.0))])
                };
                stage
                    .bodies
                    .push(Body::receiver(shapes::square(20.0), wall));
                let what = format!("{light:?}, {eye}");
                let [fan, full] = assert_as_textbook(&gpu, &stage, savings, &what);
                assert!(fan.draws < full.draws || fan.draws == 3, "{what}: {fan:?}");
            }
        }
    }
}

#[test]
fn a_light_among_the_triangles_gets_the_full_cap() {
    let Some(gpu) = Gpu::for_test() else { return };
    let room = shapes::cube().cut(|corners| corners.iter().any(|c| c.y > -0.5));
    let stage = Stage::new(
        HomogeneousLight::point(Vec3::new(0.1, 2.0, 0.2)),
        vec![Body::caster(room, at(0.0, 2.0, 0.0))],
    );
    let [auto, _] = assert_as_textbook(&gpu, &stage, Savings::default(), "room");
    // Sides, and both lists of light and dark caps: no fan.
    assert_eq!((auto.draws, auto.casters_z_fail), (5, 1));
}

#[test]
fn a_directional_lights_volume_needs_no_dark_cap() {
    let Some(gpu) = Gpu::for_test() else { return };
    let savings = Savings {
        method: Method::ZFail,
        ..Default::default()
    };
    for depth in depths(&gpu) {
        let stage = Stage {
            depth,
            ..mixed(sun())
        };
        let [bare, full] = assert_as_textbook(&gpu, &stage, savings, &format!("{depth:?}"));
        assert!(bare.draws < full.draws);
    }
}

#[test]
fn what_cannot_shadow_the_view_is_skipped_and_what_can_is_not() {
    let Some(gpu) = Gpu::for_test() else { return };
    // The sun is low on the right: a caster there, out of sight, shadows what is in sight.
    let light = HomogeneousLight::directional(Vec3::new(0.8, 0.6, 0.2));
    let small = Affine3A::from_scale(Vec3::splat(0.6));
    let sphere = shapes::sphere(8);
    let right = Body::caster(sphere.clone(), at(6.5, 4.5, 0.0) * small);
    let stage = Stage::new(light, vec![right]);
    let [auto, _] = assert_as_textbook(&gpu, &stage, Savings::default(), "right");
    assert_eq!((auto.casters_drawn, auto.casters_skipped), (1, 0));
    // Those on the left and behind the camera do not.
    let away = [at(-15.0, 1.0, 0.0), at(-12.0, 6.0, 4.0), at(1.0, 1.0, 30.0)];
    let mut more = stage.clone();
    more.bodies
        .extend(away.map(|place| Body::caster(sphere.clone(), place * small)));
    let [auto, textbook] = assert_as_textbook(&gpu, &more, Savings::default(), "away");
    assert_eq!((auto.casters_drawn, auto.skipped_out_of_view), (1, 3));
    assert_eq!((textbook.casters_drawn, textbook.casters_skipped), (4, 0));
    // The twin: the caster that is drawn is needed.
    let forgotten = Stage::new(light, Vec::new()).draw(&gpu);
    assert!(stage.truth().errors(&forgotten).wrong > 50);
}

#[test]
fn a_volume_cut_off_at_the_range_shadows_all_within_it() {
    let Some(gpu) = Gpu::for_test() else { return };
    // A wide caster close to the light: chords of a sphere of the range would cut deep into it.
    let light = HomogeneousLight::point(Vec3::new(0.0, 2.0, 0.0));
    let casters = vec![
        Body::caster(shapes::square(1.2), at(0.0, 1.5, 0.2)),
        Body::caster(shapes::cube().tilted(), at(3.5, 1.0, -1.0)),
        Body::caster(shapes::cube(), at(-5.0, 1.0, 0.0)),
    ];
    for depth in depths(&gpu) {
        for method in [Method::Auto, Method::ZFail] {
            for eye in [Vec3::new(1.0, 5.0, 9.0), Vec3::new(0.0, 9.0, -14.0)] {
                let stage = Stage {
                    range: Some(6.0),
                    depth,
                    eye,
                    field_of_view: 1.6,
                    ..Stage::new(light, casters.clone())
                };
                let savings = Savings {
                    method,
                    extrusion: Extrusion::ToRange,
                    ..Default::default()
                };
                let what = format!("{depth:?}, {method:?}, {eye}");
                assert_within_range(&gpu, &stage, savings, &what);
            }
        }
    }
}

/// Right within the range, and cut off beyond it: other pixels than with infinite volumes.
fn assert_within_range(gpu: &Gpu, stage: &Stage, savings: Savings, what: &str) {
    let truth = stage.truth();
    let (cut, _) = draw(gpu, stage, savings);
    let found = truth.errors(&cut);
    assert!(found.lit > 300 && found.shadowed > 300, "{what}: {found:?}");
    assert_eq!(found.wrong, 0, "{what}: {found:?}");
    // The twin: a light that reaches farther than the renderer was told.
    let mut farther = stage.clone();
    farther.range = Some(30.0);
    let missed = farther.truth().errors(&cut).wrong;
    assert!(missed > 20, "{what}: {missed}");
}

#[test]
fn the_scissor_spares_what_the_light_does_not_reach() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage {
        range: Some(3.0),
        ..Stage::new(
            HomogeneousLight::point(Vec3::new(0.0, 1.5, 0.0)),
            vec![Body::caster(shapes::sphere(8), {
                at(0.8, 0.9, 0.3) * Affine3A::from_scale(Vec3::splat(0.4))
            })],
        )
    };
    let truth = stage.truth();
    let endless = Savings {
        extrusion: Extrusion::Infinite,
        ..Default::default()
    };
    let (clipped, _) = draw(&gpu, &stage, endless);
    let whole = Savings {
        unculled: true,
        ..endless
    };
    let (unclipped, _) = draw(&gpu, &stage, whole);
    for picture in [&clipped, &unclipped] {
        let found = truth.errors(picture);
        assert!(found.lit > 1000 && found.shadowed > 100, "{found:?}");
        assert_eq!(found.wrong, 0, "{found:?}");
    }
    // The shadow runs on beyond the range, and only the unclipped picture has it there.
    let dark = |picture: &[u8]| picture.iter().filter(|&&v| v == 0).count();
    assert!(dark(&clipped) < dark(&unclipped));
    // The twin: clipped to a light elsewhere, a part of the shadow is missing.
    let mut elsewhere = stage.clone();
    elsewhere.range = Some(1.2);
    let (broken, _) = draw(&gpu, &elsewhere, endless);
    assert!(truth.errors(&broken).wrong > 50);
}

#[test]
fn casters_are_sorted_by_what_becomes_of_them() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = shaded_camera(
        HomogeneousLight::point(Vec3::new(0.3, 6.0, 4.5)),
        Vec3::new(0.0, 3.5, 4.0),
    );
    let mut casters = stage.casters(&gpu);
    let extra = |place| Caster::new(casters[1].mesh.clone(), place);
    let extra = [extra(at(0.0, 1.0, 500.0)), extra(at(90.0, 1.0, -20.0))];
    casters.extend(extra);
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    let view = stage.view();
    let frame = OneLight {
        range: Some(400.0),
        ..OneLight::new(&view, stage.light, &casters)
    };
    renderer
        .prepare_one(&gpu.device, &gpu.queue, &frame)
        .unwrap();
    let s = renderer.statistics();
    assert_eq!((s.casters_drawn, s.casters_skipped), (2, 2));
    assert_eq!((s.casters_z_pass, s.casters_z_fail), (1, 1));
    assert_eq!((s.skipped_out_of_range, s.skipped_out_of_view), (1, 1));
    assert_eq!(s.skipped_empty, 0);
}
