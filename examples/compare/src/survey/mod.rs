//! The techniques of scenes that need no more than they show. Each is a variant here and a file beside.

pub mod baked;
mod blob;
pub mod planar;
pub mod planar_soft;
pub mod projected;

use anyhow::Result;
use serde_json::Value;
use shadows::reference::Interior;
use shadows::wgpu;

use crate::shadow::{Cost, ShadowInputs};
use host::gpu::Gpu;
use host::renderer::{LitPipeline, Look, Renderer};
use host::scene::Scene;
use host::scene_gpu::SceneGpu;

pub use baked::Baked;
pub use blob::Blobs;

/// Which one, and how it is made.
#[derive(Clone, Debug)]
pub enum Survey {
    /// Projected onto the ground.
    Planar,
    /// The same from many places of a light with a size, in a texture of so many texels a side.
    PlanarSoft { size: u32, samples: u32 },
    /// Pictures of casters on what receives.
    Projected(projected::Projected),
    /// An ellipsoid for each caster.
    Blob(Blobs),
    /// Found once by rays, and kept in a light map.
    Baked(Baked),
}

/// What was done once, before the first frame.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Bake {
    /// Wall-clock seconds of unwrapping and of baking.
    pub seconds: f64,
    /// The longest side of a texel on a surface, world units.
    pub texel: f64,
    /// Texels of the map that hold something, in per cent.
    pub filled_percent: f64,
}

/// One at work.
pub trait SurveyShadow {
    /// The frame's work on the CPU.
    ///
    /// # Errors
    /// If the technique refuses the inputs.
    fn prepare(&mut self, gpu: &Gpu, inputs: &ShadowInputs) -> Result<()>;

    /// Records what finds the shadows.
    fn generate(&mut self, host: &Renderer, scene: &SceneGpu, encoder: &mut wgpu::CommandEncoder);

    /// What the lit pass reads, if anything.
    fn group(&self) -> Option<&wgpu::BindGroup>;

    /// What the last prepared frame takes.
    fn cost(&self) -> Cost;

    /// Where resolution is no excuse for its errors.
    fn interior(&self) -> Interior;

    /// What was baked before the first frame, if anything was.
    fn bake(&self) -> Option<Bake> {
        None
    }
}

impl Survey {
    /// With what its names begin.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Planar | Self::PlanarSoft { .. } => "planar",
            Self::Projected(_) => "projected",
            Self::Blob(_) => "blob",
            Self::Baked(_) => "baked",
        }
    }

    /// Whether it is made for a number of texels.
    pub fn has_texels(&self) -> bool {
        match self {
            Self::Planar | Self::Blob(_) => false,
            Self::PlanarSoft { .. } | Self::Projected(_) | Self::Baked(_) => true,
        }
    }

    /// Whether its edges are as soft as those of a light with a size.
    pub fn is_soft(&self) -> bool {
        match self {
            Self::PlanarSoft { .. } | Self::Blob(_) => true,
            Self::Baked(baked) => baked.radius > 0.0,
            Self::Planar | Self::Projected(_) => false,
        }
    }

    /// Whether it can be tried on a scene that is drawn in this way.
    pub fn fits(&self, scene: &Scene, look: Look) -> bool {
        match self {
            Self::Planar | Self::PlanarSoft { .. } => planar::ground(scene).is_some(),
            Self::Projected(_) | Self::Blob(Blobs::Asked) => true,
            Self::Blob(Blobs::Decals) => look.samples == 1,
            Self::Baked(_) => baked::knows(look),
        }
    }

    /// Everything that was chosen, by name.
    pub fn settings(&self) -> Value {
        match self {
            Self::Planar => planar::settings(),
            Self::PlanarSoft { size, samples } => planar_soft::settings(*size, *samples),
            Self::Projected(projected) => projected.settings(),
            Self::Blob(blobs) => blobs.settings(),
            Self::Baked(baked) => baked.settings(),
        }
    }

    /// Makes it, and the lit pass that reads it.
    ///
    /// # Errors
    /// If the device cannot do it.
    pub fn make(
        &self,
        gpu: &Gpu,
        renderer: &Renderer,
    ) -> Result<(Box<dyn SurveyShadow>, LitPipeline)> {
        match self {
            Self::Planar => planar::make(gpu, renderer),
            &Self::PlanarSoft { size, samples } => {
                planar_soft::make(gpu, renderer, (size, samples))
            }
            Self::Projected(projected) => projected.make(gpu, renderer),
            Self::Blob(blobs) => blobs.make(gpu, renderer),
            Self::Baked(baked) => baked.make(gpu, renderer),
        }
    }
}
