//! Which pixels are so far from any shadow edge that resolution cannot explain an error.

use std::f64::consts::{SQRT_2, TAU};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::sync::PoisonError;

use glam::{DVec3, Mat4, Vec4Swizzles};

use super::caster_edges::beside_edges;
use super::geometry::SurfacePoint;
use super::image::{Class, Lighting, ReferenceImage, Seen};
use super::map_rays::{MapRays, Rays};
use crate::error::ReferenceError;

/// How many pixel footprints apart two neighbouring surfaces must be to count as a depth edge.
///
/// On a smooth convex surface the neighbour lies at most one footprint off the tangent plane, on
/// the silhouette itself; a diagonal neighbour's footprint is already longer. Twice that leaves
/// room for the creases of a tessellation.
const STEP: f64 = 2.0;

/// Where an error counts as an interior error, because no shadow edge is near enough to explain it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Interior {
    /// For shadow volumes. Over the surrounding 3 x 3 pixels (those inside the picture), the reference agrees
    /// (only [`Class::Lit`] is lit), none is background, and there is no depth edge.
    Screen,
    /// For cube shadow maps of a point light. In addition to the conditions of [`Screen`](Self::Screen), the
    /// reference agrees wherever a light ray within 1.5 texels plus the kernel's radius of the pixel's own meets
    /// the tangent plane. A ray that misses the plane counts as an edge, and so does the edge of a shadow beyond
    /// the light's range, because a map holds that, too.
    Map {
        /// Texels along the edge of a cube face; at least 1.
        face_size: u32,
        /// Largest offset of a tap in texels, from the middle of a face; 0 for one tap.
        kernel_radius: f32,
    },
    /// For flat shadow maps of a spot or directional light: like [`Map`](Self::Map), with the texels of this
    /// map.
    FlatMap {
        /// From world space to the map's clip space, as the map was drawn:
        /// [`ShadowMap::clip_from_world`](crate::ShadowMap::clip_from_world).
        clip_from_world: Mat4,
        /// Texels along the map's edge; at least 1.
        size: u32,
        /// Largest offset of a tap in texels, from the middle of the map; 0 for one tap.
        kernel_radius: f32,
    },
    /// For light maps, of any light. In addition to the conditions of [`Screen`](Self::Screen), the reference
    /// agrees within 3.54 texels on the pixel's tangent plane: a texel is a mean over its area, a bilinear filter
    /// reads its neighbours, and those in the margin are means of their own neighbours.
    LightMap {
        /// Sides of a texel on the surface, world units, above 0; of the largest where they differ.
        texel: f32,
    },
}

impl Interior {
    /// The radius in which the reference must agree; `None` where the screen alone decides.
    pub(super) fn radius(self, directional: bool) -> Result<Option<Radius>, ReferenceError> {
        let (map, face_size, kernel_radius, possible) = match self {
            Self::Screen => return Ok(None),
            Self::LightMap { texel } if texel.is_finite() && texel > 0.0 => {
                let texels = 2.5 * SQRT_2;
                return Ok(Some(Radius {
                    texels,
                    across: texels * f64::from(texel),
                    map: MapRays::Surface,
                }));
            }
            Self::LightMap { texel } => return Err(ReferenceError::Texel(texel)),
            Self::Map {
                face_size,
                kernel_radius,
            } => (MapRays::Cube, face_size, kernel_radius, !directional),
            Self::FlatMap {
                clip_from_world,
                size,
                kernel_radius,
            } => {
                let map = MapRays::Flat(clip_from_world.as_dmat4());
                (map, size, kernel_radius, clip_from_world.is_finite())
            }
        };
        let sound = face_size > 0 && kernel_radius.is_finite() && kernel_radius >= 0.0;
        if !possible || !sound {
            return Err(ReferenceError::Interior {
                face_size,
                kernel_radius,
            });
        }
        let texels = 1.5 + f64::from(kernel_radius);
        let across = 2.0 * texels / f64::from(face_size);
        Ok(Some(Radius {
            texels,
            across,
            map,
        }))
    }
}

/// How far around a pixel the reference must agree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Radius {
    texels: f64,
    /// In units in which a map's edge is 2 long; of a light map in world units.
    across: f64,
    map: MapRays,
}

impl Radius {
    /// What tells radii apart in the cache.
    fn key(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.across.to_bits().hash(&mut hasher);
        matches!(self.map, MapRays::Surface).hash(&mut hasher);
        if let MapRays::Flat(clip_from_world) = &self.map {
            for entry in clip_from_world.to_cols_array() {
                entry.to_bits().hash(&mut hasher);
            }
        }
        hasher.finish()
    }
}

