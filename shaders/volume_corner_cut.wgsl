// What the vertex shaders of a volume's faces give to the rasteriser, where depth is not clipped so that
// faces beyond the far plane count. That spares the near plane, too, and a face that passes the eye is then
// cut where it leaves the rasteriser's range of coordinates: at corners whose depth is huge, from which
// GPUs find the depth of the rest with an error to match. So faces are cut at the near plane, as the
// host's surfaces are.

// The depth of the near plane: 0, or 1 where depth is reversed.
override near_depth: f32 = 0.0;

struct Drawn {
    @invariant @builtin(position) clip: vec4f,
    @builtin(clip_distances) beyond_near: array<f32, 1>,
}

fn drawn(clip: vec4f) -> Drawn {
    let beyond_near = select(clip.z, clip.w - clip.z, near_depth == 1.0);
    return Drawn(clip, array(beyond_near));
}
