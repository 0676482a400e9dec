//! Receivers on an atlas: of each light they see what they see on its own map, whatever lies beside it.

use crate::common::rays::Triangles;
use crate::common::shapes::{Random, cuboid, sphere};
use crate::receivers::{ask, ask_changed};
use glam::camera::rh::{proj::directx as proj, view as camera};
use glam::{Affine3A, Quat, Vec3};
use host::gpu::Gpu;
use shadows::error::PcfError;
use shadows::{
    AnyMap, AtlasFrame, AtlasLight, AtlasView, CascadeSplit, Cascades, Caster, CubeFrame,
    CubeShadowMap, CubeShadowMapDescriptor, DepthConvention, DirectionalLight, FlatLight, Kernel,
    Light, LightKinds, MapKind, PcfDescriptor, PcfSampler, PointLight, ShadowAtlas,
    ShadowAtlasDescriptor, ShadowFrame, ShadowMap, ShadowMapDescriptor, SpotLight, TileSize, View,
    glam,
};

const SIZE: u32 = 128;

struct Room {
    casters: Vec<Caster>,
    truth: Triangles,
    /// Points on the casters and their normals.
    points: Vec<(Vec3, Vec3)>,
}

fn room(gpu: &Gpu, count: usize) -> Room {
    let shapes = [sphere(9, 13), cuboid(Vec3::ONE)];
    let meshes = shapes.each_ref().map(|shape| shape.mesh(&gpu.device));
    let mut random = Random::new(5);
    let mut room = Room {
        casters: Vec::new(),
        truth: Triangles::default(),
        points: Vec::new(),
    };
    for i in 0..24 {
        let (shape, mesh) = (&shapes[i % 2], &meshes[i % 2]);
        let transform = Affine3A::from_scale_rotation_translation(
            Vec3::splat(0.4 + 0.2 * random.next().abs()),
            Quat::from_rotation_y(random.next()),
            4.0 * random.vec3(),
        );
        room.casters.push(Caster::new(mesh.clone(), transform));
        room.truth.add(&shape.positions, &shape.indices, transform);
        for _ in 0..count / 24 {
            let triangle = (random.next().abs() * (shape.indices.len() / 3) as f32) as usize;
            let corner = |k: usize| {
                let index = shape.indices[3 * triangle + k] as usize;
                transform.transform_point3(shape.positions[index].into())
            };
            let [a, b, c] = [0, 1, 2].map(corner);
            let (u, v) = (random.next().abs(), random.next().abs());
            let (u, v) = if u + v > 1.0 {
                (1.0 - u, 1.0 - v)
            } else {
                (u, v)
            };
            let normal = (b - a).cross(c - a);
            if normal.length() > 0.0 {
                room.points.push((a + u * (b - a) + v * (c - a), normal));
            }
        }
    }
    room
}

fn lights() -> [AtlasLight; 5] {
    let spot = |x: f32| {
        let light = SpotLight::new(Vec3::new(x, 6.0, 1.0), Vec3::new(0.1, -1.0, 0.2), 0.7, 14.0);
        AtlasLight::new(light)
    };
    let lamp = |x: f32| AtlasLight::new(PointLight::new(Vec3::new(x, 0.1, 0.3), 9.0));
    let sun = DirectionalLight::new(Vec3::new(0.3, 1.0, 0.2));
    [
        spot(0.3),
        lamp(0.2),
        AtlasLight::directional(sun, Cascades::default()),
        lamp(-1.3),
        spot(-0.4),
    ]
    .map(|light| light.with_size(TileSize::Fixed(SIZE)))
}

fn atlas(gpu: &Gpu, frame: &AtlasFrame<'_>) -> ShadowAtlas {
    let descriptor = ShadowAtlasDescriptor {
        layer_size: 512,
        memory: 4 << 20,
        ..Default::default()
    };
    let mut atlas = ShadowAtlas::new(&gpu.device, &descriptor).unwrap();
    gpu.checked(|| {
        atlas.prepare(&gpu.device, &gpu.queue, frame).unwrap();
        gpu.run(|encoder| atlas.encode(encoder));
    });
    atlas
}

