//! Where shadow volumes usually break.

use shadows::glam::camera::rh::{proj::directx as proj, view};
use shadows::glam::{Affine3A, Quat, Vec3};
use shadows::{
    Caps, DepthConvention, Extrusion, HomogeneousLight, Method, ShadowVolumeDescriptor,
    ShadowVolumeRenderer, Silhouettes, View, wgpu,
};

use crate::pictures::{assert_exact, at, lamp, mixed, sun};
use crate::shapes;
use crate::stage::{Body, Savings, Stage, WAYS};
use host::gpu::Gpu;

/// The stage with its silhouettes found in this way.
fn by(stage: &Stage, silhouettes: Silhouettes) -> Stage {
    let mut stage = stage.clone();
    stage.savings.silhouettes = silhouettes;
    stage
}

#[test]
fn a_light_inside_a_closed_caster_is_seen_through_its_hole_only() {
    let Some(gpu) = Gpu::for_test() else { return };
    // Closed around the light, seen from outside: everything outside is in shadow. A second, small
    // caster inside keeps the inside from being trivial, and the eye looks in from outside.
    let light = HomogeneousLight::point(Vec3::new(0.1, 2.0, 0.2));
    let room = Body::caster(shapes::cube(), at(0.0, 2.0, 0.0));
    let dark = Stage::new(light, vec![room.clone()]);
    let truth = dark.truth();
    let found = truth.errors(&dark.draw(&gpu));
    assert!(found.lit == 0 && found.shadowed > 10_000, "{found:?}");
    assert_eq!(found.wrong, 0, "{found:?}");

    let lid = |corners: [Vec3; 3]| corners.iter().any(|c| c.y > -0.5);
    let mut holed = room;
    holed.shape = shapes::cube().cut(lid);
    assert_exact(
        &gpu,
        &Stage::new(light, vec![holed]),
        "a room without a floor",
    );
}

#[test]
fn light_and_eye_may_be_inside_a_closed_caster() {
    let Some(gpu) = Gpu::for_test() else { return };
    for shape in [shapes::cube(), shapes::cube().reversed()] {
        let stage = Stage {
            eye: Vec3::new(2.5, 3.0, 2.8),
            target: Vec3::new(-1.0, 0.5, -1.0),
            field_of_view: 1.5,
            ..Stage::new(
                HomogeneousLight::point(Vec3::new(-1.5, 4.5, 0.5)),
                vec![
                    Body::caster(shape, Affine3A::from_scale(Vec3::splat(6.0))),
                    Body::caster(shapes::cube().tilted(), at(0.0, 1.8, 0.0)),
                ],
            )
        };
        assert_exact(&gpu, &stage, "room");
    }
}

#[test]
fn a_light_in_the_plane_of_a_triangle_keeps_the_volume_closed() {
    let Some(gpu) = Gpu::for_test() else { return };
    let plane = Affine3A::from_rotation_x(std::f32::consts::FRAC_PI_2);
    let sheet = Body::caster(shapes::square(1.0), at(0.0, 1.5, 0.0) * plane);
    for light in [
        HomogeneousLight::point(Vec3::new(-2.0, 6.0, 0.0)),
        HomogeneousLight::directional(Vec3::new(-0.4, 1.0, 0.0)),
    ] {
        let cube = Body::caster(shapes::cube(), at(1.5, 1.5, -1.0));
        let stage = Stage::new(light, vec![sheet.clone(), cube]);
        assert_exact(&gpu, &stage, &format!("{light:?}"));
    }
}

#[test]
fn a_light_on_a_vertex_or_an_edge_leaves_the_rest_right() {
    let Some(gpu) = Gpu::for_test() else { return };
    for shape in [shapes::cube(), shapes::square(1.0)] {
        for corner in [Vec3::new(-1.0, 3.0, 1.0), Vec3::new(0.0, 3.0, 1.0)] {
            let down = if shape.positions.len() == 4 { 3.0 } else { 2.0 };
            let stage = Stage::new(
                HomogeneousLight::point(corner),
                vec![
                    Body::caster(shape.clone(), at(0.0, down, 0.0)),
                    Body::caster(shapes::sphere(10), at(-2.5, 0.8, 1.5)),
                ],
            );
            assert_exact(&gpu, &stage, &format!("light at {corner}"));
        }
    }
}

