//! One light in one view, as most hosts here have them.

use shadows::error::ShadowVolumeError;
use shadows::mesh::Bounds;
use shadows::{
    Caster, HomogeneousLight, ShadowVolumeFrame, ShadowVolumeRenderer, View, VolumeCone,
    VolumeLight, VolumeView, wgpu,
};

/// A frame of shadow volumes with one light and one view.
#[derive(Clone, Copy, Debug)]
pub struct OneLight<'a> {
    pub view: &'a View,
    pub light: HomogeneousLight,
    pub range: Option<f32>,
    /// Of a spot.
    pub cone: Option<VolumeCone>,
    pub target_size: Option<[u32; 2]>,
    pub receivers: Option<Bounds>,
    pub casters: &'a [Caster],
}

impl<'a> OneLight<'a> {
    /// With a light of no range, no target size and receivers anywhere.
    pub fn new(view: &'a View, light: HomogeneousLight, casters: &'a [Caster]) -> Self {
        Self {
            view,
            light,
            range: None,
            cone: None,
            target_size: None,
            receivers: None,
            casters,
        }
    }

    /// Gives what it is as a frame.
    pub fn with<T>(&self, work: impl FnOnce(&ShadowVolumeFrame<'_>) -> T) -> T {
        work(&ShadowVolumeFrame {
            lights: &[VolumeLight {
                cone: self.cone,
                ..VolumeLight::new(self.light, self.range)
            }],
            views: &[VolumeView {
                view: *self.view,
                target_size: self.target_size,
            }],
            receivers: self.receivers,
            casters: self.casters,
        })
    }
}

/// Prepares such frames.
pub trait PrepareOne {
    /// # Errors
    /// As [`ShadowVolumeRenderer::prepare`].
    fn prepare_one(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        frame: &OneLight<'_>,
    ) -> Result<(), ShadowVolumeError>;
}

impl PrepareOne for ShadowVolumeRenderer {
    fn prepare_one(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        frame: &OneLight<'_>,
    ) -> Result<(), ShadowVolumeError> {
        frame.with(|frame| self.prepare(device, queue, frame))
    }
}
