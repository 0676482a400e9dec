//! Parameters of a flat map, and its input for each frame.

use super::settings::MapSettings;
use crate::error::ShadowMapError;
use crate::mesh::{Bounds, Caster};
use crate::{DirectionalLight, Light, SpotLight, View};

/// Parameters of a [`ShadowMap`](crate::ShadowMap).
#[derive(Clone, Debug)]
pub struct ShadowMapDescriptor<'a> {
    /// Name shown in debuggers. Default none.
    pub label: Option<&'a str>,
    /// Texels along each side. Default 2048. 1 to the device's `max_texture_dimension_2d`. Memory:
    /// 4 bytes a texel, 2 as `Depth16Unorm`.
    pub size: u32,
    /// How depths are stored, drawn and compared.
    pub settings: MapSettings,
    /// Whether casters in front of the near plane are pulled onto it, on devices with
    /// [`DEPTH_CLIP_CONTROL`](wgpu::Features::DEPTH_CLIP_CONTROL) and on GL. Default true. On other devices,
    /// a directional light's near plane is placed in front of all casters, and a spot loses casters nearer
    /// than its [`near`](SpotLight::near). False to see the result of such devices.
    #[doc(hidden)]
    pub unclipped_depth: bool,
    /// Whether a map whose content has not changed is left alone. Default true; false redraws it every frame,
    /// to measure the benefit.
    #[doc(hidden)]
    pub cache: bool,
}

impl ShadowMapDescriptor<'_> {
    pub(super) fn validate(&self, device: &wgpu::Device) -> Result<(), ShadowMapError> {
        let (size, limit) = (self.size, device.limits().max_texture_dimension_2d);
        if size == 0 || size > limit {
            return Err(ShadowMapError::Size { size, limit });
        }
        Ok(self.settings.validate()?)
    }
}

impl Default for ShadowMapDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            size: 2048,
            settings: MapSettings::default(),
            unclipped_depth: true,
            cache: true,
        }
    }
}

/// The light of a [`ShadowMap`](crate::ShadowMap): a [`Light`] other than a point light, which does not fit a
/// single map.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum FlatLight {
    /// A spot: the map is drawn around its cone.
    Spot(SpotLight),
    /// A directional light: the map is fitted to the casters, and to the view and the receivers if the frame
    /// specifies them.
    Directional(DirectionalLight),
}

impl From<FlatLight> for Light {
    fn from(light: FlatLight) -> Self {
        match light {
            FlatLight::Spot(light) => light.into(),
            FlatLight::Directional(light) => light.into(),
        }
    }
}

impl From<SpotLight> for FlatLight {
    fn from(light: SpotLight) -> Self {
        Self::Spot(light)
    }
}

impl From<DirectionalLight> for FlatLight {
    fn from(light: DirectionalLight) -> Self {
        Self::Directional(light)
    }
}

/// The input of a [`ShadowMap`](crate::ShadowMap) for one frame. A spot's map always covers its cone: `view`
/// and `receivers` have no effect on it.
#[derive(Clone, Copy, Debug)]
pub struct ShadowFrame<'a> {
    /// The light.
    pub light: FlatLight,
    /// Everything that may cast; the map itself leaves out what cannot be on it.
    pub casters: &'a [Caster],
    /// The host's camera, and the distance from its eye, along its axis and in world units, up to which
    /// shadows are visible. A directional light's map then covers only what the view shows up to there, or up
    /// to its far plane if that is nearer. `None`: everything.
    ///
    /// An orthographic view has no eye (its near plane may even lie behind the camera), and shows everything
    /// at one scale. It is covered from its near to its far plane, whatever the distance; to cover less, pass
    /// a view with a nearer far plane.
    pub view: Option<(&'a View, f32)>,
    /// Bounds of all receivers in world space. A directional light's map then covers only those. `None`:
    /// receivers may be anywhere.
    pub receivers: Option<Bounds>,
}

impl<'a> ShadowFrame<'a> {
    /// A frame without a view or bounds, for a [`SpotLight`] or a [`DirectionalLight`].
    pub fn new(light: impl Into<FlatLight>, casters: &'a [Caster]) -> Self {
        Self {
            light: light.into(),
            casters,
            view: None,
            receivers: None,
        }
    }

    pub(super) fn validate(&self) -> Result<(), ShadowMapError> {
        Light::from(self.light).validate()?;
        if let Some((_, distance)) = self.view
            && !(distance.is_finite() && distance > 0.0)
        {
            return Err(ShadowMapError::Distance(distance));
        }
        if let Some(Bounds { min, max }) = self.receivers
            && !(min.is_finite() && max.is_finite() && min.cmple(max).all())
        {
            let (min, max) = (min.to_array(), max.to_array());
            return Err(ShadowMapError::Receivers { min, max });
        }
        Ok(())
    }
}
