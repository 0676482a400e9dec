//! What the examples, tests and benchmarks look at: meshes, objects, lights and one camera.
//!
//! Metres, right-handed, Y up, triangles counter-clockwise seen from outside. Nothing in here needs
//! a GPU.

use shadows::DepthConvention;
use shadows::glam::camera::rh::{proj::directx, view::look_at_mat4};
use shadows::glam::{Affine3A, DAffine3, DMat3, DVec3, Mat4, Vec3, Vec4};

pub mod city;
pub mod courtyard;
pub mod file;
pub mod floor;
pub mod ironwork;
mod kit;
pub mod leaf_mask;
mod light;
pub mod masonry;
pub mod plants;
pub mod spheres;
pub mod surface;
pub mod teapot;
pub mod valley;

pub use city::city;
pub use courtyard::courtyard;
pub use file::file;
pub use floor::floor;
pub use light::{Cone, Light, LightKind, Sky, homogeneous, moved_light};
pub use spheres::{spheres, spheres_moving};
pub use teapot::teapot;
pub use valley::valley;

/// Names of the built-in scenes, as [`load`] takes them.
pub const NAMES: [&str; 7] = [
    "spheres",
    "courtyard",
    "teapot",
    "city",
    "valley",
    "valley-leaves",
    "floor",
];

/// Indexed triangles in the mesh's own space.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// What it shows; for labels and reports.
    pub name: String,
    /// One per vertex, in metres before the object's transform.
    pub positions: Vec<[f32; 3]>,
    /// One unit vector per vertex, on the outside. Vertices on a crease are repeated.
    pub normals: Vec<[f32; 3]>,
    /// Three per triangle, counter-clockwise seen from outside; all below `positions.len()`.
    pub indices: Vec<u32>,
    /// Of what leaves are cut out of by a mask: each vertex's place in it, as [`leaf_mask::is_leaf`] takes it.
    /// Empty where nothing is cut out.
    pub mask: Vec<[f32; 2]>,
}

impl Mesh {
    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// The triangles' corners, as indices into `positions`.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]])
    }
}

/// A mesh placed in the world. Every object receives shadows.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// What it is; for labels and reports.
    pub name: String,
    /// Place of its mesh in [`Scene::meshes`].
    pub mesh: usize,
    /// World from mesh space; may mirror or flatten.
    pub transform: Affine3A,
    /// Whether it casts a shadow.
    pub casts: bool,
    /// Linear diffuse reflectance, 0 to 1.
    pub albedo: [f32; 3],
    /// Linear light that it gives off itself, to be seen, not to light others.
    pub glow: [f32; 3],
}

impl Object {
    /// The world position of a vertex in f64: the f32 position and the f32 transform taken as exact.
    pub fn world_point(&self, position: [f32; 3]) -> DVec3 {
        let p = Vec3::from(position).as_dvec3();
        widened(&self.transform).transform_point3(p)
    }
}

/// The f32 transform with every entry taken as exact.
pub fn widened(t: &Affine3A) -> DAffine3 {
    DAffine3 {
        matrix3: DMat3::from_cols(
            Vec3::from(t.matrix3.x_axis).as_dvec3(),
            Vec3::from(t.matrix3.y_axis).as_dvec3(),
            Vec3::from(t.matrix3.z_axis).as_dvec3(),
        ),
        translation: Vec3::from(t.translation).as_dvec3(),
    }
}

/// A pinhole camera, upright.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Centre of projection, world space.
    pub eye: Vec3,
    /// A point in the middle of the picture, world space; not straight above or below `eye`.
    pub target: Vec3,
    /// Vertical field of view in radians, 0 to pi, both excluded.
    pub fovy: f32,
    /// Distance of the near plane in metres, above 0.
    pub near: f32,
}

impl Camera {
    /// Clip from world space, infinite reverse Z (1 at the near plane, 0 at infinity).
    /// `aspect` is width over height.
    pub fn clip_from_world(&self, aspect: f32) -> Mat4 {
        self.clip_from_world_as(aspect, DepthConvention::InfiniteReverse)
    }

