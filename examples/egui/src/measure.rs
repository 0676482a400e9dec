//! The error of what the window shows, against rays cast in f64, on a thread of its own.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use anyhow::{Context as _, Result};
use eframe::egui::{Color32, ColorImage, Context};
use shadows::glam::Vec4;
use shadows::reference::{Comparison, Interior, ReferenceImage, ReferenceScene, Verdict};

use host::exact::reference_scene;
use host::renderer;
use host::scene::{Scene, homogeneous};

/// The reference looks at every third pixel of every third row: at the very same points of the
/// picture, with a ninth of the rays.
pub const STRIDE: u32 = 3;

/// A picture that is to be judged.
pub struct Job {
    pub light: Vec4,
    /// Pixels of the picture: multiples of [`STRIDE`].
    pub size: [u32; 2],
    /// Its pixels, once they are drawn.
    pub shot: Receiver<Shot>,
}

/// What was drawn.
pub struct Shot {
    /// One byte a pixel.
    pub visibility: Vec<u8>,
    /// Where resolution is no excuse.
    pub interior: Interior,
}

/// How wrong it is.
pub struct Measured {
    pub error: Comparison,
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
        let shot = job.shot.recv().context("the picture was not drawn")?;
        let [width, height] = job.size.map(|side| side / STRIDE);
        let pixel = |x: u32, y: u32| {
            let [x, y] = [x, y].map(|at| at * STRIDE + STRIDE / 2);
            shot.visibility[(y * job.size[0] + x) as usize]
        };
        let seen: Vec<u8> = (0..height)
            .flat_map(|y| (0..width).map(move |x| pixel(x, y)))
            .collect();
        let reference = self.reference(job)?;
        let error = reference.compare(&seen, shot.interior)?;
        Ok(Measured {
            picture: picture([width, height], &seen, &error.verdicts),
            error,
            seconds: reference.seconds(),
        })
    }

    fn reference(&mut self, job: &Job) -> Result<&ReferenceImage> {
        let size = job.size.map(|side| side / STRIDE);
        let known = self.known.take();
        let known = match known.filter(|(light, other, _)| (*light, *other) == (job.light, size)) {
            Some(known) => known,
            None => {
                let light = homogeneous(job.light);
                let range = (!light.is_directional()).then_some(self.scene.light().range);
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