#[test]
fn a_light_just_above_a_caster_casts_the_whole_shadow() {
    let Some(gpu) = Gpu::for_test() else { return };
    for height in [1e-1, 1e-3, 1e-4] {
        let light = HomogeneousLight::point(Vec3::new(0.1, 1.0 + height, 0.2));
        let small = Affine3A::from_scale(Vec3::splat(0.7));
        let stage = Stage::new(
            light,
            vec![
                Body::caster(shapes::square(1.0), at(0.0, 1.0, 0.0)),
                Body::caster(shapes::sphere(10), at(-1.5, 2.5, -1.0) * small),
            ],
        );
        let truth = stage.truth();
        let found = truth.errors(&stage.draw(&gpu));
        assert!(found.shadowed > 10_000, "{height}: {found:?}");
        assert_eq!(found.wrong, 0, "{height}: {found:?}");
    }
}

#[test]
fn slivers_and_repeated_corners_change_nothing() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = mixed(lamp());
    let mut more = stage.clone();
    let shape = &mut more.bodies[1].shape;
    let first = shape.positions.len() as u32;
    shape.positions.extend([
        [0.0, 0.0, 0.0],
        [0.5, 0.5, 0.0],
        [0.25, 0.25, 0.0],
        [0.2, 0.9, 0.1],
        [0.2, 0.9, 0.1],
    ]);
    shape
        .indices
        .extend([0, 1, 2, 0, 0, 1, 2, 3, 4].map(|i| first + i));
    let found = stage.truth().errors(&more.draw(&gpu));
    assert!(found.interior > 10_000, "{found:?}");
    assert_eq!(found.wrong, 0, "{found:?}");
}

#[test]
fn slivers_of_aspect_a_million_cast_no_streaks() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut shape = shapes::square(1.2);
    let first = shape.positions.len() as u32;
    shape
        .positions
        .extend([[-1.1, 0.6, -0.4], [1.1, 0.7, 0.5], [1.1, 0.7, 0.500_002_2]]);
    shape.indices.extend([first, first + 1, first + 2]);
    for light in [lamp(), sun()] {
        let stage = Stage::new(light, vec![Body::caster(shape.clone(), at(0.0, 1.0, 0.0))]);
        assert_exact(&gpu, &stage, "sliver");
    }
}

#[test]
fn the_near_plane_may_cut_a_volume() {
    let Some(gpu) = Gpu::for_test() else { return };
    // The edge of the square's shadow runs down at z = 0.6; the near rectangle slides through it.
    let light = HomogeneousLight::directional(Vec3::new(0.0, 1.0, 0.0));
    for step in 0..5 {
        for degrees in [30.0f32, 60.0, 90.0, 120.0, 150.0] {
            let eye = Vec3::new(0.0, 1.2, 1.3 + 0.05 * step as f32);
            let stage = Stage {
                eye,
                target: eye + Vec3::new(0.1, -0.6, -1.0),
                field_of_view: degrees.to_radians(),
                near: 0.2,
                ..Stage::new(
                    light,
                    vec![Body::caster(shapes::square(1.2), at(0.0, 2.0, 0.0))],
                )
            };
            let truth = stage.truth();
            for silhouettes in WAYS {
                let found = truth.errors(&by(&stage, silhouettes).draw(&gpu));
                let what = format!("{step}, {degrees}, {silhouettes:?}: {found:?}");
                assert!(found.interior > 1_000, "{what}");
                assert_eq!(found.wrong, 0, "{what}");
            }
        }
    }
}