    /// The same in any convention; where there is a far plane, it is at a thousand times `near`.
    pub fn clip_from_world_as(&self, aspect: f32, depth: DepthConvention) -> Mat4 {
        let (fovy, near, far) = (self.fovy, self.near, 1e3 * self.near);
        let projection = match depth {
            DepthConvention::InfiniteReverse => {
                directx::perspective_infinite_reverse(fovy, aspect, near)
            }
            DepthConvention::FiniteReverse => directx::perspective(fovy, aspect, far, near),
            DepthConvention::Standard => directx::perspective(fovy, aspect, near, far),
        };
        projection * self.eye_from_world()
    }

    /// What the camera sees from world space: to the right, up and behind it.
    pub fn eye_from_world(&self) -> Mat4 {
        look_at_mat4(self.eye, self.target, Vec3::Y)
    }
}

/// An axis-aligned box in world space, in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub min: DVec3,
    /// Greatest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The box around no point: `min` above `max`.
    pub const EMPTY: Self = Self {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };

    /// The smallest box around these points.
    pub fn of(points: impl Iterator<Item = DVec3>) -> Self {
        points.fold(Self::EMPTY, |b, p| Self {
            min: b.min.min(p),
            max: b.max.max(p),
        })
    }

    /// Middle of the box.
    pub fn centre(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// Edge lengths.
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }
}

/// Everything a picture needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Name for reports and directories.
    pub name: String,
    /// Shared by the objects.
    pub meshes: Vec<Mesh>,
    /// What is seen.
    pub objects: Vec<Object>,
    /// At least one; the first is the one for whoever takes only one.
    pub lights: Vec<Light>,
    /// What is behind everything.
    pub sky: Sky,
    /// The view.
    pub camera: Camera,
    /// What the file it came from holds besides, and how much of it.
    pub left_out: Vec<String>,
}

impl Scene {
    /// Bounds of all objects, world space.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.objects.iter().flat_map(|o| self.world_points(o)))
    }

    /// Bounds of the objects that cast, world space; [`Bounds::EMPTY`] if none does.
    pub fn caster_bounds(&self) -> Bounds {
        let casters = self.objects.iter().filter(|o| o.casts);
        Bounds::of(casters.flat_map(|o| self.world_points(o)))
    }

    /// World positions of an object's vertices in f64.
    pub fn world_points<'a>(&'a self, object: &'a Object) -> impl Iterator<Item = DVec3> + 'a {
        let positions = &self.meshes[object.mesh].positions;
        positions.iter().map(|p| object.world_point(*p))
    }

    /// Triangles drawn, counting a mesh once per object.
    pub fn triangle_count(&self) -> usize {
        self.count(|_| true)
    }

    /// Triangles that cast, counting a mesh once per object.
    pub fn caster_triangle_count(&self) -> usize {
        self.count(|o| o.casts)
    }

    /// Whether a caster has a mask, so that the host alone can draw it.
    pub fn casts_through_masks(&self) -> bool {
        let mut casters = self.objects.iter().filter(|o| o.casts);
        casters.any(|o| !self.meshes[o.mesh].mask.is_empty())
    }

    fn count(&self, wanted: impl Fn(&Object) -> bool) -> usize {
        let objects = self.objects.iter().filter(|o| wanted(o));
        objects.map(|o| self.meshes[o.mesh].triangle_count()).sum()
    }

    /// Replaces what is given, as the command line asks. The camera is eye, target and, where
    /// given, the vertical field of view in radians.
    pub fn override_with(
        &mut self,
        light: Option<Vec4>,
        range: Option<f32>,
        camera: Option<(Vec3, Vec3, Option<f32>)>,
    ) {
        let first = self.light_mut();
        first.place = light.unwrap_or(first.place);
        first.range = range.unwrap_or(first.range);
        if let Some((eye, target, fovy)) = camera {
            self.camera.eye = eye;
            self.camera.target = target;
            self.camera.fovy = fovy.unwrap_or(self.camera.fovy);
        }
    }

    /// The first of its lights.
    pub fn light(&self) -> &Light {
        &self.lights[0]
    }

    /// The same, to change it.
    pub fn light_mut(&mut self) -> &mut Light {
        &mut self.lights[0]
    }

    /// Makes the first light one of another kind: a spot shines from its place at the camera's target, as
    /// wide as a face of a cube map (45 degrees to each side); a directional light shines from
    /// there, too.
    ///
    /// # Errors
    /// If a directional light is to have a place, or the light is at the camera's target.
    pub fn shine_as(&mut self, kind: LightKind) -> anyhow::Result<()> {
        if kind == self.light().kind() {
            return Ok(());
        }
        anyhow::ensure!(
            self.light().place.w != 0.0,
            "a directional light has no place to shine from; give one with --light X,Y,Z"
        );
        let toward_light = self.light().place.truncate() - self.camera.target;
        anyhow::ensure!(
            kind == LightKind::Point || toward_light != Vec3::ZERO,
            "the light is at the camera's target, so it has no direction; move one of them"
        );
        let light = self.light_mut();
        light.cone = (kind == LightKind::Spot).then_some(Cone {
            direction: -toward_light,
            half_angle: std::f32::consts::FRAC_PI_4,
        });
        if kind == LightKind::Directional {
            light.place = toward_light.extend(0.0);
        }
        Ok(())
    }

    /// Nothing to see, under a light from above.
    pub fn empty(name: &str) -> Self {
        Self {
            name: name.into(),
            meshes: Vec::new(),
            objects: Vec::new(),
            lights: vec![Light::new(Vec4::Y, 100.0)],
            sky: Sky::default(),
            camera: Camera {
                eye: Vec3::new(0.0, 5.0, 10.0),
                target: Vec3::ZERO,
                fovy: std::f32::consts::FRAC_PI_4,
                near: 0.1,
            },
            left_out: Vec::new(),
        }
    }

    /// Adds a mesh and says where it is.
    pub fn add_mesh(&mut self, mesh: Mesh) -> usize {
        self.meshes.push(mesh);
        self.meshes.len() - 1
    }
}

