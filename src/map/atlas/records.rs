//! What receivers are told of an atlas's lights.

use super::ShadowAtlas;
use super::lights::Entry;
use crate::map::gpu::{LightRecord, TileTexture, Tiles};
use crate::map::plan::{Place, Tile};
use crate::map::projection::{LightProjection, TileProjection};

impl ShadowAtlas {
    /// Stages what receivers are told of the lights.
    pub(super) fn write_lights(&mut self, entries: &[Entry<'_>]) {
        let mut next = self.views * self.lights;
        for (place, entry) in entries.iter().enumerate() {
            let Some(index) = self.slots.of_light(place) else {
                continue;
            };
            let (first, further) = self.records(index, entry);
            let views = match entry.view {
                Some((view, _)) => view..view + 1,
                None => 0..self.views,
            };
            let (lights, uploads) = self.gpu.lights_mut();
            for view in views {
                let record = first.with_further(further.len() as u32, next as u32);
                lights.write(uploads, view * self.lights + entry.index, record);
            }
            for record in further {
                lights.write(uploads, next, record);
                next += 1;
            }
        }
        let (lights, uploads) = self.gpu.lights_mut();
        lights.end(uploads, next);
    }

    /// What receivers are told of a slot's light: its record, and those of further cascades.
    fn records(&self, index: usize, entry: &Entry<'_>) -> (LightRecord, Vec<LightRecord>) {
        let (slot, places) = (&self.slots[index], self.residents.places(index));
        let texture = TileTexture {
            side: self.layer_size,
            bias: self.bias,
            format: self.format,
        };
        let Some(light) = slot.light() else {
            return (LightRecord::DARK, Vec::new());
        };
        let stale = slot.stale();
        // Without casters every texel is right, and none need be read.
        let casts = !places.is_empty() && (slot.casting > 0 || stale != 0);
        match light {
            LightProjection::Point(light) => {
                let shown = match slot.tiles.first().and_then(|tile| tile.shown) {
                    Some(TileProjection::Face(shown)) => shown,
                    _ if casts => return (LightRecord::DARK, Vec::new()),
                    _ => *light,
                };
                let near = self.gpu.near_plane().of_point(&shown);
                let record = LightRecord::point(&shown, near, tiles(places, casts), &texture);
                (record, Vec::new())
            }
            _ => {
                let sun = entry.sun;
                let flat = |(number, tile): (usize, &Tile)| {
                    let projection = match casts {
                        true => tile.shown,
                        false => slot.projection(number),
                    };
                    let Some(TileProjection::Flat(frame)) = projection else {
                        return None;
                    };
                    let place = places.get(number..=number).unwrap_or_default();
                    let record = LightRecord::flat(&frame, tiles(place, casts), &texture);
                    let blend = sun.map_or(0.0, |sun| self.suns.blend(sun, number));
                    Some(record.with_blend(blend))
                };
                let mut records = slot.tiles.iter().enumerate().filter_map(flat);
                match records.next() {
                    Some(first) => (first, records.collect()),
                    None if casts => (LightRecord::DARK, Vec::new()),
                    None => (LightRecord::lit(), Vec::new()),
                }
            }
        }
    }
}

/// Where a light's `N` tiles are, if anything casts.
fn tiles<const N: usize>(places: &[Place], casts: bool) -> Tiles<N> {
    match <&[Place; N]>::try_from(places) {
        Ok(places) if casts && N > 0 => Tiles::At {
            size: places[0].size,
            places: places.map(Into::into),
        },
        _ => Tiles::NoCaster,
    }
}
