//! The places of a mesh that is drawn many times (EXT_mesh_gpu_instancing).

use std::collections::BTreeSet;

use anyhow::{Context, Result, ensure};
use gltf::json::Value;
use gltf::{Accessor, Document};
use shadows::glam::{DMat4, DQuat, Quat, Vec3};

use super::accessor::Buffers;

/// Node space from each instance's; an attribute that is not there moves nothing.
///
/// # Errors
/// If attributes are missing, broken or not of one count.
pub fn read(document: &Document, buffers: &Buffers, extension: &Value) -> Result<Vec<DMat4>> {
    let find = |name| accessor(document, extension, name).transpose();
    let vectors = |name| find(name)?.map(|a| buffers.floats::<3>(&a)).transpose();
    let translations = vectors("TRANSLATION")?;
    let scales = vectors("SCALE")?;
    let rotations = find("ROTATION")?.map(|a| buffers.floats::<4>(&a));
    let rotations = rotations.transpose()?;
    let counts = [
        translations.as_ref().map(Vec::len),
        rotations.as_ref().map(Vec::len),
        scales.as_ref().map(Vec::len),
    ];
    let counts: BTreeSet<usize> = counts.into_iter().flatten().collect();
    ensure!(
        counts.len() == 1,
        "it needs attributes of one count, not {counts:?}"
    );
    let instance = |i: usize| {
        let translation = translations.as_ref().map_or(Vec3::ZERO, |t| t[i].into());
        let rotation = rotations
            .as_ref()
            .map(|r| Quat::from_array(r[i]).as_dquat());
        let scale = scales.as_ref().map_or(Vec3::ONE, |s| s[i].into());
        DMat4::from_scale_rotation_translation(
            scale.as_dvec3(),
            rotation.map_or(DQuat::IDENTITY, DQuat::normalize),
            translation.as_dvec3(),
        )
    };
    let count = counts.into_iter().sum();
    Ok((0..count).map(instance).collect())
}

/// The accessor of an attribute, if it is there.
fn accessor<'a>(
    document: &'a Document,
    extension: &Value,
    name: &str,
) -> Option<Result<Accessor<'a>>> {
    let place = extension["attributes"].get(name)?;
    let index = place.as_u64().and_then(|index| usize::try_from(index).ok());
    let found = index.and_then(|index| document.accessors().nth(index));
    Some(found.with_context(|| format!("{name} has no accessor {place}")))
}
