//! The budget of tiles a frame, and tiles that no visible receiver needs.

use crate::atlas::{assert_few, atlas, draw, wrong_texels};
use crate::common::shapes::{Random, cuboid};
use crate::receivers::{ask, ask_changed};
use glam::camera::rh::{proj::directx as proj, view};
use glam::{Affine3A, Mat4, Vec3};
use host::gpu::Gpu;
use shadows::{
    AtlasFrame, AtlasLight, AtlasTile, AtlasView, Caster, CubeFace, DepthConvention, Kernel,
    MapKind, MapSettings, PcfDescriptor, PointLight, Radius, RandomDisk, ShadowAtlas,
    ShadowAtlasDescriptor, TileSize, TileState, View, VogelDisk, glam,
};

const SIZE: u32 = 32;

fn descriptor(max_tiles_per_frame: Option<u32>) -> ShadowAtlasDescriptor<'static> {
    ShadowAtlasDescriptor {
        max_tiles_per_frame,
        settings: MapSettings {
            reach: Radius::Texels(2.0),
            ..Default::default()
        },
        ..crate::atlas::descriptor(8)
    }
}

fn lit(light: PointLight, size: u32) -> AtlasLight {
    AtlasLight::new(light).with_size(TileSize::Fixed(size))
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

    /// The lights, each with tiles of so many texels.
    fn lit(&self, size: u32) -> Vec<AtlasLight> {
        self.lights.iter().map(|&light| lit(light, size)).collect()
    }

    /// A frame of them, drawn.
    fn draw(&self, gpu: &Gpu, atlas: &mut ShadowAtlas, size: u32, view: Option<&View>) {
        let lights = self.lit(size);
        let views: Vec<_> = view
            .into_iter()
            .map(|view| AtlasView::new(view, 300, 300))
            .collect();
        let frame = AtlasFrame {
            lights: &lights,
            casters: &self.casters,
            views: &views,
            ..Default::default()
        };
        draw(gpu, atlas, &frame);
    }

    /// How many texels are not those of the lights' own maps.
    fn wrong(&self, gpu: &Gpu, atlas: &ShadowAtlas) -> (usize, usize) {
        wrong_texels(gpu, atlas, &self.lit(SIZE), &self.casters)
    }
}

fn tile(atlas: &ShadowAtlas, light: usize, face: CubeFace) -> AtlasTile {
    atlas.tiles(light, 0)[face.layer() as usize]
}

fn oldest(atlas: &ShadowAtlas) -> u32 {
    let tiles = (0..3).flat_map(|light| atlas.tiles(light, 0));
    tiles.map(|tile| tile.statistics.age).max().unwrap_or(0)
}

/// What is seen of a light at some points.
fn seen(gpu: &Gpu, atlas: &ShadowAtlas, light: usize, points: &[(Vec3, Vec3)]) -> Vec<f32> {
    let reader = PcfDescriptor {
        map: MapKind::ATLAS,
        ..Default::default()
    };
    ask(gpu, atlas, &reader, light, points)
}

#[test]
fn a_budget_is_kept_and_no_tile_waits_longer_than_stated() {
    let Some(gpu) = Gpu::for_test() else { return };
    for budget in [1, 4, 7] {
        let mut crowd = Crowd::new(&gpu);
        let mut atlas = atlas(&gpu, &descriptor(Some(budget)));
        crowd.draw(&gpu, &mut atlas, SIZE, None);
        let bound = atlas.max_age().unwrap();
        for _ in 0..bound {
            crowd.draw(&gpu, &mut atlas, SIZE, None);
        }
        let mut eldest = 0;
        for _ in 0..3 * bound {
            crowd.move_casters();
            crowd.draw(&gpu, &mut atlas, SIZE, None);
            let s = atlas.statistics();
            assert_eq!(s.tiles_rendered, budget, "all move, so all of it is used");
            assert_eq!(s.tiles_rendered + s.tiles_postponed, 18);
            eldest = oldest(&atlas).max(eldest);
        }
        assert!(eldest <= bound, "{eldest} over {bound}, budget {budget}");
        assert!(2 * eldest > bound, "{eldest}: the bound says nothing");
        // The broken twin of what follows: most tiles show the past.
        assert!(crowd.wrong(&gpu, &atlas).0 > 100);
        for _ in 0..bound {
            crowd.draw(&gpu, &mut atlas, SIZE, None);
        }
        assert_few(crowd.wrong(&gpu, &atlas), "once all had their turn");
        assert_eq!(atlas.statistics().tiles_postponed, 0);
    }
}

