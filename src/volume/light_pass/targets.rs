//! What formats a pass can have.

/// Of depth-stencil buffers, where a descriptor names no other.
pub(crate) const DEPTH_STENCIL: wgpu::TextureFormat = wgpu::TextureFormat::Depth32FloatStencil8;

/// Whether a depth-stencil buffer of this format has what volumes need: depth, and a stencil of 8 bits.
pub(crate) fn has_stencil(format: wgpu::TextureFormat) -> bool {
    use wgpu::TextureFormat as F;
    matches!(format, F::Depth24PlusStencil8 | F::Depth32FloatStencil8)
}

/// Whether its depth is a float, as fine as it is near to 0.
pub(crate) fn is_float(format: wgpu::TextureFormat) -> bool {
    use wgpu::TextureFormat as F;
    matches!(format, F::Depth32Float | F::Depth32FloatStencil8)
}

/// Whether it is one of depth alone, as fine as theirs.
pub(crate) fn has_depth_alone(format: wgpu::TextureFormat) -> bool {
    use wgpu::TextureFormat as F;
    matches!(format, F::Depth24Plus | F::Depth32Float)
}

/// Whether pictures of this format can be drawn into with so many samples a pixel, and are `also` what
/// is asked for. A device that goes by its adapter's own formats does not say which they are; there,
/// every uncompressed colour format is believed to be one, but that whole numbers blend nowhere.
pub(crate) fn is_drawable(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    sample_count: u32,
    also: wgpu::TextureFormatFeatureFlags,
) -> bool {
    let features = device.features();
    let is_color = format.has_color_aspect() && !format.is_compressed();
    if !(is_color && features.contains(format.required_features())) {
        return false;
    }
    let whole = matches!(
        format.sample_type(None, None),
        Some(wgpu::TextureSampleType::Uint | wgpu::TextureSampleType::Sint)
    );
    if whole && also.contains(wgpu::TextureFormatFeatureFlags::BLENDABLE) {
        return false;
    }
    let by_adapter = wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES;
    let known = format.guaranteed_format_features(features);
    let target = wgpu::TextureUsages::RENDER_ATTACHMENT;
    features.contains(by_adapter)
        || known.allowed_usages.contains(target)
            && known.flags.sample_count_supported(sample_count)
            && known.flags.contains(also)
}

/// Bytes of one sample of all targets together, as the device's
/// `max_color_attachment_bytes_per_sample` counts them: each target begins at a multiple of its
/// components' size.
pub(crate) fn bytes_a_sample(formats: impl Iterator<Item = wgpu::TextureFormat>) -> u32 {
    formats.fold(0, |before, format| {
        let alignment = format.target_component_alignment().unwrap_or(1);
        before.next_multiple_of(alignment) + format.target_pixel_byte_cost().unwrap_or(0)
    })
}
