//! What stands in the streets: lamps, trees, cars, and the market.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use shadows::glam::{Affine3A, Quat, Vec2, Vec3, vec2, vec3};

use super::super::kit::{about_y, direction};
use super::super::plants::{Habit, Wood, grow, lumps};
use super::super::square;
use super::lights::{Candidate, Lamp};
use super::plan::{self, Area, PAVEMENT, Road};
use super::{City, car, palette, stand, street};

/// The pieces of what there is many of.
struct Pieces {
    post: usize,
    shade: usize,
    bulb: usize,
    wire: usize,
    bollard: usize,
    bench: usize,
    car: [usize; 3],
    trees: Vec<[usize; 2]>,
}

pub fn build(city: &mut City) {
    let pieces = Pieces::new(city);
    for road in plan::roads() {
        lamps(city, &pieces, &road);
        cars(city, &pieces, &road);
        if road.main {
            avenue_trees(city, &pieces, &road);
            wires(city, &pieces, &road);
        }
    }
    market(city, &pieces, &plan::market());
}

impl Pieces {
    fn new(city: &mut City) -> Self {
        let habit = Habit {
            height: 7.2,
            clear: 2.7,
            girth: 0.17,
            reach: 2.1,
            branches: 8,
            twigs: 2,
            rise: 0.8,
            wood: Wood::Branches,
            cone: false,
        };
        let trees = (0..3).map(|i| {
            let tree = grow(&habit, 40 + i);
            let crown = lumps(&tree, 0.72, 70 + i);
            [
                city.mesh(tree.wood.finish("trunk", 60.0)),
                city.mesh(crown.finish("crown", 55.0)),
            ]
        });
        let trees = trees.collect();
        Self {
            post: city.mesh(street::lamp_post()),
            shade: city.mesh(street::shade()),
            bulb: city.mesh(street::bulb()),
            wire: city.mesh(street::wire()),
            bollard: city.mesh(street::bollard()),
            bench: city.mesh(street::bench()),
            car: [car::body(), car::cabin(), car::wheels()].map(|mesh| city.mesh(mesh)),
            trees,
        }
    }
}

/// A point of a road: so far along it, so far to the left of its middle.
fn at(road: &Road, along: f32, aside: f32) -> Vec3 {
    let way = (road.to - road.from).normalize();
    let p = road.from + way * along + way.perp() * aside;
    vec3(p.x, PAVEMENT, p.y)
}

/// The turn by which +x comes to lie in a direction.
fn turn_to(way: Vec2) -> f32 {
    -way.as_dvec2().to_angle() as f32
}

fn length(road: &Road) -> f32 {
    road.from.distance(road.to)
}

/// A lamp on its post, with its arm in a direction.
fn lamp(city: &mut City, pieces: &Pieces, foot: Vec3, turn: f32) {
    let place = stand(foot, turn);
    city.put(pieces.post, place, palette::IRON);
    let bulb = place.transform_point3(street::BULB.as_vec3());
    city.put(
        pieces.shade,
        Affine3A::from_translation(bulb),
        palette::IRON,
    );
    let small = Affine3A::from_translation(bulb) * Affine3A::from_scale(Vec3::splat(0.085));
    city.put_glass(pieces.bulb, small, palette::BULB, palette::FLAME);
    city.lights
        .push(Candidate::new(Lamp::Street, bulb, Vec3::ZERO));
}

/// On both sides of the main avenue, on alternate sides of the others.
fn lamps(city: &mut City, pieces: &Pieces, road: &Road) {
    let way = (road.to - road.from).normalize();
    let count = (length(road) / 13.0).round().max(1.0);
    for i in 0..count as u32 {
        let along = length(road) * (i as f32 + 0.5) / count;
        for side in [-1.0, 1.0] {
            if !road.main && (i % 2 == 0) != (side > 0.0) {
                continue;
            }
            // Clear of the trees, which stand between.
            let foot = at(road, along, side * (road.half[0] + 0.45));
            lamp(city, pieces, foot, turn_to(-side * way.perp()));
        }
    }
}

fn avenue_trees(city: &mut City, pieces: &Pieces, road: &Road) {
    let count = (length(road) / 13.0).round();
    for i in 1..count as u32 {
        for side in [-1.0, 1.0] {
            let foot = at(
                road,
                length(road) * i as f32 / count,
                side * (road.half[0] + 0.9),
            );
            tree(city, pieces, foot, 0.9);
        }
    }
}

