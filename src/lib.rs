//! Real-time shadows for any engine on wgpu 30.
//!
#![cfg_attr(doc, doc = include_str!("../docs/picture.md"))]
//!
//! The host owns the window, the device, the frame graph and the meshes. This crate takes the host's device,
//! meshes and lights, and returns bind groups, WGSL and render passes. It never creates a device, submits,
//! polls or blocks. It owns shadow textures, pipelines and scratch buffers, and nothing else.
//!
//! Guides: [`choosing`] a technique, [`adding`] the crate to an engine, and the known [`limits`].
//!
//! | | what it is | what it is for |
//! |---|---|---|
//! | [`CubeShadowMap`] | depth of casters on six cube faces | a point light |
//! | [`ShadowMap`] | depth of casters on one square | a spot or a directional light |
//! | [`ShadowAtlas`] | all lights of a scene as tiles of one texture | many lights of any kind in one bind group, cascades |
//! | [`PcfSampler`] | the filters through which receivers read a map | one tap to contact hardening, without acne or seams |
//! | [`ShadowVolumeRenderer`] | stencil shadow volumes | shadows exact to the pixel, for point and directional lights |
//! | [`BlobShadow`] | an ellipsoid for each caster, with a computed penumbra | soft shadows of thousands of objects whose shape does not matter |
//! | [`PlanarShadow`] | casters projected onto planes | a floor or a wall as the only receiver, exact to the pixel |
//! | [`PlanarSoftShadow`] | the same, averaged over an area light | soft shadows on one rectangle |
//! | [`ProjectedShadow`] | pictures of casters, projected onto receivers | few receivers; coloured and translucent casters |
//! | [`mesh::Adjacency`] | welded edges and their triangles | input of shadow volumes; any triangle mesh will do |
//! | `reference` (feature) | exact visibility by ray casting in f64 | measuring the error of all of the above; light maps |
//!
//! Each type has the same three calls: `new` for what never changes, `prepare` once per frame for the CPU's
//! work, and `encode` (into the host's encoder) or `render` (into the host's pass) for the GPU's.
//!
//! # Dependencies
//!
//! ```toml
//! [dependencies]
//! shadows = "0.1"
//! wgpu = "30"
//! ```
//!
//! Back ends (Vulkan, Metal, Direct3D 12, GL) are default features of wgpu. This crate enables none of them
//! (except `webgpu` on the web), so without your own dependency on wgpu, no adapter is found. The versions are
//! wgpu 30 and glam 0.33, re-exported as `shadows::wgpu` and `shadows::glam`.
//!
//! # A complete host
//!
//! One triangle above a floor, with its shadow from a map and from volumes. This example runs as a test on wgpu's
//! driverless device; in a real host, only the creation of the device differs.
//!
//! ```
//! use shadows::glam::{Affine3A, Mat4, Vec3, camera::rh};
//! use shadows::mesh::Adjacency;
//! use shadows::{wgpu, *};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # // wgpu 30's check of indirect draws trips over the driverless device's limits.
//! # let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
//! #     backends: wgpu::Backends::NOOP,
//! #     flags: wgpu::InstanceFlags::empty(),
//! #     backend_options: wgpu::BackendOptions {
//! #         noop: wgpu::NoopBackendOptions::enabled(),
//! #         ..Default::default()
//! #     },
//! #     ..wgpu::InstanceDescriptor::new_without_display_handle()
//! # });
//! # let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
//! let support = Support::of_adapter(&adapter);
//! let wanted = wgpu::DeviceDescriptor {
//!     required_features: support.features(),
//!     required_limits: support.limits(),
//!     ..Default::default()
//! };
//! let (device, queue) = pollster::block_on(adapter.request_device(&wanted))?;
//!
//! // Once per mesh: which triangles are neighbours, then the GPU's copy.
//! let positions = [[-1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.0]];
//! let adjacency = Adjacency::new(&positions, &[0, 1, 2])?;
//! let mesh = CasterMesh::new(&device, &positions, &adjacency)?;
//! let casters = [Caster::new(mesh, Affine3A::IDENTITY)];
//! let light = PointLight::new(Vec3::new(0.0, 4.0, 1.0), 30.0);
//!
//! // A shadow map, and how shaders read it.
//! let mut map = CubeShadowMap::new(&device, &CubeShadowMapDescriptor::default())?;
//! let sampler = PcfSampler::new(&device, &queue, &PcfDescriptor::default())?;
//! let group = sampler.bind_group(&device, &map)?;
//! let lighting = sampler.wgsl_module(1)
//!     + "@fragment fn light(@location(0) world: vec3f) -> @location(0) vec4f {
//!            return vec4f(shadows_visibility(world)); // times the light's colour
//!        }";
//! let lighting = device.create_shader_module(wgpu::ShaderModuleDescriptor {
//!     label: None,
//!     source: wgpu::ShaderSource::Wgsl(lighting.into()),
//! });
//!
//! // Shadow volumes for a depth-stencil buffer that the host has filled with its scene.
//! let mut volumes = ShadowVolumeRenderer::new(
//!     &device,
//!     &ShadowVolumeDescriptor {
//!         depth_stencil_format: support.depth_stencil_format(),
//!         ..Default::default()
//!     },
//! )?;
//! let projection = rh::proj::directx::perspective_infinite_reverse(0.8, 16.0 / 9.0, 0.1);
//! let camera = rh::view::look_at_mat4(Vec3::new(0.0, 3.0, 8.0), Vec3::ZERO, Vec3::Y);
//! let view = View::new(projection * camera, DepthConvention::InfiniteReverse)?;
//! # let depth = device
//! #     .create_texture(&wgpu::TextureDescriptor {
//! #         label: None,
//! #         size: wgpu::Extent3d { width: 64, height: 36, depth_or_array_layers: 1 },
//! #         mip_level_count: 1,
//! #         sample_count: 1,
//! #         dimension: wgpu::TextureDimension::D2,
//! #         format: support.depth_stencil_format(),
//! #         usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
//! #         view_formats: &[],
//! #     })
//! #     .create_view(&Default::default());
//!
//! // Every frame: decide, then record into the host's own encoder and pass.
//! map.prepare(&device, &queue, &CubeFrame::new(light, &casters))?;
//! let frame = ShadowVolumeFrame {
//!     lights: &[light.into()],
//!     views: &[view.into()],
//!     casters: &casters,
//!     ..Default::default()
//! };
//! volumes.prepare(&device, &queue, &frame)?;
//! let mut encoder = device.create_command_encoder(&Default::default());
//! map.encode(&mut encoder);
//! volumes.encode(&mut encoder);
//! // ... the host draws its depth and ambient light here ...
//! let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
//!     label: Some("shadow volumes"),
//!     depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
//!         view: &depth,
//!         depth_ops: None, // read only
//!         stencil_ops: Some(wgpu::Operations {
//!             load: wgpu::LoadOp::Clear(0),
//!             store: wgpu::StoreOp::Store,
//!         }),
//!     }),
//!     ..Default::default()
//! });
//! volumes.render(&mut pass, 0, 0)?; // the first light in the first view
//! drop(pass);
//! // ... and adds this light where the stencil is 0, with `light_pass_stencil` in its pipeline,
//! // or everywhere, times `shadows_visibility`, with `group` bound as group 1 ...
//! let stencil: wgpu::StencilState = ShadowVolumeRenderer::light_pass_stencil();
//! queue.submit([encoder.finish()]);
//! # let _ = (group, lighting, stencil, Mat4::IDENTITY);
//! # Ok(())
//! # }
//! ```
//!
//! # Which one
//!
//! Shadow volumes are exact for any mesh: no resolution, no bias, no leaks. Their cost is the fill of the
//! area that they cover on screen. The cost of shadow maps is their texels, whatever the screen shows, and
//! their accuracy depends on the size of those texels. The example `compare` measures time and error of both
//! on your own scene. See [`choosing`] for more; `docs/numerics.md` in the repository explains why the
//! results are correct.
//!
//! # Compatibility
//!
//! Errors, statistics and choices (enums of a descriptor) are `#[non_exhaustive]`: new variants and fields are
//! not breaking changes. Create descriptors and frames with `..Default::default()` or with their `new`, so that
//! new fields do not break your code. Lights, [`Bias`], [`mesh::Bounds`], the parameters of kernels,
//! [`CubeFace`], [`mesh::MeshKind`] and [`DepthConvention`] are exhaustive: hosts construct or match on them, and
//! changing them requires a breaking release.
//!
//! # Features
//!
//! - `reference` (off): exact visibility in f64, for measuring errors rather than rendering frames. Needs
//!   Rust 1.89; everything else needs 1.88.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub use {glam, wgpu};

