//! What a refused frame has moved in an atlas, the next one draws anew.

use glam::{Affine3A, Vec3};
use shadows::error::{CascadeError, ShadowAtlasError};
use shadows::{
    AtlasFrame, AtlasLight, Cascades, DirectionalLight, MapSettings, Radius, ShadowAtlas,
    ShadowAtlasDescriptor, SpotLight, TileSize, TileState, glam,
};

use crate::common::noop;
use crate::common::shapes::cuboid;

const LAYER: u32 = 256;

#[test]
fn tiles_that_a_refused_frame_moved_are_drawn_anew() {
    let (device, queue) = noop();
    let descriptor = ShadowAtlasDescriptor {
        layer_size: LAYER,
        memory: u64::from(LAYER * LAYER * 4),
        // Enough for a directional light's tile of 256 texels, too much for one of 128.
        settings: MapSettings {
            reach: Radius::Texels(32.0),
            ..Default::default()
        },
        ..Default::default()
    };
    let mut atlas = ShadowAtlas::new(&device, &descriptor).unwrap();
    let caster = cuboid(Vec3::splat(0.2)).caster(&device, Affine3A::IDENTITY);
    let spot = |number: usize| {
        let above = Vec3::new(0.01 * number as f32, 3.0, 0.0);
        AtlasLight::new(SpotLight::new(above, Vec3::NEG_Y, 0.5, 9.0)).with_size(TileSize::Fixed(64))
    };
    let mut prepare = |lights: &[AtlasLight]| {
        let frame = AtlasFrame {
            lights,
            casters: std::slice::from_ref(&caster),
            ..Default::default()
        };
        atlas.prepare(&device, &queue, &frame)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        atlas.encode(&mut encoder);
        queue.submit([encoder.finish()]);
        let tiles = (0..lights.len()).map(|light| atlas.tiles(light, 0)[0]);
        Ok::<_, ShadowAtlasError>(tiles.collect::<Vec<_>>())
    };
    let place = |tile: &shadows::AtlasTile| (tile.layer, tile.x, tile.y);

    // A layer full of small tiles, of which one is left in each quarter.
    let all: Vec<_> = (0..16).map(spot).collect();
    let tiles = prepare(&all).unwrap();
    let quarter = |of: usize| (tiles[of].x / 128, tiles[of].y / 128);
    let first_of = |q| (0..16).find(|&of| quarter(of) == q).unwrap();
    let left = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|q| all[first_of(q)]);
    let before = prepare(&left).unwrap();
    let kept = |tile: &shadows::AtlasTile| tile.statistics.state == TileState::Kept;
    assert!(before.iter().all(kept), "{before:?}");

    // A sun has to have a quarter, where its tile is too small.
    let sun = DirectionalLight::new(Vec3::Y);
    let size = TileSize::Auto {
        least: 128,
        most: LAYER,
    };
    let sun = AtlasLight::directional(sun, Cascades::default()).with_size(size);
    let lights: Vec<_> = left.into_iter().chain([sun]).collect();
    let refused = prepare(&lights).unwrap_err();
    let too_small = CascadeError::ReachOfSize {
        reach: 32.0,
        margin: 0.0,
        size: 128,
    };
    let too_small = ShadowAtlasError::Cascades {
        index: 4,
        source: too_small,
    };
    assert_eq!(refused, too_small);

    let after = prepare(&left).unwrap();
    let moved = before
        .iter()
        .zip(&after)
        .filter(|(before, after)| place(before) != place(after));
    let states: Vec<_> = moved.map(|(_, after)| after.statistics.state).collect();
    assert!(!states.is_empty(), "nothing had to move");
    let drawn = |state: &TileState| *state == TileState::Rendered;
    assert!(states.iter().all(drawn), "{states:?}");
}
