//! An object's charts, flat.

use anyhow::Result;
use shadows::error::LightMapError;
use shadows::glam::{DAffine3, DVec2, DVec3};
use shadows::mesh::{Adjacency, MeshKind};
use shadows::reference::bake::{LightMapLayout, LightMapReceiver, TexelRectangle};

use super::Unwrapped;
use super::charts::{Charts, grown, neighbours};
use super::pack::Place;
use crate::scene::{Scene, widened};

/// An object's triangles by charts.
pub struct Parts {
    /// Of each chart, in metres, never higher than wide.
    pub sizes: Vec<DVec2>,
    /// In object space, three a triangle.
    positions: Vec<[f32; 3]>,
    transform: DAffine3,
    two_sided: bool,
    /// In metres, three a triangle, from the chart's own corner.
    flat: Vec<DVec2>,
    /// Of each triangle; `None` without area.
    charts: Vec<Option<usize>>,
}

impl Parts {
    /// Charts of which none overlaps itself.
    pub fn new(scene: &Scene, object: usize) -> Result<Self> {
        let placed = &scene.objects[object];
        let mesh = &scene.meshes[placed.mesh];
        let corners = mesh.indices.iter();
        let positions: Vec<[f32; 3]> = corners.map(|&at| mesh.positions[at as usize]).collect();
        let world: Vec<[DVec3; 3]> = positions
            .chunks_exact(3)
            .map(|t| [0, 1, 2].map(|k| placed.world_point(t[k])))
            .collect();
        let neighbours = neighbours(&positions);
        let normals: Vec<DVec3> = world
            .iter()
            .map(|[a, b, c]| (b - a).cross(c - a).normalize_or_zero())
            .collect();
        // Of an open mesh both sides are seen.
        let kind = Adjacency::new(&mesh.positions, &mesh.indices)?.kind();
        let mut parts = Self {
            sizes: Vec::new(),
            positions,
            transform: widened(&placed.transform),
            two_sided: kind == MeshKind::General,
            flat: Vec::new(),
            charts: Vec::new(),
        };
        let mut levels = vec![0; world.len()];
        loop {
            parts.flatten(&world, &grown(&normals, &neighbours, &levels));
            let Some(triangle) = parts.overlap()? else {
                return Ok(parts);
            };
            let folded = parts.charts[triangle];
            let own = levels.iter_mut().zip(&parts.charts);
            own.filter(|(_, chart)| **chart == folded)
                .for_each(|(level, _)| *level += 1);
        }
    }

    /// A triangle of a chart that lies on another of the same chart, if there is one.
    fn overlap(&self) -> Result<Option<usize>> {
        let area: f64 = self.sizes.iter().map(|size| size.x * size.y).sum();
        let texel = area.sqrt().max(f64::MIN_POSITIVE) / 1024.0;
        let place = Place::alone(&self.cells(texel, 1), 1);
        let indices: Vec<u32> = (0..self.positions.len() as u32).collect();
        let receiver = LightMapReceiver {
            positions: &self.positions,
            indices: &indices,
            uvs: &self.uvs(&place, texel),
            transform: self.transform,
            // Texels are of no interest here.
            rectangle: TexelRectangle {
                width: 1,
                height: 1,
                ..Default::default()
            },
            two_sided: self.two_sided,
        };
        match LightMapLayout::new([1; 2], &[receiver]) {
            Ok(_) => Ok(None),
            Err(LightMapError::UvOverlap { triangles, .. }) => Ok(Some(triangles[1])),
            Err(error) => Err(error.into()),
        }
    }

    /// Projects each chart, in the direction in which its box is smallest.
    fn flatten(&mut self, world: &[[DVec3; 3]], charts: &Charts) {
        self.charts = charts
            .iter()
            .map(|chart| chart.map(|(place, _)| place))
            .collect();
        let count = self
            .charts
            .iter()
            .flatten()
            .max()
            .map_or(0, |last| last + 1);
        let mut members: Vec<Vec<usize>> = vec![Vec::new(); count];
        for (triangle, chart) in self.charts.iter().enumerate() {
            if let Some(chart) = chart {
                members[*chart].push(triangle);
            }
        }
        self.flat = vec![DVec2::ZERO; 3 * world.len()];
        self.sizes.clear();
        for triangles in &members {
            let first = triangles[0];
            let normal = charts[first].map_or(DVec3::Y, |(_, normal)| normal);
            let (across, low, high) = directions(&world[first], normal)
                .into_iter()
                .map(|across| {
                    let corners = triangles.iter().flat_map(|&triangle| world[triangle]);
                    let (low, high) = extent(corners.map(|corner| seen(corner, across, normal)));
                    (across, low, high)
                })
                .min_by(|a, b| area(a).total_cmp(&area(b)))
                .unwrap_or_default();
            let size = high - low;
            // Lying, so that rows are low.
            let turned = |at: DVec2| {
                if size.y > size.x {
                    DVec2::new(at.y, at.x)
                } else {
                    at
                }
            };
            for &triangle in triangles {
                let at = world[triangle].map(|corner| turned(seen(corner, across, normal) - low));
                self.flat[3 * triangle..][..3].copy_from_slice(&at);
            }
            self.sizes.push(turned(size));
        }
    }

    /// Texels of each chart's cell.
    pub fn cells(&self, texel: f64, gap: u32) -> Vec<[u32; 2]> {
        let cell = |size: &DVec2| {
            let texels = (*size / texel).ceil() + 2.0 * f64::from(gap);
            [texels.x as u32, texels.y as u32].map(|side| side.max(1))
        };
        self.sizes.iter().map(cell).collect()
    }

    /// With places in the map.
    pub fn unwrapped(self, place: &Place, texel: f64) -> Unwrapped {
        Unwrapped {
            uvs: self.uvs(place, texel),
            indices: (0..self.positions.len() as u32).collect(),
            positions: self.positions,
            transform: self.transform,
            rectangle: place.rectangle,
            two_sided: self.two_sided,
        }
    }

    fn uvs(&self, place: &Place, texel: f64) -> Vec<[f32; 2]> {
        let rectangle = place.rectangle;
        let size = DVec2::new(rectangle.width.into(), rectangle.height.into());
        let uv = |(corner, at): (usize, &DVec2)| {
            let Some(chart) = self.charts[corner / 3] else {
                return [0.0; 2];
            };
            let cell = DVec2::from_array(place.cells[chart].map(f64::from));
            let at = cell + f64::from(place.gap) + *at / texel;
            (at / size).as_vec2().to_array()
        };
        self.flat.iter().enumerate().map(uv).collect()
    }
}

type Box2 = (DVec3, DVec2, DVec2);

fn area((_, low, high): &Box2) -> f64 {
    let size = *high - *low;
    size.x * size.y
}

/// Directions in the plane: a triangle's edges, and one that is as good as any.
fn directions([a, b, c]: &[DVec3; 3], normal: DVec3) -> [DVec3; 4] {
    let across = |edge: DVec3| (edge - edge.dot(normal) * normal).normalize();
    [
        normal.any_orthonormal_vector(),
        across(b - a),
        across(c - b),
        across(a - c),
    ]
}

fn seen(point: DVec3, across: DVec3, normal: DVec3) -> DVec2 {
    DVec2::new(across.dot(point), normal.cross(across).dot(point))
}

fn extent(points: impl Iterator<Item = DVec2>) -> (DVec2, DVec2) {
    let empty = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    points.fold(empty, |(low, high), at| (low.min(at), high.max(at)))
}
