//! No acne, no leaks, no seams, at any scale, on any number of threads.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{Affine3A, DVec3, Quat, Vec3};
use shadows::reference::bake::{
    BakeDescriptor, BakedLight, Emitter, LightMap, LightMapLayout, TexelRectangle,
};
use shadows::reference::{Class, ReferenceScene};
use shadows::{DirectionalLight, Light, PointLight, glam};

use super::yard::{Unwrapped, Yard, cuboid, square};
use crate::common::rays::Triangles;
use crate::common::shapes::sphere;

fn whole(texels: u32) -> TexelRectangle {
    TexelRectangle {
        x: 0,
        y: 0,
        width: texels,
        height: texels,
    }
}

/// A ball of triangles, each a chart.
fn ball(texels: u32, transform: Affine3A) -> Unwrapped {
    let shape = sphere(7, 12);
    let corner = |index: &u32| transform.transform_point3(shape.positions[*index as usize].into());
    let faces = shape.indices.chunks_exact(3);
    let faces: Vec<Vec<Vec3>> = faces
        .map(|face| face.iter().map(corner).collect())
        .collect();
    Unwrapped::new(&faces, texels, 2.0)
}

fn baked(mesh: &Unwrapped, texels: u32, light: &BakedLight, margin: u32) -> LightMap {
    let scene = ReferenceScene::new(&[mesh.object(true)]).unwrap();
    let layout = LightMapLayout::new([texels; 2], &[mesh.receiver(whole(texels))]).unwrap();
    assert_eq!(layout.crowded_texels(), 0);
    let descriptor = BakeDescriptor { samples: 8, margin };
    scene.bake(&layout, light, &descriptor).unwrap()
}

/// A convex body shadows none of what faces the light, whatever its size and place.
#[test]
fn nothing_shadows_itself() {
    let texels = 160;
    for (scale, far) in [
        (1e-4, 0.0),
        (1.0, 0.0),
        (1e5, 0.0),
        (1.0, 1000.0),
        (1.0, -1e5),
    ] {
        let place = scale * Vec3::new(far + 0.3, 0.7 - far, far);
        let turned = Quat::from_rotation_x(0.3);
        let transform =
            Affine3A::from_scale_rotation_translation(Vec3::splat(scale), turned, place);
        let mesh = ball(texels, transform);
        let lamps = [
            Light::from(PointLight::new(
                place + scale * Vec3::new(1.0, 3.0, 2.0),
                100.0 * scale,
            )),
            Light::from(DirectionalLight::new(Vec3::new(0.2, 1.0, -0.3))),
        ];
        for lamp in lamps {
            let map = baked(&mesh, texels, &BakedLight::new(lamp), 0);
            let seen = map
                .visibility()
                .iter()
                .filter(|value| **value > 0.0)
                .count();
            let dark = darkened(&map);
            assert!(seen > 1500, "{seen}");
            assert_eq!(dark, 0, "scale {scale}, {far} from the origin, {lamp:?}");
        }
        // The twin: rays that start at the surface with nothing to tell it from casters.
        assert!(naively_hidden(&mesh, place + scale * Vec3::new(1.0, 3.0, 2.0)) > 20);
    }
}

/// Texels neither 0 (turned away, or nothing there) nor 1.
fn darkened(map: &LightMap) -> usize {
    let values = map.visibility().iter();
    values
        .filter(|value| **value != 0.0 && **value != 1.0)
        .count()
}

fn naively_hidden(mesh: &Unwrapped, light: Vec3) -> usize {
    let mut triangles = Triangles::default();
    triangles.add(&mesh.positions, &mesh.indices, Affine3A::IDENTITY);
    let hidden = triangles.0.iter().filter(|[a, b, c]| {
        let to = light.as_dvec3() - *a;
        let faces = (b - a).cross(c - a).dot(to) > 0.0;
        faces
            && (1..8).any(|k| {
                let [u, v] = [f64::from(k) / 17.0, f64::from(8 - k) / 19.0];
                let point: DVec3 = *a + u * (b - a) + v * (c - a);
                triangles
                    .nearest(point, light.as_dvec3() - point)
                    .is_some_and(|t| t < 1.0)
            })
    });
    hidden.count()
}

/// Bilinear sampling at the borders of charts finds the chart's own light, on mip levels too.
#[test]
fn the_margin_leaves_no_seams() {
    let mut yard = Yard::new(96);
    // Alone, so that all that faces the light is lit.
    yard.meshes.truncate(2);
    yard.meshes.remove(0);
    yard.scene = ReferenceScene::new(&[yard.meshes[0].object(true)]).unwrap();
    let image = yard.image();
    let points = yard.points(&image);
    assert!(points.len() > 300 && image.count(Class::Shadowed) == 0);
    let lamp = BakedLight::new(yard.lamp());
    let layout = yard.layout();
    let dark = |margin, levels: u32| {
        let descriptor = BakeDescriptor { samples: 4, margin };
        let mut map = yard.scene.bake(&layout, &lamp, &descriptor).unwrap();
        for _ in 0..levels {
            map = map.half().unwrap();
        }
        let scale = 0.5_f64.powi(levels as i32);
        let seen = points
            .iter()
            .map(|point| map.bilinear(point.at.map(|at| scale * at)));
        seen.filter(|value| *value < 1.0).count()
    };
    assert_eq!([dark(1, 0), dark(2, 0), dark(1, 1)], [0, 0, 0]);
    // The twin.
    assert!(
        dark(0, 0) > 10 && dark(0, 1) > 10,
        "{} {}",
        dark(0, 0),
        dark(0, 1)
    );
}

