//! Second layers for what stands still: depths bit for bit those of drawing everything, and no
//! layer where it would not pay.

use crate::common::shapes::{Random, cuboid, sphere};
use crate::cubes::{draw, draw_frame, faces, fresh};
use crate::deformed::Deformed;
use crate::receivers::visibility;
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use shadows::error::CubeShadowMapError;
use shadows::{
    Caster, CasterMesh, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DepthEncoding, Kernel,
    MapSettings, PointLight, StaticLayers, glam, wgpu,
};

const SIZE: u32 = 24;
const ALWAYS: StaticLayers = StaticLayers::AtLeast(1);

fn descriptor(static_layers: StaticLayers) -> CubeShadowMapDescriptor<'static> {
    CubeShadowMapDescriptor {
        size: SIZE,
        static_layers,
        ..Default::default()
    }
}

fn at(mesh: &CasterMesh, place: Vec3) -> Caster {
    Caster::new(mesh.clone(), Affine3A::from_translation(place))
}

fn light_at(position: Vec3) -> PointLight {
    PointLight::new(position, 12.0)
}

/// Casters that stand around on all faces, and one before them on the face +X, the last.
fn surroundings(gpu: &Gpu) -> Vec<Caster> {
    let mesh = sphere(6, 8).mesh(&gpu.device);
    let mut random = Random::new(12);
    let mut casters: Vec<Caster> = (0..30)
        .map(|_| at(&mesh, random.vec3().normalize() * 6.0))
        .collect();
    casters.push(at(
        &cuboid(Vec3::splat(0.4)).mesh(&gpu.device),
        Vec3::X * 3.0,
    ));
    casters
}

fn move_last(casters: &mut [Caster], frame: u32) {
    if let Some(caster) = casters.last_mut() {
        caster.world_from_object.translation.y = 0.1 * (frame % 7) as f32;
    }
}

/// Something that a host does, for one frame or some.
#[derive(Clone, Debug)]
enum Step {
    /// Moves a caster a little in each of some frames.
    Stir(usize, u32),
    Move(usize, Vec3),
    Add(usize, Vec3),
    Remove(usize),
    Swap(usize, usize),
    Light(Vec3),
    Deform(f32),
    Invalidate,
    Unencoded,
}

fn step() -> impl Strategy<Value = Step> {
    let place = || {
        (-60i32..60, -60i32..60, -60i32..60)
            .prop_map(|(x, y, z)| Vec3::new(x as f32, y as f32, z as f32) * 0.1)
    };
    prop_oneof![
        6 => (0..16usize, 1..7u32).prop_map(|(i, n)| Step::Stir(i, n)),
        1 => (0..16usize, place()).prop_map(|(i, p)| Step::Move(i, p)),
        1 => (0..3usize, place()).prop_map(|(i, p)| Step::Add(i, p)),
        1 => (0..16usize).prop_map(Step::Remove),
        1 => (0..16usize, 0..16usize).prop_map(|(i, j)| Step::Swap(i, j)),
        1 => place().prop_map(|p| Step::Light(p * 0.2)),
        1 => (5..30i32).prop_map(|f| Step::Deform(f as f32 * 0.1)),
        1 => Just(Step::Invalidate),
        1 => Just(Step::Unencoded),
    ]
}

/// A scene under a host's hands, and maps that go with it.
struct Stage<'a> {
    gpu: &'a Gpu,
    meshes: [CasterMesh; 3],
    deformed: &'a Deformed,
    light: PointLight,
    casters: Vec<Caster>,
    maps: Vec<CubeShadowMap>,
}

