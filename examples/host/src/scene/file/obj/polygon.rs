//! Polygons as triangles.

use shadows::glam::{DVec2, DVec3};

/// The triangles of a polygon from its first corner: right where it is convex.
pub fn fan(corners: usize) -> Vec<[usize; 3]> {
    (2..corners).map(|i| [0, i - 1, i]).collect()
}

/// Cuts a polygon's ears off, one by one (Meisters 1975: every polygon that does not cross itself has
/// two). All corners stay in use, also those on a straight side, so that neighbours still meet; a convex
/// polygon becomes its [`fan`]. `None` if it crosses itself, or has no area.
pub fn triangles(corners: &[DVec3]) -> Option<Vec<[usize; 3]>> {
    if corners.len() <= 3 {
        return Some(fan(corners.len()));
    }
    let flat = flattened(corners)?;
    let mut ring: Vec<usize> = (0..flat.len()).collect();
    let mut triangles = Vec::with_capacity(flat.len() - 2);
    while ring.len() > 3 {
        let order = || (1..ring.len()).chain([0]);
        let strict = order().find(|&at| is_ear(&flat, &ring, at));
        // A corner on a straight side, or one given twice.
        let place = strict.or_else(|| order().find(|&at| turn(&flat, around(&ring, at)) == 0.0))?;
        triangles.push(around(&ring, place));
        ring.remove(place);
    }
    triangles.push([ring[0], ring[1], ring[2]]);
    (turn(&flat, [ring[0], ring[1], ring[2]]) >= 0.0).then_some(triangles)
}

/// Without the coordinate along which its normal is longest (Newell's), counter-clockwise: differences
/// of `f32` numbers, and mostly their products, are exact then.
fn flattened(corners: &[DVec3]) -> Option<Vec<DVec2>> {
    let first = corners[0];
    let next = corners.iter().cycle().skip(1);
    let pairs = corners.iter().zip(next);
    let normal: DVec3 = pairs.map(|(a, b)| (a - first).cross(b - first)).sum();
    let axis = normal.abs().max_position();
    if normal[axis] == 0.0 {
        return None;
    }
    let [u, v] = match normal[axis] > 0.0 {
        true => [(axis + 1) % 3, (axis + 2) % 3],
        false => [(axis + 2) % 3, (axis + 1) % 3],
    };
    Some(corners.iter().map(|p| DVec2::new(p[u], p[v])).collect())
}

/// A place of the ring between its neighbours.
fn around(ring: &[usize], at: usize) -> [usize; 3] {
    let count = ring.len();
    [
        ring[(at + count - 1) % count],
        ring[at],
        ring[(at + 1) % count],
    ]
}

/// Twice the area, positive for a turn to the left.
fn turn(flat: &[DVec2], [a, b, c]: [usize; 3]) -> f64 {
    (flat[b] - flat[a]).perp_dot(flat[c] - flat[a])
}

/// Whether a corner is convex, and nothing of the ring is in the triangle that it is cut off with.
fn is_ear(flat: &[DVec2], ring: &[usize], at: usize) -> bool {
    let [a, b, c] = around(ring, at);
    let inside = |p: usize| {
        [[a, b], [b, c], [c, a]]
            .iter()
            .all(|side| turn(flat, [side[0], side[1], p]) >= 0.0)
    };
    // Holes are often joined to the outline by a seam, whose corners are there twice.
    let apart = |p: &usize| [a, b, c].iter().all(|corner| flat[*p] != flat[*corner]);
    turn(flat, [a, b, c]) > 0.0 && !ring.iter().filter(|p| apart(p)).any(|&p| inside(p))
}
