//! Shadows of ellipsoids.

use super::buffer::BlobBuffer;
use super::decals::Decals;
use super::descriptor::BlobShadowDescriptor;
use super::ellipsoid::Blob;
use super::frame::BlobFrame;
use super::receivers::{self, Receivers};
use super::records::{LightRecord, STRIDE, ViewRecord};
use super::statistics::BlobStatistics;
use crate::error::{BlobRenderError, BlobShadowError};
use crate::map::buffer;
use crate::scene::Casters;
use crate::submissions::Submissions;
use crate::uploads::Uploads;

/// Soft shadows of thousands of casters, each approximated by an ellipsoid.
///
/// The share of a light's disk that an ellipsoid covers is computed analytically at each receiver: there is no
/// texture, no resolution and no bias, and the penumbra follows from the light's size and distance. What is
/// approximate is the shape. For a caster that is an ellipsoid, the shadow is accurate to a hundredth; that of
/// a box looks like a box's only from afar. `docs/survey.md` has the figures.
///
/// The shadows of several blobs are multiplied: correct if they cover parts of the light independently, too dark
/// by up to a quarter if two cover the same half of it, and too light by as much if they cover opposite halves.
/// (Area overlap of a light and a blocking sphere as the measure of a soft shadow: Oat and Sander, "Ambient
/// Aperture Lighting", 2007; here for ellipsoids, by quadrature.)
///
/// # Two ways to apply it
///
/// - **Decals** ([`render`](Self::render)): one instanced draw for all blobs, over the host's depth, which
///   multiplies a target. Each blob costs only the pixels that its shadow can reach. For thousands of blobs.
/// - **A function** ([`wgsl_module`](Self::wgsl_module)): `shadows_blob_visibility(light, position)` for the
///   host's shader, which needs no depth buffer and no pass, but evaluates every blob at every pixel. For
///   dozens of blobs.
///
/// A caster's own surface lies in and around its ellipsoid, which darkens the parts of it that face away from
/// the light. Draw decals before the casters are in the depth buffer, or call
/// `shadows_blob_visibility_of(light, position, own)` for casters, which leaves out their own blob.
///
/// # What is uploaded
///
/// Unchanged casters, at the same place in the list, are neither checked nor computed again; unchanged ellipsoids,
/// lights and views are not uploaded. In a frame without changes, nothing is uploaded.
#[derive(Debug)]
pub struct BlobShadow {
    label: String,
    strips: u32,
    /// At most: lights, views.
    most: [u32; 2],
    casters: Casters,
    blobs: BlobBuffer,
    lights: Records<LightRecord>,
    views: Records<ViewRecord>,
    decals: Option<Decals>,
    receivers: Option<Receivers>,
    uploads: Uploads,
    submissions: Submissions,
    /// Of the frame: lights, views. `None` before there is one, and after `invalidate`.
    prepared: Option<[usize; 2]>,
    statistics: BlobStatistics,
}

