//! Houses: walls with niches, and what is in and on them, each material a mesh of its own.

use shadows::glam::{DAffine3, DVec3, dvec2, dvec3};

use super::super::Mesh;
use super::super::surface::Surface;
use super::roof::{self, Roof};
use super::walls::{Body, NICHE, Openings, Storey, walls};

/// Height of the ground floor and of each storey above it.
const GROUND: f64 = 3.6;
const UPPER: f64 = 3.1;
/// Of windows above the ground floor.
const WINDOW: [f64; 2] = [1.05, 1.75];
/// How far the openings of the ground floor reach, from and to.
const SHOP: [f64; 2] = [0.25, 2.7];

/// What is in a front's ground floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ground {
    /// A door and windows.
    Flat,
    /// A door between shop windows, under an awning.
    Shop,
}

/// A kind of house.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    pub name: &'static str,
    pub width: f64,
    pub depth: f64,
    /// Windows beside one another.
    pub bays: u32,
    /// Above the ground floor.
    pub storeys: u32,
    pub ground: Ground,
    pub roof: Roof,
    /// Balconies: bay and storey above the ground floor, from 0.
    pub balconies: &'static [[u32; 2]],
    /// Whether its right side is a front, too: a house at a corner.
    pub corner: bool,
}

/// Its meshes, standing on y = 0 around the y axis, the front towards +z.
pub struct House {
    pub walls: Mesh,
    /// Cornices, chimneys, parapets: what one sees from afar.
    pub crown: Mesh,
    /// Sills, steps, balconies.
    pub stone: Mesh,
    /// Frames and doors.
    pub wood: Mesh,
    pub roof: Mesh,
    pub iron: Option<Mesh>,
    /// Panes, which do not cast; those of rooms where somebody is in.
    pub dark: Mesh,
    pub lit: Mesh,
    /// The middles of lit panes with the way out of the window, and where a lantern hangs by the door.
    pub windows: Vec<[DVec3; 2]>,
    pub lantern: DVec3,
    /// The shop's front, if it has an awning: where its middle is fixed.
    pub awning: Option<DVec3>,
}

/// A house being built.
struct Builder {
    style: Style,
    body: Body,
    crown: Surface,
    stone: Surface,
    wood: Surface,
    iron: Surface,
    dark: Surface,
    lit: Surface,
    windows: Vec<[DVec3; 2]>,
    panes: u32,
}

/// Builds one.
pub fn house(style: Style) -> House {
    let height = GROUND + UPPER * f64::from(style.storeys) + 0.35;
    let body = Body {
        width: style.width,
        height,
        depth: style.depth,
    };
    let storeys: Vec<Storey> = (0..=style.storeys).map(|at| storey(&style, at)).collect();
    let mut builder = Builder {
        style,
        body,
        crown: Surface::default(),
        stone: Surface::default(),
        wood: Surface::default(),
        iron: Surface::default(),
        dark: Surface::default(),
        lit: Surface::default(),
        windows: Vec::new(),
        panes: 0,
    };
    for face in 0..4 {
        for (at, storey) in storeys.iter().enumerate() {
            builder.storey(face, at as u32, storey);
        }
    }
    for &face in fronts(&style) {
        builder.bands(face);
    }
    for &[bay, storey] in style.balconies {
        builder.balcony(bay_middle(&style, bay), GROUND + UPPER * f64::from(storey));
    }
    let roof = roof::roof(style.roof, &body, &mut builder.crown, &mut builder.dark);
    builder.finish(&storeys, &roof)
}

fn fronts(style: &Style) -> &'static [usize] {
    if style.corner { &[0, 1] } else { &[0] }
}

fn bay_middle(style: &Style, bay: u32) -> f64 {
    style.width * ((f64::from(bay) + 0.5) / f64::from(style.bays) - 0.5)
}

/// Where a storey has openings.
fn storey(style: &Style, at: u32) -> Storey {
    let windows = |bays: u32, width: f64, half: f64| -> Openings {
        let middle = |bay: u32| width * ((f64::from(bay) + 0.5) / f64::from(bays) - 0.5);
        (0..bays)
            .map(|bay| [middle(bay) - half, middle(bay) + half])
            .collect()
    };
    let side_bays = (style.depth / 3.3) as u32;
    let half = 0.5 * WINDOW[0];
    let side = |half| match style.corner {
        true => windows(side_bays, style.depth, half),
        false => Openings::new(),
    };
    if at == 0 {
        return Storey {
            y: SHOP,
            faces: [
                ground_front(style),
                side(0.62),
                Openings::new(),
                Openings::new(),
            ],
        };
    }
    let foot = GROUND + UPPER * f64::from(at - 1) + 0.72;
    let back = windows(style.bays.div_ceil(2), style.width, half);
    Storey {
        y: [foot, foot + WINDOW[1]],
        faces: [
            windows(style.bays, style.width, half),
            side(half),
            back,
            Openings::new(),
        ],
    }
}

