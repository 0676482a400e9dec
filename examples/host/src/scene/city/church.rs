//! The church on the square.

use shadows::glam::{DAffine3, DVec2, Vec2, dvec2, dvec3, vec3};

use super::super::surface::Surface;
use super::plan::PAVEMENT;
use super::walls::{Body, Storey, walls};
use super::{City, palette};

/// Walls, stone, roof and panes of the church.
pub struct Church {
    walls: usize,
    stone: usize,
    roof: usize,
    panes: usize,
}

impl Church {
    /// Adds its meshes to the scene.
    pub fn new(city: &mut City) -> Self {
        build(city)
    }

    /// Places it with its front's middle at a point of the ground.
    pub fn place(&self, city: &mut City, middle: Vec2) {
        let place = super::stand(vec3(middle.x, PAVEMENT - 0.05, middle.y), 0.0);
        city.put(self.walls, place, [0.6, 0.53, 0.42]);
        city.put(self.stone, place, palette::STONE);
        city.put(self.roof, place, palette::SLATE[0]);
        city.put_glass(self.panes, place, [0.1, 0.12, 0.18], [0.16, 0.12, 0.07]);
    }
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
fn build(city: &mut City) -> Church {
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
