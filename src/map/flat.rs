//! Flat shadow maps for spot and directional lights.

use glam::{Mat4, Vec4};

use super::encoding::{DepthEncoding, texel_bytes};
use super::flat_descriptor::{FlatLight, ShadowFrame, ShadowMapDescriptor};
use super::gpu::{
    Casting, Draw, FlatLightBuffer, INSTANCE_SIZE, LightRecord, PipelineKind, TilePlace,
    TileTexture, Tiles, TooLarge, array_view, begin_depth_pass, can_pull_casters, create_texture,
    layer_view,
};
use super::plan::{FlatPlace, Rules, SlotPlan, Slots, choose_tiles, follow};
use super::statistics::ShadowMapStatistics;
use crate::error::ShadowMapError;
use crate::gl;
use crate::mesh::Caster;
use crate::scene::Casters;
use crate::submissions::Submissions;
use crate::{Bias, Radius};

/// The matrix from clip space to the space of a texture: x and y from -1 .. 1 to 0 .. 1, y turned
/// over because rows of a texture count down, and z left as it is because WebGPU's clip space has
/// depth in 0 .. 1 already. (What textbooks for OpenGL call the bias matrix halves z too.)
///
/// ```
/// use shadows::{glam::Vec3, texture_from_clip};
/// let corner = texture_from_clip().project_point3(Vec3::new(-1.0, 1.0, 0.25));
/// assert_eq!(corner, Vec3::new(0.0, 0.0, 0.25));
/// ```
pub fn texture_from_clip() -> Mat4 {
    Mat4::from_cols(
        Vec4::new(0.5, 0.0, 0.0, 0.0),
        Vec4::new(0.0, -0.5, 0.0, 0.0),
        Vec4::Z,
        Vec4::new(0.5, 0.5, 0.0, 1.0),
    )
}

/// A depth map for one spot or directional light (Williams, "Casting Curved Shadows on Curved
/// Surfaces", 1978).
///
/// Reverse-Z, `Depth32Float` by default: a texel holds `near / d` for a spot and `1 - d / range` for a
/// directional light, `d` along the light's direction, and 0 where no caster is. What lies outside
/// the map is lit, and so is what lies behind a spot; beyond a spot's range nothing is.
///
/// # What is drawn again
///
/// A map that shows all that it must is left alone. This is found by comparing, as for a
/// [`CubeShadowMap`](crate::CubeShadowMap): of a frame in which nothing has changed, 80 bytes a caster
/// are read, and nothing is uploaded.
#[derive(Debug)]
pub struct ShadowMap {
    label: String,
    size: u32,
    bias: Bias,
    pub(crate) reach: Radius,
    cache: bool,
    texture: wgpu::Texture,
    /// What is drawn on, and what is read.
    layer: wgpu::TextureView,
    layers: wgpu::TextureView,
    light: FlatLightBuffer,
    casting: Casting,
    casters: Casters,
    place: FlatPlace,
    /// One, with one tile.
    slots: Slots,
    submissions: Submissions,
    statistics: ShadowMapStatistics,
}

