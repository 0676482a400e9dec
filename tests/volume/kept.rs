//! What a frame's change costs, and that what is kept is what would be found anew.

use host::one_light::{OneLight, PrepareOne as _};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use shadows::error::VolumeRenderError;
use shadows::glam::{Affine3A, Quat, Vec3};
use shadows::mesh::Adjacency;
use shadows::{
    Caster, CasterMesh, HomogeneousLight, ShadowVolumeDescriptor, ShadowVolumeRenderer,
    Silhouettes, View, VolumeStatistics, wgpu,
};

use crate::passes::{attach, begin, view_of};
use crate::pictures::{at, lamp, mixed, sun};
use crate::shapes;
use host::gpu::Gpu;

pub const SIDE: u32 = 48;
/// What is visible: a wall behind the casters.
pub const WALL: f32 = 0.009;
/// The ways that keep something.
const KEEPING: [Silhouettes; 2] = [Silhouettes::Compute, Silhouettes::Cpu];
const RANGE: f32 = 12.0;

pub struct Theatre {
    pub gpu: Gpu,
    pub meshes: Vec<CasterMesh>,
}

impl Theatre {
    pub fn new(gpu: Gpu) -> Self {
        let shapes = [
            shapes::cube(),
            shapes::sphere(7),
            shapes::fins(3),
            shapes::sphere(4),
        ];
        let mesh = |shape: &shapes::Shape| {
            let adjacency = Adjacency::new(&shape.positions, &shape.indices).unwrap();
            CasterMesh::new(&gpu.device, &shape.positions, &adjacency).unwrap()
        };
        Self {
            meshes: shapes.iter().map(mesh).collect(),
            gpu,
        }
    }

    pub fn renderer(&self, silhouettes: Silhouettes) -> ShadowVolumeRenderer {
        let descriptor = ShadowVolumeDescriptor {
            silhouettes,
            ..Default::default()
        };
        ShadowVolumeRenderer::new(&self.gpu.device, &descriptor).unwrap()
    }

    /// A caster of this number: every number has its own place and turn.
    pub fn caster(&self, number: usize) -> Caster {
        let n = number as f32;
        let place = Vec3::new(
            (n * 0.61).sin() * 3.0,
            1.0 + (n * 0.37).sin(),
            (n * 1.13).cos() * 3.0,
        );
        let turn = Quat::from_rotation_y(n * 0.1) * Quat::from_rotation_x(n * 0.07);
        let transform = Affine3A::from_scale_rotation_translation(Vec3::splat(0.3), turn, place);
        Caster::new(self.meshes[number % self.meshes.len()].clone(), transform)
    }

    pub fn casters(&self, numbers: impl IntoIterator<Item = usize>) -> Vec<Caster> {
        numbers.into_iter().map(|n| self.caster(n)).collect()
    }

    pub fn target(&self) -> wgpu::Texture {
        let format = ShadowVolumeDescriptor::default().depth_stencil_format;
        self.gpu.target([SIDE; 2], format, 1)
    }

    pub fn prepare(&self, renderer: &mut ShadowVolumeRenderer, frame: &OneLight<'_>) {
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        renderer.prepare_one(device, queue, frame).unwrap();
    }

    pub fn counts(&self, target: &wgpu::Texture) -> Vec<u8> {
        self.gpu
            .read_texture(target, 0, wgpu::TextureAspect::StencilOnly)
    }

    /// The counts that a renderer comes to, and its statistics.
    pub fn draw(
        &self,
        renderer: &mut ShadowVolumeRenderer,
        frame: &OneLight<'_>,
    ) -> (Vec<u8>, VolumeStatistics) {
        self.prepare(renderer, frame);
        let statistics = renderer.statistics();
        let target = self.target();
        self.gpu.run(|encoder| {
            renderer.encode(encoder);
            count(renderer, encoder, &target);
        });
        (self.counts(&target), statistics)
    }

