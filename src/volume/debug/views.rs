//! Debug views of volumes: their surfaces, silhouettes and counts, and how each is counted.

use glam::Mat4;
use wgpu::util::DeviceExt as _;

use crate::error::{ScreenPassError, ShadowVolumeError, VolumeDebugError, VolumeRenderError};
use crate::mesh::CasterMesh;
use crate::volume::debug::colors::{DebugColors, Swatch};
use crate::volume::debug::exact_counts::ExactCounts;
use crate::volume::debug::pipelines::{
    COLOR_BYTES, CountPipelines, Factory, FeedPipelines, color_layout,
};
use crate::volume::decide::method::Count;
use crate::volume::descriptor::check_depth;
use crate::volume::gpu::buffers::window;
use crate::volume::gpu::draw_pipelines::{Feed, Style};
use crate::volume::gpu::grown::spread;
use crate::volume::gpu::layout::bind;
use crate::volume::light_pass::checks::{check_samples, check_target};
use crate::volume::light_pass::join::check_color;
use crate::volume::light_pass::targets::{DEPTH_STENCIL, has_depth_alone, has_stencil};
use crate::volume::multiview::Multiview;
use crate::volume::plan::cache::position_words;
use crate::volume::plan::faces::Faces;
use crate::volume::plan::limits;
use crate::volume::plan::merged::{BLOCK_BYTES, MergedDraw};
use crate::volume::plan::params::{CasterParams, LightParams, ViewParams};
use crate::volume::{ExactCount, ShadowVolumeFrame, ShadowVolumeRenderer};
use crate::{Caster, DepthConvention, View};

/// Parameters of a [`VolumeDebug`], which must match the pass that it draws into.
#[derive(Clone, Copy, Debug)]
pub struct VolumeDebugDescriptor<'a> {
    /// Name of its GPU objects in debuggers, after "shadows volume debug". Default `None`.
    pub label: Option<&'a str>,
    /// Format of the pass's only colour attachment, which must be blendable. Default `Rgba8Unorm`.
    pub color_format: wgpu::TextureFormat,
    /// Format of the depth-stencil buffer that the volumes were counted in, or of a plain depth buffer
    /// (`Depth32Float`, `Depth24Plus`) if they were counted exactly. Default `Depth32FloatStencil8`.
    pub depth_stencil_format: wgpu::TextureFormat,
    /// Samples per pixel of both, 1 (default) or 4.
    pub sample_count: u32,
    /// How the host's projection maps depth, as for the renderers to be shown. Default
    /// [`DepthConvention::InfiniteReverse`].
    pub depth: DepthConvention,
    /// The colours. Default: the legend in [`DebugColors`].
    pub colors: DebugColors,
}

impl Default for VolumeDebugDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            color_format: wgpu::TextureFormat::Rgba8Unorm,
            depth_stencil_format: DEPTH_STENCIL,
            sample_count: 1,
            depth: DepthConvention::default(),
            colors: DebugColors::default(),
        }
    }
}

/// Debug views of a [`ShadowVolumeRenderer`], drawn over the host's picture.
///
/// All views are drawn into a pass with one colour attachment and the buffer that holds the scene's depth,
/// both of whose aspects may be read-only. They change the pass's pipeline, bind groups 0 and 1, index
/// buffer, vertex buffer 0 and stencil reference, and nothing else; the scissor rectangle is the host's. One
/// `VolumeDebug` serves any number of renderers of its device and depth convention.
///
/// `docs/volume-debug.png` in the repository shows all of them; it is drawn by
/// `cargo run --release --example volume_debug -- --out docs/volume-debug.png`.
#[derive(Debug)]
pub struct VolumeDebug {
    label: String,
    depth: DepthConvention,
    pulled: Option<FeedPipelines>,
    fed: FeedPipelines,
    /// For a buffer that has a stencil.
    counts: Option<CountPipelines>,
    exact_counts: Option<ExactCounts>,
    depth_stencil_format: wgpu::TextureFormat,
    sample_count: u32,
    colors: wgpu::BindGroup,
    /// Bytes from one colour to the next.
    color_step: u32,
    casters: Vec<ShownCaster>,
}

/// A caster as [`VolumeDebug::draw_casters`] draws it.
#[derive(Debug)]
struct ShownCaster {
    mesh: CasterMesh,
    feed: Feed,
    group: wgpu::BindGroup,
    /// Its parameters: bytes from the start of a uniform buffer, or the number in a storage buffer.
    place: u32,
    /// In which blocks say that number, one for each caster.
    blocks: Option<wgpu::Buffer>,
    swatch: Swatch,
}

