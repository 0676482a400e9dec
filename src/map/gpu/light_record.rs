//! What receivers are told of a light of whatever kind.

use crate::map::encoding::quantum;
use crate::map::projection::FlatFrame;
use crate::{Bias, PointLight};

/// Where a tile lies in the texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TilePlace {
    /// The corner nearest to that of the texture, in texels: multiples of [`TilePlace::UNIT`], less than
    /// [`TilePlace::MOST_TEXELS`].
    pub x: u32,
    pub y: u32,
    /// Less than [`TilePlace::MOST_LAYERS`].
    pub layer: u32,
}

impl TilePlace {
    /// A whole layer.
    pub fn layer(layer: u32) -> Self {
        Self { x: 0, y: 0, layer }
    }

    /// Corners of tiles are at multiples of so many texels.
    pub const UNIT: u32 = 16;
    /// The side of the largest texture whose texels can be told.
    pub const MOST_TEXELS: u32 = Self::UNIT << 10;
    pub const MOST_LAYERS: u32 = 1 << 12;

    /// As shaders have it.
    pub fn packed(self) -> u32 {
        debug_assert!(self.x < Self::MOST_TEXELS && self.x.is_multiple_of(Self::UNIT));
        debug_assert!(self.y < Self::MOST_TEXELS && self.y.is_multiple_of(Self::UNIT));
        debug_assert!(self.layer < Self::MOST_LAYERS);
        (self.x / Self::UNIT) | ((self.y / Self::UNIT) << 10) | (self.layer << 20)
    }
}

/// The texture that tiles lie in, and how its texels are biased.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TileTexture {
    /// Texels along a side.
    pub side: u32,
    pub bias: Bias,
    pub format: wgpu::TextureFormat,
}

/// Where a light's depths are: `N` tiles of `size` texels along a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tiles<const N: usize> {
    /// There.
    At { size: u32, places: [TilePlace; N] },
    /// Nowhere: nothing casts, so receivers in range are lit.
    NoCaster,
}

/// `ShadowsLight` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct LightRecord {
    pub position: [f32; 3],
    pub kind: u32,
    pub forward: [f32; 3],
    pub texels: f32,
    pub right: [f32; 3],
    pub middle: f32,
    pub down: [f32; 3],
    pub range_squared: f32,
    pub normal_offset: f32,
    pub depth_bias: f32,
    pub quantum: f32,
    pub rounding: f32,
    pub texel: f32,
    pub depth_per: f32,
    pub widths: f32,
    pub step: f32,
    pub tiles: [u32; 4],
    pub last_tiles: [u32; 2],
    pub per_blend: f32,
    pub centre: f32,
}

impl LightRecord {
    const POINT: u32 = 1;
    const SPOT: u32 = 2;
    const DIRECTIONAL: u32 = 3;
    const NO_CASTER: u32 = 4;
    const FURTHER_SHIFT: u32 = 8;
    /// The most cascades that may come after the first.
    pub const MOST_FURTHER: u32 = 15;

    /// No light: all is dark. Of a light that was not drawn yet, or of a place that holds none.
    pub const DARK: Self = Self {
        position: [0.0; 3],
        kind: 0,
        forward: [0.0; 3],
        texels: 0.0,
        right: [0.0; 3],
        middle: 0.0,
        down: [0.0; 3],
        range_squared: -1.0,
        normal_offset: 0.0,
        depth_bias: 0.0,
        quantum: 0.0,
        rounding: 0.0,
        texel: 0.0,
        depth_per: 0.0,
        widths: 0.0,
        step: 0.0,
        tiles: [0; 4],
        last_tiles: [0; 2],
        per_blend: 0.0,
        centre: 0.0,
    };

    /// A point light with its six tiles in the order of [`CubeFace::ALL`](crate::CubeFace::ALL); `near` is
    /// the distance of the near plane that they were drawn with.
    pub fn point(light: &PointLight, near: f32, tiles: Tiles<6>, texture: &TileTexture) -> Self {
        let none = Self {
            position: light.position.to_array(),
            kind: Self::POINT | Self::NO_CASTER,
            range_squared: light.range * light.range,
            ..Self::DARK
        };
        let Tiles::At { size, places } = tiles else {
            return none;
        };
        let texel = 2.0 / size as f32;
        let half_size = 0.499_999_8 * size as f32;
        let depth_bias = 1.0 + texture.bias.constant * texel;
        let scale = near * depth_bias / half_size;
        let [a, b, c, d, e, f] = places.map(TilePlace::packed);
        Self {
            kind: Self::POINT,
            forward: [scale, 32.0 * scale, light.range / near],
            texels: half_size,
            depth_bias,
            depth_per: near * depth_bias,
            tiles: [a, b, c, d],
            last_tiles: [e, f],
            ..none.in_texture(texture, size, texel)
        }
    }

