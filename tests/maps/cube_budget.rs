//! The budget of faces a frame, and faces that no visible receiver needs.

use crate::common::shapes::{Random, cuboid};
use crate::cubes::{draw, draw_frame, faces, fresh};
use crate::receivers::{ask_changed, visibility};
use glam::camera::rh::{proj::directx as proj, view};
use glam::{Affine3A, Mat4, Vec3};
use host::gpu::Gpu;
use shadows::{
    Caster, CubeFace, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DepthConvention, Kernel,
    PcfDescriptor, PointLight, Radius, RandomDisk, TileState, View, VogelDisk, glam,
};

const SIZE: u32 = 32;

fn descriptor(lights: u32, max_faces_per_frame: Option<u32>) -> CubeShadowMapDescriptor<'static> {
    CubeShadowMapDescriptor {
        size: SIZE,
        lights,
        max_faces_per_frame,
        reach: Radius::Texels(2.0),
        ..Default::default()
    }
}

/// Casters all around, and lights among them that reach most.
struct Crowd {
    random: Random,
    lights: Vec<PointLight>,
    casters: Vec<Caster>,
}

impl Crowd {
    fn new(gpu: &Gpu) -> Self {
        let mesh = cuboid(Vec3::splat(0.4)).mesh(&gpu.device);
        let mut random = Random::new(21);
        let lights = [-2.0, 0.0, 2.0]
            .map(|x| PointLight::new(Vec3::new(x, 0.1, 0.2), 9.0))
            .to_vec();
        let casters = (0..40)
            .map(|_| Affine3A::from_translation(random.vec3() * 5.0))
            .map(|at| Caster::new(mesh.clone(), at))
            .collect();
        Self {
            random,
            lights,
            casters,
        }
    }

    fn move_casters(&mut self) {
        for caster in &mut self.casters {
            caster.world_from_object.translation += glam::Vec3A::from(self.random.vec3() * 0.1);
        }
    }

    fn frame(&self) -> CubeFrame<'_> {
        CubeFrame {
            lights: &self.lights,
            casters: &self.casters,
            ..Default::default()
        }
    }
}

fn oldest(map: &CubeShadowMap) -> u32 {
    (0..3)
        .flat_map(|light| CubeFace::ALL.map(|face| (light, face)))
        .filter_map(|(light, face)| map.face_statistics(light, face))
        .map(|face| face.age)
        .max()
        .unwrap_or(0)
}

/// Every light's faces against those of a map of its own.
fn differing(gpu: &Gpu, map: &CubeShadowMap, crowd: &Crowd) -> usize {
    let one = descriptor(1, None);
    let each = crowd.lights.iter().enumerate().map(|(place, light)| {
        let truth = faces(gpu, &fresh(gpu, &one, &[*light], &crowd.casters), 0);
        let ours = faces(gpu, map, place);
        ours.iter().zip(&truth).filter(|(a, b)| a != b).count()
    });
    each.sum()
}

#[test]
fn a_budget_is_kept_and_no_face_waits_longer_than_stated() {
    let Some(gpu) = Gpu::for_test() else { return };
    for budget in [1, 4, 7] {
        let mut crowd = Crowd::new(&gpu);
        let mut map = CubeShadowMap::new(&gpu.device, &descriptor(3, Some(budget))).unwrap();
        let bound = map.max_age().unwrap();
        for _ in 0..bound {
            draw_frame(&gpu, &mut map, &crowd.frame());
        }
        let mut eldest = 0;
        for _ in 0..3 * bound {
            crowd.move_casters();
            draw_frame(&gpu, &mut map, &crowd.frame());
            let s = map.statistics();
            assert_eq!(s.faces_rendered, budget, "all move, so all of it is used");
            assert_eq!(s.faces_rendered + s.faces_postponed, 18);
            eldest = oldest(&map).max(eldest);
        }
        assert!(eldest <= bound, "{eldest} over {bound}, budget {budget}");
        assert!(2 * eldest > bound, "{eldest}: the bound says nothing");
        // The broken twin of what follows: now most faces still show the past.
        assert!(differing(&gpu, &map, &crowd) > 0);
        for _ in 0..bound {
            draw_frame(&gpu, &mut map, &crowd.frame());
        }
        assert_eq!(differing(&gpu, &map, &crowd), 0);
        assert_eq!(map.statistics().faces_postponed, 0);
    }
}

