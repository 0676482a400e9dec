//! What volumes fill, in screens of 1280 x 720: each pixel as often as faces cover it, whether the depth test
//! then counts them or not. Counted by [`ShadowVolumeRenderer::survey`], so that machine and driver make no
//! difference; beside it the time of the stencil pass, all lights in one.
//!
//! A line for each scene: with volumes without end, with ends at the lights' range alone, with the scene's
//! bounds as receivers besides, and with z-fail forced. The scenes: those built in, of the town by night the
//! 16 street lamps that come first, the same as spots that shine down, and the 16 windows that come first,
//! which are spots; and ten thousand needles of grass.

use host::gpu::Gpu;
use host::random::Random;
use host::renderer::{self, Renderer};
use host::scene::{self, Cone, Light, LightKind, Mesh, Object, Scene, Time, homogeneous};
use host::scene_gpu::SceneGpu;
use host::timer::Timer;
use shadows::glam::{Affine3A, Quat, Vec3, Vec4};
use shadows::mesh::Bounds;
use shadows::{
    Extrusion, Method, ShadowVolumeDescriptor, ShadowVolumeFrame, ShadowVolumeRenderer, VolumeCone,
    VolumeLight, VolumeView,
};

use super::SIZE;
use super::shared::median;

const ROUNDS: usize = 5;

/// Lights of the town.
const LIGHTS: usize = 16;

pub fn run(gpu: &Gpu) -> anyhow::Result<()> {
    let town = scene::city(Time::Night);
    let lamps = lit(&town, LightKind::Point, "city, 16 lamps");
    let mut spots = lamps.clone();
    spots.name = "city, 16 lamps as spots".into();
    for light in &mut spots.lights {
        light.cone = Some(Cone {
            direction: Vec3::NEG_Y,
            half_angle: 1.05,
        });
    }
    let windows = lit(&town, LightKind::Spot, "city, 16 windows");
    for scene in [
        scene::spheres(),
        scene::courtyard(),
        needles(),
        lamps,
        spots,
        windows,
    ] {
        measure(gpu, &scene)?;
    }
    Ok(())
}

/// The scene under the first of its lights that are of a kind.
fn lit(scene: &Scene, kind: LightKind, name: &str) -> Scene {
    let of_kind = scene.lights.iter().filter(|light| light.kind() == kind);
    Scene {
        name: name.into(),
        lights: of_kind.take(LIGHTS).copied().collect(),
        ..scene.clone()
    }
}

fn measure(gpu: &Gpu, scene: &Scene) -> anyhow::Result<()> {
    let stage = Stage::new(gpu, scene)?;
    let bounds = scene.bounds();
    let receivers = Bounds {
        min: bounds.min.as_vec3(),
        max: bounds.max.as_vec3(),
    };
    let lights: Vec<VolumeLight> = scene.lights.iter().map(told).collect();
    let around: Vec<VolumeLight> = lights
        .iter()
        .map(|light| VolumeLight {
            cone: None,
            ..*light
        })
        .collect();
    let frame = ShadowVolumeFrame {
        lights: &lights,
        views: &[VolumeView {
            view: renderer::view(scene, SIZE)?,
            target_size: Some(SIZE),
        }],
        receivers: Some(receivers),
        casters: &stage.scene.casters,
    };
    let unbounded = ShadowVolumeFrame {
        receivers: None,
        ..frame
    };
    let without_cones = ShadowVolumeFrame {
        lights: &around,
        ..frame
    };
    let infinite = ShadowVolumeDescriptor {
        extrusion: Extrusion::Infinite,
        ..Default::default()
    };
    let zfail = ShadowVolumeDescriptor {
        method: Method::ZFail,
        ..Default::default()
    };
    let auto = ShadowVolumeDescriptor::default();
    println!("{}", scene.name);
    for (name, descriptor, frame) in [
        ("without end", &infinite, &unbounded),
        ("to the range", &auto, &unbounded),
        ("to the receivers", &auto, &frame),
        ("the same, z-fail alone", &zfail, &frame),
        ("the same, spots as lamps", &auto, &without_cones),
    ] {
        let Filled {
            sides,
            caps,
            volumes,
            time,
        } = stage.fill(descriptor, frame)?;
        println!(
            "  {name}: {:.2} screens ({caps:.2} of them caps), {volumes} volumes, {time:.1} ms",
            sides + caps
        );
    }
    Ok(())
}

fn told(light: &Light) -> VolumeLight {
    let place = homogeneous(light.place);
    let own = VolumeLight::new(place, (!place.is_directional()).then_some(light.range));
    match light.cone {
        Some(cone) => own.with_cone(VolumeCone {
            direction: cone.direction,
            half_angle: cone.half_angle,
        }),
        None => own,
    }
}

/// What a scene is drawn with.
struct Stage<'a> {
    gpu: &'a Gpu,
    timer: Timer,
    host: Renderer,
    scene: SceneGpu,
}

