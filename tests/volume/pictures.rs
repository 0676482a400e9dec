//! Meshes, transforms, lights, cameras, formats.

use shadows::glam::{Affine3A, Mat3A, Quat, Vec3, Vec3A};
use shadows::{DepthConvention, HomogeneousLight, Method, ShadowVolumeDescriptor, wgpu};

use crate::passes::Arithmetic;
use crate::shapes::{self, Shape};
use crate::stage::{Body, Lens, Stage};
use host::gpu::Gpu;
use host::scene::moved_light;

pub fn lamp() -> HomogeneousLight {
    HomogeneousLight::point(Vec3::new(-2.0, 6.0, 2.5))
}

pub fn sun() -> HomogeneousLight {
    HomogeneousLight::directional(Vec3::new(-0.4, 1.0, 0.3))
}

pub fn at(x: f32, y: f32, z: f32) -> Affine3A {
    Affine3A::from_translation(Vec3::new(x, y, z))
}

/// Draws, compares, and makes sure that there was something to compare.
pub fn assert_exact(gpu: &Gpu, stage: &Stage, what: &str) {
    let truth = stage.truth();
    let found = truth.errors(&stage.draw(gpu));
    assert!(found.lit > 300 && found.shadowed > 300, "{what}: {found:?}");
    assert!(found.interior > 10_000, "{what}: {found:?}");
    assert_eq!(found.wrong, 0, "{what}: {found:?}");
}

fn assert_shape_exact(shape: Shape, transform: Affine3A, what: &str) {
    let Some(gpu) = Gpu::for_test() else { return };
    for light in [lamp(), sun()] {
        let stage = Stage::new(light, vec![Body::caster(shape.clone(), transform)]);
        assert_exact(&gpu, &stage, &format!("{what}, {light:?}"));
    }
}

#[test]
fn a_sphere_casts_its_shadow() {
    assert_shape_exact(shapes::sphere(24), at(0.0, 1.5, 0.0), "sphere");
    assert_shape_exact(
        shapes::sphere(24).reversed(),
        at(0.0, 1.5, 0.0),
        "inside out",
    );
}

#[test]
fn a_box_on_the_ground_leaves_no_gap() {
    assert_shape_exact(shapes::cube(), at(0.0, 1.0, 0.0), "box");
}

#[test]
fn an_open_square_casts_from_both_sides() {
    let place = at(0.0, 1.5, 0.0);
    assert_shape_exact(shapes::square(1.2), place, "square");
    assert_shape_exact(shapes::square(1.2).reversed(), place, "square, reversed");
    assert_shape_exact(shapes::square(1.2).tilted(), place, "tilted");
}

#[test]
fn an_open_hemisphere_casts_from_both_sides() {
    for up in [1.0, -1.0] {
        let half = shapes::sphere(16).cut(|corners| corners.iter().all(|c| c.y * up > -1e-3));
        assert_shape_exact(half.clone(), at(0.0, 1.2, 0.0), "hemisphere");
        assert_shape_exact(half.reversed(), at(0.0, 1.2, 0.0), "hemisphere, reversed");
    }
}

#[test]
fn fins_on_one_edge_cast_each_its_shadow() {
    for count in [3, 4] {
        assert_shape_exact(shapes::fins(count), at(0.0, 0.5, 0.0), "fins");
    }
}

#[test]
fn mixed_winding_does_not_matter() {
    let sphere = shapes::sphere(16).turned(|triangle| triangle % 2 == 0);
    assert_shape_exact(sphere, at(0.0, 1.5, 0.0), "every other triangle");
    let half = shapes::sphere(16).turned(|triangle| triangle < 512);
    assert_shape_exact(half, at(0.0, 1.5, 0.0), "half of them");
}

