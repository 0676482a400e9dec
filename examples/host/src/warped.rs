//! A warped shadow map's matrix, in our rendition: light space perspective shadow maps (Wimmer, Scherzer and
//! Purgathofer 2004). No part of the library: it is here to be measured against maps without a warp.

use shadows::glam::{DMat4, DVec3, DVec4, Mat4, Vec3, Vec4Swizzles as _};
use shadows::mesh::Bounds;

use super::scene;

/// What the camera sees.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Infinite reverse Z.
    pub clip_from_world: Mat4,
    /// From where along the camera's axis on there is something to see, if that is known; else from the near plane.
    pub nearest: Option<f32>,
    /// Up to where along the camera's axis there is something to see.
    pub far: f32,
}

/// Clip from world space for a directional light, depth 0 nearest to it; `bounds` hold all that casts or receives.
/// `None` where the camera sees nothing of them.
pub fn warped(toward_light: Vec3, seen: &Seen, bounds: &Bounds) -> Option<Mat4> {
    let camera = Camera::new(seen);
    let body = camera.body(bounds);
    if body.is_empty() {
        return None;
    }
    // Up is the camera's direction as the light sees it: along it the map is warped.
    let back = toward_light.as_dvec3().normalize();
    let across = camera.axis.cross(back);
    let sine = across.length();
    let right = match sine > 0.0 {
        true => across / sine,
        false => back.any_orthonormal_vector(),
    };
    let up = back.cross(right);
    let light_from_world = rows([right, up, back]);
    let lit = |point: &DVec3| light_from_world.transform_point3(*point);
    let extent = scene::Bounds::of(body.iter().map(lit));
    let depth = extent.size().y;
    // How far the warp's own eye is before the body: the error is then the same at both of its ends.
    // The paper's n_opt.
    let near = camera.near;
    let distance = (near + (near * (near + depth * sine)).sqrt()) / sine.max(1e-6);
    let eye = lit(&camera.eye);
    let start = DVec3::new(eye.x, extent.min.y - distance, eye.z);
    let (first, last) = (distance, distance + depth);
    let warp = DMat4::from_cols(
        DVec4::X,
        DVec4::new(0.0, (last + first) / (last - first), 0.0, 1.0),
        DVec4::Z,
        DVec4::new(0.0, -2.0 * last * first / (last - first), 0.0, 0.0),
    );
    let warped_from_world = warp * DMat4::from_translation(-start) * light_from_world;
    let through = |point: DVec3| {
        let clip = warped_from_world * point.extend(1.0);
        clip.xyz() / clip.w
    };
    let extent = scene::Bounds::of(body.iter().copied().map(through));
    // Casters beside the body cast nothing on it; those before it lie on lines of the same x, y and w.
    let depths = casters(&light_from_world, bounds, start, [first, last]);
    Some((fit(&extent, depths) * warped_from_world).as_mat4())
}

fn rows(axes: [DVec3; 3]) -> DMat4 {
    let [x, y, z] = axes.map(|axis| axis.extend(0.0));
    DMat4::from_cols(x, y, z, DVec4::W).transpose()
}

/// Least and greatest warped depth of what lies over the body, toward the light positive.
fn casters(light_from_world: &DMat4, bounds: &Bounds, start: DVec3, ends: [f64; 2]) -> [f64; 2] {
    let lit = corners(bounds).map(|corner| light_from_world.transform_point3(corner));
    let lit = scene::Bounds::of(lit.into_iter());
    let depths = [lit.min.z - start.z, lit.max.z - start.z];
    let all = depths.iter().flat_map(|depth| ends.map(|end| depth / end));
    all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], depth| {
        [low.min(depth), high.max(depth)]
    })
}

/// To -1 to 1 across, 0 to 1 away from the light.
fn fit(extent: &scene::Bounds, [far, near]: [f64; 2]) -> DMat4 {
    let margin = 1e-4 * (near - far);
    let (far, near) = (far - margin, near + margin);
    let size = 1.001 * extent.size();
    let middle = extent.centre();
    let scale = DVec3::new(2.0 / size.x, 2.0 / size.y, -1.0 / (near - far));
    let offset = DVec3::new(
        -middle.x * scale.x,
        -middle.y * scale.y,
        near / (near - far),
    );
    DMat4::from_translation(offset) * DMat4::from_scale(scale)
}

fn corners(bounds: &Bounds) -> [DVec3; 8] {
    let ends = [bounds.min.as_dvec3(), bounds.max.as_dvec3()];
    std::array::from_fn(|i| DVec3::new(ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2].z))
}

/// Four corners of each face of a hexahedron whose corner `i` has the bits of its sides.
const FACES: [[usize; 4]; 6] = [
    [0, 1, 3, 2],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 3, 7, 6],
    [0, 2, 6, 4],
    [1, 3, 7, 5],
];

struct Camera {
    eye: DVec3,
    axis: DVec3,
    near: f64,
    /// Of its frustum, up to the last of what there is.
    corners: [DVec3; 8],
}

impl Camera {
    fn new(seen: &Seen) -> Self {
        let world_from_clip = seen.clip_from_world.as_dmat4().inverse();
        let point = |clip: DVec4| {
            let world = world_from_clip * clip;
            world.xyz() / world.w
        };
        let eye = point(DVec4::Z);
        let forward = point(DVec4::new(0.0, 0.0, 1.0, 1.0)) - eye;
        let plane = forward.length();
        let near = seen.nearest.map_or(plane, f64::from).max(plane);
        let ends = [near / plane, f64::from(seen.far).max(near) / plane];
        let corners = std::array::from_fn(|i| {
            let side = |bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let corner = point(DVec4::new(side(0), side(1), 1.0, 1.0));
            eye + ends[i >> 2] * (corner - eye)
        });
        Self {
            eye,
            axis: forward / plane,
            near,
            corners,
        }
    }

    /// Corners of what of the bounds is in the frustum.
    fn body(&self, bounds: &Bounds) -> Vec<DVec3> {
        let boxes = [corners(bounds), self.corners];
        let mut body = Vec::new();
        for (own, other) in [(0, 1), (1, 0)] {
            let planes = planes(&boxes[other]);
            for face in FACES {
                let face = face.map(|corner| boxes[own][corner]).to_vec();
                body.extend(
                    planes
                        .iter()
                        .fold(face, |face, plane| clipped(&face, plane)),
                );
            }
        }
        body
    }
}

/// A point of each face and its normal inwards.
fn planes(corners: &[DVec3; 8]) -> [(DVec3, DVec3); 6] {
    let middle = corners.iter().sum::<DVec3>() / 8.0;
    FACES.map(|face| {
        let [a, b, c, _] = face.map(|corner| corners[corner]);
        let normal = (b - a).cross(c - a);
        (a, normal * normal.dot(middle - a).signum())
    })
}

/// What of a polygon is inside a plane.
fn clipped(polygon: &[DVec3], (point, normal): &(DVec3, DVec3)) -> Vec<DVec3> {
    let inside = |corner: DVec3| normal.dot(corner - point);
    let mut kept = Vec::new();
    for (k, &to) in polygon.iter().enumerate() {
        let from = polygon[(k + polygon.len() - 1) % polygon.len()];
        let (a, b) = (inside(from), inside(to));
        if a * b < 0.0 {
            kept.push(from.lerp(to, a / (a - b)));
        }
        if b >= 0.0 {
            kept.push(to);
        }
    }
    kept
}
