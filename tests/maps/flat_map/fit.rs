//! What a map of a directional light covers.

use shadows::glam::{Affine3A, Mat4, Vec3, Vec3Swizzles as _, camera::rh};
use shadows::{
    Bias, Caster, DepthConvention, Kernel, MapSettings, Radius, ShadowFrame, ShadowMap,
    ShadowMapDescriptor, View, VogelDisk,
};

use super::{drawn, field, interior, of_size, sun, wrong};
use crate::common::shapes::{Random, square};
use crate::receivers::visibility;
use host::gpu::Gpu;

fn camera(eye: Vec3, target: Vec3) -> View {
    let projection = rh::proj::directx::perspective_infinite_reverse(0.8, 1.5, 0.1);
    let camera = rh::view::look_at_mat4(eye, target, Vec3::Y);
    View::new(projection * camera, DepthConvention::InfiniteReverse).unwrap()
}

/// How far the grid of texels moved against the world from one frame to the next, at most and in
/// texels, while the camera moves and the light turns by an angle a frame.
fn grid_motion(gpu: &Gpu, casters: &[Caster], turn: f32) -> f32 {
    let mut map = ShadowMap::new(&gpu.device, &of_size(1024, Bias::default())).unwrap();
    let mut widths = Vec::new();
    let mut places: Vec<Vec3> = Vec::new();
    for step in 0..60 {
        let step = step as f32;
        let view = camera(Vec3::new(0.013 * step, 2.0, 6.0), Vec3::X * 0.02 * step);
        let frame = ShadowFrame {
            view: Some((&view, 7.0)),
            ..ShadowFrame::new(sun(Vec3::new(0.4 + turn * step, 1.0, 0.2)), casters)
        };
        map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        let matrix: Mat4 = map.texture_from_world().unwrap();
        widths.push(matrix.row(0).truncate().length());
        places.push(matrix.project_point3(Vec3::new(3.3, 0.7, -2.1)) * 1024.0);
    }
    let same = |w: &[f32]| (w[0] / w[1] - 1.0).abs() < 0.01;
    let changes = widths.windows(2).filter(|w| !same(w)).count();
    assert!(changes <= 1, "{changes} of 59 frames changed the width");
    let shifts = places.windows(2).zip(widths.windows(2));
    let shifts: Vec<_> = shifts
        .filter(|(_, widths)| same(widths))
        .map(|(places, _)| (places[0] - places[1]).truncate())
        .collect();
    let followed = shifts.iter().filter(|shift| shift.length() > 0.5).count();
    assert!(followed > 5, "the map follows the camera");
    let off = shifts.iter().map(|shift| (shift - shift.round()).abs());
    off.map(|off| off.max_element()).fold(0.0, f32::max)
}

#[test]
fn a_moving_camera_keeps_the_texel_grid_in_its_place() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = field(&gpu);
    // What is left is the rounding of world coordinates to f32.
    let moved = grid_motion(&gpu, &field.casters, 0.0);
    assert!(moved < 0.01, "{moved} texels");
    // The broken twin: a light that turns takes the grid with it.
    let moved = grid_motion(&gpu, &field.casters, 1e-4);
    assert!(moved > 0.01, "{moved} texels");
}

#[test]
fn the_map_covers_no_more_than_casts_receives_and_is_seen() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = field(&gpu);
    let all = ShadowFrame::new(sun(Vec3::Y), &field.casters);
    let view = camera(Vec3::new(0.0, 1.0, 3.0), Vec3::new(0.0, 0.5, 0.0));
    let near = ShadowFrame {
        view: Some((&view, 1.5)),
        ..all
    };
    let bounds = shadows::mesh::Bounds {
        min: Vec3::new(-0.5, 0.0, -0.5),
        max: Vec3::new(0.5, 0.0, 0.5),
    };
    let few = ShadowFrame {
        receivers: Some(bounds),
        ..all
    };
    let width = |frame| {
        let map = drawn(&gpu, &of_size(512, Bias::default()), frame);
        2.0 / map.clip_from_world().unwrap().row(0).truncate().length()
    };
    let [all, near, few] = [&all, &near, &few].map(width);
    // Casters lie within 5 of the middle; a step and the slack are at most 1.19 * 1.04.
    assert!((8.0..13.0).contains(&all), "{all}");
    assert!(near < 0.6 * all, "{near} of {all}");
    assert!((1.0..1.25).contains(&few), "{few}");
}

