// A cube map unfolded as a cross of four by three cells, seen from the light:
//
//          +Y
//      -X  +Z  +X  -Z
//          -Y

// The part of ShadowsCubeLight that is needed here.
struct Light {
    position: vec3f,
    near: f32,
    range: f32,
    rest: vec3f,
}

@group(0) @binding(0) var map: texture_cube<f32>;
@group(0) @binding(1) var map_sampler: sampler;
@group(0) @binding(2) var<uniform> light: Light;

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

@fragment
fn fragment(in: Corner) -> @location(0) vec4f {
    let cell = floor(in.cell);
    let at = (in.cell - cell) * 2.0 - 1.0;
    var direction: vec3f;
    if cell.y == 1.0 {
        switch u32(cell.x) {
            case 0u: { direction = vec3f(-1.0, -at.y, at.x); }
            case 1u: { direction = vec3f(at.x, -at.y, 1.0); }
            case 2u: { direction = vec3f(1.0, -at.y, -at.x); }
            default: { direction = vec3f(-at.x, -at.y, -1.0); }
        }
    } else if cell.x == 1.0 {
        direction = select(vec3f(at.x, -1.0, -at.y), vec3f(at.x, 1.0, at.y), cell.y == 0.0);
    } else {
        discard;
    }
    let stored = textureSampleLevel(map, map_sampler, direction, 0.0).x;
    if stored == select(0.0, 1.0, linear) {
        return vec4f(0.0, 0.0, 0.25, 1.0);
    }
    let along = select(light.near / (stored * light.range), stored, linear);
    return vec4f(vec3f(1.0 - min(along, 1.0)), 1.0);
}