// The guides, as pages of this documentation. Their own definitions of links lead to other pages of the
// repository; here those before them count.
/// [speed]: https://docs.rs/crate/shadows/latest/source/docs/speed-vs-error.md
/// [cost]: https://docs.rs/crate/shadows/latest/source/docs/shader-cost.md
/// [growth]: https://docs.rs/crate/shadows/latest/source/docs/growth.md
/// [temporal]: https://docs.rs/crate/shadows/latest/source/docs/temporal.md
/// [hard]: https://docs.rs/crate/shadows/latest/source/docs/hard-cases.md
/// [limits]: crate::limits
/// [survey]: https://docs.rs/crate/shadows/latest/source/docs/survey.md
#[cfg(any(doc, doctest))]
#[doc = include_str!("../docs/choosing.md")]
pub mod choosing {}
/// [first]: https://docs.rs/crate/shadows/latest/source/examples/first_shadow.rs
/// [front]: crate#a-complete-host
#[cfg(any(doc, doctest))]
#[doc = include_str!("../docs/adding.md")]
pub mod adding {}
/// [survey]: https://docs.rs/crate/shadows/latest/source/docs/survey.md
/// [hard]: https://docs.rs/crate/shadows/latest/source/docs/hard-cases.md
#[cfg(any(doc, doctest))]
#[doc = include_str!("../docs/limits.md")]
pub mod limits {}

