//! Several lights at once: one technique for all of them, and the truth about each.

use anyhow::Result;
use shadows::reference::{Class, Comparison, Interior, ReferenceImage, Verdict};
use shadows::wgpu;

use crate::shadow::{Cost, Shadow};
use crate::stage::{Picture, Stage};
use crate::survey::Bake;
use crate::technique::{Config, Technique};
use host::gpu::Gpu;

/// A technique at work for those of a stage's lights that it can shadow.
pub struct Lamps {
    technique: Technique,
    /// Their places among the stage's lights.
    lights: Vec<usize>,
    means: Means,
}

/// A frame of several lights.
pub struct Shown {
    /// Of each light, 255 lit; rows from the top.
    pub visibility: Vec<Vec<u8>>,
    /// Under all of them.
    pub shaded: Vec<[u8; 3]>,
}

enum Means {
    /// One at a time, each with a map and a bind group of its own.
    Each(Vec<Shadow>),
    /// All in one atlas.
    Atlas(Box<Shadow>),
}

impl Lamps {
    /// Makes what the technique needs.
    ///
    /// # Errors
    /// If the device cannot do it.
    pub fn new(gpu: &Gpu, stage: &Stage, technique: &Technique) -> Result<Self> {
        let all = 0..stage.scene.lights.len();
        let applies = |at: &usize| technique.config.applies_to(stage.scene.lights[*at].kind());
        let lights: Vec<usize> = all.filter(applies).collect();
        let means = match &technique.config {
            Config::Atlas { .. } => {
                let kinds = lights.iter().map(|&at| stage.scene.lights[at].kind());
                let own = technique.for_kinds(&kinds.collect::<Vec<_>>());
                Means::Atlas(Box::new(Shadow::new(gpu, &stage.renderer, own)?))
            }
            _ => {
                let each = lights.iter();
                let new = |_| Shadow::new(gpu, &stage.renderer, technique.clone());
                Means::Each(each.map(new).collect::<Result<_>>()?)
            }
        };
        Ok(Self {
            technique: technique.clone(),
            lights,
            means,
        })
    }

    /// Which technique it is.
    pub fn technique(&self) -> &Technique {
        &self.technique
    }

    /// The places of its lights among the stage's.
    pub fn lights(&self) -> &[usize] {
        &self.lights
    }

    /// The frame's work on the CPU, for all lights.
    ///
    /// # Errors
    /// If the technique refuses a light.
    pub fn prepare(&mut self, gpu: &Gpu, stage: &Stage) -> Result<()> {
        let inputs = self.lights.iter().map(|&light| stage.inputs_of(light));
        match &mut self.means {
            Means::Each(shadows) => shadows
                .iter_mut()
                .zip(inputs)
                .try_for_each(|(shadow, inputs)| shadow.prepare(gpu, &inputs)),
            Means::Atlas(shadow) => {
                let inputs: Vec<_> = inputs.collect();
                shadow.prepare_all(gpu, &inputs)
            }
        }
    }

    /// Records what finds the shadows of one of its lights, or of all of them with the first. For
    /// volumes what [`shade`](Self::shade) records must come before the next light's.
    pub fn generate(&mut self, stage: &Stage, light: usize, encoder: &mut wgpu::CommandEncoder) {
        match &mut self.means {
            Means::Each(shadows) => {
                shadows[light].generate(&stage.renderer, &stage.scene_gpu, encoder);
            }
            Means::Atlas(shadow) if light == 0 => {
                shadow.generate(&stage.renderer, &stage.scene_gpu, encoder);
            }
            Means::Atlas(_) => {}
        }
    }

    /// Records the lit pass of one of its lights.
    pub fn shade(&self, stage: &Stage, light: usize, encoder: &mut wgpu::CommandEncoder) {
        let (renderer, scene) = (&stage.renderer, &stage.scene_gpu);
        let place = self.lights[light];
        match &self.means {
            Means::Each(shadows) => shadows[light].shade_by(renderer, scene, place, encoder),
            Means::Atlas(shadow) => shadow.shade_by(renderer, scene, place, encoder),
        }
    }

    /// A frame: what it shows, and each light's visibility.
    ///
    /// # Errors
    /// If the technique refuses a light.
    pub fn picture(&mut self, gpu: &Gpu, stage: &Stage) -> Result<Shown> {
        self.prepare(gpu, stage)?;
        gpu.run(|encoder| stage.renderer.draw_ambient(encoder, &stage.scene_gpu));
        let mut all = Vec::new();
        for light in 0..self.lights.len() {
            gpu.run(|encoder| {
                self.generate(stage, light, encoder);
                self.shade(stage, light, encoder);
            });
            all.push(stage.renderer.read_visibility(gpu));
        }
        Ok(Shown {
            visibility: all,
            shaded: stage.renderer.read_shaded(gpu),
        })
    }

    /// What the last prepared frame takes.
    pub fn cost(&self) -> Cost {
        match &self.means {
            Means::Each(shadows) => {
                let mut sum = Cost {
                    bytes: 0,
                    draws: 0,
                    triangles: 0,
                };
                for cost in shadows.iter().map(Shadow::cost) {
                    sum.bytes += cost.bytes;
                    sum.draws += cost.draws;
                    sum.triangles += cost.triangles;
                }
                sum
            }
            Means::Atlas(shadow) => shadow.cost(),
        }
    }

