//! What some arithmetic makes wrong in the hard cases, and how wrong it may be.

use crate::hard::limits::{Known, Limit, ON_HARDWARE};

/// What is known of a variant, beside the limits that hold anyway.
pub fn of(variant: &str) -> &'static [Known] {
    match variant {
        "fma-other" => &FMA_OTHER,
        "host-fma" => &[FIGHTING],
        "snapped" => &SNAPPED,
        _ => &[],
    }
}

/// A host of other arithmetic at the default bias of caps; none at 512 units.
const FIGHTING: Known = Known {
    case: "Equal-depth light pass",
    technique: "volume-zfail",
    limit: Limit {
        why: "a host of other arithmetic, whose steep surfaces are off by more than the 16 units of cap_bias_ulps",
        at_most: [0.01, 0.02, 0.05],
    },
};

const FMA_OTHER: [Known; 2] = [
    FIGHTING,
    Known {
        case: "Light 1e-6 from a tilted caster",
        technique: "volume-zfail",
        limit: Limit {
            why: "f32 hardly tells the far corners of such a caster from its plane",
            at_most: [1.8, 0.0, 1.9],
        },
    },
];

const FACING_SNAPPED: Limit = Limit {
    why: "facing in f32, as without other arithmetic, and corners that are snapped to 1/256 of a pixel",
    at_most: [35.0, 0.27, 35.9],
};

const SNAPPED: [Known; 4] = [
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