#[test]
fn a_pinned_light_never_waits() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut crowd = Crowd::new(&gpu);
    let mut atlas = atlas(&gpu, &descriptor(Some(2)));
    for _ in 0..20 {
        crowd.move_casters();
        let mut lights = crowd.lit(SIZE);
        lights[1] = lights[1].pinned();
        let frame = AtlasFrame {
            lights: &lights,
            casters: &crowd.casters,
            ..Default::default()
        };
        draw(&gpu, &mut atlas, &frame);
        let pinned = atlas.tiles(1, 0);
        assert!(pinned.iter().all(|tile| tile.statistics.age == 0));
    }
    assert!(oldest(&atlas) > 0, "the others wait");
    assert_eq!(atlas.statistics().tiles_rendered, 6 + 2);
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
    let mut atlas = atlas(&gpu, &descriptor(Some(1)));
    let lights = lights.map(|light| lit(light, SIZE));
    let waits = 24; // 12 tiles, half a tile of the budget each
    let mut frame = |casters: &[Caster], eye: Vec3| {
        let view = camera(eye, Vec3::ZERO).1;
        let frame = AtlasFrame {
            lights: &lights,
            casters,
            views: &[AtlasView::new(&view, 300, 300)],
            ..Default::default()
        };
        draw(&gpu, &mut atlas, &frame);
        let state = |light, face| tile(&atlas, light, face).statistics.state;
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

/// Where the light of a tile is, read off its matrix.
fn shown(atlas: &ShadowAtlas, light: usize) -> Vec3 {
    let matrix = tile(atlas, light, CubeFace::PositiveZ).clip_from_world;
    -Vec3::new(matrix.w_axis.x, matrix.w_axis.y, matrix.w_axis.w)
}

#[test]
fn a_light_that_waits_stays_where_its_tiles_were_drawn() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut crowd = Crowd::new(&gpu);
    let mut map = atlas(&gpu, &descriptor(Some(2)));
    let points: Vec<(Vec3, Vec3)> = (0..500)
        .map(|_| (crowd.random.vec3() * 4.0, crowd.random.vec3()))
        .collect();
    let mut waited = 0;
    for frame in 0..24 {
        for light in &mut crowd.lights {
            light.position.x += 0.05;
        }
        crowd.draw(&gpu, &mut map, SIZE, None);
        if frame < 3 {
            continue; // new lights are dark until their first turn
        }
        // All of them where they are shown, so that tiles lie in the same places.
        let mut past = Crowd::new(&gpu);
        for (light, past) in past.lights.iter_mut().enumerate() {
            past.position = shown(&map, light);
        }
        waited += usize::from(past.lights[0].position.distance(crowd.lights[0].position) > 0.01);
        let mut truth = atlas(&gpu, &descriptor(None));
        past.draw(&gpu, &mut truth, SIZE, None);
        let of = |map| seen(&gpu, map, 0, &points);
        assert_eq!(of(&map), of(&truth), "frame {frame}");
    }
    assert!(waited > 5, "{waited}");
}

#[test]
fn new_lights_are_dark_until_their_turn() {
    let Some(gpu) = Gpu::for_test() else { return };
    let crowd = Crowd::new(&gpu);
    let mut map = atlas(&gpu, &descriptor(Some(1)));
    crowd.draw(&gpu, &mut map, SIZE, None);
    let is_dark = |place: &usize| {
        let at = [(crowd.lights[*place].position, Vec3::Y)];
        seen(&gpu, &map, *place, &at) == [0.0]
    };
    assert_eq!((0..3).filter(is_dark).count(), 2);
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
fn tiles_without_visible_receivers_wait_and_are_not_forgotten() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut crowd = Crowd::new(&gpu);
    let mut atlas = atlas(&gpu, &descriptor(None));
    let away = camera(Vec3::X * 20.0, Vec3::X * 30.0).1;
    let toward = camera(Vec3::X * 20.0, Vec3::ZERO).1;
    let mut frame = |crowd: &Crowd, view| {
        crowd.draw(&gpu, &mut atlas, SIZE, Some(view));
        let s = atlas.statistics();
        (s.tiles_rendered, s.tiles_hidden, s.tiles_empty)
    };
    assert_eq!(frame(&crowd, &away).0, 0);
    assert_eq!(frame(&crowd, &toward).0, 18);
    crowd.move_casters();
    for _ in 0..3 {
        assert_eq!(frame(&crowd, &away), (0, 18, 0));
    }
    assert_eq!(frame(&crowd, &toward).0, 18);
    // So do tiles that only have to be cleared.
    let all = std::mem::take(&mut crowd.casters);
    assert_eq!(frame(&crowd, &away), (0, 18, 0));
    assert_eq!(frame(&crowd, &toward), (18, 0, 0));
    assert_eq!(frame(&crowd, &away), (0, 0, 18), "they are clear");
    crowd.casters = all;
    frame(&crowd, &toward);
    assert_few(crowd.wrong(&gpu, &atlas), "back again");
}

