//! All lights and views of a frame.

use crate::error::ShadowVolumeError;
use crate::volume::ShadowVolumeFrame;
use crate::volume::decide::decision::{Choices, KnownCaster};
use crate::volume::decide::facing::{self, ObjectLight};
use crate::volume::decide::method::Options;
use crate::volume::multiview::Multiview;
use crate::volume::plan::cache::VolumeCache;
use crate::volume::plan::limits::PlanLimits;
use crate::volume::plan::merged::MergedDraws;
use crate::volume::plan::pair::{Pair, Shared};
use crate::volume::plan::params::{LightParams, ViewParams};
use crate::volume::plan::scene::{Changes, SceneCasters};
use crate::volume::plan::windows::Windows;
use crate::volume::silhouette::{Way, Ways};
use crate::{Caster, HomogeneousLight};

/// What is drawn under which light in which view.
#[derive(Debug)]
pub(crate) struct Volumes {
    pub casters: SceneCasters,
    pub windows: Windows,
    pub merged: MergedDraws,
    lights: Vec<Light>,
    multiview: Multiview,
    /// How many views there are; of those that are drawn together, one.
    views: usize,
}

/// A light, and what of the casters depends on it.
#[derive(Debug, Default)]
struct Light {
    light: Option<HomogeneousLight>,
    /// By the casters' numbers: the light in their own space.
    of_casters: Vec<Option<ObjectLight>>,
    /// One for each view.
    pairs: Vec<Pair>,
}

impl Volumes {
    /// `bytes`: the largest storage buffer that can be made and bound.
    pub fn new(bytes: u64, multiview: Multiview) -> Self {
        Self {
            casters: SceneCasters::default(),
            windows: Windows::default(),
            merged: MergedDraws::new(bytes),
            lights: Vec::new(),
            multiview,
            views: 0,
        }
    }

    /// How many lights and views the last frame had.
    pub fn counts(&self) -> [usize; 2] {
        [self.lights.len(), self.views]
    }

    pub fn pair(&self, light: usize, view: usize) -> Option<&Pair> {
        self.lights.get(light)?.pairs.get(view)
    }

    pub fn pairs(&self) -> impl Iterator<Item = &Pair> {
        self.lights.iter().flat_map(|light| &light.pairs)
    }

    /// Decides what is drawn and which volumes that takes. The casters were
    /// [compared](SceneCasters::compare). Returns the meshes that no caster has any more, and no volume.
    pub fn decide(
        &mut self,
        frame: &ShadowVolumeFrame<'_>,
        (options, keep): (Options, bool),
        ways: &Ways,
        cache: &mut VolumeCache,
    ) -> Vec<u64> {
        let changes = self.casters.update(frame.casters, ways);
        let mut shared = Shared {
            casters: &self.casters,
            cache,
            windows: &mut self.windows,
            merged: &mut self.merged,
        };
        let multiview = self.multiview;
        self.views = frame.views.len() / multiview.views();
        for light in self
            .lights
            .drain(frame.lights.len().min(self.lights.len())..)
        {
            light
                .pairs
                .into_iter()
                .for_each(|mut pair| pair.clear(&mut shared));
        }
        self.lights.resize_with(frame.lights.len(), Light::default);
        for (place, light) in self.lights.iter_mut().enumerate() {
            for mut pair in light.pairs.drain(self.views.min(light.pairs.len())..) {
                pair.clear(&mut shared);
            }
            light.pairs.resize_with(self.views, Pair::default);
            light.update(frame.lights[place].light, &changes, shared.casters);
            for (view, pair) in light.pairs.iter_mut().enumerate() {
                if let Some(situation) = frame.situation(multiview, place, view) {
                    let lights = &light.of_casters[..];
                    pair.decide(&situation, (options, keep), (&changes, lights), &mut shared);
                }
            }
        }
        for light in &mut self.lights {
            light
                .pairs
                .iter_mut()
                .for_each(|pair| pair.draw(&mut shared));
        }
        cache.sweep();
        changes.meshes
    }

