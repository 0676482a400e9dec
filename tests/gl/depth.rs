//! Depth on GL, where clip z becomes `2 z - w`: maps hold what they hold elsewhere.

use shadows::glam::{Affine3A, Quat, Vec3};
use shadows::mesh::Bounds;
use shadows::{
    AnyMap, Bias, Caster, CasterMesh, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor,
    DepthEncoding, FlatLight, Kernel, MapKind, MapSettings, PcfDescriptor, PcfSampler, PointLight,
    ShadowFrame, ShadowMap, ShadowMapDescriptor, SpotLight,
};

use crate::common::own_pass::OwnPass;
use crate::common::shapes::{Random, Shape, square};
use crate::gl;
use crate::receivers::ask;
use host::gpu::Gpu;

const SIZE: u32 = 64;
const TEXELS: u32 = SIZE * SIZE;

/// A light over the origin, and a square through it that leans and reaches far behind the light.
struct Ground {
    shape: Shape,
    turn: Affine3A,
    light: PointLight,
}

impl Ground {
    fn new(height: f32, near: Option<f32>, lean: f32) -> Self {
        let turn = Quat::from_rotation_z(lean) * Quat::from_rotation_x(0.6 * lean);
        Self {
            shape: square(150.0 * height),
            turn: Affine3A::from_quat(turn),
            light: PointLight {
                near,
                ..PointLight::new(Vec3::Y * height, 1e4)
            },
        }
    }

    fn caster(&self, gpu: &Gpu) -> Caster {
        self.shape.caster(&gpu.device, self.turn)
    }

    fn map(&self, gpu: &Gpu, encoding: DepthEncoding) -> CubeShadowMap {
        self.map_with(gpu, encoding, Bias::default())
    }

    fn map_with(&self, gpu: &Gpu, encoding: DepthEncoding, bias: Bias) -> CubeShadowMap {
        let descriptor = CubeShadowMapDescriptor {
            size: SIZE,
            encoding,
            settings: MapSettings {
                bias,
                ..Default::default()
            },
            ..Default::default()
        };
        crate::cubes::fresh(gpu, &descriptor, self.light, &[self.caster(gpu)])
    }

    /// The broken twin: drawn by a host that leaves depth to the rasteriser.
    fn map_of_a_host(&self, gpu: &Gpu) -> CubeShadowMap {
        let corners: Vec<Vec3> = (self.shape.indices.iter())
            .map(|&i| self.shape.positions[i as usize].into())
            .map(|corner| self.turn.transform_point3(corner))
            .collect();
        let mut bounds = Bounds {
            min: corners[0],
            max: corners[0],
        };
        for corner in &corners {
            bounds.min = bounds.min.min(*corner);
            bounds.max = bounds.max.max(*corner);
        }
        let mesh = CasterMesh::host_drawn(&gpu.device, bounds, corners.len() as u32 / 3).unwrap();
        let casters = [Caster::new(mesh, Affine3A::IDENTITY)];
        let descriptor = CubeShadowMapDescriptor {
            size: SIZE,
            ..Default::default()
        };
        let mut map = CubeShadowMap::new(&gpu.device, &descriptor).unwrap();
        let frame = CubeFrame::new(self.light, &casters);
        map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        gpu.run(|encoder| {
            map.encode_with(encoder, |pass, asked| {
                OwnPass::new(&gpu.device, &asked.clip_from_world, &corners).draw(pass);
            });
        });
        map
    }

    /// The share of points on the square that are in shadow, which none is.
    fn acne(&self, gpu: &Gpu, map: &CubeShadowMap, encoding: DepthEncoding) -> f32 {
        let mut random = Random::new(5);
        let normal = self.turn.transform_vector3(Vec3::Y);
        let height = self.light.position.y;
        let points: Vec<_> = (0..4000)
            .map(|_| Vec3::new(random.next(), 0.0, random.next()) * 20.0 * height)
            .map(|point| (self.turn.transform_point3(point), normal))
            .collect();
        let descriptor = PcfDescriptor {
            kernel: Kernel::Weighted3,
            map: MapKind::Cube(encoding),
            ..Default::default()
        };
        let seen = ask(gpu, map, &descriptor, 0, &points);
        seen.iter().filter(|&&lit| lit < 1.0).count() as f32 / points.len() as f32
    }
}

/// The depths stored on all faces.
fn stored(gpu: &Gpu, map: &CubeShadowMap) -> Vec<f32> {
    let source = format!(
        "@group(1) @binding(0) var map: texture_2d_array<f32>;
        @group(1) @binding(1) var nearest: sampler;
        fn ask(i: u32) -> f32 {{
            let face = i / {TEXELS}u;
            let texel = vec2f(f32(i % {SIZE}u), f32(i % {TEXELS}u / {SIZE}u));
            return textureSampleLevel(map, nearest, (texel + 0.5) / {SIZE}.0, face, 0.0).x;
        }}"
    );
    let descriptor = PcfDescriptor {
        kernel: Kernel::Hard,
        map: AnyMap::from(map).kind(),
        ..Default::default()
    };
    let sampler = PcfSampler::new(&gpu.device, &gpu.queue, &descriptor).unwrap();
    let group = sampler.bind_group(&gpu.device, map).unwrap();
    crate::ask(
        gpu,
        &source,
        (sampler.bind_group_layout(), &group),
        6 * TEXELS,
    )
}

/// As a share of depth, a quarter of the bias at 64 texels. Where the sides clip a triangle, its new
/// vertices snap to the rasteriser's grid on each back end by themselves: each by up to sqrt(2) / 512 of a
/// texel, 9e-5 of a depth for a plane at 45 degrees.
const SAME: f32 = 4e-4;

