//! The pass over the scene's depth that reads a light map by texture coordinates of its own.

use shadows::wgpu;

use host::gpu::Gpu;
use host::renderer::Renderer;
use host::scene_gpu::SceneGpu;

const READ: &str = include_str!("baked.wgsl");

/// Of what the pass leaves at each pixel.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// Position, then place in the map.
pub type Vertex = [f32; 5];

/// The pipeline, and the layout of what it reads.
pub struct Reading {
    pub pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    linear: wgpu::Sampler,
    device: wgpu::Device,
}

impl Reading {
    /// For the renderer's depth buffer of one sample.
    pub fn new(gpu: &Gpu, renderer: &Renderer) -> Self {
        let device = &gpu.device;
        let uniform = |has_dynamic_offset| wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset,
            min_binding_size: None,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let (vertex, fragment) = (wgpu::ShaderStages::VERTEX, wgpu::ShaderStages::FRAGMENT);
        let entries = [
            (uniform(false), vertex),
            (uniform(true), vertex),
            (texture(true), fragment),
            (sampler, fragment),
        ];
        let layout = group_layout(gpu, &entries);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("baked"),
            source: wgpu::ShaderSource::Wgsl(format!("{}\n{READ}", shadows::wgsl::POSITION).into()),
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("baked"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("baked"),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("baked_vertex"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<Vertex>() as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x2],
                })],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: renderer.depth_stencil_format(),
                depth_write_enabled: Some(false),
                depth_compare: Some(wgpu::CompareFunction::Equal),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("baked_fragment"),
                compilation_options: Default::default(),
                targets: &[Some(FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let linear = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("light map"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self {
            pipeline,
            layout,
            linear,
            device: device.clone(),
        }
    }

    /// The frame's matrix, the host's objects and the map.
    pub fn bind(
        &self,
        frame: &wgpu::Buffer,
        scene: &SceneGpu,
        map: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        // An object's matrix is the first of what the host tells its shaders of it.
        let one = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &scene.object_uniforms,
            offset: 0,
            size: wgpu::BufferSize::new(64),
        });
        let resources = [
            frame.as_entire_binding(),
            one,
            wgpu::BindingResource::TextureView(map),
            wgpu::BindingResource::Sampler(&self.linear),
        ];
        bind(&self.device, &self.layout, &resources)
    }
}

/// A texture, read with a filter or texel by texel.
pub fn texture(filterable: bool) -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    }
}

/// Entries from binding 0 on.
pub fn group_layout(
    gpu: &Gpu,
    entries: &[(wgpu::BindingType, wgpu::ShaderStages)],
) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = (0..)
        .zip(entries)
        .map(|(binding, &(ty, visibility))| wgpu::BindGroupLayoutEntry {
            binding,
            visibility,
            ty,
            count: None,
        })
        .collect();
    gpu.device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("baked"),
            entries: &entries,
        })
}

/// Resources from binding 0 on.
pub fn bind(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry {
            binding,
            resource: resource.clone(),
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("baked"),
        layout,
        entries: &entries,
    })
}
