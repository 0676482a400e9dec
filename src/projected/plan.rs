//! Which shadow has which tile, and which tiles show what they should.

use std::collections::HashMap;

use super::descriptor::{ProjectedCaster, ProjectedFrame, Projector};
use super::fit::{casting_bounds, fit};
use super::statistics::ProjectorState;
use super::texture::LEAST_TILE;
use crate::Light;
use crate::error::ProjectedShadowError;
use crate::map::{FlatFrame, Place, TileAllocator};
use crate::scene::{CasterBounds, Digest, caster_digest};

/// All that a tile's texels depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Key {
    /// Of the light and the casters, whose order does not count.
    digest: u128,
    size: u32,
}

impl Key {
    fn of(projector: &Projector<'_>) -> Self {
        let light = &projector.light;
        let casts = |caster: &&ProjectedCaster| casting_bounds(light, &caster.caster).is_some();
        let casters = projector.casters.iter().filter(casts);
        // A sum, as of a map's tiles: see `scene::casters`.
        let sum = casters.fold(0, |sum: u128, caster| {
            let mut digest = Digest::new();
            take(&mut digest, caster_digest(&caster.caster));
            digest.take_f32(&caster.transmittance);
            sum.wrapping_add(digest.finish())
        });
        let mut digest = Digest::new();
        take(&mut digest, sum);
        take_light(&mut digest, light);
        Self {
            digest: digest.finish(),
            size: projector.size,
        }
    }
}

fn take(digest: &mut Digest, number: u128) {
    digest.take(number as u64);
    digest.take((number >> 64) as u64);
}

/// What of a light decides where its shadows fall.
fn take_light(digest: &mut Digest, light: &Light) {
    match light {
        Light::Point(light) => {
            digest.take(1);
            digest.take_f32(&light.position.extend(light.range).to_array());
        }
        Light::Spot(light) => {
            digest.take(2);
            digest.take_f32(&light.position.extend(light.range).to_array());
            digest.take_f32(&light.direction.extend(light.half_angle).to_array());
        }
        Light::Directional(light) => {
            digest.take(3);
            digest.take_f32(&light.toward_light.to_array());
        }
    }
}

/// One shadow.
#[derive(Clone, Debug)]
struct Entry {
    key: Key,
    /// Where its tile lies in the world, or why it has none.
    frame: Result<FlatFrame, ProjectorState>,
    /// Where it lies in the texture.
    place: Option<Place>,
    /// Whether its texels show it.
    drawn: bool,
}

/// What a frame asks for, before anything is changed for it.
pub(super) struct Wanted {
    /// With the entry of the last frame that is the same.
    entries: Vec<(Entry, Option<usize>)>,
}

/// The shadows of the last frame, and the tiles they have.
#[derive(Debug)]
pub(super) struct Plan {
    entries: Vec<Entry>,
    tiles: TileAllocator,
}

impl Plan {
    pub fn new(layer_size: u32, most_layers: u32) -> Self {
        Self {
            entries: Vec::new(),
            tiles: TileAllocator::new(layer_size, most_layers, LEAST_TILE),
        }
    }

    /// Finds what is as it was, wherever it stood in the frame, and where the others lie in the world.
    pub fn wanted(&self, frame: &ProjectedFrame<'_>) -> Result<Wanted, ProjectedShadowError> {
        let mut known: HashMap<Key, Vec<usize>> = HashMap::new();
        for (index, entry) in self.entries.iter().enumerate().rev() {
            known.entry(entry.key).or_default().push(index);
        }
        let entries = frame.projectors.iter().map(|projector| {
            let key = Key::of(projector);
            match known.get_mut(&key).and_then(Vec::pop) {
                Some(index) => (self.entries[index].clone(), Some(index)),
                None => (entry(key, projector), None),
            }
        });
        let wanted = Wanted {
            entries: entries.collect(),
        };
        wanted.check_space(self.tiles.capacity())?;
        Ok(wanted)
    }

    /// Gives each shadow a tile.
    pub fn take_over(&mut self, wanted: Wanted) {
        let mut gone: Vec<Option<Entry>> = self.entries.drain(..).map(Some).collect();
        for index in wanted.entries.iter().filter_map(|(_, from)| *from) {
            gone[index] = None;
        }
        for place in gone.into_iter().flatten().filter_map(|entry| entry.place) {
            self.tiles.free(place);
        }
        self.entries = wanted.entries.into_iter().map(|(entry, _)| entry).collect();
        let mut full = false;
        for entry in &mut self.entries {
            if entry.frame.is_ok() && entry.place.is_none() {
                entry.place = self.tiles.allocate(entry.key.size);
                full |= entry.place.is_none();
            }
        }
        if full {
            self.pack();
        }
    }

    /// All tiles anew, without gaps.
    fn pack(&mut self) {
        let with_tile = self.entries.iter_mut().filter(|entry| entry.frame.is_ok());
        let mut with_tile: Vec<&mut Entry> = with_tile.collect();
        let sizes: Vec<u32> = with_tile.iter().map(|entry| entry.key.size).collect();
        // `Wanted` has seen that there is room.
        let places = self.tiles.pack(&sizes).unwrap_or_default();
        for (entry, place) in with_tile.iter_mut().zip(places) {
            entry.place = Some(place);
            entry.drawn = false;
        }
    }

    /// Layers that the texture needs.
    pub fn layers(&self) -> u32 {
        self.tiles.layers_in_use()
    }

    pub fn texels(&self) -> u64 {
        self.tiles.texels_in_use()
    }

    /// Nothing is known of any texels.
    pub fn doubt(&mut self) {
        self.entries
            .iter_mut()
            .for_each(|entry| entry.drawn = false);
    }

    /// Learns that all tiles are drawn.
    pub fn encoded(&mut self) {
        self.entries.iter_mut().for_each(|entry| entry.drawn = true);
    }

    /// For each shadow of the frame where its tile lies, in the world and in the texture.
    pub fn tiles(&self) -> impl Iterator<Item = Option<(&FlatFrame, Place)>> {
        self.entries
            .iter()
            .map(|entry| Some((entry.frame.as_ref().ok()?, entry.place?)))
    }

    /// Where a shadow's tile lies in the world.
    pub fn frame(&self, projector: usize) -> Option<&FlatFrame> {
        self.entries.get(projector)?.frame.as_ref().ok()
    }

    /// What becomes of each shadow in the next encode.
    pub fn states(&self) -> impl Iterator<Item = ProjectorState> {
        self.entries
            .iter()
            .map(|entry| match (&entry.frame, entry.drawn) {
                (Err(state), _) => *state,
                (Ok(_), true) => ProjectorState::Kept,
                (Ok(_), false) => ProjectorState::Drawn,
            })
    }
}

impl Wanted {
    fn check_space(&self, bound: u64) -> Result<(), ProjectedShadowError> {
        let with_tile = self.entries.iter().filter(|(entry, _)| entry.frame.is_ok());
        let texels = with_tile
            .clone()
            .map(|(entry, _)| u64::from(entry.key.size).pow(2));
        let needed = texels.sum();
        match needed > bound {
            true => Err(ProjectedShadowError::Space {
                shadows: with_tile.count(),
                needed,
                bound,
            }),
            false => Ok(()),
        }
    }
}

fn entry(key: Key, projector: &Projector<'_>) -> Entry {
    let casters = projector.casters.iter();
    let bounds = casters.filter_map(|caster| casting_bounds(&projector.light, &caster.caster));
    let bounds: Vec<CasterBounds> = bounds.collect();
    Entry {
        key,
        frame: fit(&projector.light, &bounds, projector.size),
        place: None,
        drawn: false,
    }
}
