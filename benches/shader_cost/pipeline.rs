//! WGSL to SPIR-V as wgpu-hal 30 has naga do it on a Vulkan device with robustness2, and that to a
//! pipeline.

use std::ffi::CString;

use anyhow::{Context as _, Result, anyhow};
use ash::vk;
use naga::back::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

use crate::device::{Device, Stage};

/// What is compiled.
pub struct Case {
    pub name: String,
    pub wgsl: String,
    /// Entry points, in the order of their stages.
    pub entries: Vec<&'static str>,
    /// Vertex attributes from this location on are an instance's.
    pub instanced_from: u32,
    /// Whether the fragment stage alone counts.
    pub fragment_only: bool,
    /// How often each loop of the code is gone round, in order.
    pub trips: Vec<u32>,
}

/// (group, binding, type)
type Binding = (u32, u32, vk::DescriptorType);

struct Shader {
    stage: vk::ShaderStageFlags,
    entry: CString,
    spirv: Vec<u32>,
}

/// What a pipeline needs to know of its shaders.
struct Interface {
    bindings: Vec<Binding>,
    /// Location, format, whether once an instance.
    attributes: Vec<(u32, vk::Format, bool)>,
    color: bool,
}

/// The stages of a case, as the driver compiled them.
pub fn compile(device: &Device, case: &Case) -> Result<Vec<Stage>> {
    let explain = |error: String| anyhow!("{error}");
    let module = naga::front::wgsl::parse_str(&case.wgsl)
        .map_err(|error| explain(error.emit_to_string(&case.wgsl)))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .map_err(|error| explain(error.emit_to_string(&case.wgsl)))?;
    let interface = interface(&module, case)?;
    let shaders = case
        .entries
        .iter()
        .map(|entry| shader(&module, &info, entry, &interface.bindings))
        .collect::<Result<Vec<_>>>()?;
    make(device, &shaders, &interface)
}

fn interface(module: &naga::Module, case: &Case) -> Result<Interface> {
    let mut bindings: Vec<Binding> = Vec::new();
    for (_, global) in module.global_variables.iter() {
        let Some(at) = &global.binding else { continue };
        let kind = match (global.space, &module.types[global.ty].inner) {
            (naga::AddressSpace::Uniform, _) => vk::DescriptorType::UNIFORM_BUFFER,
            (naga::AddressSpace::Storage { .. }, _) => vk::DescriptorType::STORAGE_BUFFER,
            (_, naga::TypeInner::Sampler { .. }) => vk::DescriptorType::SAMPLER,
            (_, naga::TypeInner::Image { .. }) => vk::DescriptorType::SAMPLED_IMAGE,
            other => return Err(anyhow!("a binding of {other:?}")),
        };
        bindings.push((at.group, at.binding, kind));
    }
    let points = module.entry_points.iter();
    let mut attributes = Vec::new();
    let mut color = false;
    for point in points.filter(|point| case.entries.contains(&&point.name[..])) {
        match point.stage {
            naga::ShaderStage::Vertex => vertex_inputs(module, point, case, &mut attributes),
            naga::ShaderStage::Fragment => {
                let result = point.function.result.as_ref();
                let binding = result.and_then(|result| result.binding.as_ref());
                color |= matches!(binding, Some(naga::Binding::Location { .. }));
            }
            _ => {}
        }
    }
    Ok(Interface {
        bindings,
        attributes,
        color,
    })
}

fn vertex_inputs(
    module: &naga::Module,
    point: &naga::EntryPoint,
    case: &Case,
    attributes: &mut Vec<(u32, vk::Format, bool)>,
) {
    use naga::{ScalarKind, TypeInner, VectorSize};
    let mut add = |binding: &Option<naga::Binding>, ty| {
        let Some(naga::Binding::Location { location, .. }) = *binding else {
            return;
        };
        let format = match module.types[ty].inner {
            TypeInner::Scalar(s) if s.kind == ScalarKind::Uint => vk::Format::R32_UINT,
            TypeInner::Scalar(_) => vk::Format::R32_SFLOAT,
            TypeInner::Vector {
                size: VectorSize::Tri,
                scalar,
            } if scalar.kind == ScalarKind::Uint => vk::Format::R32G32B32_UINT,
            TypeInner::Vector { size, .. } => match size {
                VectorSize::Bi => vk::Format::R32G32_SFLOAT,
                VectorSize::Tri => vk::Format::R32G32B32_SFLOAT,
                VectorSize::Quad => vk::Format::R32G32B32A32_SFLOAT,
            },
            _ => vk::Format::R32G32B32A32_SFLOAT,
        };
        attributes.push((location, format, location >= case.instanced_from));
    };
    for argument in &point.function.arguments {
        add(&argument.binding, argument.ty);
        if let TypeInner::Struct { members, .. } = &module.types[argument.ty].inner {
            for member in members {
                add(&member.binding, member.ty);
            }
        }
    }
}

