//! Cascades as fixed points see them while the camera turns and walks.

use crate::common::shapes::{Random, cuboid};
use crate::receivers::Questions;
use glam::camera::rh::{proj::directx as proj, view as camera};
use glam::{Affine3A, DVec4, Vec3};
use host::gpu::Gpu;
use shadows::{
    AtlasFrame, AtlasLight, AtlasTile, AtlasView, CascadeFit, CascadeSplit, Cascades, Caster,
    DepthConvention, DirectionalLight, Kernel, MapKind, PcfDescriptor, PcfSampler, ShadowAtlas,
    ShadowAtlasDescriptor, TileSize, View, glam,
};

pub const TOWARD: Vec3 = Vec3::new(1.0, 1.3, 0.4);
pub const HALF: Vec3 = Vec3::new(0.5, 1.0, 0.4);

/// Level ground at height 0 with posts all over it.
pub struct Field {
    pub casters: Vec<Caster>,
    pub posts: Vec<Vec3>,
}

impl Field {
    pub fn new(gpu: &Gpu) -> Self {
        let mut random = Random::new(3);
        let mut posts = Vec::new();
        for (x, z) in (-16..16).flat_map(|x| (-16..16).map(move |z| (x, z))) {
            let mut aside = || 1.5 * random.next();
            posts.push(Vec3::new(
                5.0 * x as f32 + aside(),
                HALF.y,
                5.0 * z as f32 + aside(),
            ));
        }
        let post = cuboid(HALF).mesh(&gpu.device);
        let ground = cuboid(Vec3::new(100.0, 0.5, 100.0)).mesh(&gpu.device);
        let at = Affine3A::from_translation;
        let mut casters = vec![Caster::new(ground, at(-0.5 * Vec3::Y))];
        casters.extend(
            posts
                .iter()
                .map(|&place| Caster::new(post.clone(), at(place))),
        );
        Self { casters, posts }
    }

    /// Points on the ground, evenly, and those of no post.
    pub fn points(&self, count: usize, middle: Vec3, half: f32) -> Vec<(Vec3, Vec3)> {
        let mut random = Random::new(7);
        let mut points = Vec::new();
        while points.len() < count {
            let point = middle + half * Vec3::new(random.next(), 0.0, random.next());
            let below = |post: &Vec3| (point - *post).abs().cmple(HALF * 1.01).all();
            if !self.posts.iter().any(below) {
                points.push((point, Vec3::Y));
            }
        }
        points
    }
}

/// From a height of 1.7, with shadows from `near` on.
pub fn view(near: f32, eye: Vec3, along: Vec3) -> View {
    let projection = proj::perspective_infinite_reverse(1.0, 1.6, near);
    let camera = camera::look_to_mat4(eye, along, Vec3::Y);
    View::new(projection * camera, DepthConvention::InfiniteReverse).unwrap()
}

pub fn sun(cascades: Cascades, size: u32) -> [AtlasLight; 1] {
    let sun = DirectionalLight::new(TOWARD);
    [AtlasLight::directional(sun, cascades).with_size(TileSize::Fixed(size))]
}

/// An atlas with one sun, and what reads it.
pub struct Sun {
    pub atlas: ShadowAtlas,
    sampler: PcfSampler,
    descriptor: PcfDescriptor<'static>,
}

impl Sun {
    pub fn new(gpu: &Gpu, kernel: Kernel) -> Self {
        let descriptor = PcfDescriptor {
            kernel,
            map: MapKind::ATLAS,
            ..Default::default()
        };
        let made = ShadowAtlasDescriptor {
            layer_size: 1024,
            ..Default::default()
        };
        Self {
            atlas: ShadowAtlas::new(&gpu.device, &made).unwrap(),
            sampler: PcfSampler::new(&gpu.device, &gpu.queue, &descriptor).unwrap(),
            descriptor,
        }
    }

    pub fn draw(&mut self, gpu: &Gpu, lights: &[AtlasLight], view: &View, casters: &[Caster]) {
        let frame = AtlasFrame {
            lights,
            casters,
            views: &[AtlasView::new(view, 300, 200)],
            receivers: None,
        };
        self.atlas.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        gpu.run(|encoder| self.atlas.encode(encoder));
    }

    fn questions(&self, gpu: &Gpu, points: &[(Vec3, Vec3)]) -> Questions {
        self.changed_questions(gpu, points, |module| module)
    }

    /// With the sampler's module changed, for what must fail.
    pub fn changed_questions(
        &self,
        gpu: &Gpu,
        points: &[(Vec3, Vec3)],
        change: fn(String) -> String,
    ) -> Questions {
        Questions::new(gpu, &self.sampler, &self.descriptor, 0, points, change)
    }

    pub fn ask(&self, gpu: &Gpu, questions: &Questions) -> Vec<f32> {
        let group = self.sampler.bind_group(&gpu.device, &self.atlas).unwrap();
        questions.ask(gpu, &group)
    }
}

