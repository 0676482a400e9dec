//! Static casters baked, dynamic ones in an atlas: no caster is missing and none darkens twice.

use glam::camera::rh::{proj::directx as proj, view as camera};
use glam::{Affine3A, Quat, Vec3};
use host::gpu::Gpu;
use shadows::reference::bake::{
    BakeDescriptor, BakedLight, Emitter, LightMapLayout, TexelRectangle,
};
use shadows::reference::{Class, ReferenceImage, ReferenceScene};
use shadows::{
    AtlasFrame, AtlasLight, Caster, DepthConvention, Kernel, MapKind, PcfDescriptor, PointLight,
    ShadowAtlas, ShadowAtlasDescriptor, TileSize, View, glam,
};

use super::yard::{Unwrapped, cuboid, square};
use crate::common::shapes;
use crate::receivers::ask;

const STATIC: u32 = 1;
const DYNAMIC: u32 = 2;
const TEXELS: u32 = 512;
const SIDE: u32 = 128;
const RADIUS: f32 = 0.25;

fn lamp() -> PointLight {
    PointLight::new(Vec3::new(0.3, 5.0, -0.4), 30.0)
}

/// Half sides and place of what stands, and of what moves; their shadows cross.
fn boxes() -> [(Vec3, Affine3A); 2] {
    let at = |turn, to| Affine3A::from_rotation_translation(Quat::from_rotation_y(turn), to);
    [
        (Vec3::new(0.9, 0.2, 0.5), at(0.3, Vec3::new(-0.3, 1.6, 0.0))),
        (Vec3::new(0.4, 0.2, 0.9), at(-0.2, Vec3::new(0.4, 2.2, 0.3))),
    ]
}

/// The exact answer with either kind of casters, and with both.
struct Truth {
    fixed: ReferenceImage,
    moving: ReferenceImage,
    all: ReferenceImage,
    /// Pixels that see the ground, and where.
    pixels: Vec<[u32; 2]>,
    points: Vec<Vec3>,
}

fn ground() -> Unwrapped {
    Unwrapped::new(&square(3.0, Affine3A::IDENTITY), TEXELS, 0.0)
}

/// With what stands, with what moves.
fn scene(of: [bool; 2]) -> ReferenceScene {
    let ground = ground();
    let meshes = boxes().map(|(half, place)| Unwrapped::new(&cuboid(half, place), 64, 2.0));
    let mut objects = vec![ground.object(false)];
    let chosen = meshes.iter().zip(of).filter(|(_, is_there)| *is_there);
    objects.extend(chosen.map(|(mesh, _)| mesh.object(true)));
    ReferenceScene::new(&objects).unwrap()
}

impl Truth {
    fn new() -> Self {
        // Below the boxes, so that little of the ground is hidden.
        let camera = camera::look_at_mat4(Vec3::new(2.3, 1.3, 3.1), Vec3::ZERO, Vec3::Y);
        let projection = proj::perspective_infinite_reverse(0.9, 1.0, 0.1);
        let view = View::new(projection * camera, DepthConvention::InfiniteReverse).unwrap();
        let render = |of| {
            let light = lamp().homogeneous();
            scene(of).render(&view, SIDE, SIDE, light, None).unwrap()
        };
        let all = render([true, true]);
        let pixels = (0..SIDE * SIDE).map(|at| [at % SIDE, at / SIDE]);
        let hits = pixels.filter_map(|at| Some((at, all.hit(at[0], at[1])?)));
        let (pixels, points) = hits
            .filter(|(_, hit)| hit.object == 0)
            .map(|(at, hit)| (at, hit.position.as_vec3()))
            .unzip();
        Self {
            fixed: render([true, false]),
            moving: render([false, true]),
            all,
            pixels,
            points,
        }
    }

    /// Exact visibility at the points: of a hard light, or of one with a radius.
    fn of(&self, image: &ReferenceImage, radius: Option<f32>) -> Vec<f64> {
        if let Some(radius) = radius {
            let seen = image.area_visibility(&self.pixels, radius.into(), 256);
            return seen.into_iter().map(|seen| seen.unwrap()).collect();
        }
        let classes: Vec<Class> = image.classes().collect();
        let lit = |[x, y]: &[u32; 2]| classes[(y * SIDE + x) as usize] == Class::Lit;
        self.pixels
            .iter()
            .map(|at| f64::from(u8::from(lit(at))))
            .collect()
    }
}

/// Of what stands, at the points.
fn baked(truth: &Truth, radius: Option<f32>) -> Vec<f64> {
    let ground = ground();
    let receiver = ground.receiver(TexelRectangle {
        x: 0,
        y: 0,
        width: TEXELS,
        height: TEXELS,
    });
    let layout = LightMapLayout::new([TEXELS; 2], &[receiver]).unwrap();
    let emitter = radius.map_or(Emitter::Point, |radius| Emitter::Sphere { radius });
    let light = BakedLight::new(lamp()).with_emitter(emitter);
    let descriptor = BakeDescriptor {
        samples: 16,
        ..Default::default()
    };
    let map = scene([true, false])
        .bake(&layout, &light, &descriptor)
        .unwrap();
    // The ground spans the map, u along x.
    let at = |x: f32| f64::from(x + 3.0) / 6.0 * f64::from(TEXELS);
    let points = truth.points.iter();
    points
        .map(|point| map.bilinear([at(point.x), at(point.z)]).into())
        .collect()
}

