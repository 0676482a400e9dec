//! Meshes that ellipsoids stand for, against the area of the light that their triangles leave.

use shadows::glam::{Affine3A, DAffine3, DVec3, Mat4, Quat, Vec3, camera::rh};
use shadows::reference::{ReferenceObject, ReferenceScene};
use shadows::{Blob, BlobFrame, BlobLight, DepthConvention, HomogeneousLight, View};

use super::ask::{Question, answers, errors};
use crate::common::noop;
use crate::common::shapes::{Shape, cuboid, sphere, square};
use host::gpu::Gpu;

const LIGHT: Vec3 = Vec3::new(0.6, 6.0, 0.9);
const SIDE: u32 = 48;

/// The error on the floor of a caster of half a metre or so, whose bottom is at `above`, under a light of this
/// radius: root mean square and largest, of visibility, over the points that are not fully lit in truth or in
/// the picture.
fn error(gpu: &Gpu, shape: &Shape, transform: Affine3A, radius: f32) -> [f64; 2] {
    error_of(gpu, shape, transform, radius, |blob| blob)
}

fn error_of(
    gpu: &Gpu,
    shape: &Shape,
    transform: Affine3A,
    radius: f32,
    change: impl FnOnce(Blob) -> Blob,
) -> [f64; 2] {
    // From straight above, so that each pixel is a place of the floor; the near plane cuts off all else.
    let projection = rh::proj::directx::orthographic(-1.6, 1.6, -1.6, 1.6, 1.0, 1e-3);
    let camera = rh::view::look_at_mat4(Vec3::Y * 0.01, Vec3::ZERO, Vec3::Z);
    let clip_from_world: Mat4 = projection * camera;
    let view = View::new(clip_from_world, DepthConvention::FiniteReverse).unwrap();
    let ground = square(3.0);
    let object = |shape: &Shape, transform: Affine3A, casts| {
        let m = transform.matrix3;
        let columns = [m.x_axis, m.y_axis, m.z_axis].map(|axis| Vec3::from(axis).as_dvec3());
        let [x, y, z] = columns;
        let at: DVec3 = Vec3::from(transform.translation).as_dvec3();
        (shape.clone(), DAffine3::from_cols(x, y, z, at), casts)
    };
    let objects = [
        object(&ground, Affine3A::IDENTITY, false),
        object(shape, transform, true),
    ];
    let objects: Vec<ReferenceObject<'_>> = objects
        .iter()
        .map(|(shape, transform, casts)| ReferenceObject {
            positions: &shape.positions,
            indices: &shape.indices,
            transform: *transform,
            casts: *casts,
        })
        .collect();
    let scene = ReferenceScene::new(&objects).unwrap();
    let light = HomogeneousLight::point(LIGHT);
    let image = scene.render(&view, SIDE, SIDE, light, None).unwrap();
    let pixels: Vec<[u32; 2]> = (0..SIDE * SIDE).map(|i| [i % SIDE, i / SIDE]).collect();
    let exact = image.area_visibility(&pixels, f64::from(radius), 1024);
    let world = clip_from_world.inverse();
    let place = |&[x, y]: &[u32; 2]| {
        let clip = [x, y].map(|at| 2.0 * (at as f32 + 0.5) / SIDE as f32 - 1.0);
        let at = world.project_point3(Vec3::new(clip[0], -clip[1], 0.5));
        Question::of(Vec3::new(at.x, 0.0, at.z), 0)
    };
    let questions: Vec<Question> = pixels.iter().map(place).collect();
    let blob = change(Blob::of_caster(&shape.caster(&noop().0, transform)));
    let frame = BlobFrame {
        lights: &[BlobLight::new(light, radius, 100.0)],
        blobs: &[blob],
        ..Default::default()
    };
    let shown = answers(gpu, &frame, &questions);
    let counted = shown.into_iter().zip(exact);
    let (shown, exact): (Vec<f32>, Vec<f64>) = counted
        .filter_map(|(shown, exact)| Some((shown, exact?)))
        .filter(|(shown, exact)| *shown < 1.0 || *exact < 1.0)
        .unzip();
    assert!(exact.len() > 15, "{}", exact.len());
    errors(&shown, &exact)
}

fn at(height: f32) -> Affine3A {
    Affine3A::from_translation(Vec3::Y * height)
}

#[test]
fn errors_are_those_of_the_shape() {
    let Some(gpu) = Gpu::for_test() else { return };
    let ball = sphere(47, 96);
    let turn = Quat::from_axis_angle(Vec3::new(1.0, 0.3, 0.5).normalize(), 0.8);
    let egg = at(1.0) * Affine3A::from_quat(turn) * Affine3A::from_scale(Vec3::new(0.3, 0.6, 0.4));
    let crate_ = cuboid(Vec3::new(0.45, 0.4, 0.35));
    let turned = |height| at(height) * Affine3A::from_rotation_y(0.5);
    let pole = cuboid(Vec3::new(0.02, 0.8, 0.02));
    let tile = cuboid(Vec3::new(0.6, 0.03, 0.45));
    let cases: [(&str, [f64; 2], &Shape, Affine3A); 6] = [
        (
            "ball",
            [0.01, 0.05],
            &ball,
            at(1.0) * Affine3A::from_scale(Vec3::splat(0.5)),
        ),
        ("egg", [0.01, 0.05], &ball, egg),
        ("crate, 1 m above", [0.26, 0.9], &crate_, turned(1.4)),
        ("crate, standing", [0.36, 1.0], &crate_, turned(0.4)),
        ("pole, standing", [0.1, 0.3], &pole, at(0.8)),
        ("tile, 1 m above", [0.3, 1.0], &tile, turned(1.0)),
    ];
    for (name, bounds, shape, transform) in cases {
        let [rms, largest] = error(&gpu, shape, transform, 0.3);
        println!("{name}: rms {rms:.4}, largest {largest:.3}");
        assert!(
            rms <= bounds[0] && largest <= bounds[1],
            "{name}: {rms} {largest}"
        );
    }
    // The twins: a light of another size; a ball for an egg; the inscribed and the circumscribed ellipsoid of
    // a box, than which the one between is better.
    let [soft, _] = error(&gpu, &ball, egg, 0.3);
    let [round, _] = error_of(&gpu, &ball, egg, 0.3, |blob| {
        Blob::sphere(blob.centre, 0.43)
    });
    assert!(round > 5.0 * soft, "{round} {soft}");
    let of = |factor| error_of(&gpu, &crate_, turned(1.4), 0.3, |blob| blob.scaled(factor))[0];
    let [inscribed, fitted, around] = [1.0 / 1.227, 1.0, 3.0_f32.sqrt() / 1.227].map(of);
    println!("crate: inscribed {inscribed:.4}, fitted {fitted:.4}, around {around:.4}");
    assert!(fitted < inscribed && fitted < 0.6 * around);
}
