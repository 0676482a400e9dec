//! What the page shows, wherever it is drawn: a scene, both halves of its picture, and a smaller picture
//! of the same by which the error is measured.

use anyhow::Result;
use host::gpu::Gpu;
use shadows::wgpu;

use crate::choice::Choice;
use crate::job::Job;
use crate::picture::Picture;
use crate::world::World;

/// Samples a pixel of what is seen. What is measured has one: the reference looks at pixels' centres.
const SAMPLES: u32 = 4;

/// The page's state but for its canvas.
pub struct App {
    pub gpu: Gpu,
    pub world: World,
    choice: Choice,
    picture: Picture,
    measured: Option<Picture>,
}

impl App {
    /// A scene and a picture of so many pixels.
    ///
    /// # Errors
    /// If a choice is out of its range, or the device cannot do it.
    pub fn new(gpu: Gpu, choice: Choice, size: [u32; 2]) -> Result<Self> {
        let world = World::new(&gpu, choice.place, choice.light)?;
        let picture = Picture::new(&gpu, &world, &choice, size, SAMPLES)?;
        Ok(Self {
            gpu,
            world,
            choice,
            picture,
            measured: None,
        })
    }

    /// What is shown, and how.
    pub fn choice(&self) -> &Choice {
        &self.choice
    }

    /// What was last drawn.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Takes over other choices and another size. Another scene or kind of light begins with its own camera
    /// and light.
    ///
    /// # Errors
    /// As [`new`](Self::new); what was shown can then still be drawn.
    pub fn update(&mut self, choice: Choice, size: [u32; 2]) -> Result<()> {
        let elsewhere = choice.place != self.choice.place || choice.light != self.choice.light;
        if elsewhere {
            let world = World::new(&self.gpu, choice.place, choice.light)?;
            self.picture = Picture::new(&self.gpu, &world, &choice, size, SAMPLES)?;
            self.world = world;
            self.measured = None;
        } else {
            self.picture.update(&self.gpu, &self.world, &choice, size)?;
        }
        self.choice = choice;
        Ok(())
    }

    /// Records the halves that are to be seen.
    ///
    /// # Errors
    /// If a method refuses the frame.
    pub fn encode(&mut self, seen: [bool; 2], encoder: &mut wgpu::CommandEncoder) -> Result<()> {
        self.picture.encode(&self.gpu, &self.world, seen, encoder)
    }

    /// Records both halves in another size, one sample a pixel, to be compared with the reference: the
    /// textures of their visibility, and what the reference must know.
    ///
    /// # Errors
    /// As [`new`](Self::new) and [`encode`](Self::encode).
    pub fn encode_measured(
        &mut self,
        size: [u32; 2],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<([wgpu::Texture; 2], Job)> {
        let (gpu, world, choice) = (&self.gpu, &self.world, &self.choice);
        let mut picture = match self.measured.take() {
            Some(mut picture) => {
                picture.update(gpu, world, choice, size)?;
                picture
            }
            None => Picture::new(gpu, world, choice, size, 1)?,
        };
        picture.encode(gpu, world, [true; 2], encoder)?;
        let sides = picture.sides();
        let textures = sides
            .each_ref()
            .map(|side| side.renderer.visibility().clone());
        let job = Job {
            clip_from_world: world.inputs(size)?.view.clip_from_world(),
            light: *world.scene.light(),
            interiors: sides.each_ref().map(|side| side.interior()),
        };
        self.measured = Some(picture);
        Ok((textures, job))
    }
}
