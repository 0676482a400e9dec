//! Flat shadow maps for spot and directional lights.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::{DAffine3, Mat4, Vec4};

use super::descriptor::DepthEncoding;
use super::draws::{Cull, Draw, instance};
use super::flat_descriptor::{
    FlatLight, FlatLightUniform, ShadowFrame, ShadowMapDescriptor, ShadowMapStatistics,
};
use super::flat_frame::{Fit, FlatFrame, fit};
use super::near::NearPlane;
use super::resources::{self, FaceUniform, INSTANCE_SIZE, PipelineKey, PipelineKind};
use super::scene::Scene;
use super::step::depth_step;
use super::texture;
use crate::error::ShadowMapError;
use crate::mesh::Caster;
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
#[derive(Debug)]
pub struct ShadowMap {
    size: u32,
    bias: Bias,
    reach: Radius,
    label: String,
    cache: bool,
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    kind: PipelineKind,
    near_plane: NearPlane,
    depth_step: f32,
    pipelines: HashMap<PipelineKey, wgpu::RenderPipeline>,
    face: wgpu::Buffer,
    face_group: wgpu::BindGroup,
    light: wgpu::Buffer,
    instances: wgpu::Buffer,
    scene: Scene,
    frame: Option<FlatFrame>,
    width: Option<f64>,
    draws: Vec<Draw>,
    content: Option<Content>,
    statistics: ShadowMapStatistics,
    // These change in `encode` and `begin_pass`, which borrow the map shared as a host's frame
    // graph wants it: what the next encode must do, what the texture may hold, and whether that is
    // still what `content` says.
    pending: AtomicBool,
    filled: AtomicBool,
    foreign: AtomicBool,
}

