//! The area that a polygon covers on screen.

use glam::{DVec2, DVec4, Vec4Swizzles as _};

use crate::volume::decide::scissor::Rect;

/// What of a polygon in clip space is seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Screen {
    /// Width and height in pixels.
    pub size: [f64; 2],
    /// The part of it that is drawn to; `None` for all of it.
    pub rect: Option<Rect>,
    /// Whether what is before the near plane (depth 1, reversed) is cut off.
    pub near_is_clipped: bool,
}

impl Screen {
    /// Pixels covered by a convex polygon whose corners are homogeneous, those at infinity and
    /// behind the eye included (Sutherland and Hodgman, "Reentrant polygon clipping", 1974).
    pub fn area(&self, corners: &[DVec4]) -> f64 {
        let mut polygon = corners.to_vec();
        for plane in self.planes() {
            polygon = clipped(&polygon, plane);
        }
        let scale = DVec2::from(self.size) * 0.5;
        // All points left have w >= 0, and 0 only at the eye itself.
        let points: Vec<DVec2> = polygon
            .iter()
            .filter(|p| p.w > 0.0)
            .map(|p| p.xy() / p.w * scale)
            .collect();
        let Some(&first) = points.first() else {
            return 0.0;
        };
        let twice: f64 = points
            .windows(2)
            .map(|pair| (pair[0] - first).perp_dot(pair[1] - first))
            .sum();
        0.5 * twice.abs()
    }

    /// Planes whose product with a point is not negative where the point is seen.
    fn planes(&self) -> Vec<DVec4> {
        let [width, height] = self.size;
        let all = [0.0, 0.0, width, height];
        let [x, y, w, h] = self.rect.map_or(all, |rect| rect.map(f64::from));
        let (left, right) = (2.0 * x / width - 1.0, 2.0 * (x + w) / width - 1.0);
        let (top, bottom) = (1.0 - 2.0 * y / height, 1.0 - 2.0 * (y + h) / height);
        let mut planes = vec![
            DVec4::new(1.0, 0.0, 0.0, -left),
            DVec4::new(-1.0, 0.0, 0.0, right),
            DVec4::new(0.0, 1.0, 0.0, -bottom),
            DVec4::new(0.0, -1.0, 0.0, top),
        ];
        if self.near_is_clipped {
            planes.push(DVec4::new(0.0, 0.0, -1.0, 1.0));
        }
        planes
    }
}

fn clipped(polygon: &[DVec4], plane: DVec4) -> Vec<DVec4> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (place, &from) in polygon.iter().enumerate() {
        let to = polygon[(place + 1) % polygon.len()];
        let (a, b) = (plane.dot(from), plane.dot(to));
        if a >= 0.0 {
            kept.push(from);
        }
        if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
            kept.push(from.lerp(to, a / (a - b)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: Screen = Screen {
        size: [200.0, 100.0],
        rect: None,
        near_is_clipped: false,
    };

    fn point(x: f64, y: f64, w: f64) -> DVec4 {
        DVec4::new(x, y, 0.1, w)
    }

    fn close(found: f64, right: f64) {
        assert!(
            (found - right).abs() < 1e-9 * right.max(1.0),
            "{found}, {right}"
        );
    }

    #[test]
    fn polygons_cover_their_area() {
        let half = [
            point(-1.0, -1.0, 1.0),
            point(1.0, -1.0, 1.0),
            point(-1.0, 1.0, 1.0),
        ];
        close(ALL.area(&half), 10_000.0);
        // Homogeneous: the same place, whatever w.
        close(ALL.area(&half.map(|p| 3.0 * p)), 10_000.0);
        // Of a polygon that is larger than the screen, only the screen counts.
        let large = [(-9.0, -9.0), (27.0, -9.0), (-9.0, 27.0)];
        close(ALL.area(&large.map(|(x, y)| point(x, y, 1.0))), 20_000.0);
        let beside = half.map(|p| p + point(3.0, 0.0, 0.0));
        close(ALL.area(&beside), 0.0);
    }

    #[test]
    fn corners_at_infinity_and_behind_the_eye_are_clipped() {
        // From the middle to the right without end, between y = 0 and y = 1.
        let strip = [
            point(0.0, 0.0, 1.0),
            point(1.0, 0.0, 0.0),
            point(1.0, 1e-12, 0.0),
            point(0.0, 1.0, 1.0),
        ];
        close(ALL.area(&strip), 5_000.0);
        // A corner behind the eye: the triangle grows beyond the edge of the screen.
        let behind = [
            point(0.0, 0.0, 1.0),
            point(4.0, 0.0, -1.0),
            point(0.0, 1.0, 1.0),
        ];
        let area = ALL.area(&behind);
        assert!(area > 2_500.0 && area <= 5_000.0 + 1e-6, "{area}");
    }

    #[test]
    fn the_scissor_and_the_near_plane_cut() {
        let all = [
            point(-1.0, -1.0, 1.0),
            point(1.0, -1.0, 1.0),
            point(1.0, 1.0, 1.0),
            point(-1.0, 1.0, 1.0),
        ];
        let cut = Screen {
            rect: Some([10, 20, 30, 40]),
            ..ALL
        };
        close(cut.area(&all), 1_200.0);
        let near = Screen {
            near_is_clipped: true,
            ..ALL
        };
        let crossing = [
            all[0].with_z(0.0),
            all[1].with_z(2.0),
            all[2].with_z(2.0),
            all[3].with_z(0.0),
        ];
        close(near.area(&crossing), 10_000.0);
        close(ALL.area(&crossing), 20_000.0);
    }
}
