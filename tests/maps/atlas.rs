//! `ShadowAtlas`: every tile is what the same light's own map holds, whatever came and went before it.

use crate::common::shapes::{Random, cuboid, sphere};
use glam::camera::rh::{proj::directx as proj, view};
use glam::{Affine3A, Vec3, Vec3A};
use host::gpu::Gpu;
use shadows::error::{ShadowAtlasError, TileSizeError};
use shadows::{
    AtlasFrame, AtlasLight, AtlasTile, AtlasView, Cascades, Caster, CubeFace, CubeFrame,
    CubeShadowMap, CubeShadowMapDescriptor, DepthConvention, DirectionalLight, FlatLight, Light,
    PointLight, ShadowAtlas, ShadowAtlasDescriptor, ShadowFrame, ShadowMap, ShadowMapDescriptor,
    SpotLight, StaticLayers, TileSize, View, glam, wgpu,
};

pub const LAYER: u32 = 512;

pub fn descriptor(layers: u64) -> ShadowAtlasDescriptor<'static> {
    ShadowAtlasDescriptor {
        layer_size: LAYER,
        memory: layers * u64::from(LAYER).pow(2) * 4,
        ..Default::default()
    }
}

pub fn atlas(gpu: &Gpu, descriptor: &ShadowAtlasDescriptor<'_>) -> ShadowAtlas {
    ShadowAtlas::new(&gpu.device, descriptor).unwrap()
}

pub fn draw(gpu: &Gpu, atlas: &mut ShadowAtlas, frame: &AtlasFrame<'_>) {
    gpu.checked(|| {
        atlas.prepare(&gpu.device, &gpu.queue, frame).unwrap();
        gpu.run(|encoder| atlas.encode(encoder));
    });
}

/// The layers of an atlas as they are.
pub fn layers(gpu: &Gpu, atlas: &ShadowAtlas) -> Vec<Vec<f32>> {
    let read = |layer| {
        let bytes = gpu.read_texture(atlas.texture(), layer, wgpu::TextureAspect::All);
        bytemuck::pod_collect_to_vec(&bytes)
    };
    (0..atlas.statistics().layers).map(read).collect()
}

pub fn texels(layers: &[Vec<f32>], tile: &AtlasTile) -> Vec<f32> {
    let layer = &layers[tile.layer as usize];
    let row = |y: u32| {
        let start = ((tile.y + y) * LAYER + tile.x) as usize;
        layer[start..start + tile.size as usize].iter().copied()
    };
    (0..tile.size).flat_map(row).collect()
}

/// What a light's own maps hold, tile by tile.
fn own_maps(gpu: &Gpu, light: Light, tile: &AtlasTile, casters: &[Caster]) -> Vec<Vec<f32>> {
    let (size, placed) = (tile.size, tile.clip_from_world);
    let whole = wgpu::TextureAspect::All;
    let flat = |light: FlatLight| {
        let descriptor = ShadowMapDescriptor {
            size,
            ..Default::default()
        };
        let mut map = ShadowMap::new(&gpu.device, &descriptor).unwrap();
        let frame = ShadowFrame::new(light, casters);
        map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        gpu.run(|encoder| map.encode(encoder));
        if map.clip_from_world() != Some(placed) {
            return Vec::new(); // a sun's map stays where it was, as long as that will do
        }
        vec![bytemuck::pod_collect_to_vec(&gpu.read_texture(
            map.texture(),
            0,
            whole,
        ))]
    };
    match light {
        Light::Spot(light) => flat(light.into()),
        Light::Directional(light) => flat(light.into()),
        Light::Point(light) => {
            let descriptor = CubeShadowMapDescriptor {
                size,
                ..Default::default()
            };
            let mut map = CubeShadowMap::new(&gpu.device, &descriptor).unwrap();
            let frame = CubeFrame::new(light, casters);
            map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
            gpu.run(|encoder| map.encode(encoder));
            let face = |face: CubeFace| {
                let bytes = gpu.read_texture(map.texture(), face.layer(), whole);
                bytemuck::pod_collect_to_vec(&bytes)
            };
            CubeFace::ALL.map(face).into()
        }
        other => panic!("{other:?}"),
    }
}

