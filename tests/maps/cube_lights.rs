//! Many lights in one map: whose faces are drawn, what receivers see, and what memory it takes.

use crate::common::shapes::{Random, cuboid};
use crate::cubes::{draw, draw_frame, faces, fresh};
use crate::receivers::{ask, ask_group};
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::error::PcfError;
use shadows::{
    Allocation, Caster, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DepthEncoding, Kernel,
    PcfDescriptor, PcfSampler, PointLight, glam,
};

const LIGHTS: u32 = 4;

fn descriptor(cube_array: bool) -> CubeShadowMapDescriptor<'static> {
    CubeShadowMapDescriptor {
        size: 32,
        lights: LIGHTS,
        cube_array,
        ..Default::default()
    }
}

fn one_light() -> CubeShadowMapDescriptor<'static> {
    CubeShadowMapDescriptor {
        lights: 1,
        cube_array: false,
        ..descriptor(false)
    }
}

fn lights() -> Vec<PointLight> {
    [(0.0, 0.3, 8.0), (6.0, -1.0, 9.0), (-3.0, 2.0, 7.0)]
        .map(|(x, y, range)| PointLight::new(Vec3::new(x, y, 0.2), range))
        .to_vec()
}

fn casters(gpu: &Gpu) -> Vec<Caster> {
    let mesh = cuboid(Vec3::splat(0.6)).mesh(&gpu.device);
    let mut random = Random::new(5);
    let place = |_| Affine3A::from_translation(random.vec3() * 5.0);
    (0..20)
        .map(place)
        .map(|at| Caster::new(mesh.clone(), at))
        .collect()
}

/// Whether lights share a texture.
const ARRAYS: [bool; 2] = [false, true];

#[test]
fn each_light_has_the_faces_it_would_have_alone() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (casters, lights) = (casters(&gpu), lights());
    for array in ARRAYS {
        let map = fresh(&gpu, &descriptor(array), &lights, &casters);
        assert_eq!(map.lights_in_one_binding(), array);
        let alone: Vec<_> = lights
            .iter()
            .map(|light| faces(&gpu, &fresh(&gpu, &one_light(), &[*light], &casters), 0))
            .collect();
        for (place, alone) in alone.iter().enumerate() {
            assert_eq!(&faces(&gpu, &map, place), alone, "light {place}");
        }
        assert_ne!(alone[0], alone[1], "the broken twin: another light");
    }
}

#[test]
fn a_light_that_comes_goes_or_moves_has_only_its_own_faces_drawn() {
    let Some(gpu) = Gpu::for_test() else { return };
    for array in ARRAYS {
        only_its_own_faces(&gpu, array);
    }
}

fn only_its_own_faces(gpu: &Gpu, array: bool) {
    let (casters, mut lights) = (casters(gpu), lights());
    let mut map = fresh(gpu, &descriptor(array), &lights, &casters);
    let mut step = |lights: &[PointLight]| {
        draw(gpu, &mut map, lights, &casters);
        for (place, &light) in lights.iter().enumerate() {
            let alone = fresh(gpu, &one_light(), &[light], &casters);
            assert_eq!(faces(gpu, &map, place), faces(gpu, &alone, 0), "{place}");
        }
        map.statistics().faces_rendered
    };
    assert_eq!(step(&lights), 0);
    lights.push(PointLight::new(Vec3::new(1.0, 1.0, 4.0), 9.0));
    assert!((1..=6).contains(&step(&lights)), "one came");
    lights.remove(0);
    assert_eq!(step(&lights), 0, "one went, the others moved up");
    lights.swap(0, 2);
    assert_eq!(step(&lights), 0, "two changed places");
    lights[1].position.x += 0.5;
    assert!((1..=6).contains(&step(&lights)), "one moved");
    lights.remove(1);
    assert_eq!(step(&lights), 0);
}

