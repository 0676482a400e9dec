// What the vertex shaders of a volume's faces give to the rasteriser.

struct Drawn {
    @invariant @builtin(position) clip: vec4f,
}

fn drawn(clip: vec4f) -> Drawn {
    return Drawn(clip);
}
