//! The number of faces of a frame's volumes, and of the pixels they cover.

use glam::{DMat4, DVec3, DVec4, Vec4Swizzles as _};

use crate::error::VolumeRenderError;
use crate::mesh::{Adjacency, Bounds, MeshData, MeshKind, mesh_edges};
use crate::volume::ShadowVolumeRenderer;
use crate::volume::debug::screen_area::Screen;
use crate::volume::plan::faces::{Draw, Faces};
use crate::volume::plan::params::CasterParams;
use crate::volume::renderer::Drawn;
use crate::volume::silhouette::{Counts, CpuVolume, Way};

/// The faces that one frame draws, counted and measured, from [`ShadowVolumeRenderer::survey`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct VolumeSurvey {
    /// Silhouette edges, each counted as often as it is extruded.
    pub silhouette_edges: u64,
    /// The subset extruded to quads, of volumes that do not end in one point.
    pub side_quads: u64,
    /// The subset extruded to triangles, which meet in one point at infinity.
    pub side_triangles: u64,
    /// Triangles of light caps.
    pub light_cap_triangles: u64,
    /// Triangles of dark caps, fans included.
    pub dark_cap_triangles: u64,
    /// Pixels covered by sides, each counted as often as it is covered.
    pub side_fill: f64,
    /// The same for light caps.
    pub light_cap_fill: f64,
    /// The same for dark caps.
    pub dark_cap_fill: f64,
    /// Casters that were approximated by their bounding boxes, because their positions lie in a buffer of the
    /// host. For them, the numbers above are rough estimates, which may be off by any factor.
    pub casters_by_bounds: u32,
}

impl VolumeSurvey {
    /// Pixels covered by all faces, each counted as often as it is covered.
    pub fn fill(&self) -> f64 {
        self.side_fill + self.light_cap_fill + self.dark_cap_fill
    }
}

impl ShadowVolumeRenderer {
    /// Counts the faces that the last prepared frame draws under one light in one view, and estimates how many pixels
    /// of a target of this size they fill (with a viewport that covers all of it), before the depth test.
    ///
    /// The silhouettes are found on the CPU, regardless of how the frame finds them, so that nothing is read
    /// back and nothing waits. This takes the time of [`Silhouettes::Cpu`] for every drawn caster, and as
    /// long again for the areas: it is for debugging and tuning, not for every frame. The fill is the sum of
    /// the faces' areas on screen, clipped to it (and to the scissor rectangle of
    /// [`VolumeView::target_size`]) as polygons: what a rasteriser covers except for rounding at their edges,
    /// to within a few percent if faces are larger than pixels.
    ///
    /// Where more than two triangles meet in an edge, [`Silhouettes::Vertex`] draws sides that cancel
    /// each other; they are not counted here.
    ///
    /// [`Silhouettes::Cpu`]: crate::Silhouettes::Cpu
    /// [`Silhouettes::Vertex`]: crate::Silhouettes::Vertex
    /// [`VolumeView::target_size`]: crate::VolumeView::target_size
    ///
    /// # Errors
    /// [`VolumeRenderError::NoSuch`] if the frame had no such light or view,
    /// [`VolumeRenderError::Multiview`] if the renderer draws several views a pass.
    pub fn survey(
        &self,
        light: usize,
        view: usize,
        target_size: [u32; 2],
    ) -> Result<VolumeSurvey, VolumeRenderError> {
        let drawn = self.drawn_alone(light, view)?;
        let screen = Screen {
            size: target_size.map(f64::from),
            rect: drawn.pair.scissor.map(|(rect, _)| rect),
            near_is_clipped: self.options().near.ends_faces(),
        };
        let mut surveyor = Surveyor {
            screen,
            volume: CpuVolume::default(),
            counts: Counts::default(),
            survey: VolumeSurvey::default(),
        };
        for mut draws in drawn.pair.faces() {
            draws.retain(|draw| !draw.style.is_repeat());
            surveyor.add(&drawn, &draws);
        }
        Ok(surveyor.survey)
    }
}

struct Surveyor {
    screen: Screen,
    volume: CpuVolume,
    counts: Counts,
    survey: VolumeSurvey,
}

impl Surveyor {
    /// Adds all that is drawn of one volume.
    fn add(&mut self, drawn: &Drawn<'_>, draws: &[Draw]) {
        let Some(first) = draws.first() else { return };
        let Some((slot, params)) = drawn.of(first.window) else {
            return;
        };
        let boxed;
        let (mesh, kind) = match slot.mesh.data() {
            Some(mesh) => (mesh, slot.mesh.kind()),
            None => {
                let Some(data) = box_mesh(slot.mesh.bounds()) else {
                    return;
                };
                self.survey.casters_by_bounds += 1;
                boxed = data;
                (&boxed, MeshKind::Closed)
            }
        };
        self.counts = self.volume.extract(mesh, kind, &slot.instance);
        let corners = Corners::new(params, drawn);
        for draw in draws {
            match draw.style.faces {
                Faces::LightCap | Faces::DarkCap => {
                    self.add_caps(draw, slot.way, mesh, &corners);
                }
                Faces::Sides => self.add_sides(mesh, &corners),
                Faces::Fan => self.add_fan(mesh, &corners),
            }
        }
    }

