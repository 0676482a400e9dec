// The four kinds of faces of a shadow volume, from the lists that an extraction left. Every vertex
// is pulled by its index.
//
// A draw is that of many casters: an instance is a block of up to eight elements, sides or triangles of a
// cap, of one of them. What of a block has no element shrinks to a point.

@group(0) @binding(2) var<storage, read> casters: array<Caster>;
@group(0) @binding(3) var<storage, read> positions: array<f32>;
@group(0) @binding(4) var<storage, read> edges: array<vec4u>;
// Sides, or the corners of caps.
@group(0) @binding(5) var<storage, read> elements: array<u32>;

// The caster, the first word of the elements, and their number: 0 where the draw is indexed, all of it one
// caster's.
struct Block {
    @location(0) caster_first_count: vec3u,
}

// The block's own.
var<private> caster: Caster;

fn begin(block: Block) {
    caster = casters[block.caster_first_count.x];
}

fn is_beyond(element: u32, block: Block) -> bool {
    return element >= block.caster_first_count.z;
}

fn nowhere() -> Drawn {
    return drawn(vec4f(2.0, 2.0, 0.0, 1.0));
}

fn position(vertex: u32) -> vec3f {
    let word = caster.position_offset + vertex * caster.position_stride;
    return vec3f(positions[word], positions[word + 1u], positions[word + 2u]);
}

fn cap_corner(vertex: u32, block: Block) -> u32 {
    if block.caster_first_count.z == 0u {
        return vertex;
    }
    return elements[block.caster_first_count.y + vertex];
}

fn is_beyond_cap(vertex: u32, block: Block) -> bool {
    return block.caster_first_count.z != 0u && is_beyond(vertex / 3u, block);
}

@vertex
fn shadows_volume_light_cap(
    @builtin(vertex_index) vertex: u32,
    block: Block,
) -> Drawn {
    if is_beyond_cap(vertex, block) {
        return nowhere();
    }
    begin(block);
    return drawn(near_point(position(cap_corner(vertex, block))));
}

@vertex
fn shadows_volume_dark_cap(
    @builtin(vertex_index) vertex: u32,
    block: Block,
) -> Drawn {
    if is_beyond_cap(vertex, block) {
        return nowhere();
    }
    begin(block);
    return drawn(far_point(position(cap_corner(vertex, block))));
}

// The edge that a side is made of, in the direction in which the caps' boundary runs through it.
fn directed_edge(place: u32, block: Block) -> vec2u {
    let side = elements[block.caster_first_count.y + place];
    let edge = edges[caster.edge_base + (side >> 1u)].xy;
    return select(edge, edge.yx, (side & 1u) == 1u);
}

// A cap that runs through an edge is bounded there by the edge's side.
@vertex
fn shadows_volume_side(
    @builtin(vertex_index) vertex: u32,
    block: Block,
) -> Drawn {
    begin(block);
    // Three vertices a side, or twice that: no division by what a buffer says.
    let place = (vertex / 3u) >> select(0u, 1u, caster.side_vertices == 6u);
    if is_beyond(place, block) {
        return nowhere();
    }
    let edge = directed_edge(place, block);
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
    block: Block,
) -> Drawn {
    let place = vertex / 3u;
    if is_beyond(place, block) {
        return nowhere();
    }
    begin(block);
    let edge = directed_edge(place, block);
    let corner = vertex % 3u;
    if corner == 0u {
        return drawn(fan_apex());
    }
    return drawn(far_point(position(select(edge.x, edge.y, fan_corner_is_second(corner)))));
}
