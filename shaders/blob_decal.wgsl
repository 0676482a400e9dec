// Blobs drawn over the host's depth: a hull around what each can darken, whose far sides cover every pixel of
// it once, wherever the eye is. Needs `blob_visibility.wgsl`.

struct ShadowsBlobView {
    // Both are about `origin`, the eye, so that nothing is lost far from the world's origin.
    clip_from_world: mat4x4f,
    world_from_clip: mat4x4f,
    origin: vec4f,
    clear_depth: f32,
    turn: f32, // -1 where the view mirrors
    spare: vec2f,
    spare_6: array<vec4f, 6>,
}

@group(0) @binding(0) var<uniform> shadows_blob_view: ShadowsBlobView;
@group(0) @binding(1) var<uniform> shadows_blob_light: ShadowsBlobLight;
// Not as depth, which GL does not load texel by texel.
@group(0) @binding(2) var shadows_blob_depth: texture_2d<f32>;

struct ShadowsBlobInstance {
    @location(0) row_x: vec4f,
    @location(1) row_y: vec4f,
    @location(2) row_z: vec4f,
    @location(3) extent: vec4f,
}

struct ShadowsBlobFragment {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) row_x: vec4f,
    @location(1) @interpolate(flat) row_y: vec4f,
    @location(2) @interpolate(flat) row_z: vec4f,
    @location(3) @interpolate(flat) extent: vec4f,
}

// For what rounding takes from the hull.
const SHADOWS_BLOB_SLACK: f32 = 1.0 + 1.0 / 256.0;

fn shadows_blob_of(row_x: vec4f, row_y: vec4f, row_z: vec4f, extent: vec4f) -> ShadowsBlob {
    return ShadowsBlob(row_x, row_y, row_z, extent.x, extent.y, extent.zw);
}

// Half the ellipsoid's width along a unit vector; `axes` are images of the unit sphere's.
fn shadows_blob_extent(axes: mat3x3f, direction: vec3f) -> f32 {
    return length(direction * axes);
}

// A corner of the hull, from the centre.
fn shadows_blob_corner(blob: ShadowsBlob, light: ShadowsBlobLight, corner: u32) -> vec3f {
    let rows = mat3x3f(
        blob.radius * blob.row_x.xyz,
        blob.radius * blob.row_y.xyz,
        blob.radius * blob.row_z.xyz,
    );
    let volume = blob.radius / determinant(rows);
    let axes = mat3x3f(
        volume * cross(rows[1], rows[2]),
        volume * cross(rows[2], rows[0]),
        volume * cross(rows[0], rows[1]),
    );
    let to_light = shadows_blob_to_light(light, shadows_blob_centre(blob));
    let distance = length(to_light);
    let away = -to_light / select(distance, 1.0, distance == 0.0);
    // Principal axes of the outline as seen along the light.
    let beside = shadows_blob_beside(away);
    let p = beside[0] * axes;
    let q = beside[1] * axes;
    let half_difference = 0.5 * (dot(p, p) - dot(q, q));
    let mixed = dot(p, q);
    let size = length(vec2f(half_difference, mixed));
    let is_round = size == 0.0;
    let cosine = select(half_difference / select(size, 1.0, is_round), 1.0, is_round);
    let c = sqrt(max(0.5 + 0.5 * cosine, 0.0));
    let s = sqrt(max(0.5 - 0.5 * cosine, 0.0)) * select(1.0, -1.0, mixed < 0.0);
    let u = c * beside[0] + s * beside[1];
    let v = c * beside[1] - s * beside[0];

    // What is darkened lies between the plane before the blob and the end of the reach, no farther aside
    // than the reach, and within a pyramid that widens by the penumbra.
    let thickness = shadows_blob_extent(axes, away);
    let end = blob.radius + light.reach;
    let width = vec2f(shadows_blob_extent(axes, u), shadows_blob_extent(axes, v));
    let directional = light.homogeneous.w == 0.0;
    let least = SHADOWS_BLOB_LEAST_SLOPE * (distance + end);
    let light_radius = max(light.radius, least);
    let between = distance - thickness - light_radius;
    let before = directional | (between > 0.0);
    let by_point = (width + light_radius) / select(1.0, between, between > 0.0);
    let slope = max(light.radius, SHADOWS_BLOB_LEAST_SLOPE);
    let grown = (thickness + end) * select(by_point, vec2f(slope), directional);
    let is_wide = grown > vec2f(end);
    let boundless = is_wide | vec2<bool>(before == false);
    let near_width = select(width, vec2f(end), boundless);
    let far_width = select(width + grown, vec2f(end), boundless);

    let side = vec3f(vec3u(corner, corner >> 1u, corner >> 2u) & vec3u(1u));
    let half = mix(near_width, far_width, side.z) * (2.0 * side.xy - 1.0);
    let start = select(-end, -thickness, before);
    let deep = mix(start, end, side.z);
    return SHADOWS_BLOB_SLACK * (half.x * u + half.y * v + deep * away);
}

@vertex
fn shadows_blob_vertex(
    @builtin(vertex_index) corner: u32,
    in: ShadowsBlobInstance,
) -> ShadowsBlobFragment {
    let blob = shadows_blob_of(in.row_x, in.row_y, in.row_z, in.extent);
    if !shadows_blob_casts(blob) {
        // All corners in one place, beside the picture.
        let nowhere = vec4f(2.0, 2.0, 0.5, 1.0);
        return ShadowsBlobFragment(nowhere, in.row_x, in.row_y, in.row_z, in.extent);
    }
    // Mirrored once more, so that far sides are back sides.
    let mirrored = select(corner, corner ^ 1u, shadows_blob_view.turn < 0.0);
    let from_centre = shadows_blob_corner(blob, shadows_blob_light, mirrored);
    let to_centre = shadows_blob_centre(blob) - shadows_blob_view.origin.xyz;
    let clip = shadows_blob_view.clip_from_world * vec4f(to_centre + from_centre, 1.0);
    // Neither the near plane nor the far one may cut it.
    let position = vec4f(clip.xy, 0.5 * clip.w, clip.w);
    return ShadowsBlobFragment(position, in.row_x, in.row_y, in.row_z, in.extent);
}

@fragment
fn shadows_blob_fragment(in: ShadowsBlobFragment) -> @location(0) vec4f {
    let size = vec2f(textureDimensions(shadows_blob_depth));
    let depth = textureLoad(shadows_blob_depth, vec2i(in.clip.xy), 0).x;
    if depth == shadows_blob_view.clear_depth {
        return vec4f(1.0);
    }
    let place = in.clip.xy / size * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    let seen = shadows_blob_view.world_from_clip * vec4f(place, depth, 1.0);
    let from_eye = seen.xyz / seen.w;
    let eye = shadows_blob_view.origin.xyz;
    let blob = shadows_blob_of(in.row_x, in.row_y, in.row_z, in.extent);
    let from_centre = from_eye + (eye - shadows_blob_centre(blob));
    let to_light = shadows_blob_to_light(shadows_blob_light, eye)
        - shadows_blob_light.homogeneous.w * from_eye;
    let visibility = shadows_blob_past(blob, shadows_blob_light, from_centre, to_light);
    return vec4f(vec3f(visibility), 1.0);
}
