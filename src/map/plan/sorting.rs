//! All casters sorted for one light: which tiles each touches, and what that comes to for each tile.

use super::content::Content;
use super::tile_masks::{TileMasks, tiles_of};
use crate::map::projection::{MOST_TILES, TileSides};
use crate::scene::{Block, CasterBounds, CasterFilter, Casters, Record};

/// The casters that a light may reach, by index.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Reached<'a> {
    All,
    Some(&'a [u32]),
}

/// What the casters on a tile come to.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sum {
    pub content: Content,
    /// Their shares of the tile.
    pub change: f64,
}

/// What casters are sorted by, and into.
pub(super) struct Sorting<'a> {
    pub filter: CasterFilter,
    /// All tiles of the light.
    pub all: u8,
    /// What tiles hold; `None`: everything.
    pub sides: Option<&'a TileSides>,
    pub masks: &'a mut TileMasks,
    pub sums: [Sum; MOST_TILES],
    /// Casters that touch any tile.
    pub casting: usize,
}

impl Sorting<'_> {
    pub fn sort(&mut self, casters: &Casters, reached: Reached<'_>) {
        let records = casters.records();
        self.masks.reset(records.len());
        match reached {
            Reached::Some(some) => {
                let some = some.iter().map(|&index| index as usize);
                some.for_each(|index| self.add(index, &records[index]));
            }
            Reached::All => {
                for (index, block) in casters.blocks().iter().enumerate() {
                    if !self.add_block(index, block) {
                        let first = index * Block::SIZE;
                        let singly = first..first + Block::SIZE;
                        singly.for_each(|index| self.add(index, &records[index]));
                    }
                }
                let rest = casters.blocks().len() * Block::SIZE;
                (rest..records.len()).for_each(|index| self.add(index, &records[index]));
            }
        }
    }

    fn add(&mut self, index: usize, record: &Record) {
        if !(record.casts() && self.filter.admits(record.layers, record.owner)) {
            return;
        }
        let mask = match self.sides {
            Some(sides) => sides.touched_by(record),
            None => self.all,
        };
        self.masks.add(index, mask);
        self.casting += usize::from(mask != 0);
        for tile in tiles_of(mask) {
            let sum = &mut self.sums[tile];
            sum.content.add(record);
            sum.change += self
                .sides
                .map_or(0.0, |sides| sides.share(tile, &record.bounds));
        }
    }

    /// False if its casters must be looked at one by one.
    fn add_block(&mut self, index: usize, block: &Block) -> bool {
        let mask = match self.sides {
            _ if !block.admitted_by(self.filter) => None,
            Some(sides) => sides.touched_by_all_in(&block.bounds),
            None => Some(self.all),
        };
        let Some(mask) = mask else {
            return false;
        };
        self.masks.add_block(index, mask);
        self.casting += if mask == 0 { 0 } else { Block::SIZE };
        let as_one = CasterBounds {
            radius: block.radius_squared.sqrt(),
            ..block.bounds
        };
        for tile in tiles_of(mask) {
            let sum = &mut self.sums[tile];
            sum.content.add_block(block);
            sum.change += self.sides.map_or(0.0, |sides| sides.share(tile, &as_one));
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use glam::{Affine3A, Quat, Vec3};

    use super::*;
    use crate::map::projection::{LightProjection, fit_spot};
    use crate::mesh::{Adjacency, Caster, CasterMesh};
    use crate::{PointLight, SpotLight};

    /// Small casters, neighbours in the world where they are neighbours in the list, and some that are not.
    fn casters(device: &wgpu::Device) -> Vec<Caster> {
        let positions = [[0.3, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 0.3]];
        let adjacency = Adjacency::new(&positions, &[0, 1, 2]).unwrap();
        let mesh = CasterMesh::new(device, &positions, &adjacency).unwrap();
        let place = |i: usize| {
            let at = Vec3::new(
                (i % 40) as f32 - 19.5,
                (i % 7) as f32 * 0.1,
                (i / 40) as f32 - 12.5,
            );
            let turned = Quat::from_rotation_y(i as f32);
            let mut caster = Caster::new(
                mesh.clone(),
                Affine3A::from_rotation_translation(
                    turned,
                    at * if i.is_multiple_of(97) { -1.0 } else { 1.0 },
                ),
            );
            caster.layers = if (i / 60).is_multiple_of(5) { 1 } else { 3 };
            caster.owner = NonZeroU32::new(u32::from((i / 50).is_multiple_of(6)));
            caster
        };
        (0..1003).map(place).collect()
    }

    fn lights() -> Vec<LightProjection> {
        let point =
            |x, range| LightProjection::Point(PointLight::new(Vec3::new(x, 0.5, 0.3), range));
        let spot = |angle| {
            let light = SpotLight::new(Vec3::new(3.0, 8.0, 1.0), Vec3::NEG_Y, angle, 9.0);
            LightProjection::Spot(fit_spot(&light, 0.01))
        };
        vec![
            point(0.0, 100.0),
            point(7.0, 12.0),
            point(-30.0, 5.0),
            spot(0.4),
            spot(1.2),
        ]
    }

    /// Masks of all casters, and what each tile holds.
    fn sorted(
        sides: &TileSides,
        all: u8,
        filter: CasterFilter,
        (casters, reached): (&Casters, Reached<'_>),
    ) -> (Vec<u8>, [Content; MOST_TILES], usize) {
        let mut masks = TileMasks::default();
        let mut sorting = Sorting {
            filter,
            all,
            sides: Some(sides),
            masks: &mut masks,
            sums: Default::default(),
            casting: 0,
        };
        sorting.sort(casters, reached);
        let (sums, casting) = (sorting.sums.map(|sum| sum.content), sorting.casting);
        let masks = (0..casters.records().len())
            .map(|at| masks.get(at))
            .collect();
        (masks, sums, casting)
    }

    #[test]
    fn casters_by_the_block_are_sorted_as_they_are_one_by_one() {
        let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let mut all = casters(&device);
        let mut casters = Casters::default();
        let filters = [
            CasterFilter::ALL,
            CasterFilter {
                layers: 2,
                owner: None,
            },
            CasterFilter {
                layers: 1,
                owner: NonZeroU32::new(1),
            },
        ];
        let (mut by_blocks, mut others) = (0, 0);
        for moved in 0..4 {
            // All, a few, and fewer casters.
            let step = [1, 100, 13, 1][moved];
            for caster in all.iter_mut().step_by(step) {
                caster.world_from_object.translation.x += 0.7;
            }
            all.truncate(1003 - 3 * moved);
            casters.compare(&all, &device).unwrap();
            casters.update(&all);
            let one_by_one: Vec<u32> = (0..all.len() as u32).collect();
            for (light, filter) in lights()
                .iter()
                .flat_map(|light| filters.map(|of| (light, of)))
            {
                let sides = TileSides::new(light);
                let sort = |reached| sorted(&sides, light.all(), filter, (&casters, reached));
                assert_eq!(sort(Reached::All), sort(Reached::Some(&one_by_one)));
                for (block, records) in casters
                    .blocks()
                    .iter()
                    .zip(casters.records().chunks(Block::SIZE))
                {
                    let touched = |record: &Record| sides.touched_by(record);
                    by_blocks += usize::from(sides.touched_by_all_in(&block.bounds).is_some());
                    // The broken twin: bounds of the first alone.
                    let first = sides.touched_by_all_in(&records[0].bounds);
                    others += usize::from(
                        first.is_some_and(|mask| records.iter().any(|of| touched(of) != mask)),
                    );
                }
            }
        }
        assert!(by_blocks > 1000 && others > 100, "{by_blocks} {others}");
    }
}
