//! What planar shadows have on the GPU.

mod outline;
mod pipelines;
mod uniforms;

pub(crate) use outline::OutlineGpu;
pub(crate) use pipelines::{CastKey, CastPipelines, Marking, MarkingPipelines, PassFormats};
pub(crate) use uniforms::PlanarUniform;
