// Silhouettes without compute and without storage buffers: every triangle and every edge is drawn,
// as one instance each, and what is no part of the volume shrinks to a point. An edge carries its
// triangles whole and in their own order of corners, so that all edges of a triangle, and its caps,
// come to the same sign from the same numbers. (McGuire, "Efficient shadow volume rendering",
// 2004, carries the neighbours' normals, which round on their own.)

// A draw is one caster's.
@group(0) @binding(2) var<uniform> caster: Caster;

fn cap_count(a: vec3f, b: vec3f, c: vec3f) -> i32 {
    let light = caster.object_light;
    let count = light_side(a, b, c, light, caster.object_light_rest, caster.zero);
    return counted(count, caster.both_sides);
}

// Corner 0 of a triangle stays, 1 and 2 change places; of a second triangle 4 and 5.
fn turned(corner: u32) -> u32 {
    return (0x453120u >> (4u * corner)) & 7u;
}

// One of three. Not from an array: what is found by a number that only the shader knows, small GPUs keep
// in memory.
fn one_of(a: vec3f, b: vec3f, c: vec3f, corner: u32) -> vec3f {
    return select(select(a, b, corner == 1u), c, corner == 2u);
}

fn cap_corner(vertex: u32, a: vec3f, b: vec3f, c: vec3f) -> vec3f {
    let count = cap_count(a, b, c);
    let corner = select(vertex, turned(vertex), count < 0);
    return one_of(a, b, c, select(corner, 0u, count == 0));
}

struct Triangle {
    @location(0) a: vec3f,
    @location(1) b: vec3f,
    @location(2) c: vec3f,
}

@vertex
fn shadows_volume_light_cap(
    @builtin(vertex_index) vertex: u32,
    triangle: Triangle,
) -> Drawn {
    return drawn(near_point(cap_corner(vertex, triangle.a, triangle.b, triangle.c)));
}

@vertex
fn shadows_volume_dark_cap(
    @builtin(vertex_index) vertex: u32,
    triangle: Triangle,
) -> Drawn {
    return drawn(far_point(cap_corner(vertex, triangle.a, triangle.b, triangle.c)));
}

// An edge and two triangles that use it. Where it has only one, the second is a point.
struct Edge {
    @location(0) a: vec3f,
    @location(1) b: vec3f,
    @location(2) c: vec3f,
    @location(3) d: vec3f,
    @location(4) e: vec3f,
    @location(5) f: vec3f,
    // Bits 0-1, 2-3: the edge's ends among the first triangle's corners. Bits 4, 5: whether the
    // first and the second triangle run through it from the second end to the first.
    @location(6) code: u32,
}

// How often, and in which direction, the caps' boundary runs through the edge.
fn side_count(edge: Edge) -> i32 {
    let first = cap_count(edge.a, edge.b, edge.c);
    let second = cap_count(edge.d, edge.e, edge.f);
    return select(first, -first, (edge.code & 16u) != 0u)
        + select(second, -second, (edge.code & 32u) != 0u);
}

@vertex
fn shadows_volume_side(
    @builtin(vertex_index) vertex: u32,
    edge: Edge,
) -> Drawn {
    let count = side_count(edge);
    let start = one_of(edge.a, edge.b, edge.c, edge.code & 3u);
    // An edge is extruded twice at most.
    let copy = select(0u, 1u, vertex >= caster.side_vertices);
    if copy >= u32(abs(count)) {
        return drawn(near_point(start));
    }
    // The same triangles whichever way they are turned: where two sides of one edge cancel, they do
    // so to the last bit.
    let place = vertex - copy * caster.side_vertices;
    let corner = select(place, turned(place), count < 0);
    let second = one_of(edge.a, edge.b, edge.c, (edge.code >> 2u) & 3u);
    let end = select(start, second, side_corner_is_second(corner));
    if side_corner_is_far(corner) {
        return drawn(far_point(end));
    }
    return drawn(near_point(end));
}

@vertex
fn shadows_volume_fan(
    @builtin(vertex_index) vertex: u32,
    edge: Edge,
) -> Drawn {
    let count = side_count(edge);
    let copy = select(0u, 1u, vertex >= 3u);
    let place = vertex - 3u * copy;
    let corner = select(place, turned(place), count < 0);
    if copy >= u32(abs(count)) || corner == 0u {
        return drawn(fan_apex());
    }
    let end = select(edge.code, edge.code >> 2u, fan_corner_is_second(corner));
    return drawn(far_point(one_of(edge.a, edge.b, edge.c, end & 3u)));
}
