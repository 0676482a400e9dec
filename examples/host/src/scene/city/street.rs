//! What stands in streets and squares: lamps, wires, benches, stalls, a fountain. All closed; metres.

use std::f64::consts::TAU;

use shadows::glam::{DAffine3, DVec3, dvec2, dvec3};

use super::super::Mesh;
use super::super::surface::Surface;

/// Where the bulb of a [`lamp`] is, from its foot; the arm reaches towards +x.
pub const BULB: DVec3 = DVec3::new(1.15, 4.42, 0.0);
/// The same of a [`bracket`], from where it is fixed to the wall at z = 0.
pub const LANTERN: DVec3 = DVec3::new(0.0, -0.12, 0.42);

/// A cast iron post with an arm.
pub fn lamp_post() -> Mesh {
    let profile = [
        (0.0, -0.05),
        (0.2, -0.05),
        (0.2, 0.12),
        (0.14, 0.2),
        (0.12, 0.6),
        (0.055, 0.8),
        (0.045, 4.3),
        (0.075, 4.36),
        (0.04, 4.75),
        (0.0, 4.82),
    ];
    let profile = profile.map(|(r, y)| dvec2(r, y));
    let mut s = Surface::turned(&profile, 8, |p, _| p.x);
    let arm: Vec<DVec3> = (0..=7)
        .map(|i| {
            let t = f64::from(i) / 7.0;
            dvec3(
                1.15 * t,
                4.46 + 0.52 * (0.5 * TAU * (0.12 + 0.76 * t)).sin(),
                0.0,
            )
        })
        .collect();
    s.add(&Surface::tube(&arm, |_| 0.026, 5), DAffine3::IDENTITY);
    let hook = [
        dvec3(0.02, 4.02, 0.0),
        dvec3(0.3, 4.3, 0.0),
        dvec3(0.42, 4.86, 0.0),
    ];
    s.add(&Surface::tube(&hook, |_| 0.018, 5), DAffine3::IDENTITY);
    s.finish("lamp post", 50.0)
}

/// A bell over the bulb, which is at the origin: light goes up as far as 30 degrees above level.
pub fn shade() -> Mesh {
    let profile = [
        (0.0, 0.2),
        (0.1, 0.19),
        (0.19, 0.12),
        (0.2, 0.11),
        (0.12, 0.23),
        (0.05, 0.27),
        (0.04, 0.38),
        (0.0, 0.4),
    ];
    let profile = profile.map(|(r, y)| dvec2(r, y));
    Surface::turned(&profile, 10, |p, _| p.x).finish("lamp shade", 50.0)
}

/// A bulb around the origin, of radius 1.
pub fn bulb() -> Mesh {
    Surface::lump(0, |_| 1.0).finish("bulb", 180.0)
}

/// A square lantern on a bracket from a wall at z = 0, panes left out so that its bars cast.
pub fn bracket() -> Mesh {
    let mut s = Surface::default();
    s.block(dvec3(-0.05, -0.3, -0.05), dvec3(0.05, 0.34, 0.02));
    let arm: Vec<DVec3> = (0..=5)
        .map(|i| f64::from(i) / 5.0)
        .map(|t| dvec3(0.0, 0.12 + 0.14 * (0.5 * TAU * t).sin(), 0.42 * t))
        .collect();
    s.add(&Surface::tube(&arm, |_| 0.014, 5), DAffine3::IDENTITY);
    let at = DAffine3::from_translation(LANTERN);
    let mut lantern = Surface::default();
    for [x, z] in [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]] {
        lantern.rod(
            dvec3(0.1 * x, -0.17, 0.1 * z),
            dvec3(0.13 * x, 0.16, 0.13 * z),
            0.01,
            4,
        );
    }
    let base = [(0.0, -0.2), (0.15, -0.2), (0.16, -0.16), (0.0, -0.16)];
    let base = base.map(|(r, y)| dvec2(r, y));
    lantern.add(
        &Surface::turned(&base, 4, |p, _| p.x),
        DAffine3::from_rotation_y(TAU / 8.0),
    );
    let roof = [(0.0, 0.14), (0.22, 0.14), (0.05, 0.27), (0.0, 0.3)];
    let roof = roof.map(|(r, y)| dvec2(r, y));
    lantern.add(
        &Surface::turned(&roof, 4, |p, _| p.x),
        DAffine3::from_rotation_y(TAU / 8.0),
    );
    s.add(&lantern, at);
    s.finish("lantern", 30.0)
}

