//! The receiver's WGSL as a naga_oil module: imported by a host's shader, for every kernel and map.

use crate::common::{noop, validate};
use crate::pcf::{descriptors, host_of, made, visibility_name};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga_oil::compose::{ComposableModuleDescriptor, Composer, NagaModuleDescriptor};
use shadows::{Kernel, MapKind, PcfDescriptor, wgsl};

/// Composes a host's shader with modules, writes the result out as WGSL, and validates that too.
fn compose(modules: &[String], host: &str) -> Result<(), String> {
    let mut composer = Composer::default();
    for source in modules {
        let added = composer.add_composable_module(ComposableModuleDescriptor {
            source,
            file_path: "shadows.wgsl",
            ..Default::default()
        });
        if let Err(error) = added.map(drop) {
            return Err(error.emit_to_string(&composer));
        }
    }
    let module = composer
        .make_naga_module(NagaModuleDescriptor {
            source: host,
            file_path: "host.wgsl",
            ..Default::default()
        })
        .map_err(|error| error.emit_to_string(&composer))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| error.to_string())?;
    let flags = naga::back::wgsl::WriterFlags::empty();
    let text = naga::back::wgsl::write_string(&module, &info, flags).map_err(|e| e.to_string())?;
    validate(&text).map(drop)
}

#[test]
fn every_module_is_imported_by_name_and_by_path() {
    let (device, queue) = noop();
    for descriptor in descriptors() {
        let sampler = made(&device, &queue, &descriptor);
        let pasted = sampler.wgsl_module(1);
        let module = wgsl::import_module("shadows::pcf", &pasted);
        let name = visibility_name(descriptor.map);
        let by_name = format!("#import shadows::pcf::{name}\n") + &host_of(&descriptor, "");
        let by_path = "#import shadows::pcf\n".to_owned() + &host_of(&descriptor, "shadows::pcf::");
        for host in [&by_name, &by_path] {
            compose(std::slice::from_ref(&module), host).unwrap();
        }
        // The broken twins: no module of that path; a host that does not import; a module pasted,
        // where naga knows no such directive.
        let elsewhere = wgsl::import_module("shadows::other", &pasted);
        assert!(compose(&[elsewhere], &by_name).is_err());
        assert!(compose(std::slice::from_ref(&module), &host_of(&descriptor, "")).is_err());
        assert!(validate(&module).is_err());
        assert!(validate(&pasted).is_ok());
    }
}

#[test]
fn functions_without_bindings_are_imported_too() {
    let (device, queue) = noop();
    for descriptor in descriptors() {
        let sampler = made(&device, &queue, &descriptor);
        let module = wgsl::import_module("shadows::functions", &sampler.wgsl());
        let (kind, names) = match descriptor.map {
            MapKind::Flat(_) => ("flat", "Flat"),
            MapKind::Atlas(kinds) if !kinds.point => ("flat", ""),
            _ => ("cube", ""),
        };
        let (texture, sampled) = match descriptor.kernel {
            Kernel::HardwareBilinear => ("texture_depth_2d_array", "sampler_comparison"),
            _ => ("texture_2d_array<f32>", "sampler"),
        };
        let function = descriptor.kernel.function().replace("cube", kind);
        let (bindings, kernel, pixel) = match descriptor.kernel.uses_pixel() {
            true => (
                format!(
                    "@group(0) @binding(3) var<uniform> kernel: functions::Shadows{names}Kernel;
                     @group(0) @binding(4) var offsets: texture_3d<f32>;"
                ),
                ", kernel, offsets",
                ", pixel.xy",
            ),
            false => Default::default(),
        };
        let host = format!(
            "#import shadows::functions as functions
             @group(0) @binding(0) var map: {texture};
             @group(0) @binding(1) var map_sampler: {sampled};
             @group(0) @binding(2) var<uniform> light: functions::Shadows{names}Light;
             {bindings}
             @fragment
             fn host(@builtin(position) pixel: vec4f, @location(0) at: vec3f) -> @location(0) vec4f {{
                 return vec4f(functions::{function}(
                     map, map_sampler, light{kernel}, at, vec3f(0.0, 1.0, 0.0){pixel},
                 ));
             }}"
        );
        compose(&[module], &host).unwrap();
    }
}

#[test]
fn two_kernels_on_one_kind_of_map_are_two_modules() {
    let (device, queue) = noop();
    let [near, far] = [Kernel::Vogel(Default::default()), Kernel::Weighted3].map(|kernel| {
        let descriptor = PcfDescriptor {
            kernel,
            ..Default::default()
        };
        made(&device, &queue, &descriptor)
    });
    let (near, far) = (near.wgsl_module(1), far.wgsl_module(2));
    let host = "
#import shadows::near
#import shadows::far
@fragment
fn host(@builtin(position) pixel: vec4f, @location(0) at: vec3f) -> @location(0) vec4f {
    return vec4f(shadows::near::shadows_visibility(at, pixel.xy) * shadows::far::shadows_visibility(at));
}
";
    let modules = [
        wgsl::import_module("shadows::near", &near),
        wgsl::import_module("shadows::far", &far),
    ];
    compose(&modules, host).unwrap();
    // The broken twin: pasted, they share their names.
    assert!(validate(&(near + &far)).is_err());
}

#[test]
fn the_other_shaders_are_imported_as_well() {
    let modules = [
        wgsl::import_module("shadows::position", wgsl::POSITION),
        wgsl::import_module("shadows::mask", wgsl::MASK),
        wgsl::import_module("shadows::exact", wgsl::EXACT),
        wgsl::import_module("shadows::exact_samples", wgsl::EXACT_SAMPLES),
    ];
    let host = "
#import shadows::position::shadows_clip_position
#import shadows::mask::shadows_mask
#import shadows::exact::shadows_exact_visibility
#import shadows::exact_samples::shadows_exact_lit_samples
@group(0) @binding(0) var mask: texture_2d_array<f32>;
@group(0) @binding(1) var counts: texture_2d<f32>;
@group(0) @binding(2) var samples: texture_multisampled_2d<f32>;
@vertex
fn corner(@location(0) at: vec3f) -> @builtin(position) vec4f {
    return shadows_clip_position(mat4x4f(), mat4x4f(), at);
}
@fragment
fn host(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let lit = shadows_exact_lit_samples(samples, pixel.xy);
    return vec4f(shadows_mask(mask, pixel.xy, 0), shadows_exact_visibility(counts, pixel.xy), f32(lit), 0.0);
}
";
    let composed = compose(&modules, host);
    assert!(composed.is_ok(), "{composed:?}");
    assert!(compose(&modules[..3], host).is_err());
}
