// What kernels on a cube map need besides the light: the texel frame of the face that a receiver
// falls on, and the depth of the receiver's plane in the direction of any texel.

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
// of the receiver's plane in any direction is one dot product, and no tap needs a bias for slope.
struct ShadowsCubeReceiver {
    face: ShadowsCubeFace,
    texel: vec2f,
    // Along the face's axes (forward, right, down), and along the world's.
    plane: vec3f,
    gradient: vec3f,
    // The receiver's own depth: stands in for the plane's where a texel does not see the plane, so that
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

// `normal` is the geometric one, of any length and either sign; it is turned toward the light. `nearer`
// is the share of its distance at which the receiver is taken to be: 1 where the normal is known (see
// pcf_derivatives.wgsl).
fn shadows_cube_receiver(
    light: ShadowsCubeLight,
    position: vec3f,
    normal: vec3f,
    nearer: vec2f,
) -> ShadowsCubeReceiver {
    // Whether the light reaches it is a matter of where the receiver is, not of where it is taken to be.
    let own_ray = position - light.position;
    let reach = length(own_ray);
    var receiver: ShadowsCubeReceiver;
    if reach > light.range || light.cube < 0 {
        receiver.known = select(0.0, 1.0, reach <= light.range && light.cube == -1);
        return receiver;
    }
    let from_light = nearer.x * own_ray;
    let distance = nearer.x * reach;
    receiver.cube = light.cube;
    receiver.quantum = light.quantum;
    receiver.range_over_near = light.range / light.near;
    let face = shadows_cube_face(from_light, light.size);
    receiver.face = face;
    receiver.texel = face.texel;
    let toward_light = -sign(dot(normal, from_light));
    let n = normalize(normal) * select(toward_light, 1.0, toward_light == 0.0);
    let height = dot(n, from_light);
    let sine = length(cross(n, from_light)) / distance;
    let major = dot(face.forward, from_light);
    // As far as rounding may have moved the receiver, where that is more than the bias in texels.
    let rounding = light.rounding * (abs(position) + abs(from_light));
    let offset = max(light.normal_offset * major * sine, dot(abs(n), rounding));
    let plane_distance = height + offset;
    // The light within the bias of the receiver's plane: nothing is between them. Nor is there at the
    // light itself, or where there is no plane: there the numbers above are not numbers, which no
    // comparison may be trusted to say.
    if distance == 0.0 || dot(normal, normal) == 0.0 || plane_distance >= 0.0 {
        receiver.known = 1.0;
        return receiver;
    }
    let axes = mat3x3f(face.forward, face.right, face.down);
    receiver.normal = n;
    receiver.local = from_light;
    receiver.ray = from_light / distance;
    receiver.gradient = light.near * light.depth_scale / plane_distance * n;
    receiver.plane = receiver.gradient * axes;
    let own_distance = max(major - dot(abs(face.forward), rounding), 0.03125 * major);
    receiver.own = light.near * light.depth_scale / own_distance;
    receiver.bound = 32.0 * receiver.own;
    receiver.horizon = 0.0;
    receiver.width = 2.0 * major / light.size;
    receiver.known = -1.0;
    return receiver;
}
