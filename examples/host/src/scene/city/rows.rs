//! Rows of houses around the blocks.

use std::f32::consts::{FRAC_PI_2, PI};

use shadows::glam::{Affine3A, Vec2, Vec3, vec2, vec3};

use super::City;
use super::church::Church;
use super::house::{Ground, House, Style, house};
use super::lights::{Candidate, Lamp};
use super::palette;
use super::plan::{self, Area, PAVEMENT};
use super::roof::Roof;
use super::street::{LANTERN, awning, bracket, bulb};

/// How deep houses are.
const DEPTH: f64 = 10.0;
/// Houses farther from the eye than this have no details.
const DETAILED: f32 = 66.0;

const MIDDLES: [Style; 5] = [
    style(
        "shop",
        8.4,
        3,
        3,
        Ground::Shop,
        Roof::Mansard,
        &[[1, 0], [1, 1]],
    ),
    style("terrace", 9.6, 4, 2, Ground::Flat, Roof::Gable, &[]),
    style(
        "hotel",
        10.4,
        4,
        4,
        Ground::Shop,
        Roof::Flat,
        &[[1, 0], [2, 0], [1, 2], [2, 2]],
    ),
    style("narrow", 7.2, 3, 3, Ground::Flat, Roof::Gable, &[[1, 0]]),
    style(
        "house",
        9.0,
        3,
        3,
        Ground::Flat,
        Roof::Mansard,
        &[[0, 1], [2, 1]],
    ),
];
const CORNERS: [Style; 2] = [
    corner(style(
        "corner",
        9.8,
        3,
        4,
        Ground::Shop,
        Roof::Flat,
        &[[0, 0], [1, 1], [2, 0]],
    )),
    corner(style(
        "inn",
        9.2,
        3,
        3,
        Ground::Flat,
        Roof::Gable,
        &[[1, 0]],
    )),
];

const fn style(
    name: &'static str,
    width: f64,
    bays: u32,
    storeys: u32,
    ground: Ground,
    roof: Roof,
    balconies: &'static [[u32; 2]],
) -> Style {
    Style {
        name,
        width,
        depth: DEPTH,
        bays,
        storeys,
        ground,
        roof,
        balconies,
        corner: false,
    }
}

const fn corner(style: Style) -> Style {
    Style {
        corner: true,
        ..style
    }
}

/// A house's meshes among the scene's.
struct Kind {
    style: Style,
    near: Vec<(usize, Part)>,
    far: Vec<(usize, Part)>,
    windows: Vec<[Vec3; 2]>,
    lantern: Vec3,
    awning: Option<Vec3>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Walls,
    Stone,
    Wood,
    Roof,
    Iron,
    Dark,
    Lit,
}

/// What hangs on houses.
struct Fittings {
    bracket: usize,
    bulb: usize,
    awning: usize,
}

/// A line of houses: where it begins on the left as seen from the street, which way it runs, how far,
/// and by how much houses are turned.
struct Row {
    left: Vec2,
    along: Vec2,
    length: f32,
    turn: f32,
    corners: bool,
}

/// All blocks but the square.
pub fn build(city: &mut City) {
    let middles: Vec<Kind> = MIDDLES.iter().map(|style| kind(city, *style)).collect();
    let corners: Vec<Kind> = CORNERS.iter().map(|style| kind(city, *style)).collect();
    let fittings = Fittings {
        bracket: city.mesh(bracket()),
        bulb: city.mesh(bulb()),
        awning: city.mesh(awning()),
    };
    let church = Church::new(city);
    for block in plan::blocks().filter(|block| !block.square) {
        for row in rows(&block.houses) {
            let Row { left, along, .. } = row;
            let middle = left + 0.5 * row.length * along;
            if plan::faces_market(middle) {
                church.place(city, middle);
                continue;
            }
            fill(city, &row, &middles, &corners, &fittings);
        }
    }
}

fn rows(area: &Area) -> [Row; 4] {
    let (min, max) = (area.min, area.max);
    let (deep, size) = (DEPTH as f32, max - min);
    let row = |left, along, length, turn, corners| Row {
        left,
        along,
        length,
        turn,
        corners,
    };
    [
        row(min, Vec2::Y, size.y, -FRAC_PI_2, true),
        row(max, -Vec2::Y, size.y, FRAC_PI_2, true),
        row(
            vec2(max.x - deep, min.y),
            -Vec2::X,
            size.x - 2.0 * deep,
            PI,
            false,
        ),
        row(
            vec2(min.x + deep, max.y),
            Vec2::X,
            size.x - 2.0 * deep,
            0.0,
            false,
        ),
    ]
}

fn kind(city: &mut City, style: Style) -> Kind {
    let House {
        walls,
        crown,
        stone,
        wood,
        roof,
        iron,
        dark,
        lit,
        windows,
        lantern,
        awning,
    } = house(style);
    let far = vec![
        (city.mesh(walls), Part::Walls),
        (city.mesh(crown), Part::Stone),
        (city.mesh(roof), Part::Roof),
        (city.mesh(dark), Part::Dark),
        (city.mesh(lit), Part::Lit),
    ];
    let mut near = far.clone();
    near.extend([
        (city.mesh(stone), Part::Stone),
        (city.mesh(wood), Part::Wood),
    ]);
    near.extend(iron.map(|iron| (city.mesh(iron), Part::Iron)));
    Kind {
        style,
        near,
        far,
        windows: windows
            .iter()
            .map(|pair| pair.map(|p| p.as_vec3()))
            .collect(),
        lantern: lantern.as_vec3(),
        awning: awning.map(|p| p.as_vec3()),
    }
}

