//! A light map of all casters, baked by rays when the light is first seen; nothing is drawn for it afterwards.
//!
//! Scenes here bring no second texture coordinates, so [`host::unwrap`] makes some. The map is read in a pass over
//! the scene's depth, by vertices of its own; a host with such coordinates reads a texture in its lit pass instead.

use anyhow::{Context as _, Result, ensure};
use serde_json::{Value, json};
use shadows::reference::Interior;
use shadows::reference::bake::{BakeDescriptor, BakedLight, Emitter, LightMap};
use shadows::wgpu::util::DeviceExt as _;
use shadows::{DirectionalLight, Light, glam, wgpu};

use super::SurveyShadow;
use crate::shadow::{Cost, ShadowInputs};
use host::exact;
use host::gpu::Gpu;
use host::renderer::{LitPipeline, Renderer, ShadowAccess};
use host::scene_gpu::SceneGpu;
use host::unwrap::Unwrapping;

const READ: &str = include_str!("baked.wgsl");

const LIT: &str = "
@group(1) @binding(0) var baked: texture_2d<f32>;
fn host_visibility(at: HostReceiver) -> f32 {
    return textureLoad(baked, vec2i(at.pixel), 0).r;
}
";

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// How the map is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Baked {
    /// Along a side of the map.
    pub texels: u32,
    /// Rays a texel.
    pub samples: u32,
    /// Of the light: world units, or a directional light's tangent; 0 for hard shadows.
    pub radius: f32,
}

impl Baked {
    /// Everything that was chosen, by name.
    pub fn settings(&self) -> Value {
        json!({ "texels": self.texels, "samples": self.samples, "light_radius": self.radius })
    }

    /// Statements that bake the same.
    pub fn snippet(&self) -> String {
        let emitter = match self.radius {
            0.0 => String::new(),
            radius => format!(".with_emitter(Emitter::Sphere {{ radius: {radius:?} }})"),
        };
        format!(
            "let descriptor = BakeDescriptor {{\n    samples: {},\n    ..Default::default()\n}};\n\
             let map = scene.bake(&layout, &BakedLight::new(light){emitter}, &descriptor)?; // {} texels a side\n",
            self.samples, self.texels
        )
    }

    /// Makes the pass that reads the map, and the lit pass that reads what that says of each pixel.
    ///
    /// # Errors
    /// If the renderer draws in a way that the pass does not know.
    pub fn make(
        &self,
        gpu: &Gpu,
        renderer: &Renderer,
    ) -> Result<(Box<dyn SurveyShadow>, LitPipeline)> {
        let look = renderer.look();
        ensure!(
            look.samples == 1 && !look.premultiplied,
            "light maps are compared with one sample a pixel and the library's own arithmetic"
        );
        let visible = gpu.target(renderer.size(), FORMAT, 1);
        let visible = visible.create_view(&Default::default());
        let layout = group_layout(gpu, &[(texture(false), wgpu::ShaderStages::FRAGMENT)]);
        let group = bind(
            gpu,
            &layout,
            &[wgpu::BindingResource::TextureView(&visible)],
        );
        let access = ShadowAccess {
            module: Some(LIT),
            layout: Some(&layout),
            ..Default::default()
        };
        let lit = renderer.lit_pipeline(gpu, &access);
        let reading = Reading::new(gpu, renderer);
        let shadow = BakedShadow {
            settings: *self,
            reading,
            visible,
            group,
            map: None,
            pixels: u64::from(renderer.size()[0]) * u64::from(renderer.size()[1]),
        };
        Ok((Box::new(shadow), lit))
    }
}

/// A map at work.
struct BakedShadow {
    settings: Baked,
    reading: Reading,
    visible: wgpu::TextureView,
    group: wgpu::BindGroup,
    map: Option<Map>,
    pixels: u64,
}

/// The pass that reads the map.
struct Reading {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

/// A baked light.
struct Map {
    light: Light,
    frame: wgpu::Buffer,
    group: wgpu::BindGroup,
    vertices: wgpu::Buffer,
    /// Of each object the end of its vertices.
    ends: Vec<u32>,
    texel: f64,
    bytes: u64,
}

/// Position, then place in the map.
type Vertex = [f32; 5];

const STRIDE: u64 = 256;

impl SurveyShadow for BakedShadow {
    fn prepare(&mut self, gpu: &Gpu, inputs: &ShadowInputs) -> Result<()> {
        let light = light(inputs);
        if self.map.as_ref().is_none_or(|map| map.light != light) {
            self.map = Some(Map::new(gpu, &self.reading, self.settings, light, inputs)?);
        }
        let map = self.map.as_ref().context("it was just made")?;
        let matrix = inputs.view.clip_from_world();
        gpu.queue
            .write_buffer(&map.frame, 0, bytemuck::bytes_of(&matrix));
        Ok(())
    }