/// Texels whose depths differ, and those that have one.
fn differ(a: &[f32], b: &[f32]) -> (usize, usize) {
    let share = |(a, b): (&f32, &f32)| (a - b).abs() / a.max(*b).max(f32::MIN_POSITIVE);
    let shares = || a.iter().zip(b).map(share);
    println!("at most {:.1e} apart", shares().fold(0.0, f32::max));
    (
        shares().filter(|&share| share > SAME).count(),
        b.iter()
            .filter(|&&depth| depth > 0.0 && depth < 1.0)
            .count(),
    )
}

const NEAR: [Option<f32>; 4] = [None, Some(1e-2), Some(1e-4), Some(1e-7)];
const PLACES: [(f32, f32); 4] = [(1.1, 0.0), (3.7, 0.2), (1.0, 0.4), (1.0, 1.1)];

#[test]
fn maps_hold_the_depths_that_they_hold_elsewhere() {
    let Some(gpu) = gl() else { return };
    let Ok(vulkan) = Gpu::new(Some("(vulkan,")) else {
        eprintln!("skipped: no Vulkan adapter to compare with");
        return;
    };
    let mut twins = 0;
    for near in NEAR {
        for (height, lean) in PLACES {
            let ground = Ground::new(height, near, lean);
            for encoding in [DepthEncoding::MajorAxis, DepthEncoding::LinearDistance] {
                let right = stored(&vulkan, &ground.map(&vulkan, encoding));
                let (apart, all) = differ(&stored(&gpu, &ground.map(&gpu, encoding)), &right);
                println!("near {near:?}, {height} away, {lean}, {encoding:?}: {apart} of {all}");
                assert!(all > 8000, "{all}");
                assert_eq!(
                    apart, 0,
                    "near {near:?}, {height} away, {lean}, {encoding:?}"
                );
            }
            let right = stored(&vulkan, &ground.map(&vulkan, DepthEncoding::MajorAxis));
            let (apart, all) = differ(&stored(&gpu, &ground.map_of_a_host(&gpu)), &right);
            println!("near {near:?}, {height} away, {lean}, a host's: {apart} of {all}");
            twins += apart;
        }
    }
    assert!(twins > 50_000, "{twins}");
}

#[test]
fn a_ground_has_no_acne_whatever_the_near_plane() {
    let Some(gpu) = gl() else { return };
    let mut twins = 0.0;
    for near in NEAR {
        for (height, lean) in PLACES {
            let ground = Ground::new(height, near, lean);
            for encoding in [DepthEncoding::MajorAxis, DepthEncoding::LinearDistance] {
                let acne = ground.acne(&gpu, &ground.map(&gpu, encoding), encoding);
                println!("near {near:?}, {height} away, {lean}, {encoding:?}: {acne}");
                assert_eq!(
                    acne, 0.0,
                    "near {near:?}, {height} away, {lean}, {encoding:?}"
                );
            }
            let twin = ground.map_of_a_host(&gpu);
            let twin = ground.acne(&gpu, &twin, DepthEncoding::MajorAxis);
            println!("near {near:?}, {height} away, {lean}, a host's: {twin}");
            twins += twin;
        }
    }
    assert!(twins > 0.5, "{twins}");
}

#[test]
fn a_slope_scaled_bias_moves_depths_as_elsewhere() {
    let Some(gpu) = gl() else { return };
    let Ok(vulkan) = Gpu::new(Some("(vulkan,")) else {
        eprintln!("skipped: no Vulkan adapter to compare with");
        return;
    };
    let map = |gpu: &Gpu, slope_scale| {
        let bias = Bias {
            slope_scale,
            ..Bias::default()
        };
        let ground = Ground::new(3.7, Some(0.05), 0.2);
        stored(gpu, &ground.map_with(gpu, DepthEncoding::MajorAxis, bias))
    };
    let right = map(&vulkan, 2.0);
    // At the square's edges the difference to the next texel is another's business.
    assert!(differ(&map(&gpu, 2.0), &right).0 < 8);
    // The broken twin: none.
    assert!(differ(&map(&gpu, 0.0), &right).0 > 8000);
}

#[test]
fn casters_before_the_near_plane_of_a_spot_are_pulled_onto_it_or_left_out() {
    let Some(gpu) = gl() else { return };
    let light = FlatLight::Spot(SpotLight {
        near: Some(2.0),
        ..SpotLight::new(Vec3::Y * 5.0, Vec3::NEG_Y, 0.5, 20.0)
    });
    let roof = square(0.2).caster(&gpu.device, Affine3A::from_translation(Vec3::Y * 4.0));
    let far = square(0.2).caster(
        &gpu.device,
        Affine3A::from_translation(Vec3::new(1.2, 1.0, 0.0)),
    );
    let points = [
        (Vec3::ZERO, Vec3::Y),
        (Vec3::X * 1.5, Vec3::Y),
        (Vec3::Z * 1.5, Vec3::Y),
    ];
    for (unclipped_depth, expected) in [(true, [0.0, 0.0, 1.0]), (false, [1.0, 0.0, 1.0])] {
        let descriptor = ShadowMapDescriptor {
            size: 256,
            unclipped_depth,
            ..Default::default()
        };
        let mut map = ShadowMap::new(&gpu.device, &descriptor).unwrap();
        let casters = [roof.clone(), far.clone()];
        let frame = ShadowFrame::new(light, &casters);
        map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        gpu.run(|encoder| map.encode(encoder));
        let descriptor = PcfDescriptor {
            map: MapKind::FLAT,
            ..Default::default()
        };
        assert_eq!(ask(&gpu, &map, &descriptor, 0, &points), expected);
    }
}
