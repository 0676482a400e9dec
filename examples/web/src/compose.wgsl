// Puts the left picture to the left of the bar and the right one to the right of it.

@group(0) @binding(0) var left: texture_2d<f32>;
@group(0) @binding(1) var right: texture_2d<f32>;
// Where the bar is: pixels from the left.
@group(0) @binding(2) var<uniform> bar: vec4f;

// Whether pictures have one channel.
override grey: bool = false;

// One triangle that covers the target.
@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let place = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return vec4f(place, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let at = vec2u(pixel.xy);
    var color = textureLoad(right, at, 0).rgb;
    if pixel.x < bar.x {
        color = textureLoad(left, at, 0).rgb;
    }
    return vec4f(select(color, color.rrr, grey), 1.0);
}