impl Stage<'_> {
    /// Does a step, and gives the frames that follow it.
    fn take(&mut self, step: &Step) -> u32 {
        let count = self.casters.len().max(1);
        match *step {
            Step::Stir(_, frames) => return frames,
            Step::Move(i, p) => {
                if let Some(caster) = self.casters.get_mut(i % count) {
                    caster.world_from_object.translation = p.into();
                }
            }
            Step::Add(i, p) => self.casters.push(at(&self.meshes[i], p)),
            Step::Remove(i) if !self.casters.is_empty() => drop(self.casters.remove(i % count)),
            Step::Swap(i, j) if !self.casters.is_empty() => self.casters.swap(i % count, j % count),
            Step::Light(p) => self.light.position = p,
            Step::Deform(factor) => {
                self.deformed.deform(self.gpu, factor);
                self.deformed.mesh.bump_revision();
            }
            Step::Invalidate => self.maps.iter_mut().for_each(CubeShadowMap::invalidate),
            Step::Unencoded => {
                self.stir(3);
                for map in &mut self.maps {
                    let frame = CubeFrame::new(self.light, &self.casters);
                    map.prepare(&self.gpu.device, &self.gpu.queue, &frame)
                        .unwrap();
                }
            }
            Step::Remove(_) | Step::Swap(..) => {}
        }
        1
    }

    fn stir(&mut self, i: usize) {
        let count = self.casters.len().max(1);
        if let Some(caster) = self.casters.get_mut(i % count) {
            caster.world_from_object.translation.x += 0.03;
        }
    }

    /// Draws a frame of every map: what their texels are, and how many faces were copied.
    fn draw(&mut self, bytes: impl Fn(&CubeShadowMap) -> Vec<Vec<u8>>) -> Frame {
        let mut frame = Frame::default();
        for map in &mut self.maps {
            draw(self.gpu, map, self.light, &self.casters);
            frame.texels.push(bytes(map));
            frame.copied.push(map.statistics().faces_copied);
        }
        frame
    }
}

#[derive(Default)]
struct Frame {
    texels: Vec<Vec<Vec<u8>>>,
    copied: Vec<u32>,
}

/// Random sequences with layers never, where they pay, and always: faces copied with the last two.
fn sequences(
    gpu: &Gpu,
    cases: u32,
    descriptor: &CubeShadowMapDescriptor<'_>,
    bytes: impl Fn(&CubeShadowMap) -> Vec<Vec<u8>>,
) -> [u32; 2] {
    let deformed = Deformed::new(gpu);
    let mut runner = TestRunner::new(Config {
        cases,
        failure_persistence: None,
        ..Config::default()
    });
    let copied = std::cell::Cell::new([0; 2]);
    let steps = prop::collection::vec(step(), 3..10);
    let result = runner.run(&steps, |steps| {
        let meshes = [
            cuboid(Vec3::splat(0.5)).mesh(&gpu.device),
            sphere(4, 6).mesh(&gpu.device),
            deformed.mesh.clone(),
        ];
        let modes = [StaticLayers::Never, StaticLayers::Auto, ALWAYS];
        let map = |static_layers| {
            let descriptor = CubeShadowMapDescriptor {
                static_layers,
                ..descriptor.clone()
            };
            CubeShadowMap::new(&gpu.device, &descriptor).unwrap()
        };
        let mut stage = Stage {
            gpu,
            casters: vec![
                at(&meshes[0], Vec3::X * 3.0),
                at(&meshes[1], Vec3::new(5.0, 1.0, 1.0)),
                at(&meshes[2], Vec3::new(4.0, -1.0, -2.0)),
                at(&meshes[1], Vec3::new(0.5, 4.0, 0.5)),
            ],
            meshes,
            deformed: &deformed,
            light: light_at(Vec3::ZERO),
            maps: modes.map(map).into(),
        };
        // Whatever else comes, something is stirred for so long that the rest gets a layer.
        for step in [Step::Stir(0, 5)].iter().chain(&steps) {
            for _ in 0..stage.take(step) {
                if let Step::Stir(i, _) = *step {
                    stage.stir(i);
                }
                let frame = stage.draw(&bytes);
                let [whole, auto, always] = [0, 1, 2].map(|map| &frame.texels[map]);
                prop_assert!(auto == whole, "layers where they pay");
                prop_assert!(always == whole, "layers always");
                prop_assert_eq!(frame.copied[0], 0);
                let [auto, always] = copied.get();
                copied.set([auto + frame.copied[1], always + frame.copied[2]]);
            }
        }
        Ok(())
    });
    result.unwrap();
    copied.get()
}

