//! One light in one view, or in those that are drawn together: what is decided for each caster, and the draws that follow from it.

use glam::Mat4;

use crate::volume::decide::decision::{Choices, Decision, KnownCaster, Volume};
use crate::volume::decide::facing::{self, ObjectLight};
use crate::volume::decide::method::{Form, Options};
use crate::volume::decide::scissor::Rect;
use crate::volume::frame::Situation;
use crate::volume::plan::cache::{Slot, VolumeCache};
use crate::volume::plan::draw_lists::DrawLists;
use crate::volume::plan::faces::{Draw, DrawnAs};
use crate::volume::plan::merged::MergedDraws;
use crate::volume::plan::params::CasterParams;
use crate::volume::plan::scene::{Changes, SceneCasters};
use crate::volume::plan::seats::Seats;
use crate::volume::plan::windows::{Window, Windows};
use crate::volume::statistics::{CasterState, Counted, Tally};

/// A light in a view, and the casters as they were decided on last, by their numbers.
#[derive(Debug, Default)]
pub(crate) struct Pair {
    situation: Option<Situation>,
    choices: Option<Choices>,
    entries: Vec<Option<Entry>>,
    /// The casters that are drawn and were decided on in this frame.
    decided: Vec<Decided>,
    pub draws: DrawLists,
    pub tally: Tally,
    /// What of the target is drawn to, and the target's size.
    pub scissor: Option<(Rect, [u32; 2])>,
}

/// A caster that was decided on.
#[derive(Clone, Copy, Debug)]
struct Decided {
    number: u32,
    /// Whether anything that its shaders read may be new, or the way in which it is drawn is.
    anew: bool,
}

/// What was decided for a caster, and what came of it.
#[derive(Clone, Copy, Debug)]
struct Entry {
    counted: Counted,
    volume: Option<Volume>,
    form: Option<Form>,
    slot: Option<u32>,
    drawn_as: Option<DrawnAs>,
    seats: Seats,
}

/// What pairs share.
pub(crate) struct Shared<'a> {
    pub casters: &'a SceneCasters,
    pub cache: &'a mut VolumeCache,
    pub windows: &'a mut Windows,
    pub merged: &'a mut MergedDraws,
}

impl Pair {
    /// Decides anew for what changed: for all casters if light, view or receivers did.
    pub fn decide(
        &mut self,
        situation: &Situation,
        (options, keep): (Options, bool),
        (changes, lights): (&Changes, &[Option<ObjectLight>]),
        shared: &mut Shared<'_>,
    ) {
        self.decided.clear();
        let anew = self.situation.as_ref() != Some(situation);
        if !anew && changes.is_empty() {
            return;
        }
        for &number in &changes.departed {
            self.let_go(number, shared);
        }
        if anew {
            self.situation = Some(situation.clone());
            self.choices = Some(Choices::new(situation, options, keep));
            self.scissor = options.scissor(situation);
        }
        let Some(choices) = self.choices.take() else {
            return;
        };
        let casters = shared.casters;
        let changed = changes.changed.iter().map(|(_, number)| *number);
        let all = casters.numbers().iter().copied().filter(|_| anew);
        let mut update = |number: u32| {
            if let Some(known) = casters.get(number) {
                let light = lights.get(number as usize).and_then(Option::as_ref);
                let decision = choices.decide(known, light);
                self.update((number, changes.has(number)), known, decision, shared);
            }
        };
        match anew {
            true => all.for_each(&mut update),
            false => changed.for_each(&mut update),
        }
        self.choices = Some(choices);
    }

    /// Gives the casters that are drawn and were decided on their windows.
    pub fn draw(&mut self, shared: &mut Shared<'_>) {
        let Some(choices) = &self.choices else { return };
        let left_handed = choices.left_handed;
        for Decided { number, anew } in &mut self.decided {
            let number = *number;
            let entry = self.entries[number as usize].as_mut();
            let (Some(entry), Some(known)) = (entry, shared.casters.get(number)) else {
                continue;
            };
            let (Some(form), Some(volume)) = (&entry.form, &entry.volume) else {
                continue;
            };
            let last = entry.drawn_as;
            let window = last.map_or_else(|| shared.windows.take(), |last| last.window);
            let now = DrawnAs::new(
                window,
                form,
                (volume.counted, known.way),
                (known.mirrored, left_handed),
            );
            *anew |= last != Some(now);
            entry.drawn_as = Some(now);
        }
    }

    /// Fills their windows and gives them their draws, their volumes having their places: of all that are
    /// drawn if nothing can be counted on that was written before.
    pub fn fill(&mut self, shared: &mut Shared<'_>, renewed: bool) {
        let decided = std::mem::take(&mut self.decided);
        let anew = decided.iter().filter(|decided| decided.anew && !renewed);
        anew.for_each(|decided| self.fill_one(decided.number, shared));
        let all = 0..self.entries.len() as u32;
        all.filter(|_| renewed)
            .for_each(|number| self.fill_one(number, shared));
    }

