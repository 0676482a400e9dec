//! How the maps of a directional light divide the visible scene among themselves.

use crate::error::CascadeError;

/// The cascades of a directional light: maps of equal size, each covering what a view shows between two
/// distances, so that texels are smallest near the eye.
///
/// In a perspective view, distances are measured from the eye rather than along the view axis, so none of
/// them changes when the camera turns. An orthographic view shows everything at one scale: distances are
/// measured from its near plane along its direction, up to its far plane regardless of
/// [`distance`](Self::distance), and all cascades are equally long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cascades {
    /// Number of cascades. Default 4. 1 to 8.
    pub count: u32,
    /// Where one ends and the next begins. Default [`CascadeSplit::default`].
    pub split: CascadeSplit,
    /// What each one covers. Default [`CascadeFit::Stable`].
    pub fit: CascadeFit,
    /// Distance up to which shadows are visible, in world units. Default 100. Greater than 0, finite. Beyond
    /// it, as beyond the view's far plane, everything is lit.
    pub distance: f32,
    /// Fraction of each cascade's length, at its far end, over which it blends into the next one. Default
    /// 0.1. 0 (no blending) to 0.5.
    pub blend: f32,
    /// How far the covered region may move before the cascade is placed and drawn again, as a fraction of the
    /// cascade's width. Default 1/32: a cascade 30 units wide stays in place until the camera has moved about
    /// one unit. Texels grow by twice that fraction. 0 (the cascade follows texel by texel) to 1/8.
    pub margin: f32,
}

impl Cascades {
    /// The maximum number of cascades per light and view.
    pub const MOST: u32 = 8;

    /// Checks that every number is in its range.
    pub(crate) fn validate(&self) -> Result<(), CascadeError> {
        if !(1..=Self::MOST).contains(&self.count) {
            return Err(CascadeError::Count {
                count: self.count,
                limit: Self::MOST,
            });
        }
        let lambda = match self.split {
            CascadeSplit::Auto => 0.0,
            CascadeSplit::Practical { lambda } => lambda,
            CascadeSplit::Ground { nearest } => match nearest.is_finite() && nearest >= 0.0 {
                true => 0.0,
                false => return Err(CascadeError::Nearest(nearest)),
            },
        };
        for (field, value, limit) in [
            ("CascadeSplit::Practical::lambda", lambda, 1.0),
            ("Cascades::blend", self.blend, 0.5),
            ("Cascades::margin", self.margin, 0.125),
        ] {
            if !(0.0..=limit).contains(&value) {
                return Err(CascadeError::Share {
                    field,
                    value,
                    limit,
                });
            }
        }
        match self.distance.is_finite() && self.distance > 0.0 {
            true => Ok(()),
            false => Err(CascadeError::Distance(self.distance)),
        }
    }
}

impl Default for Cascades {
    fn default() -> Self {
        Self {
            count: 4,
            split: CascadeSplit::default(),
            fit: CascadeFit::default(),
            distance: 100.0,
            blend: 0.1,
            margin: 1.0 / 32.0,
        }
    }
}

/// The distances at which one cascade ends and the next begins. (An orthographic view shows everything at one
/// scale, so its cascades are equally long whatever the setting.)
///
/// Below, `n` is the distance of the view's near plane, and `f` is the shadow distance or that of the view's
/// far plane; if the host passes [`DepthBounds`], they are the nearest and farthest visible distances
/// instead.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum CascadeSplit {
    /// [`Ground`](Self::Ground) if the host passes [`DepthBounds`], otherwise [`Practical`](Self::Practical)
    /// with `lambda` 0.85.
    #[default]
    Auto,
    /// A mix of logarithmic and uniform splits (Zhang et al., "Parallel-Split Shadow Maps for Large-scale
    /// Virtual Environments", 2006): of m cascades from `n` to `f`, the i-th ends at
    /// `lambda * n * (f / n)^(i / m) + (1 - lambda) * (n + (f - n) * i / m)`.
    ///
    /// For views whose near plane lies far in front of anything visible, when nothing else is known.
    Practical {
        /// 1: each cascade is as many times as far as the one before it, which wastes the first ones where
        /// nothing is near. 0: all are equally long. 0.85: over flat ground seen from 1.7 above it, for
        /// distances of 100 to 1000 and near planes of 0.01 to 1, texels are in the mean at most 1.33 times
        /// as wide in the world as with the best value for each. 0 to 1.
        lambda: f32,
    },
    /// For views whose nearest visible distance is known: minimises the mean size of texels in pixels, over
    /// all pixels that show ground beyond that distance.
    ///
    /// Seen from above, ground at a distance `d` takes up a share of the picture proportional to `1 / d^2`, and
    /// the texels of a cascade that ends at `e` are a number of pixels wide that is proportional to `e / d`.
    /// The mean is smallest if a cascade that ends `r` times as far away as the one before it is followed by
    /// one that ends `(r^2 + 1) / 2` times as far again.
    Ground {
        /// Distance of the nearest surfaces, in world units; what is nearer than that is shadowed by the first
        /// cascade, too. Less than `n` counts as `n`, which is enough where the host passes
        /// [`DepthBounds`]; `f` and more, too. Else about 2 for eyes at a person's height, in metres. Finite, at
        /// least 0.
        nearest: f32,
    },
}

/// What each cascade covers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CascadeFit {
    /// Everything around the eye, up to the cascade's far end. Turning the camera in place changes no
    /// cascade: nothing is redrawn, and no shadow flickers. Moving it shifts them by whole texels, which stay
    /// fixed in the world. (In an orthographic view, a sphere around the slice: turning then shifts the map
    /// by whole texels.)
    ///
    /// Texels are wider than those of a sphere around the visible slice: 1.3 times for a field of view of 100
    /// degrees from corner to corner, 1.7 times for 60, and more for narrower ones. See
    /// [`Tight`](Self::Tight).
    #[default]
    Stable,
    /// Only what is visible, aligned with the light's axes: the smallest texels. They stay fixed in the world
    /// as long as the cascade's width does. The width changes in steps of a quarter octave as the camera
    /// moves and turns; shadow edges then move by up to a texel. For narrow views, still pictures, and lights
    /// that move anyway.
    Tight,
}

/// The range of depths visible in a view's picture, such as the minimum and maximum of its depth buffer.
/// Cascades then divide only that range (Lauritzen et al., "Sample Distribution Shadow Maps", 2010).
///
/// In world units along the view's axis, measured from the eye, or from the near plane of an orthographic
/// view. A host that reads them back from an earlier frame should widen them by the distance that the camera
/// may have moved since: anything visible outside them gets no shadow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthBounds {
    /// The smallest depth; at least 0.
    pub nearest: f32,
    /// The largest depth; finite, at least `nearest`.
    pub farthest: f32,
}

impl DepthBounds {
    pub(crate) fn validate(&self) -> Result<(), CascadeError> {
        let Self { nearest, farthest } = *self;
        match nearest >= 0.0 && nearest <= farthest && farthest.is_finite() {
            true => Ok(()),
            false => Err(CascadeError::DepthBounds { nearest, farthest }),
        }
    }
}
