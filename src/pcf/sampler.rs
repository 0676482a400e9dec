//! The receiving side of a shadow map: layout, bind group and WGSL.

use super::Kernel;
use crate::error::PcfError;
use crate::map::LightUniform;
use crate::{CubeShadowMap, DepthEncoding};

/// How to make a [`PcfSampler`].
#[derive(Clone, Debug, Default)]
pub struct PcfDescriptor<'a> {
    /// Name of the sampler in debuggers. Default none.
    pub label: Option<&'a str>,
    /// The kernel. Default [`Kernel::Bilinear`].
    pub kernel: Kernel,
    /// What the maps' texels hold. Default [`DepthEncoding::MajorAxis`].
    pub encoding: DepthEncoding,
    /// Whether shaders name a light by its place in the frame, from one bind group for all lights of
    /// a map. Such maps are made with `cube_array`. Default false: one light a bind group.
    pub many_lights: bool,
    /// Whether receivers do as textbooks have it instead of the kernel: one tap, and a constant
    /// bias of 0.15 world units. Needs `LinearDistance`; for comparison with
    /// [`CubeShadowMapDescriptor::textbook`](crate::CubeShadowMapDescriptor::textbook). Default
    /// false.
    pub textbook: bool,
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
    encoding: DepthEncoding,
    many_lights: bool,
    textbook: bool,
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
            encoding: descriptor.encoding,
            many_lights: descriptor.many_lights,
            textbook: descriptor.textbook,
            layout: create_layout(device, &label, descriptor.many_lights),
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

    /// Layout of the bind group: 0 the map (`texture_cube<f32>`, unfilterable; with `many_lights`
    /// `texture_cube_array<f32>`), 1 a sampler (non-filtering), 2 the light (uniform buffer of 48
    /// bytes; with `many_lights` a read-only storage buffer of all lights). Fragment and compute
    /// stages.
    pub fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The bind group for a map: all its lights with `many_lights`, else its first. Maps of any
    /// size may be read with one sampler.
    ///
    /// It stays right whatever light the map is prepared for, until
    /// [`CubeShadowMap::texture_revision`] changes.
    ///
    /// # Errors
    /// [`PcfError`] if the map has another encoding or is no cube array.
    pub fn bind_group(
        &self,
        device: &wgpu::Device,
        map: &CubeShadowMap,
    ) -> Result<wgpu::BindGroup, PcfError> {
        self.bind_group_of(device, map, 0)
    }

    /// The bind group for one light of a map that has a texture for each; `light` is its place in
    /// the frame. With `many_lights` it holds all of them.
    ///
    /// # Errors
    /// As [`bind_group`](Self::bind_group).
    pub fn bind_group_of(
        &self,
        device: &wgpu::Device,
        map: &CubeShadowMap,
        light: usize,
    ) -> Result<wgpu::BindGroup, PcfError> {
        if map.encoding() != self.encoding {
            return Err(PcfError::Encoding {
                map: map.encoding(),
                sampler: self.encoding,
            });
        }
        let (view, lights) = match (self.many_lights, map.array()) {
            (true, Some((view, lights))) => (view, lights.as_entire_binding()),
            (true, None) => return Err(PcfError::NoCubeArray),
            (false, _) => (map.view(light), map.light_uniform(light)),
        };
        Ok(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.label),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(view),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::Sampler(&self.sampler),
                },
                wgpu::BindGroupEntry {
                    binding: 2,
                    resource: lights,
                },
            ],
        }))
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
    /// With `many_lights` the map is a `texture_cube_array<f32>`, and `light.cube` says which cube.
    pub fn wgsl(&self) -> String {
        let mut parts = match self.textbook {
            true => vec![
                include_str!("../../shaders/cube_receiver.wgsl"),
                include_str!("../../shaders/cube_textbook.wgsl"),
            ],
            false => self.kernel.parts().to_vec(),
        };
        let gathers = parts
            .iter()
            .any(|part| part.contains("shadows_cube_gather("));
        parts.push(match self.encoding {
            DepthEncoding::MajorAxis => include_str!("../../shaders/cube_major.wgsl"),
            DepthEncoding::LinearDistance => include_str!("../../shaders/cube_linear.wgsl"),
        });
        let (fetch, gather) = match self.many_lights {
            false => (
                include_str!("../../shaders/cube_fetch.wgsl"),
                include_str!("../../shaders/cube_gather.wgsl"),
            ),
            true => (
                include_str!("../../shaders/cube_array_fetch.wgsl"),
                include_str!("../../shaders/cube_array_gather.wgsl"),
            ),
        };
        parts.push(fetch);
        if gathers {
            parts.push(gather);
        }
        let text = parts.join("\n");
        match self.many_lights {
            false => text,
            true => text.replace("texture_cube<f32>", "texture_cube_array<f32>"),
        }
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
    ///
    /// With `many_lights` both take the light's place in the frame first, as `light: u32`.
    pub fn wgsl_module(&self, group: u32) -> String {
        let function = match self.textbook {
            true => "shadows_cube_textbook",
            false => self.kernel.function(),
        };
        let (map, lights, parameter, argument, light) = match self.many_lights {
            false => (
                "texture_cube<f32>",
                "var<uniform> shadows_light: ShadowsCubeLight",
                "",
                "",
                "shadows_light",
            ),
            true => (
                "texture_cube_array<f32>",
                "var<storage, read> shadows_lights: array<ShadowsCubeLight>",
                "light: u32, ",
                "light, ",
                "shadows_lights[light]",
            ),
        };
        format!(
            "{functions}
@group({group}) @binding(0) var shadows_map: {map};
@group({group}) @binding(1) var shadows_map_sampler: sampler;
@group({group}) @binding(2) {lights};

fn shadows_visibility_flat({parameter}position: vec3f, normal: vec3f) -> f32 {{
    return {function}(shadows_map, shadows_map_sampler, {light}, position, normal);
}}

fn shadows_visibility({parameter}position: vec3f) -> f32 {{
    return shadows_visibility_flat({argument}position, cross(dpdx(position), dpdy(position)));
}}
",
            functions = self.wgsl(),
        )
    }
}

fn create_layout(device: &wgpu::Device, label: &str, many: bool) -> wgpu::BindGroupLayout {
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
                    view_dimension: match many {
                        false => wgpu::TextureViewDimension::Cube,
                        true => wgpu::TextureViewDimension::CubeArray,
                    },
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
                    ty: match many {
                        false => wgpu::BufferBindingType::Uniform,
                        true => wgpu::BufferBindingType::Storage { read_only: true },
                    },
                    has_dynamic_offset: false,
                    min_binding_size: wgpu::BufferSize::new(size_of::<LightUniform>() as u64),
                },
            ),
        ],
    })
}
