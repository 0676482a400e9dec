//! What scenes and hard cases come to under one variant.

use anyhow::Result;
use indicatif::ProgressBar;
use shadows::reference::ReferenceImage;

use super::variant::Variant;
use super::{Plan, bounds};
use crate::hard;
use crate::hard::cases::Case;
use crate::hard::trial::Trial;
use crate::shadow::Shadow;
use crate::stage::Stage;
use crate::technique::{Config, Technique};
use host::gpu::Gpu;

/// Wrong pixels of a kind of technique, the worst of its techniques.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrong {
    /// In per cent of the pixels that face the light.
    pub percent: f64,
    /// Of these in pixels, where resolution is no excuse.
    pub interior: usize,
}

impl Wrong {
    fn worst(&mut self, other: Self) {
        self.percent = self.percent.max(other.percent);
        self.interior = self.interior.max(other.interior);
    }
}

/// Maps and volumes.
pub type Kinds = [Wrong; 2];

/// One variant.
pub struct Row {
    pub variant: Variant,
    /// As many as there are scenes.
    pub scenes: Vec<Kinds>,
    pub cases: Vec<(&'static str, Kinds)>,
    /// What failed in the hard cases, known limits being what they are there.
    pub failures: Vec<String>,
}

/// What is drawn under each variant.
pub struct Trials<'a> {
    gpu: &'a Gpu,
    plan: &'a Plan,
    truths: Vec<ReferenceImage>,
    cases: &'a [Case],
    techniques: &'a [Technique],
}

impl<'a> Trials<'a> {
    /// # Errors
    /// If a scene does not fit the device.
    pub fn new(
        gpu: &'a Gpu,
        plan: &'a Plan,
        cases: &'a [Case],
        techniques: &'a [Technique],
    ) -> Result<Self> {
        let truth = |scene: &host::scene::Scene| {
            Stage::new(gpu, scene.clone(), plan.size)?.reference(|_| ())
        };
        Ok(Self {
            gpu,
            plan,
            truths: plan.scenes.iter().map(truth).collect::<Result<_>>()?,
            cases,
            techniques,
        })
    }

    /// # Errors
    /// If the device cannot do what a technique needs.
    pub fn under(&self, variant: Variant, bar: &ProgressBar) -> Result<Row> {
        let mut row = Row {
            variant,
            scenes: Vec::new(),
            cases: Vec::new(),
            failures: Vec::new(),
        };
        let installed = variant.install(self.plan.size);
        for (scene, truth) in self.plan.scenes.iter().zip(&self.truths) {
            row.scenes.push(self.scene(scene, truth)?);
            bar.inc(1);
        }
        drop(installed);
        let _installed = variant.install(hard::SIZE);
        for case in self.cases {
            let trial = Trial {
                gpu: self.gpu,
                case,
                techniques: self.techniques,
                limits: bounds::of(variant.name),
            };
            let found = trial.run(self.plan.rounds, bar)?;
            let mut kinds = Kinds::default();
            for (technique, outcome) in self.techniques.iter().zip(&found.outcomes) {
                let Some(outcome) = outcome else { continue };
                if !is_textbook(technique) {
                    kinds[kind(technique)].worst(Wrong {
                        percent: outcome.wrong_percent(),
                        interior: outcome.interior(),
                    });
                }
                let failures = outcome.failures.iter();
                let named =
                    failures.map(|what| format!("{}, {}: {what}", case.name, technique.name));
                row.failures.extend(named);
            }
            row.cases.push((case.name, kinds));
        }
        Ok(row)
    }

    fn scene(&self, scene: &host::scene::Scene, truth: &ReferenceImage) -> Result<Kinds> {
        let stage = Stage::new(self.gpu, scene.clone(), self.plan.size)?;
        let mut kinds = Kinds::default();
        for technique in &self.plan.techniques {
            if !technique.config.applies_to(scene.light().kind()) || is_textbook(technique) {
                continue;
            }
            let mut shadow = Shadow::new(self.gpu, &stage.renderer, technique.clone())?;
            let picture = stage.picture(self.gpu, &mut shadow, &stage.inputs)?;
            let found = truth.compare(&picture.visibility, shadow.interior())?;
            let wrong = found.false_lit + found.false_shadow;
            kinds[kind(technique)].worst(Wrong {
                percent: 100.0 * wrong as f64 / found.lit_facing.max(1) as f64,
                interior: found.false_lit_interior + found.false_shadow_interior,
            });
        }
        Ok(kinds)
    }
}

fn kind(technique: &Technique) -> usize {
    usize::from(matches!(technique.config, Config::Volume(_)))
}

/// What is there to be beaten.
fn is_textbook(technique: &Technique) -> bool {
    technique.name.ends_with("textbook")
}
