// What kernels on a disk share: the disk in the receiver's tangent plane, and its taps where the receiver's tile holds them all.

// The disk's axes, as long as its radius, along the same axes as `receiver.normal`; of taps, as
// `receiver.local`.
struct ShadowsCubeDisk {
    across: vec3f,
    along: vec3f,
}

// In the tangent plane every point of the disk is on the surface: none is behind it, and the plane
// is no farther from the receiver than the radius, at any grazing angle.
fn shadows_cube_disk(receiver: ShadowsCubeReceiver, radius: f32, stretch: f32) -> ShadowsCubeDisk {
    let n = receiver.normal;
    // Any axis in the plane, n x (1, 0, 0) or n x (0, 1, 0); the same all over a flat surface, so that the
    // pattern does not turn.
    let upright = abs(n.x) > 0.7;
    let other = select(n.y, n.x, upright);
    let length = radius * inverseSqrt(other * other + n.z * n.z);
    let a = length * n.z;
    let b = length * other;
    var across = vec3f(select(0.0, -a, upright), select(a, 0.0, upright), select(-b, b, upright));
    if stretch > 1.01 {
        across = radius * normalize(cross(n, receiver.ray));
    }
    return ShadowsCubeDisk(across, stretch * cross(n, across));
}

fn shadows_cube_radius(receiver: ShadowsCubeReceiver, kernel: ShadowsKernel) -> f32 {
    return kernel.radius_world + kernel.radius_texels * receiver.width;
}

// Depths at one tap: the plane's and the stored one.
fn shadows_cube_tap(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    disk: ShadowsCubeDisk,
    offset: vec2f,
) -> vec2f {
    let local = receiver.local + offset.x * disk.across + offset.y * disk.along;
    return shadows_cube_look(map, map_sampler, receiver, local);
}

// The share of taps that are lit. Where `first` of them agree, the rest is taken to agree with them
// (0: never). Offsets are in a texture: a uniform array given as a parameter is copied for every pixel. And
// it is sampled: a load is guarded against coordinates outside by asking for the size, once a tap.
fn shadows_cube_lit_on(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    disk: ShadowsCubeDisk,
    offsets: texture_3d<f32>,
    column: vec2f,
    layer: f32,
    taps: u32,
    first: u32,
) -> f32 {
    var at = vec3f(column, 0.5 * layer);
    var lit = 0u;
    var i = 0u;
    var end = taps;
    // One loop for the first taps and the rest, with its end asked for behind the body: drivers that
    // run both sides of a branch run every loop once at least, and once more if it asks before.
    loop {
        let pair = textureSampleLevel(offsets, map_sampler, at, 0.0);
        let a = shadows_cube_tap(map, map_sampler, receiver, disk, pair.xy);
        let b = shadows_cube_tap(map, map_sampler, receiver, disk, pair.zw);
        lit += select(0u, 1u, a.x >= a.y);
        lit += select(0u, 1u, (b.x >= b.y) & (i + 1u < taps));
        i += 2u;
        at.z += layer;
        let agree = (first > 0u) & (i == first) & ((lit == 0u) | (lit == first));
        end = select(end, first, agree);
        continuing {
            break if i >= end;
        }
    }
    return shadows_cube_share(end - lit, end);
}

// How much is lit where so many of some taps are blocked. Exactly 0 or 1 where all taps agree, though a
// GPU's quotient of equal numbers need not be 1: stretched around one half by more than that, and cut off.
fn shadows_cube_share(blocked: u32, taps: u32) -> f32 {
    return saturate(1.0 + 0x1p-17 - f32(blocked) * ((1.0 + 0x1p-16) / f32(taps)));
}
