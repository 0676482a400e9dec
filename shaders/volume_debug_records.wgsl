// What the debug views draw beside a volume's faces, from all triangles and edges.

// Two vertices an edge: a line if the caps' boundary runs through it, else a point off the screen.
@vertex
fn shadows_volume_debug_edge(
    @builtin(vertex_index) vertex: u32,
    edge: Edge,
) -> Drawn {
    if side_count(edge) == 0 {
        return drawn(vec4f(2.0, 2.0, 0.0, 1.0));
    }
    let end = select(edge.code, edge.code >> 2u, vertex == 1u);
    return drawn(near_point(one_of(edge.a, edge.b, edge.c, end & 3u)));
}

@vertex
fn shadows_volume_debug_caster(
    @builtin(vertex_index) vertex: u32,
    triangle: Triangle,
) -> Drawn {
    return drawn(near_point(one_of(triangle.a, triangle.b, triangle.c, vertex)));
}
