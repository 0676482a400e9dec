//! Pictures: 8-bit PNG files in memory.

use std::path::Path;

use anyhow::{Context as _, Result};

/// A grey picture, one byte a pixel, rows from the top.
pub fn grey_png(size: [u32; 2], pixels: &[u8]) -> Result<Vec<u8>> {
    encode(size, pixels, png::ColorType::Grayscale)
}

/// A colour picture, three bytes a pixel (sRGB), rows from the top.
pub fn rgb_png(size: [u32; 2], pixels: &[[u8; 3]]) -> Result<Vec<u8>> {
    encode(size, pixels.as_flattened(), png::ColorType::Rgb)
}

fn encode(size: [u32; 2], bytes: &[u8], color: png::ColorType) -> Result<Vec<u8>> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, size[0], size[1]);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()?;
    Ok(file)
}

/// Size and bytes of a file of 8 bits a channel.
pub fn read_png(path: &Path) -> Result<([u32; 2], Vec<u8>)> {
    let file = std::io::BufReader::new(std::fs::File::open(path)?);
    let mut reader = png::Decoder::new(file).read_info()?;
    let bytes = reader.output_buffer_size().context("it is too large")?;
    let mut pixels = vec![0; bytes];
    let info = reader.next_frame(&mut pixels)?;
    pixels.truncate(info.buffer_size());
    Ok(([info.width, info.height], pixels))
}

/// The colours of RGBA pixels.
pub fn without_alpha(rgba: &[u8]) -> Vec<[u8; 3]> {
    rgba.chunks_exact(4).map(|p| [p[0], p[1], p[2]]).collect()
}

/// Luma of an sRGB pixel (Rec. 709 weights applied to the encoded values).
pub fn luma([r, g, b]: [u8; 3]) -> u8 {
    (0.2126 * f32::from(r) + 0.7152 * f32::from(g) + 0.0722 * f32::from(b)).round() as u8
}
