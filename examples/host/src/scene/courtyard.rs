//! A courtyard as a game level would have it: arcades, stairs, railings, a fence and hanging chains
//! around one point light. Generated, so nothing needs to be downloaded; metres.

use std::f32::consts::FRAC_PI_2;

use shadows::glam::{Affine3A, DVec3, Quat, Vec3, Vec4, dvec3, vec3};

use super::ironwork::{PANEL, balustrade, fence_panel, hanging_chain, link, stair_railing};
use super::masonry::{
    ARCADE_HEIGHT, BAY, COLUMN_HEIGHT, GOING, RISE, STEPS, arcade, archivolt, block, column,
    dentils, stairs, urn,
};
use super::{Camera, Light, Mesh, Object, Scene, Sky};

const STONE: [f32; 3] = [0.72, 0.66, 0.55];
const PALE: [f32; 3] = [0.78, 0.74, 0.66];
const WALL: [f32; 3] = [0.66, 0.57, 0.47];
const PAVING: [f32; 3] = [0.52, 0.5, 0.47];
const IRON: [f32; 3] = [0.2, 0.22, 0.25];
const BRASS: [f32; 3] = [0.6, 0.46, 0.24];
const CLAY: [f32; 3] = [0.66, 0.34, 0.22];

/// Where the back arcade and the side arcade meet.
const CORNER: Vec3 = Vec3::new(-9.0, 0.0, -6.0);
/// Foot of the stairs, in the middle of the first step.
const STAIRS: Vec3 = Vec3::new(4.2, 0.0, -1.7);
const STAIRS_WIDTH: f32 = 3.2;

/// The courtyard: about 220,000 triangles that cast, of closed meshes shared by transformed
/// objects. The ground is a closed slab that does not cast: nothing lies below it.
pub fn courtyard() -> Scene {
    let mut yard = Yard::new();
    yard.ground_and_walls();
    yard.arcades();
    yard.stairs_and_terrace();
    yard.fence();
    yard.chains();
    yard.urns();
    yard.0
}

/// The scene while it is built.
struct Yard(Scene);

impl Yard {
    fn new() -> Self {
        Self(Scene {
            name: "courtyard".into(),
            meshes: Vec::new(),
            objects: Vec::new(),
            lights: vec![Light::new(Vec4::new(0.43, 4.07, 0.86, 1.0), 40.0)],
            sky: Sky::default(),
            camera: Camera {
                eye: vec3(-4.6, 5.9, 13.7),
                target: vec3(0.75, 0.95, -1.2),
                fovy: 45_f32.to_radians(),
                near: 0.1,
            },
            left_out: Vec::new(),
        })
    }

    fn mesh(&mut self, mesh: Mesh) -> usize {
        self.0.add_mesh(mesh)
    }

    /// Places a mesh that casts, named after it.
    fn put(&mut self, mesh: usize, transform: Affine3A, albedo: [f32; 3]) {
        self.0.objects.push(Object {
            name: format!("{} {}", self.0.meshes[mesh].name, self.0.objects.len()),
            mesh,
            transform,
            casts: true,
            albedo,
            glow: [0.0; 3],
        });
    }

    /// Places a block between two corners.
    fn put_block(&mut self, block: usize, min: Vec3, max: Vec3, albedo: [f32; 3]) {
        let half = 0.5 * (max - min);
        let foot = vec3(min.x + half.x, min.y, min.z + half.z);
        let scale = vec3(half.x, 2.0 * half.y, half.z);
        let place = Affine3A::from_scale_rotation_translation(scale, Quat::IDENTITY, foot);
        self.put(block, place, albedo);
    }

