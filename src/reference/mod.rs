//! The ground truth: exact visibility by casting rays in f64, and the error of a technique against it.
//!
//! For each pixel centre, one ray is cast from the near plane to the nearest surface, and one from there to
//! the light (Whitted, "An Improved Illumination Model for Shaded Display", 1980). There is no bias, no
//! absolute epsilon and no resolution: the answer holds for the triangles as given, not for the shapes they
//! approximate. It takes seconds, so it is for measuring rather than for rendering frames.
//!
//! ```
//! use shadows::glam::camera::rh::{proj::directx as proj, view};
//! use shadows::glam::{DAffine3, Vec3};
//! use shadows::reference::{Class, Interior, ReferenceObject, ReferenceScene};
//! use shadows::{DepthConvention, HomogeneousLight, View};
//!
//! // A square of 4 x 4 metres on the ground, one of 2 x 2 above it, the light above both.
//! let square = |half: f32, y| {
//!     [[-half, y, -half], [-half, y, half], [half, y, half], [half, y, -half]]
//! };
//! let (ground, roof) = (square(2.0, 0.0), square(1.0, 1.0));
//! let object = |positions, casts| ReferenceObject {
//!     positions,
//!     indices: &[0, 1, 2, 0, 2, 3],
//!     transform: DAffine3::IDENTITY,
//!     casts,
//! };
//! let scene = ReferenceScene::new(&[object(&ground, false), object(&roof, true)])?;
//!
//! let projection = proj::perspective_infinite_reverse(1.0, 1.0, 0.1);
//! let camera = view::look_at_mat4(Vec3::new(0.0, 3.0, 4.0), Vec3::ZERO, Vec3::Y);
//! let view = View::new(projection * camera, DepthConvention::InfiniteReverse)?;
//! let light = HomogeneousLight::point(Vec3::new(0.0, 5.0, 0.0));
//! let image = scene.render(&view, 64, 64, light, None)?;
//! assert!(image.count(Class::Shadowed) > 0);
//!
//! // A technique without shadows is wrong wherever the reference has one.
//! let no_shadows = vec![1.0_f32; 64 * 64];
//! let error = image.compare(&no_shadows, Interior::Screen)?;
//! assert_eq!(error.false_lit, image.count(Class::Shadowed));
//! assert_eq!(error.false_shadow, 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod area;
pub mod bake;
mod camera;
mod caster_edges;
mod compare;
mod flips;
mod geometry;
mod image;
mod interior;
mod map_rays;
mod ray;
mod survey;

use crate::clock::Clock;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DAffine3, DVec3};
use rayon::prelude::*;

pub use self::compare::{Comparison, Verdict, Visibility};
pub use self::flips::Flips;
pub use self::geometry::Crossing;
pub use self::image::{Class, Hit, ReferenceImage};
pub use self::interior::Interior;
pub use self::survey::{Candidate, Survey};

use self::camera::Camera;
use self::geometry::{Geometry, Triangle};
use self::image::{Lighting, Pixel};
use crate::error::ReferenceError;
use crate::{HomogeneousLight, SpotLight, View};

/// A mesh for the reference. Any triangles are accepted: open, inconsistently wound or degenerate.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceObject<'a> {
    /// Vertex positions in object space.
    pub positions: &'a [[f32; 3]],
    /// Three indices into `positions` per triangle.
    pub indices: &'a [u32],
    /// World from object space; applied in f64.
    pub transform: DAffine3,
    /// Whether the object blocks light. Every object is visible and receives shadows.
    pub casts: bool,
}

/// A scene of triangles in world space, ready for ray casting. Clones share them.
#[derive(Clone)]
pub struct ReferenceScene {
    geometry: Geometry,
    progress: Option<Arc<dyn Fn(f64) + Send + Sync>>,
    /// All, if `None`.
    rows: Option<Range<u32>>,
}

