//! Maps of one texel and of two.

use anyhow::{Result, ensure};
use shadows::glam::DVec3;
use shadows::reference::{Class, ReferenceImage};

use super::SIZE;
use super::situation::{Situation, at, lamp, sun};
use super::table::Refusal;
use crate::shadow::Shadow;
use crate::stage::Stage;
use crate::table::named;
use crate::technique::{Config, Technique};
use host::gpu::Gpu;
use host::random::Random;
use host::scene::Scene;
use host::shapes;

/// One of every kind of kernel on either kind of map.
const NAMES: [&str; 6] = [
    "cube-hard",
    "cube-2x2",
    "cube-disk",
    "flat-hard",
    "flat-2x2",
    "flat-disk",
];

/// Tries them: they work, or say that they do not.
///
/// # Errors
/// If the device cannot draw the scenes.
pub fn maps(gpu: &Gpu) -> Result<Vec<Refusal>> {
    let mut all = Vec::new();
    for (name, side) in NAMES.into_iter().flat_map(|name| [(name, 1), (name, 2)]) {
        let technique = named(name, side)?;
        all.push(Refusal {
            what: format!("{name}: a map of {side}x{side}"),
            outcome: tried(gpu, &technique),
        });
    }
    Ok(all)
}

fn tried(gpu: &Gpu, technique: &Technique) -> Result<String, String> {
    let mut said = "works".to_owned();
    for (what, scene) in scenes(technique) {
        match picture(gpu, technique, scene) {
            Ok((reference, visibility)) => {
                lit_where_nothing_casts(&reference, &visibility)
                    .map_err(|error| format!("{what}: {error}"))?;
            }
            Err(error) => said = format!("refused: {error:#}"),
        }
    }
    Ok(said)
}

type Shown = (ReferenceImage, Vec<u8>);

fn picture(gpu: &Gpu, technique: &Technique, scene: Scene) -> Result<Shown> {
    let stage = Stage::new(gpu, scene, SIZE)?;
    let mut shadow = Shadow::new(gpu, &stage.renderer, technique.clone())?;
    let picture = stage.picture(gpu, &mut shadow, &stage.inputs)?;
    Ok((stage.reference(|_| ())?, picture.visibility))
}

/// Nothing that casts, and casters that the light does not reach the ground through: on the lamp's
/// other side, or below the ground.
fn scenes(technique: &Technique) -> [(&'static str, Scene); 2] {
    let random = &mut Random(0);
    let (light, behind) = match technique.config {
        Config::Flat { .. } => (sun(random), at(0.0, -3.0, 0.0)),
        _ => {
            let light = lamp(random);
            (light, at(light.x, light.y + 3.0, light.z))
        }
    };
    let nothing = Situation::new("", light, random);
    let behind = nothing.clone().caster(&shapes::cube().tilted(), behind);
    [
        ("no caster", nothing.scene),
        ("a caster behind", behind.scene),
    ]
}

/// The pixels straight below the lamp that the reference says are lit: all must be.
///
/// # Errors
/// Says how many pixels are not, or that there is none to look at.
pub fn lit_where_nothing_casts(
    reference: &ReferenceImage,
    visibility: &[u8],
) -> Result<Vec<usize>> {
    let width = reference.width();
    let lit: Vec<usize> = reference
        .classes()
        .enumerate()
        .filter(|(pixel, class)| {
            let hit = reference.hit(*pixel as u32 % width, *pixel as u32 / width);
            *class == Class::Lit && hit.is_some_and(|hit| is_below(hit.position))
        })
        .map(|(pixel, _)| pixel)
        .collect();
    let dark = lit.iter().filter(|&&pixel| visibility[pixel] != 255);
    let dark = dark.count();
    ensure!(lit.len() > 500, "only {} pixels are lit", lit.len());
    ensure!(dark == 0, "{dark} of {} pixels are not lit", lit.len());
    Ok(lit)
}

/// On the ground within the lower face of a cube map at the lamp, whose neighbours a kernel of one
/// texel may ask, too.
fn is_below(position: DVec3) -> bool {
    position.y.abs() < 1e-3 && (position - DVec3::new(-2.0, 0.0, 2.5)).abs().max_element() < 4.0
}
