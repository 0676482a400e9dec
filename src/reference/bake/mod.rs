//! Light maps: the visibility of a light that does not move past casters that do not move, found once by
//! the reference's rays and kept in a texture over the receivers' second set of texture coordinates.
//!
//! Each texel holds the mean, over the part of it that a receiver covers and over the light's area, of whether
//! the light is seen from there: an area-sampled light map (Cook, Porter and Carpenter, "Distributed Ray
//! Tracing", 1984, for the sampling). The host multiplies its light with it:
//!
//! ```wgsl
//! // `place`: TexelRectangle::scale_and_offset, one for each receiver.
//! let baked = textureSample(light_map, linear_sampler, second_uv * place.xy + place.zw).r;
//! let light = color * falloff * max(dot(normal, toward_light), 0.0) * baked;
//! ```
//!
//! ```
//! use shadows::glam::{DAffine3, Vec3};
//! use shadows::reference::bake::*;
//! use shadows::reference::{ReferenceObject, ReferenceScene};
//! use shadows::PointLight;
//!
//! // A ground of 4 x 4 metres, and a roof of 2 x 2 above it, which casts.
//! let square = |half: f32, y| {
//!     [[-half, y, -half], [-half, y, half], [half, y, half], [half, y, -half]]
//! };
//! let (ground, roof, indices) = (square(2.0, 0.0), square(1.0, 1.0), [0, 1, 2, 0, 2, 3]);
//! let scene = ReferenceScene::new(&[ReferenceObject {
//!     positions: &roof,
//!     indices: &indices,
//!     transform: DAffine3::IDENTITY,
//!     casts: true,
//! }])?;
//!
//! let uvs = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
//! let receiver = LightMapReceiver {
//!     positions: &ground,
//!     indices: &indices,
//!     uvs: &uvs,
//!     transform: DAffine3::IDENTITY,
//!     // Two texels of the map remain on each side, which the margin fills.
//!     rectangle: TexelRectangle { x: 2, y: 2, width: 60, height: 60 },
//!     two_sided: false,
//! };
//! let layout = LightMapLayout::new([64, 64], &[receiver])?;
//! let light = PointLight::new(Vec3::new(0.0, 5.0, 0.0), 20.0);
//! let lamp = BakedLight::new(light).with_emitter(Emitter::Sphere { radius: 0.2 });
//! let map = scene.bake(&layout, &lamp, &BakeDescriptor::default())?;
//! assert_eq!(map.bilinear([32.0, 32.0]), 0.0); // under the roof
//! assert_eq!(map.bilinear([4.0, 32.0]), 1.0);
//!
//! let image = map.r8(); // for `wgpu::Queue::write_texture`, with `image.layout()`
//! assert_eq!((image.bytes_per_row, image.bytes.len()), (64, 64 * 64));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Together with dynamic shadows
//!
//! A shadow map for what moves goes on top. No caster may darken twice, so which casters are in which decides how the
//! two visibilities, `baked` and `dynamic`, are joined:
//!
//! | the light map holds | the shadow map holds | join | right |
//! |---|---|---|---|
//! | static casters | dynamic casters alone | `baked * dynamic` | exactly for hard lights; for a light with a size within 1/4 |
//! | static casters | dynamic casters alone | `min(baked, dynamic)` | exactly for hard lights; for a light with a size up to 1/2 too light |
//! | static casters | all casters | `min(baked, dynamic)` | exactly for hard lights; a static penumbra is the darker of its two renditions |
//! | static casters | all casters | `baked * dynamic` | **wrong**: in the penumbrae of static casters `v` becomes `v * v` |
//!
//! The first is what this crate is made for. Give static and dynamic casters a bit each in
//! [`Caster::layers`](crate::Caster::layers), and the light
//! [`AtlasLight::with_layers`](crate::AtlasLight::with_layers) of the dynamic bit.
//!
//! Why: a point sees a hard light if neither group is in the way, so visibilities multiply. Of a light with a size the
//! two groups hide parts; how the parts overlap is not in two numbers. The whole scene's visibility lies between
//! `max(0, baked + dynamic - 1)` (the parts are disjoint) and `min(baked, dynamic)` (one holds the other). The
//! product lies between them too, at most 1/4 from either, and is exact where the parts overlap as chance would have it.
//!
//! Receivers that move have no light map. They need all casters in a shadow map: a second `AtlasLight` at the same
//! place with both bits, or the third row of the table for all receivers.
//!
//! # Why here
//!
//! The rays, their bounds on rounding and the feature are the reference's: a point of a surface is never hidden by its
//! own triangle, nor by those in its plane, without an offset and at any scale. Nothing else of the crate needs them.

