//! How the maps of a directional light share out what a view shows.

use crate::error::CascadeError;

/// The cascades of a directional light: maps of equal size, each for what a view shows between two
/// distances, so that what is near the eye gets the small texels.
///
/// A view in perspective counts distances from its eye, not along its axis, so that none changes when
/// the camera turns. All of an orthographic view is seen at one scale: it counts from its near plane
/// along its direction, up to its far plane whatever [`distance`](Self::distance) is, and its cascades
/// are equally long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cascades {
    /// How many. Default 4. 1 to 8.
    pub count: u32,
    /// Where one ends and the next begins. Default [`CascadeSplit::default`].
    pub split: CascadeSplit,
    /// What each one covers. Default [`CascadeFit::Stable`].
    pub fit: CascadeFit,
    /// Distance up to which shadows are to be seen, in world units. Default 100. Greater than 0, finite.
    /// Beyond it, as beyond the view's far plane, all is lit.
    pub distance: f32,
    /// Share of each cascade's length, at its far end, in which it turns into the next one. Default 0.1.
    /// 0 (the next one begins where it ends) to 0.5.
    pub blend: f32,
    /// Share of a cascade's width by which what it covers may move before it is placed and drawn anew.
    /// Default 1/32: a cascade 30 units wide stays as it is until the camera has walked about one. Its
    /// texels are by twice that share wider. 0 (it follows texel by texel) to 1/8.
    pub margin: f32,
}

impl Cascades {
    /// The most cascades of one light and view.
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

/// The distances at which one cascade ends and the next begins. (An orthographic view sees all at one scale:
/// there cascades are equally long whatever is asked.)
///
/// Below, `n` is the distance of the view's near plane and `f` the shadows' or the view's far plane's; the
/// nearest and farthest that is seen, where the host says so ([`DepthBounds`]).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum CascadeSplit {
    /// [`Ground`](Self::Ground) where the host says what is seen ([`DepthBounds`]), else
    /// [`Practical`](Self::Practical) with `lambda` 0.85.
    #[default]
    Auto,
    /// Between two rules (Zhang et al., "Parallel-Split Shadow Maps for Large-scale Virtual
    /// Environments", 2006): of m cascades from `n` to `f`, the i-th ends at
    /// `lambda * n * (f / n)^(i / m) + (1 - lambda) * (n + (f - n) * i / m)`.
    ///
    /// For views of which only the near plane is known, which lies far before all that is seen.
    Practical {
        /// 1: each cascade is as many times as far as the one before it, which wastes the first ones where
        /// nothing is near. 0: all are equally long. 0.85: over flat ground seen from 1.7 above it, for
        /// distances of 100 to 1000 and near planes of 0.01 to 1, texels are in the mean at most 1.33 times
        /// as wide in the world as with the best value for each. 0 to 1.
        lambda: f32,
    },
    /// For a view of which it is known where what it shows begins: texels are as few pixels wide as can be, in
    /// the mean over the pixels that show ground from there on.
    ///
    /// Of ground that is seen from above it, a distance `d` takes a share of the picture of `1 / d^2`, and the
    /// texels of a cascade that ends at `e` are `e / d` as many pixels wide. The mean is least where each
    /// cascade ends `r` times as far as the one before it, and the next one `(r^2 + 1) / 2` times as far again.
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
    /// All around the eye, up to the cascade's far end. A camera that turns in place changes no
    /// cascade: none is drawn anew, and no shadow flickers. One that walks moves them by whole texels
    /// that stay where they are in the world. (Of an orthographic view, a sphere around the slice: there a
    /// turn moves the map by whole texels.)
    ///
    /// Texels are wider than those of a sphere around what is seen: 1.3 times if that is 100 degrees wide
    /// from corner to corner, 1.7 times at 60, and more at less. See [`Tight`](Self::Tight).
    #[default]
    Stable,
    /// What is seen, in the light's axes: the smallest texels. They stay where they are in the world
    /// while the cascade's width does, which goes in steps of a quarter octave as the camera moves and
    /// turns; shadow edges move by up to a texel then. For narrow views, still pictures, and lights
    /// that move anyway.
    Tight,
}

/// The depths between which a view's picture shows anything, such as the least and the greatest of its
/// depth buffer: cascades then divide no more than that (Lauritzen et al., "Sample Distribution Shadow
/// Maps", 2010).
///
/// In world units along the view's axis, from the eye; of an orthographic view from its near plane. A
/// host that reads them back from an earlier frame adds what the camera may have moved since: what is
/// seen outside them gets no shadow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthBounds {
    /// The least depth; at least 0.
    pub nearest: f32,
    /// The greatest depth; finite, no less than `nearest`.
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
