//! What receivers are told of the light of a flat map.

use wgpu::util::DeviceExt as _;

use crate::Bias;
use crate::map::encoding::quantum;
use crate::map::projection::FlatFrame;
use crate::uploads::Uploads;

/// What receivers need to know of the light; `ShadowsFlatLight` in WGSL.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct FlatLightUniform {
    pub position: [f32; 3],
    pub step: f32,
    pub forward: [f32; 3],
    pub texels: f32,
    pub right: [f32; 3],
    pub size: f32,
    pub down: [f32; 3],
    pub reach: f32,
    pub normal_offset: f32,
    pub depth_bias: f32,
    pub perspective: f32,
    /// Negative where nothing casts.
    pub quantum: f32,
    pub rounding: f32,
    pub texel: f32,
    pub depth_per: f32,
    pub widths: f32,
}

impl FlatLightUniform {
    /// A spot that reaches nothing, not even itself.
    pub(crate) const DARK: Self = Self {
        position: [0.0; 3],
        step: 0.0,
        forward: [0.0; 3],
        texels: 0.0,
        right: [0.0; 3],
        size: 0.0,
        down: [0.0; 3],
        reach: -1.0,
        normal_offset: 0.0,
        depth_bias: 0.0,
        perspective: 1.0,
        quantum: 0.0,
        rounding: 0.0,
        texel: 0.0,
        depth_per: 0.0,
        widths: 0.0,
    };

    /// `frame` is `None` where nothing casts.
    pub(crate) fn new(
        frame: Option<&FlatFrame>,
        bias: &Bias,
        size: u32,
        format: wgpu::TextureFormat,
    ) -> Self {
        let Some(frame) = frame else {
            return Self {
                quantum: -1.0,
                // A light of either kind, whatever is far away.
                perspective: 0.5,
                reach: 3e38,
                ..Self::default()
            };
        };
        // In the world, at distance 1 of a spot.
        let texel = 2.0 / (frame.scale * size as f32);
        Self {
            position: frame.origin.to_array(),
            step: 1.0 / size as f32,
            forward: frame.forward.to_array(),
            texels: 1.0 / texel,
            right: frame.right.to_array(),
            size: size as f32,
            down: (-frame.up).to_array(),
            reach: frame.range * frame.range,
            normal_offset: bias.normal_offset * texel,
            depth_bias: match frame.perspective {
                true => 1.0 + bias.constant * texel,
                false => bias.constant * texel / frame.range,
            },
            perspective: f32::from(u8::from(frame.perspective)),
            quantum: quantum(format).unwrap_or(0.0),
            rounding: bias.rounding(),
            texel,
            depth_per: match frame.perspective {
                true => frame.near * (1.0 + bias.constant * texel),
                false => 1.0 / frame.range,
            },
            widths: match frame.perspective {
                true => 0.0,
                false => 32.0 / (frame.scale * frame.range),
            },
        }
    }
}

/// The uniform on the GPU; until something is written, [`FlatLightUniform::DARK`].
#[derive(Debug)]
pub(crate) struct FlatLightBuffer {
    buffer: wgpu::Buffer,
    /// What it holds once the uploads are recorded.
    written: Option<FlatLightUniform>,
}

impl FlatLightBuffer {
    pub fn new(device: &wgpu::Device, label: &str) -> Self {
        Self {
            buffer: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(&format!("{label} light")),
                contents: bytemuck::bytes_of(&FlatLightUniform::DARK),
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            }),
            written: None,
        }
    }

    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Uploads a light, if it is not what it was.
    pub fn write(&mut self, uploads: &mut Uploads, light: FlatLightUniform) {
        if self.written.replace(light) != Some(light) {
            uploads.write(&self.buffer, 0, bytemuck::bytes_of(&light));
        }
    }

    /// Takes nothing for written.
    pub fn forget(&mut self) {
        self.written = None;
    }
}

#[cfg(test)]
mod tests {
    use super::FlatLightUniform as Uniform;
    use crate::wgsl_layout::assert_layout;

    #[test]
    fn the_light_lies_in_memory_as_wgsl_has_it() {
        let text = include_str!("../../../shaders/flat_light.wgsl");
        assert_layout!(
            text,
            "ShadowsFlatLight",
            Uniform,
            position,
            step,
            forward,
            texels,
            right,
            size,
            down,
            reach,
            normal_offset,
            depth_bias,
            perspective,
            quantum,
            rounding,
            texel,
            depth_per,
            widths
        );
    }
}
