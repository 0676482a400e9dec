// The faces of a cube, each of which is a tile.

// Which face of the cube a direction falls on, and which of the face's axes (forward, right, down) point the
// way of the world's. All as truth values, for which GPUs have registers of their own.
struct ShadowsCubeFace {
    x_major: bool,
    y_major: bool,
    forward: bool,
    right: bool,
    down: bool,
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

// The part of a vector along a face's axis forward.
fn shadows_cube_ahead(face: ShadowsCubeFace, v: vec3f) -> f32 {
    let along = select(select(v.z, v.y, face.y_major), v.x, face.x_major);
    return select(-along, along, face.forward);
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

// The tile of one of the faces.
fn shadows_cube_tile(light: ShadowsLight, face: ShadowsCubeFace) -> ShadowsTile {
    return shadows_tile_of(light, face.x_major, face.y_major, face.forward);
}
