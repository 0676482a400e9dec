//! What light passes demand of devices, descriptors and buffers.

use crate::error::ScreenPassError;
use crate::gl;
use crate::volume::light_pass::targets::has_stencil;
use crate::volume::multiview::Multiview;

/// Whether a depth-stencil buffer has the width, height, samples and format that were announced.
pub(crate) fn check_buffer(
    buffer: &wgpu::TextureView,
    needed: [u32; 3],
    needed_format: wgpu::TextureFormat,
) -> Result<(), ScreenPassError> {
    let buffer = buffer.texture();
    let found = [buffer.width(), buffer.height(), buffer.sample_count()];
    if found == needed && buffer.format() == needed_format {
        return Ok(());
    }
    Err(ScreenPassError::Buffer {
        found,
        found_format: buffer.format(),
        needed,
        needed_format,
    })
}

/// A target's width and height.
pub(crate) fn check_size(
    [width, height]: [u32; 2],
    limits: &wgpu::Limits,
) -> Result<(), ScreenPassError> {
    check_range("width", width, limits.max_texture_dimension_2d)?;
    check_range("height", height, limits.max_texture_dimension_2d)
}

pub(crate) fn check_range(
    what: &'static str,
    value: u32,
    limit: u32,
) -> Result<(), ScreenPassError> {
    if (1..=limit).contains(&value) {
        return Ok(());
    }
    Err(ScreenPassError::Range { what, value, limit })
}

/// Whether shaders can read targets of so many samples.
pub(crate) fn check_readable_samples(
    device: &wgpu::Device,
    samples: u32,
    what: &'static str,
) -> Result<(), ScreenPassError> {
    match samples > 1 && gl::is_gl(device) {
        true => Err(ScreenPassError::SamplesOnGl { samples, what }),
        false => Ok(()),
    }
}

/// The pass's depth-stencil format and sample count.
pub(crate) fn check_target(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    samples: u32,
) -> Result<(), ScreenPassError> {
    let usable = device.features().contains(format.required_features());
    if !has_stencil(format) || !usable {
        return Err(ScreenPassError::Format(format));
    }
    check_samples(samples)
}

/// The pass's sample count.
pub(crate) fn check_samples(samples: u32) -> Result<(), ScreenPassError> {
    match samples {
        1 | 4 => Ok(()),
        _ => Err(ScreenPassError::SampleCount(samples)),
    }
}

/// Whether `what` can read or draw the layers of these passes, of so many samples.
pub(crate) fn check_multiview(
    device: &wgpu::Device,
    multiview: Multiview,
    samples: u32,
    what: &'static str,
) -> Result<(), ScreenPassError> {
    if multiview.0.is_none() {
        return Ok(());
    }
    let feature = multiview.features() - device.features();
    if !feature.is_empty() {
        let needed_by = what;
        return Err(ScreenPassError::MissingFeature { feature, needed_by });
    }
    let most = device.limits().max_multiview_view_count;
    check_range(
        "multiview_mask's number of layers",
        multiview.layers(),
        most,
    )?;
    match samples {
        1 => Ok(()),
        _ => Err(ScreenPassError::LayeredSamples { samples, what }),
    }
}

/// The same for what reads counts or pictures in its shaders.
pub(crate) fn check_readable(
    device: &wgpu::Device,
    multiview: Multiview,
    samples: u32,
    what: &'static str,
) -> Result<(), ScreenPassError> {
    check_multiview(device, multiview, samples, what)?;
    check_readable_samples(device, samples, what)
}

/// Whether a texture has a layer for each view.
pub(crate) fn check_layers(
    texture: &wgpu::Texture,
    multiview: Multiview,
) -> Result<(), ScreenPassError> {
    let (found, needed) = (texture.depth_or_array_layers(), multiview.layers());
    match found < needed {
        true => Err(ScreenPassError::Layers { found, needed }),
        false => Ok(()),
    }
}
