//! Planar shadows in the host's passes: prepare, encode, render.

use super::axes::{PlaneAxes, Whereabouts};
use super::casters::{PlaneCasters, host_drawn, reorders};
use super::descriptor::PlanarShadowDescriptor;
use super::frame::{PlanarFrame, PlanarLight, PlanarOutline};
use super::gpu::{
    CastKey, CastPipelines, Marking, MarkingPipelines, OutlineGpu, PassFormats, PlanarUniform,
};
use super::pairs::Pair;
use super::statistics::PlanarStatistics;
use crate::error::{PlanarRenderError, PlanarShadowError};
use crate::map::{DynamicUniforms, INSTANCE_SIZE, largest_buffer};
use crate::scene::Casters;
use crate::submissions::Submissions;
use crate::uploads::Uploads;

/// Hard shadows on planes, exact at any distance and scale.
///
/// A frame of the host consists of:
/// 1. [`prepare`](Self::prepare) with lights, planes, views and casters, then [`encode`](Self::encode) outside
///    any pass, once each;
/// 2. a pass with a depth-stencil buffer whose [`shadow_bit`](PlanarShadowDescriptor::shadow_bit) and
///    [`outline_bit`](PlanarShadowDescriptor::outline_bit) are 0. In it, once the receivers have been drawn:
///    [`render`](Self::render) for each plane under one light;
/// 3. with [`PlanarOutput::Stencil`](crate::PlanarOutput::Stencil) the host's pass for that light, with
///    [`light_pass_stencil`](Self::light_pass_stencil);
/// 4. [`reset`](Self::reset), if there is another light, for which steps 2 to 4 repeat.
///
/// With a receiver marked by a [`Stencil`](PlanarOutline::Stencil) value, there are two ways to an exact result:
/// draw the receivers, then their shadows, then everything else; or draw everything, with a stencil value of 0
/// for whatever is not a receiver. A [`Polygon`](PlanarOutline::Polygon) is compared with the depth buffer, so
/// everything must have been drawn.
///
/// What has not changed costs nothing: in a frame with the same lights, planes, views and casters, nothing is uploaded.
/// Otherwise the upload for every plane is
/// - 48 bytes for each caster that moves (and for up to 16 that lie between two such, as another copy would cost
///   more), or for every caster if any is added, removed or changes its mesh;
/// - 112 bytes per view for each light that moves, and per light for each view that moves;
/// - 24 bytes for each triangle of a polygon that changes (two fewer than it has corners);
/// - all of that, if the plane changes, or if the casters as a whole move by about their own extent, because
///   positions on a plane are relative to a point near the casters.
///
/// # What it does not do
///
/// Casters receive no shadows, neither from each other nor from themselves, and nor does anything that is not a
/// plane. A light in a plane or behind it casts nothing there.
#[derive(Debug)]
pub struct PlanarShadow {
    label: String,
    descriptor: PlanarShadowDescriptor<'static>,
    casts: CastPipelines,
    markings: MarkingPipelines,
    uniforms: DynamicUniforms<PlanarUniform>,
    casters: Casters,
    whereabouts: Whereabouts,
    planes: Vec<Plane>,
    /// By light, then plane.
    pairs: Vec<Option<Pair>>,
    /// Lights, planes and views of the frame.
    counts: [usize; 3],
    uploads: Uploads,
    submissions: Submissions,
    statistics: PlanarStatistics,
    prepared: bool,
    encoded: bool,
}

/// A plane that receives.
#[derive(Debug)]
struct Plane {
    casters: PlaneCasters,
    outline: OutlineGpu,
    /// What the stencil holds where the receiver is and no shadow yet.
    reference: u8,
}