mod charts;
mod emitter;
mod face;
mod layout;
mod map;
mod margin;
mod overlap;
mod piece;
mod sequence;
mod texel;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use rayon::prelude::*;

pub use self::emitter::{BakedLight, Emitter};
pub use self::layout::{LightMapLayout, LightMapReceiver, TexelRectangle};
pub use self::map::{LightMap, LightMapImage};

use self::sequence::Sequence;
use self::texel::{Baker, Texel};
use super::ReferenceScene;
use crate::error::LightMapError;

/// How a light map is baked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BakeDescriptor {
    /// Rays a texel, over the part of it that is covered and over the light at once; at least 1. Default 64.
    /// Baking takes time in proportion. In penumbrae four times the rays leave a third to a half of the error; at
    /// hard edges the size of texels decides, and 4 do. Powers of two are sampled most evenly.
    pub samples: u32,
    /// By how many texels the content grows beyond the borders of charts, so that filters find nothing foreign
    /// there. Bilinear filtering needs 1, on the map's mip level `n` 1 there, thus `2^n` here unless the
    /// levels come from [`LightMap::half`], which grows each anew. Default 2. Charts must be twice as far apart.
    pub margin: u32,
}

impl Default for BakeDescriptor {
    fn default() -> Self {
        Self {
            samples: 64,
            margin: 2,
        }
    }
}

impl ReferenceScene {
    /// Bakes how much of a light the receivers of a layout see past this scene's casters.
    ///
    /// A receiver that casts is also an object of the scene, with the same positions and transform (its vertices may be
    /// split where texture coordinates are): a coarser copy of itself would shadow it. The scene's holes
    /// ([`with_opacity`](Self::with_opacity)) let light through, and its progress
    /// ([`with_progress`](Self::with_progress)) hears of rows of the map. Rows are computed in parallel; the map is
    /// the same, bit for bit, on any number of threads.
    ///
    /// # Errors
    /// [`LightMapError`] if the light is not valid or there are no samples.
    pub fn bake(
        &self,
        layout: &LightMapLayout,
        light: &BakedLight,
        descriptor: &BakeDescriptor,
    ) -> Result<LightMap, LightMapError> {
        light.validate()?;
        if descriptor.samples == 0 {
            return Err(LightMapError::Samples);
        }
        let start = Instant::now();
        let baker = Baker {
            geometry: &self.geometry,
            layout,
            light: light.prepared(),
            sequence: Sequence::new(),
            samples: descriptor.samples,
        };
        let [_, height] = layout.size();
        let done = AtomicUsize::new(0);
        let row = |y: u32| -> Vec<Texel> {
            let texels = baker.row(y);
            if let Some(progress) = &self.progress {
                let rows = done.fetch_add(1, Ordering::Relaxed) + 1;
                progress(rows as f64 / f64::from(height));
            }
            texels
        };
        let rows = (0..height).into_par_iter().map(row).flatten_iter();
        let texels: Vec<Texel> = rows.collect();
        let seconds = start.elapsed().as_secs_f64();
        Ok(LightMap::new(layout, &texels, descriptor.margin, seconds))
    }
}
