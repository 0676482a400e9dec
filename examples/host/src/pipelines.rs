//! The host's pipelines: ambient light with depth, and lit passes for any way to find shadows.

use shadows::{DepthConvention, MapKind, PcfSampler, wgpu};

use super::scene::leaf_mask;

/// The convention of the host's depth buffer, where nothing else is asked for.
pub const DEPTH: DepthConvention = DepthConvention::InfiniteReverse;

/// How the host draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    pub depth: DepthConvention,
    /// Samples a pixel.
    pub samples: u32,
    /// Whether the host multiplies its matrices before the positions: other last bits than the
    /// library's.
    pub premultiplied: bool,
    /// Without perspective; the scene's camera then gives no more than place and direction.
    pub orthographic: Option<Orthographic>,
    /// Of the depth-stencil buffer; `None` for the best that the device has.
    pub depth_stencil: Option<wgpu::TextureFormat>,
}

/// What an orthographic camera shows, in the world's unit of length: counted from the camera, to the
/// right, up and ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthographic {
    pub left: f32,
    pub right: f32,
    pub bottom: f32,
    pub top: f32,
    /// Below 0: behind the camera.
    pub near: f32,
    pub far: f32,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            depth: DEPTH,
            samples: 1,
            premultiplied: false,
            orthographic: None,
            depth_stencil: None,
        }
    }
}

// sRGB, so that the hardware blends light linearly.
pub const SHADED: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
pub(super) const VISIBILITY: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// How a light pass learns where there is shadow.
#[derive(Clone, Default)]
pub struct ShadowAccess<'a> {
    /// WGSL that declares `host_visibility(at: HostReceiver) -> f32` and its bindings in group 1, such
    /// as [`visibility_module`].
    pub module: Option<&'a str>,
    /// Layout of group 1.
    pub layout: Option<&'a wgpu::BindGroupLayout>,
    /// The stencil test, if that decides.
    pub stencil: Option<wgpu::StencilState>,
    /// Whether smoothed normals alone say where the light ends, not the triangles' own.
    pub smooth: bool,
}

/// A sampler's module for group 1, called as the host calls it whatever the kernel.
pub fn visibility_module(sampler: &PcfSampler) -> String {
    module(sampler, "", light(sampler), "")
}

/// The same, with the triangles' normals given by the host.
pub fn visibility_module_with_normals(sampler: &PcfSampler) -> String {
    module(sampler, "_flat", light(sampler), ", at.flat_normal")
}

/// By what a shader names the light, where it does.
fn light(sampler: &PcfSampler) -> &'static str {
    match sampler.map() {
        MapKind::Atlas(_) => "at.light, ",
        _ => "",
    }
}

fn module(sampler: &PcfSampler, suffix: &str, light: &str, normal: &str) -> String {
    let name = match sampler.map() {
        MapKind::Flat(_) => "shadows_flat_visibility",
        _ => "shadows_visibility",
    };
    let pixel = if sampler.takes_pixel() {
        ", at.pixel"
    } else {
        ""
    };
    format!(
        "{}
fn host_visibility(at: HostReceiver) -> f32 {{
    return {name}{suffix}({light}at.world{normal}{pixel});
}}
",
        sampler.wgsl_module(1)
    )
}

/// A pass's pipelines.
pub(super) struct Drawing {
    pub solid: wgpu::RenderPipeline,
    /// For meshes with a mask, where the scene has any.
    pub masked: Option<wgpu::RenderPipeline>,
}

/// The pipelines of a lit pass.
pub struct LitPipeline {
    pub(super) drawing: Drawing,
    pub(super) uses_stencil: bool,
}

/// What all of a renderer's pipelines share.
pub(super) struct Shared<'a> {
    pub device: &'a wgpu::Device,
    pub layout: &'a wgpu::BindGroupLayout,
    pub format: wgpu::TextureFormat,
    pub look: Look,
    /// Whether a mesh of the scene has a mask.
    pub masks: bool,
}

/// Depth and ambient light.
pub(super) fn ambient(shared: &Shared<'_>) -> Drawing {
    let masked = include_str!("shaders/masked.wgsl");
    let depth = wgpu::DepthStencilState {
        format: shared.format,
        depth_write_enabled: Some(true),
        depth_compare: Some(shared.look.depth.nearer_or_equal()),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    };
    let targets = [Some(SHADED.into())];
    let pipeline = |module: &wgpu::ShaderModule, entries| {
        let (layouts, pass) = ([Some(shared.layout)], (&targets[..], &[][..]));
        pipeline(shared, module, entries, &layouts, depth.clone(), pass)
    };
    Drawing {
        solid: pipeline(
            &shader(shared.device, "ambient", &[]),
            ["host_vertex", "host_ambient"],
        ),
        masked: shared.masks.then(|| {
            let parts = [&leaf_mask::wgsl()[..], masked];
            let module = shader(shared.device, "ambient, masked", &parts);
            pipeline(&module, ["host_masked_vertex", "host_masked_ambient"])
        }),
    }
}

