//! Welding within a distance, by a grid.
//!
//! In the order of their indices, each vertex joins the lowest-indexed representative within the
//! distance, or becomes a representative itself. Representatives are thus farther apart than the
//! distance, and a cell 2.5 distances wide holds no more than 60 of them (the densest packing of
//! spheres; Hales 2005): a vertex looks at eight such cells at most, however many vertices crowd
//! together. The rule does not chain: a row of vertices, each close to the next, does not collapse
//! into its first.

use super::weld;

/// Cells are this many distances wide.
const CELL: f64 = 2.5;

/// How far a neighbour can be along one axis, in cells: `1 / CELL` and some room for rounding.
const REACH: f64 = 0.41;

const NONE: u32 = u32::MAX;

/// Welds the representatives of an exact weld further. `tolerance` is a fraction of the largest
/// side of the positions' bounds.
pub(super) fn weld_near(positions: &[[f32; 3]], representatives: &mut [u32], tolerance: f32) {
    let distance = f64::from(tolerance) * size(positions);
    if distance == 0.0 {
        return;
    }
    let mut grid = Grid::new(positions, distance, distinct(representatives));
    for vertex in 0..representatives.len() {
        // The lowest vertex at a position comes first, so its own representative is final here.
        // Equal positions need no search of their own: the rule gives them the same answer.
        let exact = representatives[vertex] as usize;
        representatives[vertex] = if exact == vertex {
            grid.find_or_insert(vertex as u32)
        } else {
            representatives[exact]
        };
    }
}

fn distinct(representatives: &[u32]) -> usize {
    let own = representatives.iter().zip(0u32..);
    own.filter(|(representative, vertex)| *representative == vertex)
        .count()
}

/// The largest side of the positions' bounds.
fn size(positions: &[[f32; 3]]) -> f64 {
    (0..3)
        .map(|axis| {
            let side = positions.iter().map(|position| position[axis]);
            let (low, high) = side.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), x| {
                (low.min(x), high.max(x))
            });
            f64::from(high) - f64::from(low)
        })
        .fold(0.0, f64::max)
}

struct Grid<'a> {
    positions: &'a [[f32; 3]],
    distance: f64,
    /// First representative in each bucket of cells, or [`NONE`].
    heads: Vec<u32>,
    /// The next representative in the same bucket, by representative.
    next: Vec<u32>,
    shift: u32,
}

impl<'a> Grid<'a> {
    fn new(positions: &'a [[f32; 3]], distance: f64, representatives: usize) -> Self {
        let bits = (usize::BITS - representatives.leading_zeros()).clamp(4, 31);
        Self {
            positions,
            distance,
            heads: vec![NONE; 1 << bits],
            next: vec![NONE; positions.len()],
            shift: 32 - bits,
        }
    }

    fn find_or_insert(&mut self, vertex: u32) -> u32 {
        let position = self.positions[vertex as usize].map(f64::from);
        let cells = position.map(|x| x / (CELL * self.distance));
        let ends = cells.map(|q| [(q - REACH).floor() + 0.0, (q + REACH).floor() + 0.0]);
        let mut found = NONE;
        for x in distinct_ends(ends[0]) {
            for y in distinct_ends(ends[1]) {
                for z in distinct_ends(ends[2]) {
                    found = found.min(self.search([x, y, z], position));
                }
            }
        }
        if found != NONE {
            return found;
        }
        let bucket = self.bucket(cells.map(|q| q.floor() + 0.0));
        self.next[vertex as usize] = self.heads[bucket];
        self.heads[bucket] = vertex;
        vertex
    }

    /// The lowest representative near the position in the bucket of a cell.
    fn search(&self, cell: [f64; 3], position: [f64; 3]) -> u32 {
        let mut found = NONE;
        let mut other = self.heads[self.bucket(cell)];
        while other != NONE {
            let at = self.positions[other as usize].map(f64::from);
            let [dx, dy, dz] = [0, 1, 2].map(|axis| at[axis] - position[axis]);
            if dx * dx + dy * dy + dz * dz <= self.distance * self.distance {
                found = found.min(other);
            }
            other = self.next[other as usize];
        }
        found
    }

    fn bucket(&self, cell: [f64; 3]) -> usize {
        let words = cell.map(|q| {
            let bits = q.to_bits();
            (bits >> 32) as u32 ^ (bits as u32).rotate_left(7)
        });
        (weld::hash(words) >> self.shift) as usize
    }
}

fn distinct_ends(ends: [f64; 2]) -> impl Iterator<Item = f64> + Clone {
    let second = (ends[1] != ends[0]).then_some(ends[1]);
    std::iter::once(ends[0]).chain(second)
}