#[test]
fn tiles_of_where_a_light_was_do_not_wait_once_they_show() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut crowd = Crowd::new(&gpu);
    crowd.lights.truncate(1);
    let budget = ShadowAtlasDescriptor {
        settings: MapSettings {
            reach: Radius::Texels(0.1),
            ..Default::default()
        },
        ..descriptor(Some(1))
    };
    let mut map = atlas(&gpu, &budget);
    let mut frame = |crowd: &Crowd, eye: Vec3, target: Vec3| {
        crowd.draw(&gpu, &mut map, SIZE, Some(&camera(eye, target).1));
        let s = map.statistics();
        let (wrong, _) = crowd.wrong(&gpu, &map);
        (
            [s.tiles_rendered, s.tiles_hidden, s.tiles_postponed],
            wrong < 5,
        )
    };
    let light = crowd.lights[0].position;
    frame(&crowd, light + Vec3::X * 20.0, light);
    for _ in 0..12 {
        frame(&crowd, light + Vec3::X * 20.0, light);
    }
    crowd.lights[0].position.x += 0.5;
    let light = crowd.lights[0].position;
    assert_eq!(frame(&crowd, light, light + Vec3::X), ([1, 5, 0], false));
    // Receivers are told where it is: no other tile may show where it was.
    let all = light + Vec3::X * 20.0;
    assert_eq!(frame(&crowd, all, light), ([5, 0, 0], true));
    // Tiles on which only casters moved keep to the budget.
    crowd.move_casters();
    assert_eq!(frame(&crowd, all, light), ([1, 0, 5], false));
}

#[test]
fn what_a_view_shows_is_the_same_with_and_without_hidden_tiles() {
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
        assert!(seen.hidden > 20, "{} tiles hidden, {kernel:?}", seen.hidden);
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

/// How an atlas that puts off hidden tiles compares with one that does not, in some frames.
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
        crowd.lights.truncate(1);
        let one = ShadowAtlasDescriptor {
            settings: MapSettings {
                reach: kernel.radius(),
                ..Default::default()
            },
            ..descriptor(None)
        };
        let mut map = atlas(gpu, &one);
        let mut seen = Self::default();
        for frame in 0..30 {
            crowd.move_casters();
            crowd.lights[0].position.y += if frame % 4 == 0 { 0.1 } else { 0.0 };
            // Anywhere, or where the view shows nearly all of a tile and nothing of the others.
            let (eye, toward) = match frame % 2 {
                0 => (crowd.random.vec3() * 9.0, crowd.random.vec3()),
                _ => (crowd.lights[0].position, DIRECTIONS[frame / 2 % 6]),
            };
            let (matrix, view) = camera(eye, eye + toward);
            let mut truth = atlas(gpu, &one);
            crowd.draw(gpu, &mut truth, size, None);
            crowd.draw(gpu, &mut map, size, Some(&view));
            seen.hidden += map.statistics().tiles_hidden;
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
                    map: MapKind::ATLAS,
                    ..Default::default()
                };
                let of =
                    |map: &ShadowAtlas| ask_changed(gpu, map.into(), &reader, 0, points, change);
                usize::from(!points.is_empty() && of(&map) != of(&truth))
            };
            seen.unlike_inside += unlike(&inside);
            seen.unlike_outside += unlike(&outside);
        }
        seen
    }
}
