//! One renderer for all lights and views of a frame: each picture as alone, at the price of what changed.

use std::num::NonZeroU32;

use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use shadows::error::VolumeRenderError;
use shadows::glam::{Quat, Vec3};
use shadows::{
    Caster, HomogeneousLight, ShadowVolumeFrame, ShadowVolumeRenderer, Silhouettes, VolumeLight,
    VolumeStatistics, VolumeView, wgpu,
};

use crate::kept::{Theatre, WALL, is_shown};
use crate::passes::{attach, begin, view_of};
use crate::pictures::{mixed, sun};
use crate::stage::WAYS;
use host::gpu::Gpu;
use host::one_light::OneLight;

/// Lights, views and casters that a frame is made of.
#[derive(Clone)]
struct Scene {
    lights: Vec<VolumeLight>,
    views: Vec<VolumeView>,
    casters: Vec<Caster>,
}

impl Scene {
    fn frame(&self) -> ShadowVolumeFrame<'_> {
        ShadowVolumeFrame {
            lights: &self.lights,
            views: &self.views,
            casters: &self.casters,
            ..Default::default()
        }
    }

    /// What a new renderer of one light and one view counts.
    fn alone(&self, theatre: &Theatre, way: Silhouettes, light: usize, view: usize) -> Vec<u8> {
        let VolumeLight { light, range, .. } = self.lights[light];
        let one = OneLight {
            range,
            ..OneLight::new(&self.views[view].view, light, &self.casters)
        };
        theatre.fresh(way, &one)
    }
}

fn eye(turn: f32) -> VolumeView {
    let mut stage = mixed(sun());
    stage.eye = Quat::from_rotation_y(turn) * Vec3::new(1.0, 5.0, 9.0);
    stage.view().into()
}

fn lamp_at(turn: f32) -> VolumeLight {
    let place = Quat::from_rotation_y(turn) * Vec3::new(-2.0, 6.0, 2.5);
    VolumeLight::new(HomogeneousLight::point(place), Some(12.0))
}

fn scene(theatre: &Theatre) -> Scene {
    Scene {
        lights: vec![lamp_at(0.0), sun().into(), lamp_at(2.0)],
        views: vec![eye(0.0), eye(0.7)],
        casters: theatre.casters(0..24),
    }
}

/// The counts of each light in each view, all drawn in one submission, the last first.
fn draw(
    theatre: &Theatre,
    renderer: &mut ShadowVolumeRenderer,
    scene: &Scene,
) -> (Vec<Vec<Vec<u8>>>, VolumeStatistics) {
    let gpu = &theatre.gpu;
    renderer
        .prepare(&gpu.device, &gpu.queue, &scene.frame())
        .unwrap();
    let statistics = renderer.statistics();
    let row = || scene.views.iter().map(|_| theatre.target()).collect();
    let targets: Vec<Vec<wgpu::Texture>> = scene.lights.iter().map(|_| row()).collect();
    gpu.run(|encoder| {
        renderer.encode(encoder);
        for (light, targets) in targets.iter().enumerate().rev() {
            for (view, target) in targets.iter().enumerate().rev() {
                let depth = view_of(target);
                let mut pass = begin(encoder, "counts", &[], attach(&depth, Some(WALL)));
                renderer.render(&mut pass, light, view).unwrap();
            }
        }
    });
    let read = |target: &wgpu::Texture| theatre.counts(target);
    let rows = targets.iter().map(|row| row.iter().map(read).collect());
    (rows.collect(), statistics)
}

#[test]
fn every_light_in_every_view_is_as_alone() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    let scene = scene(&theatre);
    for way in WAYS {
        let (counts, _) = draw(&theatre, &mut theatre.renderer(way), &scene);
        let mut seen: Vec<&Vec<u8>> = Vec::new();
        for (light, row) in counts.iter().enumerate() {
            for (view, counts) in row.iter().enumerate() {
                assert!(is_shown(counts), "{way:?}, light {light}, view {view}");
                let alone = scene.alone(&theatre, way, light, view);
                assert!(*counts == alone, "{way:?}, light {light}, view {view}");
                // No two are alike: whoever swaps them sees it.
                assert!(!seen.contains(&counts));
                seen.push(counts);
            }
        }
    }
}

