// What kernels on a disk share: their parameters, the disk in the receiver's tangent plane, and
// its taps.

struct ShadowsCubeKernel {
    // Of the disk: so many texels, plus so much in world units, at the receiver.
    radius_texels: f32,
    radius_world: f32,
    // Radius of a spherical light; of a directional one, the tangent of its angular radius.
    light_size: f32,
    // Added to the pixel before it is hashed: moves the noise on from frame to frame.
    frame_shift: f32,
    taps: u32,
    // Taps of the blocker search; or of the first batch, after which the rest is skipped where
    // all agree.
    first_taps: u32,
    // WebGL 2 takes uniforms in units of 16 bytes.
    padding: vec2u,
}

// The disk's axes, as long as its radius, along the same axes as `receiver.local`.
struct ShadowsCubeDisk {
    across: vec3f,
    along: vec3f,
}

// In the tangent plane every point of the disk is on the surface: none is behind it, and the plane
// is no farther from the receiver than the radius, at any grazing angle.
fn shadows_cube_disk(receiver: ShadowsCubeReceiver, radius: f32, stretch: f32) -> ShadowsCubeDisk {
    let n = receiver.normal;
    // Any axis in the plane; the same all over a flat surface, so that the pattern does not turn.
    let a = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(n.x) > 0.7);
    var across = normalize(cross(n, a));
    if stretch > 1.01 {
        across = normalize(cross(n, receiver.ray));
    }
    return ShadowsCubeDisk(radius * across, radius * stretch * cross(n, across));
}

fn shadows_cube_radius(receiver: ShadowsCubeReceiver, kernel: ShadowsCubeKernel) -> f32 {
    return kernel.radius_world + kernel.radius_texels * receiver.width;
}

// Depths at one tap: the plane's and the stored one.
fn shadows_cube_tap(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    disk: ShadowsCubeDisk,
    offset: vec2f,
) -> vec2f {
    let local = receiver.local + offset.x * disk.across + offset.y * disk.along;
    return shadows_cube_look(map, map_sampler, receiver, size, local);
}

// The offsets of taps `i` and `i + 1`, `i` even, from the table's column at `column` (0 .. 1).
// It is a texture: a uniform array given as a parameter is copied for every pixel. And it is sampled:
// a load is guarded against coordinates outside by asking for the size, once a tap.
fn shadows_cube_offset_pair(
    offsets: texture_3d<f32>,
    nearest: sampler,
    column: vec2f,
    i: u32,
) -> vec4f {
    let layer = (f32(i / 2u) + 0.5) / f32(textureDimensions(offsets).z);
    return textureSampleLevel(offsets, nearest, vec3f(column, layer), 0.0);
}

// The share of taps that are lit. Where `first` of them agree, the rest is taken to agree with them
// (0: never).
fn shadows_cube_lit(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    disk: ShadowsCubeDisk,
    offsets: texture_3d<f32>,
    column: vec2f,
    taps: u32,
    first: u32,
) -> f32 {
    var lit = 0.0;
    var i = 0u;
    var end = taps;
    // One loop for the first taps and the rest, with its end asked for behind the body: drivers that
    // run both sides of a branch run every loop once at least, and once more if it asks before.
    loop {
        let pair = shadows_cube_offset_pair(offsets, map_sampler, column, i);
        let a = shadows_cube_tap(map, map_sampler, receiver, size, disk, pair.xy);
        let b = shadows_cube_tap(map, map_sampler, receiver, size, disk, pair.zw);
        lit += select(0.0, 1.0, a.x >= a.y) + select(0.0, 1.0, b.x >= b.y && i + 1u < end);
        i += 2u;
        let agree = i == first && (lit == 0.0 || lit == f32(first));
        end = select(end, first, agree);
        continuing {
            break if i >= end;
        }
    }
    // Exactly 0 or 1 where all taps agree, though a GPU's quotient of equal numbers need not be 1:
    // stretched around one half by more than that, and cut off.
    return saturate(1.0 + 0x1p-17 - (f32(end) - lit) * ((1.0 + 0x1p-16) / f32(end)));
}
