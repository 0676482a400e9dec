//! Models from files (Wavefront OBJ, glTF 2.0), with a ground, light and camera that fit their size.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use shadows::glam::{Affine3A, DVec3, Vec3, dvec3};

use super::surface::Surface;
use super::{Bounds, Camera, Light, Mesh, Object, Scene, Sky, square};

mod glb;
mod obj;

const CLAY: [f32; 3] = [0.7, 0.62, 0.52];
const GREY: [f32; 3] = [0.55, 0.54, 0.52];

/// Loads an `.obj`, `.gltf` or `.glb` file; every object in it casts.
///
/// Light, range and camera follow from the model's bounds, so a model gives the same picture in any
/// unit. With `ground`, a square that only receives lies under its lowest point, eight times as
/// wide as the model. Materials are ignored; what else is not loaded is told in [`Scene::left_out`].
///
/// # Errors
/// One line with the path: the file is missing or of another kind, is not what its ending says, has
/// no triangles, has a coordinate that is not finite or an index out of range, or has no extent.
pub fn file(path: &Path, ground: bool) -> Result<Scene> {
    load(path, ground).with_context(|| format!("cannot load the model {}", path.display()))
}

fn load(path: &Path, ground: bool) -> Result<Scene> {
    let ending = path.extension().and_then(|e| e.to_str());
    let ending = ending.map(str::to_ascii_lowercase);
    let read = || std::fs::read(path).context("cannot read the file");
    let model = match ending.as_deref() {
        Some("obj") => obj::parse(read()?)?,
        Some("gltf" | "glb") => glb::parse(&read()?, path.parent())?,
        _ => bail!("its name must end in .obj, .gltf or .glb"),
    };
    if model.meshes.iter().all(|m| m.indices.is_empty()) {
        match model.told().as_slice() {
            [] => bail!("it has no triangles"),
            others => bail!("it has no triangles, only {}", others.join(", ")),
        }
    }
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut scene = around(&name, model)?;
    if ground {
        add_ground(&mut scene);
    }
    Ok(scene)
}

/// What a file holds.
#[derive(Default)]
struct Model {
    meshes: Vec<Mesh>,
    objects: Vec<Object>,
    /// What is in the file and does not become part of the scene, with how often.
    left_out: BTreeMap<String, usize>,
}

impl Model {
    fn leave_out(&mut self, what: &str) {
        *self.left_out.entry(what.into()).or_default() += 1;
    }

    /// How [`Scene::left_out`] says it.
    fn told(&self) -> Vec<String> {
        let left_out = self.left_out.iter();
        left_out
            .map(|(what, count)| format!("{what} ({count})"))
            .collect()
    }

    fn put(&mut self, mesh: usize, transform: Affine3A) {
        self.objects.push(Object {
            name: format!("{} {}", self.meshes[mesh].name, self.objects.len()),
            mesh,
            transform,
            casts: true,
            albedo: CLAY,
            glow: [0.0; 3],
        });
    }
}

/// A mesh of a file, checked; it gets normals when it has none that can be used: with `crease` as
/// [`Surface::finish`] takes it, in degrees.
fn checked(
    name: &str,
    positions: Vec<[f32; 3]>,
    normals: Option<Vec<[f32; 3]>>,
    indices: Vec<u32>,
    crease: f64,
) -> Result<Mesh> {
    if let Some(i) = positions
        .iter()
        .position(|p| p.iter().any(|x| !x.is_finite()))
    {
        bail!("vertex {i} has a coordinate that is not finite");
    }
    let count = positions.len();
    if let Some(i) = indices.iter().find(|i| **i as usize >= count) {
        bail!("index {i} is out of range, there are {count} vertices");
    }
    ensure!(
        indices.len().is_multiple_of(3),
        "{} indices do not make whole triangles",
        indices.len()
    );
    let unit = normals.and_then(|n| normalized(&n, count));
    Ok(match unit {
        Some(normals) => Mesh {
            name: name.into(),
            positions,
            normals,
            indices,
            mask: Vec::new(),
        },
        None => welded(&positions, &indices).finish(name, crease),
    })
}

