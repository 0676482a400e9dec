//! Bad input, which must be refused by name, and degenerate sizes, which must work or be refused.

use std::fmt::Display;

use anyhow::Result;
use shadows::glam::{Affine3A, Mat4, Vec3, Vec4};
use shadows::mesh::{Adjacency, Topology};
use shadows::{
    Caster, CubeShadowMap, CubeShadowMapDescriptor, DepthConvention, ShadowMap,
    ShadowMapDescriptor, View,
};

use super::cases::mesh::split_square;
use super::situation::{Situation, at, lamp, sun};
use super::table::Refusal;
use super::{SIDE, SIZE, small};
use crate::shadow::{Shadow, ShadowInputs};
use crate::stage::Stage;
use crate::table::named;
use crate::technique::Technique;
use host::gpu::Gpu;
use host::random::Random;
use host::scene::{Scene, homogeneous};
use host::shapes::{self, Shape};

/// Tries all of it.
///
/// # Errors
/// If the device cannot draw the scene that the input is a change of.
pub fn refusals(gpu: &Gpu) -> Result<Vec<Refusal>> {
    let mut all = meshes();
    all.push(t_junction(&split_square()));
    all.extend(sizes(gpu));
    all.extend(small::maps(gpu)?);
    for name in ["cube-2x2", "flat-2x2", "volume"] {
        let technique = named(name, SIDE)?;
        all.extend(frames(gpu, &technique)?);
        all.extend(degenerate(gpu, &technique)?);
    }
    Ok(all)
}

/// What was refused says why; what was not is a defect.
fn refused<T, E: Display>(what: impl Into<String>, result: Result<T, E>) -> Refusal {
    Refusal {
        what: what.into(),
        outcome: match result {
            Err(error) => Ok(format!("refused: {error}")),
            Ok(_) => Err("taken, and should have been refused".into()),
        },
    }
}

fn works<T, E: Display>(what: impl Into<String>, result: Result<T, E>) -> Refusal {
    Refusal {
        what: what.into(),
        outcome: match result {
            Ok(_) => Ok("works".into()),
            Err(error) => Err(format!("refused: {error}")),
        },
    }
}

fn meshes() -> Vec<Refusal> {
    let shape = shapes::cube();
    let with = |bad: f32| {
        let mut positions = shape.positions.clone();
        positions[3][1] = bad;
        Adjacency::new(&positions, &shape.indices)
    };
    let mut beyond = shape.indices.clone();
    beyond[4] = shape.positions.len() as u32;
    let view = |matrix| View::new(matrix, DepthConvention::InfiniteReverse);
    vec![
        refused("a vertex with a NaN", with(f32::NAN)),
        refused("a vertex at infinity", with(f32::INFINITY)),
        refused(
            "an index past the end",
            Adjacency::new(&shape.positions, &beyond),
        ),
        refused(
            "seven indices",
            Adjacency::new(&shape.positions, &shape.indices[..7]),
        ),
        refused("a view matrix of NaN", view(Mat4::NAN)),
        refused("a view matrix of zeros", view(Mat4::ZERO)),
    ]
}

/// What the topology report says of a square with a T-junction: beside its four sides, the split
/// edge and its two parts are open.
pub fn t_junction(shape: &Shape) -> Refusal {
    let report = Adjacency::new(&shape.positions, &shape.indices).map(|mesh| *mesh.topology());
    Refusal {
        what: "a T-junction in a square".into(),
        outcome: match report {
            Ok(Topology {
                closed: false,
                open_edges: 7,
                ..
            }) => Ok(format!("reported: {}", report_line(&report))),
            _ => Err(format!("not reported: {}", report_line(&report))),
        },
    }
}

fn report_line<T: Display, E: Display>(report: &Result<T, E>) -> String {
    match report {
        Ok(topology) => topology.to_string(),
        Err(error) => error.to_string(),
    }
}

