//! The input of one frame: lights, views and casters.

use std::num::NonZeroU32;

use glam::Vec3;

use crate::error::{LightError, ShadowVolumeError};
use crate::light::check_cone;
use crate::mesh::Bounds;
use crate::scene::CasterFilter;
use crate::volume::multiview::Multiview;
use crate::{
    Caster, DepthConvention, DirectionalLight, HomogeneousLight, PointLight, SpotLight, View,
};

/// Where a spot shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeCone {
    /// From the light along the cone's middle, in world space, of any length but 0.
    pub direction: Vec3,
    /// From the direction to the cone's side, in radians; greater than 0, less than pi / 2.
    pub half_angle: f32,
}

impl VolumeCone {
    fn validate(&self) -> Result<(), LightError> {
        check_cone(self.direction, self.half_angle)
    }
}

/// A light, reduced to what shadow volumes need.
///
/// ```
/// use shadows::{PointLight, VolumeLight, glam::Vec3};
/// let lamp = VolumeLight::from(PointLight::new(Vec3::Y, 30.0)).with_layers(0b1);
/// assert_eq!(lamp.range, Some(30.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeLight {
    /// In world space: `w = 1` for a point, `w = 0` for a direction.
    pub light: HomogeneousLight,
    /// Distance in world units beyond which a point light has no effect: casters that lie entirely beyond it
    /// are skipped. Finite and above 0. `None` for an unlimited range; directional lights ignore it.
    pub range: Option<f32>,
    /// The cone into which a point light shines, if it is a spot: casters wholly beside it are skipped.
    /// With a [`range`](Self::range), volumes also end where the cone does, and draws are clipped to it where a
    /// view has a [`target_size`](VolumeView::target_size). Outside of the cone may be shadow or none: the
    /// host's light pass leaves it dark. `None`, the default: all around. Directional lights ignore it.
    pub cone: Option<VolumeCone>,
    /// It casts the shadows of casters on any of these layers, one bit each ([`Caster::layers`]). Default
    /// all.
    pub layers: u32,
    /// Its owner: it casts no shadow of casters with the same owner ([`Caster::owner`]), such as a lamp's own
    /// shade. Default `None`.
    pub owner: Option<NonZeroU32>,
}

/// A range from here on is none: ends that far away would leave f32 on their way through a view's matrix.
const ENDLESS: f32 = 1e30;

impl VolumeLight {
    /// A light with this range, for all casters.
    pub fn new(light: HomogeneousLight, range: Option<f32>) -> Self {
        let CasterFilter { layers, owner } = CasterFilter::ALL;
        Self {
            light,
            range,
            cone: None,
            layers,
            owner,
        }
    }

    /// The same light, restricted to casters on any of these layers, one bit each ([`Caster::layers`]).
    pub fn with_layers(self, layers: u32) -> Self {
        Self { layers, ..self }
    }

    /// The same light, without the shadows of casters of this owner ([`Caster::owner`]), such as a lamp's own
    /// shade.
    pub fn owned_by(self, owner: NonZeroU32) -> Self {
        Self {
            owner: Some(owner),
            ..self
        }
    }

    /// The same, shining into a cone: of what is outside of it no shadow is promised, and none is paid for.
    pub fn with_cone(self, cone: VolumeCone) -> Self {
        Self {
            cone: Some(cone),
            ..self
        }
    }

    fn filter(&self) -> CasterFilter {
        let Self { layers, owner, .. } = *self;
        CasterFilter { layers, owner }
    }
}

impl From<HomogeneousLight> for VolumeLight {
    /// Without a range.
    fn from(light: HomogeneousLight) -> Self {
        Self::new(light, None)
    }
}

impl From<PointLight> for VolumeLight {
    fn from(light: PointLight) -> Self {
        Self::new(light.homogeneous(), Some(light.range))
    }
}

impl From<SpotLight> for VolumeLight {
    /// What is outside the cone is for the host's light pass to leave dark.
    fn from(light: SpotLight) -> Self {
        Self::new(light.homogeneous(), Some(light.range)).with_cone(VolumeCone {
            direction: light.direction,
            half_angle: light.half_angle,
        })
    }
}

impl From<DirectionalLight> for VolumeLight {
    fn from(light: DirectionalLight) -> Self {
        light.homogeneous().into()
    }
}

