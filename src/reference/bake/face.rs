//! A receiver's triangle, checked.

use glam::{DVec2, DVec3};

use super::charts::Vertex;
use super::layout::{LightMapReceiver, SEVERAL};
use crate::error::LightMapError;
use crate::reference::geometry::Triangle;

/// A triangle of a receiver, before it is known to be one.
pub(super) struct Face<'a> {
    pub receiver: &'a LightMapReceiver<'a>,
    pub number: usize,
    pub place: usize,
    pub face: [u32; 3],
}

impl Face<'_> {
    /// Position and texture coordinates of each corner, bit by bit.
    pub fn vertices(&self) -> [Vertex; 3] {
        self.face.map(|index| {
            let [x, y, z] = self.receiver.positions[index as usize];
            let [u, v] = self.receiver.uvs[index as usize];
            [x, y, z, u, v].map(f32::to_bits)
        })
    }

    /// World corners and texture coordinates; `None` if there is no area that could be seen.
    pub fn checked(&self) -> Result<Option<(Triangle, [DVec2; 3])>, LightMapError> {
        let mut corners = [DVec3::ZERO; 3];
        for (corner, index) in corners.iter_mut().zip(self.face) {
            *corner = self.corner(index)?;
        }
        let world = Triangle {
            corners,
            source: [number(self.number, 0)?, number(self.place, 0)?],
        };
        if is_thin(&world) {
            return Ok(None);
        }
        let mut uvs = [DVec2::ZERO; 3];
        for (uv, index) in uvs.iter_mut().zip(self.face) {
            *uv = self.uv(index)?;
        }
        let [a, b, c] = uvs;
        match (b - a).perp_dot(c - a) == 0.0 {
            true => Err(LightMapError::UvNoArea {
                receiver: self.number,
                triangle: self.place,
            }),
            false => Ok(Some((world, uvs))),
        }
    }

    fn corner(&self, index: u32) -> Result<DVec3, LightMapError> {
        let position = self.receiver.positions.get(index as usize);
        let position = position.ok_or(LightMapError::IndexOutOfRange {
            receiver: self.number,
            triangle: self.place,
            index,
            vertices: self.receiver.positions.len(),
        })?;
        let position = DVec3::from_array(position.map(f64::from));
        let world = self.receiver.transform.transform_point3(position);
        match world.is_finite() {
            true => Ok(world),
            false => Err(LightMapError::Position {
                receiver: self.number,
                vertex: index,
            }),
        }
    }

    fn uv(&self, index: u32) -> Result<DVec2, LightMapError> {
        let uv = self.receiver.uvs[index as usize];
        match uv.iter().all(|part| (0.0..=1.0).contains(part)) {
            true => Ok(DVec2::from_array(uv.map(f64::from))),
            false => Err(LightMapError::Uv {
                receiver: self.number,
                triangle: self.place,
                uv,
            }),
        }
    }
}

/// A count in 32 bits, if as many more could be counted, too.
pub(super) fn number(count: usize, more: usize) -> Result<u32, LightMapError> {
    let all = count.saturating_add(more);
    match (u32::try_from(count), u32::try_from(all)) {
        (Ok(count), Ok(all)) if all < SEVERAL => Ok(count),
        _ => Err(LightMapError::TooLarge(all)),
    }
}

/// Whether a triangle is no thicker than what rounding its corners to f32 could make of it.
fn is_thin(triangle: &Triangle) -> bool {
    let [a, b, c] = triangle.corners;
    let longest = [b - a, c - b, a - c].map(DVec3::length).into_iter();
    let longest = longest.fold(0.0, f64::max);
    let size = a.abs().max(b.abs()).max(c.abs()).max_element();
    let thickness = 4.0 * f64::from(f32::EPSILON) * size;
    triangle.normal().length() <= thickness * longest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_32_bits_can_count_is_refused() {
        let most = SEVERAL as usize - 1;
        assert_eq!(number(most, 0), Ok(SEVERAL - 1));
        assert_eq!(number(most - 2, 2), Ok(SEVERAL - 3));
        for (count, more) in [(most + 1, 0), (0, most + 1), (usize::MAX, 1)] {
            let all = count.saturating_add(more);
            assert_eq!(number(count, more), Err(LightMapError::TooLarge(all)));
        }
    }
}
