//! Where the tiles of lights lie in the layers of one texture.

use std::collections::BTreeSet;

/// A tile's square of texels in one layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Place {
    pub layer: u32,
    /// Of the corner nearest to texel (0, 0); multiples of `size`.
    pub x: u32,
    pub y: u32,
    /// Texels along a side.
    pub size: u32,
}

impl Place {
    /// Texels in it.
    pub fn texels(&self) -> u64 {
        u64::from(self.size).pow(2)
    }
}

/// Places for square tiles in equal layers: a buddy system (Knowlton, "A Fast Storage Allocator",
/// 1965) in two dimensions.
///
/// A square is split into four quarters, and four free quarters of one square become that square again
/// at once. So a tile finds a place exactly where some free square of its size lies at a multiple of it.
/// It goes into the fullest layer that has one, so that others become empty, and there into the smallest
/// free square, so that large ones stay whole. Layers are taken one by one, and the last ones are given
/// back when they are empty.
///
/// Equal calls in equal order give equal places.
#[derive(Clone, Debug)]
pub(crate) struct TileAllocator {
    layer_side: u32,
    most_layers: u32,
    /// How often a layer's side is halved for the smallest tile.
    depth: u32,
    layers: Vec<Layer>,
    texels: u64,
}

/// One layer's free squares.
#[derive(Clone, Debug)]
struct Layer {
    /// For each number of halvings, the squares that are free and whose square of twice the size is not:
    /// x and y in units of their size, bit by bit in turn (Morton, 1966), so that the quarters of square
    /// i are 4 i to 4 i + 3.
    free: Vec<BTreeSet<u32>>,
    texels: u64,
}

impl TileAllocator {
    /// Layers of `layer_side` texels along a side, at most `most_layers`, for tiles of `least_tile`,
    /// twice that, four times that and so on up to a whole layer, which is one of these sizes.
    pub fn new(layer_side: u32, most_layers: u32, least_tile: u32) -> Self {
        debug_assert!(least_tile > 0 && layer_side.is_multiple_of(least_tile));
        debug_assert!((layer_side / least_tile).is_power_of_two());
        Self {
            layer_side,
            most_layers,
            depth: (layer_side / least_tile).ilog2(),
            layers: Vec::new(),
            texels: 0,
        }
    }

    /// A place for a tile; `None` if no layer has one, and there may be no more layers, or if it is no
    /// size of a tile.
    pub fn allocate(&mut self, size: u32) -> Option<Place> {
        let level = self.level(size)?;
        let layer = match self.fullest_with(level) {
            Some(layer) => layer,
            None if self.layers_in_use() < self.most_layers => {
                self.layers.push(Layer::new(self.depth));
                self.layers.len() - 1
            }
            None => return None,
        };
        let texels = u64::from(size).pow(2);
        let index = self.layers[layer].take(level)?;
        self.layers[layer].texels += texels;
        self.texels += texels;
        Some(Place {
            layer: layer as u32,
            x: even_bits(index) * size,
            y: even_bits(index >> 1) * size,
            size,
        })
    }

    /// Gives back a place that came from here and is not free.
    pub fn free(&mut self, place: Place) {
        let level = self.level(place.size);
        let layer = self.layers.get_mut(place.layer as usize);
        let (Some(level), Some(layer)) = (level, layer) else {
            debug_assert!(false, "{place:?} is of another allocator");
            return;
        };
        let index = spread(place.x / place.size) | spread(place.y / place.size) << 1;
        debug_assert!(!layer.is_free(level, index), "{place:?} is free");
        layer.give_back(level, index);
        layer.texels -= place.texels();
        self.texels -= place.texels();
        while self.layers.last().is_some_and(|last| last.texels == 0) {
            self.layers.pop();
        }
    }

    /// Gives back all places, and finds new ones for tiles of these sizes, in their order. `None`, with
    /// nothing changed, if they are more texels than there are or if one is no size of a tile: the
    /// largest go first, and so they leave no gaps.
    pub fn pack(&mut self, sizes: &[u32]) -> Option<Vec<Place>> {
        let mut packed = Self {
            layers: Vec::new(),
            texels: 0,
            ..*self
        };
        let mut order: Vec<usize> = (0..sizes.len()).collect();
        order.sort_by_key(|&tile| std::cmp::Reverse(sizes[tile]));
        let mut places = vec![None; sizes.len()];
        for tile in order {
            places[tile] = Some(packed.allocate(sizes[tile])?);
        }
        *self = packed;
        places.into_iter().collect()
    }

