//! The receiving side: layout, bind group and WGSL.

use super::record::{ProjectedRecord, Records, UNIFORM_RECORDS};
use super::texture::MipTexture;
use crate::support::has_storage;

const RECEIVER: &str = include_str!("../../shaders/projected_receiver.wgsl");

/// What shaders read shadows through.
#[derive(Debug)]
pub(super) struct Receivers {
    label: String,
    storage: bool,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
}

impl Receivers {
    pub fn new(device: &wgpu::Device, label: &str) -> Self {
        let storage = has_storage(device);
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE,
            ty,
            count: None,
        };
        let size = size_of::<ProjectedRecord>();
        let (ty, size) = match storage {
            true => (wgpu::BufferBindingType::Storage { read_only: true }, size),
            false => (wgpu::BufferBindingType::Uniform, size * UNIFORM_RECORDS),
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &[
                entry(
                    0,
                    wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Float { filterable: true },
                        view_dimension: wgpu::TextureViewDimension::D2Array,
                        multisampled: false,
                    },
                ),
                entry(
                    1,
                    wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                ),
                entry(
                    2,
                    wgpu::BindingType::Buffer {
                        ty,
                        has_dynamic_offset: false,
                        min_binding_size: wgpu::BufferSize::new(size as u64),
                    },
                ),
            ],
        });
        let linear = wgpu::FilterMode::Linear;
        Self {
            label: label.to_owned(),
            storage,
            layout,
            // Levels are read one by one: each has a border of its own.
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some(label),
                mag_filter: linear,
                min_filter: linear,
                mipmap_filter: wgpu::MipmapFilterMode::Nearest,
                ..Default::default()
            }),
        }
    }

    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    pub fn group(
        &self,
        device: &wgpu::Device,
        texture: &MipTexture,
        records: &Records,
    ) -> wgpu::BindGroup {
        let resources = [
            wgpu::BindingResource::TextureView(texture.view()),
            wgpu::BindingResource::Sampler(&self.sampler),
            records.buffer().as_entire_binding(),
        ];
        let entries = (0..).zip(resources);
        let entries: Vec<wgpu::BindGroupEntry<'_>> = entries
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.label),
            layout: &self.layout,
            entries: &entries,
        })
    }

    /// Functions that take texture and sampler as parameters.
    pub fn wgsl(&self) -> String {
        RECEIVER.to_owned()
    }

    /// The same with the bindings of a group, and functions that read them.
    pub fn module(&self, group: u32) -> String {
        let records = match self.storage {
            true => "storage, read> shadows_projectors: array<ShadowsProjected>".to_owned(),
            false => {
                format!("uniform> shadows_projectors: array<ShadowsProjected, {UNIFORM_RECORDS}>")
            }
        };
        format!(
            "{RECEIVER}
@group({group}) @binding(0) var shadows_projected_map: texture_2d_array<f32>;
@group({group}) @binding(1) var shadows_projected_sampler: sampler;
@group({group}) @binding(2) var<{records};

fn shadows_transmittance(projector: u32, position: vec3f, x: vec3f, y: vec3f) -> vec3f {{
    return shadows_projected_transmittance(
        shadows_projected_map, shadows_projected_sampler, shadows_projectors[projector], position, x, y
    );
}}

fn shadows_transmittance_facing(
    projector: u32,
    position: vec3f,
    normal: vec3f,
    x: vec3f,
    y: vec3f,
) -> vec3f {{
    return shadows_projected_transmittance_facing(
        shadows_projected_map, shadows_projected_sampler, shadows_projectors[projector],
        position, normal, x, y
    );
}}
"
        )
    }
}