#[test]
fn lights_cast_what_is_on_their_layers_and_not_what_is_their_owners() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    let owner = NonZeroU32::new(7).unwrap();
    for way in WAYS {
        let mut scene = scene(&theatre);
        for (i, caster) in scene.casters.iter_mut().enumerate() {
            caster.layers = 1 << (i % 3);
            caster.owner = (i % 4 == 0).then_some(owner);
        }
        let mut renderer = theatre.renderer(way);
        // As with the casters alone that a light casts the shadows of.
        let mut check = |scene: &Scene, light: usize, casts: fn(&Caster) -> bool| {
            let (counts, statistics) = draw(&theatre, &mut renderer, scene);
            let mut admitted = scene.clone();
            admitted.casters.retain(casts);
            for (view, counts) in counts[light].iter().enumerate() {
                let of = |scene: &Scene| scene.alone(&theatre, way, light, view);
                assert!(
                    *counts == of(&admitted),
                    "{way:?}, light {light}, view {view}"
                );
                // The broken twin: a light that takes no notice.
                assert!(*counts != of(scene), "{way:?}, light {light}, view {view}");
            }
            statistics.skipped_masked
        };
        scene.lights[0] = lamp_at(0.0).with_layers(0b011);
        assert_eq!(check(&scene, 0, |caster| caster.layers & 0b011 != 0), 2 * 8);
        scene.lights[2] = lamp_at(2.0).owned_by(owner);
        assert_eq!(
            check(&scene, 2, |caster| caster.owner.is_none()),
            2 * (8 + 6)
        );
        // Another mask, and other layers of a caster, with all else as it was.
        scene.lights[0] = lamp_at(0.0).with_layers(0b100);
        assert_eq!(
            check(&scene, 0, |caster| caster.layers & 0b100 != 0),
            2 * (16 + 6)
        );
        scene.casters[0].layers = 0b110;
        assert_eq!(
            check(&scene, 0, |caster| caster.layers & 0b100 != 0),
            2 * (15 + 6)
        );
    }
}

#[test]
fn what_a_light_casts_is_found_once_for_all_views() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    let both = scene(&theatre);
    for way in [Silhouettes::Compute, Silhouettes::Cpu] {
        let found = |views: &[VolumeView]| {
            let scene = Scene {
                views: views.to_vec(),
                ..both.clone()
            };
            draw(&theatre, &mut theatre.renderer(way), &scene).1
        };
        let (two, one) = (found(&both.views), found(&both.views[..1]));
        assert_eq!(two.casters_extracted, one.casters_extracted, "{way:?}");
        assert!(two.casters_drawn > one.casters_drawn, "{way:?}");
        // Three lights have three volumes of each caster.
        assert_eq!(one.casters_extracted, 3 * 24, "{way:?}");
    }
}

#[test]
fn what_did_not_change_is_neither_searched_nor_uploaded() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    let mut scene = scene(&theatre);
    // Without a range, volumes end at infinity, wherever the eye is.
    scene.lights.iter_mut().for_each(|light| light.range = None);
    for way in [Silhouettes::Compute, Silhouettes::Cpu, Silhouettes::Vertex] {
        let mut scene = scene.clone();
        let mut renderer = theatre.renderer(way);
        let mut draw = |scene: &Scene| {
            let (counts, statistics) = draw(&theatre, &mut renderer, scene);
            for (light, row) in counts.iter().enumerate() {
                for (view, counts) in row.iter().enumerate() {
                    assert!(*counts == scene.alone(&theatre, way, light, view));
                }
            }
            let VolumeStatistics {
                casters_extracted,
                uploaded,
                dispatches,
                ..
            } = statistics;
            assert_eq!(
                dispatches > 0,
                way == Silhouettes::Compute && casters_extracted > 0
            );
            (casters_extracted, uploaded)
        };
        let searches = u32::from(way != Silhouettes::Vertex);
        let (_, first) = draw(&scene);
        assert!(first > 100 * 6 * 24, "{way:?}: {first}");
        assert_eq!(draw(&scene), (0, 0), "{way:?}");
        // The order means nothing.
        scene.casters.rotate_left(5);
        assert_eq!(draw(&scene), (0, 0), "{way:?}");
        scene.views[1] = eye(0.71);
        let (searched, uploaded) = draw(&scene);
        assert_eq!(searched, 0, "{way:?}");
        // One window for the view, and those of casters that are counted in another way.
        assert!(
            uploaded > 0 && uploaded < first / 8,
            "{way:?}: {uploaded}, {first}"
        );
        scene.casters[3].world_from_object.translation.x += 0.1;
        let (searched, uploaded) = draw(&scene);
        // The sun meets it as before.
        assert_eq!(searched, 2 * searches, "{way:?}");
        assert!(
            uploaded > 0 && uploaded < first / 8,
            "{way:?}: {uploaded}, {first}"
        );
        scene.lights[2] = VolumeLight {
            range: None,
            ..lamp_at(2.1)
        };
        let (searched, uploaded) = draw(&scene);
        assert_eq!(searched, 24 * searches, "{way:?}");
        assert!(uploaded < first / 2, "{way:?}: {uploaded}, {first}");
        assert_eq!(draw(&scene), (0, 0), "{way:?}");
    }
}

/// What happens between two frames.
#[derive(Clone, Debug)]
enum Event {
    Come(usize, usize),
    ComeMany(usize),
    Go(usize),
    Swap(usize, usize),
    Move(usize, usize),
    Twin(usize),
    LightMoves(usize, u8),
    LightComes(u8),
    LightGoes(usize),
    ViewMoves(usize, u8),
    ViewComes(u8),
    ViewGoes(usize),
    /// The frame is prepared, and no more.
    Forget,
    /// The frame is encoded, and the encoder dropped.
    Drop,
}

