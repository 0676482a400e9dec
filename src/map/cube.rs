//! Omnidirectional shadow maps.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU8, Ordering};

use glam::Mat4;

use super::cull::{Group, INSTANCE_SIZE, sort_into_faces};
use super::face::CubeFace;
use super::resources::{self, MATRIX_STRIDE};
use crate::error::CubeShadowMapError;
use crate::mesh::{Caster, CasterMesh};
use crate::{Bias, PointLight};

/// A mask of all six faces.
const ALL_FACES: u8 = 0b11_1111;
/// How to make a [`CubeShadowMap`].
#[derive(Clone, Debug)]
pub struct CubeShadowMapDescriptor<'a> {
    /// Name of the map in debuggers. Default none.
    pub label: Option<&'a str>,
    /// Texels along each side of a face. Default 1024. 1 to the device's
    /// `max_texture_dimension_2d`. Memory: 24 bytes a texel (six faces of 4 bytes).
    pub size: u32,
    /// Bias for receivers. Default [`Bias::default`], which needs no tuning.
    pub bias: Bias,
}

impl Default for CubeShadowMapDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            size: 1024,
            bias: Bias::default(),
        }
    }
}

/// What a [`CubeShadowMap`] is to show this frame.
#[derive(Clone, Copy, Debug)]
pub struct CubeFrame<'a> {
    /// The light.
    pub light: &'a PointLight,
    /// Everything that may cast; what the light cannot reach is left out by the map itself.
    pub casters: &'a [Caster],
}

/// What the last [`CubeShadowMap::prepare`] found and the next `encode` will do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CubeStatistics {
    /// Faces that will be drawn or cleared.
    pub faces_rendered: u32,
    /// Faces without a caster that are clear already and left alone.
    pub faces_kept_clear: u32,
    /// Casters that touch at least one face.
    pub casters_drawn: u32,
    /// Casters beyond the light's range.
    pub casters_out_of_range: u32,
    /// Draw calls.
    pub draws: u32,
    /// Triangles in those draws.
    pub triangles: u64,
    /// GPU memory held: texture and buffers.
    pub bytes: u64,
}

/// An omnidirectional depth map for one point light: six faces, drawn only where a caster is.
///
/// `Depth32Float`, infinite reverse-Z: a texel holds `near / d`, where `d` is the distance along
/// the face's major axis, and 0 where no caster is. That is linear over a face for any plane,
/// which is what lets [`PcfSampler`](crate::PcfSampler) compare every tap with the receiver's own
/// plane. (Cube maps for point lights: Gerasimov, "Omnidirectional Shadow Mapping", GPU Gems,
/// 2004.)
#[derive(Debug)]
pub struct CubeShadowMap {
    size: u32,
    bias: Bias,
    label: String,
    cube: wgpu::TextureView,
    faces: [wgpu::TextureView; 6],
    shader: wgpu::ShaderModule,
    pipeline_layout: wgpu::PipelineLayout,
    // One for each distance between positions that a mesh came with.
    pipelines: HashMap<u64, wgpu::RenderPipeline>,
    matrices: wgpu::Buffer,
    matrix_group: wgpu::BindGroup,
    light_uniform: wgpu::Buffer,
    instances: wgpu::Buffer,
    draws: [Vec<Draw>; 6],
    light: Option<PointLight>,
    statistics: CubeStatistics,
    // Faces that the next encode must draw, and faces that may hold something. They change in
    // `encode` and `begin_face`, which borrow the map shared as a host's frame graph wants it.
    pending: AtomicU8,
    filled: AtomicU8,
}

/// One draw call: a mesh, and where its instances lie.
#[derive(Clone, Debug)]
struct Draw {
    mesh: CasterMesh,
    first_instance: u64,
    instance_count: u32,
}

/// What receivers need to know of the light; `ShadowsCubeLight` in WGSL.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct LightUniform {
    pub position: [f32; 3],
    pub near: f32,
    pub range: f32,
    pub size: f32,
    pub normal_offset: f32,
    pub depth_scale: f32,
}