    fn ground_and_walls(&mut self) {
        let block = self.mesh(block());
        self.put_block(
            block,
            vec3(-30.0, -0.4, -25.0),
            vec3(32.0, 0.0, 28.0),
            PAVING,
        );
        if let Some(ground) = self.0.objects.last_mut() {
            ground.name = "ground".into();
            ground.casts = false;
        }
        let top = 6.2;
        self.put_block(block, vec3(-13.0, -0.2, -9.6), vec3(14.6, top, -9.0), WALL);
        self.put_block(block, vec3(-13.0, -0.2, -8.9), vec3(-12.4, top, 4.6), WALL);
        self.put_block(block, vec3(14.0, -0.2, -8.9), vec3(14.6, top, 5.2), WALL);
        // The terrace at the head of the stairs.
        let height = STEPS as f32 * RISE as f32;
        let edge = STAIRS.x + STEPS as f32 * GOING as f32;
        self.put_block(
            block,
            vec3(edge, -0.2, -5.2),
            vec3(13.9, height, 3.4),
            STONE,
        );
        self.put_block(block, vec3(-9.8, -0.2, -8.9), vec3(9.8, 0.16, -5.3), PALE);
        self.put_block(block, vec3(-12.3, -0.2, -5.2), vec3(-8.3, 0.16, 4.6), PALE);
        // Cornices of the two arcades.
        let y = COLUMN_HEIGHT as f32 + ARCADE_HEIGHT as f32 + 0.16;
        self.put_block(
            block,
            vec3(-9.5, y, -6.48),
            vec3(9.5, y + 0.18, -5.52),
            PALE,
        );
        self.put_block(
            block,
            vec3(-9.48, y, -5.6),
            vec3(-8.52, y + 0.17, 3.5),
            PALE,
        );
    }

    fn arcades(&mut self) {
        let column = self.mesh(column());
        let back = self.mesh(arcade(6));
        let side = self.mesh(arcade(3));
        let archivolt = self.mesh(archivolt());
        let dentils = self.mesh(dentils());
        let bay = BAY as f32;
        let plinth = vec3(0.0, 0.16, 0.0);
        let along_back = Affine3A::from_translation(CORNER + plinth);
        let along_side = along_back * Affine3A::from_rotation_y(-FRAC_PI_2);
        for i in 0..7 {
            self.put(column, along_back * along(bay * i as f32), STONE);
        }
        for i in 1..4 {
            self.put(column, along_side * along(bay * i as f32), STONE);
        }
        let up = Affine3A::from_translation(vec3(0.0, COLUMN_HEIGHT as f32, 0.0));
        for (line, mesh, bays) in [(along_back, back, 6), (along_side, side, 3)] {
            self.put(mesh, line * up * along(0.5 * bay * bays as f32), PALE);
            for i in 0..bays {
                let middle = line * up * along(bay * (i as f32 + 0.5));
                // Only the faces towards the court are decorated. The moulding is let into the wall by
                // a little more than half, as masonry is: an edge of it that lay in the wall's own
                // face would end its shadow there, and rounding decide on which side.
                let front = if mesh == back { 0.29 } else { -0.29 };
                let moulding = middle * Affine3A::from_translation(vec3(0.0, 0.0, front));
                self.put(archivolt, moulding, STONE);
                let under = vec3(0.0, ARCADE_HEIGHT as f32, 0.0);
                self.put(dentils, middle * Affine3A::from_translation(under), STONE);
            }
        }
    }

    fn stairs_and_terrace(&mut self) {
        let stairs = self.mesh(stairs(f64::from(STAIRS_WIDTH)));
        let railing = self.mesh(stair_railing());
        let balustrade = self.mesh(balustrade());
        self.put(stairs, Affine3A::from_translation(STAIRS), STONE);
        let side = vec3(0.0, 0.0, 0.5 * STAIRS_WIDTH - 0.09);
        let mirror = Affine3A::from_scale(vec3(1.0, 1.0, -1.0));
        let near = Affine3A::from_translation(STAIRS + side);
        let far = Affine3A::from_translation(STAIRS - side) * mirror;
        self.put(railing, near, IRON);
        self.put(railing, far, IRON);
        let edge = STAIRS
            + vec3(
                STEPS as f32 * GOING as f32 + 0.12,
                STEPS as f32 * RISE as f32,
                0.0,
            );
        let turned = Affine3A::from_rotation_y(-FRAC_PI_2);
        for i in 0..3 {
            let start = edge + vec3(0.0, 0.0, 0.5 * STAIRS_WIDTH + i as f32 * 1.06 + 0.06);
            self.put(balustrade, Affine3A::from_translation(start) * turned, IRON);
        }
    }