/// A wire of one metre along x from the origin, that sags by a fortieth, to be stretched.
pub fn wire() -> Mesh {
    Surface::wire(DVec3::ZERO, DVec3::X, 0.025, 0.5, 14).finish("wire", 180.0)
}

/// A bench around the origin, to be sat on facing +z.
pub fn bench() -> Mesh {
    let mut s = Surface::default();
    for i in 0..4 {
        let z = -0.2 + 0.12 * f64::from(i);
        s.block(dvec3(-0.9, 0.43, z), dvec3(0.9, 0.465, z + 0.095));
    }
    for i in 0..3 {
        let (y, z) = (0.56 + 0.13 * f64::from(i), -0.235 - 0.035 * f64::from(i));
        s.block(dvec3(-0.9, y, z - 0.03), dvec3(0.9, y + 0.1, z));
    }
    for x in [-0.72, 0.72] {
        let iron = |z: [f64; 2], y: [f64; 2]| {
            Surface::cuboid(dvec3(x - 0.03, y[0], z[0]), dvec3(x + 0.03, y[1], z[1]))
        };
        s.add(&iron([-0.22, -0.16], [-0.03, 0.44]), DAffine3::IDENTITY);
        s.add(&iron([0.2, 0.26], [-0.02, 0.44]), DAffine3::IDENTITY);
        s.add(&iron([-0.21, 0.25], [0.36, 0.431]), DAffine3::IDENTITY);
        s.rod(dvec3(x, 0.4, -0.19), dvec3(x, 0.93, -0.34), 0.025, 6);
    }
    s.finish("bench", 30.0)
}

/// A bollard.
pub fn bollard() -> Mesh {
    let profile = [
        (0.0, -0.05),
        (0.12, -0.05),
        (0.12, 0.08),
        (0.085, 0.14),
        (0.07, 0.72),
        (0.1, 0.76),
        (0.1, 0.82),
        (0.06, 0.9),
        (0.0, 0.93),
    ];
    let profile = profile.map(|(r, y)| dvec2(r, y));
    Surface::turned(&profile, 10, |p, _| p.x).finish("bollard", 40.0)
}

/// An umbrella over a round table.
pub fn umbrella() -> Mesh {
    let mut s = Surface::default();
    s.rod(dvec3(0.0, -0.05, 0.0), dvec3(0.0, 2.55, 0.0), 0.03, 6);
    let cloth = [
        (0.0, 2.42),
        (1.5, 1.95),
        (1.52, 1.98),
        (0.05, 2.48),
        (0.0, 2.5),
    ];
    let cloth = cloth.map(|(r, y)| dvec2(r, y));
    s.add(&Surface::turned(&cloth, 8, |p, _| p.x), DAffine3::IDENTITY);
    s.finish("umbrella", 30.0)
}

/// A round table with two chairs.
pub fn table() -> Mesh {
    let mut s = Surface::default();
    let top = [(0.0, 0.7), (0.45, 0.7), (0.45, 0.735), (0.0, 0.735)].map(|(r, y)| dvec2(r, y));
    s.add(&Surface::turned(&top, 14, |p, _| p.x), DAffine3::IDENTITY);
    let foot = [
        (0.0, -0.03),
        (0.24, -0.03),
        (0.05, 0.06),
        (0.035, 0.71),
        (0.0, 0.71),
    ];
    let foot = foot.map(|(r, y)| dvec2(r, y));
    s.add(&Surface::turned(&foot, 8, |p, _| p.x), DAffine3::IDENTITY);
    for turn in [0.3, 3.0] {
        let mut chair = Surface::default();
        chair.block(dvec3(-0.2, 0.43, -0.2), dvec3(0.2, 0.46, 0.2));
        chair.block(dvec3(-0.2, 0.62, 0.2), dvec3(0.2, 0.88, 0.22));
        for [x, z] in [[-0.17, -0.17], [0.17, -0.17], [-0.17, 0.2], [0.17, 0.2]] {
            let top = if z > 0.0 { 0.87 } else { 0.44 };
            chair.rod(dvec3(x, -0.03, z), dvec3(x, top, z), 0.014, 5);
        }
        let place =
            DAffine3::from_rotation_y(turn) * DAffine3::from_translation(dvec3(0.0, 0.0, 0.72));
        s.add(&chair, place);
    }
    s.finish("table", 30.0)
}

