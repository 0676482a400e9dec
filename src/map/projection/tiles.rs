//! What a light's tiles show of the world, whatever its kind.

use glam::{DVec3, Mat4, Vec3};

use super::cube::{ALL_FACES, CubeFace, clear_of_near, face_of_all, touched_faces};
use super::flat::{FlatFrame, FlatFrustum};
use super::near::NearPlane;
use crate::PointLight;
use crate::scene::{CasterBounds, CasterFilter, Record};

/// The most tiles that a light has: the cascades of a directional light.
pub(crate) const MOST_TILES: usize = 8;

/// What one tile shows: with its place among its light's tiles, all that its matrix depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TileProjection {
    /// A face of the cube around a point light.
    Face(PointLight),
    /// A spot's cone, or a part of what a directional light shines on.
    Flat(FlatFrame),
}

impl TileProjection {
    /// What casters' positions are relative to when they are drawn.
    pub fn origin(&self) -> Vec3 {
        match self {
            Self::Face(light) => light.position,
            Self::Flat(frame) => frame.origin,
        }
    }

    /// Clip space of a light's tile number `tile` from positions relative to the origin.
    pub fn clip_from_light(&self, tile: usize, near_plane: NearPlane) -> Mat4 {
        match self {
            Self::Face(light) => CubeFace::ALL[tile].clip_from_light(near_plane.of_point(light)),
            Self::Flat(frame) => frame.clip_from_light(),
        }
    }

    /// The distance at which depths end.
    pub fn range(&self) -> f32 {
        match self {
            Self::Face(light) => light.range,
            Self::Flat(frame) => frame.range,
        }
    }

    /// Whether the light is outside a caster's bounds and no near plane cuts them.
    pub fn is_clear_of(&self, caster: &CasterBounds, near_plane: NearPlane) -> bool {
        match self {
            Self::Face(light) => {
                clear_of_near(light, caster, f64::from(near_plane.of_point(light)))
            }
            Self::Flat(frame) => frame.is_clear_of(caster),
        }
    }
}

/// What all tiles of a light show.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum LightProjection {
    /// Six faces, in the order of their layers.
    Point(PointLight),
    /// One tile.
    Spot(FlatFrame),
    /// A tile a cascade of a directional light; `None` where nothing casts on it.
    Cascades(Box<[Option<FlatFrame>]>),
}

impl LightProjection {
    /// How many tiles it has: 1 to [`MOST_TILES`].
    pub fn count(&self) -> usize {
        match self {
            Self::Point(_) => 6,
            Self::Spot(_) => 1,
            Self::Cascades(frames) => frames.len(),
        }
    }

    /// A mask of all its tiles.
    pub fn all(&self) -> u8 {
        match self {
            Self::Point(_) => ALL_FACES,
            _ => ((1_u16 << self.count()) - 1) as u8,
        }
    }

    /// What a tile shows, if anything.
    pub fn tile(&self, tile: usize) -> Option<TileProjection> {
        match self {
            Self::Point(light) => Some(TileProjection::Face(*light)),
            Self::Spot(frame) => Some(TileProjection::Flat(*frame)),
            Self::Cascades(frames) => frames[tile].map(TileProjection::Flat),
        }
    }

    /// Whether receivers are given one position for all tiles, so that tiles that were drawn for
    /// different ones cannot be read side by side.
    pub fn is_joint(&self) -> bool {
        matches!(self, Self::Point(_))
    }

    /// Whether tiles of one may take the place of tiles of the other.
    pub fn is_like(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
            && self.count() == other.count()
    }

    /// Where it can reach casters: centre and radius. `None`: everywhere.
    pub fn sphere(&self) -> Option<(DVec3, f64)> {
        match self {
            Self::Point(light) => Some((light.position.as_dvec3(), f64::from(light.range))),
            Self::Spot(frame) => Some((frame.origin.as_dvec3(), f64::from(frame.range))),
            Self::Cascades(_) => None,
        }
    }