#[test]
fn receivers_ask_for_a_light_by_its_place() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (casters, mut lights) = (casters(&gpu), lights());
    // One more that reaches no caster: lit in its range.
    lights.push(PointLight::new(Vec3::splat(30.0), 5.0));
    let mut random = Random::new(8);
    let points: Vec<(Vec3, Vec3)> = (0..3000)
        .map(|_| (random.vec3() * 6.0, random.vec3()))
        .chain([(Vec3::splat(31.0), Vec3::Y), (Vec3::splat(40.0), Vec3::Y)])
        .collect();
    let one = |kernel| PcfDescriptor {
        kernel,
        ..Default::default()
    };
    for kernel in Kernel::ALL {
        let alone: Vec<Vec<f32>> = lights
            .iter()
            .map(|light| {
                let map = fresh(&gpu, &one_light(), &[*light], &casters);
                ask(&gpu, &map, &one(kernel), 0, &points)
            })
            .collect();
        assert_eq!(alone[3][3000..], [1.0, 0.0]);
        assert!(alone[0].contains(&0.0) && alone[0].contains(&1.0));
        assert_ne!(alone[0], alone[1], "the broken twin: another light");
        for many_lights in ARRAYS {
            let mut map = fresh(&gpu, &descriptor(many_lights), &lights, &casters);
            let sampler = PcfDescriptor {
                many_lights,
                ..one(kernel)
            };
            for turn in 0..2 {
                for (place, alone) in alone.iter().enumerate() {
                    let place = if turn == 0 { place } else { 3 - place };
                    let seen = ask(&gpu, &map, &sampler, place, &points);
                    assert_eq!(&seen, alone, "{kernel:?}, {many_lights}, light {place}");
                }
                let turned: Vec<_> = lights.iter().rev().copied().collect();
                draw(&gpu, &mut map, &turned, &casters);
            }
        }
    }
}

#[test]
fn maps_of_different_sizes_share_a_sampler() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (casters, lights) = (casters(&gpu), lights());
    let reader = PcfDescriptor::default();
    let sampler = PcfSampler::new(&gpu.device, &gpu.queue, &reader).unwrap();
    let mut random = Random::new(23);
    let points: Vec<(Vec3, Vec3)> = (0..2000)
        .map(|_| (random.vec3() * 6.0, random.vec3()))
        .collect();
    let seen = [16, 64].map(|size| {
        let descriptor = CubeShadowMapDescriptor {
            size,
            ..one_light()
        };
        let map = fresh(&gpu, &descriptor, &lights[..1], &casters);
        assert_eq!(map.texture(0).unwrap().0.width(), size);
        let group = gpu.checked(|| sampler.bind_group(&gpu.device, &map).unwrap());
        let seen = ask_group(&gpu, (&sampler, &group), &reader, 0, &points, |m| m);
        assert_eq!(
            seen,
            ask(&gpu, &map, &reader, 0, &points),
            "a sampler of its own"
        );
        seen
    });
    assert_ne!(seen[0], seen[1], "the broken twin: the other map");
}

#[test]
fn no_texture_without_a_casting_light() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (casters, lights) = (casters(&gpu), lights());
    let cube = 6 * 4 * 32 * 32;
    for array in ARRAYS {
        let mut map = fresh(&gpu, &descriptor(array), &lights, &[]);
        assert!(map.texture(0).is_none());
        assert!(map.statistics().bytes < cube, "{}", map.statistics().bytes);
        let revision = map.texture_revision();
        draw(&gpu, &mut map, &lights[..1], &casters);
        assert!(map.texture(0).is_some());
        assert_ne!(map.texture_revision(), revision);
        let cubes = if array { u64::from(LIGHTS) } else { 1 };
        let bytes = map.statistics().bytes;
        assert!(
            (cubes * cube..cubes * cube + cube).contains(&bytes),
            "{bytes}"
        );
        draw(&gpu, &mut map, &[], &casters);
        assert!(
            map.statistics().bytes < cube,
            "given back with the last light"
        );
        draw(&gpu, &mut map, &lights, &casters);
        let alone = fresh(&gpu, &one_light(), &lights[2..], &casters);
        assert_eq!(faces(&gpu, &map, 2), faces(&gpu, &alone, 0));

        let at_once = CubeShadowMapDescriptor {
            allocation: Allocation::AtOnce,
            ..descriptor(array)
        };
        let map = fresh(&gpu, &at_once, &lights, &[]);
        assert!(map.texture(0).is_some());
        let clear = faces(&gpu, &map, 0);
        assert!(clear.iter().flatten().all(|&byte| byte == 0));
    }
}

