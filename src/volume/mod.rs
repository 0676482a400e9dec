//! Stencil shadow volumes: exact hard shadows, counted in the stencil buffer.
//!
//! The method that is always correct is z-fail ("Carmack's reverse"): a volume's faces are counted where they
//! lie *behind* the visible point. The eye may be inside a volume and the near plane may intersect it, as
//! long as the volume is closed and extends to infinity (Everitt and Kilgard, "Practical and Robust Stenciled
//! Shadow Volumes for Hardware-Accelerated Rendering", 2002). Where a caster provably needs less, less is
//! drawn of its volume: see [`Method`] and `docs/numerics.md`.
//!
//! The volume is the boundary of a chain of light caps, whose coefficients are computed once per triangle and
//! stored; an edge is extruded as many times as that chain's boundary contains it (its multiplicity, in the
//! terms of Kim, Kim and Lee, "Robust silhouette extraction for shadow volumes of non-manifold models",
//! 2008). Rounding therefore cannot open a volume.

mod debug;
mod decide;
mod descriptor;
mod frame;
mod gpu;
pub(crate) mod light_pass;
mod multiview;
mod plan;
mod renderer;
mod silhouette;
mod statistics;

pub use debug::colors::DebugColors;
pub use debug::survey::VolumeSurvey;
pub use debug::views::{VolumeDebug, VolumeDebugDescriptor};
pub use decide::method::{Caps, Extrusion, Method};
pub use decide::start::StartFrom;
pub use descriptor::ShadowVolumeDescriptor;
pub use frame::{ShadowVolumeFrame, VolumeCone, VolumeLight, VolumeView};
pub use gpu::counter::Counter;
pub use gpu::pipelines::VolumePipelines;
pub use light_pass::exact_count::{ExactCount, ExactCountDescriptor};
pub use light_pass::join::{LightJoin, LightJoinDescriptor};
pub use light_pass::mask::{ShadowMask, ShadowMaskDescriptor};
pub use renderer::ShadowVolumeRenderer;
pub use silhouette::Silhouettes;
pub use statistics::{CasterState, VolumeStatistics};
