//! What a texel holds.

use glam::DVec3;

use super::emitter::PreparedLight;
use super::layout::{ChartTriangle, LightMapLayout};
use super::piece::{Piece, Place, area};
use super::sequence::{Sequence, shift};
use crate::reference::geometry::{Geometry, SurfacePoint};

/// The mean visibility of a texel, and the part of the texel that it is the mean over.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Texel {
    pub visibility: f32,
    /// 0 where nothing is that the light could reach.
    pub weight: f32,
}

/// All that a texel is baked from.
pub(super) struct Baker<'a> {
    pub geometry: &'a Geometry,
    pub layout: &'a LightMapLayout,
    pub light: PreparedLight,
    pub sequence: Sequence,
    pub samples: u32,
}

/// A triangle of a texel's covered part, as the sequence's points fill it.
struct Share<'a> {
    owner: &'a ChartTriangle,
    corners: [Place; 3],
    /// Covered area before it, and its own.
    before: f64,
    area: f64,
}

impl Baker<'_> {
    /// A row of texels from the left.
    pub fn row(&self, y: u32) -> Vec<Texel> {
        let mut texels = vec![Texel::default(); self.layout.size()[0] as usize];
        let pieces = self.layout.pieces(y);
        for of_texel in pieces.chunk_by(|a, b| a.0 == b.0) {
            let x = of_texel[0].0;
            texels[x as usize] = self.texel(of_texel, shift(x, y));
        }
        texels
    }

    fn texel(&self, pieces: &[(u32, &ChartTriangle, Piece)], shift: [u32; 4]) -> Texel {
        let shares = shares(pieces);
        let covered = shares.last().map_or(0.0, |last| last.before + last.area);
        let whole = match pieces {
            [(_, owner, piece)] => piece.whole_texel().map(|corners| (*owner, corners)),
            _ => None,
        };
        let (mut counted, mut visible) = (0_u32, 0_u32);
        for number in 0..self.samples {
            let [u, v, s, t] = self.sequence.point(number, shift);
            let (owner, weights) = match whole {
                Some((owner, corners)) => (owner, in_parallelogram(&corners, [u, v])),
                None => in_shares(&shares, u * covered, v),
            };
            if let Some(sees) = self.sees(owner, weights, [s, t]) {
                counted += 1;
                visible += u32::from(sees);
            }
        }
        if counted == 0 {
            return Texel::default();
        }
        let part = f64::from(counted) / f64::from(self.samples);
        Texel {
            visibility: (f64::from(visible) / f64::from(counted)) as f32,
            weight: (covered * part) as f32,
        }
    }

    /// Whether a point of a triangle sees a place on the light; `None` where there is no light to see: turned away from
    /// its middle, out of its range, outside its cone.
    fn sees(&self, owner: &ChartTriangle, weights: DVec3, on_light: [f64; 2]) -> Option<bool> {
        let world = &owner.world;
        let corners = world.corners.iter().zip(weights.to_array());
        let position: DVec3 = corners.map(|(corner, weight)| weight * *corner).sum();
        let side = world.light_side(self.light.centre());
        let faces = match owner.front {
            0.0 => side != 0.0,
            front => side * front > 0.0,
        };
        if !faces || !self.light.lighting.reaches(position) {
            return None;
        }
        let place = self.light.place(position, on_light);
        // No triangle of the scene is the receiver's own by number: those that hold the point are known by their planes.
        let surface = SurfacePoint {
            position,
            triangle: u32::MAX,
            size: world.size(),
        };
        Some(world.light_side(place) == side && !self.geometry.blocked(&surface, place))
    }
}

/// The triangles of all pieces.
fn shares<'a>(pieces: &[(u32, &'a ChartTriangle, Piece)]) -> Vec<Share<'a>> {
    let mut before = 0.0;
    let mut shares = Vec::with_capacity(2 * pieces.len());
    for (_, owner, piece) in pieces {
        for corners in piece.fan() {
            let area = area(&corners);
            if area > 0.0 {
                shares.push(Share {
                    owner,
                    corners,
                    before,
                    area,
                });
                before += area;
            }
        }
    }
    shares
}

/// The place of a texel that its four corners hold, by three of them.
fn in_parallelogram([a, b, d]: &[Place; 3], [u, v]: [f64; 2]) -> DVec3 {
    let weights = a.weights + u * (b.weights - a.weights) + v * (d.weights - a.weights);
    weights.max(DVec3::ZERO)
}

/// The place that is `along` the covered area: uniform over it.
fn in_shares<'a>(shares: &[Share<'a>], along: f64, v: f64) -> (&'a ChartTriangle, DVec3) {
    let place = shares.partition_point(|share| share.before <= along);
    let share = &shares[place.saturating_sub(1)];
    // Uniform over a triangle (Turk, "Generating Random Points in Triangles", 1990).
    let root = ((along - share.before) / share.area).clamp(0.0, 1.0).sqrt();
    let [a, b, c] = share.corners.map(|corner| corner.weights);
    let weights = (1.0 - root) * a + root * ((1.0 - v) * b + v * c);
    (share.owner, weights)
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::reference::geometry::Triangle;

    /// Points of the shares of a clipped triangle are spread over it in proportion to area.
    #[test]
    fn points_fill_what_is_covered_and_nothing_else() {
        let at = [
            DVec2::new(-0.5, 0.1),
            DVec2::new(1.7, 0.3),
            DVec2::new(0.2, 1.9),
        ];
        let owner = ChartTriangle::for_test(
            Triangle {
                corners: at.map(|at| at.extend(0.0)),
                source: [0, 0],
            },
            at,
        );
        let piece = Piece::of(&at).between(1, 0.0, 1.0).between(0, 0.0, 1.0);
        let pieces = [(0, &owner, piece)];
        let shares = shares(&pieces);
        let covered = piece.area();
        assert!(covered > 0.3 && covered < 0.9 && shares.len() >= 2);
        let sequence = Sequence::new();
        let count = 4096;
        let (mut left, mut sum) = (0, DVec2::ZERO);
        for number in 0..count {
            let [u, v, ..] = sequence.point(number, [0; 4]);
            let (_, weights) = in_shares(&shares, u * covered, v);
            assert!(weights.min_element() >= 0.0);
            let place: DVec2 = at.iter().zip(weights.to_array()).map(|(c, w)| w * *c).sum();
            assert!(place.min_element() >= -1e-12 && place.max_element() <= 1.0 + 1e-12);
            left += u32::from(place.x < 0.5);
            sum += place;
        }
        let half = piece.between(0, 0.0, 0.5).area() / covered;
        let found = f64::from(left) / f64::from(count);
        assert!((found - half).abs() < 3e-3, "{found} {half}");
        // The twin: as if each share were as large as the others.
        let even = f64::from(u8::from(shares[0].corners.iter().all(|c| c.at.x <= 0.5)));
        assert!((even - half).abs() > 0.05);
    }
}