#[test]
fn lights_that_reach_no_caster_for_a_while_give_their_texels_back() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (casters, lights) = (casters(&gpu), lights());
    let lights = &lights[..2];
    for array in ARRAYS {
        let mut map = fresh(&gpu, &descriptor(array), lights, &casters);
        // The frame, counted from 1, in which there are texels for so many lights only.
        let mut frame_of = |left: usize, lights: &[PointLight], casters: &[Caster]| {
            (1..=100).find(|_| {
                draw(&gpu, &mut map, lights, casters);
                (0..2).filter(|&at| map.texture(at).is_some()).count() == left
            })
        };
        let far = PointLight::new(Vec3::splat(90.0), 5.0);
        let one_casts = [lights[0], far];
        let one_left = frame_of(1, &one_casts, &casters);
        assert_eq!(one_left, (!array).then_some(60), "an array stays whole");
        assert_eq!(frame_of(0, &one_casts, &[]), Some(60));
        assert_eq!(frame_of(2, lights, &casters), Some(1), "casters came back");
        for (place, light) in lights.iter().enumerate() {
            let alone = fresh(&gpu, &one_light(), &[*light], &casters);
            assert_eq!(faces(&gpu, &map, place), faces(&gpu, &alone, 0), "{place}");
        }
    }
}

#[test]
fn samplers_refuse_maps_that_they_cannot_read() {
    let Some(gpu) = Gpu::for_test() else { return };
    let map = CubeShadowMap::new(&gpu.device, &descriptor(false)).unwrap();
    let refused = |descriptor: &PcfDescriptor<'_>| {
        PcfSampler::new(&gpu.device, &gpu.queue, descriptor)
            .unwrap()
            .bind_group(&gpu.device, &map)
            .unwrap_err()
    };
    let many = PcfDescriptor {
        many_lights: true,
        ..Default::default()
    };
    assert_eq!(refused(&many), PcfError::NoCubeArray);
    let linear = PcfDescriptor {
        encoding: DepthEncoding::LinearDistance,
        ..Default::default()
    };
    let expected = PcfError::Encoding {
        map: DepthEncoding::MajorAxis,
        sampler: DepthEncoding::LinearDistance,
    };
    assert_eq!(refused(&linear), expected);
    let good = PcfSampler::new(&gpu.device, &gpu.queue, &PcfDescriptor::default()).unwrap();
    good.bind_group(&gpu.device, &map).unwrap();
}

#[test]
fn statistics_count_every_face_once() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (casters, lights) = (casters(&gpu), lights());
    let mut map = fresh(&gpu, &descriptor(false), &lights, &casters);
    for round in 0..2 {
        let s = map.statistics();
        let faces =
            s.faces_rendered + s.faces_kept + s.faces_empty + s.faces_hidden + s.faces_postponed;
        assert_eq!(faces, 18);
        assert_eq!(s.casters_in_range + s.casters_out_of_range, 60);
        if round == 0 {
            assert_eq!(s.faces_rendered, 18);
            assert!(s.draws > 10 && s.triangles > 12 * 20 && s.triangles.is_multiple_of(12));
        } else {
            assert_eq!((s.faces_rendered, s.draws, s.triangles), (0, 0, 0));
        }
        let frame = CubeFrame {
            lights: &lights,
            casters: &casters,
            ..Default::default()
        };
        draw_frame(&gpu, &mut map, &frame);
    }
}

