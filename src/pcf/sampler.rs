//! The receiving side of a shadow map: layout, bind group and WGSL.

use wgpu::util::DeviceExt as _;

use super::bound::Bound;
use super::kernel::KernelUniform;
use super::layout::layout_entries;
use super::map_kind::{Lights, MapWgsl, Reads};
use super::{AnyMap, Gather, Kernel, MapKind, ModulePlace, atlas_text, offsets, text};
use crate::DepthEncoding;
use crate::error::PcfError;
use crate::support::has_storage;

/// Parameters of a [`PcfSampler`].
#[derive(Clone, Debug, Default)]
pub struct PcfDescriptor<'a> {
    /// Name shown in debuggers. Default none.
    pub label: Option<&'a str>,
    /// The kernel. Default [`Kernel::Bilinear`].
    pub kernel: Kernel,
    /// The maps that it reads, and for which lights: one kind of light takes fewer instructions. Default
    /// [`MapKind::CUBE`].
    pub map: MapKind,
    /// Whether receivers do as textbooks have it instead of the kernel: one tap, and a constant
    /// bias of 0.15 world units. Needs cube maps of `LinearDistance`; for comparison with
    /// [`CubeShadowMapDescriptor::textbook`](crate::CubeShadowMapDescriptor::textbook). `kernel` is
    /// then its default, or [`Kernel::Hard`]. Default false.
    #[doc(hidden)]
    pub textbook: bool,
    /// Whether square kernels gather texels. Default [`Gather::Auto`]: wherever that is reliable.
    #[doc(hidden)]
    pub gather: Gather,
}

impl PcfDescriptor<'_> {
    /// Refuses what does not go together.
    fn validate_combination(&self) -> Result<(), PcfError> {
        if let MapKind::Atlas(kinds) = self.map
            && kinds.is_empty()
        {
            return Err(PcfError::NoLightKinds);
        }
        if !self.textbook {
            return match self.kernel.reads(self.map) {
                true => Ok(()),
                false => Err(PcfError::HardwareEncoding(self.map)),
            };
        }
        if self.map != MapKind::Cube(DepthEncoding::LinearDistance) {
            return Err(PcfError::Textbook(self.map));
        }
        match self.kernel {
            Kernel::Hard => Ok(()),
            kernel if kernel == Kernel::default() => Ok(()),
            kernel => Err(PcfError::TextbookKernel(kernel)),
        }
    }
}

/// Reads a [`CubeShadowMap`](crate::CubeShadowMap), a [`ShadowMap`](crate::ShadowMap) or a
/// [`ShadowAtlas`](crate::ShadowAtlas) in the host's lighting shader.
///
/// It provides three things: a bind group layout, a bind group for a map, and WGSL, either as functions
/// without bindings ([`wgsl`](Self::wgsl)) or as a module for a group number
/// ([`wgsl_module`](Self::wgsl_module)).
///
/// Every texel is compared with the depth of the receiver's plane in that texel's own direction (a receiver
/// plane as in Isidoro, "Shadow Mapping: GPU-based Tips and Techniques", GDC 2006, but exact for each texel
/// rather than a gradient for the kernel). The plane is the geometric one, from the screen derivatives of the
/// world position or from a flat normal of the host's; a smooth shading normal would tilt it and bring acne
/// back.
///
/// Far from the origin, where a pixel is hardly wider than an ulp of the position, derivatives contain no
/// information about the normal; the plane's slope is then read from the map.
/// [`Bias::position_ulps`](crate::Bias) covers the rounding of positions: a receiver within that distance of
/// a caster is lit.
#[derive(Debug)]
pub struct PcfSampler {
    kernel: Kernel,
    reads: Reads,
    textbook: bool,
    label: String,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    // Only disks have them.
    parameters: Option<wgpu::Buffer>,
    offsets: Option<wgpu::TextureView>,
}

