//! Every way to find silhouettes gives the same shadows, and none looks twice without need.

use host::one_light::{OneLight, PrepareOne as _};
use shadows::error::ShadowVolumeError;
use shadows::glam::{Affine3A, Quat, Vec3};
use shadows::mesh::{Adjacency, Bounds};
use shadows::{
    Caster, CasterMesh, HomogeneousLight, HostPositions, ShadowVolumeDescriptor,
    ShadowVolumeRenderer, Silhouettes, wgpu,
};
use wgpu::util::DeviceExt as _;

use crate::pictures::{at, lamp, mixed, sun};
use crate::shapes;
use crate::stage::{Body, Stage, WAYS};
use host::gpu::Gpu;
use host::scene::moved_light;

fn renderer(gpu: &Gpu, stage: &Stage, silhouettes: Silhouettes) -> ShadowVolumeRenderer {
    let descriptor = ShadowVolumeDescriptor {
        silhouettes,
        ..stage.descriptor()
    };
    ShadowVolumeRenderer::new(&gpu.device, &descriptor).unwrap()
}

fn wrong(stage: &Stage, picture: &[u8]) -> usize {
    let found = stage.truth().errors(picture);
    assert!(found.shadowed > 500 && found.interior > 10_000, "{found:?}");
    found.wrong
}

/// Closed, open, non-manifold, inside out, mirrored, touching; a light and an eye inside.
fn stages() -> Vec<(&'static str, Stage)> {
    let turn = Quat::from_rotation_z(0.4) * Quat::from_rotation_x(-0.3);
    let mirror = Affine3A::from_scale_rotation_translation(
        Vec3::new(-1.0, 0.6, 1.3),
        turn,
        Vec3::new(0.3, 1.8, -0.2),
    );
    let one = |light, shape, place| Stage::new(light, vec![Body::caster(shape, place)]);
    let turned = shapes::sphere(10).turned(|triangle| triangle % 2 == 0);
    let hemisphere = shapes::sphere(10).cut(|corners| corners.iter().all(|c| c.y > -1e-3));
    let mut stages = Vec::new();
    for light in [lamp(), sun()] {
        stages.extend([
            ("mixed", mixed(light)),
            ("three fins", one(light, shapes::fins(3), at(0.0, 0.5, 0.0))),
            ("four fins", one(light, shapes::fins(4), at(0.0, 0.5, 0.0))),
            (
                "mixed winding",
                one(light, turned.clone(), at(0.0, 1.5, 0.0)),
            ),
            (
                "hemisphere",
                one(light, hemisphere.clone(), at(0.0, 1.2, 0.0)),
            ),
            (
                "mirrored",
                one(light, shapes::cube().with(&shapes::fins(3)), mirror),
            ),
            ("closed, mirrored", one(light, shapes::sphere(8), mirror)),
        ]);
    }
    let inside = one(
        HomogeneousLight::point(Vec3::new(0.1, 1.2, 0.2)),
        shapes::cube(),
        at(0.0, 1.3, 0.0),
    );
    stages.push(("a light inside a closed caster", inside));
    stages
}

#[test]
fn every_way_is_exact() {
    let Some(gpu) = Gpu::for_test() else { return };
    assert_every_way_is_exact(&gpu, stages());
}

#[test]
fn every_way_is_exact_on_gl_too() {
    let Some(_) = Gpu::for_test() else { return };
    let Ok(gl) = Gpu::new(Some("(gl,")) else {
        eprintln!("skipped: no GL adapter");
        return;
    };
    assert_eq!(gl.info.backend, wgpu::Backend::Gl);
    let chosen = ["mixed", "four fins", "closed, mirrored"];
    let stages = stages().into_iter();
    let stages = stages.filter(|(what, _)| chosen.contains(what));
    assert_every_way_is_exact(&gl, stages.collect());
}

fn assert_every_way_is_exact(gpu: &Gpu, stages: Vec<(&str, Stage)>) {
    for (what, stage) in stages {
        let truth = stage.truth();
        for way in WAYS {
            let mut renderer = renderer(gpu, &stage, way);
            let picture = stage.draw_with(gpu, &mut renderer, &stage.casters(gpu));
            let found = truth.errors(&picture);
            assert!(found.shadowed > 300, "{what}: {found:?}");
            assert_eq!(found.wrong, 0, "{what}, {way:?}: {found:?}");
        }
    }
}

