//! The nearest and the farthest that a picture shows, as a host finds them in its depth buffer.

use shadows::glam::{DVec3, DVec4, Vec4Swizzles as _};
use shadows::{DepthBounds, View, wgpu};
use wgpu::util::DeviceExt as _;

use super::gpu::Gpu;

/// The bits of floats that are not negative are in the order of the floats.
const SHADER: &str = "
@group(0) @binding(0) var depths: texture_depth_2d;
@group(0) @binding(1) var<storage, read_write> bounds: array<atomic<u32>, 2>;

@compute @workgroup_size(8, 8)
fn bound(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(depths)) {
        return;
    }
    let depth = textureLoad(depths, id.xy, 0);
    if depth == CLEAR {
        return;
    }
    atomicMin(&bounds[0], bitcast<u32>(depth));
    atomicMax(&bounds[1], bitcast<u32>(depth));
}
";

/// Share of a depth by which it may be rounded in the buffer, and more.
const ROUNDING: f64 = 1e-3;

/// The depths between which a buffer of one sample a pixel shows anything; `None` if it shows nothing.
///
/// It waits for the GPU. A host that cannot reads the two numbers a frame or two later.
pub fn depth_bounds(
    gpu: &Gpu,
    view: &View,
    depth_stencil: &wgpu::TextureView,
) -> Option<DepthBounds> {
    let texture = depth_stencil.texture();
    let [least, greatest] = extremes(gpu, texture, view.depth().clear_depth());
    if least > greatest {
        return None;
    }
    let inverse = view.clip_from_world().as_dmat4().inverse();
    let forward = forward(view);
    let distance = |depth: f32| {
        let point = inverse * DVec4::new(0.0, 0.0, f64::from(depth), 1.0);
        forward.dot(point.xyz() / point.w - origin(view))
    };
    let [a, b] = [distance(least), distance(greatest)];
    Some(DepthBounds {
        nearest: (a.min(b) * (1.0 - ROUNDING)).max(0.0) as f32,
        farthest: (a.max(b) * (1.0 + ROUNDING)) as f32,
    })
}

/// From where depths count: the eye, or the near plane of an orthographic view.
fn origin(view: &View) -> DVec3 {
    let eye = view.eye();
    match eye.w == 0.0 {
        true => view.near_corners()[0],
        false => eye.xyz() / eye.w,
    }
}

/// Along what they do.
fn forward(view: &View) -> DVec3 {
    let middle = view.near_corners().iter().sum::<DVec3>() / 4.0;
    let matrix = view.clip_from_world().as_dmat4();
    let [z, w] = [2, 3].map(|row| matrix.row(row).xyz());
    let along = match view.eye().w == 0.0 {
        true => z,
        false => w,
    };
    // An orthographic view's depth may grow either way.
    let away = match view.eye().w == 0.0 {
        true if view.depth().clear_depth() == 0.0 => -along,
        true => along,
        false if along.dot(middle - origin(view)) < 0.0 => -along,
        false => along,
    };
    away.normalize()
}

fn extremes(gpu: &Gpu, texture: &wgpu::Texture, clear: f32) -> [f32; 2] {
    let device = &gpu.device;
    let source = SHADER.replace("CLEAR", &format!("{clear:?}"));
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("depth bounds"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("depth bounds"),
        layout: None,
        module: &module,
        entry_point: Some("bound"),
        compilation_options: Default::default(),
        cache: None,
    });
    let bounds = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("depth bounds"),
        contents: bytemuck::cast_slice(&[u32::MAX, 0]),
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
    });
    let depths = texture.create_view(&wgpu::TextureViewDescriptor {
        aspect: wgpu::TextureAspect::DepthOnly,
        ..Default::default()
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("depth bounds"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&depths),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: bounds.as_entire_binding(),
            },
        ],
    });
    gpu.run(|encoder| {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        let groups = |texels: u32| texels.div_ceil(8);
        pass.dispatch_workgroups(groups(texture.width()), groups(texture.height()), 1);
    });
    let bits: Vec<u32> = bytemuck::pod_collect_to_vec(&gpu.read_buffer(&bounds));
    match bits[0] == u32::MAX {
        true => [f32::INFINITY, 0.0],
        false => [bits[0], bits[1]].map(f32::from_bits),
    }
}
