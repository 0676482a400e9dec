//! Calls that a host forgets, repeats, mixes up or takes back: no picture may stay wrong in silence.

use crate::common::shapes::{Random, cuboid};
use crate::cubes::faces;
use crate::receivers::visibility;
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::{
    Caster, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, Kernel, PointLight, ShadowFrame,
    ShadowMap, ShadowMapDescriptor, SpotLight, StaticLayers, glam, wgpu,
};

/// Either map, under the same light.
enum Map {
    Cube(Box<CubeShadowMap>),
    Flat(Box<ShadowMap>),
}

/// What `prepare` said of calls.
#[derive(Debug, PartialEq)]
struct Said {
    drawn: bool,
    not_encoded: bool,
    encoder_dropped: bool,
}

const DRAWN: Said = Said {
    drawn: true,
    not_encoded: false,
    encoder_dropped: false,
};
const KEPT: Said = Said {
    drawn: false,
    ..DRAWN
};

impl Map {
    fn both(gpu: &Gpu) -> [Self; 2] {
        let cube = CubeShadowMapDescriptor {
            size: 32,
            ..Default::default()
        };
        let flat = ShadowMapDescriptor {
            size: 64,
            ..Default::default()
        };
        [
            Self::Cube(Box::new(CubeShadowMap::new(&gpu.device, &cube).unwrap())),
            Self::Flat(Box::new(ShadowMap::new(&gpu.device, &flat).unwrap())),
        ]
    }

    /// A new one of the same kind.
    fn fresh(&self, gpu: &Gpu) -> Self {
        let [cube, flat] = Self::both(gpu);
        match self {
            Self::Cube(_) => cube,
            Self::Flat(_) => flat,
        }
    }

    fn prepare(&mut self, gpu: &Gpu, stage: &Stage) -> Said {
        let (device, queue) = (&gpu.device, &gpu.queue);
        match self {
            Self::Cube(map) => {
                let frame = CubeFrame::new(PointLight::new(stage.light, 20.0), &stage.casters);
                map.prepare(device, queue, &frame).unwrap();
                let s = map.statistics();
                Said {
                    drawn: s.faces_rendered > 0,
                    not_encoded: s.not_encoded,
                    encoder_dropped: s.encoder_dropped,
                }
            }
            Self::Flat(map) => {
                let spot = SpotLight::new(stage.light, Vec3::NEG_Y, 0.8, 20.0);
                let frame = ShadowFrame::new(spot, &stage.casters);
                map.prepare(device, queue, &frame).unwrap();
                let s = map.statistics();
                Said {
                    drawn: s.rendered,
                    not_encoded: s.not_encoded,
                    encoder_dropped: s.encoder_dropped,
                }
            }
        }
    }

    fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        match self {
            Self::Cube(map) => map.encode(encoder),
            Self::Flat(map) => map.encode(encoder),
        }
    }

    fn invalidate(&mut self) {
        match self {
            Self::Cube(map) => map.invalidate(),
            Self::Flat(map) => map.invalidate(),
        }
    }

    /// Prepared, encoded and submitted.
    fn draw(&mut self, gpu: &Gpu, stage: &Stage) -> Said {
        gpu.checked(|| {
            let said = self.prepare(gpu, stage);
            gpu.run(|encoder| self.encode(encoder));
            said
        })
    }

    fn texels(&self, gpu: &Gpu) -> Vec<Vec<u8>> {
        match self {
            Self::Cube(map) => faces(gpu, map),
            Self::Flat(map) => {
                vec![gpu.read_texture(map.texture(), 0, wgpu::TextureAspect::DepthOnly)]
            }
        }
    }

    /// The visibility of some points in front of the light.
    fn seen(&self, gpu: &Gpu) -> Vec<f32> {
        let mut random = Random::new(5);
        let points: Vec<_> = (0..400)
            .map(|_| (random.vec3() * Vec3::new(4.0, 1.0, 4.0), Vec3::Y))
            .collect();
        match self {
            Self::Cube(map) => visibility(gpu, &**map, Kernel::Bilinear, &points),
            Self::Flat(map) => visibility(gpu, &**map, Kernel::Bilinear, &points),
        }
    }

    /// Whether texels and receivers are those of a map that was made for this and drawn once.
    fn is_right(&self, gpu: &Gpu, stage: &Stage) -> bool {
        let mut truth = self.fresh(gpu);
        truth.draw(gpu, stage);
        self.texels(gpu) == truth.texels(gpu) && self.seen(gpu) == truth.seen(gpu)
    }
}

