//! A scene as the reference takes it.

use shadows::error::ReferenceError;
use shadows::reference::{Crossing, ReferenceObject, ReferenceScene};

use super::scene::{Object, Scene, leaf_mask, widened};

/// The scene's triangles, ready for rays, without what leaf masks cut out of them.
///
/// # Errors
/// If an index or a position is broken.
pub fn reference_scene(scene: &Scene) -> Result<ReferenceScene, ReferenceError> {
    let solid = solid_scene(scene)?;
    if scene.meshes.iter().all(|mesh| mesh.mask.is_empty()) {
        return Ok(solid);
    }
    let meshes = scene.meshes.iter();
    let masks: Vec<(Vec<u32>, Vec<[f32; 2]>)> = meshes
        .map(|mesh| match mesh.mask.is_empty() {
            true => Default::default(),
            false => (mesh.indices.clone(), mesh.mask.clone()),
        })
        .collect();
    let objects: Vec<usize> = scene.objects.iter().map(|object| object.mesh).collect();
    Ok(solid.with_opacity(move |crossing| {
        let (indices, mask) = &masks[objects[crossing.object as usize]];
        mask.is_empty() || leaf_mask::is_leaf(place(crossing, indices, mask))
    }))
}

/// The same as if all masks were opaque.
///
/// # Errors
/// As [`reference_scene`].
pub fn solid_scene(scene: &Scene) -> Result<ReferenceScene, ReferenceError> {
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

/// Where in its mask a ray meets a triangle.
fn place(crossing: &Crossing, indices: &[u32], mask: &[[f32; 2]]) -> [f64; 2] {
    let first = 3 * crossing.triangle as usize;
    let corners = [0, 1, 2].map(|k| mask[indices[first + k] as usize]);
    [0, 1].map(|axis| {
        let parts = corners.iter().zip(crossing.weights);
        parts
            .map(|(corner, weight)| f64::from(corner[axis]) * weight)
            .sum()
    })
}