/// The door on the right, windows on the left of it; of a shop, two large ones on both sides.
fn ground_front(style: &Style) -> Openings {
    let half = 0.5 * style.width;
    match style.ground {
        Ground::Shop => {
            let pane = [0.95, half - 0.75];
            vec![[-pane[1], -pane[0]], [-0.55, 0.55], [pane[0], pane[1]]]
        }
        Ground::Flat => {
            let windows = 0..style.bays - 1;
            let mut openings: Openings = windows
                .map(|bay| bay_middle(style, bay))
                .map(|x| [x - 0.62, x + 0.62])
                .collect();
            let door = bay_middle(style, style.bays - 1);
            openings.push([door - 0.58, door + 0.58]);
            openings
        }
    }
}

impl Builder {
    /// From a face's own space.
    fn frame(&self, face: usize) -> DAffine3 {
        let axis = |p| self.body.place(face, p) - self.body.place(face, DVec3::ZERO);
        DAffine3 {
            matrix3: shadows::glam::DMat3::from_cols(axis(DVec3::X), DVec3::Y, axis(DVec3::Z)),
            translation: self.body.place(face, DVec3::ZERO),
        }
    }

    fn storey(&mut self, face: usize, at: u32, storey: &Storey) {
        let count = storey.faces[face].len();
        for (place, &[left, right]) in storey.faces[face].iter().enumerate() {
            let ([low, high], frame) = (storey.y, self.frame(face));
            let door = at == 0
                && face == 0
                && match self.style.ground {
                    Ground::Shop => place == 1,
                    Ground::Flat => place + 1 == count,
                };
            let foot = match (at, door) {
                (0, true) => low + 1.95,
                (0, false) => low + 0.5,
                _ => low,
            };
            self.pane(&frame, [left, right], [foot, high]);
            if face == 2 {
                continue; // yards are not looked into
            }
            let wide = right - left > 1.5;
            let mut wood = window_frame([left, right], [foot, high], wide);
            if at == 0 {
                // A door leaf, or what is below a window of the ground floor.
                let front = if door { -0.08 } else { -0.05 };
                wood.block(
                    dvec3(left - 0.01, low - 0.01, -NICHE - 0.02),
                    dvec3(right + 0.01, foot + 0.02, front),
                );
            }
            self.wood.add(&wood, frame);
            let mut stone = Surface::default();
            if door {
                stone.block(
                    dvec3(left - 0.15, -0.1, -0.1),
                    dvec3(right + 0.15, 0.24, 0.3),
                );
                stone.block(dvec3(left - 0.2, -0.1, -0.1), dvec3(right + 0.2, 0.12, 0.6));
            } else if at > 0 {
                stone.block(
                    dvec3(left - 0.12, low - 0.11, -0.1),
                    dvec3(right + 0.12, low + 0.02, 0.11),
                );
                stone.block(
                    dvec3(left - 0.14, high + 0.06, -0.1),
                    dvec3(right + 0.14, high + 0.2, 0.09),
                );
            }
            self.stone.add(&stone, frame);
        }
    }

    /// A pane in its niche; about a third are of lit rooms.
    fn pane(&mut self, frame: &DAffine3, [left, right]: [f64; 2], [low, high]: [f64; 2]) {
        self.panes += 1;
        let hash = (self.panes * 7 + self.style.bays * 3 + self.style.storeys * 5) % 13;
        let lit = matches!(hash, 1 | 4 | 6 | 9 | 12);
        let pane = if lit { &mut self.lit } else { &mut self.dark };
        let z = -0.14;
        let corners = [(left, low), (right, low), (right, high), (left, high)];
        let corners = corners.map(|(x, y)| pane.corner(frame.transform_point3(dvec3(x, y, z))));
        pane.quad(corners);
        if lit {
            let middle = dvec3(0.5 * (left + right), 0.35 * low + 0.65 * high, -0.02);
            let out = frame.transform_vector3(DVec3::Z);
            self.windows.push([frame.transform_point3(middle), out]);
        }
    }

    /// The plinth, the band above the ground floor and the cornice.
    fn bands(&mut self, face: usize) {
        let (half, frame) = (self.body.half(face), self.frame(face));
        let top = self.body.height;
        let mut bands = Surface::default();
        let ends = [-half, half];
        for outline in [
            &[
                (-0.1, GROUND - 0.35),
                (0.1, GROUND - 0.3),
                (0.14, GROUND - 0.08),
                (-0.1, GROUND),
            ][..],
            &[
                (-0.1, top - 0.5),
                (0.08, top - 0.5),
                (0.14, top - 0.3),
                (0.42, top - 0.16),
                (0.42, top - 0.02),
                (-0.1, top + 0.04),
            ],
        ] {
            let outline: Vec<_> = outline.iter().map(|(z, y)| dvec2(*z, *y)).collect();
            bands.add(&Surface::prism(&outline, ends), DAffine3::IDENTITY);
        }
        // Under the cornice, small blocks.
        let count = (2.0 * half / 0.62) as u32;
        for i in 0..count {
            let x = -half + 2.0 * half * (f64::from(i) + 0.5) / f64::from(count);
            bands.block(
                dvec3(x - 0.09, top - 0.4, -0.05),
                dvec3(x + 0.09, top - 0.19, 0.34),
            );
        }
        self.crown.add(&bands, frame);
    }