fn tree(city: &mut City, pieces: &Pieces, foot: Vec3, scale: f32) {
    let [wood, crown] = city.any(&pieces.trees);
    let scale = scale * city.random.within(0.88, 1.08);
    let turn = about_y(city.random.within(0.0, TAU));
    let place = Affine3A::from_scale_rotation_translation(Vec3::splat(scale), turn, foot);
    let leaves = city.any(&palette::LEAVES);
    city.put(wood, place, palette::BARK);
    city.put(crown, place, leaves);
}

/// Parked along the kerbs, with gaps.
fn cars(city: &mut City, pieces: &Pieces, road: &Road) {
    let way = (road.to - road.from).normalize();
    let places = ((length(road) - 8.0) / 5.6) as u32;
    for side in [-1.0, 1.0] {
        for i in 0..places {
            let middle = at(road, 6.8 + 5.6 * i as f32, 0.0);
            let far = middle.distance(city.scene.camera.eye);
            // Fewer where they are small.
            let free = if far < 70.0 { 2 } else { 9 };
            if city.random.below(free + 2) < free {
                continue;
            }
            let shift = city.random.within(-0.4, 0.4);
            let foot = at(
                road,
                6.8 + 5.6 * i as f32 + shift,
                side * (road.half[0] - 1.02),
            );
            let turn = turn_to(side * way) + city.random.within(-0.03, 0.03);
            car(city, pieces, foot.with_y(0.0), turn);
        }
    }
}

fn car(city: &mut City, pieces: &Pieces, foot: Vec3, turn: f32) {
    let paint = city.any(&palette::CAR);
    let place = stand(foot, turn);
    for (mesh, albedo) in pieces
        .car
        .into_iter()
        .zip([paint, palette::GLASS, palette::RUBBER])
    {
        city.put(mesh, place, albedo);
    }
}

/// A wire of this thickness between two points.
fn wire(city: &mut City, pieces: &Pieces, from: Vec3, to: Vec3, thickness: f32) {
    let way = to - from;
    let turn = Quat::from_rotation_y((-way.z).atan2(way.x));
    let slope = Quat::from_rotation_z((way.y / way.length()).asin());
    // What sags is scaled as what is thick: the wire is as tall as it hangs low.
    let scale = vec3(way.length(), thickness.max(1e-3), thickness);
    let place = Affine3A::from_scale_rotation_translation(scale, turn * slope, from);
    city.put(pieces.wire, place, palette::IRON);
}

/// The tram's: two lines along the avenue, held by wires from house to house.
fn wires(city: &mut City, pieces: &Pieces, road: &Road) {
    let spans = 2;
    let height = 5.9;
    for i in 0..spans {
        let ends = [i, i + 1].map(|k| length(road) * k as f32 / spans as f32);
        for aside in [-1.9, 1.9] {
            let [from, to] = ends.map(|along| at(road, along, aside).with_y(height));
            wire(city, pieces, from, to, 0.016);
        }
        let along = 0.5 * (ends[0] + ends[1]);
        let [left, right] = [-1.0, 1.0].map(|side| at(road, along, side * road.half[1]));
        wire(
            city,
            pieces,
            left.with_y(height + 1.3),
            right.with_y(height + 1.3),
            0.014,
        );
        for aside in [-1.9, 1.9] {
            let top = at(road, along, aside).with_y(height + 1.28);
            wire(
                city,
                pieces,
                top,
                top.with_y(height) + Vec3::X * 0.01,
                0.012,
            );
        }
    }
}

