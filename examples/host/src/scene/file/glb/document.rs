//! A glTF file as a document that has been checked.

use anyhow::{Context, Result, bail};
use gltf::json::Root;
use gltf::json::validation::Checked;
use gltf::{Document, Glb, Semantic};

use super::super::Model;

/// The same mesh in many places.
pub const INSTANCING: &str = "EXT_mesh_gpu_instancing";
/// Positions of few bits.
const QUANTIZATION: &str = "KHR_mesh_quantization";
/// What extensions begin with that change nothing that casts.
const HARMLESS: [&str; 8] = [
    "KHR_materials_",
    "EXT_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_xmp",
];

fn is_read(extension: &str) -> bool {
    [INSTANCING, QUANTIZATION].contains(&extension)
        || HARMLESS.iter().any(|start| extension.starts_with(start))
}

/// The document and the binary part of a `.glb`.
///
/// # Errors
/// If it is no glTF, or requires an extension that is not read.
pub fn read(bytes: &[u8], model: &mut Model) -> Result<(Document, Option<Vec<u8>>)> {
    let invalid = "it is not a valid glTF file";
    let (json, binary) = match bytes.starts_with(b"glTF") {
        true => {
            let glb = Glb::from_slice(bytes).context(invalid)?;
            (glb.json.into_owned(), glb.bin.map(|bin| bin.into_owned()))
        }
        false => (bytes.to_vec(), None),
    };
    let mut root: Root = gltf::json::deserialize::from_slice(&json).context(invalid)?;
    if let Some(extension) = root.extensions_required.iter().find(|name| !is_read(name)) {
        bail!(
            "it requires the extension {extension}, which is not read here; write the file without it"
        );
    }
    for extension in root.extensions_used.iter().filter(|name| !is_read(name)) {
        model.leave_out(&format!("extension {extension}"));
    }
    // The library validates by its own list.
    root.extensions_required.clear();
    repair(&mut root, model)?;
    let document = Document::from_json(root).context(invalid)?;
    Ok((document, binary))
}

/// Takes out what the library would refuse a whole file for, and refuses what it would panic at.
fn repair(root: &mut Root, model: &mut Model) -> Result<()> {
    let semantic = Checked::Valid(Semantic::Positions);
    let mut positions: Vec<usize> = Vec::new();
    for mesh in &mut root.meshes {
        mesh.primitives.retain(|primitive| {
            let accessor = primitive.attributes.get(&semantic);
            positions.extend(accessor.map(|index| index.value()));
            if accessor.is_none() {
                model.leave_out("primitives without positions");
            }
            accessor.is_some()
        });
    }
    // Their bounds are demanded, often missing, and not used here.
    let unused = gltf::json::serialize::to_value([0.0_f32; 3])?;
    let count = root.accessors.len();
    for place in positions {
        let accessor = root.accessors.get_mut(place);
        let accessor = accessor
            .with_context(|| format!("it asks for accessor {place}, and there are {count}"))?;
        accessor.min = Some(unused.clone());
        accessor.max = Some(unused.clone());
    }
    Ok(())
}
