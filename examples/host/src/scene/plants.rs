//! Trees: wood as tubes, crowns as lumps, or twigs with leaves for them. Seeded; metres.

use std::f64::consts::{PI, TAU};

use shadows::glam::{DAffine3, DVec2, DVec3, dvec2, dvec3};

use super::super::random::Random;
use super::Mesh;
use super::surface::Surface;

/// The golden angle: branches never stand above one another (Vogel 1979).
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// A tree's wood and the ends of its twigs.
pub struct Skeleton {
    /// Closed tubes.
    pub wood: Surface,
    /// Where twigs end, and in which direction.
    pub twigs: Vec<[DVec3; 2]>,
}

/// Down to what a tree's wood is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Wood {
    Trunk,
    Branches,
    Twigs,
}

/// How a tree grows.
#[derive(Clone, Copy, Debug)]
pub struct Habit {
    pub height: f64,
    /// Height of the lowest branches.
    pub clear: f64,
    /// Radius of the trunk at its foot.
    pub girth: f64,
    /// Length of the longest branches.
    pub reach: f64,
    pub branches: u32,
    /// Twigs that each branch has besides its own end.
    pub twigs: u32,
    /// How far branches rise: the sine of their angle at the foot.
    pub rise: f64,
    /// What of it is made of wood; of the rest nothing is seen but the leaves.
    pub wood: Wood,
    /// Whether branches get shorter towards the top, as a fir's do, or are longest in the middle.
    pub cone: bool,
}

fn within(random: &mut Random, from: f64, to: f64) -> f64 {
    f64::from(random.within(from as f32, to as f32))
}

/// Grows a tree from the origin.
pub fn grow(habit: &Habit, seed: u64) -> Skeleton {
    let mut random = Random(seed);
    let lean = [0, 1].map(|_| within(&mut random, -0.04, 0.04));
    let bend = within(&mut random, 0.0, TAU);
    let trunk = |t: f64| {
        let y = -0.3 + (habit.height * 0.93 + 0.3) * t;
        let aside = if habit.cone { 0.15 } else { 0.5 };
        let sway = aside * habit.girth * (3.0 * t * PI + bend).sin();
        dvec3(lean[0] * y + sway, y, lean[1] * y - 0.6 * sway)
    };
    let path: Vec<DVec3> = (0..=6).map(|i| trunk(f64::from(i) / 6.0)).collect();
    let taper = |i: usize| {
        let t = i as f64 / 6.0;
        habit.girth * (1.0 - 0.86 * t) * if i == 0 { 1.35 } else { 1.0 }
    };
    let mut skeleton = Skeleton {
        wood: Surface::tube(&path, taper, 8),
        twigs: vec![[trunk(1.0), DVec3::Y]],
    };
    let first = habit.clear / habit.height;
    for i in 0..habit.branches {
        let part = (f64::from(i) + 0.5) / f64::from(habit.branches);
        let t = first + (0.97 - first) * part;
        let turn = GOLDEN_ANGLE * f64::from(i) + within(&mut random, -0.3, 0.3);
        let shape = match habit.cone {
            true => 1.02 - part,
            false => 0.45 + 0.55 * (PI * (0.12 + 0.75 * part)).sin(),
        };
        let length = habit.reach * shape * within(&mut random, 0.85, 1.1);
        let rise = habit.rise + if habit.cone { 0.25 * part } else { 0.35 * part };
        let out = dvec3(turn.cos(), rise, turn.sin()).normalize();
        let girth = (0.4 * habit.girth * (1.0 - 0.8 * t)).max(0.012);
        branch(
            &mut skeleton,
            habit,
            &mut random,
            trunk(t),
            out * length,
            girth,
        );
    }
    skeleton
}

/// A branch with its twigs.
fn branch(
    skeleton: &mut Skeleton,
    habit: &Habit,
    random: &mut Random,
    foot: DVec3,
    way: DVec3,
    girth: f64,
) {
    let length = way.length();
    // Firs hang, others reach up.
    let curve = if habit.cone { -0.1 } else { 0.18 };
    let at = |t: f64| foot + way * t + DVec3::Y * (curve * length * t * t);
    let path: Vec<DVec3> = (0..=3).map(|i| at(f64::from(i) / 3.0)).collect();
    if habit.wood >= Wood::Branches {
        let tube = Surface::tube(&path, |i| girth * (1.0 - 0.26 * i as f64), 5);
        skeleton.wood.add(&tube, DAffine3::IDENTITY);
    }
    let along = (at(1.0) - at(0.8)).normalize();
    skeleton.twigs.push([at(1.0), along]);
    for i in 0..habit.twigs {
        let t = 0.3 + 0.65 * (f64::from(i) + 0.5) / f64::from(habit.twigs);
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let across = way.cross(DVec3::Y).normalize_or(DVec3::X) * side;
        let spread = if habit.cone { 0.1 } else { 0.45 };
        let up = within(random, -spread, spread + 0.2);
        let out = (0.55 * along + 0.75 * across + up * DVec3::Y).normalize();
        let reach = length * (1.05 - t) * within(random, 0.4, 0.65);
        let end = at(t) + out * reach;
        if habit.wood == Wood::Twigs {
            let twig = [at(t), at(t).lerp(end, 0.5), end];
            let thin = 0.45 * girth;
            let tube = Surface::tube(&twig, |i| thin * (1.0 - 0.35 * i as f64), 4);
            skeleton.wood.add(&tube, DAffine3::IDENTITY);
        }
        skeleton.twigs.push([end, out]);
    }
}