#[test]
fn what_stands_still_is_not_searched_again() {
    let Some(gpu) = Gpu::for_test() else { return };
    for way in [Silhouettes::Compute, Silhouettes::Cpu] {
        let mut stage = mixed(lamp());
        let mut casters = stage.casters(&gpu);
        let count = casters.len() as u32;
        let mut renderer = renderer(&gpu, &stage, way);
        let mut drawn = |stage: &Stage, casters: &[Caster]| {
            let picture = stage.draw_with(&gpu, &mut renderer, casters);
            let found = renderer.statistics();
            assert_eq!(wrong(stage, &picture), 0, "{way:?}");
            assert_eq!(found.casters_drawn, count);
            assert_eq!(
                found.dispatches > 0,
                found.casters_extracted > 0 && way == Silhouettes::Compute
            );
            found.casters_extracted
        };
        assert_eq!(drawn(&stage, &casters), count, "{way:?}: the first frame");
        assert_eq!(drawn(&stage, &casters), 0, "{way:?}: nothing moves");
        stage.eye = Vec3::new(-4.0, 6.0, 5.0);
        assert_eq!(drawn(&stage, &casters), 0, "{way:?}: the camera moves");
        stage.light = moved_light(stage.light, 0.5 * Vec3::X);
        assert_eq!(drawn(&stage, &casters), count, "{way:?}: the light moves");
        let last = stage.bodies.len() - 1;
        stage.bodies[last].transform.translation.x += 0.5;
        casters[last - 1].world_from_object = stage.bodies[last].transform;
        assert_eq!(drawn(&stage, &casters), 1, "{way:?}: one caster moves");
        assert_eq!(drawn(&stage, &casters), 0, "{way:?}: nothing moves again");
    }
}

#[test]
fn what_was_prepared_and_not_encoded_is_searched_again() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = mixed(lamp());
    let casters = stage.casters(&gpu);
    let mut renderer = renderer(&gpu, &stage, Silhouettes::Compute);
    let view = stage.view();
    let frame = OneLight::new(&view, stage.light, &casters);
    for _ in 0..2 {
        renderer
            .prepare_one(&gpu.device, &gpu.queue, &frame)
            .unwrap();
        assert_eq!(renderer.statistics().casters_extracted, 2);
    }
    assert_eq!(wrong(&stage, &stage.redraw(&gpu, &mut renderer)), 0);
    renderer
        .prepare_one(&gpu.device, &gpu.queue, &frame)
        .unwrap();
    assert_eq!(renderer.statistics().casters_extracted, 0);
}

#[test]
fn nothing_is_kept_where_the_host_does_not_want_it() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = mixed(lamp());
    let casters = stage.casters(&gpu);
    let descriptor = ShadowVolumeDescriptor {
        keep_between_frames: false,
        ..stage.descriptor()
    };
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &descriptor).unwrap();
    for _ in 0..2 {
        stage.draw_with(&gpu, &mut renderer, &casters);
        assert_eq!(renderer.statistics().casters_extracted, 2);
    }
}

/// A sphere in the host's own buffer.
fn of_host(gpu: &Gpu, shape: &shapes::Shape) -> (wgpu::Buffer, CasterMesh) {
    let buffer = gpu
        .device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("host positions"),
            contents: bytemuck::cast_slice(&shape.positions),
            usage: wgpu::BufferUsages::VERTEX
                | wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::COPY_DST,
        });
    let adjacency = Adjacency::new(&shape.positions, &shape.indices).unwrap();
    let host = HostPositions {
        buffer: &buffer,
        stride: 12,
        offset: 0,
        bounds: Bounds {
            min: Vec3::splat(-3.0),
            max: Vec3::splat(3.0),
        },
    };
    let mesh = CasterMesh::from_host_positions(&gpu.device, &host, &adjacency).unwrap();
    (buffer, mesh)
}

/// Wrong pixels after the host has turned a box in its buffer, `told` or not.
fn after_deforming(gpu: &Gpu, told: bool) -> usize {
    let mut stage = Stage::new(
        lamp(),
        vec![Body::caster(shapes::cube(), at(0.0, 2.0, 0.0))],
    );
    let (buffer, mesh) = of_host(gpu, &stage.bodies[1].shape);
    let casters = [Caster::new(mesh.clone(), stage.bodies[1].transform)];
    let mut renderer = renderer(gpu, &stage, Silhouettes::Compute);
    assert_eq!(
        wrong(&stage, &stage.draw_with(gpu, &mut renderer, &casters)),
        0
    );
    let shape = &mut stage.bodies[1].shape;
    for position in &mut shape.positions {
        *position = Quat::from_rotation_x(0.9)
            .mul_vec3((*position).into())
            .to_array();
    }
    let bytes = bytemuck::cast_slice(&shape.positions);
    gpu.queue.write_buffer(&buffer, 0, bytes);
    if told {
        mesh.bump_revision();
    }
    wrong(&stage, &stage.draw_with(gpu, &mut renderer, &casters))
}