impl VolumeDebug {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// [`VolumeDebugError`] if a format or the sample count is unsuitable, or if the device lacks a feature
    /// or a limit; the message names it.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &VolumeDebugDescriptor<'_>,
    ) -> Result<Self, VolumeDebugError> {
        validate(device, descriptor)?;
        let label = match descriptor.label {
            Some(name) => format!("shadows volume debug {name}"),
            None => "shadows volume debug".to_owned(),
        };
        let layout = color_layout(device, &label);
        let factory = Factory {
            device,
            descriptor,
            label: &label,
            colors: &layout,
        };
        let pulls = limits::check_pulling(device).is_ok();
        let color_step = window::<[f32; 4]>(&device.limits());
        let colors = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(&label),
            contents: &spread(&descriptor.colors.list(), color_step),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        Ok(Self {
            depth: descriptor.depth,
            pulled: pulls.then(|| FeedPipelines::new(&factory, Feed::Pulled)),
            fed: FeedPipelines::new(&factory, Feed::Records),
            counts: has_stencil(descriptor.depth_stencil_format)
                .then(|| CountPipelines::new(&factory)),
            exact_counts: ExactCounts::new(device, &label, descriptor),
            depth_stencil_format: descriptor.depth_stencil_format,
            sample_count: descriptor.sample_count,
            colors: bind(device, &label, &layout, &[(&colors, COLOR_BYTES)], &[]),
            color_step,
            casters: Vec::new(),
            label,
        })
    }

    /// Prepares [`draw_casters`](Self::draw_casters), the one view that also shows casters for which the
    /// renderer draws nothing. Call it after the renderer's own [`prepare`](ShadowVolumeRenderer::prepare),
    /// with the same frame. The other views need no preparation.
    ///
    /// # Errors
    /// [`VolumeDebugError`], before any GPU work, if the renderer has another depth convention, if it was
    /// prepared with another number of casters, or if a caster is invalid. What was prepared before is then
    /// still drawn.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        frame: &ShadowVolumeFrame<'_>,
        renderer: &ShadowVolumeRenderer,
        light: usize,
        view: usize,
    ) -> Result<(), VolumeDebugError> {
        if renderer.depth() != self.depth {
            return Err(VolumeDebugError::Depth {
                debug: self.depth,
                renderer: renderer.depth(),
            });
        }
        renderer.drawn_alone(light, view)?;
        let states = renderer.caster_states(light, view);
        if frame.casters.len() != states.len() {
            return Err(VolumeDebugError::Casters {
                frame: frame.casters.len(),
                renderer: states.len(),
            });
        }
        for (index, caster) in frame.casters.iter().enumerate() {
            caster
                .validate(index, device)
                .map_err(ShadowVolumeError::from)?;
            if !caster.mesh.has_adjacency() {
                return Err(ShadowVolumeError::NoAdjacency { index }.into());
            }
        }
        let shown = frame.casters.iter().zip(&states);
        let shown: Vec<_> = shown
            .filter_map(|(caster, state)| Some((caster, Swatch::of_state(*state)?)))
            .collect();
        self.casters = self.show(device, &frame.views[view].view, &shown);
        Ok(())
    }

    fn show(
        &self,
        device: &wgpu::Device,
        view: &View,
        shown: &[(&Caster, Swatch)],
    ) -> Vec<ShownCaster> {
        let params: Vec<_> = shown.iter().map(|(c, _)| caster_params(c)).collect();
        if params.is_empty() {
            return Vec::new();
        }
        use wgpu::BufferUsages as U;
        let buffer = |contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(&self.label),
                contents,
                usage,
            })
        };
        let (feed, step, usage) = match self.pulled {
            Some(_) => (Feed::Pulled, size_of::<CasterParams>() as u32, U::STORAGE),
            None => (
                Feed::Records,
                window::<CasterParams>(&device.limits()),
                U::UNIFORM,
            ),
        };
        let view = ViewParams::new(view);
        let no_light: LightParams = bytemuck::Zeroable::zeroed();
        let [view, no_light, params] = [
            buffer(bytemuck::bytes_of(&view), U::UNIFORM),
            buffer(bytemuck::bytes_of(&no_light), U::UNIFORM),
            buffer(&spread(&params, step), usage),
        ];
        let uniforms = [&view, &no_light, &params].into_iter();
        let uniforms: Vec<_> = uniforms.zip(feed.uniforms(Multiview::default())).collect();
        let blocks = self.pulled.as_ref().map(|_| {
            let blocks: Vec<[u32; 3]> = (0..shown.len() as u32).map(|n| [n, 0, 0]).collect();
            buffer(bytemuck::cast_slice(&blocks), U::VERTEX)
        });
        let show = |(&(caster, swatch), number): (&(&Caster, Swatch), u32)| {
            let mesh = &caster.mesh;
            let group = match &self.pulled {
                Some(pulled) => {
                    // No edge and no side is read; any buffer will do.
                    let any = mesh.positions();
                    let buffers = [&params, any, any, any];
                    bind(device, &self.label, &pulled.layout, &uniforms, &buffers)
                }
                None => bind(device, &self.label, &self.fed.layout, &uniforms, &[]),
            };
            ShownCaster {
                mesh: mesh.clone(),
                feed,
                group,
                place: match feed {
                    Feed::Pulled => number,
                    Feed::Records => number * step,
                },
                blocks: blocks.clone(),
                swatch,
            }
        };
        shown.iter().zip(0..).map(show).collect()
    }

    /// Draws the faces of all volumes that the renderer counts as transparent surfaces, where they are in
    /// front of the visible surfaces: sides by method, light caps, dark caps. Dark caps at infinity are
    /// behind everything and therefore never visible.
    ///
    /// To be called, like [`ShadowVolumeRenderer::render`], after `encode`, in the same submission or a later
    /// one.
    ///
    /// # Errors
    /// [`VolumeRenderError::NoSuch`] if the renderer's frame had no such light or view,
    /// [`VolumeRenderError::Multiview`] if it draws several views a pass.
    pub fn draw_surfaces(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        renderer: &ShadowVolumeRenderer,
        light: usize,
        view: usize,
    ) -> Result<(), VolumeRenderError> {
        let drawn = renderer.drawn_alone(light, view)?;
        let recorder = drawn.recorder();
        for draw in drawn.draws().filter(|draw| !draw.key.style.is_repeat()) {
            let style = draw.key.style;
            let swatch = match (style.faces, style.count) {
                (Faces::LightCap, _) => Swatch::LightCaps,
                (Faces::DarkCap | Faces::Fan, _) => Swatch::DarkCaps,
                (Faces::Sides, Count::Pass) => Swatch::SidesZPass,
                (Faces::Sides, Count::Fail) => Swatch::SidesZFail,
            };
            let pipeline = |feed: &FeedPipelines| feed.faces(style.faces).cloned();
            let bound = (renderer, [light, view]);
            if self.bind(pass, bound, draw, (pipeline, swatch)) {
                recorder.record(pass, draw);
            }
        }
        Ok(())
    }

    /// Draws the silhouette edges of all volumes, from which sides are extruded, as lines one pixel wide,
    /// including those behind other surfaces.
    ///
    /// # Errors
    /// [`VolumeRenderError::NoSuch`] if the renderer's frame had no such light or view,
    /// [`VolumeRenderError::Multiview`] if it draws several views a pass.
    pub fn draw_edges(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        renderer: &ShadowVolumeRenderer,
        light: usize,
        view: usize,
    ) -> Result<(), VolumeRenderError> {
        let drawn = renderer.drawn_alone(light, view)?;
        let recorder = drawn.recorder();
        let are_sides = |style: Style| style.faces == Faces::Sides && !style.is_repeat();
        for draw in drawn.draws().filter(|draw| are_sides(draw.key.style)) {
            let pipeline = |feed: &FeedPipelines| Some(feed.edges.clone());
            let pipeline = (pipeline, Swatch::Edges);
            if self.bind(pass, (renderer, [light, view]), draw, pipeline) {
                recorder.record_edges(pass, draw);
            }
        }
        Ok(())
    }

    /// Colours every sample by its stencil count, which is the number of volumes that contain it; samples
    /// with a count of 0 are left untouched. To be drawn after [`ShadowVolumeRenderer::render`] and before a
    /// light pass changes the count.
    ///
    /// Nine triangles that cover the target, each with its own stencil test.
    ///
    /// # Errors
    /// [`VolumeDebugError::NoStencil`] if the buffer has no stencil: see
    /// [`draw_exact_counts`](Self::draw_exact_counts). Nothing is then drawn.
    pub fn draw_counts(&self, pass: &mut wgpu::RenderPass<'_>) -> Result<(), VolumeDebugError> {
        let no_stencil = VolumeDebugError::NoStencil(self.depth_stencil_format);
        let counts = self.counts.as_ref().ok_or(no_stencil)?;
        let mut draw = |pipeline, reference: u32, swatch: u32| {
            pass.set_pipeline(pipeline);
            pass.set_stencil_reference(reference);
            pass.set_bind_group(1, &self.colors, &[swatch * self.color_step]);
            pass.draw(0..3, 0..1);
        };
        let first = Swatch::Counts as u32;
        draw(&counts.above, 7, first + 7);
        draw(&counts.negative, 248, Swatch::Negative as u32);
        for count in 1..=7 {
            draw(&counts.equal, count, first + count - 1);
        }
        Ok(())
    }

    /// Colours every sample by its exact count ([`Counter::Exact`](crate::Counter::Exact)), as
    /// [`draw_counts`](Self::draw_counts) does by the stencil count, but without ambiguity: counts of 8 and
    /// above, however large, and negative ones, which only an incorrect method produces, are told apart. To
    /// be drawn after the pass in which volumes were counted. Needs no stencil.
    ///
    /// Nine triangles that cover the target.
    ///
    /// # Errors
    /// [`VolumeDebugError::Target`] if the count has another number of samples than the descriptor said, or
    /// is of several views.
    /// Nothing is then drawn.
    pub fn draw_exact_counts(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        counts: &ExactCount,
    ) -> Result<(), VolumeDebugError> {
        let not_here = ScreenPassError::SamplesOnGl {
            samples: self.sample_count,
            what: "VolumeDebug::draw_exact_counts",
        };
        Ok(self
            .exact_counts
            .as_ref()
            .ok_or(not_here)?
            .draw(pass, counts)?)
    }

    /// Draws the visible casters of the frame passed to [`prepare`](Self::prepare), each in the colour of the
    /// decision made for it.
    pub fn draw_casters(&self, pass: &mut wgpu::RenderPass<'_>) {
        for caster in &self.casters {
            let Some(feed) = self.feed(caster.feed) else {
                continue;
            };
            pass.set_pipeline(&feed.casters);
            let offsets = [0, 0, caster.place];
            let uniforms = caster.feed.uniform_count();
            pass.set_bind_group(0, &caster.group, &offsets[..uniforms]);
            self.set_color(pass, caster.swatch);
            let mesh = &caster.mesh;
            match caster.feed {
                Feed::Pulled => {
                    let Some(blocks) = &caster.blocks else {
                        continue;
                    };
                    let first = u64::from(caster.place) * BLOCK_BYTES;
                    pass.set_vertex_buffer(0, blocks.slice(first..first + BLOCK_BYTES));
                    let triangles = mesh.triangles().slice(..);
                    pass.set_index_buffer(triangles, wgpu::IndexFormat::Uint32);
                    pass.draw_indexed(0..3 * mesh.triangle_count(), 0, 0..1);
                }
                Feed::Records => {
                    let Some(records) = mesh.records() else {
                        continue;
                    };
                    pass.set_vertex_buffer(0, records.triangles.slice(..));
                    pass.draw(0..3, 0..mesh.triangle_count());
                }
            }
        }
    }

    fn feed(&self, feed: Feed) -> Option<&FeedPipelines> {
        match feed {
            Feed::Pulled => self.pulled.as_ref(),
            Feed::Records => Some(&self.fed),
        }
    }

    fn set_color(&self, pass: &mut wgpu::RenderPass<'_>, swatch: Swatch) {
        pass.set_bind_group(1, &self.colors, &[swatch as u32 * self.color_step]);
    }

    /// Sets pipeline, colour and the volume's own bind group, if all of them are there.
    fn bind(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        (renderer, place): (&ShadowVolumeRenderer, [usize; 2]),
        draw: &MergedDraw,
        (pipeline, swatch): (
            impl Fn(&FeedPipelines) -> Option<wgpu::RenderPipeline>,
            Swatch,
        ),
    ) -> bool {
        let feed = self.feed(Feed::of(draw.key.way));
        let Some(pipeline) = feed.and_then(pipeline) else {
            return false;
        };
        pass.set_pipeline(&pipeline);
        self.set_color(pass, swatch);
        renderer.bind_draw(pass, draw, place)
    }
}

fn caster_params(caster: &Caster) -> CasterParams {
    let (position_stride, position_offset) = position_words(&caster.mesh);
    CasterParams {
        world_from_object: Mat4::from(caster.world_from_object).to_cols_array_2d(),
        position_stride,
        position_offset,
        ..bytemuck::Zeroable::zeroed()
    }
}

fn validate(
    device: &wgpu::Device,
    descriptor: &VolumeDebugDescriptor<'_>,
) -> Result<(), VolumeDebugError> {
    let (format, samples) = (descriptor.depth_stencil_format, descriptor.sample_count);
    match has_depth_alone(format) {
        true => check_samples(samples)?,
        false => check_target(device, format, samples)?,
    }
    check_color(device, descriptor.color_format, descriptor.sample_count)?;
    check_depth(device, descriptor.depth)?;
    // Caster, view and light, and the colour.
    limits::check_one(
        "max_dynamic_uniform_buffers_per_pipeline_layout",
        4,
        u64::from(
            device
                .limits()
                .max_dynamic_uniform_buffers_per_pipeline_layout,
        ),
    )?;
    Ok(())
}