impl ReferenceImage {
    /// Whether a pixel that faces the light is in the interior.
    pub(super) fn is_interior(&self, pixel: usize, radius: Option<Radius>) -> bool {
        let width = self.width as usize;
        let (x, y) = ((pixel % width) as u32, (pixel / width) as u32);
        let Some(seen) = self.seen(x, y) else {
            return false;
        };
        self.screen_agrees(x, y, &seen)
            && radius.is_none_or(|radius| self.remembered(pixel, radius, &seen))
    }

    fn screen_agrees(&self, x: u32, y: u32, seen: &Seen) -> bool {
        let lit = self.class(x, y) == Class::Lit;
        let columns = x.saturating_sub(1)..=(x + 1).min(self.width - 1);
        let rows = y.saturating_sub(1)..=(y + 1).min(self.height - 1);
        rows.flat_map(|row| columns.clone().map(move |column| (column, row)))
            .all(|(column, row)| {
                (self.class(column, row) == Class::Lit) == lit
                    && self
                        .seen(column, row)
                        .is_some_and(|other| is_continuous(seen, &other))
            })
    }

    fn remembered(&self, pixel: usize, radius: Radius, seen: &Seen) -> bool {
        let cache = || {
            self.interiors
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
        };
        let key = (radius.key(), pixel);
        if let Some(&known) = cache().get(&key) {
            return known;
        }
        let lit = self.pixels[pixel].class == Class::Lit;
        let agrees = self.light_agrees(seen, lit, radius);
        cache().insert(key, agrees);
        agrees
    }

    /// Whether the reference says `lit` for all light rays within the radius: on rings at most half
    /// a texel apart, as are the rays on each, the outermost first since it most likely disagrees; then beside
    /// the edges of casters, whose shadows may be thinner than that. Not of a light map, which no rays of the light make:
    /// thinner shadows on it count as interior.
    fn light_agrees(&self, seen: &Seen, lit: bool, radius: Radius) -> bool {
        let light = self.lighting.light.xyz();
        let rays = Rays::new(&radius.map, light, seen.surface.position, seen.normal);
        // A shadow map knows no range and no cone: beside a shadow that goes on beyond them it holds that shadow's
        // edge, wherever that is.
        let reach = match (lit, &radius.map) {
            (true, _) | (_, MapRays::Surface) => self.lighting,
            (false, _) => Lighting::moved_to(self.lighting.light),
        };
        let agrees = |[u, v]: [f64; 2]| {
            let position = rays.meet(u, v);
            position.is_some_and(|position| self.lit_at(seen, position, reach) == lit)
        };
        let rings = (2.0 * radius.texels).ceil();
        let on_rings = (1..=rings as u32).rev().all(|ring| {
            let fraction = f64::from(ring) / rings;
            let count = (2.0 * TAU * radius.texels * fraction).ceil().max(8.0);
            (0..count as u32).all(|ray| {
                let angle = TAU * f64::from(ray) / count;
                let (v, u) = angle.sin_cos();
                let length = radius.across * fraction;
                agrees([length * u, length * v])
            })
        });
        let beside_edges = || {
            beside_edges(
                (&self.geometry, &self.lighting),
                &rays,
                (seen.surface.position, seen.normal),
                (radius.across, radius.across / radius.texels),
            )
            .all(|place| agrees(place.to_array()))
        };
        on_rings && (matches!(radius.map, MapRays::Surface) || beside_edges())
    }

    /// Whether that light reaches a point of the pixel's tangent plane.
    fn lit_at(&self, seen: &Seen, position: DVec3, lighting: Lighting) -> bool {
        let light = lighting.light.xyz();
        let size = seen
            .surface
            .size
            .max(light.abs().max(position.abs()).max_element());
        let surface = SurfacePoint {
            position,
            size,
            ..seen.surface
        };
        lighting.class(&self.geometry, &surface, seen.side) == Class::Lit
    }
}

/// Whether two neighbouring pixels see one surface without a step: each lies on the other's tangent
/// plane within [`STEP`] pixel footprints.
fn is_continuous(a: &Seen, b: &Seen) -> bool {
    if a.surface.triangle == b.surface.triangle {
        return true;
    }
    let (p, q) = (a.surface.position, b.surface.position);
    let footprint = b.ray.distance(p).min(a.ray.distance(q));
    let step = a.normal.dot(q - p).abs().max(b.normal.dot(q - p).abs());
    step <= STEP * footprint
}
