//! Far from the origin with positions in f32 and nothing `placed`: what rounding leaves of the
//! receivers' positions, and of normals from their derivatives.

use glam::{Affine3A, DVec3, Vec3};
use shadows::mesh::Adjacency;
use shadows::{
    AnyMap, Caster, CasterMesh, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor,
    DirectionalLight, FlatLight, Kernel, MapKind, PcfDescriptor, PcfSampler, PointLight,
    ShadowFrame, ShadowMap, ShadowMapDescriptor, SpotLight, glam,
};

use crate::common::shapes::Random;
use crate::receivers::ask_changed;
use compare::hard::{cases, techniques};
use compare::shadow::Shadow;
use compare::stage::Stage;
use host::gpu::Gpu;
use host::renderer::ShadowAccess;
use host::scene::{Mesh, Object, Scene};

/// As far as positions in f32 let a shadow's edge, or light under a caster, be from where it should
/// be: this part of the distance from the origin.
const LEAK: f64 = 1e-6;

/// No bias but that in texels.
fn without_ulps(module: String) -> String {
    let count = module.matches("light.rounding *").count();
    assert_eq!(count, 2, "in the receiver and where the map is asked");
    module.replace("light.rounding *", "0.0 *")
}

/// Axis-aligned boxes and slanted squares in world space, rounded to f32 as a model file has them.
struct Model {
    positions: Vec<[f32; 3]>,
    indices: Vec<u32>,
}

impl Model {
    fn new() -> Self {
        Self {
            positions: Vec::new(),
            indices: Vec::new(),
        }
    }

    fn quad(&mut self, corner: DVec3, a: DVec3, b: DVec3) {
        let first = self.positions.len() as u32;
        let corners = [corner, corner + a, corner + a + b, corner + b];
        self.positions
            .extend(corners.map(|corner| corner.as_vec3().to_array()));
        self.indices
            .extend([0, 1, 2, 0, 2, 3].map(|i: u32| first + i));
    }

    fn cuboid(&mut self, min: DVec3, size: DVec3) {
        let [x, y, z] = [DVec3::X * size.x, DVec3::Y * size.y, DVec3::Z * size.z];
        for (corner, a, b) in [
            (min, y, x),
            (min, z, y),
            (min, x, z),
            (min + z, x, y),
            (min + x, y, z),
            (min + y, z, x),
        ] {
            self.quad(corner, a, b);
        }
    }

    /// A thick box, a thin wall, a floor under both and a square that leans, as large as `scale`.
    fn house(place: DVec3, scale: f64) -> Self {
        let mut model = Self::new();
        let at = |x, y, z| place + scale * DVec3::new(x, y, z);
        model.cuboid(at(0.0, 0.0, 0.0), scale * DVec3::ONE);
        model.cuboid(at(1.6, 0.0, -1.0), scale * DVec3::new(0.05, 1.2, 2.0));
        model.quad(
            at(-3.0, 0.0, -3.0),
            DVec3::X * 6.0 * scale,
            DVec3::NEG_Z * -6.0 * scale,
        );
        model.quad(
            at(-2.5, 0.2, 0.0),
            scale * DVec3::new(0.9, 0.7, 0.3),
            scale * DVec3::new(-0.2, 0.4, 1.1),
        );
        model
    }

    fn mesh(&self) -> Mesh {
        Mesh {
            name: "model".into(),
            positions: self.positions.clone(),
            normals: vec![[0.0, 1.0, 0.0]; self.positions.len()],
            indices: self.indices.clone(),
            mask: Vec::new(),
        }
    }

    fn caster(&self, gpu: &Gpu) -> Caster {
        let adjacency = Adjacency::new(&self.positions, &self.indices).unwrap();
        let mesh = CasterMesh::new(&gpu.device, &self.positions, &adjacency).unwrap();
        Caster::new(mesh, Affine3A::IDENTITY)
    }

    fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        let corner = |i: &u32| Vec3::from(self.positions[*i as usize]).as_dvec3();
        let triangles = self.indices.as_chunks::<3>().0.iter();
        triangles.map(move |t| [corner(&t[0]), corner(&t[1]), corner(&t[2])])
    }

    /// Points of its surfaces, rounded to f32, and the surfaces' normals: those that face the light and see
    /// it, and those behind something by more than `gap`, all around which it is so within `beside`.
    fn receivers(&self, light: Light, beside: f64, gap: f64) -> [Vec<(Vec3, Vec3)>; 2] {
        let triangles: Vec<_> = self.triangles().collect();
        let mut truth = crate::common::rays::Triangles::default();
        truth.add(&self.positions, &self.indices, Affine3A::IDENTITY);
        let mut random = Random::new(3);
        let mut unit = || 0.5 + 0.5 * f64::from(random.next());
        let mut found = [Vec::new(), Vec::new()];
        for _ in 0..3000 {
            let [a, b, c] =
                triangles[((triangles.len() as f64 * unit()) as usize).min(triangles.len() - 1)];
            let (s, t) = (unit(), unit());
            let (s, t) = if s + t > 1.0 {
                (1.0 - s, 1.0 - t)
            } else {
                (s, t)
            };
            let point = a + (b - a) * s + (c - a) * t;
            let normal = (b - a).cross(c - a).normalize();
            let toward = light.toward(point);
            let cosine = normal.dot(toward.normalize());
            // At a grazing angle the leak is longer; what faces away is in shadow by itself.
            if cosine.abs() < 0.15 {
                continue;
            }
            let turned = normal * cosine.signum();
            let across = turned.any_orthonormal_pair();
            // How far toward the light something is, all around.
            let blocked = |at: DVec3| {
                let toward = light.toward(at);
                let start = 1e-9 * beside.max(1e-6);
                let from = at + turned * (1e-3 * gap).max(start);
                let nearest = truth.nearest(from, toward);
                nearest.filter(|&t| t < 1.0).map(|t| t * toward.length())
            };
            let around = (0..17).map(|i| {
                let angle = std::f64::consts::FRAC_PI_4 * f64::from(i);
                let radius = beside / cosine.abs() * f64::from((i + 7) / 8) * 0.5;
                point + (across.0 * angle.cos() + across.1 * angle.sin()) * radius
            });
            let seen: Vec<_> = around.map(blocked).collect();
            let receiver = (point.as_vec3(), normal.as_vec3());
            if seen.iter().all(Option::is_none) {
                found[0].push(receiver);
            } else if seen
                .iter()
                .all(|seen| seen.is_some_and(|far| far > gap / cosine.abs()))
            {
                found[1].push(receiver);
            }
        }
        found
    }
}

#[derive(Clone, Copy, Debug)]
enum Light {
    Point(PointLight),
    Flat(FlatLight),
}

impl Light {
    fn toward(self, point: DVec3) -> DVec3 {
        match self {
            Self::Point(light) => light.position.as_dvec3() - point,
            Self::Flat(FlatLight::Spot(light)) => light.position.as_dvec3() - point,
            Self::Flat(FlatLight::Directional(light)) => light.toward_light.as_dvec3() * 1e4,
            Self::Flat(other) => unreachable!("{other:?} is none of these tests' lights"),
        }
    }

    /// Visibility of receivers with given normals.
    fn ask(
        self,
        gpu: &Gpu,
        (size, kernel): (u32, Kernel),
        caster: &Caster,
        receivers: &[(Vec3, Vec3)],
        change: fn(String) -> String,
    ) -> Vec<f32> {
        let casters = std::slice::from_ref(caster);
        let (cube, flat);
        let map = match self {
            Self::Point(light) => {
                cube = cube_map(gpu, size, light, casters);
                AnyMap::Cube(&cube)
            }
            Self::Flat(light) => {
                flat = flat_map(gpu, size, light, casters);
                AnyMap::Flat(&flat)
            }
        };
        let descriptor = PcfDescriptor {
            kernel,
            map: map.kind(),
            ..Default::default()
        };
        ask_changed(gpu, map, &descriptor, 0, receivers, change)
    }
}

fn cube_map(gpu: &Gpu, size: u32, light: PointLight, casters: &[Caster]) -> CubeShadowMap {
    let descriptor = CubeShadowMapDescriptor {
        size,
        ..Default::default()
    };
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor).unwrap();
    let frame = CubeFrame::new(light, casters);
    map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    gpu.run(|encoder| map.encode(encoder));
    map
}

fn flat_map(gpu: &Gpu, size: u32, light: FlatLight, casters: &[Caster]) -> ShadowMap {
    let descriptor = ShadowMapDescriptor {
        size,
        ..Default::default()
    };
    let mut map = ShadowMap::new(&gpu.device, &descriptor).unwrap();
    map.prepare(&gpu.device, &gpu.queue, &ShadowFrame::new(light, casters))
        .unwrap();
    gpu.run(|encoder| map.encode(encoder));
    map
}

fn lights(place: DVec3, scale: f64) -> [Light; 3] {
    let position = (place + scale * DVec3::new(0.8, 3.1, 1.9)).as_vec3();
    let range = 40.0 * scale as f32;
    [
        Light::Point(PointLight::new(position, range)),
        Light::Flat(FlatLight::Spot(SpotLight {
            position,
            direction: Vec3::new(-0.2, -1.0, -0.4),
            half_angle: 0.8,
            near: None,
            range,
        })),
        Light::Flat(FlatLight::Directional(DirectionalLight::new(Vec3::new(
            0.4, 1.0, 0.3,
        )))),
    ]
}