/// Whether two depths differ by more than it can be that one was rasterised elsewhere in its layer: the
/// depth of a steep triangle, from rounded coordinates of its corners. (2^-14 is the most that was seen.)
fn differ(a: f32, b: f32) -> bool {
    (a - b).abs() > a.max(b) * f32::powi(2.0, -12)
}

/// Fails if more texels are wrong than outlines may cover or not, where a rounded corner goes to another
/// place of the rasteriser's grid: 1 of 69,632 was seen.
pub fn assert_few((wrong, all): (usize, usize), what: &str) {
    assert!(wrong * 20_000 <= all, "{what}: {wrong} of {all} are wrong");
}

/// How many texels of a frame's lights are not what they should be, and how many there are.
pub fn wrong_texels(
    gpu: &Gpu,
    atlas: &ShadowAtlas,
    lights: &[AtlasLight],
    casters: &[Caster],
) -> (usize, usize) {
    let layers = layers(gpu, atlas);
    let (mut wrong, mut all) = (0, 0);
    for (index, light) in lights.iter().enumerate() {
        let tiles = atlas.tiles(index, 0);
        let Some(first) = tiles.first() else {
            continue;
        };
        let own = own_maps(gpu, light.light(), first, casters);
        assert!(own.is_empty() || own.len() == tiles.len(), "light {index}");
        for (tile, own) in tiles.iter().zip(&own) {
            let here = texels(&layers, tile);
            all += own.len();
            wrong += here
                .iter()
                .zip(own)
                .filter(|(a, b)| differ(**a, **b))
                .count();
        }
    }
    (wrong, all)
}

pub fn room(gpu: &Gpu) -> Vec<Caster> {
    let ball = sphere(12, 8).mesh(&gpu.device);
    let block = cuboid(Vec3::ONE).mesh(&gpu.device);
    let mut random = Random::new(5);
    (0..24)
        .map(|i| {
            let at = Vec3::from_array(std::array::from_fn(|_| random.next() * 4.0));
            let mesh = if i % 2 == 0 { &ball } else { &block };
            let transform = Affine3A::from_scale_rotation_translation(
                Vec3::splat(0.3 + 0.2 * random.next().abs()),
                glam::Quat::from_rotation_y(random.next()),
                at,
            );
            Caster::new(mesh.clone(), transform)
        })
        .collect()
}

fn light(random: &mut Random, size: u32) -> AtlasLight {
    let mut vector = |scale: f32| Vec3::from_array(std::array::from_fn(|_| random.next() * scale));
    let (at, toward) = (vector(3.0), vector(1.0) + Vec3::Y * 0.1);
    let light = match (vector(1.0).x * 1.5) as i32 {
        0 => AtlasLight::new(PointLight::new(at, 6.0)),
        1 => AtlasLight::directional(DirectionalLight::new(toward), Cascades::default()),
        _ => AtlasLight::new(SpotLight::new(at, toward, 0.7, 8.0)),
    };
    light.with_size(TileSize::Fixed(size))
}