/// The matrices of a map that is fitted to a view, and to views that end or begin elsewhere.
#[test]
fn a_views_distance_counts_from_the_eye() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = field(&gpu);
    let camera = rh::view::look_at_mat4(Vec3::new(0.0, 3.0, 7.0), Vec3::ZERO, Vec3::Y);
    let fitted = |near: f32, far: Option<f32>, distance: f32| {
        use rh::proj::directx as proj;
        let (mut projection, depth) = match far {
            None => (
                proj::perspective_infinite_reverse(0.3, 1.5, near),
                DepthConvention::InfiniteReverse,
            ),
            Some(far) => (
                proj::perspective(0.3, 1.5, far, near),
                DepthConvention::FiniteReverse,
            ),
        };
        // Off centre: the axis is not the middle of the picture.
        (projection.z_axis.x, projection.z_axis.y) = (0.3, -0.2);
        let view = View::new(projection * camera, depth).unwrap();
        let frame = ShadowFrame {
            view: Some((&view, distance)),
            ..ShadowFrame::new(sun(Vec3::new(0.3, 1.0, 0.1)), &field.casters)
        };
        let map = drawn(&gpu, &of_size(512, Bias::default()), &frame);
        map.clip_from_world().unwrap()
    };
    let same = |a: Mat4, b: Mat4| a.abs_diff_eq(b, 1e-3 * a.x_axis.length());
    for near in [0.01, 4.0, 6.0] {
        let ends_there = fitted(near, Some(8.0), 100.0);
        assert!(same(fitted(near, None, 8.0), ends_there), "near {near}");
        assert!(
            same(fitted(near, Some(50.0), 8.0), ends_there),
            "near {near}"
        );
        // The broken twin: counted from the near plane.
        let twin = same(fitted(near, None, 8.0 + near), ends_there);
        assert_eq!(twin, near < 0.1, "near {near}");
    }
}

#[test]
fn orthographic_views_show_their_shadows_wherever_their_near_plane_is() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = field(&gpu);
    let light = sun(Vec3::new(0.4, 1.0, 0.2));
    // A camera among the casters, that sees what is behind it as well, and does not look along the
    // light.
    let eye = Vec3::new(0.3, 0.6, 0.2);
    let camera = rh::view::look_at_mat4(eye, eye + Vec3::new(0.2, -0.5, -1.0), Vec3::Y);
    let view = |near: f32, far: f32, depth| {
        let (first, last) = match depth {
            DepthConvention::Standard => (near, far),
            _ => (far, near),
        };
        let off_centre = [-3.0, 4.5, -3.5, 2.5];
        let [left, right, bottom, top] = off_centre;
        let projection = rh::proj::directx::orthographic(left, right, bottom, top, first, last);
        View::new(projection * camera, depth).unwrap()
    };
    for depth in [DepthConvention::Standard, DepthConvention::FiniteReverse] {
        for (near, far) in [(-20.0, 20.0), (-50.0, 90.0), (-1000.0, 30.0)] {
            let whole = view(near, far, depth);
            let visible = |point: Vec3| {
                let clip = whole.clip_from_world().project_point3(point);
                clip.x.abs() < 0.98 && clip.y.abs() < 0.98
            };
            for distance in [1.0, 100.0, 5000.0] {
                let wrong_in = |seen: &View| {
                    let frame = ShadowFrame {
                        view: Some((seen, distance)),
                        ..ShadowFrame::new(light, &field.casters)
                    };
                    let map = drawn(&gpu, &of_size(2048, Bias::default()), &frame);
                    let points: Vec<_> = interior(&field, light, 0.05)
                        .into_iter()
                        .filter(|(point, _)| visible(*point))
                        .collect();
                    assert!(points.iter().filter(|(_, blocked)| *blocked).count() > 20);
                    wrong(&gpu, &map, Kernel::Bilinear, &points)
                };
                assert_eq!(wrong_in(&whole), 0, "{depth:?} {near} {distance}");
                // The broken twin: as if only what is beyond the camera were seen.
                let half = view(0.5, far, depth);
                assert!(wrong_in(&half) > 5, "{depth:?} {near} {distance}");
            }
        }
    }
}

#[test]
fn a_fitted_map_reaches_as_far_as_its_kernels() {
    let Some(gpu) = Gpu::for_test() else { return };
    // Under a roof there is no light, wherever a tap falls.
    let casters = [square(30.0).caster(&gpu.device, Affine3A::from_translation(Vec3::Y * 4.0))];
    let frame = ShadowFrame {
        receivers: Some(shadows::mesh::Bounds {
            min: Vec3::new(-1.0, 0.0, -1.0),
            max: Vec3::new(1.0, 0.1, 1.0),
        }),
        ..ShadowFrame::new(sun(Vec3::Y), &casters)
    };
    let mut random = Random::new(3);
    let points: Vec<_> = (0..500)
        .map(|i| {
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let (edge, along) = (Vec3::X * side, random.next());
            let (edge, along) = if i % 4 < 2 {
                (edge, Vec3::Z * along)
            } else {
                (edge.zyx(), Vec3::X * along)
            };
            (edge + along, Vec3::Y)
        })
        .collect();
    for radius in [Radius::Texels(40.0), Radius::World(0.6)] {
        let kernel = Kernel::Vogel(VogelDisk { radius, taps: 64 });
        let lit = |beyond: f32| {
            let descriptor = ShadowMapDescriptor {
                settings: MapSettings {
                    reach: kernel.radius(),
                    ..Default::default()
                },
                ..of_size(256, Bias::default())
            };
            let map = drawn(&gpu, &descriptor, &frame);
            let points: Vec<_> = points.iter().map(|&(at, up)| (at * beyond, up)).collect();
            let seen = visibility(&gpu, &map, kernel, &points);
            seen.into_iter().filter(|&lit| lit > 0.0).count()
        };
        assert_eq!(lit(1.0), 0, "{radius:?}");
        // The broken twin: receivers farther out than was said, as if kernels reached farther.
        assert!(lit(2.0) > 400, "{radius:?}");
    }
}