/// What a light's own map says.
fn own(gpu: &Gpu, light: Light, kernel: Kernel, room: &Room) -> Vec<f32> {
    let flat = |light: FlatLight| {
        let descriptor = ShadowMapDescriptor {
            size: SIZE,
            ..Default::default()
        };
        let mut map = ShadowMap::new(&gpu.device, &descriptor).unwrap();
        let frame = ShadowFrame::new(light, &room.casters);
        map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        gpu.run(|encoder| map.encode(encoder));
        crate::receivers::visibility(gpu, &map, kernel, &room.points)
    };
    match light {
        Light::Spot(light) => flat(light.into()),
        Light::Directional(light) => flat(light.into()),
        Light::Point(light) => {
            let descriptor = CubeShadowMapDescriptor {
                size: SIZE,
                ..Default::default()
            };
            let mut map = CubeShadowMap::new(&gpu.device, &descriptor).unwrap();
            let frame = CubeFrame::new(light, &room.casters);
            map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
            gpu.run(|encoder| map.encode(encoder));
            crate::receivers::visibility(gpu, &map, kernel, &room.points)
        }
        other => panic!("{other:?}"),
    }
}

fn descriptor(kernel: Kernel) -> PcfDescriptor<'static> {
    PcfDescriptor {
        kernel,
        map: MapKind::ATLAS,
        ..Default::default()
    }
}

/// Points of which two answers differ by more than rounding makes of them: that of the rasteriser, or of a
/// sampler that blends, which knows places between texels to 1/256.
fn differing(kernel: Kernel, a: &[f32], b: &[f32]) -> usize {
    assert_eq!(a.len(), b.len());
    let rounding = match kernel {
        Kernel::HardwareBilinear => 0.01,
        _ => 1e-3,
    };
    let differ = |(a, b): &(&f32, &f32)| (*a - *b).abs() > rounding;
    a.iter().zip(b).filter(differ).count()
}

#[test]
fn every_kernel_says_of_a_light_what_it_says_of_its_own_map() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (room, lights) = (room(&gpu, 4800), lights());
    let frame = AtlasFrame {
        lights: &lights,
        casters: &room.casters,
        ..Default::default()
    };
    let atlas = atlas(&gpu, &frame);
    for kernel in Kernel::ALL {
        let said = |light| ask(&gpu, &atlas, &descriptor(kernel), light, &room.points);
        for (index, light) in lights.iter().enumerate() {
            let (ours, theirs) = (said(index), own(&gpu, light.light(), kernel, &room));
            let wrong = differing(kernel, &ours, &theirs);
            // One comparison by the sampler takes what is beside a tile for what is on its edge: half a
            // texel along each seam of a cube's faces and each border of a spot.
            let seams = match kernel {
                Kernel::HardwareBilinear => 60,
                _ => 10,
            };
            assert!(
                wrong <= seams,
                "{kernel:?}, light {index}: {wrong} of {}",
                ours.len()
            );
            // The broken twin: another light of the same kind.
            if index == 1 {
                let other = differing(kernel, &said(3), &theirs);
                assert!(other > 300, "{kernel:?}: {other}");
            }
        }
        let none = said(5);
        assert!(none.iter().all(|&lit| lit == 0.0), "no such light");
    }
}

/// Share of points whose visibility is not what rays in f64 say.
fn wrong_share(said: &[f32], toward: Vec3, room: &Room) -> f64 {
    let wrong = said
        .iter()
        .zip(&room.points)
        .filter(|(lit, (point, normal))| {
            let facing = normal.dot(toward) > 0.0;
            let from = point.as_dvec3() + 1e-4 * normal.normalize().as_dvec3();
            let truth = facing && room.truth.nearest(from, toward.as_dvec3()).is_none();
            facing && (**lit > 0.5) != truth
        });
    wrong.count() as f64 / said.len() as f64
}

