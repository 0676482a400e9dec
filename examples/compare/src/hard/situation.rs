//! Scenes for the hard cases: shapes over a large ground, one light, one camera.

use shadows::glam::{Affine3A, DVec3, Vec3, Vec4};

use host::random::Random;
use host::renderer::Look;
use host::scene::{Camera, Cone, Light, Mesh, Object, Scene};
use host::shapes::{self, Shape};

/// One thing to try.
#[derive(Clone)]
pub struct Situation {
    /// What distinguishes it from the case's others.
    pub what: String,
    pub scene: Scene,
    pub look: Look,
    /// Everything is this far away, placed in f64; the host draws it relative to the camera.
    pub offset: DVec3,
    /// How far f32 positions let the edges of shadows be from where they are, in the world: so much
    /// farther from an edge is a map's interior.
    pub leak: f32,
    /// Whether it is made for 8-bit counts to wrap.
    pub wraps: bool,
    /// Whether no shadow falls on what is seen: then a map's resolution is no excuse either.
    pub no_shadow_in_view: bool,
}

/// A point light above, to the left and in front, never twice in the same place.
pub fn lamp(random: &mut Random) -> Vec4 {
    (Vec3::new(-2.0, 6.0, 2.5) + random.point(0.7)).extend(1.0)
}

/// The direction to a light infinitely far away.
pub fn sun(random: &mut Random) -> Vec4 {
    (Vec3::new(-0.4, 1.0, 0.3) + random.point(0.1))
        .normalize()
        .extend(0.0)
}

/// A lamp and a sun by turns.
pub fn either(random: &mut Random, turn: u32) -> Vec4 {
    match turn % 2 {
        0 => lamp(random),
        _ => sun(random),
    }
}

pub fn at(x: f32, y: f32, z: f32) -> Affine3A {
    Affine3A::from_translation(Vec3::new(x, y, z))
}

/// With those under a lamp once more, each under a spot at the lamp's place.
pub fn with_spots(mut situations: Vec<Situation>, target: Vec3, degrees: f32) -> Vec<Situation> {
    let lamps = situations
        .iter()
        .filter(|situation| situation.scene.light().place.w != 0.0);
    let spots: Vec<Situation> = lamps
        .map(|lamp| lamp.clone().spot(target, degrees))
        .collect();
    situations.extend(spots);
    situations
}

impl Situation {
    /// A large ground under a light, seen from the front and above, a little differently each time.
    pub fn new(what: impl Into<String>, light: Vec4, random: &mut Random) -> Self {
        let scene = Scene {
            lights: vec![Light::new(light, 100.0)],
            camera: Camera {
                eye: Vec3::new(1.0, 5.0, 9.0) + random.point(0.8),
                target: Vec3::new(0.0, 0.5, 0.0),
                fovy: 0.9,
                near: 0.1,
            },
            ..Scene::empty("hard case")
        };
        let ground = Affine3A::IDENTITY;
        Self::of(what, scene).receiver(&shapes::square(30.0), ground)
    }

    /// A scene as it is.
    pub fn of(what: impl Into<String>, scene: Scene) -> Self {
        Self {
            what: what.into(),
            scene,
            look: Look::default(),
            offset: DVec3::ZERO,
            leak: 0.0,
            wraps: false,
            no_shadow_in_view: false,
        }
    }

    /// With a shape that casts and receives.
    pub fn caster(mut self, shape: &Shape, transform: Affine3A) -> Self {
        self.add(shape, transform, true);
        self
    }

    /// With a shape that only receives.
    pub fn receiver(mut self, shape: &Shape, transform: Affine3A) -> Self {
        self.add(shape, transform, false);
        self
    }

    /// Without anything so far.
    pub fn bare(mut self) -> Self {
        self.scene.objects.clear();
        self.scene.meshes.clear();
        self
    }

