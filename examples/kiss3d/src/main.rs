//! kiss3d with the shadows of this crate: its instances, MSAA and HDR, with three lights in one atlas whose bindings
//! share the material's group 0. Runs without a window, and compares each light's visibility with exact ray casting.
//!
//! ```text
//! cargo run --release --manifest-path examples/kiss3d/Cargo.toml -- target/kiss3d.png
//! ```

mod material;
mod shadow;

use std::cell::RefCell;
use std::rc::Rc;

use anyhow::{Result, ensure};
use glam::{DAffine3, DMat3, Mat3, Mat4, Quat, Vec3};
use kiss3d::camera::{Camera3d, OrbitCamera3d};
use kiss3d::color::Color;
use kiss3d::post_processing::Tonemap;
use kiss3d::resource::{Material3d, MaterialManager3d};
use kiss3d::scene::{InstanceData3d, SceneNode3d};
use kiss3d::window::{NumSamples, OffscreenSurface};
use shadows::reference::{
    Class, Comparison, Interior, ReferenceImage, ReferenceObject, ReferenceScene,
};
use shadows::{
    AtlasLight, Cascades, DepthConvention, DirectionalLight, HomogeneousLight, PointLight,
    ShadowAtlas, SpotLight, TileSize, View,
};

use material::Lit;
use shadow::{Shadows, transforms};

const SIZE: [u32; 2] = [960, 540];

fn lamp() -> PointLight {
    PointLight::new(Vec3::new(-3.2, 3.4, 1.6), 30.0)
}

fn spot() -> SpotLight {
    let position = Vec3::new(4.5, 6.0, 4.0);
    SpotLight::new(position, Vec3::new(0.5, 0.5, 0.0) - position, 0.62, 30.0)
}

fn sun() -> DirectionalLight {
    DirectionalLight::new(Vec3::new(0.5, 0.9, -0.35))
}

fn lights() -> [AtlasLight; 3] {
    let cascades = Cascades {
        distance: 40.0,
        ..Default::default()
    };
    let size = TileSize::Fixed(1024);
    [
        AtlasLight::new(lamp()).with_size(size),
        AtlasLight::new(spot()).with_size(size),
        AtlasLight::directional(sun(), cascades).with_size(size),
    ]
}

/// A floor, a ring of instanced pillars around a ball, and a tilted cone.
fn scene() -> (SceneNode3d, Vec<SceneNode3d>) {
    let mut root = SceneNode3d::empty();
    let floor = root
        .add_cube(24.0, 0.4, 24.0)
        .set_position(Vec3::new(0.0, -0.2, 0.0))
        .set_color(Color::new(0.62, 0.60, 0.56, 1.0));
    let pillar = |i: u32| {
        let turn = i as f32 * std::f32::consts::TAU / 12.0;
        InstanceData3d {
            position: Vec3::new(3.4 * turn.cos(), 0.0, 3.4 * turn.sin()),
            deformation: Mat3::from_quat(Quat::from_rotation_y(-turn))
                * Mat3::from_diagonal(Vec3::new(1.0, 1.0 + 0.25 * (i % 3) as f32, 1.0)),
            ..Default::default()
        }
    };
    let pillars: Vec<_> = (0..12).map(pillar).collect();
    let pillars = root
        .add_cube(0.35, 1.6, 0.35)
        .set_position(Vec3::new(0.0, 0.8, 0.0))
        .set_color(Color::new(0.75, 0.55, 0.38, 1.0))
        .set_instances(&pillars);
    let ball = root
        .add_sphere(0.9)
        .set_position(Vec3::new(0.0, 1.3, 0.0))
        .set_color(Color::new(0.35, 0.55, 0.75, 1.0));
    let cone = root
        .add_cone(0.5, 1.2)
        .set_position(Vec3::new(1.5, 0.6, 1.3))
        .set_rotation(Quat::from_rotation_z(0.3))
        .set_color(Color::new(0.45, 0.65, 0.40, 1.0));
    (root, vec![floor, pillars, ball, cone])
}

fn main() -> Result<()> {
    let path = std::env::args()
        .nth(1)
        .unwrap_or_else(|| "target/kiss3d.png".to_owned());
    pollster::block_on(run(path.as_ref()))
}

