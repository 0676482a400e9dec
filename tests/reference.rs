//! The reference against analytic answers, and its comparison against counts made by hand.

use std::f32::consts::PI;
use std::sync::{Arc, Mutex};

use shadows::error::{LightError, ReferenceError};
use shadows::glam::camera::{lh, rh};
use shadows::glam::{DAffine3, DVec3, Mat4, Vec2, Vec3, Vec4};
use shadows::reference::{
    Class, Comparison, Interior, ReferenceImage, ReferenceObject, ReferenceScene, Verdict,
};
use shadows::{DepthConvention, HomogeneousLight, View};

const SIDE: u32 = 160;

#[derive(Clone)]
struct Mesh {
    positions: Vec<[f32; 3]>,
    indices: Vec<u32>,
}

impl Mesh {
    fn object(&self, casts: bool) -> ReferenceObject<'_> {
        ReferenceObject {
            positions: &self.positions,
            indices: &self.indices,
            transform: DAffine3::IDENTITY,
            casts,
        }
    }

    fn at(&self, transform: DAffine3, casts: bool) -> ReferenceObject<'_> {
        ReferenceObject {
            transform,
            ..self.object(casts)
        }
    }
}

/// A horizontal rectangle, counter-clockwise from above.
fn rectangle(low: Vec2, high: Vec2, y: f32) -> Mesh {
    Mesh {
        positions: vec![
            [low.x, y, low.y],
            [low.x, y, high.y],
            [high.x, y, high.y],
            [high.x, y, low.y],
        ],
        indices: vec![0, 1, 2, 0, 2, 3],
    }
}

fn ground() -> Mesh {
    rectangle(Vec2::splat(-20.0), Vec2::splat(20.0), 0.0)
}

/// A closed box of eight vertices.
fn cuboid(low: Vec3, high: Vec3) -> Mesh {
    let corner = |i: usize| {
        let pick = |axis: usize| {
            if i >> axis & 1 == 1 {
                high[axis]
            } else {
                low[axis]
            }
        };
        [pick(0), pick(1), pick(2)]
    };
    let quads = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    Mesh {
        positions: (0..8).map(corner).collect(),
        indices: quads
            .iter()
            .flat_map(|&[a, b, c, d]| [a, b, c, a, c, d])
            .collect(),
    }
}

/// A sphere of `rings` between two poles and `sectors` around.
fn sphere(centre: Vec3, radius: f32, rings: u32, sectors: u32) -> Mesh {
    let mut positions = vec![(centre + Vec3::Y * radius).to_array()];
    for ring in 1..=rings {
        let phi = PI * ring as f32 / (rings + 1) as f32;
        for sector in 0..sectors {
            let t = 2.0 * PI * sector as f32 / sectors as f32;
            let unit = Vec3::new(phi.sin() * t.cos(), phi.cos(), phi.sin() * t.sin());
            positions.push((centre + radius * unit).to_array());
        }
    }
    positions.push((centre - Vec3::Y * radius).to_array());
    let vertex = |ring: u32, sector: u32| 1 + (ring - 1) * sectors + sector % sectors;
    let bottom = positions.len() as u32 - 1;
    let mut indices = Vec::new();
    for k in 0..sectors {
        indices.extend([0, vertex(1, k + 1), vertex(1, k)]);
        indices.extend([bottom, vertex(rings, k), vertex(rings, k + 1)]);
        for j in 1..rings {
            let (a, b) = (vertex(j, k), vertex(j, k + 1));
            let (c, d) = (vertex(j + 1, k), vertex(j + 1, k + 1));
            indices.extend([a, b, c, b, d, c]);
        }
    }
    Mesh { positions, indices }
}

/// Straight down from `eye`, 90 degrees wide and high; every entry is exact. World -Z is up.
fn downward(eye: Vec3, near: f32) -> View {
    let matrix = Mat4::from_cols(
        Vec4::new(1.0, 0.0, 0.0, 0.0),
        Vec4::new(0.0, 0.0, 0.0, -1.0),
        Vec4::new(0.0, -1.0, 0.0, 0.0),
        Vec4::new(-eye.x, eye.z, near, eye.y),
    );
    View::new(matrix, DepthConvention::InfiniteReverse).unwrap()
}

/// The ground point under a pixel of [`downward`].
fn ground_under(x: u32, y: u32, eye: Vec3) -> DVec3 {
    let clip = |i: u32| (2.0 * f64::from(i) + 1.0) / f64::from(SIDE) - 1.0;
    let eye = eye.as_dvec3();
    DVec3::new(eye.x + clip(x) * eye.y, 0.0, eye.z + clip(y) * eye.y)
}

/// Whether the open segment from `from` to the light passes through the box.
fn crosses(from: DVec3, light: HomogeneousLight, low: DVec3, high: DVec3) -> bool {
    let light = light.0.as_dvec4();
    let to = light.truncate() - light.w * from;
    let (mut near, mut far) = (0.0, if light.w == 1.0 { 1.0 } else { f64::INFINITY });
    for axis in 0..3 {
        let (a, b) = (
            (low[axis] - from[axis]) / to[axis],
            (high[axis] - from[axis]) / to[axis],
        );
        near = f64::max(near, a.min(b));
        far = f64::min(far, a.max(b));
    }
    near < far
}

