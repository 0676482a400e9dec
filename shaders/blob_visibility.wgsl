// How much of a light's disk an ellipsoid covers, seen from a point.
//
// A linear map keeps rays, so the ellipsoid is the unit sphere in a space of its own. There the ray from q
// through the place m = toward + x across + y along of the disk meets it where |cross(q, m)|^2 <= |m|^2: a conic
// in x and y. The part of the disk inside is summed over strips of constant y, each exact, placed and weighted
// by Gauss's quadrature for the weight sqrt(1 - y^2) (Chebyshev polynomials of the second kind).

const SHADOWS_BLOB_STRIPS: u32 = 6u;
// A light is no smaller than this part of its distance.
const SHADOWS_BLOB_LEAST_SLOPE: f32 = 1.0 / 4096.0;
// Where in the reach shadows begin to fade.
const SHADOWS_BLOB_FADE: f32 = 0.75;

struct ShadowsBlob {
    // Rows of the map from world space, about the centre, to that of the unit sphere; the centre in w.
    row_x: vec4f,
    row_y: vec4f,
    row_z: vec4f,
    // Of a sphere around it.
    radius: f32,
    opacity: f32,
    spare: vec2f,
}

struct ShadowsBlobLight {
    // A point with w = 1, or the unit vector toward a directional light with w = 0.
    homogeneous: vec4f,
    radius: f32, // of a directional light the tangent of its angular radius
    reach: f32,
    // Up to what dynamic offsets are multiples of.
    spare_2: vec2f,
    spare_14: array<vec4f, 14>,
}

// One without an area has neither a radius nor a map that could be reckoned with.
fn shadows_blob_casts(blob: ShadowsBlob) -> bool {
    return blob.radius > 0.0 && blob.opacity > 0.0;
}

fn shadows_blob_centre(blob: ShadowsBlob) -> vec3f {
    return vec3f(blob.row_x.w, blob.row_y.w, blob.row_z.w);
}

fn shadows_blob_map(blob: ShadowsBlob, v: vec3f) -> vec3f {
    return vec3f(dot(blob.row_x.xyz, v), dot(blob.row_y.xyz, v), dot(blob.row_z.xyz, v));
}

// From a point to the light: of length 1 to a directional one.
fn shadows_blob_to_light(light: ShadowsBlobLight, position: vec3f) -> vec3f {
    return light.homogeneous.xyz - light.homogeneous.w * position;
}

// Two unit vectors orthogonal to a third and to each other, right-handed with it: the first is in the plane of
// x and y, unless that is orthogonal.
fn shadows_blob_beside(axis: vec3f) -> mat2x3f {
    let flat = axis.xy;
    let length_squared = dot(flat, flat);
    let upright = length_squared < 1e-6;
    let scale = inverseSqrt(select(length_squared, 1.0, upright));
    let in_plane = vec3f(-flat.y, flat.x, 0.0) * scale;
    let first = select(in_plane, normalize(vec3f(axis.z, 0.0, -axis.x)), upright);
    return mat2x3f(first, cross(axis, first));
}