#[test]
fn a_pinned_light_never_waits() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut crowd = Crowd::new(&gpu);
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor(3, Some(2))).unwrap();
    for _ in 0..20 {
        crowd.move_casters();
        let frame = CubeFrame {
            pinned: &[1],
            ..crowd.frame()
        };
        draw_frame(&gpu, &mut map, &frame);
        let age = |face| map.face_statistics(1, face).unwrap().age;
        assert!(CubeFace::ALL.into_iter().all(|face| age(face) == 0));
    }
    assert!(oldest(&map) > 0, "the others wait");
    assert_eq!(map.statistics().faces_rendered, 6 + 2);
}

#[test]
fn what_changed_most_and_matters_most_to_the_eye_goes_first() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mesh = cuboid(Vec3::splat(0.3)).mesh(&gpu.device);
    let at = |place: Vec3| Caster::new(mesh.clone(), Affine3A::from_translation(place));
    let lights = [-20.0, 20.0].map(|x| PointLight::new(Vec3::X * x, 9.0));
    // Before each light a caster that takes much of a face, on +Y, and one that takes little, on +Z.
    let mut casters: Vec<Caster> = lights
        .iter()
        .flat_map(|light| [Vec3::Y * 2.0, Vec3::Z * 7.0].map(|from| light.position + from))
        .map(at)
        .collect();
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor(2, Some(1))).unwrap();
    let waits = map.max_age().unwrap();
    let mut frame = |casters: &[Caster], eye: Vec3| {
        let view = camera(eye, Vec3::ZERO).1;
        let frame = CubeFrame {
            lights: &lights,
            casters,
            view: Some(&view),
            ..Default::default()
        };
        draw_frame(&gpu, &mut map, &frame);
        let state = |light, face| map.face_statistics(light, face).unwrap().state;
        let faces = [CubeFace::PositiveY, CubeFace::PositiveZ];
        let rendered = |light| faces.map(|face| state(light, face) == TileState::Rendered);
        [rendered(0), rendered(1)]
    };
    // Far away from both, so that all of it is in view, once nearer to the one, once to the other.
    let eyes = [-1.0, 1.0].map(|side| Vec3::new(side * 45.0, 3.0, 60.0));
    for (light, eye) in eyes.into_iter().enumerate() {
        for _ in 0..2 * waits {
            frame(&casters, eye);
        }
        for caster in &mut casters {
            caster.world_from_object.translation.x += 0.01;
        }
        let mut order = [[false; 2]; 2];
        order[light] = [true, false];
        assert_eq!(frame(&casters, eye), order, "near the eye, and large");
    }
}

/// Where the light of a map's faces is, read off their matrix.
fn shown(map: &CubeShadowMap, light: usize) -> Vec3 {
    let matrix = map.clip_from_world(light, CubeFace::PositiveZ).unwrap();
    -Vec3::new(matrix.w_axis.x, matrix.w_axis.y, matrix.w_axis.w)
}

#[test]
fn a_light_that_waits_stays_where_its_faces_were_drawn() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut crowd = Crowd::new(&gpu);
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor(3, Some(2))).unwrap();
    let points: Vec<(Vec3, Vec3)> = (0..500)
        .map(|_| (crowd.random.vec3() * 4.0, crowd.random.vec3()))
        .collect();
    let mut waited = 0;
    for frame in 0..24 {
        for light in &mut crowd.lights {
            light.position.x += 0.05;
        }
        draw(&gpu, &mut map, &crowd.lights, &crowd.casters);
        if frame < 3 {
            continue; // new lights are dark until their first turn
        }
        let at = shown(&map, 0);
        waited += usize::from(at.distance(crowd.lights[0].position) > 0.01);
        let light = PointLight {
            position: at,
            ..crowd.lights[0]
        };
        let truth = fresh(&gpu, &descriptor(1, None), &[light], &crowd.casters);
        let seen = |map| visibility(&gpu, map, Kernel::Bilinear, &points);
        assert_eq!(seen(&map), seen(&truth), "frame {frame}");
    }
    assert!(waited > 5, "{waited}");
}

#[test]
fn new_lights_are_dark_until_their_turn() {
    let Some(gpu) = Gpu::for_test() else { return };
    let crowd = Crowd::new(&gpu);
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor(3, Some(1))).unwrap();
    draw(&gpu, &mut map, &crowd.lights, &crowd.casters);
    let dark = (0..3)
        .filter(|&place| {
            let sampler = shadows::PcfDescriptor::default();
            let at = [(crowd.lights[place].position, Vec3::Y)];
            crate::receivers::ask(&gpu, &map, &sampler, place, &at) == [0.0]
        })
        .count();
    assert_eq!(dark, 2);
}

