//! The shaders that are not receivers: what casters, volumes and their silhouettes run.

use crate::pipeline::Case;

macro_rules! shaders {
    ($($name:literal),+) => {
        concat!($(include_str!(concat!("../../shaders/", $name, ".wgsl")), "\n"),+)
    };
}

/// A depth-only vertex shader with a transform an instance, for comparison.
const PLAIN: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;
struct Model { @location(1) a: vec4f, @location(2) b: vec4f, @location(3) c: vec4f }
@vertex fn vertex(@location(0) p: vec3f, m: Model) -> @builtin(position) vec4f {
    let q = vec4f(p, 1.0);
    return clip_from_world * vec4f(dot(m.a, q), dot(m.b, q), dot(m.c, q), 1.0);
}
";

const FACE: &str = shaders!("cube_caster", "cube_caster_face");
const PULLED: &str = shaders!(
    "position",
    "volume_depth_as_is",
    "volume_extrude",
    "volume_draw"
);
/// For the depth conventions that round far depths apart.
const PULLED_STEPS: &str = shaders!(
    "position",
    "volume_depth_steps",
    "volume_extrude",
    "volume_draw"
);
const RECORDS: &str = shaders!(
    "position",
    "volume_depth_as_is",
    "volume_extrude",
    "volume_light_side",
    "volume_vertex"
);
const FACING: &str = shaders!("volume_batch", "volume_light_side", "volume_facing");
const EDGES: &str = shaders!("volume_batch", "volume_edges");

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
        case("caster/face".to_owned(), FACE, &["vertex"], 1, vec![]),
        case(
            "caster/face-distance".to_owned(),
            FACE,
            &["vertex_distance", "fragment_distance"],
            1,
            vec![],
        ),
        case(
            "volume/facing".to_owned(),
            FACING,
            &["shadows_volume_facing"],
            none,
            vec![1],
        ),
        case(
            "volume/edges".to_owned(),
            EDGES,
            &["shadows_volume_edges"],
            none,
            vec![1, 0, 1],
        ),
    ];
    for (name, entry) in VOLUME {
        cases.push(case(
            format!("volume-pulled-steps/{name}"),
            PULLED_STEPS,
            &[entry],
            none,
            vec![],
        ));
        cases.push(case(
            format!("volume-pulled/{name}"),
            PULLED,
            &[entry],
            none,
            vec![],
        ));
        cases.push(case(
            format!("volume-records/{name}"),
            RECORDS,
            &[entry],
            0,
            vec![],
        ));
    }
    cases
}
