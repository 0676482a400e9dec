//! Short loops as animated PNG of few colours.

use std::collections::BTreeMap;

use anyhow::{Context as _, Result, ensure};
use png::{BitDepth, BlendOp, ColorType, Compression, DisposeOp, Encoder, Filter};

/// Colours of a loop, and the place after them, which leaves a pixel as it was.
const COLORS: usize = 255;
const UNCHANGED: u8 = COLORS as u8;
/// Bits of a channel by which colours are told apart.
const BITS: u32 = 6;

/// A loop for ever: frames of `size` pixels, three bytes each, each shown for `milliseconds`.
///
/// # Errors
/// If there is no frame, or one of another size.
pub fn animated_png(size: [u32; 2], milliseconds: u16, frames: &[Vec<[u8; 3]>]) -> Result<Vec<u8>> {
    let pixels = size[0] as usize * size[1] as usize;
    ensure!(
        frames.iter().all(|frame| frame.len() == pixels),
        "a frame is not of {} x {} pixels",
        size[0],
        size[1]
    );
    let Palette { colors, places } = Palette::of(frames.iter().flatten());
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, size[0], size[1]);
    encoder.set_color(ColorType::Indexed);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::High);
    encoder.set_filter(Filter::NoFilter);
    let mut alpha = vec![255; COLORS];
    alpha.push(0);
    let mut rgb: Vec<[u8; 3]> = colors;
    rgb.resize(COLORS + 1, [0; 3]);
    encoder.set_palette(rgb.into_flattened());
    encoder.set_trns(alpha);
    encoder.set_animated(u32::try_from(frames.len())?, 0)?;
    encoder.set_frame_delay(milliseconds, 1000)?;
    encoder.set_dispose_op(DisposeOp::None)?;
    encoder.set_blend_op(BlendOp::Over)?;
    let mut writer = encoder.write_header()?;
    let mut shown: Vec<u8> = Vec::new();
    for frame in frames {
        let indices: Vec<u8> = frame.iter().map(|color| places[&cell(*color)]).collect();
        let data: Vec<u8> = match shown.is_empty() {
            true => indices.clone(),
            false => indices
                .iter()
                .zip(&shown)
                .map(|(now, before)| if now == before { UNCHANGED } else { *now })
                .collect(),
        };
        writer.write_image_data(&data)?;
        shown = indices;
    }
    writer.finish().context("the loop is not whole")?;
    Ok(file)
}

/// Which colours look alike.
fn cell(color: [u8; 3]) -> [u8; 3] {
    color.map(|channel| channel >> (8 - BITS))
}

/// A loop's colours.
struct Palette {
    colors: Vec<[u8; 3]>,
    /// Of each cell.
    places: BTreeMap<[u8; 3], u8>,
}

/// Pixels of a cell.
#[derive(Clone, Copy, Default)]
struct Count {
    pixels: f64,
    sum: [f64; 3],
    squares: [f64; 3],
}

impl Count {
    fn with(self, other: &Self) -> Self {
        let both = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|axis| a[axis] + b[axis]);
        Self {
            pixels: self.pixels + other.pixels,
            sum: both(self.sum, other.sum),
            squares: both(self.squares, other.squares),
        }
    }

    fn mean(&self) -> [f64; 3] {
        self.sum.map(|sum| sum / self.pixels)
    }

    /// Squares of the distances from the mean, summed over the pixels.
    fn spread(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.squares[axis] - self.sum[axis] * self.sum[axis] / self.pixels)
    }
}

impl Palette {
    /// By halves: of all groups of cells that which is spread most is parted at its mean (Wan, Prusinkiewicz
    /// and Wong, "Variance-Based Color Image Quantization for Frame Buffer Display", 1990).
    fn of<'a>(pixels: impl Iterator<Item = &'a [u8; 3]>) -> Self {
        let mut cells: BTreeMap<[u8; 3], Count> = BTreeMap::new();
        for color in pixels {
            let values = color.map(f64::from);
            let one = Count {
                pixels: 1.0,
                sum: values,
                squares: values.map(|value| value * value),
            };
            let count = cells.entry(cell(*color)).or_default();
            *count = count.with(&one);
        }
        let mut groups = vec![Group::new(cells.into_iter().collect())];
        while groups.len() < COLORS {
            let widest = (0..groups.len()).max_by(|a, b| {
                let [a, b] = [a, b].map(|at| groups[*at].worst().1);
                a.total_cmp(&b)
            });
            let Some(halves) = widest.and_then(|at| groups[at].halves().map(|halves| (at, halves)))
            else {
                break;
            };
            let (at, [one, other]) = halves;
            groups[at] = one;
            groups.push(other);
        }
        let colors = groups.iter().map(|group| group.total.mean());
        let places = (0..=u8::MAX).zip(&groups).flat_map(|(place, group)| {
            let cells = group.cells.iter();
            cells.map(move |(cell, _)| (*cell, place))
        });
        Self {
            colors: colors
                .map(|mean| mean.map(|channel| channel.round() as u8))
                .collect(),
            places: places.collect(),
        }
    }
}

/// Cells of one colour.
struct Group {
    cells: Vec<([u8; 3], Count)>,
    total: Count,
}

impl Group {
    fn new(cells: Vec<([u8; 3], Count)>) -> Self {
        let total = cells
            .iter()
            .fold(Count::default(), |total, (_, count)| total.with(count));
        Self { cells, total }
    }

    /// The channel in which it is spread most, and how much.
    fn worst(&self) -> (usize, f64) {
        if self.cells.len() < 2 {
            return (0, 0.0);
        }
        let spread = self.total.spread();
        let channels = [0, 1, 2].map(|axis| (axis, spread[axis]));
        channels
            .into_iter()
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((0, 0.0))
    }

    /// Its cells below and above the mean; `None` of a single colour.
    fn halves(&self) -> Option<[Self; 2]> {
        let (axis, _) = self.worst();
        let mean = self.total.mean()[axis];
        let (below, above): (Vec<_>, Vec<_>) = self
            .cells
            .iter()
            .copied()
            .partition(|(_, count)| count.mean()[axis] < mean);
        let both = !below.is_empty() && !above.is_empty();
        both.then(|| [below, above].map(Self::new))
    }
}
