//! Times and errors of the techniques, measured in turn in one process.

use std::time::Instant;

use anyhow::{Context as _, Result};
use shadows::reference::{Comparison, Interior, ReferenceImage};

use crate::lamps::{Lamps, Shown, Truth};
use crate::shadow::{Cost, Shadow};
use crate::soft::Soft;
use crate::stage::{Picture, Stage};
use crate::survey::Bake;
use crate::technique::Technique;
use host::gpu::Gpu;
use host::timer::{Clock, Timer};

/// How to measure.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a> {
    pub techniques: &'a [Technique],
    /// Rounds; each times every technique once.
    pub frames: u32,
    /// Which technique goes first in the first round; the next one does in the next.
    pub seed: u64,
}

/// Milliseconds of one kind of work, one sample a round.
#[derive(Clone, Debug)]
pub struct Times {
    pub samples: Vec<f64>,
    pub clock: Clock,
}

impl Times {
    fn new(clock: Clock) -> Self {
        Self {
            samples: Vec::new(),
            clock,
        }
    }

    /// The median; the mean of the middle two for an even count.
    pub fn median(&self) -> f64 {
        median(&self.samples)
    }

    /// The smallest sample.
    pub fn min(&self) -> f64 {
        self.samples.iter().copied().fold(f64::NAN, f64::min)
    }
}

/// The mean of the middle two for an even count; NaN of nothing.
pub fn median(samples: &[f64]) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len();
    match count {
        0 => f64::NAN,
        _ => 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]),
    }
}

/// What was found about one technique.
pub struct Measured {
    pub technique: Technique,
    /// On the CPU.
    pub prepare: Times,
    /// The map, or the volumes and their stencil pass.
    pub generate: Times,
    /// The lit pass less the lit pass without shadows of the same round: noise may make it
    /// negative, and so may a stencil test that spares more work than it costs.
    pub shade: Times,
    pub cost: Cost,
    pub error: Comparison,
    /// How many of the scene's lights it shadows.
    pub lights: usize,
    pub picture: Picture,
    /// Of kernels that make soft edges, once they are judged by them.
    pub soft: Option<Soft>,
    /// What was done once, and is in no frame's time.
    pub bake: Option<Bake>,
}

impl Measured {
    /// What the shadows cost a frame.
    pub fn total_ms(&self) -> f64 {
        total_ms([&self.prepare, &self.generate, &self.shade])
    }

    /// Wrong pixels, in per cent of those that face the light.
    pub fn wrong_percent(&self) -> f64 {
        percent(self.error.false_lit + self.error.false_shadow, &self.error)
    }
}

/// The median of the rounds' sums.
fn total_ms([prepare, generate, shade]: [&Times; 3]) -> f64 {
    let rounds = prepare.samples.iter().zip(&generate.samples);
    let rounds = rounds.zip(&shade.samples);
    let sums: Vec<f64> = rounds.map(|((p, g), s)| p + g + s).collect();
    median(&sums)
}

/// A count of pixels in per cent of those that face the light; 0 if none does.
pub fn percent(pixels: usize, error: &Comparison) -> f64 {
    100.0 * pixels as f64 / error.lit_facing.max(1) as f64
}

struct Contestant {
    lamps: Lamps,
    shown: Shown,
    prepare: Times,
    generate: Times,
    shade: Times,
}

/// Measures the techniques on a stage. `step` is called after each timed frame.
///
/// # Errors
/// If the device cannot do what a technique needs.
pub fn measure(
    gpu: &Gpu,
    stage: &Stage,
    truth: &Truth,
    plan: &Plan<'_>,
    step: &dyn Fn(),
) -> Result<Vec<Measured>> {
    let timer = Timer::new(gpu);
    let mut contestants = Vec::new();
    for technique in plan.techniques {
        // The first frame, not timed, also makes what is made lazily.
        let contestant = Contestant::new(gpu, stage, technique, timer.clock());
        contestants.push(contestant.with_context(|| technique.name.to_string())?);
    }
    let count = contestants.len();
    for round in 0..plan.frames as usize {
        let first = (plan.seed as usize).wrapping_add(round);
        for turn in 0..count {
            let place = first.wrapping_add(turn) % count;
            contestants[place].time(gpu, stage, &timer)?;
            step();
        }
    }
    contestants
        .into_iter()
        .map(|contestant| contestant.judged(truth))
        .collect()
}