    /// What was baked before the first frame: of all lights the time, of the first the rest.
    pub fn bake(&self) -> Option<Bake> {
        let Means::Each(shadows) = &self.means else {
            return None;
        };
        let all = shadows.iter().filter_map(Shadow::bake);
        all.reduce(|sum, own| Bake {
            seconds: sum.seconds + own.seconds,
            ..sum
        })
    }

    /// Where resolution is no excuse for the errors of one of its lights.
    pub fn interior(&self, light: usize) -> Interior {
        match &self.means {
            Means::Each(shadows) => shadows[light].interior(),
            Means::Atlas(shadow) => shadow.interior_of(light),
        }
    }
}

/// The truth about each of a stage's lights.
pub struct Truth {
    /// In the order of the lights.
    pub images: Vec<ReferenceImage>,
}

impl Truth {
    /// Of the stage as it is; `progress` hears what part of the first light's picture is done.
    ///
    /// # Errors
    /// If the scene or a light is broken.
    pub fn new(stage: &Stage, progress: impl Fn(f64) + Send + Sync + 'static) -> Result<Self> {
        let mut images = vec![stage.reference(progress)?];
        for light in 1..stage.scene.lights.len() {
            images.push(stage.relit(&images[0], light)?);
        }
        Ok(Self { images })
    }

    /// The first light's.
    pub fn first(&self) -> &ReferenceImage {
        &self.images[0]
    }

    /// Pairs of a pixel and a light that it faces within range: what errors are a part of.
    pub fn lit_facing(&self) -> usize {
        self.images.iter().map(ReferenceImage::lit_facing).sum()
    }

    /// What it took.
    pub fn seconds(&self) -> f64 {
        self.images.iter().map(ReferenceImage::seconds).sum()
    }

    /// Which part arrives of the lights that a pixel faces, 0 to 255.
    pub fn visibility(&self) -> Vec<u8> {
        let shown: Vec<Vec<u8>> = self.images.iter().map(ReferenceImage::visibility).collect();
        let all: Vec<usize> = (0..self.images.len()).collect();
        self.mean(&all, &shown)
    }

    /// Where any light may arrive: as [`ReferenceImage::coverage`].
    pub fn coverage(&self) -> Vec<u8> {
        let mut all = self.first().coverage();
        for image in &self.images[1..] {
            for (sum, own) in all.iter_mut().zip(image.coverage()) {
                *sum = (*sum).max(own);
            }
        }
        all
    }

    /// Judges a technique by all of its lights: a pixel is wrong for a light, and counts once for each
    /// light that it faces.
    ///
    /// # Errors
    /// If there is not one visibility a pixel.
    pub fn judge(&self, lamps: &Lamps, shown: &[Vec<u8>]) -> Result<Comparison> {
        let mut total: Option<Comparison> = None;
        for (light, (&place, visibility)) in lamps.lights.iter().zip(shown).enumerate() {
            let own = self.images[place].compare(visibility, lamps.interior(light))?;
            total = Some(match total {
                None => own,
                Some(total) => joined(total, &own),
            });
        }
        total.ok_or_else(|| anyhow::anyhow!("no light is left"))
    }

    /// One picture of what is shown of some lights: the mean over those that a pixel faces. Of a single
    /// light it is what was shown.
    pub fn picture(&self, lamps: &Lamps, shown: Shown) -> Picture {
        let shaded = shown.shaded;
        let visibility = match <[Vec<u8>; 1]>::try_from(shown.visibility) {
            Ok([only]) => only,
            Err(shown) => self.mean(&lamps.lights, &shown),
        };
        Picture { visibility, shaded }
    }

    fn mean(&self, places: &[usize], shown: &[Vec<u8>]) -> Vec<u8> {
        let pixels = self.first().classes().len();
        let (mut sum, mut count) = (vec![0_u32; pixels], vec![0_u32; pixels]);
        for (&place, shown) in places.iter().zip(shown) {
            let classes = self.images[place].classes();
            for (pixel, (class, &shown)) in classes.zip(shown).enumerate() {
                let faces = u32::from(matches!(class, Class::Lit | Class::Shadowed));
                sum[pixel] += faces * u32::from(shown);
                count[pixel] += faces;
            }
        }
        let mean = |(sum, count): (u32, u32)| (sum / count.max(1)) as u8;
        sum.into_iter().zip(count).map(mean).collect()
    }
}

/// The errors of two lights together; of a pixel's verdicts the worse.
fn joined(mut total: Comparison, own: &Comparison) -> Comparison {
    let squares = |one: &Comparison| one.rmse * one.rmse * one.lit_facing as f64;
    let sum = squares(&total) + squares(own);
    total.lit_facing += own.lit_facing;
    total.rmse = (sum / total.lit_facing.max(1) as f64).sqrt();
    total.false_lit += own.false_lit;
    total.false_shadow += own.false_shadow;
    total.false_lit_interior += own.false_lit_interior;
    total.false_shadow_interior += own.false_shadow_interior;
    let weight = |verdict: &Verdict| match verdict {
        Verdict::NotCounted => 0,
        Verdict::Right => 1,
        Verdict::FalseLit | Verdict::FalseShadow => 2,
        Verdict::FalseLitInterior | Verdict::FalseShadowInterior => 3,
    };
    for (verdict, other) in total.verdicts.iter_mut().zip(&own.verdicts) {
        if weight(other) > weight(verdict) {
            *verdict = *other;
        }
    }
    total
}
