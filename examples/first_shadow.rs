//! A complete host, from device to pixels: one box, one floor, one point light, one picture.

use shadows::glam::{Affine3A, Mat4, Vec3, camera::rh};
use shadows::{mesh::Adjacency, wgpu, wgpu::util::DeviceExt as _, *};

const SIZE: u32 = 512;

const SHADER: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;

struct Vertex { @builtin(position) clip: vec4f, @location(0) world: vec3f }

@vertex
fn vertex(@location(0) world: vec3f) -> Vertex {
    return Vertex(clip_from_world * vec4f(world, 1.0), world);
}

@fragment
fn fragment(vertex: Vertex) -> @location(0) vec4f {
    let lit = shadows_visibility(vertex.world); // 1 lit, 0 in shadow
    let normal = normalize(cross(dpdx(vertex.world), dpdy(vertex.world)));
    let toward_light = normalize(shadows_light.position - vertex.world);
    return vec4f(vec3f(0.1 + 0.9 * lit * abs(dot(normal, toward_light))), 1.0);
}
";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The host's device, with the features and limits that are of use to shadows.
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let support = Support::of_adapter(&adapter);
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_features: support.features(),
        required_limits: support.limits(),
        ..Default::default()
    }))?;

    // The host's meshes: a box that stands on a floor. Both are drawn, both cast.
    let corner = |i: u32| [i & 1, i >> 1 & 1, i >> 2].map(|bit| bit as f32);
    let mut positions: Vec<[f32; 3]> = (0..8).map(corner).collect();
    let mut indices = vec![
        0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, //
        2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6,
    ];
    positions.extend([
        [-4.0, 0.0, -4.0],
        [-4.0, 0.0, 5.0],
        [5.0, 0.0, 5.0],
        [5.0, 0.0, -4.0],
    ]);
    indices.extend([8, 9, 10, 8, 10, 11]);

    // Shadows: the mesh as a caster, a map for the light, a sampler for the shader.
    let adjacency = Adjacency::new(&positions, &indices)?;
    let mesh = CasterMesh::new(&device, &positions, &adjacency)?;
    let casters = [Caster::new(mesh, Affine3A::IDENTITY)];
    let light = PointLight::new(Vec3::new(-1.3, 2.6, 2.2), 20.0);
    let mut map = CubeShadowMap::new(&device, &CubeShadowMapDescriptor::default())?;
    let sampler = PcfSampler::new(&device, &queue, &PcfDescriptor::default())?;
    let shadow_group = sampler.bind_group(&device, &map)?;

    // The host's own pipeline; group 1 is the shadows'.
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl((sampler.wgsl_module(1) + SHADER).into()),
    });
    let camera_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&camera_layout), Some(sampler.bind_group_layout())],
        immediate_size: 0,
    });
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 12,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3],
            })],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::TextureFormat::Rgba8UnormSrgb.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let init = |contents: &[u8], usage| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage,
        })
    };
    let vertices = init(bytemuck::cast_slice(&positions), wgpu::BufferUsages::VERTEX);
    let index_buffer = init(bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX);
    let camera: Mat4 = rh::proj::directx::perspective_infinite_reverse(0.7, 1.0, 0.1)
        * rh::view::look_at_mat4(Vec3::new(3.5, 4.0, 6.0), Vec3::splat(0.4), Vec3::Y);
    let camera_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &camera_layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: init(bytemuck::bytes_of(&camera), wgpu::BufferUsages::UNIFORM)
                .as_entire_binding(),
        }],
    });
    let target = |format, usage| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: SIZE,
                height: SIZE,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
            view_formats: &[],
        })
    };
    let colour = target(
        wgpu::TextureFormat::Rgba8UnormSrgb,
        wgpu::TextureUsages::COPY_SRC,
    );
    let depth = target(
        wgpu::TextureFormat::Depth32Float,
        wgpu::TextureUsages::empty(),
    );
    let readback = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(SIZE * SIZE * 4),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });

    // Every frame: decide, record the map, then the host's own pass.
    map.prepare(&device, &queue, &CubeFrame::new(light, &casters))?;
    let mut encoder = device.create_command_encoder(&Default::default());
    map.encode(&mut encoder);
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &colour.create_view(&Default::default()),
            depth_slice: None,
            resolve_target: None,
            ops: Default::default(),
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth.create_view(&Default::default()),
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.0),
                store: wgpu::StoreOp::Discard,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &camera_group, &[]);
    pass.set_bind_group(1, &shadow_group, &[]);
    pass.set_vertex_buffer(0, vertices.slice(..));
    pass.set_index_buffer(index_buffer.slice(..), wgpu::IndexFormat::Uint32);
    pass.draw_indexed(0..indices.len() as u32, 0, 0..1);
    drop(pass);

    // The picture.
    encoder.copy_texture_to_buffer(
        colour.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &readback,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(SIZE * 4),
                rows_per_image: None,
            },
        },
        colour.size(),
    );
    queue.submit([encoder.finish()]);
    readback.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;
    std::fs::create_dir_all("target")?;
    let file = std::fs::File::create("target/first_shadow.png")?;
    let mut encoder = png::Encoder::new(file, SIZE, SIZE);
    encoder.set_color(png::ColorType::Rgba);
    encoder
        .write_header()?
        .write_image_data(&readback.slice(..).get_mapped_range()?)?;
    println!("target/first_shadow.png");
    Ok(())
}
