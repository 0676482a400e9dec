//! Approximate shadows: an ellipsoid for each caster.

mod buffer;
mod decals;
mod descriptor;
mod ellipsoid;
mod frame;
mod principal;
mod receivers;
mod records;
mod shadow;
mod statistics;

pub use descriptor::{BlobDecalDescriptor, BlobShadowDescriptor};
pub use ellipsoid::Blob;
pub use frame::{BlobFrame, BlobLight};
pub use shadow::BlobShadow;
pub use statistics::BlobStatistics;