/// When it is, in scenes that have days and nights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Time {
    /// Under a sun.
    Day,
    /// Under lamps.
    Night,
}

/// The times of a built-in scene, the usual first; none for a scene whose light is always the same.
pub fn times(name: &str) -> &'static [Time] {
    match name {
        "city" => &[Time::Day, Time::Night],
        "valley" | "valley-leaves" => &[Time::Day],
        _ => &[],
    }
}

/// A built-in scene by name (one of [`NAMES`]), or a model file.
///
/// `ground` puts a model file on a ground square; built-in scenes bring their own. `time` is one of
/// [`times`], or `None` for the usual one.
///
/// # Errors
/// One line that names the file and what is wrong with it, or the scene that has no such time.
pub fn load(spec: &str, ground: bool, time: Option<Time>) -> anyhow::Result<Scene> {
    let times = times(spec);
    match time {
        Some(_) if times.is_empty() => anyhow::bail!("it has no day and no night"),
        Some(Time::Night) if !times.contains(&Time::Night) => anyhow::bail!("it has no night"),
        _ => {}
    }
    match spec {
        "spheres" => Ok(spheres()),
        "city" => Ok(city(time.unwrap_or(times[0]))),
        "valley" => Ok(valley()),
        "valley-leaves" => Ok(valley::valley_with(plants::Leaves::Masked)),
        "courtyard" => Ok(courtyard()),
        "teapot" => Ok(teapot()),
        "floor" => Ok(floor()),
        path => file(std::path::Path::new(path), ground),
    }
}

/// A horizontal square of the given half side around a point, facing up.
pub fn square(name: &str, centre: Vec3, half: f32) -> Mesh {
    let corner = |x: f32, z: f32| (centre + Vec3::new(x * half, 0.0, z * half)).to_array();
    Mesh {
        name: name.into(),
        positions: vec![
            corner(-1.0, -1.0),
            corner(-1.0, 1.0),
            corner(1.0, 1.0),
            corner(1.0, -1.0),
        ],
        normals: vec![[0.0, 1.0, 0.0]; 4],
        indices: vec![0, 1, 2, 0, 2, 3],
        mask: Vec::new(),
    }
}
