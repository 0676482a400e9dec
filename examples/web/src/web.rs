//! What the page's JavaScript calls.

use std::sync::{Arc, Mutex};

use anyhow::{Context as _, Result};
use futures_channel::oneshot;
use host::gpu::Gpu;
use js_sys::{Promise, Uint8Array};
use shadows::glam::Vec2;
use shadows::{Bias, Support, wgpu};
use wasm_bindgen::prelude::*;
use web_sys::HtmlCanvasElement;

use crate::app::App;
use crate::choice::{Choice, Show};
use crate::compose::Compose;
use crate::job::{Count, Job, Judge, NUMBERS};
use crate::picture::Picture;

/// Tells the console where the module stopped, if it did.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|panic| {
        web_sys::console::error_1(&panic.to_string().into());
    }));
}

/// The page: a canvas, and what is on it.
#[wasm_bindgen]
pub struct Page {
    app: App,
    /// What the next frame shows.
    choice: Choice,
    size: [u32; 2],
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    compose: Compose,
    error: Arc<Mutex<Option<String>>>,
}

#[wasm_bindgen]
impl Page {
    /// Asks for a device and draws to the canvas from now on. `choices` are names and values, in turn.
    pub async fn open(canvas: HtmlCanvasElement, choices: Vec<String>) -> Result<Page, JsError> {
        Self::opened(canvas, &choices).await.map_err(js)
    }

