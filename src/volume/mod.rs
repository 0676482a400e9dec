//! Stencil shadow volumes: exact hard shadows, counted in the stencil buffer.
//!
//! The method is z-fail ("Carmack's reverse"): a volume's faces count where they lie *behind* the
//! visible point, so that the eye may be inside a volume and the near plane may cut it, as long as
//! the volume is closed and reaches to infinity (Everitt and Kilgard, "Practical and Robust
//! Stenciled Shadow Volumes for Hardware-Accelerated Rendering", 2002).
//!
//! The volume is the boundary of a chain of light caps, whose coefficients are decided once for
//! each triangle and stored; an edge is extruded as often as that chain's boundary runs through it
//! (Kim, Kim and Lee, "Robust silhouette extraction for shadow volumes of non-manifold models",
//! 2008, called it multiplicity). Closedness therefore does not depend on rounding.

mod buffers;
mod descriptor;
mod draw;
mod groups;
mod kept;
mod layout;
mod light_pass;
mod limits;
mod mask;
mod params;
mod plan;
mod regions;
mod renderer;
mod rule;
mod screen;
mod silhouette;

pub use descriptor::{ShadowVolumeDescriptor, ShadowVolumeFrame, VolumeStatistics};
pub use light_pass::{LightJoin, LightJoinDescriptor};
pub use mask::{ShadowMask, ShadowMaskDescriptor};
pub use renderer::ShadowVolumeRenderer;
pub use silhouette::Silhouettes;