/// Unit normals, or nothing unless there is a usable one for each vertex.
fn normalized(normals: &[[f32; 3]], count: usize) -> Option<Vec<[f32; 3]>> {
    let unit = |n: &[f32; 3]| {
        let n = Vec3::from(*n).as_dvec3().try_normalize()?;
        Some(n.as_vec3().to_array())
    };
    let normals: Option<Vec<_>> = normals.iter().map(unit).collect();
    normals.filter(|n| n.len() == count)
}

/// The triangles with vertices at the same place made one: files repeat them along texture seams.
fn welded(positions: &[[f32; 3]], indices: &[u32]) -> Surface {
    let mut places = std::collections::HashMap::new();
    let mut surface = Surface::default();
    // Adding zero makes -0 and 0 one place.
    let key = |p: &[f32; 3]| p.map(|x| (x + 0.0).to_bits());
    let corners: Vec<u32> = positions
        .iter()
        .map(|p| {
            let place = Vec3::from(*p).as_dvec3();
            *places
                .entry(key(p))
                .or_insert_with(|| surface.corner(place))
        })
        .collect();
    let corner = |i: u32| corners[i as usize];
    let triangles = indices.chunks_exact(3);
    surface.triangles = triangles
        .map(|t| [corner(t[0]), corner(t[1]), corner(t[2])])
        .collect();
    surface
}

/// A scene with light and camera placed around a model.
fn around(name: &str, model: Model) -> Result<Scene> {
    let mut scene = Scene {
        name: name.into(),
        left_out: model.told(),
        meshes: model.meshes,
        objects: model.objects,
        lights: vec![Light::new(shadows::glam::Vec4::W, 1.0)],
        sky: Sky::default(),
        camera: Camera {
            eye: Vec3::Z,
            target: Vec3::ZERO,
            fovy: std::f32::consts::FRAC_PI_4,
            near: 1.0,
        },
    };
    let bounds = scene.bounds();
    // Half the diagonal: a ball of this radius holds the model.
    let radius = 0.5 * bounds.size().length();
    ensure!(radius > 0.0, "all its vertices are at one point");
    place(&mut scene, &bounds, radius);
    let far = [scene.light().place.truncate(), scene.camera.eye].map(|p| p.length_squared());
    ensure!(
        far.iter().all(|d| d.is_finite()) && (40.0 * radius) < f64::from(f32::MAX),
        "its size or place is too large for single precision"
    );
    Ok(scene)
}

/// Light above and to the right, camera in front and slightly above, all relative to the radius and
/// at odd numbers, so that no edge of a model is in line with them by design.
fn place(scene: &mut Scene, bounds: &Bounds, radius: f64) {
    let centre = bounds.centre();
    let light = centre + radius * dvec3(0.917, 2.131, 1.073);
    *scene.light_mut() = Light::new(light.as_vec3().extend(1.0), (12.0 * radius) as f32);
    // Room for the ball and for the shadow beside it.
    let distance = 1.35 * radius / f64::from(0.5 * scene.camera.fovy).sin();
    let towards: DVec3 = dvec3(-0.381, 0.473, 1.0).normalize();
    scene.camera.eye = (centre + distance * towards).as_vec3();
    scene.camera.target = (centre - dvec3(0.0, 0.13 * radius, 0.0)).as_vec3();
    scene.camera.near = (0.02 * radius) as f32;
}

fn add_ground(scene: &mut Scene) {
    let bounds = scene.bounds();
    let half = 4.0 * bounds.size().max_element();
    let centre = bounds.centre().with_y(bounds.min.y);
    // The square's corners are about the origin: large coordinates belong into the transform.
    let mesh = scene.add_mesh(square("ground", Vec3::ZERO, half as f32));
    scene.objects.push(Object {
        name: "ground".into(),
        mesh,
        transform: Affine3A::from_translation(centre.as_vec3()),
        casts: false,
        albedo: GREY,
        glow: [0.0; 3],
    });
}
