//! One light's place in a map: which casters its tiles hold, and which they were drawn with.

use super::content::{Content, Signature, Texels};
use super::sorting::{Reached, Sorting, Sum};
use super::static_layer::{DrawMode, StaticLayer};
use super::tile_masks::{TileMasks, tiles_of};
use crate::map::projection::{LightProjection, SlotLight, TileProjection, TileSides};
use crate::scene::{Casters, Change, Record};

/// One tile of one light.
#[derive(Clone, Debug)]
pub(crate) struct Tile {
    pub content: Content,
    texels: Texels<TileProjection>,
    /// What receivers are told that it shows; `None`: nothing yet.
    pub shown: Option<TileProjection>,
    /// Frames for which it has waited to be drawn.
    pub age: u32,
    /// How much has changed since it was drawn: the sum of the shares of the tile that the casters
    /// cover that did.
    pub change: f64,
    /// Its layer of static casters.
    pub layer: StaticLayer,
}

impl Default for Tile {
    fn default() -> Self {
        Self {
            content: Content::default(),
            texels: Texels::UNKNOWN,
            shown: None,
            age: 0,
            change: 0.0,
            layer: StaticLayer::default(),
        }
    }
}

/// The light of this frame, for which a slot's masks and contents are.
#[derive(Debug)]
struct Current {
    of: SlotLight,
    sides: TileSides,
}

#[derive(Debug, Default)]
pub(crate) struct Slot {
    current: Option<Current>,
    pub tiles: Vec<Tile>,
    /// For each caster the tiles it touches.
    masks: TileMasks,
    /// Casters that touch any tile.
    pub casting: usize,
    /// Frames since there was one.
    pub idle: u32,
    pub cull: bool,
    /// Tiles that the next encode must draw.
    pub pending: u8,
    /// Set if the texels of all tiles were found to be right and nothing has come since: then there is
    /// nothing to look for again.
    settled: Option<Settled>,
}

#[derive(Clone, Copy, Debug)]
struct Settled {
    /// The tiles without a caster.
    empty: u8,
    /// Whether receivers were told since.
    told: bool,
}

impl Slot {
    pub fn new(cull: bool) -> Self {
        Self {
            cull,
            ..Self::default()
        }
    }

    /// The light of this frame.
    pub fn light(&self) -> Option<&LightProjection> {
        Some(&self.current.as_ref()?.of.projection)
    }

    /// The light of this frame, and which casters count for it.
    pub fn slot_light(&self) -> Option<&SlotLight> {
        Some(&self.current.as_ref()?.of)
    }

    /// A mask of all tiles of its light.
    pub fn all(&self) -> u8 {
        self.light().map_or(0, LightProjection::all)
    }

    pub fn masks(&self) -> &TileMasks {
        &self.masks
    }

    /// What a tile is to show.
    pub fn projection(&self, tile: usize) -> Option<TileProjection> {
        self.light()?.tile(tile)
    }

    /// Learns that tiles were drawn as scheduled.
    pub fn encoded(&mut self, mask: u8) {
        self.pending &= !mask;
        for (bit, tile) in self.tiles.iter_mut().enumerate() {
            if mask & 1 << bit != 0 {
                tile.texels.encoded();
                tile.layer.encoded();
            }
        }
    }

    /// Learns that a tile was drawn without some of its casters, and the layer under it, too.
    pub fn spoil(&mut self, tile: usize) {
        self.settled = None;
        let tile = &mut self.tiles[tile];
        tile.texels.forget();
        tile.layer = StaticLayer::default();
    }

    /// Nothing is known of the texels any more: they are new.
    pub fn forget_texels(&mut self) {
        self.settled = None;
        for tile in &mut self.tiles {
            tile.texels.forget();
            tile.shown = None;
        }
    }

    /// The texels are gone, and the layers under them.
    pub fn texels_freed(&mut self) {
        self.forget_texels();
        for tile in &mut self.tiles {
            tile.layer = StaticLayer::default();
        }
    }

    /// Nothing is known of the texels any more, nor of the layers under them, and nothing is to be
    /// drawn on those. Receivers are given the light that they were.
    pub fn doubt_texels(&mut self) {
        self.settled = None;
        self.pending = 0;
        for tile in &mut self.tiles {
            tile.texels.forget();
            tile.layer = StaticLayer::default();
        }
    }