impl PcfSampler {
    /// Creates a sampler for one kernel. Other kernels add no code to its WGSL and no bindings to its layout.
    ///
    /// # Errors
    /// [`PcfError`] if a parameter of the kernel is out of range, the device has no gathers for
    /// [`Gather::Always`], the maps' encoding does not go with [`Kernel::HardwareBilinear`] or with textbook
    /// receivers, or no kind of light is left.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        descriptor: &PcfDescriptor<'_>,
    ) -> Result<Self, PcfError> {
        let &PcfDescriptor {
            label,
            kernel,
            map,
            textbook,
            gather,
        } = descriptor;
        kernel.validate()?;
        descriptor.validate_combination()?;
        let hardware = kernel == Kernel::HardwareBilinear;
        let border = matches!(map, MapKind::Flat(_))
            && device
                .features()
                .contains(wgpu::Features::ADDRESS_MODE_CLAMP_TO_BORDER);
        let address_mode = match border {
            true => wgpu::AddressMode::ClampToBorder,
            false => wgpu::AddressMode::ClampToEdge,
        };
        let reads = Reads {
            map,
            lights: match map {
                MapKind::Atlas(_) if has_storage(device) => Lights::Storage,
                MapKind::Atlas(_) => Lights::Uniform,
                MapKind::Cube(_) | MapKind::Flat(_) => Lights::One,
            },
            border,
            gather: gather.on(device)?,
        };
        let filter = match hardware {
            false => wgpu::FilterMode::Nearest,
            true => wgpu::FilterMode::Linear,
        };
        let label = match label {
            Some(label) => format!("shadows pcf {label}"),
            None => "shadows pcf".to_owned(),
        };
        Ok(Self {
            kernel,
            reads,
            textbook,
            layout: device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(&label),
                entries: &layout_entries(kernel, reads, 0),
            }),
            // Nearest: texels are compared one by one, never blended as depths. In hardware it is what
            // comparisons say that is blended.
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some(&label),
                mag_filter: filter,
                min_filter: filter,
                compare: hardware.then_some(wgpu::CompareFunction::GreaterEqual),
                address_mode_u: address_mode,
                address_mode_v: address_mode,
                border_color: border.then_some(wgpu::SamplerBorderColor::TransparentBlack),
                ..Default::default()
            }),
            parameters: kernel.parameters().map(|parameters| {
                device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some(&label),
                    contents: bytemuck::bytes_of(&parameters),
                    usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                })
            }),
            offsets: offsets::create(device, queue, &label, kernel),
            label,
        })
    }

    /// The kernel it was created for.
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// The maps that it reads.
    pub fn map(&self) -> MapKind {
        self.reads.map
    }

    /// Selects the noise of rotated disks for a frame, for hosts whose temporal anti-aliasing averages it
    /// out: the patterns repeat after 64 frames (Jimenez 2014). Kernels without such noise are not affected.
    /// Without this call, every frame has the noise of frame 0.
    pub fn set_frame(&self, queue: &wgpu::Queue, frame: u32) {
        if let Some(buffer) = &self.parameters {
            let shift = 5.588_238 * (frame % 64) as f32;
            let place = std::mem::offset_of!(KernelUniform, frame_shift);
            queue.write_buffer(buffer, place as u64, bytemuck::bytes_of(&shift));
        }
    }

    /// Layout of the bind group: 0 the map (`texture_2d_array<f32>`, unfilterable), 1 a sampler
    /// (non-filtering); for [`Kernel::HardwareBilinear`] a `texture_depth_2d_array` and a comparison
    /// sampler; 2 the light (uniform buffer of 128 bytes; of an atlas a read-only storage buffer of
    /// all lights, or without storage buffers a uniform buffer of 128); for disks also 3, the kernel's
    /// parameters (uniform buffer of 32 bytes), and 4, its offsets (`texture_3d<f32>`). Fragment and
    /// compute stages.
    pub fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The same bindings in the same order for one of the host's bind groups, from `first_binding` on: three, or
    /// five for disks. [`entries`](Self::entries) returns the resources,
    /// [`wgsl_module_at`](Self::wgsl_module_at) the WGSL.
    pub fn layout_entries(&self, first_binding: u32) -> Vec<wgpu::BindGroupLayoutEntry> {
        layout_entries(self.kernel, self.reads, first_binding)
    }

    /// The bind group for a map. Maps of any size may be read with one sampler.
    ///
    /// It remains valid whatever light the map is prepared for. That of an atlas remains valid until
    /// [`ShadowAtlas::revision`](crate::ShadowAtlas::revision) changes; after that, all lights appear dark
    /// with it.
    ///
    /// # Errors
    /// [`PcfError`] if the map is of another kind or encoding, or was made for kernels that do not reach as far
    /// as this one.
    pub fn bind_group<'a>(
        &self,
        device: &wgpu::Device,
        map: impl Into<AnyMap<'a>>,
    ) -> Result<wgpu::BindGroup, PcfError> {
        Ok(self.group(device, &self.bound(map.into())?.entries(0)))
    }

    /// The entries of [`bind_group`](Self::bind_group), for one of the host's bind groups with
    /// [`layout_entries`](Self::layout_entries) in its layout. The host's group must be recreated whenever
    /// that one would be.
    ///
    /// # Errors
    /// Those of [`bind_group`](Self::bind_group).
    pub fn entries<'a>(
        &'a self,
        map: impl Into<AnyMap<'a>>,
        first_binding: u32,
    ) -> Result<Vec<wgpu::BindGroupEntry<'a>>, PcfError> {
        Ok(self.bound(map.into())?.entries(first_binding))
    }

    /// What is bound for a map.
    fn bound<'a>(&'a self, map: AnyMap<'a>) -> Result<Bound<'a>, PcfError> {
        if !self.map().reads(map.kind()) {
            let (made_for, given) = (self.map(), map.kind());
            return Err(PcfError::Map { made_for, given });
        }
        self.check_reach(map)?;
        let (map, lights) = match map {
            AnyMap::Cube(map) => (map.layers(), map.light_uniform()),
            AnyMap::Flat(map) => (map.view(), map.light_uniform()),
            AnyMap::Atlas(map) => (map.view(), map.light_buffer()),
        };
        Ok(Bound {
            map,
            sampler: &self.sampler,
            lights: lights.as_entire_binding(),
            parameters: self.parameters.as_ref(),
            offsets: self.offsets.as_ref(),
        })
    }

    /// What a kernel reads beyond a map's reach may be out of date, or beside the map.
    fn check_reach(&self, map: AnyMap<'_>) -> Result<(), PcfError> {
        let (kernel, map) = (self.kernel.radius(), map.reach());
        match kernel.is_within(map) {
            true => Ok(()),
            false => Err(PcfError::Reach { kernel, map }),
        }
    }

    fn group(
        &self,
        device: &wgpu::Device,
        entries: &[wgpu::BindGroupEntry<'_>],
    ) -> wgpu::BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.label),
            layout: &self.layout,
            entries,
        })
    }

    /// WGSL without bindings: textures and samplers are parameters. The function is named
    /// [`Kernel::function`]:
    ///
    /// ```wgsl
    /// fn shadows_cube_bilinear(
    ///     map: texture_2d_array<f32>, // the faces, in the order of CubeFace::ALL
    ///     map_sampler: sampler,
    ///     light: ShadowsLight,
    ///     position: vec3f, // of the receiver, world space
    ///     normal: vec3f,   // geometric, world space, any length, either sign
    /// ) -> f32             // 1 lit, 0 in shadow; 0 beyond the light's range
    /// ```
    ///
    /// For flat maps, `flat` replaces `cube` in all names, and the map has one layer. Disks take
    /// `kernel: ShadowsKernel` and `offsets: texture_3d<f32>` after the light, and `pixel: vec2f`, the pixel's
    /// coordinates, as the last parameter.
    ///
    /// `light.tiles` specifies the layers.
    pub fn wgsl(&self) -> String {
        let own = MapWgsl::new(self.reads);
        if let MapKind::Atlas(kinds) = self.map() {
            let flat = MapWgsl::flat_tiles(self.reads, kinds);
            return atlas_text::functions(self.kernel, &own, &flat, kinds);
        }
        match self.textbook {
            true => text::textbook(&own),
            false => text::functions(self.kernel, &own),
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
    /// Disks ([`Kernel::uses_pixel`]) take one more argument, `pixel: vec2f`: the x and y of
    /// `@builtin(position)`.
    ///
    /// For atlases, both take the light as the first parameter, `light: u32`: the index returned by
    /// [`ShadowAtlas::light_index`](crate::ShadowAtlas::light_index). For flat maps, the names begin with
    /// `shadows_flat_`: `shadows_flat_visibility` and `shadows_flat_visibility_flat`, so that a shader can
    /// contain the modules of both a cube sampler and a flat one.
    pub fn wgsl_module(&self, group: u32) -> String {
        self.module(group, 0)
    }

    /// The same for one of the host's bind groups: bindings start at that of `place`, and every name has its
    /// prefix, so that a shader can contain the modules of any number of samplers.
    ///
    /// ```
    /// # fn host(sampler: &shadows::PcfSampler) -> Result<String, shadows::error::PcfError> {
    /// let place = shadows::ModulePlace {
    ///     group: 0,
    ///     first_binding: 3,
    ///     prefix: "lamp_",
    /// };
    /// // lamp_shadows_visibility(position)
    /// sampler.wgsl_module_at(&place)
    /// # }
    /// ```
    ///
    /// # Errors
    /// [`PcfError::Prefix`] if the prefix does not form valid names.
    pub fn wgsl_module_at(&self, place: &ModulePlace<'_>) -> Result<String, PcfError> {
        let prefix = place.validated_prefix()?;
        let plain = self.module(place.group, place.first_binding);
        // By way of what no text has, in case the prefix has the word itself.
        let words = [("shadows_", "\u{1}"), ("Shadows", "\u{2}")];
        let marked = words
            .iter()
            .fold(plain, |text, (word, mark)| text.replace(word, mark));
        let named = words.iter().fold(marked, |text, (word, mark)| {
            text.replace(mark, &format!("{prefix}{word}"))
        });
        Ok(named)
    }

    fn module(&self, group: u32, first_binding: u32) -> String {
        let kernel = (!self.textbook).then_some(self.kernel);
        if let MapKind::Atlas(kinds) = self.map() {
            return self.wgsl()
                + &text::declarations(kernel, self.reads.lights, group, first_binding)
                + &atlas_text::visibility(self.kernel, kinds);
        }
        self.wgsl() + &text::bindings(kernel, &MapWgsl::new(self.reads), group, first_binding)
    }

    /// Whether the functions of [`wgsl_module`](Self::wgsl_module) take the pixel's coordinates:
    /// [`Kernel::uses_pixel`], except for textbook receivers.
    pub fn takes_pixel(&self) -> bool {
        self.kernel.uses_pixel() && !self.textbook
    }
}
