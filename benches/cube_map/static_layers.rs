//! What layers of still casters are worth: copied under what moves, against drawing all again.

use std::time::Duration;

use shadows::glam::{Affine3A, Vec3, Vec3A};
use shadows::{Caster, CubeShadowMap, CubeShadowMapDescriptor, PointLight, StaticLayers, wgpu};

use super::shapes::{cuboid, sphere};
use super::{frame, median, new_map, ratio};
use host::gpu::Gpu;

/// What stands still before each face: `side` x `side` spheres.
#[derive(Clone, Copy)]
struct StillPart {
    side: u32,
    rings: u32,
    radius: f32,
}

impl StillPart {
    /// Few texels, so that triangles are what counts.
    fn small(triangles: u32) -> Self {
        Self {
            side: 1,
            rings: (triangles / 8).isqrt(),
            radius: 0.02,
        }
    }

    /// 4,608 triangles on a third of the face.
    const HEAVY: Self = Self {
        side: 4,
        rings: 6,
        radius: 1.0,
    };

    /// Its spheres before one face.
    fn places(self, direction: Vec3) -> impl Iterator<Item = Affine3A> {
        let (right, up) = direction.any_orthonormal_pair();
        let at = move |k: u32| 2.0 * k as f32 - (self.side - 1) as f32;
        (0..self.side * self.side).map(move |i| {
            let (x, y) = (at(i % self.side), at(i / self.side));
            Affine3A::from_translation(direction * 6.0 + right * x + up * y)
                * Affine3A::from_scale(Vec3::splat(self.radius))
        })
    }
}

/// A part that stands still around a light, and a box that moves before each face.
struct Surroundings {
    casters: Vec<Caster>,
    maps: [CubeShadowMap; 2],
}

const BOXES: usize = 6;

impl Surroundings {
    fn new(gpu: &Gpu, size: u32, part: StillPart, layers: StaticLayers) -> Self {
        let box_mesh = cuboid(Vec3::splat(0.2)).mesh(&gpu.device);
        let sphere_mesh = sphere(part.rings, 4 * part.rings).mesh(&gpu.device);
        let directions = Vec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
        let boxes = directions
            .clone()
            .map(|direction| Affine3A::from_translation(direction * 2.0))
            .map(|place| Caster::new(box_mesh.clone(), place));
        let spheres = directions
            .flat_map(|direction| part.places(direction))
            .map(|place| Caster::new(sphere_mesh.clone(), place));
        let map = |static_layers| {
            let descriptor = CubeShadowMapDescriptor {
                size,
                static_layers,
                ..Default::default()
            };
            new_map(gpu, &descriptor)
        };
        Self {
            casters: boxes.chain(spheres).collect(),
            maps: [layers, StaticLayers::Never].map(map),
        }
    }

    /// Times with layers and without, of one more frame.
    fn frame(&mut self, gpu: &Gpu) -> [Duration; 2] {
        for caster in &mut self.casters[..BOXES] {
            caster.world_from_object.translation += Vec3A::splat(0.001);
        }
        let light = PointLight::new(Vec3::ZERO, 30.0);
        let casters = &self.casters;
        self.maps
            .each_mut()
            .map(|map| frame(gpu, map, light, casters))
    }
}

pub fn run(gpu: &Gpu, rounds: u32) {
    let measure = |size, part, layers| {
        let mut scene = Surroundings::new(gpu, size, part, layers);
        let (mut layers, mut redraw) = (Vec::new(), Vec::new());
        for round in 0..rounds + 4 {
            let [layered, whole] = scene.frame(gpu);
            if round >= 4 {
                layers.push(layered);
                redraw.push(whole);
            }
        }
        let copied = scene.maps[0].statistics().faces_copied;
        (copied == 6).then_some([layers, redraw])
    };
    match measure(1024, StillPart::HEAVY, StaticLayers::Auto) {
        Some([layers, redraw]) => ratio("static_layer_vs_redraw", &layers, &redraw),
        None => println!("StaticLayers::Auto keeps no layer here"),
    }
    let always = StaticLayers::AtLeast(1);
    for size in [256, 1024, 2048] {
        for triangles in [8, 512, 8192] {
            let measured = measure(size, StillPart::small(triangles), always);
            let [layers, redraw] = measured.expect("a layer was asked for, and none copied");
            let name = format!("static_layer_vs_redraw_{size}_{triangles}");
            ratio(&name, &layers, &redraw);
        }
    }
    texels_a_triangle(gpu, rounds);
}

/// How many texels of depth are copied in the time in which a small triangle is drawn.
fn texels_a_triangle(gpu: &Gpu, rounds: u32) {
    const SIDE: u32 = 1024;
    const FEW: u32 = 512;
    const MANY: u32 = 32_768;
    let depth = |usage| {
        gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: SIDE,
                height: SIDE,
                depth_or_array_layers: 6,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Depth32Float,
            usage,
            view_formats: &[],
        })
    };
    let from = depth(wgpu::TextureUsages::COPY_SRC);
    let to = depth(wgpu::TextureUsages::COPY_DST);
    let mut scenes = [FEW, MANY].map(|triangles| {
        Surroundings::new(gpu, 256, StillPart::small(triangles), StaticLayers::Never)
    });
    let (mut few, mut many, mut copy) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..rounds.max(15) {
        let [light, heavy] = scenes.each_mut().map(|scene| scene.frame(gpu)[1]);
        few.push(light);
        many.push(heavy);
        copy.push(gpu.run(|encoder| {
            encoder.copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), from.size());
        }));
    }
    let triangle = (median(&many) - median(&few)) / f64::from(6 * (MANY - FEW));
    let texel = median(&copy) / f64::from(6 * SIDE * SIDE);
    println!(
        "a triangle {:.1} ns, a texel copied {:.3} ns",
        triangle * 1e9,
        texel * 1e9
    );
    println!("ratio texels_a_triangle {:.1}", triangle / texel);
}
