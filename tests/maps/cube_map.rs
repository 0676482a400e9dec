//! `CubeShadowMap`: what is drawn, what is left alone, and what the texels hold.

use crate::common::rays::Triangles;
use crate::common::shapes::{Random, cuboid, sphere};
use glam::{Affine3A, DVec3, Vec3};
use host::gpu::Gpu;
use shadows::{
    Caster, CubeFace, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, PointLight, glam, wgpu,
};

fn map(gpu: &Gpu, size: u32) -> CubeShadowMap {
    CubeShadowMap::new(
        &gpu.device,
        &CubeShadowMapDescriptor {
            size,
            ..Default::default()
        },
    )
    .unwrap()
}

fn draw(gpu: &Gpu, map: &mut CubeShadowMap, light: &PointLight, casters: &[Caster]) {
    gpu.checked(|| {
        let frame = CubeFrame::new(*light, casters);
        map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        gpu.run(|encoder| map.encode(encoder));
    });
}

fn texels(gpu: &Gpu, map: &CubeShadowMap, face: CubeFace) -> Vec<f32> {
    let bytes = gpu.read_texture(map.texture(), face.layer(), wgpu::TextureAspect::All);
    bytemuck::pod_collect_to_vec(&bytes)
}

/// Direction of a point of a face, in texels from its corner, 1 along the major axis, by the table of the
/// specification.
fn direction(face: CubeFace, size: u32, x: f64, y: f64) -> DVec3 {
    let at = |i: f64| i * 2.0 / f64::from(size) - 1.0;
    let (s, t) = (at(x), at(y));
    match face {
        CubeFace::PositiveX => DVec3::new(1.0, -t, -s),
        CubeFace::NegativeX => DVec3::new(-1.0, -t, s),
        CubeFace::PositiveY => DVec3::new(s, 1.0, t),
        CubeFace::NegativeY => DVec3::new(s, -1.0, -t),
        CubeFace::PositiveZ => DVec3::new(s, -t, 1.0),
        CubeFace::NegativeZ => DVec3::new(-s, -t, -1.0),
    }
}

/// Around a texel's centre: there, and as far to either side as the rasteriser may have moved a vertex.
/// Hardware takes depth from the vertices that it moved.
fn snapped(gpu: &Gpu) -> [(f64, f64); 5] {
    let half = gpu.vertex_grid() / 2.0;
    [
        (0.0, 0.0),
        (half, half),
        (-half, half),
        (half, -half),
        (-half, -half),
    ]
}

/// Share of texels whose depth is not what rays in f64 say, to one part in 1e6.
fn wrong_share(gpu: &Gpu, map: &CubeShadowMap, light: &PointLight, truth: &Triangles) -> f64 {
    let size = map.size();
    let (mut wrong, snapped) = (0, snapped(gpu));
    for face in CubeFace::ALL {
        let near = f64::from(map.clip_from_world(face).unwrap().w_axis.z);
        let stored = texels(gpu, map, face);
        for (i, &depth) in stored.iter().enumerate() {
            let (x, y) = (i as u32 % size, i as u32 / size);
            let expected = snapped.map(|(right, down)| {
                let ray = direction(
                    face,
                    size,
                    f64::from(x) + 0.5 + right,
                    f64::from(y) + 0.5 + down,
                );
                let hit = truth.nearest(light.position.as_dvec3(), ray);
                hit.filter(|&t| t > near).map_or(0.0, |t| near / t)
            });
            let least = expected.into_iter().fold(f64::INFINITY, f64::min);
            let most = expected.into_iter().fold(0.0, f64::max);
            let depth = f64::from(depth);
            if depth < least * (1.0 - 1e-6) || depth > most * (1.0 + 1e-6) {
                wrong += 1;
            }
        }
    }
    wrong as f64 / f64::from(6 * size * size)
}

/// Boxes of every transform around a light: scaled, sheared, mirrored, shared mesh.
fn clutter(gpu: &Gpu, count: usize) -> (Vec<Caster>, Triangles) {
    let mut random = Random::new(7);
    let shapes = [cuboid(Vec3::splat(0.5)), sphere(5, 7)];
    let meshes = shapes.each_ref().map(|shape| shape.mesh(&gpu.device));
    let mut casters = Vec::new();
    let mut truth = Triangles::default();
    for i in 0..count {
        let place = random.vec3() * 4.0;
        let scale = Vec3::splat(1.2) + random.vec3();
        let turn =
            Affine3A::from_axis_angle((random.vec3() + 0.01).normalize(), random.next() * 3.0);
        let mirror = if i % 3 == 0 {
            Vec3::new(-1.0, 1.0, 1.0)
        } else {
            Vec3::ONE
        };
        let transform = Affine3A::from_translation(place + place.signum() * 2.5)
            * Affine3A::from_scale(Vec3::new(1.0, 0.5, 1.0))
            * turn
            * Affine3A::from_scale(scale * mirror * 0.5);
        casters.push(Caster::new(meshes[i % 2].clone(), transform));
        truth.add(&shapes[i % 2].positions, &shapes[i % 2].indices, transform);
    }
    (casters, truth)
}

