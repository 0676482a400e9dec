// What kernels on a disk share: their parameters, the disk in the receiver's tangent plane, and
// one tap of it.

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
    // all agree (0: never).
    first_taps: u32,
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