#[test]
fn a_deformed_mesh_casts_its_present_shadow() {
    let Some(gpu) = Gpu::for_test() else { return };
    assert_eq!(after_deforming(&gpu, true), 0);
}

#[test]
fn a_host_that_hides_a_deformation_gets_a_stale_silhouette() {
    let Some(gpu) = Gpu::for_test() else { return };
    assert!(after_deforming(&gpu, false) > 100);
}

#[test]
fn a_software_adapter_is_left_to_the_cpu() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = mixed(lamp());
    let mut renderer = renderer(&gpu, &stage, Silhouettes::Auto);
    stage.draw_with(&gpu, &mut renderer, &stage.casters(&gpu));
    let found = renderer.statistics();
    let software = gpu.info.device_type == wgpu::DeviceType::Cpu;
    assert_eq!(found.casters_extracted, 2);
    assert_eq!(found.dispatches == 0, software);

    // What the CPU cannot read, compute shaders extract.
    let (_buffer, mesh) = of_host(&gpu, &shapes::fins(3));
    let casters = [Caster::new(mesh, at(0.0, 0.5, 0.0))];
    let alone = Stage::new(
        lamp(),
        vec![Body::caster(shapes::fins(3), at(0.0, 0.5, 0.0))],
    );
    assert_eq!(
        wrong(&alone, &alone.draw_with(&gpu, &mut renderer, &casters)),
        0
    );
    assert!(renderer.statistics().dispatches > 0);
}

#[test]
fn positions_of_the_host_are_refused_where_they_cannot_be_read() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = mixed(lamp());
    for way in [Silhouettes::Cpu, Silhouettes::Vertex] {
        let (_buffer, mesh) = of_host(&gpu, &shapes::fins(3));
        let mut casters = stage.casters(&gpu);
        let mut renderer = renderer(&gpu, &stage, way);
        let view = stage.view();
        let mut prepare = |casters: &[Caster]| {
            let frame = OneLight::new(&view, stage.light, casters);
            renderer.prepare_one(&gpu.device, &gpu.queue, &frame)
        };
        assert_eq!(prepare(&casters), Ok(()));
        casters.push(Caster::new(mesh, Affine3A::IDENTITY));
        assert_eq!(
            prepare(&casters),
            Err(ShadowVolumeError::HostPositions { index: 2 })
        );
        assert_eq!(
            wrong(&stage, &stage.redraw(&gpu, &mut renderer)),
            0,
            "{way:?}"
        );
    }
}

/// Draws a frame on a device of WebGL2's limits; the validation error, if there is one.
fn on_webgl2(silhouettes: Silhouettes) -> Result<Option<String>, ShadowVolumeError> {
    let limits = wgpu::Limits::downlevel_webgl2_defaults();
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor {
        required_limits: limits,
        ..Default::default()
    });
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let mut renderer = ShadowVolumeRenderer::new(
        &device,
        &ShadowVolumeDescriptor {
            silhouettes,
            depth_stencil_format: wgpu::TextureFormat::Depth24PlusStencil8,
            ..Default::default()
        },
    )?;
    let fins = shapes::fins(3);
    let adjacency = Adjacency::new(&fins.positions, &fins.indices).unwrap();
    let mesh = CasterMesh::new(&device, &fins.positions, &adjacency).unwrap();
    let view = mixed(lamp()).view();
    let casters = [Caster::new(mesh, at(0.0, 0.5, 0.0))];
    let frame = OneLight::new(&view, lamp(), &casters);
    renderer.prepare_one(&device, &queue, &frame)?;
    assert!(renderer.statistics().draws > 0);
    let mut encoder = device.create_command_encoder(&Default::default());
    renderer.encode(&mut encoder);
    let depth = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: 64,
            height: 64,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth24PlusStencil8,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth.create_view(&Default::default()),
            depth_ops: None,
            stencil_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0),
                store: wgpu::StoreOp::Store,
            }),
        }),
        ..Default::default()
    });
    renderer.render(&mut pass, 0, 0).unwrap();
    drop(pass);
    queue.submit([encoder.finish()]);
    Ok(pollster::block_on(scope.pop()).map(|error| error.to_string()))
}

#[test]
fn webgl2_has_shadow_volumes_too() {
    assert_eq!(on_webgl2(Silhouettes::Auto), Ok(None));
    assert_eq!(on_webgl2(Silhouettes::Vertex), Ok(None));
    for (way, needed) in [(Silhouettes::Compute, 7), (Silhouettes::Cpu, 4)] {
        let error = ShadowVolumeError::Limit {
            name: "max_storage_buffers_per_shader_stage",
            needed,
            available: 0,
        };
        assert_eq!(on_webgl2(way), Err(error));
    }
}
