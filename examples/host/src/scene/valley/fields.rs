//! Fences, poles, grass, stones and sheep.

use std::f64::consts::TAU;

use shadows::glam::{DAffine3, DVec3, dvec2, dvec3};

use super::super::super::random::Random;
use super::super::Mesh;
use super::super::surface::Surface;

/// A post and three rails of one metre along +x, to be stretched to the next post.
pub fn fence() -> [Mesh; 2] {
    let post = [
        (0.0, -0.5),
        (0.075, -0.5),
        (0.07, 1.12),
        (0.035, 1.2),
        (0.0, 1.2),
    ];
    let post = post.map(|(r, y)| dvec2(r, y));
    let post = Surface::turned(&post, 7, |p, _| p.x);
    let mut rails = Surface::default();
    for (i, y) in [0.3, 0.64, 0.97].into_iter().enumerate() {
        let tilt = 0.012 * (i as f64 - 1.0);
        rails.rod(
            dvec3(-0.04, y - tilt, 0.06),
            dvec3(1.04, y + tilt, 0.06),
            0.035,
            6,
        );
    }
    [post.finish("fence post", 40.0), rails.finish("rails", 40.0)]
}

/// A pole with a cross-arm and three insulators; wires end at [`INSULATORS`].
pub fn pole() -> Mesh {
    let mut s = Surface::default();
    s.rod(dvec3(0.0, -0.8, 0.0), dvec3(0.0, 7.6, 0.0), 0.11, 8);
    s.block(dvec3(-0.95, 6.95, 0.08), dvec3(0.95, 7.07, 0.2));
    s.rod(dvec3(-0.5, 6.98, 0.14), dvec3(0.0, 6.3, 0.09), 0.03, 5);
    s.rod(dvec3(0.5, 6.98, 0.14), dvec3(0.0, 6.3, 0.09), 0.03, 5);
    for top in INSULATORS {
        s.rod(dvec3(top.x, top.y - 0.2, top.z), top, 0.035, 6);
    }
    s.finish("pole", 40.0)
}

/// Where wires are fixed to a [`pole`].
pub const INSULATORS: [DVec3; 3] = [
    DVec3::new(-0.85, 7.22, 0.14),
    DVec3::new(0.3, 7.22, 0.14),
    DVec3::new(0.85, 7.22, 0.14),
];

/// Blades on a square metre around the origin: open triangles in pairs.
pub fn grass(seed: u64) -> Mesh {
    let mut random = Random(seed);
    let mut mesh = Mesh {
        name: "grass".into(),
        positions: Vec::new(),
        normals: Vec::new(),
        indices: Vec::new(),
        mask: Vec::new(),
    };
    for _ in 0..70 {
        let mut within = |from: f32, to: f32| f64::from(random.within(from, to));
        let foot = dvec3(within(-0.6, 0.6), -0.04, within(-0.6, 0.6));
        let (turn, tall) = (within(0.0, TAU as f32), within(0.16, 0.5));
        let side = dvec3(turn.cos(), 0.0, turn.sin()) * 0.011;
        let lean = dvec3(within(-0.5, 0.5), 0.0, within(-0.5, 0.5)) * tall;
        let knee = foot + DVec3::Y * (0.6 * tall) + 0.3 * lean;
        let tip = foot + DVec3::Y * tall + lean;
        let out = side.cross(DVec3::Y).normalize();
        let first = mesh.positions.len() as u32;
        for p in [
            foot - side,
            foot + side,
            knee + 0.8 * side,
            knee - 0.8 * side,
            tip,
        ] {
            mesh.positions.push(p.as_vec3().to_array());
        }
        // Wound to the side of their normals.
        let faces = (2.0 * side).cross(knee - foot);
        let turned = faces.dot(out) < 0.0;
        let outward = if turned { -faces } else { faces }.normalize();
        mesh.normals.extend([outward.as_vec3().to_array(); 5]);
        let wound = [[0, 1, 2], [0, 2, 3], [3, 2, 4]];
        for [a, b, c] in wound {
            let t = if turned { [a, c, b] } else { [a, b, c] };
            mesh.indices.extend(t.map(|i| first + i));
        }
    }
    mesh
}

/// A boulder around the origin, half in the ground.
pub fn boulder(seed: u64) -> Mesh {
    let phase = seed as f64;
    let s = Surface::lump(2, |d| {
        let waves = (3.1 * d.x + phase).sin() + (4.3 * d.y - phase).cos() * (3.7 * d.z).sin();
        1.0 + 0.16 * waves + 0.05 * (9.0 * d.z + phase).sin()
    });
    s.placed(DAffine3::from_scale(dvec3(1.0, 0.7, 1.25)))
        .finish("boulder", 25.0)
}

/// A bale of straw on its side.
pub fn bale() -> Mesh {
    let mut s = Surface::default();
    s.rod(dvec3(-0.6, 0.62, 0.0), dvec3(0.6, 0.62, 0.0), 0.65, 18);
    s.finish("bale", 40.0)
}

/// A sheep that grazes towards +x: wool, then head and legs.
pub fn sheep() -> [Mesh; 2] {
    let wool = Surface::lump(2, |d| {
        0.42 + 0.03 * ((9.0 * d.x).sin() * (8.0 * d.y).cos() + (9.0 * d.z).sin())
    });
    let wool = wool.placed(DAffine3::from_scale_rotation_translation(
        dvec3(1.3, 0.95, 0.85),
        shadows::glam::DQuat::IDENTITY,
        dvec3(0.0, 0.72, 0.0),
    ));
    let mut dark = Surface::default();
    for [x, z] in [[-0.3, -0.18], [0.3, -0.18], [-0.3, 0.18], [0.3, 0.18]] {
        dark.rod(dvec3(x, -0.05, z), dvec3(x, 0.5, z), 0.045, 6);
    }
    let head = Surface::lump(1, |_| 0.14).placed(DAffine3::from_scale_rotation_translation(
        dvec3(1.6, 1.0, 0.85),
        shadows::glam::DQuat::from_rotation_z(-0.9),
        dvec3(0.72, 0.5, 0.0),
    ));
    dark.add(&head, DAffine3::IDENTITY);
    dark.rod(dvec3(0.4, 0.78, 0.0), dvec3(0.68, 0.56, 0.0), 0.11, 7);
    [wool.finish("wool", 180.0), dark.finish("sheep", 60.0)]
}
