//! The receiver's WGSL: valid in every configuration, free of bindings, free of other kernels.

mod common;

use common::{noop, noop_with, to_glsl, validate, validation_error};
use shadows::{DepthEncoding, Kernel, MapKind, PcfDescriptor, PcfSampler, wgpu};

fn made(device: &wgpu::Device, queue: &wgpu::Queue, descriptor: &PcfDescriptor<'_>) -> PcfSampler {
    PcfSampler::new(device, queue, descriptor).unwrap()
}

/// All that a sampler can be made for.
fn descriptors() -> Vec<PcfDescriptor<'static>> {
    let mut all = Vec::new();
    for kernel in Kernel::ALL {
        for encoding in [DepthEncoding::MajorAxis, DepthEncoding::LinearDistance] {
            for many_lights in [false, true] {
                all.push(PcfDescriptor {
                    kernel,
                    encoding,
                    many_lights,
                    ..Default::default()
                });
            }
        }
        all.push(PcfDescriptor {
            kernel,
            map: MapKind::Flat,
            ..Default::default()
        });
    }
    all
}

/// The samplers of all configurations, on devices without any feature and with borders.
fn samplers() -> Vec<(PcfDescriptor<'static>, PcfSampler)> {
    let borders = wgpu::Features::ADDRESS_MODE_CLAMP_TO_BORDER;
    [wgpu::Features::empty(), borders]
        .into_iter()
        .flat_map(|features| {
            let (device, queue) = noop_with(features, wgpu::Limits::defaults());
            descriptors()
                .into_iter()
                .map(move |descriptor| {
                    let sampler = made(&device, &queue, &descriptor);
                    (descriptor, sampler)
                })
                .collect::<Vec<_>>()
        })
        .collect()
}

/// A fragment shader that asks for the visibility at its position.
fn host(descriptor: &PcfDescriptor<'_>) -> String {
    let pixel = if descriptor.kernel.uses_pixel() {
        ", pixel.xy"
    } else {
        ""
    };
    let light = if descriptor.many_lights { "3u, " } else { "" };
    let name = match descriptor.map {
        MapKind::Flat => "shadows_flat_visibility",
        _ => "shadows_visibility",
    };
    format!(
        "
@fragment
fn host(@builtin(position) pixel: vec4f, @location(0) position: vec3f) -> @location(0) vec4f {{
    return vec4f({name}({light}position{pixel}));
}}
"
    )
}

const VERTEX: &str = "
struct Corner { @builtin(position) clip: vec4f, @location(0) position: vec3f }
@vertex
fn corner() -> Corner {
    return Corner();
}
";

#[test]
fn every_configuration_is_valid_as_functions_and_as_a_module_of_any_group() {
    for (descriptor, sampler) in samplers() {
        if !descriptor.many_lights {
            validate(&sampler.wgsl()).unwrap();
        }
        for group in [0, 3] {
            let text = sampler.wgsl_module(group) + &host(&descriptor);
            if descriptor.many_lights {
                continue; // cube arrays are a capability; see the host's pipeline below
            }
            let module = validate(&text).unwrap();
            assert!(
                module
                    .global_variables
                    .iter()
                    .all(|(_, v)| v.binding.is_some_and(|b| b.group == group))
            );
        }
    }
    // The broken twin: a name that is not there.
    let (descriptor, sampler) = samplers().remove(0);
    let text = sampler.wgsl_module(0) + &host(&descriptor);
    assert!(validate(&text.replace("fn shadows_cube_receiver", "fn other")).is_err());
}

#[test]
fn the_functions_have_no_bindings() {
    for (descriptor, sampler) in samplers() {
        if !descriptor.many_lights {
            let module = validate(&sampler.wgsl()).unwrap();
            assert!(module.global_variables.is_empty());
        }
    }
}

#[test]
fn every_name_has_the_prefix() {
    for (descriptor, sampler) in samplers() {
        if descriptor.many_lights {
            continue;
        }
        let module = validate(&sampler.wgsl_module(1)).unwrap();
        let functions = module.functions.iter().filter_map(|(_, f)| f.name.clone());
        let globals = module
            .global_variables
            .iter()
            .filter_map(|(_, v)| v.name.clone());
        for name in functions.chain(globals) {
            assert!(name.starts_with("shadows_"), "{name}");
        }
        for (_, ty) in module.types.iter() {
            let name = ty.name.clone().unwrap_or("Shadows".to_owned());
            assert!(name.starts_with("Shadows"), "{name}");
        }
    }
}

