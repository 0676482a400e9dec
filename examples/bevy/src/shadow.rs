//! All that shadows add to this application: one atlas for its three lights, fed from Bevy's own mesh slabs.

use std::collections::HashMap;

use bevy_app::{App, Plugin};
use bevy_asset::AssetId;
use bevy_camera::{Camera3d, primitives::Aabb};
use bevy_core_pipeline::schedule::camera_driver;
use bevy_ecs::prelude::*;
use bevy_light::NotShadowCaster;
use bevy_mesh::{Mesh, Mesh3d};
use bevy_render::mesh::{RenderMesh, RenderMeshBufferInfo::Indexed, allocator::MeshAllocator};
use bevy_render::render_asset::RenderAssets;
use bevy_render::renderer::*;
use bevy_render::view::ExtractedView;
use bevy_render::{Extract, ExtractSchedule, Render, RenderApp, RenderSystems};
use bevy_transform::components::GlobalTransform;
use shadows::glam::Affine3A;
use shadows::mesh::Bounds;
use shadows::{
    AtlasFrame, AtlasLight, AtlasView, Caster, CasterMesh, DepthConvention, HostMesh, Kernel,
    MapKind, PcfDescriptor, PcfSampler, ShadowAtlas, ShadowAtlasDescriptor, View, wgpu,
};

pub struct ShadowPlugin(pub Vec<AtlasLight>);

/// Lives in the render world.
#[derive(Resource)]
pub struct Shadows {
    pub atlas: ShadowAtlas,
    pub sampler: PcfSampler,
    lights: Vec<AtlasLight>,
    meshes: HashMap<AssetId<Mesh>, CasterMesh>,
    /// What the main world's casters were when they were extracted.
    extracted: Vec<(AssetId<Mesh>, Aabb, Affine3A)>,
}

impl Plugin for ShadowPlugin {
    fn build(&self, _: &mut App) {}

    /// There is a device by now.
    fn finish(&self, app: &mut App) {
        let device = app.world().resource::<RenderDevice>().wgpu_device().clone();
        let queue = app.world().resource::<RenderQueue>().clone();
        let descriptor = PcfDescriptor {
            map: MapKind::ATLAS,
            kernel: Kernel::Hard,
            ..Default::default()
        };
        let sampler = PcfSampler::new(&device, &queue, &descriptor).expect("it is in range");
        let atlas = ShadowAtlas::new(&device, &ShadowAtlasDescriptor::default());
        app.sub_app_mut(RenderApp)
            .insert_resource(Shadows {
                atlas: atlas.expect("it is in range"),
                sampler,
                lights: self.0.clone(),
                meshes: HashMap::new(),
                extracted: Vec::new(),
            })
            .add_systems(ExtractSchedule, extract)
            .add_systems(Render, prepare.in_set(RenderSystems::PrepareResources))
            .add_systems(RenderGraph, encode.before(camera_driver));
    }
}

type Drawn = (&'static Mesh3d, &'static Aabb, &'static GlobalTransform);

fn extract(mut shadows: ResMut<Shadows>, casters: Extract<Query<Drawn, Without<NotShadowCaster>>>) {
    let casters = casters.iter();
    shadows.extracted = casters
        .map(|(mesh, bounds, place)| (mesh.id(), *bounds, place.affine()))
        .collect();
}

fn prepare(
    mut shadows: ResMut<Shadows>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
    (loaded, slabs): (Res<RenderAssets<RenderMesh>>, Res<MeshAllocator>),
    camera: Single<&ExtractedView, With<Camera3d>>,
) -> Result<()> {
    let (shadows, device) = (&mut *shadows, device.wgpu_device());
    // A slab that grew is another buffer.
    for moved in slabs.meshes_displaced_by_slab_growth() {
        shadows.meshes.remove(&moved);
    }
    let mut casters = Vec::new();
    for (id, bounds, place) in &shadows.extracted {
        if !shadows.meshes.contains_key(id) {
            let Some(mesh) = caster_mesh(device, &loaded, &slabs, id, bounds)? else {
                continue; // not loaded yet
            };
            shadows.meshes.insert(*id, mesh);
        }
        casters.push(Caster::new(shadows.meshes[id].clone(), *place));
    }
    let camera = camera.into_inner();
    let clip_from_world = camera.clip_from_view * camera.world_from_view.to_matrix().inverse();
    let view = View::new(clip_from_world, DepthConvention::InfiniteReverse)?;
    let [.., width, height] = camera.viewport.to_array();
    let frame = AtlasFrame {
        lights: &shadows.lights,
        casters: &casters,
        views: &[AtlasView::new(&view, width, height)],
        receivers: None,
    };
    Ok(shadows.atlas.prepare(device, &queue, &frame)?)
}

/// A mesh as it lies in Bevy's slabs, whatever other attributes its vertices have.
fn caster_mesh(
    device: &wgpu::Device,
    loaded: &RenderAssets<RenderMesh>,
    slabs: &MeshAllocator,
    id: &AssetId<Mesh>,
    bounds: &Aabb,
) -> Result<Option<CasterMesh>> {
    let slices = (slabs.mesh_vertex_slice(id), slabs.mesh_index_slice(id));
    let (Some(mesh), (Some(vertices), Some(indices))) = (loaded.get(*id), slices) else {
        return Ok(None);
    };
    let Indexed {
        count,
        index_format,
    } = mesh.buffer_info
    else {
        return Ok(None);
    };
    let position = Mesh::ATTRIBUTE_POSITION.at_shader_location(0);
    let layout = mesh.layout.0.get_layout(&[position])?;
    let stride = layout.array_stride;
    let host = HostMesh {
        vertices: vertices.buffer,
        stride,
        offset: u64::from(vertices.range.start) * stride + layout.attributes[0].offset,
        indices: indices.buffer,
        index_format,
        index_offset: u64::from(indices.range.start) * index_format.byte_size() as u64,
        index_count: count,
        bounds: Bounds {
            min: bounds.min().into(),
            max: bounds.max().into(),
        },
    };
    Ok(Some(CasterMesh::from_host(device, &host)?))
}

fn encode(mut shadows: ResMut<Shadows>, mut context: RenderContext) {
    shadows.atlas.encode(context.command_encoder());
}
