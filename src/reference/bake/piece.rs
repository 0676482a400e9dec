//! The part of a triangle that lies in a texel.

use glam::{DVec2, DVec3};

/// A place on a triangle: in the map, in texels, and by the weights of the triangle's corners.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    pub at: DVec2,
    pub weights: DVec3,
}

impl Place {
    fn between(self, other: Self, part: f64) -> Self {
        Self {
            at: self.at.lerp(other.at, part),
            weights: self.weights.lerp(other.weights, part),
        }
    }
}

/// A convex polygon: what four half-planes leave of a triangle has at most seven corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    corners: [Place; 8],
    count: usize,
}

impl Piece {
    /// A whole triangle.
    pub fn of(triangle: &[DVec2; 3]) -> Self {
        let mut corners = [Place::default(); 8];
        for (k, corner) in corners[..3].iter_mut().enumerate() {
            corner.at = triangle[k];
            corner.weights[k] = 1.0;
        }
        Self { corners, count: 3 }
    }

    pub fn corners(&self) -> &[Place] {
        &self.corners[..self.count]
    }

    /// The part between two coordinates of an axis (Sutherland and Hodgman, "Reentrant Polygon Clipping", 1974).
    pub fn between(&self, axis: usize, low: f64, high: f64) -> Self {
        self.beyond(axis, low, 1.0).beyond(axis, high, -1.0)
    }

    fn beyond(&self, axis: usize, bound: f64, sign: f64) -> Self {
        let mut kept = Self {
            corners: [Place::default(); 8],
            count: 0,
        };
        let inside = |place: &Place| (place.at[axis] - bound) * sign;
        let corners = self.corners();
        for (k, &to) in corners.iter().enumerate() {
            let from = corners[(k + corners.len() - 1) % corners.len()];
            let (a, b) = (inside(&from), inside(&to));
            if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
                let mut met = from.between(to, a / (a - b));
                met.at[axis] = bound;
                kept.push(met);
            }
            if b >= 0.0 {
                kept.push(to);
            }
        }
        kept
    }

    fn push(&mut self, place: Place) {
        // Rounding may not make a corner more than geometry has.
        if let Some(free) = self.corners.get_mut(self.count) {
            *free = place;
            self.count += 1;
        }
    }

    /// In square texels.
    pub fn area(&self) -> f64 {
        self.fan().map(|triangle| area(&triangle)).sum()
    }

    /// The triangles that make it up.
    pub fn fan(&self) -> impl Iterator<Item = [Place; 3]> + '_ {
        let corners = self.corners();
        let last = corners.len().saturating_sub(1);
        (1..last).map(|k| [corners[0], corners[k], corners[k + 1]])
    }

    /// Its corners as a parallelogram's, if it is a whole texel.
    pub fn whole_texel(&self) -> Option<[Place; 3]> {
        let is_whole = self.count == 4 && self.area() >= 1.0 - 1e-12;
        is_whole.then(|| [self.corners[0], self.corners[1], self.corners[3]])
    }
}

/// Of a triangle, in square texels.
pub(super) fn area(triangle: &[Place; 3]) -> f64 {
    let [a, b, c] = triangle.map(|place| place.at);
    0.5 * (b - a).perp_dot(c - a).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pieces_of_a_triangle_make_it_up() {
        let triangle = [
            DVec2::new(0.3, 0.2),
            DVec2::new(6.7, 1.4),
            DVec2::new(2.1, 5.9),
        ];
        let whole = Piece::of(&triangle);
        let mut sum = 0.0;
        let mut whole_texels = 0;
        for y in 0..7 {
            let row = whole.between(1, f64::from(y), f64::from(y + 1));
            for x in 0..7 {
                let piece = row.between(0, f64::from(x), f64::from(x + 1));
                sum += piece.area();
                whole_texels += usize::from(piece.whole_texel().is_some());
                for corner in piece.corners() {
                    let weights = corner.weights.to_array();
                    assert!(weights.iter().all(|w| (-1e-12..=1.0 + 1e-12).contains(w)));
                    let at: DVec2 = triangle.iter().zip(weights).map(|(c, w)| w * *c).sum();
                    assert!((at - corner.at).length() < 1e-12, "{at} {corner:?}");
                }
            }
        }
        assert!((sum - whole.area()).abs() < 1e-12, "{sum}");
        assert!(whole_texels > 4);
        // The twin: a map one column short.
        let short = whole.between(0, 0.0, 6.0).area();
        assert!(whole.area() - short > 0.05);
    }
}
