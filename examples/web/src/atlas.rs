//! The light in an atlas of its own.

use anyhow::Result;
use host::gpu::Gpu;
use host::interior::radius_in_texels;
use host::scene::LightKind;
use shadows::reference::Interior;
use shadows::{
    AtlasFrame, AtlasLight, AtlasStatistics, AtlasView, Cascades, PcfSampler, ShadowAtlas,
    ShadowAtlasDescriptor, TileSize, wgpu,
};

use crate::choice::Maps;
use crate::world::Inputs;

/// The atlas, and what reads it.
pub struct Atlas {
    atlas: ShadowAtlas,
    sampler: PcfSampler,
    /// With the revision of the atlas that it is for.
    group: (u64, wgpu::BindGroup),
    /// Texels along a tile.
    size: u32,
    /// Of the last frame.
    kind: LightKind,
}

impl Atlas {
    pub fn new(gpu: &Gpu, maps: &Maps, sampler: PcfSampler) -> Result<Self> {
        // Room for the largest tiles, six of them.
        let usual = ShadowAtlasDescriptor::default();
        let layer_size = maps.size.max(usual.layer_size);
        let layer = 4 * u64::from(layer_size) * u64::from(layer_size);
        let descriptor = ShadowAtlasDescriptor {
            layer_size,
            memory: usual.memory.max(6 * layer),
            settings: maps.settings(),
            ..usual
        };
        let atlas = ShadowAtlas::new(&gpu.device, &descriptor)?;
        Ok(Self {
            group: (atlas.revision(), sampler.bind_group(&gpu.device, &atlas)?),
            atlas,
            sampler,
            size: maps.size,
            kind: LightKind::Point,
        })
    }

    pub fn prepare(&mut self, gpu: &Gpu, inputs: &Inputs<'_>) -> Result<()> {
        self.kind = inputs.light.kind();
        let light = match (inputs.spot(), self.kind) {
            (Some(spot), _) => AtlasLight::new(spot),
            (None, LightKind::Directional) => {
                // Depths count along the camera's axis, cascades' distances from its eye.
                let cascades = Cascades {
                    distance: 1.5 * inputs.seen,
                    ..Default::default()
                };
                AtlasLight::directional(inputs.sun(), cascades)
            }
            (None, _) => AtlasLight::new(inputs.point()),
        };
        let [width, height] = inputs.size;
        let frame = AtlasFrame {
            lights: &[light.with_size(TileSize::Fixed(self.size))],
            casters: inputs.casters,
            views: &[AtlasView::new(&inputs.view, width, height)],
            receivers: Some(inputs.receivers),
        };
        self.atlas.prepare(&gpu.device, &gpu.queue, &frame)?;
        let revision = self.atlas.revision();
        if self.group.0 != revision {
            let group = self.sampler.bind_group(&gpu.device, &self.atlas)?;
            self.group = (revision, group);
        }
        Ok(())
    }

    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.atlas.encode(encoder);
    }

    pub fn group(&self) -> &wgpu::BindGroup {
        &self.group.1
    }

    pub fn statistics(&self) -> AtlasStatistics {
        self.atlas.statistics()
    }

    /// Where resolution is no excuse for errors. Of cascades the widest decides, whichever a pixel reads.
    pub fn interior(&self) -> Interior {
        let kernel_radius = radius_in_texels(self.sampler.kernel());
        match (self.atlas.tiles(0, 0).last(), self.kind) {
            (Some(tile), LightKind::Point) => Interior::Map {
                face_size: tile.size,
                kernel_radius,
            },
            (Some(tile), _) => Interior::FlatMap {
                clip_from_world: tile.clip_from_world,
                size: tile.size,
                kernel_radius,
            },
            // Nothing casts.
            (None, _) => Interior::Screen,
        }
    }
}
