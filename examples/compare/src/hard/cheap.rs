//! What the cheap and baked techniques cannot do, and how wrong that makes them.

use super::limits::{Known, known};

const RECEIVERS: &str = "only non-casters receive: shadows of casters on each other and on \
    themselves are missing";
const SURROUNDED: &str = "a light within a caster's bounds, or from which they extend beyond 84 \
    degrees to either side, has no picture of it, as `ProjectorState::Surrounded` reports";
const ELLIPSOIDS: &str = "casters are replaced by ellipsoids, and lie in their own shadow";
const RIM: &str = "a receiver given as a polygon extends a sixteenth of a pixel beyond it, onto the \
    objects that stand there";
const FEET: &str = "anything within a texel of the plane reads the plane's texture: the foot of an \
    object on it is in its own shadow";

/// What one technique cannot do, for one reason.
struct Lack {
    technique: &'static str,
    why: &'static str,
    /// Cases, and the bounds of their errors.
    cases: &'static [(&'static str, [f64; 3])],
}

/// Bounds as those of [`ALL`](super::limits::ALL), and a hundredth of a per cent at least where such an error is a
/// matter of a few pixels.
const LACKS: &[Lack] = &[
    Lack {
        technique: "planar",
        why: RECEIVERS,
        cases: &[
            ("Camera inside a shadow volume", [17.9, 0.0, 18.1]),
            ("Grazing light", [1.9, 0.01, 2.1]),
            ("Orthographic camera, near < 0", [0.63, 0.01, 0.79]),
            ("MSAA 4x", [0.21, 0.0, 0.41]),
            ("Mirrored and sheared transforms", [0.37, 0.0, 0.43]),
            ("Far from the origin", [0.41, 0.0, 0.55]),
            ("Scale", [0.32, 0.0, 0.45]),
            ("Courtyard from anywhere", [8.7, 0.011, 12.2]),
            ("Casters come and go", [0.18, 0.0, 0.31]),
            ("Two views in one submission", [0.18, 0.0, 0.31]),
        ],
    },
    Lack {
        technique: "projected",
        why: RECEIVERS,
        cases: &[
            ("Camera inside a shadow volume", [17.3, 0.0, 18.2]),
            ("Grazing light", [1.9, 0.0, 10.6]),
            ("Orthographic camera, near < 0", [0.63, 0.0, 0.87]),
            ("MSAA 4x", [0.21, 0.0, 0.39]),
            ("Far from the origin", [0.23, 0.01, 0.58]),
            ("Scale", [0.32, 0.0, 0.49]),
            ("Casters come and go", [0.053, 0.0, 0.38]),
            ("Two views in one submission", [0.065, 0.0, 0.38]),
        ],
    },
    Lack {
        technique: "blob",
        why: ELLIPSOIDS,
        cases: &[
            ("Orthographic camera, near < 0", [1.7, 5.9, 8.2]),
            ("MSAA 4x", [0.017, 4.0, 4.8]),
            ("Instances", [0.01, 1.6, 2.9]),
            ("Touching", [0.58, 1.8, 2.5]),
            ("Two views in one submission", [0.095, 1.5, 2.6]),
        ],
    },
    Lack {
        technique: "projected",
        why: SURROUNDED,
        cases: &[
            ("Light inside a closed caster", [97.1, 0.0, 98.2]),
            ("Mirrored and sheared transforms", [5.2, 0.0, 5.8]),
        ],
    },
    Lack {
        technique: "planar",
        why: RIM,
        cases: &[
            ("Thin caster", [0.0, 0.01, 0.01]),
            ("Touching", [0.0, 0.01, 0.01]),
        ],
    },
    Lack {
        technique: "planar-soft",
        why: FEET,
        cases: &[("Touching", [0.0, 0.14, 0.17])],
    },
];

/// All of them.
pub fn limits() -> impl Iterator<Item = Known> {
    LACKS.iter().flat_map(|lack| {
        let of_case = |&(case, at_most)| known(case, lack.technique, lack.why, at_most);
        lack.cases.iter().map(of_case)
    })
}
