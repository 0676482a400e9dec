//! Rows of houses around the blocks, and the church.

use std::f32::consts::{FRAC_PI_2, PI};

use shadows::glam::{Affine3A, DAffine3, DVec2, Vec2, Vec3, dvec2, dvec3, vec2, vec3};

use super::super::surface::Surface;
use super::City;
use super::house::{Ground, House, Style, house};
use super::lights::{Candidate, Lamp};
use super::palette;
use super::plan::{self, Area, PAVEMENT};
use super::roof::Roof;
use super::street::{LANTERN, awning, bracket, bulb};
use super::walls::{Body, Storey, walls};

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
    let church = church(city);
    for block in plan::blocks().filter(|block| !block.square) {
        for row in rows(&block.houses) {
            let Row { left, along, .. } = row;
            let middle = left + 0.5 * row.length * along;
            if plan::faces_market(middle) {
                place_church(city, &church, middle);
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

/// Walls, stone, roof and panes of the church.
struct Church {
    walls: usize,
    stone: usize,
    roof: usize,
    panes: usize,
}

const NAVE: Body = Body {
    width: 11.0,
    height: 11.0,
    depth: 20.0,
};
const TOWER: Body = Body {
    width: 6.4,
    height: 25.0,
    depth: 6.4,
};

/// Its front is at z = 0, towards +z.
fn church(city: &mut City) -> Church {
    let bays = |count: u32, length: f64, half: f64| -> Vec<[f64; 2]> {
        let middle = |i| length * ((f64::from(i) + 0.5) / f64::from(count) - 0.5);
        (0..count)
            .map(|i| [middle(i) - half, middle(i) + half])
            .collect()
    };
    let side = bays(4, NAVE.depth, 0.6);
    let nave = [Storey {
        y: [3.4, 8.6],
        faces: [vec![], side.clone(), vec![], side],
    }];
    let [door, narrow, wide] = [1.1, 0.3, 0.75].map(|half| vec![[-half, half]]);
    let storey = |y, faces| Storey { y, faces };
    let tower = [
        storey([0.3, 3.6], [door, vec![], vec![], vec![]]),
        storey([6.5, 9.5], [narrow.clone(), narrow.clone(), vec![], narrow]),
        storey(
            [19.0, 22.6],
            [wide.clone(), wide.clone(), wide.clone(), wide],
        ),
    ];
    let behind = DAffine3::from_translation(dvec3(0.0, 0.0, -0.5 * NAVE.depth - 2.0));
    let front = DAffine3::from_translation(dvec3(0.0, 0.0, -0.5 * TOWER.depth));
    let mut wall = walls(&NAVE, &nave).placed(behind);
    wall.add(&walls(&TOWER, &tower), front);
    let (mut stone, mut panes) = (Surface::default(), Surface::default());
    for (place, body, storeys) in [(behind, &NAVE, &nave[..]), (front, &TOWER, &tower[..])] {
        for storey in storeys {
            for (face, openings) in storey.faces.iter().enumerate() {
                for [left, right] in openings {
                    let [low, high] = storey.y;
                    let corners = [(left, low), (right, low), (right, high), (left, high)];
                    let corners = corners.map(|(x, y)| {
                        let p = body.place(face, dvec3(*x, y, -0.15));
                        panes.corner(place.transform_point3(p))
                    });
                    panes.quad(corners);
                }
            }
        }
    }
    for y in [5.4, 11.6, 17.2, 24.6] {
        let half = 0.5 * TOWER.width + 0.12;
        let z = [-TOWER.depth - 0.12, 0.12];
        stone.block(dvec3(-half, y, z[0]), dvec3(half, y + 0.3, z[1]));
    }
    for x in [-5.5, 5.5] {
        for i in 0..5 {
            let z = -2.3 - 4.85 * f64::from(i);
            stone.block(dvec3(x - 0.5, -0.1, z - 0.4), dvec3(x + 0.5, 7.2, z + 0.4));
            stone.block(
                dvec3(x - 0.8, -0.12, z - 0.45),
                dvec3(x + 0.8, 2.6, z + 0.45),
            );
        }
    }
    let clock = [(0.0, 0.0), (1.1, 0.0), (1.1, 0.1), (0.0, 0.1)].map(|(r, y)| dvec2(r, y));
    let dial = Surface::turned(&clock, 20, |p, _| p.x)
        .placed(DAffine3::from_rotation_x(std::f64::consts::FRAC_PI_2));
    stone.add(&dial, DAffine3::from_translation(dvec3(0.0, 14.6, -0.03)));
    let mut roof = Surface::default();
    let gable: [DVec2; 5] = [
        (-5.9, 10.9),
        (5.9, 10.9),
        (5.9, 11.1),
        (0.0, 17.0),
        (-5.9, 11.1),
    ]
    .map(|(x, y)| dvec2(x, y));
    let fan = [[0, 1, 2], [0, 2, 3], [0, 3, 4]];
    roof.add(
        &Surface::plate(&gable, &fan, (-NAVE.depth - 2.3, -1.8)),
        DAffine3::IDENTITY,
    );
    let spire = [
        (0.0, 24.8),
        (4.75, 24.8),
        (4.6, 25.1),
        (2.2, 29.5),
        (0.12, 39.0),
        (0.0, 39.1),
    ]
    .map(|(r, y)| dvec2(r, y));
    let spire = Surface::turned(&spire, 4, |p, _| p.x);
    roof.add(
        &spire,
        front * DAffine3::from_rotation_y(0.25 * std::f64::consts::PI),
    );
    let top = dvec3(0.0, 38.8, -0.5 * TOWER.depth);
    roof.rod(top, top + dvec3(0.0, 2.2, 0.0), 0.06, 6);
    roof.rod(
        top + dvec3(-0.6, 1.5, 0.0),
        top + dvec3(0.6, 1.5, 0.0),
        0.05,
        6,
    );
    Church {
        walls: city.mesh(wall.finish("church walls", 30.0)),
        stone: city.mesh(stone.finish("church stone", 30.0)),
        roof: city.mesh(roof.finish("church roof", 30.0)),
        panes: city.mesh(panes.finish("church panes", 30.0)),
    }
}

fn place_church(city: &mut City, church: &Church, middle: Vec2) {
    let place = super::stand(vec3(middle.x, PAVEMENT - 0.05, middle.y), 0.0);
    city.put(church.walls, place, [0.6, 0.53, 0.42]);
    city.put(church.stone, place, palette::STONE);
    city.put(church.roof, place, palette::SLATE[0]);
    city.put_glass(church.panes, place, [0.1, 0.12, 0.18], [0.16, 0.12, 0.07]);
}
