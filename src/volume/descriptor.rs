//! What the host says about its passes and its frame, and what it gets to know.

use std::num::NonZeroU32;

use crate::DepthConvention;
use crate::error::ShadowVolumeError;
use crate::volume::decide::method::{Caps, Extrusion, Method};
use crate::volume::gpu::counter;
use crate::volume::light_pass::targets::{
    DEPTH_STENCIL, bytes_a_sample, has_depth_alone, has_stencil, is_drawable,
};
use crate::volume::multiview::Multiview;
use crate::volume::plan::limits;
use crate::volume::{Counter, Silhouettes, StartFrom};

/// How a [`ShadowVolumeRenderer`](crate::ShadowVolumeRenderer) fits into the host's passes.
#[derive(Clone, Copy, Debug)]
pub struct ShadowVolumeDescriptor<'a> {
    /// Names the renderer's GPU objects, after "shadows volume". Default `None`.
    pub label: Option<&'a str>,
    /// Format of the depth-stencil attachment, which is the host's own:
    /// [`Support::depth_stencil_format`](crate::Support::depth_stencil_format) says which to make it of.
    /// With [`Counter::Exact`] it needs no stencil: `Depth32Float` and `Depth24Plus` will do.
    ///
    /// `Depth32FloatStencil8` (the default, and what this crate's figures are of) needs the
    /// [feature of that name](wgpu::Features::DEPTH32FLOAT_STENCIL8). `Depth24PlusStencil8` is there
    /// on every device, and its steps are the same size at any depth, where depth itself falls as 1
    /// over the distance: what is farther than some thousand times the near plane's distance comes
    /// out speckled. The farther the near plane, the better: on a kilometre of hills under a sun 0.00 %
    /// of the interior pixels were wrong with a near plane at 10 m, 0.09 % at 0.1 m and 0.30 % at 0.02 m
    /// (software Vulkan, 320x240; in floats none at any).
    pub depth_stencil_format: wgpu::TextureFormat,
    /// Samples per pixel of the pass, 1 (default) or 4. The stencil counts each sample by itself.
    pub sample_count: u32,
    /// The layers of its attachments that a pass draws into at once, a bit and a view each: the pass's own
    /// [`multiview_mask`](wgpu::RenderPassDescriptor::multiview_mask), as for both eyes of a headset. Default
    /// `None`: a pass draws one view.
    ///
    /// With a mask the frame's [`views`](crate::ShadowVolumeFrame::views) come in sets, one after another: as
    /// many as the mask has bits, the first of a set for the lowest layer. Whatever takes the index of a
    /// view, such as [`render`](crate::ShadowVolumeRenderer::render), then takes that of a set.
    ///
    /// A set shares its draws, so what is decided for a caster is what is right in each view: it is counted
    /// in front of the visible surfaces only where that is proven for all, left out only where all leave it
    /// out, and so on. That suits eyes side by side; views that look apart take less fill in passes of their
    /// own.
    ///
    /// Needs [`MULTIVIEW`](wgpu::Features::MULTIVIEW) and a
    /// [`max_multiview_view_count`](wgpu::Limits::max_multiview_view_count) of as many layers, both of which
    /// [`Support`](crate::Support) asks for; a mask with gaps also
    /// [`SELECTIVE_MULTIVIEW`](wgpu::Features::SELECTIVE_MULTIVIEW). The attachments are views of the dimension
    /// `D2Array`. Mesa's software driver needs to be newer than 22.3, which draws clipped triangles of one
    /// view into another (25.0 does not).
    pub multiview_mask: Option<NonZeroU32>,
    /// How the host's projection maps depth. Default [`DepthConvention::InfiniteReverse`].
    pub depth: DepthConvention,
    /// Formats of the pass's colour attachments, which are left as they are. Default none.
    pub color_formats: &'a [Option<wgpu::TextureFormat>],
    /// How far light caps are pushed away from the viewer, in units of the depth format's last
    /// place. Default 16: more than the 6 that a host was measured to be off by near the origin. GPUs take
    /// depth from corners on a grid of 1/256 of a pixel, where a unit may be a whole step: a host of other
    /// arithmetic may want 512 there (`docs/arithmetic.md`), of a float format under infinite reverse-Z.
    /// Elsewhere a unit is one of depth 1, and 512 of them are decimetres at ten metres, which volumes that
    /// start from away-facing triangles show.
    ///
    /// A light cap lies in a surface that the host draws, so "behind what is visible" is the right
    /// answer wherever it is drawn. 0 is enough for a host that computes its positions with
    /// [`wgsl::POSITION`](crate::wgsl::POSITION); more makes up for other arithmetic. It has no
    /// effect on where shadows fall, except for casters that the host itself does not draw.
    ///
    /// Other arithmetic rounds the more, the larger world coordinates are beside the distance from the
    /// eye. What is seen from 10 units away took up to 512 at 100 units from the origin and 1024 at 1000
    /// (`Depth32FloatStencil8`; a host that multiplies `p * (v * (m * x))` or `(p * v * m) * x`; corners
    /// on the rasteriser's grid, as GPUs have them). Count
    /// such scenes from a point near the eye ([`View::placed`](crate::View::placed)), or raise this.
    ///
    /// Where depth is not 0 at infinity, units of the last place of the depth there are added to those
    /// of the depth itself: by the near plane of standard depth the latter are far too small.
    pub cap_bias_ulps: u32,
    /// Which faces count, those before the visible point or those behind it. Default [`Method::Auto`];
    /// [`Method::ZFail`] for casters that the host does not draw.
    pub method: Method,
    /// How z-fail closes volumes at their far end. Default [`Caps::AsNeeded`]; the other gives the same picture
    /// for more work, for measuring what that is worth.
    #[doc(hidden)]
    pub caps: Caps,
    /// How far volumes reach. Default [`Extrusion::ToRange`]. Volumes of a light without a range, where the
    /// receivers are not known, are infinite: that is what a host says who wants them so. `Infinite` is for
    /// measuring what ending them is worth.
    #[doc(hidden)]
    pub extrusion: Extrusion,
    /// Which side of closed casters volumes start from. Default [`StartFrom::LightFacing`].
    pub start_from: StartFrom,
    /// Whether casters beyond the light's range, or whose shadow cannot be in view, are left out,
    /// and the draws clipped to what the range covers on screen. Default `true`; `false` for measuring
    /// what that is worth.
    #[doc(hidden)]
    pub culling: bool,
    /// Whether a caster's volume is kept for the next frame if neither the light nor the caster
    /// moves: its silhouette is then not searched again. Default `true`; `false` is of use only to
    /// measure what it saves.
    #[doc(hidden)]
    pub keep_between_frames: bool,
    /// How silhouettes are found. Default [`Silhouettes::Auto`].
    pub silhouettes: Silhouettes,
    /// What holds the count. Default [`Counter::Stencil`].
    pub counter: Counter,
}

