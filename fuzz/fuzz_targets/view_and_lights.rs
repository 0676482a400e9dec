//! Views and lights of any numbers, and their placing in f64.
#![no_main]

use libfuzzer_sys::fuzz_target;
use shadows::glam::{DMat4, DVec3};
use shadows::{HomogeneousLight, View};
use shadows_fuzz::scene::{Camera, Light, Projection};

fuzz_target!(|input: (Camera, Projection, Light, [f64; 16], [f64; 3])| {
    let (camera, projection, light, numbers, origin) = input;
    if let Some(view) = camera.view(projection) {
        let (centre, radius) = view.near_sphere();
        assert!(centre.is_finite() && radius >= 0.0);
    }
    let origin = DVec3::from_array(origin);
    let matrix = DMat4::from_cols_array(&numbers);
    let convention = projection.convention();
    let _ = View::placed(matrix, origin, convention);
    let _ = View::placed(camera.matrix(projection).as_dmat4(), origin, convention);

    let _ = HomogeneousLight::placed(light.point().position.as_dvec3(), origin).validate();
    if light.point().validate().is_ok() {
        assert_eq!(light.point().homogeneous().validate(), Ok(()));
    }
    if light.spot().validate().is_ok() {
        assert_eq!(light.point().validate(), Ok(()));
        assert_eq!(light.spot().homogeneous().validate(), Ok(()));
    }
    let directional = light.directional();
    let homogeneous = directional.homogeneous().validate();
    assert_eq!(directional.validate().is_ok(), homogeneous.is_ok());
});