/// What unit tests share with the examples calls this crate by its name.
#[cfg(test)]
extern crate self as shadows;

pub mod blob;
mod clock;
pub mod error;
mod gl;
pub mod light;
pub mod map;
pub mod mesh;
pub mod pcf;
pub mod planar;
pub mod projected;
#[cfg(feature = "reference")]
pub mod reference;
mod runs;
mod scene;
mod shader;
mod submissions;
pub mod support;
mod uploads;
pub mod view;
pub mod volume;
pub mod wgsl;
#[cfg(test)]
mod wgsl_layout;

// For this crate's own tests and tools, which try other arithmetic: no part of its interface.
#[cfg(feature = "reference")]
#[doc(hidden)]
pub use shader::rewriting;

pub use blob::{
    Blob, BlobDecalDescriptor, BlobFrame, BlobLight, BlobShadow, BlobShadowDescriptor,
    BlobStatistics,
};
pub use light::{DirectionalLight, HomogeneousLight, Light, PointLight, SpotLight};
pub use map::{
    AtlasDebug, AtlasDebugDescriptor, AtlasFrame, AtlasLight, AtlasStatistics, AtlasTile,
    AtlasView, Bias, CascadeFit, CascadeSplit, Cascades, CasterSides, CubeCross,
    CubeCrossDescriptor, CubeFace, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor,
    CubeStatistics, DepthBounds, DepthEncoding, FlatLight, HostDraw, LocalLight, MapSettings,
    ShadowAtlas, ShadowAtlasDescriptor, ShadowFrame, ShadowMap, ShadowMapDescriptor,
    ShadowMapStatistics, StaticLayers, TileSize, TileState, TileStatistics, texture_from_clip,
};
pub use mesh::{Caster, CasterMesh, HostInstances, HostMesh, HostPositions, InstanceLayout};
pub use pcf::{
    AnyMap, ContactHardening, FlatLights, Gather, Kernel, LightKinds, MapKind, ModulePlace,
    PcfDescriptor, PcfSampler, Radius, RandomDisk, VogelDisk,
};
pub use planar::{
    LightShape, PlanarFrame, PlanarLight, PlanarOutline, PlanarOutput, PlanarReceiver,
    PlanarRectangle, PlanarShadow, PlanarShadowDescriptor, PlanarSoftFrame, PlanarSoftShadow,
    PlanarSoftShadowDescriptor, PlanarSoftStatistics, PlanarStatistics,
};
pub use projected::{
    ProjectedCaster, ProjectedFrame, ProjectedShadow, ProjectedShadowDescriptor,
    ProjectedStatistics, Projector, ProjectorState,
};
pub use support::{Fallback, Support};
pub use view::{DepthConvention, View};
pub use volume::{
    Caps, CasterState, Counter, DebugColors, ExactCount, ExactCountDescriptor, Extrusion,
    LightJoin, LightJoinDescriptor, Method, ShadowMask, ShadowMaskDescriptor,
    ShadowVolumeDescriptor, ShadowVolumeFrame, ShadowVolumeRenderer, Silhouettes, StartFrom,
    VolumeCone, VolumeDebug, VolumeDebugDescriptor, VolumeLight, VolumePipelines, VolumeStatistics,
    VolumeSurvey, VolumeView,
};