#[test]
fn a_tile_is_what_its_lights_own_map_holds() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = room(&gpu);
    let spot = SpotLight::new(Vec3::new(0.0, 5.0, 1.0), Vec3::NEG_Y, 0.6, 12.0);
    let sun = DirectionalLight::new(Vec3::new(0.3, 1.0, 0.2));
    let lights = [
        AtlasLight::new(PointLight::new(Vec3::new(0.2, 0.1, 0.3), 7.0))
            .with_size(TileSize::Fixed(128)),
        AtlasLight::new(spot).with_size(TileSize::Fixed(256)),
        AtlasLight::directional(sun, Cascades::default()).with_size(TileSize::Fixed(64)),
    ];
    let mut atlas = atlas(&gpu, &descriptor(4));
    let frame = AtlasFrame {
        lights: &lights,
        casters: &casters,
        ..Default::default()
    };
    draw(&gpu, &mut atlas, &frame);
    let (wrong, all) = wrong_texels(&gpu, &atlas, &lights, &casters);
    assert_few((wrong, all), "three lights");
    assert_eq!(all, 6 * 128 * 128 + 256 * 256 + 64 * 64);
    // In a layer's corner the arithmetic is the same.
    let tile = &atlas.tiles(1, 0)[0];
    assert_eq!((tile.x, tile.y), (0, 0));
    let own = own_maps(&gpu, lights[1].light(), tile, &casters);
    assert!(texels(&layers(&gpu, &atlas), tile) == own[0]);
    // The broken twin: the light has gone on, its tiles have not.
    let mut moved = lights;
    moved[0] = AtlasLight::new(PointLight::new(Vec3::new(0.3, 0.1, 0.3), 7.0));
    let (wrong, _) = wrong_texels(&gpu, &atlas, &moved, &casters);
    assert!(wrong > 1000, "{wrong}");
}

#[test]
fn nothing_that_came_before_is_seen_in_any_tile() {
    let Some(gpu) = Gpu::for_test() else { return };
    let [_, compared, copied, moved] = wander(&gpu, 120, |step| 1 + step % 3, 6);
    assert!(compared > 1_000_000, "{compared}");
    assert!(copied > 20 && moved > 10, "{copied} copied, {moved} moved");
}

#[test]
fn after_10_000_lights_and_casters_came_went_moved_and_changed_their_size_all_are_right() {
    let Some(gpu) = Gpu::for_test() else { return };
    let [changes, compared, ..] = wander(&gpu, 200, |_| 50, 8);
    assert!(
        changes == 10_000 && compared > 500_000,
        "{changes}, {compared}"
    );
}

/// Adds, removes, replaces and resizes lights and moves casters, so many a step, and compares every so many
/// steps every texel: how many changes, compared texels, copied tiles and moved lights there were.
fn wander(gpu: &Gpu, steps: usize, changes: fn(usize) -> usize, every: usize) -> [usize; 4] {
    let mut casters = room(gpu);
    let mut random = Random::new(11);
    let descriptor = ShadowAtlasDescriptor {
        static_layers: StaticLayers::AtLeast(1),
        ..descriptor(3)
    };
    let mut atlas = atlas(gpu, &descriptor);
    let size = |random: &mut Random| 64 << ((random.next().abs() * 1.99) as u32);
    let mut lights: Vec<AtlasLight> = Vec::new();
    let (mut all_changes, mut compared, mut copied, mut moved) = (0, 0, 0, 0);
    for step in 0..steps {
        for change in 0..changes(step) {
            all_changes += 1;
            let pick = (random.next().abs() * 0.999 * lights.len() as f32) as usize;
            match (random.next().abs() * 6.0) as u32 {
                0 if lights.len() > 1 => drop(lights.swap_remove(pick)),
                1 if lights.len() > 1 => drop(lights.remove(pick)),
                2 if !lights.is_empty() => lights[pick] = light(&mut random, size_of_step(step)),
                3 if !lights.is_empty() => {
                    lights[pick] = lights[pick].with_size(TileSize::Fixed(size(&mut random)));
                }
                4 if lights.len() < 8 => {
                    let size = size(&mut random);
                    lights.push(light(&mut random, size));
                }
                _ => {
                    let caster = (step + change) % 5;
                    casters[caster].world_from_object.translation.x += 0.1 * random.next();
                }
            }
        }
        let frame = AtlasFrame {
            lights: &lights,
            casters: &casters,
            ..Default::default()
        };
        // Now and then a frame is found and not drawn, or drawn and not submitted.
        if step % 7 == 3 {
            atlas.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        }
        if step % 11 == 5 {
            atlas.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
            atlas.encode(&mut gpu.device.create_command_encoder(&Default::default()));
        }
        draw(gpu, &mut atlas, &frame);
        let statistics = atlas.statistics();
        copied += statistics.tiles_copied as usize;
        moved += statistics.lights_moved as usize;
        if step % every == 0 {
            let (wrong, all) = wrong_texels(gpu, &atlas, &lights, &casters);
            assert_few((wrong, all), &format!("step {step}"));
            compared += all;
        }
    }
    [all_changes, compared, copied, moved]
}