impl Default for ShadowVolumeDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            depth_stencil_format: DEPTH_STENCIL,
            sample_count: 1,
            multiview_mask: None,
            depth: DepthConvention::default(),
            color_formats: &[],
            cap_bias_ulps: 16,
            method: Method::Auto,
            caps: Caps::AsNeeded,
            extrusion: Extrusion::ToRange,
            start_from: StartFrom::LightFacing,
            culling: true,
            keep_between_frames: true,
            silhouettes: Silhouettes::Auto,
            counter: Counter::Stencil,
        }
    }
}

impl ShadowVolumeDescriptor<'_> {
    /// The method as it is usually written down (Everitt and Kilgard, 2002): every caster in
    /// z-fail, with both caps, to infinity, whether or not its shadow can be seen, the silhouettes
    /// searched every frame. For comparison: it gives the same picture for more work.
    pub fn textbook() -> Self {
        Self {
            method: Method::ZFail,
            caps: Caps::Full,
            extrusion: Extrusion::Infinite,
            culling: false,
            keep_between_frames: false,
            ..Self::default()
        }
    }
}

impl ShadowVolumeDescriptor<'_> {
    /// Whether the device can do what the descriptor asks for.
    pub(crate) fn validate(&self, device: &wgpu::Device) -> Result<(), ShadowVolumeError> {
        let format = self.depth_stencil_format;
        let counts_beside = self.counter == Counter::Exact;
        if !(has_stencil(format) || (counts_beside && has_depth_alone(format))) {
            return Err(ShadowVolumeError::Format(format));
        }
        if !matches!(self.sample_count, 1 | 4) {
            return Err(ShadowVolumeError::SampleCount(self.sample_count));
        }
        if !device.features().contains(format.required_features()) {
            return Err(ShadowVolumeError::FormatFeature(format));
        }
        check_depth(device, self.depth)?;
        self.multiview().validate(device)?;
        self.validate_colors(device)
    }

    pub(crate) fn multiview(&self) -> Multiview {
        Multiview(self.multiview_mask)
    }

    fn validate_colors(&self, device: &wgpu::Device) -> Result<(), ShadowVolumeError> {
        for (place, format) in self.color_formats.iter().enumerate() {
            let Some(format) = *format else { continue };
            if format.has_color_aspect() && !format.is_compressed() {
                check_feature(device, format.required_features(), || format!("{format:?}"))?;
            }
            let also = wgpu::TextureFormatFeatureFlags::empty();
            if !is_drawable(device, format, self.sample_count, also) {
                return Err(ShadowVolumeError::ColorFormat { place, format });
            }
        }
        let counts = self.counter == Counter::Exact;
        if counts {
            check_feature(device, counter::FEATURE, || "Counter::Exact".to_owned())?;
        }
        let available = device.limits();
        limits::check_one(
            "max_color_attachments",
            self.color_formats.len() as u64 + u64::from(counts),
            available.max_color_attachments.into(),
        )?;
        let formats = self.color_formats.iter().copied().flatten();
        limits::check_one(
            "max_color_attachment_bytes_per_sample",
            bytes_a_sample(formats.chain(counts.then_some(counter::FORMAT))).into(),
            available.max_color_attachment_bytes_per_sample.into(),
        )
    }
}

/// Whether the device keeps what lies beyond a far plane.
pub(crate) fn check_depth(
    device: &wgpu::Device,
    depth: DepthConvention,
) -> Result<(), ShadowVolumeError> {
    if !depth.clips_far() {
        return Ok(());
    }
    check_feature(device, wgpu::Features::DEPTH_CLIP_CONTROL, || {
        format!("DepthConvention::{depth:?}")
    })
}

pub(crate) fn check_feature(
    device: &wgpu::Device,
    feature: wgpu::Features,
    needed_by: impl FnOnce() -> String,
) -> Result<(), ShadowVolumeError> {
    let missing = feature - device.features();
    if missing.is_empty() {
        return Ok(());
    }
    Err(ShadowVolumeError::MissingFeature {
        feature: missing,
        needed_by: needed_by(),
    })
}
