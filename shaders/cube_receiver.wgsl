// What kernels on a cube map need besides the light: the texel frame of the face that a receiver
// falls on, and the depth of the receiver's plane in the direction of any texel.

// Which face of the cube a direction falls on, and which of the face's axes (forward, right, down) point the
// way of the world's. All as truth values, for which GPUs have registers of their own.
struct ShadowsCubeFace {
    x_major: bool,
    y_major: bool,
    forward: bool,
    right: bool,
    down: bool,
}

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
    // The same along the world's axes, and as a multiple of the normal as it was given.
    gradient: vec3f,
    given: vec3f,
    per_length: f32,
    // The plane's depth at the receiver. Stands in for that at a texel which does not see the plane, so that
    // nothing behind the receiver shadows it.
    own: f32,
    // No tap takes the plane for nearer than this depth, a thirty-second of the receiver's distance:
    // what casts from nearer casts at any grazing angle.
    bound: f32,
    // Depth of the plane's horizon: no receiver is at this depth or below.
    horizon: f32,
    // From the light, the same with length 1, and the unit normal, along the world's axes.
    local: vec3f,
    ray: vec3f,
    normal: vec3f,
    // World width of a texel at the receiver.
    width: f32,
    // Whether the map says what the receiver sees, and if not, whether it is lit.
    asks: bool,
    lit: bool,
    cube: i32,
    centre: f32,
    half_size: f32,
    quantum: f32,
    range_over_near: f32,
}

// The squared length of a direction. Not 0 at the light itself, so that quotients are numbers.
fn shadows_cube_squared(direction: vec3f) -> f32 {
    let d = direction;
    return 1e-37 + d.x * d.x + d.y * d.y + d.z * d.z;
}

fn shadows_cube_major(direction: vec3f) -> f32 {
    let a = abs(direction);
    return max(a.x, max(a.y, a.z));
}

fn shadows_cube_face(direction: vec3f) -> ShadowsCubeFace {
    let a = abs(direction);
    let major = max(a.x, max(a.y, a.z));
    let ahead = direction > vec3f(0.0);
    var face: ShadowsCubeFace;
    face.x_major = a.x >= major;
    face.y_major = select(a.y >= major, false, face.x_major);
    face.forward = select(select(ahead.z, ahead.y, face.y_major), ahead.x, face.x_major);
    face.right = (face.forward != face.x_major) | face.y_major;
    face.down = face.forward & face.y_major;
    return face;
}

// The parts of a vector along a face's axes right and down.
fn shadows_cube_across(face: ShadowsCubeFace, v: vec3f) -> vec2f {
    let x = select(v.x, v.z, face.x_major);
    let y = select(v.y, v.z, face.y_major);
    return vec2f(select(-x, x, face.right), select(-y, y, face.down));
}

// From a face's axes (forward, right, down) to the world's.
fn shadows_cube_to_world(face: ShadowsCubeFace, v: vec3f) -> vec3f {
    let x = v.x * select(-1.0, 1.0, face.forward);
    let y = select(-v.y, v.y, face.right);
    let z = select(-v.z, v.z, face.down);
    return vec3f(
        select(y, x, face.x_major),
        select(z, x, face.y_major),
        select(select(x, z, face.y_major), y, face.x_major),
    );
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
fn shadows_cube_given(light: ShadowsCubeLight, position: vec3f, normal: vec3f) -> ShadowsCubeDerived {
    let facing = dot(normal, position - light.position);
    return ShadowsCubeDerived(normal, dot(normal, normal), facing, abs(facing));
}

fn shadows_cube_receiver(
    light: ShadowsCubeLight,
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
    receiver.asks = reached & (light.cube >= 0) & (left > 0.0);
    receiver.lit = reached & (light.cube >= -1);
    let face = shadows_cube_face(from_light);
    receiver.face = face;
    let per_length = light.scale / left;
    let to_face = light.half_size / major;
    let step = shadows_cube_step(light.quantum);
    receiver.texel = shadows_cube_across(face, from_light) * to_face;
    receiver.given = derived.normal;
    receiver.per_length = select(-per_length, per_length, facing > 0.0);
    receiver.gradient = derived.normal * receiver.per_length;
    receiver.slope = shadows_cube_across(face, derived.normal) * receiver.per_length;
    receiver.own = abs(facing) * per_length * to_face + step;
    receiver.bound = light.bound * to_face + step;
    receiver.horizon = step;
    receiver.local = from_light;
    receiver.ray = from_light * inverseSqrt(squared);
    receiver.normal = derived.normal * (select(1.0, -1.0, facing > 0.0) * inverseSqrt(derived.squared));
    receiver.width = major * light.texel;
    receiver.half_size = light.half_size;
    receiver.cube = light.cube;
    receiver.centre = light.centre;
    receiver.quantum = light.quantum;
    receiver.range_over_near = light.range / light.near;
    return receiver;
}

// Where the receiver is between the centres of texels, 0 .. 1.
fn shadows_cube_between(receiver: ShadowsCubeReceiver) -> vec2f {
    return fract(receiver.texel + receiver.centre);
}

// The corner of a place's texel toward that of the face.
fn shadows_cube_floor(receiver: ShadowsCubeReceiver, place: vec2f) -> vec2f {
    let corner = 0.5 - receiver.centre;
    return floor(place - corner) + corner;
}
