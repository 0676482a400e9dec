// The taps of a disk on a cube map: those of a disk that goes over an edge of the receiver's face look for the
// face of each by itself. Two loops, of which one is gone round: one tap that could be either is as dear as both.

// A disk along the axes of the receiver's face, as its taps have it.
fn shadows_cube_on_face(receiver: ShadowsCubeReceiver, disk: ShadowsCubeDisk) -> ShadowsCubeDisk {
    let face = receiver.face;
    return ShadowsCubeDisk(
        vec3f(shadows_cube_ahead(face, disk.across), shadows_cube_across(face, disk.across)),
        vec3f(shadows_cube_ahead(face, disk.along), shadows_cube_across(face, disk.along)),
    );
}

// Depths at one tap, on whichever face: the plane's and the stored one.
fn shadows_cube_tap_over(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    disk: ShadowsCubeDisk,
    offset: vec2f,
) -> vec2f {
    let local = receiver.local + offset.x * disk.across + offset.y * disk.along;
    return shadows_cube_look_over(map, map_sampler, receiver, local);
}

fn shadows_cube_lit(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    in_world: ShadowsCubeDisk,
    offsets: texture_3d<f32>,
    column: vec2f,
    layer: f32,
    taps: u32,
    first: u32,
) -> f32 {
    let disk = shadows_cube_on_face(receiver, in_world);
    let holds = shadows_cube_holds(receiver, disk);
    let lit = shadows_cube_lit_on(
        map, map_sampler, receiver, disk, offsets, column, layer, select(0u, taps, holds), first,
    );
    var blocked = 0u;
    let end = select(taps, 0u, holds);
    var at = vec3f(column, 0.25 * layer);
    for (var i = 0u; i < end; i++) {
        let pair = textureSampleLevel(offsets, map_sampler, at, 0.0);
        let offset = select(pair.xy, pair.zw, (i & 1u) == 1u);
        at.z += 0.5 * layer;
        let depths = shadows_cube_tap_over(map, map_sampler, receiver, disk, offset);
        blocked += select(0u, 1u, depths.x < depths.y);
    }
    return select(shadows_cube_share(blocked, taps), lit, holds);
}