    fn generate(&mut self, host: &Renderer, _: &SceneGpu, encoder: &mut wgpu::CommandEncoder) {
        let Some(map) = &self.map else { return };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("baked"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.visible,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: host.depth_stencil(),
                depth_ops: None,
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.reading.pipeline);
        pass.set_vertex_buffer(0, map.vertices.slice(..));
        let mut first = 0;
        for (object, &end) in map.ends.iter().enumerate() {
            pass.set_bind_group(0, &map.group, &[(object as u64 * STRIDE) as u32]);
            pass.draw(first..end, 0..1);
            first = end;
        }
    }

    fn group(&self) -> Option<&wgpu::BindGroup> {
        Some(&self.group)
    }

    /// Of the light alone: vertices and coordinates are the host's.
    fn cost(&self) -> Cost {
        Cost {
            bytes: self.pixels + self.map.as_ref().map_or(0, |map| map.bytes),
            draws: 0,
            triangles: 0,
        }
    }

    fn interior(&self) -> Interior {
        let texel = self.map.as_ref().map_or(1.0, |map| map.texel as f32);
        Interior::LightMap { texel }
    }
}

fn light(inputs: &ShadowInputs) -> Light {
    match inputs.spot_light() {
        Some(spot) => spot.into(),
        None if inputs.light.is_directional() => {
            DirectionalLight::new(inputs.light.0.truncate()).into()
        }
        None => inputs.point_light().into(),
    }
}

impl Map {
    fn new(
        gpu: &Gpu,
        reading: &Reading,
        settings: Baked,
        light: Light,
        inputs: &ShadowInputs,
    ) -> Result<Self> {
        let scene = &*inputs.scene;
        let unwrapping = Unwrapping::new(scene, settings.texels)?;
        let emitter = match settings.radius {
            0.0 => Emitter::Point,
            radius => Emitter::Sphere { radius },
        };
        let descriptor = BakeDescriptor {
            samples: settings.samples,
            ..Default::default()
        };
        let baked = exact::reference_scene(scene)?.bake(
            &unwrapping.layout,
            &BakedLight::new(light).with_emitter(emitter),
            &descriptor,
        )?;
        let (vertices, ends) = vertices(&unwrapping);
        let mut matrices = vec![0_u8; scene.objects.len() * STRIDE as usize];
        for (slot, object) in matrices
            .chunks_exact_mut(STRIDE as usize)
            .zip(&scene.objects)
        {
            let matrix = glam::Mat4::from(object.transform);
            slot[..64].copy_from_slice(bytemuck::bytes_of(&matrix));
        }
        let buffer = |contents: &[u8], usage| {
            let descriptor = wgpu::util::BufferInitDescriptor {
                label: Some("baked"),
                contents,
                usage,
            };
            gpu.device.create_buffer_init(&descriptor)
        };
        let uniform = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let frame = buffer(&[0; 64], uniform);
        let objects = buffer(&matrices, uniform);
        let (view, bytes) = upload(gpu, &baked);
        let group = reading.bind(gpu, [&frame, &objects], &view);
        Ok(Self {
            light,
            frame,
            group,
            vertices: buffer(bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX),
            ends,
            texel: unwrapping.texel,
            bytes,
        })
    }
}

fn vertices(unwrapping: &Unwrapping) -> (Vec<Vertex>, Vec<u32>) {
    let (mut vertices, mut ends) = (Vec::new(), Vec::new());
    for object in &unwrapping.objects {
        let [x, y, left, top] = object.rectangle.scale_and_offset(unwrapping.layout.size());
        for ([a, b, c], [u, v]) in object.positions.iter().zip(&object.uvs) {
            vertices.push([*a, *b, *c, u * x + left, v * y + top]);
        }
        ends.push(vertices.len() as u32);
    }
    (vertices, ends)
}

/// The map as a texture, and its bytes.
fn upload(gpu: &Gpu, map: &LightMap) -> (wgpu::TextureView, u64) {
    let image = map.r8();
    let texture = gpu.device.create_texture_with_data(
        &gpu.queue,
        &wgpu::TextureDescriptor {
            label: Some("light map"),
            size: image.size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: image.format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        &image.bytes,
    );
    let view = texture.create_view(&Default::default());
    (view, image.bytes.len() as u64)
}

impl Reading {
    fn new(gpu: &Gpu, renderer: &Renderer) -> Self {
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
        Self { pipeline, layout }
    }

    fn bind(
        &self,
        gpu: &Gpu,
        [frame, objects]: [&wgpu::Buffer; 2],
        map: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        let linear = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("light map"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let one = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: objects,
            offset: 0,
            size: wgpu::BufferSize::new(64),
        });
        let resources = [
            frame.as_entire_binding(),
            one,
            wgpu::BindingResource::TextureView(map),
            wgpu::BindingResource::Sampler(&linear),
        ];
        bind(gpu, &self.layout, &resources)
    }
}

fn texture(filterable: bool) -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    }
}

fn group_layout(
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

fn bind(
    gpu: &Gpu,
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
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("baked"),
        layout,
        entries: &entries,
    })
}
