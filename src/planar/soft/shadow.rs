//! Planar soft shadows: prepare, encode, read.

use glam::{DVec2, DVec4};

use super::descriptor::PlanarSoftShadowDescriptor;
use super::frame::{LightShape, PlanarRectangle, PlanarSoftFrame};
use super::gpu::{CountPipelines, Receiver, SoftUniform, Target, clip_rows};
use super::samples::{in_square, places};
use crate::Light;
use crate::error::PlanarSoftShadowError;
use crate::map::{DynamicUniforms, INSTANCE_SIZE, largest_buffer};
use crate::planar::axes::{PlaneAxes, Whereabouts};
use crate::planar::casters::{CastDraw, PlaneCasters, host_drawn, reorders};
use crate::planar::gpu::{CastKey, PlanarUniform};
use crate::planar::light::PlaneLight;
use crate::planar::statistics::PlanarStatistics;
use crate::scene::Casters;
use crate::submissions::Submissions;
use crate::uploads::Uploads;

/// The result of the last [`PlanarSoftShadow::prepare`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct PlanarSoftStatistics {
    /// Whether the next `encode` draws the texture; false if nothing has moved.
    pub rendered: bool,
    /// Sample points of the light that are behind the plane or in it, and so light nothing.
    pub samples_behind: u32,
    /// Draw calls of the next `encode`.
    pub draws: u32,
    /// Triangles in those draws.
    pub triangles: u64,
    /// Bytes of GPU memory held.
    pub bytes: u64,
    /// Bytes that the next `encode` copies.
    pub uploaded: u64,
    /// Whether the result of the previous `prepare` was never encoded, so that this one found the same work
    /// again.
    pub not_encoded: bool,
    /// Whether the encoder that was last recorded into was dropped, so that everything is redrawn.
    pub encoder_dropped: bool,
}

/// Soft shadows of one area light on one rectangle: as many hard shadows as the light has
/// [`samples`](PlanarSoftShadowDescriptor::samples), counted in a texture that covers the rectangle.
///
/// [`prepare`](Self::prepare) once a frame, then [`encode`](Self::encode), then the host's own lighting, whose shader
/// calls [`wgsl_module`](Self::wgsl_module)'s `shadows_planar_visibility(world)` with
/// [`bind_group`](Self::bind_group). The texture is redrawn only when the light, the rectangle or the casters change;
/// the camera does not matter.
///
/// The error relative to the true area light falls with the number of samples (figures in `docs/survey.md`), down to a
/// limit set by the size of a texel. As with [`PlanarShadow`](crate::PlanarShadow), nothing but the rectangle
/// receives.
#[derive(Debug)]
pub struct PlanarSoftShadow {
    label: String,
    size: [u32; 2],
    samples: u32,
    jitter: bool,
    cache: bool,
    target: Target,
    receiver: Receiver,
    pipelines: CountPipelines,
    uniforms: DynamicUniforms<PlanarUniform>,
    casters: Casters,
    whereabouts: Whereabouts,
    plane: Option<PlaneCasters>,
    /// What the texture shows once the last encode has run.
    shown: Option<Shown>,
    /// What the next encode draws: the uniform's place, and the draws that use it.
    draws: Option<Vec<Vec<CastDraw>>>,
    behind: u32,
    uploads: Uploads,
    submissions: Submissions,
    statistics: PlanarSoftStatistics,
}

/// All that a texture depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shown {
    light: Light,
    shape: LightShape,
    receiver: PlanarRectangle,
    casters: u64,
}