/// The square: a fountain, trees around it, stalls, tables, benches, strings of bulbs.
fn market(city: &mut City, pieces: &Pieces, area: &Area) {
    let middle = 0.5 * (area.min + area.max);
    let ground = |p: Vec2| vec3(p.x, PAVEMENT, p.y);
    let fountain = city.mesh(street::fountain());
    city.put(fountain, stand(ground(middle), 0.0), palette::STONE);
    let water = city.mesh(square("water", Vec3::ZERO, 1.8));
    let level = ground(middle) + Vec3::Y * 0.5;
    city.place(water, stand(level, 0.4), palette::WATER, [0.0; 3], false);
    for (i, side) in [
        (-1.0, -1.0),
        (0.0, -1.0),
        (1.0, -1.0),
        (1.0, 1.0),
        (0.0, 1.0),
        (-1.0, 1.0),
    ]
    .into_iter()
    .enumerate()
    {
        let place = middle + vec2(10.5 * side.0, 13.5 * side.1);
        tree(city, pieces, ground(place), 1.0 + 0.1 * (i % 2) as f32);
    }
    for i in 0..8 {
        let angle = TAU * (i as f32 + 0.5) / 8.0;
        let out = direction(angle);
        let turn = f64::from(out.x).atan2(out.y.into()) as f32;
        let place = stand(ground(middle + 5.6 * out), turn + PI);
        city.put(pieces.bench, place, palette::PLANK);
    }
    for i in 0..4 {
        let out = direction(TAU * i as f32 / 4.0 + 0.4);
        lamp(city, pieces, ground(middle + 7.4 * out), turn_to(-out));
    }
    stalls(city, area);
    tables(city, pieces, area);
    for i in 0..12 {
        let z = area.min.y + 1.5 + (area.max.y - area.min.y - 3.0) * i as f32 / 11.0;
        let foot = vec3(area.min.x + 0.7, PAVEMENT, z);
        city.put(pieces.bollard, stand(foot, 0.0), palette::IRON);
    }
    strings(city, pieces, middle);
}

fn stalls(city: &mut City, area: &Area) {
    let stall = city.mesh(street::stall());
    for i in 0..4 {
        let foot = vec3(
            area.max.x - 3.2,
            PAVEMENT,
            area.min.y + 6.5 + 8.0 * i as f32,
        );
        let (turn, cloth) = (
            -FRAC_PI_2 + city.random.within(-0.1, 0.1),
            city.any(&palette::CLOTH),
        );
        city.put(stall, stand(foot, turn), cloth);
        let place = stand(foot, turn) * Affine3A::from_translation(vec3(0.0, 2.05, 0.2));
        city.lights.push(Candidate::new(
            Lamp::Bulb,
            place.translation.into(),
            Vec3::ZERO,
        ));
    }
}

fn tables(city: &mut City, pieces: &Pieces, area: &Area) {
    let umbrella = city.mesh(street::umbrella());
    let table = city.mesh(street::table());
    for i in 0..6 {
        let (row, column) = (i / 3, i % 3);
        let foot = vec3(
            area.min.x + 4.2 + 4.0 * column as f32,
            PAVEMENT,
            area.max.y - 2.6 - 3.6 * row as f32,
        );
        let turn = city.random.within(0.0, TAU);
        city.put(table, stand(foot, turn), palette::PLANK);
        if (row + column) % 2 == 0 {
            let cloth = palette::CLOTH[(column % 2) as usize];
            city.put(umbrella, stand(foot, turn), cloth);
        }
    }
    for i in 0..3 {
        let foot = vec3(
            area.min.x + 2.2 + 5.0 * i as f32,
            PAVEMENT,
            area.max.y - 9.6,
        );
        city.put(pieces.bench, stand(foot, PI), palette::PLANK);
    }
}

/// From the lamps around the fountain outwards, with a bulb every few metres.
fn strings(city: &mut City, pieces: &Pieces, middle: Vec2) {
    for i in 0..4 {
        let out = direction(TAU * i as f32 / 4.0 + 0.4);
        let next = direction(TAU * (i + 1) as f32 / 4.0 + 0.4);
        let post = |out: Vec2| {
            let p = middle + 7.4 * out;
            vec3(p.x, PAVEMENT + 4.7, p.y)
        };
        let (from, to) = (post(out), post(next));
        wire(city, pieces, from, to, 0.02);
        for k in 1..8 {
            let t = k as f32 / 8.0;
            let p = from.lerp(to, t) - Vec3::Y * (0.002 * t * (1.0 - t) + 0.1);
            let bulb = Affine3A::from_translation(p) * Affine3A::from_scale(Vec3::splat(0.06));
            city.put_glass(pieces.bulb, bulb, palette::BULB, palette::FLAME);
            city.lights.push(Candidate::new(Lamp::Bulb, p, Vec3::ZERO));
        }
    }
}
