mod coverage;
mod errors;
mod motion;

use glam::camera::rh::{proj::directx as proj, view as camera};
use glam::{DVec3, Mat4, Vec3};

use super::*;
use crate::map::cascades::CascadeSplit;
use crate::map::projection::directional::{Fit, fit_directional};
use crate::{DepthConvention, Radius};

const SIZE: u32 = 1024;

fn sun() -> DirectionalLight {
    DirectionalLight {
        toward_light: Vec3::new(0.3, 1.0, -0.2),
    }
}

fn shape(reach: Radius) -> MapShape {
    MapShape {
        size: SIZE,
        reach,
        unclipped_depth: true,
    }
}

fn looking(eye: Vec3, along: Vec3) -> Mat4 {
    camera::look_to_mat4(eye, along.normalize(), Vec3::Y)
}

fn perspective(degrees: f32, eye: Vec3, along: Vec3) -> View {
    let projection = proj::perspective_infinite_reverse(degrees.to_radians(), 1.6, 0.1);
    View::new(
        projection * looking(eye, along),
        DepthConvention::InfiniteReverse,
    )
    .unwrap()
}

fn off_centre(eye: Vec3, along: Vec3) -> View {
    let mut projection = proj::perspective_infinite_reverse(0.8, 1.6, 0.1);
    (projection.z_axis.x, projection.z_axis.y) = (0.7, -0.4);
    View::new(
        projection * looking(eye, along),
        DepthConvention::InfiniteReverse,
    )
    .unwrap()
}

fn ending(eye: Vec3, along: Vec3) -> View {
    let projection = proj::perspective(0.8, 1.6, 0.1, 60.0);
    View::new(projection * looking(eye, along), DepthConvention::Standard).unwrap()
}

fn orthographic(eye: Vec3, along: Vec3) -> View {
    let projection = proj::orthographic(-9.0, 14.0, -4.0, 7.0, -20.0, 70.0);
    View::new(projection * looking(eye, along), DepthConvention::Standard).unwrap()
}

fn views(eye: Vec3, along: Vec3) -> Vec<View> {
    let wide = [0.01, 1.0, 50.0, 120.0, 170.0].map(|degrees| perspective(degrees, eye, along));
    let others = [off_centre, ending, orthographic].map(|view| view(eye, along));
    wide.into_iter().chain(others).collect()
}

/// Casters all around.
const EVERYWHERE: LightBox = LightBox {
    min: DVec3::splat(-2000.0),
    max: DVec3::splat(2000.0),
};

fn of<'a>(view: &'a View, light: &'a DirectionalLight, cascades: &'a Cascades) -> CascadesOf<'a> {
    CascadesOf {
        light,
        view,
        cascades,
        depth_bounds: None,
        receivers: None,
        shape: shape(Radius::Texels(12.0)),
        casters: Some(EVERYWHERE),
        last: &[],
    }
}

const FITS: [CascadeFit; 2] = [CascadeFit::Stable, CascadeFit::Tight];

fn fitted(fit: CascadeFit) -> Cascades {
    Cascades {
        fit,
        ..Default::default()
    }
}

fn frames(cascades: &[Cascade]) -> Vec<FlatFrame> {
    cascades
        .iter()
        .map(|cascade| cascade.map.unwrap().0)
        .collect()
}

fn placed(cascades: &[Cascade]) -> Vec<Option<Placed>> {
    let map = |cascade: &Cascade| cascade.map.map(|(_, placed)| placed);
    cascades.iter().map(map).collect()
}

/// Points of a slice: on its corners, its faces and inside.
fn points(view: &View, slice: &Slice) -> Vec<DVec3> {
    points_at(view, slice, &[0.0, 0.2, 0.5, 0.9, 1.0])
}

/// Many of them.
fn dense_points(view: &View, slice: &Slice) -> Vec<DVec3> {
    let shares: Vec<f64> = (0..=16).map(|i| f64::from(i) / 16.0).collect();
    points_at(view, slice, &shares)
}

fn points_at(view: &View, slice: &Slice, shares: &[f64]) -> Vec<DVec3> {
    let [a, b, _, d] = view.near_corners();
    let lines = view
        .sight_lines()
        .map(|line| line / view.forward().dot(line));
    let [e, f, _, h] = lines;
    let mut points = Vec::new();
    for (u, v, w) in shares.iter().flat_map(|&u| {
        shares
            .iter()
            .flat_map(move |&v| shares.iter().map(move |&w| (u, v, w)))
    }) {
        let distance = slice.from + (slice.to - slice.from) * w;
        points.push(match view.eye_point() {
            Some(eye) => eye + distance * (e + (f - e) * u + (h - e) * v).normalize(),
            None => {
                let along = view.forward().normalize();
                a + (b - a) * u + (d - a) * v + along * distance
            }
        });
    }
    points
}

/// How far inside a map's sides a point is, in texels, as shaders see it.
fn spare(frame: &FlatFrame, point: DVec3) -> f64 {
    let from = point - frame.origin.as_dvec3();
    let [right, up] = [frame.right, frame.up].map(|axis| axis.as_dvec3().dot(from).abs());
    (1.0 - right.max(up) * f64::from(frame.scale)) * f64::from(SIZE) / 2.0
}

/// The texels to spare of the point of a view's slices that has the fewest, less what kernels reach.
fn least_spare(of: &CascadesOf<'_>, points_of: &Cascades) -> f64 {
    let cascades = fit_cascades(of).unwrap();
    let slices = slices(of.view, points_of, None);
    let (texels, world) = of.shape.reach.reach();
    let mut least = f64::INFINITY;
    for (cascade, slice) in cascades.iter().zip(&slices) {
        let (frame, _) = cascade.map.unwrap();
        let texel = 2.0 / f64::from(frame.scale) / f64::from(SIZE);
        for point in points(of.view, slice) {
            let spare = spare(&frame, point) - f64::from(texels) - f64::from(world) / texel;
            least = least.min(spare);
        }
    }
    least
}
