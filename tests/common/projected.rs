//! The WGSL of projected shadows for receivers, behind a host that asks for it in a branch.
#![allow(dead_code)] // each test uses its own part

use shadows::{ProjectedShadow, ProjectedShadowDescriptor, wgpu};

const HOST: &str = "
@fragment
fn host_projected(@location(0) world: vec3f, @location(1) normal: vec3f) -> @location(0) vec4f {
    let x = dpdx(world);
    let y = dpdy(world);
    var through = vec3f(1.0);
    if world.y < normal.y {
        through = shadows_transmittance(0u, world, x, y);
        through *= shadows_transmittance_facing(1u, world, normal, x, y);
    }
    return vec4f(through, 1.0);
}
";

/// Of shadows on a device.
pub fn made(limits: wgpu::Limits) -> ProjectedShadow {
    let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor {
        required_limits: limits,
        ..Default::default()
    });
    ProjectedShadow::new(&device, &ProjectedShadowDescriptor::default()).unwrap()
}

/// By name: with a storage buffer, and with a uniform buffer for devices without those.
pub fn modules(group: u32) -> [(&'static str, String); 2] {
    let ways = [
        ("projected-storage", wgpu::Limits::defaults()),
        (
            "projected-uniform",
            wgpu::Limits::downlevel_webgl2_defaults(),
        ),
    ];
    ways.map(|(name, limits)| (name, made(limits).wgsl_module(group) + HOST))
}