    /// The counts that a new renderer comes to.
    pub fn fresh(&self, way: Silhouettes, frame: &OneLight<'_>) -> Vec<u8> {
        self.draw(&mut self.renderer(way), frame).0
    }
}

/// Counts volumes before the wall.
pub fn count(
    renderer: &ShadowVolumeRenderer,
    encoder: &mut wgpu::CommandEncoder,
    target: &wgpu::Texture,
) {
    let view = view_of(target);
    let mut pass = begin(encoder, "counts", &[], attach(&view, Some(WALL)));
    renderer.render(&mut pass, 0, 0).unwrap();
}

pub fn frame<'a>(view: &'a View, light: HomogeneousLight, casters: &'a [Caster]) -> OneLight<'a> {
    OneLight {
        range: (!light.is_directional()).then_some(RANGE),
        ..OneLight::new(view, light, casters)
    }
}

pub fn is_shown(counts: &[u8]) -> bool {
    counts.iter().filter(|&&count| count > 0).count() > 10
}

#[test]
fn a_change_in_the_list_costs_what_changed() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    let view = mixed(lamp()).view();
    for way in KEEPING {
        let mut renderer = theatre.renderer(way);
        let mut draw = |what: &str, casters: &[Caster], searched: u32| {
            let frame = frame(&view, lamp(), casters);
            let (counts, statistics) = theatre.draw(&mut renderer, &frame);
            assert!(is_shown(&counts), "{way:?}, {what}");
            assert_eq!(statistics.casters_extracted, searched, "{way:?}, {what}");
            let most = match way {
                // Those who go are taken from their draws.
                Silhouettes::Compute if searched == 0 => 1,
                Silhouettes::Compute => 3,
                _ => 0,
            };
            assert!(statistics.dispatches <= most, "{way:?}, {what}");
            assert!(statistics.dispatches >= most.min(searched));
            assert!(counts == theatre.fresh(way, &frame), "{way:?}, {what}");
            statistics.dispatches
        };
        let mut casters = theatre.casters(0..40);
        draw("the first frame", &casters, 40);
        let first = casters.remove(0);
        draw("the first one goes", &casters, 0);
        casters.remove(20);
        draw("one in the middle goes", &casters, 0);
        casters.pop();
        draw("the last one goes", &casters, 0);
        casters.insert(0, first);
        draw("one comes in front of all others", &casters, 1);
        casters.reverse();
        assert_eq!(draw("another order", &casters, 0), 0);
        let there = casters[5].world_from_object;
        casters[5].world_from_object.translation.y += 100.0;
        draw("one leaves the range", &casters, 0);
        casters[5].world_from_object = there;
        draw("it comes back", &casters, 1);
        casters.extend(theatre.casters(100..400));
        draw("so many come that buffers grow", &casters, 300);
        assert_eq!(draw("and nothing changes", &casters, 0), 0);
        casters.truncate(10);
        draw("and they go", &casters, 0);
        casters[3].world_from_object.translation.x += 0.1;
        draw("one moves", &casters, 1);
        casters.push(casters[4].clone());
        draw("one gets a twin", &casters, 0);
        casters.remove(4);
        draw("and leaves it alone", &casters, 0);
    }
}