    fn fence(&mut self) {
        let panel = self.mesh(fence_panel());
        let width = PANEL as f32;
        let start = vec3(-8.7, 0.0, 4.4);
        for i in 0..4 {
            // The third panel, a gate, stands open.
            let turn = if i == 2 { -0.9 } else { 0.0 };
            let place = Affine3A::from_rotation_translation(
                Quat::from_rotation_y(turn),
                start + vec3(i as f32 * width, 0.0, 0.0),
            );
            self.put(panel, place, IRON);
        }
    }

    fn chains(&mut self) {
        let link = self.mesh(link());
        let bollard = self.mesh(column());
        let feet = [
            vec3(0.35, 0.0, 5.35),
            vec3(2.75, 0.0, 5.0),
            vec3(5.05, 0.0, 4.05),
            vec3(6.9, 0.0, 2.35),
        ];
        let scale = vec3(0.42, 0.36, 0.42);
        for foot in feet {
            let foot = foot - vec3(0.0, 0.02, 0.0);
            let place = Affine3A::from_scale_rotation_translation(scale, Quat::IDENTITY, foot);
            self.put(bollard, place, PALE);
        }
        let height = 0.86;
        for pair in feet.windows(2) {
            let ends = [pair[0], pair[1]].map(|p| (p + vec3(0.0, height, 0.0)).as_dvec3());
            let way = (ends[1] - ends[0]).normalize() * 0.16;
            self.hang(link, ends[0] + way, ends[1] - way, 0.42);
        }
        // One from the crown of the middle arch, to a hanging urn.
        let crown = dvec3(-1.5, 4.5, -6.0);
        self.hang(link, crown, crown - dvec3(0.0, 1.55, 0.0), 0.0);
    }

    fn hang(&mut self, link: usize, from: DVec3, to: DVec3, sag: f64) {
        for place in hanging_chain(from, to, sag) {
            let place = Affine3A::from_mat3_translation(
                place.matrix3.as_mat3(),
                place.translation.as_vec3(),
            );
            self.put(link, place, BRASS);
        }
    }

    fn urns(&mut self) {
        let urn = self.mesh(urn());
        let terrace = STEPS as f32 * RISE as f32;
        let upright = [
            (vec3(-6.9, 0.0, -3.6), vec3(1.0, 1.0, 1.0), 0.4),
            (vec3(-5.9, 0.0, -2.7), vec3(0.7, 0.62, 0.7), 1.9),
            (vec3(3.3, 0.0, -4.3), vec3(0.95, 1.15, 0.95), 2.6),
            (vec3(9.9, terrace, 1.9), vec3(0.8, 0.9, 0.8), 0.9),
            (vec3(-1.5, 2.35, -6.0), vec3(0.6, 0.46, 0.6), 0.3),
        ];
        for (foot, scale, turn) in upright {
            let turn = Quat::from_rotation_y(turn);
            let place = Affine3A::from_scale_rotation_translation(scale, turn, foot);
            self.put(urn, place, CLAY);
        }
        // One lies on its side, on belly and lip: 15.5 degrees from level.
        let tilt = Quat::from_rotation_y(0.65)
            * Quat::from_rotation_z(FRAC_PI_2 + 0.27)
            * Quat::from_rotation_y(FRAC_PI_2);
        let points = self.0.meshes[urn].positions.iter();
        let heights = points.map(|p| (tilt * Vec3::from(*p)).y);
        let lowest = heights.fold(f32::INFINITY, f32::min);
        let place = vec3(-2.6, -lowest, 0.9);
        let fallen = Affine3A::from_rotation_translation(tilt, place);
        self.put(urn, fallen, CLAY);
    }
}

fn along(x: f32) -> Affine3A {
    Affine3A::from_translation(vec3(x, 0.0, 0.0))
}
