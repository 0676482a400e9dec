//! The volumes that compute shaders find in one frame, for whichever lights, and who finds what.

use std::collections::{BTreeMap, HashMap};

use bytemuck::{Pod, Zeroable};

use crate::volume::plan::cache::{Sources, VolumeCache};
use crate::volume::plan::limits::WORKGROUP;
use crate::volume::plan::merged::{MergedDraw, MergedDraws};
use crate::volume::plan::params::{Arguments, InstanceParams};
use crate::volume::silhouette::Way;

/// What one workgroup does: so many elements of an instance's mesh, from this one on. `shares` in
/// `volume_batch.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Share {
    pub instance: u32,
    pub first: u32,
}

/// A draw whose blocks are made anew. `Merge` in `volume_merge.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Merge {
    pub first_member: u32,
    pub member_count: u32,
    pub first_block: u32,
    pub draw: u32,
    pub element_words: u32,
    pub block_vertices: u32,
    pub padding: [u32; 2],
}

impl Merge {
    /// Nothing.
    const NONE: Self = Self {
        first_member: 0,
        member_count: 0,
        first_block: 0,
        draw: u32::MAX,
        element_words: 1,
        block_vertices: 0,
        padding: [0; 2],
    };

    fn new(draw: &MergedDraw) -> Self {
        let [first_member, first_block, arguments] = draw.starts();
        Self {
            first_member,
            member_count: draw.seats(),
            first_block,
            draw: arguments,
            element_words: draw.key.element_words(),
            block_vertices: draw.key.block_vertices(),
            padding: [0; 2],
        }
    }
}

impl Share {
    /// Nothing: no mesh has so many elements.
    const NONE: Self = Self {
        instance: 0,
        first: u32::MAX - (WORKGROUP - 1),
    };
}

/// Workgroups that read and write the same buffers.
#[derive(Clone, Debug)]
pub(crate) struct Dispatch {
    pub sources: Sources,
    /// The first of their items, in the list of what is to be done.
    pub first_item: u32,
    /// How many there are, in two dimensions.
    pub groups: [u32; 2],
}

/// All extraction of a frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct Work {
    /// What compute shaders find.
    pub instances: Vec<InstanceParams>,
    /// For each of these, its indirect arguments before anything is counted, and their number.
    pub arguments: Vec<(u32, Arguments)>,
    pub shares: Vec<Share>,
    pub facing: Vec<Dispatch>,
    pub edges: Vec<Dispatch>,
    pub merges: Vec<Merge>,
    /// Those of draws of one chunk each, which is all that their sources say.
    pub merging: Vec<Dispatch>,
}

impl Work {
    /// The work for volumes that have their places. `most`: workgroups in one dimension of a dispatch.
    pub fn of(numbers: &[u32], cache: &VolumeCache, most: u32) -> Self {
        let mut work = Self::default();
        let [mut facing, mut edges] = [Lists::default(), Lists::default()];
        for slot in numbers.iter().filter_map(|&number| cache.get(number)) {
            let instance = work.instances.len() as u32;
            work.instances.push(slot.instance);
            // Caps are below the region's end, which the regions keep below 2^32.
            let cap_end = slot.place.cap + 3 * slot.mesh.triangle_count();
            let arguments = Arguments::new(slot.place.cap, cap_end);
            work.arguments.push((slot.instance.arguments, arguments));
            let sources = slot.sources();
            facing.add(&sources, instance, slot.mesh.triangle_count());
            // Edges are not read with positions.
            let sources = Sources {
                host_positions: None,
                ..sources
            };
            edges.add(&sources, instance, slot.mesh.edge_count());
        }
        work.facing = facing.lay_out(&mut work.shares, most);
        work.edges = edges.lay_out(&mut work.shares, most);
        work
    }