fn options(bindings: &[Binding]) -> spv::Options<'static> {
    let mut options = spv::Options {
        lang_version: (1, 6),
        flags: spv::WriterFlags::LABEL_VARYINGS | spv::WriterFlags::FORCE_POINT_SIZE,
        bounds_check_policies: BoundsCheckPolicies {
            index: BoundsCheckPolicy::Restrict,
            buffer: BoundsCheckPolicy::Unchecked,
            image_load: BoundsCheckPolicy::Unchecked,
            binding_array: BoundsCheckPolicy::Unchecked,
        },
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::Native,
        force_loop_bounding: true,
        ..spv::Options::default()
    };
    for &(group, binding, _) in bindings {
        options.binding_map.insert(
            naga::ResourceBinding { group, binding },
            spv::BindingInfo {
                descriptor_set: group,
                binding,
                ..Default::default()
            },
        );
    }
    options
}

fn shader(
    module: &naga::Module,
    info: &ModuleInfo,
    entry: &str,
    bindings: &[Binding],
) -> Result<Shader> {
    let points = &module.entry_points;
    let point = points
        .iter()
        .find(|point| point.name == entry)
        .with_context(|| format!("no entry point {entry}"))?;
    let (module, info) = naga::back::pipeline_constants::process_overrides(
        module,
        info,
        Some((point.stage, entry)),
        &Default::default(),
    )?;
    let of = spv::PipelineOptions {
        shader_stage: point.stage,
        entry_point: entry.to_owned(),
    };
    Ok(Shader {
        stage: match point.stage {
            naga::ShaderStage::Vertex => vk::ShaderStageFlags::VERTEX,
            naga::ShaderStage::Fragment => vk::ShaderStageFlags::FRAGMENT,
            _ => vk::ShaderStageFlags::COMPUTE,
        },
        entry: CString::new(entry)?,
        spirv: spv::write_vec(&module, &info, &options(bindings), Some(&of))?,
    })
}

/// Makes the pipeline, asks for its stages, and forgets it.
fn make(device: &Device, shaders: &[Shader], interface: &Interface) -> Result<Vec<Stage>> {
    let raw = &device.raw;
    // SAFETY: every handle is this device's and outlives its use; the structures are filled as their
    // shaders say.
    unsafe {
        let layout = layout(raw, &interface.bindings)?;
        let mut stages = Vec::new();
        for shader in shaders {
            let module = vk::ShaderModuleCreateInfo::default().code(&shader.spirv);
            stages.push(
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(shader.stage)
                    .module(raw.create_shader_module(&module, None)?)
                    .name(&shader.entry),
            );
        }
        let pipeline = match shaders.first().map(|shader| shader.stage) {
            Some(vk::ShaderStageFlags::COMPUTE) => compute(raw, stages[0], layout)?,
            _ => graphics(raw, &stages, layout, interface)?,
        };
        let found = device.stages(pipeline);
        raw.destroy_pipeline(pipeline, None);
        for stage in stages {
            raw.destroy_shader_module(stage.module, None);
        }
        raw.destroy_pipeline_layout(layout, None);
        found
    }
}

const CAPTURE: vk::PipelineCreateFlags = vk::PipelineCreateFlags::from_raw(
    vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR.as_raw()
        | vk::PipelineCreateFlags::CAPTURE_INTERNAL_REPRESENTATIONS_KHR.as_raw(),
);

