//! A device without a driver. What wgpu would refuse, it refuses too, with a panic.

use std::sync::OnceLock;

use shadows::wgpu;

static DEVICE: OnceLock<(wgpu::Device, wgpu::Queue)> = OnceLock::new();

/// For every depth convention and `Counter::Exact`.
const FEATURES: wgpu::Features =
    wgpu::Features::DEPTH_CLIP_CONTROL.union(wgpu::Features::FLOAT32_BLENDABLE);

/// The device that all runs share.
pub fn device() -> &'static (wgpu::Device, wgpu::Queue) {
    DEVICE.get_or_init(|| {
        // wgpu 30's check of indirect draws trips over the driverless device's limits.
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::NOOP,
            flags: wgpu::InstanceFlags::empty(),
            backend_options: wgpu::BackendOptions {
                noop: wgpu::NoopBackendOptions::enabled(),
                ..Default::default()
            },
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        pollster::block_on(async {
            let adapter = instance.request_adapter(&Default::default()).await.unwrap();
            let descriptor = wgpu::DeviceDescriptor {
                required_features: FEATURES,
                ..Default::default()
            };
            adapter.request_device(&descriptor).await.unwrap()
        })
    })
}

/// Records commands and submits them, which is when wgpu validates them.
pub fn submit(record: impl FnOnce(&mut wgpu::CommandEncoder)) {
    let (device, queue) = device();
    let mut encoder = device.create_command_encoder(&Default::default());
    record(&mut encoder);
    queue.submit([encoder.finish()]);
}

/// Lets go of what the GPU is done with.
pub fn tidy() {
    let (device, _) = device();
    let _ = device.poll(wgpu::PollType::Poll);
}
