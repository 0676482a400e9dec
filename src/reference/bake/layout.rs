//! Which texels belong to which receiver.

use std::fmt;
use std::sync::Arc;

use glam::{DAffine3, DVec2};
use rayon::prelude::*;

use super::charts::Charts;
use super::face::{Face, number};
use super::margin::neighbours;
use super::overlap::first_overlap;
use super::piece::Piece;
use crate::error::LightMapError;
use crate::reference::geometry::Triangle;

/// Texels along a side of the largest map: of textures on any WebGPU device.
const MOST: u32 = 8192;

/// Of a texel's charts: none, and more than one.
const NONE: u32 = u32::MAX;
pub(super) const SEVERAL: u32 = u32::MAX - 1;

/// A rectangle of texels in a map, from its top left.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct TexelRectangle {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
}

impl TexelRectangle {
    /// Converts a receiver's own texture coordinates (0 to 1 over the rectangle) to those of the whole map:
    /// two scale factors, then two offsets.
    pub fn scale_and_offset(&self, map_size: [u32; 2]) -> [f32; 4] {
        let [width, height] = map_size.map(f64::from);
        [
            f64::from(self.width) / width,
            f64::from(self.height) / height,
            f64::from(self.x) / width,
            f64::from(self.y) / height,
        ]
        .map(|part| part as f32)
    }

    fn fits(&self, size: [u32; 2]) -> bool {
        let ends = |first: u32, length: u32, side: u32| {
            length > 0 && first.checked_add(length).is_some_and(|end| end <= side)
        };
        ends(self.x, self.width, size[0]) && ends(self.y, self.height, size[1])
    }

    fn overlaps(&self, other: &Self) -> bool {
        let apart = |a: u32, length: u32, b: u32, others: u32| a + length <= b || b + others <= a;
        !apart(self.x, self.width, other.x, other.width)
            && !apart(self.y, self.height, other.y, other.height)
    }
}

/// A mesh that receives shadows, with the texture coordinates of its light map. Each instance is a receiver of its
/// own.
#[derive(Clone, Copy, Debug)]
pub struct LightMapReceiver<'a> {
    /// Vertex positions in object space.
    pub positions: &'a [[f32; 3]],
    /// Three indices into `positions` per triangle.
    pub indices: &'a [u32],
    /// Texture coordinates, one pair per vertex, from (0, 0) at the rectangle's top left to (1, 1) at its bottom right.
    /// Triangles may share edges but must not overlap: each point of the map corresponds to one point of the world.
    pub uvs: &'a [[f32; 2]],
    /// World from object space; applied in f64. It may include mirroring.
    pub transform: DAffine3,
    /// The receiver's part of the map. Rectangles may touch; the texture coordinates should leave margins
    /// between charts.
    pub rectangle: TexelRectangle,
    /// Whether triangles are visible from both sides, like sheets; the side that faces the light is then baked.
    /// Otherwise the front is baked (counter-clockwise in object space), and texels on faces turned away from the light
    /// copy their neighbours, so that they do not darken them across a crease.
    pub two_sided: bool,
}

/// A triangle with a place in the map.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChartTriangle {
    pub world: Triangle,
    /// Of the corners, in texels of the map.
    pub at: [DVec2; 3],
    /// +1 where the front is the side on which the world's corners are counter-clockwise, -1 where it is the other,
    /// 0 where both count.
    pub front: f64,
    chart: u32,
}

#[cfg(test)]
impl ChartTriangle {
    pub fn for_test(world: Triangle, at: [DVec2; 3]) -> Self {
        Self {
            world,
            at,
            front: 1.0,
            chart: 0,
        }
    }
}

/// Checked texture coordinates of receivers, ready for [`bake`](super::super::ReferenceScene::bake). Clones
/// share them.
#[derive(Clone)]
pub struct LightMapLayout {
    size: [u32; 2],
    triangles: Arc<[ChartTriangle]>,
    /// Triangles that touch each row of texels.
    rows: Arc<[Vec<u32>]>,
    coverage: Arc<[f32]>,
    crowded: usize,
}

