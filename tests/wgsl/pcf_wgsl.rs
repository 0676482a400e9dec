//! The receiver's WGSL: valid in every configuration, free of bindings, free of other kernels.

use crate::common::{noop, to_glsl, to_webgl, validate, validation_error};
use crate::pcf::{SQUARES, WAYS, descriptors, host, made, samplers, takes_light};
use shadows::{DepthEncoding, Gather, Kernel, MapKind, PcfDescriptor, wgpu};

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
        validate(&sampler.wgsl()).unwrap();
        for group in [0, 3] {
            let text = sampler.wgsl_module(group) + &host(&descriptor);
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
    for (_, sampler) in samplers() {
        let module = validate(&sampler.wgsl()).unwrap();
        assert!(module.global_variables.is_empty());
    }
}

#[test]
fn every_name_has_the_prefix() {
    for (_, sampler) in samplers() {
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
        let flat = match descriptor.map {
            MapKind::Atlas(kinds) => !kinds.point,
            map => matches!(map, MapKind::Flat(_)),
        };
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

/// The functions called in a block, and the expressions computed there; in its loops alone if
/// `in_loop` is false on entry.
fn taps(
    block: &naga::Block,
    in_loop: bool,
    calls: &mut Vec<naga::Handle<naga::Function>>,
    values: &mut Vec<naga::Handle<naga::Expression>>,
) {
    use naga::Statement as S;
    for statement in block {
        match statement {
            S::Loop {
                body, continuing, ..
            } => {
                taps(body, true, calls, values);
                taps(continuing, true, calls, values);
            }
            S::Block(inner) => taps(inner, in_loop, calls, values),
            S::If { accept, reject, .. } => {
                taps(accept, in_loop, calls, values);
                taps(reject, in_loop, calls, values);
            }
            S::Call { function, .. } if in_loop => calls.push(*function),
            S::Emit(range) if in_loop => values.extend(range.clone()),
            _ => {}
        }
    }
}

/// Transcendental functions that run once a tap: in loops, and in what loops call.
fn transcendental_taps(module: &naga::Module) -> Vec<naga::MathFunction> {
    use naga::MathFunction as M;
    let mut found = Vec::new();
    let mut waiting: Vec<_> = module.functions.iter().map(|(f, _)| (f, false)).collect();
    let mut seen = std::collections::HashSet::new();
    while let Some((handle, in_loop)) = waiting.pop() {
        if !seen.insert((handle, in_loop)) {
            continue;
        }
        let function = &module.functions[handle];
        let (mut calls, mut values) = (Vec::new(), Vec::new());
        taps(&function.body, in_loop, &mut calls, &mut values);
        waiting.extend(calls.into_iter().map(|call| (call, true)));
        found.extend(
            values
                .into_iter()
                .filter_map(|value| match function.expressions[value] {
                    naga::Expression::Math { fun, .. } => Some(fun),
                    _ => None,
                }),
        );
    }
    found.retain(|fun| {
        matches!(
            fun,
            M::Sin
                | M::Cos
                | M::Tan
                | M::Asin
                | M::Acos
                | M::Atan
                | M::Atan2
                | M::Sinh
                | M::Cosh
                | M::Tanh
                | M::Exp
                | M::Exp2
                | M::Log
                | M::Log2
                | M::Pow
        )
    });
    found
}

#[test]
fn no_tap_loop_runs_a_transcendental_function() {
    for (descriptor, sampler) in samplers() {
        let text = sampler.wgsl();
        let module = validate(&text).unwrap();
        assert_eq!(transcendental_taps(&module), [], "{descriptor:?}");
        // The broken twin: one in the function that every tap of a disk calls.
        if descriptor.kernel.uses_pixel() {
            let worse = text.replace("offset.x * disk.across", "cos(offset.x) * disk.across");
            let module = validate(&worse).unwrap();
            assert!(!transcendental_taps(&module).is_empty());
        }
    }
}

#[test]
fn every_kernel_translates_to_gl() {
    for (descriptor, sampler) in samplers() {
        let text = sampler.wgsl_module(0) + &host(&descriptor);
        to_glsl(&text, "host").unwrap();
    }
}

/// Found 16: what WebGL 2 has no word for, in GLSL that naga wrote for it.
fn beyond_webgl(glsl: &str) -> Option<&'static str> {
    assert!(glsl.starts_with("#version 300 es"), "{glsl}");
    let missing = ["textureGather", "imageLoad", "buffer "];
    missing.into_iter().find(|word| glsl.contains(word))
}

/// Sizes in bytes of what a module has as uniforms. In WebGL 2 they come in units of 16.
fn uniform_sizes(module: &naga::Module) -> Vec<u32> {
    let uniforms = module.global_variables.iter().filter_map(|(_, variable)| {
        let is_uniform = variable.space == naga::AddressSpace::Uniform;
        is_uniform.then_some(variable.ty)
    });
    uniforms
        .map(|ty| module.types[ty].inner.size(module.to_ctx()))
        .collect()
}

#[test]
fn every_kernel_of_one_light_without_gathers_is_webgl_2() {
    let mut squares = 0;
    for (descriptor, sampler) in samplers() {
        if takes_light(&descriptor) {
            continue; // a storage buffer, which is not there
        }
        let text = sampler.wgsl_module(0) + &host(&descriptor);
        let glsl = to_webgl(&text, "host").unwrap();
        let gathers = SQUARES.contains(&descriptor.kernel) && descriptor.gather == Gather::Auto;
        // The broken twin: the same kernels with gathers.
        let missing = gathers.then_some("textureGather");
        assert_eq!(beyond_webgl(&glsl), missing, "{descriptor:?}");
        squares += usize::from(gathers);
        let sizes = uniform_sizes(&validate(&text).unwrap());
        assert!(sizes.iter().all(|size| size % 16 == 0), "{sizes:?}");
    }
    let one_light = WAYS
        .iter()
        .filter(|way| !matches!(way.map, MapKind::Atlas(_)) && way.gather == Gather::Auto);
    assert_eq!(squares, one_light.count() * SQUARES.len());
    // The broken twin: parameters of a disk without padding.
    let (_, disk) = samplers()
        .into_iter()
        .find(|(descriptor, _)| descriptor.kernel.uses_pixel() && descriptor.map == MapKind::CUBE)
        .unwrap();
    let short = disk.wgsl_module(0).replace("padding: u32,", "");
    assert!(uniform_sizes(&validate(&short).unwrap()).contains(&28));
}

#[test]
fn gathers_are_in_the_squares_alone_and_only_where_they_are_wanted() {
    for (descriptor, sampler) in samplers() {
        let gathers = SQUARES.contains(&descriptor.kernel) && descriptor.gather == Gather::Auto;
        assert_eq!(
            sampler.wgsl().contains("textureGather"),
            gathers,
            "{descriptor:?}"
        );
        // A device without a driver has gathers, so asking for them is the same.
        if descriptor.gather == Gather::Auto {
            let (device, queue) = noop();
            let always = PcfDescriptor {
                gather: Gather::Always,
                map: descriptor.map,
                kernel: descriptor.kernel,
                ..Default::default()
            };
            let always = made(&device, &queue, &always).wgsl();
            assert_eq!(always.contains("textureGather"), gathers);
        }
    }
}

#[test]
fn a_cube_sampler_and_a_flat_one_share_a_shader() {
    let (device, queue) = noop();
    for kernel in Kernel::ALL {
        let modules = [MapKind::CUBE, MapKind::FLAT].map(|map| {
            let descriptor = PcfDescriptor {
                kernel,
                map,
                ..Default::default()
            };
            let group = if map == MapKind::CUBE { 1 } else { 2 };
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

/// Every way to make a sampler for maps of one light but its kernel, and one for atlases.
fn ways() -> Vec<PcfDescriptor<'static>> {
    let linear = MapKind::Cube(DepthEncoding::LinearDistance);
    let of = |map, textbook| PcfDescriptor {
        map,
        textbook,
        ..Default::default()
    };
    vec![
        of(MapKind::CUBE, false),
        of(linear, false),
        of(linear, true),
        of(MapKind::ATLAS, false),
    ]
}

#[test]
fn every_encoding_and_method_is_valid() {
    let (device, queue) = noop();
    for kernel in Kernel::ALL {
        for way in ways() {
            if way.textbook && kernel != Kernel::Hard || !kernel.reads(way.map) {
                continue; // refused
            }
            let sampler = made(&device, &queue, &PcfDescriptor { kernel, ..way });
            let host = |map| host(&PcfDescriptor { kernel, map, ..way });
            let text = sampler.wgsl_module(2) + &host(way.map);
            let module = validate(&text).unwrap();
            for (_, function) in module.functions.iter() {
                let name = function.name.as_deref().unwrap_or_default();
                assert!(name.starts_with("shadows_"), "{name}");
            }
            // The broken twin: a host that calls as for the other number of lights.
            let other = match way.map {
                MapKind::Atlas(_) => MapKind::CUBE,
                _ => MapKind::ATLAS,
            };
            let wrong = sampler.wgsl_module(2) + &host(other);
            assert!(validate(&wrong).is_err());
        }
    }
}