/// Number of pixels whose class is not what `expected` says; `None` says nothing.
fn disagreements(
    image: &ReferenceImage,
    expected: impl Fn(u32, u32) -> Option<Class>,
) -> (usize, usize) {
    let mut said = 0;
    let wrong = image
        .classes()
        .enumerate()
        .filter(|&(i, class)| {
            let (x, y) = (i as u32 % image.width(), i as u32 / image.width());
            let expected = expected(x, y);
            said += usize::from(expected.is_some());
            expected.is_some_and(|expected| expected != class)
        })
        .count();
    (wrong, said)
}

fn lit_or(shadow: bool) -> Class {
    if shadow { Class::Shadowed } else { Class::Lit }
}

/// Exact in f32 also when 1e5 is added, and no pixel centre falls on an edge of the scenes below.
const EYE: Vec3 = Vec3::new(0.2578125, 8.0, 0.5);

fn from_above(objects: &[ReferenceObject<'_>], light: HomogeneousLight) -> ReferenceImage {
    let scene = ReferenceScene::new(objects).unwrap();
    scene
        .render(&downward(EYE, 0.1), SIDE, SIDE, light, None)
        .unwrap()
}

#[test]
fn a_rectangle_casts_its_projection() {
    let (low, high) = (Vec2::new(-1.0, -0.5), Vec2::new(1.5, 0.75));
    let (ground, roof) = (ground(), rectangle(low, high, 2.0));
    let (low, high) = (DVec3::new(-1.0, 2.0, -0.5), DVec3::new(1.5, 2.0, 0.75));
    let expected = |x, y, light: HomogeneousLight| {
        // Seen from above: the roof where the camera's ray crosses its plane inside it.
        let point = ground_under(x, y, EYE);
        let eye = EYE.as_dvec3();
        let at_roof = point + (eye - point) * (2.0 / eye.y);
        if at_roof.clamp(low, high) == at_roof.with_y(2.0) {
            return Some(Class::Lit);
        }
        let light = light.0.as_dvec4();
        let to = light.truncate() - light.w * point;
        let crossing = (point + to * (2.0 / to.y)).with_y(2.0);
        Some(lit_or(crossing.clamp(low, high) == crossing))
    };
    for light in [
        HomogeneousLight::point(Vec3::new(0.3, 5.0, -0.7)),
        HomogeneousLight::point(Vec3::new(-3.0, 4.0, 1.0)),
        HomogeneousLight::directional(Vec3::new(0.5, 1.0, 0.27)),
    ] {
        let image = from_above(&[ground.object(false), roof.object(true)], light);
        assert!(image.count(Class::Shadowed) > 100);
        let (wrong, said) = disagreements(&image, |x, y| expected(x, y, light));
        assert_eq!((wrong, said), (0, (SIDE * SIDE) as usize), "{light:?}");
        // The twin: a light a little aside.
        let moved = HomogeneousLight(light.0 + Vec4::new(0.1, 0.0, 0.0, 0.0));
        assert!(disagreements(&image, |x, y| expected(x, y, moved)).0 > 0);
    }
}

#[test]
fn only_casters_cast() {
    let (ground, roof) = (ground(), rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0));
    let light = HomogeneousLight::point(Vec3::new(2.0, 5.0, 0.0));
    let shadowed = |casts| {
        let image = from_above(&[ground.object(true), roof.object(casts)], light);
        assert_eq!(image.lit_facing(), (SIDE * SIDE) as usize);
        image.count(Class::Shadowed)
    };
    assert!(shadowed(true) > 0);
    assert_eq!(shadowed(false), 0);
}

#[test]
fn a_sphere_casts_between_its_inscribed_and_circumscribed_spheres() {
    let centre = Vec3::new(0.5, 2.0, 0.0);
    let (ball, ground) = (sphere(centre, 1.0, 47, 64), ground());
    let light = Vec3::new(2.0, 6.0, 1.0);
    let image = from_above(
        &[ground.object(false), ball.object(true)],
        HomogeneousLight::point(light),
    );
    // A facet is no farther from the centre than a step of latitude and one of longitude allow.
    let inner = (f64::from(PI) / 48.0).cos() * (f64::from(PI) / 64.0).cos();
    let expected = |radius: f64, x, y| {
        let hit = image.hit(x, y).filter(|hit| hit.object == 0)?;
        let light = light.as_dvec3();
        let along = (light - hit.position).normalize();
        let distance = (centre.as_dvec3() - hit.position).cross(along).length();
        if distance < inner * radius {
            Some(Class::Shadowed)
        } else if distance > radius {
            Some(Class::Lit)
        } else {
            None
        }
    };
    let (wrong, said) = disagreements(&image, |x, y| expected(1.0, x, y));
    assert_eq!(wrong, 0);
    assert!(said > 15_000, "{said}");
    assert!(disagreements(&image, |x, y| expected(1.05, x, y)).0 > 0);
    assert!(disagreements(&image, |x, y| expected(0.95, x, y)).0 > 0);
}

