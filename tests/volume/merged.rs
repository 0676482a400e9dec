//! Casters share their draws: a handful a light, whatever the number of casters, and nothing of one is
//! drawn as another's.

use host::one_light::{OneLight, PrepareOne as _};
use shadows::glam::{Affine3A, Vec3};
use shadows::mesh::Adjacency;
use shadows::{
    Caster, CasterMesh, HomogeneousLight, Method, ShadowVolumeDescriptor, ShadowVolumeFrame,
    ShadowVolumeRenderer, Silhouettes, VolumeLight, VolumeStatistics, rewriting, wgpu,
};

use crate::errors::bare;
use crate::kept::{Theatre, frame, is_shown};
use crate::pictures::{lamp, mixed};
use crate::shapes::{self, Shape};
use host::gpu::Gpu;

/// The ways whose casters share draws.
const SHARING: [Silhouettes; 2] = [Silhouettes::Compute, Silhouettes::Cpu];

fn mesh(device: &wgpu::Device, shape: &Shape) -> CasterMesh {
    let adjacency = Adjacency::new(&shape.positions, &shape.indices).unwrap();
    CasterMesh::new(device, &shape.positions, &adjacency).unwrap()
}

fn renderer(
    device: &wgpu::Device,
    silhouettes: Silhouettes,
    method: Method,
) -> ShadowVolumeRenderer {
    let descriptor = ShadowVolumeDescriptor {
        silhouettes,
        method,
        ..Default::default()
    };
    ShadowVolumeRenderer::new(device, &descriptor).unwrap()
}

/// Casters of eight meshes, closed and general, all over the stage.
fn crowd(device: &wgpu::Device, count: usize) -> Vec<Caster> {
    let meshes: Vec<CasterMesh> = (3..7)
        .flat_map(|rings| [shapes::sphere(rings), shapes::fins(rings)])
        .map(|shape| mesh(device, &shape))
        .collect();
    let place = |i: usize| {
        let at = Vec3::new((i % 40) as f32 * 0.2 - 4.0, 0.5, (i / 40) as f32 * -0.2);
        Affine3A::from_translation(at) * Affine3A::from_scale(Vec3::splat(0.05))
    };
    let caster = |i: usize| Caster::new(meshes[i % meshes.len()].clone(), place(i));
    (0..count).map(caster).collect()
}

/// What a frame of these lights comes to, without a driver.
fn counted(way: Silhouettes, method: Method, lights: usize, casters: usize) -> VolumeStatistics {
    let (device, queue) = bare();
    let mut renderer = renderer(&device, way, method);
    let light = |i: usize| HomogeneousLight::point(Vec3::new(i as f32, 9.0, 0.0));
    let lights: Vec<VolumeLight> = (0..lights).map(|i| light(i).into()).collect();
    let casters = crowd(&device, casters);
    let views = [mixed(lamp()).view().into()];
    let frame = ShadowVolumeFrame {
        lights: &lights,
        views: &views,
        casters: &casters,
        ..Default::default()
    };
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    renderer.prepare(&device, &queue, &frame).unwrap();
    let mut encoder = device.create_command_encoder(&Default::default());
    renderer.encode(&mut encoder);
    queue.submit([encoder.finish()]);
    let error = pollster::block_on(scope.pop());
    assert!(error.is_none(), "{error:?}");
    renderer.statistics()
}

