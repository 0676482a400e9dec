//! What a frame of a flat map draws and uploads.

use glam::DAffine3;

use super::draws::{Cull, Draw, instance};
use super::flat::ShadowMap;
use super::flat_content::{Asked, Content, Texels};
use super::flat_descriptor::{FlatLight, FlatLightUniform, ShadowFrame, ShadowMapStatistics};
use super::flat_frame::{Fit, FlatFrame, LightBox, fit};
use super::resources::{self, FaceUniform, INSTANCE_SIZE};
use super::texture;
use crate::DirectionalLight;
use crate::error::ShadowMapError;
use crate::mesh::Caster;

impl ShadowMap {
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
        let limit = device.limits().max_buffer_size;
        let size = frame.casters.len() as u64 * INSTANCE_SIZE;
        if size > limit {
            let casters = frame.casters.len();
            return Err(ShadowMapError::TooManyCasters {
                casters,
                size,
                limit,
            });
        }
        self.scene.compare(frame.casters, device)?;
        self.look(frame)?;

        let encoder_dropped = self.submissions.take_dropped();
        if encoder_dropped {
            self.invalidate();
        }
        let not_encoded = self.pending || self.uploads.bytes() > 0;
        if not_encoded {
            self.forget_uploads();
        }
        let texels = self.wanted.on_texels();
        let kept = texels == self.texels && (self.cache || texels == Texels::Clear);
        self.pending = !kept;
        self.draws.clear();
        if self.pending {
            self.gather(device, frame.casters);
        }
        self.tell_receivers();
        self.statistics = ShadowMapStatistics {
            not_encoded,
            encoder_dropped,
            ..self.count(frame.casters.len())
        };
        Ok(())
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

    /// Takes over the frame's casters and light, if they are not what they were.
    fn look(&mut self, frame: &ShadowFrame<'_>) -> Result<(), ShadowMapError> {
        let asked = Asked::of(frame);
        let still = self.scene.is_still(frame.casters);
        if still && self.asked == Some(asked) {
            return Ok(());
        }
        // Until all of it has succeeded, nothing is known to be what it was.
        let known = self.asked.take().is_some() && still;
        if !still {
            self.scene.update(frame.casters, &mut []);
            self.caster_box = None;
        }
        let before = self.frame;
        self.place(frame)?;
        if !known || self.frame != before {
            self.wanted = Content::of(self.frame, self.scene.records());
        }
        self.asked = Some(asked);
        Ok(())
    }

    /// Where the map lies for a frame, if anything casts.
    fn place(&mut self, frame: &ShadowFrame<'_>) -> Result<(), ShadowMapError> {
        let (placed, width) = match &frame.light {
            FlatLight::Spot(light) => {
                let near = self.near_plane.of_spot(light);
                (Some(FlatFrame::of_spot(light, near)), self.width)
            }
            FlatLight::Directional(light) => fit(&Fit {
                light,
                view: frame.view,
                receivers: frame.receivers,
                size: self.size,
                reach: self.reach,
                unclipped_depth: self.kind.unclipped_depth,
                last_width: self.width,
                casters: self.caster_box(light),
            })
            .unzip(),
        };
        if placed.is_some_and(|frame| !frame.fits_f32()) {
            return Err(ShadowMapError::BeyondF32);
        }
        (self.frame, self.width) = (placed, width);
        Ok(())
    }

    /// The box around all casters as a light sees them, which a camera that moves does not change.
    fn caster_box(&mut self, light: &DirectionalLight) -> Option<LightBox> {
        match self.caster_box {
            Some((of, known)) if of == *light => known,
            _ => {
                let found = LightBox::of_casters(light, self.scene.records());
                self.caster_box = Some((*light, found));
                found
            }
        }
    }

    /// The draws of the casters on the map, one for each mesh, and their instances.
    fn gather(&mut self, device: &wgpu::Device, casters: &[Caster]) {
        let Some(frame) = self.frame else { return };
        let light_from_world = DAffine3::from_translation(-frame.origin.as_dvec3());
        let sides = self.scene.sides();
        let records = self.scene.records().iter().zip(casters).enumerate();
        let mut members: Vec<_> = records
            .filter(|(_, (record, _))| frame.holds(record))
            .map(|(index, (record, caster))| {
                let cull = Cull::of(sides, record, frame.is_clear_of(record));
                (record.group, cull, index, caster)
            })
            .collect();
        members.sort_unstable_by_key(|&(group, cull, index, _)| (group, cull, index));
        let mut rows = Vec::with_capacity(members.len());
        for run in members.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let Some(group) = self.scene.group(run[0].0) else {
                continue; // every record's group exists
            };
            self.draws.push(Draw {
                mesh: group.mesh.clone(),
                cull: run[0].1.face(),
                first_instance: rows.len() as u64,
                instance_count: run.len() as u32,
            });
            let transforms = run.iter().map(|(.., caster)| caster.transform());
            rows.extend(transforms.map(|transform| instance(&(light_from_world * transform))));
        }
        if rows.len() as u64 * INSTANCE_SIZE > self.instances.size() {
            self.instances = resources::instances(device, &self.label, rows.len() as u64);
        }
        let bytes = bytemuck::cast_slice(&rows);
        self.uploads.write(&self.instances, 0, bytes);
        for draw in &self.draws {
            let key = draw.key();
            self.pipelines
                .entry(key)
                .or_insert_with(|| resources::pipeline(device, &self.label, &self.kind, key));
        }
        self.write_face(&frame);
    }

    fn write_face(&mut self, frame: &FlatFrame) {
        let face = FaceUniform {
            clip_from_light: frame.clip_from_light().to_cols_array(),
            range: frame.range,
            texel: 2.0 / self.size as f32,
            padding: [0.0; 2],
        };
        if self.written_face.replace(face) != Some(face) {
            self.uploads.write(&self.face, 0, bytemuck::bytes_of(&face));
        }
    }

    fn tell_receivers(&mut self) {
        let (frame, format) = (self.frame.as_ref(), self.texture.format());
        let light = FlatLightUniform::new(frame, &self.bias, self.size, format);
        if self.written_light.replace(light) != Some(light) {
            self.uploads
                .write(&self.light, 0, bytemuck::bytes_of(&light));
        }
    }

    /// Forgets what was to be written, and what has been.
    pub(super) fn forget_uploads(&mut self) {
        self.uploads.clear();
        self.written_light = None;
        self.written_face = None;
    }

    fn count(&self, casters: usize) -> ShadowMapStatistics {
        let drawn = self.wanted.casters();
        ShadowMapStatistics {
            rendered: self.pending,
            casters_drawn: drawn,
            casters_outside: casters as u32 - drawn,
            draws: self.draws.len() as u32,
            triangles: self.draws.iter().map(Draw::triangles).sum(),
            bytes: u64::from(self.size).pow(2) * texture::texel_bytes(self.texture.format())
                + self.instances.size()
                + self.face.size()
                + self.light.size(),
            uploaded: self.uploads.bytes(),
            ..Default::default()
        }
    }
}
