//! A material of this application's own. Of all that is here, shadows ask for the lines with `shadows` in them.

use std::any::Any;
use std::cell::RefCell;
use std::rc::Rc;

use anyhow::Result;
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use kiss3d::camera::Camera3d;
use kiss3d::context::Context;
use kiss3d::light::LightCollection;
use kiss3d::resource::vertex_index::VERTEX_INDEX_FORMAT;
use kiss3d::resource::{
    DynamicUniformBuffer, GpuData, GpuMesh3d, Material3d, PipelineCache, RenderContext,
    RenderPhase, multisample_state,
};
use kiss3d::scene::{InstancesBuffer3d, ObjectData3d};
use shadows::wgpu;

use crate::shadow::Shadows;

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Frame {
    clip_from_world: [f32; 16],
    shown: u32,
    padding: [u32; 3],
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Object {
    pose: [f32; 16],
    scale: [f32; 4],
    color: [f32; 4],
}

/// Where an object's uniform lies.
#[derive(Default)]
struct Place(u32);

impl GpuData for Place {
    fn as_any(&self) -> &dyn Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }
}

/// Lambert's law with shadows.
pub struct Lit {
    shadows: Rc<RefCell<Shadows>>,
    /// What is shown: 0 the scene, above that the visibility of a light alone.
    shown: Rc<RefCell<u32>>,
    pipeline: PipelineCache,
    frame: wgpu::Buffer,
    frame_layout: wgpu::BindGroupLayout,
    /// With the revision of the atlas that it is for.
    frame_group: (u64, wgpu::BindGroup),
    objects: DynamicUniformBuffer<Object>,
    object_layout: wgpu::BindGroupLayout,
    object_group: wgpu::BindGroup,
}

impl Lit {
    pub fn new(shadows: Rc<RefCell<Shadows>>, shown: Rc<RefCell<u32>>) -> Result<Self> {
        let context = Context::get();
        let uniform = |dynamic| wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: dynamic,
                min_binding_size: None,
            },
            count: None,
        };
        let mut entries = vec![uniform(false)];
        entries.extend(shadows.borrow().layout_entries());
        let layout = |entries: &[_]| {
            context.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("lit"),
                entries,
            })
        };
        let (frame_layout, object_layout) = (layout(&entries), layout(&[uniform(true)]));
        let frame = context.create_buffer(&wgpu::BufferDescriptor {
            label: Some("lit frame"),
            size: size_of::<Frame>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let objects = DynamicUniformBuffer::new("lit objects");
        let source = shadows.borrow().wgsl()? + include_str!("lit.wgsl");
        let group = frame_group(&frame_layout, &frame, &shadows.borrow())?;
        let frame_group = (shadows.borrow().atlas.revision(), group);
        Ok(Self {
            pipeline: pipeline(&source, [&frame_layout, &object_layout]),
            frame_group,
            object_group: object_group(&object_layout, &objects),
            shadows,
            shown,
            frame,
            frame_layout,
            objects,
            object_layout,
        })
    }
}

/// The material's group 0: its own uniform, and the shadows'.
fn frame_group(
    layout: &wgpu::BindGroupLayout,
    frame: &wgpu::Buffer,
    shadows: &Shadows,
) -> Result<wgpu::BindGroup> {
    let mut entries = vec![wgpu::BindGroupEntry {
        binding: 0,
        resource: frame.as_entire_binding(),
    }];
    entries.extend(shadows.entries()?);
    Ok(
        Context::get().create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("lit frame"),
            layout,
            entries: &entries,
        }),
    )
}

fn object_group(
    layout: &wgpu::BindGroupLayout,
    objects: &DynamicUniformBuffer<Object>,
) -> wgpu::BindGroup {
    Context::get().create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("lit object"),
        layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: objects.buffer(),
                offset: 0,
                size: wgpu::BufferSize::new(objects.aligned_size()),
            }),
        }],
    })
}

