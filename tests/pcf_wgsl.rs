//! The receiver's WGSL: valid in every configuration, free of bindings, free of other kernels.

mod common;

use common::{noop, to_glsl, validate, validation_error};
use shadows::{DepthEncoding, Kernel, PcfDescriptor, PcfSampler, wgpu};

fn sampler(kernel: Kernel) -> PcfSampler {
    let (device, _) = noop();
    PcfSampler::new(
        &device,
        &PcfDescriptor {
            kernel,
            ..Default::default()
        },
    )
}

const HOST: &str = "
@fragment
fn host(@location(0) position: vec3f) -> @location(0) vec4f {
    return vec4f(shadows_visibility(position));
}
";

const VERTEX: &str = "
struct Corner { @builtin(position) clip: vec4f, @location(0) position: vec3f }
@vertex
fn corner() -> Corner {
    return Corner();
}
";

#[test]
fn every_kernel_is_valid_as_functions_and_as_a_module_of_any_group() {
    for kernel in Kernel::ALL {
        let sampler = sampler(kernel);
        validate(&sampler.wgsl()).unwrap();
        for group in 0..4 {
            let text = sampler.wgsl_module(group) + HOST;
            let module = validate(&text).unwrap();
            assert!(
                module
                    .global_variables
                    .iter()
                    .all(|(_, v)| v.binding.is_some_and(|b| b.group == group))
            );
        }
    }
}

#[test]
fn the_functions_have_no_bindings() {
    for kernel in Kernel::ALL {
        let module = validate(&sampler(kernel).wgsl()).unwrap();
        assert!(module.global_variables.is_empty());
    }
}

#[test]
fn every_name_has_the_prefix() {
    for kernel in Kernel::ALL {
        let module = validate(&sampler(kernel).wgsl_module(1)).unwrap();
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
    let hard = sampler(Kernel::Hard).wgsl();
    assert!(!hard.contains("textureGather"));
    for kernel in Kernel::ALL {
        let text = sampler(kernel).wgsl();
        for other in Kernel::ALL {
            assert_eq!(text.contains(other.function()), kernel == other);
        }
    }
}

#[test]
fn every_kernel_translates_to_gl() {
    for kernel in Kernel::ALL {
        let text = sampler(kernel).wgsl_module(0) + HOST;
        to_glsl(&text, "host").unwrap();
    }
}

#[test]
fn a_host_pipeline_accepts_layout_and_module() {
    let (device, _) = noop();
    for kernel in Kernel::ALL {
        let sampler = PcfSampler::new(
            &device,
            &PcfDescriptor {
                kernel,
                ..Default::default()
            },
        );
        let source = sampler.wgsl_module(0) + HOST + VERTEX;
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

/// Every way to make a sampler but its kernel.
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
    let (device, _) = noop();
    for kernel in Kernel::ALL {
        for way in ways() {
            let sampler = PcfSampler::new(&device, &PcfDescriptor { kernel, ..way });
            let host = match way.many_lights {
                false => HOST.to_owned(),
                true => HOST.replace("(position)", "(3u, position)"),
            };
            let text = sampler.wgsl_module(2) + &host;
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
            let wrong = match way.many_lights {
                true => HOST.to_owned(),
                false => HOST.replace("(position)", "(3u, position)"),
            };
            assert!(validate_arrays(&(sampler.wgsl_module(2) + &wrong)).is_err());
        }
    }
}