    /// Lets go of its light and all casters, before [`set_light`](Self::set_light) for the next light, if
    /// there is one. If it is like the last one, receivers still know the tiles.
    pub fn leave_light(&mut self, next: Option<&LightProjection>) {
        self.settled = None;
        let before = self.current.take();
        let like = before
            .zip(next)
            .is_some_and(|(before, next)| before.of.projection.is_like(next));
        if let Some(next) = next.filter(|next| next.count() != self.tiles.len()) {
            self.tiles.clear();
            self.tiles.resize_with(next.count(), Tile::default);
        }
        if !like {
            self.tiles.iter_mut().for_each(|tile| tile.shown = None);
        }
        self.casting = 0;
        for tile in &mut self.tiles {
            tile.content = Content::default();
            tile.change = 1.0;
        }
    }

    /// Whether it is worth asking for those in range before sorting: not for a light that most were on.
    pub fn finds_few(&self, casters: &Casters) -> bool {
        self.cull && 2 * self.casting <= casters.records().len()
    }

    /// Sorts all casters for a light.
    pub fn set_light(&mut self, of: SlotLight, casters: &Casters, reached: Reached<'_>) {
        let sides = TileSides::new(&of.projection);
        self.current = Some(Current { of, sides });
        self.sort(casters, reached);
    }

    /// Sorts all casters for the light it has.
    pub fn sort(&mut self, casters: &Casters, reached: Reached<'_>) {
        let Some(current) = &self.current else { return };
        let mut sorting = Sorting {
            filter: current.of.filter,
            all: current.of.projection.all(),
            sides: self.cull.then_some(&current.sides),
            masks: &mut self.masks,
            sums: Default::default(),
            casting: 0,
        };
        sorting.sort(casters, reached);
        let Sorting { sums, casting, .. } = sorting;
        self.settled = None;
        self.casting = casting;
        for (tile, Sum { content, change }) in self.tiles.iter_mut().zip(sums) {
            // Which casters it was is not known: all that are there count, or the whole tile if none is left.
            if tile.content != content {
                tile.change += match content == Content::default() {
                    true => 1.0,
                    false => change,
                };
                tile.content = content;
            }
        }
    }

    /// Learns what became of one caster.
    pub fn apply(&mut self, change: &Change<'_>) {
        let all = self.all();
        if all == 0 {
            return;
        }
        let after = change.new.map_or(0, |new| self.touched_by(new, all));
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
        self.settled = None;
        self.casting += usize::from(after != 0);
        self.casting -= usize::from(before != 0);
        if let Some(old) = change.old {
            self.each(before, old, Content::remove);
        }
        if let Some(new) = change.new {
            if after != before {
                self.masks.set(change.index, after);
            }
            self.each(after, new, Content::add);
        }
    }

    fn touched_by(&self, record: &Record, all: u8) -> u8 {
        match &self.current {
            Some(current)
                if !(record.casts() && current.of.filter.admits(record.layers, record.owner)) =>
            {
                0
            }
            Some(_) if !self.cull => all,
            Some(current) => current.sides.touched_by(record),
            None => 0,
        }
    }

    fn each(&mut self, mask: u8, record: &Record, change: impl Fn(&mut Content, &Record)) {
        let Some(current) = &self.current else { return };
        for bit in tiles_of(mask) {
            let tile = &mut self.tiles[bit];
            change(&mut tile.content, record);
            tile.change += current.sides.share(bit, &record.bounds);
        }
    }

    fn wanted(&self, tile: usize) -> Signature<TileProjection> {
        Signature::new(self.projection(tile), self.tiles[tile].content)
    }

    /// The tiles whose texels are not what they should be.
    pub fn stale(&self) -> u8 {
        if self.settled.is_some() {
            return 0;
        }
        self.mask_of(|bit, tile| !tile.texels.show(&self.wanted(bit)))
    }

    /// The tiles whose texels do not belong with what receivers are told of them.
    pub fn foreign(&self) -> u8 {
        self.mask_of(|_, tile| tile.shown.is_some() && tile.texels.are_foreign(tile.shown))
    }

