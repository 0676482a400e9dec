//! Roofs, chimneys and dormers.

use shadows::glam::{DAffine3, DVec2, dvec2, dvec3};

use super::super::surface::Surface;
use super::walls::Body;

/// A kind of roof.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Roof {
    /// A ridge along the street.
    Gable,
    /// Steep below and flat above, with dormers.
    Mansard,
    /// Behind a parapet.
    Flat,
}

/// The roof of a body; chimneys and the dormers' cheeks go to `stone`, their panes to `panes`.
pub fn roof(kind: Roof, body: &Body, stone: &mut Surface, panes: &mut Surface) -> Surface {
    let (half, deep, top) = (0.5 * body.width, 0.5 * body.depth, body.height);
    let ends = [-half, half];
    let mut s = Surface::default();
    let mut add = |outline: &[DVec2]| s.add(&Surface::prism(outline, ends), DAffine3::IDENTITY);
    match kind {
        Roof::Gable => {
            let (eaves, rise) = (deep + 0.5, 0.62 * deep);
            add(&[
                dvec2(-eaves, top - 0.03),
                dvec2(eaves, top - 0.03),
                dvec2(eaves, top + 0.1),
                dvec2(0.0, top + rise),
                dvec2(-eaves, top + 0.1),
            ]);
            chimney(
                stone,
                [0.28 * half, 0.9],
                [top + 0.2 * rise, top + rise + 0.7],
            );
        }
        Roof::Mansard => {
            let edge = deep + 0.15;
            add(&[
                dvec2(-edge, top - 0.02),
                dvec2(edge, top - 0.02),
                dvec2(edge - 1.1, top + 2.5),
                dvec2(0.0, top + 3.3),
                dvec2(-edge + 1.1, top + 2.5),
            ]);
            let count = (body.width / 3.2) as u32;
            for i in 0..count {
                let x = body.width * ((f64::from(i) + 0.5) / f64::from(count) - 0.5);
                dormer([x, top + 0.45, deep - 0.12], &mut s, stone, panes);
            }
            chimney(stone, [0.62 * half, -0.6], [top + 2.0, top + 4.3]);
        }
        Roof::Flat => {
            add(&[
                dvec2(-deep + 0.1, top - 0.05),
                dvec2(deep - 0.1, top - 0.05),
                dvec2(deep - 0.1, top + 0.06),
                dvec2(-deep + 0.1, top + 0.06),
            ]);
            let [x, z] = [half - 0.03, deep + 0.02];
            for front in [-1.0, 1.0] {
                let [a, b] = [front * z, front * (z - 0.3)];
                stone.block(
                    dvec3(-half, top - 0.04, a.min(b)),
                    dvec3(half, top + 0.75, a.max(b)),
                );
                let [a, b] = [front * x, front * (x - 0.28)];
                stone.block(
                    dvec3(a.min(b), top - 0.06, 0.25 - z),
                    dvec3(a.max(b), top + 0.7, z - 0.25),
                );
            }
            chimney(stone, [-0.4 * half, -1.2], [top - 0.1, top + 1.7]);
            // The head of the stairs.
            stone.block(
                dvec3(0.1, top - 0.1, -2.6),
                dvec3(0.2 + 0.4 * half, top + 1.9, -0.3),
            );
        }
    }
    s
}

/// With a cap and two pots, at x and z, from one height to another.
fn chimney(stone: &mut Surface, [x, z]: [f64; 2], [low, high]: [f64; 2]) {
    stone.block(
        dvec3(x - 0.55, low, z - 0.3),
        dvec3(x + 0.55, high, z + 0.3),
    );
    stone.block(
        dvec3(x - 0.62, high - 0.25, z - 0.37),
        dvec3(x + 0.62, high - 0.1, z + 0.37),
    );
    for side in [-0.25, 0.25] {
        let foot = dvec3(x + side, high - 0.05, z);
        stone.rod(foot, foot + dvec3(0.0, 0.5, 0.0), 0.13, 8);
    }
}

/// A window in a roof with its own small one; its front's lower middle is at a point.
fn dormer([x, y, z]: [f64; 3], roof: &mut Surface, stone: &mut Surface, panes: &mut Surface) {
    stone.block(
        dvec3(x - 0.6, y - 0.05, z - 1.3),
        dvec3(x + 0.6, y + 1.5, z),
    );
    let gable = [
        dvec2(-0.75, y + 1.47),
        dvec2(0.75, y + 1.47),
        dvec2(0.75, y + 1.55),
        dvec2(0.0, y + 1.95),
        dvec2(-0.75, y + 1.55),
    ];
    // Its ridge runs into the roof: along z.
    let fan = [[0, 1, 2], [0, 2, 3], [0, 3, 4]];
    let small = Surface::plate(&gable, &fan, (z - 1.6, z + 0.14));
    roof.add(&small, DAffine3::from_translation(dvec3(x, 0.0, 0.0)));
    let at = z + 0.015;
    let corners = [(-0.42, 0.1), (0.42, 0.1), (0.42, 1.3), (-0.42, 1.3)];
    let corners = corners.map(|(dx, dy)| panes.corner(dvec3(x + dx, y + dy, at)));
    panes.quad(corners);
    for (dx, wide) in [(-0.5, 0.08), (-0.03, 0.06), (0.42, 0.08)] {
        stone.block(
            dvec3(x + dx, y + 0.02, z - 0.02),
            dvec3(x + dx + wide, y + 1.38, z + 0.04),
        );
    }
    for dy in [0.03, 0.85, 1.28] {
        stone.block(
            dvec3(x - 0.51, y + dy, z - 0.03),
            dvec3(x + 0.51, y + dy + 0.07, z + 0.035),
        );
    }
}