fn sizes(gpu: &Gpu) -> Vec<Refusal> {
    let over = gpu.device.limits().max_texture_dimension_2d + 1;
    let cube = |size| {
        let descriptor = CubeShadowMapDescriptor {
            size,
            ..Default::default()
        };
        CubeShadowMap::new(&gpu.device, &descriptor)
    };
    let flat = |size| {
        let descriptor = ShadowMapDescriptor {
            size,
            ..Default::default()
        };
        ShadowMap::new(&gpu.device, &descriptor)
    };
    vec![
        refused("cube faces of no texel", cube(0)),
        refused("cube faces over the limit", cube(over)),
        refused("a flat map of no texel", flat(0)),
        refused("a flat map over the limit", flat(over)),
    ]
}

/// A scene that the technique can shadow.
fn scene(technique: &Technique) -> Scene {
    let random = &mut Random(0);
    let directional = technique.name.starts_with("flat");
    let light = if directional {
        sun(random)
    } else {
        lamp(random)
    };
    Situation::new("", light, random)
        .caster(&shapes::cube(), at(0.0, 1.5, 0.0))
        .scene
}

/// What a frame tells a technique, with one number spoilt.
fn frames(gpu: &Gpu, technique: &Technique) -> Result<Vec<Refusal>> {
    let stage = Stage::new(gpu, scene(technique), SIZE)?;
    let mut shadow = Shadow::new(gpu, &stage.renderer, technique.clone())?;
    let name = &technique.name;
    let mut spoilt: Vec<(&str, ShadowInputs)> = Vec::new();
    let mut spoil = |what, change: &dyn Fn(&mut ShadowInputs)| {
        let mut inputs = stage.inputs.clone();
        change(&mut inputs);
        spoilt.push((what, inputs));
    };
    spoil("a light at NaN", &|inputs| {
        inputs.light = homogeneous(Vec4::new(f32::NAN, 1.0, 0.0, inputs.light.xyzw().w));
    });
    spoil("a caster at infinity", &|inputs| {
        let far = Affine3A::from_translation(Vec3::new(0.0, f32::INFINITY, 0.0));
        let mesh = inputs.casters[0].mesh.clone();
        inputs.casters = vec![Caster::new(mesh, far)];
    });
    if !stage.inputs.light.is_directional() {
        spoil("a range of NaN", &|inputs| inputs.range = f32::NAN);
        spoil("a range of 0", &|inputs| inputs.range = 0.0);
    }
    let mut all: Vec<Refusal> = spoilt
        .iter()
        .map(|(what, inputs)| refused(format!("{name}: {what}"), shadow.prepare(gpu, inputs)))
        .collect();
    let after = stage.picture(gpu, &mut shadow, &stage.inputs);
    let right = after.and_then(|picture| {
        let reference = stage.reference(|_| ())?;
        let found = reference.compare(&picture.visibility, shadow.interior())?;
        anyhow::ensure!(found.false_lit_interior + found.false_shadow_interior == 0);
        Ok(())
    });
    all.push(works(format!("{name}: a good frame after these"), right));
    Ok(all)
}

/// As little as there can be.
fn degenerate(gpu: &Gpu, technique: &Technique) -> Result<Vec<Refusal>> {
    let name = &technique.name;
    let full = scene(technique);
    let mut nothing = full.clone();
    nothing.objects.retain(|object| !object.casts);
    let mut no_triangles = full.clone();
    let caster = no_triangles.objects.iter().position(|object| object.casts);
    if let Some(caster) = caster {
        let mesh = no_triangles.objects[caster].mesh;
        no_triangles.meshes[mesh].indices.clear();
    }
    let tried = |scene: Scene, size| -> Result<()> {
        let stage = Stage::new(gpu, scene, size)?;
        let mut shadow = Shadow::new(gpu, &stage.renderer, technique.clone())?;
        let picture = stage.picture(gpu, &mut shadow, &stage.inputs)?;
        let reference = stage.reference(|_| ())?;
        let found = reference.compare(&picture.visibility, shadow.interior())?;
        let wrong = found.false_lit_interior + found.false_shadow_interior;
        anyhow::ensure!(wrong == 0, "{wrong} interior pixels are wrong");
        Ok(())
    };
    Ok(vec![
        works(format!("{name}: no caster"), tried(nothing, SIZE)),
        works(
            format!("{name}: a caster of no triangle"),
            tried(no_triangles, SIZE),
        ),
        works(format!("{name}: a target of 1x1"), tried(full, [1, 1])),
    ])
}