fn size_of_step(step: usize) -> u32 {
    if step.is_multiple_of(2) { 64 } else { 128 }
}

#[test]
fn a_frame_in_which_nothing_changed_draws_and_uploads_nothing() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut casters = room(&gpu);
    let mut random = Random::new(3);
    let lights: Vec<_> = (0..8).map(|_| light(&mut random, 64)).collect();
    let mut atlas = atlas(&gpu, &descriptor(4));
    let frame = AtlasFrame {
        lights: &lights,
        casters: &casters,
        ..Default::default()
    };
    draw(&gpu, &mut atlas, &frame);
    let (first, revision) = (atlas.statistics(), atlas.revision());
    assert!(first.tiles_rendered > 8 && first.uploaded > 0);
    draw(&gpu, &mut atlas, &frame);
    let still = atlas.statistics();
    assert_eq!(
        (still.tiles_rendered, still.uploaded, still.draws),
        (0, 0, 0)
    );
    assert_eq!(atlas.revision(), revision);
    casters[0].world_from_object.translation.x += 0.01;
    let frame = AtlasFrame {
        lights: &lights,
        casters: &casters,
        ..Default::default()
    };
    draw(&gpu, &mut atlas, &frame);
    let moved = atlas.statistics();
    assert!(moved.tiles_rendered > 0 && moved.tiles_rendered < first.tiles_rendered);
}

#[test]
fn more_lights_leave_what_is_drawn_where_it_is() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = room(&gpu);
    let lamp =
        |x: f32| AtlasLight::new(PointLight::new(Vec3::X * x, 6.0)).with_size(TileSize::Fixed(256));
    let lights: Vec<_> = (0..6).map(|i| lamp(i as f32 * 0.3)).collect();
    let mut atlas = atlas(&gpu, &descriptor(12));
    let mut layers = 0;
    for count in 1..=lights.len() {
        let frame = AtlasFrame {
            lights: &lights[..count],
            casters: &casters,
            ..Default::default()
        };
        draw(&gpu, &mut atlas, &frame);
        let statistics = atlas.statistics();
        assert_eq!(
            statistics.tiles_rendered + statistics.tiles_empty,
            6,
            "{count} lights"
        );
        assert!(statistics.layers >= layers);
        layers = statistics.layers;
        assert_few(
            wrong_texels(&gpu, &atlas, &lights[..count], &casters),
            "lights of the last frame",
        );
    }
    assert_eq!(layers, 9);
    assert_eq!(atlas.statistics().texels, 36 * 256 * 256);
}

#[test]
fn lights_that_do_not_cast_take_no_memory_and_short_memory_leaves_no_light_out() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = room(&gpu);
    let mut atlas = atlas(&gpu, &descriptor(2));
    let far =
        AtlasLight::new(PointLight::new(Vec3::splat(1000.0), 5.0)).with_size(TileSize::Fixed(64));
    let frame = AtlasFrame {
        lights: &[far; 9],
        casters: &casters,
        ..Default::default()
    };
    draw(&gpu, &mut atlas, &frame);
    let statistics = atlas.statistics();
    assert_eq!((statistics.layers, statistics.texels), (0, 0));
    assert_eq!(statistics.tiles_empty, 54);

    let at = |x: f32| PointLight::new(Vec3::X * x, 6.0);
    let auto = TileSize::Auto {
        least: 16,
        most: 256,
    };
    let lights: Vec<_> = (0..12)
        .map(|i| AtlasLight::new(at(i as f32 * 0.2)).with_size(auto))
        .collect();
    let frame = AtlasFrame {
        lights: &lights,
        ..frame
    };
    draw(&gpu, &mut atlas, &frame);
    let statistics = atlas.statistics();
    assert_eq!(statistics.layers, 2);
    assert!(statistics.lights_reduced > 0);
    let sizes: Vec<u32> = (0..12).map(|i| atlas.tiles(i, 0)[0].size).collect();
    assert!(sizes.iter().all(|&size| size >= 16), "{sizes:?}");
    assert_few(
        wrong_texels(&gpu, &atlas, &lights, &casters),
        "lights of the last frame",
    );

    let fixed: Vec<_> = lights
        .iter()
        .map(|light| light.with_size(TileSize::Fixed(256)))
        .collect();
    let frame = AtlasFrame {
        lights: &fixed,
        ..frame
    };
    let error = atlas.prepare(&gpu.device, &gpu.queue, &frame).unwrap_err();
    assert!(matches!(
        error,
        ShadowAtlasError::Space(TileSizeError::Space { lights: 12, .. })
    ));
    // What was drawn still stands.
    assert_few(
        wrong_texels(&gpu, &atlas, &lights, &casters),
        "lights of the last frame",
    );
}

