//! What some arithmetic makes wrong in the hard cases, and how wrong it may be.

use crate::hard::limits::{Known, Limit, ON_HARDWARE};

/// What is known of a variant, beside the limits that hold anyway.
pub fn of(variant: &str) -> &'static [Known] {
    match variant {
        "fma" => &[FAR_AWAY],
        "fma-other" => &FMA_OTHER,
        "host-order" | "host-fma" | "caps-and-sides" => &APART,
        "snapped" => &SNAPPED,
        _ => &[],
    }
}

const FIGHTING: Known = apart("Equal-depth light pass", "volume-zfail", [0.01, 0.02, 0.05]);

/// Bounds are a quarter, or a point, above what one round gave, the worst of the three variants.
const APART: [Known; 10] = [
    FAR_AWAY,
    FIGHTING,
    apart(
        "Far from the origin, plain f32",
        "volume-zfail",
        [0.003, 3.8, 4.4],
    ),
    apart("Scale", "volume-zfail", [0.0, 0.0023, 0.041]),
    apart(
        "Courtyard from anywhere",
        "volume-zfail",
        [0.0, 0.013, 0.027],
    ),
    apart("Teapot from anywhere", "volume-zfail", [0.0, 0.0015, 0.006]),
    apart(
        "Flat caster in the receivers' side",
        "volume-zfail",
        [0.0, 37.3, 37.4],
    ),
    apart("Landscape", "volume-zfail", [0.0, 0.008, 0.043]),
    apart("Near plane through a caster", "volume*", [0.0, 0.068, 0.17]),
    Known {
        case: "Light 1e-6 from a tilted caster",
        technique: "volume-vertex",
        limit: Limit {
            why: "facing in f32, as without other arithmetic, and caps that find another side than sides do",
            at_most: [35.0, 0.67, 36.3],
        },
    },
];

/// Volumes' caps and the host of two arithmetics, at the default bias of caps.
const fn apart(case: &'static str, technique: &'static str, at_most: [f64; 3]) -> Known {
    Known {
        case,
        technique,
        limit: Limit {
            why: "caps are not where a host of other arithmetic has the same surfaces: steep and large ones are off by \
                  more than the 16 units of cap_bias_ulps",
            at_most,
        },
    }
}

const FAR_AWAY: Known = Known {
    case: "Far from the origin, plain f32",
    technique: "atlas-*",
    limit: Limit {
        why: "positions in f32 are rounded by more than a texel there, in another way",
        at_most: [0.0017, 0.0017, 0.39],
    },
};

const SINGULAR_CAP: Limit = Limit {
    why: "the light is in its caster's own box, so the dark cap is full, and one triangle of it covers half the sky: \
          clipping leaves of it what the last bit says",
    at_most: [1.8, 0.0, 1.9],
};

const FMA_OTHER: [Known; 3] = [
    FIGHTING,
    Known {
        case: "Light 1e-6 from a tilted caster",
        technique: "volume-zfail",
        limit: SINGULAR_CAP,
    },
    Known {
        case: "Light 1e-6 from a tilted caster",
        technique: "volume-cpu",
        limit: SINGULAR_CAP,
    },
];

const FACING_SNAPPED: Limit = Limit {
    why: "facing in f32, as without other arithmetic, and corners that are snapped to 1/256 of a pixel",
    at_most: [35.0, 0.27, 35.9],
};

const SNAPPED: [Known; 5] = [
    FAR_AWAY,
    ON_HARDWARE[0],
    FIGHTING,
    Known {
        case: "Light 1e-6 from a tilted caster",
        technique: "volume-compute",
        limit: FACING_SNAPPED,
    },
    Known {
        case: "Light 1e-6 from a tilted caster",
        technique: "volume-vertex",
        limit: FACING_SNAPPED,
    },
];
