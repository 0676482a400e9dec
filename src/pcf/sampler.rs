//! The receiving side of a shadow map: layout, bind group and WGSL.

use super::Kernel;
use crate::CubeShadowMap;
use crate::map::LightUniform;

/// How to make a [`PcfSampler`].
#[derive(Clone, Debug, Default)]
pub struct PcfDescriptor<'a> {
    /// Name of the sampler in debuggers. Default none.
    pub label: Option<&'a str>,
    /// The kernel. Default [`Kernel::Bilinear`].
    pub kernel: Kernel,
}

/// Reads a [`CubeShadowMap`] in the host's lighting shader.
///
/// Gives three things: a bind group layout, a bind group for a map, and WGSL, either as functions
/// without bindings ([`wgsl`](Self::wgsl)) or as a module for a group number
/// ([`wgsl_module`](Self::wgsl_module)).
///
/// Every texel is compared with the depth that the receiver's plane has in that texel's own
/// direction (a receiver plane as in Isidoro, "Shadow Mapping: GPU-based Tips and Techniques",
/// GDC 2006, but exact for each texel rather than a gradient for the kernel). The plane is the
/// geometric one, from the screen derivatives of the world position or from a flat normal of the
/// host's; a smooth shading normal would tilt it and bring acne back.
#[derive(Debug)]
pub struct PcfSampler {
    kernel: Kernel,
    label: String,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
}

impl PcfSampler {
    /// Makes a sampler for one kernel. Kernels that were not chosen leave no code in its WGSL.
    pub fn new(device: &wgpu::Device, descriptor: &PcfDescriptor<'_>) -> Self {
        let label = match descriptor.label {
            Some(label) => format!("shadows pcf {label}"),
            None => "shadows pcf".to_owned(),
        };
        Self {
            kernel: descriptor.kernel,
            layout: create_layout(device, &label),
            // Nearest: texels are compared one by one, never blended as depths.
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some(&label),
                ..Default::default()
            }),
            label,
        }
    }

    /// The kernel it was made for.
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// Layout of the bind group: 0 the map (`texture_cube<f32>`, unfilterable), 1 a sampler
    /// (non-filtering), 2 the light (uniform buffer of 32 bytes). Fragment and compute stages.
    pub fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The bind group for a map. It stays right as long as the map lives, whatever light the map
    /// is prepared for.
    pub fn bind_group(&self, device: &wgpu::Device, map: &CubeShadowMap) -> wgpu::BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.label),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(map.view()),
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
        })
    }

    /// WGSL without bindings: textures and samplers are parameters. The function is named
    /// [`Kernel::function`]:
    ///
    /// ```wgsl
    /// fn shadows_cube_bilinear(
    ///     map: texture_cube<f32>,
    ///     map_sampler: sampler,
    ///     light: ShadowsCubeLight,
    ///     position: vec3f, // of the receiver, world space
    ///     normal: vec3f,   // geometric, world space, any length, either sign
    /// ) -> f32             // 1 lit, 0 in shadow; 0 beyond the light's range
    /// ```
    pub fn wgsl(&self) -> String {
        self.kernel.parts().join("\n")
    }

    /// WGSL with the bindings of one group declared, to paste into a host's shader:
    ///
    /// ```wgsl
    /// // World position; the plane comes from its screen derivatives. Fragment stage, in uniform
    /// // control flow.
    /// fn shadows_visibility(position: vec3f) -> f32
    /// // The same with a geometric normal of the host's; any stage, any control flow.
    /// fn shadows_visibility_flat(position: vec3f, normal: vec3f) -> f32
    /// ```
    pub fn wgsl_module(&self, group: u32) -> String {
        let function = self.kernel.function();
        format!(
            "{functions}
@group({group}) @binding(0) var shadows_map: texture_cube<f32>;
@group({group}) @binding(1) var shadows_map_sampler: sampler;
@group({group}) @binding(2) var<uniform> shadows_light: ShadowsCubeLight;

fn shadows_visibility_flat(position: vec3f, normal: vec3f) -> f32 {{
    return {function}(shadows_map, shadows_map_sampler, shadows_light, position, normal);
}}

fn shadows_visibility(position: vec3f) -> f32 {{
    return shadows_visibility_flat(position, cross(dpdx(position), dpdy(position)));
}}
",
            functions = self.wgsl(),
        )
    }
}

fn create_layout(device: &wgpu::Device, label: &str) -> wgpu::BindGroupLayout {
    let visibility = wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE;
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty,
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[
            entry(
                0,
                // A float texture rather than a depth texture: depths are compared here, texel by
                // texel, and GL reads depth textures only through its own single comparison.
                wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::Cube,
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
                    min_binding_size: wgpu::BufferSize::new(size_of::<LightUniform>() as u64),
                },
            ),
        ],
    })
}
