//! What maps have on the GPU: textures, pipelines, draw lists, uniforms, and the passes.

mod atlas;
mod atlas_lights;
mod atlas_texture;
mod buffers;
mod casting;
mod cube;
mod cube_lights;
mod draws;
mod encode;
mod flat_light;
mod instances;
mod light_record;
mod pipelines;
mod static_layers;
mod texture;
mod tile_fill;
mod uniforms;

pub use atlas::HostDraw;
pub(crate) use atlas::{AtlasGpu, AtlasKind, DrawByHost, Tiled};
pub(crate) use atlas_texture::Resized;
pub(crate) use buffers::buffer;
pub(crate) use casting::Casting;
pub(crate) use cube::CubeGpu;
pub(crate) use cube_lights::UNIFORM_LIGHTS;
pub(crate) use draws::Draw;
pub(crate) use encode::begin_depth_pass;
pub(crate) use flat_light::FlatLightBuffer;
pub(crate) use instances::{INSTANCE_SIZE, Instance, TooLarge, instance};
pub(crate) use light_record::{LightRecord, TilePlace, TileTexture, Tiles};
pub(crate) use pipelines::{PipelineKind, can_pull_casters};
pub(crate) use texture::{array_view, create_texture, layer_view};
pub(crate) use uniforms::{UNIFORM_STRIDE, most_tiles};