#[test]
fn a_thousand_casters_take_a_handful_of_draws() {
    for way in SHARING {
        // Sides, fan, and both lists of light caps, for each 256 casters.
        let draws = |method, casters| counted(way, method, 1, casters).draws;
        assert_eq!(draws(Method::ZFail, 200), 4, "{way:?}");
        assert_eq!(draws(Method::ZFail, 1_000), 4 + 4 + 4 + 2, "{way:?}");
        let auto = counted(way, Method::Auto, 1, 1_000);
        assert_eq!(auto.casters_drawn, 1_000);
        assert!(auto.draws <= 15, "{way:?}: {auto:?}");
        let of_many = counted(way, Method::Auto, 16, 1_000);
        assert!(of_many.draws <= 16 * 15, "{way:?}: {of_many:?}");
        if way == Silhouettes::Compute {
            assert_eq!((auto.dispatches, of_many.dispatches), (3, 3));
        }
    }
    // A draw for each caster and kind of faces.
    let by_vertices = counted(Silhouettes::Vertex, Method::Auto, 1, 1_000);
    assert!(by_vertices.draws >= 1_000, "{by_vertices:?}");
}

#[test]
fn a_draw_is_made_anew_only_where_a_list_was_found_anew() {
    let (device, queue) = bare();
    let mut renderer = renderer(&device, Silhouettes::Compute, Method::ZFail);
    let view = mixed(lamp()).view();
    let mesh = mesh(&device, &shapes::sphere(4));
    let mut dispatches = |x: f32, toward_light: Vec3| {
        let place = Affine3A::from_translation(Vec3::new(x, 0.5, 0.0));
        let casters = [Caster::new(mesh.clone(), place)];
        let frame = ShadowVolumeFrame {
            lights: &[HomogeneousLight::directional(toward_light).into()],
            views: &[view.into()],
            casters: &casters,
            ..Default::default()
        };
        renderer.prepare(&device, &queue, &frame).unwrap();
        let mut encoder = device.create_command_encoder(&Default::default());
        renderer.encode(&mut encoder);
        queue.submit([encoder.finish()]);
        renderer.statistics().dispatches
    };
    assert_eq!(dispatches(0.0, Vec3::Y), 3);
    // A sun finds the same silhouette wherever a caster is moved to, now or frames later.
    assert_eq!(dispatches(0.1, Vec3::Y), 0);
    assert_eq!(dispatches(0.1, Vec3::Y), 0);
    assert_eq!(dispatches(0.2, Vec3::Y), 0);
    assert_eq!(dispatches(0.2, Vec3::ONE), 3);
}

/// What the vertex way counts, whose draws have one caster each.
struct Expected<'a> {
    theatre: &'a Theatre,
    one_by_one: ShadowVolumeRenderer,
    sharing: ShadowVolumeRenderer,
}

impl<'a> Expected<'a> {
    fn new(theatre: &'a Theatre, way: Silhouettes, method: Method) -> Self {
        let device = &theatre.gpu.device;
        Self {
            one_by_one: renderer(device, Silhouettes::Vertex, method),
            sharing: renderer(device, way, method),
            theatre,
        }
    }

    fn assert_as_one_by_one(&mut self, what: &str, casters: &[Caster]) -> VolumeStatistics {
        let view = mixed(lamp()).view();
        let frame: OneLight<'_> = frame(&view, lamp(), casters);
        let (expected, single) = self.theatre.draw(&mut self.one_by_one, &frame);
        let (counts, statistics) = self.theatre.draw(&mut self.sharing, &frame);
        assert!(is_shown(&expected), "{what}");
        let differ = counts.iter().zip(&expected).filter(|(a, b)| a != b).count();
        assert_eq!(differ, 0, "{what}: pixels differ, {statistics:?}");
        assert!(statistics.draws <= single.draws, "{what}");
        statistics
    }
}

