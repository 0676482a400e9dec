//! What has a slot in an atlas: lights, each for what it shows, and where its tiles lie.

use super::ShadowAtlas;
use super::descriptor::{AtlasFrame, AtlasLight, AtlasView};
use super::suns::{Sun, Suns};
use crate::Light;
use crate::error::ShadowAtlasError;
use crate::map::gpu::TooLarge;
use crate::map::plan::{Claim, LitSphere, Screen, importance};
use crate::map::projection::{LightProjection, SlotLight, fit_spot};

/// One light for one view: what has a slot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<'a> {
    /// Its place in the frame.
    pub index: usize,
    pub light: &'a AtlasLight,
    /// For directional lights, if the frame has any.
    pub view: Option<(usize, &'a AtlasView<'a>)>,
    /// Its number among directional lights.
    pub sun: Option<usize>,
}

impl ShadowAtlas {
    /// The records that shaders read: one for each light and view, and one for each further cascade.
    pub(super) fn count_records(&self, frame: &AtlasFrame<'_>) -> Result<usize, ShadowAtlasError> {
        let views = frame.views.len().max(1);
        let further = |light: &AtlasLight| match light.light() {
            Light::Directional(_) => views * (Suns::tiles(light, frame.views.first()) - 1),
            _ => 0,
        };
        let records = views * frame.lights.len() + frame.lights.iter().map(further).sum::<usize>();
        let limit = self.gpu.lights().limit();
        match records <= limit {
            true => Ok(records),
            false => Err(ShadowAtlasError::TooManyLights { records, limit }),
        }
    }

    /// Whether one buffer of the device holds the matrices of all that has a slot.
    pub(super) fn check_matrices(
        &self,
        device: &wgpu::Device,
        entries: &[Entry<'_>],
    ) -> Result<(), ShadowAtlasError> {
        let lights = entries.len();
        let checked = self.gpu.check_slots(device, lights);
        checked.map_err(
            |TooLarge { size, limit }| ShadowAtlasError::TooManyMatrices {
                lights,
                size,
                limit,
            },
        )
    }

    /// Finds what every light's tiles show and where they lie. Tells the slots whose tiles were elsewhere
    /// before.
    pub(super) fn take_over(
        &mut self,
        frame: &AtlasFrame<'_>,
        entries: &[Entry<'_>],
    ) -> Result<Vec<usize>, ShadowAtlasError> {
        let before: Vec<Option<u32>> = (0..entries.len())
            .map(|entry| self.residents.size(self.slots.of_light(entry)?))
            .collect();
        let size = |entry: usize, of: &Entry<'_>| before[entry].unwrap_or(of.light.size().most());
        let mut projections = Vec::with_capacity(entries.len());
        self.spots.resize(entries.len(), None);
        for (place, entry) in entries.iter().enumerate() {
            projections.push(SlotLight {
                projection: self.project(frame, (place, entry), size(place, entry))?,
                filter: entry.light.filter(),
            });
        }
        self.suns
            .keep(entries.iter().filter(|of| of.sun.is_some()).count());
        self.slots.grow(entries.len());
        self.slots.take_over(&projections, &mut self.casters);
        let claims = self.claims(frame, entries);
        let had: Vec<bool> = (0..self.slots.len())
            .map(|slot| self.residents.size(slot).is_some())
            .collect();
        let moved = self.residents.settle(self.slots.len(), &claims);
        let mut moved = moved.map_err(ShadowAtlasError::Space)?;
        // Before anything is refused: the next frame does not hear of these moves.
        for &slot in &moved {
            self.slots[slot].texels_freed();
        }
        // A directional light's tiles lie on a grid of texels, so where depends on their size.
        for (place, entry) in entries.iter().enumerate() {
            let Some(slot) = self.slots.of_light(place).filter(|_| entry.sun.is_some()) else {
                continue;
            };
            let granted = self.residents.size(slot);
            if let Some(granted) = granted.filter(|&granted| granted != size(place, entry)) {
                let projection = self.project(frame, (place, entry), granted)?;
                self.slots.refit(slot, projection, &self.casters);
            }
        }
        // Those that are new can wait, as they are dark already.
        moved.retain(|&slot| had[slot] && self.residents.size(slot).is_some());
        Ok(moved)
    }

    /// What a light's tiles show.
    fn project(
        &mut self,
        frame: &AtlasFrame<'_>,
        (place, entry): (usize, &Entry<'_>),
        size: u32,
    ) -> Result<LightProjection, ShadowAtlasError> {
        match (entry.light.light(), entry.sun) {
            (Light::Point(light), _) => Ok(LightProjection::Point(light)),
            (Light::Spot(light), _) => {
                if let Some((_, frame)) = self.spots[place].filter(|(last, _)| *last == light) {
                    return Ok(LightProjection::Spot(frame));
                }
                let near = self.gpu.near_plane().of_spot(&light);
                let frame = fit_spot(&light, near);
                match frame.fits_f32() {
                    true => {
                        self.spots[place] = Some((light, frame));
                        Ok(LightProjection::Spot(frame))
                    }
                    false => Err(ShadowAtlasError::BeyondF32 { index: entry.index }),
                }
            }
            (Light::Directional(light), number) => {
                let sun = Sun {
                    index: entry.index,
                    light,
                    cascades: entry.light.cascades(),
                    view: entry.view.map(|(_, view)| view),
                    size,
                };
                let records = self.casters.records();
                self.suns.fit(number.unwrap_or(0), &sun, frame, records)
            }
        }
    }

    /// The lights that are to have tiles: those to which anything casts.
    fn claims(&mut self, frame: &AtlasFrame<'_>, entries: &[Entry<'_>]) -> Vec<Claim> {
        let screens: Vec<Screen<'_>> = frame.views.iter().map(screen).collect();
        let worth = |lit: &LitSphere| match screens.is_empty() {
            true => f64::INFINITY,
            false => importance(lit, &screens),
        };
        let mut claims = Vec::new();
        for (place, entry) in entries.iter().enumerate() {
            let Some(slot) = self.slots.of_light(place) else {
                continue;
            };
            let has_some = self.residents.size(slot).is_some();
            if !self.slots.needs_texels(slot, has_some) {
                continue;
            }
            claims.push(Claim {
                slot,
                tiles: self.slots[slot].tiles.len(),
                size: entry.light.size(),
                importance: match entry.light.light() {
                    Light::Point(light) => worth(&LitSphere::of_point(&light)),
                    Light::Spot(light) => worth(&LitSphere::of_spot(&light)),
                    Light::Directional(_) => f64::INFINITY,
                },
            });
        }
        claims
    }
}

fn screen<'a>(view: &AtlasView<'a>) -> Screen<'a> {
    Screen {
        view: view.view,
        width: view.width.into(),
        height: view.height.into(),
    }
}

/// What has a slot: every light, a directional one once a view.
pub(super) fn entries<'a>(frame: &AtlasFrame<'a>) -> Vec<Entry<'a>> {
    let mut suns = 0;
    let mut entries = Vec::with_capacity(frame.lights.len());
    for (index, light) in frame.lights.iter().enumerate() {
        let is_sun = matches!(light.light(), Light::Directional(_));
        let views: Vec<_> = match is_sun && !frame.views.is_empty() {
            true => frame.views.iter().enumerate().map(Some).collect(),
            false => vec![None],
        };
        for view in views {
            let sun = is_sun.then_some(suns);
            suns += usize::from(is_sun);
            entries.push(Entry {
                index,
                light,
                view,
                sun,
            });
        }
    }
    entries
}
