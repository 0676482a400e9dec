//! The input of one frame: lights, planes, views and casters.

use glam::Vec3;

use super::descriptor::PlanarShadowDescriptor;
use crate::error::PlanarShadowError;
use crate::{Caster, Light, View};

/// How far a corner of an outline may lie off its plane, as a part of its largest coordinate: what rounding a
/// turned plane to `f32` takes.
const OFF_PLANE: f64 = 1.0 / 65536.0;

/// A light whose shadows are projected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarLight {
    /// The light, in world space. Only planes with the light in front of them receive its shadows.
    pub light: Light,
    /// The factor for red, green and blue in shadow, each from 0 (black) to 1 (unchanged): the share of the
    /// colour that is due to other lights and the ambient light. Default 0.5 each. Used only with
    /// [`PlanarOutput::Darken`](crate::PlanarOutput::Darken).
    pub shade: [f32; 3],
}

impl PlanarLight {
    /// A light of any kind, whose shadows halve the colours.
    pub fn new(light: impl Into<Light>) -> Self {
        Self {
            light: light.into(),
            shade: [0.5; 3],
        }
    }
}

/// The extent of a receiver on its plane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PlanarOutline<'a> {
    /// The pixels where the host has written this value, which must not be 0, into the bits of
    /// [`receiver_bits`](crate::PlanarShadowDescriptor::receiver_bits) when it drew the receiver. Exact to the
    /// sample, for outlines of any shape, and without a bias.
    Stencil(u8),
    /// The pixels within a polygon where the depth buffer holds the plane. Its corners are in world space, in
    /// order, either way around. Edges may cross; the even-odd rule then decides.
    Polygon(&'a [Vec3]),
}

/// A plane that receives shadows, on the side that its normal points to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarReceiver<'a> {
    /// A point on the plane, in world space.
    pub point: Vec3,
    /// Points to the side that receives; of any length but 0. A plane that receives on both sides is two
    /// receivers.
    pub normal: Vec3,
    /// The extent of the receiver on the plane.
    pub outline: PlanarOutline<'a>,
}

/// One frame of a [`PlanarShadow`](crate::PlanarShadow). Default: nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlanarFrame<'a> {
    /// The lights, identified by their index.
    pub lights: &'a [PlanarLight],
    /// The planes that receive, also identified by their index.
    pub planes: &'a [PlanarReceiver<'a>],
    /// The cameras.
    pub views: &'a [View],
    /// The casters, for all planes.
    pub casters: &'a [Caster],
}

impl PlanarFrame<'_> {
    pub(super) fn validate(
        &self,
        descriptor: &PlanarShadowDescriptor<'_>,
    ) -> Result<(), PlanarShadowError> {
        for (index, PlanarLight { light, shade }) in self.lights.iter().enumerate() {
            let shade = *shade;
            let sound = light.validate();
            sound.map_err(|error| PlanarShadowError::Light { index, error })?;
            if !shade.iter().all(|part| (0.0..=1.0).contains(part)) {
                return Err(PlanarShadowError::Shade { index, shade });
            }
        }
        for (index, view) in self.views.iter().enumerate() {
            let (made_for, view) = (descriptor.depth, view.depth());
            if made_for != view {
                return Err(PlanarShadowError::Depth {
                    index,
                    made_for,
                    view,
                });
            }
        }
        let mut planes = self.planes.iter().enumerate();
        planes.try_for_each(|(index, plane)| plane.validate(index, descriptor.receiver_bits))
    }
}

impl PlanarReceiver<'_> {
    fn validate(&self, index: usize, receivers: u8) -> Result<(), PlanarShadowError> {
        let Self { point, normal, .. } = *self;
        if !(point.is_finite() && normal.is_finite() && normal != Vec3::ZERO) {
            let (point, normal) = (point.to_array(), normal.to_array());
            return Err(PlanarShadowError::Plane {
                index,
                point,
                normal,
            });
        }
        match self.outline {
            PlanarOutline::Stencil(value) if value == 0 || value & !receivers != 0 => {
                Err(PlanarShadowError::Value {
                    index,
                    value,
                    receivers,
                })
            }
            PlanarOutline::Stencil(_) => Ok(()),
            PlanarOutline::Polygon(corners) => self.validate_corners(index, corners),
        }
    }

    fn validate_corners(&self, index: usize, corners: &[Vec3]) -> Result<(), PlanarShadowError> {
        if corners.len() < 3 {
            let corners = corners.len();
            return Err(PlanarShadowError::Outline { index, corners });
        }
        let normal = self.normal.as_dvec3().normalize();
        for (corner, position) in corners.iter().enumerate() {
            let size = f64::from(position.abs().max(self.point.abs()).max_element());
            let off = normal.dot(position.as_dvec3() - self.point.as_dvec3());
            if !position.is_finite() || off.abs() > OFF_PLANE * size {
                let position = position.to_array();
                return Err(PlanarShadowError::Corner {
                    index,
                    corner,
                    position,
                });
            }
        }
        Ok(())
    }
}