#[test]
fn a_frame_that_is_refused_late_leaves_what_receivers_see_and_nothing_to_draw() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = room(&gpu);
    let mut atlas = atlas(&gpu, &descriptor(2));
    let lamp = AtlasLight::new(PointLight::new(Vec3::Y, 6.0)).with_size(TileSize::Fixed(64));
    let spot = SpotLight::new(Vec3::Y, Vec3::NEG_Y, 0.7, 9.0);
    let spot = AtlasLight::new(spot).with_size(TileSize::Fixed(64));
    let frame = AtlasFrame {
        lights: &[lamp],
        casters: &casters,
        ..Default::default()
    };
    draw(&gpu, &mut atlas, &frame);
    // Found and not encoded; then one that does not fit, with another kind of light in its place.
    let mut moved = casters.clone();
    moved[0].world_from_object.translation += Vec3A::splat(0.3);
    let waiting = AtlasFrame {
        casters: &moved,
        ..frame
    };
    atlas.prepare(&gpu.device, &gpu.queue, &waiting).unwrap();
    let large = lamp.with_size(TileSize::Fixed(LAYER));
    let refused = AtlasFrame {
        lights: &[spot, large],
        ..waiting
    };
    let error = atlas.prepare(&gpu.device, &gpu.queue, &refused);
    assert!(matches!(error, Err(ShadowAtlasError::Space(_))));
    let before = layers(&gpu, &atlas);
    gpu.checked(|| gpu.run(|encoder| atlas.encode(encoder)));
    assert!(layers(&gpu, &atlas) == before, "nothing was drawn");
    for lights in [[spot], [lamp]] {
        let frame = AtlasFrame {
            lights: &lights,
            ..waiting
        };
        draw(&gpu, &mut atlas, &frame);
        assert_few(
            wrong_texels(&gpu, &atlas, &lights, &moved),
            "the frame after",
        );
    }
}

#[test]
fn a_budget_is_kept_and_nothing_waits_for_ever() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut casters = room(&gpu);
    let lights: Vec<_> = (0..6)
        .map(|i| {
            let light = SpotLight::new(Vec3::X * (i as f32 - 3.0), Vec3::NEG_Y, 0.7, 9.0);
            AtlasLight::new(light).with_size(TileSize::Fixed(64))
        })
        .collect();
    let descriptor = ShadowAtlasDescriptor {
        max_tiles_per_frame: Some(2),
        ..descriptor(1)
    };
    let mut atlas = atlas(&gpu, &descriptor);
    let mut oldest = 0;
    for step in 0..20 {
        for caster in &mut casters {
            caster.world_from_object.translation.y += 0.01;
        }
        let frame = AtlasFrame {
            lights: &lights,
            casters: &casters,
            ..Default::default()
        };
        draw(&gpu, &mut atlas, &frame);
        let statistics = atlas.statistics();
        assert!(statistics.tiles_rendered <= 2, "{statistics:?}");
        assert!(statistics.tiles_postponed >= 4, "{step}: {statistics:?}");
        let ages = (0..6).map(|light| atlas.tiles(light, 0)[0].statistics.age);
        oldest = ages.fold(oldest, u32::max);
    }
    let bound = atlas.max_age().unwrap();
    assert!(oldest > 1 && oldest <= bound, "{oldest} of {bound}");
    // A size that changes does not wait.
    let larger: Vec<_> = lights
        .iter()
        .map(|light| light.with_size(TileSize::Fixed(128)))
        .collect();
    let frame = AtlasFrame {
        lights: &larger,
        casters: &casters,
        ..Default::default()
    };
    draw(&gpu, &mut atlas, &frame);
    assert_eq!(atlas.statistics().lights_moved, 6);
    assert_few(
        wrong_texels(&gpu, &atlas, &larger, &casters),
        "lights of the last frame",
    );
}