#[test]
fn what_the_sun_meets_alike_is_searched_once() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    let view = mixed(sun()).view();
    let place =
        |n: usize| at(n as f32 * 0.7 - 3.0, 1.0, 0.0) * Affine3A::from_scale(Vec3::splat(0.3));
    let mut casters: Vec<Caster> = (0..9)
        .map(|n| Caster::new(theatre.meshes[n % 2].clone(), place(n)))
        .collect();
    for way in KEEPING {
        let mut renderer = theatre.renderer(way);
        let (counts, statistics) = theatre.draw(&mut renderer, &frame(&view, sun(), &casters));
        assert_eq!(
            [statistics.casters_drawn, statistics.casters_extracted],
            [9, 2]
        );
        // Each alone, added up: the same shadows.
        let mut sum = vec![0_u8; counts.len()];
        for caster in &casters {
            let alone = std::slice::from_ref(caster);
            let counts = theatre.fresh(way, &frame(&view, sun(), alone));
            sum.iter_mut()
                .zip(counts)
                .for_each(|(sum, c)| *sum = sum.wrapping_add(c));
        }
        assert!(is_shown(&sum), "{way:?}");
        assert!(counts == sum, "{way:?}");
        // Moved along, they look the same to the sun; turned, they do not.
        casters[0].world_from_object.translation.z += 0.5;
        let moved = theatre
            .draw(&mut renderer, &frame(&view, sun(), &casters))
            .1;
        assert_eq!(moved.casters_extracted, 0, "{way:?}");
        casters[0].world_from_object = place(0) * Affine3A::from_rotation_x(0.3);
        let turned = theatre
            .draw(&mut renderer, &frame(&view, sun(), &casters))
            .1;
        assert_eq!(turned.casters_extracted, 1, "{way:?}");
        casters[0].world_from_object = place(0);
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
    Light(u8),
    Camera(u8),
    /// The frame is prepared, and no more.
    Forget,
    /// The frame is encoded, and the encoder dropped.
    Drop,
}

fn event() -> impl Strategy<Value = Event> {
    let at = || 0_usize..60;
    prop_oneof![
        3 => (at(), 0_usize..500).prop_map(|(place, number)| Event::Come(place, number)),
        1 => (0_usize..500).prop_map(Event::ComeMany),
        3 => at().prop_map(Event::Go),
        1 => (at(), at()).prop_map(|(a, b)| Event::Swap(a, b)),
        2 => (at(), 0_usize..500).prop_map(|(place, number)| Event::Move(place, number)),
        1 => at().prop_map(Event::Twin),
        1 => any::<u8>().prop_map(Event::Light),
        1 => any::<u8>().prop_map(Event::Camera),
        1 => Just(Event::Forget),
        1 => Just(Event::Drop),
    ]
}

/// A scene that events happen to.
struct Play {
    casters: Vec<Caster>,
    light: HomogeneousLight,
    eye: Vec3,
}

impl Play {
    /// How many casters have to be searched at most; `None`: all.
    fn happens(&mut self, event: &Event, theatre: &Theatre) -> Option<usize> {
        let casters = &mut self.casters;
        let count = casters.len();
        let turned = |n: u8| 0.02 * f32::from(n);
        match *event {
            Event::Come(place, number) => {
                casters.insert(place.min(count), theatre.caster(number));
                return Some(1);
            }
            Event::ComeMany(first) => {
                casters.extend(theatre.casters(first..first + 60));
                return Some(60);
            }
            Event::Go(place) if place < count => {
                casters.remove(place);
            }
            Event::Swap(a, b) if a.max(b) < count => casters.swap(a, b),
            Event::Move(place, number) if place < count => {
                casters[place].world_from_object = theatre.caster(number).world_from_object;
                return Some(1);
            }
            Event::Twin(place) if place < count => casters.push(casters[place].clone()),
            Event::Light(turn) => {
                let turn = turned(turn);
                self.light = HomogeneousLight::point(Vec3::new(-2.0 + turn, 6.0, 2.5));
                return None;
            }
            // What was out of view has no volume yet.
            Event::Camera(turn) => {
                self.eye = Quat::from_rotation_y(turned(turn)) * Vec3::new(1.0, 5.0, 9.0);
                return None;
            }
            Event::Forget | Event::Drop => return None,
            _ => {}
        }
        Some(0)
    }
}

