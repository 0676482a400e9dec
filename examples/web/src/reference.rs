//! The reference, as the page's worker calls it.

use anyhow::{Context as _, Result};
use wasm_bindgen::prelude::*;

use crate::choice::Choice;
use crate::job::{Count, Job, Judge, NUMBERS};
use crate::web::js;

/// The reference, in a worker.
#[wasm_bindgen]
pub struct Reference {
    judge: Judge,
    counts: [Count; 2],
}

#[wasm_bindgen]
impl Reference {
    /// For a scene under a kind of light, by the names of the choices.
    #[wasm_bindgen(constructor)]
    pub fn new(scene: &str, light: &str) -> Result<Reference, JsError> {
        Self::made(scene, light).map_err(js)
    }

    fn made(scene: &str, light: &str) -> Result<Self> {
        let mut choice = Choice::default();
        choice.set("scene", scene)?;
        choice.set("light", light)?;
        Ok(Self {
            judge: Judge::new(choice.place, choice.light)?,
            counts: Default::default(),
        })
    }

    /// Compares some rows of both halves; counts from 0 if they are the first. Gives the rows' colours, four
    /// bytes a pixel, the left half's before the right one's.
    pub fn rows(
        &mut self,
        job: &[f32],
        width: u32,
        height: u32,
        first: u32,
        end: u32,
        visibility: &[u8],
    ) -> Result<Vec<u8>, JsError> {
        if first == 0 {
            self.counts = Default::default();
        }
        let mut compared = || -> Result<Vec<u8>> {
            let job: &[f32; NUMBERS] = job.try_into().context("this is no job")?;
            let (left, right) = visibility.split_at(visibility.len() / 2);
            let [mut colors, rest] = self.judge.rows(
                &Job::from_numbers(job),
                [width, height],
                [first, end],
                [left, right],
                &mut self.counts,
            )?;
            colors.extend(rest);
            Ok(colors.into_flattened())
        };
        compared().map_err(js)
    }

    /// So far, of the left half (0) or the right one (1): pixels counted, lit in shadow, in shadow though
    /// lit, and those of both that resolution does not excuse.
    pub fn counts(&self, side: usize) -> Vec<u32> {
        let Count {
            counted,
            false_lit,
            false_shadow,
            interior,
        } = self.counts[side.min(1)];
        vec![counted, false_lit, false_shadow, interior]
    }
}
