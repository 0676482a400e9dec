//! What a technique has been through when its picture is taken.

use anyhow::Result;
use shadows::glam::Vec3;
use shadows::{Caster, View};

use crate::shadow::{Shadow, ShadowInputs};
use crate::stage::{Picture, Stage};
use host::gpu::Gpu;
use host::renderer::matrix;
use host::scene::moved_light;

/// Added at once, so that buffers grow.
const MANY: usize = 300;

/// The frames before the picture that is judged, or with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    /// None.
    Fresh,
    /// Casters came and went.
    ComeAndGo,
    /// Another view, of casters and a light that have moved on, is prepared and recorded behind it in
    /// the same submission.
    TwoViews,
}

impl Course {
    /// The picture that is judged.
    ///
    /// # Errors
    /// If the technique refuses a frame.
    pub fn picture(self, gpu: &Gpu, stage: &Stage, shadow: &mut Shadow) -> Result<Picture> {
        match self {
            Self::Fresh => {}
            Self::ComeAndGo => {
                for casters in comings(&stage.inputs.casters) {
                    let inputs = ShadowInputs {
                        casters,
                        ..stage.inputs.clone()
                    };
                    stage.picture(gpu, shadow, &inputs)?;
                }
            }
            Self::TwoViews => return before_another(gpu, stage, shadow),
        }
        stage.picture(gpu, shadow, &stage.inputs)
    }
}

/// The first goes, one in the middle, the last; one leaves the range; many come.
fn comings(all: &[Caster]) -> Vec<Vec<Caster>> {
    let without = |place: usize| {
        let mut casters = all.to_vec();
        casters.remove(place);
        casters
    };
    let moved = |caster: &Caster, by: Vec3| {
        let mut caster = caster.clone();
        caster.world_from_object.translation += shadows::glam::Vec3A::from(by);
        caster
    };
    let mut far = all.to_vec();
    far[0] = moved(&all[0], Vec3::Y * 1e4);
    let many = (0..MANY).map(|n| moved(&all[n % all.len()], Vec3::Y * 0.01 * n as f32));
    vec![
        all.to_vec(),
        without(0),
        all.to_vec(),
        without(all.len() / 2),
        all.to_vec(),
        without(all.len() - 1),
        far,
        many.chain(all.iter().cloned()).collect(),
        all.iter().rev().cloned().collect(),
    ]
}

fn before_another(gpu: &Gpu, stage: &Stage, shadow: &mut Shadow) -> Result<Picture> {
    let mut scene = stage.scene.clone();
    scene.camera.eye += Vec3::new(-2.0, 1.0, -1.0);
    let (renderer, look) = (&stage.renderer, stage.renderer.look());
    let mut other = stage.inputs.clone();
    other.view = View::new(matrix(&scene, renderer.size(), look), look.depth)?;
    other.depths = None;
    other.light = moved_light(other.light, Vec3::new(0.4, 0.1, 0.2));
    for caster in &mut other.casters {
        caster.world_from_object.translation.x += 0.3;
    }
    shadow.prepare(gpu, &stage.inputs)?;
    let mut answer = Ok(());
    gpu.run(|encoder| {
        renderer.draw_ambient(encoder, &stage.scene_gpu);
        shadow.generate(renderer, &stage.scene_gpu, encoder);
        shadow.shade(renderer, &stage.scene_gpu, encoder);
        answer = shadow.prepare(gpu, &other);
        if answer.is_ok() {
            shadow.generate(renderer, &stage.scene_gpu, encoder);
        }
    });
    answer?;
    Ok(Picture {
        visibility: renderer.read_visibility(gpu),
        shaded: renderer.read_shaded(gpu),
    })
}
