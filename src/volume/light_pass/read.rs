//! How the shaders of light passes read what was drawn before.

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
