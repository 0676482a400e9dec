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

/// A picture's wrong pixels, or a case's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrong {
    /// In per cent of the pixels that face the light.
    pub percent: f64,
    /// Of these in pixels, where resolution is no excuse.
    pub interior: usize,
}

/// What a technique came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The scene or the case.
    pub what: String,
    pub technique: String,
    pub is_volume: bool,
    pub wrong: Wrong,
}

impl Found {
    fn new(what: &str, technique: &Technique, wrong: Wrong) -> Self {
        Self {
            what: what.into(),
            technique: technique.name.to_string(),
            is_volume: matches!(technique.config, Config::Volume(_)),
            wrong,
        }
    }
}

/// One variant.
pub struct Row {
    pub variant: Variant,
    /// The scenes, then the hard cases; the same of each variant, in the same order.
    pub found: Vec<Found>,
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
            found: Vec::new(),
            failures: Vec::new(),
        };
        let installed = variant.install(self.plan.size);
        for (scene, truth) in self.plan.scenes.iter().zip(&self.truths) {
            row.found.extend(self.scene(scene, truth)?);
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
            for (technique, outcome) in self.techniques.iter().zip(&found.outcomes) {
                let Some(outcome) = outcome else { continue };
                let wrong = Wrong {
                    percent: outcome.wrong_percent(),
                    interior: outcome.interior(),
                };
                row.found.push(Found::new(case.name, technique, wrong));
                let failures = outcome.failures.iter();
                let named =
                    failures.map(|what| format!("{}, {}: {what}", case.name, technique.name));
                row.failures.extend(named);
            }
        }
        Ok(row)
    }

    fn scene(&self, scene: &host::scene::Scene, truth: &ReferenceImage) -> Result<Vec<Found>> {
        let stage = Stage::new(self.gpu, scene.clone(), self.plan.size)?;
        let mut all = Vec::new();
        for technique in &self.plan.techniques {
            if !technique.config.applies_to(scene.light().kind()) {
                continue;
            }
            let mut shadow = Shadow::new(self.gpu, &stage.renderer, technique.clone())?;
            let picture = stage.picture(self.gpu, &mut shadow, &stage.inputs)?;
            let found = truth.compare(&picture.visibility, shadow.interior())?;
            let wrong = found.false_lit + found.false_shadow;
            let wrong = Wrong {
                percent: 100.0 * wrong as f64 / found.lit_facing.max(1) as f64,
                interior: found.false_lit_interior + found.false_shadow_interior,
            };
            all.push(Found::new(&scene.name, technique, wrong));
        }
        Ok(all)
    }
}
