//! One light's place in a map: which casters its faces hold, and which they were drawn with.

use super::content::{Content, Signature, Texels};
use super::face_masks::FaceMasks;
use super::static_layer::{DrawMode, StaticLayer};
use crate::PointLight;
use crate::map::projection::{ALL_FACES, CubeFace, touched_faces};
use crate::scene::{Casters, Change, Record};

/// One face of one light.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    pub content: Content,
    texels: Texels<PointLight>,
    /// Frames for which it has waited to be drawn.
    pub age: u32,
    /// How much has changed since it was drawn: the sum of (radius / distance)^2 of the casters
    /// that did.
    pub change: f64,
    /// Its layer of static casters.
    pub layer: StaticLayer,
}

impl Default for Face {
    fn default() -> Self {
        Self {
            content: Content::default(),
            texels: Texels::UNKNOWN,
            age: 0,
            change: 0.0,
            layer: StaticLayer::default(),
        }
    }
}

#[derive(Debug, Default)]
pub(crate) struct Slot {
    /// The light of this frame, for which the masks and contents below are.
    pub light: Option<PointLight>,
    /// The light that receivers are given: the one its faces were last drawn for together.
    pub shown: Option<PointLight>,
    pub faces: [Face; 6],
    /// For each caster the faces it touches.
    masks: FaceMasks,
    /// Casters that touch any face.
    pub casting: usize,
    /// Frames since there was one.
    pub idle: u32,
    pub cull: bool,
    /// Faces that the next encode must draw.
    pub pending: u8,
}

impl Slot {
    pub fn new(cull: bool) -> Self {
        Self {
            cull,
            ..Self::default()
        }
    }

    pub fn masks(&self) -> &FaceMasks {
        &self.masks
    }

    /// Learns that faces were drawn as scheduled.
    pub fn encoded(&mut self, mask: u8) {
        self.pending &= !mask;
        for (bit, face) in self.faces.iter_mut().enumerate() {
            if mask & 1 << bit != 0 {
                face.texels.encoded();
                face.layer.encoded();
            }
        }
    }

    /// Learns that somebody else draws on a face.
    pub fn touched(&mut self, face: CubeFace) {
        self.pending &= !face.bit();
        self.faces[face.layer() as usize].texels.forget();
    }

    /// Nothing is known of the texels any more: they are new.
    pub fn forget_texels(&mut self) {
        self.faces.iter_mut().for_each(|face| face.texels.forget());
        self.shown = None;
    }

    /// The texels are gone, and the layers under them.
    pub fn texels_freed(&mut self) {
        self.forget_texels();
        self.faces
            .iter_mut()
            .for_each(|face| face.layer = StaticLayer::default());
    }

    /// Nothing is known of the texels any more, nor of the layers under them, and nothing is to be
    /// drawn on those. Receivers are given the light that they were.
    pub fn doubt_texels(&mut self) {
        self.pending = 0;
        for face in &mut self.faces {
            face.texels.forget();
            face.layer = StaticLayer::default();
        }
    }

    /// Takes another light (or none) and sorts all casters anew, of which `reached` are those that
    /// it may reach.
    pub fn set_light(&mut self, light: Option<PointLight>, casters: &[Record], reached: &[u32]) {
        self.light = light;
        self.casting = 0;
        self.masks.reset(casters.len());
        for face in &mut self.faces {
            face.content = Content::default();
            face.change = 1.0;
        }
        let Some(light) = light else {
            self.shown = None;
            return;
        };
        for &index in reached {
            let record = &casters[index as usize];
            let mask = self.touched_by(&light, record);
            self.masks.set(index as usize, mask);
            self.enter(mask, &light, record);
        }
    }

    /// Learns what became of one caster.
    pub fn apply(&mut self, change: &Change<'_>) {
        let Some(light) = self.light else { return };
        let after = change.new.map_or(0, |new| self.touched_by(&light, new));
        let before = match (change.old, change.new) {
            (Some(_), Some(_)) => self.masks.get(change.index),
            (Some(_), None) => self.masks.pop().unwrap_or(0), // the last
            (None, Some(_)) => {
                self.masks.push(after);
                0
            }
            (None, None) => 0,
        };
        if before | after == 0 {
            return; // most casters are far from most lights
        }
        if let Some(old) = change.old {
            self.leave(before, &light, old);
        }
        if let Some(new) = change.new {
            self.masks.set(change.index, after);
            self.enter(after, &light, new);
        }
    }

