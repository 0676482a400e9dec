//! The error of what the window shows, against rays cast in f64, on a thread of its own.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use anyhow::{Context as _, Result};
use eframe::egui::{Color32, ColorImage, Context};
use shadows::glam::Vec4;
use shadows::reference::{Comparison, Interior, ReferenceImage, ReferenceScene, Verdict};
use shadows::{HomogeneousLight, Kernel, Radius};

use crate::host::exact::reference_scene;
use crate::host::renderer;
use crate::host::scene::Scene;
use crate::shadow::{Settings, Technique};

/// The reference looks at every third pixel of every third row: at the very same points of the
/// picture, with a ninth of the rays.
pub const STRIDE: u32 = 3;

/// A picture that is to be judged.
pub struct Job {
    pub light: Vec4,
    pub settings: Settings,
    /// Pixels of the picture: multiples of [`STRIDE`].
    pub size: [u32; 2],
    /// One byte a pixel.
    pub visibility: Receiver<Vec<u8>>,
}

/// How wrong it is.
pub struct Measured {
    pub error: Comparison,
    /// Whether the interior counts are of use: there is no such measure for flat maps.
    pub interior: bool,
    /// Wall-clock seconds that the reference took, this time or earlier.
    pub seconds: f64,
    /// Of the pixels looked at: wrong ones in colour.
    pub picture: ColorImage,
}

/// Starts the thread, which ends when the sender is dropped. It has egui paint again when an answer
/// is there.
pub fn start(scene: Scene, context: Context) -> Result<(Sender<Job>, Receiver<Result<Measured>>)> {
    let (jobs, received) = channel::<Job>();
    let (answers, answered) = channel();
    let triangles = reference_scene(&scene)?;
    thread::Builder::new()
        .name("reference".into())
        .spawn(move || {
            let mut judge = Judge {
                scene,
                triangles,
                known: None,
            };
            for job in received {
                let answer = judge.measure(&job);
                if answers.send(answer).is_err() {
                    return;
                }
                context.request_repaint();
            }
        })
        .context("no thread for the reference")?;
    Ok((jobs, answered))
}

struct Judge {
    scene: Scene,
    triangles: ReferenceScene,
    /// The last reference: other kernels, sizes and biases have the same.
    known: Option<(Vec4, [u32; 2], ReferenceImage)>,
}

impl Judge {
    fn measure(&mut self, job: &Job) -> Result<Measured> {
        let visibility = job.visibility.recv().context("the picture was not drawn")?;
        let [width, height] = job.size.map(|side| side / STRIDE);
        let pixel = |x: u32, y: u32| {
            let [x, y] = [x, y].map(|at| at * STRIDE + STRIDE / 2);
            visibility[(y * job.size[0] + x) as usize]
        };
        let seen: Vec<u8> = (0..height)
            .flat_map(|y| (0..width).map(move |x| pixel(x, y)))
            .collect();
        let interior = interior(&job.settings);
        let reference = self.reference(job)?;
        let error = reference.compare(&seen, interior.unwrap_or(Interior::Screen))?;
        Ok(Measured {
            picture: picture([width, height], &seen, &error.verdicts),
            error,
            interior: interior.is_some(),
            seconds: reference.seconds(),
        })
    }

    fn reference(&mut self, job: &Job) -> Result<&ReferenceImage> {
        let size = job.size.map(|side| side / STRIDE);
        let known = self.known.take();
        let known = match known.filter(|(light, other, _)| (*light, *other) == (job.light, size)) {
            Some(known) => known,
            None => {
                let light = HomogeneousLight(job.light);
                let range = (!light.is_directional()).then_some(self.scene.range);
                // The view of the whole picture: the same rays, fewer of them.
                let view = renderer::view(&self.scene, job.size)?;
                let image = self
                    .triangles
                    .render(&view, size[0], size[1], light, range)?;
                (job.light, size, image)
            }
        };
        Ok(&self.known.insert(known).2)
    }
}

/// Where resolution is no excuse; `None` for flat maps.
fn interior(settings: &Settings) -> Option<Interior> {
    match (settings.technique, settings.directional) {
        (Technique::Map, true) => None,
        (Technique::Map, false) => Some(Interior::Map {
            face_size: settings.size,
            kernel_radius: radius_in_texels(settings.kernel),
        }),
        (Technique::Volumes | Technique::None, _) => Some(Interior::Screen),
    }
}

/// How far a kernel reaches on a face: disks lie on the surface, where texels are up to `sqrt(3)`
/// smaller than straight ahead, and reach to the centre of the texel they hit.
fn radius_in_texels(kernel: Kernel) -> f32 {
    match kernel.radius() {
        Radius::Texels(radius) if kernel.uses_pixel() => radius * 3.0_f32.sqrt() + 0.5,
        Radius::Texels(radius) => radius,
        Radius::World(_) => Radius::MAX_TEXELS,
    }
}

/// Wrong pixels in colour over the visibility in grey.
fn picture(size: [u32; 2], visibility: &[u8], verdicts: &[Verdict]) -> ColorImage {
    let color = |(&visibility, verdict): (&u8, &Verdict)| match verdict {
        Verdict::FalseLit | Verdict::FalseLitInterior => Color32::from_rgb(255, 40, 30),
        Verdict::FalseShadow | Verdict::FalseShadowInterior => Color32::from_rgb(60, 130, 255),
        Verdict::Right => Color32::from_gray(40 + visibility / 4),
        Verdict::NotCounted => Color32::from_gray(20),
    };
    let pixels = visibility.iter().zip(verdicts).map(color).collect();
    ColorImage::new(size.map(|side| side as usize), pixels)
}