#[test]
fn layers_change_no_bit() {
    let Some(gpu) = Gpu::for_test() else { return };
    let read = |map: &CubeShadowMap| faces(&gpu, map);
    let [auto, always] = sequences(&gpu, 48, &descriptor(StaticLayers::Never), read);
    assert!(auto >= 48 && always >= auto, "{auto} and {always} copies");
}

#[test]
fn layers_change_no_bit_in_any_encoding_and_format() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut random = Random::new(2);
    let points: Vec<(Vec3, Vec3)> = (0..2000)
        .map(|_| (random.vec3() * 9.0, random.vec3()))
        .collect();
    for format in [
        wgpu::TextureFormat::Depth32Float,
        wgpu::TextureFormat::Depth16Unorm,
        wgpu::TextureFormat::Depth24Plus,
    ] {
        for encoding in [DepthEncoding::MajorAxis, DepthEncoding::LinearDistance] {
            let descriptor = CubeShadowMapDescriptor {
                settings: MapSettings {
                    format,
                    ..Default::default()
                },
                encoding,
                ..descriptor(StaticLayers::Never)
            };
            // `Depth24Plus` cannot be read back: it is asked for what receivers see of it.
            let read = |map: &CubeShadowMap| match format {
                wgpu::TextureFormat::Depth24Plus => {
                    let seen = visibility(&gpu, map, Kernel::FourTaps, &points);
                    vec![bytemuck::pod_collect_to_vec(&seen)]
                }
                _ => faces(&gpu, map),
            };
            let [_, always] = sequences(&gpu, 3, &descriptor, read);
            assert!(always >= 3, "{always} copies, {format:?} {encoding:?}");
        }
    }
}

#[test]
fn a_layer_that_is_not_drawn_again_is_the_broken_twin() {
    let Some(gpu) = Gpu::for_test() else { return };
    let deformed = Deformed::new(&gpu);
    let mut casters = surroundings(&gpu);
    casters.insert(0, at(&deformed.mesh, Vec3::new(6.0, 1.0, 0.0)));
    let light = light_at(Vec3::ZERO);
    let mut maps = [StaticLayers::Never, ALWAYS]
        .map(|mode| CubeShadowMap::new(&gpu.device, &descriptor(mode)).unwrap());
    let mut alike = |casters: &[Caster]| {
        let [whole, layered] = maps.each_mut().map(|map| {
            draw(&gpu, map, light, casters);
            faces(&gpu, map)
        });
        whole == layered
    };
    for frame in 0..6 {
        move_last(&mut casters, frame);
        assert!(alike(&casters));
    }
    deformed.deform(&gpu, 2.0);
    move_last(&mut casters, 6);
    assert!(!alike(&casters), "nobody said that it changed");
    deformed.mesh.bump_revision();
    assert!(alike(&casters));
}

