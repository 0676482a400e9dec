//! What an adapter offers, which of its features are worth requesting, and what replaces missing ones.

use std::fmt;
use std::future::Future as _;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

use wgpu::{AdapterInfo, Backend, DownlevelFlags, Features, Limits};

/// The capabilities of an adapter that matter to shadows.
///
/// Everything in this crate runs with WebGPU's default limits and without any features. For each field that
/// is `false`, [`fallbacks`](Self::fallbacks) names the replacement.
///
/// # wgpu's GL back end
/// This back end has restrictions that the fields do not express:
/// - It converts clip z to `2 z - w`, which loses most of the precision of reverse-Z, and everything beyond 2^23
///   times the near distance. Shadow maps avoid this: their fragment shaders write the depth, so they hold the
///   same values as elsewhere, but without an early depth test. A host that draws into a map itself
///   ([`encode_with`](crate::ShadowAtlas::encode_with)) must do the same. The host's own depth buffer suffers the
///   loss, and shadow volumes depend on it: of 260 random scenes that are exact elsewhere, 257 are exact there
///   (`tests/volume/random.rs`). On receivers a million near distances away, 1.4 % of the pixels are wrong; in a
///   host that does not compute its positions with [`wgsl::POSITION`](crate::wgsl::POSITION), 0.07 % are (at light
///   caps).
/// - Shaders cannot read multisampled textures: [`LightJoin`](crate::LightJoin) and
///   [`ExactCount`](crate::ExactCount) take one sample.
/// - Cube maps cannot be read as cubes ([`CubeShadowMap::view`](crate::CubeShadowMap::view)) and have an unused
///   additional layer, as a [`ShadowMask`](crate::ShadowMask) may. Depth cannot be copied
///   ([`StaticLayers`](crate::StaticLayers)).
///
/// ```
/// # fn host(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
/// # use shadows::wgpu;
/// let support = shadows::Support::of_adapter(adapter);
/// wgpu::DeviceDescriptor {
///     required_features: support.features(),
///     required_limits: support.limits(),
///     ..Default::default()
/// }
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    /// Depth clip control: for shadow volumes under projections with a finite far plane, and for casters
    /// nearer to a map's light than its near plane.
    pub depth_clip_control: bool,
    /// Clip distances: under projections with a finite far plane, the faces of shadow volumes are clipped at
    /// the near plane, as the host's surfaces are. Without them, up to 90 % of the interior pixels of single
    /// pictures were wrong on an NVIDIA H200 where the near plane intersects a caster (`docs/gpu.md`).
    pub clip_distances: bool,
    /// `Depth32FloatStencil8`: stencil together with float depth.
    pub depth32float_stencil8: bool,
    /// Blending in `R32Float`: for shadow volumes that count without wrapping
    /// ([`Counter::Exact`](crate::Counter::Exact)).
    pub float32_blending: bool,
    /// Multiview: shadow volumes of several views in one pass
    /// ([`ShadowVolumeDescriptor::multiview_mask`](crate::ShadowVolumeDescriptor::multiview_mask)).
    pub multiview: bool,
    /// Storage buffers in vertex shaders: for shadow volumes that pull their vertices.
    pub vertex_storage: bool,
    /// Compute shaders with indirect draws: for finding silhouettes on the GPU.
    pub compute: bool,
    /// Samplers with a border colour: flat maps are lit beyond their edge without a test in the shader.
    pub clamp_to_border: bool,
    /// Texture gathers: square kernels read four texels of a map at once. All devices have them except those
    /// of the GL back end without compute shaders, that is WebGL 2 and OpenGL ES 3.0.
    pub gather: bool,
    limits: Limits,
}

/// A capability that an adapter lacks, and its replacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Fallback {
    /// The missing capability.
    pub missing: &'static str,
    /// What replaces it.
    pub instead: &'static str,
}

impl fmt::Display for Fallback {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no {}: {}", self.missing, self.instead)
    }
}

/// Compute is of use only together with indirect draws.
const COMPUTE: DownlevelFlags =
    DownlevelFlags::COMPUTE_SHADERS.union(DownlevelFlags::INDIRECT_EXECUTION);

/// Storage buffers in the largest of the crate's shader stages.
pub(crate) const STORAGE_BUFFERS: u32 = 7;

