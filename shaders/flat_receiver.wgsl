// What kernels on a spot's or a directional light's tile need besides the light: the depth of the receiver's plane at any
// texel.

// Depth is near / d (spot) or 1 - d / range (directional), d along the frame's forward axis. Of a
// plane either is linear over the map.
struct ShadowsFlatReceiver {
    // In texels from the tile's middle.
    texel: vec2f,
    // How the plane's depth changes from texel to texel.
    slope: vec2f,
    // The plane's depth at the tile's corner.
    corner: f32,
    // The same at the receiver. Stands in for that at a texel which does not see the plane, so that
    // nothing behind the receiver shadows it.
    own: f32,
    // The same without the bias in texels, which at grazing angles is most of the distance between a spot and
    // the plane. Disks, which mirror no texels, take it in place of `own`.
    alone: f32,
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
    // Of the light, and where its tile is.
    light: ShadowsLight,
    tile: ShadowsTile,
    spot: bool,
    // Whether the map says what the receiver sees, and if not, whether it is lit.
    asks: bool,
    lit: bool,
}

// What is known of a receiver's plane.
struct ShadowsFlatDerived {
    // Geometric, of any length and either sign; its squared length, and its part along the ray: that from a
    // spot to the receiver, or the direction of parallel ones.
    normal: vec3f,
    squared: f32,
    facing: f32,
    // How far the plane is moved toward the light, times the normal's length.
    moved: f32,
}

fn shadows_flat_ray(light: ShadowsLight, from_light: vec3f) -> vec3f {
    return select(light.forward, from_light, shadows_flat_spot(light));
}

// A normal that the host knows.
fn shadows_flat_given(light: ShadowsLight, position: vec3f, normal: vec3f) -> ShadowsFlatDerived {
    let facing = dot(normal, shadows_flat_ray(light, position - light.position));
    return ShadowsFlatDerived(normal, dot(normal, normal), facing, 0.0);
}

fn shadows_flat_receiver(
    light: ShadowsLight,
    position: vec3f,
    derived: ShadowsFlatDerived,
) -> ShadowsFlatReceiver {
    let spot = shadows_flat_spot(light);
    let axes = mat3x3f(light.forward, light.right, light.down);
    let from_light = position - light.position;
    let local = from_light * axes;
    let n = derived.normal * axes;
    let squared = dot(from_light, from_light);
    let away = select(1.0, local.x, spot);
    let inverse = 1.0 / away;
    let facing = abs(derived.facing);
    // Of the ray to the plane's normal, times the normal's length: Pythagoras. The normal's length cancels.
    let along = select(facing * facing, facing * facing / squared, spot);
    let sine = sqrt(abs(derived.squared - along));
    // As far as rounding may have moved the receiver, where that is more than the bias in texels.
    let rounded = light.rounding * dot(abs(derived.normal), abs(position) + abs(from_light));
    let offset = max(light.normal_offset * away * sine, rounded);
    // What is left of the distance between a spot and the plane. That a plane is moved turns it for a spot:
    // by what derivatives do not say, to a thirty-second at most.
    let taken = max(facing - derived.moved, 0.03125 * facing);
    let left = select(facing, taken - offset, spot);
    let per_length = light.depth_per / left;
    var receiver: ShadowsFlatReceiver;
    // Behind a spot the map says nothing. A spot within the bias of the receiver's plane: nothing is between
    // them. The plane seen from its edge by a directional light: nothing of it is hidden. Nor where there is
    // no plane.
    let reached = shadows_flat_served(light) & (!spot | (squared <= light.range_squared));
    receiver.asks = reached & shadows_casts(light) & (away > 0.0) & (facing > 0.0) & (left > 0.0);
    receiver.lit = reached;
    receiver.texel = local.yz * (light.texels * inverse);
    receiver.slope = n.yz * (light.texel * select(-per_length, per_length, derived.facing > 0.0));
    let parallel = 1.0 + light.depth_bias - local.x * light.depth_per + per_length * (offset + derived.moved);
    receiver.own = select(parallel, per_length * facing * inverse, spot) + light.quantum;
    receiver.corner = receiver.own - dot(receiver.slope, receiver.texel + light.middle);
    receiver.alone = light.depth_per * facing * inverse / (taken - rounded) + light.quantum;
    // Far behind all casters the sum is below 0, and so would be taken to lie behind empty texels.
    let nearest = max(0.0, receiver.own + light.widths);
    receiver.bound = select(nearest, 32.0 * light.depth_per * inverse + light.quantum, spot);
    receiver.horizon = select(-3e38, light.quantum, spot);
    receiver.local = local;
    receiver.ray = select(vec3f(1.0, 0.0, 0.0), local * inverseSqrt(squared), spot);
    receiver.normal = n * (select(1.0, -1.0, derived.facing > 0.0) * inverseSqrt(derived.squared));
    receiver.width = light.texel * away;
    receiver.light = light;
    receiver.tile = shadows_tile(light);
    receiver.spot = spot;
    return receiver;
}

// Where the receiver is between the centres of texels, 0 .. 1.
fn shadows_flat_between(receiver: ShadowsFlatReceiver) -> vec2f {
    return fract(receiver.texel + receiver.light.centre);
}

// The corner of a place's texel toward that of the tile.
fn shadows_flat_floor(receiver: ShadowsFlatReceiver, place: vec2f) -> vec2f {
    let middle = receiver.light.middle;
    return floor(place + middle) - middle;
}