    pub fn camera(mut self, eye: Vec3, target: Vec3) -> Self {
        self.scene.camera.eye = eye;
        self.scene.camera.target = target;
        self
    }

    /// Under a spot at the lamp's place, that shines at a point, so many degrees to each side.
    pub fn spot(mut self, target: Vec3, degrees: f32) -> Self {
        self.what = format!("{}, spot of {degrees} degrees", self.what);
        self.scene.light_mut().cone = Some(Cone {
            direction: target - self.scene.light().place.truncate(),
            half_angle: degrees.to_radians(),
        });
        self
    }

    fn add(&mut self, shape: &Shape, transform: Affine3A, casts: bool) {
        let mesh = smooth(shape);
        let known = self.scene.meshes.iter().position(|other| *other == mesh);
        let mesh = known.unwrap_or_else(|| {
            self.scene.meshes.push(mesh);
            self.scene.meshes.len() - 1
        });
        self.scene.objects.push(Object {
            name: format!("{}", self.scene.objects.len()),
            mesh,
            transform,
            casts,
            albedo: if casts { [0.8, 0.5, 0.3] } else { [0.6; 3] },
            glow: [0.0; 3],
        });
    }

    /// Everything moved, as a host has it that knows f32 only: vertices in world space, rounded, and
    /// light and camera by as much. What is there is then exactly what casts and what is seen.
    pub fn moved(mut self, offset: DVec3) -> Self {
        let round = |point: DVec3| (point + offset).as_vec3();
        let scene = &mut self.scene;
        let mut meshes = Vec::new();
        for object in &mut scene.objects {
            let mut mesh = scene.meshes[object.mesh].clone();
            for position in &mut mesh.positions {
                *position = round(object.world_point(*position)).to_array();
            }
            for normal in &mut mesh.normals {
                let turned = object.transform.transform_vector3((*normal).into());
                *normal = turned.normalize_or(Vec3::Y).to_array();
            }
            object.mesh = meshes.len();
            object.transform = Affine3A::IDENTITY;
            meshes.push(mesh);
        }
        scene.meshes = meshes;
        if scene.light().place.w != 0.0 {
            scene.light_mut().place = round(scene.light().place.truncate().as_dvec3()).extend(1.0);
        }
        scene.camera.eye = round(scene.camera.eye.as_dvec3());
        scene.camera.target = round(scene.camera.target.as_dvec3());
        self
    }

    /// All lengths times a factor.
    pub fn scaled(mut self, factor: f32) -> Self {
        for position in self
            .scene
            .meshes
            .iter_mut()
            .flat_map(|mesh| &mut mesh.positions)
        {
            *position = position.map(|x| x * factor);
        }
        for object in &mut self.scene.objects {
            object.transform.translation *= factor;
        }
        if self.scene.light().place.w != 0.0 {
            self.scene.light_mut().place =
                (self.scene.light().place.truncate() * factor).extend(1.0);
        }
        let camera = &mut self.scene.camera;
        camera.eye *= factor;
        camera.target *= factor;
        camera.near *= factor;
        self.scene.light_mut().range *= factor;
        self.scene.light_mut().near = self.scene.light().near.map(|near| near * factor);
        self
    }
}

/// With normals that are the mean of the triangles' around, weighted by area; they only shade.
fn smooth(shape: &Shape) -> Mesh {
    let mut normals = vec![Vec3::ZERO; shape.positions.len()];
    for t in shape.indices.as_chunks::<3>().0 {
        let [a, b, c] = t.map(|i| Vec3::from(shape.positions[i as usize]));
        for i in t {
            normals[*i as usize] += (b - a).cross(c - a);
        }
    }
    Mesh {
        name: "shape".into(),
        positions: shape.positions.clone(),
        normals: normals
            .into_iter()
            .map(|normal| normal.normalize_or(Vec3::Y).to_array())
            .collect(),
        indices: shape.indices.clone(),
        mask: Vec::new(),
    }
}
