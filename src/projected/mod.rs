//! Projected shadows: the share of light that casters let through, as a texture that receivers read.

mod descriptor;
mod draws;
mod fit;
mod passes;
mod pipelines;
mod plan;
mod receivers;
mod record;
mod shadow;
mod statistics;
mod texture;

pub use descriptor::{ProjectedCaster, ProjectedFrame, ProjectedShadowDescriptor, Projector};
pub use shadow::ProjectedShadow;
pub use statistics::{ProjectedStatistics, ProjectorState};
