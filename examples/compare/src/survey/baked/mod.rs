//! A light map of all that there is, baked by rays when the light is first seen; nothing is drawn for it afterwards.
//!
//! Scenes here bring no second texture coordinates, so [`host::unwrap`] makes some. They divide vertices that the host's
//! meshes share, so the map is read in a pass over the scene's depth, by vertices of its own, and the lit pass reads
//! what that left. A host whose meshes have such coordinates reads the map in its lit pass.

mod reading;

use std::time::Instant;

use anyhow::{Context as _, Result, ensure};
use serde_json::{Value, json};
use shadows::reference::Interior;
use shadows::reference::bake::{BakeDescriptor, BakedLight, Emitter, LightMap};
use shadows::wgpu::util::DeviceExt as _;
use shadows::{Light, wgpu};

use self::reading::{FORMAT, Reading, Vertex, bind, group_layout, texture};
use super::planar::light;
use super::{Bake, SurveyShadow};
use crate::shadow::{Cost, ShadowInputs};
use host::exact;
use host::gpu::Gpu;
use host::renderer::{LitPipeline, Look, Renderer, ShadowAccess};
use host::scene::Scene;
use host::scene_gpu::SceneGpu;
use host::unwrap::Unwrapping;

const LIT: &str = "
@group(1) @binding(0) var baked: texture_2d<f32>;
fn host_visibility(at: HostReceiver) -> f32 {
    return textureLoad(baked, vec2i(at.pixel), 0).r;
}
";

/// How the map is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Baked {
    /// Along a side of the map.
    pub texels: u32,
    /// Rays a texel.
    pub samples: u32,
    /// Of the light: world units, or a directional light's tangent; 0 for hard shadows.
    pub radius: f32,
    /// Texels around each chart that take after it. Fewer than [`Unwrapping::GAP`] show what a filter then finds there.
    pub gap: u32,
}

impl Baked {
    /// With the gaps that a bilinear filter needs.
    pub fn new(texels: u32, samples: u32, radius: f32) -> Self {
        let gap = Unwrapping::GAP;
        Self {
            texels,
            samples,
            radius,
            gap,
        }
    }

    pub(super) fn settings(&self) -> Value {
        json!({
            "map_texels": self.texels,
            "rays_a_texel": self.samples,
            "light_radius": self.radius,
        })
    }

    /// Statements that bake the same.
    pub(crate) fn snippet(&self) -> String {
        let emitter = match self.radius {
            0.0 => String::new(),
            radius => format!(".with_emitter(Emitter::Sphere {{ radius: {radius:?} }})"),
        };
        format!(
            "// `layout`: of the receivers in a map of {} texels a side.\n\
             let baked = BakedLight::new(light){emitter};\n\
             let descriptor = BakeDescriptor {{\n    samples: {},\n    margin: {},\n}};\n\
             let map = scene.bake(&layout, &baked, &descriptor)?;\n",
            self.texels, self.samples, self.gap
        )
    }

    pub(super) fn make(
        self,
        gpu: &Gpu,
        renderer: &Renderer,
    ) -> Result<(Box<dyn SurveyShadow>, LitPipeline)> {
        ensure!(
            knows(renderer.look()),
            "light maps are compared with one sample a pixel and the library's own arithmetic"
        );
        let visible = gpu.target(renderer.size(), FORMAT, 1);
        let visible = visible.create_view(&Default::default());
        let layout = group_layout(gpu, &[(texture(false), wgpu::ShaderStages::FRAGMENT)]);
        let resource = wgpu::BindingResource::TextureView(&visible);
        let group = bind(&gpu.device, &layout, &[resource]);
        let access = ShadowAccess {
            module: Some(LIT),
            layout: Some(&layout),
            ..Default::default()
        };
        let lit = renderer.lit_pipeline(gpu, &access);
        let shadow = AtWork {
            of: self,
            reading: Reading::new(gpu, renderer),
            visible,
            group,
            map: None,
            pixels: renderer.size().map(u64::from).iter().product(),
        };
        Ok((Box::new(shadow), lit))
    }

    /// Places for the scene's triangles, and what the light sees of them.
    ///
    /// # Errors
    /// If the scene does not fit the map, or the light is none.
    pub fn bake(&self, scene: &Scene, light: Light) -> Result<(Unwrapping, LightMap)> {
        let unwrapping = Unwrapping::with_gap(scene, self.texels, self.gap)?;
        let emitter = match self.radius {
            0.0 => Emitter::Point,
            radius => Emitter::Sphere { radius },
        };
        let descriptor = BakeDescriptor {
            samples: self.samples,
            margin: self.gap,
        };
        let light = BakedLight::new(light).with_emitter(emitter);
        let map = exact::reference_scene(scene)?.bake(&unwrapping.layout, &light, &descriptor)?;
        Ok((unwrapping, map))
    }
}

/// Whether the pass that reads the map knows this way to draw.
pub fn knows(look: Look) -> bool {
    look.samples == 1 && !look.premultiplied
}

struct AtWork {
    of: Baked,
    reading: Reading,
    /// What the map says of each pixel.
    visible: wgpu::TextureView,
    group: wgpu::BindGroup,
    map: Option<Map>,
    pixels: u64,
}

/// A baked light.
struct Map {
    light: Light,
    frame: wgpu::Buffer,
    texture: wgpu::TextureView,
    vertices: wgpu::Buffer,
    /// Of each object the end of its vertices.
    ends: Vec<u32>,
    bake: Bake,
    bytes: u64,
}

impl SurveyShadow for AtWork {
    fn prepare(&mut self, gpu: &Gpu, inputs: &ShadowInputs) -> Result<()> {
        let light = light(inputs);
        if self.map.as_ref().is_none_or(|map| map.light != light) {
            self.map = Some(Map::new(gpu, self.of, light, &inputs.scene)?);
        }
        let map = self.map.as_ref().context("it was just made")?;
        let matrix = inputs.view.clip_from_world();
        gpu.queue
            .write_buffer(&map.frame, 0, bytemuck::bytes_of(&matrix));
        Ok(())
    }

    fn generate(&mut self, host: &Renderer, scene: &SceneGpu, encoder: &mut wgpu::CommandEncoder) {
        let Some(map) = &self.map else { return };
        let group = self.reading.bind(&map.frame, scene, &map.texture);
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
        for (object, &end) in (0..).zip(&map.ends) {
            pass.set_bind_group(0, &group, &[object * scene.object_stride]);
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
        match &self.map {
            Some(map) => Interior::LightMap {
                texel: map.bake.texel as f32,
            },
            None => Interior::Screen,
        }
    }

    fn bake(&self) -> Option<Bake> {
        self.map.as_ref().map(|map| map.bake)
    }
}

impl Map {
    fn new(gpu: &Gpu, of: Baked, light: Light, scene: &Scene) -> Result<Self> {
        let start = Instant::now();
        let (unwrapping, baked) = of.bake(scene, light)?;
        let texels = f64::from(of.texels).powi(2);
        let bake = Bake {
            seconds: start.elapsed().as_secs_f64(),
            texel: unwrapping.texel,
            filled_percent: 100.0 * unwrapping.layout.covered_texels() as f64 / texels,
        };
        let (vertices, ends) = vertices(&unwrapping);
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
        let (texture, bytes) = upload(gpu, &baked);
        Ok(Self {
            light,
            frame,
            texture,
            vertices: buffer(bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX),
            ends,
            bake,
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
