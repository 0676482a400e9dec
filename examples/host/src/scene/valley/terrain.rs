//! The lie of the land: heights, a road, a stream, and the meshes of the ground.

use shadows::glam::{DVec2, DVec3, dvec2, dvec3};

use super::super::Mesh;

/// Half the side of the land, in metres.
pub const HALF: f64 = 500.0;
/// Blocks of ground along each side.
const BLOCKS: u32 = 6;
/// Quads along each side of a block.
const QUADS: u32 = 36;
/// Half the width of the road, and of the stream.
pub const ROAD: f64 = 2.3;
pub const STREAM: f64 = 2.2;

/// Where the road is at a z, and where the stream.
pub fn road(z: f64) -> f64 {
    9.0 * (0.018 * z + 0.4).sin() + 5.0 * (0.041 * z).sin() - 2.0
}

pub fn stream(z: f64) -> f64 {
    30.0 + 11.0 * (0.021 * z + 2.0).sin() + 4.0 * (0.06 * z).cos()
}

/// Smooth steps and noise.
fn smooth(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A value from -1 to 1 at a lattice point.
fn lattice(x: i64, z: i64) -> f64 {
    let mut h = (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ (z as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
    h = (h ^ (h >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h ^= h >> 32;
    (h & 0xffff) as f64 / 32767.5 - 1.0
}

/// Value noise with smooth derivatives (Perlin 2002's fade).
fn noise(p: DVec2) -> f64 {
    let (cell, f) = (p.floor(), p - p.floor());
    let fade = |t: f64| t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    let (u, v) = (fade(f.x), fade(f.y));
    let (x, z) = (cell.x as i64, cell.y as i64);
    let row = |z| lattice(x, z) + u * (lattice(x + 1, z) - lattice(x, z));
    row(z) + v * (row(z + 1) - row(z))
}

/// Height of the land without road and stream.
fn hills(p: DVec2) -> f64 {
    let octaves = [(0.0045, 34.0), (0.011, 13.0), (0.027, 4.2), (0.07, 0.9)];
    let rough: f64 = octaves
        .iter()
        .map(|(scale, height)| height * noise(p * *scale + dvec2(3.7, 8.1)))
        .sum();
    // A valley along z between two slopes, closed by a ridge far behind.
    let across = (p.x - 8.0).abs();
    let sides = smooth(45.0, 420.0, across);
    let end = smooth(-260.0, -480.0, p.y) + 0.4 * smooth(280.0, 480.0, p.y);
    let wild = 0.06 + 0.94 * smooth(30.0, 190.0, across).max(smooth(-220.0, -400.0, p.y));
    118.0 * sides * sides + 62.0 * end + rough * wild
}

/// Height of the ground's meshes: as [`height`], but for a trench below the road, which covers it.
fn bare(x: f64, z: f64) -> f64 {
    let off = (x - road(z)).abs();
    height(x, z) - 0.4 * (1.0 - smooth(ROAD - 0.7, ROAD + 0.1, off))
}

/// Height of the road's surface: a little arched, its edges below the ground.
pub fn road_level(x: f64, z: f64) -> f64 {
    let off = (x - road(z)).abs() / ROAD;
    height(x, z) + 0.07 - 0.06 * off * off - 0.3 * smooth(0.93, 1.16, off)
}

/// Height of the water in the stream.
pub fn water_level(_: f64, z: f64) -> f64 {
    height(stream(z), z) + 0.75
}

/// Height of the ground at x and z.
pub fn height(x: f64, z: f64) -> f64 {
    let land = hills(dvec2(x, z));
    // The road lies level across, on the land's own height along its middle.
    let middle = road(z);
    let bed = hills(dvec2(middle, z));
    let off = (x - middle).abs();
    let land = bed + (land - bed) * smooth(ROAD + 0.3, ROAD + 9.0, off);
    let bank = (x - stream(z)).abs();
    land - 1.7 * (1.0 - smooth(STREAM * 0.6, STREAM * 2.6, bank))
}

/// The ground's normal.
pub fn normal(x: f64, z: f64) -> DVec3 {
    let step = 0.35;
    let slope = |dx: f64, dz: f64| height(x + dx, z + dz) - height(x - dx, z - dz);
    dvec3(-slope(step, 0.0), 2.0 * step, -slope(0.0, step)).normalize()
}

/// A point of the ground.
pub fn ground(x: f64, z: f64) -> DVec3 {
    dvec3(x, height(x, z), z)
}

/// From a lattice line's number to its coordinate: lines are nearer together about `centre`.
fn line(number: f64, centre: f64) -> f64 {
    let t = number / f64::from(BLOCKS * QUADS) * 2.0 - 1.0;
    // A cubic through the edges, steepest there.
    let from = centre / HALF;
    let bent = 0.24 * t + 0.76 * t * t * t;
    HALF * (bent + from * (1.0 - t * t))
}

/// The ground in closed blocks, from its surface down to a floor below everything. Neighbours share
/// the corners of their common edge.
pub fn blocks(centre: DVec2) -> Vec<Mesh> {
    let blocks = (0..BLOCKS).flat_map(|i| (0..BLOCKS).map(move |j| (i, j)));
    blocks
        .map(|(i, j)| block(i * QUADS, j * QUADS, centre))
        .collect()
}

fn block(first_x: u32, first_z: u32, centre: DVec2) -> Mesh {
    const SIDE: u32 = QUADS + 1;
    const FLOOR: f32 = -60.0;
    let mut mesh = Mesh {
        name: format!("ground {first_x} {first_z}"),
        positions: Vec::new(),
        normals: Vec::new(),
        indices: Vec::new(),
        mask: Vec::new(),
    };
    // One line more on each side, for the normals: neighbours then agree on them.
    const WIDER: u32 = SIDE + 2;
    let beyond = |first: u32, k: u32, centre| {
        let number = f64::from(first) + f64::from(k) - 1.0;
        line(number, centre)
    };
    let points = (0..WIDER).flat_map(|j| (0..WIDER).map(move |i| (i, j)));
    let points: Vec<DVec3> = points
        .map(|(i, j)| (beyond(first_x, i, centre.x), beyond(first_z, j, centre.y)))
        .map(|(x, z)| dvec3(x, bare(x, z), z))
        .collect();
    for j in 1..=SIDE {
        for i in 1..=SIDE {
            let at = |i: u32, j: u32| points[(j * WIDER + i) as usize];
            let (along_x, along_z) = (at(i + 1, j) - at(i - 1, j), at(i, j + 1) - at(i, j - 1));
            mesh.positions.push(at(i, j).as_vec3().to_array());
            let normal = along_z.cross(along_x).normalize();
            mesh.normals.push(normal.as_vec3().to_array());
        }
    }
    let at = |i: u32, j: u32| j * SIDE + i;
    for j in 0..QUADS {
        for i in 0..QUADS {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            mesh.indices.extend([a, b, c, a, c, d]);
        }
    }
    // Walls below the four edges, then the floor: vertices of their own, for their normals.
    let normals = [
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [0.0, 0.0, -1.0],
        [-1.0, 0.0, 0.0],
    ];
    for (edge, normal) in normals.into_iter().enumerate() {
        let first = mesh.positions.len() as u32;
        for k in 0..SIDE {
            let (i, j) = match edge {
                0 => (k, QUADS),
                1 => (QUADS, QUADS - k),
                2 => (QUADS - k, 0),
                _ => (0, k),
            };
            let top = mesh.positions[at(i, j) as usize];
            mesh.positions.extend([top, [top[0], FLOOR, top[2]]]);
            mesh.normals.extend([normal; 2]);
        }
        for k in 0..QUADS {
            let top = first + 2 * k;
            mesh.indices
                .extend([top, top + 1, top + 3, top, top + 3, top + 2]);
        }
    }
    floor(&mut mesh, SIDE, FLOOR);
    mesh
}

/// A fan around the middle.
fn floor(mesh: &mut Mesh, side: u32, height: f32) {
    let last = side - 1;
    let rim = (0..last)
        .map(|k| (k, 0))
        .chain((0..last).map(|k| (last, k)))
        .chain((0..last).map(|k| (last - k, last)))
        .chain((0..last).map(|k| (0, last - k)));
    let rim: Vec<[f32; 3]> = rim
        .map(|(i, j)| mesh.positions[(j * side + i) as usize])
        .collect();
    let count = rim.len() as u32;
    let first = mesh.positions.len() as u32;
    let middle = (
        rim[0][0] + rim[2 * last as usize][0],
        rim[0][2] + rim[2 * last as usize][2],
    );
    mesh.positions
        .extend(rim.iter().map(|p| [p[0], height, p[2]]));
    mesh.positions
        .push([0.5 * middle.0, height, 0.5 * middle.1]);
    mesh.normals
        .extend(vec![[0.0, -1.0, 0.0]; count as usize + 1]);
    for k in 0..count {
        mesh.indices
            .extend([first + count, first + k, first + (k + 1) % count]);
    }
}

/// A ribbon on the ground along z, from one z to another: quads of a metre, `half` to each side of
/// where `middle` says, lifted by `up`. It does not cast.
pub fn ribbon(
    name: &str,
    middle: impl Fn(f64) -> f64,
    [from, to]: [f64; 2],
    half: f64,
    level: impl Fn(f64, f64) -> f64,
) -> Mesh {
    let mut mesh = Mesh {
        name: name.into(),
        positions: Vec::new(),
        normals: Vec::new(),
        indices: Vec::new(),
        mask: Vec::new(),
    };
    let steps = ((to - from) / 1.2) as u32;
    const ACROSS: u32 = 6;
    for k in 0..=steps {
        let z = from + (to - from) * f64::from(k) / f64::from(steps);
        for i in 0..=ACROSS {
            let x = middle(z) + half * (2.0 * f64::from(i) / f64::from(ACROSS) - 1.0);
            mesh.positions
                .push(dvec3(x, level(x, z), z).as_vec3().to_array());
            let n = dvec3(
                level(x - 0.3, z) - level(x + 0.3, z),
                0.6,
                level(x, z - 0.3) - level(x, z + 0.3),
            );
            mesh.normals.push(n.normalize().as_vec3().to_array());
        }
    }
    for k in 0..steps {
        for i in 0..ACROSS {
            let a = k * (ACROSS + 1) + i;
            let b = a + ACROSS + 1;
            mesh.indices.extend([a, b, b + 1, a, b + 1, a + 1]);
        }
    }
    mesh
}
