//! The shaders that are not receivers: what casters, volumes and their silhouettes run.

use crate::modules::{EDGES, FACE, FACING, MERGE, PULLED, PULLED_STEPS, RECORDS, joined};
use crate::pipeline::Case;

/// A depth-only vertex shader with a transform an instance, for comparison.
const PLAIN: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;
struct Model { @location(1) a: vec4f, @location(2) b: vec4f, @location(3) c: vec4f }
@vertex fn vertex(@location(0) p: vec3f, m: Model) -> @builtin(position) vec4f {
    let q = vec4f(p, 1.0);
    return clip_from_world * vec4f(dot(m.a, q), dot(m.b, q), dot(m.c, q), 1.0);
}
";

/// The ways of volumes' vertices: pulled from found silhouettes, or from records of all edges.
const VOLUME: [(&str, &str); 4] = [
    ("light-cap", "shadows_volume_light_cap"),
    ("dark-cap", "shadows_volume_dark_cap"),
    ("side", "shadows_volume_side"),
    ("fan", "shadows_volume_fan"),
];

fn case(
    name: String,
    wgsl: &str,
    entries: &[&'static str],
    instanced_from: u32,
    trips: Vec<u32>,
) -> Case {
    Case {
        name,
        wgsl: wgsl.to_owned(),
        entries: entries.to_vec(),
        instanced_from,
        fragment_only: false,
        trips,
    }
}

pub fn all() -> Vec<Case> {
    let none = u32::MAX;
    // In compute shaders the first loop sets the workgroup's memory to zero. Edges: then the uses of an edge
    // that is not two triangles', then the copies of the side, of which there is one.
    let mut cases = vec![
        case("peer/depth-only".to_owned(), PLAIN, &["vertex"], 1, vec![]),
        case(
            "caster/face".to_owned(),
            &joined(FACE),
            &["vertex"],
            1,
            vec![],
        ),
        case(
            "caster/face-distance".to_owned(),
            &joined(FACE),
            &["vertex", "fragment_distance"],
            1,
            vec![],
        ),
        case(
            "volume/facing".to_owned(),
            &joined(FACING),
            &["shadows_volume_facing"],
            none,
            vec![1],
        ),
        case(
            "volume/edges".to_owned(),
            &joined(EDGES),
            &["shadows_volume_edges"],
            none,
            vec![1, 0, 1],
        ),
        // Then the doublings of the sum, and the blocks of an invocation; the search in it is unrolled.
        case(
            "volume/merge".to_owned(),
            &joined(MERGE),
            &["shadows_volume_merge"],
            none,
            vec![1, 8, 1],
        ),
    ];
    for (name, entry) in VOLUME {
        cases.push(case(
            format!("volume-pulled-steps/{name}"),
            &joined(PULLED_STEPS),
            &[entry],
            0,
            vec![],
        ));
        cases.push(case(
            format!("volume-pulled/{name}"),
            &joined(PULLED),
            &[entry],
            0,
            vec![],
        ));
        cases.push(case(
            format!("volume-records/{name}"),
            &joined(RECORDS),
            &[entry],
            0,
            vec![],
        ));
    }
    cases
}
