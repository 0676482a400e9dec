// Copies a picture to a viewport of its own size.

@group(0) @binding(0) var shaded_picture: texture_2d<f32>;
@group(0) @binding(1) var visibility_picture: texture_2d<f32>;

// Whether the target takes sRGB values as they are.
override encodes: bool = true;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) place: vec2f, // 0 to 1, from the top left
}

// One triangle that covers the viewport.
@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Corner {
    let place = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0;
    return Corner(vec4f(place.x * 2.0 - 1.0, 1.0 - place.y * 2.0, 0.0, 1.0), place);
}

fn encoded(linear: vec3f) -> vec3f {
    let curve = 1.055 * pow(linear, vec3f(1.0 / 2.4)) - 0.055;
    return select(linear, select(curve, 12.92 * linear, linear <= vec3f(0.0031308)), encodes);
}

@fragment
fn shaded(corner: Corner) -> @location(0) vec4f {
    let pixel = vec2u(corner.place * vec2f(textureDimensions(shaded_picture)));
    return vec4f(encoded(textureLoad(shaded_picture, pixel, 0).rgb), 1.0);
}

@fragment
fn visibility(corner: Corner) -> @location(0) vec4f {
    let pixel = vec2u(corner.place * vec2f(textureDimensions(visibility_picture)));
    return vec4f(textureLoad(visibility_picture, pixel, 0).rrr, 1.0);
}
