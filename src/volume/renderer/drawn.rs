//! What the last frame draws.

use crate::volume::gpu::buffers::Buffers;
use crate::volume::gpu::draw_calls::Recorder;
use crate::volume::plan::cache::{Slot, VolumeCache};
use crate::volume::plan::merged::MergedDraw;
use crate::volume::plan::pair::Pair;
use crate::volume::plan::params::{CasterParams, LightParams, ViewParams};
use crate::volume::plan::volumes::Volumes;

/// What the last frame draws under one light in one view, and where it lies.
pub(crate) struct Drawn<'a> {
    pub pair: &'a Pair,
    pub volumes: &'a Volumes,
    pub cache: &'a VolumeCache,
    pub buffers: &'a Buffers,
    /// The view, or the first camera that shaders find of several.
    pub view: &'a ViewParams,
    pub light: &'a LightParams,
}

impl<'a> Drawn<'a> {
    /// A window's volume, and what its draws read.
    pub fn of(&self, window: u32) -> Option<(&'a Slot, &'a CasterParams)> {
        let window = self.volumes.windows.get(window)?;
        Some((self.cache.get(window.slot)?, &window.params))
    }

    /// All draws, those of one pipeline one after another.
    pub fn draws(&self) -> impl Iterator<Item = &'a MergedDraw> + use<'a> {
        let (lists, merged) = (&self.pair.draws, &self.volumes.merged);
        let numbers = lists.numbers();
        numbers.filter_map(|number| merged.get(number))
    }

    /// What they are recorded from.
    pub fn recorder(&self) -> Recorder<'a> {
        Recorder {
            windows: &self.volumes.windows,
            cache: self.cache,
            buffers: self.buffers,
        }
    }
}