impl CubeShadowMap {
    /// Allocates a map.
    ///
    /// # Errors
    /// [`CubeShadowMapError`] if the size or the bias is out of range.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &CubeShadowMapDescriptor<'_>,
    ) -> Result<Self, CubeShadowMapError> {
        let &CubeShadowMapDescriptor { label, size, bias } = descriptor;
        let limit = device.limits().max_texture_dimension_2d;
        if size == 0 || size > limit {
            return Err(CubeShadowMapError::Size { size, limit });
        }
        bias.validate()?;
        let label = match label {
            Some(label) => format!("shadows cube map {label}"),
            None => "shadows cube map".to_owned(),
        };
        let texture = resources::texture(device, &label, size);
        let (matrices, layout, matrix_group) = resources::matrices(device, &label);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(&label),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        Ok(Self {
            size,
            bias,
            cube: resources::cube_view(&texture, &label),
            faces: CubeFace::ALL.map(|face| resources::face_view(&texture, &label, face)),
            shader: device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(&label),
                source: wgpu::ShaderSource::Wgsl(crate::wgsl::CUBE_CASTER.into()),
            }),
            pipeline_layout,
            pipelines: HashMap::new(),
            matrices,
            matrix_group,
            light_uniform: resources::light_uniform(device, &label),
            instances: resources::instances(device, &label, 1),
            label,
            draws: Default::default(),
            light: None,
            statistics: CubeStatistics::default(),
            pending: AtomicU8::new(0),
            // A new texture's content is unknown until each face has been cleared once.
            filled: AtomicU8::new(ALL_FACES),
        })
    }

    /// Decides which casters go on which faces and uploads what drawing them needs.
    ///
    /// # Errors
    /// [`CubeShadowMapError`] if the light or a caster is out of range; the map is then as it was.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        frame: &CubeFrame<'_>,
    ) -> Result<(), CubeShadowMapError> {
        frame.light.validate()?;
        for (index, caster) in frame.casters.iter().enumerate() {
            caster.validate(index, device)?;
        }
        let (groups, mut statistics) = sort_into_faces(frame);
        let count: usize = groups.iter().flat_map(|g| &g.faces).map(Vec::len).sum();
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
            self.instances = resources::instances(device, &self.label, count.next_power_of_two());
        }
        self.make_pipelines(device, &groups);
        self.record_draws(queue, groups);
        self.write_light(queue, frame.light);
        let drawn = (0..6)
            .filter(|&face| !self.draws[face].is_empty())
            .fold(0, |mask, face| mask | 1 << face);
        let pending = drawn | self.filled.load(Ordering::Relaxed);
        self.pending.store(pending, Ordering::Relaxed);

        statistics.faces_rendered = pending.count_ones();
        statistics.faces_kept_clear = 6 - pending.count_ones();
        for draw in self.draws.iter().flatten() {
            statistics.draws += 1;
            statistics.triangles +=
                u64::from(draw.mesh.triangle_count()) * u64::from(draw.instance_count);
        }
        statistics.bytes = u64::from(self.size).pow(2) * 24
            + self.instances.size()
            + self.matrices.size()
            + self.light_uniform.size();
        self.statistics = statistics;
        Ok(())
    }

    /// Records the passes that the last [`prepare`](Self::prepare) found necessary; once: a second
    /// call before the next `prepare` records nothing. What is recorded must be submitted.
    pub fn encode(&self, encoder: &mut wgpu::CommandEncoder) {
        let pending = self.pending.swap(0, Ordering::Relaxed);
        for face in CubeFace::ALL {
            if pending & face.bit() == 0 {
                continue;
            }
            let draws = &self.draws[face.layer() as usize];
            let mut pass = self.begin_pass(encoder, face);
            pass.set_bind_group(
                0,
                &self.matrix_group,
                &[face.layer() * MATRIX_STRIDE as u32],
            );
            for draw in draws {
                self.draw(&mut pass, draw);
            }
            if draws.is_empty() {
                self.filled.fetch_and(!face.bit(), Ordering::Relaxed);
            } else {
                self.filled.fetch_or(face.bit(), Ordering::Relaxed);
            }
        }
    }

    /// Begins a pass that clears one face, for a host that draws its own geometry (skinned,
    /// alpha-tested) with [`clip_from_world`](Self::clip_from_world): `Depth32Float`, one sample,
    /// depth compare `Greater`.
    ///
    /// Call it after [`encode`](Self::encode) (or instead of it): what `encode` drew on this face
    /// is cleared, so pass such a host's other casters through its own draws too.
    pub fn begin_face<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        face: CubeFace,
    ) -> wgpu::RenderPass<'encoder> {
        self.pending.fetch_and(!face.bit(), Ordering::Relaxed);
        self.filled.fetch_or(face.bit(), Ordering::Relaxed);
        self.begin_pass(encoder, face)
    }

    /// The matrix of a face for the light of the last [`prepare`](Self::prepare), world space to
    /// clip space; `None` before the first. The frame is left-handed: triangles that are
    /// counter-clockwise seen from the light are clockwise on the face.
    pub fn clip_from_world(&self, face: CubeFace) -> Option<Mat4> {
        let light = self.light?;
        Some(face.clip_from_light(light.near) * Mat4::from_translation(-light.position))
    }

    /// The map as a cube texture, for hosts that sample it themselves.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.cube
    }

    /// One face of the map, as a 2D texture.
    pub fn face_view(&self, face: CubeFace) -> &wgpu::TextureView {
        &self.faces[face.layer() as usize]
    }

    /// Texels along each side of a face.
    pub fn size(&self) -> u32 {
        self.size
    }

    /// What the last [`prepare`](Self::prepare) found.
    pub fn statistics(&self) -> CubeStatistics {
        self.statistics
    }

    pub(crate) fn light_uniform(&self) -> &wgpu::Buffer {
        &self.light_uniform
    }

    fn begin_pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        face: CubeFace,
    ) -> wgpu::RenderPass<'encoder> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&format!("{} {face:?}", self.label)),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: self.face_view(face),
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, draw: &Draw) {
        let (stride, offset) = draw.mesh.layout();
        let Some(pipeline) = self.pipelines.get(&stride) else {
            return; // prepare made one for every stride
        };
        let size = u64::from(draw.instance_count) * INSTANCE_SIZE;
        let first = draw.first_instance * INSTANCE_SIZE;
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, draw.mesh.positions().slice(offset..));
        // Sliced rather than drawn from a first instance, which GL does not have.
        pass.set_vertex_buffer(1, self.instances.slice(first..first + size));
        pass.set_index_buffer(draw.mesh.triangles().slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..draw.mesh.triangle_count() * 3, 0, 0..draw.instance_count);
    }

    fn make_pipelines(&mut self, device: &wgpu::Device, groups: &[Group]) {
        for group in groups {
            let (stride, _) = group.mesh.layout();
            self.pipelines.entry(stride).or_insert_with(|| {
                resources::pipeline(
                    device,
                    &self.label,
                    &self.pipeline_layout,
                    &self.shader,
                    stride,
                )
            });
        }
    }

    fn record_draws(&mut self, queue: &wgpu::Queue, groups: Vec<Group>) {
        let mut instances = Vec::new();
        self.draws = Default::default();
        for group in groups {
            for (draws, list) in self.draws.iter_mut().zip(group.faces) {
                if list.is_empty() {
                    continue;
                }
                draws.push(Draw {
                    mesh: group.mesh.clone(),
                    first_instance: instances.len() as u64,
                    instance_count: list.len() as u32,
                });
                instances.extend(list);
            }
        }
        queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(&instances));
    }

    fn write_light(&mut self, queue: &wgpu::Queue, light: &PointLight) {
        if self.light == Some(*light) {
            return;
        }
        self.light = Some(*light);
        let texel = 2.0 / self.size as f32;
        let uniform = LightUniform {
            position: light.position.to_array(),
            near: light.near,
            range: light.range,
            size: self.size as f32,
            normal_offset: self.bias.normal_offset * texel,
            depth_scale: 1.0 + self.bias.constant * texel,
        };
        queue.write_buffer(&self.light_uniform, 0, bytemuck::bytes_of(&uniform));
        for face in CubeFace::ALL {
            queue.write_buffer(
                &self.matrices,
                u64::from(face.layer()) * MATRIX_STRIDE,
                bytemuck::bytes_of(&face.clip_from_light(light.near)),
            );
        }
    }
}