impl Support {
    /// Queries an adapter, before the host creates its device.
    pub fn of_adapter(adapter: &wgpu::Adapter) -> Self {
        Self::new(
            adapter.features(),
            adapter.limits(),
            adapter.get_downlevel_capabilities().flags,
            &adapter.get_info(),
        )
    }

    fn new(
        features: Features,
        limits: Limits,
        downlevel: DownlevelFlags,
        info: &AdapterInfo,
    ) -> Self {
        let gather = info.backend != Backend::Gl || downlevel.contains(COMPUTE);
        Self {
            gather,
            depth_clip_control: features.contains(Features::DEPTH_CLIP_CONTROL),
            clip_distances: features.contains(Features::CLIP_DISTANCES),
            depth32float_stencil8: features.contains(Features::DEPTH32FLOAT_STENCIL8),
            float32_blending: features.contains(Features::FLOAT32_BLENDABLE),
            multiview: features.contains(Features::MULTIVIEW),
            vertex_storage: downlevel.contains(DownlevelFlags::VERTEX_STORAGE)
                && limits.max_storage_buffers_per_shader_stage >= STORAGE_BUFFERS,
            compute: downlevel.contains(COMPUTE),
            clamp_to_border: features.contains(Features::ADDRESS_MODE_CLAMP_TO_BORDER),
            limits,
        }
    }

    /// The depth-stencil format to use for the host's buffer, and in every descriptor of shadow volumes:
    /// `Depth32FloatStencil8`, their default, if the adapter has it (the device must then be created with
    /// [`features`](Self::features)); otherwise `Depth24PlusStencil8`, which every device has.
    /// [`ShadowVolumeDescriptor::depth_stencil_format`](crate::ShadowVolumeDescriptor::depth_stencil_format)
    /// states what that costs.
    pub fn depth_stencil_format(&self) -> wgpu::TextureFormat {
        match self.depth32float_stencil8 {
            true => wgpu::TextureFormat::Depth32FloatStencil8,
            false => wgpu::TextureFormat::Depth24PlusStencil8,
        }
    }

    /// The features to request; never more than the adapter has.
    pub fn features(&self) -> Features {
        [
            (self.depth_clip_control, Features::DEPTH_CLIP_CONTROL),
            (self.clip_distances, Features::CLIP_DISTANCES),
            (self.depth32float_stencil8, Features::DEPTH32FLOAT_STENCIL8),
            (self.float32_blending, Features::FLOAT32_BLENDABLE),
            (self.multiview, Features::MULTIVIEW),
            (self.clamp_to_border, Features::ADDRESS_MODE_CLAMP_TO_BORDER),
        ]
        .into_iter()
        .filter(|(offered, _)| *offered)
        .fold(Features::empty(), |all, (_, feature)| all | feature)
    }

    /// The limits to ask for: WebGPU's defaults (less where the adapter has less), with room for
    /// large meshes and as many views in a pass as there may be.
    pub fn limits(&self) -> Limits {
        let offered = &self.limits;
        Limits {
            max_buffer_size: offered.max_buffer_size,
            max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
            max_texture_dimension_2d: offered.max_texture_dimension_2d,
            max_multiview_view_count: offered.max_multiview_view_count,
            ..Limits::defaults().or_worse_values_from(offered)
        }
    }

    /// What is missing, and what replaces it. Empty if nothing is missing.
    pub fn fallbacks(&self) -> Vec<Fallback> {
        [
            (
                self.depth_clip_control,
                "DEPTH_CLIP_CONTROL",
                "shadow volumes need an infinite reverse-Z projection; others are refused",
            ),
            (
                self.clip_distances,
                "CLIP_DISTANCES",
                "under a projection with a finite far plane, shadow volumes of casters that the near plane cuts are wrong in places on GPUs; infinite reverse-Z needs none",
            ),
            (
                self.depth32float_stencil8,
                "Depth32FloatStencil8",
                "Depth24PlusStencil8 for the host's depth-stencil buffer, named in every descriptor of shadow volumes (Support::depth_stencil_format)",
            ),
            (
                self.float32_blending,
                "FLOAT32_BLENDABLE",
                "the 8-bit stencil counts volumes modulo 256; ShadowVolumeRenderer::may_wrap says when that could matter",
            ),
            (
                self.multiview,
                "MULTIVIEW",
                "a pass draws one view; the passes of several views go into one submission",
            ),
            (
                self.vertex_storage,
                "storage buffers in vertex shaders",
                "the silhouettes of shadow volumes are found in the vertex shader alone",
            ),
            (
                self.compute,
                "compute shaders with indirect draws",
                "the silhouettes of shadow volumes are found on the CPU",
            ),
            (
                self.clamp_to_border,
                "ADDRESS_MODE_CLAMP_TO_BORDER",
                "each tap on a flat map is tested against the map's edge",
            ),
            (
                self.gather,
                "texture gathers",
                "square kernels fetch texels one by one",
            ),
        ]
        .into_iter()
        .filter(|(offered, ..)| !offered)
        .map(|(_, missing, instead)| Fallback { missing, instead })
        .collect()
    }
}

