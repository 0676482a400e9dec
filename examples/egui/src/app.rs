//! The application: controls at the side, the picture in the middle.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result};
use eframe::egui::{
    self, CentralPanel, Color32, Panel, Rect, Sense, TextureHandle, Ui, pos2, vec2,
};
use eframe::egui_wgpu::{Callback, RenderState};
use shadows::glam::{Quat, Vec3, Vec3Swizzles as _, Vec4};
use shadows::wgpu;

use crate::measure::{self, Job, Measured, STRIDE, Shot};
use crate::panel::{Controls, error_ui, table};
use crate::viewport::{Paint, Show, Viewport};
use host::image;
use host::scene::Scene;

/// So long nothing must change before the error is measured.
const PAUSE: Duration = Duration::from_millis(300);

pub struct App {
    state: RenderState,
    controls: Controls,
    /// Half the width of the box in which the light may be moved.
    reach: f32,
    /// What the picture was drawn from, and since when.
    drawn: (Controls, [u32; 2], Instant),
    jobs: Sender<Job>,
    answers: Receiver<Result<Measured>>,
    measured: Option<Result<Measured>>,
    picture: Option<TextureHandle>,
    /// Whether a picture is being judged, and whether it is still the one in the window.
    pending: Option<bool>,
    /// Where one is wanted: to which file, until it has been asked for.
    screenshot: Option<Option<PathBuf>>,
    taken: Arc<AtomicBool>,
}

impl App {
    /// # Errors
    /// If the scene does not fit egui's device.
    pub fn new(
        creation: &eframe::CreationContext<'_>,
        scene: Scene,
        mut controls: Controls,
        screenshot: Option<PathBuf>,
    ) -> Result<Self> {
        let state = creation
            .wgpu_render_state
            .clone()
            .context("egui runs without wgpu")?;
        let size = scene.bounds().size();
        controls.light = scene.light().place.truncate();
        let (jobs, answers) = measure::start(scene.clone(), creation.egui_ctx.clone())?;
        let viewport = Viewport::new(&state, scene)?;
        state.renderer.write().callback_resources.insert(viewport);
        Ok(Self {
            state,
            controls,
            reach: size.max_element() as f32 / 2.0,
            drawn: (controls, [0; 2], Instant::now()),
            jobs,
            answers,
            measured: None,
            picture: None,
            pending: None,
            screenshot: screenshot.map(Some),
            taken: Arc::default(),
        })
    }

    fn side(&mut self, ui: &mut Ui) {
        self.controls.ui(ui, self.reach);
        let renderer = self.state.renderer.read();
        let viewport = renderer.callback_resources.get::<Viewport>();
        if let Some(viewport) = viewport {
            table(ui, "Statistics", &viewport.statistics());
        }
        error_ui(
            ui,
            self.measured.as_ref(),
            viewport.and_then(Viewport::problem),
        );
    }

    fn middle(&mut self, ui: &mut Ui) {
        let scale = ui.ctx().pixels_per_point();
        let pixels = |points: f32| ((points * scale) as u32 / STRIDE).max(1) * STRIDE;
        let available = ui.available_size();
        let size = [pixels(available.x), pixels(available.y)];
        let points = vec2(size[0] as f32, size[1] as f32) / scale;
        let (rect, _) = ui.allocate_exact_size(points, Sense::hover());

        self.take_answer(ui.ctx());
        let read = self.is_due(ui.ctx(), size).then(|| self.send_job(size));
        self.paint(ui, rect, size, read.flatten());
    }

    /// Homogeneous, world space.
    fn light(&self) -> Vec4 {
        let w = f32::from(u8::from(!self.controls.settings.directional));
        self.controls.light.extend(w)
    }

    fn paint(&self, ui: &Ui, rect: Rect, size: [u32; 2], read: Option<Sender<Shot>>) {
        let Controls { settings, show, .. } = self.controls;
        let paint = Paint {
            settings,
            light: self.light(),
            size,
            show,
            read,
        };
        ui.painter().add(Callback::new_paint_callback(rect, paint));
        if let (Show::Error, Some(picture)) = (show, &self.picture) {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter()
                .image(picture.id(), rect, whole, Color32::WHITE);
        }
    }

