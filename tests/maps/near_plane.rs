//! The near planes of lights' maps: where they lie unless told, and what is nearer than they are.

use crate::common::rays::Triangles;
use crate::common::shapes::{Random, Shape, cuboid};
use crate::cubes::{faces, fresh};
use crate::receivers::visibility;
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::{
    Bias, Caster, CubeShadowMap, CubeShadowMapDescriptor, DepthEncoding, FlatLight, Kernel,
    MapKind, MapSettings, PointLight, ShadowFrame, ShadowMap, ShadowMapDescriptor, SpotLight, glam,
    wgpu::{Features, TextureFormat},
};

const RANGE: f32 = 40.0;
/// Of the receivers, all around the light.
const SHELL: f32 = 10.0;
const SIZE: u32 = 256;

/// Casters around a light, and what is true of receivers on a sphere around them.
struct Lamp {
    position: Vec3,
    casters: Vec<Caster>,
    truth: Triangles,
}

impl Lamp {
    fn new() -> Self {
        Self {
            position: Vec3::new(0.3, -0.2, 0.1),
            casters: Vec::new(),
            truth: Triangles::default(),
        }
    }

    fn add(&mut self, gpu: &Gpu, shape: &Shape, relative: Affine3A) {
        let world = Affine3A::from_translation(self.position) * relative;
        self.truth.add(&shape.positions, &shape.indices, world);
        self.casters.push(shape.caster(&gpu.device, world));
    }

    /// A bar beside the light along each axis: behind the near plane of some faces, and before that of
    /// others, which see its ends; and boxes before corners and edges of the cube.
    fn barred(gpu: &Gpu) -> Self {
        let mut lamp = Self::new();
        for (half, at) in [
            (Vec3::new(6.0, 0.03, 0.05), Vec3::new(0.1, -0.3, 0.05)),
            (Vec3::new(0.03, 6.0, 0.05), Vec3::new(0.1, 0.2, -0.4)),
            (Vec3::new(0.05, 0.03, 6.0), Vec3::new(-0.35, 0.1, 0.2)),
        ] {
            lamp.add(gpu, &cuboid(half), Affine3A::from_translation(at));
        }
        for sign in [
            Vec3::ONE,
            Vec3::new(-1.0, 1.0, 1.0),
            Vec3::new(1.0, -1.0, 0.0),
        ] {
            let box_ = cuboid(Vec3::splat(0.08));
            lamp.add(gpu, &box_, Affine3A::from_translation(0.45 * sign));
        }
        lamp
    }

    /// Boxes at distances from 1e-4 to 3 of the light, all as large as seen from there.
    fn at_all_distances(gpu: &Gpu) -> Self {
        let (mut lamp, mut random) = (Self::new(), Random::new(3));
        lamp.position = Vec3::new(3e-3, -2e-3, 1e-3);
        for i in 0..40 {
            let distance = 10.0_f32.powf(-4.0 + 4.5 * i as f32 / 40.0);
            let at = distance * random.vec3().normalize();
            let box_ = cuboid(Vec3::splat(0.15 * distance));
            lamp.add(gpu, &box_, Affine3A::from_translation(at));
        }
        lamp
    }

    fn point(&self, near: Option<f32>) -> PointLight {
        PointLight {
            near,
            ..PointLight::new(self.position, RANGE)
        }
    }

    fn spot(&self, near: Option<f32>) -> FlatLight {
        let direction = Vec3::new(1.0, -0.4, 0.2);
        FlatLight::Spot(SpotLight {
            near,
            ..SpotLight::new(self.position, direction, 0.8, RANGE)
        })
    }

    /// Points whose surroundings all have the same answer, and whether they are lit.
    fn receivers(&self, within: f32) -> Vec<((Vec3, Vec3), bool)> {
        let mut random = Random::new(17);
        let axis = Vec3::new(1.0, -0.4, 0.2).normalize();
        let lit = |direction: Vec3| {
            let hit = self
                .truth
                .nearest(self.position.as_dvec3(), direction.as_dvec3());
            hit.is_none_or(|t| t > f64::from(SHELL))
        };
        (0..3000)
            .filter_map(|_| {
                let direction = random.vec3().normalize();
                let (across, up) = direction.any_orthonormal_pair();
                let own = lit(direction);
                let alike = (0..48).all(|i| {
                    let (sine, cosine) = (i as f32 * std::f32::consts::TAU / 16.0).sin_cos();
                    let aside = 0.007 * (1 + i / 16) as f32 * (cosine * across + sine * up);
                    lit((direction + aside).normalize()) == own
                });
                let at = self.position + SHELL * direction;
                let inside = direction.dot(axis) > within.cos();
                (alike && inside).then_some(((at, -direction), own))
            })
            .collect()
    }
}