#[test]
fn mirrored_and_sheared_transforms_cast_what_they_show() {
    let turn = Quat::from_rotation_z(0.4) * Quat::from_rotation_x(-0.3);
    let scaled =
        |scale| Affine3A::from_scale_rotation_translation(scale, turn, Vec3::new(0.3, 1.8, -0.2));
    let shear = Affine3A {
        matrix3: Mat3A::from_cols(
            Vec3A::new(1.0, 0.3, 0.0),
            Vec3A::new(0.7, 0.9, -0.2),
            Vec3A::new(0.0, 0.4, 0.8),
        ),
        translation: Vec3A::new(0.0, 1.9, 0.0),
    };
    let fins = shapes::cube().with(&shapes::fins(3));
    for (transform, what) in [
        (scaled(Vec3::new(-1.0, 1.0, 1.0)), "mirrored"),
        (scaled(Vec3::new(-1.0, -0.8, -1.2)), "mirrored thrice"),
        (scaled(Vec3::new(1.0, 0.01, 4.0)), "flattened"),
        (shear, "sheared"),
    ] {
        assert_shape_exact(shapes::sphere(12), transform, what);
        assert_shape_exact(fins.clone(), transform, what);
    }
}

#[test]
fn instances_cast_independent_shadows() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mirror = Affine3A::from_scale(Vec3::new(-0.5, 0.5, 0.5));
    let small = Affine3A::from_scale(Vec3::splat(0.6));
    for light in [lamp(), sun()] {
        let cube = shapes::cube().tilted();
        let sheet = shapes::square(1.0).tilted();
        let stage = Stage::new(
            light,
            vec![
                Body::caster(cube.clone(), at(-2.5, 1.0, 0.0) * small),
                Body::caster(sheet.clone(), at(0.0, 2.0, -2.0) * small),
                Body::caster(cube.clone(), at(0.0, 0.9, 0.5) * mirror),
                Body::caster(sheet, at(1.0, 1.4, 2.0) * mirror),
                Body::caster(cube, at(2.5, 1.1, -1.0) * small),
            ],
        );
        assert_exact(&gpu, &stage, &format!("instances, {light:?}"));
    }
}

#[test]
fn every_depth_convention_format_and_sample_count_agrees() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut drawn = 0;
    for depth in [
        DepthConvention::InfiniteReverse,
        DepthConvention::FiniteReverse,
        DepthConvention::Standard,
    ] {
        for format in [
            wgpu::TextureFormat::Depth24PlusStencil8,
            wgpu::TextureFormat::Depth32FloatStencil8,
        ] {
            let clip = wgpu::Features::DEPTH_CLIP_CONTROL;
            let needed = format.required_features()
                | if depth.clips_far() {
                    clip
                } else {
                    wgpu::Features::empty()
                };
            if !gpu.device.features().contains(needed) {
                continue;
            }
            for samples in [1, 4] {
                for cap_bias_ulps in [0, ShadowVolumeDescriptor::default().cap_bias_ulps] {
                    let stage = Stage {
                        depth,
                        format,
                        samples,
                        cap_bias_ulps,
                        ..mixed(lamp())
                    };
                    let what = format!("{depth:?}, {format:?}, {samples}x, bias {cap_bias_ulps}");
                    assert_exact(&gpu, &stage, &what);
                    drawn += 1;
                }
            }
        }
    }
    assert!(drawn >= 4, "only {drawn} combinations could be drawn");
}

/// A closed and an open caster, both touching or crossing the ground.
pub fn mixed(light: HomogeneousLight) -> Stage {
    let fins = Affine3A::from_rotation_y(0.5);
    Stage::new(
        light,
        vec![
            Body::caster(shapes::cube().with(&shapes::sphere(10)), at(-1.2, 0.9, 0.0)),
            Body::caster(shapes::fins(3), at(1.8, 0.4, 0.5) * fins),
        ],
    )
}

/// A ball, drawn by a host that multiplies in this order.
fn ball(arithmetic: Arithmetic, axis: Vec3) -> Stage {
    let turned = Affine3A::from_rotation_translation(
        Quat::from_axis_angle(axis.normalize(), 1.1),
        Vec3::new(0.37, 1.9, -0.23),
    );
    Stage {
        arithmetic,
        ..Stage::new(lamp(), vec![Body::caster(shapes::sphere(24), turned)])
    }
}

