//! Casters by eights, so that what holds for all of them is asked once.

use glam::DVec3;

use super::bounds::CasterBounds;
use super::casters::Record;
use super::filter::CasterFilter;

/// Eight casters that follow each other in the host's list, which often are neighbours in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block {
    /// Around all of them.
    pub bounds: CasterBounds,
    /// Sums of theirs.
    pub digest: u128,
    pub triangles: u64,
    /// The square of a radius that covers as much as theirs do together.
    pub radius_squared: f64,
    /// The layers that all of them are on.
    layers: u32,
    /// Whether none has an owner, and all cast.
    plain: bool,
    /// Whether they are drawn alike: of one mesh, by the map, and with the same windings.
    pub alike: bool,
}

impl Block {
    pub const SIZE: usize = 8;

    fn of(records: &[Record]) -> Option<Self> {
        let first = records.first()?;
        let mut block = Self {
            bounds: first.bounds,
            digest: 0,
            triangles: 0,
            radius_squared: 0.0,
            layers: u32::MAX,
            plain: true,
            alike: !first.host_drawn,
        };
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for record in records {
            let CasterBounds {
                centre,
                half,
                radius,
            } = record.bounds;
            (min, max) = (min.min(centre - half), max.max(centre + half));
            block.digest = block.digest.wrapping_add(record.digest);
            block.triangles += u64::from(record.triangles);
            block.radius_squared += radius * radius;
            block.layers &= record.layers;
            block.plain &= record.owner.is_none() && record.casts();
            block.alike &= record.mesh == first.mesh && record.mirrored == first.mirrored;
        }
        block.bounds = CasterBounds::of_box(min, max);
        Some(block)
    }

    /// Whether a light surely casts the shadows of all of them.
    pub fn admitted_by(&self, filter: CasterFilter) -> bool {
        self.plain && filter.admits(self.layers, None)
    }
}

/// The blocks of all casters but the last few.
#[derive(Debug, Default)]
pub(crate) struct Blocks(Vec<Block>);

impl Blocks {
    /// Follows the records, of which those at some places (in ascending order) are not what they were.
    pub fn update(&mut self, records: &[Record], different: &[u32]) {
        let Self(blocks) = self;
        let full = records.as_chunks::<{ Block::SIZE }>().0;
        blocks.truncate(full.len());
        let mut next = 0;
        for index in different.iter().map(|&index| index as usize / Block::SIZE) {
            // Once for each block. New ones are all among them.
            if index < next || index >= full.len() {
                continue;
            }
            next = index + 1;
            let block = Block::of(&full[index]);
            match blocks.get_mut(index) {
                Some(known) => *known = block.unwrap_or(*known),
                None => blocks.extend(block),
            }
        }
    }

    pub fn all(&self) -> &[Block] {
        &self.0
    }
}