    /// Whether receivers are told of another light than that of this frame: they are when all its
    /// tiles are drawn, and not before.
    pub fn waits_for_all(&self) -> bool {
        let joint = self.light().is_some_and(LightProjection::is_joint);
        joint && self.mask_of(|bit, tile| tile.shown != self.projection(bit)) != 0
    }

    /// The tiles of which receivers must be told something before they are told anything of the light:
    /// cascades, which lie in each other's place where one is missing.
    pub fn urgent(&self) -> u8 {
        match self.light() {
            Some(LightProjection::Cascades(_)) => {
                self.mask_of(|bit, tile| tile.shown.is_none() && self.projection(bit).is_some())
            }
            _ => 0,
        }
    }

    pub fn empty(&self) -> u8 {
        let found = || self.mask_of(|_, tile| tile.content.is_empty());
        self.settled.map_or_else(found, |settled| settled.empty)
    }

    /// Learns, after [`schedule`](Self::schedule), that no tile is drawn, nor waits to be.
    pub fn settle(&mut self) {
        if self.settled.is_none() {
            let (empty, told) = (self.empty(), false);
            self.settled = Some(Settled { empty, told });
        }
    }

    /// Learns that receivers were told of it.
    pub fn tell(&mut self) {
        if let Some(settled) = &mut self.settled {
            settled.told = true;
        }
    }

    /// Whether all is as receivers were told.
    pub fn is_told(&self) -> bool {
        self.settled.is_some_and(|settled| settled.told)
    }

    fn mask_of(&self, is: impl Fn(usize, &Tile) -> bool) -> u8 {
        let tiles = self.tiles.iter().enumerate();
        tiles.fold(0, |mask, (bit, tile)| mask | u8::from(is(bit, tile)) << bit)
    }

    /// Decides which of the tiles that should be drawn the next `encode` draws.
    pub fn schedule(&mut self, wanted: u8, drawn: u8) {
        if self.settled.is_some() && wanted | drawn == 0 {
            return; // all is as the last call left it
        }
        let joint = self.light().is_none_or(LightProjection::is_joint);
        for bit in 0..self.tiles.len() {
            let (signature, projection) = (self.wanted(bit), self.projection(bit));
            let tile = &mut self.tiles[bit];
            if drawn & 1 << bit != 0 {
                tile.texels.schedule(signature);
                tile.age = 0;
                tile.change = 0.0;
            }
            // Of one light's tiles that are read side by side all change over, or none.
            let waiting = wanted & !drawn;
            let ready = match joint {
                true => waiting == 0,
                false => waiting & 1 << bit == 0,
            };
            if ready {
                tile.shown = projection;
            }
        }
        self.pending = drawn;
        self.grow_older(wanted & !drawn);
    }

    /// One more frame for the tiles that wait; the others have nothing to wait for.
    fn grow_older(&mut self, waiting: u8) {
        for (bit, tile) in self.tiles.iter_mut().enumerate() {
            tile.age = match waiting & 1 << bit {
                0 => 0,
                _ => tile.age.saturating_add(1),
            };
        }
    }

    /// Decides how the tiles of a mask are drawn: on layers of at least so many triangles of static
    /// casters, or all at once.
    pub fn choose_modes(&mut self, mask: u8, least: u64, casters: &Casters) {
        let Some(current) = &self.current else { return };
        for (bit, tile) in self.tiles.iter_mut().enumerate() {
            let projection = current.of.projection.tile(bit);
            if let Some(projection) = projection
                && mask & 1 << bit != 0
            {
                let (masks, frame) = (&self.masks, casters.frame());
                tile.layer.choose(&projection, frame, least, |frame| {
                    let on_tile = masks.touching(1 << bit).map(|at| &casters.records()[at]);
                    Content::of(on_tile.filter(|record| record.since <= frame))
                });
            }
        }
    }

    /// Which lists of draws a caster on a tile goes to: the tile's, and that of the layer under it.
    pub fn lists(&self, tile: usize, record: &Record) -> (bool, bool) {
        match self.tiles[tile].layer.mode() {
            DrawMode::Build(until) if record.since <= until => (false, true),
            DrawMode::Copy(until) if record.since <= until => (false, false),
            DrawMode::Whole | DrawMode::Copy(_) | DrawMode::Build(_) => (true, false),
        }
    }
}

#[cfg(test)]
#[path = "slot_tests.rs"]
mod tests;
