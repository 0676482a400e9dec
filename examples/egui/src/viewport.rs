//! The picture inside egui's window: a paint callback that prepares before egui's pass, records
//! into egui's encoder and copies the result into egui's pass.

use std::sync::mpsc::Sender;

use anyhow::Result;
use eframe::egui::PaintCallbackInfo;
use eframe::egui_wgpu::{self, CallbackResources, CallbackTrait, ScreenDescriptor};
use shadows::glam::Vec4;
use shadows::reference::Interior;
use shadows::{Support, wgpu};

use crate::blit::Blit;
use crate::measure::Shot;
use crate::shadow::{DebugView, Frame, Settings, Shadows};
use crate::statistics::Rows;
use host::gpu::Gpu;
use host::renderer::{self, Renderer};
use host::scene::{Scene, homogeneous};
use host::scene_gpu::SceneGpu;

/// What the window shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Show {
    /// The shaded picture.
    Picture,
    /// Light's visibility: white lit, black in shadow.
    Visibility,
    /// Where it differs from the reference.
    Error,
    /// The cube map, unfolded.
    Cross,
    /// The layers of the atlas, and what became of each tile.
    Tiles,
    /// Surfaces and silhouette edges of the volumes.
    Surfaces,
    /// How many volumes a pixel is in, as colours.
    Counts,
    /// Casters by how their volumes are counted, or why they have none.
    Casters,
}

impl Show {
    fn debug(self) -> Option<DebugView> {
        match self {
            Self::Picture | Self::Visibility | Self::Error => None,
            Self::Cross => Some(DebugView::Cross),
            Self::Tiles => Some(DebugView::Tiles),
            Self::Surfaces => Some(DebugView::Surfaces),
            Self::Counts => Some(DebugView::Counts),
            Self::Casters => Some(DebugView::Casters),
        }
    }
}

/// One frame: the callback that egui calls while it paints.
pub struct Paint {
    pub settings: Settings,
    /// Homogeneous, world space.
    pub light: Vec4,
    /// Pixels.
    pub size: [u32; 2],
    pub show: Show,
    /// Where the visibility is to be sent, if it is wanted.
    pub read: Option<Sender<Shot>>,
}

impl CallbackTrait for Paint {
    fn prepare(
        &self,
        _: &wgpu::Device,
        _: &wgpu::Queue,
        _: &ScreenDescriptor,
        _: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(viewport) = resources.get_mut::<Viewport>() {
            viewport.problem = viewport
                .prepare(self)
                .err()
                .map(|error| format!("{error:#}"));
        }
        Vec::new()
    }

    fn finish_prepare(
        &self,
        _: &wgpu::Device,
        _: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(viewport) = resources.get_mut::<Viewport>() {
            if let Err(error) = viewport.encode(encoder) {
                viewport.problem.get_or_insert(format!("{error:#}"));
            }
            if let Some(read) = &self.read {
                viewport.read_visibility(encoder, read.clone());
            }
        }
        Vec::new()
    }

    fn paint(
        &self,
        _: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        let Some(viewport) = resources.get::<Viewport>() else {
            return;
        };
        let debug = matches!(self.show, Show::Cross | Show::Tiles)
            && viewport
                .shadows
                .as_ref()
                .is_some_and(|s| s.1.draw_debug(pass));
        if !debug {
            viewport.blit.draw(pass, self.show == Show::Visibility);
        }
    }
}

/// What lives from frame to frame, among egui's callback resources.
pub struct Viewport {
    gpu: Gpu,
    window: wgpu::TextureFormat,
    scene: Scene,
    scene_gpu: SceneGpu,
    renderer: Renderer,
    shadows: Option<(Settings, Shadows)>,
    blit: Blit,
    problem: Option<String>,
}

impl Viewport {
    /// Uploads the scene to egui's device.
    ///
    /// # Errors
    /// If something of it does not fit the device.
    pub fn new(state: &egui_wgpu::RenderState, scene: Scene) -> Result<Self> {
        let gpu = Gpu {
            device: state.device.clone(),
            queue: state.queue.clone(),
            info: state.adapter.get_info(),
            support: Support::of_adapter(&state.adapter),
        };
        let scene_gpu = SceneGpu::new(&gpu, &scene)?;
        let renderer = Renderer::new(&gpu, [3, 3], &scene, &scene_gpu)?;
        let window = state.target_format;
        Ok(Self {
            blit: Blit::new(&gpu.device, window, &renderer),
            gpu,
            window,
            scene,
            scene_gpu,
            renderer,
            shadows: None,
            problem: None,
        })
    }

    /// What the last frame came to.
    pub fn statistics(&self) -> Rows {
        let shadows = self.shadows.as_ref();
        shadows.map_or_else(Vec::new, |(_, shadows)| shadows.statistics())
    }

    /// Why the last frame was refused, if it was.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    fn prepare(&mut self, paint: &Paint) -> Result<()> {
        let resized = paint.size != self.renderer.size();
        self.scene.light_mut().place = paint.light;
        self.renderer.update(&self.gpu, paint.size, &self.scene)?;
        if resized {
            self.blit.bind(&self.gpu.device, &self.renderer);
        }
        if self
            .shadows
            .as_ref()
            .is_none_or(|(made, _)| *made != paint.settings)
        {
            let made = Shadows::new(&self.gpu, &self.renderer, self.window, &paint.settings)?;
            self.shadows = Some((paint.settings, made));
        }
        let frame = Frame {
            view: renderer::view(&self.scene, paint.size)?,
            light: homogeneous(paint.light),
            range: self.scene.light().range,
            casters: &self.scene_gpu.casters,
            size: paint.size,
            debug: paint.show.debug(),
        };
        match &mut self.shadows {
            Some((_, shadows)) => shadows.prepare(&self.gpu, &frame),
            None => Ok(()),
        }
    }

    fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) -> Result<()> {
        self.renderer.draw_ambient(encoder, &self.scene_gpu);
        if let Some((_, shadows)) = &mut self.shadows {
            shadows.encode(&self.renderer, encoder)?;
            shadows.shade(&self.renderer, &self.scene_gpu, encoder)?;
        }
        Ok(())
    }

    /// Sends the visibility of the frame being recorded, one byte a pixel, once it is drawn.
    fn read_visibility(&self, encoder: &mut wgpu::CommandEncoder, read: Sender<Shot>) {
        let texture = self.renderer.visibility();
        let [width, height] = self.renderer.size();
        let row = width.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("visibility"),
            size: u64::from(row) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let destination = wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row),
                rows_per_image: None,
            },
        };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, texture.size());
        let shadows = self.shadows.as_ref();
        let interior = shadows.map_or(Interior::Screen, |(made, shadows)| {
            shadows.interior(made.kernel)
        });
        let mapped = buffer.clone();
        encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Read, .., move |result| {
            if result.is_ok()
                && let Ok(bytes) = mapped.get_mapped_range(..)
            {
                let rows = bytes.chunks(row as usize);
                let pixels = rows.flat_map(|bytes| &bytes[..width as usize]).copied();
                // Nobody listens any more if the window has been closed.
                let _ = read.send(Shot {
                    visibility: pixels.collect(),
                    interior,
                });
            }
        });
    }
}
