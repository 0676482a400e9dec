//! Whether two triangles of a receiver lie on one another in its texture coordinates.

use glam::DVec2;

use super::piece::Piece;

/// How far two triangles may lie on one another, relative to the largest coordinate, which is at most 1: what
/// rounding of corners to f32 makes of triangles that touch.
const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;

/// The first triangle that overlaps one before it, and the first of those it overlaps: places in the list, the
/// smaller first.
pub(super) fn first_overlap(triangles: &[[DVec2; 3]]) -> Option<[usize; 2]> {
    let mut grid = Grid::new(triangles.len());
    (0..triangles.len()).find_map(|place| {
        let other = grid.insert(triangles, place)?;
        Some([other, place])
    })
}

/// Cells of the unit square with the triangles that touch each: at most a few as long as none overlap, whatever
/// their shapes.
struct Grid {
    side: usize,
    cells: Vec<Vec<u32>>,
}

impl Grid {
    fn new(count: usize) -> Self {
        let side = ((count as f64).sqrt().ceil() as usize).clamp(1, 4096);
        Self {
            side,
            cells: vec![Vec::new(); side * side],
        }
    }

    /// Adds a triangle; gives the first of those that are there that it overlaps.
    fn insert(&mut self, triangles: &[[DVec2; 3]], place: usize) -> Option<usize> {
        let side = self.side as f64;
        let triangle = triangles[place].map(|corner| corner * side);
        let last = self.side - 1;
        // The first cell that both touch says nothing of the order in the list: all are asked.
        let mut first: Option<usize> = None;
        let cells = |low: f64, high: f64| {
            let cell = |at: f64| (at.max(0.0) as usize).min(last);
            cell(low - 1e-9)..=cell(high + 1e-9)
        };
        let [a, b, c] = triangle;
        for row in cells(a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y)) {
            let (low, high) = (row as f64 - 1e-9, (row + 1) as f64 + 1e-9);
            let band = Piece::of(&triangle).between(1, low, high);
            let across = band.corners().iter().map(|corner| corner.at.x);
            let low = across.clone().fold(f64::INFINITY, f64::min);
            let high = across.fold(f64::NEG_INFINITY, f64::max);
            if low > high {
                continue;
            }
            for column in cells(low, high) {
                let cell = &mut self.cells[row * self.side + column];
                // In the order of the list, so that none behind the first found so far is looked at.
                let earlier = cell.iter().map(|&other| other as usize);
                let met = earlier
                    .take_while(|&other| first.is_none_or(|first| other < first))
                    .find(|&other| overlap(&triangles[other], &triangles[place]));
                first = met.or(first);
                cell.push(place as u32);
            }
        }
        first
    }
}

/// Whether two triangles share more than their borders: no edge of either has them on different sides.
pub(super) fn overlap(a: &[DVec2; 3], b: &[DVec2; 3]) -> bool {
    !is_beside(a, b) && !is_beside(b, a)
}

/// Whether an edge of `triangle` has all of `other` on its outer side.
fn is_beside(triangle: &[DVec2; 3], other: &[DVec2; 3]) -> bool {
    let [a, b, c] = *triangle;
    let turn = (b - a).perp_dot(c - a).signum();
    (0..3).any(|k| {
        let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
        let along = to - from;
        let bound = ROUNDING * along.length();
        let outside = |corner: &DVec2| turn * along.perp_dot(*corner - from) <= bound;
        other.iter().all(outside)
    })
}
