//! What the cheap and baked techniques cannot do, and how wrong that makes them.

use super::limits::{Known, known};

const RECEIVERS: &str = "only what does not cast receives: what casters throw on each other and on themselves is missing";
const SURROUNDED: &str = "a light within a caster's bounds, or that sees them wider than 84 degrees to each side, has no \
    picture of it, which `ProjectorState::Surrounded` says";
const ELLIPSOIDS: &str = "a caster is an ellipsoid, and lies in its own shadow";
const RIM: &str = "a receiver that is given as a polygon reaches a sixteenth of a pixel beyond it, onto what stands there";
const FEET: &str = "what is within a texel of the plane reads the plane's texture: the foot of what stands on it is in its shadow";

/// All of them; bounds as those of [`ALL`](super::limits::ALL), and a hundredth of a per cent at least where
/// such an error is a matter of a few pixels.
pub const CHEAP: &[Known] = &[
    known(
        "Camera inside a shadow volume",
        "planar",
        RECEIVERS,
        [17.9, 0.0, 18.1],
    ),
    known(
        "Camera inside a shadow volume",
        "projected",
        RECEIVERS,
        [17.3, 0.0, 18.2],
    ),
    known("Grazing light", "planar", RECEIVERS, [1.9, 0.01, 2.1]),
    known("Grazing light", "projected", RECEIVERS, [1.9, 0.0, 10.6]),
    known(
        "Orthographic camera, near < 0",
        "planar",
        RECEIVERS,
        [0.63, 0.01, 0.79],
    ),
    known(
        "Orthographic camera, near < 0",
        "projected",
        RECEIVERS,
        [0.63, 0.0, 0.87],
    ),
    known(
        "Orthographic camera, near < 0",
        "blob",
        ELLIPSOIDS,
        [1.7, 5.9, 8.2],
    ),
    known("MSAA 4x", "planar", RECEIVERS, [0.21, 0.0, 0.41]),
    known("MSAA 4x", "projected", RECEIVERS, [0.21, 0.0, 0.39]),
    known("MSAA 4x", "blob", ELLIPSOIDS, [0.017, 4.0, 4.8]),
    known(
        "Light inside a closed caster",
        "projected",
        SURROUNDED,
        [97.1, 0.0, 98.2],
    ),
    known(
        "Mirrored and sheared transforms",
        "planar",
        RECEIVERS,
        [0.37, 0.0, 0.43],
    ),
    known(
        "Mirrored and sheared transforms",
        "projected",
        SURROUNDED,
        [5.2, 0.0, 5.8],
    ),
    known("Instances", "blob", ELLIPSOIDS, [0.01, 1.6, 2.9]),
    known("Thin caster", "planar", RIM, [0.0, 0.01, 0.01]),
    known(
        "Far from the origin",
        "planar",
        RECEIVERS,
        [0.41, 0.0, 0.55],
    ),
    known(
        "Far from the origin",
        "projected",
        RECEIVERS,
        [0.23, 0.01, 0.58],
    ),
    known("Scale", "planar", RECEIVERS, [0.32, 0.0, 0.45]),
    known("Scale", "projected", RECEIVERS, [0.32, 0.0, 0.49]),
    known("Touching", "planar", RIM, [0.0, 0.01, 0.01]),
    known("Touching", "planar-soft", FEET, [0.0, 0.14, 0.17]),
    known("Touching", "blob", ELLIPSOIDS, [0.58, 1.8, 2.5]),
    known(
        "Courtyard from anywhere",
        "planar",
        RECEIVERS,
        [8.7, 0.011, 12.2],
    ),
    known(
        "Casters come and go",
        "planar",
        RECEIVERS,
        [0.18, 0.0, 0.31],
    ),
    known(
        "Casters come and go",
        "projected",
        RECEIVERS,
        [0.053, 0.0, 0.38],
    ),
    known(
        "Two views in one submission",
        "planar",
        RECEIVERS,
        [0.18, 0.0, 0.31],
    ),
    known(
        "Two views in one submission",
        "projected",
        RECEIVERS,
        [0.065, 0.0, 0.38],
    ),
    known(
        "Two views in one submission",
        "blob",
        ELLIPSOIDS,
        [0.095, 1.5, 2.6],
    ),
];
