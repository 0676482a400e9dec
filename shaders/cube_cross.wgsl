// A cube map unfolded as a cross of four by three cells, seen from the light:
//
//          +Y
//      -X  +Z  +X  -Z
//          -Y

@group(0) @binding(0) var map: texture_2d_array<f32>;
@group(0) @binding(1) var map_sampler: sampler;
@group(0) @binding(2) var<uniform> light: ShadowsLight;

// Whether texels hold distance / range rather than near / (distance along the major axis).
override linear: bool = false;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) cell: vec2f,
}

// One triangle over the whole viewport.
@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Corner {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0;
    let clip = vec4f(corner * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0), 0.0, 1.0);
    return Corner(clip, corner * vec2f(4.0, 3.0));
}

// The face in a cell, by its layer; -1: none.
fn face_in(cell: vec2f) -> i32 {
    if cell.y == 1.0 {
        return vec4i(1, 4, 0, 5)[u32(cell.x)];
    }
    return select(-1, select(3, 2, cell.y == 0.0), cell.x == 1.0);
}

@fragment
fn fragment(in: Corner) -> @location(0) vec4f {
    let cell = floor(in.cell);
    let face = face_in(cell);
    if face < 0 {
        discard;
    }
    let layer = i32(light.tiles.x >> 20u) + face;
    let stored = textureSampleLevel(map, map_sampler, in.cell - cell, layer, 0.0).x;
    // A light without casters has no layers.
    let drawn = light.kind == 1u;
    if !drawn | (stored == select(0.0, 1.0, linear)) {
        return vec4f(0.0, 0.0, 0.25, 1.0);
    }
    let along = select(1.0 / (stored * light.forward.z), stored, linear);
    return vec4f(vec3f(1.0 - min(along, 1.0)), 1.0);
}
