//! Planar soft shadows: what a light with a size leaves of light, and how near to it a number of samples comes.

use host::exact;
use host::gpu::Gpu;
use host::renderer::{self, Renderer, ShadowAccess};
use host::scene::{Scene, homogeneous};
use host::scene_gpu::SceneGpu;
use host::shapes;
use shadows::error::PlanarSoftShadowError as Error;
use shadows::glam::{Affine3A, Vec3};
use shadows::mesh::Adjacency;
use shadows::reference::ReferenceImage;
use shadows::{
    Caster, CasterMesh, DirectionalLight, Light, LightShape, PlanarRectangle, PlanarSoftFrame,
    PlanarSoftShadow, PlanarSoftShadowDescriptor, PointLight, wgpu,
};

use crate::planar::uncut;
use crate::planar_host::at;

const SIZE: [u32; 2] = [240, 160];

/// The square of this half side around the origin, seen from above.
fn square(half: f32) -> PlanarRectangle {
    PlanarRectangle {
        corner: Vec3::new(-half, 0.0, -half),
        width: Vec3::Z * 2.0 * half,
        height: Vec3::X * 2.0 * half,
    }
}

/// The scene `floor` under a light with a size.
struct Studio {
    gpu: Gpu,
    scene: Scene,
    scene_gpu: SceneGpu,
    renderer: Renderer,
    reference: ReferenceImage,
}

impl Studio {
    fn new() -> Option<Self> {
        let gpu = Gpu::for_test()?;
        let scene = host::scene::floor();
        let scene_gpu = SceneGpu::new(&gpu, &scene).unwrap();
        let renderer = Renderer::new(&gpu, SIZE, &scene, &scene_gpu).unwrap();
        let view = renderer::view(&scene, SIZE).unwrap();
        let light = homogeneous(scene.light().place);
        let range = Some(scene.light().range);
        let exact = exact::reference_scene(&scene).unwrap();
        let reference = exact.render(&view, SIZE[0], SIZE[1], light, range).unwrap();
        Some(Self {
            gpu,
            scene,
            scene_gpu,
            renderer,
            reference,
        })
    }

    /// What is shown of a light of this radius.
    fn shown(&self, samples: u32, radius: f32) -> Vec<u8> {
        let gpu = &self.gpu;
        let descriptor = PlanarSoftShadowDescriptor {
            size: [2048; 2],
            samples,
            ..Default::default()
        };
        let mut soft = PlanarSoftShadow::new(&gpu.device, &descriptor).unwrap();
        let light = self.scene.light();
        let frame = PlanarSoftFrame {
            light: PointLight::new(light.place.truncate(), light.range).into(),
            shape: LightShape::Sphere { radius },
            receiver: square(host::scene::floor::HALF),
            casters: &self.scene_gpu.casters,
        };
        soft.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        let module = PlanarSoftShadow::wgsl_module(1)
            + "fn host_visibility(at: HostReceiver) -> f32 {
                return shadows_planar_visibility(at.world);
            }";
        let layout = soft.bind_group_layout().clone();
        let access = ShadowAccess {
            module: Some(&module),
            layout: Some(&layout),
            ..Default::default()
        };
        gpu.checked(|| {
            let lit = self.renderer.lit_pipeline(gpu, &access);
            gpu.run(|encoder| {
                self.renderer.draw_ambient(encoder, &self.scene_gpu);
                soft.encode(encoder);
                let group = Some(soft.bind_group());
                self.renderer
                    .draw_lit(encoder, &self.scene_gpu, &lit, group);
            });
        });
        self.renderer.read_visibility(gpu)
    }

    /// Whether a pixel shows the floor, and the light's middle is before it.
    fn is_floor(&self, x: u32, y: u32) -> bool {
        self.reference.hit(x, y).is_some_and(|hit| hit.object == 0)
    }
}