/// An atlas whose light casts the shadows of these layers, at the points.
fn drawn(gpu: &Gpu, truth: &Truth, layers: u32, kernel: Kernel) -> Vec<f64> {
    let casters = boxes().map(|(half, place)| shapes::cuboid(half).caster(&gpu.device, place));
    let mut casters: Vec<Caster> = casters.into();
    (casters[0].layers, casters[1].layers) = (STATIC, DYNAMIC);
    let size = if kernel == Kernel::Hard { 1024 } else { 64 };
    let light = AtlasLight::new(lamp()).with_size(TileSize::Fixed(size));
    let descriptor = ShadowAtlasDescriptor {
        layer_size: 2048,
        ..Default::default()
    };
    let mut atlas = ShadowAtlas::new(&gpu.device, &descriptor).unwrap();
    let frame = AtlasFrame {
        lights: &[light.with_layers(layers)],
        casters: &casters,
        ..Default::default()
    };
    gpu.checked(|| {
        atlas.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        gpu.run(|encoder| atlas.encode(encoder));
    });
    let sampler = PcfDescriptor {
        kernel,
        map: MapKind::ATLAS,
        ..Default::default()
    };
    let points: Vec<(Vec3, Vec3)> = truth.points.iter().map(|point| (*point, Vec3::Y)).collect();
    let seen = ask(gpu, &atlas, &sampler, 0, &points);
    seen.into_iter().map(f64::from).collect()
}

fn joined(a: &[f64], b: &[f64], join: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| join(*a, *b)).collect()
}

fn product(a: f64, b: f64) -> f64 {
    a * b
}

fn mean_error(seen: &[f64], truth: &[f64]) -> f64 {
    let sum: f64 = seen.iter().zip(truth).map(|(a, b)| (a - b).abs()).sum();
    sum / seen.len() as f64
}

/// The rule's reason, by exact rays alone.
#[test]
fn visibilities_multiply_for_hard_lights_and_are_bounded_for_others() {
    let truth = Truth::new();
    assert!(truth.points.len() > 5000, "{}", truth.points.len());
    let of =
        |radius| [&truth.fixed, &truth.moving, &truth.all].map(|image| truth.of(image, radius));
    let [fixed, moving, all] = of(None);
    assert_eq!(joined(&fixed, &moving, product), all);
    // The twin: one of the two alone.
    assert!(fixed != all && moving != all);

    let [fixed, moving, all] = of(Some(RADIUS));
    // The same places on the light are tried in all three.
    let rounding = 1e-12;
    let mut apart = [0.0_f64; 2];
    for ((a, b), v) in fixed.iter().zip(&moving).zip(&all) {
        let (least, most) = ((a + b - 1.0).max(0.0), a.min(*b));
        assert!(
            *v >= least - rounding && *v <= most + rounding,
            "{a} {b} {v}"
        );
        apart = [
            apart[0].max((v - a * b).abs()),
            apart[1].max((v - most).abs()),
        ];
    }
    assert!(
        apart[0] <= 0.25 + rounding && apart[1] <= 0.5 + rounding,
        "{apart:?}"
    );
    // The twin: the product is no exact answer here, and the minimum is worse.
    assert!(apart[0] > 0.05 && apart[1] > apart[0], "{apart:?}");
}

#[test]
fn baked_and_drawn_are_as_right_together_as_each_alone() {
    let Some(gpu) = Gpu::for_test() else { return };
    let truth = Truth::new();
    let [fixed, moving, all] =
        [&truth.fixed, &truth.moving, &truth.all].map(|image| truth.of(image, None));
    let map = baked(&truth, None);
    let atlas = drawn(&gpu, &truth, DYNAMIC, Kernel::Hard);
    let together = mean_error(&joined(&map, &atlas, product), &all);
    // |ab - AB| <= |a - A| + |b - B| where none is above 1.
    let most = mean_error(&map, &fixed) + mean_error(&atlas, &moving);
    assert!(together <= most && most < 0.02, "{together} {most}");
    // All in the map: the smaller of both is right, too.
    let every = drawn(&gpu, &truth, STATIC | DYNAMIC, Kernel::Hard);
    assert!(mean_error(&joined(&map, &every, f64::min), &all) < 0.02);
    // The twins: either alone; dynamic casters under the layer of static ones.
    assert!(mean_error(&map, &all) > 0.05 && mean_error(&atlas, &all) > 0.05);
    let wrong = drawn(&gpu, &truth, STATIC, Kernel::Hard);
    assert!(mean_error(&joined(&map, &wrong, product), &all) > 0.05);
}

/// Static casters in both darken their penumbrae twice.
#[test]
fn a_penumbra_is_not_darkened_twice() {
    let Some(gpu) = Gpu::for_test() else { return };
    let truth = Truth::new();
    let fixed = truth.of(&truth.fixed, Some(RADIUS));
    let map = baked(&truth, Some(RADIUS));
    let kernel = Kernel::Weighted7;
    let dynamic = drawn(&gpu, &truth, DYNAMIC, kernel);
    let every = drawn(&gpu, &truth, STATIC | DYNAMIC, kernel);
    // In the penumbra of what stands, away from what moves and its filtered edges.
    let mean = |seen: &[f64]| {
        let penumbra =
            (0..seen.len()).filter(|&at| (0.2..0.8).contains(&fixed[at]) && dynamic[at] > 0.999);
        let differences: Vec<f64> = penumbra.map(|at| seen[at] - fixed[at]).collect();
        assert!(differences.len() > 40, "{}", differences.len());
        differences.iter().sum::<f64>() / differences.len() as f64
    };
    let right = mean(&joined(&map, &dynamic, product));
    let twice = mean(&joined(&map, &every, product));
    assert!(right.abs() < 0.03, "{right}");
    // The twin.
    assert!(twice < -0.1, "{twice}");
    assert!(mean(&joined(&map, &every, f64::min)) > 0.7 * twice);
}