unsafe fn layout(raw: &ash::Device, bindings: &[Binding]) -> Result<vk::PipelineLayout> {
    let groups = bindings.iter().map(|b| b.0 + 1).max().unwrap_or(0);
    let mut layouts = Vec::new();
    for group in 0..groups {
        let own: Vec<_> = bindings
            .iter()
            .filter(|b| b.0 == group)
            .map(|&(_, binding, kind)| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(binding)
                    .descriptor_type(kind)
                    .descriptor_count(1)
                    .stage_flags(vk::ShaderStageFlags::ALL)
            })
            .collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&own);
        // SAFETY: the caller's.
        layouts.push(unsafe { raw.create_descriptor_set_layout(&info, None)? });
    }
    let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts);
    // SAFETY: the caller's.
    Ok(unsafe { raw.create_pipeline_layout(&info, None)? })
}

unsafe fn compute(
    raw: &ash::Device,
    stage: vk::PipelineShaderStageCreateInfo<'_>,
    layout: vk::PipelineLayout,
) -> Result<vk::Pipeline> {
    let info = vk::ComputePipelineCreateInfo::default()
        .flags(CAPTURE)
        .layout(layout)
        .stage(stage);
    // SAFETY: the caller's.
    let made = unsafe { raw.create_compute_pipelines(vk::PipelineCache::null(), &[info], None) };
    made.map(|pipelines| pipelines[0])
        .map_err(|(_, error)| anyhow!("{error}"))
}

type Buffers = (
    Vec<vk::VertexInputBindingDescription>,
    Vec<vk::VertexInputAttributeDescription>,
);

/// One buffer of vertices, one of instances, packed.
fn buffers(attributes: &[(u32, vk::Format, bool)]) -> Buffers {
    let (mut buffers, mut places) = Buffers::default();
    for (binding, rate) in [
        (0, vk::VertexInputRate::VERTEX),
        (1, vk::VertexInputRate::INSTANCE),
    ] {
        let mut offset = 0;
        for &(location, format, _) in attributes.iter().filter(|a| u32::from(a.2) == binding) {
            places.push(vk::VertexInputAttributeDescription {
                location,
                binding,
                format,
                offset,
            });
            offset += match format {
                vk::Format::R32_UINT | vk::Format::R32_SFLOAT => 4,
                vk::Format::R32G32_SFLOAT => 8,
                vk::Format::R32G32B32_SFLOAT => 12,
                _ => 16,
            };
        }
        if offset > 0 {
            buffers.push(vk::VertexInputBindingDescription {
                binding,
                stride: offset,
                input_rate: rate,
            });
        }
    }
    (buffers, places)
}

unsafe fn graphics(
    raw: &ash::Device,
    stages: &[vk::PipelineShaderStageCreateInfo<'_>],
    layout: vk::PipelineLayout,
    interface: &Interface,
) -> Result<vk::Pipeline> {
    let (buffers, attributes) = buffers(&interface.attributes);
    let input = vk::PipelineVertexInputStateCreateInfo::default()
        .vertex_binding_descriptions(&buffers)
        .vertex_attribute_descriptions(&attributes);
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
        .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport = vk::PipelineViewportStateCreateInfo::default()
        .viewport_count(1)
        .scissor_count(1);
    let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
    let multisample = vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(vk::SampleCountFlags::TYPE_1);
    let depth = vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(true)
        .depth_write_enable(true)
        .depth_compare_op(vk::CompareOp::GREATER);
    let colors = usize::from(interface.color);
    let blends = [vk::PipelineColorBlendAttachmentState::default()
        .color_write_mask(vk::ColorComponentFlags::RGBA)];
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends[..colors]);
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&[
        vk::DynamicState::VIEWPORT,
        vk::DynamicState::SCISSOR,
        vk::DynamicState::BLEND_CONSTANTS,
        vk::DynamicState::STENCIL_REFERENCE,
    ]);
    let formats = [vk::Format::R8G8B8A8_SRGB];
    let mut rendering = vk::PipelineRenderingCreateInfo::default()
        .color_attachment_formats(&formats[..colors])
        .depth_attachment_format(vk::Format::D32_SFLOAT);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .flags(CAPTURE)
        .stages(stages)
        .vertex_input_state(&input)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&multisample)
        .depth_stencil_state(&depth)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .push_next(&mut rendering);
    // SAFETY: the caller's.
    let made = unsafe { raw.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) };
    made.map(|pipelines| pipelines[0])
        .map_err(|(_, error)| anyhow!("{error}"))
}