impl BlobShadow {
    /// Creates the pipelines and buffers.
    ///
    /// # Errors
    /// [`BlobShadowError`] if a count or a format is out of range.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &BlobShadowDescriptor<'_>,
    ) -> Result<Self, BlobShadowError> {
        descriptor.validate(device)?;
        let label = match descriptor.label {
            Some(label) => format!("shadows blobs {label}"),
            None => "shadows blobs".to_owned(),
        };
        let blobs = BlobBuffer::new(device, &label, descriptor.receivers);
        let lights = Records::new(device, &label, descriptor.lights);
        let receivers = descriptor
            .receivers
            .then(|| Receivers::new(device, &label, &lights.buffer, blobs.buffer()));
        let decals = descriptor.decals.as_ref();
        Ok(Self {
            strips: descriptor.strips,
            most: [descriptor.lights, descriptor.views],
            decals: decals.map(|decals| Decals::new(device, &label, descriptor, decals)),
            receivers,
            views: Records::new(device, &label, descriptor.views),
            lights,
            casters: Casters::default(),
            blobs,
            uploads: Uploads::new(device),
            submissions: Submissions::default(),
            prepared: None,
            statistics: BlobStatistics::default(),
            label,
        })
    }

    /// Finds what has changed and stages it. (Nothing is written through the queue, which is a parameter only
    /// because every `prepare` takes one.)
    ///
    /// # Errors
    /// [`BlobShadowError`] if a light, a caster or a blob is out of range, or if there are too many; the
    /// previous result then remains in force.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        _: &wgpu::Queue,
        frame: &BlobFrame<'_>,
    ) -> Result<(), BlobShadowError> {
        frame.validate(self.most)?;
        let (count, limit) = (frame.len(), self.blobs.most(device));
        if count as u64 > limit {
            return Err(BlobShadowError::TooManyBlobs { count, limit });
        }
        self.casters.compare(frame.casters, device)?;
        self.casters.update(frame.casters);
        let encoder_dropped = self.submissions.take_dropped();
        let not_encoded = self.uploads.is_waiting();
        if not_encoded || encoder_dropped {
            self.forget();
        }
        if self.blobs.reserve(device, count)
            && let Some(receivers) = &mut self.receivers
        {
            receivers.rebind(device, &self.lights.buffer, self.blobs.buffer());
        }
        let changed = self.write_blobs(frame);
        let lights = frame.lights.iter().map(LightRecord::new);
        let no_more = std::iter::repeat(LightRecord::NONE);
        let lights = lights.chain(no_more).take(self.most[0] as usize);
        self.lights.write(&mut self.uploads, lights);
        let views = frame.views.iter().map(ViewRecord::new);
        self.views.write(&mut self.uploads, views);
        self.prepared = Some([frame.lights.len(), frame.views.len()]);
        self.statistics = BlobStatistics {
            blobs: self.blobs.len(),
            without_shadow: self.blobs.without_shadow(),
            changed,
            uploaded: self.uploads.bytes(),
            bytes: self.blobs.buffer().size()
                + self.lights.buffer.size()
                + self.views.buffer.size(),
            not_encoded,
            encoder_dropped,
        };
        Ok(())
    }

    /// Records the copies to the GPU that the last [`prepare`](Self::prepare) staged, once. They must be
    /// submitted before any work that draws decals or reads the blobs.
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if self.uploads.record(encoder) {
            self.submissions.watch(encoder);
        }
    }

    /// Makes the next [`prepare`](Self::prepare) upload everything again, for a host that has lost recorded work
    /// in a way that cannot be detected here, such as a failed submission. Until that is encoded,
    /// [`render`](Self::render) returns [`BlobRenderError::NotEncoded`].
    pub fn invalidate(&mut self) {
        self.prepared = None;
        self.forget();
    }

    /// A bind group through which decals read the host's depth texture, which holds the surfaces to be
    /// darkened. It remains valid as long as the host uses this texture. The whole texture must correspond to
    /// the view.
    ///
    /// # Errors
    /// [`BlobShadowError::Depth`] if it is not a depth texture of one layer and one sample with
    /// `TEXTURE_BINDING`; [`BlobShadowError::NoDecals`] if the descriptor requested no decals.
    pub fn decal_bind_group(
        &self,
        device: &wgpu::Device,
        depth: &wgpu::TextureView,
    ) -> Result<wgpu::BindGroup, BlobShadowError> {
        let decals = self.decals.as_ref().ok_or(BlobShadowError::NoDecals)?;
        let buffers = [&self.views.buffer, &self.lights.buffer];
        decals.group(device, &self.label, buffers, depth)
    }

    /// Draws all blobs for one of the frame's lights in one of its views: one instanced draw, which multiplies
    /// the pass's target by the visibility. The pass must match
    /// [`BlobDecalDescriptor`](crate::BlobDecalDescriptor), and its viewport must be the whole picture.
    /// Replaces the pass's bind group 0, vertex buffer 0 and index buffer.
    ///
    /// # Errors
    /// [`BlobRenderError`] if the prepared data has not been encoded, or if the frame has no such light or
    /// view. Nothing is then drawn.
    pub fn render(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        light: usize,
        view: usize,
        depth: &wgpu::BindGroup,
    ) -> Result<(), BlobRenderError> {
        let Some(decals) = &self.decals else {
            return Err(BlobRenderError::NoDecals);
        };
        let prepared = self.prepared.filter(|_| !self.uploads.is_waiting());
        let Some([lights, views]) = prepared else {
            return Err(BlobRenderError::NotEncoded);
        };
        if self.submissions.is_dropped() {
            return Err(BlobRenderError::Dropped);
        }
        if light >= lights || view >= views {
            return Err(BlobRenderError::NoSuch {
                light,
                view,
                lights,
                views,
            });
        }
        if self.blobs.len() > 0 {
            let instances = (self.blobs.instances(), self.blobs.len());
            decals.draw(pass, depth, [view, light], instances);
        }
        Ok(())
    }

    /// WGSL for the host's shader, whose bind group `group` is [`bind_group`](Self::bind_group):
    ///
    /// - `shadows_blob_visibility(light: u32, position: vec3f) -> f32`, 1 lit, 0 in shadow; `position` in world
    ///   space;
    /// - `shadows_blob_visibility_of(light: u32, position: vec3f, own: u32) -> f32`, the same without the shadow
    ///   of one blob, given by its index in the frame (casters first).
    ///
    /// `light` is the light's index in the frame. An index without a light gives no shadow as long as it is below
    /// [`BlobShadowDescriptor::lights`](crate::BlobShadowDescriptor::lights), the length of the array that the
    /// module reads; beyond that, WGSL may read any light of the array.
    pub fn wgsl_module(&self, group: u32) -> String {
        receivers::source(self.strips, self.most[0], group)
    }

    /// Layout of [`bind_group`](Self::bind_group), for fragment and compute shaders; `None` if
    /// [`BlobShadowDescriptor::receivers`](crate::BlobShadowDescriptor::receivers) is false.
    pub fn bind_group_layout(&self) -> Option<&wgpu::BindGroupLayout> {
        Some(self.receivers.as_ref()?.layout())
    }

    /// The bindings that the host's shader reads. Fetch it after every [`prepare`](Self::prepare), which may
    /// recreate it. `None` under the same condition as [`bind_group_layout`](Self::bind_group_layout).
    pub fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        Some(self.receivers.as_ref()?.group())
    }

    /// Statistics of the last [`prepare`](Self::prepare).
    pub fn statistics(&self) -> BlobStatistics {
        self.statistics
    }

    /// Those of the casters first, as far as they changed.
    fn write_blobs(&mut self, frame: &BlobFrame<'_>) -> u32 {
        let casters = frame.casters;
        let changes = self.casters.changes();
        let changed = changes.filter_map(|change| {
            let caster = casters.get(change.index)?;
            Some((change.index, Blob::of_caster(caster)))
        });
        let blobs = (casters.len()..).zip(frame.blobs.iter().copied());
        self.blobs
            .write(&mut self.uploads, frame.len(), changed.chain(blobs))
    }

    fn forget(&mut self) {
        self.uploads.clear();
        self.blobs.forget();
        self.lights.written.clear();
        self.views.written.clear();
    }
}

/// A uniform buffer of records that are told apart by dynamic offsets.
#[derive(Debug)]
struct Records<T> {
    buffer: wgpu::Buffer,
    /// What it holds once the uploads are recorded.
    written: Vec<T>,
}

impl<T: bytemuck::Pod + PartialEq> Records<T> {
    fn new(device: &wgpu::Device, label: &str, count: u32) -> Self {
        Self {
            buffer: buffer(
                device,
                label,
                u64::from(count) * STRIDE,
                wgpu::BufferUsages::UNIFORM,
            ),
            written: Vec::new(),
        }
    }

    fn write(&mut self, uploads: &mut Uploads, records: impl Iterator<Item = T>) {
        for (at, record) in records.enumerate() {
            if self.written.get(at) == Some(&record) {
                continue;
            }
            uploads.write(
                &self.buffer,
                at as u64 * STRIDE,
                bytemuck::bytes_of(&record),
            );
            match self.written.get_mut(at) {
                Some(old) => *old = record,
                None => self.written.push(record),
            }
        }
    }
}
