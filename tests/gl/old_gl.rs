//! OpenGL 3.3, which as WebGL 2 and OpenGL ES 3.0 has no compute shaders, no storage buffers and no
//! gathers: a whole picture of every kernel on every kind of map.

use std::process::Command;

use shadows::error::PcfError;
use shadows::glam::{Affine3A, Vec3};
use shadows::{
    AnyMap, Caster, CubeShadowMapDescriptor, DirectionalLight, FlatLight, Gather, Kernel,
    PcfDescriptor, PcfSampler, PointLight, ShadowFrame, ShadowMap, ShadowMapDescriptor, SpotLight,
    wgpu,
};

use crate::common::noop;
use crate::common::shapes::{Random, cuboid};
use crate::{gl, ground};
use host::gpu::Gpu;

/// Set in the process that the test starts for itself: Mesa is told by its environment what to be.
const CHILD: &str = "SHADOWS_TEST_OLD_GL";

const MESA: [(&str, &str); 3] = [
    ("MESA_GL_VERSION_OVERRIDE", "3.3"),
    ("MESA_GLSL_VERSION_OVERRIDE", "330"),
    (
        "MESA_EXTENSION_OVERRIDE",
        "-GL_ARB_compute_shader -GL_ARB_draw_indirect -GL_ARB_shader_storage_buffer_object \
         -GL_ARB_gpu_shader5 -GL_ARB_texture_gather",
    ),
];

#[test]
fn every_kernel_works_without_gathers() {
    if std::env::var_os(CHILD).is_some() {
        return child();
    }
    let name = "old_gl::every_kernel_works_without_gathers";
    let output = anew()
        .args(["--exact", name, "--nocapture"])
        .envs(MESA)
        .env(CHILD, "1")
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    print!("{out}");
    eprint!("{err}");
    assert!(output.status.success());
    assert!(out.contains("1 passed"), "{out}");
}

/// This program again, by the loader that `scripts/drivers.sh` names where it is not the system's: then the running
/// program is that loader, and this one its argument.
fn anew() -> Command {
    let Ok(loader) = std::env::var("SHADOWS_TEST_LOADER") else {
        return Command::new(std::env::current_exe().unwrap());
    };
    let mut words = loader.split_whitespace();
    let mut command = Command::new(words.next().unwrap());
    command.args(words).args(std::env::args_os().take(1));
    command
}

fn child() {
    let Some(old) = gl() else { return };
    if old.support.compute {
        eprintln!(
            "skipped: {} does not act as OpenGL 3.3",
            old.info.driver_info
        );
        return;
    }
    assert!(!old.support.gather);
    let always = PcfDescriptor {
        gather: Gather::Always,
        ..Default::default()
    };
    assert_eq!(
        PcfSampler::new(&old.device, &old.queue, &always).unwrap_err(),
        PcfError::Gather
    );
    assert!(refuses_gathers(&old));
    let Ok(other) = Gpu::new(Some("(vulkan,")) else {
        eprintln!("skipped: no Vulkan adapter to compare with");
        return;
    };
    let (old_pictures, pictures) = (all(&old, 0.0), all(&other, 0.0));
    // The broken twin: the ground a texel beside.
    let beside = all(&old, 6.0 / 256.0);
    for (((name, old), (_, right)), (_, beside)) in old_pictures.iter().zip(&pictures).zip(&beside)
    {
        let (same, twin) = (difference(old, right), difference(beside, right));
        println!("{name}: {same:.5}; a texel beside: {twin:.4}");
        assert!(
            right.iter().filter(|&&lit| lit < 128).count() > 200,
            "{name}"
        );
        assert!(same < 0.005, "{name}: {same}");
        assert!(twin > 0.02, "{name}: {twin}");
    }
}

/// Root mean square, where white is 1.
fn difference(a: &[u8], b: &[u8]) -> f64 {
    let squares = a
        .iter()
        .zip(b)
        .map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2));
    (squares.sum::<f64>() / a.len() as f64).sqrt() / 255.0
}

