//! Between which depths a picture shows anything, read from the host's own depth buffer, as a host does that
//! tells it to the cascades of a directional light (Lauritzen et al., "Sample Distribution Shadow Maps", 2010).

use shadows::glam::{DMat4, DVec4};
use shadows::{DepthBounds, View, wgpu};

use super::gpu::Gpu;

/// What pixel centres may miss of the surfaces, and the depth format rounds off: a part of the depth.
const SPARE: f64 = 0.01;

/// The least and the greatest depth of what was drawn, with a little to spare; `None` where nothing was, or
/// where the device cannot read the buffer: of several samples, or without compute shaders.
pub fn depth_bounds(gpu: &Gpu, depth: &wgpu::Texture, view: &View) -> Option<DepthBounds> {
    let reads = depth.usage().contains(wgpu::TextureUsages::TEXTURE_BINDING);
    let computes = gpu.device.limits().max_compute_workgroups_per_dimension > 0;
    if !(reads && computes) {
        return None;
    }
    // Without what was cleared.
    let [least, greatest] = extremes(gpu, depth, view.depth().clear_depth());
    if least > greatest {
        return None;
    }
    let ends = [least, greatest].map(|stored| distance(view, stored.into()));
    Some(DepthBounds {
        nearest: (ends[0].min(ends[1]) * (1.0 - SPARE)) as f32,
        farthest: (ends[0].max(ends[1]) * (1.0 + SPARE)) as f32,
    })
}

/// How far along the axis a stored depth is: from the eye, or from the near plane of an orthographic view.
fn distance(view: &View, stored: f64) -> f64 {
    let entries = view.clip_from_world().to_cols_array().map(f64::from);
    let matrix = DMat4::from_cols_array(&entries);
    let at = |stored: f64| matrix.inverse() * DVec4::new(0.0, 0.0, stored, 1.0);
    match view.eye().w == 0.0 {
        true => {
            let near = 1.0 - f64::from(view.depth().clear_depth());
            (at(stored) - at(near)).truncate().length()
        }
        // The projections of the host have a unit vector in their last row.
        false => 1.0 / at(stored).w,
    }
}

/// The least and the greatest of a depth buffer's texels, but for those that were cleared.
fn extremes(gpu: &Gpu, depth: &wgpu::Texture, cleared: f32) -> [f32; 2] {
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("depth bounds"),
        source: wgpu::ShaderSource::Wgsl(include_str!("shaders/depth_bounds.wgsl").into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("depth bounds"),
        layout: None,
        module: &module,
        entry_point: Some("host_depth_bounds"),
        compilation_options: wgpu::PipelineCompilationOptions {
            constants: &[("host_cleared", cleared.into())],
            ..Default::default()
        },
        cache: None,
    });
    let found = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("depth bounds"),
        size: size_of::<[u32; 2]>() as u64,
        usage: wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_DST
            | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let none = [f32::MAX.to_bits(), 0];
    gpu.queue
        .write_buffer(&found, 0, bytemuck::cast_slice(&none));
    let view = depth.create_view(&wgpu::TextureViewDescriptor {
        aspect: wgpu::TextureAspect::DepthOnly,
        ..Default::default()
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("depth bounds"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: found.as_entire_binding(),
            },
        ],
    });
    gpu.run(|encoder| {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(depth.width().div_ceil(8), depth.height().div_ceil(8), 1);
    });
    let bytes = gpu.read_buffer(&found);
    let bits: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes);
    [bits[0], bits[1]].map(f32::from_bits)
}
