//! What is known not to be right, and how wrong it may be.
//!
//! A bound is a quarter above the worst of four rounds, for another driver's and other seeds' sake,
//! but at most one point above it: a technique that loses most of a shadow has no room for more. It
//! is 0 where that kind of error did not occur.

use super::cheap;

/// Why a technique cannot be right, and the bound of its errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    pub why: &'static str,
    /// In each round, in per cent of the pixels that face the light: interior pixels lit falsely,
    /// interior pixels in shadow falsely, and all that are wrong, edges included.
    pub at_most: [f64; 3],
}

/// The limit of a technique on a case, if one is known.
pub fn of(case: &str, technique: &str) -> Option<Limit> {
    let row = all().find(|row| row.is_of(case, technique))?;
    Some(row.limit)
}

/// Those of every technique, but for hardware's own.
pub fn all() -> impl Iterator<Item = Known> {
    ALL.iter().copied().chain(cheap::limits())
}

/// The limit on hardware, if one is known there that software drivers have not.
pub fn of_hardware(case: &str, technique: &str) -> Option<Limit> {
    let row = ON_HARDWARE.iter().find(|row| row.is_of(case, technique))?;
    Some(row.limit)
}

/// A known limit, and what has it. The first that fits counts.
#[derive(Clone, Copy)]
pub struct Known {
    /// A case's name, or `*` for all of them.
    pub case: &'static str,
    /// A technique's name, or the beginning of several before a `*`.
    pub technique: &'static str,
    pub limit: Limit,
}

impl Known {
    /// Whether it is about this technique on this case.
    pub fn is_of(&self, case: &str, technique: &str) -> bool {
        fits(self.case, case) && fits(self.technique, technique)
    }
}

fn fits(pattern: &str, name: &str) -> bool {
    match pattern.strip_suffix('*') {
        Some(start) => name.starts_with(start),
        None => name == pattern,
    }
}

pub(super) const fn known(
    case: &'static str,
    technique: &'static str,
    why: &'static str,
    at_most: [f64; 3],
) -> Known {
    Known {
        case,
        technique,
        limit: Limit { why, at_most },
    }
}

/// A few pixels of any scene, and more where distances are short or very long; a hundredth of a per cent
/// is the least bound, since so few pixels are a matter of chance.
const TEXTBOOK: &str =
    "the textbook map has a constant bias of 0.15, whatever the size of the scene";
const GRAZING: &str = "one texel covers 1 / N.L texels of the ground in the light's direction, so shadow edges \
    are that much coarser";
const CLIPPED: &str = "rasterisers clip in f32: where a triangle a million times larger than its \
    distance from the light crosses the border of a cube face, its edges move by a texel";
const TILTED: &str = "rasterisers clip in f32, and f32 positions do not determine the plane of a \
    surface so close to the light: receivers are moved toward the light accordingly, which matters for \
    wide kernels";
const RIM: &str = "everything outside a spot's square map is lit, and where the cone touches the \
    side of the map, half of a disk kernel lies outside";
const FULL_CAPS: &str = "full caps draw distant triangles that are almost coplanar with the light, \
    and their equations are nearly singular";
const FACING: &str = "when the light is nearer to a triangle than 1e-5 of its size, f32 cannot tell on which \
    side of its plane the light is; `Silhouettes::Cpu` decides that in f64";
const THIN: &str = "a caster that no texel centre hits casts no shadow";

const ONE_DEPTH: &str = "hardware filtering compares four texels with one depth, so where a caster touches a \
    receiver, the shadow starts late, by the depth that a texel covers there";
const POSITIONS: &str = "positions in f32 are rounded by more than a texel or a pixel there; surfaces seen \
    edge-on are off by more than the bias in ulps";
const VERTICES: &str =
    "vertices are in f32: at 1e6 the rendered picture itself is off by whole pixels";
const TWENTY_FOUR_BITS: &str = "depth is near / distance in steps of 2^-24: with the near plane at 2 cm a step is 0.7 m \
    deep at a distance of 500 m";

const FINE_GRAZING: &str = "texels of a near cascade are a 25th as wide as those of the usual map, \
    which is so fine that derivatives of f32 positions cannot resolve planes that contain the light's \
    direction to within 1e-5 (the same happens on a flat map of 8192; with the triangles' own normals, \
    no pixel is wrong)";

const SNAPPED: &str = "hardware takes depth from corners that are snapped to 1/256 of a pixel: at N.L = 1e-5 \
    the sides of a volume whose caster stands on the ground are nearer to the ground than \
    that";

/// Those of hardware alone. Bounds are of the arithmetic `snapped` on a software driver.
pub const ON_HARDWARE: [Known; 1] = [known("Grazing light", "volume*", SNAPPED, [2.8, 0.0, 2.9])];

