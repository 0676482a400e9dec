//! Blobs as the host's shader reads them.

const VISIBILITY: &str = include_str!("../../shaders/blob_visibility.wgsl");
const RECEIVER: &str = include_str!("../../shaders/blob_receiver.wgsl");

/// Binding 0 is the lights, 1 the blobs.
#[derive(Debug)]
pub(super) struct Receivers {
    label: String,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
}

impl Receivers {
    pub fn new(
        device: &wgpu::Device,
        label: &str,
        lights: &wgpu::Buffer,
        blobs: &wgpu::Buffer,
    ) -> Self {
        let entry = |binding, ty, min_binding_size| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty,
                has_dynamic_offset: false,
                min_binding_size,
            },
            count: None,
        };
        let all_lights = wgpu::BufferSize::new(lights.size());
        let read = wgpu::BufferBindingType::Storage { read_only: true };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &[
                entry(0, wgpu::BufferBindingType::Uniform, all_lights),
                entry(1, read, None),
            ],
        });
        Self {
            group: group(device, label, &layout, [lights, blobs]),
            layout,
            label: label.to_owned(),
        }
    }

    /// Reads other buffers from now on.
    pub fn rebind(&mut self, device: &wgpu::Device, lights: &wgpu::Buffer, blobs: &wgpu::Buffer) {
        self.group = group(device, &self.label, &self.layout, [lights, blobs]);
    }

    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    pub fn group(&self) -> &wgpu::BindGroup {
        &self.group
    }
}

fn group(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    buffers: [&wgpu::Buffer; 2],
) -> wgpu::BindGroup {
    let entries = [0, 1].map(|binding: usize| wgpu::BindGroupEntry {
        binding: binding as u32,
        resource: buffers[binding].as_entire_binding(),
    });
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}

/// What decals and receivers share, for so many strips.
pub(super) fn visibility(strips: u32) -> String {
    VISIBILITY.replace(
        "const SHADOWS_BLOB_STRIPS: u32 = 6u;",
        &format!("const SHADOWS_BLOB_STRIPS: u32 = {strips}u;"),
    )
}

/// The module for a host's shader.
pub(super) fn source(strips: u32, lights: u32, group: u32) -> String {
    let receiver = RECEIVER
        .replace("@group(0)", &format!("@group({group})"))
        .replace(
            "array<ShadowsBlobLight, 1>",
            &format!("array<ShadowsBlobLight, {lights}>"),
        );
    visibility(strips) + &receiver
}