fn cube(
    gpu: &Gpu,
    lamp: &Lamp,
    near: Option<f32>,
    (encoding, format): (DepthEncoding, TextureFormat),
) -> CubeShadowMap {
    let descriptor = CubeShadowMapDescriptor {
        size: SIZE,
        encoding,
        settings: MapSettings {
            format,
            ..Default::default()
        },
        ..Default::default()
    };
    fresh(gpu, &descriptor, lamp.point(near), &lamp.casters)
}

fn flat(gpu: &Gpu, lamp: &Lamp, near: Option<f32>, format: TextureFormat) -> ShadowMap {
    let descriptor = ShadowMapDescriptor {
        size: SIZE,
        settings: MapSettings {
            format,
            ..Default::default()
        },
        ..Default::default()
    };
    let mut map = ShadowMap::new(&gpu.device, &descriptor).unwrap();
    let frame = ShadowFrame::new(lamp.spot(near), &lamp.casters);
    map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    gpu.run(|encoder| map.encode(encoder));
    map
}

fn wrong(seen: &[f32], points: &[((Vec3, Vec3), bool)]) -> usize {
    let truth = points.iter().map(|(_, lit)| f32::from(u8::from(*lit)));
    let pairs = seen.iter().zip(truth);
    pairs.filter(|(seen, truth)| **seen != *truth).count()
}

const FORMATS: [TextureFormat; 3] = [
    TextureFormat::Depth32Float,
    TextureFormat::Depth24Plus,
    TextureFormat::Depth16Unorm,
];

/// How many receivers are wrong on cubes of all formats and encodings, and under spots; and of how
/// many.
fn wrong_on_all(gpu: &Gpu, lamp: &Lamp, near: Option<f32>) -> Vec<(String, usize, usize)> {
    let (around, before) = (lamp.receivers(9.0), lamp.receivers(0.7));
    let ask = |points: &[((Vec3, Vec3), bool)]| -> Vec<(Vec3, Vec3)> {
        points.iter().map(|(point, _)| *point).collect()
    };
    let mut found = Vec::new();
    for format in FORMATS {
        for encoding in [DepthEncoding::MajorAxis, DepthEncoding::LinearDistance] {
            let map = cube(gpu, lamp, near, (encoding, format));
            let seen = visibility(gpu, &map, Kernel::Bilinear, &ask(&around));
            let what = format!("cube {encoding:?} {format:?}");
            found.push((what, wrong(&seen, &around), around.len()));
        }
        let map = flat(gpu, lamp, near, format);
        let seen = visibility(gpu, &map, Kernel::Bilinear, &ask(&before));
        let what = format!("spot {format:?}");
        found.push((what, wrong(&seen, &before), before.len()));
    }
    found
}

#[test]
fn what_is_nearer_than_the_near_plane_casts_on_every_face() {
    let Some(gpu) = Gpu::for_test() else { return };
    if !gpu.support.depth_clip_control {
        return;
    }
    let near = Some(1.0);
    let lamp = Lamp::barred(&gpu);
    for (what, wrong, of) in wrong_on_all(&gpu, &lamp, near) {
        assert!(wrong == 0 && of > 100, "{what}: {wrong} of {of}");
    }
    // The broken twin: a device that only clips.
    let clips = Gpu::for_test_without(Features::DEPTH_CLIP_CONTROL).unwrap();
    let lamp = Lamp::barred(&clips);
    for (what, wrong, of) in wrong_on_all(&clips, &lamp, near) {
        assert!(wrong > of / 20, "{what}: {wrong} of {of}");
    }
}

#[test]
fn a_light_that_says_nothing_of_its_near_plane_loses_no_caster() {
    // Even where nothing can be pulled onto it.
    for features in [Features::empty(), Features::DEPTH_CLIP_CONTROL] {
        let Some(gpu) = Gpu::for_test_without(features) else {
            return;
        };
        let lamp = Lamp::at_all_distances(&gpu);
        let pulls = features.is_empty() && gpu.support.depth_clip_control;
        for (what, wrong, of) in wrong_on_all(&gpu, &lamp, None) {
            let fixed_point = !what.contains("Linear") && !what.contains("Float");
            if pulls || !fixed_point {
                assert!(wrong == 0 && of > 100, "{what}: {wrong} of {of}");
            }
        }
        // The broken twin: what hosts used to pass, a twentieth of a scene's size.
        if !pulls {
            for (what, wrong, of) in wrong_on_all(&gpu, &lamp, Some(0.05 * SHELL)) {
                assert!(wrong > of / 50, "{what}: {wrong} of {of}");
            }
        }
    }
}

