//! Casters: meshes placed in the world.

use std::num::NonZeroU32;

use glam::{Affine3A, DAffine3, DVec3};

use super::CasterMesh;
use crate::error::CasterError;

/// A mesh placed in the world. Many casters may share one mesh.
#[derive(Clone, Debug)]
pub struct Caster {
    /// The mesh.
    pub mesh: CasterMesh,
    /// Any affine map from the mesh's space to world space, including scaling, shearing and mirroring.
    pub world_from_object: Affine3A,
    /// The layers it is on, one bit each. A light of a [`ShadowAtlas`](crate::ShadowAtlas) or of shadow volumes casts
    /// the shadows of all casters on any of its own layers
    /// ([`AtlasLight::with_layers`](crate::AtlasLight::with_layers),
    /// [`VolumeLight::with_layers`](crate::VolumeLight::with_layers)); maps of one light and projected shadows ignore
    /// layers. Default all.
    pub layers: u32,
    /// Its owner: a light of the same owner ([`AtlasLight::owned_by`](crate::AtlasLight::owned_by),
    /// [`VolumeLight::owned_by`](crate::VolumeLight::owned_by)) does not cast its shadow, so that a lamp can
    /// shine out of its own bulb. Maps of one light and projected shadows ignore owners. Default `None`.
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

    /// A mesh placed in f64, for a host that renders relative to `origin`.
    ///
    /// For scenes so far from the world's origin that f32 is not precise enough: with `origin` at the camera
    /// (or anywhere near it), everything near the camera keeps full precision. View and light must use the
    /// same origin ([`View::placed`](crate::View::placed),
    /// [`HomogeneousLight::placed`](crate::HomogeneousLight::placed)), and the host draws the mesh with
    /// [`world_from_object`](Self::world_from_object) as set here. If the origin stays in place for a while
    /// rather than following the camera, volumes can be kept between frames.
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
