//! Every configuration of a `PcfSampler`, and hosts that ask it.
#![allow(dead_code)] // each test uses its own part

use naga::valid::{Capabilities, ValidationFlags, Validator};
use shadows::{DepthEncoding, Gather, Kernel, MapKind, PcfDescriptor, PcfSampler, wgpu};

pub fn made(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    descriptor: &PcfDescriptor<'_>,
) -> PcfSampler {
    PcfSampler::new(device, queue, descriptor).unwrap()
}

/// The kernels that differ with and without gathers.
pub const SQUARES: [Kernel; 5] = [
    Kernel::Bilinear,
    Kernel::FourTaps,
    Kernel::Weighted3,
    Kernel::Weighted5,
    Kernel::Weighted7,
];

/// All kernels, and once more without gathers those that else have them.
fn kernels() -> impl Iterator<Item = (Kernel, Gather)> {
    let all = Kernel::ALL.map(|kernel| (kernel, Gather::Auto));
    all.into_iter()
        .chain(SQUARES.map(|kernel| (kernel, Gather::Never)))
}

/// All that a sampler can be made for.
pub fn descriptors() -> Vec<PcfDescriptor<'static>> {
    let mut all = Vec::new();
    for (kernel, gather) in kernels() {
        for encoding in [DepthEncoding::MajorAxis, DepthEncoding::LinearDistance] {
            for many_lights in [false, true] {
                all.push(PcfDescriptor {
                    kernel,
                    encoding,
                    many_lights,
                    gather,
                    ..Default::default()
                });
            }
        }
        all.push(PcfDescriptor {
            kernel,
            map: MapKind::Flat,
            gather,
            ..Default::default()
        });
    }
    all
}

/// A fragment shader that asks for the visibility at its position; `module` is what stands before
/// the function's name.
pub fn host_of(descriptor: &PcfDescriptor<'_>, module: &str) -> String {
    let pixel = match descriptor.kernel.uses_pixel() {
        true => ", pixel.xy",
        false => "",
    };
    let light = if descriptor.many_lights { "3u, " } else { "" };
    let name = visibility_name(descriptor.map);
    format!(
        "
@fragment
fn host(@builtin(position) pixel: vec4f, @location(0) position: vec3f) -> @location(0) vec4f {{
    return vec4f({module}{name}({light}position{pixel}));
}}
"
    )
}

/// The same where the module is pasted.
pub fn host(descriptor: &PcfDescriptor<'_>) -> String {
    host_of(descriptor, "")
}

pub fn visibility_name(map: MapKind) -> &'static str {
    match map {
        MapKind::Flat => "shadows_flat_visibility",
        _ => "shadows_visibility",
    }
}

/// Parses and validates WGSL as a device with cube arrays would.
pub fn validate_arrays(wgsl: &str) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|e| e.emit_to_string(wgsl))?;
    Validator::new(ValidationFlags::all(), Capabilities::CUBE_ARRAY_TEXTURES)
        .validate(&module)
        .map_err(|e| e.emit_to_string(wgsl))?;
    Ok(module)
}