    /// Equal for lights that are equal.
    pub fn key(&self) -> [u32; 3] {
        let origin = match self {
            Self::Point(light) => light.position,
            Self::Spot(frame) => frame.origin,
            // Few enough to be looked through.
            Self::Cascades(_) => Vec3::ZERO,
        };
        // Not -0, which is equal to 0.
        (origin + Vec3::ZERO).to_array().map(f32::to_bits)
    }
}

/// A light as it has a slot.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SlotLight {
    pub projection: LightProjection,
    pub filter: CasterFilter,
}

impl From<LightProjection> for SlotLight {
    fn from(projection: LightProjection) -> Self {
        Self {
            projection,
            filter: CasterFilter::ALL,
        }
    }
}

/// Which casters each tile of a light holds.
#[derive(Clone, Debug)]
pub(crate) enum TileSides {
    Faces(PointLight),
    Frusta(Vec<Option<FlatFrustum>>),
}

impl TileSides {
    pub fn new(light: &LightProjection) -> Self {
        match light {
            LightProjection::Point(light) => Self::Faces(*light),
            LightProjection::Spot(frame) => Self::Frusta(vec![Some(frame.frustum())]),
            LightProjection::Cascades(frames) => {
                let frusta = frames.iter().map(|frame| Some(frame.as_ref()?.frustum()));
                Self::Frusta(frusta.collect())
            }
        }
    }

    /// A mask of the tiles that a caster may touch.
    pub fn touched_by(&self, record: &Record) -> u8 {
        match self {
            Self::Faces(light) => touched_faces(light, &record.bounds),
            Self::Frusta(frusta) => frusta.iter().enumerate().fold(0, |mask, (tile, frustum)| {
                let holds = frustum
                    .as_ref()
                    .is_some_and(|frustum| frustum.holds(record));
                mask | u8::from(holds) << tile
            }),
        }
    }

    /// The same for every caster within some bounds, if it is the same for all.
    pub fn touched_by_all_in(&self, around: &CasterBounds) -> Option<u8> {
        match self {
            Self::Faces(light) => face_of_all(light, around),
            Self::Frusta(frusta) => {
                let mut mask = 0;
                for (tile, frustum) in frusta.iter().enumerate() {
                    match frustum {
                        Some(frustum) if frustum.holds_all(around) => mask |= 1 << tile,
                        Some(frustum) if frustum.touches(around) => return None,
                        _ => {}
                    }
                }
                Some(mask)
            }
        }
    }

    /// How large a caster is on a tile: about its share of the tile's solid angle or area, up to 1.
    pub fn share(&self, tile: usize, bounds: &CasterBounds) -> f64 {
        match self {
            Self::Faces(light) => {
                let squared = bounds.centre.distance_squared(light.position.as_dvec3());
                (bounds.radius * bounds.radius / squared).min(1.0)
            }
            Self::Frusta(frusta) => frusta[tile]
                .as_ref()
                .map_or(0.0, |frustum| frustum.share(bounds)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_of_either_sign_are_one_light() {
        let at = |x: f32| LightProjection::Point(PointLight::new(Vec3::new(x, 1.0, 2.0), 3.0));
        assert_eq!(at(0.0), at(-0.0));
        assert_eq!(at(0.0).key(), at(-0.0).key());
        assert_ne!(at(0.0).key(), at(1.0).key());
    }

    #[test]
    fn there_is_a_bit_for_every_tile() {
        let frames = |count| LightProjection::Cascades(vec![None; count].into());
        assert_eq!(frames(MOST_TILES).all(), 0xff);
        assert_eq!(frames(3).all(), 0b111);
        let point = LightProjection::Point(PointLight::new(Vec3::ZERO, 1.0));
        assert_eq!((point.all(), point.count()), (ALL_FACES, 6));
        assert!(!frames(6).is_like(&point) && !frames(3).is_like(&frames(4)));
    }
}
