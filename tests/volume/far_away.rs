//! Scenes so far from the origin that f32 cannot place them.

use shadows::glam::{Affine3A, DAffine3, DMat4, DVec3, Mat4, Vec3};
use shadows::{Caster, DepthConvention, HomogeneousLight, View};

use crate::pictures::{lamp, mixed, sun};
use crate::stage::Stage;
use host::gpu::Gpu;

/// The stage, everything in it moved by an offset, in f64.
struct Moved<'a> {
    stage: &'a Stage,
    offset: DVec3,
}

impl Moved<'_> {
    fn transform(&self, transform: Affine3A) -> DAffine3 {
        let near = DAffine3::from_mat4(DMat4::from_cols_array(
            &Mat4::from(transform).to_cols_array().map(f64::from),
        ));
        DAffine3::from_translation(self.offset) * near
    }

    fn clip_from_world(&self) -> DMat4 {
        let near = self.stage.view().clip_from_world().as_dmat4();
        near * DMat4::from_translation(-self.offset)
    }

    /// As `placed` has it, from the origin of its choice.
    fn placed(&self, gpu: &Gpu, origin: DVec3) -> Stage {
        let mut stage = self.stage.clone();
        let clip = self.clip_from_world();
        stage.placed_view = Some(View::placed(clip, origin, stage.depth).unwrap());
        let mesh = stage.casters(gpu)[0].mesh.clone();
        for body in &mut stage.bodies {
            let place = self.transform(body.transform);
            body.transform = Caster::placed(mesh.clone(), place, origin).world_from_object;
        }
        if !stage.light.is_directional() {
            let position = stage.light.xyzw().truncate().as_dvec3() + self.offset;
            stage.light = HomogeneousLight::placed(position, origin);
        }
        stage
    }
}

fn stages() -> [Stage; 2] {
    [mixed(lamp()), mixed(sun())]
}

/// Far off the axes, and not a round number.
fn offset(distance: f64) -> DVec3 {
    DVec3::new(0.61, -0.48, 0.63) * distance + DVec3::new(0.1, 0.2, 0.3)
}

#[test]
fn far_from_the_origin_a_scene_looks_as_it_does_there() {
    let Some(gpu) = Gpu::for_test() else { return };
    for stage in stages() {
        let truth = stage.truth();
        for distance in [1e5, 1e6, 1e7] {
            let moved = Moved {
                stage: &stage,
                offset: offset(distance),
            };
            let eye = moved.offset + stage.eye.as_dvec3();
            // Counted from the eye, and from a point that the eye has left.
            for origin in [eye, eye + DVec3::new(30.0, -20.0, 10.0)] {
                let found = truth.errors(&moved.placed(&gpu, origin).draw(&gpu));
                let what = format!("{distance}, {:?}: {found:?}", stage.light);
                assert!(found.interior > 10_000 && found.shadowed > 500, "{what}");
                assert_eq!(found.wrong, 0, "{what}");
            }
        }
    }
}

#[test]
fn rounded_to_f32_it_does_not() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = mixed(lamp());
    let moved = Moved {
        stage: &stage,
        offset: offset(1e7),
    };
    let rounded = moved.placed(&gpu, DVec3::ZERO);
    assert!(stage.truth().errors(&rounded.draw(&gpu)).wrong > 500);
}

#[test]
fn a_matrix_that_is_no_view_is_refused_when_placed() {
    let singular = DMat4::from_scale(DVec3::new(0.0, 1.0, 1.0));
    assert!(View::placed(singular, DVec3::ONE, DepthConvention::Standard).is_err());
    let place = DAffine3::from_translation(DVec3::splat(1e9));
    assert_eq!(
        HomogeneousLight::placed(place.translation, DVec3::splat(1e9 - 1.0)),
        HomogeneousLight::point(Vec3::ONE)
    );
}
