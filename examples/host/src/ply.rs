//! Writes a scene as one PLY file in world space, for other tools to measure or look at.
//!
//! The format (Turk 1994) needs no more than a header and packed numbers, hence no crate for it.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use super::scene::{Object, Scene};

/// Writes all objects, one after another, as binary little-endian PLY.
///
/// Vertices are doubles in world space: the f32 positions through the f32 transforms, computed in
/// f64. Each face is a triangle, counter-clockwise outside (turned round under a mirroring
/// transform), with the number of its object in `scene.objects` and whether it casts (0 or 1).
///
/// # Errors
/// Whatever creating or writing the file gives.
pub fn write_ply(path: &Path, scene: &Scene) -> io::Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    write_header(&mut out, scene)?;
    for object in &scene.objects {
        for p in scene.world_points(object) {
            for x in p.to_array() {
                out.write_all(&x.to_le_bytes())?;
            }
        }
    }
    let mut first = 0;
    for (number, object) in scene.objects.iter().enumerate() {
        write_faces(&mut out, scene, object, number, first)?;
        first += scene.meshes[object.mesh].positions.len() as u32;
    }
    out.flush()
}

fn write_header(out: &mut impl Write, scene: &Scene) -> io::Result<()> {
    let meshes = scene.objects.iter().map(|o| &scene.meshes[o.mesh]);
    let vertices: usize = meshes.map(|m| m.positions.len()).sum();
    if u32::try_from(vertices).is_err() {
        let message = "more vertices than PLY's 32-bit indices can name";
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    writeln!(out, "ply")?;
    writeln!(out, "format binary_little_endian 1.0")?;
    writeln!(out, "element vertex {vertices}")?;
    for axis in ["x", "y", "z"] {
        writeln!(out, "property double {axis}")?;
    }
    writeln!(out, "element face {}", scene.triangle_count())?;
    writeln!(out, "property list uchar uint vertex_indices")?;
    writeln!(out, "property int object")?;
    writeln!(out, "property uchar casts")?;
    writeln!(out, "end_header")
}

fn write_faces(
    out: &mut impl Write,
    scene: &Scene,
    object: &Object,
    number: usize,
    first: u32,
) -> io::Result<()> {
    let mirrored = object.transform.matrix3.determinant() < 0.0;
    for [a, b, c] in scene.meshes[object.mesh].triangles() {
        let corners = if mirrored { [a, c, b] } else { [a, b, c] };
        out.write_all(&[3])?;
        for i in corners {
            out.write_all(&(first + i).to_le_bytes())?;
        }
        out.write_all(&(number as i32).to_le_bytes())?;
        out.write_all(&[u8::from(object.casts)])?;
    }
    Ok(())
}