fn camera(eye: Vec3, target: Vec3) -> (Mat4, View) {
    let projection = proj::perspective_infinite_reverse(1.5, 1.05, 0.1);
    let up = match (target - eye).normalize().abs().y {
        1.0 => Vec3::X,
        _ => Vec3::Y,
    };
    let matrix = projection * view::look_at_mat4(eye, target, up);
    (
        matrix,
        View::new(matrix, DepthConvention::InfiniteReverse).unwrap(),
    )
}

#[test]
fn faces_without_visible_receivers_wait_and_are_not_forgotten() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut crowd = Crowd::new(&gpu);
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor(3, None)).unwrap();
    let away = camera(Vec3::X * 20.0, Vec3::X * 30.0).1;
    let toward = camera(Vec3::X * 20.0, Vec3::ZERO).1;
    let mut frame = |crowd: &Crowd, view| {
        let frame = CubeFrame {
            view: Some(view),
            ..crowd.frame()
        };
        draw_frame(&gpu, &mut map, &frame);
        map.statistics()
    };
    assert_eq!(frame(&crowd, &away).faces_rendered, 0);
    assert_eq!(frame(&crowd, &toward).faces_rendered, 18);
    crowd.move_casters();
    for _ in 0..3 {
        let s = frame(&crowd, &away);
        assert_eq!((s.faces_rendered, s.faces_hidden), (0, 18));
    }
    assert_eq!(frame(&crowd, &toward).faces_rendered, 18);
    // So do faces that only have to be cleared.
    let all = std::mem::take(&mut crowd.casters);
    let s = frame(&crowd, &away);
    assert_eq!((s.faces_hidden, s.faces_empty), (18, 0));
    let s = frame(&crowd, &toward);
    assert_eq!((s.faces_rendered, s.faces_empty), (18, 0));
    let s = frame(&crowd, &away);
    assert_eq!((s.faces_hidden, s.faces_empty), (0, 18), "clear now");
    crowd.casters = all;
    frame(&crowd, &toward);
    assert_eq!(differing(&gpu, &map, &crowd), 0);
}

#[test]
fn faces_of_where_a_light_was_do_not_wait_once_they_show() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut crowd = Crowd::new(&gpu);
    crowd.lights.truncate(1);
    let budget = CubeShadowMapDescriptor {
        size: 64,
        reach: Radius::Texels(0.1),
        ..descriptor(1, Some(1))
    };
    let mut map = CubeShadowMap::new(&gpu.device, &budget).unwrap();
    let mut frame = |crowd: &Crowd, eye: Vec3, target: Vec3| {
        let frame = CubeFrame {
            view: Some(&camera(eye, target).1),
            ..crowd.frame()
        };
        draw_frame(&gpu, &mut map, &frame);
        let s = map.statistics();
        let truth = fresh(&gpu, &budget, &crowd.lights, &crowd.casters);
        let same = faces(&gpu, &map, 0) == faces(&gpu, &truth, 0);
        ([s.faces_rendered, s.faces_hidden, s.faces_postponed], same)
    };
    let light = crowd.lights[0].position;
    frame(&crowd, light + Vec3::X * 20.0, light);
    crowd.lights[0].position.x += 0.5;
    let light = crowd.lights[0].position;
    assert_eq!(frame(&crowd, light, light + Vec3::X), ([1, 5, 0], false));
    // Now receivers are told where it is: no other face may show where it was.
    let all = light + Vec3::X * 20.0;
    assert_eq!(frame(&crowd, all, light), ([5, 0, 0], true));
    // Faces on which only casters moved keep to the budget.
    crowd.move_casters();
    assert_eq!(frame(&crowd, all, light), ([1, 0, 5], false));
}