/// What a host of other arithmetic near the origin is told to set in floats: GPUs take depth from corners that
/// are snapped to the rasteriser's grid (docs/arithmetic.md).
fn bias_for_other_arithmetic(gpu: &Gpu) -> u32 {
    match gpu.info.device_type {
        wgpu::DeviceType::Cpu => ShadowVolumeDescriptor::default().cap_bias_ulps,
        _ => 512,
    }
}

const OTHER_ARITHMETIC: [Arithmetic; 2] = [Arithmetic::Premultiplied, Arithmetic::OneByOne];

#[test]
fn caps_do_not_fight_with_a_host_of_other_arithmetic() {
    let Some(gpu) = Gpu::for_test() else { return };
    // In 24-bit depth the other arithmetic does not show here: float depth is finer.
    let format = wgpu::TextureFormat::Depth32FloatStencil8;
    if !gpu.device.features().contains(format.required_features()) {
        return;
    }
    // Which ball and which order shows it is a matter of the rasteriser's own rounding.
    let mut fought = 0;
    let axes = [Vec3::new(3.0, 1.0, 2.0), Vec3::new(-1.0, 2.0, 0.4)];
    for (arithmetic, axis) in OTHER_ARITHMETIC
        .into_iter()
        .flat_map(|arithmetic| axes.map(|axis| (arithmetic, axis)))
    {
        let mut stage = Stage {
            format,
            cap_bias_ulps: bias_for_other_arithmetic(&gpu),
            ..ball(arithmetic, axis)
        };
        // z-pass has no caps.
        stage.savings.method = Method::ZFail;
        assert_exact(&gpu, &stage, &format!("{arithmetic:?}"));
        let unbiased = Stage {
            cap_bias_ulps: 0,
            ..stage
        };
        fought += unbiased.truth().errors(&unbiased.draw(&gpu)).wrong;
    }
    assert!(fought > 0, "the bias has nothing to do here");
}

/// The same, so far from the origin.
fn moved(mut stage: Stage, by: f32) -> Stage {
    let offset = Vec3::new(0.6, 0.0, -0.8) * by;
    for body in &mut stage.bodies {
        body.transform.translation += Vec3A::from(offset);
    }
    stage.light = moved_light(stage.light, offset);
    stage.eye += offset;
    stage.target += offset;
    stage
}

#[test]
fn far_from_the_origin_other_arithmetic_takes_a_larger_bias() {
    let Some(gpu) = Gpu::for_test() else { return };
    let format = wgpu::TextureFormat::Depth32FloatStencil8;
    if !gpu.device.features().contains(format.required_features()) {
        return;
    }
    let wrong = |arithmetic, distance, cap_bias_ulps| {
        let mut stage = Stage {
            format,
            cap_bias_ulps,
            ..moved(ball(arithmetic, Vec3::new(3.0, 1.0, 2.0)), distance)
        };
        stage.savings.method = Method::ZFail;
        stage.truth().errors(&stage.draw(&gpu)).wrong
    };
    let orders = [
        Arithmetic::Ours,
        Arithmetic::Premultiplied,
        Arithmetic::OneByOne,
    ];
    let near_by = bias_for_other_arithmetic(&gpu);
    for (distance, needed, too_little) in [
        (0.0, near_by, 0),
        (100.0, near_by.max(256), 4),
        (1000.0, 1024, 64),
    ] {
        assert_eq!(wrong(Arithmetic::Ours, distance, 0), 0, "{distance}");
        for arithmetic in orders {
            assert_eq!(
                wrong(arithmetic, distance, needed),
                0,
                "{distance}, {arithmetic:?}"
            );
        }
        let fought = OTHER_ARITHMETIC.map(|arithmetic| wrong(arithmetic, distance, too_little));
        assert!(fought.iter().any(|&wrong| wrong > 0), "{distance}");
    }
}

