//! What a light is worth on screen, in texels.

use std::f64::consts::FRAC_PI_4;

use glam::{DVec3, DVec4, Vec4Swizzles as _};

use crate::{PointLight, SpotLight, View};

/// A view and the picture that it fills.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Screen<'a> {
    pub view: &'a View,
    /// In pixels.
    pub width: f64,
    pub height: f64,
}

/// A sphere around what a light may light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LitSphere {
    centre: DVec3,
    radius: f64,
    /// Width of a tile where the light ends, as a share of the sphere's diameter.
    tile_width: f64,
}

impl LitSphere {
    /// A face of a point light is as wide where its range ends as the sphere of its range.
    pub fn of_point(light: &PointLight) -> Self {
        Self {
            centre: light.position.as_dvec3(),
            radius: f64::from(light.range),
            tile_width: 1.0,
        }
    }

    /// The smallest sphere around a spot's cone, which ends in a cap. The map is as wide as the cap's rim.
    pub fn of_spot(light: &SpotLight) -> Self {
        let (sin, cos) = f64::from(light.half_angle).sin_cos();
        let range = f64::from(light.range);
        let (along, radius) = match f64::from(light.half_angle) < FRAC_PI_4 {
            // Through the apex and the rim.
            true => (0.5 * range / cos, 0.5 * range / cos),
            // Around the rim.
            false => (range * cos, range * sin),
        };
        let direction = light.direction.as_dvec3().normalize();
        Self {
            centre: light.position.as_dvec3() + along * direction,
            radius,
            tile_width: range * sin / radius,
        }
    }
}

