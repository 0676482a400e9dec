//! Wavefront OBJ: groups as meshes, polygons as fans, everything else ignored.

use anyhow::{Context, Result, anyhow};
use shadows::glam::Affine3A;

use super::{Model, checked};

/// OBJ files seldom say where they are smooth; faces that meet at less than this are, in degrees.
const CREASE: f64 = 60.0;

pub(super) fn parse(bytes: Vec<u8>) -> Result<Model> {
    let text = String::from_utf8(bytes).context("it is not UTF-8 text")?;
    // Materials are not used; not opening them means that a missing one is no error.
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    let (groups, _) =
        tobj::load_obj_buf(&mut text.as_bytes(), &tobj::GPU_LOAD_OPTIONS, no_materials)
            .map_err(|e| anyhow!("it is not a valid OBJ file: {e}"))?;
    let mut model = Model::default();
    for group in groups {
        if group.mesh.indices.is_empty() {
            continue;
        }
        let normals = triples(&group.mesh.normals);
        let mesh = checked(
            &group.name,
            triples(&group.mesh.positions),
            Some(normals),
            group.mesh.indices,
            CREASE,
        )?;
        model.meshes.push(mesh);
        model.put(model.meshes.len() - 1, Affine3A::IDENTITY);
    }
    Ok(model)
}

fn triples(flat: &[f32]) -> Vec<[f32; 3]> {
    flat.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()
}
