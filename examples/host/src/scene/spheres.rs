//! The 64-sphere scene: closed casters of one mesh around a light, on a square that only receives.

use std::f64::consts::{PI, TAU};

use shadows::glam::{Affine3A, DVec3, Vec3, Vec4};

use super::{Camera, Light, Mesh, Object, Scene, Sky, square};

const COUNT: u32 = 64;
const RADIUS: f64 = 0.4;
const RINGS: u32 = 24;
const SECTORS: u32 = 32;
/// The golden angle in radians: neighbours in the spiral never line up with the light (Vogel 1979).
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// 64 spheres of 1,536 triangles on a spiral, at four heights, around a point light.
pub fn spheres() -> Scene {
    spheres_moving(0.0)
}

/// [`spheres`] with each sphere displaced by up to 0.25 m along x and 0.4 m upwards, at its own
/// pace. `time` is in seconds; time 0 is [`spheres`] itself.
pub fn spheres_moving(time: f64) -> Scene {
    let mut scene = empty();
    let ground = scene.add_mesh(square("ground", Vec3::ZERO, 15.0));
    let sphere = scene.add_mesh(sphere());
    scene.objects.push(Object {
        name: "ground".into(),
        mesh: ground,
        transform: Affine3A::IDENTITY,
        casts: false,
        albedo: [0.55, 0.54, 0.52],
        glow: [0.0; 3],
    });
    scene.objects.extend((0..COUNT).map(|i| Object {
        name: format!("sphere {i}"),
        mesh: sphere,
        transform: Affine3A::from_translation((centre(i) + displacement(i, time)).as_vec3()),
        casts: true,
        albedo: [0.75, 0.45 + 0.1 * (i % 4) as f32, 0.35],
        glow: [0.0; 3],
    }));
    scene
}

fn empty() -> Scene {
    Scene {
        name: "spheres".into(),
        meshes: Vec::new(),
        objects: Vec::new(),
        lights: vec![Light::new(Vec4::new(0.0, 4.0, 0.0, 1.0), 30.0)],
        sky: Sky::default(),
        camera: Camera {
            eye: Vec3::new(0.0, 9.0, 16.0),
            target: Vec3::new(0.0, 0.5, 0.0),
            fovy: std::f32::consts::FRAC_PI_4,
            near: 0.1,
        },
        left_out: Vec::new(),
    }
}

fn centre(i: u32) -> DVec3 {
    let r = 2.0 + 7.0 * ((f64::from(i) + 0.5) / f64::from(COUNT)).sqrt();
    let theta = GOLDEN_ANGLE * f64::from(i);
    let height = 0.5 + 0.75 * f64::from(i % 4);
    DVec3::new(r * theta.cos(), height, r * theta.sin())
}

fn displacement(i: u32, time: f64) -> DVec3 {
    let phase = (1.0 + 0.1 * f64::from(i % 8)) * time;
    // Never downwards: the lowest spheres are a tenth of a metre above the ground.
    DVec3::new(0.25 * phase.sin(), 0.2 * (1.0 - phase.cos()), 0.0)
}

/// Top pole, rings from the top down, bottom pole; counter-clockwise outside.
fn sphere() -> Mesh {
    let normals = sphere_directions();
    let row = |j: u32, k: u32| 1 + (j - 1) * SECTORS + k % SECTORS;
    let (top, bottom) = (0, 1 + RINGS * SECTORS);
    let mut indices = Vec::new();
    for k in 0..SECTORS {
        indices.extend([top, row(1, k + 1), row(1, k)]);
        for j in 1..RINGS {
            let [a, b] = [row(j, k), row(j, k + 1)];
            let [c, d] = [row(j + 1, k), row(j + 1, k + 1)];
            indices.extend([a, b, c, b, d, c]);
        }
        indices.extend([bottom, row(RINGS, k), row(RINGS, k + 1)]);
    }
    Mesh {
        name: "sphere".into(),
        positions: normals
            .iter()
            .map(|n| (*n * RADIUS).as_vec3().to_array())
            .collect(),
        normals: normals.iter().map(|n| n.as_vec3().to_array()).collect(),
        indices,
        mask: Vec::new(),
    }
}

fn sphere_directions() -> Vec<DVec3> {
    let mut out = vec![DVec3::Y];
    for j in 1..=RINGS {
        let phi = PI * f64::from(j) / f64::from(RINGS + 1);
        for k in 0..SECTORS {
            let t = TAU * f64::from(k) / f64::from(SECTORS);
            out.push(DVec3::new(
                phi.sin() * t.cos(),
                phi.cos(),
                phi.sin() * t.sin(),
            ));
        }
    }
    out.push(DVec3::NEG_Y);
    out
}
