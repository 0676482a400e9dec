//! Both halves of a picture, each drawn in whole by its own method.

use anyhow::Result;
use host::gpu::Gpu;
use host::renderer::{Look, Renderer};
use host::scene::LightKind;
use shadows::reference::Interior;
use shadows::wgpu;

use crate::choice::{Choice, Maps, Method, Place};
use crate::shadow::Shadow;
use crate::statistics::Rows;
use crate::world::World;

/// The left and the right half.
pub struct Picture {
    /// Pixels.
    size: [u32; 2],
    look: Look,
    sides: [Side; 2],
}

/// One half.
pub struct Side {
    made_for: MadeFor,
    pub renderer: Renderer,
    shadow: Shadow,
}

/// With anything else here, objects are made anew.
#[derive(Clone, Copy, Debug, PartialEq)]
struct MadeFor {
    place: Place,
    light: LightKind,
    method: Method,
    maps: Maps,
}

impl Picture {
    /// A picture of so many pixels, each of so many samples.
    ///
    /// # Errors
    /// If a choice is out of its range, or the device cannot do it.
    pub fn new(
        gpu: &Gpu,
        world: &World,
        choice: &Choice,
        size: [u32; 2],
        samples: u32,
    ) -> Result<Self> {
        let look = Look {
            samples,
            ..Default::default()
        };
        let side = |method| Side::new(gpu, world, MadeFor::new(choice, method), size, look);
        Ok(Self {
            size,
            look,
            sides: [side(choice.left)?, side(choice.right)?],
        })
    }

    /// Takes over other choices and another size.
    ///
    /// # Errors
    /// As [`new`](Self::new); the picture then stays as it was.
    pub fn update(
        &mut self,
        gpu: &Gpu,
        world: &World,
        choice: &Choice,
        size: [u32; 2],
    ) -> Result<()> {
        let methods = [choice.left, choice.right];
        for (side, method) in self.sides.iter_mut().zip(methods) {
            let wanted = MadeFor::new(choice, method);
            if side.made_for != wanted {
                *side = Side::new(gpu, world, wanted, size, self.look)?;
            }
        }
        self.size = size;
        Ok(())
    }

    /// Records both halves, or those that are to be seen.
    ///
    /// # Errors
    /// If a method refuses the frame.
    pub fn encode(
        &mut self,
        gpu: &Gpu,
        world: &World,
        seen: [bool; 2],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<()> {
        let inputs = world.inputs(self.size)?;
        let sides = self.sides.iter_mut().zip(seen).filter(|(_, seen)| *seen);
        for (side, _) in sides {
            let scene = &world.scene_gpu;
            side.renderer.update(gpu, self.size, &world.scene)?;
            side.shadow.prepare(gpu, &inputs)?;
            side.renderer.draw_ambient(encoder, scene);
            side.shadow.encode(&side.renderer, scene, encoder)?;
            side.shadow.shade(&side.renderer, scene, encoder);
        }
        Ok(())
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Left and right.
    pub fn sides(&self) -> &[Side; 2] {
        &self.sides
    }
}

impl MadeFor {
    fn new(choice: &Choice, method: Method) -> Self {
        Self {
            place: choice.place,
            light: choice.light,
            method,
            maps: choice.maps,
        }
    }
}

impl Side {
    fn new(
        gpu: &Gpu,
        world: &World,
        made_for: MadeFor,
        size: [u32; 2],
        look: Look,
    ) -> Result<Self> {
        let renderer = Renderer::with_look(gpu, size, &world.scene, &world.scene_gpu, look)?;
        let MadeFor {
            light,
            method,
            maps,
            ..
        } = &made_for;
        Ok(Self {
            shadow: Shadow::new(gpu, &renderer, *light, *method, maps)?,
            renderer,
            made_for,
        })
    }

    /// What the last frame came to.
    pub fn statistics(&self) -> Rows {
        self.shadow.statistics()
    }

    /// Where resolution is no excuse for errors of the last frame.
    pub fn interior(&self) -> Interior {
        self.shadow.interior()
    }
}