/// The ground below a light as every kernel sees it, on every kind of map.
fn all(gpu: &Gpu, shift: f32) -> Vec<(String, Vec<u8>)> {
    let at = Vec3::new(0.0, 3.0, 0.0);
    let mut random = Random::new(21);
    let mesh = cuboid(Vec3::new(0.25, 0.15, 0.2)).mesh(&gpu.device);
    let casters: Vec<_> = (0..10)
        .map(|_| {
            let place = random.vec3() * Vec3::new(1.2, 0.5, 1.2) + Vec3::Y * 0.8;
            let turn = Affine3A::from_axis_angle(random.vec3().normalize(), 3.0);
            Caster::new(mesh.clone(), Affine3A::from_translation(place) * turn)
        })
        .collect();
    let near = Some(0.05);
    let descriptor = CubeShadowMapDescriptor {
        size: 256,
        ..Default::default()
    };
    let point = PointLight {
        near,
        ..PointLight::new(at, 30.0)
    };
    let cube = crate::cubes::fresh(gpu, &descriptor, point, &casters);
    let spot = FlatLight::Spot(SpotLight {
        near,
        ..SpotLight::new(at, Vec3::NEG_Y, std::f32::consts::FRAC_PI_4, 30.0)
    });
    let sun = FlatLight::Directional(DirectionalLight::new(Vec3::new(0.3, 1.0, 0.2)));
    let [spot, sun] = [spot, sun].map(|light| flat(gpu, light, &casters));
    let mut all = Vec::new();
    for kernel in Kernel::ALL {
        let maps: [(&str, AnyMap<'_>); 3] = [
            ("cube", (&cube).into()),
            ("spot", (&spot).into()),
            ("sun", (&sun).into()),
        ];
        for (name, map) in maps {
            all.push((
                format!("{name} {kernel:?}"),
                picture(gpu, map, kernel, shift),
            ));
        }
    }
    all
}

fn flat(gpu: &Gpu, light: FlatLight, casters: &[Caster]) -> ShadowMap {
    let descriptor = ShadowMapDescriptor {
        size: 256,
        ..Default::default()
    };
    let mut map = ShadowMap::new(&gpu.device, &descriptor).unwrap();
    gpu.checked(|| {
        map.prepare(&gpu.device, &gpu.queue, &ShadowFrame::new(light, casters))
            .unwrap();
        gpu.run(|encoder| map.encode(encoder));
    });
    map
}

/// The broken twin: what the device says of a module with gathers.
fn refuses_gathers(old: &Gpu) -> bool {
    let (device, queue) = noop();
    let descriptor = PcfDescriptor::default();
    let module = PcfSampler::new(&device, &queue, &descriptor)
        .unwrap()
        .wgsl_module(0);
    assert!(module.contains("textureGather"));
    let here = PcfSampler::new(&old.device, &old.queue, &descriptor).unwrap();
    let show = "return vec4f(shadows_visibility_flat(vec3f(unit, 0.0), vec3f(1.0)));";
    let scopes = [wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::Internal]
        .map(|filter| old.device.push_error_scope(filter));
    ground::pipeline(old, &module, show, &[here.bind_group_layout()]);
    let errors = scopes
        .into_iter()
        .rev()
        .map(|scope| pollster::block_on(scope.pop()));
    errors.flatten().count() == 1
}

/// The ground from 2.2 before to 2.2 behind the origin, a byte a point.
fn picture(gpu: &Gpu, map: AnyMap<'_>, kernel: Kernel, shift: f32) -> Vec<u8> {
    let descriptor = PcfDescriptor {
        kernel,
        map: map.kind(),
        ..Default::default()
    };
    let sampler = PcfSampler::new(&gpu.device, &gpu.queue, &descriptor).unwrap();
    let prefix = match map {
        AnyMap::Flat(_) => "shadows_flat",
        _ => "shadows",
    };
    let pixel = if sampler.takes_pixel() { ", at.xy" } else { "" };
    let show = format!(
        "let place = vec3f(unit.x, 0.0, unit.y) * 4.4 + vec3f({shift:?}, 0.0, 0.0);
        return vec4f({prefix}_visibility_flat(place, vec3f(0.0, 1.0, 0.0){pixel}));"
    );
    let group = gpu.checked(|| sampler.bind_group(&gpu.device, map).unwrap());
    let (module, layouts) = (sampler.wgsl_module(0), [sampler.bind_group_layout()]);
    let pixels = ground::picture(gpu, (&module, &show), &layouts, &[group]);
    pixels.into_iter().step_by(4).collect()
}
