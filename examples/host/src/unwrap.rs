//! Texture coordinates for light maps, made for scenes that bring none: charts of triangles that face about the same
//! way, projected onto a plane and packed on shelves. Tools that artists use do better; this does for any mesh.

use std::collections::{HashMap, HashSet};

use anyhow::{Result, bail};
use shadows::error::LightMapError;
use shadows::glam::{DAffine3, DVec2, DVec3};
use shadows::reference::bake::{LightMapLayout, LightMapReceiver, TexelRectangle};

use super::scene::{Scene, widened};

/// Cosine of the angle within which a chart's triangles face: they are stretched by 1.22 at most.
const SAME_WAY: f64 = 0.82;

/// Texels between a chart and its cell's edge.
const GAP: f64 = 1.0;

/// A scene's objects with places in one map.
pub struct Unwrapping {
    /// One for each object of the scene.
    pub objects: Vec<Unwrapped>,
    pub layout: LightMapLayout,
    /// Sides of the largest texel, in metres on a surface.
    pub texel: f64,
}

/// An object whose triangles share no vertices.
pub struct Unwrapped {
    /// In object space.
    pub positions: Vec<[f32; 3]>,
    pub uvs: Vec<[f32; 2]>,
    indices: Vec<u32>,
    transform: DAffine3,
    pub rectangle: TexelRectangle,
}

impl Unwrapped {
    fn receiver(&self) -> LightMapReceiver<'_> {
        LightMapReceiver {
            positions: &self.positions,
            indices: &self.indices,
            uvs: &self.uvs,
            transform: self.transform,
            rectangle: self.rectangle,
            two_sided: false,
        }
    }
}

impl Unwrapping {
    /// Finds the smallest texels with which the scene fits a square map of `side` texels.
    ///
    /// # Errors
    /// If it does not fit with any.
    pub fn new(scene: &Scene, side: u32) -> Result<Self> {
        let mut split = HashSet::new();
        loop {
            let objects: Vec<Parts> = (0..scene.objects.len())
                .map(|object| Parts::new(scene, object, &split))
                .collect();
            let (texel, places) = fitting(&objects, side)?;
            let objects: Vec<Unwrapped> = objects
                .iter()
                .zip(places)
                .map(|(parts, place)| parts.unwrapped(place, texel))
                .collect();
            let receivers: Vec<_> = objects.iter().map(Unwrapped::receiver).collect();
            match LightMapLayout::new([side; 2], &receivers) {
                // A chart that folds back over itself: its triangles get charts of their own.
                Err(LightMapError::UvOverlap {
                    receiver,
                    triangles,
                }) if split.insert((receiver, triangles[1])) => {}
                Err(error) => return Err(error.into()),
                Ok(layout) => {
                    return Ok(Self {
                        objects,
                        layout,
                        texel: texel / SAME_WAY,
                    });
                }
            }
        }
    }
}

/// An object's triangles by charts.
struct Parts {
    /// In object space, three a triangle.
    positions: Vec<[f32; 3]>,
    transform: DAffine3,
    /// In metres, three a triangle, from the chart's own corner.
    flat: Vec<DVec2>,
    /// Of each triangle; `None` without area.
    charts: Vec<Option<usize>>,
    /// Of each chart, in metres.
    sizes: Vec<DVec2>,
}

impl Parts {
    fn new(scene: &Scene, object: usize, split: &HashSet<(usize, usize)>) -> Self {
        let placed = &scene.objects[object];
        let mesh = &scene.meshes[placed.mesh];
        let transform = widened(&placed.transform);
        let corners = mesh.indices.iter();
        let positions: Vec<[f32; 3]> = corners.map(|&at| mesh.positions[at as usize]).collect();
        let world: Vec<[DVec3; 3]> = positions
            .chunks_exact(3)
            .map(|t| [0, 1, 2].map(|k| placed.world_point(t[k])))
            .collect();
        let neighbours = neighbours(&positions);
        let alone = |triangle: usize| split.contains(&(object, triangle));
        let normals: Vec<DVec3> = world
            .iter()
            .map(|[a, b, c]| (b - a).cross(c - a).normalize_or_zero())
            .collect();
        let charts = charts(&normals, &neighbours, alone);
        let mut parts = Self {
            positions,
            transform,
            flat: Vec::new(),
            charts: charts
                .iter()
                .map(|chart| chart.map(|(place, _)| place))
                .collect(),
            sizes: Vec::new(),
        };
        parts.flatten(&world, &charts);
        parts
    }

    fn flatten(&mut self, world: &[[DVec3; 3]], charts: &[Option<(usize, DVec3)>]) {
        let mut bounds: Vec<[DVec2; 2]> = Vec::new();
        for (corners, chart) in world.iter().zip(charts) {
            let (place, normal) = chart.unwrap_or((0, DVec3::Y));
            let (across, along) = normal.any_orthonormal_pair();
            for corner in corners {
                let at = DVec2::new(across.dot(*corner), along.dot(*corner));
                self.flat.push(at);
                if chart.is_some() {
                    bounds.resize(
                        bounds.len().max(place + 1),
                        [DVec2::INFINITY, DVec2::NEG_INFINITY],
                    );
                    bounds[place] = [bounds[place][0].min(at), bounds[place][1].max(at)];
                }
            }
        }
        for (triangle, chart) in self.charts.iter().enumerate() {
            for at in &mut self.flat[3 * triangle..3 * triangle + 3] {
                *at = chart.map_or(DVec2::ZERO, |chart| *at - bounds[chart][0]);
            }
        }
        self.sizes = bounds.iter().map(|[low, high]| high - low).collect();
    }

