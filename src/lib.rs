//! Real-time shadows for any engine on wgpu 30.
//!
#![cfg_attr(doc, doc = include_str!("../docs/picture.md"))]
//!
//! The host owns the window, the device, the frame graph and the meshes. This crate takes its
//! device, its meshes and its lights, and hands back bind groups, WGSL and render passes. It never
//! creates a device, submits, polls or blocks, and it holds nothing but shadow textures, pipelines
//! and scratch buffers.
//!
//! | | what it is | what it is for |
//! |---|---|---|
//! | [`CubeShadowMap`] | depth of the casters on six cube faces | point lights, soft edges, many receivers |
//! | [`ShadowMap`] | depth of the casters on one square | spot and directional lights |
//! | [`PcfSampler`] | the kernels by which receivers read a map | one tap to contact hardening, no acne, no seams |
//! | [`ShadowVolumeRenderer`] | stencil shadow volumes | exact to the pixel, point and directional lights |
//! | [`mesh::Adjacency`] | welded edges and their triangles | what volumes need to know of a mesh; any triangles will do |
//! | `reference` (feature) | exact visibility by casting rays in f64 | the error of all of the above |
//!
//! Each type has the same three verbs: `new` for what never changes, `prepare` once a frame for
//! what the CPU decides, `encode` (into the host's encoder) or `render` (into the host's pass) for
//! the GPU.
//!
//! # Dependencies
//!
//! ```toml
//! [dependencies]
//! shadows = "0.1"
//! wgpu = "30"
//! ```
//!
//! Back ends (Vulkan, Metal, Direct3D 12, GL) come with wgpu's default features, and this crate switches on
//! none but `webgpu` on the web: without a dependency of your own on wgpu no adapter is found on any
//! other machine. glam is 0.33, wgpu 30; both are re-exported as `shadows::glam` and `shadows::wgpu`.
//!
//! # A host, complete
//!
//! One triangle above a floor, its shadow both ways. This runs on wgpu's driverless device; a real
//! host differs in how it comes by its device.
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
//! // Once a mesh: who is whose neighbour, then the GPU's copy.
//! let positions = [[-1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.0]];
//! let adjacency = Adjacency::new(&positions, &[0, 1, 2])?;
//! let mesh = CasterMesh::new(&device, &positions, &adjacency)?;
//! let casters = [Caster::new(mesh, Affine3A::IDENTITY)];
//! let light = PointLight::new(Vec3::new(0.0, 4.0, 1.0), 30.0);
//!
//! // A shadow map, and how shaders read it.
//! let mut map = CubeShadowMap::new(&device, &CubeShadowMapDescriptor::default())?;
//! let sampler = PcfSampler::new(&device, &queue, &PcfDescriptor::default())?;
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
//! let frame = CubeFrame { lights: &[light], casters: &casters, ..Default::default() };
//! map.prepare(&device, &queue, &frame)?;
//! let group = sampler.bind_group(&device, &map)?; // again when `map.texture_revision()` changes
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
//! Shadow volumes are exact whatever the mesh: no resolution, no bias, no leak; their cost is the
//! fill of what they draw on screen. Shadow maps cost what their texels cost, whatever the screen
//! shows, and are as exact as their texels are small. `compare`, the example, measures both on your
//! own scene: time beside error.
//!
//! Longer, in the repository: `docs/choosing.md` (which technique, and what each costs and gets
//! wrong), `docs/adding.md` (this crate in an engine, step by step) and `docs/numerics.md` (why it is
//! right).
//!
//! # What a version may add
//!
//! Errors, statistics and choices (enums of a descriptor) are `#[non_exhaustive]`: variants and fields
//! come without a breaking release. Descriptors and frames are made with `..Default::default()` or from
//! their `new`, so that a new field breaks no code; one that takes such a struct apart without `..`
//! asks to be told of it. Lights, [`Bias`], [`mesh::Bounds`] and the parameters of kernels are what they
//! are, and so are [`CubeFace`], [`mesh::MeshKind`] and [`DepthConvention`], which hosts match on.
//!
//! # Features
//!
//! - `reference` (off): exact visibility in f64 for measuring error. Not for frames. It needs Rust 1.89;
//!   everything else 1.88.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub use {glam, wgpu};

/// What unit tests share with the examples calls this crate by its name.
#[cfg(test)]
extern crate self as shadows;

pub mod error;
mod gl;
pub mod light;
pub mod map;
pub mod mesh;
pub mod pcf;
#[cfg(feature = "reference")]
pub mod reference;
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

pub use light::{DirectionalLight, HomogeneousLight, Light, PointLight, SpotLight};
pub use map::{
    Allocation, AtlasFrame, AtlasLight, AtlasStatistics, AtlasTile, AtlasView, Bias, CascadeFit,
    CascadeSplit, Cascades, CasterSides, CubeCross, CubeCrossDescriptor, CubeFace, CubeFrame,
    CubeShadowMap, CubeShadowMapDescriptor, CubeStatistics, DepthBounds, DepthEncoding, FaceState,
    FaceStatistics, FlatLight, HostDraw, LocalLight, ShadowAtlas, ShadowAtlasDescriptor,
    ShadowFrame, ShadowMap, ShadowMapDescriptor, ShadowMapStatistics, StaticLayers, TileSize,
    texture_from_clip,
};
pub use mesh::{Caster, CasterMesh, HostMesh, HostPositions};
pub use pcf::{
    AnyMap, ContactHardening, FlatLights, Gather, Kernel, MapKind, PcfDescriptor, PcfSampler,
    Radius, RandomDisk, VogelDisk,
};
pub use support::{Fallback, Support};
pub use view::{DepthConvention, View};
pub use volume::{
    Caps, CasterState, Counter, DebugColors, ExactCount, ExactCountDescriptor, Extrusion,
    LightJoin, LightJoinDescriptor, Method, ShadowMask, ShadowMaskDescriptor,
    ShadowVolumeDescriptor, ShadowVolumeFrame, ShadowVolumeRenderer, Silhouettes, StartFrom,
    VolumeDebug, VolumeDebugDescriptor, VolumeLight, VolumePipelines, VolumeStatistics,
    VolumeSurvey, VolumeView,
};