    /// Adds the draws whose blocks compute shaders make anew.
    pub fn merge(&mut self, merged: &MergedDraws, touched: &[u32], most: u32) {
        let draws = touched.iter().filter_map(|&number| merged.get(number));
        let by_compute = draws.filter(|draw| draw.key.way == Way::Compute && !draw.key.own);
        let mut lists: BTreeMap<usize, Vec<Merge>> = BTreeMap::new();
        for draw in by_compute {
            lists
                .entry(draw.chunk())
                .or_default()
                .push(Merge::new(draw));
        }
        for (chunk, mut list) in lists {
            let first_item = self.merges.len() as u32;
            let groups = fold(list.len() as u32, most);
            list.resize(groups.iter().product::<u32>() as usize, Merge::NONE);
            self.merges.extend(list);
            let sources = Sources {
                chunk,
                ..Sources::default()
            };
            self.merging.push(Dispatch {
                sources,
                first_item,
                groups,
            });
        }
    }

    pub fn is_empty(&self) -> bool {
        self.instances.is_empty() && self.merges.is_empty()
    }

    /// The dispatches of all passes, one after the other.
    pub fn dispatches(&self) -> impl Iterator<Item = &Dispatch> {
        let extraction = self.facing.iter().chain(&self.edges);
        extraction.chain(&self.merging)
    }
}

/// The shares of a pass, by what they read and write.
#[derive(Default)]
struct Lists {
    places: HashMap<Sources, usize>,
    lists: Vec<(Sources, Vec<Share>)>,
}

impl Lists {
    fn add(&mut self, sources: &Sources, instance: u32, elements: u32) {
        let place = match self.lists.last() {
            Some((last, _)) if last == sources => self.lists.len() - 1,
            _ => *self.places.entry(sources.clone()).or_insert_with(|| {
                self.lists.push((sources.clone(), Vec::new()));
                self.lists.len() - 1
            }),
        };
        let firsts = (0..elements).step_by(WORKGROUP as usize);
        let shares = firsts.map(|first| Share { instance, first });
        self.lists[place].1.extend(shares);
    }

    fn lay_out(self, all: &mut Vec<Share>, most: u32) -> Vec<Dispatch> {
        let lists = self.lists.into_iter().filter(|(_, list)| !list.is_empty());
        let dispatch = |(sources, list): (Sources, Vec<Share>)| {
            let first_item = all.len() as u32;
            let groups = fold(list.len() as u32, most);
            all.extend(list);
            all.resize(
                first_item as usize + groups.iter().product::<u32>() as usize,
                Share::NONE,
            );
            Dispatch {
                sources,
                first_item,
                groups,
            }
        };
        lists.map(dispatch).collect()
    }
}

/// Rows of workgroups, the last of which may have more than there is work for.
fn fold(groups: u32, most: u32) -> [u32; 2] {
    let rows = groups.div_ceil(most);
    [groups.div_ceil(rows.max(1)), rows]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_folded_and_nothing_is_left_out() {
        assert_eq!(fold(1, 65_535), [1, 1]);
        assert_eq!(fold(65_535, 65_535), [65_535, 1]);
        assert_eq!(fold(65_536, 65_535), [32_768, 2]);
        for groups in [1, 5_000, 1_000_000, 16_000_000] {
            let [x, y] = fold(groups, 4_100);
            assert!(x <= 4_100 && y <= 4_100);
            assert!(x * y >= groups && x * y < groups + y);
        }
    }

    #[test]
    fn every_element_has_one_share() {
        let sources = |chunk| Sources {
            chunk,
            ..Sources::default()
        };
        let mut lists = Lists::default();
        // The third joins the first, though another came between.
        for (place, instance, elements) in [(0, 0, 12), (1, 1, 700), (0, 2, 512), (0, 3, 0)] {
            lists.add(&sources(place), instance, elements);
        }
        let mut shares = Vec::new();
        let dispatches = lists.lay_out(&mut shares, 2);
        let share = |instance, first| Share { instance, first };
        let [first, second] = &dispatches[..] else {
            panic!("{dispatches:?}")
        };
        // Three workgroups each, in rows of two.
        assert_eq!((first.first_item, first.groups), (0, [2, 2]));
        assert_eq!((second.first_item, second.groups), (4, [2, 2]));
        assert_eq!(
            shares,
            [
                share(0, 0),
                share(2, 0),
                share(2, 256),
                Share::NONE,
                share(1, 0),
                share(1, 256),
                share(1, 512),
                Share::NONE,
            ]
        );
        assert!(Share::NONE.first.checked_add(WORKGROUP - 1).is_some());
    }
}
