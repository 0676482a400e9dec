//! Where resolution is no excuse for what a light's tiles get wrong.

use anyhow::Result;
use shadows::AtlasTile;
use shadows::glam::{DVec3, DVec4};
use shadows::reference::{Comparison, Interior, ReferenceImage, Verdict};

use host::scene::LightKind;

/// A light's tiles, and the kernel that reads them.
pub struct Resolution {
    pub tiles: Vec<AtlasTile>,
    pub kind: LightKind,
    /// In texels.
    pub kernel_radius: f32,
    /// At most so many texels before its border a cascade begins to turn into the next.
    pub band: f64,
}

/// Texels from a cascade's border within which kernels may read it or not: more than any reads to a side.
const BORDER: f64 = 16.0;

impl Resolution {
    /// Compares a light's picture with the truth. A pixel is interior if it is at the texels of the tile that it
    /// reads. Of cascades that is the nearest that holds it; beside that one's border, and where it blends,
    /// the next one's texels count, too.
    ///
    /// # Errors
    /// If the picture does not fit the reference.
    pub fn compare(&self, reference: &ReferenceImage, visibility: &[u8]) -> Result<Comparison> {
        let Some(first) = self.tiles.first() else {
            // Nothing casts.
            return Ok(reference.compare(visibility, Interior::Screen)?);
        };
        if self.kind == LightKind::Point {
            let at_texels = Interior::Map {
                face_size: first.size,
                kernel_radius: self.kernel_radius,
            };
            return Ok(reference.compare(visibility, at_texels)?);
        }
        let of_tile = |tile: &AtlasTile| {
            let at_texels = Interior::FlatMap {
                clip_from_world: tile.clip_from_world,
                size: tile.size,
                kernel_radius: self.kernel_radius,
            };
            reference.compare(visibility, at_texels)
        };
        let each = self.tiles.iter().map(of_tile);
        let each: Vec<Comparison> = each.collect::<Result<_, _>>()?;
        Ok(match self.kind {
            LightKind::Directional => self.joined(reference, &each),
            _ => each[0].clone(),
        })
    }

    /// Of each pixel the verdict by the cascades that it may read.
    fn joined(&self, reference: &ReferenceImage, each: &[Comparison]) -> Comparison {
        let mut found = each[0].clone();
        let width = reference.width() as usize;
        for (pixel, verdict) in found.verdicts.iter_mut().enumerate() {
            let [x, y] = [pixel % width, pixel / width].map(|at| at as u32);
            let Some(hit) = reference.hit(x, y) else {
                continue;
            };
            let mut read = self.read_at(hit.position);
            let interior = read.all(|tile| is_interior(each[tile].verdicts[pixel]));
            *verdict = match (*verdict, interior) {
                (Verdict::FalseLit | Verdict::FalseLitInterior, true) => Verdict::FalseLitInterior,
                (Verdict::FalseLit | Verdict::FalseLitInterior, false) => Verdict::FalseLit,
                (Verdict::FalseShadow | Verdict::FalseShadowInterior, true) => {
                    Verdict::FalseShadowInterior
                }
                (Verdict::FalseShadow | Verdict::FalseShadowInterior, false) => {
                    Verdict::FalseShadow
                }
                (right, _) => right,
            };
        }
        let count = |wanted| found.verdicts.iter().filter(|of| **of == wanted).count();
        found.false_lit_interior = count(Verdict::FalseLitInterior);
        found.false_shadow_interior = count(Verdict::FalseShadowInterior);
        found
    }

    /// The cascades that a point may read.
    fn read_at(&self, point: DVec3) -> impl Iterator<Item = usize> {
        let holds = |tile: &AtlasTile| inside(tile, point) > 0.0;
        let first = self.tiles.iter().position(holds);
        let of_next = |first: usize| {
            let beside = inside(&self.tiles[first], point) < self.band + BORDER;
            let next = first + 1;
            (beside && next < self.tiles.len() && holds(&self.tiles[next])).then_some(next)
        };
        first.into_iter().chain(first.and_then(of_next))
    }
}

/// How many texels a point is inside a tile's border; none before its near plane.
fn inside(tile: &AtlasTile, point: DVec3) -> f64 {
    let clip = tile.clip_from_world.as_dmat4() * DVec4::from((point, 1.0));
    match clip.z > 1.0 {
        true => 0.0,
        false => 0.5 * f64::from(tile.size) * (1.0 - clip.x.abs().max(clip.y.abs())),
    }
}

fn is_interior(verdict: Verdict) -> bool {
    matches!(
        verdict,
        Verdict::FalseLitInterior | Verdict::FalseShadowInterior
    )
}
