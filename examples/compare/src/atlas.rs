//! An atlas at work: all lights that it is given, in one map.

use anyhow::Result;
use host::gpu::Gpu;
use host::interior::radius_in_texels;
use host::renderer::Renderer;
use shadows::reference::Interior;
use shadows::{
    AtlasFrame, AtlasLight, AtlasStatistics, AtlasTile, AtlasView, CascadeFit, Cascades,
    DirectionalLight, HostDraw, PcfSampler, ShadowAtlas, ShadowAtlasDescriptor, TileSize, wgpu,
};

use crate::shadow::ShadowInputs;

/// The atlas, and what reads it.
pub struct Atlas {
    atlas: ShadowAtlas,
    sampler: PcfSampler,
    group: (u64, wgpu::BindGroup),
    size: u32,
    kept: bool,
    target: [u32; 2],
    /// Of the last frame: whether each light has a cube of tiles.
    points: Vec<bool>,
}

impl Atlas {
    pub fn new(
        gpu: &Gpu,
        renderer: &Renderer,
        (size, kept): (u32, bool),
        sampler: PcfSampler,
    ) -> Result<Self> {
        let usual = ShadowAtlasDescriptor::default();
        let descriptor = ShadowAtlasDescriptor {
            layer_size: usual.layer_size.max(size),
            ..usual
        };
        let atlas = ShadowAtlas::new(&gpu.device, &descriptor)?;
        Ok(Self {
            group: (atlas.revision(), sampler.bind_group(&gpu.device, &atlas)?),
            atlas,
            sampler,
            size,
            kept,
            target: renderer.size(),
            points: Vec::new(),
        })
    }

    /// Lights of one view, with the same casters.
    pub fn prepare(&mut self, gpu: &Gpu, inputs: &[ShadowInputs]) -> Result<()> {
        let Some(first) = inputs.first() else {
            return Ok(());
        };
        if !self.kept {
            self.atlas.invalidate();
        }
        let lights: Vec<AtlasLight> = inputs
            .iter()
            .map(|of| self.light(of, inputs.len()))
            .collect();
        self.points = inputs.iter().map(is_point).collect();
        let [width, height] = self.target;
        let frame = AtlasFrame {
            lights: &lights,
            casters: &first.of_maps(),
            views: &[AtlasView {
                depth_bounds: first.depths,
                ..AtlasView::new(&first.view, width, height)
            }],
            receivers: Some(first.receivers),
        };
        self.atlas.prepare(&gpu.device, &gpu.queue, &frame)?;
        let revision = self.atlas.revision();
        if self.group.0 != revision {
            let group = self.sampler.bind_group(&gpu.device, &self.atlas)?;
            self.group = (revision, group);
        }
        Ok(())
    }

    /// Draws the tiles; what only the host can draw, by `draw`.
    pub fn encode_with(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        draw: impl FnMut(&mut wgpu::RenderPass<'_>, &HostDraw<'_>),
    ) {
        self.atlas.encode_with(encoder, draw);
    }

    pub fn group(&self) -> &wgpu::BindGroup {
        &self.group.1
    }

    pub fn statistics(&self) -> AtlasStatistics {
        self.atlas.statistics()
    }

    /// Where resolution is no excuse for the errors of one of the last frame's lights. Of cascades the
    /// widest decides, whichever a pixel reads.
    pub fn interior(&self, light: usize) -> Interior {
        let kernel_radius = radius_in_texels(self.sampler.kernel());
        let mut tiles = self.atlas.tiles(light, 0);
        let texels = |tile: &AtlasTile| {
            let per_unit = tile.clip_from_world.row(0).truncate().length();
            per_unit * tile.size as f32
        };
        // The last may be narrower than one before it: fits end where nothing receives.
        tiles.sort_by(|a, b| texels(b).total_cmp(&texels(a)));
        match (tiles.last(), self.points.get(light)) {
            (Some(tile), Some(true)) => Interior::Map {
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

    /// A single light has tiles of the asked size; of many, they go by what each is worth on screen.
    fn light(&self, of: &ShadowInputs, count: usize) -> AtlasLight {
        let auto = |least: u32| TileSize::Auto {
            least: least.min(self.size),
            most: self.size,
        };
        let (light, least) = if let Some(spot) = of.spot_light() {
            (AtlasLight::new(spot), 64)
        } else if is_point(of) {
            (AtlasLight::new(of.point_light()), 64)
        } else {
            // Depths count along the camera's axis, cascades' distances from its eye.
            let cascades = Cascades {
                distance: 1.5 * of.seen,
                // Who has read the depths of the very picture has a camera that stands still.
                fit: match of.depths {
                    Some(_) => CascadeFit::Tight,
                    None => CascadeFit::Stable,
                },
                ..Default::default()
            };
            let sun = DirectionalLight::new(of.light.xyzw().truncate());
            (AtlasLight::directional(sun, cascades), 256)
        };
        light.with_size(match count {
            1 => TileSize::Fixed(self.size),
            _ => auto(least),
        })
    }
}

fn is_point(of: &ShadowInputs) -> bool {
    of.cone.is_none() && !of.light.is_directional()
}
