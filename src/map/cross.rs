//! A debug view of a cube map, unfolded into a cross.

use super::cube::CubeShadowMap;
use super::encoding::DepthEncoding;
use super::gpu::LightRecord;
use super::overlay::Overlay;
use crate::error::{CubeShadowMapError, DebugPassError};

/// Parameters of a [`CubeCross`].
#[derive(Clone, Debug)]
pub struct CubeCrossDescriptor<'a> {
    /// Name shown in debuggers. Default none.
    pub label: Option<&'a str>,
    /// Format of the pass's only colour attachment. Default `Rgba8Unorm`.
    pub color_format: wgpu::TextureFormat,
    /// The pass's depth-stencil format, if it has one; neither tested nor written. Default `None`.
    pub depth_stencil_format: Option<wgpu::TextureFormat>,
    /// Samples of the pass, 1 or 4. Default 1.
    pub sample_count: u32,
    /// What the maps' texels hold. Default [`DepthEncoding::MajorAxis`].
    pub encoding: DepthEncoding,
}

impl Default for CubeCrossDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            color_format: wgpu::TextureFormat::Rgba8Unorm,
            depth_stencil_format: None,
            sample_count: 1,
            encoding: DepthEncoding::default(),
        }
    }
}

/// Draws a cube map into a host's pass, unfolded as a cross, to show its content.
///
/// The viewport is divided into four by three cells: +Y at the top, -X, +Z, +X, -Z in the middle row, -Y at
/// the bottom, each as seen from the light and joined to +Z as on the cube. White is at the light, black at
/// its range or beyond (in distance or along the major axis, according to the map's encoding), and dark blue
/// where there is no caster. The corner cells are left untouched.
#[derive(Debug)]
pub struct CubeCross {
    label: String,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    pipeline: wgpu::RenderPipeline,
    encoding: DepthEncoding,
}

impl CubeCross {
    /// Creates the pipeline.
    ///
    /// # Errors
    /// [`DebugPassError`] if a format or the sample count of the pass does not fit.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &CubeCrossDescriptor<'_>,
    ) -> Result<Self, DebugPassError> {
        let label = match descriptor.label {
            Some(label) => format!("shadows cube cross {label}"),
            None => "shadows cube cross".to_owned(),
        };
        let layout = layout(device, &label);
        Ok(Self {
            pipeline: pipeline(device, &label, &layout, descriptor)?,
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some(&label),
                ..Default::default()
            }),
            layout,
            label,
            encoding: descriptor.encoding,
        })
    }

    /// The bind group for a map; it remains valid as long as the map exists.
    ///
    /// # Errors
    /// [`CubeShadowMapError`] if the map has another encoding.
    pub fn bind_group(
        &self,
        device: &wgpu::Device,
        map: &CubeShadowMap,
    ) -> Result<wgpu::BindGroup, CubeShadowMapError> {
        if map.encoding() != self.encoding {
            return Err(CubeShadowMapError::Encoding {
                map: map.encoding(),
                cross: self.encoding,
            });
        }
        Ok(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.label),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(map.layers()),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::Sampler(&self.sampler),
                },
                wgpu::BindGroupEntry {
                    binding: 2,
                    resource: map.light_uniform().as_entire_binding(),
                },
            ],
        }))
    }

    /// Draws into the pass's viewport. Replaces the pass's pipeline and bind group 0.
    pub fn render(&self, pass: &mut wgpu::RenderPass<'_>, group: &wgpu::BindGroup) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn layout(device: &wgpu::Device, label: &str) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[
            entry(
                0,
                wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2Array,
                    multisampled: false,
                },
            ),
            entry(
                1,
                wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
            ),
            entry(
                2,
                wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: wgpu::BufferSize::new(size_of::<LightRecord>() as u64),
                },
            ),
        ],
    })
}

fn pipeline(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    descriptor: &CubeCrossDescriptor<'_>,
) -> Result<wgpu::RenderPipeline, DebugPassError> {
    let linear = descriptor.encoding == DepthEncoding::LinearDistance;
    let overlay = Overlay {
        label,
        shader: crate::wgsl::CUBE_CROSS,
        layout,
        buffers: &[],
        topology: wgpu::PrimitiveTopology::TriangleList,
        constants: &[("linear", f64::from(u8::from(linear)))],
        format: descriptor.color_format,
        depth_stencil: descriptor.depth_stencil_format,
        samples: descriptor.sample_count,
    };
    overlay.pipeline(device)
}