#[test]
fn the_far_side_is_away_and_shadows_itself_nowhere() {
    let ball = sphere(Vec3::new(0.0, 2.0, 0.0), 1.5, 24, 32);
    let light = HomogeneousLight::directional(Vec3::new(1.0, 0.5, 0.0));
    let image = from_above(&[ball.object(true)], light);
    // A convex body: what faces the light is lit.
    assert_eq!(image.count(Class::Shadowed), 0);
    assert!(image.count(Class::Away) > 100 && image.count(Class::Lit) > 100);
    for (i, class) in image.classes().enumerate() {
        let hit = image.hit(i as u32 % SIDE, i as u32 / SIDE);
        let faces = hit.map(|hit| hit.normal.dot(DVec3::new(1.0, 0.5, 0.0)) > 0.0);
        let expected = match faces {
            None => Class::Background,
            Some(true) => Class::Lit,
            Some(false) => Class::Away,
        };
        assert_eq!(class, expected);
    }
    // The twin: a second body makes the same surface shadowed.
    let other = sphere(Vec3::new(4.0, 4.0, 0.0), 1.5, 24, 32);
    assert!(from_above(&[ball.object(true), other.object(true)], light).count(Class::Shadowed) > 0);
}

#[test]
fn a_light_behind_or_in_the_plane_leaves_the_ground_away() {
    let ground = ground();
    let all = (SIDE * SIDE) as usize;
    for (height, class) in [(-3.0, Class::Away), (0.0, Class::Away), (3.0, Class::Lit)] {
        for light in [
            HomogeneousLight::point(Vec3::new(1.0, height, 2.0)),
            HomogeneousLight::directional(Vec3::new(1.0, height, 2.0)),
        ] {
            assert_eq!(from_above(&[ground.object(true)], light).count(class), all);
        }
    }
}

#[test]
fn beyond_the_range_is_another_class() {
    let (ground, position) = (ground(), Vec3::new(0.5, 3.0, 0.0));
    let scene = ReferenceScene::new(&[ground.object(false)]).unwrap();
    let light = HomogeneousLight::point(position);
    let image = scene
        .render(&downward(EYE, 0.1), SIDE, SIDE, light, Some(5.0))
        .unwrap();
    let expected = |x, y, range: f64| {
        let far = ground_under(x, y, EYE).distance(position.as_dvec3()) > range;
        Some(if far { Class::OutOfRange } else { Class::Lit })
    };
    assert_eq!(disagreements(&image, |x, y| expected(x, y, 5.0)).0, 0);
    assert!(disagreements(&image, |x, y| expected(x, y, 5.05)).0 > 0);
    assert!(image.count(Class::OutOfRange) > 0);
    assert_eq!(
        image.coverage().iter().filter(|&&byte| byte == 128).count(),
        image.count(Class::OutOfRange)
    );
    let sun = HomogeneousLight::directional(Vec3::Y);
    let image = scene
        .render(&downward(EYE, 0.1), SIDE, SIDE, sun, Some(5.0))
        .unwrap();
    assert_eq!(image.count(Class::OutOfRange), 0);
}

/// Ground, a box that rests on it, another above, a coplanar copy of the ground, and a sphere.
fn furnished() -> [Mesh; 5] {
    [
        ground(),
        cuboid(Vec3::new(-2.0, 0.0, -1.0), Vec3::new(-1.0, 1.0, 0.5)),
        cuboid(Vec3::new(1.0, 1.5, -1.0), Vec3::new(2.5, 2.0, 0.5)),
        ground(),
        sphere(Vec3::new(0.0, 1.0, 2.0), 0.75, 12, 16),
    ]
}

#[test]
fn a_resting_box_leaves_no_light_gap() {
    let [ground, resting, ..] = furnished();
    for light in [
        HomogeneousLight::point(Vec3::new(1.0, 3.0, 0.3)),
        HomogeneousLight::directional(Vec3::new(1.0, 1.0, 0.3)),
    ] {
        let image = from_above(&[ground.object(true), resting.object(true)], light);
        let expected = |x, y, high: DVec3| {
            let hit = image.hit(x, y).filter(|hit| hit.object == 0)?;
            let low = DVec3::new(-2.0, 0.0, -1.0);
            Some(lit_or(crosses(hit.position.with_y(0.0), light, low, high)))
        };
        let high = DVec3::new(-1.0, 1.0, 0.5);
        let (wrong, said) = disagreements(&image, |x, y| expected(x, y, high));
        assert_eq!(wrong, 0);
        assert!(said > 15_000 && image.count(Class::Shadowed) > 40);
        let lower = high.with_y(0.9);
        assert!(disagreements(&image, |x, y| expected(x, y, lower)).0 > 0);
    }
}

#[test]
fn a_coplanar_copy_casts_nothing_and_a_lifted_one_everything() {
    let ground = ground();
    let light = HomogeneousLight::directional(Vec3::new(1.0, 0.01, 0.3));
    let turned = |lift: f64| {
        // There and back again, so that the corners round differently.
        let turn = DAffine3::from_axis_angle(DVec3::Y, 0.7);
        DAffine3::from_translation(DVec3::new(-1e3, lift, 3.0))
            * turn
            * DAffine3::from_translation(DVec3::new(300.0, 0.0, 700.0))
            * DAffine3::from_scale(DVec3::splat(1e3))
    };
    let shadowed = |lift| {
        let image = from_above(&[ground.object(true), ground.at(turned(lift), true)], light);
        assert_eq!(image.lit_facing(), (SIDE * SIDE) as usize);
        image.count(Class::Shadowed)
    };
    assert_eq!(shadowed(0.0), 0);
    // The twin: a copy that the near plane hides from view but not from the light.
    let scene = ReferenceScene::new(&[ground.object(true), ground.at(turned(1.0), true)]).unwrap();
    let image = scene
        .render(&downward(EYE, 7.5), SIDE, SIDE, light, None)
        .unwrap();
    assert_eq!(image.count(Class::Shadowed), image.lit_facing());
}

