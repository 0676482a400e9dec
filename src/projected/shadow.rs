//! The type of projected shadows.

use glam::Mat4;

use super::descriptor::{ProjectedFrame, ProjectedShadowDescriptor};
use super::draws::Draw;
use super::passes::Passes;
use super::plan::Plan;
use super::receivers::Receivers;
use super::record::{ProjectedRecord, Records};
use super::statistics::{ProjectedStatistics, ProjectorState};
use super::texture::MipTexture;
use crate::error::ProjectedShadowError;
use crate::submissions::Submissions;
use crate::uploads::Uploads;

/// Shadows as pictures of their casters, seen from the light and projected onto receivers (Segal et al., "Fast
/// Shadows and Lighting Effects Using Texture Mapping", 1992): Many shadows, each of one light and a few
/// casters, share one texture as its tiles.
///
/// A texel holds the share of red, green and blue light that passes through all casters on it, multiplied, so
/// casters may be coloured and translucent, and their order does not matter. It does not hold their depth,
/// hence two limitations:
///
/// - **A caster shadows itself.** If read on the caster's own surface, all of it is in shadow except what is
///   nearer to the light than the nearest point of the bounds of the projector's casters. Read the shadow only
///   on receivers that do not cast it.
/// - **Receivers between casters and the light** are shadowed, too, from that nearest point on.
///
/// Anything nearer to the light than that, outside the tile, or behind the light is lit; so is anything that faces away
/// from the light, if the shader passes a normal. Filtering is bilinear, and linear between mip levels: a shadow's edge
/// is blurred over about a texel, or over a pixel where pixels are larger.
///
/// # What is redrawn
///
/// A shadow whose light and casters have not changed is left alone, wherever it is in the frame's list: in a frame
/// without changes, 80 bytes per caster are read, and nothing is uploaded.
///
/// ```
/// # use shadows::*;
/// # fn host(
/// #     device: &wgpu::Device, queue: &wgpu::Queue, encoder: &mut wgpu::CommandEncoder, caster: Caster, pane: Caster,
/// # ) -> Result<(), shadows::error::ProjectedShadowError> {
/// // Once.
/// let mut shadows = ProjectedShadow::new(device, &ProjectedShadowDescriptor::default())?;
/// let module = shadows.wgsl_module(1); // `shadows_transmittance(0u, world, dpdx(world), dpdy(world))`
///
/// // Every frame. Of red light a fifth comes through the pane, of the rest nothing.
/// let casters = [
///     ProjectedCaster::opaque(caster),
///     ProjectedCaster::new(pane, [0.2, 0.0, 0.0]),
/// ];
/// let lamp = PointLight::new(glam::Vec3::new(0.0, 4.0, 1.0), 30.0);
/// let projectors = [Projector::new(lamp, &casters)];
/// shadows.prepare(device, queue, &ProjectedFrame { projectors: &projectors })?;
/// shadows.encode(encoder);
/// // ... and bind it as group 1 where receivers are shaded.
/// let group = shadows.bind_group();
/// # let _ = (module, group);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct ProjectedShadow {
    label: String,
    layer_size: u32,
    most_layers: u32,
    cache: bool,
    plan: Plan,
    texture: MipTexture,
    records: Records,
    receivers: Receivers,
    group: wgpu::BindGroup,
    passes: Passes,
    uploads: Uploads,
    submissions: Submissions,
    statistics: ProjectedStatistics,
}

