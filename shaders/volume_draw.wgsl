// The three kinds of faces of a shadow volume. Every vertex is pulled by its index, so that faces
// that meet compute the same position from the same numbers.

struct Caster {
    clip_from_world: mat4x4f,
    world_from_object: mat4x4f,
    // World space, homogeneous.
    light: vec4f,
    // In words of 4 bytes.
    position_stride: u32,
    position_offset: u32,
    side_base: u32,
    side_vertices: u32,
}

@group(0) @binding(0) var<uniform> caster: Caster;
@group(0) @binding(1) var<storage, read> positions: array<f32>;
@group(0) @binding(2) var<storage, read> edges: array<vec4u>;
@group(0) @binding(3) var<storage, read> sides: array<u32>;

fn position(vertex: u32) -> vec3f {
    let word = caster.position_offset + vertex * caster.position_stride;
    return vec3f(positions[word], positions[word + 1u], positions[word + 2u]);
}

fn near_vertex(vertex: u32) -> vec4f {
    return shadows_clip_position(
        caster.clip_from_world,
        caster.world_from_object,
        position(vertex),
    );
}

// The point at infinity behind a vertex, seen from the light. A vertex at the very place of the
// light has no such direction: it stays where it is, the same for every face that meets there, so
// that the surface is still closed and no vertex is (0, 0, 0, 0).
fn far_vertex(vertex: u32) -> vec4f {
    let world = (caster.world_from_object * vec4f(position(vertex), 1.0)).xyz;
    let direction = caster.light.w * world - caster.light.xyz;
    if all(direction == vec3f(0.0)) {
        return near_vertex(vertex);
    }
    return caster.clip_from_world * vec4f(direction, 0.0);
}

@vertex
fn shadows_volume_light_cap(
    @builtin(vertex_index) vertex: u32,
) -> @invariant @builtin(position) vec4f {
    return near_vertex(vertex);
}

@vertex
fn shadows_volume_dark_cap(
    @builtin(vertex_index) vertex: u32,
) -> @invariant @builtin(position) vec4f {
    return far_vertex(vertex);
}

// A cap that runs through an edge from a to b is bounded there by the side b, a, a', b', where a'
// and b' are at infinity; for a directional light a' = b' and one triangle is left.
@vertex
fn shadows_volume_side(
    @builtin(vertex_index) vertex: u32,
) -> @invariant @builtin(position) vec4f {
    let side = sides[caster.side_base + vertex / caster.side_vertices];
    let corner = vertex % caster.side_vertices;
    let edge = edges[side >> 1u];
    let flipped = (side & 1u) == 1u;
    // Corners: b a a', b a' b'.
    let second = ((0x29u >> corner) & 1u) == 1u;
    let far = ((0x34u >> corner) & 1u) == 1u;
    let end = select(edge.x, edge.y, second != flipped);
    if far {
        return far_vertex(end);
    }
    return near_vertex(end);
}

@fragment
fn shadows_volume_nothing() {}
