//! How often the cascades of a directional light are drawn.

use crate::atlas::{atlas, descriptor, draw, room};
use crate::common::shapes::sphere;
use glam::camera::rh::{proj::directx as proj, view};
use glam::{Affine3A, Mat4, Vec3};
use host::gpu::Gpu;
use shadows::{
    AtlasFrame, AtlasLight, AtlasView, CascadeFit, Cascades, Caster, DepthConvention,
    DirectionalLight, ShadowAtlas, ShadowAtlasDescriptor, TileSize, TileState, View, glam,
};

const CASCADES: usize = 4;

fn sun(cascades: Cascades) -> [AtlasLight; 1] {
    let sun = DirectionalLight::new(Vec3::new(0.4, 1.0, 0.3));
    [AtlasLight::directional(sun, cascades).with_size(TileSize::Fixed(128))]
}

fn camera(eye: Vec3, along: Vec3) -> View {
    let projection = proj::perspective_infinite_reverse(1.2, 1.5, 0.1);
    let camera: Mat4 = view::look_to_mat4(eye, along.normalize(), Vec3::Y);
    View::new(projection * camera, DepthConvention::InfiniteReverse).unwrap()
}

/// Draws a frame; which cascades were drawn.
fn drawn(
    gpu: &Gpu,
    atlas: &mut ShadowAtlas,
    (lights, view, casters): (&[AtlasLight], &View, &[Caster]),
) -> [usize; CASCADES] {
    let frame = AtlasFrame {
        lights,
        casters,
        views: &[AtlasView::new(view, 300, 200)],
        receivers: None,
    };
    draw(gpu, atlas, &frame);
    let tiles = atlas.tiles(0, 0);
    std::array::from_fn(|cascade| {
        usize::from(tiles[cascade].statistics.state == TileState::Rendered)
    })
}

fn add(sum: &mut [usize; CASCADES], drawn: [usize; CASCADES]) {
    for (sum, drawn) in sum.iter_mut().zip(drawn) {
        *sum += drawn;
    }
}

/// Casters all around, so that each cascade has some whose light goes by distance alone.
fn wide(gpu: &Gpu) -> Vec<Caster> {
    let mut casters = room(gpu);
    let ball = sphere(12, 8).mesh(&gpu.device);
    let corner = |x, z| Affine3A::from_translation(Vec3::new(x, 0.0, z));
    for (x, z) in [(-300.0, -300.0), (300.0, 300.0)] {
        casters.push(Caster::new(ball.clone(), corner(x, z)));
    }
    casters
}

#[test]
fn a_budget_goes_to_near_cascades_first_and_no_far_one_waits_too_long() {
    let Some(gpu) = Gpu::for_test() else { return };
    let lights = sun(Cascades::default());
    let view = camera(Vec3::new(0.5, 1.0, 0.2), Vec3::X);
    let drawn_of = |budget| {
        let mut atlas = atlas(
            &gpu,
            &ShadowAtlasDescriptor {
                max_tiles_per_frame: budget,
                ..descriptor(4)
            },
        );
        let mut casters = wide(&gpu);
        drawn(&gpu, &mut atlas, (&lights, &view, &casters));
        let (mut sum, mut oldest) = ([0; CASCADES], 0);
        for frame in 0..30 {
            // On all cascades, and the larger the nearer they are.
            let at = Vec3::new(1.0, 0.5 + 0.01 * frame as f32, 0.0);
            let mesh = casters[0].mesh.clone();
            casters[0] = Caster::new(mesh, Affine3A::from_translation(at));
            add(
                &mut sum,
                drawn(&gpu, &mut atlas, (&lights, &view, &casters)),
            );
            let ages = atlas
                .tiles(0, 0)
                .into_iter()
                .map(|tile| tile.statistics.age);
            oldest = ages.max().unwrap().max(oldest);
        }
        assert!(
            atlas.max_age().is_none_or(|most| oldest <= most),
            "{oldest}"
        );
        sum
    };
    let [first, rest @ ..] = drawn_of(Some(2));
    assert_eq!(first, 30);
    assert!(rest.iter().all(|&far| (8..=12).contains(&far)), "{rest:?}");
    // The broken twin: without a budget all are drawn each time.
    assert_eq!(drawn_of(None), [30; CASCADES]);
}

#[test]
fn a_camera_that_turns_draws_nothing_and_one_that_walks_draws_far_cascades_seldom() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = wide(&gpu);
    let drawn_of = |cascades, views: &[View]| {
        let lights = sun(cascades);
        let mut atlas = atlas(&gpu, &descriptor(4));
        drawn(&gpu, &mut atlas, (&lights, &views[0], &casters));
        let mut sum = [0; CASCADES];
        for view in &views[1..] {
            add(&mut sum, drawn(&gpu, &mut atlas, (&lights, view, &casters)));
        }
        sum
    };
    let stable = Cascades {
        distance: 60.0,
        ..Default::default()
    };
    let eye = Vec3::new(0.5, 1.0, 0.2);
    let turn: Vec<View> = (0..65)
        .map(|step| {
            let (sin, cos) = (std::f32::consts::TAU * step as f32 / 64.0).sin_cos();
            camera(eye, Vec3::new(cos, -0.2, sin))
        })
        .collect();
    assert_eq!(drawn_of(stable, &turn), [0; CASCADES]);
    // The broken twin: a fit to what is seen turns with it.
    let tight = Cascades {
        fit: CascadeFit::Tight,
        ..stable
    };
    let follow = drawn_of(tight, &turn);
    assert!(follow.iter().all(|&drawn| drawn > 30), "{follow:?}");

    let walk: Vec<View> = (0..81)
        .map(|step| camera(eye + Vec3::new(0.05, 0.0, 0.02) * step as f32, Vec3::X))
        .collect();
    let [first, .., last] = drawn_of(stable, &walk);
    assert!(last <= 2 && last < first, "{first} {last}");
    // The broken twin: without a margin they follow texel by texel.
    let follow = drawn_of(
        Cascades {
            margin: 0.0,
            ..stable
        },
        &walk,
    );
    assert!(follow[0] > 2 * first && follow[3] > last, "{follow:?}");
}