#[test]
fn a_sheet_a_ten_millionth_above_casts_its_shadow() {
    let height = 1e-7_f32;
    let sheet = rectangle(Vec2::new(0.0, -20.0), Vec2::new(20.0, 20.0), height);
    let ground = ground();
    let scene = ReferenceScene::new(&[ground.object(true), sheet.object(true)]).unwrap();
    let light = HomogeneousLight::directional(Vec3::new(1.0, 0.125, 0.0));
    let view = downward(EYE * 1e-6, 1e-7);
    let image = scene.render(&view, SIDE, SIDE, light, None).unwrap();
    let expected = |x, y, slope: f64| {
        let hit = image.hit(x, y).filter(|hit| hit.object == 0)?;
        Some(lit_or(
            hit.position.x > -f64::from(height) / slope && hit.position.x < 0.0,
        ))
    };
    let (wrong, said) = disagreements(&image, |x, y| expected(x, y, 0.125));
    assert!(wrong == 0 && said > 5_000, "{wrong} of {said}");
    assert!(image.count(Class::Shadowed) > 500);
    assert!(disagreements(&image, |x, y| expected(x, y, 0.15)).0 > 0);
}

#[test]
fn scale_and_place_change_nothing() {
    let meshes = furnished();
    let classes = |scale: f32, offset: Vec3, light: Vec3| -> Vec<Class> {
        let transform = DAffine3::from_translation(offset.as_dvec3())
            * DAffine3::from_scale(DVec3::splat(f64::from(scale)));
        let objects: Vec<_> = meshes.iter().map(|mesh| mesh.at(transform, true)).collect();
        let scene = ReferenceScene::new(&objects).unwrap();
        let view = downward(EYE * scale + offset, 0.1 * scale);
        let light = HomogeneousLight::point(light * scale + offset);
        let image = scene
            .render(&view, SIDE, SIDE, light, Some(9.0 * scale))
            .unwrap();
        image.classes().collect()
    };
    let light = Vec3::new(0.5, 3.0, -0.25);
    let original = classes(1.0, Vec3::ZERO, light);
    for class in [Class::Lit, Class::Shadowed, Class::Away, Class::OutOfRange] {
        assert!(original.contains(&class), "{class:?}");
    }
    for scale in [1e-4, 1e5] {
        assert!(classes(scale, Vec3::ZERO, light) == original, "{scale}");
    }
    for offset in [Vec3::splat(1e5), Vec3::new(-1e5, 1e3, 1e6)] {
        assert!(classes(1.0, offset, light) == original, "{offset}");
    }
    let aside = light + Vec3::X / 64.0;
    assert!(classes(1.0, Vec3::splat(1e5), aside) != original);
}

#[test]
fn a_light_on_a_vertex_on_an_edge_inside_and_in_the_plane() {
    let (low, high) = (Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 3.0, 1.0));
    let (ground, cube) = (ground(), cuboid(low, high));
    let render = |light| {
        let scene = ReferenceScene::new(&[ground.object(false), cube.object(true)]).unwrap();
        // The near plane at 0.25: the box is not seen, only its shadow.
        let view = downward(EYE, 7.75);
        scene
            .render(&view, SIDE, SIDE, HomogeneousLight::point(light), None)
            .unwrap()
    };
    type Shadow = fn(DVec3) -> bool;
    let cases: [(Vec3, Shadow); 4] = [
        (high, |p| p.x < 1.0 && p.z < 1.0),
        (Vec3::new(1.0, 3.0, 0.0), |p| p.x < 1.0),
        (Vec3::new(0.1, 2.0, 0.2), |_| true),
        (Vec3::new(0.0, 3.0, 0.0), |_| true),
    ];
    for (light, shadow) in cases {
        let image = render(light);
        let expected = |x, y| Some(lit_or(shadow(ground_under(x, y, EYE))));
        assert_eq!(disagreements(&image, expected).0, 0, "{light}");
        // The twin: the same light above the box.
        let above = render(light.with_y(4.0));
        assert!(disagreements(&above, expected).0 > 0, "{light}");
    }
    let roof = rectangle(Vec2::NEG_ONE, Vec2::ONE, 3.0);
    let shadowed = |light| {
        from_above(
            &[ground.object(false), roof.object(true)],
            HomogeneousLight::point(light),
        )
        .count(Class::Shadowed)
    };
    assert_eq!(shadowed(Vec3::new(0.5, 3.0, 0.0)), 0);
    assert!(shadowed(Vec3::new(0.5, 3.0 + 1e-6, 0.0)) > 10_000);
}