/// The sky, drawn first.
pub(super) fn sky(shared: &Shared<'_>) -> wgpu::RenderPipeline {
    let module = shader(shared.device, "sky", &[include_str!("shaders/sky.wgsl")]);
    let depth = wgpu::DepthStencilState {
        format: shared.format,
        depth_write_enabled: Some(false),
        depth_compare: Some(wgpu::CompareFunction::Always),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    };
    let (layouts, targets) = ([Some(shared.layout)], [Some(SHADED.into())]);
    let entries = ["host_sky_vertex", "host_sky"];
    pipeline(shared, &module, entries, &layouts, depth, (&targets, &[]))
}

/// Light that is added where depth is equal.
pub(super) fn lit(shared: &Shared<'_>, access: &ShadowAccess<'_>) -> LitPipeline {
    let receiver: &[&str] = match &access.module {
        Some(receiver) => &[receiver, include_str!("shaders/sampled.wgsl")],
        None => &[include_str!("shaders/unshadowed.wgsl")],
    };
    let label = match access.module {
        Some(_) => "lit, sampled",
        None => "lit",
    };
    let depth = wgpu::DepthStencilState {
        format: shared.format,
        depth_write_enabled: Some(false),
        depth_compare: Some(wgpu::CompareFunction::Equal),
        stencil: access.stencil.clone().unwrap_or_default(),
        bias: wgpu::DepthBiasState::default(),
    };
    let targets = lit_targets();
    let mut layouts = vec![Some(shared.layout)];
    layouts.extend(access.layout.map(Some));
    let constants = [("host_smooth", f64::from(access.smooth))];
    let pipeline = |module: &wgpu::ShaderModule, entries| {
        let pass = (&targets[..], &constants[..]);
        pipeline(shared, module, entries, &layouts, depth.clone(), pass)
    };
    let solid = shader(shared.device, label, receiver);
    let masked = || {
        let mask = leaf_mask::wgsl();
        let own = [
            &mask[..],
            include_str!("shaders/masked.wgsl"),
            include_str!("shaders/masked_lit.wgsl"),
        ];
        let module = shader(shared.device, label, &[receiver, &own].concat());
        pipeline(&module, ["host_masked_vertex", "host_masked_lit"])
    };
    LitPipeline {
        drawing: Drawing {
            solid: pipeline(&solid, ["host_vertex", "host_lit"]),
            masked: shared.masks.then(masked),
        },
        uses_stencil: access.stencil.is_some(),
    }
}

/// The picture, to which light is added, and the light's visibility.
fn lit_targets() -> [Option<wgpu::ColorTargetState>; 2] {
    let additive = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    [
        Some(wgpu::ColorTargetState {
            format: SHADED,
            blend: Some(wgpu::BlendState {
                color: additive,
                alpha: additive,
            }),
            write_mask: wgpu::ColorWrites::ALL,
        }),
        Some(VISIBILITY.into()),
    ]
}

fn shader(device: &wgpu::Device, label: &str, parts: &[&str]) -> wgpu::ShaderModule {
    let shared = [shadows::wgsl::POSITION, include_str!("shaders/host.wgsl")];
    let source = [&shared[..], parts].concat().join("\n");
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(shadows::rewriting::rewritten(source.into())),
    })
}

fn pipeline(
    shared: &Shared<'_>,
    module: &wgpu::ShaderModule,
    [vertex, fragment]: [&str; 2],
    layouts: &[Option<&wgpu::BindGroupLayout>],
    depth: wgpu::DepthStencilState,
    (targets, constants): (&[Option<wgpu::ColorTargetState>], &[(&str, f64)]),
) -> wgpu::RenderPipeline {
    let (device, look) = (shared.device, shared.look);
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(fragment),
        bind_group_layouts: layouts,
        immediate_size: 0,
    });
    let [positions, normals, mask] = VERTEX_BUFFERS;
    let premultiplied = [("host_premultiplied", f64::from(look.premultiplied))];
    let (buffers, vertex_constants): (&[_], &[_]) = match vertex {
        "host_sky_vertex" => (&[], &[]),
        "host_masked_vertex" => (&[positions, normals, mask], &premultiplied),
        _ => (&[positions, normals], &premultiplied),
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: vertex_constants,
                ..Default::default()
            },
            buffers,
        },
        // Nothing is culled: meshes may be open, and the side one sees receives light too.
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(depth),
        multisample: wgpu::MultisampleState {
            count: look.samples,
            ..Default::default()
        },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants,
                ..Default::default()
            },
            targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Positions, normals, places in the mask.
pub(super) const VERTEX_BUFFERS: [Option<wgpu::VertexBufferLayout<'static>>; 3] = [
    buffer(12, &wgpu::vertex_attr_array![0 => Float32x3]),
    buffer(12, &wgpu::vertex_attr_array![1 => Float32x3]),
    buffer(8, &wgpu::vertex_attr_array![2 => Float32x2]),
];

const fn buffer(
    array_stride: u64,
    attributes: &'static [wgpu::VertexAttribute],
) -> Option<wgpu::VertexBufferLayout<'static>> {
    Some(wgpu::VertexBufferLayout {
        array_stride,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes,
    })
}