    fn add_caps(&mut self, draw: &Draw, way: Way, mesh: &MeshData, corners: &Corners) {
        let front = self.counts.front as usize / 3;
        // Vertex shaders find both lists in one draw.
        let (skipped, taken) = match (way, draw.back) {
            (Way::Vertex, _) => (0, usize::MAX),
            (_, false) => (0, front),
            (_, true) => (front, usize::MAX),
        };
        let dark = draw.style.faces == Faces::DarkCap;
        let (mut count, mut area) = (0, 0.0);
        for triangle in self.volume.caps(mesh).skip(skipped).take(taken) {
            let points = triangle.map(|v| mesh.positions[v as usize]);
            let points = points.map(|p| {
                if dark {
                    corners.far(p)
                } else {
                    corners.near(p)
                }
            });
            area += self.screen.area(&points);
            count += 1;
        }
        let survey = &mut self.survey;
        let (triangles, fill) = match dark {
            true => (&mut survey.dark_cap_triangles, &mut survey.dark_cap_fill),
            false => (&mut survey.light_cap_triangles, &mut survey.light_cap_fill),
        };
        *triangles += count;
        *fill += area;
    }

    fn add_sides(&mut self, mesh: &MeshData, corners: &Corners) {
        let mut area = 0.0;
        for [a, b] in ends(&self.volume, mesh) {
            let [near_a, near_b, far_a] = [corners.near(a), corners.near(b), corners.far(a)];
            area += match corners.side_vertices {
                3 => self.screen.area(&[near_b, near_a, far_a]),
                _ => self.screen.area(&[near_b, near_a, far_a, corners.far(b)]),
            };
        }
        let count = self.volume.sides.len() as u64;
        let survey = &mut self.survey;
        survey.silhouette_edges += count;
        match corners.side_vertices {
            3 => survey.side_triangles += count,
            _ => survey.side_quads += count,
        }
        survey.side_fill += area;
    }

    fn add_fan(&mut self, mesh: &MeshData, corners: &Corners) {
        let triangles = ends(&self.volume, mesh);
        let area = |[a, b]: [[f32; 3]; 2]| {
            self.screen
                .area(&[corners.apex, corners.far(b), corners.far(a)])
        };
        self.survey.dark_cap_fill += triangles.map(area).sum::<f64>();
        self.survey.dark_cap_triangles += self.volume.sides.len() as u64;
    }
}

/// The ends of all sides' edges, whichever way they run.
fn ends<'a>(volume: &'a CpuVolume, mesh: &'a MeshData) -> impl Iterator<Item = [[f32; 3]; 2]> + 'a {
    volume.sides.iter().map(|side| {
        let [a, b, _, _] = mesh.edges[(side >> 1) as usize];
        [a, b].map(|v| mesh.positions[v as usize])
    })
}

/// Where corners lie in clip space, as `volume_extrude.wgsl` has them, in f64.
struct Corners {
    clip_from_world: DMat4,
    world_from_object: DMat4,
    light: DVec4,
    far_plane: DVec3,
    apex: DVec4,
    side_vertices: u32,
}

impl Corners {
    fn new(params: &CasterParams, drawn: &Drawn<'_>) -> Self {
        let matrix = |m: &[[f32; 4]; 4]| DMat4::from_cols_array_2d(&m.map(|c| c.map(f64::from)));
        let vector = |v: [f32; 4]| DVec4::from(v.map(f64::from));
        let clip_from_world = matrix(&drawn.view.clip_from_world);
        Self {
            clip_from_world,
            world_from_object: matrix(&params.world_from_object),
            light: vector(drawn.light.homogeneous),
            far_plane: vector(params.far_plane).xyz(),
            apex: clip_from_world * vector(params.apex),
            side_vertices: params.side_vertices,
        }
    }

    fn world(&self, position: [f32; 3]) -> DVec3 {
        let position = DVec3::from(position.map(f64::from));
        (self.world_from_object * position.extend(1.0)).xyz()
    }

    fn near(&self, position: [f32; 3]) -> DVec4 {
        self.clip_from_world * self.world(position).extend(1.0)
    }

    fn far(&self, position: [f32; 3]) -> DVec4 {
        let light = self.light.xyz();
        let direction = self.light.w * self.world(position) - light;
        if direction == DVec3::ZERO {
            return self.near(position);
        }
        let w = self.far_plane.dot(direction);
        self.clip_from_world * (direction + w * light).extend(w)
    }
}

/// A box as a mesh.
fn box_mesh(bounds: Bounds) -> Option<MeshData> {
    let (low, high) = (bounds.min.to_array(), bounds.max.to_array());
    let corner = |i: usize| [0, 1, 2].map(|axis| [low, high][i >> axis & 1][axis]);
    let positions: Vec<[f32; 3]> = (0..8).map(corner).collect();
    let triangles = [
        0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, //
        2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6,
    ];
    let adjacency = Adjacency::new(&positions, &triangles).ok()?;
    let closed = adjacency.kind() == MeshKind::Closed;
    closed.then(|| MeshData::new(positions, mesh_edges(&adjacency), &adjacency))
}