/// Frames that [`once`] times.
pub const FRAMES_AT_ONCE: usize = 3;

/// Milliseconds of a frame of a technique that is made for it: the median of a few, the first not
/// counted.
///
/// # Errors
/// If the device cannot do what the technique needs.
pub fn once(gpu: &Gpu, stage: &Stage, technique: &Technique) -> Result<f64> {
    let timer = Timer::new(gpu);
    let mut contestant = Contestant::new(gpu, stage, technique, timer.clock())?;
    for _ in 0..FRAMES_AT_ONCE {
        contestant.time(gpu, stage, &timer)?;
    }
    let Contestant {
        prepare,
        generate,
        shade,
        ..
    } = contestant;
    Ok(total_ms([&prepare, &generate, &shade]))
}

/// Wrong pixels of a technique, as a part of those that face the light.
///
/// # Errors
/// As [`once`].
pub fn error(
    gpu: &Gpu,
    stage: &Stage,
    reference: &ReferenceImage,
    technique: &Technique,
) -> Result<f64> {
    let mut shadow = Shadow::new(gpu, &stage.renderer, technique.clone())?;
    let picture = stage.picture(gpu, &mut shadow, &stage.inputs)?;
    // Which errors are in the interior is not asked, and would cost rays.
    let error = reference.compare(&picture.visibility, Interior::Screen)?;
    Ok((error.false_lit + error.false_shadow) as f64 / error.lit_facing.max(1) as f64)
}

impl Contestant {
    fn new(gpu: &Gpu, stage: &Stage, technique: &Technique, clock: Clock) -> Result<Self> {
        let mut lamps = Lamps::new(gpu, stage, technique)?;
        let shown = lamps.picture(gpu, stage)?;
        Ok(Self {
            lamps,
            shown,
            prepare: Times::new(Clock::Wall),
            generate: Times::new(clock),
            shade: Times::new(clock),
        })
    }

    fn time(&mut self, gpu: &Gpu, stage: &Stage, timer: &Timer) -> Result<()> {
        let (renderer, scene) = (&stage.renderer, &stage.scene_gpu);
        let lights = self.lamps.lights().to_vec();
        gpu.run(|encoder| renderer.draw_ambient(encoder, scene));
        let unshadowed = lights.iter().map(|&light| {
            timer.time(gpu, |encoder| {
                renderer.draw_lit_by(encoder, scene, light, renderer.unshadowed(), None);
            })
        });
        let without: f64 = unshadowed.sum();
        gpu.run(|encoder| renderer.draw_ambient(encoder, scene));

        let start = Instant::now();
        self.lamps.prepare(gpu, stage)?;
        let prepare = start.elapsed().as_secs_f64() * 1e3;
        let lamps = &mut self.lamps;
        let (mut generate, mut with) = (0.0, 0.0);
        for light in 0..lights.len() {
            generate += timer.time(gpu, |encoder| lamps.generate(stage, light, encoder));
            with += timer.time(gpu, |encoder| lamps.shade(stage, light, encoder));
        }

        self.prepare.samples.push(prepare);
        self.generate.samples.push(generate);
        self.shade.samples.push(with - without);
        Ok(())
    }

    fn judged(self, truth: &Truth) -> Result<Measured> {
        Ok(Measured {
            technique: self.lamps.technique().clone(),
            cost: self.lamps.cost(),
            error: truth.judge(&self.lamps, &self.shown.visibility)?,
            lights: self.lamps.lights().len(),
            picture: truth.picture(&self.lamps, self.shown),
            soft: None,
            bake: self.lamps.bake(),
            prepare: self.prepare,
            generate: self.generate,
            shade: self.shade,
        })
    }
}