/// With floats a near plane a power of two nearer changes the exponents of depths, not their digits:
/// so no receiver has another answer, whatever the kernel.
#[test]
fn a_tiny_near_plane_costs_floats_not_a_digit() {
    let Some(gpu) = Gpu::for_test() else { return };
    let lamp = {
        let (mut lamp, mut random) = (Lamp::new(), Random::new(5));
        for _ in 0..40 {
            let at = random.vec3().normalize() * (3.0 + random.next());
            let turn = Affine3A::from_axis_angle(random.vec3().normalize(), 1.0);
            let place = Affine3A::from_translation(at) * turn;
            lamp.add(&gpu, &cuboid(Vec3::new(0.5, 0.3, 0.4)), place);
        }
        lamp
    };
    let large = RANGE * 2.0_f32.powi(-6);
    let float = (DepthEncoding::MajorAxis, TextureFormat::Depth32Float);
    let texels = |near| -> Vec<f32> {
        let map = cube(&gpu, &lamp, near, float);
        let faces = faces(&gpu, &map);
        faces
            .iter()
            .flat_map(|face| bytemuck::pod_collect_to_vec::<u8, f32>(face))
            .collect()
    };
    let differ = |tiny: &[f32], large: &[f32], by: f32| {
        let pairs = tiny.iter().zip(large);
        pairs.filter(|(tiny, large)| **tiny * by != **large).count()
    };
    let (tiny, large_texels) = (texels(None), texels(Some(large)));
    let factor = 2.0_f32.powi(24 - 6);
    assert!(tiny.iter().filter(|&&depth| depth > 0.0).count() > 10_000);
    assert_eq!(differ(&tiny, &large_texels, factor), 0);
    // The broken twin: a near plane that is no power of two away.
    let uneven = texels(Some(large / 3.0));
    assert!(differ(&uneven, &large_texels, 3.0) > 1000);

    let points: Vec<_> = lamp
        .receivers(9.0)
        .into_iter()
        .map(|(point, _)| point)
        .collect();
    let before: Vec<_> = lamp
        .receivers(0.7)
        .into_iter()
        .map(|(point, _)| point)
        .collect();
    let linear = (DepthEncoding::LinearDistance, TextureFormat::Depth32Float);
    for kernel in Kernel::ALL {
        for kind in [float, linear]
            .into_iter()
            .filter(|kind| kernel.reads(MapKind::Cube(kind.0)))
        {
            let [tiny, large] = [None, Some(large)].map(|near| {
                let map = cube(&gpu, &lamp, near, kind);
                visibility(&gpu, &map, kernel, &points)
            });
            assert_eq!(tiny, large, "{kernel:?} {kind:?}");
        }
        let [tiny, large] = [None, Some(large)].map(|near| {
            let map = flat(&gpu, &lamp, near, TextureFormat::Depth32Float);
            visibility(&gpu, &map, kernel, &before)
        });
        assert_eq!(tiny, large, "{kernel:?}, spot");
    }
}

/// A surface that casts on itself from very near the light to its end shows no acne: the bias along the
/// normal grows with the distance, as what rasterisers make of such long triangles does.
#[test]
fn a_floor_just_below_a_light_has_no_acne() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut without_bias = 0;
    for height in [0.3_f32, 1e-2, 1e-3] {
        let mut lamp = Lamp::new();
        let floor = crate::common::shapes::square(30.0);
        lamp.add(&gpu, &floor, Affine3A::from_translation(-height * Vec3::Y));
        let mut random = Random::new(7);
        let points: Vec<_> = (0..4000)
            .map(|_| {
                let radius = height * (25.0 / height).powf(0.5 + 0.5 * random.next());
                let (sine, cosine) = (random.next() * 3.15).sin_cos();
                let at = Vec3::new(radius * cosine, -height, radius * sine);
                (lamp.position + at, Vec3::Y)
            })
            .collect();
        let shadowed = |bias| {
            let descriptor = CubeShadowMapDescriptor {
                size: SIZE,
                settings: MapSettings {
                    bias,
                    ..Default::default()
                },
                ..Default::default()
            };
            let map = fresh(&gpu, &descriptor, lamp.point(None), &lamp.casters);
            // Wider kernels take the floor for its own caster where it grazes the light so: `Kernel`.
            [Kernel::Hard, Kernel::Bilinear]
                .map(|kernel| {
                    let seen = visibility(&gpu, &map, kernel, &points);
                    seen.iter().filter(|lit| **lit < 1.0).count()
                })
                .into_iter()
                .sum::<usize>()
        };
        assert_eq!(shadowed(Bias::default()), 0, "{height}");
        without_bias += shadowed(Bias::NONE);
    }
    assert!(without_bias > 1000, "the broken twin: {without_bias}");
}
