//! The host's pipelines: ambient light with depth, and lit passes for any way to find shadows.

use shadows::{DepthConvention, MapKind, PcfSampler, wgpu};

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
    module(sampler, "", "")
}

/// The same, with the triangles' normals given by the host.
pub fn visibility_module_with_normals(sampler: &PcfSampler) -> String {
    module(sampler, "_flat", ", at.flat_normal")
}

fn module(sampler: &PcfSampler, suffix: &str, normal: &str) -> String {
    let name = match sampler.map() {
        MapKind::Flat => "shadows_flat_visibility",
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
    return {name}{suffix}(at.world{normal}{pixel});
}}
",
        sampler.wgsl_module(1)
    )
}

/// The pipeline of a lit pass.
pub struct LitPipeline {
    pub(super) pipeline: wgpu::RenderPipeline,
    pub(super) uses_stencil: bool,
}

/// Depth and ambient light.
pub(super) fn ambient_pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
    look: Look,
) -> wgpu::RenderPipeline {
    let module = shader(device, "ambient", &[]);
    let depth = wgpu::DepthStencilState {
        format,
        depth_write_enabled: Some(true),
        depth_compare: Some(look.depth.nearer_or_equal()),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    };
    let targets = [Some(SHADED.into())];
    pipeline(
        device,
        "host_ambient",
        &module,
        &[Some(layout)],
        (depth, look),
        (&targets, &[]),
    )
}

/// Light that is added where depth is equal.
pub(super) fn lit_pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
    look: Look,
    access: &ShadowAccess<'_>,
) -> LitPipeline {
    let module = match access.module {
        Some(receiver) => shader(
            device,
            "lit, sampled",
            &[receiver, include_str!("shaders/sampled.wgsl")],
        ),
        None => shader(device, "lit", &[include_str!("shaders/unshadowed.wgsl")]),
    };
    let depth = wgpu::DepthStencilState {
        format,
        depth_write_enabled: Some(false),
        depth_compare: Some(wgpu::CompareFunction::Equal),
        stencil: access.stencil.clone().unwrap_or_default(),
        bias: wgpu::DepthBiasState::default(),
    };
    let additive = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    let targets = [
        Some(wgpu::ColorTargetState {
            format: SHADED,
            blend: Some(wgpu::BlendState {
                color: additive,
                alpha: additive,
            }),
            write_mask: wgpu::ColorWrites::ALL,
        }),
        Some(VISIBILITY.into()),
    ];
    let mut layouts = vec![Some(layout)];
    layouts.extend(access.layout.map(Some));
    LitPipeline {
        pipeline: pipeline(
            device,
            "host_lit",
            &module,
            &layouts,
            (depth, look),
            (&targets, &[("host_smooth", f64::from(access.smooth))]),
        ),
        uses_stencil: access.stencil.is_some(),
    }
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
    device: &wgpu::Device,
    fragment: &str,
    module: &wgpu::ShaderModule,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    (depth, look): (wgpu::DepthStencilState, Look),
    (targets, constants): (&[Option<wgpu::ColorTargetState>], &[(&str, f64)]),
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(fragment),
        bind_group_layouts: layouts,
        immediate_size: 0,
    });
    let buffer = |attributes| {
        Some(wgpu::VertexBufferLayout {
            array_stride: 12,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes,
        })
    };
    let (positions, normals) = (
        wgpu::vertex_attr_array![0 => Float32x3],
        wgpu::vertex_attr_array![1 => Float32x3],
    );
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("host_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &[("host_premultiplied", f64::from(look.premultiplied))],
                ..Default::default()
            },
            buffers: &[buffer(&positions), buffer(&normals)],
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
