//! A caster: a mesh somewhere in the world.

use std::num::NonZeroU32;

use glam::{Affine3A, DAffine3, DVec3};

use super::CasterMesh;
use crate::error::CasterError;

/// A mesh somewhere in the world. Many casters may share one mesh.
#[derive(Clone, Debug)]
pub struct Caster {
    /// The mesh.
    pub mesh: CasterMesh,
    /// Any affine map from the mesh's space to world space: scale, shear and mirror included.
    pub world_from_object: Affine3A,
    /// The layers it is on, a bit each. A light of a [`ShadowAtlas`](crate::ShadowAtlas) or of shadow volumes
    /// casts the shadows of what is on any of its own layers
    /// ([`AtlasLight::with_layers`](crate::AtlasLight::with_layers),
    /// [`VolumeLight::with_layers`](crate::VolumeLight::with_layers)); maps of one light and projected shadows take no notice.
    /// Default all.
    pub layers: u32,
    /// Whose it is: a light of the same owner ([`AtlasLight::owned_by`](crate::AtlasLight::owned_by),
    /// [`VolumeLight::owned_by`](crate::VolumeLight::owned_by)) does not cast its shadow, as a lamp shines
    /// out of its own bulb. Maps of one light and projected shadows take no notice. Default `None`: nobody's.
    pub owner: Option<NonZeroU32>,
}

impl Caster {
    /// A mesh under a transform.
    pub fn new(mesh: CasterMesh, world_from_object: Affine3A) -> Self {
        Self {
            mesh,
            world_from_object,
            layers: u32::MAX,
            owner: None,
        }
    }

    /// A mesh placed in f64, in a world whose coordinates are counted from `origin`.
    ///
    /// For scenes so far from their origin that f32 cannot place them: with `origin` at the camera
    /// (or anywhere near it), what is near the camera keeps all its digits. View and light must be
    /// placed from the same origin ([`View::placed`](crate::View::placed),
    /// [`HomogeneousLight::placed`](crate::HomogeneousLight::placed)), and the host draws the mesh
    /// with [`world_from_object`](Self::world_from_object) as it is here. An origin that stays where
    /// it is for a while, rather than following the camera, lets volumes be kept between frames.
    pub fn placed(mesh: CasterMesh, world_from_object: DAffine3, origin: DVec3) -> Self {
        let relative = DAffine3 {
            translation: world_from_object.translation - origin,
            ..world_from_object
        };
        Self::new(mesh, relative.as_affine3a())
    }

    /// The transform in f64 (bit for bit the same numbers).
    pub(crate) fn transform(&self) -> DAffine3 {
        let m = self.world_from_object;
        DAffine3::from_cols(
            m.matrix3.x_axis.as_dvec3(),
            m.matrix3.y_axis.as_dvec3(),
            m.matrix3.z_axis.as_dvec3(),
            m.translation.as_dvec3(),
        )
    }

    /// Checks what every pass needs of a caster.
    pub(crate) fn validate(&self, index: usize, device: &wgpu::Device) -> Result<(), CasterError> {
        if self.mesh.device() != device {
            return Err(CasterError::Device { index });
        }
        if !self.world_from_object.is_finite() {
            return Err(CasterError::NotFinite { index });
        }
        Ok(())
    }
}
