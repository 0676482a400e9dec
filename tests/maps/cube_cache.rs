//! Caching: pictures that are those of a map drawn afresh, and nothing drawn that has not changed.

use crate::common::shapes::{cuboid, sphere};
use crate::cubes::{draw, faces, fresh};
use crate::deformed::Deformed;
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use shadows::{
    Caster, CasterMesh, CubeFace, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, PointLight,
    TileState, glam,
};

const SIZE: u32 = 24;

fn descriptor() -> CubeShadowMapDescriptor<'static> {
    CubeShadowMapDescriptor {
        size: SIZE,
        ..Default::default()
    }
}

fn at(mesh: &CasterMesh, x: f32, y: f32, z: f32) -> Caster {
    let transform = Affine3A::from_translation(Vec3::new(x, y, z));
    Caster::new(mesh.clone(), transform)
}

fn light_at(position: Vec3) -> PointLight {
    PointLight::new(position, 12.0)
}

/// Something that a host does between two frames.
#[derive(Clone, Debug)]
enum Step {
    Move(usize, Vec3),
    Add(usize, Vec3),
    Remove(usize),
    Swap(usize, usize),
    Light(Vec3),
    Range(f32),
    Deform(f32),
    Invalidate,
    Unencoded,
    Still,
}

fn step() -> impl Strategy<Value = Step> {
    let place = || {
        (-60i32..60, -60i32..60, -60i32..60)
            .prop_map(|(x, y, z)| Vec3::new(x as f32, y as f32, z as f32) * 0.1)
    };
    prop_oneof![
        3 => (0..16usize, place()).prop_map(|(i, p)| Step::Move(i, p)),
        2 => (0..3usize, place()).prop_map(|(i, p)| Step::Add(i, p)),
        2 => (0..16usize).prop_map(Step::Remove),
        1 => (0..16usize, 0..16usize).prop_map(|(i, j)| Step::Swap(i, j)),
        1 => place().prop_map(|p| Step::Light(p * 0.3)),
        1 => (3..14i32).prop_map(|r| Step::Range(r as f32)),
        1 => (5..30i32).prop_map(|f| Step::Deform(f as f32 * 0.1)),
        1 => Just(Step::Invalidate),
        1 => Just(Step::Unencoded),
        1 => Just(Step::Still),
    ]
}

/// A scene under a host's hands, and one map that goes with it.
struct Stage<'a> {
    gpu: &'a Gpu,
    meshes: [CasterMesh; 3],
    deformed: &'a Deformed,
    light: PointLight,
    casters: Vec<Caster>,
    map: CubeShadowMap,
}

impl Stage<'_> {
    fn take(&mut self, step: &Step) {
        let count = self.casters.len().max(1);
        match *step {
            Step::Move(i, p) => {
                if let Some(caster) = self.casters.get_mut(i % count) {
                    caster.world_from_object.translation = p.into();
                }
            }
            Step::Add(i, p) => self.casters.push(at(&self.meshes[i], p.x, p.y, p.z)),
            Step::Remove(i) if !self.casters.is_empty() => {
                self.casters.remove(i % count);
            }
            Step::Swap(i, j) if !self.casters.is_empty() => self.casters.swap(i % count, j % count),
            Step::Light(p) => self.light.position = p,
            Step::Range(r) => self.light.range = r,
            Step::Deform(factor) => {
                self.deformed.deform(self.gpu, factor);
                self.deformed.mesh.bump_revision();
            }
            Step::Invalidate => self.map.invalidate(),
            Step::Unencoded => {
                let frame = CubeFrame::new(self.light, &[]);
                let (device, queue) = (&self.gpu.device, &self.gpu.queue);
                self.map.prepare(device, queue, &frame).unwrap();
            }
            Step::Remove(_) | Step::Swap(..) | Step::Still => {}
        }
    }
}

