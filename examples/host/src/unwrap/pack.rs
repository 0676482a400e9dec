//! Where charts are in an object's part of a map, and objects in the map.

use anyhow::{Result, bail};
use shadows::reference::bake::TexelRectangle;

use super::parts::Parts;

/// Where an object is in the map, and its charts' cells in it.
pub struct Place {
    pub rectangle: TexelRectangle,
    /// First column and row of each, from the rectangle's.
    pub cells: Vec<[u32; 2]>,
    /// Texels of a cell around its chart.
    pub gap: u32,
}

impl Place {
    /// Of an object with a map of its own, as good as square.
    pub fn alone(cells: &[[u32; 2]], gap: u32) -> Self {
        let area = cells.iter().map(|[x, y]| f64::from(*x) * f64::from(*y));
        let widest = cells.iter().map(|cell| cell[0]).max().unwrap_or(1);
        let width = widest.max(area.sum::<f64>().sqrt().ceil() as u32);
        let (cells, height) = packed(cells, width);
        let rectangle = TexelRectangle {
            width,
            height: height.max(1),
            ..Default::default()
        };
        Self {
            rectangle,
            cells,
            gap,
        }
    }
}

/// The smallest texel, in metres, with which all fit, to a hundredth.
///
/// # Errors
/// If not even the gaps around charts do.
pub fn fitting(objects: &[Parts], side: u32, gap: u32) -> Result<(f64, Vec<Place>)> {
    let sizes = objects.iter().flat_map(|parts| &parts.sizes);
    let area: f64 = sizes.map(|size| size.x * size.y).sum();
    let mut fine = area.sqrt() / f64::from(side);
    let mut coarse = 2.0 * fine;
    let mut found = loop {
        if let Some(places) = placed(objects, [side, gap], coarse) {
            break places;
        }
        fine = coarse;
        coarse *= 2.0;
        if !(coarse.is_normal() && coarse < 1e6 * area.sqrt()) {
            bail!("{side} texels a side are too few for a light map of this scene");
        }
    };
    while coarse > 1.01 * fine {
        let middle = 0.5 * (fine + coarse);
        match placed(objects, [side, gap], middle) {
            Some(places) => (coarse, found) = (middle, places),
            None => fine = middle,
        }
    }
    Ok((coarse, found))
}

fn placed(objects: &[Parts], [side, gap]: [u32; 2], texel: f64) -> Option<Vec<Place>> {
    let mut places = Vec::with_capacity(objects.len());
    for parts in objects {
        let place = Place::alone(&parts.cells(texel, gap), gap);
        if place.rectangle.width > side || place.rectangle.height > side {
            return None;
        }
        places.push(place);
    }
    let of_place = |place: &Place| [place.rectangle.width, place.rectangle.height];
    let sizes: Vec<[u32; 2]> = places.iter().map(of_place).collect();
    let (corners, height) = packed(&sizes, side);
    if height > side {
        return None;
    }
    for (place, [x, y]) in places.iter_mut().zip(corners) {
        (place.rectangle.x, place.rectangle.y) = (x, y);
    }
    Some(places)
}

/// Places of rectangles in a strip of this width, and the height of all: the highest first, each as high up as it goes
/// below what is there already, then as far left (a skyline; Jylänki, "A Thousand Ways to Pack the Bin", 2010).
fn packed(sizes: &[[u32; 2]], width: u32) -> (Vec<[u32; 2]>, u32) {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|&at| std::cmp::Reverse([sizes[at][1], sizes[at][0]]));
    let mut places = vec![[0; 2]; sizes.len()];
    let mut skyline = vec![Step { x: 0, y: 0 }];
    let mut height = 0_u32;
    for at in order {
        let [x, y] = highest(&skyline, width, sizes[at][0]);
        places[at] = [x, y];
        let bottom = y.saturating_add(sizes[at][1]);
        height = height.max(bottom);
        let end = x + sizes[at][0];
        // What goes on after it is as low as the step that its end covers.
        let after = skyline
            .iter()
            .rfind(|step| step.x <= end)
            .map(|step| step.y);
        skyline.retain(|step| step.x < x || step.x > end);
        let own = skyline.partition_point(|step| step.x < x);
        skyline.insert(own, Step { x, y: bottom });
        if let (Some(y), true) = (after, end < width) {
            skyline.insert(own + 1, Step { x: end, y });
        }
    }
    (places, height)
}

/// Free below `y` from column `x` to the next step.
#[derive(Clone, Copy)]
struct Step {
    x: u32,
    y: u32,
}

/// Where a rectangle so wide fits highest; it is no wider than the strip.
fn highest(skyline: &[Step], width: u32, wide: u32) -> [u32; 2] {
    let starts = skyline.iter().enumerate();
    let fits = starts.filter(|(_, step)| step.x + wide <= width);
    let place = |(first, step): (usize, &Step)| {
        let under = skyline[first..].iter();
        let under = under.take_while(|other| other.x < step.x + wide);
        let y = under.map(|other| other.y).max().unwrap_or(0);
        [y, step.x]
    };
    let [y, x] = fits.map(place).min().unwrap_or([0, 0]);
    [x, y]
}
