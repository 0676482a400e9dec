//! Convex things above a flat floor, far enough apart that none shadows another: where a shadow on one
//! plane is the whole truth.

use std::f64::consts::TAU;

use shadows::glam::{Affine3A, DVec2, DVec3, Quat, Vec3, Vec4, dvec2, dvec3, vec3};

use super::surface::Surface;
use super::{Camera, Light, Object, Scene, square};

/// Half a side of the floor, in metres. Nothing casts beyond its edge.
pub const HALF: f32 = 8.0;

/// A ball, a crate, a tilted tile, a lying cylinder, a cone and a pole of 4 cm under one lamp. The floor casts
/// nothing.
pub fn floor() -> Scene {
    let mut scene = Scene {
        lights: vec![Light::new(Vec4::new(0.6, 6.0, 0.9, 1.0), 30.0)],
        camera: Camera {
            eye: vec3(0.0, 7.5, 11.0),
            target: vec3(0.0, 0.2, 0.6),
            fovy: std::f32::consts::FRAC_PI_4,
            near: 0.1,
        },
        ..Scene::empty("floor")
    };
    let ground = scene.add_mesh(square("floor", Vec3::ZERO, HALF));
    scene.objects.push(Object {
        name: "floor".into(),
        mesh: ground,
        transform: Affine3A::IDENTITY,
        casts: false,
        albedo: [0.58, 0.56, 0.52],
        glow: [0.0; 3],
    });
    for (name, surface, transform, albedo) in casters() {
        let mesh = scene.add_mesh(surface.finish(name, CREASE));
        scene.objects.push(Object {
            name: name.into(),
            mesh,
            transform,
            casts: true,
            albedo,
            glow: [0.0; 3],
        });
    }
    scene
}

/// Degrees between faces above which an edge is sharp.
const CREASE: f64 = 30.0;

type Placed = (&'static str, Surface, Affine3A, [f32; 3]);

fn casters() -> [Placed; 6] {
    let at = |x, y, z| Affine3A::from_translation(vec3(x, y, z));
    let turned = |by: Quat, to| Affine3A::from_rotation_translation(by, to);
    let crate_ = Surface::cuboid(dvec3(-0.45, 0.0, -0.35), dvec3(0.45, 0.8, 0.35));
    let tile = Surface::cuboid(dvec3(-0.6, -0.03, -0.45), dvec3(0.6, 0.03, 0.45));
    let cylinder = Surface::turned(&profile(&[(0.35, -0.7), (0.35, 0.7)]), 40, |p, _| p.x);
    let cone = Surface::turned(&profile(&[(0.5, 0.0), (0.01, 1.2)]), 40, |p, _| p.x);
    let pole = Surface::cuboid(dvec3(-0.02, 0.0, -0.02), dvec3(0.02, 1.6, 0.02));
    [
        ("ball", ball(), at(-2.6, 1.1, -0.6), [0.75, 0.42, 0.33]),
        (
            "crate",
            crate_,
            turned(Quat::from_rotation_y(0.5), vec3(2.4, 0.0, -1.4)),
            [0.55, 0.43, 0.28],
        ),
        (
            "tile",
            tile,
            turned(
                Quat::from_rotation_z(0.45) * Quat::from_rotation_x(0.2),
                vec3(0.2, 1.3, -2.6),
            ),
            [0.40, 0.52, 0.62],
        ),
        (
            "cylinder",
            cylinder,
            turned(
                Quat::from_rotation_y(0.8) * Quat::from_rotation_z(0.25 * TAU as f32),
                vec3(2.9, 0.35, 2.2),
            ),
            [0.48, 0.60, 0.42],
        ),
        ("cone", cone, at(-2.3, 0.0, 2.6), [0.70, 0.62, 0.36]),
        ("pole", pole, at(0.4, 0.0, 3.2), [0.5, 0.5, 0.52]),
    ]
}

/// A profile closed on the axis at both ends.
fn profile(rows: &[(f64, f64)]) -> Vec<DVec2> {
    let (first, last) = (rows[0].1, rows[rows.len() - 1].1);
    let mut all = vec![dvec2(0.0, first)];
    all.extend(rows.iter().map(|&(radius, height)| dvec2(radius, height)));
    all.push(dvec2(0.0, last));
    all
}

fn ball() -> Surface {
    Surface::lump(4, |_: DVec3| 0.55)
}
