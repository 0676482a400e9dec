//! Which tiles of which lights are in the texture, and where.

use super::allocation::{Place, TileAllocator};
use super::sizing::{SizeRequest, Standing, TileSize, choose_sizes};
use crate::error::TileSizeError;

/// A light that is to have tiles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Claim {
    pub slot: usize,
    pub tiles: usize,
    pub size: TileSize,
    /// See [`importance`](super::importance()).
    pub importance: f64,
}

/// One slot's tiles; none if nothing casts for its light.
#[derive(Clone, Debug, Default)]
struct Resident {
    standing: Option<Standing>,
    places: Vec<Place>,
}

/// The tiles of all slots.
#[derive(Debug)]
pub(crate) struct Residents {
    allocator: TileAllocator,
    slots: Vec<Resident>,
    /// Lights of the last frame that wanted larger tiles than there was room for.
    reduced: u32,
}

impl Residents {
    pub fn new(layer_size: u32, most_layers: u32, least_tile: u32) -> Self {
        Self {
            allocator: TileAllocator::new(layer_size, most_layers, least_tile),
            slots: Vec::new(),
            reduced: 0,
        }
    }

    /// Where the tiles of a slot are, in their order; empty if it has none.
    pub fn places(&self, slot: usize) -> &[Place] {
        self.slots.get(slot).map_or(&[], |slot| &slot.places)
    }

    /// Texels along the tiles of a slot, if it has any.
    pub fn size(&self, slot: usize) -> Option<u32> {
        Some(self.places(slot).first()?.size)
    }

    /// Layers that the texture must have.
    pub fn layers(&self) -> u32 {
        self.allocator.layers_in_use()
    }

    pub fn texels(&self) -> u64 {
        self.allocator.texels_in_use()
    }

    pub fn reduced(&self) -> u32 {
        self.reduced
    }

    /// How many tiles lie in a layer.
    pub fn count_in(&self, layer: u32) -> usize {
        let places = self.slots.iter().flat_map(|slot| &slot.places);
        places.filter(|place| place.layer == layer).count()
    }

    /// Gives the claimants tiles of the sizes that they can have, and all others none. Tells the slots
    /// whose tiles came, went, or are elsewhere now. With an error nothing has changed.
    pub fn settle(&mut self, slots: usize, claims: &[Claim]) -> Result<Vec<usize>, TileSizeError> {
        self.slots.resize_with(slots, Resident::default);
        let requests: Vec<SizeRequest> = claims.iter().map(|claim| self.request(claim)).collect();
        let standings = choose_sizes(&requests, self.allocator.capacity())?;
        self.reduced = standings
            .iter()
            .map(|standing| u32::from(standing.size < standing.wanted))
            .sum();
        let mut claimed = vec![None; slots];
        for (claim, standing) in claims.iter().zip(standings) {
            claimed[claim.slot] = Some((claim.tiles, standing));
        }
        let mut moved = Vec::new();
        let mut homeless = Vec::new();
        for (index, (slot, claim)) in self.slots.iter_mut().zip(&claimed).enumerate() {
            slot.standing = claim.map(|(_, standing)| standing);
            let (tiles, size) = claim.map_or((0, 0), |(tiles, standing)| (tiles, standing.size));
            let stays =
                slot.places.len() == tiles && slot.places.iter().all(|place| place.size == size);
            if !stays {
                slot.places
                    .drain(..)
                    .for_each(|place| self.allocator.free(place));
                moved.push(index);
                homeless.push((size, index, tiles));
            }
        }
        // The largest first: they are the hardest to place.
        homeless.sort_by_key(|&(size, slot, _)| (std::cmp::Reverse(size), slot));
        let all_placed = homeless.into_iter().all(|(size, slot, tiles)| {
            let places: Option<Vec<Place>> =
                (0..tiles).map(|_| self.allocator.allocate(size)).collect();
            let placed = places.is_some();
            self.slots[slot].places = places.unwrap_or_default();
            placed
        });
        if !all_placed {
            // What was homeless has moved, even where it has been put back to what it was given first.
            moved.extend(self.repack(&claimed));
            moved.sort_unstable();
            moved.dedup();
        }
        Ok(moved)
    }

    fn request(&self, claim: &Claim) -> SizeRequest {
        SizeRequest {
            size: claim.size,
            tiles: claim.tiles as u32,
            importance: claim.importance,
            last: self.slots[claim.slot].standing,
        }
    }