#[test]
fn all_projections_see_the_same_ground() {
    let [ground, resting, above, ..] = furnished();
    let scene = ReferenceScene::new(&[
        ground.object(false),
        resting.object(true),
        above.object(true),
    ])
    .unwrap();
    let light = HomogeneousLight::point(Vec3::new(0.5, 3.0, -0.25));
    let look = rh::view::look_at_mat4(Vec3::new(3.0, 4.0, 5.0), Vec3::ZERO, Vec3::Y);
    let look_lh = lh::view::look_at_mat4(Vec3::new(3.0, 4.0, 5.0), Vec3::ZERO, Vec3::Y);
    let render = |matrix, depth| {
        let view = View::new(matrix, depth).unwrap();
        scene.render(&view, SIDE, SIDE, light, None).unwrap()
    };
    use DepthConvention as D;
    let perspective = [
        (
            rh::proj::directx::perspective_infinite_reverse(0.9, 1.0, 0.1) * look,
            D::InfiniteReverse,
        ),
        (
            rh::proj::directx::perspective(0.9, 1.0, 100.0, 0.1) * look,
            D::FiniteReverse,
        ),
        (
            rh::proj::directx::perspective(0.9, 1.0, 0.1, 100.0) * look,
            D::Standard,
        ),
        (
            lh::proj::directx::perspective(0.9, 1.0, 0.1, 100.0) * look_lh,
            D::Standard,
        ),
    ]
    .map(|(matrix, depth)| render(matrix, depth));
    // A left-handed camera shows world coordinates mirrored.
    let mut mirrored = perspective[0].visibility();
    mirrored.chunks_mut(SIDE as usize).for_each(<[u8]>::reverse);
    let truth = perspective[0].visibility();
    let errors = |image: &ReferenceImage, truth: &[u8]| {
        let error = image.compare(truth, Interior::Screen).unwrap();
        error.false_lit + error.false_shadow
    };
    // The f32 matrices differ in their last digits; a pixel on an edge may fall either way.
    let [_, finite, standard, left] = &perspective;
    for (image, truth, other) in [
        (finite, &truth, &mirrored),
        (standard, &truth, &mirrored),
        (left, &mirrored, &truth),
    ] {
        assert!(errors(image, truth) <= 2);
        assert!(errors(image, other) > 100);
    }
    let orthographic = rh::proj::directx::orthographic(-3.0, 3.0, -3.0, 3.0, 0.1, 30.0) * look;
    let image = render(orthographic, D::Standard);
    let (low, high) = (DVec3::new(-2.0, 0.0, -1.0), DVec3::new(-1.0, 1.0, 0.5));
    let (low2, high2) = (DVec3::new(1.0, 1.5, -1.0), DVec3::new(2.5, 2.0, 0.5));
    let expected = |x: u32, y: u32, eye: Vec3| {
        let hit = image.hit(x, y).filter(|hit| hit.object == 0)?;
        // Where the axis through the pixel meets the ground, from the camera's own axes.
        let back = eye.as_dvec3().normalize();
        let right = DVec3::Y.cross(back).normalize();
        let up = back.cross(right);
        let clip = |i: u32| 3.0 * ((2.0 * f64::from(i) + 1.0) / f64::from(SIDE) - 1.0);
        let start = right * clip(x) - up * clip(y);
        let point = start - back * (start.y / back.y);
        assert!(
            point.distance(hit.position) < 1e-5,
            "{point} {}",
            hit.position
        );
        let blocked = crosses(point, light, low, high) || crosses(point, light, low2, high2);
        Some(lit_or(blocked))
    };
    let (wrong, said) = disagreements(&image, |x, y| expected(x, y, Vec3::new(3.0, 4.0, 5.0)));
    assert!(wrong <= 2 && said > 10_000, "{wrong} of {said}");
    // The twin: the perspective picture is another one.
    assert!(errors(&image, &truth) > 100);
}

#[test]
fn the_near_and_far_planes_clip_what_is_seen_but_not_what_casts() {
    let (ground, roof) = (ground(), rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0));
    let scene = ReferenceScene::new(&[ground.object(false), roof.object(true)]).unwrap();
    let light = HomogeneousLight::point(Vec3::new(0.0, 4.0, 0.0));
    let seen = |near: f32, far: f32| {
        // Straight down, without glam's look_at, whose up must not be parallel to the view.
        let down = Mat4::from_cols(Vec4::X, Vec4::Z, -Vec4::Y, Vec4::new(0.0, 0.0, -8.0, 1.0));
        let matrix = rh::proj::directx::perspective(1.0, 1.0, near, far) * down;
        let view = View::new(matrix, DepthConvention::Standard).unwrap();
        let image = scene.render(&view, SIDE, SIDE, light, None).unwrap();
        let object = image.hit(SIDE / 2, SIDE / 2).map(|hit| hit.object);
        (object, image.count(Class::Shadowed))
    };
    let (object, with_roof) = seen(0.1, 20.0);
    assert_eq!(object, Some(1));
    let (object, without_roof) = seen(6.5, 20.0);
    assert_eq!(object, Some(0));
    assert!(without_roof > with_roof && with_roof > 0);
    assert_eq!(seen(0.1, 7.5), (Some(1), 0));
    assert_eq!(seen(0.1, 5.5), (None, 0));
}

