//! Bevy with the shadows of this crate instead of its own: three lights in one atlas, whose bindings share the
//! material's bind group. Runs without a window, and compares each light's visibility with exact ray casting.
//!
//! ```text
//! cargo run --release --manifest-path examples/bevy/Cargo.toml -- target/bevy.png
//! ```
//!
//! Rust older than 1.97.1 needs `--ignore-rust-version`, which Bevy's shader language asks for and does not use.

mod material;
mod shadow;

use anyhow::{Context, Result, ensure};
use bevy_app::{App, PluginsState, Startup, TaskPoolPlugin};
use bevy_asset::{AssetPlugin, Assets, Handle};
use bevy_camera::{Camera, Camera3d, PerspectiveProjection, Projection, RenderTarget};
use bevy_core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy_ecs::prelude::{Commands, On, ResMut, Resource, World};
use bevy_image::Image;
use bevy_mesh::{Mesh, Mesh3d, Meshable};
use bevy_pbr::MeshMaterial3d;
use bevy_render::gpu_readback::{Readback, ReadbackComplete};
use bevy_render::render_resource::{TextureFormat, TextureUsages};
use bevy_render::view::Msaa;
use bevy_render::{RenderApp, RenderPlugin};
use bevy_shape::{Cone, Cuboid, Sphere};
use bevy_transform::components::{GlobalTransform, Transform};
use shadows::glam::{DAffine3, DMat3, Mat4, Quat, Vec3};
use shadows::reference::{
    Class, Comparison, Interior, ReferenceImage, ReferenceObject, ReferenceScene,
};
use shadows::{
    AtlasLight, Cascades, DepthConvention, DirectionalLight, HomogeneousLight, PointLight,
    ShadowAtlas, SpotLight, TileSize, View,
};

use material::{Lit, LitPlugin};
use shadow::{ShadowPlugin, Shadows};

/// Rows of whole 256 bytes, as they are read back.
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

fn lights() -> Vec<AtlasLight> {
    let cascades = Cascades {
        distance: 40.0,
        ..Default::default()
    };
    let size = TileSize::Fixed(1024);
    vec![
        AtlasLight::new(lamp()).with_size(size),
        AtlasLight::new(spot()).with_size(size),
        AtlasLight::directional(sun(), cascades).with_size(size),
    ]
}

/// The last picture that came back.
#[derive(Resource, Default)]
struct Seen(Vec<u8>);

/// A floor, a ring of pillars of one mesh around a ball, and a tilted cone.
fn spawn(
    mut commands: Commands,
    mut images: ResMut<Assets<Image>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<Lit>>,
) {
    let [width, height] = SIZE;
    let mut image = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
    image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    let target = images.add(image);
    commands.spawn(Readback::texture(target.clone())).observe(
        |read: On<ReadbackComplete>, mut seen: ResMut<Seen>| seen.0.clone_from(&read.data),
    );
    commands.spawn((
        Camera3d::default(),
        RenderTarget::from(target),
        Projection::Perspective(PerspectiveProjection {
            fov: 0.8,
            ..Default::default()
        }),
        Transform::from_xyz(5.5, 5.0, 8.0).looking_at(Vec3::new(0.0, 0.6, 0.0), Vec3::Y),
        Msaa::Off,
        Tonemapping::None,
        DebandDither::Disabled,
    ));
    let mut object = |mesh: Handle<Mesh>, places: Vec<Transform>, color: [f32; 3]| {
        let color = Vec3::from(color);
        let material = materials.add(Lit { color, shown: 0 });
        for place in places {
            commands.spawn((
                Mesh3d(mesh.clone()),
                MeshMaterial3d(material.clone()),
                place,
            ));
        }
    };
    let floor = meshes.add(Cuboid::new(24.0, 0.4, 24.0));
    object(
        floor,
        vec![Transform::from_xyz(0.0, -0.2, 0.0)],
        [0.62, 0.60, 0.56],
    );
    let pillar = |i: u32| {
        let turn = i as f32 * std::f32::consts::TAU / 12.0;
        let height = 1.0 + 0.25 * (i % 3) as f32;
        Transform::from_xyz(3.4 * turn.cos(), 0.8 * height, 3.4 * turn.sin())
            .with_rotation(Quat::from_rotation_y(-turn))
            .with_scale(Vec3::new(1.0, height, 1.0))
    };
    let pillars = meshes.add(Cuboid::new(0.35, 1.6, 0.35));
    object(pillars, (0..12).map(pillar).collect(), [0.75, 0.55, 0.38]);
    let ball = meshes.add(Sphere::new(0.9).mesh().uv(64, 32));
    object(
        ball,
        vec![Transform::from_xyz(0.0, 1.3, 0.0)],
        [0.35, 0.55, 0.75],
    );
    let cone = meshes.add(Cone::new(0.5, 1.2));
    let tilted = Transform::from_xyz(1.5, 0.6, 1.3).with_rotation(Quat::from_rotation_z(0.3));
    object(cone, vec![tilted], [0.45, 0.65, 0.40]);
}

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        bevy_diagnostic::FrameCountPlugin,
        bevy_time::TimePlugin,
        bevy_transform::TransformPlugin,
        bevy_diagnostic::DiagnosticsPlugin,
        bevy_window::WindowPlugin {
            primary_window: None,
            exit_condition: bevy_window::ExitCondition::DontExit,
            ..Default::default()
        },
        AssetPlugin::default(),
        RenderPlugin {
            synchronous_pipeline_compilation: true,
            ..Default::default()
        },
        bevy_image::ImagePlugin::default(),
        bevy_mesh::MeshPlugin,
        bevy_camera::CameraPlugin,
        bevy_light::LightPlugin,
        bevy_core_pipeline::CorePipelinePlugin,
        bevy_pbr::PbrPlugin::default(),
    ))
    .add_plugins((ShadowPlugin(lights()), LitPlugin))
    .init_resource::<Seen>()
    .add_systems(Startup, spawn);
    while app.plugins_state() == PluginsState::Adding {
        std::thread::yield_now();
    }
    app.finish();
    app.cleanup();
    app
}