#[test]
fn every_texel_holds_the_depth_of_the_nearest_caster() {
    let Some(gpu) = Gpu::for_test() else { return };
    let light = PointLight::new(Vec3::new(0.1, -0.2, 0.3), 40.0);
    let (casters, truth) = clutter(&gpu, 40);
    let mut map = map(&gpu, 96);
    draw(&gpu, &mut map, &light, &casters);
    // Texels on an outline may go either way: the rasteriser snaps vertices.
    let share = wrong_share(&gpu, &map, &light, &truth);
    assert!(share < 1e-4, "{share}");
    assert!(map.statistics().triangles > 0);

    // The broken twin: ten casters fewer than the truth knows.
    draw(&gpu, &mut map, &light, &casters[10..]);
    let twin = wrong_share(&gpu, &map, &light, &truth);
    assert!(twin > 1e-3, "{twin}");
}

#[test]
fn casters_are_drawn_only_on_the_faces_they_touch() {
    let Some(gpu) = Gpu::for_test() else { return };
    let light = PointLight::new(Vec3::ZERO, 40.0);
    let mut map = map(&gpu, 32);
    let small = cuboid(Vec3::splat(0.5)).mesh(&gpu.device);
    let at = |x: f32, y: f32, z: f32| {
        Caster::new(
            small.clone(),
            Affine3A::from_translation(Vec3::new(x, y, z)),
        )
    };
    let casters = [
        at(5.0, 0.0, 0.0),  // one face
        at(5.0, 5.0, 0.0),  // an edge: two faces
        at(5.0, 5.0, 5.0),  // a corner: three faces
        at(50.0, 0.0, 0.0), // beyond the range
    ];
    draw(&gpu, &mut map, &light, &casters);
    let statistics = map.statistics();
    assert_eq!(statistics.triangles, 12 * (1 + 2 + 3));
    assert_eq!(statistics.casters_in_range, 3);
    assert_eq!(statistics.casters_out_of_range, 1);
    // They share a mesh, so each face is one instanced draw.
    assert_eq!(statistics.draws, 3);
}

#[test]
fn culling_changes_no_bit() {
    let Some(gpu) = Gpu::for_test() else { return };
    // All casters are in range: what lies beyond it is drawn only without culling.
    let light = PointLight::new(Vec3::new(0.1, -0.2, 0.3), 40.0);
    let (casters, _) = clutter(&gpu, 40);
    let faces = |cull_casters, casters: &[Caster]| {
        let descriptor = CubeShadowMapDescriptor {
            size: 96,
            cull_casters,
            ..Default::default()
        };
        let mut map = CubeShadowMap::new(&gpu.device, &descriptor).unwrap();
        draw(&gpu, &mut map, &light, casters);
        let triangles = map.statistics().triangles;
        (
            CubeFace::ALL.map(|face| texels(&gpu, &map, face)),
            triangles,
        )
    };
    let (culled, few) = faces(true, &casters);
    let (whole, many) = faces(false, &casters);
    assert!(2 * few < many, "{few} of {many} triangles");
    assert!(culled == whole);
    assert!(faces(true, &casters[1..]).0 != whole, "the broken twin");
}

#[test]
fn a_face_without_casters_is_cleared_once() {
    let Some(gpu) = Gpu::for_test() else { return };
    let light = PointLight::new(Vec3::ZERO, 40.0);
    let mut map = map(&gpu, 32);
    let mesh = cuboid(Vec3::splat(0.5)).mesh(&gpu.device);
    let at = |x: f32| {
        [Caster::new(
            mesh.clone(),
            Affine3A::from_translation(Vec3::new(x, 0.0, 0.0)),
        )]
    };
    let mut rendered = |casters: &[Caster]| {
        draw(&gpu, &mut map, &light, casters);
        let right = texels(&gpu, &map, CubeFace::PositiveX);
        (
            map.statistics().faces_rendered,
            right.iter().any(|&d| d > 0.0),
        )
    };
    assert_eq!(
        rendered(&at(5.0)),
        (6, true),
        "a new map has all faces cleared"
    );
    assert_eq!(rendered(&at(5.0)), (0, true), "nothing changed");
    assert_eq!(
        rendered(&at(-5.0)),
        (2, false),
        "the new face, and the old one cleared"
    );
    assert_eq!(rendered(&at(-5.0)), (0, false));
    assert_eq!(rendered(&[]), (1, false));
    assert_eq!(rendered(&[]), (0, false), "nothing left to do");
}

#[test]
fn a_clear_that_was_prepared_but_not_encoded_is_not_lost() {
    let Some(gpu) = Gpu::for_test() else { return };
    let light = PointLight::new(Vec3::ZERO, 40.0);
    let mut map = map(&gpu, 32);
    let caster = cuboid(Vec3::ONE).caster(&gpu.device, Affine3A::from_translation(Vec3::X * 5.0));
    draw(&gpu, &mut map, &light, &[caster]);
    let frame = CubeFrame::new(light, &[]);
    map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    gpu.run(|encoder| map.encode(encoder));
    let right = texels(&gpu, &map, CubeFace::PositiveX);
    assert!(right.iter().all(|&depth| depth == 0.0));
}
