//! What the host's renderer draws into.

use anyhow::{Result, ensure};
use shadows::wgpu;

use super::gpu::Gpu;
use super::pipelines::{SHADED, VISIBILITY};

/// What is drawn into.
pub(super) struct Targets {
    pub depth_texture: wgpu::Texture,
    pub depth_stencil: wgpu::TextureView,
    pub shaded: Target,
    pub visibility: Target,
}

impl Targets {
    pub fn new(
        gpu: &Gpu,
        size: [u32; 2],
        depth_stencil: wgpu::TextureFormat,
        samples: u32,
    ) -> Result<Self> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        ensure!(
            size.iter().all(|&side| side <= limit),
            "a picture of {}x{} is too large for this device; at most {limit}x{limit}",
            size[0],
            size[1]
        );
        let depth_stencil = gpu.target(size, depth_stencil, samples);
        Ok(Self {
            depth_stencil: depth_stencil.create_view(&Default::default()),
            depth_texture: depth_stencil,
            shaded: Target::new(gpu, size, SHADED, samples),
            visibility: Target::new(gpu, size, VISIBILITY, samples),
        })
    }
}

/// One of them: the texture that is read, resolved from the samples where there are several.
pub(super) struct Target {
    pub texture: wgpu::Texture,
    samples: Option<wgpu::Texture>,
}

impl Target {
    pub fn new(gpu: &Gpu, size: [u32; 2], format: wgpu::TextureFormat, samples: u32) -> Self {
        Self {
            texture: gpu.target(size, format, 1),
            samples: (samples > 1).then(|| gpu.target(size, format, samples)),
        }
    }

    /// Where a pass draws, and where it resolves to.
    pub fn views(&self) -> (wgpu::TextureView, Option<wgpu::TextureView>) {
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        match &self.samples {
            None => (view(&self.texture), None),
            Some(samples) => (view(samples), Some(view(&self.texture))),
        }
    }
}

/// A colour attachment that is kept.
pub(super) fn color<'v>(
    view: &'v wgpu::TextureView,
    resolve_target: Option<&'v wgpu::TextureView>,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPassColorAttachment<'v> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target,
        ops: wgpu::Operations {
            load,
            store: wgpu::StoreOp::Store,
        },
    }
}
