//! Parameters of shadow volumes.

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

/// Parameters of a [`ShadowVolumeRenderer`](crate::ShadowVolumeRenderer), which must match the host's passes.
#[derive(Clone, Copy, Debug)]
pub struct ShadowVolumeDescriptor<'a> {
    /// Name of its GPU objects in debuggers, after "shadows volume". Default `None`.
    pub label: Option<&'a str>,
    /// Format of the depth-stencil attachment, which is owned by the host:
    /// [`Support::depth_stencil_format`](crate::Support::depth_stencil_format) recommends one. With
    /// [`Counter::Exact`] it needs no stencil: `Depth32Float` and `Depth24Plus` will do.
    ///
    /// `Depth32FloatStencil8` (the default, which this crate's figures refer to) needs the [feature of that
    /// name](wgpu::Features::DEPTH32FLOAT_STENCIL8). `Depth24PlusStencil8` is available on every device, but
    /// its resolution is the same at any depth, while depth itself is proportional to 1 over the distance:
    /// anything beyond some thousand times the near plane's distance is speckled. A more distant near plane
    /// helps: on a kilometre of hills under a sun, 0.00 % of the interior pixels were wrong with a near plane
    /// at 10 m, 0.09 % at 0.1 m and 0.30 % at 0.02 m (software Vulkan, 320x240; none in floats).
    pub depth_stencil_format: wgpu::TextureFormat,
    /// Samples per pixel of the pass, 1 (default) or 4. Each sample has its own count.
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
    /// `D2Array`; of 4 samples, they need [`MULTISAMPLE_ARRAY`](wgpu::Features::MULTISAMPLE_ARRAY). Mesa's software driver needs to be newer than 22.3, which draws clipped triangles of one
    /// view into another (25.0 does not).
    pub multiview_mask: Option<NonZeroU32>,
    /// How the host's projection maps depth. Default [`DepthConvention::InfiniteReverse`].
    pub depth: DepthConvention,
    /// Formats of the pass's colour attachments, which are not written. Default none.
    pub color_formats: &'a [Option<wgpu::TextureFormat>],
    /// How far light caps are pushed away from the viewer, in ulps of the depth. Default 16: more than the 6
    /// by which a host was measured to differ near the origin. GPUs compute depth from vertices snapped to
    /// 1/256 of a pixel, where an ulp may become a whole step of that grid: a host with other arithmetic may
    /// need 512 there (`docs/arithmetic.md`), with a float format and infinite reverse-Z. Otherwise an ulp is
    /// one of depth 1, and 512 of them are decimetres at ten metres, which is visible with volumes that start
    /// from away-facing triangles.
    ///
    /// A light cap lies in a surface that the host draws, so "behind the visible surface" is always the
    /// correct answer. 0 is enough for a host that computes its positions with
    /// [`wgsl::POSITION`](crate::wgsl::POSITION); larger values compensate for other arithmetic. It does not
    /// affect where shadows fall, except for casters that the host itself does not draw.
    ///
    /// The rounding errors of other arithmetic grow with the ratio of world coordinates to the distance from
    /// the eye. Surfaces seen from 10 units away needed up to 512 at 100 units from the origin and 1024 at
    /// 1000 (`Depth32FloatStencil8`; a host that multiplies `p * (v * (m * x))` or `(p * v * m) * x`;
    /// vertices snapped to the rasteriser's grid, as on GPUs). Render such scenes relative to a point near
    /// the eye ([`View::placed`](crate::View::placed)), or raise this.
    ///
    /// If depth is not 0 at infinity, ulps of the depth at infinity are added to those of the depth itself,
    /// which are far too small near the near plane of standard depth.
    pub cap_bias_ulps: u32,
    /// Which faces count, those before the visible point or those behind it. Default [`Method::Auto`];
    /// [`Method::ZFail`] for casters that the host does not draw.
    pub method: Method,
    /// How z-fail closes volumes at their far end. Default [`Caps::AsNeeded`]; the other gives the same picture
    /// for more work, for measuring what that is worth.
    #[doc(hidden)]
    pub caps: Caps,
    /// How far volumes extend. Default [`Extrusion::ToRange`]. Volumes of a light without a range, where the
    /// receivers are not known, are infinite: that is what a host says who wants them so. `Infinite` is for
    /// measuring what ending them is worth.
    #[doc(hidden)]
    pub extrusion: Extrusion,
    /// Which side of closed casters volumes start from. Default [`StartFrom::LightFacing`].
    pub start_from: StartFrom,
    /// Whether casters beyond the light's range, or whose shadow cannot be in view, are left out, and draws
    /// are clipped to the area that the range covers on screen. Default `true`; `false` to measure the
    /// benefit.
    #[doc(hidden)]
    pub culling: bool,
    /// Whether a caster's volume is kept for the next frame if neither the light nor the caster moves, so
    /// that its silhouette is not extracted again. Default `true`; `false` to measure the benefit.
    #[doc(hidden)]
    pub keep_between_frames: bool,
    /// How silhouettes are found. Default [`Silhouettes::Auto`].
    pub silhouettes: Silhouettes,
    /// Where volumes are counted. Default [`Counter::Stencil`].
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
    /// The textbook method (Everitt and Kilgard, 2002): every caster in z-fail, with both caps, extended to
    /// infinity, whether or not its shadow can be visible, with silhouettes extracted every frame. For
    /// comparison: it gives the same picture with more work.
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
