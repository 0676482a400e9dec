// The debug views' colour where an exact count is in a range.

struct Range {
    color: vec4f,
    least: f32,
    most: f32,
}

@group(0) @binding(0) var counts: texture_2d<f32>;
@group(1) @binding(0) var<uniform> range: Range;

@fragment
fn shadows_volume_debug_counts(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let count = textureLoad(counts, vec2i(position.xy), 0).r;
    let is_other = (count < range.least) | (count > range.most);
    if is_other {
        discard;
    }
    return range.color;
}
