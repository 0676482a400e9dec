//! Flat shadow maps for spot and directional lights.

use std::collections::HashMap;

use glam::{Mat4, Vec4};
use wgpu::util::DeviceExt as _;

use super::descriptor::DepthEncoding;
use super::draws::Draw;
use super::flat_content::{Asked, Content, Texels};
use super::flat_descriptor::{FlatLightUniform, ShadowMapDescriptor, ShadowMapStatistics};
use super::flat_frame::{FlatFrame, LightBox};
use super::near::NearPlane;
use super::resources::{self, FaceUniform, PipelineKey, PipelineKind};
use super::scene::Scene;
use super::texture;
use crate::error::ShadowMapError;
use crate::submissions::Submissions;
use crate::uploads::Uploads;
use crate::{Bias, DirectionalLight, Radius};

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
    pub(super) size: u32,
    pub(super) bias: Bias,
    pub(crate) reach: Radius,
    pub(super) label: String,
    pub(super) cache: bool,
    pub(super) texture: wgpu::Texture,
    view: wgpu::TextureView,
    pub(super) kind: PipelineKind,
    pub(super) near_plane: NearPlane,
    pub(super) pipelines: HashMap<PipelineKey, wgpu::RenderPipeline>,
    pub(super) face: wgpu::Buffer,
    face_group: wgpu::BindGroup,
    pub(super) light: wgpu::Buffer,
    pub(super) instances: wgpu::Buffer,
    pub(super) scene: Scene,
    /// What the last frame asked for, where the map lies for it and what it is to show.
    pub(super) asked: Option<Asked>,
    pub(super) frame: Option<FlatFrame>,
    pub(super) width: Option<f64>,
    /// The box around all casters, as a light sees them.
    pub(super) caster_box: Option<(DirectionalLight, Option<LightBox>)>,
    pub(super) wanted: Content,
    /// What the texels show.
    pub(super) texels: Texels,
    /// Whether the next encode draws, and what.
    pub(super) pending: bool,
    pub(super) draws: Vec<Draw>,
    // What the uniforms hold once the uploads are recorded.
    pub(super) written_light: Option<FlatLightUniform>,
    pub(super) written_face: Option<FaceUniform>,
    pub(super) uploads: Uploads,
    pub(super) submissions: Submissions,
    pub(super) statistics: ShadowMapStatistics,
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
            shader: resources::caster_shader(device, &label),
            depth_written: resources::writes_depth(device),
            format: texture.format(),
            encoding: DepthEncoding::MajorAxis,
            slope_scale: bias.slope_scale,
            unclipped_depth: descriptor.unclipped_depth && resources::can_pull_casters(device),
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
            near_plane: NearPlane::new(kind.format, kind.encoding),
            texture,
            kind,
            pipelines: HashMap::new(),
            face,
            face_group,
            light: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(&format!("{label} light")),
                contents: bytemuck::bytes_of(&FlatLightUniform::DARK),
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            }),
            instances: resources::instances(device, &label, 1),
            scene: Scene::new(descriptor.sides),
            asked: None,
            frame: None,
            width: None,
            caster_box: None,
            wanted: Content::default(),
            texels: Texels::Unknown,
            pending: false,
            draws: Vec::new(),
            written_light: None,
            written_face: None,
            uploads: Uploads::new(device),
            submissions: Submissions::default(),
            statistics: ShadowMapStatistics::default(),
            label,
        })
    }

    /// Records what the last [`prepare`](Self::prepare) found necessary: its pass, and what it tells
    /// receivers of the light. Once: a second call before the next `prepare` records nothing.
    ///
    /// Call it after every `prepare`, whatever that found. Until it is called, receivers see texels and
    /// light as they were; of a map that was never drawn they see a dark light. What is recorded must
    /// be submitted: if its encoder is dropped, the `prepare` after that draws the map again
    /// ([`ShadowMapStatistics::encoder_dropped`]).
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let copied = self.uploads.record(encoder);
        if copied || self.pending {
            self.submissions.watch(encoder);
        }
        if !std::mem::take(&mut self.pending) {
            return;
        }
        let mut pass = self.pass(encoder);
        pass.set_bind_group(0, &self.face_group, &[0]);
        for draw in &self.draws {
            draw.record(&mut pass, &self.pipelines, &self.instances);
        }
        drop(pass);
        self.texels = self.wanted.on_texels();
    }

    /// Takes nothing for drawn: the next [`prepare`](Self::prepare) has the map drawn again. What the
    /// last one found is forgotten.
    ///
    /// For a host that has written to the map's texture, or has lost what was recorded in a way that
    /// the map cannot see: an encoder that is kept but never submitted, a submission that failed.
    pub fn invalidate(&mut self) {
        self.pending = false;
        self.texels = Texels::Unknown;
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
        if self.uploads.record(encoder) {
            self.submissions.watch(encoder);
        }
        self.pending = false;
        self.texels = Texels::Unknown;
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
