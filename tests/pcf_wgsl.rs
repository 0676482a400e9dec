//! The receiver's WGSL: valid in every configuration, free of bindings, free of other kernels.

mod common;

use common::{noop, to_glsl, validate, validation_error};
use shadows::{Kernel, PcfDescriptor, PcfSampler, wgpu};

fn sampler(kernel: Kernel) -> PcfSampler {
    let (device, queue) = noop();
    made(&device, &queue, kernel)
}

fn made(device: &wgpu::Device, queue: &wgpu::Queue, kernel: Kernel) -> PcfSampler {
    let descriptor = PcfDescriptor {
        kernel,
        ..Default::default()
    };
    PcfSampler::new(device, queue, &descriptor).unwrap()
}

/// A fragment shader that asks for the visibility at its position.
fn host(kernel: Kernel) -> String {
    let pixel = if kernel.uses_pixel() {
        ", pixel.xy"
    } else {
        ""
    };
    format!(
        "
@fragment
fn host(@builtin(position) pixel: vec4f, @location(0) position: vec3f) -> @location(0) vec4f {{
    return vec4f(shadows_visibility(position{pixel}));
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
fn every_kernel_is_valid_as_functions_and_as_a_module_of_any_group() {
    for kernel in Kernel::ALL {
        let sampler = sampler(kernel);
        validate(&sampler.wgsl()).unwrap();
        for group in 0..4 {
            let text = sampler.wgsl_module(group) + &host(kernel);
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
            assert_eq!(
                text.contains(&format!("fn {}(", other.function())),
                kernel == other
            );
        }
    }
}

#[test]
fn every_kernel_translates_to_gl() {
    for kernel in Kernel::ALL {
        let text = sampler(kernel).wgsl_module(0) + &host(kernel);
        to_glsl(&text, "host").unwrap();
    }
}

#[test]
fn a_host_pipeline_accepts_layout_and_module() {
    let (device, queue) = noop();
    for kernel in Kernel::ALL {
        let sampler = made(&device, &queue, kernel);
        let source = sampler.wgsl_module(0) + &host(kernel) + VERTEX;
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
