//! The error of a technique: its picture against the reference.

use std::fmt;

use rayon::prelude::*;

use super::image::{Class, ReferenceImage};
use super::interior::{Interior, Radius};
use crate::error::ReferenceError;

/// The visibility of one pixel in a technique's picture: `f32` from 0 to 1, or `u8` from 0 to 255.
pub trait Visibility: Copy + Sync {
    /// 0 in shadow, 1 lit.
    fn fraction(self) -> f32;
}

impl Visibility for f32 {
    fn fraction(self) -> f32 {
        self
    }
}

impl Visibility for u8 {
    fn fraction(self) -> f32 {
        f32::from(self) / 255.0
    }
}

/// The result for one pixel of a technique. Exhaustive: right, or wrong in one of two ways at one of two
/// places.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// No surface that faces the light within its range.
    NotCounted,
    /// Agrees with the reference.
    Right,
    /// Lit where the reference is in shadow, at an edge.
    FalseLit,
    /// In shadow where the reference is lit, at an edge.
    FalseShadow,
    /// Lit where the reference is in shadow, in the interior.
    FalseLitInterior,
    /// In shadow where the reference is lit, in the interior.
    FalseShadowInterior,
}

/// The error of a technique in pixels. Only pixels whose surface faces the light count.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub struct Comparison {
    /// Pixels that count: the reference says [`Class::Lit`] or [`Class::Shadowed`].
    pub lit_facing: usize,
    /// Pixels that are lit (visibility 0.5 or more) where the reference is in shadow.
    pub false_lit: usize,
    /// Pixels that are in shadow (visibility below 0.5) where the reference is lit.
    pub false_shadow: usize,
    /// The part of `false_lit` that is in the interior.
    pub false_lit_interior: usize,
    /// The part of `false_shadow` that is in the interior.
    pub false_shadow_interior: usize,
    /// Root mean square difference between the visibility and the reference's 0 or 1; 0 if no pixel counts.
    pub rmse: f64,
    /// One verdict per pixel, row-major from the top left, for a picture of the error.
    pub verdicts: Vec<Verdict>,
}

/// Everything but the verdicts: a picture is no reading matter.
impl fmt::Debug for Comparison {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Comparison")
            .field("lit_facing", &self.lit_facing)
            .field("false_lit", &self.false_lit)
            .field("false_shadow", &self.false_shadow)
            .field("false_lit_interior", &self.false_lit_interior)
            .field("false_shadow_interior", &self.false_shadow_interior)
            .field("rmse", &self.rmse)
            .finish_non_exhaustive()
    }
}

impl ReferenceImage {
    /// Compares a technique's visibility, one value per pixel, row-major from the top left.
    ///
    /// Rays that tell interior from edge are cast only for wrong pixels, and remembered.
    ///
    /// # Errors
    /// [`ReferenceError`] if there is not one visibility per pixel, if one that counts is NaN or outside 0 to
    /// 1, or if `interior` specifies a cube map for a directional light or without texels.
    pub fn compare<V: Visibility>(
        &self,
        visibility: &[V],
        interior: Interior,
    ) -> Result<Comparison, ReferenceError> {
        let (passed, pixels) = (visibility.len(), self.pixels.len());
        if passed != pixels {
            return Err(ReferenceError::VisibilityCount { passed, pixels });
        }
        let radius = interior.radius(self.lighting.light.w == 0.0)?;
        let square_error = self.square_error(visibility)?;
        let verdicts: Vec<Verdict> = (0..pixels)
            .into_par_iter()
            .map(|pixel| self.verdict(pixel, visibility[pixel].fraction(), radius))
            .collect();
        Ok(tally(verdicts, square_error))
    }

    /// The number of pixels facing the light that are in the interior.
    ///
    /// For [`Interior::Map`] this casts about 40 rays per pixel, more with a wider kernel.
    ///
    /// # Errors
    /// [`ReferenceError::Interior`], as with [`compare`](Self::compare).
    pub fn interior_pixels(&self, interior: Interior) -> Result<usize, ReferenceError> {
        let radius = interior.radius(self.lighting.light.w == 0.0)?;
        Ok((0..self.pixels.len())
            .into_par_iter()
            .filter(|&pixel| self.pixels[pixel].class.faces_light())
            .filter(|&pixel| self.is_interior(pixel, radius))
            .count())
    }

    /// The sum of squared differences, in the order of the pixels so that it is the same each time.
    fn square_error<V: Visibility>(&self, visibility: &[V]) -> Result<f64, ReferenceError> {
        let mut sum = 0.0;
        for (pixel, (class, visibility)) in self.classes().zip(visibility).enumerate() {
            if class.faces_light() {
                let value = visibility.fraction();
                if !(0.0..=1.0).contains(&value) {
                    return Err(ReferenceError::Visibility { pixel, value });
                }
                let truth = if class == Class::Lit { 1.0 } else { 0.0 };
                sum += (f64::from(value) - truth).powi(2);
            }
        }
        Ok(sum)
    }

    fn verdict(&self, pixel: usize, visibility: f32, radius: Option<Radius>) -> Verdict {
        let lit = visibility >= 0.5;
        let inside = || self.is_interior(pixel, radius);
        match (self.pixels[pixel].class, lit) {
            (Class::Background | Class::Away | Class::OutOfRange, _) => Verdict::NotCounted,
            (Class::Lit, true) | (Class::Shadowed, false) => Verdict::Right,
            (Class::Lit, false) if inside() => Verdict::FalseShadowInterior,
            (Class::Lit, false) => Verdict::FalseShadow,
            (Class::Shadowed, true) if inside() => Verdict::FalseLitInterior,
            (Class::Shadowed, true) => Verdict::FalseLit,
        }
    }
}

fn tally(verdicts: Vec<Verdict>, square_error: f64) -> Comparison {
    let count = |wanted| {
        verdicts
            .iter()
            .filter(|&&verdict| verdict == wanted)
            .count()
    };
    let lit_facing = verdicts.len() - count(Verdict::NotCounted);
    let false_lit_interior = count(Verdict::FalseLitInterior);
    let false_shadow_interior = count(Verdict::FalseShadowInterior);
    Comparison {
        lit_facing,
        false_lit: count(Verdict::FalseLit) + false_lit_interior,
        false_shadow: count(Verdict::FalseShadow) + false_shadow_interior,
        false_lit_interior,
        false_shadow_interior,
        rmse: (square_error / lit_facing.max(1) as f64).sqrt(),
        verdicts,
    }
}
