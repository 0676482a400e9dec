//! Errors of cascades.

use thiserror::Error;

/// What can be wrong with the cascades of a directional light.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CascadeError {
    /// No cascades, or too many.
    #[error("{count} cascades are out of range; pass 1 to {limit}")]
    Count {
        /// Cascades asked for.
        count: u32,
        /// The most that work.
        limit: u32,
    },
    /// A field that is a fraction is out of range.
    #[error("{field} = {value} is out of range; pass 0 to {limit}")]
    Share {
        /// The field.
        field: &'static str,
        /// Its value.
        value: f32,
        /// The largest that works.
        limit: f32,
    },
    /// The distance up to which a view shows shadows is out of range.
    #[error("shadow distance {0} is out of range; pass a finite distance above 0")]
    Distance(f32),
    /// The nearest visible distance is out of range.
    #[error(
        "CascadeSplit::Ground::nearest = {0} is out of range; pass a finite distance of at least 0"
    )]
    Nearest(f32),
    /// The visible depths are not a valid range.
    #[error(
        "depths from {nearest} to {farthest} are not a range; pass finite distances, 0 <= nearest <= farthest"
    )]
    DepthBounds {
        /// The least depth passed.
        nearest: f32,
        /// The greatest depth passed.
        farthest: f32,
    },
    /// The cascades have too few texels for the reach of kernels and the margin for camera movement.
    #[error(
        "kernels that reach {reach} texels, and a camera that may move by {margin} of a cascade's width, need cascades of at least {} texels, not {size}: pass a larger size, a smaller reach or a smaller margin",
        (4.0 * (reach + 1.25) / (1.0 - 4.0 * margin)).ceil()
    )]
    ReachOfSize {
        /// Texels that kernels reach.
        reach: f32,
        /// [`Cascades::margin`](crate::map::Cascades::margin).
        margin: f32,
        /// Texels along a side.
        size: u32,
    },
    /// A cascade lies so far from the origin, or is so large or so narrow, that its matrix is not
    /// finite in `f32`.
    #[error(
        "the matrix of cascade {cascade} is not finite in f32: the view or a caster is too far away, or the distance too great; move the scene nearer to the origin, or pass a smaller distance"
    )]
    BeyondF32 {
        /// The cascade, counted from 0.
        cascade: usize,
    },
}