    fn fill_one(&mut self, number: u32, shared: &mut Shared<'_>) {
        let entry = self.entries[number as usize].as_mut();
        let (Some(entry), Some(known)) = (entry, shared.casters.get(number)) else {
            return;
        };
        let (Some(drawn_as), Some(form), Some(number)) = (entry.drawn_as, entry.form, entry.slot)
        else {
            return;
        };
        let Some(slot) = shared.cache.get(number) else {
            return;
        };
        let side_vertices = form.side_vertices;
        let draws = (&mut self.draws, &mut *shared.merged);
        entry.seats.update((drawn_as, side_vertices), slot, draws);
        if let Some(params) = entry.params(known, slot) {
            let slot = number;
            shared.windows.set(drawn_as.window, Window { slot, params });
        }
    }

    /// Lets everything go: light or view is no more.
    pub fn clear(&mut self, shared: &mut Shared<'_>) {
        for number in 0..self.entries.len() as u32 {
            self.let_go(number, shared);
        }
        self.situation = None;
    }

    /// What became of a caster.
    pub fn state(&self, number: u32) -> Option<CasterState> {
        let entry = self.entries.get(number as usize)?.as_ref()?;
        Some(entry.counted.state)
    }

    /// All that is drawn, caster by caster.
    pub fn faces(&self) -> impl Iterator<Item = Vec<Draw>> {
        let drawn = self.entries.iter().flatten();
        drawn.filter_map(|entry| {
            let mut faces = Vec::new();
            entry.drawn_as?.draws(|draw| faces.push(draw));
            Some(faces)
        })
    }

    /// The windows of all casters that are drawn.
    pub fn windows(&self) -> impl Iterator<Item = u32> {
        let drawn = self.entries.iter().flatten();
        drawn.filter_map(|entry| Some(entry.drawn_as?.window))
    }

    /// Keeps volume, window and draws where the caster had them. Which may have changed, or not.
    fn update(
        &mut self,
        (number, changed): (u32, bool),
        known: &KnownCaster,
        decision: Decision,
        shared: &mut Shared<'_>,
    ) {
        let Decision {
            state,
            form,
            volume,
        } = decision;
        let drawn = form.is_some();
        let counted = volume.map(|volume| volume.counted);
        let place = number as usize;
        if self.entries.len() <= place {
            self.entries.resize(place + 1, None);
        }
        let last = self.entries[place];
        let kept = last.and_then(|last| last.kept(&volume, (known, drawn), shared.cache));
        let taken = volume.filter(|_| kept.is_none());
        let taken = taken.map(|volume| shared.cache.acquire(&volume, known, drawn));
        let entry = Entry {
            counted: Counted {
                state,
                away_facing: drawn && counted == Some(facing::Counted::AwayFacing),
                triangles: known.mesh().triangle_count(),
            },
            slot: kept.or(taken),
            volume,
            form,
            drawn_as: None,
            seats: Seats::default(),
        };
        self.entries[place] = Some(entry);
        self.tally.add(entry.counted);
        let mut anew = true;
        if let Some(last) = last {
            self.tally.remove(last.counted);
            anew = changed || kept.is_none() || (last.form, last.volume) != (form, volume);
            if let Some(slot) = last.slot.filter(|_| kept.is_none()) {
                shared.cache.release(slot, last.form.is_some());
            }
            match drawn {
                true => {
                    if let Some(entry) = &mut self.entries[place] {
                        (entry.drawn_as, entry.seats) = (last.drawn_as, last.seats);
                    }
                }
                false => self.undraw(last, shared),
            }
        }
        if drawn {
            self.decided.push(Decided { number, anew });
        }
    }

    fn let_go(&mut self, number: u32, shared: &mut Shared<'_>) {
        let entry = self.entries.get_mut(number as usize).and_then(Option::take);
        let Some(entry) = entry else { return };
        self.tally.remove(entry.counted);
        if let Some(slot) = entry.slot {
            shared.cache.release(slot, entry.form.is_some());
        }
        self.undraw(entry, shared);
    }

    fn undraw(&mut self, mut entry: Entry, shared: &mut Shared<'_>) {
        entry.seats.leave(&mut self.draws, shared.merged);
        if let Some(drawn_as) = entry.drawn_as {
            shared.windows.give_back(drawn_as.window);
        }
    }
}

impl Entry {
    /// Its volume, if that is the one which is wanted.
    fn kept(
        &self,
        volume: &Option<Volume>,
        (known, drawn): (&KnownCaster, bool),
        cache: &mut VolumeCache,
    ) -> Option<u32> {
        let (slot, volume) = (self.slot?, volume.as_ref()?);
        let same = cache.is_still(slot, (volume, known), [self.form.is_some(), drawn]);
        same.then_some(slot)
    }

    fn params(&self, known: &KnownCaster, slot: &Slot) -> Option<CasterParams> {
        let (form, volume) = (self.form.as_ref()?, self.volume.as_ref()?);
        let light = &volume.light;
        let mut params = CasterParams {
            world_from_object: Mat4::from(known.caster.world_from_object).to_cols_array_2d(),
            far_plane: form.far.plane.as_vec4().to_array(),
            apex: form.far.apex.as_vec4().to_array(),
            position_stride: 0,
            position_offset: 0,
            edge_base: 0,
            side_vertices: form.side_vertices,
            object_light: light.light,
            object_light_rest: light.rest,
            both_sides: volume.counted as u32,
            anchor: light.origin.anchor,
            zero: 0,
            anchor_from_light: light.origin.from_light,
            padding: 0,
        };
        slot.locate(&mut params);
        Some(params)
    }
}
