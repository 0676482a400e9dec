//! How far apart a map's depths are at least.

use super::descriptor::{DepthEncoding, quantum};
use crate::gl;

/// What wgpu's GL back end leaves of `near / d`: clip z becomes `2 z - w` there, for GL's depths from -1
/// to 1, and is moved back after the division by w. Where depth is near 0 that is a small difference of
/// numbers near 1, rounded to 24 bits each: in the conversion, in the division, in the move. So floats
/// there are no finer than fixed point, and this is the most that `tests/gl.rs` finds.
pub(super) const ON_GL: f32 = 1.0 / 8_388_608.0;

/// By so much a stored depth may be off: a step of the format, 0 for floats, and what the back end's
/// conversion costs.
pub(super) fn depth_step(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    encoding: DepthEncoding,
) -> f32 {
    let converted = match encoding {
        DepthEncoding::MajorAxis if gl::is_gl(device) => ON_GL,
        // The fragment shader writes a distance as it is to be stored.
        _ => 0.0,
    };
    quantum(format).unwrap_or(0.0) + converted
}
