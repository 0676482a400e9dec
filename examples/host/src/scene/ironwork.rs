//! Iron for the courtyard: thin bars, railings and chains, the hard cases of a shadow map. Metres.

use std::f64::consts::PI;

use shadows::glam::{DAffine3, DMat3, DVec2, DVec3, dvec2, dvec3};

use super::Mesh;
use super::masonry::{GOING, RISE, STEPS, half_ring};
use super::surface::Surface;

/// Length of a [`fence_panel`].
pub const PANEL: f64 = 2.0;
/// Height of the railings above the nosings of the stairs.
const RAIL: f64 = 0.86;
/// A chain link: radius to the middle of the section, radius of the section, stretch along the chain.
const LINK: (f64, f64, f64) = (0.085, 0.022, 1.45);

/// Sixteen bars with points, two rails and a post at the left end, along x from the origin.
pub fn fence_panel() -> Mesh {
    const BARS: u32 = 16;
    let spear = turned(
        &[(0.014, 0.03), (0.014, 1.1), (0.03, 1.15), (0.018, 1.2)],
        1.3,
        10,
    );
    let mut s = post(1.42, 0.04);
    for y in [0.14, 1.02] {
        let rail = Surface::cuboid(dvec3(0.0, y, -0.01), dvec3(PANEL, y + 0.045, 0.01));
        s.add(&rail, DAffine3::IDENTITY);
    }
    for i in 0..BARS {
        let x = PANEL * (f64::from(i) + 0.5) / f64::from(BARS);
        s.add(&spear, DAffine3::from_translation(dvec3(x, 0.0, 0.0)));
    }
    s.finish("fence panel", 45.0)
}

/// The railing of a flight of stairs in the stairs' own space, around z = 0. Each baluster has a
/// brace towards +z, so a railing for the other side is its mirror image.
pub fn stair_railing() -> Mesh {
    let mut s = post(1.1, 0.055);
    let top = dvec3(f64::from(STEPS) * GOING, f64::from(STEPS) * RISE, 0.0);
    s.add(&post(1.1, 0.055), DAffine3::from_translation(top));
    let rail = dvec3(0.0, RAIL + 0.5 * RISE, 0.0);
    s.add(
        &Surface::bar(rail, rail + top, 0.035, 16),
        DAffine3::IDENTITY,
    );
    let brace = half_ring(0.07, 0.012, 16, 8);
    let outwards = DMat3::from_rotation_y(-0.5 * PI) * DMat3::from_rotation_z(-0.5 * PI);
    for i in 0..STEPS {
        let foot = dvec3((f64::from(i) + 0.5) * GOING, f64::from(i + 1) * RISE, 0.0);
        let bar = Surface::bar(
            foot - dvec3(0.0, 0.02, 0.0),
            foot + DVec3::Y * RAIL,
            0.016,
            10,
        );
        s.add(&bar, DAffine3::IDENTITY);
        let middle = foot + dvec3(0.0, 0.45, 0.0);
        s.add(&brace, DAffine3::from_mat3_translation(outwards, middle));
    }
    s.finish("stair railing", 45.0)
}

/// A level railing along x from the origin, one metre long.
pub fn balustrade() -> Mesh {
    const BARS: u32 = 8;
    let mut s = Surface::bar(dvec3(-0.02, 0.9, 0.0), dvec3(1.02, 0.9, 0.0), 0.03, 16);
    s.add(
        &Surface::bar(dvec3(-0.02, 0.1, 0.0), dvec3(1.02, 0.1, 0.0), 0.018, 12),
        DAffine3::IDENTITY,
    );
    for i in 0..BARS {
        let x = (f64::from(i) + 0.5) / f64::from(BARS);
        let bar = Surface::bar(dvec3(x, 0.1, 0.0), dvec3(x, 0.9, 0.0), 0.013, 10);
        s.add(&bar, DAffine3::IDENTITY);
    }
    s.finish("balustrade", 45.0)
}

/// One link of a chain, round before [`hanging_chain`] stretches it.
pub fn link() -> Mesh {
    Surface::ring(LINK.0, LINK.1, 28, 14).finish("link", 180.0)
}

/// Where the links of a chain between two points hang, `sag` below the straight line in the
/// middle. They interlock without touching and are turned by a quarter one after another.
pub fn hanging_chain(from: DVec3, to: DVec3, sag: f64) -> Vec<DAffine3> {
    let at = |t: f64| from.lerp(to, t) - DVec3::Y * (4.0 * sag * t * (1.0 - t));
    let path = ByLength::new(at, 2000);
    // The furthest two links can be apart is inner end on inner end; 0.96 leaves them some air.
    let (radius, section, stretch) = LINK;
    let pitch = 0.96 * 2.0 * stretch * (radius - section);
    let count = (path.length() / pitch).ceil().max(1.0);
    let side = (to - from).cross(DVec3::Y).normalize_or(DVec3::Z);
    (0..count as u32)
        .map(|i| {
            let t = path.at((f64::from(i) + 0.5) / count);
            let along = (at(t + 1e-4) - at(t - 1e-4)).normalize();
            let up = side.cross(along);
            let turn = PI * (0.25 + 0.5 * f64::from(i % 2));
            let z = side * turn.cos() + up * turn.sin();
            let axes = DMat3::from_cols(along * stretch, z.cross(along), z);
            DAffine3::from_mat3_translation(axes, at(t))
        })
        .collect()
}

/// A curve's parameter by its length.
struct ByLength {
    lengths: Vec<f64>,
}

impl ByLength {
    fn new(at: impl Fn(f64) -> DVec3, steps: u32) -> Self {
        let mut lengths = vec![0.0];
        for i in 0..steps {
            let [a, b] = [i, i + 1].map(|k| at(f64::from(k) / f64::from(steps)));
            lengths.push(lengths[i as usize] + a.distance(b));
        }
        Self { lengths }
    }

    fn length(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// The parameter at a part of the whole length; both 0 to 1.
    fn at(&self, part: f64) -> f64 {
        let wanted = part * self.length();
        let i = self.lengths.partition_point(|l| *l < wanted);
        let i = i.clamp(1, self.lengths.len() - 1);
        let [a, b] = [self.lengths[i - 1], self.lengths[i]];
        ((i - 1) as f64 + (wanted - a) / (b - a)) / (self.lengths.len() - 1) as f64
    }
}

/// A round post with a ball on top, its foot at the origin.
fn post(height: f64, radius: f64) -> Surface {
    const STEPS: u32 = 10;
    let ball = 1.6 * radius;
    let mut rows = vec![(radius, 0.0)];
    // From where the ball leaves the post, by angle from its foot.
    let first = (radius / ball * 0.8).asin();
    rows.extend((0..STEPS).map(|i| {
        let a = first + (PI - first) * f64::from(i) / f64::from(STEPS);
        (ball * a.sin(), height - ball - ball * a.cos())
    }));
    let neck = rows[1].1;
    rows.insert(1, (radius, neck - 0.4 * radius));
    turned(&rows, height, 20)
}

/// A surface of revolution from (radius, height) rows, closed on the axis below its first row and
/// at `top`.
fn turned(rows: &[(f64, f64)], top: f64, sectors: u32) -> Surface {
    let mut profile = vec![dvec2(0.0, rows[0].1)];
    profile.extend(rows.iter().map(|(r, y)| dvec2(*r, *y)));
    profile.push(DVec2::new(0.0, top));
    Surface::turned(&profile, sectors, |p, _| p.x)
}