    /// Layers up to the last one that holds a tile: as many as the texture needs.
    pub fn layers_in_use(&self) -> u32 {
        self.layers.len() as u32
    }

    /// Texels of all tiles.
    pub fn texels_in_use(&self) -> u64 {
        self.texels
    }

    /// Texels of all layers there may be.
    pub fn capacity(&self) -> u64 {
        u64::from(self.layer_side).pow(2) * u64::from(self.most_layers)
    }

    /// How often a layer's side is halved for a tile of this size.
    fn level(&self, size: u32) -> Option<u32> {
        (0..=self.depth).find(|level| self.layer_side >> level == size)
    }

    /// The fullest layer with a free square of at least this level, the first of equals.
    fn fullest_with(&self, level: u32) -> Option<usize> {
        let with = |layer: &Layer| layer.smallest(level).is_some();
        (0..self.layers.len())
            .filter(|&layer| with(&self.layers[layer]))
            .max_by_key(|&layer| (self.layers[layer].texels, std::cmp::Reverse(layer)))
    }
}

impl Layer {
    fn new(depth: u32) -> Self {
        let mut free = vec![BTreeSet::new(); depth as usize + 1];
        free[0].insert(0);
        Self { free, texels: 0 }
    }

    /// The level of the smallest free square that is no smaller than those of a level.
    fn smallest(&self, level: u32) -> Option<u32> {
        (0..=level)
            .rev()
            .find(|&level| !self.free[level as usize].is_empty())
    }

    /// The first square of a level out of the smallest free square.
    fn take(&mut self, level: u32) -> Option<u32> {
        let from = self.smallest(level)?;
        let mut index = self.free[from as usize].pop_first()?;
        for split in from + 1..=level {
            index *= 4;
            self.free[split as usize].extend(index + 1..index + 4);
        }
        Some(index)
    }

    fn give_back(&mut self, mut level: u32, mut index: u32) {
        while level > 0 {
            let free = &mut self.free[level as usize];
            let quarters = index & !3..(index & !3) + 4;
            let buddies = quarters.filter(|&quarter| quarter != index);
            if !buddies.clone().all(|buddy| free.contains(&buddy)) {
                break;
            }
            for buddy in buddies {
                free.remove(&buddy);
            }
            (level, index) = (level - 1, index / 4);
        }
        self.free[level as usize].insert(index);
    }

    /// Whether a square lies in a free one.
    fn is_free(&self, level: u32, index: u32) -> bool {
        (0..=level).any(|up| self.free[up as usize].contains(&(index >> (2 * (level - up)))))
    }
}

/// The even bits of a number side by side.
fn even_bits(index: u32) -> u32 {
    (0..16).fold(0, |bits, bit| bits | (index >> bit) & 1 << bit)
}

