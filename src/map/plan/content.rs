//! The casters on a tile, and what its texels show of them.

use crate::scene::{Block, Record};

/// Casters, as a sum that their order does not change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Content {
    digest: u128,
    pub casters: u32,
    pub triangles: u64,
}

impl Content {
    pub fn of<'a>(records: impl Iterator<Item = &'a Record>) -> Self {
        let mut content = Self::default();
        records.for_each(|record| content.add(record));
        content
    }

    pub fn add(&mut self, record: &Record) {
        self.digest = self.digest.wrapping_add(record.digest);
        self.casters += 1;
        self.triangles += u64::from(record.triangles);
    }

    pub fn add_block(&mut self, block: &Block) {
        self.digest = self.digest.wrapping_add(block.digest);
        self.casters += Block::SIZE as u32;
        self.triangles += block.triangles;
    }

    pub fn remove(&mut self, record: &Record) {
        self.digest = self.digest.wrapping_sub(record.digest);
        self.casters -= 1;
        self.triangles -= u64::from(record.triangles);
    }

    pub fn is_empty(&self) -> bool {
        self.casters == 0
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

/// All that a tile's texels depend on: its projection and its casters. A tile without casters is the
/// same for every projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Signature<P> {
    projection: Option<P>,
    content: Content,
}

impl<P> Signature<P> {
    pub fn new(projection: Option<P>, content: Content) -> Self {
        Self {
            projection: projection.filter(|_| !content.is_empty()),
            content,
        }
    }
}

/// What the texels of a tile show.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Texels<P> {
    /// `None` if nobody knows.
    shown: Option<Signature<P>>,
    /// What they will show once the pending pass is encoded.
    scheduled: Option<Signature<P>>,
}

impl<P: Copy + PartialEq> Texels<P> {
    pub const UNKNOWN: Self = Self {
        shown: None,
        scheduled: None,
    };

    pub fn show(&self, wanted: &Signature<P>) -> bool {
        self.shown == Some(*wanted)
    }

    /// Whether they belong with no projection that receivers are given: drawn for another one, or
    /// unknown.
    pub fn are_foreign(&self, given: Option<P>) -> bool {
        match self.shown {
            None => true,
            Some(shown) => shown.projection.is_some() && shown.projection != given,
        }
    }

    pub fn schedule(&mut self, wanted: Signature<P>) {
        self.scheduled = Some(wanted);
    }

    /// Learns that they were drawn as scheduled.
    pub fn encoded(&mut self) {
        self.shown = self.scheduled;
    }

    pub fn forget(&mut self) {
        self.shown = None;
    }
}