/// For any number of samples, into kiss3d's HDR target, by its depth convention.
fn pipeline(source: &str, groups: [&wgpu::BindGroupLayout; 2]) -> PipelineCache {
    let context = Context::get();
    let module = context.create_shader_module(Some("lit"), source);
    let layout = context.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("lit"),
        bind_group_layouts: &groups.map(Some),
        immediate_size: 0,
    });
    PipelineCache::new(move |samples| {
        let vertex = |attributes| {
            Some(wgpu::VertexBufferLayout {
                array_stride: 12,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes,
            })
        };
        let instance = |array_stride, attributes| {
            Some(wgpu::VertexBufferLayout {
                array_stride,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes,
            })
        };
        Context::get().create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("lit"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &[
                    vertex(&wgpu::vertex_attr_array![0 => Float32x3]),
                    vertex(&wgpu::vertex_attr_array![1 => Float32x3]),
                    instance(12, &wgpu::vertex_attr_array![2 => Float32x3]),
                    instance(
                        36,
                        &wgpu::vertex_attr_array![3 => Float32x3, 4 => Float32x3, 5 => Float32x3],
                    ),
                ],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: Context::depth_format(),
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: multisample_state(samples),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: Default::default(),
                targets: &[Some(Context::render_format().into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    })
}

impl Material3d for Lit {
    fn create_gpu_data(&self) -> Box<dyn GpuData> {
        Box::new(Place::default())
    }

    fn begin_frame(&mut self) {
        self.objects.clear();
        let shadows = self.shadows.borrow();
        if self.frame_group.0 != shadows.atlas.revision() {
            let group = frame_group(&self.frame_layout, &self.frame, &shadows);
            self.frame_group = (
                shadows.atlas.revision(),
                group.expect("the atlas is the same"),
            );
        }
    }

    fn prepare(
        &mut self,
        pass: usize,
        pose: kiss3d::glamx::Pose3,
        scale: Vec3,
        camera: &mut dyn Camera3d,
        _: &LightCollection,
        data: &ObjectData3d,
        place: &mut dyn GpuData,
        _: u32,
        _: u32,
    ) {
        let (view, projection) = camera.view_transform_pair(pass);
        let frame = Frame {
            clip_from_world: (projection * view.to_mat4()).to_cols_array(),
            shown: *self.shown.borrow(),
            padding: [0; 3],
        };
        Context::get().write_buffer(&self.frame, 0, bytemuck::bytes_of(&frame));
        let color = data.color();
        let object = Object {
            pose: pose.to_mat4().to_cols_array(),
            scale: scale.extend(0.0).to_array(),
            color: [color.r, color.g, color.b, color.a],
        };
        if let Some(place) = place.as_any_mut().downcast_mut::<Place>() {
            place.0 = self.objects.push(&object);
        }
    }

    fn flush(&mut self) {
        if self.objects.flush() {
            self.object_group = object_group(&self.object_layout, &self.objects);
        }
    }

    fn render(
        &mut self,
        _: usize,
        _: kiss3d::glamx::Pose3,
        _: Vec3,
        _: &mut dyn Camera3d,
        _: &LightCollection,
        _: &ObjectData3d,
        mesh: &mut GpuMesh3d,
        instances: &mut InstancesBuffer3d,
        place: &mut dyn GpuData,
        render_pass: &mut wgpu::RenderPass<'_>,
        context: &RenderContext,
    ) {
        let Some(place) = place.as_any().downcast_ref::<Place>() else {
            return;
        };
        if context.phase != RenderPhase::Opaque {
            return;
        }
        mesh.coords().write().unwrap().load_to_gpu();
        mesh.normals().write().unwrap().load_to_gpu();
        mesh.faces().write().unwrap().load_to_gpu();
        instances.positions.load_to_gpu();
        instances.deformations.load_to_gpu();
        let (coords, normals) = (
            mesh.coords().read().unwrap(),
            mesh.normals().read().unwrap(),
        );
        let faces = mesh.faces().read().unwrap();
        let buffers = [
            coords.buffer(),
            normals.buffer(),
            instances.positions.buffer(),
            instances.deformations.buffer(),
        ];
        for (slot, buffer) in (0..).zip(buffers) {
            let Some(buffer) = buffer else { return };
            render_pass.set_vertex_buffer(slot, buffer.slice(..));
        }
        let Some(faces) = faces.buffer() else { return };
        render_pass.set_index_buffer(faces.slice(..), VERTEX_INDEX_FORMAT);
        render_pass.set_pipeline(&self.pipeline.get(context.sample_count));
        render_pass.set_bind_group(0, &self.frame_group.1, &[]);
        render_pass.set_bind_group(1, &self.object_group, &[place.0]);
        render_pass.draw_indexed(0..mesh.num_indices(), 0, 0..instances.len() as u32);
    }
}