/// What volumes come to.
struct Filled {
    /// In screens.
    sides: f64,
    caps: f64,
    volumes: u32,
    /// Of the stencil pass, in milliseconds.
    time: f64,
}

impl<'a> Stage<'a> {
    fn new(gpu: &'a Gpu, scene: &Scene) -> anyhow::Result<Self> {
        let scene_gpu = SceneGpu::new(gpu, scene)?;
        let host = Renderer::new(gpu, SIZE, scene, &scene_gpu)?;
        gpu.run(|encoder| host.draw_ambient(encoder, &scene_gpu));
        Ok(Self {
            gpu,
            timer: Timer::new(gpu),
            host,
            scene: scene_gpu,
        })
    }

    fn fill(
        &self,
        descriptor: &ShadowVolumeDescriptor<'_>,
        frame: &ShadowVolumeFrame<'_>,
    ) -> anyhow::Result<Filled> {
        let gpu = self.gpu;
        let descriptor = ShadowVolumeDescriptor {
            depth_stencil_format: self.host.depth_stencil_format(),
            depth: renderer::DEPTH,
            ..*descriptor
        };
        let mut volumes = ShadowVolumeRenderer::new(&gpu.device, &descriptor)?;
        volumes.prepare(&gpu.device, &gpu.queue, frame)?;
        gpu.run(|encoder| volumes.encode(encoder));
        let [mut sides, mut caps] = [0.0; 2];
        let pixels = f64::from(SIZE[0] * SIZE[1]);
        for light in 0..frame.lights.len() {
            let survey = volumes.survey(light, 0, SIZE)?;
            sides += survey.side_fill / pixels;
            caps += (survey.light_cap_fill + survey.dark_cap_fill) / pixels;
        }
        let times = (0..ROUNDS).map(|_| self.time(&volumes, frame.lights.len()));
        Ok(Filled {
            sides,
            caps,
            volumes: volumes.statistics().casters_drawn,
            time: median(times),
        })
    }

    /// All lights in one pass.
    fn time(&self, volumes: &ShadowVolumeRenderer, lights: usize) -> f64 {
        self.timer.time(self.gpu, |encoder| {
            let mut pass = self.host.begin_stencil_pass(encoder);
            for light in 0..lights {
                volumes.reset(&mut pass);
                volumes.render(&mut pass, light, 0).expect("it is encoded");
            }
        })
    }
}

/// A hundred tufts of a hundred needles each, closed and thinner than a pixel where they are far.
fn needles() -> Scene {
    let mut scene = Scene::empty("needles of grass");
    let mut random = Random(11);
    let ground = scene.add_mesh(scene::square("ground", Vec3::ZERO, 12.0));
    let tufts = [0; 4].map(|_| scene.add_mesh(tuft(&mut random)));
    let object = |mesh, transform, casts| Object {
        name: "grass".into(),
        mesh,
        transform,
        casts,
        albedo: [0.5; 3],
        glow: [0.0; 3],
    };
    scene
        .objects
        .push(object(ground, Affine3A::IDENTITY, false));
    for place in 0..100_u8 {
        let [x, z] = [place % 10, place / 10].map(|i| f32::from(i) - 4.5);
        let middle = Vec3::new(x, 0.0, z) + level(random.point(0.2));
        let turn = Quat::from_rotation_y(random.within(0.0, 6.0));
        let transform = Affine3A::from_rotation_translation(turn, middle);
        let mesh = tufts[random.below(tufts.len())];
        scene.objects.push(object(mesh, transform, true));
    }
    scene.lights = vec![Light::new(Vec4::new(3.0, 4.0, -3.0, 1.0), 30.0)];
    scene.camera.eye = Vec3::new(0.0, 1.2, 7.0);
    scene.camera.target = Vec3::new(0.0, 0.2, 0.0);
    scene
}

/// Tetrahedra, 16 mm thick at the root.
fn tuft(random: &mut Random) -> Mesh {
    let mut mesh = Mesh {
        name: "tuft".into(),
        positions: Vec::new(),
        normals: Vec::new(),
        indices: Vec::new(),
        mask: Vec::new(),
    };
    for needle in 0..100 {
        let root = level(random.point(0.5));
        let tip = root + Vec3::Y * random.within(0.2, 0.5) + level(random.point(0.15));
        let corner = |third: f32| {
            let around = Quat::from_rotation_y(third * std::f32::consts::TAU / 3.0);
            (root + around * Vec3::X * 0.008).to_array()
        };
        mesh.positions.extend([0.0, 1.0, 2.0].map(corner));
        mesh.positions.push(tip.to_array());
        mesh.normals.extend([[0.0, 1.0, 0.0]; 4]);
        let corners = [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3];
        mesh.indices
            .extend(corners.map(|corner| 4 * needle + corner));
    }
    mesh
}

fn level(point: Vec3) -> Vec3 {
    Vec3::new(point.x, 0.0, point.z)
}
