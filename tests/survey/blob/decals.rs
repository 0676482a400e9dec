//! Decals against the function, pixel by pixel, whatever the view and the light.

use shadows::glam::{Affine3A, Mat4, Vec3, Vec4};
use shadows::{
    Blob, BlobDecalDescriptor, BlobFrame, BlobLight, BlobShadow, BlobShadowDescriptor,
    DepthConvention, HomogeneousLight, View, rewriting, wgpu,
};

use host::gpu::Gpu;
use host::renderer::{self, Look, Orthographic, Renderer, ShadowAccess};
use host::scene::{Light, Scene, floor, homogeneous};
use host::scene_gpu::SceneGpu;

const SIZE: [u32; 2] = [160, 90];
const REACH: f32 = 30.0;
const LAMP: Vec4 = Vec4::new(0.6, 6.0, 0.9, 1.0);
const SUN: Vec4 = Vec4::new(0.5, 0.8, 0.3, 0.0);

/// A picture's visibility by decals and by the function, at the pixels that show something.
struct Both {
    decals: Vec<u8>,
    function: Vec<u8>,
}

impl Both {
    /// Pixels that differ by more than rounding in 8 bits of each of the blobs.
    fn differing(&self) -> usize {
        let pairs = self.decals.iter().zip(&self.function);
        pairs.filter(|(a, b)| a.abs_diff(**b) > 4).count()
    }

    fn dark(&self) -> usize {
        self.function.iter().filter(|v| **v < 128).count()
    }
}

struct Trial {
    scene: Scene,
    look: Look,
    /// Before clip space: mirrors.
    mirror: Mat4,
    radius: f32,
    reach: f32,
    blobs: Vec<Blob>,
}

impl Trial {
    /// The scene `floor` under a light.
    fn under(place: Vec4, radius: f32) -> Self {
        let mut scene = floor();
        scene.lights = vec![Light::new(place, 1e3)];
        Self {
            scene,
            look: Look::default(),
            mirror: Mat4::IDENTITY,
            radius,
            reach: REACH,
            blobs: Vec::new(),
        }
    }

    fn from(mut self, eye: Vec3, target: Vec3) -> Self {
        (self.scene.camera.eye, self.scene.camera.target) = (eye, target);
        self
    }

    fn looking(mut self, look: Look) -> Self {
        self.look = look;
        self
    }

    fn mirrored(mut self) -> Self {
        self.mirror = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        self
    }

    fn scaled(mut self, scale: f32) -> Self {
        for object in &mut self.scene.objects {
            object.transform = Affine3A::from_scale(Vec3::splat(scale)) * object.transform;
        }
        let camera = &mut self.scene.camera;
        camera.eye *= scale;
        camera.target *= scale;
        camera.near *= scale;
        let light = self.scene.light_mut();
        light.range *= scale;
        light.place = (light.place.truncate() * scale).extend(light.place.w);
        if light.place.w != 0.0 {
            self.radius *= scale;
        }
        self.reach *= scale;
        self
    }

