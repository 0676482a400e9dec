//! The part of the target that a light's range covers.

use glam::{DVec3, DVec4, Vec4Swizzles as _};

use crate::View;

/// Pixels: left, top, width, height.
pub(crate) type Rect = [u32; 4];

/// The smallest rectangle of whole pixels around what a sphere covers on screen, one pixel wider on
/// each side for what f32 makes of the view. `None` if it covers nothing.
///
/// Along each screen axis the bounds are the two planes through the eye that touch the sphere
/// (Lengyel, "The Mechanics of Robust Stencil Shadows", 2002; Mara and McGuire, "2D Polyhedral
/// Bounds of a Clipped, Perspective-Projected 3D Sphere", 2013).
pub(crate) fn of_sphere(view: &View, centre: DVec3, radius: f64, target: [u32; 2]) -> Option<Rect> {
    let matrix = view.clip_from_world().as_dmat4();
    let w = matrix.row(3);
    let [left, right] = bounds(matrix.row(0), w, centre, radius)?;
    let [bottom, top] = bounds(matrix.row(1), w, centre, radius)?;
    let [x, width] = pixels([left, right], target[0])?;
    let [y, height] = pixels([-top, -bottom], target[1])?;
    Some([x, y, width, height])
}

/// The smallest rectangle that holds two others.
pub(crate) fn around(a: Rect, b: Rect) -> Rect {
    let [x, y] = [0, 1].map(|axis| a[axis].min(b[axis]));
    let [right, bottom] = [0, 1].map(|axis| (a[axis] + a[axis + 2]).max(b[axis] + b[axis + 2]));
    [x, y, right - x, bottom - y]
}

/// Bounds of `row . p / w . p` over a sphere, in clip space; all of it where the sphere reaches the
/// plane w = 0; `None` behind that.
fn bounds(row: DVec4, w: DVec4, centre: DVec3, radius: f64) -> Option<[f64; 2]> {
    let centre = centre.extend(1.0);
    let (p, q) = (row.dot(centre), w.dot(centre));
    let squared = radius * radius;
    // The plane row - s w touches the sphere: a s^2 - 2 b s + c = 0.
    let a = q * q - squared * w.xyz().length_squared();
    if a <= 0.0 {
        return Some([-1.0, 1.0]);
    }
    if q < 0.0 {
        return None;
    }
    let b = p * q - squared * row.xyz().dot(w.xyz());
    let c = p * p - squared * row.xyz().length_squared();
    let root = (b * b - a * c).max(0.0).sqrt();
    Some([(b - root) / a, (b + root) / a])
}

/// First pixel and number of pixels between two places of clip space, -1 being pixel 0.
fn pixels([from, to]: [f64; 2], size: u32) -> Option<[u32; 2]> {
    let size = f64::from(size);
    let pixel = |clip: f64| (clip + 1.0) * 0.5 * size;
    let first = (pixel(from).floor() - 1.0).max(0.0);
    let end = (pixel(to).ceil() + 1.0).min(size);
    (first < end).then_some([first as u32, (end - first) as u32])
}

#[cfg(test)]
mod tests {
    use glam::camera::rh::{proj::directx as proj, view};
    use glam::{Mat4, Vec3};

    use super::*;
    use crate::DepthConvention;

    const TARGET: [u32; 2] = [320, 200];

    fn views() -> Vec<View> {
        let camera = view::look_at_mat4(Vec3::new(1.0, 2.0, 9.0), Vec3::ZERO, Vec3::Y);
        let mut skewed = proj::perspective_infinite_reverse(1.2, 1.6, 0.1);
        skewed.z_axis.x = 0.4;
        skewed.z_axis.y = -0.3;
        let perspective: Vec<Mat4> = vec![
            proj::perspective_infinite_reverse(0.9, 1.6, 0.1),
            proj::perspective_infinite_reverse(2.6, 1.6, 0.1),
            skewed,
        ];
        let mut views: Vec<View> = perspective
            .iter()
            .map(|p| View::new(*p * camera, DepthConvention::InfiniteReverse).unwrap())
            .collect();
        let parallel = proj::orthographic(-4.0, 4.0, -3.0, 3.0, 0.1, 30.0);
        views.push(View::new(parallel * camera, DepthConvention::Standard).unwrap());
        views
    }

    /// The pixels that points all over the sphere are in, if they are on the target.
    fn sampled(view: &View, centre: DVec3, radius: f64) -> Option<[f64; 4]> {
        let mut found: Option<[f64; 4]> = None;
        for i in 0..20_000 {
            let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / 20_000.0;
            let angle = f64::from(i) * 2.399_963_229_728_653;
            let ring = (1.0 - z * z).sqrt();
            let normal = DVec3::new(ring * angle.cos(), ring * angle.sin(), z);
            let point = (centre + normal * radius).extend(1.0);
            let clip = view.clip_from_world().as_dmat4() * point;
            let (x, y) = (clip.x / clip.w, clip.y / clip.w);
            if clip.w <= 0.0 || x.abs() > 1.0 || y.abs() > 1.0 {
                continue;
            }
            let x = (x + 1.0) * 0.5 * f64::from(TARGET[0]);
            let y = (1.0 - y) * 0.5 * f64::from(TARGET[1]);
            let [l, t, r, b] = found.unwrap_or([x, y, x, y]);
            found = Some([l.min(x), t.min(y), r.max(x), b.max(y)]);
        }
        found
    }

    #[test]
    fn the_rectangle_holds_the_sphere_and_little_more() {
        let mut tight = 0;
        for (place, view) in views().iter().enumerate() {
            for (centre, radius) in [
                (DVec3::new(0.0, 0.0, 0.0), 1.0),
                (DVec3::new(2.0, -1.0, 3.0), 0.5),
                (DVec3::new(-3.0, 2.0, -4.0), 2.0),
                (DVec3::new(1.0, 2.0, 8.0), 3.0),
            ] {
                let Some([l, t, r, b]) = sampled(view, centre, radius) else {
                    continue;
                };
                let [x, y, w, h] = of_sphere(view, centre, radius, TARGET)
                    .unwrap()
                    .map(f64::from);
                let what = format!("view {place}, {centre}, {radius}");
                assert!(x <= l && y <= t && x + w >= r && y + h >= b, "{what}");
                assert!(x + w <= 320.0 && y + h <= 200.0, "{what}");
                // Two pixels of margin and rounding, and a little for the finite sampling.
                let slack = [l - x, t - y, x + w - r, y + h - b];
                tight += usize::from(slack.iter().all(|s| *s < 4.0));
            }
        }
        assert!(tight >= 8, "only {tight} rectangles are tight");
    }

    #[test]
    fn two_rectangles_are_in_the_one_around_them() {
        assert_eq!(around([2, 9, 3, 4], [4, 1, 10, 2]), [2, 1, 12, 12]);
        assert_eq!(around([0, 0, 8, 8], [2, 3, 1, 1]), [0, 0, 8, 8]);
    }

    #[test]
    fn what_is_behind_or_beside_covers_nothing() {
        let view = &views()[0];
        assert_eq!(
            of_sphere(view, DVec3::new(1.0, 2.0, 30.0), 2.0, TARGET),
            None
        );
        assert_eq!(
            of_sphere(view, DVec3::new(40.0, 0.0, -9.0), 2.0, TARGET),
            None
        );
    }
}
