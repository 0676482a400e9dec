//! What the page's JavaScript calls.

use std::sync::{Arc, Mutex};

use anyhow::{Context as _, Result};
use host::gpu::Gpu;
use js_sys::{Promise, Uint8Array};
use shadows::glam::Vec2;
use shadows::{Bias, Support, wgpu};
use wasm_bindgen::prelude::*;
use web_sys::HtmlCanvasElement;

use crate::app::App;
use crate::choice::{Choice, Show};
use crate::compose::Compose;
use crate::digest::digest;
use crate::picture::Picture;
use crate::readback::{Readback, promise};

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
    error: Refusal,
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
        let error = Refusal::default();
        error.listen(&device);
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
        self.error.0.lock().ok().and_then(|error| error.clone())
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

    /// The scene in short, a line for each part of it.
    pub fn digest(&self) -> Vec<String> {
        digest(&self.app.world.scene)
    }

    /// The last frame's half, four bytes a pixel, sRGB.
    pub fn read(&self, side: usize) -> Promise {
        let picture: &Picture = self.app.picture();
        let texture = picture.sides()[side.min(1)].renderer.shaded();
        let gpu = &self.app.gpu;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let copy = Readback::new(gpu, texture, &mut encoder);
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
        let copies = textures.map(|texture| Readback::new(gpu, &texture, &mut encoder));
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

/// What a device refused first, or why it is gone.
#[derive(Clone, Default)]
struct Refusal(Arc<Mutex<Option<String>>>);

impl Refusal {
    fn listen(&self, device: &wgpu::Device) {
        let refusal = self.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            refusal.keep(error.to_string());
        }));
        let refusal = self.clone();
        device.set_device_lost_callback(move |_, message| {
            refusal.keep(format!("The GPU is lost; load the page again. {message}"));
        });
    }

    fn keep(&self, message: String) {
        web_sys::console::error_1(&(&message).into());
        if let Ok(mut kept) = self.0.lock() {
            kept.get_or_insert(message);
        }
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

/// An error as JavaScript has it.
pub fn js(error: anyhow::Error) -> JsError {
    JsError::new(&format!("{error:#}"))
}