#[test]
fn casters_that_share_draws_are_counted_as_one_by_one() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    for way in SHARING {
        for method in [Method::ZFail, Method::Auto] {
            let what = |step: &str| format!("{way:?}, {method:?}, {step}");
            let mut expected = Expected::new(&theatre, way, method);
            let mut casters = theatre.casters(0..600);
            let all = expected.assert_as_one_by_one(&what("all"), &casters);
            assert!(all.draws <= 4 * 3 + 2, "{all:?}");
            // Seats become free in every draw, ...
            let left: Vec<Caster> = casters.iter().step_by(3).cloned().collect();
            expected.assert_as_one_by_one(&what("every third"), &left);
            // ... and are taken by others.
            casters.rotate_left(100);
            casters.truncate(450);
            expected.assert_as_one_by_one(&what("others come"), &casters);
            for caster in &mut casters {
                caster.world_from_object.translation.y += 0.3;
            }
            expected.assert_as_one_by_one(&what("all move"), &casters);
            let few = expected.assert_as_one_by_one(&what("five are left"), &casters[..5]);
            assert!(few.draws <= 3 * 4, "{few:?}");
            expected.assert_as_one_by_one(&what("and come again"), &casters);
        }
    }
}

/// What the merge pass writes, and what it would if it were wrong.
const TWINS: [(&str, &str); 4] = [
    // Every block is full.
    ("min(counts[place] - done, BLOCK)", "BLOCK"),
    // A caster's blocks do not follow those of the one before.
    ("block_ends[local] += before;", ""),
    // All casters are the first.
    (
        "members[merge.first_member + place].caster",
        "members[merge.first_member].caster",
    ),
    // A list begins where another ends.
    ("firsts[place] + done", "firsts[0] + done"),
];

#[test]
fn a_merge_pass_that_errs_is_seen() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    let view = mixed(lamp()).view();
    let casters = theatre.casters(0..60);
    let frame = frame(&view, lamp(), &casters);
    let right = theatre.fresh(Silhouettes::Vertex, &frame);
    assert!(theatre.fresh(Silhouettes::Compute, &frame) == right);
    for (rule, twin) in TWINS {
        rewriting::set(Some(Box::new(move |wgsl| wgsl.replace(rule, twin))));
        let wrong = theatre.fresh(Silhouettes::Compute, &frame);
        rewriting::set(None);
        assert!(wrong != right, "{rule}");
    }
}

#[test]
fn caps_of_large_meshes_are_drawn_by_themselves() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut theatre = Theatre::new(gpu);
    // 1,088 triangles, and 960.
    let [large, small] = [17, 16].map(|rings| mesh(&theatre.gpu.device, &shapes::sphere(rings)));
    for way in SHARING {
        for (mesh, draws) in [(&large, 2 + 3), (&small, 2 + 1)] {
            theatre.meshes = vec![mesh.clone()];
            let mut expected = Expected::new(&theatre, way, Method::ZFail);
            let found = expected.assert_as_one_by_one("spheres", &theatre.casters(0..3));
            assert_eq!(found.draws, draws, "{way:?}");
        }
    }
}

#[test]
fn a_list_of_another_length_in_the_same_place_is_noticed() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    for way in SHARING {
        let mut expected = Expected::new(&theatre, way, Method::ZFail);
        // One caster: whatever it is, its volume lies where the last one did.
        for number in [1, 5, 9, 13, 17, 21] {
            let mut caster = theatre.caster(number);
            caster.world_from_object.matrix3 *= 3.0;
            caster.world_from_object.translation = theatre.caster(1).world_from_object.translation;
            expected.assert_as_one_by_one(&format!("{way:?}, {number}"), &[caster]);
        }
    }
}

#[test]
fn a_draw_without_casters_is_gone() {
    let (device, queue) = bare();
    let view = mixed(lamp()).view();
    let casters = crowd(&device, 300);
    for way in SHARING {
        let mut renderer = renderer(&device, way, Method::ZFail);
        let mut draws = |casters: &[Caster]| {
            let frame = frame(&view, lamp(), casters);
            renderer.prepare_one(&device, &queue, &frame).unwrap();
            renderer.encode(&mut device.create_command_encoder(&Default::default()));
            renderer.statistics().draws
        };
        let all = draws(&casters);
        assert_eq!(draws(&[]), 0);
        let again = draws(&casters);
        assert_eq!(all, again, "{way:?}");
        assert!(draws(&casters[..2]) < all, "{way:?}");
    }
}