    /// Texels of each chart's cell.
    fn cells(&self, texel: f64) -> Vec<[u32; 2]> {
        let cell = |size: &DVec2| {
            let texels = (*size / texel).ceil() + 2.0 * GAP;
            [texels.x as u32, texels.y as u32]
        };
        self.sizes.iter().map(cell).collect()
    }

    fn unwrapped(&self, place: Place, texel: f64) -> Unwrapped {
        let rectangle = place.rectangle;
        let size = DVec2::new(rectangle.width.into(), rectangle.height.into());
        let uv = |(corner, at): (usize, &DVec2)| {
            let Some(chart) = self.charts[corner / 3] else {
                return [0.0; 2];
            };
            let cell = place.cells[chart].map(f64::from);
            let at = DVec2::from_array(cell) + GAP + *at / texel;
            (at / size).as_vec2().to_array()
        };
        Unwrapped {
            positions: self.positions.clone(),
            uvs: self.flat.iter().enumerate().map(uv).collect(),
            indices: (0..self.positions.len() as u32).collect(),
            transform: self.transform,
            rectangle,
        }
    }
}

/// Triangles at each edge, by their corners' bits.
fn neighbours(positions: &[[f32; 3]]) -> Vec<Vec<usize>> {
    let key = |position: [f32; 3]| position.map(|part| (part + 0.0).to_bits());
    let mut edges: HashMap<[[u32; 3]; 2], Vec<usize>> = HashMap::new();
    for (triangle, corners) in positions.chunks_exact(3).enumerate() {
        for k in 0..3 {
            let mut edge = [key(corners[k]), key(corners[(k + 1) % 3])];
            edge.sort();
            edges.entry(edge).or_default().push(triangle);
        }
    }
    let mut neighbours = vec![Vec::new(); positions.len() / 3];
    for triangles in edges.values() {
        for &triangle in triangles {
            neighbours[triangle].extend(triangles.iter().filter(|other| **other != triangle));
        }
    }
    neighbours.iter_mut().for_each(|near| near.sort_unstable());
    neighbours
}

/// Of each triangle with an area its chart and the chart's normal: grown from the first over edges.
fn charts(
    normals: &[DVec3],
    neighbours: &[Vec<usize>],
    alone: impl Fn(usize) -> bool,
) -> Vec<Option<(usize, DVec3)>> {
    let mut charts = vec![None; normals.len()];
    let mut count = 0;
    for first in 0..normals.len() {
        let normal = normals[first];
        if normal == DVec3::ZERO || charts[first].is_some() {
            continue;
        }
        charts[first] = Some((count, normal));
        let mut edge = vec![first];
        while let Some(triangle) = edge.pop().filter(|_| !alone(first)) {
            for &next in &neighbours[triangle] {
                let joins = charts[next].is_none() && !alone(next);
                if joins && normals[next].dot(normal) > SAME_WAY {
                    charts[next] = Some((count, normal));
                    edge.push(next);
                }
            }
        }
        count += 1;
    }
    charts
}

/// Where an object is in the map, and its charts in it.
#[derive(Clone)]
struct Place {
    rectangle: TexelRectangle,
    cells: Vec<[u32; 2]>,
}

/// The smallest texel with which all fit, to a hundredth.
fn fitting(objects: &[Parts], side: u32) -> Result<(f64, Vec<Place>)> {
    let area: f64 = objects
        .iter()
        .flat_map(|parts| &parts.sizes)
        .map(|s| s.x * s.y)
        .sum();
    let mut fine = area.sqrt() / f64::from(side);
    let mut coarse = 2.0 * fine;
    let mut found = loop {
        if let Some(places) = pack(objects, side, coarse) {
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
        match pack(objects, side, middle) {
            Some(places) => (coarse, found) = (middle, places),
            None => fine = middle,
        }
    }
    Ok((coarse, found))
}

fn pack(objects: &[Parts], side: u32, texel: f64) -> Option<Vec<Place>> {
    let mut sizes = Vec::with_capacity(objects.len());
    let mut cells = Vec::with_capacity(objects.len());
    for parts in objects {
        let own = parts.cells(texel);
        let area: f64 = own.iter().map(|[x, y]| f64::from(*x) * f64::from(*y)).sum();
        let widest = own.iter().map(|cell| cell[0]).max().unwrap_or(1);
        let width = widest.max(area.sqrt().ceil() as u32);
        let (places, height) = shelves(&own, width);
        sizes.push([width, height.max(1)]);
        cells.push(places);
    }
    if sizes
        .iter()
        .any(|[width, height]| *width > side || *height > side)
    {
        return None;
    }
    let (places, height) = shelves(&sizes, side);
    let fits = height <= side;
    fits.then(|| {
        let placed = places.iter().zip(&sizes).zip(cells);
        placed
            .map(|((&[x, y], &[width, height]), cells)| Place {
                rectangle: TexelRectangle {
                    x,
                    y,
                    width,
                    height,
                },
                cells,
            })
            .collect()
    })
}

/// Places of rectangles on shelves of this width, the highest first, and the height of all.
fn shelves(sizes: &[[u32; 2]], width: u32) -> (Vec<[u32; 2]>, u32) {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|&at| std::cmp::Reverse(sizes[at][1]));
    let mut places = vec![[0; 2]; sizes.len()];
    let (mut x, mut y, mut shelf) = (0, 0, 0);
    for at in order {
        if x + sizes[at][0] > width {
            y += shelf;
            (x, shelf) = (0, 0);
        }
        places[at] = [x, y];
        x += sizes[at][0];
        shelf = shelf.max(sizes[at][1]);
    }
    (places, y + shelf)
}
