//! A scene as the reference takes it.

use shadows::error::ReferenceError;
use shadows::reference::{ReferenceObject, ReferenceScene};

use super::scene::{Object, Scene, widened};

/// The scene's triangles, ready for rays.
///
/// # Errors
/// If an index or a position is broken.
pub fn reference_scene(scene: &Scene) -> Result<ReferenceScene, ReferenceError> {
    let object = |object: &Object| {
        let mesh = &scene.meshes[object.mesh];
        ReferenceObject {
            positions: &mesh.positions,
            indices: &mesh.indices,
            transform: widened(&object.transform),
            casts: object.casts,
        }
    };
    let objects: Vec<ReferenceObject<'_>> = scene.objects.iter().map(object).collect();
    ReferenceScene::new(&objects)
}
