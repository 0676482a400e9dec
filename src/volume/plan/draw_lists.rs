//! The draws of a light in a view, by what they have in common.

use std::collections::{BTreeMap, BTreeSet};

use crate::volume::gpu::draw_pipelines::Style;
use crate::volume::plan::cache::Sources;
use crate::volume::plan::merged::BLOCK;
use crate::volume::silhouette::Way;

/// What the draws of one key share: pipeline, bind group and index buffer. Ordered so that those of one
/// pipeline follow each other.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct DrawKey {
    pub way: Way,
    pub style: Style,
    /// Vertices of an element.
    pub vertices: u32,
    /// Whether the caps are those that count -1.
    pub back: bool,
    /// Whether a draw is one caster's.
    pub own: bool,
    pub sources: Sources,
}

impl DrawKey {
    /// Words of an element in its list.
    pub fn element_words(&self) -> u32 {
        match self.style.faces.are_caps() {
            true => 3,
            false => 1,
        }
    }

    /// Vertices of a block.
    pub fn block_vertices(&self) -> u32 {
        BLOCK * self.vertices
    }
}

/// The numbers of the draws of a light in a view.
#[derive(Debug, Default)]
pub(crate) struct DrawLists(BTreeMap<DrawKey, BTreeSet<u32>>);

impl DrawLists {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn len(&self) -> usize {
        self.0.values().map(BTreeSet::len).sum()
    }

    pub fn keys(&self) -> impl Iterator<Item = &DrawKey> {
        self.0.keys()
    }

    /// Those of one key one after another.
    pub fn numbers(&self) -> impl Iterator<Item = u32> + use<'_> {
        self.0.values().flatten().copied()
    }

    /// Those of a key.
    pub fn of(&mut self, key: &DrawKey) -> &mut BTreeSet<u32> {
        self.0.entry(key.clone()).or_default()
    }

    pub fn remove(&mut self, key: &DrawKey, number: u32) {
        if let Some(list) = self.0.get_mut(key) {
            list.remove(&number);
            if list.is_empty() {
                self.0.remove(key);
            }
        }
    }
}