impl PlanarSoftShadow {
    /// Creates the texture and the pipelines.
    ///
    /// # Errors
    /// [`PlanarSoftShadowError`] if the size or the number of samples is out of range.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &PlanarSoftShadowDescriptor<'_>,
    ) -> Result<Self, PlanarSoftShadowError> {
        descriptor.validate(device)?;
        let label = match descriptor.label {
            Some(name) => format!("shadows planar soft {name}"),
            None => "shadows planar soft".to_owned(),
        };
        let target = Target::new(device, &label, descriptor.size);
        let uniforms = DynamicUniforms::new(device, format!("{label} uniforms"), 1);
        Ok(Self {
            size: descriptor.size,
            samples: descriptor.samples,
            jitter: descriptor.jitter,
            cache: descriptor.cache,
            receiver: Receiver::new(device, &label, &target.view),
            pipelines: CountPipelines::new(device, &label, uniforms.layout()),
            target,
            uniforms,
            casters: Casters::default(),
            whereabouts: Whereabouts::default(),
            plane: None,
            shown: None,
            draws: None,
            behind: 0,
            uploads: Uploads::new(device),
            submissions: Submissions::default(),
            statistics: PlanarSoftStatistics::default(),
            label,
        })
    }

    /// Decides whether to draw the texture, and stages the uploads. (Nothing is written through the queue, which
    /// is a parameter only because every `prepare` takes one.)
    ///
    /// # Errors
    /// [`PlanarSoftShadowError`] if the light, its shape, the rectangle or a caster is invalid, or if the
    /// device's buffers cannot hold the frame. The texture is then unchanged.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        _queue: &wgpu::Queue,
        frame: &PlanarSoftFrame<'_>,
    ) -> Result<(), PlanarSoftShadowError> {
        frame.validate()?;
        self.check_sizes(device, frame)?;
        self.casters.compare(frame.casters, device)?;
        if let Some(index) = host_drawn(&self.casters, frame.casters) {
            return Err(PlanarSoftShadowError::HostDrawn { index });
        }
        self.casters.update(frame.casters);
        let encoder_dropped = self.submissions.take_dropped();
        let not_encoded = self.draws.is_some() || self.uploads.is_waiting();
        if encoder_dropped || not_encoded {
            self.invalidate();
        }
        let shown = Shown {
            light: frame.light,
            shape: frame.shape,
            receiver: frame.receiver,
            casters: self.casters.frame(),
        };
        // Followed in every frame, as only this frame's changes are known.
        self.follow_casters(device, frame);
        if !self.cache || self.shown != Some(shown) {
            self.plan(device, frame);
            self.shown = Some(shown);
        }
        self.statistics = PlanarSoftStatistics {
            not_encoded,
            encoder_dropped,
            ..self.count()
        };
        Ok(())
    }

    /// Records the work that the last [`prepare`](Self::prepare) found necessary. Does so once: a second call
    /// before the next `prepare` records nothing.
    ///
    /// The recorded work must be submitted: if the encoder is dropped, the next `prepare` redraws the texture
    /// ([`PlanarSoftStatistics::encoder_dropped`]).
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let copied = self.uploads.record(encoder);
        let draws = self.draws.take();
        if copied || draws.is_some() {
            self.submissions.watch(encoder);
        }
        let (Some(draws), Some(plane)) = (draws, &self.plane) else {
            return;
        };
        let mut pass = self.target.begin(encoder, &self.label, self.behind);
        for (index, draws) in draws.iter().enumerate() {
            self.uniforms.bind(&mut pass, index);
            pass.set_stencil_reference(index as u32 + 1);
            for draw in draws {
                let Some(pipeline) = self.pipelines.get(&CastKey::new(draw, false)) else {
                    continue; // prepare made one for every key
                };
                pass.set_pipeline(pipeline);
                draw.record(&mut pass, plane.slice(draw));
            }
        }
    }

    /// Marks the texture as outdated: the next [`prepare`](Self::prepare) redraws it. For a host that has lost
    /// recorded work in a way that cannot be detected here. Work that was prepared but not yet encoded is dropped.
    pub fn invalidate(&mut self) {
        self.draws = None;
        self.shown = None;
        self.uploads.clear();
        self.uniforms.forget();
        if let Some(plane) = &mut self.plane {
            plane.forget();
        }
    }

    /// The number of sample points hidden from each texel, out of [`samples`](PlanarSoftShadowDescriptor::samples),
    /// as an 8-bit value (`R8Unorm`). Columns run along the rectangle's width, rows along its height.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.target.counts
    }

    /// The layout of [`bind_group`](Self::bind_group): the texture, a sampler, a uniform buffer, for fragment and
    /// compute shaders.
    pub fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        &self.receiver.layout
    }

    /// The bindings that receivers read. It never needs to be recreated.
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.receiver.group
    }

    /// WGSL for receivers, with the bindings of this bind group: `shadows_planar_visibility(world)` is the visible
    /// share of the light at a point of the rectangle in world space, 0 to 1. Outside the rectangle, and more than a
    /// texel's width above or below its plane, it is 1. For several in one shader, include
    /// [`wgsl::PLANAR_SOFT`](crate::wgsl::PLANAR_SOFT) once, and declare bindings of your own for each.
    pub fn wgsl_module(group: u32) -> String {
        format!(
            "{}
@group({group}) @binding(0) var shadows_planar_counts: texture_2d<f32>;
@group({group}) @binding(1) var shadows_planar_linear: sampler;
@group({group}) @binding(2) var<uniform> shadows_planar_rectangle: ShadowsPlanarSoft;

fn shadows_planar_visibility(world: vec3f) -> f32 {{
    return shadows_planar_soft(
        shadows_planar_counts,
        shadows_planar_linear,
        shadows_planar_rectangle,
        world,
    );
}}
",
            crate::wgsl::PLANAR_SOFT
        )
    }

    /// Statistics of the last [`prepare`](Self::prepare).
    pub fn statistics(&self) -> PlanarSoftStatistics {
        self.statistics
    }

    fn follow_casters(&mut self, device: &wgpu::Device, frame: &PlanarSoftFrame<'_>) {
        self.whereabouts.follow(&self.casters);
        let (corner, normal) = (frame.receiver.corner.as_dvec3(), frame.receiver.normal());
        let axes = PlaneAxes::of(corner, normal, self.whereabouts);
        let label = &self.label;
        let plane = self
            .plane
            .get_or_insert_with(|| PlaneCasters::new(device, label, axes));
        let to = (device, &mut self.uploads);
        let reordered = reorders(&self.casters);
        plane.update(to, axes, (&self.casters, frame.casters), reordered);
    }

    /// Lists what each place of the light casts.
    fn plan(&mut self, device: &wgpu::Device, frame: &PlanarSoftFrame<'_>) {
        let Some(plane) = &self.plane else { return };
        let uniform = SoftUniform::new(&frame.receiver, self.size, self.samples);
        self.uploads
            .write(&self.receiver.uniform, 0, bytemuck::bytes_of(&uniform));
        self.uniforms.reserve(device, self.samples as usize);
        let rows = clip_rows(&frame.receiver);
        let mut all = Vec::new();
        self.behind = 0;
        for (number, place) in (0..).zip(places(&frame.light, &frame.shape, self.samples)) {
            let Some(light) = PlaneLight::of_place(&plane.axes, place) else {
                self.behind += 1;
                continue;
            };
            let light = light.with_end_of(&frame.light);
            let moved = self.moved(rows, number);
            let uniform = PlanarUniform::of_rows(&moved, &plane.axes, &light, [0.0; 3]);
            self.uniforms.write(&mut self.uploads, all.len(), uniform);
            let counts = &mut PlanarStatistics::default();
            all.push(plane.draws(&self.casters, &light, counts));
        }
        let keys = all.iter().flatten().map(|draw| CastKey::new(draw, false));
        self.pipelines.make(device, keys);
        self.draws = Some(all);
    }

    /// The rows of clip space, moved within a texel.
    fn moved(&self, [x, y, z, w]: [DVec4; 4], number: u32) -> [DVec4; 4] {
        let texels = match self.jitter {
            true => DVec2::from_array(in_square(number).map(|part| 2.0 * part - 1.0)),
            false => DVec2::ZERO,
        };
        let [width, height] = self.size.map(f64::from);
        [x + texels.x / width * w, y + texels.y / height * w, z, w]
    }

    fn check_sizes(
        &self,
        device: &wgpu::Device,
        frame: &PlanarSoftFrame<'_>,
    ) -> Result<(), PlanarSoftShadowError> {
        let limit = largest_buffer(device);
        let casters = frame.casters.len() as u64 * INSTANCE_SIZE;
        let samples = DynamicUniforms::<PlanarUniform>::size(self.samples as usize);
        for (what, size) in [("casters", casters), ("samples", samples)] {
            if size > limit {
                return Err(PlanarSoftShadowError::TooMany { what, size, limit });
            }
        }
        Ok(())
    }

    fn count(&self) -> PlanarSoftStatistics {
        let draws = self.draws.iter().flatten().flatten();
        let plane = self.plane.as_ref().map_or(0, PlaneCasters::bytes);
        PlanarSoftStatistics {
            rendered: self.draws.is_some(),
            samples_behind: self.behind,
            draws: draws.clone().count() as u32,
            triangles: draws.map(CastDraw::triangles).sum(),
            bytes: self.target.bytes()
                + self.receiver.uniform.size()
                + self.uniforms.bytes()
                + plane,
            uploaded: self.uploads.bytes(),
            ..Default::default()
        }
    }
}