#[test]
fn normals_of_the_host_have_no_acne_and_leak_no_farther_than_stated() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut without = 0;
    for (direction, distance, scale) in [
        (DVec3::new(0.6, -0.5, 0.62), 333.0, 1.0),
        (DVec3::new(1.0, 0.001, 0.002), 5e3, 1.0),
        (DVec3::new(-0.7, 0.4, 0.6), 77_777.0, 1.0),
        (DVec3::new(0.01, -0.02, -1.0), 3e5, 4.0),
        (DVec3::new(0.61, 0.48, 0.63), 1e6, 12.0),
    ] {
        let place = direction * distance;
        let model = Model::house(place, scale);
        let caster = model.caster(&gpu);
        let leak = LEAK * distance;
        for light in lights(place, scale) {
            for (size, kernel) in [(512, Kernel::Weighted5), (2048, Kernel::Bilinear)] {
                // Texels are at most so wide, and kernels reach as far to each side.
                let texels = 20.0 * scale / f64::from(size) * 3.5;
                let [lit, dark] = model.receivers(light, texels + leak, 0.3 * texels + leak);
                let at = format!("{distance} {size} {light:?}");
                assert!(
                    lit.len() > 50 && (dark.len() > 5 || leak > 0.05 * scale),
                    "{at}: {} {}",
                    lit.len(),
                    dark.len()
                );
                let ask = |receivers: &[_], change| {
                    light.ask(&gpu, (size, kernel), &caster, receivers, change)
                };
                let acne = |seen: Vec<f32>| seen.iter().filter(|&&seen| seen < 1.0).count();
                assert_eq!(acne(ask(&lit, |module| module)), 0, "{at}: acne");
                let leaks = ask(&dark, |module| module);
                let leaks = leaks.iter().filter(|&&seen| seen > 0.0).count();
                assert_eq!(leaks, 0, "{at}: leaks");
                without += acne(ask(&lit, without_ulps));
            }
        }
    }
    // The broken twin: the bias in texels alone.
    assert!(without > 100, "{without}");
}

/// A unit cube on a ground square, as a model file at such a place has it, lit from above.
fn box_at(place: Vec3) -> Scene {
    let mut model = Model::new();
    model.cuboid(place.as_dvec3(), DVec3::ONE);
    let mut ground = Model::new();
    ground.quad(
        place.as_dvec3() + DVec3::new(-4.0, 0.0, -4.0),
        DVec3::Z * 8.0,
        DVec3::X * 8.0,
    );
    let mut scene = Scene::empty("box");
    for (mesh, casts) in [(model.mesh(), true), (ground.mesh(), false)] {
        scene.objects.push(Object {
            name: mesh.name.clone(),
            mesh: scene.meshes.len(),
            transform: Affine3A::IDENTITY,
            casts,
            albedo: [0.7; 3],
            glow: [0.0; 3],
        });
        scene.meshes.push(mesh);
    }
    scene.light_mut().place = (place + Vec3::new(1.3, 2.35, 1.43)).extend(1.0);
    scene.light_mut().range = 10.0;
    scene.camera.eye = place + Vec3::new(-0.5, 1.9, 3.3);
    scene.camera.target = place + Vec3::new(0.5, 0.4, 0.5);
    scene.camera.near = 0.02;
    scene
}

/// Falsely lit and falsely shadowed pixels in the interior, and all that are lit truly, of a cube map
/// that is read by positions alone.
fn errors_by_derivatives(
    gpu: &Gpu,
    scene: Scene,
    kernel: Kernel,
    change: fn(String) -> String,
) -> [usize; 2] {
    let stage = Stage::new(gpu, scene, [320, 180]).unwrap();
    let reference = stage.reference(|_| ()).unwrap();
    let place = stage.scene.light().place.truncate();
    let light = PointLight::new(place, 10.0);
    let map = cube_map(gpu, 1024, light, &stage.scene_gpu.casters);
    let descriptor = PcfDescriptor {
        kernel,
        map: MapKind::CUBE,
        ..Default::default()
    };
    let sampler = PcfSampler::new(&gpu.device, &gpu.queue, &descriptor).unwrap();
    let group = sampler.bind_group(&gpu.device, &map).unwrap();
    let module = change(host::pipelines::visibility_module(&sampler));
    let lit = stage.renderer.lit_pipeline(
        gpu,
        &ShadowAccess {
            module: Some(&module),
            layout: Some(sampler.bind_group_layout()),
            ..Default::default()
        },
    );
    gpu.run(|encoder| {
        stage.renderer.draw_ambient(encoder, &stage.scene_gpu);
        stage
            .renderer
            .draw_lit(encoder, &stage.scene_gpu, &lit, Some(&group));
    });
    let visibility = stage.renderer.read_visibility(gpu);
    let interior = host::interior::of_cube(&map, descriptor.kernel);
    let found = reference.compare(&visibility, interior).unwrap();
    [found.false_lit_interior, found.false_shadow_interior]
}