/// Whether a device's shaders read storage buffers. WebGL 2 has none.
pub(crate) fn has_storage(device: &wgpu::Device) -> bool {
    device.limits().max_storage_buffers_per_shader_stage > 0
}

/// Whether a device's shaders gather texels. GL has gathers from the versions on that have compute
/// shaders and indirect draws, and of those wgpu can be asked.
pub(crate) fn has_gather(device: &wgpu::Device) -> bool {
    device.adapter_info().backend != Backend::Gl
        || takes(device, || {
            drop(device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("shadows indirect"),
                size: 16,
                usage: wgpu::BufferUsages::INDIRECT,
                mapped_at_creation: false,
            }));
        })
}

/// Whether a device takes storage buffers in vertex shaders.
pub(crate) fn has_vertex_storage(device: &wgpu::Device) -> bool {
    takes(device, || {
        drop(
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("shadows vertex storage"),
                entries: &[wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility: wgpu::ShaderStages::VERTEX,
                    ty: wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Storage { read_only: true },
                        has_dynamic_offset: false,
                        min_binding_size: None,
                    },
                    count: None,
                }],
            }),
        );
    })
}

/// Whether a device takes what none of its features or limits tells. The answer comes at once from
/// wgpu's own validation; WebGPU gives it later, and has what is asked for here.
fn takes(device: &wgpu::Device, make: impl FnOnce()) -> bool {
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    make();
    let answer = pin!(scope.pop()).poll(&mut Context::from_waker(Waker::noop()));
    !matches!(answer, Poll::Ready(Some(_)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn info(backend: Backend) -> AdapterInfo {
        AdapterInfo::new(wgpu::DeviceType::Other, backend)
    }

    fn full(limits: Limits, info: &AdapterInfo) -> Support {
        Support::new(Features::all(), limits, DownlevelFlags::all(), info)
    }

    #[test]
    fn gl_gathers_where_it_computes() {
        let none = DownlevelFlags::empty();
        let gathers = |backend, flags| {
            let limits = Limits::defaults();
            Support::new(Features::empty(), limits, flags, &info(backend)).gather
        };
        assert!(!gathers(Backend::Gl, none));
        assert!(gathers(Backend::Gl, COMPUTE));
        assert!(gathers(Backend::Vulkan, none));
        let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        assert!(has_gather(&device));
    }

    #[test]
    fn a_bare_adapter_asks_for_nothing_and_says_what_it_does_instead() {
        let limits = Limits::downlevel_webgl2_defaults();
        let info = info(Backend::Gl);
        let support = Support::new(Features::empty(), limits, DownlevelFlags::empty(), &info);
        assert_eq!(support.features(), Features::empty());
        assert_eq!(support.fallbacks().len(), 9);
        let every_device_has_it = wgpu::TextureFormat::Depth24PlusStencil8;
        assert_eq!(support.depth_stencil_format(), every_device_has_it);
        assert!(support.limits().max_storage_buffers_per_shader_stage == 0);
    }

    #[test]
    fn a_full_adapter_lacks_nothing() {
        let support = full(Limits::defaults(), &info(Backend::Vulkan));
        assert!(support.fallbacks().is_empty());
        let default = crate::ShadowVolumeDescriptor::default().depth_stencil_format;
        assert_eq!(support.depth_stencil_format(), default);
        assert!(!support.features().contains(Features::TIMESTAMP_QUERY));
    }

    #[test]
    fn a_device_is_asked_for_storage_in_vertex_shaders() {
        let with = |required_limits| {
            let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor {
                required_limits,
                ..Default::default()
            });
            has_vertex_storage(&device)
        };
        assert!(with(Limits::defaults()));
        assert!(!with(Limits::downlevel_webgl2_defaults()));
    }
}
