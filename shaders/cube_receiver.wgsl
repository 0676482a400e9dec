// What every kernel on a cube map needs: the light, the texel frame of the face that a receiver
// falls on, and the depth of the receiver's plane in the direction of any texel.

struct ShadowsCubeLight {
    // World space.
    position: vec3f,
    near: f32,
    range: f32,
    // Texels along a face.
    size: f32,
    // Biases; a texel at distance 1 along the major axis is 2 / size wide.
    normal_offset: f32,
    depth_scale: f32,
    // One step of the map's format.
    quantum: f32,
    // Which cube of the array; -1: no caster in range, -2: not drawn yet.
    cube: i32,
}

// One face of the cube, seen from a receiver on it: directions are
// forward + u * right + v * down with u and v in -1 .. 1, and `texel` is where the receiver is,
// in texels from the corner (-1, -1).
struct ShadowsCubeFace {
    forward: vec3f,
    right: vec3f,
    down: vec3f,
    texel: vec2f,
}

// A map stores near / d, d along the major axis, which for a plane n.x = q is near * (n.dir) / q
// with dir of length 1 along that axis: linear in dir. `plane` is near * n / q, so that the depth
// of the receiver's plane in any direction is one dot product (its parts along the face's axes
// here), and no tap needs a bias for slope.
struct ShadowsReceiver {
    face: ShadowsCubeFace,
    plane: vec3f,
    // 1: surely lit, 0: surely unlit, -1: ask the map.
    known: f32,
    cube: i32,
    quantum: f32,
    range_over_near: f32,
}

fn shadows_cube_face(direction: vec3f, size: f32) -> ShadowsCubeFace {
    let a = abs(direction);
    var face: ShadowsCubeFace;
    if a.x >= a.y && a.x >= a.z {
        let side = select(-1.0, 1.0, direction.x > 0.0);
        face.forward = vec3f(side, 0.0, 0.0);
        face.right = vec3f(0.0, 0.0, -side);
        face.down = vec3f(0.0, -1.0, 0.0);
    } else if a.y >= a.z {
        let side = select(-1.0, 1.0, direction.y > 0.0);
        face.forward = vec3f(0.0, side, 0.0);
        face.right = vec3f(1.0, 0.0, 0.0);
        face.down = vec3f(0.0, 0.0, side);
    } else {
        let side = select(-1.0, 1.0, direction.z > 0.0);
        face.forward = vec3f(0.0, 0.0, side);
        face.right = vec3f(side, 0.0, 0.0);
        face.down = vec3f(0.0, -1.0, 0.0);
    }
    let major = dot(face.forward, direction);
    let uv = vec2f(dot(face.right, direction), dot(face.down, direction)) / major;
    face.texel = (uv * 0.5 + 0.5) * size;
    return face;
}

// `normal` is the geometric one, of any length and either sign; it is turned toward the light.
fn shadows_receiver(light: ShadowsCubeLight, position: vec3f, normal: vec3f) -> ShadowsReceiver {
    let from_light = position - light.position;
    let distance = length(from_light);
    var receiver: ShadowsReceiver;
    if distance > light.range || light.cube < 0 {
        receiver.known = select(0.0, 1.0, distance <= light.range && light.cube == -1);
        return receiver;
    }
    receiver.cube = light.cube;
    receiver.quantum = light.quantum;
    receiver.range_over_near = light.range / light.near;
    receiver.face = shadows_cube_face(from_light, light.size);
    let toward_light = -sign(dot(normal, from_light));
    let n = normalize(normal) * select(toward_light, 1.0, toward_light == 0.0);
    let height = dot(n, from_light);
    let sine = length(cross(n, from_light)) / distance;
    let major = dot(receiver.face.forward, from_light);
    let plane_distance = height + light.normal_offset * major * sine;
    // The light within the bias of the receiver's plane: nothing is between them. Written so that
    // a receiver at the light itself, where the numbers above are not numbers, is lit too.
    if !(plane_distance < 0.0) {
        receiver.known = 1.0;
        return receiver;
    }
    let scale = light.near * light.depth_scale / plane_distance;
    receiver.plane = scale * vec3f(
        dot(n, receiver.face.forward),
        dot(n, receiver.face.right),
        dot(n, receiver.face.down),
    );
    receiver.known = -1.0;
    return receiver;
}

// 1 where a texel sees the receiver's plane, 0 where a caster is nearer. `texel` counts from the
// face's corner and may lie beyond its edge: there the grid goes on, texel for texel, on the
// neighbouring face, whose texels have directions (and major axes) of their own.
fn shadows_cube_texel(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsReceiver,
    size: f32,
    texel: vec2f,
) -> f32 {
    let step = 2.0 / size;
    var uv = (texel + 0.5) * step - 1.0;
    var coordinates: vec3f;
    if abs(uv.x) > 1.0 {
        // Beyond a corner no fourth texel exists; the last one along the edge stands in.
        uv.y = clamp(uv.y, 0.5 * step - 1.0, 1.0 - 0.5 * step);
        coordinates = vec3f(2.0 - abs(uv.x), sign(uv.x), uv.y);
    } else if abs(uv.y) > 1.0 {
        coordinates = vec3f(2.0 - abs(uv.y), uv.x, sign(uv.y));
    } else {
        coordinates = vec3f(1.0, uv);
    }
    let face = receiver.face;
    let direction = mat3x3f(face.forward, face.right, face.down) * coordinates;
    let found = vec4f(shadows_cube_fetch(map, map_sampler, receiver, direction));
    let stored = shadows_cube_depth(receiver, found, vec4f(dot(coordinates, coordinates))).x;
    // Behind the plane's horizon the plane is infinitely far away: depth 0.
    let reference = max(dot(receiver.plane, coordinates), 0.0);
    return select(0.0, 1.0, reference >= stored);
}
