//! Shadow maps.

mod atlas;
mod bias;
mod cascades;
mod cross;
mod cube;
mod cube_descriptor;
mod encoding;
mod flat;
mod flat_descriptor;
mod gpu;
mod one_light;
mod overlay;
mod plan;
mod projection;
mod settings;
mod sides;
mod static_layers;
mod statistics;

pub use atlas::{
    AtlasDebug, AtlasDebugDescriptor, AtlasFrame, AtlasLight, AtlasStatistics, AtlasTile,
    AtlasView, LocalLight, ShadowAtlas, ShadowAtlasDescriptor,
};
pub use bias::Bias;
pub use cascades::{CascadeFit, CascadeSplit, Cascades, DepthBounds};
pub use cross::{CubeCross, CubeCrossDescriptor};
pub use cube::CubeShadowMap;
pub use cube_descriptor::{CubeFrame, CubeShadowMapDescriptor};
pub use encoding::DepthEncoding;
pub use flat::{ShadowMap, texture_from_clip};
pub use flat_descriptor::{FlatLight, ShadowFrame, ShadowMapDescriptor};
pub use gpu::HostDraw;
pub(crate) use gpu::{
    DynamicUniforms, INSTANCE_SIZE, Instance, LightRecord, UNIFORM_LIGHTS, buffer, instance,
    largest_buffer,
};
pub use plan::TileSize;
pub(crate) use plan::{Place, TileAllocator};
pub use projection::CubeFace;
pub(crate) use projection::{FlatFrame, axes, fit_spot};
pub use settings::MapSettings;
pub use sides::CasterSides;
pub use static_layers::StaticLayers;
pub use statistics::{CubeStatistics, ShadowMapStatistics, TileState, TileStatistics};