#[test]
fn a_cached_map_is_bit_for_bit_one_drawn_afresh() {
    let Some(gpu) = Gpu::for_test() else { return };
    let deformed = Deformed::new(&gpu);
    let mut runner = TestRunner::new(Config {
        cases: 64,
        failure_persistence: None,
        ..Config::default()
    });
    let kept = std::cell::Cell::new(0);
    runner
        .run(&prop::collection::vec(step(), 1..12), |steps| {
            let meshes = [
                cuboid(Vec3::splat(0.5)).mesh(&gpu.device),
                sphere(4, 6).mesh(&gpu.device),
                deformed.mesh.clone(),
            ];
            let mut stage = Stage {
                gpu: &gpu,
                casters: vec![
                    at(&meshes[0], 3.0, 0.0, 0.0),
                    at(&meshes[2], 0.0, 0.0, -4.0),
                ],
                meshes,
                deformed: &deformed,
                light: light_at(Vec3::ZERO),
                map: CubeShadowMap::new(&gpu.device, &descriptor()).unwrap(),
            };
            for step in &steps {
                stage.take(step);
                draw(&gpu, &mut stage.map, stage.light, &stage.casters);
                kept.set(kept.get() + stage.map.statistics().faces_kept);
                let truth = fresh(&gpu, &descriptor(), stage.light, &stage.casters);
                prop_assert_eq!(faces(&gpu, &stage.map), faces(&gpu, &truth));
            }
            Ok(())
        })
        .unwrap();
    assert!(kept.get() > 50, "{} faces kept", kept.get());
}

#[test]
fn a_mesh_deformed_without_a_new_revision_is_the_broken_twin() {
    let Some(gpu) = Gpu::for_test() else { return };
    let deformed = Deformed::new(&gpu);
    let casters = [at(&deformed.mesh, 4.0, 0.0, 0.0)];
    let light = light_at(Vec3::ZERO);
    let mut map = fresh(&gpu, &descriptor(), light, &casters);
    let before = faces(&gpu, &map);
    deformed.deform(&gpu, 2.0);
    draw(&gpu, &mut map, light, &casters);
    assert_eq!(faces(&gpu, &map), before, "nobody said that it changed");
    deformed.mesh.bump_revision();
    draw(&gpu, &mut map, light, &casters);
    let truth = fresh(&gpu, &descriptor(), light, &casters);
    assert_ne!(faces(&gpu, &map), before);
    assert_eq!(faces(&gpu, &map), faces(&gpu, &truth));
}

#[test]
fn only_the_faces_that_changed_are_drawn() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mesh = cuboid(Vec3::splat(0.5)).mesh(&gpu.device);
    let light = light_at(Vec3::ZERO);
    let mut casters = vec![
        at(&mesh, 5.0, 0.0, 0.0),
        at(&mesh, 0.0, 5.0, 0.0),
        at(&mesh, 0.0, 0.0, 5.0),
    ];
    let mut map = fresh(&gpu, &descriptor(), light, &casters);
    let rendered = |map: &mut CubeShadowMap, casters: &[Caster]| {
        draw(&gpu, map, light, casters);
        map.statistics().faces_rendered
    };
    assert_eq!(rendered(&mut map, &casters), 0, "a still scene");
    casters.reverse();
    assert_eq!(rendered(&mut map, &casters), 0, "another order");
    casters[0].world_from_object.translation.x += 0.1;
    assert_eq!(rendered(&mut map, &casters), 1, "one moved on its face");
    casters[0].world_from_object.translation = Vec3::new(-5.0, 0.0, 0.0).into();
    assert_eq!(rendered(&mut map, &casters), 2, "one moved to another");
    casters.remove(1);
    assert_eq!(rendered(&mut map, &casters), 1, "the others moved up");
    casters[0].mesh = sphere(4, 6).mesh(&gpu.device);
    assert_eq!(rendered(&mut map, &casters), 1, "another mesh");
    casters.push(at(&mesh, 50.0, 0.0, 0.0));
    assert_eq!(rendered(&mut map, &casters), 0, "one out of range");
    let of = |face| map.face_statistics(face).unwrap();
    assert_eq!(of(CubeFace::PositiveY).state, TileState::Empty);
    assert_eq!(of(CubeFace::PositiveZ).state, TileState::Empty);
    assert_eq!(of(CubeFace::NegativeX).casters, 1);
    assert_eq!(of(CubeFace::NegativeX).state, TileState::Kept);
}
