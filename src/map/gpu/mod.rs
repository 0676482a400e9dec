//! What maps have on the GPU: textures, pipelines, draw lists, uniforms, and the passes.

mod atlas;
mod atlas_lights;
mod atlas_texture;
mod buffers;
mod casting;
mod draws;
mod dynamic_uniforms;
mod encode;
mod host_draw;
mod instances;
mod light_buffer;
mod light_record;
mod one_light;
mod pipelines;
mod static_layers;
mod texture;
mod tile_fill;
mod tile_uniform;

pub(crate) use atlas::{AtlasGpu, AtlasKind, Tiled};
pub(crate) use atlas_lights::UNIFORM_LIGHTS;
pub(crate) use atlas_texture::Resized;
pub(crate) use buffers::{buffer, largest_buffer};
pub(crate) use draws::Draw;
pub(crate) use dynamic_uniforms::DynamicUniforms;
pub(crate) use host_draw::DrawByHost;
pub use host_draw::HostDraw;
pub(crate) use instances::{INSTANCE_SIZE, Instance, TooLarge, instance};
pub(crate) use light_record::{LightRecord, TileTexture, Tiles};
pub(crate) use one_light::{OneLightGpu, OneLightKind};
pub(crate) use pipelines::{PipelineKind, can_pull_casters};
pub(crate) use texture::cube_view;