// The part of the disk that is covered, 0 to 1. `from_centre` leads from the blob's centre to the receiver.
fn shadows_blob_covered(
    blob: ShadowsBlob,
    light: ShadowsBlobLight,
    from_centre: vec3f,
    to_light: vec3f,
) -> f32 {
    let distance = length(to_light);
    if distance == 0.0 {
        return 0.0;
    }
    let axis = to_light / distance;
    let slope = max(light.radius / distance, SHADOWS_BLOB_LEAST_SLOPE);
    // The cone of the disk against the sphere around the blob.
    let ahead = -dot(from_centre, axis);
    let aside = length(from_centre + ahead * axis);
    if aside - ahead * slope > blob.radius * sqrt(1.0 + slope * slope) {
        return 0.0;
    }
    let q = shadows_blob_map(blob, from_centre);
    let to = shadows_blob_map(blob, to_light);
    // The middle of what the ray has in common with the blob lies before the light.
    let before = (light.homogeneous.w == 0.0) | (dot(to, q + to) > 0.0);
    // A receiver inside is in shadow as the surface outside of it is.
    let squared = dot(q, q);
    let inside = squared < 1.0 && squared > 0.0;
    let eye = q * select(1.0, inverseSqrt(select(1.0, squared, inside)), inside);

    let scale = 1.0 / length(to);
    let toward = to * scale;
    let beside = shadows_blob_beside(axis);
    let width = slope * distance * scale;
    let first = shadows_blob_map(blob, beside[0]) * width;
    let second = shadows_blob_map(blob, beside[1]) * width;
    let turned_toward = cross(eye, toward);
    let turned_first = cross(eye, first);
    let turned_second = cross(eye, second);
    // Strips lead across the nearest edge, along which what they have in common with the blob changes least.
    let gradient = vec2f(
        dot(turned_toward, turned_first) - dot(toward, first),
        dot(turned_toward, turned_second) - dot(toward, second),
    );
    let steepness = length(gradient);
    let level = steepness == 0.0;
    let way = select(gradient / select(steepness, 1.0, level), vec2f(1.0, 0.0), level);
    let across = way.x * first + way.y * second;
    let along = way.x * second - way.y * first;
    let turned_across = way.x * turned_first + way.y * turned_second;
    let turned_along = way.x * turned_second - way.y * turned_first;
    // a x^2 + 2 b x + c <= 0 inside, with b and c by y.
    let a = dot(turned_across, turned_across) - dot(across, across);
    let b_0 = steepness;
    let b_1 = dot(turned_along, turned_across) - dot(along, across);
    let c_0 = dot(turned_toward, turned_toward) - dot(toward, toward);
    let c_2 = dot(turned_along, turned_along) - dot(along, along);
    // Where the line is nearest to the centre must lie ahead: below 0.
    let behind = vec3f(dot(eye, toward), dot(eye, across), dot(eye, along));

    // Far below what rounding leaves of it.
    let level_a = select(a, 1e-24, abs(a) < 1e-24);
    let opens = a < 0.0;
    let to_left = behind.y > 0.0;
    let turn = vec2f(
        cos(3.14159265 / f32(SHADOWS_BLOB_STRIPS + 1u)),
        sin(3.14159265 / f32(SHADOWS_BLOB_STRIPS + 1u)),
    );
    var place = turn;
    var covered = 0.0;
    for (var strip = 0u; strip < SHADOWS_BLOB_STRIPS; strip++) {
        let y = place.x;
        let half = place.y;
        let b = b_0 + y * b_1;
        let c = c_0 + y * y * c_2;
        let discriminant = b * b - a * c;
        let root = sqrt(max(discriminant, 0.0));
        // Without the difference of what is nearly equal.
        let sum = b + select(-root, root, b >= 0.0);
        let x_0 = -sum / level_a;
        let x_1 = -c / select(sum, 1e-24, sum == 0.0);
        let left = clamp(min(x_0, x_1), -half, half);
        let right = clamp(max(x_0, x_1), -half, half);
        // Outside of both roots there is a double cone's other half, too.
        let begin = select(left, select(right, -half, to_left), opens);
        let end = select(right, select(half, left, to_left), opens);
        let middle = 0.5 * (begin + end);
        let is_ahead = behind.x + middle * behind.y + y * behind.z < 0.0;
        let meets = is_ahead && (discriminant > 0.0 || opens);
        covered += select(0.0, half * (end - begin), meets);
        place = vec2f(place.x * turn.x - place.y * turn.y, place.x * turn.y + place.y * turn.x);
    }
    return select(0.0, saturate(covered / f32(SHADOWS_BLOB_STRIPS + 1u)), before);
}

// Visibility, 0 to 1, of one light past one blob.
fn shadows_blob_past(
    blob: ShadowsBlob,
    light: ShadowsBlobLight,
    from_centre: vec3f,
    to_light: vec3f,
) -> f32 {
    if !shadows_blob_casts(blob) {
        return 1.0;
    }
    let beyond = (length(from_centre) - blob.radius) / light.reach;
    let fade = 1.0 - smoothstep(SHADOWS_BLOB_FADE, 1.0, beyond);
    return 1.0 - blob.opacity * fade * shadows_blob_covered(blob, light, from_centre, to_light);
}
