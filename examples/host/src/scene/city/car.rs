//! A parked car, three materials; 4.1 m long towards +x, standing on y = 0. All closed.

use std::f64::consts::TAU;

use shadows::glam::{DAffine3, DVec3, dvec3};

use super::super::Mesh;
use super::super::surface::Surface;

/// A cross section: where along the car, from which height to which, half how wide.
type Section = (f64, f64, f64, f64);

/// Painted: the body and the roof.
pub fn body() -> Mesh {
    let mut s = loft(&[
        (-2.05, 0.42, 0.68, 0.66),
        (-1.95, 0.3, 0.86, 0.78),
        (-1.3, 0.24, 0.93, 0.86),
        (-0.2, 0.22, 0.95, 0.88),
        (0.95, 0.22, 0.92, 0.87),
        (1.6, 0.26, 0.82, 0.82),
        (1.96, 0.32, 0.7, 0.74),
        (2.08, 0.42, 0.58, 0.6),
    ]);
    let roof = [
        (-1.32, 1.27, 1.36, 0.52),
        (-1.1, 1.34, 1.46, 0.58),
        (-0.4, 1.4, 1.51, 0.6),
        (0.2, 1.36, 1.46, 0.58),
        (0.36, 1.3, 1.36, 0.54),
    ];
    s.add(&loft(&roof), DAffine3::IDENTITY);
    // Pillars between the windows.
    for side in [-1.0, 1.0] {
        s.rod(
            dvec3(-0.47, 0.86, 0.735 * side),
            dvec3(-0.41, 1.4, 0.585 * side),
            0.035,
            4,
        );
        s.rod(
            dvec3(0.92, 0.86, 0.735 * side),
            dvec3(0.36, 1.4, 0.585 * side),
            0.035,
            4,
        );
    }
    s.finish("car body", 50.0)
}

/// The glass house.
pub fn cabin() -> Mesh {
    loft(&[
        (-1.78, 0.84, 0.95, 0.68),
        (-1.2, 0.8, 1.41, 0.66),
        (-0.4, 0.8, 1.47, 0.66),
        (0.25, 0.8, 1.42, 0.66),
        (1.08, 0.82, 0.95, 0.72),
    ])
    .finish("car windows", 50.0)
}

/// Four wheels, bumpers and lamps.
pub fn wheels() -> Mesh {
    let mut s = Surface::default();
    for x in [-1.28, 1.26] {
        for side in [-1.0, 1.0] {
            let hub = dvec3(x, 0.31, 0.66 * side);
            s.rod(hub, hub + dvec3(0.0, 0.0, 0.21 * side), 0.32, 10);
        }
    }
    for (x, wide) in [(-2.06, 0.6), (2.04, 0.56)] {
        s.block(dvec3(x - 0.06, 0.36, -wide), dvec3(x + 0.06, 0.46, wide));
    }
    s.finish("car wheels", 40.0)
}

/// Through rounded sections.
fn loft(sections: &[Section]) -> Surface {
    const CORNERS: u32 = 8;
    Surface::swept(sections.iter().map(|&(x, low, high, half)| {
        let (middle, tall) = (0.5 * (low + high), 0.5 * (high - low));
        let row = (0..CORNERS).map(|k| {
            let (sine, cosine) = (TAU * (f64::from(k) + 0.5) / f64::from(CORNERS)).sin_cos();
            // A superellipse (Lamé): flat sides, round corners.
            let bend = |v: f64| v.signum() * v.abs().powf(0.55);
            dvec3(x, middle + tall * bend(sine), half * bend(cosine))
        });
        (dvec3(x, middle, 0.0), row.collect::<Vec<DVec3>>())
    }))
}