    /// New places for all: there is room, but in pieces. Tells the slots that are elsewhere now.
    fn repack(&mut self, claimed: &[Option<(usize, Standing)>]) -> Vec<usize> {
        let tiles = claimed.iter().enumerate().filter_map(|(slot, claim)| {
            let (tiles, standing) = (*claim)?;
            Some(std::iter::repeat_n((slot, standing.size), tiles))
        });
        let (owners, sizes): (Vec<usize>, Vec<u32>) = tiles.flatten().unzip();
        let mut places = vec![Vec::new(); claimed.len()];
        // They are no more texels than there are, so they fit.
        let packed = self.allocator.pack(&sizes).unwrap_or_default();
        for (owner, place) in owners.into_iter().zip(packed) {
            places[owner].push(place);
        }
        let mut moved = Vec::new();
        for (index, (slot, places)) in self.slots.iter_mut().zip(places).enumerate() {
            if slot.places != places {
                moved.push(index);
            }
            slot.places = places;
        }
        moved
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const LAYER: u32 = 256;
    const LEAST: u32 = 16;

    fn claim(slot: usize, tiles: usize, size: u32) -> Claim {
        Claim {
            slot,
            tiles,
            size: TileSize::Auto {
                least: LEAST,
                most: size,
            },
            importance: f64::from(size),
        }
    }

    fn check(residents: &Residents, claims: &[Claim]) -> Result<(), TestCaseError> {
        let mut taken = vec![false; (LAYER / LEAST).pow(2) as usize * 3];
        for claim in claims {
            let places = residents.places(claim.slot);
            prop_assert_eq!(places.len(), claim.tiles);
            for place in places {
                prop_assert_eq!(place.size, places[0].size);
                let cells = |from: u32| from / LEAST..(from + place.size) / LEAST;
                for (x, y) in cells(place.y).flat_map(|y| cells(place.x).map(move |x| (x, y))) {
                    let side = LAYER / LEAST;
                    let cell = &mut taken[((place.layer * side + y) * side + x) as usize];
                    prop_assert!(!std::mem::replace(cell, true), "two lights in {place:?}");
                }
            }
        }
        Ok(())
    }

    #[test]
    fn who_does_not_change_does_not_move() {
        let mut residents = Residents::new(LAYER, 3, LEAST);
        let claims: Vec<Claim> = (0..8).map(|slot| claim(slot, 1, 64)).collect();
        assert_eq!(residents.settle(8, &claims).map(|moved| moved.len()), Ok(8));
        assert_eq!(residents.settle(8, &claims), Ok(vec![]));
        let before = residents.places(5).to_vec();
        let fewer: Vec<Claim> = claims
            .iter()
            .filter(|claim| claim.slot != 2)
            .copied()
            .collect();
        assert_eq!(residents.settle(8, &fewer), Ok(vec![2]));
        assert_eq!(residents.places(5), before);
        assert!(residents.places(2).is_empty());
    }

    #[test]
    fn with_too_little_room_all_are_there_and_some_are_smaller() {
        let mut residents = Residents::new(LAYER, 3, LEAST);
        let claims: Vec<Claim> = (0..10).map(|slot| claim(slot, 6, 128)).collect();
        residents.settle(10, &claims).unwrap();
        check(&residents, &claims).unwrap();
        assert!(residents.reduced() > 0);
        let fixed: Vec<Claim> = (0..10)
            .map(|slot| Claim {
                size: TileSize::Fixed(128),
                ..claim(slot, 6, 128)
            })
            .collect();
        let before = residents.places(3).to_vec();
        assert!(matches!(
            residents.settle(10, &fixed),
            Err(TileSizeError::Space { lights: 10, .. })
        ));
        assert_eq!(residents.places(3), before);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]

        #[test]
        fn no_light_is_missing_or_in_anothers_place(
            frames in prop::collection::vec(
                prop::collection::vec((0..24_usize, prop::sample::select(vec![1_usize, 4, 6]), 4..9_u32), 0..24),
                1..30,
            ),
        ) {
            let mut residents = Residents::new(LAYER, 3, LEAST);
            let mut last: Vec<Vec<Place>> = vec![Vec::new(); 24];
            for frame in frames {
                let mut claims: Vec<Claim> = Vec::new();
                for (slot, tiles, log) in frame {
                    if claims.iter().all(|claim| claim.slot != slot) {
                        claims.push(claim(slot, tiles, 1 << log));
                    }
                }
                let moved = residents.settle(24, &claims).unwrap();
                check(&residents, &claims)?;
                for (slot, last) in last.iter_mut().enumerate() {
                    let places = residents.places(slot).to_vec();
                    if !moved.contains(&slot) {
                        prop_assert_eq!(&places, &*last, "it moved without a word");
                    }
                    *last = places;
                }
            }
        }
    }
}
