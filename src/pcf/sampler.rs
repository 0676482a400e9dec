//! The receiving side of a shadow map: layout, bind group and WGSL.

use wgpu::util::DeviceExt as _;

use super::kernel::KernelUniform;
use super::{AnyMap, Kernel, MapKind, offsets};
use crate::error::PcfError;
use crate::map::LightUniform;

/// How to make a [`PcfSampler`].
#[derive(Clone, Debug, Default)]
pub struct PcfDescriptor<'a> {
    /// Name of the sampler in debuggers. Default none.
    pub label: Option<&'a str>,
    /// The kernel. Default [`Kernel::Bilinear`].
    pub kernel: Kernel,
    /// The kind of map it reads. Default [`MapKind::Cube`].
    pub map: MapKind,
}

/// Reads a [`CubeShadowMap`](crate::CubeShadowMap) in the host's lighting shader.
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
    map: MapKind,
    label: String,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    // Only disks have them.
    parameters: Option<wgpu::Buffer>,
    offsets: Option<wgpu::TextureView>,
}

impl PcfSampler {
    /// Makes a sampler for one kernel. Kernels that were not chosen leave no code in its WGSL and
    /// no bindings in its layout.
    ///
    /// # Errors
    /// [`PcfError`] if a parameter of the kernel is out of range.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        descriptor: &PcfDescriptor<'_>,
    ) -> Result<Self, PcfError> {
        let &PcfDescriptor { label, kernel, map } = descriptor;
        kernel.validate()?;
        let label = match label {
            Some(label) => format!("shadows pcf {label}"),
            None => "shadows pcf".to_owned(),
        };
        Ok(Self {
            kernel,
            map,
            layout: create_layout(device, &label, kernel),
            // Nearest: texels are compared one by one, never blended as depths.
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some(&label),
                ..Default::default()
            }),
            parameters: kernel.parameters().map(|parameters| {
                device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some(&label),
                    contents: bytemuck::bytes_of(&parameters),
                    usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                })
            }),
            offsets: create_offsets(device, queue, &label, kernel),
            label,
        })
    }

    /// The kernel it was made for.
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// The kind of map it reads.
    pub fn map(&self) -> MapKind {
        self.map
    }

    /// Moves the noise of turned disks on to a frame, for hosts whose temporal anti-aliasing
    /// averages it away: 64 patterns, then the first again (Jimenez 2014). Kernels without such
    /// noise do not change. Without this call every frame has the noise of frame 0.
    pub fn set_frame(&self, queue: &wgpu::Queue, frame: u32) {
        if let Some(buffer) = &self.parameters {
            let shift = 5.588_238 * (frame % 64) as f32;
            let place = std::mem::offset_of!(KernelUniform, frame_shift);
            queue.write_buffer(buffer, place as u64, bytemuck::bytes_of(&shift));
        }
    }

    /// Layout of the bind group: 0 the map (`texture_cube<f32>`, unfilterable), 1 a sampler
    /// (non-filtering), 2 the light (uniform buffer of 32 bytes); for disks also 3, the kernel's
    /// parameters (uniform buffer of 544 bytes), and for the random disk 4, its offsets
    /// (`texture_3d<f32>`). Fragment and compute stages.
    pub fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The bind group for a map. It stays right as long as the map lives, whatever light the map
    /// is prepared for.
    ///
    /// # Errors
    /// [`PcfError::Map`] if the sampler was made for another kind of map.
    pub fn bind_group<'a>(
        &self,
        device: &wgpu::Device,
        map: impl Into<AnyMap<'a>>,
    ) -> Result<wgpu::BindGroup, PcfError> {
        let map = map.into();
        if map.kind() != self.map {
            let (made_for, given) = (self.map, map.kind());
            return Err(PcfError::Map { made_for, given });
        }
        let resources = [
            Some(wgpu::BindingResource::TextureView(map.view())),
            Some(wgpu::BindingResource::Sampler(&self.sampler)),
            Some(map.light_uniform().as_entire_binding()),
            self.parameters
                .as_ref()
                .map(wgpu::Buffer::as_entire_binding),
            self.offsets
                .as_ref()
                .map(wgpu::BindingResource::TextureView),
        ];
        let entries: Vec<_> = (0..)
            .zip(resources.into_iter().flatten())
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        Ok(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.label),
            layout: &self.layout,
            entries: &entries,
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
    ///
    /// Disks take `kernel: ShadowsCubeKernel` after the light (the random disk then
    /// `offsets: texture_3d<f32>`) and `pixel: vec2f`, the pixel's coordinates, as the last.
    pub fn wgsl(&self) -> String {
        self.kernel.wgsl(self.map)
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
    /// Disks ([`Kernel::uses_pixel`]) take one more argument, `pixel: vec2f`: the x and y of
    /// `@builtin(position)`.
    pub fn wgsl_module(&self, group: u32) -> String {
        let mut bindings = String::new();
        let mut arguments = "shadows_map, shadows_map_sampler, shadows_light".to_owned();
        let (mut parameter, mut pixel) = ("", "");
        if self.parameters.is_some() {
            bindings += &format!(
                "@group({group}) @binding(3) var<uniform> shadows_kernel: ShadowsCubeKernel;\n"
            );
            arguments += ", shadows_kernel";
            (parameter, pixel) = (", pixel: vec2f", ", pixel");
        }
        if self.offsets.is_some() {
            bindings +=
                &format!("@group({group}) @binding(4) var shadows_offsets: texture_3d<f32>;\n");
            arguments += ", shadows_offsets";
        }
        let module = format!(
            "@group({group}) @binding(0) var shadows_map: texture_cube<f32>;
@group({group}) @binding(1) var shadows_map_sampler: sampler;
@group({group}) @binding(2) var<uniform> shadows_light: ShadowsCubeLight;
{bindings}
fn shadows_visibility_flat(position: vec3f, normal: vec3f{parameter}) -> f32 {{
    return {function}({arguments}, position, normal{pixel});
}}

fn shadows_visibility(position: vec3f{parameter}) -> f32 {{
    return shadows_visibility_flat(position, cross(dpdx(position), dpdy(position)){pixel});
}}
",
            function = self.kernel.function(),
        );
        self.wgsl() + "\n" + &self.map.rename(&module)
    }
}

/// The random disk's texture; nothing for other kernels.
fn create_offsets(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    kernel: Kernel,
) -> Option<wgpu::TextureView> {
    let Kernel::RandomDisk(disk) = kernel else {
        return None;
    };
    // A byte a coordinate: 1/127 of the radius is fine enough for a jittered offset.
    let texels: Vec<[i8; 4]> = offsets::random_disk(&disk)
        .into_iter()
        .map(|texel| texel.map(|c| (c * 127.0).round() as i8))
        .collect();
    let texture = device.create_texture_with_data(
        queue,
        &wgpu::TextureDescriptor {
            label: Some(&format!("{label} offsets")),
            size: wgpu::Extent3d {
                width: disk.size,
                height: disk.size,
                depth_or_array_layers: disk.taps() / 2,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D3,
            format: wgpu::TextureFormat::Rgba8Snorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        bytemuck::cast_slice(&texels),
    );
    Some(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

fn create_layout(device: &wgpu::Device, label: &str, kernel: Kernel) -> wgpu::BindGroupLayout {
    let visibility = wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE;
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty,
        count: None,
    };
    let texture = |filterable, view_dimension| wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable },
        view_dimension,
        multisampled: false,
    };
    let uniform = |size: usize| wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: wgpu::BufferSize::new(size as u64),
    };
    let mut entries = vec![
        // A float texture rather than a depth texture: depths are compared here, texel by texel,
        // and GL reads depth textures only through its own single comparison.
        entry(0, texture(false, wgpu::TextureViewDimension::Cube)),
        entry(
            1,
            wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
        ),
        entry(2, uniform(size_of::<LightUniform>())),
    ];
    if kernel.uses_pixel() {
        entries.push(entry(3, uniform(size_of::<KernelUniform>())));
    }
    if let Kernel::RandomDisk(_) = kernel {
        entries.push(entry(4, texture(false, wgpu::TextureViewDimension::D3)));
    }
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &entries,
    })
}
