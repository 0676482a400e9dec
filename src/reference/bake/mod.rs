//! Light maps: the visibility of a static light past static casters, computed once with the reference's rays
//! and stored in a texture over the receivers' second set of texture coordinates.
//!
//! Each texel holds the mean visibility over the light's area and over the part of the texel that a receiver
//! covers: an area-sampled light map (for the sampling see Cook, Porter and Carpenter, "Distributed Ray
//! Tracing", 1984). The host multiplies its light by it:
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
//! A shadow map adds the moving casters. No caster may darken twice, so how to combine the two visibilities, `baked`
//! and `dynamic`, depends on which casters each of them holds:
//!
//! | the light map holds | the shadow map holds | combination | correct |
//! |---|---|---|---|
//! | static casters | only dynamic casters | `baked * dynamic` | exactly for hard lights; for area lights to within 1/4 |
//! | static casters | only dynamic casters | `min(baked, dynamic)` | exactly for hard lights; for area lights up to 1/2 too light |
//! | static casters | all casters | `min(baked, dynamic)` | exactly for hard lights; a static penumbra is the darker of its two versions |
//! | static casters | all casters | `baked * dynamic` | **incorrect**: in the penumbrae of static casters, `v` becomes `v * v` |
//!
//! The first is the recommended one. Give static and dynamic casters one bit each in
//! [`Caster::layers`](crate::Caster::layers), and use
//! [`AtlasLight::with_layers`](crate::AtlasLight::with_layers) to restrict the light to the dynamic bit.
//!
//! The reason: a point sees a hard light if neither group is in the way, so visibilities multiply. Of an area light,
//! each group hides a part, and two numbers do not say how these parts overlap. The visibility of the whole scene lies
//! between `max(0, baked + dynamic - 1)` (the parts are disjoint) and `min(baked, dynamic)` (one contains the other).
//! The product also lies between them, at most 1/4 from either, and is exact if the parts overlap as independent events
//! would.
//!
//! Moving receivers have no light map. They need all casters in a shadow map: use a second `AtlasLight` at the
//! same place with both bits, or the third row of the table for all receivers.
//!
//! # Why it is part of the reference
//!
//! Baking uses the reference's rays and their bounds on rounding: a point on a surface is never hidden by its own
//! triangle, nor by others in the same plane, without any offset and at any scale.

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

/// Parameters of a bake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BakeDescriptor {
    /// Rays per texel, distributed over its covered part and over the light together; at least 1. Default 64.
    /// Baking time is proportional to it. In penumbrae, four times the rays leave a third to a half of the error;
    /// at hard edges, where the size of texels limits accuracy, 4 rays are enough. Powers of two are sampled most
    /// evenly.
    pub samples: u32,
    /// How many texels the content extends beyond the borders of charts, so that filters read nothing unrelated
    /// there. Bilinear filtering needs 1. On mip level `n` it needs 1 texel of that level, thus `2^n` here,
    /// unless the levels come from [`LightMap::half`], which fills the margin of each. Default 2. Charts must be
    /// twice as far apart.
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
    /// Bakes how much of a light is visible to the receivers of a layout past this scene's casters.
    ///
    /// A receiver that casts is also an object of the scene, with the same positions and transform (its vertices may be
    /// split where texture coordinates are), as a coarser copy would shadow it. The scene's holes
    /// ([`with_opacity`](Self::with_opacity)) let light through, and its progress callback
    /// ([`with_progress`](Self::with_progress)) is called for rows of the map. Rows are computed in parallel; the map
    /// is bit-identical for any number of threads.
    ///
    /// # Errors
    /// [`LightMapError`] if the light is invalid or there are no samples.
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
