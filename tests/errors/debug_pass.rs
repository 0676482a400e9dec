//! The debug views of maps refuse passes that the device cannot have. No driver needed.

use crate::common::noop;
use shadows::error::DebugPassError as Error;
use shadows::{AtlasDebug, AtlasDebugDescriptor, CubeCross, CubeCrossDescriptor, wgpu};

/// Of the pass: a colour format, a depth-stencil format, samples.
type Pass = (wgpu::TextureFormat, Option<wgpu::TextureFormat>, u32);

/// What both views say of it.
fn answers(
    device: &wgpu::Device,
    (color_format, depth_stencil_format, sample_count): Pass,
) -> [Result<(), Error>; 2] {
    let cross = CubeCrossDescriptor {
        color_format,
        depth_stencil_format,
        sample_count,
        ..Default::default()
    };
    let debug = AtlasDebugDescriptor {
        color_format,
        depth_stencil_format,
        sample_count,
        ..Default::default()
    };
    [
        CubeCross::new(device, &cross).map(drop),
        AtlasDebug::new(device, &debug).map(drop),
    ]
}

#[test]
fn a_pass_that_does_not_fit_is_refused() {
    use wgpu::TextureFormat as F;
    let (device, _) = noop();
    for (pass, answer) in [
        ((F::Rgba8Unorm, None, 1), Ok(())),
        ((F::Bgra8UnormSrgb, Some(F::Depth24PlusStencil8), 4), Ok(())),
        ((F::Rgba16Float, Some(F::Depth32Float), 1), Ok(())),
        (
            (F::Rgba8Snorm, None, 1),
            Err(Error::ColorFormat(F::Rgba8Snorm)),
        ),
        (
            (F::Depth32Float, None, 1),
            Err(Error::ColorFormat(F::Depth32Float)),
        ),
        (
            (F::Rgba8Uint, None, 1),
            Err(Error::ColorFormat(F::Rgba8Uint)),
        ),
        ((F::R32Sint, None, 1), Err(Error::ColorFormat(F::R32Sint))),
        (
            (F::Bc1RgbaUnorm, None, 1),
            Err(Error::ColorFormat(F::Bc1RgbaUnorm)),
        ),
        (
            (F::Rgba32Float, None, 4),
            Err(Error::ColorFormat(F::Rgba32Float)),
        ),
        (
            (F::Rgba8Unorm, Some(F::R32Float), 1),
            Err(Error::DepthStencil(F::R32Float)),
        ),
        (
            (F::Rgba8Unorm, Some(F::Depth32FloatStencil8), 1),
            Err(Error::DepthStencil(F::Depth32FloatStencil8)),
        ),
        ((F::Rgba8Unorm, None, 3), Err(Error::SampleCount(3))),
    ] {
        assert_eq!(answers(&device, pass), [answer.clone(), answer], "{pass:?}");
    }
}
