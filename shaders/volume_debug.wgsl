// The debug views' colour, whatever they draw.

@group(1) @binding(0) var<uniform> debug_color: vec4f;

@fragment
fn shadows_volume_debug() -> @location(0) vec4f {
    return debug_color;
}