#[test]
fn whatever_comes_and_goes_pictures_are_those_of_a_fresh_renderer() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    let mut runner = TestRunner::new(Config {
        cases: 12,
        failure_persistence: None,
        ..Config::default()
    });
    let events = prop::collection::vec(event(), 1..14);
    let result = runner.run(&events, |events| {
        for way in KEEPING {
            let mut renderer = theatre.renderer(way);
            let mut play = Play {
                casters: theatre.casters(0..12),
                light: lamp(),
                eye: Vec3::new(1.0, 5.0, 9.0),
            };
            let mut known = false;
            for event in &events {
                let most = play.happens(event, &theatre);
                let mut stage = mixed(play.light);
                stage.eye = play.eye;
                let view = stage.view();
                let frame = frame(&view, play.light, &play.casters);
                let encoder = &mut theatre
                    .gpu
                    .device
                    .create_command_encoder(&Default::default());
                match event {
                    Event::Forget => theatre.prepare(&mut renderer, &frame),
                    Event::Drop => {
                        theatre.prepare(&mut renderer, &frame);
                        renderer.encode(encoder);
                    }
                    _ => {
                        let (counts, statistics) = theatre.draw(&mut renderer, &frame);
                        prop_assert!(counts == theatre.fresh(way, &frame), "{:?}", way);
                        if let Some(most) = most.filter(|_| known) {
                            prop_assert!(statistics.casters_extracted as usize <= most);
                        }
                    }
                }
                known = most.is_some();
            }
        }
        Ok(())
    });
    result.unwrap();
}

#[test]
fn a_forgotten_encode_and_a_dropped_encoder_are_told_and_mended() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    let view = mixed(lamp()).view();
    let casters = theatre.casters(0..12);
    let frame = frame(&view, lamp(), &casters);
    for way in KEEPING {
        let right = theatre.fresh(way, &frame);
        assert!(is_shown(&right));
        let mut renderer = theatre.renderer(way);
        let render = |renderer: &ShadowVolumeRenderer| {
            let target = theatre.target();
            let mut answer = Ok(());
            theatre.gpu.run(|encoder| {
                let view = view_of(&target);
                let mut pass = begin(encoder, "counts", &[], attach(&view, Some(WALL)));
                answer = renderer.render(&mut pass, 0, 0);
            });
            (answer, theatre.counts(&target))
        };
        let nothing = vec![0; right.len()];
        let not_encoded = (Err(VolumeRenderError::NotEncoded), nothing.clone());
        assert!(render(&renderer) == not_encoded, "{way:?}: never prepared");
        theatre.gpu.run(|encoder| renderer.encode(encoder));
        assert!(render(&renderer) == not_encoded, "{way:?}: nor now");
        theatre.prepare(&mut renderer, &frame);
        assert!(render(&renderer) == not_encoded, "{way:?}");

        theatre.prepare(&mut renderer, &frame);
        let told = renderer.statistics();
        assert!(told.not_encoded && !told.encoder_dropped, "{way:?}");
        assert_eq!(told.casters_extracted, 12, "{way:?}");
        let mut encoder = theatre
            .gpu
            .device
            .create_command_encoder(&Default::default());
        renderer.encode(&mut encoder);
        drop(encoder);
        let dropped = (Err(VolumeRenderError::Dropped), nothing);
        assert!(render(&renderer) == dropped, "{way:?}");

        let (counts, told) = theatre.draw(&mut renderer, &frame);
        assert!(counts == right, "{way:?}");
        assert!(told.encoder_dropped && !told.not_encoded, "{way:?}");
        assert_eq!(told.casters_extracted, 12, "{way:?}");
        let (counts, told) = theatre.draw(&mut renderer, &frame);
        assert!(counts == right, "{way:?}");
        assert_eq!(
            (
                told.encoder_dropped,
                told.not_encoded,
                told.casters_extracted
            ),
            (false, false, 0)
        );
        renderer.invalidate();
        theatre.gpu.run(|encoder| renderer.encode(encoder));
        assert!(render(&renderer) == not_encoded, "{way:?}: invalid");
        let (counts, told) = theatre.draw(&mut renderer, &frame);
        assert!(counts == right && told.casters_extracted == 12, "{way:?}");
    }
}
