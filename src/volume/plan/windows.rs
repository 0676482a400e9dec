//! The parameters of all casters that are drawn, one window of a uniform buffer each: what was written
//! once stays there until it changes.

use std::collections::BTreeSet;

use crate::volume::plan::cache::VolumeCache;
use crate::volume::plan::params::CasterParams;

/// What the draws of a caster read, under one light in one view.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    /// Number of its volume in the cache.
    pub slot: u32,
    pub params: CasterParams,
}

/// All windows, by numbers that stay theirs.
#[derive(Debug, Default)]
pub(crate) struct Windows {
    list: Vec<Option<Window>>,
    free: BTreeSet<u32>,
    /// Those to be written, some of them more than once.
    changed: Vec<u32>,
}

impl Windows {
    /// How many there are, those without a caster included.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    pub fn get(&self, number: u32) -> Option<&Window> {
        self.list.get(number as usize)?.as_ref()
    }

    /// The least number that is free, so that what is written lies together.
    pub fn take(&mut self) -> u32 {
        self.free.pop_first().unwrap_or_else(|| {
            self.list.push(None);
            self.list.len() as u32 - 1
        })
    }

    pub fn give_back(&mut self, number: u32) {
        if let Some(window) = self.list.get_mut(number as usize) {
            *window = None;
            self.free.insert(number);
        }
    }

    pub fn set(&mut self, number: u32, new: Window) {
        let Some(window) = self.list.get_mut(number as usize) else {
            return;
        };
        let is_same = |old: &Window| {
            old.slot == new.slot
                && bytemuck::bytes_of(&old.params) == bytemuck::bytes_of(&new.params)
        };
        if !window.as_ref().is_some_and(is_same) {
            *window = Some(new);
            self.changed.push(number);
        }
    }

    /// Has all of them written, as volumes may lie elsewhere and what was written may be lost.
    pub fn renew(&mut self, cache: &VolumeCache) {
        for (number, window) in (0..).zip(&mut self.list) {
            let Some(window) = window else { continue };
            if let Some(slot) = cache.get(window.slot) {
                slot.locate(&mut window.params);
            }
            self.changed.push(number);
        }
    }

    /// The numbers of those that changed, in order.
    pub fn take_changed(&mut self) -> Vec<u32> {
        let mut changed = std::mem::take(&mut self.changed);
        changed.sort_unstable();
        changed.dedup();
        changed.retain(|&number| self.get(number).is_some());
        changed
    }
}