    /// Fills the windows of what was decided and gives it its draws, all volumes having their places. If
    /// nothing can be counted on that was written before, that of all casters.
    pub fn fill(&mut self, cache: &mut VolumeCache, renewed: bool) {
        if renewed {
            self.merged.renew();
        }
        let mut shared = Shared {
            casters: &self.casters,
            cache,
            windows: &mut self.windows,
            merged: &mut self.merged,
        };
        let pairs = self.lights.iter_mut().flat_map(|light| &mut light.pairs);
        pairs.for_each(|pair| pair.fill(&mut shared, renewed));
    }
}

impl Light {
    fn update(&mut self, light: HomogeneousLight, changes: &Changes, casters: &SceneCasters) {
        let moved = self.light != Some(light);
        self.light = Some(light);
        let changed = changes.changed.iter().map(|(_, number)| *number);
        match moved {
            true => (casters.numbers().iter()).for_each(|&number| self.see(number, casters)),
            false => changed.for_each(|number| self.see(number, casters)),
        }
    }

    fn see(&mut self, number: u32, casters: &SceneCasters) {
        let (Some(light), Some(known)) = (self.light, casters.get(number)) else {
            return;
        };
        if self.of_casters.len() <= number as usize {
            self.of_casters.resize(number as usize + 1, None);
        }
        let map = known.caster.transform();
        self.of_casters[number as usize] = ObjectLight::new(light, &map, known.mesh().bounds());
    }
}

/// Whether lights, views and casters are as few as the device's buffers can describe.
pub(crate) fn check_counts(
    frame: &ShadowVolumeFrame<'_>,
    multiview: Multiview,
    options: Options,
    limits: &PlanLimits,
) -> Result<(), ShadowVolumeError> {
    let limit = limits.casters;
    let [lights, views] = [frame.lights.len(), frame.views.len()];
    let most_views = limits.passes().saturating_mul(multiview.views());
    for (what, count, limit) in [("lights", lights, limit), ("views", views, most_views)] {
        if count > limit {
            return Err(ShadowVolumeError::TooMany { what, count, limit });
        }
    }
    let pairs = lights.saturating_mul(views / multiview.views());
    if frame.casters.len().saturating_mul(pairs) <= limit {
        return Ok(());
    }
    match drawn(frame, multiview, options) {
        count if count > limit => Err(ShadowVolumeError::TooManyCasters { count, limit }),
        _ => Ok(()),
    }
}

/// How many casters are drawn, those under two lights counted twice.
fn drawn(frame: &ShadowVolumeFrame<'_>, multiview: Multiview, options: Options) -> usize {
    // The way makes no difference.
    let known = |caster: &Caster| KnownCaster::new(caster, Way::Cpu);
    let known: Vec<KnownCaster> = frame.casters.iter().map(known).collect();
    let mut count = 0;
    for light in 0..frame.lights.len() {
        for view in 0..frame.views.len() / multiview.views() {
            let Some(of) = frame.situation(multiview, light, view) else {
                continue;
            };
            let choices = Choices::new(&of, options, false);
            let is_drawn = |known: &&KnownCaster| {
                let (map, bounds) = (known.caster.transform(), known.mesh().bounds());
                let light = ObjectLight::new(of.light, &map, bounds);
                choices.decide(known, light.as_ref()).form.is_some()
            };
            count += known.iter().filter(is_drawn).count();
        }
    }
    count
}

/// What shaders read of the views.
pub(crate) fn view_params(frame: &ShadowVolumeFrame<'_>) -> Vec<ViewParams> {
    let views = frame.views.iter();
    views.map(|told| ViewParams::new(&told.view)).collect()
}

/// What shaders read of the lights.
pub(crate) fn light_params(frame: &ShadowVolumeFrame<'_>) -> Vec<LightParams> {
    let lights = frame.lights.iter();
    let light = |light: HomogeneousLight| LightParams {
        homogeneous: facing::world_light(light),
    };
    lights.map(|told| light(told.light)).collect()
}