#[test]
fn normals_from_derivatives_have_no_acne_where_pixels_are_as_wide_as_rounding() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut without = 0;
    for place in [
        Vec3::ZERO,
        Vec3::new(1000.0, 0.0, 650.0),
        Vec3::new(14_678.0, 0.0, 9_540.7),
        Vec3::new(-9_540.7, -3_000.0, 14_678.0),
        Vec3::new(45_889.0, 0.0, -54_444.0),
    ] {
        let scene = box_at(place);
        let errors = |kernel, change| errors_by_derivatives(&gpu, scene.clone(), kernel, change);
        assert_eq!(
            errors(Kernel::Weighted7, |module| module),
            [0, 0],
            "{place}"
        );
        // The hardware's one depth makes up for what it does not know with light, of which this is the most.
        let [lit, shadow] = errors(Kernel::HardwareBilinear, |module| module);
        println!("{place}: {lit} lit by HardwareBilinear, {shadow} dark");
        assert_eq!(shadow, 0, "{place}");
        // The broken twin: the bias in texels alone.
        without += errors(Kernel::Weighted7, without_ulps)[1];
    }
    assert!(without > 100, "{without}");
}

#[test]
fn where_derivatives_say_nothing_the_map_does() {
    let Some(gpu) = Gpu::for_test() else { return };
    // Twice as far from number to number as from pixel to pixel.
    let scene = box_at(Vec3::new(300_000.0, 0.0, 195_000.0));
    let asked = errors_by_derivatives(&gpu, scene.clone(), Kernel::Weighted7, |module| module);
    // The broken twin: normals from the derivatives in any case.
    let never = errors_by_derivatives(&gpu, scene, Kernel::Weighted7, |module| {
        let doubtful = "doubt > facing_squared";
        assert!(module.contains(doubtful));
        module.replace(doubtful, "false")
    });
    let [asked, never] = [asked, never].map(|[lit, shadow]| lit + shadow);
    assert!(asked < 150 && never > 8 * asked, "{asked}, {never}");
}

/// Of a directional light's map, the kernel's own and with another word of its shader.
fn visibility_with(sampler: &PcfSampler, from: &str, to: &str) -> String {
    let module = host::pipelines::visibility_module(sampler);
    assert!(module.contains(from), "{from}");
    module.replace(from, to)
}

/// A face that the map shows on less than a texel, and a place that rounding moves over an edge.
#[test]
fn planes_from_the_map_hold_on_grazed_faces_and_beside_edges() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut all = techniques().unwrap().into_iter();
    let technique = all.find(|technique| technique.name == "flat-2x2").unwrap();
    let case = cases::all().find(|case| case.name == "Far from the origin, plain f32");
    let situations = case.unwrap().situations;
    let dark = |round: u64, what: &str, module: fn(&PcfSampler) -> String| {
        let mut all = situations(&mut host::random::Random(round)).into_iter();
        let situation = all.find(|situation| situation.what == what).unwrap();
        let stage = Stage::new(&gpu, situation.scene.clone(), compare::hard::SIZE).unwrap();
        let reference = stage.reference(|_| ()).unwrap();
        let mut shadow = Shadow::read_by(&gpu, &stage.renderer, technique.clone(), module).unwrap();
        let picture = stage.picture(&gpu, &mut shadow, &stage.inputs).unwrap();
        let frame = situation.frame(&technique, &mut shadow, &picture.visibility);
        let found = reference.compare(&picture.visibility, frame.interior);
        found.unwrap().false_shadow_interior
    };
    let whole = host::pipelines::visibility_module;
    assert_eq!(dark(0, "1e3, sun", whole), 0);
    assert_eq!(dark(1, "1e6, sun", whole), 0);
    // The broken twins: no more than four texels from texel to texel; and texels side by side.
    let steep = |sampler: &PcfSampler| visibility_with(sampler, "clamp(certain, 4.0, 64.0)", "4.0");
    let near = |sampler: &PcfSampler| visibility_with(sampler, "floor(0.25 * moved)", "0.0");
    assert!(dark(0, "1e3, sun", steep) > 10);
    assert!(dark(1, "1e6, sun", near) > 50);
}
