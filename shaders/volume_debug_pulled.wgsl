// What the debug views draw beside a volume's faces, from the lists that an extraction left.

// As many vertices as the sides' own draw has, two of them a line for each side; the others lie off the
// screen.
@vertex
fn shadows_volume_debug_edge(
    @builtin(vertex_index) vertex: u32,
    block: Block,
) -> Drawn {
    let place = vertex / 2u;
    if is_beyond(place, block) {
        return nowhere();
    }
    begin(block);
    let edge = directed_edge(place, block);
    return drawn(near_point(position(select(edge.x, edge.y, vertex % 2u == 1u))));
}

@vertex
fn shadows_volume_debug_caster(
    @builtin(vertex_index) vertex: u32,
    block: Block,
) -> Drawn {
    begin(block);
    return drawn(near_point(position(vertex)));
}