/// The lowest 16 bits of a number with a gap after each.
fn spread(number: u32) -> u32 {
    (0..16).fold(0, |bits, bit| bits | (number & 1 << bit) << bit)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The layers of an allocator texel by texel: which tile each belongs to.
    struct Bitmap {
        side: u32,
        texels: Vec<Vec<Option<usize>>>,
    }

    impl Bitmap {
        fn new(side: u32, layers: u32) -> Self {
            let layer = vec![None; (side * side) as usize];
            Self {
                side,
                texels: vec![layer; layers as usize],
            }
        }

        fn of(&mut self, place: Place) -> impl Iterator<Item = &mut Option<usize>> {
            let (xs, ys) = (place.x..place.x + place.size, place.y..place.y + place.size);
            let side = self.side as usize;
            let layer = &mut self.texels[place.layer as usize];
            layer.iter_mut().enumerate().filter_map(move |(at, texel)| {
                let (x, y) = ((at % side) as u32, (at / side) as u32);
                (xs.contains(&x) && ys.contains(&y)).then_some(texel)
            })
        }

        fn has_room(&mut self, size: u32) -> bool {
            let steps = self.side / size;
            (0..self.texels.len() as u32).any(|layer| {
                (0..steps * steps).any(|at| {
                    let (x, y) = (at % steps * size, at / steps * size);
                    let place = Place { layer, x, y, size };
                    self.of(place).all(|texel| texel.is_none())
                })
            })
        }
    }

    #[derive(Clone, Debug)]
    enum Step {
        /// Number of halvings.
        Allocate(u32),
        Free(prop::sample::Index),
    }

    fn step() -> impl Strategy<Value = Step> {
        prop_oneof![
            3 => (0..4_u32).prop_map(Step::Allocate),
            2 => any::<prop::sample::Index>().prop_map(Step::Free),
        ]
    }

    fn steps() -> impl Strategy<Value = Vec<Step>> {
        prop::collection::vec(step(), 1..120)
    }

    const SIDE: u32 = 16;
    const LAYERS: u32 = 3;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2))]

        #[test]
        fn ten_thousand_tiles_may_come_and_go(steps in prop::collection::vec(step(), 10_000)) {
            overlap_never_and_fail_only_without_room(steps)?;
        }
    }

    fn overlap_never_and_fail_only_without_room(steps: Vec<Step>) -> Result<(), TestCaseError> {
        let mut tiles = TileAllocator::new(SIDE, LAYERS, 2);
        let mut bitmap = Bitmap::new(SIDE, LAYERS);
        let mut live: Vec<(usize, Place)> = Vec::new();
        for (tile, step) in steps.into_iter().enumerate() {
            match step {
                Step::Allocate(level) => {
                    let size = SIDE >> level;
                    let room = bitmap.has_room(size);
                    let place = tiles.allocate(size);
                    prop_assert_eq!(place.is_some(), room);
                    let Some(place) = place else { continue };
                    prop_assert_eq!((place.size, place.x % size, place.y % size), (size, 0, 0));
                    prop_assert!(place.x + size <= SIDE && place.y + size <= SIDE);
                    prop_assert!(place.layer < tiles.layers_in_use());
                    for texel in bitmap.of(place) {
                        prop_assert_eq!(texel.replace(tile), None);
                    }
                    live.push((tile, place));
                }
                Step::Free(which) => {
                    if live.is_empty() {
                        continue;
                    }
                    let (tile, place) = live.swap_remove(which.index(live.len()));
                    tiles.free(place);
                    for texel in bitmap.of(place) {
                        prop_assert_eq!(texel.take(), Some(tile));
                    }
                }
            }
            let used: u64 = live.iter().map(|(_, place)| place.texels()).sum();
            prop_assert_eq!(tiles.texels_in_use(), used);
            let last = live.iter().map(|(_, place)| place.layer + 1).max();
            prop_assert_eq!(tiles.layers_in_use(), last.unwrap_or(0));
        }
        live.into_iter().for_each(|(_, place)| tiles.free(place));
        prop_assert_eq!((tiles.layers_in_use(), tiles.texels_in_use()), (0, 0));
        // Nothing is left over: each layer is one free square again.
        for layer in 0..LAYERS {
            prop_assert_eq!(tiles.allocate(SIDE).map(|place| place.layer), Some(layer));
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn tiles_never_overlap_and_fail_only_without_room(steps in steps()) {
            overlap_never_and_fail_only_without_room(steps)?;
        }

        #[test]
        fn tiles_packed_anew_fit_where_their_texels_do(
            levels in prop::collection::vec(0..4_u32, 0..40),
            before in steps(),
        ) {
            let mut tiles = TileAllocator::new(SIDE, LAYERS, 2);
            for step in before {
                if let Step::Allocate(level) = step {
                    tiles.allocate(SIDE >> level);
                }
            }
            let sizes: Vec<u32> = levels.iter().map(|level| SIDE >> level).collect();
            let texels: u64 = sizes.iter().map(|size| u64::from(size * size)).sum();
            let was = tiles.clone();
            let Some(places) = tiles.pack(&sizes) else {
                prop_assert!(texels > tiles.capacity());
                prop_assert_eq!(format!("{tiles:?}"), format!("{was:?}"));
                return Ok(());
            };
            prop_assert!(texels <= tiles.capacity());
            prop_assert_eq!(tiles.texels_in_use(), texels);
            let layer = u64::from(SIDE * SIDE);
            prop_assert_eq!(u64::from(tiles.layers_in_use()), texels.div_ceil(layer));
            let mut bitmap = Bitmap::new(SIDE, LAYERS);
            for (tile, (place, size)) in places.into_iter().zip(sizes).enumerate() {
                prop_assert_eq!(place.size, size);
                for texel in bitmap.of(place) {
                    prop_assert_eq!(texel.replace(tile), None);
                }
            }
        }
    }

    #[test]
    fn the_bitmap_sees_what_an_allocator_gets_wrong() {
        let mut bitmap = Bitmap::new(SIDE, 1);
        let place = |x, y, size| Place {
            layer: 0,
            x,
            y,
            size,
        };
        bitmap.of(place(0, 0, 8)).for_each(|texel| *texel = Some(7));
        let taken = |bitmap: &mut Bitmap, place| bitmap.of(place).any(|texel| texel.is_some());
        assert!(taken(&mut bitmap, place(7, 7, 2)));
        assert!(!taken(&mut bitmap, place(8, 0, 8)));
        assert_eq!(
            bitmap.of(place(15, 0, 2)).count(),
            2,
            "half of it is outside"
        );
        assert!(bitmap.has_room(8) && !bitmap.has_room(16));
        // Room enough, but no square at a multiple of its size.
        for x in [2, 10] {
            bitmap
                .of(place(x, 10, 2))
                .for_each(|texel| *texel = Some(8));
        }
        bitmap
            .of(place(10, 2, 2))
            .for_each(|texel| *texel = Some(9));
        assert!(bitmap.has_room(4) && !bitmap.has_room(8));
    }

    #[test]
    fn small_tiles_fill_the_gaps_of_the_fullest_layer() {
        let mut tiles = TileAllocator::new(8, 4, 1);
        let whole = tiles.allocate(8).unwrap();
        let half = tiles.allocate(4).unwrap();
        let quarter = tiles.allocate(2).unwrap();
        tiles.free(whole);
        // Layer 0 is empty now and stays, since layer 1 is not.
        assert_eq!(tiles.layers_in_use(), 2);
        let place = |x, y, size| Place {
            layer: 1,
            x,
            y,
            size,
        };
        assert_eq!((half, quarter), (place(0, 0, 4), place(4, 0, 2)));
        // Beside the quarter, not in one of the halves that are still whole.
        assert_eq!(tiles.allocate(2), Some(place(6, 0, 2)));
        assert_eq!(tiles.allocate(4), Some(place(0, 4, 4)));
        // What layer 1 has no room for goes into the empty layer before a new one is taken.
        assert_eq!(tiles.allocate(8).map(|whole| whole.layer), Some(0));
        assert_eq!(tiles.layers_in_use(), 2);
    }

    #[test]
    fn empty_layers_are_given_back_from_the_end() {
        let mut tiles = TileAllocator::new(4, 9, 4);
        let places: Vec<Place> = (0..3).map(|_| tiles.allocate(4).unwrap()).collect();
        tiles.free(places[1]);
        assert_eq!(tiles.layers_in_use(), 3);
        tiles.free(places[2]);
        assert_eq!(tiles.layers_in_use(), 1);
        tiles.free(places[0]);
        assert_eq!((tiles.layers_in_use(), tiles.texels_in_use()), (0, 0));
    }

    #[test]
    fn a_layer_may_be_one_tile_of_any_size() {
        let mut tiles = TileAllocator::new(1000, 6, 1000);
        for layer in 0..6 {
            let (x, y, size) = (0, 0, 1000);
            assert_eq!(tiles.allocate(size), Some(Place { layer, x, y, size }));
        }
        assert_eq!(tiles.allocate(1000), None);
    }

    #[test]
    fn what_is_no_tile_gets_no_place() {
        let mut tiles = TileAllocator::new(1024, 2, 64);
        for size in [0, 1, 32, 63, 65, 96, 1000, 2048, u32::MAX] {
            assert_eq!(tiles.allocate(size), None, "{size}");
            assert_eq!(tiles.pack(&[64, size]), None, "{size}");
        }
        assert_eq!(tiles.layers_in_use(), 0);
    }

    #[test]
    fn squares_are_counted_bit_by_bit_in_turn() {
        for (x, y, index) in [(0, 0, 0), (1, 0, 1), (0, 1, 2), (3, 5, 0b10_0111)] {
            assert_eq!(spread(x) | spread(y) << 1, index);
            assert_eq!((even_bits(index), even_bits(index >> 1)), (x, y));
        }
        assert_eq!(even_bits(spread(0xffff)), 0xffff);
    }
}