/// A box on the ground: dark below it up to its edge, and no gap of light where its shadow begins.
#[test]
fn a_resting_box_leaks_no_light() {
    let texels = 128;
    let ground = Unwrapped::new(&square(2.0, Affine3A::IDENTITY), texels, 0.0);
    let half = Vec3::new(0.5, 0.25, 0.5);
    let resting = Unwrapped::new(
        &cuboid(half, Affine3A::from_translation(Vec3::Y * half.y)),
        texels,
        2.0,
    );
    let layout = LightMapLayout::new([texels; 2], &[ground.receiver(whole(texels))]).unwrap();
    let light = BakedLight::new(DirectionalLight::new(Vec3::new(1.0, 1.0, 0.0)));
    // Of the texels under the box and its shadow, those that see any light.
    let lit = |scene: &ReferenceScene| {
        let map = scene
            .bake(&layout, &light, &BakeDescriptor::default())
            .unwrap();
        let at = |place: usize| (place as f64 + 0.5) / 32.0 - 2.0;
        let inside = |x: f64, z: f64| (-1.0..0.5).contains(&x) && (-0.5..0.5).contains(&z);
        let texels = (0..128 * 128).filter(|place| inside(at(place % 128), at(place / 128)));
        // u goes along x, v along z.
        let (mut lit, mut count) = (0, 0);
        for place in texels {
            lit += usize::from(map.visibility()[place] > 0.0);
            count += 1;
        }
        assert_eq!(count, 48 * 32);
        lit
    };
    let objects = [ground.object(true), resting.object(true)];
    assert_eq!(lit(&ReferenceScene::new(&objects).unwrap()), 0);
    // The twin: the box a texel above the ground.
    let above = Affine3A::from_translation(Vec3::Y * (half.y + 1.0 / 32.0));
    let hovering = Unwrapped::new(&cuboid(half, above), texels, 2.0);
    let objects = [ground.object(true), hovering.object(true)];
    assert!(lit(&ReferenceScene::new(&objects).unwrap()) >= 32);
}

/// Powers of two scale without rounding: the same map, bit by bit.
#[test]
fn scale_changes_nothing() {
    let bake = |scale: f32| {
        let yard = Yard::scaled(48, scale);
        let emitter = Emitter::Sphere {
            radius: 0.3 * scale,
        };
        yard.bake(&BakedLight::new(yard.lamp()).with_emitter(emitter), 16)
    };
    let own = bake(1.0);
    for scale in [2.0_f32.powi(-13), 2.0_f32.powi(17)] {
        assert!(bake(scale).visibility() == own.visibility(), "{scale}");
    }
    // With others, what rounding of the positions moves.
    for scale in [1e-4, 1e5] {
        let other = bake(scale);
        let pairs = own.visibility().iter().zip(other.visibility());
        let different = pairs.filter(|(a, b)| (*a - *b).abs() > 0.1).count();
        assert!(different < 5, "{scale}: {different}");
    }
    // The twin: a lamp that does not scale with the scene.
    let yard = Yard::scaled(48, 2.0);
    let lamp = BakedLight::new(Yard::new(48).lamp());
    assert!(yard.bake(&lamp, 16).visibility() != own.visibility());
}

#[test]
fn threads_change_nothing_and_progress_is_told() {
    let yard = Yard::new(48);
    let lamp = BakedLight::new(yard.lamp()).with_emitter(Emitter::Sphere { radius: 0.3 });
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| yard.bake(&lamp, 8))
    };
    assert!(on(1).visibility() == on(3).visibility());
    static LAST: AtomicU64 = AtomicU64::new(0);
    let told = |part: f64| {
        assert!(part > 0.0 && part <= 1.0);
        LAST.fetch_max(part.to_bits(), Ordering::Relaxed);
    };
    let scene = yard.scene.clone().with_progress(told);
    scene
        .bake(&yard.layout(), &lamp, &BakeDescriptor::default())
        .unwrap();
    assert_eq!(f64::from_bits(LAST.load(Ordering::Relaxed)), 1.0);
}

/// A texel that a chart covers in part holds what is on the chart, not what its plane has beyond.
#[test]
fn a_texel_covered_in_part_is_the_mean_of_that_part() {
    let corners = [
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(0.0, 0.0, 1.0),
        Vec3::new(1.0, 0.0, 1.0),
        Vec3::new(1.0, 0.0, 0.0),
    ];
    let mesh = |width: f32| {
        let mut mesh = Unwrapped::new(&[corners.to_vec()], 8, 0.0);
        for (position, uv) in mesh.positions.iter_mut().zip(&mut mesh.uvs) {
            position[0] *= width;
            uv[0] *= width;
        }
        mesh
    };
    // All beyond 3.3 texels is in shadow.
    let roof = Unwrapped::new(
        &[corners
            .map(|c| Vec3::new(3.3 / 8.0 + c.x, 1.0, 3.0 * c.z - 1.0))
            .to_vec()],
        8,
        0.0,
    );
    let scene = ReferenceScene::new(&[roof.object(true)]).unwrap();
    let light = BakedLight::new(DirectionalLight::new(Vec3::Y));
    let column = |width: f32| {
        let mesh = mesh(width);
        let layout = LightMapLayout::new([8; 2], &[mesh.receiver(whole(8))]).unwrap();
        let descriptor = BakeDescriptor {
            samples: 256,
            margin: 0,
        };
        let map = scene.bake(&layout, &light, &descriptor).unwrap();
        (map.visibility()[3], layout.coverage()[3])
    };
    let (seen, covered) = column(3.3 / 8.0);
    assert_eq!(seen, 1.0);
    assert!((covered - 0.3).abs() < 1e-5, "{covered}");
    // The twin: the chart covers the whole texel.
    let (seen, covered) = column(0.5);
    assert!(
        (seen - 0.3).abs() < 0.01 && covered > 0.9999,
        "{seen} {covered}"
    );
}