#[test]
fn degenerate_scenes_work() {
    let light = HomogeneousLight::point(Vec3::new(0.5, 3.0, -0.25));
    let all = (SIDE * SIDE) as usize;
    assert_eq!(from_above(&[], light).count(Class::Background), all);
    let none = Mesh {
        positions: vec![[0.0; 3]],
        indices: Vec::new(),
    };
    assert_eq!(
        from_above(&[none.object(true)], light).count(Class::Background),
        all
    );

    let [ground, resting, above, ..] = furnished();
    let mut bad = above.clone();
    bad.positions.push([1.0 + 1.5 / 1024.0, 1.5, -1.0]);
    bad.indices.extend([0, 0, 1, 3, 3, 3, 0, 8, 1]);
    let classes = |mesh: &Mesh| -> Vec<Class> {
        let objects = [
            ground.object(false),
            resting.object(true),
            mesh.object(true),
        ];
        from_above(&objects, light).classes().collect()
    };
    assert!(classes(&bad) == classes(&above));
    bad.indices.extend([0, 3, 100]);
    bad.positions.resize(101, [-3.0, 2.0, -3.0]);
    assert!(classes(&bad) != classes(&above));

    // One triangle a thousand times: as once.
    let once = Mesh {
        indices: vec![0, 1, 2],
        ..rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0)
    };
    let often = Mesh {
        indices: [0, 1, 2].repeat(1000),
        ..once.clone()
    };
    assert!(classes(&once) == classes(&often));
    let both = rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0);
    assert!(classes(&once) != classes(&both));
}

#[test]
fn every_bad_input_is_named() {
    let good = ground();
    let refuse = |change: &dyn Fn(&mut Mesh), transform| {
        let mut mesh = good.clone();
        change(&mut mesh);
        ReferenceScene::new(&[good.object(true), mesh.at(transform, true)])
            .map(|_| ())
            .unwrap_err()
    };
    let here = DAffine3::IDENTITY;
    assert_eq!(
        refuse(&|mesh| mesh.indices.push(0), here),
        ReferenceError::IndexCount {
            object: 1,
            count: 7
        }
    );
    assert_eq!(
        refuse(&|mesh| mesh.indices[4] = 4, here),
        ReferenceError::IndexOutOfRange {
            object: 1,
            index: 4,
            vertices: 4
        }
    );
    assert_eq!(
        refuse(&|mesh| mesh.positions[2][1] = f32::NAN, here),
        ReferenceError::Position {
            object: 1,
            vertex: 2
        }
    );
    assert_eq!(
        refuse(
            &|_| (),
            DAffine3::from_translation(DVec3::X * f64::INFINITY)
        ),
        ReferenceError::Position {
            object: 1,
            vertex: 0
        }
    );

    let scene = ReferenceScene::new(&[good.object(true)]).unwrap();
    let view = downward(EYE, 0.1);
    let light = HomogeneousLight::point(Vec3::Y);
    let fail = |width, height, light, range| {
        scene
            .render(&view, width, height, light, range)
            .map(|_| ())
            .unwrap_err()
    };
    assert_eq!(
        fail(0, 4, light, None),
        ReferenceError::Size {
            width: 0,
            height: 4
        }
    );
    assert_eq!(
        fail(4, 4, HomogeneousLight(Vec4::ZERO), None),
        ReferenceError::Light(LightError::Direction)
    );
    assert_eq!(
        fail(4, 4, light, Some(-1.0)),
        ReferenceError::Light(LightError::Range(-1.0))
    );

    let image = scene.render(&view, 4, 4, light, None).unwrap();
    let map = |face_size, kernel_radius| Interior::Map {
        face_size,
        kernel_radius,
    };
    assert_eq!(
        image.compare(&[0_u8; 15], Interior::Screen),
        Err(ReferenceError::VisibilityCount {
            passed: 15,
            pixels: 16
        })
    );
    let mut visibility = [1.0_f32; 16];
    visibility[7] = 1.5;
    assert_eq!(
        image.compare(&visibility, Interior::Screen),
        Err(ReferenceError::Visibility {
            pixel: 7,
            value: 1.5
        })
    );
    visibility[7] = f32::NAN;
    assert!(matches!(
        image.compare(&visibility, Interior::Screen),
        Err(ReferenceError::Visibility { pixel: 7, .. })
    ));
    visibility[7] = 1.0;
    assert!(image.compare(&visibility, map(1024, 0.0)).is_ok());
    for (face_size, kernel_radius) in [(0, 0.0), (1024, -1.0)] {
        let error = ReferenceError::Interior {
            face_size,
            kernel_radius,
        };
        assert_eq!(
            image.interior_pixels(map(face_size, kernel_radius)),
            Err(error)
        );
    }
    let sun = HomogeneousLight::directional(Vec3::Y);
    let image = scene.render(&view, 4, 4, sun, None).unwrap();
    assert!(image.compare(&visibility, map(1024, 0.0)).is_err());
    assert!(image.compare(&visibility, Interior::Screen).is_ok());
}

#[test]
fn progress_arrives_at_one() {
    let ground = ground();
    let told = Arc::new(Mutex::new(Vec::new()));
    let listener = Arc::clone(&told);
    let scene = ReferenceScene::new(&[ground.object(true)])
        .unwrap()
        .with_progress(move |part| listener.lock().unwrap().push(part));
    let light = HomogeneousLight::point(Vec3::Y);
    scene
        .render(&downward(EYE, 0.1), 8, 16, light, None)
        .unwrap();
    let told = told.lock().unwrap();
    assert_eq!(told.len(), 16);
    assert!(told.contains(&1.0) && told.iter().all(|&part| part > 0.0 && part <= 1.0));
}