fn event() -> impl Strategy<Value = Event> {
    let at = || 0_usize..30;
    let of_few = || 0_usize..3;
    prop_oneof![
        3 => (at(), 0_usize..500).prop_map(|(place, number)| Event::Come(place, number)),
        1 => (0_usize..500).prop_map(Event::ComeMany),
        3 => at().prop_map(Event::Go),
        1 => (at(), at()).prop_map(|(a, b)| Event::Swap(a, b)),
        3 => (at(), 0_usize..500).prop_map(|(place, number)| Event::Move(place, number)),
        1 => at().prop_map(Event::Twin),
        2 => (of_few(), any::<u8>()).prop_map(|(place, turn)| Event::LightMoves(place, turn)),
        1 => any::<u8>().prop_map(Event::LightComes),
        1 => of_few().prop_map(Event::LightGoes),
        2 => (of_few(), any::<u8>()).prop_map(|(place, turn)| Event::ViewMoves(place, turn)),
        1 => any::<u8>().prop_map(Event::ViewComes),
        1 => of_few().prop_map(Event::ViewGoes),
        1 => Just(Event::Forget),
        1 => Just(Event::Drop),
    ]
}

impl Scene {
    fn happens(&mut self, event: &Event, theatre: &Theatre) {
        let turned = |n: u8| 0.025 * f32::from(n);
        let Self {
            lights,
            views,
            casters,
        } = self;
        let count = casters.len();
        match *event {
            Event::Come(place, number) => casters.insert(place.min(count), theatre.caster(number)),
            Event::ComeMany(first) => casters.extend(theatre.casters(first..first + 40)),
            Event::Go(place) if place < count => {
                casters.remove(place);
            }
            Event::Swap(a, b) if a.max(b) < count => casters.swap(a, b),
            Event::Move(place, number) if place < count => {
                casters[place].world_from_object = theatre.caster(number).world_from_object;
            }
            Event::Twin(place) if place < count => casters.push(casters[place].clone()),
            Event::LightMoves(place, turn) if place < lights.len() => {
                lights[place] = lamp_at(turned(turn));
            }
            Event::LightComes(turn) if lights.len() < 3 => lights.push(lamp_at(turned(turn))),
            Event::LightGoes(place) if place < lights.len() => {
                lights.remove(place);
            }
            Event::ViewMoves(place, turn) if place < views.len() => {
                views[place] = eye(turned(turn));
            }
            Event::ViewComes(turn) if views.len() < 3 => views.push(eye(turned(turn))),
            Event::ViewGoes(place) if place < views.len() => {
                views.remove(place);
            }
            _ => {}
        }
    }
}

#[test]
fn whatever_happens_pictures_are_those_of_fresh_renderers() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    let mut runner = TestRunner::new(Config {
        cases: 8,
        failure_persistence: None,
        ..Config::default()
    });
    let events = prop::collection::vec(event(), 1..12);
    let result = runner.run(&events, |events| {
        for way in [Silhouettes::Compute, Silhouettes::Cpu] {
            let mut renderer = theatre.renderer(way);
            let mut scene = scene(&theatre);
            scene.lights.truncate(2);
            scene.casters.truncate(12);
            for event in &events {
                scene.happens(event, &theatre);
                let (device, queue) = (&theatre.gpu.device, &theatre.gpu.queue);
                match event {
                    Event::Forget => renderer.prepare(device, queue, &scene.frame()).unwrap(),
                    Event::Drop => {
                        renderer.prepare(device, queue, &scene.frame()).unwrap();
                        renderer.encode(&mut device.create_command_encoder(&Default::default()));
                    }
                    _ => {
                        let (counts, _) = draw(&theatre, &mut renderer, &scene);
                        for (light, row) in counts.iter().enumerate() {
                            for (view, counts) in row.iter().enumerate() {
                                let alone = scene.alone(&theatre, way, light, view);
                                prop_assert!(*counts == alone, "{:?} {} {}", way, light, view);
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    });
    result.unwrap();
}

#[test]
fn a_light_or_view_that_was_not_prepared_is_refused() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    let scene = scene(&theatre);
    let mut renderer = theatre.renderer(Silhouettes::Auto);
    draw(&theatre, &mut renderer, &scene);
    let target = theatre.target();
    for (light, view) in [(3, 0), (0, 2), (7, 7)] {
        theatre.gpu.run(|encoder| {
            let depth = view_of(&target);
            let mut pass = begin(encoder, "counts", &[], attach(&depth, Some(WALL)));
            let refused = VolumeRenderError::NoSuch {
                light,
                view,
                lights: 3,
                views: 2,
            };
            assert_eq!(renderer.render(&mut pass, light, view), Err(refused));
            assert_eq!(renderer.render(&mut pass, 2, 1), Ok(()));
        });
        assert!(renderer.caster_states(light, view).is_empty());
        assert_eq!(renderer.count_bound(light, view), 0);
        assert!(renderer.survey(light, view, [64; 2]).is_err());
    }
    assert_eq!(renderer.caster_states(2, 1).len(), 24);
    assert!(renderer.count_bound(2, 1) > 0);
}
