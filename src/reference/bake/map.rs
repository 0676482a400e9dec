//! A baked map, and its images.

use std::fmt;
use std::sync::Arc;

use super::layout::LightMapLayout;
use super::margin::grow;
use super::texel::Texel;
use crate::error::LightMapError;

/// How much of a light is visible from each texel; created by [`bake`](super::super::ReferenceScene::bake).
///
/// Lists are row-major from the top left. Two maps are equal if their texels are; `seconds` is not compared.
#[derive(Clone)]
pub struct LightMap {
    size: [u32; 2],
    visibility: Vec<f32>,
    /// The part of each texel that the visibility is the mean over.
    weights: Vec<f32>,
    coverage: Arc<[f32]>,
    margin: u32,
    seconds: f64,
}

impl PartialEq for LightMap {
    fn eq(&self, other: &Self) -> bool {
        let Self {
            size,
            visibility,
            weights,
            coverage,
            margin,
            seconds: _,
        } = self;
        (*size, *margin) == (other.size, other.margin)
            && *visibility == other.visibility
            && *weights == other.weights
            && *coverage == other.coverage
    }
}

impl fmt::Debug for LightMap {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("LightMap")
            .field("size", &self.size)
            .field("margin", &self.margin)
            .field("seconds", &self.seconds)
            .finish_non_exhaustive()
    }
}

impl LightMap {
    pub(super) fn new(
        layout: &LightMapLayout,
        texels: &[Texel],
        margin: u32,
        seconds: f64,
    ) -> Self {
        let weights = texels.iter().map(|texel| texel.weight).collect();
        let visibility = texels.iter().map(|texel| texel.visibility).collect();
        Self {
            size: layout.size(),
            visibility,
            weights,
            coverage: layout.shared_coverage(),
            margin,
            seconds,
        }
        .with_margin()
    }

    fn with_margin(mut self) -> Self {
        let mut known: Vec<bool> = self.weights.iter().map(|weight| *weight > 0.0).collect();
        grow(&mut self.visibility, &mut known, self.size[0], self.margin);
        self
    }

    /// Columns and rows of texels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Wall-clock seconds that the bake took.
    pub fn seconds(&self) -> f64 {
        self.seconds
    }

    /// The visible fraction of the light: 0 in shadow, 1 lit. In the margin it is taken from the neighbours,
    /// beyond that it is 0.
    pub fn visibility(&self) -> &[f32] {
        &self.visibility
    }

    /// The fraction of each texel that receivers cover, 0 to 1; 0 in the margin.
    pub fn coverage(&self) -> &[f32] {
        &self.coverage
    }

    /// The value that a bilinear sampler reads at a position, in texels from the top left: (0.5, 0.5) is the centre
    /// of the first texel. Beyond the map, its edge is used (`ClampToEdge`).
    pub fn bilinear(&self, at: [f64; 2]) -> f32 {
        let parts = [0, 1].map(|axis| {
            let last = self.size[axis] - 1;
            let place = (at[axis] - 0.5).clamp(0.0, last.into());
            let first = place as u32;
            (first, (first + 1).min(last), place - f64::from(first))
        });
        let [(left, right, u), (above, below, v)] = parts;
        let texel = |x: u32, y: u32| {
            let place = y as usize * self.size[0] as usize + x as usize;
            f64::from(self.visibility[place])
        };
        let row = |y| (1.0 - u) * texel(left, y) + u * texel(right, y);
        ((1.0 - v) * row(above) + v * row(below)) as f32
    }

