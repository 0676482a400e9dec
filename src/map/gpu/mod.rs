//! What maps have on the GPU: textures, pipelines, draw lists, uniforms, and the passes.

mod buffers;
mod cube;
mod cube_lights;
mod draws;
mod encode;
mod flat_light;
mod instances;
#[allow(dead_code)] // the atlas writes them
mod light_record;
mod pipelines;
mod static_layers;
mod texture;
mod uniforms;

pub(crate) use cube::CubeGpu;
pub(crate) use cube_lights::LightUniform;
pub(crate) use draws::{Draw, draws_of_flat};
pub(crate) use encode::{Drawing, begin_depth_pass};
pub(crate) use flat_light::{FlatLightBuffer, FlatLightUniform};
pub(crate) use instances::{INSTANCE_SIZE, Instances, TooLarge};
pub(crate) use pipelines::{PipelineKind, Pipelines, can_pull_casters};
pub(crate) use texture::create_texture;
pub(crate) use uniforms::{FaceUniform, FaceUniforms, most_tiles};
