// What the two extraction passes know: who finds what of which volume.

// Words of indirect arguments an instance owns, and where in them the counts lie.
const ARGS_STRIDE: u32 = 11u;
const ARGS_FRONT: u32 = 0u; // indexed draw of the caps that count +1
const ARGS_BACK: u32 = 5u; // indexed draw of the caps that count -1
const ARGS_SIDES: u32 = 10u; // number of sides

// A volume to be found.
struct Instance {
    // The light in the mesh's own space, homogeneous, and what xyz lost when rounded to f32.
    light: vec4f,
    light_rest: vec3f,
    // 0: light-facing triangles count; 1: every triangle, turned toward the light; 2: those turned
    // away, turned over.
    both_sides: u32,
    // Where its parts of the shared buffers begin, in words of 4 bytes.
    facing_base: u32,
    cap_base: u32,
    side_base: u32,
    // Which indirect arguments are its own.
    arguments: u32,
    triangle_count: u32,
    // In words.
    triangle_base: u32,
    edge_count: u32,
    // In records.
    edge_base: u32,
    use_base: u32,
    // 0: an edge record names its two triangles; 1: its first use and their number.
    general: u32,
    // In words.
    position_stride: u32,
    position_offset: u32,
}

@group(0) @binding(1) var<storage, read> instances: array<Instance>;
@group(0) @binding(2) var<storage, read_write> args: array<atomic<u32>>;
// For each workgroup its instance, and the first of its elements: triangles or edges.
@group(0) @binding(3) var<storage, read> shares: array<vec2u>;

fn share_of(group: vec3u, groups: vec3u) -> vec2u {
    return shares[item_of(group, groups)];
}