    fn touched_by(&self, light: &PointLight, record: &Record) -> u8 {
        if !record.casts() {
            return 0;
        }
        if !self.cull {
            return ALL_FACES;
        }
        let bounds = record.bounds.relative_to(light.position);
        touched_faces(&bounds, f64::from(light.range))
    }

    fn enter(&mut self, mask: u8, light: &PointLight, record: &Record) {
        self.casting += usize::from(mask != 0);
        self.each(mask, light, record, Content::add);
    }

    fn leave(&mut self, mask: u8, light: &PointLight, record: &Record) {
        self.casting -= usize::from(mask != 0);
        self.each(mask, light, record, Content::remove);
    }

    fn each(
        &mut self,
        mask: u8,
        light: &PointLight,
        record: &Record,
        change: fn(&mut Content, &Record),
    ) {
        if mask == 0 {
            return;
        }
        let bounds = &record.bounds;
        let squared = bounds.centre.distance_squared(light.position.as_dvec3());
        let seen = (bounds.radius * bounds.radius / squared).min(1.0);
        for (bit, face) in self.faces.iter_mut().enumerate() {
            if mask & 1 << bit != 0 {
                change(&mut face.content, record);
                face.change += seen;
            }
        }
    }

    fn wanted(&self, face: &Face) -> Signature<PointLight> {
        Signature::new(self.light, face.content)
    }

    /// The faces whose texels are not what they should be.
    pub fn stale(&self) -> u8 {
        self.mask_of(|face| !face.texels.show(&self.wanted(face)))
    }

    /// The faces whose texels belong with no light that receivers are given.
    pub fn foreign(&self) -> u8 {
        self.mask_of(|face| face.texels.are_foreign(self.shown))
    }

    pub fn empty(&self) -> u8 {
        self.mask_of(|face| face.content.is_empty())
    }

    fn mask_of(&self, is: impl Fn(&Face) -> bool) -> u8 {
        CubeFace::ALL
            .into_iter()
            .filter(|face| is(&self.faces[face.layer() as usize]))
            .fold(0, |mask, face| mask | face.bit())
    }

    /// Decides which faces the next `encode` draws.
    pub fn schedule(&mut self, mask: u8) {
        for bit in 0..6 {
            if mask & 1 << bit != 0 {
                let wanted = self.wanted(&self.faces[bit]);
                let face = &mut self.faces[bit];
                face.texels.schedule(wanted);
                face.age = 0;
                face.change = 0.0;
            }
        }
        self.pending = mask;
    }

    /// Decides how the faces of a mask are drawn: on layers of at least so many triangles of static
    /// casters, or all at once.
    pub fn choose_modes(&mut self, mask: u8, least: u64, casters: &Casters) {
        let Some(light) = self.light else { return };
        for (bit, face) in self.faces.iter_mut().enumerate() {
            if mask & 1 << bit != 0 {
                let masks = &self.masks;
                face.layer.choose(&light, casters.frame(), least, |frame| {
                    let on_face = masks.touching(1 << bit).map(|at| &casters.records()[at]);
                    Content::of(on_face.filter(|record| record.since <= frame))
                });
            }
        }
    }

    /// Which lists of draws a caster on the faces `on` goes to, as bits: 0 to 5 the faces, 6 to 11
    /// the layers under them.
    pub fn lists(&self, on: u8, record: &Record) -> u16 {
        let list = |bit: usize| match self.faces[bit].layer.mode() {
            DrawMode::Build(until) if record.since <= until => 64 << bit,
            DrawMode::Copy(until) if record.since <= until => 0,
            DrawMode::Whole | DrawMode::Copy(_) | DrawMode::Build(_) => 1 << bit,
        };
        (0..6)
            .filter(|bit| on & 1 << bit != 0)
            .fold(0, |lists, bit| lists | list(bit))
    }

    /// One more frame for the faces that wait; the others have nothing to wait for.
    pub fn grow_older(&mut self, waiting: u8) {
        for (bit, face) in self.faces.iter_mut().enumerate() {
            face.age = match waiting & 1 << bit {
                0 => 0,
                _ => face.age.saturating_add(1),
            };
        }
    }
}
