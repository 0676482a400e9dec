//! One case: every technique that applies, on all its situations, in all rounds.

use anyhow::{Context as _, Result};
use indicatif::ProgressBar;
use shadows::glam::{Affine3A, DAffine3, DMat4, DVec3, Mat4};
use shadows::reference::Interior;
use shadows::{Caster, DepthConvention, HomogeneousLight, wgpu};

use super::SIZE;
use super::atlas::{Frames, play};
use super::cases::Case;
use super::expect::{Expect, expected, is_software};
use super::judge::{Frame, judge};
use super::limits::Known;
use super::outcome::Outcome;
use super::seams::Rates;
use super::situation::Situation;
use super::table::Row;
use crate::shadow::Shadow;
use crate::stage::Stage;
use crate::technique::{Config, Technique};
use host::gpu::Gpu;
use host::random::Random;
use host::scene::Scene;

/// What is tried.
pub struct Trial<'a> {
    pub gpu: &'a Gpu,
    pub case: &'a Case,
    pub techniques: &'a [Technique],
    /// What else is known not to be right.
    pub limits: &'a [Known],
}

/// What each technique gave, and the first situation's picture.
type Round = (Vec<Option<Outcome>>, Vec<[u8; 3]>);

impl Trial<'_> {
    /// Tries it in so many rounds, and tells `bar` of each.
    ///
    /// # Errors
    /// If the device cannot do what a technique needs.
    pub fn run(&self, rounds: u32, bar: &ProgressBar) -> Result<Row> {
        let Case {
            name,
            build,
            answer,
            ..
        } = *self.case;
        let mut outcomes: Vec<Option<Outcome>> = vec![None; self.techniques.len()];
        let mut picture = Vec::new();
        for round in 0..rounds {
            let (found, shaded) = self.round(round)?;
            for ((all, found), technique) in outcomes.iter_mut().zip(found).zip(self.techniques) {
                if let Some(mut found) = found {
                    found.end_round(&format!("round {round}"), self.expected(technique));
                    all.get_or_insert_default().add(found);
                }
            }
            if round == 0 {
                picture = shaded;
            }
            bar.inc(1);
        }
        for (technique, outcome) in self.techniques.iter().zip(&mut outcomes) {
            if let Some(outcome) = outcome {
                outcome.end(self.expected(technique));
            }
        }
        Ok(Row {
            name,
            build,
            answer,
            outcomes,
            picture,
            of_atlas: self.case.frames.is_some(),
        })
    }

    fn expected(&self, technique: &Technique) -> Expect {
        let mut limits = self.limits.iter();
        let known = limits.find(|known| known.is_of(self.case.name, &technique.name));
        match known {
            Some(known) => Expect::Limit(known.limit),
            None => expected(self.case, technique, is_software(self.gpu)),
        }
    }

    /// What each technique gave, and the first situation's picture.
    fn round(&self, round: u32) -> Result<Round> {
        let mut outcomes = vec![None; self.techniques.len()];
        let mut picture = Vec::new();
        for situation in (self.case.situations)(&mut Random(u64::from(round))) {
            let what = format!("round {round}, {}", situation.what);
            let shaded = self.situation(&situation, &what, &mut outcomes);
            let shaded = shaded.with_context(|| format!("{}: {what}", self.case.name))?;
            if picture.is_empty() {
                picture = shaded;
            }
        }
        for frames in self.frames(round) {
            let what = format!("round {round}, {}", frames.what);
            let shaded = self.course(&frames, &what, &mut outcomes);
            let shaded = shaded.with_context(|| format!("{}: {what}", self.case.name))?;
            if picture.is_empty() {
                picture = shaded;
            }
        }
        Ok((outcomes, picture))
    }

    fn frames(&self, round: u32) -> Vec<Frames> {
        let frames = self.case.frames;
        frames.map_or_else(Vec::new, |frames| frames(&mut Random(u64::from(round))))
    }

    /// What an atlas goes through under each technique that reads one; its first frame as the last of
    /// them shows it.
    fn course(
        &self,
        frames: &Frames,
        what: &str,
        outcomes: &mut [Option<Outcome>],
    ) -> Result<Vec<[u8; 3]>> {
        let truth = frames.truth()?;
        let mut shaded = Vec::new();
        for (technique, outcome) in self.techniques.iter().zip(outcomes) {
            let expect = self.expected(technique);
            if expect == Expect::Nothing {
                continue;
            }
            let shown = play(self.gpu, frames, technique, |module| module)?;
            for light in &shown {
                let found = light.judge(what, &truth, &light.visibility, expect)?;
                outcome.get_or_insert_default().add(found);
            }
            let first = shown.into_iter().rfind(|of| of.at[0] == 0 && of.at[1] == 0);
            shaded = first.map_or_else(Vec::new, |first| first.shaded);
        }
        Ok(shaded)
    }

    /// One situation under each technique that applies; as the last of them shows it.
    fn situation(
        &self,
        situation: &Situation,
        what: &str,
        outcomes: &mut [Option<Outcome>],
    ) -> Result<Vec<[u8; 3]>> {
        let gpu = self.gpu;
        let stage = Stage::with_look(gpu, situation.scene.clone(), SIZE, situation.look)?;
        let reference = stage.reference(|_| ())?;
        // Far away it must look as it does here, which is what the reference saw.
        let seen = match situation.offset.length() > 0.0 {
            true => Stage::with_look(gpu, placed(situation, &stage), SIZE, situation.look)?,
            false => stage,
        };
        let mut shaded = Vec::new();
        for (technique, outcome) in self.techniques.iter().zip(outcomes) {
            let expect = self.expected(technique).where_it(situation.wraps);
            if expect == Expect::Nothing || !applies(gpu, technique, situation) {
                continue;
            }
            let mut shadow = Shadow::new(gpu, &seen.renderer, technique.clone())?;
            let picture = self.case.course.picture(gpu, &seen, &mut shadow)?;
            let frame = situation.frame(technique, &mut shadow, &picture.visibility);
            let mut found = judge(what, &reference, &frame, expect)?;
            if self.case.seams && matches!(technique.config, Config::Cube { .. }) {
                let scene = &situation.scene;
                let [light, camera] = [scene.light().place.truncate(), scene.camera.eye];
                let places = [light, camera].map(|place| place.as_dvec3());
                found.rates = Some(Rates::of(&reference, &picture.visibility, places));
            }
            outcome.get_or_insert_default().add(found);
            shaded = picture.shaded;
        }
        Ok(shaded)
    }
}

