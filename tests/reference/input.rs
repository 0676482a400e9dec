//! What is refused, and what is told meanwhile.

use std::sync::{Arc, Mutex};

use shadows::error::{LightError, ReferenceError};
use shadows::glam::{DAffine3, DVec3, Mat4, Vec3};
use shadows::reference::{Interior, ReferenceScene};
use shadows::{HomogeneousLight, SpotLight};

use crate::scene::{EYE, Mesh, downward, ground};

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
        fail(4, 4, HomogeneousLight::directional(Vec3::ZERO), None),
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
    let flat = |scale: f32, size| Interior::FlatMap {
        clip_from_world: Mat4::from_scale(Vec3::splat(scale)),
        size,
        kernel_radius: 0.0,
    };
    assert!(image.compare(&visibility, flat(1.0, 64)).is_ok());
    for wrong in [flat(f32::NAN, 64), flat(1.0, 0)] {
        let error = image.compare(&visibility, wrong);
        assert!(matches!(error, Err(ReferenceError::Interior { .. })));
    }
    let of_light_map = |texel| Interior::LightMap { texel };
    assert!(image.compare(&visibility, of_light_map(0.1)).is_ok());
    for texel in [0.0, -1.0, f32::INFINITY] {
        let error = image.interior_pixels(of_light_map(texel));
        assert_eq!(error, Err(ReferenceError::Texel(texel)));
    }
    let spot = SpotLight::new(Vec3::Y, Vec3::NEG_Y, 0.0, 9.0);
    assert_eq!(
        scene.render_spot(&view, 4, 4, &spot).err(),
        Some(LightError::HalfAngle(0.0).into())
    );
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