    async fn opened(canvas: HtmlCanvasElement, choices: &[String]) -> Result<Self> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let size = [canvas.width(), canvas.height()].map(|side| side.max(1));
        let surface = instance.create_surface(wgpu::SurfaceTarget::Canvas(canvas))?;
        let wanted = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: Some(&surface),
            ..Default::default()
        };
        let adapter = instance.request_adapter(&wanted).await?;
        let support = Support::of_adapter(&adapter);
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("page"),
            required_features: support.features(),
            required_limits: support.limits(),
            ..Default::default()
        };
        let (device, queue) = adapter.request_device(&descriptor).await?;
        let error = Arc::new(Mutex::new(None));
        let told = error.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            web_sys::console::error_1(&error.to_string().into());
            if let Ok(mut told) = told.lock() {
                told.get_or_insert(error.to_string());
            }
        }));
        let mut config = surface
            .get_default_config(&adapter, size[0], size[1])
            .context("the canvas does not go with this GPU")?;
        let color = config.format.add_srgb_suffix();
        config.view_formats = vec![color];
        surface.configure(&device, &config);
        let gpu = Gpu {
            device,
            queue,
            info: adapter.get_info(),
            support,
        };
        let mut choice = Choice::default();
        for pair in choices.chunks_exact(2) {
            choice.set(&pair[0], &pair[1])?;
        }
        Ok(Self {
            compose: Compose::new(&gpu, color, config.format),
            app: App::new(gpu, choice, size)?,
            choice,
            size,
            surface,
            config,
            error,
        })
    }

    /// The crate's default bias in texels: normal offset, constant.
    pub fn default_bias() -> Vec<String> {
        let Bias {
            normal_offset,
            constant,
            ..
        } = Bias::default();
        vec![normal_offset.to_string(), constant.to_string()]
    }

    /// Changes a choice of the next frame.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), JsError> {
        self.choice.set(name, value).map_err(js)
    }

    /// The canvas has another size, in pixels.
    pub fn resize(&mut self, width: u32, height: u32) {
        let most = self.app.gpu.device.limits().max_texture_dimension_2d;
        self.size = [width, height].map(|side| side.clamp(1, most));
        [self.config.width, self.config.height] = self.size;
        self.surface.configure(&self.app.gpu.device, &self.config);
    }

    /// Turns the camera by a drag, in heights of the picture.
    pub fn turn_camera(&mut self, right: f32, down: f32) {
        self.app.world.turn_camera(Vec2::new(right, down));
    }

    /// Brings the camera nearer by so many steps.
    pub fn advance_camera(&mut self, steps: f32) {
        self.app.world.advance_camera(steps);
    }

    /// Moves the light by a drag, in heights of the picture.
    pub fn drag_light(&mut self, right: f32, down: f32) {
        self.app.world.drag_light(Vec2::new(right, down));
    }

    /// Turns the light about the vertical, in radians.
    pub fn turn_light(&mut self, angle: f32) {
        self.app.world.turn_light(angle);
    }

    /// Where the lamp is seen, in parts of the picture's width and height; empty if it is not.
    pub fn lamp(&self) -> Vec<f32> {
        let lamp = self.app.world.lamp_on_screen(self.size);
        lamp.map_or_else(Vec::new, Into::into)
    }

    /// Draws a frame; the bar at a part of the picture's width.
    pub fn draw(&mut self, bar: f32) -> Result<(), JsError> {
        self.drawn(bar).map_err(js)
    }

    fn drawn(&mut self, bar: f32) -> Result<()> {
        self.app.update(self.choice, self.size)?;
        let texture = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(texture)
            | wgpu::CurrentSurfaceTexture::Suboptimal(texture) => texture,
            _ => return Ok(()), // the next frame may have one
        };
        let mut encoder = self
            .app
            .gpu
            .device
            .create_command_encoder(&Default::default());
        self.app.encode([bar > 0.0, bar < 1.0], &mut encoder)?;
        let format = match self.choice.show {
            Show::Picture => self.config.format.add_srgb_suffix(),
            Show::Visibility => self.config.format,
        };
        let target = texture.texture.create_view(&wgpu::TextureViewDescriptor {
            format: Some(format),
            ..Default::default()
        });
        self.compose.draw(
            &self.app.gpu,
            self.app.picture(),
            self.choice.show,
            (bar * self.size[0] as f32).round(),
            &mut encoder,
            &target,
        );
        self.app.gpu.queue.submit([encoder.finish()]);
        self.app.gpu.queue.present(texture);
        Ok(())
    }

    /// Width and height of the picture in pixels.
    pub fn size(&self) -> Vec<u32> {
        self.app.picture().size().to_vec()
    }

    /// What the GPU's driver refused first, if it did.
    pub fn refused(&self) -> Option<String> {
        self.error.lock().ok().and_then(|error| error.clone())
    }

    /// The GPU by name.
    pub fn adapter(&self) -> String {
        host::gpu::describe(&self.app.gpu.info)
    }

    /// What the last frame came to, of the left half (0) or the right one (1): what was drawn, draws,
    /// triangles, bytes.
    pub fn statistics(&self, side: usize) -> Vec<JsValue> {
        let sides = self.app.picture().sides();
        let rows = sides[side.min(1)].statistics();
        vec![
            rows.drawn.into(),
            rows.draws.into(),
            (rows.triangles as f64).into(),
            (rows.bytes as f64).into(),
        ]
    }

    /// The last frame's half, four bytes a pixel, sRGB.
    pub fn read(&self, side: usize) -> Promise {
        let picture: &Picture = self.app.picture();
        let texture = picture.sides()[side.min(1)].renderer.shaded();
        let gpu = &self.app.gpu;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let copy = Copy::new(gpu, texture, &mut encoder);
        gpu.queue.submit([encoder.finish()]);
        promise(async move { Ok(Uint8Array::from(&copy.bytes().await?[..]).into()) })
    }

    /// Draws both halves in another size for the reference. Gives the numbers of a job, and a promise of
    /// the visibility of the left half and the right one, a byte a pixel.
    pub fn measure(&mut self, width: u32, height: u32) -> Result<Measurement, JsError> {
        self.measured([width, height]).map_err(js)
    }

    fn measured(&mut self, size: [u32; 2]) -> Result<Measurement> {
        let device = self.app.gpu.device.clone();
        let mut encoder = device.create_command_encoder(&Default::default());
        let (textures, job) = self.app.encode_measured(size, &mut encoder)?;
        let gpu = &self.app.gpu;
        let copies = textures.map(|texture| Copy::new(gpu, &texture, &mut encoder));
        gpu.queue.submit([encoder.finish()]);
        let [left, right] = copies;
        Ok(Measurement {
            job: job.to_numbers().to_vec(),
            visibility: promise(async move {
                let both = [left.bytes().await?, right.bytes().await?].concat();
                Ok(Uint8Array::from(&both[..]).into())
            }),
        })
    }
}