/// Ground only is seen (the roof is nearer than the near plane), with the roof's square shadow.
fn square_shadow() -> ReferenceImage {
    let (ground, roof) = (ground(), rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0));
    let scene = ReferenceScene::new(&[ground.object(false), roof.object(true)]).unwrap();
    let light = HomogeneousLight::point(Vec3::new(0.0, 4.0, 0.0));
    scene
        .render(&downward(EYE, 7.5), SIDE, SIDE, light, None)
        .unwrap()
}

fn inverted(image: &ReferenceImage) -> Vec<u8> {
    image.visibility().iter().map(|byte| 255 - byte).collect()
}

#[test]
fn the_truth_has_no_error_and_its_inverse_has_every() {
    let image = square_shadow();
    let (lit, shadowed) = (image.count(Class::Lit), image.count(Class::Shadowed));
    assert!(lit > 1000 && shadowed > 1000);
    let right = image
        .compare(&image.visibility(), Interior::Screen)
        .unwrap();
    assert_eq!(
        (right.false_lit, right.false_shadow, right.rmse),
        (0, 0, 0.0)
    );
    let wrong = image.compare(&inverted(&image), Interior::Screen).unwrap();
    assert_eq!((wrong.false_lit, wrong.false_shadow), (shadowed, lit));
    assert_eq!((wrong.lit_facing, wrong.rmse), (lit + shadowed, 1.0));
}

#[test]
fn half_is_lit_and_fractions_enter_the_rmse() {
    let image = square_shadow();
    let pixels = (SIDE * SIDE) as usize;
    let (lit, shadowed) = (image.count(Class::Lit), image.count(Class::Shadowed));
    let compare = |value: f32| {
        image
            .compare(&vec![value; pixels], Interior::Screen)
            .unwrap()
    };
    let quarter = compare(0.25);
    assert_eq!((quarter.false_lit, quarter.false_shadow), (0, lit));
    let square = lit as f64 * 0.5625 + shadowed as f64 * 0.0625;
    assert!((quarter.rmse - (square / pixels as f64).sqrt()).abs() < 1e-12);
    assert_eq!(compare(0.5).false_lit, shadowed);
    assert_eq!(compare(0.5_f32.next_down()).false_lit, 0);
    let bytes = |byte: u8| {
        image
            .compare(&vec![byte; pixels], Interior::Screen)
            .unwrap()
    };
    assert_eq!(bytes(128).false_lit, shadowed);
    assert_eq!(bytes(127).false_lit, 0);
}

/// Which pixels are in the interior, from the verdicts on a picture that is wrong everywhere.
fn interior(image: &ReferenceImage, interior: Interior) -> Vec<bool> {
    let error = image.compare(&inverted(image), interior).unwrap();
    let inside = |verdict: &Verdict| {
        matches!(
            verdict,
            Verdict::FalseLitInterior | Verdict::FalseShadowInterior
        )
    };
    let pixels: Vec<bool> = error.verdicts.iter().map(inside).collect();
    let count = pixels.iter().filter(|&&inside| inside).count();
    assert_eq!(
        count,
        error.false_lit_interior + error.false_shadow_interior
    );
    assert_eq!(count, image.interior_pixels(interior).unwrap());
    pixels
}

#[test]
fn the_screen_interior_is_where_the_neighbours_agree() {
    let image = square_shadow();
    let classes: Vec<Class> = image.classes().collect();
    let side = SIDE as i32;
    let agree = |i: usize, reach: i32| {
        let (x, y) = (i as i32 % side, i as i32 / side);
        (-reach..=reach).all(|dy| {
            (-reach..=reach).all(|dx| {
                let (x, y) = (x + dx, y + dy);
                !(0..side).contains(&x)
                    || !(0..side).contains(&y)
                    || classes[(y * side + x) as usize] == classes[i]
            })
        })
    };
    let inside = interior(&image, Interior::Screen);
    assert!((0..inside.len()).all(|i| inside[i] == agree(i, 1)));
    assert!(!(0..inside.len()).all(|i| inside[i] == agree(i, 2)));
}

#[test]
fn the_map_interior_is_as_far_from_the_edge_as_the_kernel_reaches() {
    let image = square_shadow();
    let screen = interior(&image, Interior::Screen);
    // The roof is 2 below the light and reaches 1 to each side: 0.5 on the cube face.
    let distance = |i: usize| {
        let point = ground_under(i as u32 % SIDE, i as u32 / SIDE, EYE);
        let (u, v) = ((point.x / 4.0).abs(), (point.z / 4.0).abs());
        if u < 0.5 && v < 0.5 {
            0.5 - u.max(v)
        } else {
            DVec3::new((u - 0.5).max(0.0), (v - 0.5).max(0.0), 0.0).length()
        }
    };
    for (face_size, kernel_radius) in [(64, 0.0), (64, 2.5), (128, 6.5)] {
        let map = Interior::Map {
            face_size,
            kernel_radius,
        };
        let inside = interior(&image, map);
        let judge = |radius: f64| {
            let wrong = |&i: &usize| {
                let distance = distance(i);
                // Between the two the rays on the rings may or may not find the edge.
                (inside[i] && distance < 0.9 * radius)
                    || (!inside[i] && screen[i] && distance > radius)
            };
            (0..inside.len()).filter(wrong).count()
        };
        let radius = (1.5 + f64::from(kernel_radius)) * 2.0 / f64::from(face_size);
        assert_eq!(judge(radius), 0, "{map:?}");
        assert!(
            judge(1.2 * radius) > 0 && judge(0.8 * radius) > 0,
            "{map:?}"
        );
        assert!(inside.iter().any(|&inside| inside));
    }
}