/// What a map shows: the frame, and the sum of the casters' digests.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Content {
    frame: FlatFrame,
    casters: u128,
    count: usize,
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
        let (size, bias) = (descriptor.size, descriptor.bias);
        let texture = texture::create(device, &label, size, descriptor.format, 1);
        let (face, layout, face_group) = resources::faces(device, &label, 1);
        let kind = PipelineKind {
            layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(&label),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            }),
            shader: device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(&label),
                source: wgpu::ShaderSource::Wgsl(crate::wgsl::CUBE_CASTER.into()),
            }),
            format: texture.format(),
            encoding: DepthEncoding::MajorAxis,
            slope_scale: bias.slope_scale,
            unclipped_depth: descriptor.unclipped_depth && resources::can_pull_casters(device),
            constants: &[],
        };
        Ok(Self {
            size,
            bias,
            reach: descriptor.reach,
            cache: descriptor.cache,
            view: texture.create_view(&wgpu::TextureViewDescriptor {
                label: Some(&label),
                ..Default::default()
            }),
            near_plane: NearPlane::new(device, kind.format, kind.encoding),
            depth_step: depth_step(device, kind.format, kind.encoding),
            texture,
            kind,
            pipelines: HashMap::new(),
            face,
            face_group,
            light: resources::buffer(
                device,
                &format!("{label} light"),
                size_of::<FlatLightUniform>() as u64,
                wgpu::BufferUsages::UNIFORM,
            ),
            instances: resources::instances(device, &label, 1),
            scene: Scene::new(descriptor.sides),
            frame: None,
            width: None,
            draws: Vec::new(),
            content: None,
            statistics: ShadowMapStatistics::default(),
            pending: AtomicBool::new(false),
            // A new texture's content is unknown until it has been cleared once.
            filled: AtomicBool::new(true),
            foreign: AtomicBool::new(true),
            label,
        })
    }

    /// Finds where the map lies, decides which casters go on it and uploads what drawing them
    /// needs.
    ///
    /// # Errors
    /// [`ShadowMapError`] if the light, a caster, the view's distance or the receivers' bounds are
    /// out of range, each by itself or all together in `f32`; the map is then as it was.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        frame: &ShadowFrame<'_>,
    ) -> Result<(), ShadowMapError> {
        frame.validate()?;
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
        self.scene.update(frame.casters, &mut []);
        self.place(frame)?;
        let content = self.gather(device, queue, frame.casters);
        self.upload(queue);

        let nothing = self.draws.is_empty();
        let kept = self.cache && content == self.content && !self.foreign.load(Ordering::Relaxed);
        let clear = nothing && !self.filled.load(Ordering::Relaxed);
        let pending = !(kept || clear);
        self.content = content;
        self.pending.store(pending, Ordering::Relaxed);
        self.foreign.store(pending, Ordering::Relaxed);
        self.count(pending, frame.casters.len());
        Ok(())
    }

    /// Records the pass that the last [`prepare`](Self::prepare) found necessary; once: a second
    /// call before the next `prepare` records nothing. What is recorded must be submitted.
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if !self.pending.swap(false, Ordering::Relaxed) {
            return;
        }
        let mut pass = self.pass(encoder);
        pass.set_bind_group(0, &self.face_group, &[0]);
        for draw in &self.draws {
            draw.record(&mut pass, &self.pipelines, &self.instances);
        }
        let filled = !self.draws.is_empty();
        self.filled.store(filled, Ordering::Relaxed);
        self.foreign.store(false, Ordering::Relaxed);
    }

    /// Begins a pass that clears the map, for a host that draws its own geometry (skinned,
    /// alpha-tested) with [`clip_from_world`](Self::clip_from_world): the map's format, one sample,
    /// depth compare `Greater`.
    ///
    /// Call it after [`encode`](Self::encode) (or instead of it): what `encode` drew is cleared, so
    /// pass such a host's other casters through its own draws too. The casters of
    /// [`prepare`](Self::prepare) still decide where a directional light's map lies.
    pub fn begin_pass<'encoder>(
        &mut self,
        encoder: &'encoder mut wgpu::CommandEncoder,
    ) -> wgpu::RenderPass<'encoder> {
        self.pending.store(false, Ordering::Relaxed);
        self.filled.store(true, Ordering::Relaxed);
        self.foreign.store(true, Ordering::Relaxed);
        self.pass(encoder)
    }

    /// World space to clip space, as the last [`prepare`](Self::prepare) placed the map; `None`
    /// where nothing casts. The frame is left-handed: triangles that are counter-clockwise seen
    /// from the light are clockwise on the map.
    pub fn clip_from_world(&self) -> Option<Mat4> {
        Some(self.frame?.clip_from_world())
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

    /// The map as a 2D texture, for hosts that sample it themselves.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
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
        &self.light
    }

    /// Where the map lies for a frame, if anything casts.
    fn place(&mut self, frame: &ShadowFrame<'_>) -> Result<(), ShadowMapError> {
        let (placed, width) = match &frame.light {
            FlatLight::Spot(light) => {
                let near = self.near_plane.of_spot(light);
                (Some(FlatFrame::of_spot(light, near)), self.width)
            }
            FlatLight::Directional(light) => {
                let fitted = fit(
                    &Fit {
                        light,
                        view: frame.view,
                        receivers: frame.receivers,
                        size: self.size,
                        reach: self.reach,
                        unclipped_depth: self.kind.unclipped_depth,
                        last_width: self.width,
                    },
                    self.scene.records(),
                );
                fitted.unzip()
            }
        };
        if placed.is_some_and(|frame| !frame.fits_f32()) {
            return Err(ShadowMapError::BeyondF32);
        }
        (self.frame, self.width) = (placed, width);
        Ok(())
    }

    /// The draws of the casters on the map, one for each mesh, and what they come to.
    fn gather(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        casters: &[Caster],
    ) -> Option<Content> {
        self.draws.clear();
        let frame = self.frame?;
        let light_from_world = DAffine3::from_translation(-frame.origin.as_dvec3());
        let sides = self.scene.sides();
        let records = self.scene.records().iter().zip(casters).enumerate();
        let mut members: Vec<_> = records
            .filter(|(_, (record, _))| record.triangles > 0 && frame.touches(record))
            .map(|(index, (record, caster))| {
                let cull = Cull::of(sides, record, frame.is_clear_of(record));
                (record.group, cull, index, record.digest, caster)
            })
            .collect();
        members.sort_unstable_by_key(|&(group, cull, index, ..)| (group, cull, index));
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
        queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(&rows));
        for draw in &self.draws {
            let key = draw.key();
            self.pipelines
                .entry(key)
                .or_insert_with(|| resources::pipeline(device, &self.label, &self.kind, key, None));
        }
        let digests = members.iter().map(|member| member.3);
        Some(Content {
            frame,
            casters: digests.fold(0, u128::wrapping_add),
            count: members.len(),
        })
    }

    fn upload(&self, queue: &wgpu::Queue) {
        let (frame, step) = (self.frame.as_ref(), self.depth_step);
        let light = FlatLightUniform::new(frame, &self.bias, self.size, step);
        queue.write_buffer(&self.light, 0, bytemuck::bytes_of(&light));
        if let Some(frame) = self.frame {
            let face = FaceUniform {
                clip_from_light: frame.clip_from_light().to_cols_array(),
                range: frame.range,
                padding: [0.0; 3],
            };
            queue.write_buffer(&self.face, 0, bytemuck::bytes_of(&face));
        }
    }

    fn count(&mut self, rendered: bool, casters: usize) {
        let drawn: u32 = self.draws.iter().map(|draw| draw.instance_count).sum();
        let mut statistics = ShadowMapStatistics {
            rendered,
            casters_drawn: drawn,
            casters_outside: casters as u32 - drawn,
            bytes: u64::from(self.size).pow(2) * texture::texel_bytes(self.texture.format())
                + self.instances.size()
                + self.face.size()
                + self.light.size(),
            ..Default::default()
        };
        if rendered {
            for draw in &self.draws {
                statistics.draws += 1;
                statistics.triangles +=
                    u64::from(draw.mesh.triangle_count()) * u64::from(draw.instance_count);
            }
        }
        self.statistics = statistics;
    }

    fn pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
    ) -> wgpu::RenderPass<'encoder> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&self.label),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }
}
