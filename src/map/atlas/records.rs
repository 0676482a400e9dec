//! What receivers are told of an atlas's lights.

use super::ShadowAtlas;
use super::lights::Entry;
use crate::map::gpu::{LightRecord, TileTexture, Tiles};
use crate::map::plan::{Place, Tile};
use crate::map::projection::{LightProjection, TileProjection};

/// Where in the buffer the record of a light with a position was written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Told {
    slot: usize,
    /// Its place in the frame, of so many lights, for so many views.
    light: usize,
    lights: usize,
    views: usize,
    /// What [`AtlasLights::forgotten`](crate::map::gpu::AtlasLights::forgotten) was.
    forgotten: u64,
}

impl ShadowAtlas {
    /// Stages what receivers are told of the lights.
    pub(super) fn write_lights(&mut self, entries: &[Entry<'_>]) {
        let mut next = self.views * self.lights;
        self.told.resize(entries.len(), None);
        for (place, entry) in entries.iter().enumerate() {
            let Some(index) = self.slots.of_light(place) else {
                continue;
            };
            let told = Told {
                slot: index,
                light: entry.index,
                lights: self.lights,
                views: self.views,
                forgotten: self.gpu.lights().forgotten(),
            };
            // Cascades may blend in another way without lying elsewhere.
            let last = self.told[place]
                .replace(told)
                .filter(|_| entry.sun.is_none());
            if last == Some(told) && self.slots[index].is_told() {
                continue;
            }
            self.slots[index].tell();
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

#[cfg(test)]
mod tests {
    use glam::{Affine3A, Vec3};

    use super::*;
    use crate::mesh::{Adjacency, Caster, CasterMesh};
    use crate::{AtlasFrame, AtlasLight, PointLight, ShadowAtlasDescriptor, SpotLight, TileSize};

    const RECORD: u64 = size_of::<LightRecord>() as u64;

    #[test]
    fn receivers_are_told_of_lights_that_others_stand_before_and_of_no_other() {
        let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let positions = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let adjacency = Adjacency::new(&positions, &[0, 1, 2]).unwrap();
        let mesh = CasterMesh::new(&device, &positions, &adjacency).unwrap();
        let mut casters = vec![Caster::new(mesh, Affine3A::IDENTITY)];
        let mut atlas = ShadowAtlas::new(&device, &ShadowAtlasDescriptor::default()).unwrap();
        let mut frame = |lights: &[AtlasLight], casters: &[Caster]| {
            let frame = AtlasFrame {
                lights,
                casters,
                ..Default::default()
            };
            let prepared = atlas.prepare(&device, &queue, &frame);
            let uploaded = atlas.statistics().uploaded;
            let mut encoder = device.create_command_encoder(&Default::default());
            atlas.encode(&mut encoder);
            queue.submit([encoder.finish()]);
            prepared.map(|()| uploaded)
        };
        // Bytes of a frame, of which another one like it has none.
        let mut uploaded = |lights: &[AtlasLight], casters: &[Caster]| {
            let [first, again] = [(); 2].map(|()| frame(lights, casters).unwrap());
            assert_eq!(again, 0, "nothing changed");
            first
        };
        let of = |light: AtlasLight| light.with_size(TileSize::Fixed(64));
        let point = |x: f32| of(AtlasLight::new(PointLight::new(Vec3::X * x, 20.0)));
        let spot = of(AtlasLight::new(SpotLight::new(
            Vec3::Y * 5.0,
            Vec3::NEG_Y,
            0.7,
            9.0,
        )));
        let [a, b, c] = [point(-4.0), point(5.0), spot];
        assert!(uploaded(&[a, b, c], &casters) > 3 * RECORD);
        // Two change places: their records do, and nothing is drawn.
        assert_eq!(uploaded(&[b, a, c], &casters), 2 * RECORD);
        assert_eq!(uploaded(&[b, c, a], &casters), 2 * RECORD);
        // One goes: those behind it are told anew, and the place that is left is dark.
        assert_eq!(uploaded(&[c, a], &casters), 3 * RECORD);
        // A caster that moves is seen by all lights.
        casters[0].world_from_object.translation.x = 0.1;
        assert!(uploaded(&[c, a], &casters) > 0);
        // After a frame that was refused it is not known what receivers were told.
        assert!(frame(&[c, point(f32::NAN)], &casters).is_err());
        assert!(frame(&[c, a], &casters).unwrap() >= 2 * RECORD);
    }
}
