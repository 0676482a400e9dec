//! Pictures beside each other.

/// White paper that tiles are laid on.
pub struct Sheet {
    /// Pixels to the right and down.
    pub size: [u32; 2],
    /// Rows from the top.
    pub pixels: Vec<[u8; 3]>,
}

impl Sheet {
    /// Without any tile.
    pub fn new(size: [u32; 2]) -> Self {
        Self {
            size,
            pixels: vec![[255; 3]; (size[0] * size[1]) as usize],
        }
    }

    /// Lays a tile of so many pixels a row, its upper left pixel at a place from the sheet's.
    ///
    /// # Panics
    /// If it reaches beyond the sheet.
    pub fn put(&mut self, tile: &[[u8; 3]], width: u32, [left, top]: [u32; 2]) {
        assert!(left + width <= self.size[0], "the sheet is too narrow");
        for (y, row) in (top..).zip(tile.chunks_exact(width as usize)) {
            let at = (y * self.size[0] + left) as usize;
            self.pixels[at..at + row.len()].copy_from_slice(row);
        }
    }
}