#[test]
fn a_bind_group_that_was_not_made_again_shows_all_lights_dark() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (casters, light) = (casters(&gpu), lights()[0]);
    let mut random = Random::new(17);
    let points: Vec<(Vec3, Vec3)> = (0..500)
        .map(|_| (light.position + random.vec3() * 4.0, random.vec3()))
        .collect();
    for encoding in [DepthEncoding::MajorAxis, DepthEncoding::LinearDistance] {
        let descriptor = CubeShadowMapDescriptor {
            encoding,
            ..one_light()
        };
        let reader = PcfDescriptor {
            encoding,
            ..Default::default()
        };
        let mut map = fresh(&gpu, &descriptor, &[light], &[]);
        let sampler = PcfSampler::new(&gpu.device, &gpu.queue, &reader).unwrap();
        let early = sampler.bind_group(&gpu.device, &map).unwrap();
        let revision = map.texture_revision();
        draw(&gpu, &mut map, &[light], &casters);
        assert_ne!(map.texture_revision(), revision);
        let late = sampler.bind_group(&gpu.device, &map).unwrap();
        let lit = |group| {
            let seen = ask_group(&gpu, (&sampler, group), &reader, 0, &points, |module| {
                module
            });
            seen.iter().filter(|&&v| v == 1.0).count()
        };
        assert_eq!(lit(&early), 0, "{encoding:?}: nobody takes that for right");
        let seen = lit(&late);
        assert!(
            seen > 0 && seen < points.len() * 9 / 10,
            "the one made again"
        );
        // Texels given back and made anew: the old ones would show what stood there long ago.
        draw(&gpu, &mut map, &[], &casters);
        draw(&gpu, &mut map, &[light], &casters);
        assert_eq!(lit(&late), 0, "{encoding:?}");
        let latest = sampler.bind_group(&gpu.device, &map).unwrap();
        assert_eq!(lit(&latest), seen);
    }
}

/// Set for a process of its own, whose GL driver has no storage buffers.
const WITHOUT: &str = "SHADOWS_TEST_WITHOUT_STORAGE";

#[test]
fn devices_without_storage_buffers_have_many_lights_too() {
    if std::env::var_os(WITHOUT).is_some() {
        return without_storage();
    }
    let name = "cube_lights::devices_without_storage_buffers_have_many_lights_too";
    let status = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--exact", name, "--nocapture"])
        .env(WITHOUT, "1")
        .env("MESA_GL_VERSION_OVERRIDE", "3.3")
        .env("MESA_GLSL_VERSION_OVERRIDE", "330")
        .env(
            "MESA_EXTENSION_OVERRIDE",
            "-GL_ARB_compute_shader -GL_ARB_shader_storage_buffer_object",
        )
        .status();
    assert!(status.unwrap().success());
}

fn without_storage() {
    let gl = match Gpu::new(Some("(Gl,")) {
        Ok(gl) => gl,
        Err(_) => return eprintln!("skipped: no GL adapter"),
    };
    if gl.device.limits().max_storage_buffers_per_shader_stage > 0 {
        return eprintln!("skipped: this GL driver has storage buffers whatever it is told");
    }
    let many = PcfDescriptor {
        many_lights: true,
        ..Default::default()
    };
    let sampler = gl.checked(|| PcfSampler::new(&gl.device, &gl.queue, &many).unwrap());
    let module = sampler.wgsl_module(0);
    assert!(
        module.contains("var<uniform> shadows_light: array<"),
        "{module}"
    );
    let mut map = CubeShadowMap::new(&gl.device, &descriptor(true)).unwrap();
    draw(&gl, &mut map, &lights(), &casters(&gl));
    gl.checked(|| sampler.bind_group(&gl.device, &map).unwrap());
    eprintln!("no storage buffers: many lights in a uniform buffer");
}