#[derive(Clone)]
struct Stage {
    light: Vec3,
    casters: Vec<Caster>,
}

impl Stage {
    fn new(gpu: &Gpu) -> Self {
        let mesh = cuboid(Vec3::new(0.5, 0.2, 0.4)).mesh(&gpu.device);
        let mut random = Random::new(3);
        let mut place = || Affine3A::from_translation(random.vec3() * 3.0 + Vec3::Y * 2.0);
        Self {
            light: Vec3::Y * 8.0,
            casters: (0..8).map(|_| Caster::new(mesh.clone(), place())).collect(),
        }
    }

    /// Light and casters, farther on.
    fn moved(&self) -> Self {
        let mut moved = self.clone();
        moved.light += Vec3::new(0.4, 0.3, -0.2);
        for caster in &mut moved.casters {
            caster.world_from_object.translation.x += 0.7;
        }
        moved
    }
}

fn encoder(gpu: &Gpu) -> wgpu::CommandEncoder {
    gpu.device.create_command_encoder(&Default::default())
}

#[test]
fn a_map_that_was_never_encoded_is_dark() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage::new(&gpu);
    for mut map in Map::both(&gpu) {
        let dark = |map: &Map| map.seen(&gpu).iter().all(|&lit| lit == 0.0);
        assert!(dark(&map), "not even prepared");
        gpu.run(|encoder| map.encode(encoder));
        assert!(dark(&map), "nothing to encode");
        for frame in 0..3 {
            let said = map.prepare(&gpu, &stage);
            let not_encoded = frame > 0;
            assert_eq!(
                said,
                Said {
                    not_encoded,
                    ..DRAWN
                }
            );
            gpu.queue.submit([]);
            assert!(dark(&map), "prepared only");
        }
        gpu.run(|encoder| map.encode(encoder));
        assert!(map.is_right(&gpu, &stage));
        // The broken twin: there is light.
        assert!(!dark(&map));
    }
}

#[test]
fn a_forgotten_encode_leaves_receivers_and_texels_as_they_were() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage::new(&gpu);
    let moved = stage.moved();
    for mut map in Map::both(&gpu) {
        map.draw(&gpu, &stage);
        map.prepare(&gpu, &moved);
        gpu.queue.submit([]);
        assert!(map.is_right(&gpu, &stage), "as before, both of them");
        assert!(!map.is_right(&gpu, &moved), "the broken twin");
        // Found once more, and of the frame that is encoded.
        let not_encoded = true;
        let further = moved.moved();
        assert_eq!(
            map.draw(&gpu, &further),
            Said {
                not_encoded,
                ..DRAWN
            }
        );
        assert!(map.is_right(&gpu, &further));
        assert_eq!(map.draw(&gpu, &further), KEPT);
    }
}

#[test]
fn what_one_prepare_owes_the_next_one_draws() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage::new(&gpu);
    for mut map in Map::both(&gpu) {
        map.prepare(&gpu, &stage);
        map.prepare(&gpu, &stage);
        gpu.run(|encoder| map.encode(encoder));
        assert!(map.is_right(&gpu, &stage));
        // Back to what the texels show: nothing is owed any more.
        map.prepare(&gpu, &stage.moved());
        let not_encoded = true;
        assert_eq!(
            map.prepare(&gpu, &stage),
            Said {
                not_encoded,
                ..KEPT
            }
        );
        gpu.run(|encoder| map.encode(encoder));
        assert!(map.is_right(&gpu, &stage));
    }
}

#[test]
fn a_second_encode_records_nothing() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage::new(&gpu);
    for mut map in Map::both(&gpu) {
        map.draw(&gpu, &stage);
        map.prepare(&gpu, &stage.moved());
        gpu.run(|encoder| {
            map.encode(encoder);
            map.encode(encoder);
        });
        gpu.run(|encoder| map.encode(encoder));
        assert!(map.is_right(&gpu, &stage.moved()));
        // One that is dropped takes nothing with it.
        drop(encoder(&gpu));
        map.encode(&mut encoder(&gpu));
        assert_eq!(map.draw(&gpu, &stage.moved()), KEPT);
    }
}

