// What kernels on a cube map need besides the light: the texel frame of the face that a receiver
// falls on, and the depth of the receiver's plane in the direction of any texel.

// A map stores near / d, d along the major axis, which for a plane n.x = q is near * (n.dir) / q
// with dir of length 1 along that axis: linear in dir, so that the depth of the receiver's plane in any
// direction is one dot product, and no tap needs a bias for slope. Directions are in texels: from the
// light to the middle of a face it is half of the map's size.
struct ShadowsCubeReceiver {
    face: ShadowsCubeFace,
    // Where it is on its face, in texels from the middle.
    texel: vec2f,
    // How the plane's depth changes from texel to texel, along the face's axes (right, down).
    slope: vec2f,
    // The plane's depth at the face's corner.
    corner: f32,
    // The same at the receiver. Stands in for that at a texel which does not see the plane, so that
    // nothing behind the receiver shadows it.
    own: f32,
    // No tap takes the plane for nearer than this depth, a thirty-second of the receiver's distance:
    // what casts from nearer casts at any grazing angle.
    bound: f32,
    // Depth of the plane's horizon: no receiver is at this depth or below.
    horizon: f32,
    // From the light, along the face's axes (forward, right, down).
    local: vec3f,
    // The same with length 1, and the unit normal, along the world's axes.
    ray: vec3f,
    normal: vec3f,
    // World width of a texel at the receiver.
    width: f32,
    // Whether the map says what the receiver sees, and if not, whether it is lit.
    asks: bool,
    lit: bool,
    // Of the light, and of the receiver's face.
    light: ShadowsLight,
    tile: ShadowsTile,
}

// What is known of a receiver's plane.
struct ShadowsCubeDerived {
    // Geometric, of any length and either sign; its squared length, and its part along the ray from the light.
    normal: vec3f,
    squared: f32,
    facing: f32,
    // The same without its sign, of where the receiver is taken to be: nearer to the light, if anything.
    taken: f32,
}

// A normal that the host knows.
fn shadows_cube_given(light: ShadowsLight, position: vec3f, normal: vec3f) -> ShadowsCubeDerived {
    let facing = dot(normal, position - light.position);
    return ShadowsCubeDerived(normal, dot(normal, normal), facing, abs(facing));
}

fn shadows_cube_receiver(
    light: ShadowsLight,
    position: vec3f,
    derived: ShadowsCubeDerived,
) -> ShadowsCubeReceiver {
    let from_light = position - light.position;
    let squared = shadows_cube_squared(from_light);
    let major = shadows_cube_major(from_light);
    let facing = derived.facing;
    // Of the ray to the plane's normal, times the normal's length: Pythagoras. The normal's length cancels.
    let sine = sqrt(abs(derived.squared - facing * facing / squared));
    // As far as rounding may have moved the receiver, where that is more than the bias in texels.
    let rounded = light.rounding * dot(abs(derived.normal), abs(position) + abs(from_light));
    let left = derived.taken - max(light.normal_offset * major * sine, rounded);
    var receiver: ShadowsCubeReceiver;
    // The light within the bias of the receiver's plane: nothing is between them. Nor is there at the
    // light itself, or where there is no plane: there the bias and what it is taken from are 0.
    let reached = squared <= light.range_squared;
    let point = shadows_kind(light) == 1u;
    receiver.asks = reached & point & shadows_casts(light) & (left > 0.0);
    receiver.lit = reached & point;
    let face = shadows_cube_face(from_light);
    receiver.face = face;
    let per_length = light.forward.x / left;
    let across = shadows_cube_across(face, from_light);
    let to_face = light.texels / major;
    let step = shadows_cube_step(light.quantum);
    receiver.texel = across * to_face;
    let normal = shadows_cube_across(face, derived.normal);
    receiver.slope = normal * select(-per_length, per_length, facing > 0.0);
    receiver.own = abs(facing) * per_length * to_face + step;
    receiver.corner = receiver.own - dot(receiver.slope, receiver.texel + light.middle);
    receiver.bound = light.forward.y * to_face + step;
    receiver.horizon = step;
    receiver.local = vec3f(major, across);
    receiver.ray = from_light * inverseSqrt(squared);
    receiver.normal = derived.normal * (select(1.0, -1.0, facing > 0.0) * inverseSqrt(derived.squared));
    receiver.width = major * light.texel;
    receiver.light = light;
    receiver.tile = shadows_cube_tile(light, face);
    return receiver;
}

// Where the receiver is between the centres of texels, 0 .. 1.
fn shadows_cube_between(receiver: ShadowsCubeReceiver) -> vec2f {
    return fract(receiver.texel + receiver.light.centre);
}

// The corner of a place's texel toward that of the face.
fn shadows_cube_floor(receiver: ShadowsCubeReceiver, place: vec2f) -> vec2f {
    return floor(place + receiver.light.middle) - receiver.light.middle;
}

// Depth of the receiver's plane in a direction along the face's axes (forward, right, down), in texels.
fn shadows_cube_at(receiver: ShadowsCubeReceiver, coordinates: vec3f) -> f32 {
    // What the gradient is along the face's axis: at the receiver the plane has its own depth.
    let forward = (receiver.own - dot(receiver.slope, receiver.texel)) / receiver.light.texels;
    return receiver.own + dot(receiver.slope, coordinates.yz - receiver.texel)
        + forward * (coordinates.x - receiver.light.texels);
}
