// What the debug views draw beside a volume's faces, from the lists that an extraction left.

// Six vertices a side, as the side's own draw has them: the first two are its silhouette edge, the
// others lie off the screen.
@vertex
fn shadows_volume_debug_edge(@builtin(vertex_index) vertex: u32) -> Drawn {
    let corner = vertex % 6u;
    if corner > 1u {
        return drawn(vec4f(2.0, 2.0, 0.0, 1.0));
    }
    let edge = directed_edge(vertex / 6u);
    return drawn(near_point(position(select(edge.x, edge.y, corner == 1u))));
}

@vertex
fn shadows_volume_debug_caster(
    @builtin(vertex_index) vertex: u32,
) -> Drawn {
    return drawn(near_point(position(vertex)));
}
