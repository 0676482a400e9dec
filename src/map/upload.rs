//! What a frame of a cube map uploads.

use super::cube::CubeShadowMap;
use super::descriptor::{Allocation, CubeFrame};
use super::face::CubeFace;
use super::light::{Depths, LightUniform};
use super::plan::SlotPlan;
use super::resources::{self, FaceUniform, INSTANCE_SIZE, UNIFORM_STRIDE};
use crate::PointLight;
use crate::error::CubeShadowMapError;

impl CubeShadowMap {
    /// Makes the instance buffer large enough.
    pub(super) fn reserve(
        &mut self,
        device: &wgpu::Device,
        plans: &[SlotPlan],
    ) -> Result<(), CubeShadowMapError> {
        let mut count = 0;
        for (slot, plan) in self.slots.iter().zip(plans) {
            for face in CubeFace::ALL {
                if plan.drawn & face.bit() != 0 {
                    count += slot.faces[face.layer() as usize].content.casters as usize;
                }
            }
        }
        let limit = device.limits().max_buffer_size;
        let size = count as u64 * INSTANCE_SIZE;
        if size > limit {
            return Err(CubeShadowMapError::TooManyCasters {
                instances: count,
                size,
                limit,
            });
        }
        if size > self.instances.size() {
            let room = (count.next_power_of_two() as u64).min(limit / INSTANCE_SIZE);
            self.instances = resources::instances(device, &self.label, room);
        }
        Ok(())
    }

    pub(super) fn record_draws(
        &mut self,
        device: &wgpu::Device,
        plans: &[SlotPlan],
        frame: &CubeFrame<'_>,
    ) {
        self.draws.clear();
        for (index, plan) in plans.iter().enumerate() {
            if plan.drawn == 0 {
                continue;
            }
            self.choose_ways(device, index, plan.drawn);
            let slot = &self.slots[index];
            self.draws.add(
                index,
                slot,
                plan.drawn,
                self.near_plane,
                &self.scene,
                frame.casters,
            );
            if let Some(light) = slot.light {
                self.write_faces(index, &light);
            }
        }
        for draw in self.draws.iter() {
            let key = draw.key();
            self.pipelines
                .entry(key)
                .or_insert_with(|| resources::pipeline(device, &self.label, &self.kind, key));
        }
        let bytes = bytemuck::cast_slice(&self.draws.instances);
        self.uploads.write(&self.instances, 0, bytes);
    }

    /// Forgets what was to be written, and what has been.
    pub(super) fn forget_uploads(&mut self) {
        self.uploads.clear();
        self.written_lights.fill(None);
        self.written_faces.fill(None);
    }

    /// Gives the lights other buffers, once bind groups of the old ones must be made again. Those that
    /// are not read a light without range, which is dark, for good: better that than shadows that are
    /// not there, or are somebody else's.
    pub(super) fn replace_lights(&mut self, device: &wgpu::Device, queue: &wgpu::Queue) {
        let revision = self.texture_revision();
        if std::mem::replace(&mut self.lights_revision, revision) == revision {
            return;
        }
        for old in std::iter::once(&self.lights.uniforms).chain(&self.lights.all) {
            queue.write_buffer(old, 0, &vec![0; old.size() as usize]);
        }
        self.lights = resources::lights(device, &self.label, self.slots.len() as u64, self.array);
        self.written_lights.fill(None);
    }

    fn write_faces(&mut self, slot: usize, light: &PointLight) {
        let near = self.near_plane.of_point(light);
        let content = Some([near, light.range]);
        if self.written_faces[slot] == content {
            return;
        }
        self.written_faces[slot] = content;
        for face in CubeFace::ALL {
            let uniform = FaceUniform {
                clip_from_light: face.clip_from_light(near).to_cols_array(),
                range: light.range,
                texel: 2.0 / self.size as f32,
                padding: [0.0; 2],
            };
            let offset = (slot as u64 * 6 + u64::from(face.layer())) * UNIFORM_STRIDE;
            let bytes = bytemuck::bytes_of(&uniform);
            self.uploads.write(&self.face_uniforms, offset, bytes);
        }
    }

    pub(super) fn write_lights(&mut self, lights: &[PointLight]) {
        for (place, wanted) in lights.iter().enumerate() {
            let index = self.order[place];
            let slot = &self.slots[index];
            let depths = match (self.textures.slot(index), slot.shown) {
                (None, _) => Depths::NoCaster,
                (Some(_), Some(shown))
                    if slot.casting == 0
                        && shown == *wanted
                        && self.allocation == Allocation::WithFirstCaster =>
                {
                    Depths::NoCaster
                }
                (Some(_), Some(_)) if self.array => Depths::Cube(index as i32),
                (Some(_), Some(_)) => Depths::Cube(0),
                (Some(_), None) => Depths::NotYet,
            };
            let light = slot.shown.unwrap_or(*wanted);
            let near = self.near_plane.of_point(&light);
            let (size, bias, format) = (self.size, &self.bias, self.format);
            let uniform = LightUniform::new(&light, near, depths, size, bias, format);
            if self.written_lights[place] == Some(uniform) {
                continue;
            }
            self.written_lights[place] = Some(uniform);
            let bytes = bytemuck::bytes_of(&uniform);
            let (at, at_all) = (place as u64 * UNIFORM_STRIDE, (place * bytes.len()) as u64);
            self.uploads.write(&self.lights.uniforms, at, bytes);
            if let Some(all) = &self.lights.all {
                self.uploads.write(all, at_all, bytes);
            }
        }
    }
}
