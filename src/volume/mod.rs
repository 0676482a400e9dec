//! Stencil shadow volumes: exact hard shadows, counted in the stencil buffer.
//!
//! The method that is always right is z-fail ("Carmack's reverse"): a volume's faces count where
//! they lie *behind* the visible point, so that the eye may be inside a volume and the near plane may
//! cut it, as long as the volume is closed and reaches to infinity (Everitt and Kilgard, "Practical
//! and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering", 2002). Where a caster
//! provably needs less, less is drawn of its volume: see [`Method`], [`Caps`] and [`Extrusion`].
//!
//! The volume is the boundary of a chain of light caps, whose coefficients are decided once for
//! each triangle and stored; an edge is extruded as often as that chain's boundary runs through it
//! (Kim, Kim and Lee, "Robust silhouette extraction for shadow volumes of non-manifold models",
//! 2008, called it multiplicity). Closedness therefore does not depend on rounding.

mod buffers;
mod counter;
mod debug;
mod debug_colors;
mod debug_pipelines;
mod descriptor;
mod draw;
mod exact_count;
mod far_end;
mod found;
mod groups;
mod hull;
mod kept;
mod layers;
mod layout;
mod light_pass;
mod limits;
mod mask;
mod method;
mod near_plane;
mod params;
mod plan;
mod regions;
mod renderer;
mod rule;
mod scissor;
mod screen;
mod screen_area;
mod silhouette;
mod skin;
mod start;
mod statistics;
mod subject;
mod survey;
mod targets;
mod world_box;

pub use counter::Counter;
pub use debug::{VolumeDebug, VolumeDebugDescriptor};
pub use debug_colors::DebugColors;
pub use descriptor::{ShadowVolumeDescriptor, ShadowVolumeFrame, VolumeStatistics};
pub use exact_count::{ExactCount, ExactCountDescriptor};
pub use light_pass::{LightJoin, LightJoinDescriptor};
pub use mask::{ShadowMask, ShadowMaskDescriptor};
pub use method::{Caps, Extrusion, Method};
pub use renderer::ShadowVolumeRenderer;
pub use silhouette::Silhouettes;
pub use start::StartFrom;
pub use statistics::CasterState;
pub use survey::VolumeSurvey;
