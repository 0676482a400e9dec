//! The debug view of an atlas: every texel of every tile where it lies in its layer.

use crate::atlas::{LAYER, atlas, descriptor, draw, layers, room};
use glam::Vec3;
use host::gpu::Gpu;
use shadows::{
    AtlasDebug, AtlasDebugDescriptor, AtlasFrame, AtlasLight, Cascades, DirectionalLight,
    PointLight, ShadowAtlas, SpotLight, TileSize, TileState, glam, wgpu,
};

const NEAR: f32 = 0.05;
const RANGE: f32 = 9.0;
const CLEAR: [u8; 4] = [255, 0, 255, 255];

fn lights() -> [AtlasLight; 3] {
    let lamp = PointLight {
        near: Some(NEAR),
        ..PointLight::new(Vec3::new(0.2, 0.1, 0.3), RANGE)
    };
    let spot = SpotLight {
        near: Some(NEAR),
        ..SpotLight::new(Vec3::Y * 5.0, Vec3::NEG_Y, 0.8, RANGE)
    };
    let sun = DirectionalLight::new(Vec3::new(0.3, 1.0, 0.2));
    [
        AtlasLight::new(lamp).with_size(TileSize::Fixed(256)),
        AtlasLight::new(spot).with_size(TileSize::Fixed(128)),
        AtlasLight::directional(sun, Cascades::default()).with_size(TileSize::Fixed(64)),
    ]
}

/// A pixel a texel, two layers beside each other.
fn picture(gpu: &Gpu, atlas: &ShadowAtlas) -> Vec<[u8; 4]> {
    let size = [2 * LAYER, LAYER];
    let target = gpu.target(size, wgpu::TextureFormat::Rgba8Unorm, 1);
    gpu.checked(|| {
        let mut debug = AtlasDebug::new(&gpu.device, &AtlasDebugDescriptor::default()).unwrap();
        debug.prepare(&gpu.device, atlas);
        gpu.run(|encoder| {
            let view = target.create_view(&Default::default());
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color {
                            r: 1.0,
                            g: 0.0,
                            b: 1.0,
                            a: 1.0,
                        }),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            debug.render(&mut pass);
        });
    });
    let bytes = gpu.read_texture(&target, 0, wgpu::TextureAspect::All);
    bytemuck::pod_collect_to_vec(&bytes)
}

fn outline(state: TileState) -> [u8; 4] {
    match state {
        TileState::Rendered => [255, 140, 0, 255],
        TileState::Kept => [26, 179, 51, 255],
        TileState::Empty => [115, 115, 115, 255],
        other => panic!("{other:?}: everything is drawn"),
    }
}

/// What the tiles' texels give, `moved` to the right by so many.
fn expected(gpu: &Gpu, atlas: &ShadowAtlas, moved: u32) -> Vec<[u8; 4]> {
    let layers = layers(gpu, atlas);
    let mut picture = vec![CLEAR; (2 * LAYER * LAYER) as usize];
    for light in 0..3 {
        for tile in atlas.tiles(light, 0) {
            for (y, x) in (0..tile.size).flat_map(|y| (0..tile.size).map(move |x| (y, x))) {
                let [from_x, from_y] = [x, y].map(|at| (at as f32 + 0.5) / tile.size as f32 - 0.5);
                let stored = layers[tile.layer as usize]
                    [((tile.y + y) * LAYER + tile.x + (x + moved) % tile.size) as usize];
                let along = match light {
                    2 => 1.0 - stored,
                    _ => NEAR / (RANGE * stored),
                };
                let grey = (255.0 * (1.0 - along.min(1.0))).round() as u8;
                let pixel = (tile.y + y) * 2 * LAYER + tile.layer * LAYER + tile.x + x;
                picture[pixel as usize] = match stored == 0.0 {
                    _ if from_x.abs().max(from_y.abs()) > 0.48 => outline(tile.statistics.state),
                    true => [0, 0, 64, 255],
                    false => [grey, grey, grey, 255],
                };
            }
        }
    }
    picture
}

#[test]
fn the_layers_are_shown_with_every_texel_in_its_place() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = room(&gpu);
    let lights = lights();
    let frame = AtlasFrame {
        lights: &lights,
        casters: &casters,
        ..Default::default()
    };
    let mut atlas = atlas(&gpu, &descriptor(2));
    assert!(
        picture(&gpu, &atlas).iter().all(|pixel| *pixel == CLEAR),
        "there is nothing to show"
    );
    // Rendered, then kept.
    for _ in 0..2 {
        draw(&gpu, &mut atlas, &frame);
        assert_eq!(atlas.statistics().layers, 2);
        let seen = picture(&gpu, &atlas);
        let far = |(a, b): (&[u8; 4], &[u8; 4])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
        let differ = |truth: &[[u8; 4]]| seen.iter().zip(truth).filter(|&pair| far(pair)).count();
        assert_eq!(differ(&expected(&gpu, &atlas, 0)), 0);
        assert!(
            differ(&expected(&gpu, &atlas, 1)) > 100,
            "the broken twin: a texel to the side"
        );
    }
}
