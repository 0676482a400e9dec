//! What is static on a tile, and whether to keep it in a layer of its own.

use super::content::Content;
use crate::map::projection::TileProjection;

/// Draws of a tile in which its casters must have been the same before they are thought static: the
/// third is the one that makes a layer of them.
const LEAST_PATIENCE: u32 = 2;

/// The longest wait after layers that were of no use: at worst one copy in so many draws is wasted.
const MOST_PATIENCE: u32 = 64;

/// Copies after which a layer has repaid its making, by the rule of
/// [`StaticLayers::Auto`](crate::StaticLayers).
const REPAID: u32 = 8;

/// How a tile is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum DrawMode {
    /// All casters, on a tile that is cleared.
    #[default]
    Whole,
    /// The casters that have not changed after a frame are copied from the layer, the others drawn
    /// over them.
    Copy(u64),
    /// The same after drawing the layer.
    Build(u64),
}

/// The casters on a tile that have not changed after a frame, for one projection.
#[derive(Clone, Copy, Debug)]
struct Held {
    projection: TileProjection,
    until: u64,
    content: Content,
}

/// Draws of a tile that are looked over for what does not change in them.
#[derive(Clone, Copy, Debug)]
struct Watch {
    projection: TileProjection,
    /// The frame of the first of them.
    from: u64,
    draws: u32,
}

/// The layer under one tile. Casters belong to it by the frame in which they last changed, so that
/// one that changes leaves it, and is missed in its sum.
#[derive(Clone, Debug)]
pub(crate) struct StaticLayer {
    /// What the layer's texels show.
    holds: Option<Held>,
    /// What they will show once the pending pass is encoded.
    scheduled: Option<Held>,
    watch: Option<Watch>,
    patience: u32,
    copies: u32,
    mode: DrawMode,
}

impl Default for StaticLayer {
    fn default() -> Self {
        Self {
            holds: None,
            scheduled: None,
            watch: None,
            patience: LEAST_PATIENCE,
            copies: 0,
            mode: DrawMode::Whole,
        }
    }
}

impl StaticLayer {
    pub fn mode(&self) -> DrawMode {
        self.mode
    }

    /// Learns that the layer was drawn.
    pub fn encoded(&mut self) {
        if let Some(held) = self.scheduled.take() {
            self.holds = Some(held);
            self.copies = 0;
        }
    }

    /// Chooses how the tile is drawn in frame `now`. `since` sums up the casters that have not
    /// changed after a frame; a layer of fewer triangles than `least` is not worth its copy.
    pub fn choose(
        &mut self,
        projection: &TileProjection,
        now: u64,
        least: u64,
        since: impl Fn(u64) -> Content,
    ) {
        self.scheduled = None;
        let from = self.ripe(projection, now);
        let right =
            |held: &Held| held.projection == *projection && since(held.until) == held.content;
        self.mode = match self.holds {
            Some(held) if right(&held) => {
                self.copies += 1;
                // What stopped since then joins it if that is worth a layer by itself.
                self.build(projection, from, least + held.content.triangles, since)
                    .unwrap_or(DrawMode::Copy(held.until))
            }
            Some(_) => {
                self.holds = None;
                self.patience = match self.copies < REPAID {
                    true => (2 * self.patience).min(MOST_PATIENCE),
                    false => LEAST_PATIENCE,
                };
                self.watch = None;
                DrawMode::Whole
            }
            None => self
                .build(projection, from, least, since)
                .unwrap_or(DrawMode::Whole),
        };
    }

    /// Counts a draw. Gives the first of those watched if there were enough of them, and begins to
    /// watch anew.
    fn ripe(&mut self, projection: &TileProjection, now: u64) -> Option<u64> {
        let watched = self.watch.filter(|watch| watch.projection == *projection);
        if let Some(watch) = watched
            && watch.draws + 1 < self.patience
        {
            self.watch = Some(Watch {
                draws: watch.draws + 1,
                ..watch
            });
            return None;
        }
        self.watch = Some(Watch {
            projection: *projection,
            from: now,
            draws: 0,
        });
        watched.map(|watch| watch.from)
    }

    fn build(
        &mut self,
        projection: &TileProjection,
        from: Option<u64>,
        least: u64,
        since: impl Fn(u64) -> Content,
    ) -> Option<DrawMode> {
        let until = from?;
        let content = since(until);
        if content.triangles < least {
            return None;
        }
        let projection = *projection;
        self.scheduled = Some(Held {
            projection,
            until,
            content,
        });
        Some(DrawMode::Build(until))
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::PointLight;

    fn projection() -> TileProjection {
        TileProjection::Face(PointLight::new(Vec3::ZERO, 10.0))
    }

    /// Draws a tile of casters of 100 triangles each, given by the frames in which they last changed.
    fn draw(layer: &mut StaticLayer, now: u64, casters: &[u64]) -> DrawMode {
        let since = |frame: u64| Content::of_frames(casters.iter().filter(|&&at| at <= frame));
        layer.choose(&projection(), now, 150, since);
        layer.encoded();
        layer.mode()
    }

    #[test]
    fn casters_that_were_drawn_in_vain_twice_get_a_layer() {
        let mut layer = StaticLayer::default();
        let modes = (1..7).map(|now| draw(&mut layer, now, &[0, 0, now]));
        let expected = [
            DrawMode::Whole,
            DrawMode::Whole,
            DrawMode::Build(1),
            DrawMode::Copy(1),
            DrawMode::Copy(1),
            DrawMode::Copy(1),
        ];
        assert_eq!(modes.collect::<Vec<_>>(), expected);
    }

    #[test]
    fn where_all_move_or_too_little_stands_there_is_none() {
        for static_ones in [&[][..], &[0]] {
            let mut layer = StaticLayer::default();
            for now in 1..200 {
                let casters = [static_ones, &[now; 9]].concat();
                assert_eq!(draw(&mut layer, now, &casters), DrawMode::Whole);
            }
        }
    }

    #[test]
    fn what_stops_joins_and_what_starts_leaves() {
        let mut layer = StaticLayer::default();
        let mut casters = vec![0, 0, 0, 0];
        for now in 1..5 {
            casters[2] = now;
            casters[3] = now;
            draw(&mut layer, now, &casters);
        }
        // Two of them stop in frame 4; something else goes on.
        let modes: Vec<DrawMode> = (5..12)
            .map(|now| draw(&mut layer, now, &[&casters[..], &[now]].concat()))
            .collect();
        assert!(modes.contains(&DrawMode::Copy(1)));
        assert!(matches!(modes[..], [.., DrawMode::Copy(until)] if until >= 4));
        casters[0] = 12;
        assert_eq!(draw(&mut layer, 12, &casters), DrawMode::Whole);
    }

    #[test]
    fn layers_that_never_repay_become_rare() {
        // A hundred casters take turns in moving: each layer is out of date when it is looked for.
        let mut casters = [0; 100];
        let mut layer = StaticLayer::default();
        let mut built = 0;
        for now in 1..1000 {
            casters[now as usize * 37 % 100] = now;
            built += usize::from(matches!(
                draw(&mut layer, now, &casters),
                DrawMode::Build(_)
            ));
        }
        assert!((2..25).contains(&built), "{built}");
    }
}