/// All of them.
pub const ALL: &[Known] = &[
    known(
        "Tiles beside foreign ones",
        "atlas-disk",
        RIM,
        [0.031, 0.0, 5.6],
    ),
    known(
        "A light becomes another kind",
        "atlas-disk",
        RIM,
        [0.01, 0.0, 0.47],
    ),
    known(
        "Casters move under a budget",
        "atlas-disk",
        RIM,
        [0.01, 0.0, 0.47],
    ),
    known(
        "Cascades of other cameras",
        "atlas-disk",
        RIM,
        [0.01, 0.0, 1.4],
    ),
    known("Two views of a sun", "atlas-disk", RIM, [0.01, 0.0, 0.26]),
    known("Grazing light", "atlas-*", FINE_GRAZING, [0.0, 0.13, 9.1]),
    known(
        "Light very near a caster",
        "atlas-*",
        CLIPPED,
        [0.06, 0.0, 0.06],
    ),
    known(
        "Light 1e-6 from a tilted caster",
        "atlas-*",
        CLIPPED,
        [0.25, 0.0, 0.41],
    ),
    known(
        "Far from the origin, plain f32",
        "atlas-*",
        POSITIONS,
        [0.0017, 0.00077, 0.39],
    ),
    known("Grazing light", "flat-hw", ONE_DEPTH, [0.01, 0.00029, 11.5]),
    known(
        "Light very near a caster",
        "cube-hw",
        ONE_DEPTH,
        [0.06, 0.0, 0.7],
    ),
    known(
        "Light 1e-6 from a tilted caster",
        "cube-hw",
        ONE_DEPTH,
        [0.25, 0.0, 1.6],
    ),
    known(
        "Light close to geometry",
        "cube-hw",
        ONE_DEPTH,
        [0.01, 0.0, 0.58],
    ),
    known("Scale", "flat-hw", ONE_DEPTH, [0.0, 0.01, 0.052]),
    known(
        "Far from the origin, plain f32",
        "cube-hw",
        POSITIONS,
        [0.016, 0.0025, 1.9],
    ),
    known(
        "Far from the origin, plain f32",
        "flat-hw",
        POSITIONS,
        [0.009, 0.0025, 1.4],
    ),
    known(
        "Camera inside a shadow volume",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 0.021, 0.43],
    ),
    known(
        "Receiver far away",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 0.029, 0.15],
    ),
    known(
        "Nothing drawn at a pixel",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 3.1, 4.2],
    ),
    known(
        "Grazing light",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 0.01, 15.0],
    ),
    known(
        "Light very near a caster",
        "cube-textbook",
        TEXTBOOK,
        [0.06, 0.04, 1.6],
    ),
    known(
        "Light 1e-6 from a tilted caster",
        "cube-textbook",
        TEXTBOOK,
        [0.25, 0.01, 1.7],
    ),
    known(
        "Beyond the light's range",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 0.98, 3.3],
    ),
    known(
        "Caster inside the near sphere",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 0.025, 0.15],
    ),
    known(
        "Non-manifold edge",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 0.05, 0.2],
    ),
    known("Instances", "cube-textbook", TEXTBOOK, [0.01, 0.067, 0.31]),
    known(
        "Far from the origin",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 0.12, 0.22],
    ),
    known("Scale", "cube-textbook", TEXTBOOK, [5.1, 4.1, 9.2]),
    known("Touching", "cube-textbook", TEXTBOOK, [0.01, 0.46, 0.48]),
    known(
        "Courtyard from anywhere",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 0.046, 2.2],
    ),
    known(
        "Teapot from anywhere",
        "cube-textbook",
        TEXTBOOK,
        [0.018, 0.031, 0.3],
    ),
    known("Cone's edge", "flat-disk", RIM, [0.0022, 0.0, 0.014]),
    known(
        "Light close to geometry",
        "flat-disk",
        RIM,
        [0.012, 0.0, 0.82],
    ),
    known(
        "Near plane through a caster",
        "cube-textbook",
        TEXTBOOK,
        [0.035, 0.01, 0.39],
    ),
    known(
        "24-bit depth-stencil",
        "volume*",
        TWENTY_FOUR_BITS,
        [0.38, 0.0, 1.3],
    ),
    known(
        "Thin caster",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 0.01, 0.082],
    ),
    known(
        "Light close to geometry",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 2.5, 5.5],
    ),
    known(
        "Orthographic camera, near < 0",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 0.032, 0.28],
    ),
    known(
        "Far from the origin, plain f32",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 0.039, 0.85],
    ),
    known(
        "Far from the origin, plain f32",
        "cube-*",
        POSITIONS,
        [0.003, 0.0025, 0.43],
    ),
    known(
        "Far from the origin, plain f32",
        "flat-*",
        POSITIONS,
        [0.0015, 0.0025, 0.35],
    ),
    known(
        "Far from the origin, plain f32",
        "volume*",
        VERTICES,
        [0.003, 0.0015, 0.087],
    ),
    known(
        "Casters come and go",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 0.061, 1.6],
    ),
    known(
        "Two views in one submission",
        "cube-textbook",
        TEXTBOOK,
        [0.01, 0.061, 1.6],
    ),
    known("Landscape", "volume-textbook", FULL_CAPS, [0.01, 0.01, 0.5]),
    known("*", "cube-textbook", TEXTBOOK, [0.01, 0.01, 0.57]),
    known("Grazing light", "cube-*", GRAZING, [0.0, 0.0, 15.0]),
    known("Grazing light", "flat-*", GRAZING, [0.0, 0.00029, 7.4]),
    known(
        "Light very near a caster",
        "volume-textbook",
        FULL_CAPS,
        [1.4, 0.0, 1.4],
    ),
    known(
        "Light very near a caster",
        "cube-*",
        CLIPPED,
        [0.06, 0.0, 0.06],
    ),
    known(
        "Light 1e-6 from a tilted caster",
        "cube-7x7",
        TILTED,
        [0.25, 0.0, 0.8],
    ),
    known(
        "Light 1e-6 from a tilted caster",
        "cube-disk",
        TILTED,
        [0.25, 0.0, 0.8],
    ),
    known(
        "Light 1e-6 from a tilted caster",
        "cube-*",
        CLIPPED,
        [0.25, 0.0, 0.34],
    ),
    known(
        "Light 1e-6 from a tilted caster",
        "volume-compute",
        FACING,
        [35.0, 0.0, 35.7],
    ),
    known(
        "Light 1e-6 from a tilted caster",
        "volume-vertex",
        FACING,
        [35.0, 0.0, 35.7],
    ),
    known("Thin caster", "cube-*", THIN, [0.0, 0.0, 0.05]),
    known("Thin caster", "flat-*", THIN, [0.0, 0.0, 0.04]),
];