/// A picture to be compared with the reference.
#[wasm_bindgen]
pub struct Measurement {
    job: Vec<f32>,
    visibility: Promise,
}

#[wasm_bindgen]
impl Measurement {
    /// What the reference must know.
    #[wasm_bindgen(getter)]
    pub fn job(&self) -> Vec<f32> {
        self.job.clone()
    }

    /// Of both halves, once they are drawn.
    #[wasm_bindgen(getter)]
    pub fn visibility(&self) -> Promise {
        self.visibility.clone()
    }
}

/// The reference, in a worker.
#[wasm_bindgen]
pub struct Reference {
    judge: Judge,
    counts: [Count; 2],
}

#[wasm_bindgen]
impl Reference {
    /// For a scene under a kind of light, by the names of the choices.
    #[wasm_bindgen(constructor)]
    pub fn new(scene: &str, light: &str) -> Result<Reference, JsError> {
        Self::made(scene, light).map_err(js)
    }

    fn made(scene: &str, light: &str) -> Result<Self> {
        let mut choice = Choice::default();
        choice.set("scene", scene)?;
        choice.set("light", light)?;
        Ok(Self {
            judge: Judge::new(choice.place, choice.light)?,
            counts: Default::default(),
        })
    }

    /// Compares some rows of both halves; counts from 0 if they are the first. Gives the rows' colours, four
    /// bytes a pixel, the left half's before the right one's.
    pub fn rows(
        &mut self,
        job: &[f32],
        width: u32,
        height: u32,
        first: u32,
        end: u32,
        visibility: &[u8],
    ) -> Result<Vec<u8>, JsError> {
        if first == 0 {
            self.counts = Default::default();
        }
        let mut compared = || -> Result<Vec<u8>> {
            let job: &[f32; NUMBERS] = job.try_into().context("this is no job")?;
            let (left, right) = visibility.split_at(visibility.len() / 2);
            let [mut colors, rest] = self.judge.rows(
                &Job::from_numbers(job),
                [width, height],
                [first, end],
                [left, right],
                &mut self.counts,
            )?;
            colors.extend(rest);
            Ok(colors.into_flattened())
        };
        compared().map_err(js)
    }

    /// So far, of the left half (0) or the right one (1): pixels counted, lit in shadow, in shadow though
    /// lit, and those of both that resolution does not excuse.
    pub fn counts(&self, side: usize) -> Vec<u32> {
        let Count {
            counted,
            false_lit,
            false_shadow,
            interior,
        } = self.counts[side.min(1)];
        vec![counted, false_lit, false_shadow, interior]
    }
}

/// A texture on its way to the CPU.
struct Copy {
    buffer: wgpu::Buffer,
    mapped: oneshot::Receiver<Result<(), wgpu::BufferAsyncError>>,
    /// Bytes of a row, without and with what fills it up.
    row: [usize; 2],
}

impl Copy {
    fn new(gpu: &Gpu, texture: &wgpu::Texture, encoder: &mut wgpu::CommandEncoder) -> Self {
        let pixel = texture.format().block_copy_size(None).unwrap_or(4);
        let row = texture.width() * pixel;
        let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("copy"),
            size: u64::from(padded) * u64::from(texture.height()),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let destination = wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded),
                rows_per_image: None,
            },
        };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, texture.size());
        let (sender, mapped) = oneshot::channel();
        encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Read, .., move |result| {
            // Nobody may be waiting any more.
            let _ = sender.send(result);
        });
        Self {
            buffer,
            mapped,
            row: [row, padded].map(|bytes| bytes as usize),
        }
    }

    async fn bytes(self) -> Result<Vec<u8>> {
        self.mapped.await??;
        let [row, padded] = self.row;
        let bytes = self.buffer.get_mapped_range(..)?;
        let rows = bytes.chunks(padded).flat_map(|bytes| &bytes[..row]);
        Ok(rows.copied().collect())
    }
}

fn promise(work: impl Future<Output = Result<JsValue>> + 'static) -> Promise {
    let work = async move { work.await.map_err(|error| JsError::from(&*error).into()) };
    wasm_bindgen_futures::future_to_promise(work)
}

fn js(error: anyhow::Error) -> JsError {
    JsError::new(&format!("{error:#}"))
}