impl PlanarShadow {
    /// Creates the pipelines.
    ///
    /// # Errors
    /// [`PlanarShadowError`] if a format, a sample count or the bits are unsuitable, or if the device lacks a
    /// feature; the message names it.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &PlanarShadowDescriptor<'_>,
    ) -> Result<Self, PlanarShadowError> {
        descriptor.validate(device)?;
        let label = match descriptor.label {
            Some(name) => format!("shadows planar {name}"),
            None => "shadows planar".to_owned(),
        };
        let formats = PassFormats::new(&label, descriptor);
        let uniforms = DynamicUniforms::new(device, format!("{label} uniforms"), 1);
        let markings = MarkingPipelines::new(device, &formats, uniforms.layout(), descriptor);
        Ok(Self {
            casts: CastPipelines::new(device, &formats, uniforms.layout()),
            markings,
            uniforms,
            descriptor: PlanarShadowDescriptor {
                label: None,
                color_formats: &[],
                ..*descriptor
            },
            casters: Casters::default(),
            whereabouts: Whereabouts::default(),
            planes: Vec::new(),
            pairs: Vec::new(),
            counts: [0; 3],
            uploads: Uploads::new(device),
            submissions: Submissions::default(),
            statistics: PlanarStatistics::default(),
            prepared: false,
            encoded: false,
            label,
        })
    }

    /// Finds what each light casts on each plane, and stages uploads of what has changed. (Nothing is written
    /// through the queue, which is a parameter only because every `prepare` takes one.)
    ///
    /// # Errors
    /// [`PlanarShadowError`] if a light, plane, view or caster is invalid, or if the device's buffers cannot
    /// hold the frame. What the previous call prepared is then drawn.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        _queue: &wgpu::Queue,
        frame: &PlanarFrame<'_>,
    ) -> Result<(), PlanarShadowError> {
        frame.validate(&self.descriptor)?;
        check_sizes(device, frame)?;
        self.casters.compare(frame.casters, device)?;
        if let Some(index) = host_drawn(&self.casters, frame.casters) {
            return Err(PlanarShadowError::HostDrawn { index });
        }
        self.casters.update(frame.casters);
        let [not_encoded, encoder_dropped] = self.forget();
        self.follow_planes(device, frame);
        self.follow_lights(frame);
        self.write_uniforms(device, frame);
        self.make_pipelines(device);
        self.statistics = PlanarStatistics {
            not_encoded,
            encoder_dropped,
            ..self.count()
        };
        (self.prepared, self.encoded) = (true, false);
        Ok(())
    }

    /// Records the uploads of the last [`prepare`](Self::prepare). Does so once: a second call before the next
    /// `prepare` records nothing.
    ///
    /// The recorded work must be submitted; if the encoder is dropped instead, the next `prepare` uploads
    /// everything again ([`PlanarStatistics::encoder_dropped`]).
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.encoded = self.prepared;
        if self.uploads.record(encoder) {
            self.submissions.watch(encoder);
        }
    }

    /// Makes the next [`prepare`](Self::prepare) upload everything again, for a host that has lost recorded work
    /// in a way that cannot be detected here, such as a failed submission. Until that is encoded,
    /// [`render`](Self::render) returns [`PlanarRenderError::NotEncoded`].
    pub fn invalidate(&mut self) {
        (self.prepared, self.encoded) = (false, false);
        self.uploads.clear();
        self.uniforms.forget();
        for plane in &mut self.planes {
            plane.casters.forget();
            plane.outline.forget();
        }
    }

    /// Records the shadows of one light on one plane in one view, given by their indices in the frame, into the
    /// host's pass, which must have the formats and the sample count of the descriptor. Depth may be read-only; the
    /// stencil buffer is written.
    ///
    /// Changes the pass's pipeline, bind group 0, vertex buffers 0 to 2, index buffer and stencil reference, and
    /// nothing else.
    ///
    /// # Errors
    /// [`PlanarRenderError`] if [`encode`](Self::encode) has not been called since the last
    /// [`prepare`](Self::prepare), if its encoder was dropped, or if the frame had no such light, plane or view.
    /// Nothing is then drawn, so the picture has no shadow.
    pub fn render(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        light: usize,
        plane: usize,
        view: usize,
    ) -> Result<(), PlanarRenderError> {
        if !self.encoded {
            return Err(PlanarRenderError::NotEncoded);
        }
        if self.submissions.is_dropped() {
            return Err(PlanarRenderError::Dropped);
        }
        let asked = [("light", light), ("plane", plane), ("view", view)];
        for ((what, asked), count) in asked.into_iter().zip(self.counts) {
            if asked >= count {
                return Err(PlanarRenderError::NoSuch { what, asked, count });
            }
        }
        let pair = self.pairs[light * self.planes.len() + plane].as_ref();
        let Some(pair) = pair.filter(|pair| !pair.draws.is_empty()) else {
            return Ok(());
        };
        let index = self.uniform_index([light, plane, view]);
        self.draw(pass, pair, &self.planes[plane], index);
        Ok(())
    }

    /// Resets [`shadow_bit`](PlanarShadowDescriptor::shadow_bit) and
    /// [`outline_bit`](PlanarShadowDescriptor::outline_bit) to 0 in the whole viewport, so that the next light's
    /// shadows can be drawn in the same pass. The other bits, depth and colours are unchanged.
    ///
    /// Changes the pass's pipeline and nothing else. The scissor rectangle is the host's, and must contain
    /// everything that was drawn to.
    pub fn reset(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(self.markings.get(Marking::Reset));
        pass.draw(0..3, 0..1);
    }

    /// The stencil state for the host's light pass, drawn with
    /// [`set_stencil_reference(0)`](wgpu::RenderPass::set_stencil_reference).
    ///
    /// A fragment is shaded only where there is no shadow, and then marks its sample, so that light is never added
    /// twice. Only [`shadow_bit`](PlanarShadowDescriptor::shadow_bit) is read and written.
    pub fn light_pass_stencil(&self) -> wgpu::StencilState {
        let bit = u32::from(self.descriptor.shadow_bit);
        let face = wgpu::StencilFaceState {
            compare: wgpu::CompareFunction::Equal,
            fail_op: wgpu::StencilOperation::Keep,
            depth_fail_op: wgpu::StencilOperation::Keep,
            pass_op: wgpu::StencilOperation::Invert,
        };
        wgpu::StencilState {
            front: face,
            back: face,
            read_mask: bit,
            write_mask: bit,
        }
    }

    /// Statistics of the last [`prepare`](Self::prepare).
    pub fn statistics(&self) -> PlanarStatistics {
        self.statistics
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pair: &Pair, plane: &Plane, index: usize) {
        let Plane {
            casters,
            outline,
            reference,
        } = plane;
        let polygon = !outline.is_empty();
        self.uniforms.bind(pass, index);
        pass.set_stencil_reference(u32::from(*reference));
        let mark = |pass: &mut wgpu::RenderPass<'_>, marking| {
            if polygon {
                pass.set_pipeline(self.markings.get(marking));
                outline.draw(pass);
            }
        };
        mark(pass, Marking::Inside);
        mark(pass, Marking::Before);
        mark(pass, Marking::Behind);
        let mut current = None;
        for draw in &pair.draws {
            let key = CastKey::new(draw, polygon);
            let Some(pipeline) = self.casts.get(&key) else {
                continue; // prepare made one for every key
            };
            if current.replace(key) != Some(key) {
                pass.set_pipeline(pipeline);
            }
            draw.record(pass, casters.slice(draw));
        }
        mark(pass, Marking::Done);
    }

    /// What was found and not encoded, and what was recorded and dropped, is uploaded again.
    fn forget(&mut self) -> [bool; 2] {
        let dropped = self.submissions.take_dropped();
        let not_encoded = self.uploads.is_waiting();
        if dropped || not_encoded {
            self.invalidate();
        }
        [not_encoded, dropped]
    }

    fn follow_planes(&mut self, device: &wgpu::Device, frame: &PlanarFrame<'_>) {
        self.whereabouts.follow(&self.casters);
        let reordered = reorders(&self.casters);
        self.planes.truncate(frame.planes.len());
        for (index, receiver) in frame.planes.iter().enumerate() {
            let axes = PlaneAxes::new(receiver.point, receiver.normal, self.whereabouts);
            if index == self.planes.len() {
                self.planes.push(Plane {
                    casters: PlaneCasters::new(device, &self.label, axes),
                    outline: OutlineGpu::new(device, &self.label),
                    reference: 0,
                });
            }
            let plane = &mut self.planes[index];
            let to = (device, &mut self.uploads);
            let casters = (&self.casters, frame.casters);
            plane.casters.update(to, axes, casters, reordered);
            let (reference, polygon) = match receiver.outline {
                PlanarOutline::Stencil(value) => (value, &[][..]),
                PlanarOutline::Polygon(corners) => (self.descriptor.outline_bit, corners),
            };
            plane.reference = reference;
            let to = (device, &mut self.uploads);
            plane.outline.update(to, &axes, polygon);
        }
    }

    fn follow_lights(&mut self, frame: &PlanarFrame<'_>) {
        let (lights, planes) = (frame.lights.len(), self.planes.len());
        if self.counts[1] != planes {
            self.pairs.clear();
        }
        self.pairs.resize_with(lights * planes, || None);
        for (index, pair) in self.pairs.iter_mut().enumerate() {
            let light = &frame.lights[index / planes].light;
            let plane = &self.planes[index % planes].casters;
            let is_kept = |pair: &Pair| pair.is_of(light, plane, &self.casters);
            if !pair.as_ref().is_some_and(is_kept) {
                *pair = Some(Pair::new(light, plane, &self.casters));
            }
        }
    }

    fn write_uniforms(&mut self, device: &wgpu::Device, frame: &PlanarFrame<'_>) {
        self.counts = [frame.lights.len(), frame.planes.len(), frame.views.len()];
        self.uniforms.reserve(device, self.counts.iter().product());
        for (view, camera) in frame.views.iter().enumerate() {
            for (light, PlanarLight { shade, .. }) in frame.lights.iter().enumerate() {
                for (plane, Plane { casters, .. }) in self.planes.iter().enumerate() {
                    let pair = self.pairs[light * self.planes.len() + plane].as_ref();
                    let Some(seen) = pair.and_then(|pair| pair.seen.as_ref()) else {
                        continue;
                    };
                    let matrix = camera.clip_from_world();
                    let uniform = PlanarUniform::new(&matrix, &casters.axes, seen, *shade);
                    let index = self.uniform_index([light, plane, view]);
                    self.uniforms.write(&mut self.uploads, index, uniform);
                }
            }
        }
    }

    fn uniform_index(&self, [light, plane, view]: [usize; 3]) -> usize {
        let [lights, planes, _] = self.counts;
        (view * lights + light) * planes + plane
    }

    fn make_pipelines(&mut self, device: &wgpu::Device) {
        let planes = self.planes.len();
        let pairs = self.pairs.iter().enumerate();
        let keys = pairs.flat_map(|(index, pair)| {
            let polygon = !self.planes[index % planes].outline.is_empty();
            let draws = pair.iter().flat_map(|pair| &pair.draws);
            draws.map(move |draw| CastKey::new(draw, polygon))
        });
        self.casts.make(device, keys);
    }

    fn count(&self) -> PlanarStatistics {
        let mut all = PlanarStatistics {
            bytes: self.uniforms.bytes(),
            uploaded: self.uploads.bytes(),
            ..Default::default()
        };
        for plane in &self.planes {
            all.bytes += plane.casters.bytes() + plane.outline.bytes();
        }
        for (index, pair) in self.pairs.iter().enumerate() {
            let Some(Pair { counts, .. }) = pair else {
                continue;
            };
            all.casters_drawn += counts.casters_drawn;
            all.casters_cut += counts.casters_cut;
            all.casters_behind += counts.casters_behind;
            all.casters_beyond += counts.casters_beyond;
            all.casters_not_finite += counts.casters_not_finite;
            all.lights_behind += counts.lights_behind;
            all.triangles += counts.triangles;
            let outline = &self.planes[index % self.planes.len()].outline;
            let markings = 4 * u32::from(!outline.is_empty() && counts.draws > 0);
            all.draws += counts.draws + markings;
        }
        all
    }
}

/// Whether the device's buffers can hold a frame.
fn check_sizes(device: &wgpu::Device, frame: &PlanarFrame<'_>) -> Result<(), PlanarShadowError> {
    let limit = largest_buffer(device);
    let polygon = |outline| match outline {
        PlanarOutline::Stencil(_) => 0,
        PlanarOutline::Polygon(corners) => OutlineGpu::size(corners.len()),
    };
    let corners = frame.planes.iter().map(|plane| polygon(plane.outline));
    let lists = [frame.lights.len(), frame.planes.len(), frame.views.len()];
    let uniforms = lists
        .iter()
        .fold(1_usize, |all, &count| all.saturating_mul(count));
    let sizes = [
        ("casters", frame.casters.len() as u64 * INSTANCE_SIZE, limit),
        ("corners", corners.max().unwrap_or(0), limit),
        (
            "lights, planes and views",
            DynamicUniforms::<PlanarUniform>::size(uniforms),
            DynamicUniforms::<PlanarUniform>::most(device),
        ),
    ];
    match sizes.into_iter().find(|&(_, size, limit)| size > limit) {
        Some((what, size, limit)) => Err(PlanarShadowError::TooMany { what, size, limit }),
        None => Ok(()),
    }
}