    /// The next mip level: each texel is the mean of four, weighted by coverage, and the margin is filled again.
    /// `None` after the last.
    ///
    /// Charts that share a texel of a level blend there: leave gaps of `2^n` texels for level `n`.
    #[must_use]
    pub fn half(&self) -> Option<Self> {
        if self.size == [1, 1] {
            return None;
        }
        let size = self.size.map(|side| (side / 2).max(1));
        // Of an odd number of texels the last one gets three.
        let texels = |at: u32, axis: usize| {
            let last = at + 1 == size[axis];
            2 * at..if last { self.size[axis] } else { 2 * at + 2 }
        };
        let mut half = Self {
            size,
            visibility: Vec::new(),
            weights: Vec::new(),
            ..self.clone()
        };
        let mut coverage = Vec::new();
        for y in 0..size[1] {
            for x in 0..size[0] {
                let (mut seen, mut weight, mut covered, mut count) = (0.0, 0.0, 0.0, 0.0);
                for row in texels(y, 1) {
                    for column in texels(x, 0) {
                        let place = row as usize * self.size[0] as usize + column as usize;
                        let own = f64::from(self.weights[place]);
                        seen += own * f64::from(self.visibility[place]);
                        weight += own;
                        covered += f64::from(self.coverage[place]);
                        count += 1.0;
                    }
                }
                let mean = if weight > 0.0 { seen / weight } else { 0.0 };
                half.visibility.push(mean as f32);
                half.weights.push((weight / count) as f32);
                coverage.push((covered / count) as f32);
            }
        }
        half.coverage = coverage.into();
        Some(half.with_margin())
    }

    /// As `R8Unorm`, one byte per texel: 255 is lit. One step is 0.004 of visibility.
    pub fn r8(&self) -> LightMapImage {
        let bytes = self.visibility.iter().map(|&value| byte(value));
        LightMapImage::new(wgpu::TextureFormat::R8Unorm, self.size, bytes.collect())
    }

    /// As `R32Float`, for further work: samplers filter it only with `Features::FLOAT32_FILTERABLE`.
    pub fn r32(&self) -> LightMapImage {
        let bytes = bytemuck::cast_slice(&self.visibility).to_vec();
        LightMapImage::new(wgpu::TextureFormat::R32Float, self.size, bytes)
    }

    /// Up to four lights in the channels of one `Rgba8Unorm` image. Channels without a map are 255 (lit).
    ///
    /// # Errors
    /// [`LightMapError`] if there are none or more than four maps, or they differ in size.
    pub fn rgba8(maps: &[&Self]) -> Result<LightMapImage, LightMapError> {
        let (Some(first), true) = (maps.first(), maps.len() <= 4) else {
            return Err(LightMapError::Channels(maps.len()));
        };
        if let Some(other) = maps.iter().find(|map| map.size != first.size) {
            return Err(LightMapError::OtherSize([first.size, other.size]));
        }
        let mut bytes = Vec::with_capacity(4 * first.visibility.len());
        for place in 0..first.visibility.len() {
            let channel = |k: usize| maps.get(k).map_or(255, |map| byte(map.visibility[place]));
            bytes.extend([0, 1, 2, 3].map(channel));
        }
        let format = wgpu::TextureFormat::Rgba8Unorm;
        Ok(LightMapImage::new(format, first.size, bytes))
    }
}

fn byte(value: f32) -> u8 {
    (255.0 * value).round() as u8
}

/// An image for `wgpu::Queue::write_texture`. Its values are linear, not sRGB.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub struct LightMapImage {
    /// Format of the texture.
    pub format: wgpu::TextureFormat,
    /// Columns, rows, one layer.
    pub size: wgpu::Extent3d,
    /// Without padding, which suits `write_texture`; copies from a buffer need multiples of 256.
    pub bytes_per_row: u32,
    /// Row-major from the top left.
    pub bytes: Vec<u8>,
}

impl fmt::Debug for LightMapImage {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("LightMapImage")
            .field("format", &self.format)
            .field("size", &self.size)
            .finish_non_exhaustive()
    }
}

impl LightMapImage {
    fn new(format: wgpu::TextureFormat, [width, height]: [u32; 2], bytes: Vec<u8>) -> Self {
        let size = wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        };
        Self {
            format,
            size,
            bytes_per_row: (bytes.len() / height as usize) as u32,
            bytes,
        }
    }

    /// The data layout to pass to `write_texture`.
    pub fn layout(&self) -> wgpu::TexelCopyBufferLayout {
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(self.bytes_per_row),
            rows_per_image: None,
        }
    }
}