/// How many texels a point is inside a tile's border.
pub fn inside(tile: &AtlasTile, point: Vec3) -> f64 {
    let clip = tile.clip_from_world.as_dmat4() * DVec4::from((point.as_dvec3(), 1.0));
    0.5 * f64::from(tile.size) * (1.0 - clip.x.abs().max(clip.y.abs()))
}

/// What became of fixed points from one frame to the next.
#[derive(Clone, Copy, Debug, Default)]
struct Flips {
    /// Points and steps.
    all: usize,
    /// Points that read another cascade than before.
    changed: usize,
    /// Of those, and of the others, how many went from light to shadow or back.
    of_changed: usize,
    of_same: usize,
}

/// Along a path of eyes and directions, for the hardest of kernels.
fn flips(gpu: &Gpu, field: &Field, cascades: Cascades, path: &[(Vec3, Vec3)]) -> Flips {
    let points = field.points(4000, 4.0 * Vec3::X, 24.0);
    let lights = sun(cascades, 256);
    let mut sun_of = Sun::new(gpu, Kernel::Hard);
    let questions = sun_of.questions(gpu, &points);
    let mut last: Option<Vec<(usize, bool)>> = None;
    let mut flips = Flips::default();
    for &(eye, along) in path {
        sun_of.draw(gpu, &lights, &view(1.0, eye, along), &field.casters);
        let said = sun_of.ask(gpu, &questions);
        let tiles = sun_of.atlas.tiles(0, 0);
        // As the shader chooses, but for points that lie within rounding of a border.
        let cascade = |point: Vec3| {
            let mut at = tiles.iter().position(|tile| inside(tile, point) > 1.5);
            if tiles
                .iter()
                .any(|tile| (inside(tile, point) - 1.5).abs() < 1e-2)
            {
                at = None;
            }
            at.unwrap_or(usize::MAX)
        };
        let now: Vec<(usize, bool)> = points
            .iter()
            .zip(said)
            .map(|((point, _), said)| (cascade(*point), said >= 0.5))
            .collect();
        for (now, before) in now.iter().zip(last.iter().flatten()) {
            let flipped = usize::from(now.1 != before.1);
            flips.all += 1;
            match now.0 == before.0 && now.0 != usize::MAX {
                true => flips.of_same += flipped,
                false => {
                    flips.changed += 1;
                    flips.of_changed += flipped;
                }
            }
        }
        last = Some(now);
    }
    flips
}

/// 4, 16 and 64 away.
fn fitted(fit: CascadeFit, margin: f32) -> Cascades {
    Cascades {
        count: 3,
        split: CascadeSplit::Practical { lambda: 1.0 },
        distance: 64.0,
        blend: 0.0,
        fit,
        margin,
    }
}

pub const EYE: Vec3 = Vec3::new(-4.0, 1.7, 0.3);

fn around(step: u32) -> Vec3 {
    let angle = std::f32::consts::TAU * step as f32 / 64.0;
    Vec3::new(angle.cos(), 0.3 * (2.0 * angle).sin() - 0.2, angle.sin()).normalize()
}

#[test]
fn a_camera_that_turns_in_place_flips_no_point() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = Field::new(&gpu);
    let turn: Vec<_> = (0..65).map(|step| (EYE, around(step))).collect();
    for margin in [0.0, 1.0 / 32.0] {
        let found = flips(&gpu, &field, fitted(CascadeFit::Stable, margin), &turn);
        assert_eq!((found.of_same, found.of_changed), (0, 0), "{found:?}");
        assert!(found.all > 200_000);
    }
    // The broken twin: a fit that turns with what is seen.
    let found = flips(&gpu, &field, fitted(CascadeFit::Tight, 0.0), &turn);
    assert!(found.of_same > 50 && found.of_changed > 300, "{found:?}");
}

#[test]
fn a_camera_that_walks_flips_only_points_that_read_another_cascade() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = Field::new(&gpu);
    let step = Vec3::new(0.23, 0.0, 0.07);
    let walk: Vec<_> = (0..65)
        .map(|i| (EYE + step * i as f32, around(i / 4)))
        .collect();
    for margin in [0.0, 1.0 / 32.0] {
        let found = flips(&gpu, &field, fitted(CascadeFit::Stable, margin), &walk);
        assert_eq!(found.of_same, 0, "{found:?}");
        // Some do, or there would be nothing to see; each was wrong in one cascade or the other.
        let share = found.of_changed as f64 / found.all as f64;
        assert!(share > 0.0 && share < 4e-4, "{found:?}");
    }
    // The broken twin: a fit whose size changes.
    let found = flips(&gpu, &field, fitted(CascadeFit::Tight, 0.0), &walk);
    assert!(found.of_same > 30, "{found:?}");
}