    fn both(&self, gpu: &Gpu) -> Both {
        let device = &gpu.device;
        let scene_gpu = SceneGpu::new(gpu, &self.scene).unwrap();
        let mut host = Renderer::with_look(gpu, SIZE, &self.scene, &scene_gpu, self.look).unwrap();
        let matrix = self.mirror * renderer::matrix(&self.scene, SIZE, self.look);
        host.show(gpu, &self.scene, matrix);
        let view = View::new(matrix, self.look.depth).unwrap();
        let descriptor = BlobShadowDescriptor {
            lights: 2,
            views: 2,
            decals: Some(BlobDecalDescriptor {
                depth_stencil_format: Some(host.depth_stencil_format()),
                ..Default::default()
            }),
            ..Default::default()
        };
        let mut shadow = BlobShadow::new(device, &descriptor).unwrap();
        let light = homogeneous(self.scene.light().place);
        let light = BlobLight::new(light, self.radius, self.reach);
        // The second of two, so that the right ones are read.
        let other = BlobLight::new(HomogeneousLight::point(Vec3::X), 1.0, 1.0);
        let elsewhere = renderer::view_as(&floor(), [64, 64], Look::default()).unwrap();
        let frame = BlobFrame {
            lights: &[other, light],
            views: &[elsewhere, view],
            casters: &scene_gpu.casters,
            blobs: &self.blobs,
        };
        shadow.prepare(device, &gpu.queue, &frame).unwrap();
        let module = shadow.wgsl_module(1)
            + "fn host_visibility(at: HostReceiver) -> f32 {
                return shadows_blob_visibility(1u, at.world);
            }";
        let lit = host.lit_pipeline(
            gpu,
            &ShadowAccess {
                module: Some(&module),
                layout: shadow.bind_group_layout(),
                ..Default::default()
            },
        );
        let mask = gpu.target(SIZE, wgpu::TextureFormat::R8Unorm, 1);
        let mask_view = mask.create_view(&Default::default());
        let depth = shadow
            .decal_bind_group(device, host.depth_stencil())
            .unwrap();
        gpu.checked(|| {
            gpu.run(|encoder| {
                shadow.encode(encoder);
                host.draw_ambient(encoder, &scene_gpu);
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("blobs"),
                    color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                        view: &mask_view,
                        depth_slice: None,
                        resolve_target: None,
                        ops: wgpu::Operations {
                            load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                            store: wgpu::StoreOp::Store,
                        },
                    })],
                    depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                        view: host.depth_stencil(),
                        depth_ops: None,
                        stencil_ops: None,
                    }),
                    ..Default::default()
                });
                shadow.render(&mut pass, 1, 1, &depth).unwrap();
                drop(pass);
                host.draw_lit(encoder, &scene_gpu, &lit, shadow.bind_group());
            });
        });
        let depth = gpu.read_texture(
            host.depth_stencil().texture(),
            0,
            wgpu::TextureAspect::DepthOnly,
        );
        let depth: Vec<f32> = bytemuck::pod_collect_to_vec(&depth);
        let seen = |visibility: Vec<u8>| {
            let clear = self.look.depth.clear_depth();
            let pixels = visibility.into_iter().zip(&depth);
            pixels
                .filter(|(_, depth)| **depth != clear)
                .map(|(v, _)| v)
                .collect()
        };
        Both {
            decals: seen(gpu.read_texture(&mask, 0, wgpu::TextureAspect::All)),
            function: seen(host.read_visibility(gpu)),
        }
    }

    /// With a shader of the library changed.
    fn broken(&self, gpu: &Gpu, from: &'static str, to: &'static str) -> Both {
        self.changed(gpu, [[from, to]])
    }

    fn changed<const N: usize>(&self, gpu: &Gpu, changes: [[&'static str; 2]; N]) -> Both {
        rewriting::set(Some(Box::new(move |text| {
            let all = changes.iter();
            all.fold(text.to_owned(), |text, [from, to]| text.replace(from, to))
        })));
        let both = self.both(gpu);
        rewriting::set(None);
        both
    }
}

fn depth(depth: DepthConvention) -> Look {
    Look {
        depth,
        ..Default::default()
    }
}

fn orthographic() -> Look {
    Look {
        orthographic: Some(Orthographic {
            left: -6.0,
            right: 6.0,
            bottom: -4.0,
            top: 4.0,
            near: -5.0,
            far: 40.0,
        }),
        ..depth(DepthConvention::FiniteReverse)
    }
}

/// Hulls that end behind the far plane, 20 m away.
fn beyond() -> Trial {
    let mut trial = Trial::under(LAMP, 0.4).looking(depth(DepthConvention::Standard));
    trial.scene.camera.near = 0.02;
    trial.reach = 300.0;
    trial
}

/// Between the ball and its shadow, which is looked at.
const INSIDE: [Vec3; 2] = [Vec3::new(-2.9, 0.35, -0.7), Vec3::new(-3.6, 0.0, -1.05)];

#[test]
fn decals_show_what_the_function_says_in_every_view() {
    let Some(gpu) = Gpu::for_test() else { return };
    let lamp = || Trial::under(LAMP, 0.4);
    for (name, trial) in [
        ("lamp", lamp()),
        ("sun", Trial::under(SUN, 0.1)),
        ("hard", Trial::under(LAMP, 0.0)),
        ("standard", lamp().looking(depth(DepthConvention::Standard))),
        (
            "finite",
            lamp().looking(depth(DepthConvention::FiniteReverse)),
        ),
        ("orthographic", lamp().looking(orthographic())),
        ("inside", lamp().from(INSIDE[0], INSIDE[1])),
        ("beyond", beyond()),
        ("mirrored", lamp().mirrored()),
        (
            "mirrored inside",
            lamp().from(INSIDE[0], INSIDE[1]).mirrored(),
        ),
        ("low", lamp().from(Vec3::new(0.0, 0.3, 6.0), Vec3::ZERO)),
        // Nearer to blobs than they are wide, and in one.
        ("near", Trial::under(Vec4::new(-2.3, 2.2, -0.5, 1.0), 0.3)),
        ("within", Trial::under(Vec4::new(-2.6, 1.3, -0.6, 1.0), 0.1)),
        ("grazing", Trial::under(Vec4::new(1.0, 0.08, 0.2, 0.0), 0.3)),
        (
            "short",
            Trial {
                reach: 1.0,
                ..lamp()
            },
        ),
        (
            "endless",
            Trial {
                reach: f32::MAX,
                ..lamp()
            },
        ),
        (
            "endless sun",
            Trial {
                reach: f32::MAX,
                ..Trial::under(SUN, 0.1)
            },
        ),
        ("small", lamp().scaled(1e-4)),
        ("large", lamp().scaled(1e5)),
    ] {
        let both = trial.both(&gpu);
        let (differing, dark) = (both.differing(), both.dark());
        println!("{name}: {differing} of {}, {dark} dark", both.decals.len());
        assert!(dark > 40, "{name}: {dark}");
        // At hard outlines rounding decides.
        let allowed = if name == "hard" { 6 } else { 0 };
        assert!(differing <= allowed, "{name}: {differing}");
    }
}

#[test]
fn broken_decals_are_found() {
    let Some(gpu) = Gpu::for_test() else { return };
    let lamp = || Trial::under(LAMP, 0.4);
    for (from, to, trial) in [
        // No depth: all receivers at one distance.
        (
            "textureLoad(shadows_blob_depth, vec2i(in.clip.xy), 0).x",
            "0.009",
            lamp(),
        ),
        // A hull that does not widen by the penumbra.
        ("far_width, side.z", "near_width, side.z", lamp()),
        // One that ends at the caster.
        (
            "let end = blob.radius + light.reach;",
            "let end = blob.radius;",
            lamp(),
        ),
        // Near sides: not there for an eye inside.
        (
            "shadows_blob_view.turn < 0.0",
            "shadows_blob_view.turn > 0.0",
            lamp().from(INSIDE[0], INSIDE[1]),
        ),
        (
            "shadows_blob_view.turn < 0.0",
            "false",
            lamp().from(INSIDE[0], INSIDE[1]).mirrored(),
        ),
        // Hulls that the far plane cuts.
        ("0.5 * clip.w, clip.w", "clip.z, clip.w", beyond()),
        (
            "vec2f(2.0, -2.0) + vec2f(-1.0, 1.0)",
            "vec2f(2.0) - 1.0",
            lamp(),
        ),
    ] {
        let both = trial.broken(&gpu, from, to);
        println!("{from}: {}", both.differing());
        // None of the sound ones does.
        assert!(both.differing() > 10, "{from}: {}", both.differing());
    }
}

#[test]
fn what_casts_nothing_covers_no_pixel() {
    let Some(gpu) = Gpu::for_test() else { return };
    let without = |blobs: Vec<Blob>| {
        let mut trial = Trial::under(LAMP, 0.4);
        // The floor alone receives.
        trial.scene.objects.truncate(1);
        trial.scene.objects[0].casts = false;
        Trial { blobs, ..trial }
    };
    // Every pixel that a hull covers is black, and what has no area has a hull as wide as the reach.
    let black = [
        [
            "return vec4f(vec3f(visibility), 1.0);",
            "return vec4f(0.0);",
        ],
        ["blob.radius / determinant(rows)", "1.0"],
    ];
    let covered = |blobs| {
        let both = without(blobs).changed(&gpu, black);
        both.decals.iter().filter(|v| **v == 0).count()
    };
    let ball = Blob::sphere(Vec3::Y, 0.5);
    let clear = Blob {
        opacity: 0.0,
        ..ball
    };
    assert_eq!(covered(vec![clear, Blob::sphere(Vec3::Y, 0.0)]), 0);
    assert!(covered(vec![ball]) > 100);
}

#[test]
fn a_thousand_blobs_are_multiplied() {
    let Some(gpu) = Gpu::for_test() else { return };
    let at = |i: usize| Vec3::new((i % 40) as f32 - 20.0, 0.5, (i / 40) as f32 - 12.0) * 0.4;
    let blobs = (0..1000).map(|i| Blob {
        opacity: 0.9,
        ..Blob::sphere(at(i), 0.12)
    });
    let trial = Trial {
        blobs: blobs.collect(),
        ..Trial::under(SUN, 0.05)
    };
    let both = trial.both(&gpu);
    assert!(both.dark() > 500, "{}", both.dark());
    // Rounded to 8 bits with each that overlaps.
    assert!(both.differing() < 10, "{}", both.differing());
}