#[test]
fn a_receiver_reads_the_nearest_cascade_that_holds_it() {
    let Some(gpu) = Gpu::for_test() else { return };
    let room = room(&gpu, 7200);
    let toward = Vec3::new(0.4, 1.0, 0.3);
    let projection = proj::perspective_infinite_reverse(1.2, 1.5, 0.1);
    let matrix = projection * camera::look_at_mat4(Vec3::new(2.0, 1.0, 5.0), Vec3::ZERO, Vec3::Y);
    let view = View::new(matrix, DepthConvention::InfiniteReverse).unwrap();
    let views = [AtlasView::new(&view, 300, 200)];
    let sun = |blend: f32| {
        let cascades = Cascades {
            count: 4,
            distance: 14.0,
            blend,
            ..Default::default()
        };
        let light = DirectionalLight::new(toward);
        AtlasLight::directional(light, cascades).with_size(TileSize::Fixed(256))
    };
    for blend in [0.0, 0.3] {
        let lights = [lights()[1], sun(blend)];
        let frame = AtlasFrame {
            lights: &lights,
            casters: &room.casters,
            views: &views,
            receivers: None,
        };
        let atlas = atlas(&gpu, &frame);
        assert_eq!(atlas.tiles(1, 0).len(), 4);
        for kernel in [Kernel::Hard, Kernel::Bilinear, Kernel::Weighted5] {
            let said = ask(&gpu, &atlas, &descriptor(kernel), 1, &room.points);
            let wrong = wrong_share(&said, toward, &room);
            assert!(wrong < 0.02, "{kernel:?}, {blend}: {wrong}");
            // The broken twin: the first cascade alone, beside which all is lit.
            let first = |module: String| {
                let changed = module.replace("(first.kind >> 8u) & 15u", "0u");
                assert_ne!(changed, module);
                changed
            };
            let map = AnyMap::from(&atlas);
            let said = ask_changed(&gpu, map, &descriptor(kernel), 1, &room.points, first);
            let wrong = wrong_share(&said, toward, &room);
            assert!(
                wrong > 0.05,
                "{kernel:?}, {blend}: {wrong} with one cascade"
            );
        }
    }
}

#[test]
fn a_receiver_before_a_cascades_near_plane_reads_a_farther_one() {
    let Some(gpu) = Gpu::for_test() else { return };
    // High above the eye a platform with a roof over it; the nearest cascade begins far below both.
    let slab = cuboid(Vec3::new(40.0, 0.5, 40.0)).mesh(&gpu.device);
    let at = |y: f32| Caster::new(slab.clone(), Affine3A::from_translation(Vec3::Y * y));
    let casters = [at(-0.5), at(300.0), at(350.0)];
    let projection = proj::perspective_infinite_reverse(1.2, 1.5, 0.1);
    let matrix = projection * camera::look_at_mat4(Vec3::Y, Vec3::NEG_Z, Vec3::Y);
    let view = View::new(matrix, DepthConvention::InfiniteReverse).unwrap();
    let cascades = Cascades {
        count: 8,
        split: CascadeSplit::Practical { lambda: 1.0 },
        distance: 400.0,
        ..Default::default()
    };
    let lights = [
        AtlasLight::directional(DirectionalLight::new(Vec3::Y), cascades)
            .with_size(TileSize::Fixed(256)),
    ];
    let frame = AtlasFrame {
        lights: &lights,
        casters: &casters,
        views: &[AtlasView::new(&view, 300, 200)],
        receivers: None,
    };
    let atlas = atlas(&gpu, &frame);
    let nearest = atlas.tiles(0, 0)[0].clip_from_world;
    assert!(nearest.project_point3(Vec3::Y * 300.5).z > 1.0);
    let mut random = Random::new(1);
    let on_platform = |_| {
        let place = Vec3::new(0.2 * random.next(), 300.5, 0.2 * random.next());
        (place, Vec3::Y)
    };
    let points: Vec<_> = (0..200).map(on_platform).collect();
    let lit = |said: Vec<f32>| said.iter().filter(|&&lit| lit > 0.0).count();
    for kernel in [Kernel::Hard, Kernel::Bilinear] {
        let said = ask(&gpu, &atlas, &descriptor(kernel), 0, &points);
        assert_eq!(lit(said), 0, "{kernel:?}");
        // The broken twin: cascades are chosen by their sides alone.
        let sides = |module: String| {
            let changed = module.replace("dot(record.forward, local) < 0.0", "false");
            assert_ne!(changed, module);
            changed
        };
        let map = AnyMap::from(&atlas);
        let said = ask_changed(&gpu, map, &descriptor(kernel), 0, &points, sides);
        assert!(lit(said) > 100, "{kernel:?}");
    }
}