impl fmt::Debug for LightMapLayout {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("LightMapLayout")
            .field("size", &self.size)
            .field("triangles", &self.triangles.len())
            .field("covered", &self.covered_texels())
            .field("crowded", &self.crowded)
            .finish_non_exhaustive()
    }
}

impl LightMapLayout {
    /// Checks receivers for a map of `size` texels (columns and rows, each from 1 to 8192).
    ///
    /// Triangles without area in the world, or so thin that this depends on the rounding of positions to f32, have no
    /// place in the map, and their texture coordinates are not checked. Touching charts may overlap by the rounding
    /// error of texture coordinates along shared edges (4 ulps of 1).
    ///
    /// # Errors
    /// [`LightMapError`] names the receiver, and the triangle whose texture coordinates are outside 0 to 1, NaN,
    /// without an area, or overlap those of another triangle.
    pub fn new(size: [u32; 2], receivers: &[LightMapReceiver<'_>]) -> Result<Self, LightMapError> {
        if size.iter().any(|side| !(1..=MOST).contains(side)) {
            return Err(LightMapError::Size(size));
        }
        check_rectangles(size, receivers)?;
        let parts = receivers.par_iter().enumerate();
        let parts: Vec<Result<Vec<ChartTriangle>, LightMapError>> = parts
            .map(|(number, receiver)| charted(number, receiver))
            .collect();
        let mut triangles = Vec::new();
        for part in parts {
            let mut part = part?;
            let first = number(triangles.len(), part.len())?;
            part.iter_mut().for_each(|triangle| triangle.chart += first);
            triangles.append(&mut part);
        }
        let rows = rows(size, &triangles);
        let mut layout = Self {
            size,
            triangles: triangles.into(),
            rows: rows.into(),
            coverage: [].into(),
            crowded: 0,
        };
        layout.cover();
        Ok(layout)
    }

    /// Columns and rows of texels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The fraction of each texel that a receiver covers, 0 to 1, row-major from the top left.
    pub fn coverage(&self) -> &[f32] {
        &self.coverage
    }

    /// Number of texels that a receiver covers at least in part.
    pub fn covered_texels(&self) -> usize {
        self.coverage.iter().filter(|part| **part > 0.0).count()
    }

    /// Number of covered texels that a bilinear filter also reads for another chart: those that contain two
    /// charts or have a neighbour of another chart. Shadows bleed between charts there; move the charts two
    /// texels apart. A chart consists of triangles that share vertices (position and texture coordinates).
    pub fn crowded_texels(&self) -> usize {
        self.crowded
    }

    pub(super) fn shared_coverage(&self) -> Arc<[f32]> {
        Arc::clone(&self.coverage)
    }

    /// What lies in each texel of a row, from the left: column, triangle, piece.
    pub(super) fn pieces(&self, y: u32) -> Vec<(u32, &ChartTriangle, Piece)> {
        let mut pieces = Vec::new();
        for &number in &self.rows[y as usize] {
            let triangle = &self.triangles[number as usize];
            let band = Piece::of(&triangle.at).between(1, y.into(), (y + 1).into());
            let across = band.corners().iter().map(|place| place.at.x);
            let low = across.clone().fold(f64::INFINITY, f64::min);
            let high = across.fold(f64::NEG_INFINITY, f64::max);
            if low > high {
                continue;
            }
            for x in low as u32..(high.ceil() as u32).min(self.size[0]) {
                let piece = band.between(0, x.into(), (x + 1).into());
                if piece.area() > 0.0 {
                    pieces.push((x, triangle, piece));
                }
            }
        }
        pieces.sort_by_key(|(x, ..)| *x);
        pieces
    }

    /// Finds coverage, and what is crowded.
    fn cover(&mut self) {
        let row = |y: u32| {
            let mut texels = vec![(0.0_f64, NONE); self.size[0] as usize];
            for (x, triangle, piece) in self.pieces(y) {
                let (covered, chart) = &mut texels[x as usize];
                *covered += piece.area();
                *chart = match *chart {
                    NONE => triangle.chart,
                    same if same == triangle.chart => same,
                    _ => SEVERAL,
                };
            }
            texels
        };
        let rows = (0..self.size[1]).into_par_iter().map(row).flatten_iter();
        let (covered, charts): (Vec<f64>, Vec<u32>) = rows.collect();
        let is_crowded = |at: &usize| {
            let own = charts[*at];
            let foreign = |near: usize| charts[near] != NONE && charts[near] != own;
            let mut near = neighbours(*at, self.size[0] as usize, charts.len());
            own == SEVERAL || (own != NONE && near.any(foreign))
        };
        self.crowded = (0..charts.len()).filter(is_crowded).count();
        self.coverage = covered.iter().map(|part| part.min(1.0) as f32).collect();
    }
}

fn check_rectangles(
    size: [u32; 2],
    receivers: &[LightMapReceiver<'_>],
) -> Result<(), LightMapError> {
    let mut sorted = Vec::with_capacity(receivers.len());
    for (receiver, LightMapReceiver { rectangle, .. }) in receivers.iter().enumerate() {
        if !rectangle.fits(size) {
            return Err(LightMapError::Place {
                receiver,
                rectangle: *rectangle,
                size,
            });
        }
        sorted.push((receiver, *rectangle));
    }
    sorted.sort_by_key(|(_, rectangle)| rectangle.y);
    for (place, (receiver, rectangle)) in sorted.iter().enumerate() {
        let end = rectangle.y + rectangle.height;
        let after = sorted[place + 1..].iter();
        let mut after = after.take_while(|(_, other)| other.y < end);
        if let Some((other, _)) = after.find(|(_, other)| other.overlaps(rectangle)) {
            return Err(LightMapError::PlacesOverlap {
                receivers: [*receiver.min(other), *receiver.max(other)],
            });
        }
    }
    Ok(())
}

/// A receiver's triangles that have an area.
fn charted(
    number: usize,
    receiver: &LightMapReceiver<'_>,
) -> Result<Vec<ChartTriangle>, LightMapError> {
    let count = receiver.indices.len();
    let (faces, rest) = receiver.indices.as_chunks::<3>();
    if !rest.is_empty() {
        return Err(LightMapError::IndexCount {
            receiver: number,
            count,
        });
    }
    let vertices = receiver.positions.len();
    if receiver.uvs.len() != vertices {
        return Err(LightMapError::UvCount {
            receiver: number,
            uvs: receiver.uvs.len(),
            vertices,
        });
    }
    let mut uvs = Vec::new();
    let mut triangles = Vec::new();
    let mut charts = Charts::default();
    for (place, &face) in faces.iter().enumerate() {
        let face = Face {
            receiver,
            number,
            place,
            face,
        };
        let Some((world, uv)) = face.checked()? else {
            continue;
        };
        let front = match receiver.two_sided {
            true => 0.0,
            false => 1.0_f64.copysign(receiver.transform.matrix3.determinant()),
        };
        charts.add(face.vertices());
        triangles.push(ChartTriangle {
            world,
            at: uv.map(|uv| texels(&receiver.rectangle, uv)),
            front,
            chart: 0,
        });
        uvs.push(uv);
    }
    if let Some([first, second]) = first_overlap(&uvs) {
        let triangle = |place: usize| triangles[place].world.source[1] as usize;
        return Err(LightMapError::UvOverlap {
            receiver: number,
            triangles: [triangle(first), triangle(second)],
        });
    }
    for (place, triangle) in triangles.iter_mut().enumerate() {
        triangle.chart = charts.of(place as u32);
    }
    Ok(triangles)
}

fn texels(rectangle: &TexelRectangle, uv: DVec2) -> DVec2 {
    let first = DVec2::new(rectangle.x.into(), rectangle.y.into());
    first + uv * DVec2::new(rectangle.width.into(), rectangle.height.into())
}

fn rows(size: [u32; 2], triangles: &[ChartTriangle]) -> Vec<Vec<u32>> {
    let mut rows = vec![Vec::new(); size[1] as usize];
    for (number, triangle) in triangles.iter().enumerate() {
        let [a, b, c] = triangle.at.map(|corner| corner.y);
        let first = a.min(b).min(c) as usize;
        let end = (a.max(b).max(c).ceil() as usize).min(rows.len());
        for row in &mut rows[first.min(end)..end] {
            row.push(number as u32);
        }
    }
    rows
}