#[test]
fn a_kernel_carries_no_code_of_another() {
    for (descriptor, sampler) in samplers() {
        let text = sampler.wgsl();
        let flat = descriptor.map == MapKind::Flat;
        for other in Kernel::ALL {
            let name = match flat {
                true => other.function().replace("cube", "flat"),
                false => other.function().to_owned(),
            };
            let there = text.contains(&format!("fn {name}("));
            assert_eq!(there, descriptor.kernel == other, "{name}");
        }
        if descriptor.kernel == Kernel::Hard {
            assert!(!text.contains("textureGather"));
            assert!(!text.contains("Kernel"));
        }
        assert_eq!(text.contains("cube"), !flat);
    }
}

#[test]
fn no_tap_loop_holds_a_transcendental_function() {
    for (_, sampler) in samplers() {
        let text = sampler.wgsl();
        // From each loop's head to the end of its function.
        for start in text.match_indices("for (").map(|(at, _)| at) {
            let rest = &text[start..];
            let body = &rest[..rest.find("\n}").unwrap()];
            for name in [
                "sin(", "cos(", "tan(", "exp(", "log(", "pow(", "sqrt(", "atan",
            ] {
                assert!(!body.contains(name), "{name} in {body}");
            }
        }
    }
}

#[test]
fn every_kernel_of_one_light_translates_to_gl() {
    for (descriptor, sampler) in samplers() {
        if !descriptor.many_lights {
            let text = sampler.wgsl_module(0) + &host(&descriptor);
            to_glsl(&text, "host").unwrap();
        }
    }
}

#[test]
fn a_cube_sampler_and_a_flat_one_share_a_shader() {
    let (device, queue) = noop();
    for kernel in Kernel::ALL {
        let modules = [MapKind::Cube, MapKind::Flat].map(|map| {
            let descriptor = PcfDescriptor {
                kernel,
                map,
                ..Default::default()
            };
            let group = if map == MapKind::Cube { 1 } else { 2 };
            made(&device, &queue, &descriptor).wgsl_module(group)
        });
        validate(&modules.concat()).unwrap();
        // The broken twin: the same names twice.
        assert!(validate(&[&modules[0][..], &modules[0]].concat()).is_err());
    }
}

#[test]
fn a_host_pipeline_accepts_layout_and_module() {
    let (device, queue) = noop();
    for descriptor in descriptors() {
        let sampler = made(&device, &queue, &descriptor);
        let source = sampler.wgsl_module(0) + &host(&descriptor) + VERTEX;
        let error = validation_error(&device, || {
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(source.as_str().into()),
            });
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: &[Some(sampler.bind_group_layout())],
                immediate_size: 0,
            });
            let _ = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: None,
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("corner"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: None,
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("host"),
                    compilation_options: Default::default(),
                    targets: &[Some(wgpu::TextureFormat::Rgba8Unorm.into())],
                }),
                multiview_mask: None,
                cache: None,
            });
        });
        assert_eq!(error, None);
    }
}

/// Every way to make a sampler for cubes but its kernel.
fn ways() -> Vec<PcfDescriptor<'static>> {
    let mut ways = Vec::new();
    for encoding in [DepthEncoding::MajorAxis, DepthEncoding::LinearDistance] {
        for many_lights in [false, true] {
            for textbook in [false, true] {
                ways.push(PcfDescriptor {
                    encoding,
                    many_lights,
                    textbook,
                    ..Default::default()
                });
            }
        }
    }
    ways
}

/// Parses and validates WGSL as a device with cube arrays would.
fn validate_arrays(wgsl: &str) -> Result<naga::Module, String> {
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|e| e.emit_to_string(wgsl))?;
    Validator::new(ValidationFlags::all(), Capabilities::CUBE_ARRAY_TEXTURES)
        .validate(&module)
        .map_err(|e| e.emit_to_string(wgsl))?;
    Ok(module)
}

#[test]
fn every_encoding_number_of_lights_and_method_is_valid() {
    let (device, queue) = noop();
    for kernel in Kernel::ALL {
        for way in ways() {
            let sampler = made(&device, &queue, &PcfDescriptor { kernel, ..way });
            // Textbook receivers are one tap, whatever the kernel.
            let called = if way.textbook { Kernel::Hard } else { kernel };
            let host = |many_lights| {
                host(&PcfDescriptor {
                    kernel: called,
                    many_lights,
                    ..way
                })
            };
            let text = sampler.wgsl_module(2) + &host(way.many_lights);
            let module = validate_arrays(&text).unwrap();
            for (_, function) in module.functions.iter() {
                let name = function.name.as_deref().unwrap_or_default();
                assert!(name.starts_with("shadows_"), "{name}");
            }
            assert_eq!(
                validate(&text).is_ok(),
                !way.many_lights,
                "arrays cost a capability"
            );
            // The broken twin: a host that calls as for the other number of lights.
            let wrong = sampler.wgsl_module(2) + &host(!way.many_lights);
            assert!(validate_arrays(&wrong).is_err());
        }
    }
}