/// The picture with all materials showing this.
fn show(app: &mut App, shown: u32) -> Result<Vec<u8>> {
    let mut materials = app.world_mut().resource_mut::<Assets<Lit>>();
    for (_, material) in materials.iter_mut() {
        material.shown = shown;
    }
    // A picture that is on its way is older.
    for _ in 0..8 {
        app.update();
    }
    let seen = app.world().resource::<Seen>().0.clone();
    ensure!(!seen.is_empty(), "no picture came back");
    Ok(seen)
}

fn main() -> Result<()> {
    let path = std::env::args()
        .nth(1)
        .unwrap_or_else(|| "target/bevy.png".to_owned());
    let path = std::path::Path::new(&path);
    let mut app = app();
    show(&mut app, 0)?;
    let world = app.world_mut();
    let mut cameras = world.query::<(&Camera, &GlobalTransform)>();
    let (camera, place) = cameras.single(world)?;
    let clip_from_world = camera.clip_from_view() * place.to_matrix().inverse();
    let reference = reference_scene(world)?;
    let mut worst = 0;
    for light in 0..3 {
        let seen = show(&mut app, light as u32 + 1)?;
        let seen: Vec<u8> = seen.chunks_exact(4).map(|pixel| pixel[0]).collect();
        let truth = truth(&reference, clip_from_world, light)?;
        let shadows = app.sub_app(RenderApp).world().resource::<Shadows>();
        let found = truth.compare(&seen, interior(&shadows.atlas, light))?;
        report(["point light", "spot", "sun"][light], &truth, &found);
        worst = worst.max(found.false_lit_interior + found.false_shadow_interior);
    }
    let picture = show(&mut app, 0)?;
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    image::save_buffer(path, &picture, SIZE[0], SIZE[1], image::ColorType::Rgba8)?;
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

/// What Bevy draws, for exact rays.
fn reference_scene(world: &mut World) -> Result<ReferenceScene> {
    let mut objects = Vec::new();
    let mut drawn = world.query::<(&Mesh3d, &GlobalTransform)>();
    let meshes = world.resource::<Assets<Mesh>>();
    for (mesh, place) in drawn.iter(world) {
        let mesh = meshes.get(&mesh.0).context("a mesh is gone")?;
        let positions = mesh.attribute(Mesh::ATTRIBUTE_POSITION);
        let positions = positions.and_then(|values| values.as_float3());
        let indices = mesh.indices().context("no indices")?.iter();
        let place = place.affine();
        let column = |column| Vec3::from(column).as_dvec3();
        objects.push((
            positions.context("no positions")?.to_vec(),
            indices.map(|index| index as u32).collect::<Vec<_>>(),
            DAffine3 {
                matrix3: DMat3::from_cols(
                    column(place.matrix3.x_axis),
                    column(place.matrix3.y_axis),
                    column(place.matrix3.z_axis),
                ),
                translation: column(place.translation),
            },
        ));
    }
    let objects: Vec<_> = objects
        .iter()
        .map(|(positions, indices, transform)| ReferenceObject {
            positions,
            indices,
            transform: *transform,
            casts: true,
        })
        .collect();
    Ok(ReferenceScene::new(&objects)?)
}

fn truth(scene: &ReferenceScene, clip_from_world: Mat4, light: usize) -> Result<ReferenceImage> {
    let view = View::new(clip_from_world, DepthConvention::InfiniteReverse)?;
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