#[test]
fn the_error_against_a_light_with_a_size_falls_with_the_samples() {
    const RADIUS: f32 = 0.5;
    let Some(studio) = Studio::new() else { return };
    // Of the floor's pixels those that are in the penumbra, and as many of all others.
    let finest = studio.shown(255, RADIUS);
    let places = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
    let floor: Vec<([u32; 2], u8)> = places
        .zip(finest)
        .filter(|&([x, y], _)| studio.is_floor(x, y))
        .collect();
    let (between, others): (Vec<_>, Vec<_>) = floor
        .iter()
        .partition(|(_, value)| (5..250).contains(value));
    let spread = |all: Vec<&([u32; 2], u8)>| {
        let step = all.len().div_ceil(250).max(1);
        all.into_iter()
            .step_by(step)
            .map(|(place, _)| *place)
            .collect::<Vec<_>>()
    };
    assert!(between.len() > 300, "{} pixels of penumbra", between.len());
    let pixels = [spread(between), spread(others)].concat();
    let truth = studio
        .reference
        .area_visibility(&pixels, f64::from(RADIUS), 1024);
    let rmse = |picture: &[u8]| {
        let squares: Vec<f64> = pixels
            .iter()
            .zip(&truth)
            .filter_map(|(&[x, y], truth)| {
                let shown = f64::from(picture[(y * SIZE[0] + x) as usize]) / 255.0;
                truth.map(|truth| (shown - truth).powi(2))
            })
            .collect();
        assert!(squares.len() > 300);
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    let errors = [4, 16, 64, 255].map(|samples| rmse(&studio.shown(samples, RADIUS)));
    println!("RMSE of 4, 16, 64 and 255 samples: {errors:.4?}");
    // Places that are spread evenly: faster than the root of their number, by which random ones would.
    assert!(errors[1] < 0.5 * errors[0], "{errors:?}");
    assert!(errors[2] < 0.5 * errors[1], "{errors:?}");
    assert!(errors[2] < 0.03, "{errors:?}");
    // The twins: a light without a size, and one of another size.
    let points = [4, 64].map(|samples| rmse(&studio.shown(samples, 1e-3)));
    assert!(
        points[1] > 0.9 * points[0] && points[1] > 3.0 * errors[2],
        "{points:?}"
    );
    let smaller = rmse(&studio.shown(64, 0.5 * RADIUS));
    assert!(smaller > 2.0 * errors[2], "{smaller}");
}

#[test]
fn what_is_no_part_of_the_rectangle_is_lit() {
    let Some(studio) = Studio::new() else { return };
    let picture = studio.shown(16, 0.3);
    let facing: Vec<bool> = studio
        .reference
        .classes()
        .map(|class| class.faces_light())
        .collect();
    let of = |floor: bool| -> Vec<u8> {
        let pixels = (0..).zip(&picture);
        pixels
            .filter(|&(pixel, _)| facing[pixel as usize])
            .filter(|&(pixel, _)| {
                let (x, y) = (pixel % SIZE[0], pixel / SIZE[0]);
                let hit = studio.reference.hit(x, y).unwrap();
                // What stands on the floor is, at its foot, within a texel of it.
                let near = hit.position.y < f64::from(2.0 * host::scene::floor::HALF) / 2048.0;
                studio.is_floor(x, y) == floor && floor == near
            })
            .map(|(_, value)| *value)
            .collect()
    };
    let (floor, others) = (of(true), of(false));
    assert!(floor.contains(&0) && others.len() > 500);
    assert!(others.iter().all(|value| *value == 255));
}

/// Casters, and a texture that is read back.
struct Plate {
    gpu: Gpu,
    soft: PlanarSoftShadow,
    light: Light,
    shape: LightShape,
    receiver: PlanarRectangle,
    casters: Vec<Caster>,
}

impl Plate {
    fn new(samples: u32, bodies: &[(shapes::Shape, Affine3A)]) -> Option<Self> {
        let gpu = Gpu::for_test()?;
        let descriptor = PlanarSoftShadowDescriptor {
            size: [64, 64],
            samples,
            ..Default::default()
        };
        let soft = PlanarSoftShadow::new(&gpu.device, &descriptor).unwrap();
        let casters = bodies
            .iter()
            .map(|(shapes::Shape { positions, indices }, transform)| {
                let adjacency = Adjacency::new(positions, indices).unwrap();
                let mesh = CasterMesh::new(&gpu.device, positions, &adjacency).unwrap();
                Caster::new(mesh, *transform)
            })
            .collect();
        Some(Self {
            gpu,
            soft,
            light: PointLight::new(Vec3::new(0.5, 5.0, 0.3), 40.0).into(),
            shape: LightShape::Sphere { radius: 0.5 },
            receiver: square(3.0),
            casters,
        })
    }

    fn prepare(&mut self) {
        let frame = PlanarSoftFrame {
            light: self.light,
            shape: self.shape,
            receiver: self.receiver,
            casters: &self.casters,
        };
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        self.soft.prepare(device, queue, &frame).unwrap();
    }

    /// How many places of the light each texel does not see.
    fn counts(&mut self) -> Vec<u8> {
        self.prepare();
        let Self { gpu, soft, .. } = self;
        gpu.checked(|| gpu.run(|encoder| soft.encode(encoder)));
        gpu.read_texture(soft.texture(), 0, wgpu::TextureAspect::All)
    }

    /// The texel over a point of the plane.
    fn texel(&self, x: f32, z: f32) -> usize {
        let [column, row] = [z, x].map(|at| ((at + 3.0) / 6.0 * 64.0) as usize);
        row * 64 + column
    }
}

fn ball(x: f32, y: f32, z: f32) -> (shapes::Shape, Affine3A) {
    (shapes::sphere(8), at(x, y, z))
}

#[test]
fn every_place_is_counted_once_and_none_is_lost() {
    for samples in [1, 2, 64, 255] {
        // Two balls, each with a near and a far side, one behind the other.
        let bodies = [ball(0.1, 1.4, 0.1), ball(0.2, 2.0, 0.1)];
        let Some(mut plate) = Plate::new(samples, &bodies) else {
            return;
        };
        plate.shape = LightShape::Disk {
            radius: 0.05,
            normal: Vec3::Y,
        };
        let counts = plate.counts();
        assert_eq!(u32::from(*counts.iter().max().unwrap()), samples);
        assert_eq!(u32::from(counts[plate.texel(0.0, 0.0)]), samples);
        assert_eq!(counts[plate.texel(2.9, 2.9)], 0, "{samples}");
        // The twin: two textures of a ball each, added up.
        let both = plate.casters.clone();
        let sum: Vec<u32> = both.chunks(1).fold(vec![0; counts.len()], |sum, one| {
            plate.casters = one.to_vec();
            let counts = plate.counts();
            sum.iter()
                .zip(counts)
                .map(|(sum, count)| sum + u32::from(count))
                .collect()
        });
        assert!(sum.iter().any(|&sum| sum > samples), "{samples}");
    }
}

#[test]
fn what_does_not_move_is_not_drawn_again() {
    let Some(mut plate) = Plate::new(16, &[ball(0.0, 1.5, 0.0), ball(1.0, 1.2, 0.5)]) else {
        return;
    };
    let first = plate.counts();
    assert!(plate.soft.statistics().rendered);
    assert_eq!(plate.counts(), first);
    let kept = plate.soft.statistics();
    assert!(
        !kept.rendered && kept.uploaded == 0 && kept.draws == 0,
        "{kept:?}"
    );
    plate.casters[1].world_from_object.translation.x += 0.3;
    let moved = plate.counts();
    assert!(plate.soft.statistics().rendered && moved != first);
    assert!(
        plate.soft.statistics().uploaded < 200,
        "one row, and the rectangle"
    );
    plate.casters[1].world_from_object.translation.x -= 0.3;
    assert_eq!(plate.counts(), first);
    plate.casters[0].mesh.bump_revision();
    plate.counts();
    assert!(plate.soft.statistics().rendered, "deformed");
    plate.light = PointLight::new(Vec3::new(0.6, 5.0, 0.3), 40.0).into();
    assert_ne!(plate.counts(), first, "another light");
    // What is forgotten or lost is made good.
    plate.light = PointLight::new(Vec3::new(0.5, 5.0, 0.3), 40.0).into();
    plate.prepare();
    plate.prepare();
    assert!(plate.soft.statistics().not_encoded);
    let mut dropped = plate.gpu.device.create_command_encoder(&Default::default());
    plate.soft.encode(&mut dropped);
    drop(dropped);
    assert_eq!(plate.counts(), first);
    assert!(plate.soft.statistics().encoder_dropped);
}

#[test]
fn what_is_behind_the_plane_or_the_light_is_not_counted() {
    // Two balls below, one that reaches as high as the light, far from it, and a stick through the plane.
    let stick = Affine3A::from_translation(Vec3::new(-1.5, 0.0, -1.0))
        * Affine3A::from_rotation_z(0.6)
        * Affine3A::from_scale(Vec3::new(0.1, 2.0, 0.1));
    let bodies = [
        ball(0.0, -1.5, 0.0),
        (shapes::cube(), stick),
        ball(1.8, 5.0, -1.8),
    ];
    let Some(mut plate) = Plate::new(32, &bodies) else {
        return;
    };
    let counts = plate.counts();
    // Below the stick's upper end, and where the lower one would come to.
    let upper = plate.texel(-2.5, -1.2);
    assert!(counts[upper] > 8, "{}", counts[upper]);
    let lower = plate.texel(-0.6, -0.8);
    assert_eq!(counts[lower], 0);
    assert_eq!(counts[plate.texel(0.0, 0.0)], 0);
    let anti = uncut(|| {
        let mut twin = Plate::new(32, &bodies).unwrap();
        twin.counts()
    });
    assert!(anti[lower] > 8, "the twin: {}", anti[lower]);
}

#[test]
fn a_light_that_is_partly_behind_the_plane_is_partly_dark() {
    let Some(mut plate) = Plate::new(200, &[ball(0.0, 1.5, 0.0)]) else {
        return;
    };
    plate.light = PointLight::new(Vec3::new(40.0, 0.0, 0.0), 100.0).into();
    plate.shape = LightShape::Sphere { radius: 1.0 };
    let counts = plate.counts();
    let behind = plate.soft.statistics().samples_behind;
    assert!((90..=110).contains(&behind), "{behind}");
    assert_eq!(u32::from(counts[plate.texel(2.9, 2.9)]), behind);
    plate.light = PointLight::new(Vec3::new(40.0, -2.0, 0.0), 100.0).into();
    assert!(
        plate.counts().iter().all(|&count| count == 200),
        "wholly behind"
    );
}

#[test]
fn suns_and_rectangles_have_a_size_too() {
    let Some(mut plate) = Plate::new(64, &[ball(0.0, 2.0, 0.0)]) else {
        return;
    };
    let between = |counts: &[u8]| {
        counts
            .iter()
            .filter(|count| (1..64).contains(*count))
            .count()
    };
    plate.light = DirectionalLight::new(Vec3::new(0.0, 30.0, 0.0)).into();
    plate.shape = LightShape::Sphere { radius: 0.005 };
    let sharp = between(&plate.counts());
    plate.shape = LightShape::Sphere { radius: 0.2 };
    let soft = between(&plate.counts());
    // A penumbra of 2 * 0.2 * 2, and what jitter adds, along a circle of 2 pi.
    let texel = 6.0_f64 / 64.0;
    let expected = (0.8 + texel) * std::f64::consts::TAU / texel.powi(2);
    assert!(
        (soft as f64 / expected - 1.0).abs() < 0.15,
        "{soft} of {expected}"
    );
    assert!(sharp < soft / 4, "{sharp}");
    // Long along x alone: soft at the ends, sharp at the sides.
    plate.light = PointLight::new(Vec3::new(0.0, 4.0, 0.0), 40.0).into();
    plate.shape = LightShape::Rectangle {
        half_width: Vec3::X * 0.8,
        half_height: Vec3::Z * 1e-3,
    };
    let counts = plate.counts();
    let row = |along_x: bool| {
        let steps = (0..64).map(|step| (step as f32 - 31.5) * 6.0 / 64.0);
        let texels = steps.map(|at| match along_x {
            true => counts[plate.texel(at, 0.0)],
            false => counts[plate.texel(0.0, at)],
        });
        texels.filter(|count| (1..64).contains(count)).count()
    };
    assert!(
        row(true) > 20 && row(false) < row(true) / 3,
        "{} {}",
        row(true),
        row(false)
    );
}

#[test]
fn scale_does_not_matter() {
    let bodies = [
        ball(0.0, 1.5, 0.0),
        (shapes::cube().tilted(), at(1.5, 1.7, 1.0)),
    ];
    let Some(mut plate) = Plate::new(32, &bodies) else {
        return;
    };
    let first = plate.counts();
    let casters = plate.casters.clone();
    for scale in [1e-4, 1e5_f32] {
        let larger = Affine3A::from_scale(Vec3::splat(scale));
        plate.casters.clone_from(&casters);
        for caster in &mut plate.casters {
            caster.world_from_object = larger * caster.world_from_object;
        }
        plate.light = PointLight::new(scale * Vec3::new(0.5, 5.0, 0.3), 40.0 * scale).into();
        plate.shape = LightShape::Sphere {
            radius: 0.5 * scale,
        };
        plate.receiver = square(3.0 * scale);
        let counts = plate.counts();
        let differ = first
            .iter()
            .zip(&counts)
            .filter(|(a, b)| a.abs_diff(**b) > 1)
            .count();
        assert_eq!(differ, 0, "{scale}");
    }
}

#[test]
fn what_is_not_sound_is_refused_and_changes_nothing() {
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let usual = PlanarSoftShadowDescriptor::default();
    for size in [[0, 8], [8, 100_000]] {
        let wrong = PlanarSoftShadowDescriptor { size, ..usual };
        let limit = device.limits().max_texture_dimension_2d;
        let found = PlanarSoftShadow::new(&device, &wrong).unwrap_err();
        assert_eq!(found, Error::Size { size, limit });
    }
    for samples in [0, 256] {
        let wrong = PlanarSoftShadowDescriptor { samples, ..usual };
        let found = PlanarSoftShadow::new(&device, &wrong).unwrap_err();
        assert_eq!(
            found,
            Error::Samples {
                samples,
                limit: 255
            }
        );
        assert!(found.to_string().contains("pass 1 to 255"), "{found}");
    }
    let mut soft = PlanarSoftShadow::new(&device, &usual).unwrap();
    let sound = PlanarSoftFrame {
        light: PointLight::new(Vec3::Y * 5.0, 30.0).into(),
        shape: LightShape::Sphere { radius: 1.0 },
        receiver: square(2.0),
        casters: &[],
    };
    soft.prepare(&device, &queue, &sound).unwrap();
    let before = soft.statistics();
    let mut refuse = |frame: &PlanarSoftFrame<'_>, error: &Error| {
        let found = soft.prepare(&device, &queue, frame).unwrap_err();
        assert_eq!(found, *error);
        assert_eq!(soft.statistics(), before);
    };
    let frame = PlanarSoftFrame {
        light: PointLight::new(Vec3::Y, -1.0).into(),
        ..sound
    };
    refuse(
        &frame,
        &Error::Light(shadows::error::LightError::Range(-1.0)),
    );
    for shape in [
        LightShape::Sphere { radius: 0.0 },
        LightShape::Disk {
            radius: 1.0,
            normal: Vec3::ZERO,
        },
        LightShape::Rectangle {
            half_width: Vec3::X,
            half_height: Vec3::ZERO,
        },
    ] {
        refuse(&PlanarSoftFrame { shape, ..sound }, &Error::Shape(shape));
    }
    let bounds = shadows::mesh::Bounds {
        min: Vec3::ZERO,
        max: Vec3::ONE,
    };
    let drawn_by_host = CasterMesh::host_drawn(&device, bounds, 1).unwrap();
    let casters = &[Caster::new(drawn_by_host, Affine3A::IDENTITY)];
    refuse(
        &PlanarSoftFrame { casters, ..sound },
        &Error::HostDrawn { index: 0 },
    );
    let receiver = PlanarRectangle {
        height: 2.0 * square(2.0).width,
        ..square(2.0)
    };
    refuse(
        &PlanarSoftFrame { receiver, ..sound },
        &Error::Rectangle(receiver),
    );
}