#[test]
fn a_step_in_depth_is_an_edge_and_a_smooth_surface_has_none() {
    let ground = ground();
    let sun = HomogeneousLight::directional(Vec3::new(0.1, 1.0, 0.05));
    // A dome seen and lit from above, no shadow on it: everything in its outline is interior.
    let dome = sphere(Vec3::new(0.25, -30.0, 0.5), 36.0, 191, 256);
    let image = from_above(&[dome.object(true)], sun);
    let faces = image.lit_facing();
    assert_eq!(faces, (SIDE * SIDE) as usize);
    assert_eq!(image.interior_pixels(Interior::Screen).unwrap(), faces);

    // A sheet that does not cast, lit as the ground is: only its height makes an edge.
    let edges = |height| {
        let sheet = rectangle(Vec2::NEG_ONE, Vec2::ONE, height);
        let image = from_above(&[ground.object(false), sheet.object(false)], sun);
        assert_eq!(image.count(Class::Lit), image.lit_facing());
        image.lit_facing() - image.interior_pixels(Interior::Screen).unwrap()
    };
    // A pixel is 2 * 8 / 160 = 0.1 wide on the ground; a sheet 2 wide has 4 * 20 pixels of edge,
    // and as many around it.
    assert_eq!(edges(0.01), 0);
    let pixels = edges(0.5);
    assert!((140..200).contains(&pixels), "{pixels}");
}

#[test]
fn the_background_and_what_faces_away_bound_the_interior() {
    let sheet = rectangle(Vec2::NEG_ONE, Vec2::ONE, 0.0);
    let sun = HomogeneousLight::directional(Vec3::Y);
    let image = from_above(&[sheet.object(true)], sun);
    let lit = image.count(Class::Lit);
    let side = (lit as f64).sqrt().round() as usize;
    assert_eq!(side * side, lit);
    assert_eq!(
        image.interior_pixels(Interior::Screen).unwrap(),
        (side - 2).pow(2)
    );
    assert_eq!(
        image.coverage().iter().filter(|&&byte| byte == 255).count(),
        lit
    );
    assert_eq!(image.hit(0, 0), None);
    assert_eq!(image.hit(SIDE, 0), None);
}

/// The published scene: 64 spheres in a spiral over a ground.
fn spheres(light: Vec3) -> ReferenceImage {
    let ground = rectangle(Vec2::splat(-15.0), Vec2::splat(15.0), 0.0);
    let ball = sphere(Vec3::ZERO, 0.4, 24, 32);
    assert_eq!((ball.positions.len(), ball.indices.len()), (770, 3 * 1536));
    let mut objects = vec![ground.object(false)];
    for i in 0..64 {
        let r = 2.0 + 7.0 * ((f64::from(i) + 0.5) / 64.0).sqrt();
        let theta = 2.399963229728653 * f64::from(i);
        let y = 0.5 + 0.75 * f64::from(i % 4);
        let centre = DVec3::new(r * theta.cos(), y, r * theta.sin());
        objects.push(ball.at(DAffine3::from_translation(centre), true));
    }
    let scene = ReferenceScene::new(&objects).unwrap();
    let look = rh::view::look_at_mat4(Vec3::new(0.0, 9.0, 16.0), Vec3::new(0.0, 0.5, 0.0), Vec3::Y);
    let projection =
        rh::proj::directx::perspective_infinite_reverse(45_f32.to_radians(), 1280.0 / 720.0, 0.1);
    let view = View::new(projection * look, DepthConvention::InfiniteReverse).unwrap();
    let light = HomogeneousLight::point(light);
    scene.render(&view, 1280, 720, light, Some(30.0)).unwrap()
}

#[test]
fn the_published_scene_has_the_published_number_of_pixels() {
    let image = spheres(Vec3::Y * 4.0);
    let faces = image.lit_facing();
    println!("{faces} pixels face the light, {:.2} s", image.seconds());
    for class in [
        Class::Background,
        Class::Away,
        Class::OutOfRange,
        Class::Lit,
        Class::Shadowed,
    ] {
        println!("{class:?} {}", image.count(class));
    }
    assert!(faces.abs_diff(613_058) < 5, "{faces}");
    let error = measured(&image);
    assert_eq!(error.false_lit, image.count(Class::Shadowed));
    assert!(error.false_lit_interior < error.false_lit);
    let moved = spheres(Vec3::Y * 4.1).lit_facing();
    assert!(moved.abs_diff(613_058) >= 50, "{moved}");
}

fn measured(image: &ReferenceImage) -> Comparison {
    let start = std::time::Instant::now();
    let map = Interior::Map {
        face_size: 1024,
        kernel_radius: 0.0,
    };
    let error = image.compare(&vec![255_u8; 1280 * 720], map).unwrap();
    let (edge, inside) = (
        error.false_lit - error.false_lit_interior,
        error.false_lit_interior,
    );
    println!(
        "{edge} edge, {inside} interior pixels, {:.2} s",
        start.elapsed().as_secs_f64()
    );
    error
}