impl ReferenceScene {
    /// Transforms the objects to world space and builds the bounding volume hierarchies.
    ///
    /// No objects, objects without triangles and triangles without area are allowed.
    ///
    /// # Errors
    /// [`ReferenceError`] names the object whose indices do not form triangles or are out of range, or whose
    /// vertices are not finite in world space.
    pub fn new(objects: &[ReferenceObject<'_>]) -> Result<Self, ReferenceError> {
        number(objects.len())?;
        let (mut casting, mut others) = (Vec::new(), Vec::new());
        for (place, object) in objects.iter().enumerate() {
            let list = if object.casts {
                &mut casting
            } else {
                &mut others
            };
            list.extend(world_triangles(place, object)?);
        }
        number(casting.len() + others.len())?;
        Ok(Self {
            geometry: Geometry::new(casting, others),
            progress: None,
            rows: None,
        })
    }

    /// The same scene with holes: a triangle is visible and blocks light only where `opacity` returns true.
    /// This is for surfaces that hosts cut out with a mask (alpha-tested leaves, wire fences), which must be
    /// evaluated as in their own shaders.
    ///
    /// It is called for every triangle that a ray hits, of any object, from any thread, and must always give
    /// the same answer. An edge of the mask is an edge like any other: errors next to it are not interior
    /// errors.
    #[must_use]
    pub fn with_opacity(
        mut self,
        opacity: impl Fn(&Crossing) -> bool + Send + Sync + 'static,
    ) -> Self {
        self.geometry = self.geometry.with_opacity(Arc::new(opacity));
        self
    }

    /// The same scene, which reports to `progress` during [`render`](Self::render) and [`bake`](Self::bake),
    /// from any thread, what fraction of the picture or map is done: above 0, up to 1.
    #[must_use]
    pub fn with_progress(mut self, progress: impl Fn(f64) + Send + Sync + 'static) -> Self {
        self.progress = Some(Arc::new(progress));
        self
    }

    /// The same scene, but of each picture only these rows are computed, counted from the top: for a picture
    /// that is computed a few rows at a time, so that it can be cancelled in between. The image contains just
    /// these rows, with the same content as in the whole picture. [`Interior`] looks one row further, so
    /// include one more row on either side, if there is one, and ignore its result.
    ///
    /// [`render`](Self::render) rejects an empty range, and one that extends below the picture.
    #[must_use]
    pub fn with_rows(mut self, rows: Range<u32>) -> Self {
        self.rows = Some(rows);
        self
    }

    /// What the camera sees, and whether the light reaches it, at the centre of each pixel.
    ///
    /// `width` and `height` are in pixels. A point light (`w = 1`) reaches no farther than `range`, in world
    /// units; a directional light has none and ignores it. The near and the far plane of `view` clip what is
    /// seen, not what casts. Rows are computed in parallel; the result does not depend on the number of
    /// threads.
    ///
    /// # Errors
    /// [`ReferenceError`] if the light or the range is invalid, or if the picture has no pixels.
    pub fn render(
        &self,
        view: &View,
        width: u32,
        height: u32,
        light: HomogeneousLight,
        range: Option<f32>,
    ) -> Result<ReferenceImage, ReferenceError> {
        self.render_lit(view, width, height, Lighting::checked(light, range)?)
    }

    /// The same for a spot. Anything outside its cone is [`Class::OutOfRange`]: it receives none of the
    /// spot's light, so techniques are not judged there.
    ///
    /// # Errors
    /// [`ReferenceError`] if the light is invalid, or if the picture has no pixels.
    pub fn render_spot(
        &self,
        view: &View,
        width: u32,
        height: u32,
        light: &SpotLight,
    ) -> Result<ReferenceImage, ReferenceError> {
        light.validate()?;
        self.render_lit(view, width, height, Lighting::of_spot(light))
    }

    fn render_lit(
        &self,
        view: &View,
        width: u32,
        height: u32,
        lighting: Lighting,
    ) -> Result<ReferenceImage, ReferenceError> {
        let start = Clock::start();
        if width == 0 || height == 0 {
            return Err(ReferenceError::Size { width, height });
        }
        let rows = self.rows.clone().unwrap_or(0..height);
        if rows.is_empty() || rows.end > height {
            return Err(ReferenceError::Rows { rows, height });
        }
        let count = rows.end - rows.start;
        let camera = Camera::new(view, width, height).starting_at(rows.start);
        let done = AtomicUsize::new(0);
        let row = |y: u32| -> Vec<Pixel> {
            let pixels = (0..width)
                .map(|x| Pixel::cast(&self.geometry, &lighting, &camera.ray(x, y)))
                .collect();
            if let Some(progress) = &self.progress {
                let rows = done.fetch_add(1, Ordering::Relaxed) + 1;
                progress(rows as f64 / f64::from(count));
            }
            pixels
        };
        let pixels = (0..count).into_par_iter().map(row).flatten_iter();
        Ok(ReferenceImage {
            geometry: self.geometry.clone(),
            camera,
            lighting,
            width,
            height: count,
            pixels: pixels.collect(),
            seconds: start.elapsed().as_secs_f64(),
            interiors: Default::default(),
        })
    }
}

/// A count as the hierarchies number it.
fn number(count: usize) -> Result<u32, ReferenceError> {
    u32::try_from(count)
        .ok()
        .filter(|&count| count < u32::MAX)
        .ok_or(ReferenceError::TooLarge(count))
}

/// The triangles of an object that have an area, in world space.
fn world_triangles(
    object: usize,
    mesh: &ReferenceObject<'_>,
) -> Result<Vec<Triangle>, ReferenceError> {
    let (faces, rest) = mesh.indices.as_chunks::<3>();
    if !rest.is_empty() {
        let count = mesh.indices.len();
        return Err(ReferenceError::IndexCount { object, count });
    }
    let world = world_positions(object, mesh)?;
    let corner = |index: u32| {
        let vertices = world.len();
        world
            .get(index as usize)
            .copied()
            .ok_or(ReferenceError::IndexOutOfRange {
                object,
                index,
                vertices,
            })
    };
    let mut triangles = Vec::with_capacity(faces.len());
    for (place, &[a, b, c]) in faces.iter().enumerate() {
        let triangle = Triangle {
            corners: [corner(a)?, corner(b)?, corner(c)?],
            source: [number(object)?, number(place)?],
        };
        if triangle.normal() != DVec3::ZERO {
            triangles.push(triangle);
        }
    }
    Ok(triangles)
}

fn world_positions(
    object: usize,
    mesh: &ReferenceObject<'_>,
) -> Result<Vec<DVec3>, ReferenceError> {
    let place = |(vertex, position): (usize, &[f32; 3])| {
        let position = DVec3::from_array(position.map(f64::from));
        let world = mesh.transform.transform_point3(position);
        match number(vertex)? {
            _ if world.is_finite() => Ok(world),
            vertex => Err(ReferenceError::Position { object, vertex }),
        }
    };
    mesh.positions.iter().enumerate().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_32_bits_can_count_is_refused() {
        let most = u32::MAX as usize;
        assert_eq!(number(most - 1), Ok(u32::MAX - 1));
        assert_eq!(number(most), Err(ReferenceError::TooLarge(most)));
        assert_eq!(
            number(usize::MAX),
            Err(ReferenceError::TooLarge(usize::MAX))
        );
    }
}
