//! A kilometre of land under a low sun: a village on a road in a valley, woods on its slopes.
//! Generated and seeded; metres.
//!
//! The library draws no alpha-tested casters by itself, so [`valley`] has leaves of two triangles each,
//! small as they are: every technique shadows the same scene, and exactly. [`valley_with`] makes the
//! crowns of alpha-tested cards instead, which only a host can draw; shadow techniques that leave the
//! host no say then miss the shadows of leaves (trunks cast as ever).

mod fields;
mod terrain;
mod village;

use std::f32::consts::{PI, TAU};

use shadows::glam::{Affine3A, Mat3A, Vec3, Vec4, dvec2, vec3};

use super::super::random::Random;
use super::city::street;
use super::kit::{about_y, leaning};
use super::plants::{Habit, Leaves, Wood, foliage, grow};
use super::{Camera, Light, Mesh, Object, Scene, Sky};
use fields::INSULATORS;
use terrain::{ground, height, normal, road, stream};
use village::Building;

const GRASS: [f32; 3] = [0.25, 0.34, 0.1];
const ROAD: [f32; 3] = [0.46, 0.4, 0.31];
const WATER: [f32; 3] = [0.16, 0.25, 0.28];
const BARK: [f32; 3] = [0.19, 0.145, 0.1];
const WOOD: [f32; 3] = [0.36, 0.27, 0.19];
const IRON: [f32; 3] = [0.08, 0.085, 0.09];
const STONE: [f32; 3] = [0.5, 0.48, 0.44];
const PLASTER: [[f32; 3]; 4] = [
    [0.72, 0.68, 0.58],
    [0.68, 0.58, 0.44],
    [0.6, 0.54, 0.46],
    [0.74, 0.72, 0.67],
];
const TILES: [[f32; 3]; 3] = [[0.42, 0.18, 0.11], [0.36, 0.17, 0.12], [0.25, 0.22, 0.21]];
const FOLIAGE: [[f32; 3]; 5] = [
    [0.17, 0.29, 0.075],
    [0.22, 0.33, 0.085],
    [0.28, 0.34, 0.09],
    [0.34, 0.31, 0.08],
    [0.14, 0.25, 0.07],
];
const NEEDLES: [[f32; 3]; 2] = [[0.075, 0.155, 0.075], [0.09, 0.18, 0.08]];

/// Where the camera stands.
const EYE: [f64; 2] = [-10.5, 37.0];

/// The valley with leaves of solid triangles, which all techniques can draw.
pub fn valley() -> Scene {
    valley_with(Leaves::Solid)
}

/// The valley with leaves of a kind.
pub fn valley_with(leaves: Leaves) -> Scene {
    let mut valley = Valley::new(leaves);
    valley.land();
    valley.village();
    valley.fences();
    valley.poles();
    valley.trees();
    valley.meadow();
    valley.scene
}

/// The scene while it is built.
struct Valley {
    scene: Scene,
    leaves: Leaves,
    random: Random,
}

/// A tree's wood and crown among the meshes.
type Tree = [usize; 2];

impl Valley {
    fn new(leaves: Leaves) -> Self {
        let mut scene = Scene::empty(match leaves {
            Leaves::Solid => "valley",
            Leaves::Masked => "valley-leaves",
        });
        let eye = ground(EYE[0], EYE[1]).as_vec3() + vec3(0.0, 2.3, 0.0);
        scene.camera = Camera {
            eye,
            target: eye + vec3(8.5, -1.6, -50.0),
            fovy: 48_f32.to_radians(),
            near: 0.1,
        };
        scene.sky = Sky {
            horizon: [0.66, 0.72, 0.76],
            zenith: [0.17, 0.34, 0.62],
            ambient: [0.15, 0.175, 0.215],
            haze: 0.00075,
        };
        let sun = Light {
            color: [1.0, 0.86, 0.66],
            intensity: Some(2.6),
            ..Light::new(Vec4::new(-0.74, 0.42, 0.36, 0.0), 1.0)
        };
        scene.lights = vec![sun];
        Self {
            scene,
            leaves,
            random: Random(5),
        }
    }