#[test]
fn what_a_view_shows_is_the_same_with_and_without_hidden_faces() {
    let Some(gpu) = Gpu::for_test() else { return };
    let wide = Kernel::RandomDisk(RandomDisk {
        radius: Radius::Texels(40.0),
        ..Default::default()
    });
    let world = Kernel::Vogel(VogelDisk {
        radius: Radius::World(0.5),
        ..Default::default()
    });
    let contact = Kernel::ContactHardening(Default::default());
    for (size, kernel) in [
        (32, Kernel::FourTaps),
        (256, contact),
        (512, wide),
        (256, world),
    ] {
        let seen = Seen::by(&gpu, kernel, size, &|module| module);
        assert!(seen.hidden > 20, "{} faces hidden, {kernel:?}", seen.hidden);
        assert_eq!(seen.unlike_inside, 0, "{kernel:?}");
        // The broken twins: receivers that the view does not show, and kernels wider than told, which
        // samplers refuse: shaders that are.
        assert!(seen.unlike_outside > 5, "{}", seen.unlike_outside);
        if kernel != Kernel::FourTaps {
            let narrow = Seen::by(&gpu, narrowed(kernel), size, &|module| {
                let told = "kernel.radius_world + kernel.radius_texels * receiver.width";
                assert!(module.contains(told));
                let wide = match kernel.radius() {
                    Radius::Texels(width) => format!("f32({width}) * receiver.width"),
                    Radius::World(width) => format!("f32({width})"),
                    _ => unreachable!("a unit that these tests do not ask for"),
                };
                module.replace(told, &wide)
            });
            assert!(narrow.unlike_inside > 0, "{kernel:?}");
        }
    }
}

/// The same kernel, but hardly wide at all.
fn narrowed(mut kernel: Kernel) -> Kernel {
    *match &mut kernel {
        Kernel::RandomDisk(disk) => &mut disk.radius,
        Kernel::Vogel(disk) => &mut disk.radius,
        Kernel::ContactHardening(contact) => &mut contact.max_radius,
        _ => unreachable!("disks only"),
    } = Radius::Texels(0.01);
    kernel
}

/// Along the axes.
const DIRECTIONS: [Vec3; 6] = [
    Vec3::X,
    Vec3::NEG_X,
    Vec3::Y,
    Vec3::NEG_Y,
    Vec3::Z,
    Vec3::NEG_Z,
];

/// How a map that puts off hidden faces compares with one that does not, in some frames.
#[derive(Debug, Default)]
struct Seen {
    hidden: u32,
    /// Frames in which receivers that the view shows, and others, are not the same.
    unlike_inside: usize,
    unlike_outside: usize,
}

impl Seen {
    fn by(gpu: &Gpu, kernel: Kernel, size: u32, change: &dyn Fn(String) -> String) -> Self {
        let mut crowd = Crowd::new(gpu);
        let one = CubeShadowMapDescriptor {
            size,
            reach: kernel.radius(),
            ..descriptor(1, None)
        };
        let mut map = CubeShadowMap::new(&gpu.device, &one).unwrap();
        let mut seen = Self::default();
        for frame in 0..30 {
            crowd.move_casters();
            crowd.lights[0].position.y += if frame % 4 == 0 { 0.1 } else { 0.0 };
            // Anywhere, or where the view shows nearly all of a face and nothing of the others.
            let (eye, toward) = match frame % 2 {
                0 => (crowd.random.vec3() * 9.0, crowd.random.vec3()),
                _ => (crowd.lights[0].position, DIRECTIONS[frame / 2 % 6]),
            };
            let (matrix, view) = camera(eye, eye + toward);
            let truth = fresh(gpu, &one, &crowd.lights[..1], &crowd.casters);
            let frame = CubeFrame {
                lights: &crowd.lights[..1],
                casters: &crowd.casters,
                view: Some(&view),
                ..Default::default()
            };
            draw_frame(gpu, &mut map, &frame);
            seen.hidden += map.statistics().faces_hidden;
            let points: Vec<(Vec3, Vec3)> = (0..2000)
                .map(|_| (crowd.random.vec3() * 8.0, crowd.random.vec3()))
                .collect();
            let (inside, outside): (Vec<_>, Vec<_>) = points.into_iter().partition(|(point, _)| {
                let clip = matrix * point.extend(1.0);
                clip.x.abs() < clip.w && clip.y.abs() < clip.w && clip.w > 0.1
            });
            let unlike = |points: &[_]| {
                let reader = PcfDescriptor {
                    kernel,
                    ..Default::default()
                };
                let of =
                    |map: &CubeShadowMap| ask_changed(gpu, map.into(), &reader, 0, points, change);
                usize::from(!points.is_empty() && of(&map) != of(&truth))
            };
            seen.unlike_inside += unlike(&inside);
            seen.unlike_outside += unlike(&outside);
        }
        seen
    }
}