impl Situation {
    /// What a technique's picture of it is judged by.
    pub fn frame<'a>(
        &self,
        technique: &Technique,
        shadow: &mut Shadow,
        visibility: &'a [u8],
    ) -> Frame<'a> {
        Frame {
            visibility,
            interior: match self.no_shadow_in_view {
                true => Interior::Screen,
                false => self.beside_leak(shadow.interior()),
            },
            may_wrap: shadow.may_wrap(),
            reach: self.reach(technique),
        }
    }

    /// An interior that is as far from edges as f32 positions let them be from where they are.
    fn beside_leak(&self, interior: Interior) -> Interior {
        let light = &self.scene.light().place;
        // No receiver is nearer to a lamp than this part of its distance from the middle.
        let away = match light.w == 0.0 {
            true => 1.0,
            false => 0.4 * light.truncate().distance(self.scene.camera.target),
        };
        match interior {
            Interior::Map {
                face_size,
                kernel_radius,
            } => Interior::Map {
                face_size,
                kernel_radius: kernel_radius + self.leak * face_size as f32 / (2.0 * away),
            },
            Interior::FlatMap {
                clip_from_world,
                size,
                kernel_radius,
            } => {
                let across = clip_from_world.row(0).truncate().length() / away;
                Interior::FlatMap {
                    clip_from_world,
                    size,
                    kernel_radius: kernel_radius + 0.5 * self.leak * across * size as f32,
                }
            }
            other => other,
        }
    }

    /// Where the light is and how far it reaches, for a technique that knows; of volumes and of the cheap ones
    /// it is the host that does.
    pub fn reach(&self, technique: &Technique) -> Option<(DVec3, f32)> {
        let is_host_s = matches!(technique.config, Config::Volume(_) | Config::Survey(_));
        let knows = !is_host_s && self.scene.light().place.w != 0.0;
        knows.then(|| {
            (
                self.scene.light().place.truncate().as_dvec3(),
                self.scene.light().range,
            )
        })
    }
}

/// Whether the technique is for such a light and the device can draw it: volumes reach to infinity,
/// which a far plane cuts off where the device cannot clamp depth.
pub fn applies(gpu: &Gpu, technique: &Technique, situation: &Situation) -> bool {
    let clamps = wgpu::Features::DEPTH_CLIP_CONTROL;
    let config = &technique.config;
    let fits = match config {
        Config::Survey(survey) => survey.fits(&situation.scene, situation.look),
        _ => true,
    };
    fits && config.applies_to(situation.scene.light().kind())
        && (situation.look.depth == DepthConvention::InfiniteReverse
            || !matches!(config, Config::Volume(_))
            || gpu.device.features().contains(clamps))
}

/// The scene moved away in f64, as it is seen from its camera.
fn placed(situation: &Situation, stage: &Stage) -> Scene {
    let mut scene = situation.scene.clone();
    // Counted from a point near the camera: no difference is exactly what it was.
    let origin = situation.offset + scene.camera.eye.as_dvec3() * 0.9;
    let away = DAffine3::from_translation(situation.offset);
    let moved =
        |point: shadows::glam::Vec3| (point.as_dvec3() + situation.offset - origin).as_vec3();
    if let Some(caster) = stage.scene_gpu.casters.first() {
        for object in &mut scene.objects {
            let place = away * exact(object.transform);
            let mesh = caster.mesh.clone();
            object.transform = Caster::placed(mesh, place, origin).world_from_object;
        }
    }
    if scene.light().place.w != 0.0 {
        let position = scene.light().place.truncate().as_dvec3() + situation.offset;
        scene.light_mut().place = HomogeneousLight::placed(position, origin).xyzw();
    }
    scene.camera.eye = moved(scene.camera.eye);
    scene.camera.target = moved(scene.camera.target);
    scene
}

fn exact(transform: Affine3A) -> DAffine3 {
    let entries = Mat4::from(transform).to_cols_array().map(f64::from);
    DAffine3::from_mat4(DMat4::from_cols_array(&entries))
}