#[test]
fn still_casters_are_copied_under_one_that_moves() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut casters = surroundings(&gpu);
    let light = light_at(Vec3::ZERO);
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor(StaticLayers::Auto)).unwrap();
    let mut statistics = Vec::new();
    for frame in 0..6 {
        move_last(&mut casters, frame);
        draw(&gpu, &mut map, light, &casters);
        statistics.push(map.statistics());
    }
    let of = |what: fn(&shadows::CubeStatistics) -> u32| -> Vec<u32> {
        statistics.iter().map(what).collect()
    };
    assert_eq!(of(|s| s.faces_rendered), [6, 1, 1, 1, 1, 1]);
    assert_eq!(of(|s| s.layers_drawn), [0, 0, 1, 0, 0, 0]);
    assert_eq!(of(|s| s.faces_copied), [0, 0, 1, 1, 1, 1]);
    assert_eq!(of(|s| s.draws)[3..], [1, 1, 1]);
    assert_eq!(statistics[5].triangles, 12, "the box alone is drawn");
    let layer = u64::from(SIZE * SIZE * 4);
    assert!(statistics[2].bytes >= statistics[1].bytes + layer);
    assert!(
        statistics[2].bytes < statistics[1].bytes + 2 * layer,
        "one face"
    );

    // The order of the host's list means nothing.
    casters.rotate_left(3);
    draw(&gpu, &mut map, light, &casters);
    assert_eq!(map.statistics().faces_rendered, 0);
    casters.rotate_right(3);
    move_last(&mut casters, 6);
    draw(&gpu, &mut map, light, &casters);
    assert_eq!(map.statistics().faces_copied, 1);
    let truth = fresh(&gpu, &descriptor(StaticLayers::Never), light, &casters);
    draw(&gpu, &mut map, light, &casters);
    assert_eq!(faces(&gpu, &map), faces(&gpu, &truth));
}

#[test]
fn scenes_that_have_no_use_for_layers_get_none() {
    let Some(gpu) = Gpu::for_test() else { return };
    let crowd = surroundings(&gpu);
    let all_move = |casters: &mut Vec<Caster>, frame: u32| {
        for caster in casters {
            caster.world_from_object.translation.y += 0.01 * (1 + frame % 3) as f32;
        }
    };
    let nobody_moves = |_: &mut Vec<Caster>, _: u32| ();
    let few_stand = |casters: &mut Vec<Caster>, frame: u32| {
        casters.truncate(1);
        casters.push(crowd[30].clone());
        move_last(casters, frame);
    };
    let one_moves = |casters: &mut Vec<Caster>, frame: u32| move_last(casters, frame);
    let copies = |mode, size, change: &dyn Fn(&mut Vec<Caster>, u32)| {
        let descriptor = CubeShadowMapDescriptor {
            size,
            ..descriptor(mode)
        };
        let mut map = CubeShadowMap::new(&gpu.device, &descriptor).unwrap();
        let mut casters = crowd.clone();
        let mut copied = 0;
        for frame in 0..8 {
            change(&mut casters, frame);
            let frame = CubeFrame::new(light_at(Vec3::ZERO), &casters);
            draw_frame(&gpu, &mut map, &frame);
            copied += map.statistics().faces_copied;
        }
        copied
    };
    assert_eq!(copies(ALWAYS, SIZE, &all_move), 0);
    assert_eq!(copies(ALWAYS, SIZE, &nobody_moves), 0);
    assert_eq!(copies(StaticLayers::Auto, 512, &few_stand), 0);
    assert_eq!(copies(StaticLayers::Never, SIZE, &one_moves), 0);
    // The broken twin.
    assert!(copies(StaticLayers::Auto, SIZE, &one_moves) > 0);
}

#[test]
fn layers_are_refused_where_depth_cannot_be_copied() {
    let gl = match Gpu::new(Some("(Gl,")) {
        Ok(gl) => gl,
        Err(_) => return eprintln!("skipped: no GL adapter"),
    };
    let make = |mode| CubeShadowMap::new(&gl.device, &descriptor(mode));
    let error = make(ALWAYS).unwrap_err();
    assert_eq!(error, CubeShadowMapError::StaticLayers);
    let mut map = make(StaticLayers::Auto).unwrap();
    let mut casters = surroundings(&gl);
    for frame in 0..5 {
        move_last(&mut casters, frame);
        draw(&gl, &mut map, light_at(Vec3::ZERO), &casters);
        assert_eq!(map.statistics().faces_copied, 0);
    }
}
