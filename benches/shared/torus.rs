//! A closed mesh of as many triangles as one likes.

use std::f32::consts::TAU;

/// A torus of `2 * rings * sectors` triangles, counter-clockwise outside: positions and indices.
pub fn torus(rings: u32, sectors: u32) -> (Vec<[f32; 3]>, Vec<u32>) {
    let angle = |i: u32, n: u32| (i as f32 / n as f32 * TAU).sin_cos();
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for ring in 0..rings {
        for sector in 0..sectors {
            let ((sr, cr), (ss, cs)) = (angle(ring, rings), angle(sector, sectors));
            let radius = 3.0 + cs;
            positions.push([radius * cr, ss, radius * sr]);
            let at = |r: u32, s: u32| (r % rings) * sectors + s % sectors;
            let [a, b] = [at(ring, sector), at(ring, sector + 1)];
            let [c, d] = [at(ring + 1, sector), at(ring + 1, sector + 1)];
            indices.extend([a, b, c, b, d, c]);
        }
    }
    (positions, indices)
}
