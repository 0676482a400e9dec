//! Where a flat map lies, found anew only when what it is asked for has changed.

use crate::error::ShadowMapError;
use crate::map::flat_descriptor::{FlatLight, ShadowFrame};
use crate::map::projection::{
    Fit, FlatFrame, LightBox, LightProjection, MapShape, NearPlane, Placed, fit_directional,
    fit_spot,
};
use crate::mesh::Bounds;
use crate::scene::{Casters, Record};
use crate::{DirectionalLight, Radius, View};

/// All of a frame but its casters.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Asked {
    light: FlatLight,
    view: Option<(View, f32)>,
    receivers: Option<Bounds>,
}

impl Asked {
    fn of(frame: &ShadowFrame<'_>) -> Self {
        Self {
            light: frame.light,
            view: frame.view.map(|(view, distance)| (*view, distance)),
            receivers: frame.receivers,
        }
    }
}

/// The place of a map in the world.
#[derive(Debug)]
pub(crate) struct FlatPlace {
    shape: MapShape,
    near_plane: NearPlane,
    /// What the last frame asked for, and where the map lies for it.
    asked: Option<Asked>,
    frame: Option<FlatFrame>,
    /// Where a directional light's map was placed.
    placed: Option<Placed>,
    /// The box around all casters, as a light sees them.
    caster_box: Option<(DirectionalLight, Option<LightBox>)>,
}

impl FlatPlace {
    /// `unclipped_depth`: whether casters before the near plane are pulled onto it.
    pub fn new(size: u32, reach: Radius, near_plane: NearPlane, unclipped_depth: bool) -> Self {
        Self {
            shape: MapShape {
                size,
                reach,
                unclipped_depth,
            },
            near_plane,
            asked: None,
            frame: None,
            placed: None,
            caster_box: None,
        }
    }

    /// The frame of the map; `None` where nothing casts.
    pub fn frame(&self) -> Option<&FlatFrame> {
        self.frame.as_ref()
    }

    /// Finds where the map lies for a frame, after the casters were updated.
    pub fn take_over(
        &mut self,
        frame: &ShadowFrame<'_>,
        casters: &Casters,
    ) -> Result<(), ShadowMapError> {
        let asked = Asked::of(frame);
        let unchanged = casters.changes().len() == 0;
        if unchanged && self.asked == Some(asked) {
            return Ok(());
        }
        // Until all of it has succeeded, nothing is known to be what it was.
        self.asked = None;
        if !unchanged {
            self.caster_box = None;
        }
        self.place(frame, casters.records())?;
        self.asked = Some(asked);
        Ok(())
    }

    /// The light's only tile.
    pub fn projection(&self) -> LightProjection {
        match self.frame {
            Some(frame) if frame.perspective => LightProjection::Spot(frame),
            frame => LightProjection::Cascades(Box::new([frame])),
        }
    }

    fn place(&mut self, frame: &ShadowFrame<'_>, casters: &[Record]) -> Result<(), ShadowMapError> {
        let (lies, placed) = match &frame.light {
            FlatLight::Spot(light) => {
                let near = self.near_plane.of_spot(light);
                (Some(fit_spot(light, near)), self.placed)
            }
            FlatLight::Directional(light) => fit_directional(&Fit {
                light,
                view: frame.view,
                receivers: frame.receivers,
                shape: self.shape,
                casters: self.caster_box(light, casters),
                last: self.placed,
            })
            .unzip(),
        };
        if lies.is_some_and(|frame| !frame.fits_f32()) {
            return Err(ShadowMapError::BeyondF32);
        }
        (self.frame, self.placed) = (lies, placed);
        Ok(())
    }

    /// The box around all casters as a light sees them, which a camera that moves does not change.
    fn caster_box(&mut self, light: &DirectionalLight, casters: &[Record]) -> Option<LightBox> {
        match self.caster_box {
            Some((of, known)) if of == *light => known,
            _ => {
                let found = LightBox::of_casters(light, casters);
                self.caster_box = Some((*light, found));
                found
            }
        }
    }
}