#[test]
fn every_format_and_convention_bears_a_host_of_other_arithmetic() {
    let Some(gpu) = Gpu::for_test() else { return };
    let axes = [Vec3::new(3.0, 1.0, 2.0), Vec3::new(-1.0, 2.0, 0.4)];
    for depth in crate::choices::depths(&gpu) {
        for format in [
            wgpu::TextureFormat::Depth24PlusStencil8,
            wgpu::TextureFormat::Depth32FloatStencil8,
        ] {
            if !gpu.device.features().contains(format.required_features()) {
                continue;
            }
            for (axis, method) in axes.into_iter().zip([Method::ZFail, Method::Auto]) {
                for arithmetic in OTHER_ARITHMETIC {
                    let mut stage = Stage {
                        depth,
                        format,
                        ..ball(arithmetic, axis)
                    };
                    stage.savings.method = method;
                    let what = format!("{depth:?}, {format:?}, {method:?}, {arithmetic:?}");
                    assert_exact(&gpu, &stage, &what);
                }
            }
        }
    }
}

#[test]
fn mirrored_and_orthographic_cameras_turn_faces_the_right_way() {
    let Some(gpu) = Gpu::for_test() else { return };
    for lens in [Lens::Mirrored, Lens::Orthographic] {
        for light in [lamp(), sun()] {
            let depth = match lens {
                Lens::Orthographic => DepthConvention::Standard,
                _ => DepthConvention::InfiniteReverse,
            };
            let clip = wgpu::Features::DEPTH_CLIP_CONTROL;
            if depth.clips_far() && !gpu.device.features().contains(clip) {
                continue;
            }
            let stage = Stage {
                lens,
                depth,
                ..mixed(light)
            };
            assert_exact(&gpu, &stage, &format!("{lens:?}, {light:?}"));
        }
    }
}

#[test]
fn positions_are_read_in_place_at_any_stride() {
    let Some(gpu) = Gpu::for_test() else { return };
    for host_layout in [(12, 0), (32, 16), (20, 4)] {
        let stage = Stage {
            host_layout: Some(host_layout),
            ..mixed(lamp())
        };
        assert_exact(&gpu, &stage, &format!("stride and offset {host_layout:?}"));
    }
}

#[test]
fn the_eye_may_be_inside_a_volume() {
    let Some(gpu) = Gpu::for_test() else { return };
    for light in [lamp(), sun()] {
        for shape in [shapes::cube().tilted(), shapes::square(1.4)] {
            // A ray from the light through the caster and on to the eye.
            let caster = Vec3::new(0.0, 2.6, 0.0);
            let away = match light.is_directional() {
                true => -light.xyzw().truncate().normalize(),
                false => (caster - light.xyzw().truncate()).normalize(),
            };
            let stage = Stage {
                eye: caster + 1.9 * away,
                target: Vec3::new(3.0, 0.0, -3.0),
                field_of_view: 1.9,
                ..Stage::new(
                    light,
                    vec![Body::caster(shape, Affine3A::from_translation(caster))],
                )
            };
            assert_exact(&gpu, &stage, &format!("{light:?}"));
        }
    }
}

#[test]
fn a_picture_that_is_wrong_is_found_wrong() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = mixed(lamp());
    let truth = stage.truth();
    let wrong = |picture: &[u8]| truth.errors(picture).wrong;
    assert_eq!(wrong(&stage.draw(&gpu)), 0);

    assert!(wrong(&stage.draw_without_volumes(&gpu)) > 500, "no volumes");
    let mut moved = stage.clone();
    moved.light = moved_light(moved.light, 0.5 * Vec3::X);
    assert!(wrong(&moved.draw(&gpu)) > 100, "a light moved by 0.5");
    let mut holed = stage.clone();
    holed.bodies[1].shape.indices.drain(..30);
    assert!(
        wrong(&holed.draw(&gpu)) > 50,
        "a box without five of its sides"
    );
    let mut unmirrored = stage.clone();
    unmirrored.bodies[2].transform = at(1.8, 0.4, 0.5);
    assert!(wrong(&unmirrored.draw(&gpu)) > 50, "another transform");
    let mut damaged = stage.draw(&gpu);
    damaged.iter_mut().for_each(|value| *value = 255 - *value);
    assert!(wrong(&damaged) > 10_000, "inverted");
}
