//! The modules that the library joins of the files in `shaders/`, but for those of a `PcfSampler`.
#![allow(dead_code)] // each test uses its own part

/// What `PcfSampler` has not, in the order in which it is joined.
pub const JOINED: &[&[&str]] = &[
    &["position"],
    &["volume_mask"],
    &["volume_exact"],
    &["volume_exact_samples"],
    FACE,
    &["caster_places", "cube_caster", "cube_caster_gl"],
    &["light_record", "cube_cross"],
    &["tile_fill"],
    BLOB_RECEIVER,
    BLOB_DECAL,
    &["projected_caster"],
    &["projected_tile"],
    &["projected_receiver"],
    &["atlas_debug"],
    PULLED,
    PULLED_STEPS,
    RECORDS,
    &[
        "volume_clip_distances",
        "position",
        "volume_depth_steps",
        "volume_extrude",
        "volume_corner_cut",
        "volume_draw",
    ],
    &[
        "volume_clip_distances",
        "position",
        "volume_depth_steps",
        "volume_extrude",
        "volume_corner_cut",
        "volume_light_side",
        "volume_vertex",
    ],
    &[
        "position",
        "volume_depth_steps",
        "volume_extrude",
        "volume_corner",
        "volume_light_side",
        "volume_vertex",
    ],
    &[
        "position",
        "volume_depth_as_is",
        "volume_extrude",
        "volume_corner",
        "volume_draw",
        "volume_debug_pulled",
        "volume_debug",
    ],
    &[
        "position",
        "volume_depth_steps",
        "volume_extrude",
        "volume_corner",
        "volume_light_side",
        "volume_vertex",
        "volume_debug_records",
        "volume_debug",
    ],
    FACING,
    EDGES,
    MERGE,
    &["caster_places", "planar_caster", "planar_shade"],
    &["planar_outline"],
    &["caster_places", "planar_caster", "planar_soft_count"],
    &["planar_soft"],
    &["volume_count"],
    &["volume_screen"],
    &["volume_screen", "volume_reset"],
    &["volume_screen", "volume_debug"],
    &["volume_screen", "volume_debug_counts"],
    &["volume_screen", "volume_debug_counts_samples"],
    &["volume_screen", "volume_join"],
    &["volume_screen", "volume_join_samples"],
    &["volume_screen", "volume_exact", "volume_mark"],
    &["volume_screen", "volume_exact", "volume_mask_counts"],
    &[
        "volume_screen",
        "volume_exact_samples",
        "volume_mask_counts_samples",
    ],
    &[
        "volume_screen",
        "volume_exact_samples",
        "volume_mark_samples",
    ],
];

/// The same of passes that draw several views. They need a capability of naga's that WebGPU has not.
pub const LAYERED: &[&[&str]] = &[
    &["volume_exact_layers"],
    &["volume_screen", "volume_join_layers"],
    &["volume_screen", "volume_exact_layers", "volume_mark_layers"],
    &[
        "volume_screen",
        "volume_exact_layers",
        "volume_mask_counts_layers",
    ],
];

/// What a host's shader asks, and decals.
pub const BLOB_RECEIVER: &[&str] = &["blob_visibility", "blob_receiver"];
pub const BLOB_DECAL: &[&str] = &["blob_visibility", "blob_decal"];

pub const FACE: &[&str] = &["caster_places", "cube_caster", "cube_caster_face"];

/// Volumes whose silhouettes are found before they are drawn.
pub const PULLED: &[&str] = &[
    "position",
    "volume_depth_as_is",
    "volume_extrude",
    "volume_corner",
    "volume_draw",
];

/// The same for the depth conventions that round far depths apart.
pub const PULLED_STEPS: &[&str] = &[
    "position",
    "volume_depth_steps",
    "volume_extrude",
    "volume_corner",
    "volume_draw",
];

/// Volumes whose vertices decide by themselves.
pub const RECORDS: &[&str] = &[
    "position",
    "volume_depth_as_is",
    "volume_extrude",
    "volume_corner",
    "volume_light_side",
    "volume_vertex",
];

pub const FACING: &[&str] = &[
    "volume_dispatch",
    "volume_batch",
    "volume_light_side",
    "volume_facing",
];

pub const EDGES: &[&str] = &["volume_dispatch", "volume_batch", "volume_edges"];

pub const MERGE: &[&str] = &["volume_dispatch", "volume_merge"];

pub fn joined(names: &[&str]) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/");
    let texts = names.iter().map(|name| {
        let path = format!("{folder}{name}.wgsl");
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
    });
    texts.collect::<Vec<_>>().join("\n")
}