/// Lumps of leaves around the ends of twigs, of a radius in metres.
pub fn lumps(skeleton: &Skeleton, radius: f64, seed: u64) -> Surface {
    let mut random = Random(seed);
    let mut s = Surface::default();
    for [end, way] in &skeleton.twigs {
        let size = radius * within(&mut random, 0.8, 1.2);
        let phase = within(&mut random, 0.0, TAU);
        let lump = Surface::lump(1, |d| {
            let waves = (5.1 * d.x + phase).sin() * (4.7 * d.z - phase).cos() + (6.3 * d.y).sin();
            size * (1.0 + 0.13 * waves)
        });
        let place = DAffine3::from_scale_rotation_translation(
            dvec3(1.0, 0.82, 1.0),
            shadows::glam::DQuat::from_rotation_y(phase),
            *end - 0.35 * size * *way,
        );
        s.add(&lump, place);
    }
    s
}

/// What leaves are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leaves {
    /// Each leaf is two triangles: what any shadow technique can draw.
    Solid,
    /// Cards with twigs of leaves, cut out by [`leaf_mask`](super::leaf_mask): what only the host can
    /// draw.
    Masked,
}

/// A crown of open meshes: so many leaves (or cards) of a size at the end of each twig, spread over a
/// reach in metres.
pub fn foliage(
    skeleton: &Skeleton,
    kind: Leaves,
    [count, size, reach]: [f64; 3],
    droop: f64,
    seed: u64,
) -> Mesh {
    let mut random = Random(seed);
    let mut mesh = Mesh {
        name: "leaves".into(),
        positions: Vec::new(),
        normals: Vec::new(),
        indices: Vec::new(),
        mask: Vec::new(),
    };
    let ends = skeleton.twigs.iter().map(|[end, _]| *end);
    let middle = ends.clone().sum::<DVec3>() / ends.len() as f64;
    for [end, way] in &skeleton.twigs {
        for _ in 0..count as u32 {
            let aside = [0; 3].map(|_| within(&mut random, -1.0, 1.0));
            let place = *end + reach * DVec3::from(aside) - 0.3 * reach * *way;
            let turn = [0; 3].map(|_| within(&mut random, -0.8, 0.8));
            let along = (*way + DVec3::from(turn) - DVec3::Y * droop).normalize();
            let size = size * within(&mut random, 0.75, 1.2);
            let roll = within(&mut random, 0.0, PI);
            let side = along.any_orthonormal_vector();
            let side = side * roll.cos() + along.cross(side) * roll.sin();
            let shape = match kind {
                Leaves::Solid => leaf(place, along * size, side * (0.34 * size)),
                Leaves::Masked => card(place, along * size, side * (0.5 * size)),
            };
            add_leaf(&mut mesh, &shape, (place - middle).normalize_or(DVec3::Y));
        }
    }
    mesh
}

/// Corners, and where they are in the mask, if there is one.
type Corners = ([DVec3; 4], Option<[DVec2; 4]>);

/// A leaf of two triangles that are folded along its rib.
fn leaf(foot: DVec3, along: DVec3, side: DVec3) -> Corners {
    let fold = 0.25 * side.length() * along.cross(side).normalize();
    let widest = foot + 0.45 * along + fold;
    ([foot, widest - side, foot + along, widest + side], None)
}

fn card(foot: DVec3, along: DVec3, side: DVec3) -> Corners {
    let corners = [
        foot - side,
        foot + side,
        foot + side + along,
        foot - side + along,
    ];
    let mask = [
        dvec2(0.0, 0.0),
        dvec2(1.0, 0.0),
        dvec2(1.0, 1.0),
        dvec2(0.0, 1.0),
    ];
    (corners, Some(mask))
}

/// Adds one whose normals lean outward, so that crowns are shaded as a whole.
fn add_leaf(mesh: &mut Mesh, (corners, mask): &Corners, outward: DVec3) {
    let first = mesh.positions.len() as u32;
    let faces = [[0, 1, 2], [0, 2, 3]].map(|t| {
        let [a, b, c] = t.map(|i: usize| corners[i]);
        (b - a).cross(c - a).normalize()
    });
    let up = (faces[0] + faces[1]).normalize();
    // Wound so that the side with the normal is the outer one.
    let turned = up.dot(outward) < 0.0;
    let up = if turned { -up } else { up };
    let normal = (up + 0.9 * outward).normalize().as_vec3().to_array();
    for (i, corner) in corners.iter().enumerate() {
        mesh.positions.push(corner.as_vec3().to_array());
        mesh.normals.push(normal);
        mesh.mask
            .extend(mask.map(|mask| mask[i].as_vec2().to_array()));
    }
    let order = if turned {
        [0, 2, 1, 0, 3, 2]
    } else {
        [0, 1, 2, 0, 2, 3]
    };
    mesh.indices.extend(order.map(|i| first + i));
}