impl ShadowMap {
    /// Allocates a map.
    ///
    /// # Errors
    /// [`ShadowMapError`] if the size or the bias is out of range.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &ShadowMapDescriptor<'_>,
    ) -> Result<Self, ShadowMapError> {
        descriptor.validate(device)?;
        let label = match descriptor.label {
            Some(label) => format!("shadows map {label}"),
            None => "shadows map".to_owned(),
        };
        let (size, bias, reach) = (descriptor.size, descriptor.bias, descriptor.reach);
        let layers = gl::array_layers(device, 1);
        let texture = create_texture(device, &label, size, descriptor.format, layers);
        let kind = PipelineKind {
            format: texture.format(),
            encoding: DepthEncoding::MajorAxis,
            slope_scale: bias.slope_scale,
            unclipped_depth: descriptor.unclipped_depth && can_pull_casters(device),
        };
        let unclipped_depth = kind.unclipped_depth;
        let casting = Casting::new(device, &label, kind, descriptor.sides, (1, 1));
        Ok(Self {
            size,
            bias,
            reach,
            cache: descriptor.cache,
            layer: layer_view(&texture, &label, 0),
            layers: array_view(&texture, &label),
            texture,
            place: FlatPlace::new(size, reach, casting.near_plane(), unclipped_depth),
            light: FlatLightBuffer::new(device, &label),
            casting,
            casters: Casters::default(),
            slots: Slots::new(1, true),
            submissions: Submissions::default(),
            statistics: ShadowMapStatistics::default(),
            label,
        })
    }

    /// Finds where the map lies, decides which casters go on it and stages what drawing them needs.
    /// (Nothing goes through the queue, which is there as in every other `prepare`: it has its place in
    /// the order of the encoder, see [`encode`](Self::encode).)
    ///
    /// # Errors
    /// [`ShadowMapError`] if the light, a caster, the view's distance or the receivers' bounds are
    /// out of range, each by itself or all together in `f32`; the map is then as it was.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        _: &wgpu::Queue,
        frame: &ShadowFrame<'_>,
    ) -> Result<(), ShadowMapError> {
        frame.validate()?;
        self.validate_reach(&frame.light)?;
        self.validate_count(device, frame.casters.len())?;
        self.casters.compare(frame.casters, device)?;
        self.casters.update(frame.casters);
        let placed = self.place.take_over(frame, &self.casters);
        if placed.is_err() {
            self.slots.miss_update();
        }
        placed?;
        let light = self.place.projection();
        self.slots.take_over(&[light.into()], &mut self.casters);

        let encoder_dropped = self.submissions.take_dropped();
        if encoder_dropped {
            self.invalidate();
        }
        let not_encoded = self.is_pending() || self.casting.uploaded() > 0;
        if not_encoded {
            self.forget_uploads();
        }
        let plans = self.plan();
        follow(&plans, &mut self.slots);
        self.casting.clear();
        if self.is_pending() {
            self.record_draws(device, frame.casters)?;
        }
        let record = self.light_record();
        self.light.write(self.casting.uploads(), record);
        self.statistics = ShadowMapStatistics {
            not_encoded,
            encoder_dropped,
            ..self.count(frame.casters.len())
        };
        Ok(())
    }

    /// Records what the last [`prepare`](Self::prepare) found necessary: its pass, and what it tells
    /// receivers of the light. Once: a second call before the next `prepare` records nothing.
    ///
    /// Call it after every `prepare`, whatever that found. Until it is called, receivers see texels and
    /// light as they were; of a map that was never drawn they see a dark light. What is recorded must
    /// be submitted: if its encoder is dropped, the `prepare` after that draws the map again
    /// ([`ShadowMapStatistics::encoder_dropped`]).
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let copied = self.casting.uploads().record(encoder);
        if copied || self.is_pending() {
            self.submissions.watch(encoder);
        }
        if !self.is_pending() {
            return;
        }
        let draws = &self.casting.draws().of(0, 0).tile.draws;
        self.casting.record(&mut self.pass(encoder), (0, 0), draws);
        self.slots[0].encoded(1);
    }

    /// Takes nothing for drawn: the next [`prepare`](Self::prepare) has the map drawn again. What the
    /// last one found is forgotten.
    ///
    /// For a host that has written to the map's texture, or has lost what was recorded in a way that
    /// the map cannot see: an encoder that is kept but never submitted, a submission that failed.
    pub fn invalidate(&mut self) {
        self.slots[0].doubt_texels();
        self.forget_uploads();
    }

    /// Begins a pass that clears the map, for a host that draws its own geometry (skinned,
    /// alpha-tested) with [`clip_from_world`](Self::clip_from_world): the map's format, one sample,
    /// depth compare `Greater`. For spots on wgpu's GL back end see
    /// [`begin_face`](crate::CubeShadowMap::begin_face).
    ///
    /// Call it after [`encode`](Self::encode) (or instead of it): what `encode` drew is cleared, so
    /// pass such a host's other casters through its own draws too. The casters of
    /// [`prepare`](Self::prepare) still decide where a directional light's map lies.
    pub fn begin_pass<'encoder>(
        &mut self,
        encoder: &'encoder mut wgpu::CommandEncoder,
    ) -> wgpu::RenderPass<'encoder> {
        if self.casting.uploads().record(encoder) {
            self.submissions.watch(encoder);
        }
        if !self.slots[0].tiles.is_empty() {
            self.slots[0].touched(0);
        }
        self.pass(encoder)
    }

    /// World space to clip space, as the last [`prepare`](Self::prepare) placed the map; `None`
    /// where nothing casts. The frame is left-handed: triangles that are counter-clockwise seen
    /// from the light are clockwise on the map.
    pub fn clip_from_world(&self) -> Option<Mat4> {
        Some(self.place.frame()?.clip_from_world())
    }

    /// World space to texture coordinates (x and y in 0 .. 1 on the map) and depth, after division
    /// by w: [`texture_from_clip`] times [`clip_from_world`](Self::clip_from_world).
    pub fn texture_from_world(&self) -> Option<Mat4> {
        Some(texture_from_clip() * self.clip_from_world()?)
    }

    /// The texture, of [`ShadowMapDescriptor::format`].
    pub fn texture(&self) -> &wgpu::Texture {
        &self.texture
    }

    /// The map as layer 0 of a 2D array (`texture_2d_array`, `texture_depth_2d_array`), for hosts that
    /// sample it themselves. On wgpu's GL back end it has a spare layer, which nothing is drawn into.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.layers
    }

    /// Texels along each side.
    pub fn size(&self) -> u32 {
        self.size
    }

    /// What the last [`prepare`](Self::prepare) found.
    pub fn statistics(&self) -> ShadowMapStatistics {
        self.statistics
    }

    pub(crate) fn light_uniform(&self) -> &wgpu::Buffer {
        self.light.buffer()
    }

    fn pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
    ) -> wgpu::RenderPass<'encoder> {
        begin_depth_pass(encoder, &self.label, &self.layer, wgpu::LoadOp::Clear(0.0))
    }

    /// A directional light's map is made wider by what kernels reach beside what is seen; of texels, a
    /// small map has not that many.
    fn validate_reach(&self, light: &FlatLight) -> Result<(), ShadowMapError> {
        let ((reach, _), size) = (self.reach.reach(), self.size);
        match light {
            FlatLight::Directional(_) if 4.0 * (reach + 1.0) > size as f32 => {
                Err(ShadowMapError::ReachOfSize { reach, size })
            }
            _ => Ok(()),
        }
    }

    fn validate_count(&self, device: &wgpu::Device, casters: usize) -> Result<(), ShadowMapError> {
        let limit = device.limits().max_buffer_size;
        let size = casters as u64 * INSTANCE_SIZE;
        match size > limit {
            true => Err(ShadowMapError::TooManyCasters {
                casters,
                size,
                limit,
            }),
            false => Ok(()),
        }
    }

    /// Whether the next encode draws.
    fn is_pending(&self) -> bool {
        self.slots[0].pending != 0
    }

    /// Decides whether the map is drawn. Changes nothing.
    fn plan(&self) -> Vec<SlotPlan> {
        let rules = Rules {
            views: &[],
            reach: self.reach,
            cache: self.cache,
            budget: None,
            pinned: &[],
        };
        choose_tiles(&self.slots, &rules, |_| Some(self.size))
    }

    /// Lists the draws of the casters on the map, and stages what they need.
    fn record_draws(
        &mut self,
        device: &wgpu::Device,
        casters: &[Caster],
    ) -> Result<(), ShadowMapError> {
        let slot = &self.slots[0];
        let casters = (&self.casters, casters);
        self.casting
            .add((0, slot), slot.pending, self.size, casters);
        let instances = self.casting.draws().instances().len();
        let reserved = self.casting.reserve(device, instances, 1);
        reserved.map_err(|TooLarge { size, limit }| ShadowMapError::TooManyCasters {
            casters: instances,
            size,
            limit,
        })?;
        self.casting.finish(device);
        Ok(())
    }

    /// What receivers are told of the light.
    fn light_record(&self) -> LightRecord {
        let texture = TileTexture {
            side: self.size,
            bias: self.bias,
            format: self.texture.format(),
        };
        let tile = Tiles::At {
            size: self.size,
            places: [TilePlace::layer(0)],
        };
        match self.place.frame() {
            Some(frame) => LightRecord::flat(frame, tile, &texture),
            None => LightRecord::lit(),
        }
    }

    /// Forgets what was to be written, and what has been.
    fn forget_uploads(&mut self) {
        self.casting.forget_uploads();
        self.light.forget();
    }

    fn count(&self, casters: usize) -> ShadowMapStatistics {
        let drawn = self.slots[0].casting as u32;
        ShadowMapStatistics {
            rendered: self.is_pending(),
            casters_drawn: drawn,
            casters_outside: casters as u32 - drawn,
            draws: self.casting.draws().iter().count() as u32,
            triangles: self.casting.draws().iter().map(Draw::triangles).sum(),
            bytes: u64::from(self.texture.depth_or_array_layers())
                * u64::from(self.size).pow(2)
                * texel_bytes(self.texture.format())
                + self.casting.bytes()
                + self.light.buffer().size(),
            uploaded: self.casting.uploaded(),
            ..Default::default()
        }
    }
}