#[test]
fn what_an_encoder_held_that_was_dropped_is_drawn_again() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage::new(&gpu);
    for finished in [false, true] {
        for mut map in Map::both(&gpu) {
            map.draw(&gpu, &stage);
            assert_eq!(map.draw(&gpu, &stage), KEPT, "submitted: not drawn again");
            let moved = stage.moved();
            map.prepare(&gpu, &moved);
            let mut lost = encoder(&gpu);
            map.encode(&mut lost);
            match finished {
                true => drop(lost.finish()),
                false => drop(lost),
            }
            assert!(map.is_right(&gpu, &stage), "nothing of it has happened");
            let encoder_dropped = true;
            let again = Said {
                encoder_dropped,
                ..DRAWN
            };
            assert_eq!(map.draw(&gpu, &moved), again);
            assert!(map.is_right(&gpu, &moved));
            assert_eq!(map.draw(&gpu, &moved), KEPT);
        }
    }
}

#[test]
fn an_encoder_that_is_kept_and_never_submitted_wants_invalidate() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage::new(&gpu);
    for mut map in Map::both(&gpu) {
        map.draw(&gpu, &stage);
        let moved = stage.moved();
        map.prepare(&gpu, &moved);
        let mut kept = encoder(&gpu);
        map.encode(&mut kept);
        // The broken twin: nobody can know that it will never be submitted.
        assert_eq!(map.draw(&gpu, &moved), KEPT);
        assert!(!map.is_right(&gpu, &moved));
        map.invalidate();
        assert_eq!(map.draw(&gpu, &moved), DRAWN);
        assert!(map.is_right(&gpu, &moved));
        drop(kept);
        // Between `prepare` and `encode` it takes back what was prepared.
        map.draw(&gpu, &moved);
        map.prepare(&gpu, &stage);
        map.invalidate();
        gpu.run(|encoder| map.encode(encoder));
        assert!(map.is_right(&gpu, &moved));
        assert!(map.draw(&gpu, &stage).drawn);
        assert!(map.is_right(&gpu, &stage));
    }
}

#[test]
fn layers_of_what_stands_still_are_lost_with_an_encoder_too() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut stage = Stage::new(&gpu);
    let descriptor = CubeShadowMapDescriptor {
        size: 32,
        static_layers: StaticLayers::AtLeast(1),
        ..Default::default()
    };
    let mut map = Map::Cube(Box::new(
        CubeShadowMap::new(&gpu.device, &descriptor).unwrap(),
    ));
    let stir = |stage: &mut Stage| stage.casters[0].world_from_object.translation.x += 0.1;
    let built = |map: &Map| match map {
        Map::Cube(map) => map.statistics().layers_drawn,
        Map::Flat(_) => 0,
    };
    for _ in 0..2 {
        stir(&mut stage);
        map.draw(&gpu, &stage);
    }
    stir(&mut stage);
    map.prepare(&gpu, &stage);
    assert!(built(&map) > 0, "in the frame that is lost");
    map.encode(&mut encoder(&gpu));
    for _ in 0..6 {
        stir(&mut stage);
        map.draw(&gpu, &stage);
        assert!(map.is_right(&gpu, &stage));
    }
}

#[test]
fn two_frames_in_one_submission_each_have_their_own() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage::new(&gpu);
    let mut fewer = stage.moved();
    fewer.casters.truncate(3);
    for mut map in Map::both(&gpu) {
        let mut other = map.fresh(&gpu);
        gpu.checked(|| {
            map.prepare(&gpu, &stage);
            let mut both = encoder(&gpu);
            map.encode(&mut both);
            // Of the first frame some faces are kept, if any: none is of the second's casters.
            map.prepare(&gpu, &fewer);
            map.encode(&mut both);
            map.prepare(&gpu, &stage);
            map.encode(&mut both);
            gpu.queue.submit([both.finish()]);
        });
        assert!(map.is_right(&gpu, &stage));
        // A frame whose receivers are another's in the same submission.
        other.draw(&gpu, &fewer);
        other.prepare(&gpu, &stage);
        let mut first = encoder(&gpu);
        other.encode(&mut first);
        other.prepare(&gpu, &fewer);
        gpu.queue.submit([first.finish()]);
        assert!(other.is_right(&gpu, &stage), "only the first was encoded");
    }
}