/// A camera, and the size of its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeView {
    /// The camera with which the pass's depth buffer was drawn.
    pub view: View,
    /// Width and height of the pass's target in pixels, both above 0, if the viewport covers all of it: draws
    /// are then clipped to the area that a light's range covers on screen. `None`: no clipping.
    pub target_size: Option<[u32; 2]>,
}

impl From<View> for VolumeView {
    /// Without a target size.
    fn from(view: View) -> Self {
        Self {
            view,
            target_size: None,
        }
    }
}

/// The input of [`prepare`](crate::ShadowVolumeRenderer::prepare) for one frame. Default: empty.
///
/// ```
/// # use shadows::{Caster, PointLight, ShadowVolumeFrame, View};
/// # fn one_of_each(light: PointLight, view: View, casters: &[Caster]) {
/// let frame = ShadowVolumeFrame {
///     lights: &[light.into()],
///     views: &[view.into()],
///     casters,
///     ..Default::default()
/// };
/// # let _ = frame;
/// # }
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct ShadowVolumeFrame<'a> {
    /// The lights of this frame. A light is identified by its index in this list: one that keeps its index
    /// and does not move keeps all of its volumes.
    pub lights: &'a [VolumeLight],
    /// The cameras, also identified by their index: one, two eyes, or a split screen. With a
    /// [`multiview_mask`](crate::ShadowVolumeDescriptor::multiview_mask) sets of views, one after another.
    pub views: &'a [VolumeView],
    /// Bounds in world space of everything that receives shadows: all surfaces in the passes' depth buffers,
    /// including those of casters. Volumes then end just behind these bounds, and casters that shadow nothing
    /// within them are skipped; shadows outside are undefined. `None`, the default: receivers may be
    /// anywhere.
    ///
    /// Worth specifying, as it saves much of the fill (compare `unbounded_vs_textbook` with
    /// `auto_vs_textbook` in `docs/benches.md`). The tighter the bounds, the better.
    pub receivers: Option<Bounds>,
    /// The casters. The host must also draw their surfaces into its depth buffer. (With
    /// [`Method::ZFail`](crate::Method::ZFail), a caster that it does not draw still casts, if its triangles
    /// are wound outward; z-pass relies on their being drawn.)
    pub casters: &'a [Caster],
}

impl ShadowVolumeFrame<'_> {
    /// Whether lights, views and receivers are sound, for passes of this convention and these views.
    pub(crate) fn validate(
        &self,
        depth: DepthConvention,
        multiview: Multiview,
    ) -> Result<(), ShadowVolumeError> {
        for VolumeView { view, target_size } in self.views {
            if view.depth() != depth {
                return Err(ShadowVolumeError::Depth {
                    renderer: depth,
                    view: view.depth(),
                });
            }
            if let Some(size) = target_size.filter(|size| size.contains(&0)) {
                return Err(ShadowVolumeError::TargetSize(size));
            }
        }
        multiview.check(self.views)?;
        for VolumeLight {
            light, range, cone, ..
        } in self.lights
        {
            light.validate()?;
            cone.as_ref().map_or(Ok(()), VolumeCone::validate)?;
            if let Some(range) = *range
                && !(range.is_finite() && range > 0.0)
            {
                return Err(LightError::Range(range).into());
            }
        }
        if let Some(Bounds { min, max }) = self.receivers
            && !(min.is_finite() && max.is_finite() && min.cmple(max).all())
        {
            let [min, max] = [min, max].map(|corner| corner.to_array());
            return Err(ShadowVolumeError::Receivers { min, max });
        }
        Ok(())
    }

    /// One light, and the views of it that are drawn together: those of the pass of this number.
    pub(crate) fn situation(
        &self,
        multiview: Multiview,
        light: usize,
        pass: usize,
    ) -> Option<Situation> {
        let light = self.lights.get(light)?;
        let views = self.views.chunks(multiview.views()).nth(pass)?;
        Some(Situation {
            light: light.light,
            range: light.range.filter(|&range| range < ENDLESS),
            cone: light.cone,
            filter: light.filter(),
            views: views.iter().map(|told| told.view).collect(),
            target_size: views.first()?.target_size,
            receivers: self.receivers,
        })
    }
}

/// One light and one view of a frame, or those that are drawn together: all that the choices for a caster
/// depend on, beside the caster.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Situation {
    pub light: HomogeneousLight,
    pub range: Option<f32>,
    pub cone: Option<VolumeCone>,
    pub filter: CasterFilter,
    pub views: Vec<View>,
    pub target_size: Option<[u32; 2]>,
    pub receivers: Option<Bounds>,
}