/// A market stall: four posts, a table, a sloping cloth.
pub fn stall() -> Mesh {
    let mut s = Surface::default();
    for [x, z] in [[-1.2, -0.8], [1.2, -0.8], [-1.2, 0.8], [1.2, 0.8]] {
        let top = if z > 0.0 { 2.2 } else { 2.6 };
        s.block(
            dvec3(x - 0.04, -0.03, z - 0.04),
            dvec3(x + 0.04, top, z + 0.04),
        );
    }
    s.block(dvec3(-1.15, 0.78, -0.35), dvec3(1.15, 0.84, 0.75));
    let cloth = [
        dvec2(-0.95, 2.58),
        dvec2(1.25, 2.14),
        dvec2(1.26, 2.17),
        dvec2(-0.95, 2.63),
    ];
    s.add(&Surface::prism(&cloth, [-1.4, 1.4]), DAffine3::IDENTITY);
    let mut pack = |x: f64, z: f64, y: f64| {
        s.block(
            dvec3(x - 0.22, y, z - 0.16),
            dvec3(x + 0.22, y + 0.2, z + 0.16),
        );
    };
    for i in 0..4 {
        pack(-0.85 + 0.56 * f64::from(i), 0.45, 0.83);
    }
    pack(-1.6, 0.2, -0.02);
    pack(-1.58, 0.22, 0.19);
    pack(1.65, -0.1, -0.02);
    s.finish("stall", 30.0)
}

/// A basin with a bowl on a shaft in its middle.
pub fn fountain() -> Mesh {
    let basin = [
        (0.0, 0.1),
        (2.6, 0.1),
        (2.62, 0.62),
        (2.6, 0.7),
        (2.95, 0.7),
        (2.98, 0.6),
        (2.8, 0.5),
        (2.85, 0.15),
        (3.1, 0.1),
        (3.1, -0.05),
        (0.0, -0.05),
    ];
    let basin = basin
        .iter()
        .rev()
        .map(|(r, y)| dvec2(*r, *y))
        .collect::<Vec<_>>();
    let mut s = Surface::turned(&basin, 24, |p, _| p.x);
    let shaft = [
        (0.0, 0.05),
        (0.6, 0.05),
        (0.6, 0.35),
        (0.3, 0.45),
        (0.22, 1.3),
        (0.3, 1.4),
        (1.0, 1.65),
        (1.15, 1.8),
        (1.05, 1.8),
        (0.4, 1.62),
        (0.2, 1.62),
        (0.14, 2.3),
        (0.3, 2.45),
        (0.12, 2.6),
        (0.0, 2.85),
    ];
    let shaft = shaft.map(|(r, y)| dvec2(r, y));
    s.add(&Surface::turned(&shaft, 18, |p, _| p.x), DAffine3::IDENTITY);
    s.finish("fountain", 40.0)
}

/// A sloping cloth over a shop, four metres wide, fixed to a wall at z = 0.
pub fn awning() -> Mesh {
    let cloth = [
        dvec2(-0.05, 0.35),
        dvec2(1.3, -0.15),
        dvec2(1.31, -0.12),
        dvec2(-0.05, 0.4),
    ];
    let mut s = Surface::prism(&cloth, [-1.0, 1.0]);
    s.block(dvec3(-0.999, -0.36, 1.28), dvec3(0.999, -0.125, 1.305));
    for x in [-0.96, 0.96] {
        s.rod(dvec3(x, -0.25, -0.03), dvec3(x, -0.16, 1.27), 0.015, 5);
    }
    s.finish("awning", 20.0)
}
