//! Alpha-tested leaves, which only the host can draw: into the library's maps, when these ask for them,
//! against rays that know the mask.

use compare::stage::Stage;
use host::exact;
use host::gpu::Gpu;
use host::interior;
use host::pipelines::visibility_module;
use host::renderer::{LitPipeline, ShadowAccess};
use host::scene::{Light, Mesh, Object, Scene, square};
use shadows::glam::{Affine3A, Quat, Vec3};
use shadows::reference::{Comparison, Interior, ReferenceImage};
use shadows::{
    Caster, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, HostDraw, Kernel, MapKind,
    PcfDescriptor, PcfSampler, ShadowFrame, ShadowMap, ShadowMapDescriptor, wgpu,
};
use shadows::{FlatLight, SpotLight};

const LAMP: Vec3 = Vec3::new(0.4, 4.3, 0.3);

/// A ground under three cards, and a box that the library can draw.
fn scene() -> Scene {
    let mut scene = Scene::empty("leaves");
    *scene.light_mut() = Light::new(LAMP.extend(1.0), 30.0);
    scene.camera.eye = Vec3::new(0.4, 3.4, 4.2);
    scene.camera.target = Vec3::new(0.0, 0.3, 0.0);
    let card = Mesh {
        mask: vec![[0.0, 1.0], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
        ..square("leaves", Vec3::ZERO, 0.8)
    };
    scene.meshes = vec![
        square("ground", Vec3::ZERO, 9.0),
        card,
        host::scene::masonry::block(),
    ];
    let mut put = |mesh, transform, casts| {
        scene.objects.push(Object {
            name: format!("object {mesh}"),
            mesh,
            transform,
            casts,
            albedo: [0.6; 3],
            glow: [0.0; 3],
        });
    };
    put(0, Affine3A::IDENTITY, false);
    for i in 0..3 {
        let turn = Quat::from_rotation_y(0.7 + 2.1 * i as f32) * Quat::from_rotation_x(0.3);
        let place = Vec3::new(i as f32 - 1.0, 1.1 + 0.3 * i as f32, 0.2 * i as f32);
        put(1, Affine3A::from_rotation_translation(turn, place), true);
    }
    let small = Affine3A::from_translation(Vec3::new(1.9, 0.0, -0.9))
        * Affine3A::from_scale(Vec3::new(0.2, 0.9, 0.2));
    put(2, small, true);
    scene
}

fn sampler(gpu: &Gpu, map: MapKind) -> PcfSampler {
    let descriptor = PcfDescriptor {
        map,
        kernel: Kernel::Hard,
        ..Default::default()
    };
    PcfSampler::new(&gpu.device, &gpu.queue, &descriptor).unwrap()
}

fn lit(gpu: &Gpu, stage: &Stage, sampler: &PcfSampler) -> LitPipeline {
    let access = ShadowAccess {
        module: Some(&visibility_module(sampler)),
        layout: Some(sampler.bind_group_layout()),
        ..Default::default()
    };
    stage.renderer.lit_pipeline(gpu, &access)
}

/// The library's casters, and the host's.
fn casters(stage: &Stage) -> Vec<Caster> {
    let ours = &stage.inputs.casters;
    assert_eq!(ours.len(), 1, "the library draws no masks");
    assert_eq!(stage.inputs.masked.len(), 3);
    stage.inputs.of_maps()
}

fn draw_masked(stage: &Stage, pass: &mut wgpu::RenderPass<'_>, asked: &HostDraw<'_>) {
    stage.scene_gpu.draw_masked(1, pass, asked);
}

/// What a spot's map shows, with the host's casters drawn into it or without.
fn flat(gpu: &Gpu, stage: &Stage, own: bool) -> (Vec<u8>, Interior) {
    let mut map = ShadowMap::new(&gpu.device, &ShadowMapDescriptor::default()).unwrap();
    let sampler = sampler(gpu, MapKind::FLAT);
    let spot = SpotLight::new(LAMP, -LAMP, 0.9, 30.0);
    let casters = casters(stage);
    let frame = ShadowFrame::new(FlatLight::Spot(spot), &casters);
    map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    let group = sampler.bind_group(&gpu.device, &map).unwrap();
    let lit = lit(gpu, stage, &sampler);
    gpu.run(|encoder| {
        stage.renderer.draw_ambient(encoder, &stage.scene_gpu);
        match own {
            true => map.encode_with(encoder, |pass, asked| draw_masked(stage, pass, asked)),
            false => map.encode(encoder),
        }
        stage
            .renderer
            .draw_lit(encoder, &stage.scene_gpu, &lit, Some(&group));
    });
    let seen = stage.renderer.read_visibility(gpu);
    (seen, interior::of_flat(&map, Kernel::Hard))
}

/// The same of a cube map's faces.
fn cube(gpu: &Gpu, stage: &Stage, own: bool) -> (Vec<u8>, Interior) {
    let descriptor = CubeShadowMapDescriptor::default();
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor).unwrap();
    let sampler = sampler(gpu, MapKind::CUBE);
    let casters = casters(stage);
    let frame = CubeFrame::new(stage.inputs.point_light(), &casters);
    map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    let group = sampler.bind_group(&gpu.device, &map).unwrap();
    let lit = lit(gpu, stage, &sampler);
    gpu.run(|encoder| {
        stage.renderer.draw_ambient(encoder, &stage.scene_gpu);
        match own {
            true => map.encode_with(encoder, |pass, asked| draw_masked(stage, pass, asked)),
            false => map.encode(encoder),
        }
        stage
            .renderer
            .draw_lit(encoder, &stage.scene_gpu, &lit, Some(&group));
    });
    let seen = stage.renderer.read_visibility(gpu);
    (seen, interior::of_cube(&map, Kernel::Hard))
}

fn wrong_inside(found: &Comparison) -> usize {
    found.false_lit_interior + found.false_shadow_interior
}

#[test]
fn leaves_that_the_host_draws_into_maps_cast_as_their_mask_says() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut spot = scene();
    spot.light_mut().cone = Some(host::scene::Cone {
        direction: -LAMP,
        half_angle: 0.9,
    });
    type Draw = fn(&Gpu, &Stage, bool) -> (Vec<u8>, Interior);
    for (scene, draw) in [(spot, flat as Draw), (scene(), cube)] {
        let stage = Stage::new(&gpu, scene, [480, 270]).unwrap();
        let truth = stage.reference(|_| ()).unwrap();
        let solid = stage
            .reference_in(&exact::solid_scene(&stage.scene).unwrap())
            .unwrap();
        let judged = |truth: &ReferenceImage, (seen, interior): &(Vec<u8>, Interior)| {
            truth.compare(seen, *interior).unwrap()
        };
        let drawn = draw(&gpu, &stage, true);
        let found = judged(&truth, &drawn);
        assert_eq!(wrong_inside(&found), 0, "{found:?}");
        let part = (found.false_lit + found.false_shadow) as f64 / found.lit_facing as f64;
        assert!(part < 0.02, "{found:?}");
        // The twins: casters that the library alone draws, and rays that know no mask.
        let bare = judged(&truth, &draw(&gpu, &stage, false));
        assert!(wrong_inside(&bare) > 100, "{bare:?}");
        let blind = judged(&solid, &drawn);
        assert!(wrong_inside(&blind) > 100, "{blind:?}");
    }
}
