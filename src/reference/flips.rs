//! How a technique's picture shimmers: pixels that change between frames without a reason.

use super::compare::Visibility;
use super::image::{Class, ReferenceImage};
use crate::error::ReferenceError;

/// Pixels that change between two frames although the truth does not; made by
/// [`ReferenceImage::flips`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Flips {
    /// Pixels that count: their surface faces the light, within range, in both frames.
    pub pixels: usize,
    /// Pixels that are lit in one frame and in shadow in the other according to the reference. They are not
    /// errors and are not included below.
    pub of_reference: usize,
    /// Pixels that the technique shows lit (visibility 0.5 or more) in one frame and in shadow in the other,
    /// although the reference does not change.
    pub excess: usize,
    /// Pixels whose visibility changes by more than 0.5, although the reference does not change: for kernels
    /// with soft edges, whose values often cross 0.5 without being noticed. At most `excess`.
    pub jumps: usize,
}

/// One pixel in one frame.
struct State {
    truth: Class,
    shown: f32,
}

impl State {
    fn is_lit(&self) -> bool {
        self.shown >= 0.5
    }
}

impl ReferenceImage {
    /// The pixels that flip between the frame `before` and this one. Each frame is a reference with a
    /// technique's visibility, one value per pixel, row-major from the top left.
    ///
    /// `moved` is how many pixels the picture moved in between, to the right and down: what was seen at `x`
    /// is now seen at `x + moved`. It is `[0, 0]` if the camera does not move, and also if it moves in any
    /// other way; pixels that now see another surface are then compared as well, each with the truth about
    /// its own surface.
    ///
    /// Correct pictures never flip, whatever moves; neither do pictures that do not change.
    ///
    /// # Errors
    /// [`ReferenceError`] if the two pictures differ in size, if there is not one visibility per
    /// pixel, or if one that counts is NaN or outside 0 to 1.
    pub fn flips<V: Visibility>(
        &self,
        visibility: &[V],
        before: (&Self, &[V]),
        moved: [i32; 2],
    ) -> Result<Flips, ReferenceError> {
        let size = |image: &Self| [image.width, image.height];
        if size(before.0) != size(self) {
            return Err(ReferenceError::OtherSize {
                before: size(before.0),
                now: size(self),
            });
        }
        for (image, visibility) in [before, (self, visibility)] {
            let (passed, pixels) = (visibility.len(), image.pixels.len());
            if passed != pixels {
                return Err(ReferenceError::VisibilityCount { passed, pixels });
            }
        }
        let mut flips = Flips::default();
        for pixel in 0..self.pixels.len() {
            if let Some(origin) = self.origin(pixel, moved) {
                let was = before.0.state(before.1, origin)?;
                flips.add(&was, &self.state(visibility, pixel)?);
            }
        }
        Ok(flips)
    }

    fn state<V: Visibility>(
        &self,
        visibility: &[V],
        pixel: usize,
    ) -> Result<State, ReferenceError> {
        let (truth, shown) = (self.pixels[pixel].class, visibility[pixel].fraction());
        if truth.faces_light() && !(0.0..=1.0).contains(&shown) {
            return Err(ReferenceError::Visibility {
                pixel,
                value: shown,
            });
        }
        Ok(State { truth, shown })
    }

    /// The pixel that was moved to this one, if it was inside.
    fn origin(&self, pixel: usize, moved: [i32; 2]) -> Option<usize> {
        let width = self.width as usize;
        let came = |at: usize, moved: i32, side: u32| {
            let at = i64::try_from(at).ok()? - i64::from(moved);
            (0..i64::from(side)).contains(&at).then_some(at as usize)
        };
        let x = came(pixel % width, moved[0], self.width)?;
        let y = came(pixel / width, moved[1], self.height)?;
        Some(y * width + x)
    }
}

impl Flips {
    fn add(&mut self, before: &State, now: &State) {
        if !(before.truth.faces_light() && now.truth.faces_light()) {
            return;
        }
        self.pixels += 1;
        if before.truth != now.truth {
            self.of_reference += 1;
            return;
        }
        if before.is_lit() != now.is_lit() {
            self.excess += 1;
            self.jumps += usize::from((now.shown - before.shown).abs() > 0.5);
        }
    }
}
