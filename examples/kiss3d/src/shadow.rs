//! All that shadows add to this application: one atlas for its three lights, fed from kiss3d's own buffers.

use std::collections::HashMap;
use std::rc::Rc;

use anyhow::Result;
use glam::{Affine3A, Mat3, Mat4, Vec3};
use kiss3d::context::Context;
use kiss3d::prelude::SceneNode3d;
use kiss3d::resource::vertex_index::VERTEX_INDEX_FORMAT;
use kiss3d::scene::Object3d;
use shadows::mesh::Bounds;
use shadows::{
    AtlasFrame, AtlasLight, AtlasView, Caster, CasterMesh, DepthConvention, HostMesh, Kernel,
    MapKind, ModulePlace, PcfDescriptor, PcfSampler, ShadowAtlas, ShadowAtlasDescriptor, View,
    wgpu,
};

/// The bindings of kiss3d's materials that are left in its group 0 begin here.
pub const FIRST_BINDING: u32 = 1;

pub struct Shadows {
    pub atlas: ShadowAtlas,
    sampler: PcfSampler,
    /// By the address of kiss3d's mesh, which many objects may share.
    meshes: HashMap<usize, CasterMesh>,
}

impl Shadows {
    pub fn new() -> Result<Self> {
        let context = Context::get();
        let descriptor = PcfDescriptor {
            map: MapKind::ATLAS,
            kernel: Kernel::Hard,
            ..Default::default()
        };
        Ok(Self {
            atlas: ShadowAtlas::new(&context.device, &ShadowAtlasDescriptor::default())?,
            sampler: PcfSampler::new(&context.device, &context.queue, &descriptor)?,
            meshes: HashMap::new(),
        })
    }

    /// What stands before the material's own WGSL.
    pub fn wgsl(&self) -> Result<String> {
        let place = ModulePlace {
            first_binding: FIRST_BINDING,
            ..Default::default()
        };
        Ok(self.sampler.wgsl_module_at(&place)?)
    }

    /// What the layout of the material's group has besides its own.
    pub fn layout_entries(&self) -> Vec<wgpu::BindGroupLayoutEntry> {
        self.sampler.layout_entries(FIRST_BINDING)
    }

    /// What that group binds besides, to be made again when `atlas.revision()` changes.
    pub fn entries(&self) -> Result<Vec<wgpu::BindGroupEntry<'_>>> {
        Ok(self.sampler.entries(&self.atlas, FIRST_BINDING)?)
    }

    /// Draws the shadows of these nodes, before kiss3d draws the scene.
    pub fn draw(
        &mut self,
        nodes: &[SceneNode3d],
        (clip_from_world, [width, height]): (Mat4, [u32; 2]),
        lights: &[AtlasLight],
    ) -> Result<()> {
        let context = Context::get();
        let mut casters = Vec::new();
        for node in nodes {
            let places = transforms(node);
            let data = node.data();
            let Some(object) = data.object() else {
                continue;
            };
            let mesh = self.mesh(&context.device, object)?;
            casters.extend(places.into_iter().map(|at| Caster::new(mesh.clone(), at)));
        }
        let view = View::new(clip_from_world, DepthConvention::Standard)?;
        let frame = AtlasFrame {
            lights,
            casters: &casters,
            views: &[AtlasView::new(&view, width, height)],
            receivers: None,
        };
        self.atlas
            .prepare(&context.device, &context.queue, &frame)?;
        let mut encoder = context.create_command_encoder(Some("shadows"));
        self.atlas.encode(&mut encoder);
        context.submit([encoder.finish()]);
        Ok(())
    }

    /// The mesh of an object: kiss3d's vertex and index buffers as they are.
    fn mesh(&mut self, device: &wgpu::Device, object: &Object3d) -> Result<CasterMesh> {
        let mesh = object.mesh();
        let key = Rc::as_ptr(mesh) as usize;
        if let Some(known) = self.meshes.get(&key) {
            return Ok(known.clone());
        }
        let mesh = mesh.borrow();
        mesh.coords().write().unwrap().load_to_gpu();
        mesh.faces().write().unwrap().load_to_gpu();
        let (coords, faces) = (mesh.coords().read().unwrap(), mesh.faces().read().unwrap());
        let points = coords.data().as_deref().unwrap_or_default();
        let bounds = Bounds {
            min: points.iter().copied().fold(Vec3::INFINITY, Vec3::min),
            max: points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max),
        };
        let host = HostMesh {
            vertices: coords.buffer().expect("it was loaded"),
            stride: 12,
            offset: 0,
            indices: faces.buffer().expect("it was loaded"),
            index_format: VERTEX_INDEX_FORMAT,
            index_offset: 0,
            index_count: mesh.num_indices(),
            bounds,
        };
        let made = CasterMesh::from_host(device, &host)?;
        self.meshes.insert(key, made.clone());
        Ok(made)
    }
}

/// Where kiss3d draws an object's instances: `position + pose * (deformation * (scale * point))`.
pub fn transforms(node: &SceneNode3d) -> Vec<Affine3A> {
    let (pose, scale) = (node.world_pose(), node.world_scale());
    let pose = Affine3A::from_rotation_translation(pose.rotation, pose.translation);
    let data = node.data();
    let Some(object) = data.object() else {
        return Vec::new();
    };
    let instances = object.instances().borrow();
    let positions = instances.positions.data().as_deref().unwrap_or_default();
    let columns = instances.deformations.data().as_deref().unwrap_or_default();
    let place = |(position, columns): (&Vec3, &[Vec3])| {
        let deformation = Mat3::from_cols(columns[0], columns[1], columns[2]);
        Affine3A::from_translation(*position)
            * pose
            * Affine3A::from_mat3(deformation * Mat3::from_diagonal(scale))
    };
    let instances = positions.iter().zip(columns.chunks_exact(3));
    instances.map(place).collect()
}
