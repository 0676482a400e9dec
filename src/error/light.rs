//! Errors of lights and cameras.

use thiserror::Error;

/// What can be wrong with a light.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LightError {
    /// A coordinate is NaN or infinite.
    #[error("light position {0:?} is not finite")]
    Position([f32; 3]),
    /// The range is NaN, infinite, zero, negative, or smaller than the least normal `f32`.
    #[error("light range {0} is out of range; pass a finite distance above 0, at least 1.2e-38")]
    Range(f32),
    /// The near distance is not between 0 and the range, or so small relative to it that the depth at
    /// the range is 0.
    #[error(
        "light near {near} is out of range; pass None, or 0 < near < range = {range} and no less \
         than 1.2e-38 of that"
    )]
    Near {
        /// The near distance passed.
        near: f32,
        /// The range passed.
        range: f32,
    },
    /// The homogeneous coordinate is neither 0 nor 1.
    #[error("light w = {0}; pass 1 for a point light, 0 for a directional light")]
    Homogeneous(f32),
    /// A directional light without a direction.
    #[error("a directional light needs a direction; (0, 0, 0) was passed")]
    Direction,
    /// A spot light without a direction.
    #[error("spot direction {0:?} is invalid; pass a finite vector other than (0, 0, 0)")]
    SpotDirection([f32; 3]),
    /// The cone angle of a spot light is out of range.
    #[error("spot half_angle {0} is out of range; pass radians, 0 < half_angle < pi / 2")]
    HalfAngle(f32),
}

/// What can be wrong with the host's camera.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ViewError {
    /// An entry is NaN or infinite.
    #[error("clip_from_world holds an entry that is not finite: {0:?}")]
    NotFinite([f32; 16]),
    /// The matrix has no eye: its x, y and w rows are linearly dependent.
    #[error("clip_from_world is singular: its x, y and w rows do not fix an eye")]
    Singular,
    /// The matrix's z row does not match the specified depth convention.
    #[error(
        "clip_from_world does not map depth as {0:?} does; pass the convention it was built with"
    )]
    Depth(crate::DepthConvention),
}
