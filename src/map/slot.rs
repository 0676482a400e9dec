//! One light's place in a map: which casters its faces hold, and which they were drawn with.

use super::face::{CubeFace, LightBounds};
use super::masks::FaceMasks;
use super::scene::{Record, Scene};
use super::still::{Still, Way};
use crate::PointLight;

/// A mask of all six faces.
pub(super) const ALL_FACES: u8 = 0b11_1111;

/// The casters on a face, as a sum that their order does not change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Content {
    digest: u128,
    pub casters: u32,
    pub triangles: u64,
}

impl Content {
    fn add(&mut self, record: &Record) {
        self.digest = self.digest.wrapping_add(record.digest);
        self.casters += 1;
        self.triangles += u64::from(record.triangles);
    }

    fn remove(&mut self, record: &Record) {
        self.digest = self.digest.wrapping_sub(record.digest);
        self.casters -= 1;
        self.triangles -= u64::from(record.triangles);
    }

    /// Casters of 100 triangles each, told apart by frames.
    #[cfg(test)]
    pub fn of_frames<'a>(frames: impl Iterator<Item = &'a u64>) -> Self {
        frames.fold(Self::default(), |sum, &frame| Self {
            digest: sum.digest + (1 << (frame % 128)),
            casters: sum.casters + 1,
            triangles: sum.triangles + 100,
        })
    }
}

/// All that a face's texels depend on. A face without casters is the same for every light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Signature {
    light: Option<PointLight>,
    content: Content,
}

/// One face of one light.
#[derive(Clone, Debug, Default)]
pub(super) struct Face {
    pub content: Content,
    /// What its texels show; `None` if nobody knows.
    pub rendered: Option<Signature>,
    /// What they will show once the pending pass is encoded.
    scheduled: Option<Signature>,
    /// Frames for which it has waited to be drawn.
    pub age: u32,
    /// How much has changed since it was drawn: the sum of (radius / distance)^2 of the casters
    /// that did.
    pub change: f64,
    /// Its layer of casters that stand still.
    pub still: Still,
}

/// Bounds of a caster relative to a light.
pub(super) fn bounds(light: &PointLight, record: &Record) -> LightBounds {
    LightBounds {
        centre: record.centre - light.position.as_dvec3(),
        half: record.half,
        radius: record.radius,
    }
}

#[derive(Debug, Default)]
pub(super) struct Slot {
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
                face.rendered = face.scheduled;
                face.still.encoded();
            }
        }
    }

    /// Learns that somebody else draws on a face.
    pub fn touched(&mut self, face: CubeFace) {
        self.pending &= !face.bit();
        self.faces[face.layer() as usize].rendered = None;
    }

    /// Nothing is known of the texels any more: they are new.
    pub fn forget_texels(&mut self) {
        self.faces.iter_mut().for_each(|face| face.rendered = None);
        self.shown = None;
    }

    /// Nothing is known of the texels any more, nor of the layers under them, and nothing is to be
    /// drawn on those. Receivers are given the light that they were.
    pub fn doubt_texels(&mut self) {
        self.pending = 0;
        for face in &mut self.faces {
            face.rendered = None;
            face.still = Still::default();
        }
    }

    /// Takes another light (or none) and sorts all casters anew, of which `reached` are those that
    /// it may reach.
    pub fn set_light(&mut self, light: Option<PointLight>, scene: &Scene, reached: &[u32]) {
        self.light = light;
        self.casting = 0;
        self.masks.reset(scene.records().len());
        for face in &mut self.faces {
            face.content = Content::default();
            face.change = 1.0;
        }
        let Some(light) = light else {
            self.shown = None;
            return;
        };
        for &index in reached {
            let record = &scene.records()[index as usize];
            let mask = self.touched_by(&light, record);
            self.masks.set(index as usize, mask);
            self.enter(mask, &light, record);
        }
    }

    pub fn push(&mut self, record: &Record) {
        let Some(light) = self.light else { return };
        let mask = self.touched_by(&light, record);
        self.masks.push(mask);
        self.enter(mask, &light, record);
    }

    pub fn replace(&mut self, index: usize, old: &Record, new: &Record) {
        let Some(light) = self.light else { return };
        self.leave(self.masks.get(index), &light, old);
        let mask = self.touched_by(&light, new);
        self.masks.set(index, mask);
        self.enter(mask, &light, new);
    }

    pub fn remove_last(&mut self, old: &Record) {
        let (Some(light), Some(mask)) = (self.light, self.masks.pop()) else {
            return;
        };
        self.leave(mask, &light, old);
    }

    fn touched_by(&self, light: &PointLight, record: &Record) -> u8 {
        if record.triangles == 0 {
            return 0;
        }
        if !self.cull {
            return ALL_FACES;
        }
        bounds(light, record).faces(f64::from(light.range))
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
        let squared = record.centre.distance_squared(light.position.as_dvec3());
        let seen = (record.radius * record.radius / squared).min(1.0);
        for (bit, face) in self.faces.iter_mut().enumerate() {
            if mask & 1 << bit != 0 {
                change(&mut face.content, record);
                face.change += seen;
            }
        }
    }

    fn wanted(&self, face: &Face) -> Signature {
        let empty = face.content.casters == 0;
        Signature {
            light: self.light.filter(|_| !empty),
            content: face.content,
        }
    }

    /// The faces whose texels are not what they should be.
    pub fn stale(&self) -> u8 {
        self.mask_of(|face| face.rendered != Some(self.wanted(face)))
    }

    /// The faces whose texels belong with no light that receivers are given: drawn for another
    /// one, or unknown.
    pub fn strange(&self) -> u8 {
        self.mask_of(|face| match face.rendered {
            None => true,
            Some(signature) => signature.light.is_some() && signature.light != self.shown,
        })
    }

    pub fn empty(&self) -> u8 {
        self.mask_of(|face| face.content.casters == 0)
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
                face.scheduled = Some(wanted);
                face.age = 0;
                face.change = 0.0;
            }
        }
        self.pending = mask;
    }

    /// Decides how the faces of a mask are drawn: on layers of at least so many triangles that stand
    /// still, or all at once.
    pub fn choose_ways(&mut self, mask: u8, least: u64, scene: &Scene) {
        let Some(light) = self.light else { return };
        for (bit, face) in self.faces.iter_mut().enumerate() {
            if mask & 1 << bit != 0 {
                let masks = &self.masks;
                face.still.choose(&light, scene.frame(), least, |frame| {
                    let mut content = Content::default();
                    masks
                        .touching(1 << bit)
                        .map(|at| &scene.records()[at])
                        .filter(|record| record.since <= frame)
                        .for_each(|record| content.add(record));
                    content
                });
            }
        }
    }

    /// Which lists of draws a caster on the faces `on` goes to, as bits: 0 to 5 the faces, 6 to 11
    /// the layers under them.
    pub fn lists(&self, on: u8, record: &Record) -> u16 {
        let list = |bit: usize| match self.faces[bit].still.way() {
            Way::Build(until) if record.since <= until => 64 << bit,
            Way::Copy(until) if record.since <= until => 0,
            Way::Whole | Way::Copy(_) | Way::Build(_) => 1 << bit,
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
