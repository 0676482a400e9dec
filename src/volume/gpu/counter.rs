//! Where volumes are counted: in the stencil, modulo 256, or in a colour target, without wrapping.

use crate::volume::decide::method::Count;

/// Format of the target of [`Counter::Exact`].
pub(crate) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

const COUNT: &str = include_str!("../../../shaders/volume_count.wgsl");

/// What it takes to count there.
pub(crate) const FEATURE: wgpu::Features = wgpu::Features::FLOAT32_BLENDABLE;

/// Where the number of volumes that contain each visible point is counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Counter {
    /// The 8-bit stencil, which wraps: a point in a multiple of 256 volumes at once reads 0 and is lit.
    /// [`ShadowVolumeRenderer::may_wrap`](crate::ShadowVolumeRenderer::may_wrap) tells whether that can
    /// happen.
    #[default]
    Stencil,
    /// An additional target of 32-bit floats, to which front and back faces add 1 and -1. Exact for fewer
    /// than 2^24 faces in a row; takes four bytes per sample, and the fill of a blended target instead of the
    /// stencil's.
    ///
    /// The pass has this target (`R32Float`, cleared to 0) after those of `color_formats`. Its stencil is neither read
    /// nor written, and need not exist. [`ExactCount`](crate::ExactCount) provides the target, the pass, and what light
    /// passes need. Needs the feature [`FLOAT32_BLENDABLE`](wgpu::Features::FLOAT32_BLENDABLE).
    Exact,
}

/// What a pipeline adds to a count, and where.
#[derive(Clone, Debug)]
pub(crate) struct Counting {
    pub depth_compare: wgpu::CompareFunction,
    pub stencil: wgpu::StencilState,
    /// The target after the host's.
    pub target: Option<wgpu::ColorTargetState>,
}

impl Counter {
    /// The first count that is wrong.
    pub(crate) fn end(self) -> u64 {
        match self {
            Self::Stencil => 1 << 8,
            Self::Exact => 1 << 24,
        }
    }

    /// z-fail: a back face behind the visible point counts +1, a front face -1; z-pass: a front
    /// face before it +1, a back face -1.
    pub(crate) fn counting(self, count: Count, nearer: wgpu::CompareFunction) -> Counting {
        match self {
            Self::Stencil => Counting {
                depth_compare: nearer,
                stencil: stencil(count),
                target: None,
            },
            Self::Exact => Counting {
                // What fails there has to pass here, for only what passes is blended.
                depth_compare: match count {
                    Count::Pass => nearer,
                    Count::Fail => opposite(nearer),
                },
                stencil: wgpu::StencilState::default(),
                target: Some(target(count)),
            },
        }
    }
}

/// The shader that counts into the target at this place.
pub(crate) fn source(location: usize) -> String {
    COUNT.replace("@location(0)", &format!("@location({location})"))
}

/// Modulo 256, because the faces come in any order.
fn stencil(count: Count) -> wgpu::StencilState {
    use wgpu::StencilOperation::{DecrementWrap, IncrementWrap, Keep, Replace};
    let face = |pass_op, depth_fail_op| wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Always,
        // Never done, for nothing fails. But on Vulkan every pipeline's stencil reference is dynamic
        // state that must have been set before a draw, and wgpu sets it only for what names it.
        fail_op: Replace,
        depth_fail_op,
        pass_op,
    };
    let (front, back) = match count {
        Count::Fail => (face(Keep, DecrementWrap), face(Keep, IncrementWrap)),
        Count::Pass => (face(IncrementWrap, Keep), face(DecrementWrap, Keep)),
    };
    wgpu::StencilState {
        front,
        back,
        read_mask: 0xff,
        write_mask: 0xff,
    }
}

/// The fragment shader gives +1 for a front face, -1 for a back face.
fn target(count: Count) -> wgpu::ColorTargetState {
    let component = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: match count {
            Count::Pass => wgpu::BlendOperation::Add,
            Count::Fail => wgpu::BlendOperation::ReverseSubtract,
        },
    };
    wgpu::ColorTargetState {
        format: FORMAT,
        blend: Some(wgpu::BlendState {
            color: component,
            alpha: component,
        }),
        write_mask: wgpu::ColorWrites::RED,
    }
}

fn opposite(compare: wgpu::CompareFunction) -> wgpu::CompareFunction {
    use wgpu::CompareFunction as C;
    match compare {
        C::Never => C::Always,
        C::Less => C::GreaterEqual,
        C::Equal => C::NotEqual,
        C::LessEqual => C::Greater,
        C::Greater => C::LessEqual,
        C::NotEqual => C::Equal,
        C::GreaterEqual => C::Less,
        C::Always => C::Never,
    }
}