fn camera(eye: Vec3, target: Vec3) -> View {
    let projection = proj::perspective_infinite_reverse(1.2, 1.5, 0.1);
    let matrix = projection * view::look_at_mat4(eye, target, Vec3::Y);
    View::new(matrix, DepthConvention::InfiniteReverse).unwrap()
}

#[test]
fn a_sun_has_cascades_for_each_view() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = room(&gpu);
    let cascades = Cascades {
        count: 3,
        distance: 12.0,
        ..Default::default()
    };
    let sun = DirectionalLight::new(Vec3::new(0.4, 1.0, 0.3));
    let lights = [
        AtlasLight::new(PointLight::new(Vec3::Y, 5.0)).with_size(TileSize::Fixed(64)),
        AtlasLight::directional(sun, cascades).with_size(TileSize::Fixed(128)),
    ];
    let views = [
        camera(Vec3::new(5.0, 2.0, 5.0), Vec3::ZERO),
        camera(Vec3::new(-6.0, 3.0, 1.0), Vec3::X),
    ];
    let seen = [
        AtlasView::new(&views[0], 300, 200),
        AtlasView::new(&views[1], 300, 200),
    ];
    let frame = AtlasFrame {
        lights: &lights,
        casters: &casters,
        views: &seen,
        receivers: None,
    };
    let mut both = atlas(&gpu, &descriptor(4));
    draw(&gpu, &mut both, &frame);
    let of_both = layers(&gpu, &both);
    assert_eq!(both.light_index(1, 1), 3);
    for (view, seen) in seen.iter().enumerate() {
        let mut one = atlas(&gpu, &descriptor(4));
        let frame = AtlasFrame {
            views: std::slice::from_ref(seen),
            ..frame
        };
        draw(&gpu, &mut one, &frame);
        let of_one = layers(&gpu, &one);
        let tiles = both.tiles(1, view);
        assert_eq!(tiles.len(), 3);
        for (ours, theirs) in tiles.iter().zip(one.tiles(1, 0)) {
            assert_eq!(ours.clip_from_world, theirs.clip_from_world);
            let (ours, theirs) = (texels(&of_both, ours), texels(&of_one, &theirs));
            let wrong = ours.iter().zip(&theirs).filter(|(a, b)| differ(**a, **b));
            assert_few((wrong.count(), ours.len() * 2), "cascade of a view");
        }
        // The broken twin.
        let other = &both.tiles(1, 1 - view)[0];
        assert_ne!(
            texels(&of_both, other),
            texels(&of_one, &one.tiles(1, 0)[0])
        );
    }
    // A camera that turns in place draws no cascade again.
    let turned = camera(Vec3::new(5.0, 2.0, 5.0), Vec3::new(0.5, 0.0, 0.3));
    let turned = [AtlasView::new(&turned, 300, 200), seen[1]];
    let frame = AtlasFrame {
        views: &turned,
        ..frame
    };
    draw(&gpu, &mut both, &frame);
    let states = both.tiles(1, 0);
    let drawn = states
        .iter()
        .filter(|tile| tile.statistics.state == shadows::TileState::Rendered);
    assert_eq!(drawn.count(), 0);
}
