//! Texture coordinates for light maps, made for scenes that bring none: charts of triangles that face about the same
//! way, each projected onto a plane and packed. Tools that artists use do better; this does for any mesh.

mod charts;
mod pack;
mod parts;

use anyhow::{Context as _, Result};
use shadows::glam::DAffine3;
use shadows::reference::bake::{LightMapLayout, LightMapReceiver, TexelRectangle};

use self::charts::COSINES;
use self::pack::fitting;
use self::parts::Parts;
use super::scene::Scene;

/// A scene's objects with places in one square map.
pub struct Unwrapping {
    /// One for each object of the scene.
    pub objects: Vec<Unwrapped>,
    /// The same, checked: no two triangles share a place.
    pub layout: LightMapLayout,
    /// The longest side that a texel has on a surface, in metres. Along the other it is between this and 0.82 of it.
    pub texel: f64,
    /// How many charts there are.
    pub charts: usize,
}

/// An object whose triangles share no vertices.
pub struct Unwrapped {
    /// In object space, three a triangle, in the order of the mesh.
    pub positions: Vec<[f32; 3]>,
    /// Within the rectangle, 0 to 1.
    pub uvs: Vec<[f32; 2]>,
    /// Of the object in the map, texels.
    pub rectangle: TexelRectangle,
    indices: Vec<u32>,
    transform: DAffine3,
    two_sided: bool,
}

impl Unwrapped {
    fn receiver(&self) -> LightMapReceiver<'_> {
        LightMapReceiver {
            positions: &self.positions,
            indices: &self.indices,
            uvs: &self.uvs,
            transform: self.transform,
            rectangle: self.rectangle,
            two_sided: self.two_sided,
        }
    }
}

impl Unwrapping {
    /// Texels between a chart and what surrounds its cell, by default: what a bilinear filter needs.
    pub const GAP: u32 = 1;

    /// Finds the smallest texels with which the scene fits a map of `side` texels a side.
    ///
    /// # Errors
    /// If it does not fit with any, or a mesh is broken.
    pub fn new(scene: &Scene, side: u32) -> Result<Self> {
        Self::with_gap(scene, side, Self::GAP)
    }

    /// The same with another number of texels around each chart.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_gap(scene: &Scene, side: u32, gap: u32) -> Result<Self> {
        let objects = (0..scene.objects.len()).map(|object| {
            let name = &scene.objects[object].name;
            Parts::new(scene, object).with_context(|| format!("object {name:?}"))
        });
        let objects: Vec<Parts> = objects.collect::<Result<_>>()?;
        let (texel, places) = fitting(&objects, side, gap)?;
        let charts = objects.iter().map(|parts| parts.sizes.len()).sum();
        let objects: Vec<Unwrapped> = objects
            .into_iter()
            .zip(places)
            .map(|(parts, place)| parts.unwrapped(&place, texel))
            .collect();
        let receivers: Vec<_> = objects.iter().map(Unwrapped::receiver).collect();
        Ok(Self {
            layout: LightMapLayout::new([side; 2], &receivers)?,
            objects,
            texel: texel / COSINES[0],
            charts,
        })
    }
}
