// What kernels on a flat map need besides the light: the depth of the receiver's plane at any
// texel.

// Depth is near / d (spot) or 1 - d / range (directional), d along the frame's forward axis. Of a
// plane either is linear over the map.
struct ShadowsFlatReceiver {
    texel: vec2f,
    // How the plane's depth changes from texel to texel.
    slope: vec2f,
    // The plane's depth at the receiver. Stands in for that at a texel which does not see the plane, so that
    // nothing behind the receiver shadows it.
    own: f32,
    // No tap takes the plane for nearer to the light than this depth: a thirty-second of the
    // receiver's distance (spot), or 16 widths of the map before the receiver (directional).
    bound: f32,
    // Depth of the plane's horizon: no receiver is at this depth or below. Parallel rays have none.
    horizon: f32,
    // From the frame's origin, the direction of the light's ray and the unit normal, along the
    // frame's axes (forward, right, down).
    local: vec3f,
    ray: vec3f,
    normal: vec3f,
    // World width of a texel at the receiver.
    width: f32,
    scale: f32,
    perspective: f32,
    range: f32,
    // Whether the map says what the receiver sees, and if not, whether it is lit.
    asks: bool,
    lit: bool,
}

// What is known of a receiver's plane.
struct ShadowsFlatDerived {
    // Geometric, of any length and either sign.
    normal: vec3f,
    // The receiver is taken to be nearer to its light: by a factor, and by so much along parallel rays.
    nearer: vec2f,
}

// A normal that the host knows.
fn shadows_flat_given(light: ShadowsFlatLight, position: vec3f, normal: vec3f) -> ShadowsFlatDerived {
    return ShadowsFlatDerived(normal, vec2f(1.0, 0.0));
}

fn shadows_flat_receiver(
    light: ShadowsFlatLight,
    position: vec3f,
    derived: ShadowsFlatDerived,
) -> ShadowsFlatReceiver {
    let normal = derived.normal;
    let nearer = derived.nearer;
    let axes = mat3x3f(light.forward, light.right, light.down);
    let from_light = position - light.position;
    let own_local = from_light * axes;
    let local = nearer.x * own_local - vec3f(nearer.y, 0.0, 0.0);
    let spot = light.perspective > 0.5;
    // Whether the light reaches it is a matter of where the receiver is, not of where it is taken to be.
    let reach = length(own_local);
    let distance = nearer.x * reach;
    var receiver: ShadowsFlatReceiver;
    // Nothing here branches on the light alone, not even as && does: Mesa's lavapipe compiles a shader
    // anew at each draw for what a uniform buffer says, if that decides a branch.
    if spot & (reach > light.range) {
        return receiver;
    }
    // Behind a spot the map says nothing.
    if (light.quantum < 0.0) | (spot & (local.x <= 0.0)) {
        receiver.lit = true;
        return receiver;
    }
    receiver.local = local;
    receiver.scale = light.scale;
    receiver.perspective = light.perspective;
    receiver.range = light.range;
    let away = select(1.0, local.x, spot);
    receiver.width = 2.0 * away / (light.size * light.scale);
    let uv = local.yz * light.scale / away;
    receiver.texel = (uv * 0.5 + 0.5) * light.size;
    receiver.ray = select(vec3f(1.0, 0.0, 0.0), local / distance, spot);
    let unit = normalize(normal);
    var n = unit * axes;
    let toward_light = -sign(dot(n, receiver.ray));
    n *= select(toward_light, 1.0, toward_light == 0.0);
    receiver.normal = n;
    let sine = length(cross(n, receiver.ray));
    // As far as rounding may have moved the receiver, where that is more than the bias in texels.
    let rounding = light.rounding * (abs(position) + abs(from_light));
    let offset = max(light.normal_offset * receiver.width * sine, dot(abs(unit), rounding));
    let plane_distance = dot(n, local) + offset;
    let across = n.yz / light.scale;
    // A spot within the bias of the receiver's plane: nothing is between them. The plane seen from its
    // edge by a directional light: nothing of it is hidden. Nor where there is no plane.
    if (dot(normal, normal) == 0.0) | (select(n.x, plane_distance, spot) >= 0.0) {
        receiver.lit = true;
        return receiver;
    }
    receiver.asks = true;
    let near = light.near * light.depth_bias;
    let spot_plane = near / plane_distance * vec3f(n.x, across);
    let per_depth = 1.0 / (n.x * light.range);
    let middle = 1.0 - plane_distance * per_depth + light.depth_bias;
    let plane = select(vec3f(middle, across * per_depth), spot_plane, spot);
    // Far behind all casters the sum is below 0, and so would be taken to lie behind empty texels.
    receiver.own = dot(plane, vec3f(1.0, uv)) + light.quantum;
    receiver.slope = plane.yz * (2.0 / light.size);
    let nearest = max(0.0, receiver.own + 32.0 / (light.scale * light.range));
    receiver.bound = select(nearest, 32.0 * near / local.x + light.quantum, spot);
    receiver.horizon = select(-3e38, light.quantum, spot);
    return receiver;
}
