// The four kinds of faces of a shadow volume, from the lists that an extraction left. Every vertex
// is pulled by its index.

@group(0) @binding(3) var<storage, read> positions: array<f32>;
@group(0) @binding(4) var<storage, read> edges: array<vec4u>;
@group(0) @binding(5) var<storage, read> sides: array<u32>;

fn position(vertex: u32) -> vec3f {
    let word = caster.position_offset + vertex * caster.position_stride;
    return vec3f(positions[word], positions[word + 1u], positions[word + 2u]);
}

@vertex
fn shadows_volume_light_cap(
    @builtin(vertex_index) vertex: u32,
) -> Drawn {
    return drawn(near_point(position(vertex)));
}

@vertex
fn shadows_volume_dark_cap(
    @builtin(vertex_index) vertex: u32,
) -> Drawn {
    return drawn(far_point(position(vertex)));
}

// The edge that a side is made of, in the direction in which the caps' boundary runs through it.
fn directed_edge(place: u32) -> vec2u {
    let side = sides[caster.side_base + place];
    let edge = edges[caster.edge_base + (side >> 1u)].xy;
    return select(edge, edge.yx, (side & 1u) == 1u);
}

// A cap that runs through an edge is bounded there by the edge's side.
@vertex
fn shadows_volume_side(
    @builtin(vertex_index) vertex: u32,
) -> Drawn {
    // Three vertices a side, or twice that: no division by what a buffer says.
    let place = (vertex / 3u) >> select(0u, 1u, caster.side_vertices == 6u);
    let edge = directed_edge(place);
    let corner = vertex - place * caster.side_vertices;
    let end = position(select(edge.x, edge.y, side_corner_is_second(corner)));
    if side_corner_is_far(corner) {
        return drawn(far_point(end));
    }
    return drawn(near_point(end));
}

@vertex
fn shadows_volume_fan(
    @builtin(vertex_index) vertex: u32,
) -> Drawn {
    let edge = directed_edge(vertex / 3u);
    let corner = vertex % 3u;
    if corner == 0u {
        return drawn(fan_apex());
    }
    return drawn(far_point(position(select(edge.x, edge.y, fan_corner_is_second(corner)))));
}