    /// A spot, or one cascade of a directional light.
    pub fn flat(frame: &FlatFrame, tile: Tiles<1>, texture: &TileTexture) -> Self {
        let kind = match frame.perspective {
            true => Self::SPOT,
            false => Self::DIRECTIONAL,
        };
        let none = Self {
            position: frame.origin.to_array(),
            kind: kind | Self::NO_CASTER,
            forward: frame.forward.to_array(),
            right: frame.right.to_array(),
            down: (-frame.up).to_array(),
            range_squared: match frame.perspective {
                true => frame.range * frame.range,
                false => f32::MAX,
            },
            ..Self::DARK
        };
        let Tiles::At {
            size,
            places: [place],
        } = tile
        else {
            return none;
        };
        // In the world, at distance 1 of a spot.
        let texel = 2.0 / (frame.scale * size as f32);
        let constant = texture.bias.constant * texel;
        let (depth_bias, depth_per, widths) = match frame.perspective {
            true => (1.0 + constant, frame.near * (1.0 + constant), 0.0),
            false => (
                constant / frame.range,
                1.0 / frame.range,
                32.0 / (frame.scale * frame.range),
            ),
        };
        Self {
            kind,
            texels: 1.0 / texel,
            depth_bias,
            depth_per,
            widths,
            tiles: [place.packed(), 0, 0, 0],
            ..none.in_texture(texture, size, texel)
        }
    }

    /// The nearest cascade of a directional light: so many records of further ones begin at a place of
    /// the buffer.
    pub fn with_further(self, further: u32, first: u32) -> Self {
        debug_assert!(further <= Self::MOST_FURTHER);
        if further == 0 {
            return self;
        }
        let [tile, ..] = self.tiles;
        Self {
            kind: self.kind | (further << Self::FURTHER_SHIFT),
            tiles: [tile, first, 0, 0],
            ..self
        }
    }

    /// A light that nothing is hidden from.
    pub fn lit() -> Self {
        Self {
            kind: Self::DIRECTIONAL | Self::NO_CASTER,
            range_squared: f32::MAX,
            ..Self::DARK
        }
    }

    /// A cascade that blends into the next over the last `texels` before its border; 0: at once.
    pub fn with_blend(self, texels: f32) -> Self {
        Self {
            per_blend: texels.recip().min(f32::MAX),
            ..self
        }
    }

    /// `texel`: the world width of one, at distance 1 of a light with a position.
    fn in_texture(self, texture: &TileTexture, size: u32, texel: f32) -> Self {
        Self {
            middle: 0.5 * size as f32,
            centre: if size.is_multiple_of(2) { 0.5 } else { 0.0 },
            texel,
            normal_offset: texture.bias.normal_offset * texel,
            quantum: quantum(texture.format).unwrap_or(0.0),
            rounding: texture.bias.rounding(),
            step: 1.0 / texture.side as f32,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wgsl_layout::assert_layout;

    #[test]
    fn the_record_lies_in_memory_as_wgsl_has_it() {
        let text = include_str!("../../../shaders/light_record.wgsl");
        assert_layout!(
            text,
            "ShadowsLight",
            LightRecord,
            position,
            kind,
            forward,
            texels,
            right,
            middle,
            down,
            range_squared,
            normal_offset,
            depth_bias,
            quantum,
            rounding,
            texel,
            depth_per,
            widths,
            step,
            tiles,
            last_tiles,
            per_blend,
            centre
        );
        assert!(size_of::<LightRecord>() <= 128);
    }

    #[test]
    fn every_place_has_bits_of_its_own() {
        let last = TilePlace {
            x: TilePlace::MOST_TEXELS - TilePlace::UNIT,
            y: TilePlace::MOST_TEXELS - TilePlace::UNIT,
            layer: TilePlace::MOST_LAYERS - 1,
        };
        assert_eq!(last.packed(), u32::MAX);
        let bits = [(last.x, 0, 0), (0, last.y, 0), (0, 0, last.layer)]
            .map(|(x, y, layer)| TilePlace { x, y, layer }.packed());
        assert_eq!(bits[0] ^ bits[1] ^ bits[2], u32::MAX);
    }
}