async fn run(path: &std::path::Path) -> Result<()> {
    let mut surface = OffscreenSurface::new(SIZE[0], SIZE[1]).await;
    surface.set_shadows_enabled(false); // kiss3d's own
    let (eye, at) = (Vec3::new(5.5, 5.0, 8.0), Vec3::new(0.0, 0.6, 0.0));
    let mut camera = OrbitCamera3d::new_with_frustum(0.8, 0.1, 100.0, eye, at);
    let (mut root, nodes) = scene();
    let shadows = Rc::new(RefCell::new(Shadows::new()?));
    let shown = Rc::new(RefCell::new(0));
    let material: Box<dyn Material3d> = Box::new(Lit::new(shadows.clone(), shown.clone())?);
    let material = Rc::new(RefCell::new(material));
    // kiss3d begins and flushes the frames of the materials that it knows by a name.
    MaterialManager3d::get_global_manager(|known| known.add(material.clone(), "lit"));
    root.set_material_recursive(material);

    // Once so that kiss3d tells the camera of the surface's size.
    surface.render_3d(&mut root, &mut camera).await;
    let clip_from_world = camera.transformation();
    shadows
        .borrow_mut()
        .draw(&nodes, (clip_from_world, SIZE), &lights())?;

    surface.set_tonemap(Tonemap::None);
    let reference = reference_scene(&nodes)?;
    let mut worst = 0;
    for light in 0..3 {
        *shown.borrow_mut() = light as u32 + 1;
        surface.render_3d(&mut root, &mut camera).await;
        let seen: Vec<u8> = surface
            .snap_image()
            .pixels()
            .map(|pixel| pixel.0[0])
            .collect();
        let truth = truth(&reference, clip_from_world, light)?;
        let found = truth.compare(&seen, interior(&shadows.borrow().atlas, light))?;
        report(["point light", "spot", "sun"][light], &truth, &found);
        worst = worst.max(found.false_lit_interior + found.false_shadow_interior);
    }

    *shown.borrow_mut() = 0;
    surface.set_samples(NumSamples::Four);
    surface.set_tonemap(Tonemap::AgX);
    surface.render_3d(&mut root, &mut camera).await;
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    surface.snap_image().save(path)?;
    println!("{}", path.display());
    ensure!(worst == 0, "{worst} pixels are wrong that no edge is near");
    Ok(())
}

fn report(name: &str, truth: &ReferenceImage, found: &Comparison) {
    let wrong = found.false_lit + found.false_shadow;
    println!(
        "{name}: {:.3} % of {} pixels wrong ({} in shadow), {} in the interior",
        100.0 * wrong as f64 / found.lit_facing as f64,
        found.lit_facing,
        truth.count(Class::Shadowed),
        found.false_lit_interior + found.false_shadow_interior,
    );
}

/// What kiss3d draws, for exact rays.
fn reference_scene(nodes: &[SceneNode3d]) -> Result<ReferenceScene> {
    let mut meshes = Vec::new();
    for node in nodes {
        let places = transforms(node);
        let data = node.data();
        let Some(object) = data.object() else {
            continue;
        };
        let mesh = object.mesh().borrow();
        let points = mesh
            .coords()
            .read()
            .unwrap()
            .data()
            .clone()
            .unwrap_or_default();
        let faces = mesh
            .faces()
            .read()
            .unwrap()
            .data()
            .clone()
            .unwrap_or_default();
        let points: Vec<[f32; 3]> = points.iter().map(|point| point.to_array()).collect();
        let indices: Vec<u32> = faces.iter().flatten().copied().collect();
        meshes.push((points, indices, places));
    }
    let objects: Vec<_> = meshes
        .iter()
        .flat_map(|(positions, indices, places)| {
            places.iter().map(move |place| ReferenceObject {
                positions,
                indices,
                transform: DAffine3 {
                    matrix3: DMat3::from_cols(
                        Vec3::from(place.matrix3.x_axis).as_dvec3(),
                        Vec3::from(place.matrix3.y_axis).as_dvec3(),
                        Vec3::from(place.matrix3.z_axis).as_dvec3(),
                    ),
                    translation: Vec3::from(place.translation).as_dvec3(),
                },
                casts: true,
            })
        })
        .collect();
    Ok(ReferenceScene::new(&objects)?)
}

fn truth(scene: &ReferenceScene, clip_from_world: Mat4, light: usize) -> Result<ReferenceImage> {
    let view = View::new(clip_from_world, DepthConvention::Standard)?;
    let [width, height] = SIZE;
    Ok(match light {
        0 => scene.render(&view, width, height, lamp().into(), Some(lamp().range))?,
        1 => scene.render_spot(&view, width, height, &spot())?,
        _ => scene.render(&view, width, height, HomogeneousLight::from(sun()), None)?,
    })
}

/// How wide the map's texels are, next to which an error is no fault.
fn interior(atlas: &ShadowAtlas, light: usize) -> Interior {
    let tiles = atlas.tiles(light, 0);
    let widest = tiles[tiles.len() - 1];
    match light {
        0 => Interior::Map {
            face_size: widest.size,
            kernel_radius: 0.0,
        },
        _ => Interior::FlatMap {
            clip_from_world: widest.clip_from_world,
            size: widest.size,
            kernel_radius: 0.0,
        },
    }
}
