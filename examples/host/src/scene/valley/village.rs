//! Cottages and a chapel.

use shadows::glam::{DAffine3, DVec3, dvec2, dvec3};

use super::super::Mesh;
use super::super::city::roof::{Roof, roof};
use super::super::city::walls::{Body, Storey, walls};
use super::super::surface::Surface;

/// A building's meshes around the origin's y axis, the front towards +z; its walls reach below the
/// ground, which slopes.
pub struct Building {
    pub walls: Mesh,
    pub wood: Mesh,
    pub roof: Mesh,
    pub stone: Mesh,
    /// They do not cast.
    pub panes: Mesh,
}

/// How far walls reach into the ground.
const FOOT: f64 = 1.6;

/// A house of one storey and a loft.
pub fn cottage(name: &str, width: f64, depth: f64, bays: u32) -> Building {
    let body = Body {
        width,
        height: FOOT + 3.3,
        depth,
    };
    let spread = |count: u32, length: f64, half: f64| -> Vec<[f64; 2]> {
        let middle = |i| length * ((f64::from(i) + 0.5) / f64::from(count) - 0.5);
        (0..count)
            .map(|i| [middle(i) - half, middle(i) + half])
            .collect()
    };
    let storeys = [Storey {
        y: [FOOT + 0.75, FOOT + 2.2],
        faces: [
            spread(bays, width, 0.5),
            spread(1, depth, 0.45),
            spread(bays, width, 0.5),
            spread(1, depth, 0.45),
        ],
    }];
    build(name, &body, &storeys, 0.5 * width / f64::from(bays))
}

/// A tall one with a tower's roof.
pub fn tower() -> Building {
    let body = Body {
        width: 4.6,
        height: FOOT + 13.0,
        depth: 4.6,
    };
    let slit = || vec![[-0.35, 0.35]];
    let storeys = [
        Storey {
            y: [FOOT + 3.0, FOOT + 4.6],
            faces: [slit(), slit(), slit(), slit()],
        },
        Storey {
            y: [FOOT + 9.6, FOOT + 11.8],
            faces: [slit(), slit(), slit(), slit()],
        },
    ];
    let mut building = build("chapel tower", &body, &storeys, 0.0);
    let spire = [
        (0.0, body.height - 0.05),
        (3.9, body.height - 0.05),
        (3.7, body.height + 0.15),
        (0.08, body.height + 7.5),
        (0.0, body.height + 7.6),
    ];
    let spire = spire.map(|(r, y)| dvec2(r, y));
    let mut s = Surface::turned(&spire, 4, |p, _| p.x)
        .placed(DAffine3::from_rotation_y(0.25 * std::f64::consts::PI));
    let top = dvec3(0.0, body.height + 7.3, 0.0);
    s.rod(top, top + DVec3::Y * 1.5, 0.05, 5);
    s.rod(
        top + dvec3(-0.4, 1.0, 0.0),
        top + dvec3(0.4, 1.0, 0.0),
        0.045,
        5,
    );
    building.roof = s.finish("spire", 30.0);
    building
}

/// `door`: where the door is left of the middle window's bay, 0 for none.
fn build(name: &str, body: &Body, storeys: &[Storey], door: f64) -> Building {
    let (mut wood, mut stone) = (Surface::default(), Surface::default());
    let mut panes = Surface::default();
    for storey in storeys {
        for (face, openings) in storey.faces.iter().enumerate() {
            for &[left, right] in openings {
                let [low, high] = storey.y;
                let at = |x, y, z| body.place(face, dvec3(x, y, z));
                let corners = [(left, low), (right, low), (right, high), (left, high)];
                let corners = corners.map(|(x, y)| panes.corner(at(x, y, -0.15)));
                panes.quad(corners);
                let bar = |wood: &mut Surface, from: DVec3, to: DVec3| {
                    let [from, to] = [from, to].map(|p| body.place(face, p));
                    wood.block(from.min(to), from.max(to));
                };
                let middle = 0.5 * (left + right);
                for [x, half] in [[left, 0.06], [middle, 0.025], [right, 0.06]] {
                    let [from, to] = [x - half, x + half];
                    bar(
                        &mut wood,
                        dvec3(from, low - 0.01, -0.19),
                        dvec3(to, high + 0.01, -0.1),
                    );
                }
                for [y, half] in [[low, 0.06], [0.5 * (low + high), 0.022], [high, 0.06]] {
                    let [from, to] = [y - half, y + half];
                    bar(
                        &mut wood,
                        dvec3(left - 0.07, from, -0.18),
                        dvec3(right + 0.07, to, -0.11),
                    );
                }
                // Shutters, open.
                for [from, to] in [[left - 0.56, left - 0.04], [right + 0.04, right + 0.56]] {
                    bar(&mut wood, dvec3(from, low, -0.02), dvec3(to, high, 0.05));
                }
                bar(
                    &mut stone,
                    dvec3(left - 0.1, low - 0.1, -0.1),
                    dvec3(right + 0.1, low + 0.01, 0.1),
                );
            }
        }
    }
    if door > 0.0 {
        let z = 0.5 * body.depth;
        wood.block(
            dvec3(-door - 0.5, FOOT - 0.4, z - 0.05),
            dvec3(-door + 0.5, FOOT + 2.05, z + 0.05),
        );
        stone.block(
            dvec3(-door - 0.7, FOOT - 0.6, z - 0.1),
            dvec3(-door + 0.7, FOOT + 0.02, z + 0.7),
        );
    }
    let covered = roof(Roof::Gable, body, &mut stone, &mut panes);
    // What closes the loft between the walls and the ridge is the roof's own gable.
    Building {
        walls: walls(body, storeys).finish(&format!("{name} walls"), 30.0),
        wood: wood.finish(&format!("{name} wood"), 30.0),
        roof: covered.finish(&format!("{name} roof"), 30.0),
        stone: stone.finish(&format!("{name} stone"), 30.0),
        panes: panes.finish(&format!("{name} panes"), 30.0),
    }
}

/// Down to where its walls stand in the ground.
pub const SUNK: f32 = FOOT as f32;