#[test]
fn scale_does_not_matter() {
    let Some(gpu) = Gpu::for_test() else { return };
    for scale in [1e-4f32, 1e5] {
        let mut stage = mixed(lamp());
        stage.light = HomogeneousLight::point(stage.light.xyzw().truncate() * scale);
        stage.eye *= scale;
        stage.target *= scale;
        stage.near *= scale;
        for body in &mut stage.bodies {
            for position in &mut body.shape.positions {
                *position = position.map(|x| x * scale);
            }
            body.transform.translation *= scale;
        }
        for silhouettes in WAYS {
            let stage = by(&stage, silhouettes);
            assert_exact(&gpu, &stage, &format!("scale {scale}, {silhouettes:?}"));
        }
    }
}

#[test]
fn a_receiver_may_be_a_million_times_as_far_as_the_near_plane() {
    let Some(gpu) = Gpu::for_test() else { return };
    let format = wgpu::TextureFormat::Depth32FloatStencil8;
    if !gpu.device.features().contains(format.required_features()) {
        return;
    }
    // The scene is some 10 units away. Depths of 1e-6 want floats: 24 bits leave 16 steps up to there.
    for light in [lamp(), sun()] {
        let stage = Stage {
            near: 1e-5,
            format,
            ..mixed(light)
        };
        for silhouettes in WAYS {
            let stage = by(&stage, silhouettes);
            assert_exact(&gpu, &stage, &format!("{light:?}, {silhouettes:?}"));
        }
        // The usual projection has no depths left there.
        if crate::choices::depths(&gpu).contains(&DepthConvention::Standard) {
            let projection = proj::perspective(stage.field_of_view, 1.0, stage.near, 1e4);
            let camera = view::look_at_mat4(stage.eye, stage.target, Vec3::Y);
            let depth = DepthConvention::Standard;
            let standard = Stage {
                depth,
                placed_view: View::new(projection * camera, depth).ok(),
                ..stage
            };
            let wrong = standard.truth().errors(&standard.draw(&gpu)).wrong;
            assert!(wrong > 500, "{wrong}");
        }
    }
}

#[test]
fn a_renderer_is_used_again_frame_after_frame() {
    let Some(gpu) = Gpu::for_test() else { return };
    let descriptor = ShadowVolumeDescriptor::default();
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &descriptor).unwrap();
    let turned = Affine3A::from_quat(Quat::from_rotation_y(0.9));
    let mut more = mixed(sun());
    more.bodies.extend((0..20).map(|i| {
        let place = at(-3.0 + 0.3 * i as f32, 0.5, -3.0) * turned;
        Body::caster(
            shapes::sphere(8),
            place * Affine3A::from_scale(Vec3::splat(0.3)),
        )
    }));
    let bare = Stage::new(lamp(), Vec::new());
    for stage in [&mixed(lamp()), &more, &bare, &mixed(sun()), &more] {
        let casters = stage.casters(&gpu);
        let picture = stage.draw_with(&gpu, &mut renderer, &casters);
        let found = stage.truth().errors(&picture);
        assert!(found.interior > 10_000 && found.wrong == 0, "{found:?}");
        let drawn = renderer.statistics().casters_drawn as usize;
        assert_eq!(drawn, casters.len());
    }
}

#[test]
fn recording_twice_counts_once() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = mixed(lamp());
    let descriptor = ShadowVolumeDescriptor::default();
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &descriptor).unwrap();
    let casters = stage.casters(&gpu);
    let once = stage.draw_with(&gpu, &mut renderer, &casters);
    gpu.run(|encoder| renderer.encode(encoder));
    let again = stage.redraw(&gpu, &mut renderer);
    assert_eq!(stage.truth().errors(&again).wrong, 0);
    assert!(once == again);
}

