// Parameters of kernels on a disk.
struct ShadowsKernel {
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
    // How far apart the layers of the texture of offsets are, each of which has two taps'.
    layer: f32,
    // WebGL 2 takes uniforms in units of 16 bytes.
    padding: u32,
}
