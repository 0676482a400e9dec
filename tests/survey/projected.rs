//! Projected shadows: where they fall, what bounds them, and what comes through.

mod ask;
mod atlas;
mod colors;
mod errors;
mod kept;
mod limits;

use crate::common::shapes::{Random, cuboid, sphere, square};
use ask::{Point, ask, ask_changed};
use host::gpu::Gpu;
use shadows::glam::camera::rh::{proj::directx as proj, view};
use shadows::glam::{Affine3A, DAffine3, DVec3, Vec3};
use shadows::reference::{Interior, ReferenceImage, ReferenceObject, ReferenceScene};
use shadows::{
    Caster, DepthConvention, DirectionalLight, HomogeneousLight, Light, PointLight,
    ProjectedCaster, ProjectedFrame, ProjectedShadow, ProjectedShadowDescriptor, Projector,
    SpotLight, View,
};

/// Shadows, prepared and drawn.
fn drawn(gpu: &Gpu, projectors: &[Projector<'_>]) -> ProjectedShadow {
    gpu.checked(|| {
        let descriptor = ProjectedShadowDescriptor::default();
        let mut shadow = ProjectedShadow::new(&gpu.device, &descriptor).unwrap();
        draw(gpu, &mut shadow, projectors);
        shadow
    })
}

fn draw(gpu: &Gpu, shadow: &mut ProjectedShadow, projectors: &[Projector<'_>]) {
    let frame = ProjectedFrame { projectors };
    shadow.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    gpu.run(|encoder| shadow.encode(encoder));
}

fn opaque(casters: &[Caster]) -> Vec<ProjectedCaster> {
    casters
        .iter()
        .cloned()
        .map(ProjectedCaster::opaque)
        .collect()
}

/// The mean of the three colours, for opaque casters.
fn lit(through: &[[f32; 3]]) -> Vec<f32> {
    through.iter().map(|[r, g, b]| (r + g + b) / 3.0).collect()
}

/// Boxes and balls above a floor at y = 0, all scaled.
struct Field {
    casters: Vec<Caster>,
    scene: ReferenceScene,
    scale: f32,
}

fn field(gpu: &Gpu, scale: f32) -> Field {
    let mut random = Random::new(4);
    let shapes = [cuboid(Vec3::new(0.5, 0.3, 0.4)), sphere(9, 16)];
    let meshes = [0, 1].map(|shape: usize| shapes[shape].mesh(&gpu.device));
    let floor = square(12.0);
    let grown = Affine3A::from_scale(Vec3::splat(scale));
    let placed: Vec<(usize, Affine3A)> = (0..10)
        .map(|index| {
            let place = random.vec3() * Vec3::new(4.0, 0.5, 4.0) + Vec3::Y * 1.2;
            let turn = Affine3A::from_axis_angle(random.vec3().normalize(), 3.0 * random.next());
            let size = Affine3A::from_scale(Vec3::splat([1.0, 0.5][index % 2]));
            (
                index % 2,
                grown * Affine3A::from_translation(place) * turn * size,
            )
        })
        .collect();
    let object = |shape: &crate::common::shapes::Shape, transform: Affine3A, casts| {
        (
            shape.positions.clone(),
            shape.indices.clone(),
            widened(transform),
            casts,
        )
    };
    let mut objects = vec![object(&floor, grown, false)];
    objects.extend(
        placed
            .iter()
            .map(|&(shape, at)| object(&shapes[shape], at, true)),
    );
    let objects: Vec<ReferenceObject<'_>> = objects
        .iter()
        .map(|(positions, indices, transform, casts)| ReferenceObject {
            positions,
            indices,
            transform: *transform,
            casts: *casts,
        })
        .collect();
    let caster = |&(shape, at): &(usize, Affine3A)| Caster::new(meshes[shape].clone(), at);
    Field {
        casters: placed.iter().map(caster).collect(),
        scene: ReferenceScene::new(&objects).unwrap(),
        scale,
    }
}

fn widened(transform: Affine3A) -> DAffine3 {
    let matrix = transform.matrix3;
    DAffine3::from_cols(
        matrix.x_axis.as_dvec3(),
        matrix.y_axis.as_dvec3(),
        matrix.z_axis.as_dvec3(),
        transform.translation.as_dvec3(),
    )
}

const SIZE: [u32; 2] = [160, 120];

impl Field {
    fn view(&self) -> View {
        let projection = proj::perspective_infinite_reverse(0.9, 4.0 / 3.0, 0.1 * self.scale);
        let eye = Vec3::new(0.5, 9.0, 7.0) * self.scale;
        let camera = view::look_at_mat4(eye, Vec3::ZERO, Vec3::Y);
        View::new(projection * camera, DepthConvention::InfiniteReverse).unwrap()
    }

    fn truth(&self, light: &Light) -> ReferenceImage {
        let [width, height] = SIZE;
        let render = |light| {
            let range = Some(1000.0 * self.scale);
            self.scene.render(&self.view(), width, height, light, range)
        };
        match light {
            Light::Point(light) => render(light.homogeneous()),
            Light::Spot(light) => self.scene.render_spot(&self.view(), width, height, light),
            Light::Directional(light) => render(HomogeneousLight::from(*light)),
            _ => unreachable!("a kind that these tests do not ask for"),
        }
        .unwrap()
    }

    /// What comes to the floor in each pixel; elsewhere, as receivers there are the casters, what is true.
    fn seen(
        &self,
        gpu: &Gpu,
        truth: &ReferenceImage,
        shadow: &ProjectedShadow,
        change: impl FnOnce(String) -> String,
    ) -> Vec<f32> {
        let [width, height] = SIZE;
        let hits = (0..height).flat_map(|y| (0..width).map(move |x| truth.hit(x, y)));
        let hits: Vec<_> = hits.collect();
        let point = |hit: &Option<shadows::reference::Hit>| {
            let position = hit.map_or(DVec3::ZERO, |hit| hit.position);
            Point::at(position.as_vec3())
        };
        let points: Vec<Point> = hits.iter().map(point).collect();
        let seen = lit(&ask_changed(gpu, shadow, 0, &points, change));
        let classes = truth.classes().zip(hits).zip(seen);
        classes
            .map(|((class, hit), seen)| match hit {
                Some(hit) if hit.object == 0 => seen,
                _ => f32::from(u8::from(class == shadows::reference::Class::Lit)),
            })
            .collect()
    }
}

/// One of each kind, at a scale.
fn lights(scale: f32) -> [Light; 3] {
    let position = Vec3::new(1.0, 9.0, 0.5) * scale;
    let range = 100.0 * scale;
    [
        PointLight::new(position, range).into(),
        SpotLight::new(position, Vec3::new(-0.1, -1.0, 0.0), 0.8, range).into(),
        DirectionalLight::new(Vec3::new(0.4, 1.0, 0.2)).into(),
    ]
}

#[test]
fn on_a_floor_shadows_fall_where_rays_say_at_any_scale() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut pictures: Vec<Vec<f32>> = Vec::new();
    for scale in [1.0, 1e-4, 1e5] {
        let field = field(&gpu, scale);
        let casters = opaque(&field.casters);
        for (kind, light) in lights(scale).into_iter().enumerate() {
            let shadow = drawn(&gpu, &[Projector::new(light, &casters).with_size(1024)]);
            let truth = field.truth(&light);
            let interior = Interior::FlatMap {
                clip_from_world: shadow.clip_from_world(0).unwrap(),
                size: 1024,
                kernel_radius: 1.0,
            };
            let seen = field.seen(&gpu, &truth, &shadow, |module| module);
            let error = truth.compare(&seen, interior).unwrap();
            let inside = error.false_lit_interior + error.false_shadow_interior;
            let edges = error.false_lit + error.false_shadow;
            assert_eq!(inside, 0, "{scale} {light:?} {error:?}");
            assert!(
                edges * 200 < error.lit_facing,
                "{scale} {light:?} {error:?}"
            );
            let shadowed = seen.iter().filter(|lit| **lit < 0.5).count();
            assert!(shadowed > 400, "{shadowed}");
            match pictures.get(kind) {
                None => pictures.push(seen.clone()),
                Some(first) => {
                    let apart = first.iter().zip(&seen);
                    let apart = apart.filter(|(a, b)| (**a - **b).abs() > 0.1).count();
                    assert!(apart < 20, "{scale} {light:?}: {apart} pixels");
                }
            }
            // The broken twin: half of the casters.
            let shadow = drawn(
                &gpu,
                &[Projector::new(light, &casters[5..]).with_size(1024)],
            );
            let seen = field.seen(&gpu, &truth, &shadow, |module| module);
            let error = truth.compare(&seen, interior).unwrap();
            assert!(error.false_lit_interior > 50, "{error:?}");
        }
    }
}

/// Each colour 0 or 1.
fn all(values: &[[f32; 3]], expected: &[f32]) -> bool {
    let expected = expected.iter().map(|&value| [value; 3]);
    values.iter().copied().eq(expected)
}

#[test]
fn beside_the_tile_behind_the_light_and_before_the_casters_all_is_lit() {
    let Some(gpu) = Gpu::for_test() else { return };
    // A roof over all that the spot shines on, so that the texels at the tile's edge are dark.
    let roof = square(30.0).caster(&gpu.device, Affine3A::from_translation(Vec3::Y * 4.0));
    let casters = opaque(&[roof]);
    let light = SpotLight::new(Vec3::Y * 8.0, Vec3::NEG_Y, 0.5, 100.0);
    let shadow = drawn(&gpu, &[Projector::new(light, &casters)]);
    let edge = 8.0 * 0.5_f32.tan();
    let at = |x: f32, y: f32| Point::at(Vec3::new(x, y, 0.3));
    let places = [
        (at(0.0, 0.0), 0.0),        // under the roof
        (at(edge * 0.9, 0.0), 0.0), // in the cone
        (at(edge * 1.1, 0.0), 1.0), // beside it
        (at(edge * 9.0, 0.0), 1.0), // far beside
        (at(0.0, 5.0), 1.0),        // above the roof
        (at(0.0, 9.0), 1.0),        // behind the light
        (at(0.0, 30.0), 1.0),       // far behind
        (at(0.0, 8.0), 1.0),        // at its height
    ];
    let (points, expected): (Vec<Point>, Vec<f32>) = places.into_iter().unzip();
    let seen = ask(&gpu, &shadow, 0, &points);
    assert!(all(&seen, &expected), "{seen:?}");
    let without = |what: &str, by: &str| {
        let change = |module: String| {
            assert!(module.contains(what), "{what}");
            module.replace(what, by)
        };
        ask_changed(&gpu, &shadow, 0, &points, change)
    };
    // The broken twins. Without the border the tile's edge goes on forever.
    let streaks = ask_changed(&gpu, &shadow, 0, &points, |module| {
        let inside = "let shaded = inside & ";
        assert!(module.contains(inside) && module.contains("border.x * border.y"));
        let module = module.replace(inside, "let shaded = ");
        module.replace("border.x * border.y", "1.0")
    });
    assert_eq!(streaks[3], [0.0; 3], "{streaks:?}");
    // Without the near distance there is a shadow above the roof, and, turned over, behind the light.
    let near = "(local.z >= shadow.near)";
    let before = without(near, "(local.z > 0.0)");
    assert_eq!((before[4], before[5]), ([0.0; 3], [1.0; 3]), "{before:?}");
    let behind = ask_changed(&gpu, &shadow, 0, &points, |module| {
        let module = module.replace(near, "true");
        module.replace("max(local.z, shadow.near)", "local.z")
    });
    assert_eq!(behind[5], [0.0; 3], "{behind:?}");
}

#[test]
fn what_looks_away_from_the_light_takes_no_shadow() {
    let Some(gpu) = Gpu::for_test() else { return };
    let roof = square(2.0).caster(&gpu.device, Affine3A::from_translation(Vec3::Y * 4.0));
    let casters = opaque(&[roof]);
    let position = Vec3::Y * 8.0;
    let lights: [Light; 3] = [
        PointLight::new(position, 100.0).into(),
        SpotLight::new(position, Vec3::NEG_Y, 0.5, 100.0).into(),
        DirectionalLight::new(Vec3::Y).into(),
    ];
    for light in lights {
        let shadow = drawn(&gpu, &[Projector::new(light, &casters)]);
        let point = Point::at(Vec3::new(0.2, 0.0, 0.1));
        let points = [
            point,
            point.facing(Vec3::Y * 7.0),
            point.facing(Vec3::NEG_Y * 0.01),
            point.facing(Vec3::new(1.0, 0.5, 0.0)),
        ];
        let seen = ask(&gpu, &shadow, 0, &points);
        assert!(all(&seen, &[0.0, 0.0, 1.0, 0.0]), "{seen:?}");
        // The broken twin.
        let twin = ask_changed(&gpu, &shadow, 0, &points, |module| {
            module.replace("dot(normal, ray) >= 0.0", "dot(normal, ray) >= 1e9")
        });
        assert!(all(&twin, &[0.0; 4]), "{twin:?}");
    }
}