    fn mesh(&mut self, mesh: Mesh) -> usize {
        self.scene.add_mesh(mesh)
    }

    fn put(&mut self, mesh: usize, transform: Affine3A, albedo: [f32; 3]) {
        self.place(mesh, transform, albedo, true);
    }

    fn place(&mut self, mesh: usize, transform: Affine3A, albedo: [f32; 3], casts: bool) {
        let (name, number) = (&self.scene.meshes[mesh].name, self.scene.objects.len());
        self.scene.objects.push(Object {
            name: format!("{name} {number}"),
            mesh,
            transform,
            casts,
            albedo,
            glow: [0.0; 3],
        });
    }

    fn any<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.random.below(of.len())]
    }

    fn within(&mut self, from: f64, to: f64) -> f64 {
        f64::from(self.random.within(from as f32, to as f32))
    }

    /// The ground, the road and the stream.
    fn land(&mut self) {
        for block in terrain::blocks(dvec2(2.0, 20.0)) {
            let mesh = self.mesh(block);
            self.put(mesh, Affine3A::IDENTITY, GRASS);
        }
        let ends = [-300.0, 140.0];
        let lane = terrain::ribbon("road", road, ends, 1.2 * terrain::ROAD, terrain::road_level);
        let water = 1.5 * terrain::STREAM;
        let water = terrain::ribbon("water", stream, ends, water, terrain::water_level);
        for (mesh, albedo) in [(lane, ROAD), (water, WATER)] {
            let mesh = self.mesh(mesh);
            self.place(mesh, Affine3A::IDENTITY, albedo, false);
        }
        let stones: Vec<usize> = (0..3).map(|i| self.mesh(fields::boulder(i))).collect();
        for _ in 0..70 {
            let z = self.within(-150.0, 75.0);
            let side = self.any(&[-1.0, 1.0]);
            let x = stream(z) + side * self.within(1.2, 4.5);
            let size = self.within(0.15, 0.6) as f32;
            let mesh = self.any(&stones);
            let turn = about_y(self.within(0.0, 6.3) as f32);
            let foot = ground(x, z).as_vec3();
            let place = Affine3A::from_scale_rotation_translation(Vec3::splat(size), turn, foot);
            self.put(mesh, place, STONE);
        }
    }

    /// Houses on both sides of the road, and a chapel.
    fn village(&mut self) {
        let kinds = [
            village::cottage("cottage", 9.0, 6.4, 3),
            village::cottage("farm", 13.0, 7.0, 4),
            village::cottage("hut", 6.2, 5.4, 2),
        ];
        let kinds: Vec<[usize; 5]> = kinds.into_iter().map(|kind| self.building(kind)).collect();
        let chapel = self.building(village::tower());
        let nave = kinds[1];
        for i in 0..7 {
            for side in [-1.0, 1.0] {
                let z = -22.0 - 15.0 * f64::from(i) + self.within(-3.0, 3.0) - 5.0 * side;
                let off = terrain::ROAD + 7.0 + self.within(0.0, 4.5);
                let x = road(z) + side * off;
                if (x - stream(z)).abs() < 9.0 || (i == 2 && side < 0.0) {
                    continue;
                }
                let kind = self.any(&kinds);
                let turn = -side * 0.5 * f64::from(PI) + self.within(-0.25, 0.25);
                self.raise(&kind, [x, z], turn as f32);
            }
        }
        let z = -66.0;
        let x = road(z) - 15.0;
        self.raise(&nave, [x, z], 0.5 * PI);
        self.raise(&chapel, [x + 6.2, z + 4.6], 0.5 * PI);
    }

    fn building(&mut self, building: Building) -> [usize; 5] {
        let Building {
            walls,
            wood,
            roof,
            stone,
            panes,
        } = building;
        [walls, wood, roof, stone, panes].map(|mesh| self.mesh(mesh))
    }

    fn raise(
        &mut self,
        [walls, wood, roof, stone, panes]: &[usize; 5],
        [x, z]: [f64; 2],
        turn: f32,
    ) {
        let foot = ground(x, z).as_vec3() + Vec3::Y * (0.25 - village::SUNK);
        let place = Affine3A::from_rotation_translation(about_y(turn), foot);
        let plaster = self.any(&PLASTER);
        let tiles = self.any(&TILES);
        let paint = self.any(&[[0.2, 0.26, 0.2], [0.3, 0.17, 0.1], [0.22, 0.28, 0.34]]);
        self.put(*walls, place, plaster);
        self.put(*wood, place, paint);
        self.put(*roof, place, tiles);
        self.put(*stone, place, STONE);
        self.place(*panes, place, [0.08, 0.1, 0.13], false);
    }

    /// Along both sides of the road, with a gap for the village, and across the near meadow.
    fn fences(&mut self) {
        let pair = fields::fence().map(|mesh| self.mesh(mesh));
        for side in [-1.0, 1.0] {
            let at = |z: f64| [road(z) + side * (terrain::ROAD + 1.9), z];
            let near: Vec<[f64; 2]> = (0..32).map(|i| at(62.0 - 2.6 * f64::from(i))).collect();
            self.fence(&pair, &near);
        }
        let from = [road(24.0) - terrain::ROAD - 1.9, 24.0];
        let across = |i: u32| [from[0] - 2.5 * f64::from(i), 24.0 - 0.5 * f64::from(i)];
        let across: Vec<[f64; 2]> = (0..20).map(across).collect();
        self.fence(&pair, &across);
    }

    fn fence(&mut self, [post, rails]: &[usize; 2], feet: &[[f64; 2]]) {
        for pair in feet.windows(2) {
            let [from, to] = [0, 1].map(|k: usize| ground(pair[k][0], pair[k][1]).as_vec3());
            let way = to - from;
            let turn = about_y(self.within(0.0, 6.3) as f32);
            self.put(*post, Affine3A::from_rotation_translation(turn, from), WOOD);
            // Sheared, not turned: rails follow the slope and posts stay upright.
            let side = way.cross(Vec3::Y).normalize();
            let rail = Affine3A {
                matrix3: Mat3A::from_cols(way.into(), Vec3::Y.into(), side.into()),
                translation: from.into(),
            };
            self.put(*rails, rail, WOOD);
        }
    }

    /// Poles along the road, and their wires.
    fn poles(&mut self) {
        let pole = self.mesh(fields::pole());
        let wire = self.mesh(street::wire());
        let mut last: Option<Affine3A> = None;
        for i in 0..9 {
            let z = 66.0 - 32.0 * f64::from(i);
            let x = road(z) + terrain::ROAD + 3.4;
            let way = road(z - 10.0) - road(z + 10.0);
            let turn = about_y((-way / 20.0).atan() as f32);
            let place = Affine3A::from_rotation_translation(turn, ground(x, z).as_vec3());
            self.put(pole, place, WOOD);
            if let Some(last) = last {
                for top in INSULATORS.map(|top| top.as_vec3()) {
                    let [from, to] = [last, place].map(|place| place.transform_point3(top));
                    let way = to - from;
                    let side = way.cross(Vec3::Y).normalize();
                    // It hangs through by a fortieth of its own height: a metre is what it is scaled by.
                    let matrix3 =
                        Mat3A::from_cols(way.into(), (Vec3::Y * 0.02).into(), (side * 0.02).into());
                    let translation = from.into();
                    self.put(
                        wire,
                        Affine3A {
                            matrix3,
                            translation,
                        },
                        IRON,
                    );
                }
            }
            last = Some(place);
        }
    }

    /// Near ones have all their leaves; far ones fewer, as large as it takes.
    fn trees(&mut self) {
        let broad = Habit {
            height: 9.0,
            clear: 2.4,
            girth: 0.24,
            reach: 3.4,
            branches: 15,
            twigs: 4,
            rise: 0.55,
            wood: Wood::Branches,
            cone: false,
        };
        let fir = Habit {
            height: 13.0,
            clear: 1.0,
            girth: 0.2,
            reach: 3.0,
            branches: 34,
            twigs: 3,
            rise: 0.05,
            wood: Wood::Trunk,
            cone: true,
        };
        let far_of = |habit: Habit| Habit {
            branches: habit.branches / 2,
            twigs: habit.twigs - 1,
            wood: Wood::Trunk,
            ..habit
        };
        let solid = self.leaves == Leaves::Solid;
        // How many leaves a twig has, how large they are, and how far they spread.
        let [near_leaves, far_leaves] = match solid {
            true => [[14.0, 0.5, 0.8], [7.0, 1.15, 1.1]],
            false => [[3.0, 1.25, 0.5], [2.0, 2.1, 0.6]],
        };
        let [near_needles, far_needles] = match solid {
            true => [[9.0, 0.75, 0.6], [5.0, 1.6, 0.8]],
            false => [[2.0, 1.3, 0.3], [2.0, 2.2, 0.5]],
        };
        let mut kinds = |habit: Habit, leaves, droop, seeds: std::ops::Range<u64>| -> Vec<Tree> {
            seeds
                .map(|seed| self.tree(&habit, leaves, droop, seed))
                .collect()
        };
        let near = [
            kinds(broad, near_leaves, 0.2, 1..4),
            kinds(fir, near_needles, 0.5, 21..23),
        ];
        let far = [
            kinds(far_of(broad), far_leaves, 0.2, 31..34),
            kinds(far_of(fir), far_needles, 0.5, 41..43),
        ];
        self.single_trees(&near);
        self.woods(&near, &far);
    }

    fn tree(&mut self, habit: &Habit, leaves: [f64; 3], droop: f64, seed: u64) -> Tree {
        let skeleton = grow(habit, seed);
        let crown = foliage(&skeleton, self.leaves, leaves, droop, seed + 100);
        [
            self.mesh(skeleton.wood.finish("trunk", 60.0)),
            self.mesh(crown),
        ]
    }

    /// Along the road and the stream, and between the houses.
    fn single_trees(&mut self, near: &[Vec<Tree>; 2]) {
        let places = [
            [road(30.0) + 8.5, 30.0],
            [road(2.0) - 30.0, 2.0],
            [road(-6.0) - 8.0, -7.0],
        ];
        for place in places {
            self.plant(&near[0], place, &FOLIAGE, 1.0);
        }
        for i in 0..20 {
            let z = 58.0 - 9.5 * f64::from(i) + self.within(-3.0, 3.0);
            let side = self.any(&[-1.0, 1.0]);
            let x = stream(z) + side * self.within(4.2, 7.0);
            self.plant(&near[0], [x, z], &FOLIAGE, 0.8);
        }
        for i in 0..9 {
            let z = -40.0 - 14.0 * f64::from(i);
            let side = self.any(&[-1.0, 1.0]);
            let x = road(z) + side * self.within(22.0, 28.0);
            if (x - stream(z)).abs() > 5.0 {
                self.plant(&near[0], [x, z], &FOLIAGE, 0.75);
            }
        }
    }

    /// On the slopes, denser higher up; firs above, broad crowns below.
    fn woods(&mut self, near: &[Vec<Tree>; 2], far: &[Vec<Tree>; 2]) {
        let mut planted = 0;
        while planted < 430 {
            let (x, z) = (self.within(-330.0, 330.0), self.within(-440.0, 60.0));
            let off = (x - 8.0).abs();
            let end = z < -250.0;
            let dense = ((off - 48.0) / 120.0)
                .clamp(0.0, 1.0)
                .max(if end { 0.7 } else { 0.0 });
            if self.within(0.0, 1.0) > dense {
                continue;
            }
            let place = [x, z];
            let eye = self.scene.camera.eye;
            let distance = ground(x, z).as_vec3().distance(eye);
            if distance < 30.0 {
                continue;
            }
            let of = if distance < 85.0 { near } else { far };
            let firs = self.within(0.0, 1.0) < (height(x, z) / 55.0).clamp(0.15, 0.85);
            match firs {
                true => self.plant(&of[1], place, &NEEDLES, 1.1),
                false => self.plant(&of[0], place, &FOLIAGE, 1.15),
            }
            planted += 1;
        }
    }

    fn plant(&mut self, kinds: &[Tree], [x, z]: [f64; 2], colors: &[[f32; 3]], size: f64) {
        let [wood, crown] = self.any(kinds);
        let scale = Vec3::splat((size * self.within(0.8, 1.2)) as f32);
        let turn = about_y(self.random.within(0.0, TAU));
        let foot = ground(x, z).as_vec3();
        let place = Affine3A::from_scale_rotation_translation(scale, turn, foot);
        let leaves = self.any(colors);
        self.put(wood, place, BARK);
        self.put(crown, place, leaves);
    }

    /// Grass near the camera, bales and sheep.
    fn meadow(&mut self) {
        let tufts: Vec<usize> = (0..4).map(|i| self.mesh(fields::grass(60 + i))).collect();
        let mut grown = 0;
        while grown < 190 {
            // More where it is near, all of it in view.
            let ahead = 1.5 + 14.0 * self.within(0.0, 1.0).powf(1.4);
            let aside = self.within(-0.75, 0.95) * (ahead + 0.6);
            let (x, z) = (EYE[0] + aside, EYE[1] - ahead);
            if (x - road(z)).abs() < terrain::ROAD + 0.6 {
                continue;
            }
            grown += 1;
            let turn = leaning(normal(x, z), self.random.within(0.0, TAU));
            let scale = Vec3::splat(self.random.within(0.75, 1.2));
            let foot = ground(x, z).as_vec3();
            let place = Affine3A::from_scale_rotation_translation(scale, turn, foot);
            let mesh = self.any(&tufts);
            let albedo = self.any(&[GRASS, [0.24, 0.3, 0.09], [0.3, 0.31, 0.11]]);
            self.put(mesh, place, albedo);
        }
        let bale = self.mesh(fields::bale());
        for i in 0..9 {
            let z = 14.0 - 9.0 * f64::from(i / 3) + self.within(-2.0, 2.0);
            let x = road(z) - 16.0 - 9.0 * f64::from(i % 3) + self.within(-2.0, 2.0);
            self.rest(bale, [x, z], [0.6, 0.48, 0.22]);
        }
        let [wool, dark] = fields::sheep().map(|mesh| self.mesh(mesh));
        for _ in 0..14 {
            let z = self.within(-22.0, 26.0);
            let x = road(z) + self.within(8.0, 17.0);
            let turn = about_y(self.random.within(0.0, TAU));
            let place = Affine3A::from_rotation_translation(turn, ground(x, z).as_vec3());
            self.put(wool, place, [0.72, 0.69, 0.62]);
            self.put(dark, place, [0.12, 0.11, 0.1]);
        }
    }

    /// Something on the ground, leaning with it.
    fn rest(&mut self, mesh: usize, [x, z]: [f64; 2], albedo: [f32; 3]) {
        let turn = leaning(normal(x, z), self.random.within(0.0, TAU));
        let place = Affine3A::from_rotation_translation(turn, ground(x, z).as_vec3());
        self.put(mesh, place, albedo);
    }
}