    /// A slab with brackets and a railing under the front's window at x.
    fn balcony(&mut self, x: f64, y: f64) {
        let frame = self.frame(0) * DAffine3::from_translation(dvec3(x, y + 0.5, 0.0));
        let (half, out) = (0.95, 0.95);
        let mut stone = Surface::default();
        stone.block(dvec3(-half, -0.13, -0.1), dvec3(half, 0.0, out));
        let bracket = [
            (-0.05, -0.55),
            (0.12, -0.5),
            (0.6, -0.2),
            (0.6, -0.1),
            (-0.05, -0.1),
        ];
        let bracket = bracket.map(|(z, y)| dvec2(z, y));
        for side in [-0.7, 0.7] {
            let x = [side - 0.08, side + 0.08];
            stone.add(&Surface::prism(&bracket, x), DAffine3::IDENTITY);
        }
        self.stone.add(&stone, frame);
        self.iron.add(&railing(half - 0.06, out - 0.06), frame);
    }

    fn finish(self, storeys: &[Storey], roof: &Surface) -> House {
        let style = self.style;
        let named = |s: &Surface, part: &str| s.finish(&format!("{} {part}", style.name), 30.0);
        let door = match style.ground {
            Ground::Shop => 0.0,
            Ground::Flat => bay_middle(&style, style.bays - 1),
        };
        let beside = self
            .frame(0)
            .transform_point3(dvec3(door + 0.85, 2.45, 0.3));
        let shop = style.ground == Ground::Shop;
        House {
            walls: named(&walls(&self.body, storeys), "walls"),
            crown: named(&self.crown, "crown"),
            stone: named(&self.stone, "stone"),
            wood: named(&self.wood, "wood"),
            roof: named(roof, "roof"),
            iron: (!self.iron.triangles.is_empty()).then(|| named(&self.iron, "iron")),
            dark: named(&self.dark, "panes"),
            lit: named(&self.lit, "lit panes"),
            windows: self.windows.clone(),
            lantern: beside,
            awning: shop.then(|| self.frame(0).transform_point3(dvec3(0.0, 2.78, 0.0))),
        }
    }
}

/// Two uprights, a sill and a head, and a cross (or two mullions where it is wide).
fn window_frame([left, right]: [f64; 2], [low, high]: [f64; 2], wide: bool) -> Surface {
    let mut s = Surface::default();
    let upright = |s: &mut Surface, from: f64, to: f64| {
        s.block(dvec3(from, low - 0.01, -0.18), dvec3(to, high + 0.01, -0.1));
    };
    upright(&mut s, left - 0.01, left + 0.06);
    upright(&mut s, right - 0.06, right + 0.01);
    let width = right - left;
    let mullions: &[f64] = if wide { &[0.34, 0.67] } else { &[0.5] };
    for part in mullions {
        upright(
            &mut s,
            left + part * width - 0.03,
            left + part * width + 0.03,
        );
    }
    let across = 0.3 * low + 0.7 * high;
    for (from, to) in [
        (low - 0.011, low + 0.06),
        (across - 0.03, across + 0.03),
        (high - 0.06, high + 0.011),
    ] {
        s.block(
            dvec3(left - 0.012, from, -0.17),
            dvec3(right + 0.012, to, -0.11),
        );
    }
    s
}

/// Of a balcony around x = 0 that reaches `out` from the wall at z = 0.
fn railing(half: f64, out: f64) -> Surface {
    let mut s = Surface::default();
    let mut bar = |x: f64, z: f64, thick: f64, top: f64| {
        s.block(
            dvec3(x - thick, -0.02, z - thick),
            dvec3(x + thick, top, z + thick),
        );
    };
    for x in [-half, half] {
        bar(x, out, 0.022, 1.0);
        for i in 0..5 {
            bar(x, out * (f64::from(i) + 0.4) / 5.4, 0.01, 0.9);
        }
    }
    for i in 1..13 {
        bar(half * (f64::from(i) / 6.5 - 1.0), out, 0.01, 0.9);
    }
    for y in [0.08, 0.88] {
        let [low, high] = [y, y + 0.035];
        s.block(
            dvec3(-half - 0.02, low, out - 0.02),
            dvec3(half + 0.02, high, out + 0.02),
        );
        for x in [-half, half] {
            s.block(
                dvec3(x - 0.018, low + 0.002, -0.05),
                dvec3(x + 0.018, high - 0.002, out),
            );
        }
    }
    s
}