impl ProjectedShadow {
    /// Creates everything that shadows share. Layers are allocated when shadows need them.
    ///
    /// # Errors
    /// [`ProjectedShadowError`] if the size of layers or the memory is out of range.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &ProjectedShadowDescriptor<'_>,
    ) -> Result<Self, ProjectedShadowError> {
        descriptor.validate(device)?;
        let label = match descriptor.label {
            Some(label) => format!("shadows projected {label}"),
            None => "shadows projected".to_owned(),
        };
        let (layer_size, most_layers) = (descriptor.layer_size, descriptor.most_layers(device));
        let texture = MipTexture::placeholder(device, &label);
        let records = Records::new(device, &label, 1);
        let receivers = Receivers::new(device, &label);
        Ok(Self {
            layer_size,
            most_layers,
            cache: descriptor.cache,
            plan: Plan::new(layer_size, most_layers),
            group: receivers.group(device, &texture, &records),
            passes: Passes::new(device, &label, &texture),
            texture,
            records,
            receivers,
            uploads: Uploads::new(device),
            submissions: Submissions::default(),
            statistics: ProjectedStatistics::default(),
            label,
        })
    }

    /// Gives each shadow a tile, decides which to draw and stages the uploads. (Nothing is written through the
    /// queue, which is a parameter only because every `prepare` takes one.)
    ///
    /// A shadow that cannot be drawn, because its light is among its casters or something overflows `f32`, is
    /// missing, but does not prevent the others from being drawn: see [`state`](Self::state).
    ///
    /// # Errors
    /// [`ProjectedShadowError`] if a projector's size, light, casters or transmittances are out of range, or
    /// if the tiles do not fit. The shadows are then unchanged.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        _: &wgpu::Queue,
        frame: &ProjectedFrame<'_>,
    ) -> Result<(), ProjectedShadowError> {
        frame.validate(device, self.layer_size)?;
        let wanted = self.plan.wanted(frame)?;
        let encoder_dropped = self.submissions.take_dropped();
        let not_encoded = self.passes.is_pending() || self.uploads.is_waiting();
        if not_encoded || encoder_dropped {
            self.forget_uploads();
        }
        self.plan.take_over(wanted);
        if encoder_dropped || !self.cache {
            self.plan.doubt();
        }
        self.make_room(device, frame.projectors.len());
        self.list(device, frame);
        self.statistics = ProjectedStatistics {
            not_encoded,
            encoder_dropped,
            ..self.count()
        };
        Ok(())
    }

    /// Records the work that the last [`prepare`](Self::prepare) found necessary. Does so once: a second call
    /// before the next `prepare` records nothing.
    ///
    /// Call it after every `prepare`, whatever the result. Until then, receivers see the previous shadows, or none
    /// with a new [`bind_group`](Self::bind_group). The recorded work must be submitted: if the encoder is
    /// dropped, the next `prepare` redraws all shadows ([`ProjectedStatistics::encoder_dropped`]).
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let copied = self.uploads.record(encoder);
        if !copied && !self.passes.is_pending() {
            return;
        }
        self.submissions.watch(encoder);
        self.passes.encode(encoder, &self.texture);
        self.passes.clear();
        self.plan.encoded();
    }

    /// Marks all shadows as outdated: the next [`prepare`](Self::prepare) redraws them. The result of the
    /// last one is discarded.
    ///
    /// For a host that has lost recorded work in a way that cannot be detected here: an encoder that is kept
    /// but never submitted, or a submission that failed.
    pub fn invalidate(&mut self) {
        self.plan.doubt();
        self.passes.clear();
        self.forget_uploads();
    }

    /// Layout of the bind group: 0 the texture (`texture_2d_array<f32>`), 1 a filtering sampler, 2 the
    /// shadows (read-only storage buffer of 96 bytes each; on devices without storage buffers a uniform buffer of
    /// 128). Fragment and compute stages.
    pub fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        self.receivers.layout()
    }

    /// The bind group for all shadows of the last [`prepare`](Self::prepare), which may have recreated it:
    /// fetch it each frame.
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.group
    }

    /// WGSL without bindings: texture and sampler are parameters.
    ///
    /// ```wgsl
    /// fn shadows_projected_transmittance(
    ///     map: texture_2d_array<f32>,
    ///     map_sampler: sampler,
    ///     shadow: ShadowsProjected,
    ///     position: vec3f, // of the receiver, world space
    ///     x: vec3f,        // how it changes to the next pixel on the right: dpdx(position)
    ///     y: vec3f,        // and below: dpdy(position)
    /// ) -> vec3f           // what comes through of red, green and blue light, 0 to 1
    /// ```
    ///
    /// and `shadows_projected_transmittance_facing`, which takes a `normal` of any length after `position`: what
    /// faces away from the light is lit. Neither uses derivatives, so they may be called in any branch, and in
    /// compute shaders. If `x` and `y` are 0, only the finest mip level is read.
    pub fn wgsl(&self) -> String {
        self.receivers.wgsl()
    }

    /// The same with the bindings of group `group`, and functions that take the index of a shadow in the
    /// frame:
    ///
    /// ```wgsl
    /// fn shadows_transmittance(projector: u32, position: vec3f, x: vec3f, y: vec3f) -> vec3f
    /// fn shadows_transmittance_facing(projector: u32, position: vec3f, normal: vec3f, x: vec3f, y: vec3f) -> vec3f
    /// ```
    ///
    /// `projector` is below `arrayLength(&shadows_projectors)`, which is at least the number of the frame's
    /// projectors (for a uniform buffer it is 128, the most that a frame may then have). Below that, an index
    /// without a projector gives light; beyond it, WGSL may read any element of the array.
    pub fn wgsl_module(&self, group: u32) -> String {
        self.receivers.module(group)
    }

    /// World space to clip space of a shadow's tile, as of the last [`prepare`](Self::prepare); `None` if it has no
    /// tile. It maps to a left-handed space: triangles that are counter-clockwise seen from the light are clockwise on
    /// the tile.
    pub fn clip_from_world(&self, projector: usize) -> Option<Mat4> {
        Some(self.plan.frame(projector)?.clip_from_world())
    }

    /// What the next [`encode`](Self::encode) will do with a shadow of the last [`prepare`](Self::prepare);
    /// `None` beyond the frame's projectors.
    pub fn state(&self, projector: usize) -> Option<ProjectorState> {
        self.plan.states().nth(projector)
    }

    /// The texture that holds all tiles, `Rgba8Unorm`, linear.
    pub fn texture(&self) -> &wgpu::Texture {
        self.texture.texture()
    }

    /// Statistics of the last [`prepare`](Self::prepare).
    pub fn statistics(&self) -> ProjectedStatistics {
        self.statistics
    }

    fn forget_uploads(&mut self) {
        self.uploads.clear();
        self.records.forget();
    }

    /// Makes the texture and the buffer of records larger if they must be.
    fn make_room(&mut self, device: &wgpu::Device, projectors: usize) {
        let layers = self.plan.layers();
        let more_layers = layers > self.texture.layers();
        if more_layers {
            let layers = layers.next_power_of_two().min(self.most_layers);
            self.texture = MipTexture::new(device, &self.label, self.layer_size, layers);
            self.passes.read_from(device, &self.texture);
            self.plan.doubt();
        }
        // With a new texture the old records would name texels that nobody has drawn, until `encode`.
        if more_layers || projectors > self.records.len() {
            let count = projectors.max(self.records.len());
            self.records = Records::new(device, &self.label, count);
            self.group = self.receivers.group(device, &self.texture, &self.records);
        }
    }

    /// Lists what the next encode draws and copies.
    fn list(&mut self, device: &wgpu::Device, frame: &ProjectedFrame<'_>) {
        self.passes.clear();
        let tiles = self.plan.tiles().zip(self.plan.states());
        let mut records = Vec::with_capacity(frame.projectors.len());
        for ((tile, state), projector) in tiles.zip(frame.projectors) {
            let Some((lies, place)) = tile else {
                records.push(ProjectedRecord::LIT);
                continue;
            };
            records.push(ProjectedRecord::new(lies, place, self.layer_size));
            if state == ProjectorState::Drawn {
                self.passes.add(lies, place, projector);
            }
        }
        self.passes
            .finish(device, &mut self.uploads, self.layer_size);
        self.records.write(&mut self.uploads, &records);
    }

    fn count(&self) -> ProjectedStatistics {
        let mut statistics = ProjectedStatistics {
            draws: self.passes.draws().count() as u32,
            triangles: self.passes.draws().map(Draw::triangles).sum(),
            passes: self.passes.count(),
            layers: self.texture.layers(),
            texels: self.plan.texels(),
            bytes: self.texture.bytes() + self.passes.bytes() + self.records.buffer().size(),
            uploaded: self.uploads.bytes(),
            ..Default::default()
        };
        self.plan.states().for_each(|state| statistics.count(state));
        statistics
    }
}