#[test]
fn a_light_that_is_gone_is_dark() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (room, lights) = (room(&gpu, 480), lights());
    let frame = |count: usize| AtlasFrame {
        lights: &lights[..count],
        casters: &room.casters,
        ..Default::default()
    };
    let mut atlas = atlas(&gpu, &frame(5));
    let lit = |atlas: &ShadowAtlas, light: usize| {
        let said = ask(
            &gpu,
            atlas,
            &descriptor(Kernel::Bilinear),
            light,
            &room.points,
        );
        said.iter().filter(|&&lit| lit > 0.0).count()
    };
    assert!(lit(&atlas, 4) > 20 && lit(&atlas, 3) > 20);
    // Found once and not encoded, and then again.
    for _ in 0..2 {
        atlas.prepare(&gpu.device, &gpu.queue, &frame(2)).unwrap();
    }
    gpu.run(|encoder| atlas.encode(encoder));
    assert_eq!((lit(&atlas, 4), lit(&atlas, 3)), (0, 0));
    assert!(lit(&atlas, 1) > 20, "it is still there");
}

#[test]
fn kinds_that_are_not_asked_for_leave_no_code() {
    let Some(gpu) = Gpu::for_test() else { return };
    let kinds = |point, spot, directional| LightKinds {
        point,
        spot,
        directional,
    };
    let sampler = |kinds| {
        let descriptor = PcfDescriptor {
            map: MapKind::Atlas(kinds),
            ..descriptor(Kernel::Weighted5)
        };
        PcfSampler::new(&gpu.device, &gpu.queue, &descriptor)
    };
    let text = |kinds| sampler(kinds).unwrap().wgsl_module(0);
    let has = |kinds, what: &str| text(kinds).contains(what);
    assert!(!has(kinds(true, false, false), "shadows_flat_"));
    assert!(!has(kinds(false, true, false), "ShadowsCube"));
    assert!(!has(kinds(false, true, false), "on_cascades"));
    assert!(has(kinds(false, false, true), "on_cascades") && has(LightKinds::ALL, "ShadowsCube"));
    let error = sampler(kinds(false, false, false)).unwrap_err();
    assert_eq!(error, PcfError::NoLightKinds);

    let (room, lights) = (room(&gpu, 240), lights());
    let frame = AtlasFrame {
        lights: &lights,
        casters: &room.casters,
        ..Default::default()
    };
    let atlas = atlas(&gpu, &frame);
    let spots = PcfDescriptor {
        map: MapKind::Atlas(kinds(false, true, false)),
        ..descriptor(Kernel::Bilinear)
    };
    let lit = |light: usize| {
        let said = ask(&gpu, &atlas, &spots, light, &room.points);
        said.iter().filter(|&&lit| lit > 0.0).count()
    };
    assert!(lit(0) > 20, "a spot");
    assert_eq!((lit(1), lit(2)), (0, 0), "a lamp and a sun");
}