/// Places houses side by side, stretched a little so that they fill the row.
fn fill(city: &mut City, row: &Row, middles: &[Kind], corners: &[Kind], fittings: &Fittings) {
    let mut chosen: Vec<(&Kind, bool)> = Vec::new();
    let mut rest = row.length;
    if row.corners {
        let ends = [0, 1].map(|_| &corners[city.random.below(corners.len())]);
        rest -= (ends[0].style.width + ends[1].style.width) as f32;
        chosen.extend([(ends[0], true), (ends[1], false)]);
    }
    let mut last = middles.len();
    for _ in 0..(rest / 8.9).round().max(1.0) as u32 {
        // No two of a kind side by side.
        let mut next = city.random.below(middles.len());
        while next == last {
            next = city.random.below(middles.len());
        }
        last = next;
        let at = if row.corners {
            chosen.len() - 1
        } else {
            chosen.len()
        };
        chosen.insert(at, (&middles[next], false));
    }
    let total: f32 = chosen.iter().map(|(kind, _)| kind.style.width as f32).sum();
    let stretch = row.length / total;
    let mut at = 0.0;
    for (kind, mirrored) in chosen {
        let width = kind.style.width as f32 * stretch;
        let out = vec2(row.turn.sin(), row.turn.cos());
        let middle = row.left + row.along * (at + 0.5 * width) - out * (0.5 * DEPTH as f32);
        at += width;
        // A little wider than its place, so that no light falls between neighbours.
        let stretch = stretch * 1.003 * if mirrored { -1.0 } else { 1.0 };
        let place = super::stand(vec3(middle.x, PAVEMENT - 0.05, middle.y), row.turn)
            * Affine3A::from_scale(vec3(stretch, 1.0, 1.0));
        put_house(city, kind, place, fittings);
    }
}

fn put_house(city: &mut City, kind: &Kind, place: Affine3A, fittings: &Fittings) {
    let plaster = city.any(&palette::PLASTER);
    let roof = match kind.style.roof {
        Roof::Gable => city.any(&palette::CLAY),
        Roof::Mansard => city.any(&palette::SLATE),
        Roof::Flat => palette::SLATE[1],
    };
    let wood = city.any(&palette::WOOD);
    let room = city.any(&palette::ROOM);
    let foot = Vec3::from(place.translation);
    let near = foot.distance(city.scene.camera.eye) < DETAILED;
    for &(mesh, part) in if near { &kind.near } else { &kind.far } {
        match part {
            Part::Walls => city.put(mesh, place, plaster),
            Part::Stone => city.put(mesh, place, palette::STONE),
            Part::Wood => city.put(mesh, place, wood),
            Part::Roof => city.put(mesh, place, roof),
            Part::Iron => city.put(mesh, place, palette::IRON),
            Part::Dark => city.put_glass(mesh, place, palette::GLASS, [0.0; 3]),
            Part::Lit => city.put_glass(mesh, place, palette::GLASS, room),
        }
    }
    light_windows(city, kind, &place);
    if near || city.random.below(4) == 0 {
        put_lantern(city, kind, &place, fittings);
    }
    if let Some(awning) = kind.awning.filter(|_| near) {
        let half = 0.5 * kind.style.width as f32 - 0.6;
        let cloth = city.any(&palette::CLOTH);
        let place =
            place * Affine3A::from_translation(awning) * Affine3A::from_scale(vec3(half, 1.0, 1.0));
        city.put(fittings.awning, place, cloth);
    }
}

/// Spots out of a few of its lit windows.
fn light_windows(city: &mut City, kind: &Kind, place: &Affine3A) {
    let low = kind.windows.iter().filter(|[middle, _]| middle.y < 9.5);
    let low: Vec<_> = low.collect();
    for _ in 0..4.min(low.len()) {
        let [middle, out] = *low[city.random.below(low.len())];
        let (middle, out) = (place.transform_point3(middle), place.transform_vector3(out));
        let known = city
            .lights
            .iter()
            .any(|c| c.light.place.truncate() == middle);
        if !known {
            city.lights
                .push(Candidate::new(Lamp::Window, middle, out.normalize()));
        }
    }
}

fn put_lantern(city: &mut City, kind: &Kind, place: &Affine3A, fittings: &Fittings) {
    let wall = kind.lantern - vec3(0.0, 0.0, 0.3);
    let place = *place * Affine3A::from_translation(wall);
    // Not stretched with the house.
    let turn = place.matrix3.z_axis.x.atan2(place.matrix3.z_axis.z);
    let place = super::stand(place.translation.into(), turn);
    city.put(fittings.bracket, place, palette::IRON);
    let at = place.transform_point3(LANTERN.as_vec3());
    let bulb = Affine3A::from_translation(at) * Affine3A::from_scale(Vec3::splat(0.055));
    city.put_glass(fittings.bulb, bulb, palette::BULB, palette::FLAME);
    city.lights
        .push(Candidate::new(Lamp::Lantern, at, Vec3::ZERO));
}