#[test]
fn a_colour_target_of_the_pass_is_left_alone() {
    let Some(gpu) = Gpu::for_test() else { return };
    let formats = [Some(wgpu::TextureFormat::Rgba8Unorm)];
    let descriptor = ShadowVolumeDescriptor {
        color_formats: &formats,
        ..Default::default()
    };
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &descriptor).unwrap();
    let stage = mixed(lamp());
    let (picture, color) = stage.draw_with_color(&gpu, &mut renderer, formats[0].unwrap());
    assert_eq!(stage.truth().errors(&picture).wrong, 0);
    assert!(color.chunks(4).all(|texel| texel == [255, 0, 0, 255]));
}

/// Where no range and no receivers end them, volumes of an orthographic view end where clip w is 0, and
/// their depths have no bound.
#[test]
fn orthographic_views_see_whole_volumes_wherever_their_near_plane_is() {
    let Some(gpu) = Gpu::for_test() else { return };
    let overhead = HomogeneousLight::point(Vec3::new(0.3, 7.0, 0.2));
    let steep = HomogeneousLight::directional(Vec3::new(0.15, 1.0, 0.1));
    let formats = [
        wgpu::TextureFormat::Depth24PlusStencil8,
        wgpu::TextureFormat::Depth32FloatStencil8,
    ];
    let has =
        |format: &wgpu::TextureFormat| gpu.device.features().contains(format.required_features());
    let savings = [
        (Method::Auto, Extrusion::ToRange, Caps::AsNeeded),
        (Method::ZFail, Extrusion::Infinite, Caps::AsNeeded),
        (Method::ZFail, Extrusion::Infinite, Caps::Full),
        (Method::Auto, Extrusion::Infinite, Caps::AsNeeded),
    ];
    let mut ways = WAYS.into_iter().cycle();
    let mut wrong = Vec::new();
    for (view, depth, light) in orthographic_views(&gpu, [lamp(), sun(), overhead, steep]) {
        let stage = Stage {
            depth,
            placed_view: Some(view),
            ..mixed(light)
        };
        let truth = stage.truth();
        for (method, extrusion, caps) in savings {
            for format in formats.into_iter().filter(has) {
                let mut stage = Stage {
                    format,
                    ..by(&stage, ways.next().unwrap())
                };
                let unculled = caps == Caps::Full;
                stage.savings = Savings {
                    method,
                    extrusion,
                    caps,
                    unculled,
                    ..stage.savings
                };
                let found = truth.errors(&stage.draw(&gpu));
                assert!(found.interior > 10_000 && found.shadowed > 30, "{found:?}");
                if found.wrong > 0 {
                    let what = (light.xyzw(), depth, format, stage.savings, found.wrong);
                    wrong.push(format!("{what:?}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Cameras in the middle of the casters that see what is behind them, one of them straight down.
fn orthographic_views(
    gpu: &Gpu,
    lights: [HomogeneousLight; 4],
) -> Vec<(View, DepthConvention, HomogeneousLight)> {
    let ends = [
        (-20.0, 30.0),
        (-50.0, 20.0),
        (-1000.0, 40.0),
        (-30.0, 300.0),
    ];
    let cameras = [
        view::look_at_mat4(Vec3::new(0.5, 1.5, 1.0), Vec3::new(0.2, 1.0, -0.2), Vec3::Y),
        view::look_at_mat4(Vec3::new(0.1, 2.0, 0.2), Vec3::new(0.1, 0.0, 0.2), Vec3::X),
    ];
    let finite = crate::choices::depths(gpu).into_iter();
    let finite = finite.filter(|depth| *depth != DepthConvention::InfiniteReverse);
    finite
        .flat_map(|depth| cameras.map(|camera| (depth, camera)))
        .flat_map(|(depth, camera)| {
            lights
                .into_iter()
                .zip(ends)
                .map(move |(light, (near, far))| {
                    let (zero, one) = match depth {
                        DepthConvention::Standard => (near, far),
                        _ => (far, near),
                    };
                    let projection = proj::orthographic(-4.0, 5.0, -5.0, 4.0, zero, one);
                    (View::new(projection * camera, depth).unwrap(), depth, light)
                })
        })
        .collect()
}