/// Texels along a side of a light's tiles for one to a pixel where the light ends: of the views in which
/// that is most. 0 if no view shows what it lights.
///
/// A sphere that reaches behind an eye counts as filling the view, and none counts for more.
pub(crate) fn importance(lit: &LitSphere, screens: &[Screen<'_>]) -> f64 {
    let diameters = screens.iter().map(|screen| diameter(lit, screen));
    lit.tile_width * diameters.fold(0.0, f64::max)
}

/// Pixels across the picture of a sphere, the whole of it if any of it is seen.
fn diameter(lit: &LitSphere, screen: &Screen<'_>) -> f64 {
    let matrix = screen.view.clip_from_world().as_dmat4();
    let (x, y, w) = (matrix.row(0), matrix.row(1), matrix.row(3));
    let ends = screen.view.near_and_far_planes().into_iter().flatten();
    let seen = [w, w + x, w - x, w + y, w - y]
        .into_iter()
        .chain(ends)
        .all(|plane| at(plane, lit) + lit.radius * plane.xyz().length() > 0.0);
    if !seen {
        return 0.0;
    }
    let full = screen.width.max(screen.height);
    let across = |row, pixels| extent(lit, row, w).map_or(full, |clip| 0.5 * clip * pixels);
    across(x, screen.width)
        .max(across(y, screen.height))
        .min(full)
}

/// Width of a sphere's picture in clip space along x or y; `None` if the sphere reaches behind the eye.
///
/// The planes `row - s w` through the eye that touch the sphere have s for which
/// `(X - s W)^2 = r^2 |row - s w|^2`, with X and W the rows at the centre: this is the difference of the
/// two, without that of large numbers.
fn extent(lit: &LitSphere, row: DVec4, w: DVec4) -> Option<f64> {
    let (at_row, at_w) = (at(row, lit), at(w, lit));
    let reach = lit.radius * w.xyz().length();
    let depth = (at_w - reach) * (at_w + reach);
    let moment = row.xyz() * at_w - w.xyz() * at_row;
    let skew = lit.radius * row.xyz().cross(w.xyz()).length();
    let root = moment.length_squared() - skew * skew;
    (at_w > reach).then(|| 2.0 * lit.radius * root.max(0.0).sqrt() / depth)
}

fn at(row: DVec4, lit: &LitSphere) -> f64 {
    row.xyz().dot(lit.centre) + row.w
}

#[cfg(test)]
mod tests {
    use glam::camera::rh::{proj::directx as proj, view as camera};
    use glam::{Mat4, Vec3};

    use super::*;
    use crate::DepthConvention;

    const WIDTH: f64 = 1280.0;
    const HEIGHT: f64 = 720.0;

    fn screen(view: &View) -> Screen<'_> {
        let (width, height) = (WIDTH, HEIGHT);
        Screen {
            view,
            width,
            height,
        }
    }

    fn from_origin(projection: Mat4, depth: DepthConvention) -> View {
        let at = Vec3::new(3.0, 2.0, -7.0);
        let eye = camera::look_at_mat4(at, at + Vec3::new(0.3, -0.2, -1.0), Vec3::Y);
        View::new(projection * eye, depth).unwrap()
    }

    fn perspective(degrees: f32) -> View {
        let aspect = (WIDTH / HEIGHT) as f32;
        let angle = degrees.to_radians();
        let projection = proj::perspective_infinite_reverse(angle, aspect, 0.01);
        from_origin(projection, DepthConvention::InfiniteReverse)
    }

    fn off_centre() -> View {
        let mut projection = proj::perspective_infinite_reverse(0.8, (WIDTH / HEIGHT) as f32, 0.01);
        (projection.z_axis.x, projection.z_axis.y) = (0.7, -0.4);
        from_origin(projection, DepthConvention::InfiniteReverse)
    }

    fn orthographic() -> View {
        let projection = proj::orthographic(-16.0, 48.0, -9.0, 27.0, -20.0, 100.0);
        from_origin(projection, DepthConvention::Standard)
    }

    /// Where a sight line ends: x and y in clip space, distance.
    fn in_view(view: &View, x: f64, y: f64, distance: f64) -> DVec3 {
        let [a, b, _, d] = view.near_corners();
        let near = a + (b - a) * (0.5 + 0.5 * x) + (d - a) * (0.5 + 0.5 * y);
        let along = match view.eye_point() {
            Some(eye) => near - eye,
            None => view.forward(),
        };
        near + distance * along.normalize()
    }

    fn sphere(centre: DVec3, radius: f64) -> LitSphere {
        LitSphere {
            centre,
            radius,
            tile_width: 1.0,
        }
    }

    /// The longer side of the box around the pixels of points all over a sphere.
    fn diameter_of_points(lit: &LitSphere, view: &View) -> f64 {
        const POINTS: u32 = 20_000;
        let matrix = view.clip_from_world().as_dmat4();
        let mut min = DVec3::INFINITY;
        let mut max = DVec3::NEG_INFINITY;
        for i in 0..POINTS {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(POINTS);
            let (sin, cos) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
            let across = (1.0 - z * z).sqrt();
            let point = lit.centre + lit.radius * DVec3::new(across * cos, across * sin, z);
            let clip = matrix * point.extend(1.0);
            let pixel = clip.xyz() / clip.w * DVec3::new(WIDTH * 0.5, HEIGHT * 0.5, 0.0);
            (min, max) = (min.min(pixel), max.max(pixel));
        }
        (max - min).max_element()
    }

    #[test]
    fn a_sphere_is_as_large_as_its_points_on_screen() {
        let views = [
            perspective(0.01),
            perspective(1.0),
            perspective(50.0),
            perspective(120.0),
            perspective(170.0),
            off_centre(),
            orthographic(),
        ];
        let mut naive_is_wrong = 0;
        for (which, view) in views.iter().enumerate() {
            for (x, y) in [(0.0, 0.0), (0.9, 0.0), (-0.7, 0.9), (1.0, -1.0)] {
                let centre = in_view(view, x, y, 40.0);
                for share in [1e-3, 0.05, 1.5] {
                    // In the narrowest view, of which 40 units away 0.007 are seen.
                    let radius = share * if which == 0 { 0.01 } else { 8.0 };
                    let lit = sphere(centre, radius);
                    let found = importance(&lit, &[screen(view)]);
                    let matrix = view.clip_from_world().as_dmat4();
                    if extent(&lit, matrix.row(0), matrix.row(3)).is_none() {
                        assert_eq!(found, WIDTH);
                        continue;
                    }
                    let expected = diameter_of_points(&lit, view).min(WIDTH);
                    let error = (found / expected - 1.0).abs();
                    assert!(
                        error < 2e-3,
                        "view {which} at {x}, {y}: {found}, not {expected}"
                    );
                    // The broken twin: diameter over distance, right in the middle only.
                    let middle = importance(
                        &sphere(in_view(view, 0.0, 0.0, 40.0), radius),
                        &[screen(view)],
                    );
                    naive_is_wrong += u32::from((middle / expected - 1.0).abs() > 0.1);
                }
            }
        }
        assert!(naive_is_wrong > 10, "{naive_is_wrong}");
    }

    #[test]
    fn what_is_outside_the_view_is_worth_nothing() {
        for view in [
            perspective(0.01),
            perspective(60.0),
            off_centre(),
            orthographic(),
        ] {
            let worth = |x, y, distance, radius| {
                importance(
                    &sphere(in_view(&view, x, y, distance), radius),
                    &[screen(&view)],
                )
            };
            let unit = in_view(&view, 0.0, 0.0, 40.0).distance(in_view(&view, 1.0, 0.0, 40.0));
            assert!(worth(0.0, 0.0, 40.0, unit * 0.1) > 0.0);
            assert!(worth(1.05, 0.0, 40.0, unit * 0.1) > 0.0);
            for (x, y) in [(1.3, 0.0), (-1.3, 0.0), (0.0, 1.4), (0.0, -1.4)] {
                assert_eq!(worth(x, y, 40.0, unit * 0.1), 0.0, "{x} {y}");
            }
        }
        // Behind the eye, also of a view so narrow that its sides pass everything there by; and beyond
        // the far plane.
        for degrees in [0.01, 60.0, 170.0] {
            let view = perspective(degrees);
            let behind = sphere(in_view(&view, 0.0, 0.0, -40.0), 1.0);
            assert_eq!(importance(&behind, &[screen(&view)]), 0.0, "{degrees}");
        }
        let view = orthographic();
        let beyond = |distance| sphere(in_view(&view, 0.0, 0.0, distance), 1.0);
        assert!(importance(&beyond(120.5), &[screen(&view)]) > 0.0);
        assert_eq!(importance(&beyond(122.0), &[screen(&view)]), 0.0);
        assert_eq!(importance(&beyond(-2.0), &[screen(&view)]), 0.0);
    }

    #[test]
    fn a_light_around_the_eye_fills_the_view() {
        for view in [
            perspective(0.01),
            perspective(60.0),
            perspective(170.0),
            off_centre(),
        ] {
            let eye = view.eye_point().unwrap();
            let lamp = sphere(eye + DVec3::new(1.0, 2.0, 0.5), 5.0);
            assert_eq!(importance(&lamp, &[screen(&view)]), WIDTH);
        }
        // Going nearer, the picture grows up to the view and never jumps down.
        let view = perspective(60.0);
        let mut last = 0.0;
        for step in 0..2000 {
            let lamp = sphere(in_view(&view, 0.1, 0.2, 20.0 - 0.01 * f64::from(step)), 3.0);
            let now = importance(&lamp, &[screen(&view)]);
            assert!(now >= last && now <= WIDTH, "{step}: {now} after {last}");
            last = now;
        }
        assert_eq!(last, WIDTH);
    }

    #[test]
    fn the_greatest_of_several_views_counts() {
        let (near, far) = (perspective(60.0), orthographic());
        let lit = sphere(in_view(&near, 0.2, 0.1, 30.0), 2.0);
        let of = |screens: &[Screen<'_>]| importance(&lit, screens);
        let (a, b) = (of(&[screen(&near)]), of(&[screen(&far)]));
        assert!(a != b);
        assert_eq!(of(&[screen(&near), screen(&far)]), a.max(b));
        assert_eq!(of(&[screen(&far), screen(&near)]), a.max(b));
        assert_eq!(of(&[]), 0.0);
    }

    #[test]
    fn the_sphere_of_a_spot_holds_its_cone_and_touches_its_rim() {
        for degrees in [0.01_f32, 5.0, 30.0, 44.9, 45.1, 70.0, 89.9] {
            let angle = degrees.to_radians();
            let direction = Vec3::new(1.0, -2.0, 0.5);
            let light = SpotLight::new(Vec3::new(4.0, 5.0, 6.0), direction, angle, 10.0);
            let lit = LitSphere::of_spot(&light);
            let apex = light.position.as_dvec3();
            let forward = light.direction.as_dvec3().normalize();
            let side = forward.any_orthonormal_vector();
            let angle = f64::from(angle);
            let on_cap = |angle: f64| apex + 10.0 * (forward * angle.cos() + side * angle.sin());
            let room = |point: DVec3| lit.radius - point.distance(lit.centre);
            for point in [apex, on_cap(0.0), on_cap(0.5 * angle), on_cap(angle)] {
                assert!(room(point) > -1e-9, "{degrees}: {}", room(point));
            }
            assert!(room(on_cap(angle)) < 1e-9);
            let rim = 2.0 * 10.0 * angle.sin();
            assert!((lit.tile_width * 2.0 * lit.radius - rim).abs() < 1e-9);
        }
        let light = PointLight::new(Vec3::ONE, 10.0);
        let lit = LitSphere::of_point(&light);
        assert_eq!(
            (lit.centre, lit.radius, lit.tile_width),
            (DVec3::ONE, 10.0, 1.0)
        );
    }
}
