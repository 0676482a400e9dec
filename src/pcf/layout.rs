//! The bindings of a sampler.

use super::Kernel;
use super::kernel::KernelUniform;
use super::map_kind::{Lights, Reads};
use crate::map::{LightRecord, UNIFORM_LIGHTS};

/// The buffer that a sampler reads lights from, and how large it is at least.
fn light_buffer(reads: Reads) -> (wgpu::BufferBindingType, usize) {
    let one = size_of::<LightRecord>();
    match reads.lights {
        Lights::One => (wgpu::BufferBindingType::Uniform, one),
        Lights::Storage => (wgpu::BufferBindingType::Storage { read_only: true }, one),
        Lights::Uniform => (
            wgpu::BufferBindingType::Uniform,
            one * UNIFORM_LIGHTS as usize,
        ),
    }
}

/// What a sampler binds, from `first` on.
pub(super) fn layout_entries(
    kernel: Kernel,
    reads: Reads,
    first: u32,
) -> Vec<wgpu::BindGroupLayoutEntry> {
    let (lights, light_size) = light_buffer(reads);
    let visibility = wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE;
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding: first + binding,
        visibility,
        ty,
        count: None,
    };
    let float = wgpu::TextureSampleType::Float { filterable: false };
    let texture = |sample_type, view_dimension| wgpu::BindingType::Texture {
        sample_type,
        view_dimension,
        multisampled: false,
    };
    let (depths, sampler) = match kernel {
        Kernel::HardwareBilinear => (
            wgpu::TextureSampleType::Depth,
            wgpu::SamplerBindingType::Comparison,
        ),
        // A float texture rather than a depth texture: depths are compared here, texel by texel,
        // and GL reads depth textures only through its own single comparison.
        _ => (float, wgpu::SamplerBindingType::NonFiltering),
    };
    let buffer = |ty, size: usize| wgpu::BindingType::Buffer {
        ty,
        has_dynamic_offset: false,
        min_binding_size: wgpu::BufferSize::new(size as u64),
    };
    let mut entries = vec![
        entry(0, texture(depths, wgpu::TextureViewDimension::D2Array)),
        entry(1, wgpu::BindingType::Sampler(sampler)),
        entry(2, buffer(lights, light_size)),
    ];
    if kernel.uses_pixel() {
        let ty = wgpu::BufferBindingType::Uniform;
        entries.push(entry(3, buffer(ty, size_of::<KernelUniform>())));
        entries.push(entry(4, texture(float, wgpu::TextureViewDimension::D3)));
    }
    entries
}
