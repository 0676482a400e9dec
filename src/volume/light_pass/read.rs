//! How the shaders of light passes read what was drawn before.

use crate::error::ScreenPassError;
use crate::volume::light_pass::mask::{check_range, check_readable_samples};
use crate::volume::multiview::Multiview;

/// A picture, as shaders read it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Read {
    /// One sample a pixel.
    Plain,
    /// Several.
    Samples,
    /// One sample a pixel, and a layer for each view.
    Layers,
}

impl Read {
    /// A picture of such passes.
    pub fn of(samples: u32, multiview: Multiview) -> Self {
        match (multiview.0, samples) {
            (Some(_), _) => Self::Layers,
            (None, 1) => Self::Plain,
            (None, _) => Self::Samples,
        }
    }

    /// Of three shaders the one that reads so.
    pub fn pick<T>(self, [plain, samples, layers]: [T; 3]) -> T {
        match self {
            Self::Plain => plain,
            Self::Samples => samples,
            Self::Layers => layers,
        }
    }

    /// Binds one.
    pub fn layout(self, device: &wgpu::Device, label: &str) -> wgpu::BindGroupLayout {
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: match self {
                        Self::Plain | Self::Samples => wgpu::TextureViewDimension::D2,
                        Self::Layers => wgpu::TextureViewDimension::D2Array,
                    },
                    multisampled: self == Self::Samples,
                },
                count: None,
            }],
        })
    }
}

/// Whether `what` can read or draw the layers of these passes, of so many samples.
pub(crate) fn check(
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
    check(device, multiview, samples, what)?;
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