    /// Whether the picture has been the same for a while and its error is not known.
    fn is_due(&mut self, context: &egui::Context, size: [u32; 2]) -> bool {
        let (drawn, drawn_size, _) = &self.drawn;
        let shown = Controls {
            show: self.controls.show,
            ..*drawn
        };
        if shown != self.controls || *drawn_size != size || self.controls.turning {
            self.drawn = (self.controls, size, Instant::now());
            self.measured = None;
            self.picture = None;
            self.pending = self.pending.map(|_| false);
        }
        if self.measured.is_some() {
            return false;
        }
        context.request_repaint_after(PAUSE / 10);
        if self.pending.is_some() {
            // Polling is what hands the picture over once it is drawn.
            let _ = self.state.device.poll(wgpu::PollType::Poll);
        }
        self.pending.is_none() && self.drawn.2.elapsed() >= PAUSE
    }

    /// Has the picture that is about to be drawn judged; gives where its pixels are to be sent.
    fn send_job(&mut self, size: [u32; 2]) -> Option<Sender<Shot>> {
        let (pixels, shot) = channel();
        let job = Job {
            light: self.light(),
            size,
            shot,
        };
        self.jobs.send(job).ok()?;
        self.pending = Some(true);
        Some(pixels)
    }

    fn take_answer(&mut self, context: &egui::Context) {
        let Ok(answer) = self.answers.try_recv() else {
            return;
        };
        let current = self.pending.take() == Some(true);
        if current {
            self.picture = answer.as_ref().ok().map(|measured| {
                let picture = measured.picture.clone();
                context.load_texture("error", picture, egui::TextureOptions::NEAREST)
            });
            self.measured = Some(answer);
        }
        context.request_repaint();
    }

    /// Turns the light about the vertical axis.
    fn turn(&mut self, context: &egui::Context) {
        if self.controls.turning {
            let seconds = context.input(|input| input.stable_dt);
            let light = &mut self.controls.light;
            if light.xz().length() < 0.05 * self.reach {
                light.x = 0.25 * self.reach; // on the axis nothing would move
            }
            *light = Quat::from_axis_angle(Vec3::Y, 0.5 * seconds) * *light;
            context.request_repaint();
        }
    }

    /// As soon as everything is there: one picture of the window, then the end.
    fn take_screenshot(&mut self, context: &egui::Context) {
        if self.measured.is_none() || self.screenshot.is_none() {
            return;
        }
        if self.taken.load(Ordering::Acquire) {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        // The pixels arrive with a later frame.
        context.request_repaint();
        let Some(path) = self.screenshot.as_mut().and_then(Option::take) else {
            return;
        };
        let taken = Arc::clone(&self.taken);
        context.request_screenshot(move |window| {
            let size = window.size.map(|side| side as u32);
            let color = |pixel: &Color32| [pixel.r(), pixel.g(), pixel.b()];
            let pixels: Vec<[u8; 3]> = window.pixels.iter().map(color).collect();
            let file = image::rgb_png(size, &pixels);
            match file.and_then(|file| Ok(std::fs::write(&path, file)?)) {
                Ok(()) => println!("{}", path.display()),
                Err(error) => eprintln!("cannot write {}: {error:#}", path.display()),
            }
            taken.store(true, Ordering::Release);
        });
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        self.turn(&context);
        // Before the panel is drawn: what is photographed has been on screen, error and all.
        self.take_screenshot(&context);
        // Of one width, whatever it says, so that the picture stays the same.
        let controls = Panel::left("controls").resizable(false).exact_size(290.0);
        controls.show(ui, |ui| {
            egui::ScrollArea::vertical().show(ui, |ui| self.side(ui));
        });
        CentralPanel::no_frame().show(ui, |ui| self.middle(ui));
    }
}
