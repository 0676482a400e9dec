//! Every WGSL module is what each compiler takes that may get it: the library's in every configuration, and
//! those of examples and pages.

mod back_ends;
mod installed;
#[path = "../common/modules.rs"]
mod modules;
#[path = "../common/pcf.rs"]
mod pcf;
#[path = "../common/projected.rs"]
mod projected;
mod shown;
mod tint;

use modules::{JOINED, joined};
use pcf::{given_host, host, samplers, textbooks};

pub struct Module {
    pub name: String,
    pub wgsl: String,
}

impl Module {
    fn new(name: impl Into<String>, wgsl: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            wgsl: wgsl.into(),
        }
    }
}

/// What a host's shader asks of blob shadows, as it stands there.
fn blobs() -> Module {
    let (device, _) = shadows::wgpu::Device::noop(&Default::default());
    let descriptor = shadows::BlobShadowDescriptor {
        lights: 3,
        strips: 9,
        ..Default::default()
    };
    let blobs = shadows::BlobShadow::new(&device, &descriptor).unwrap();
    let host = "
@fragment
fn host(@location(0) world: vec3f, @location(1) @interpolate(flat) own: u32) -> @location(0) vec4f {
    let all = shadows_blob_visibility(1u, world);
    return vec4f(all, shadows_blob_visibility_of(2u, world, own), 0.0, 1.0);
}
";
    Module::new("receiver-blobs", blobs.wgsl_module(1) + host)
}

/// All of them.
fn all() -> Vec<Module> {
    let joined = JOINED
        .iter()
        .map(|files| Module::new(files.join("+"), joined(files)));
    // Group 1, as nearly every host has a group of its own before it.
    let receivers = samplers().into_iter().chain(textbooks());
    let receivers = receivers.enumerate().map(|(place, (descriptor, sampler))| {
        let kernel = descriptor.kernel.function();
        let text = sampler.wgsl_module(1) + &host(&descriptor) + &given_host(&descriptor);
        Module::new(format!("receiver-{place}-{kernel}"), text)
    });
    let projected = projected::modules(1).map(|(name, text)| Module::new(name, text));
    joined
        .chain(receivers)
        .chain(projected)
        .chain([blobs()])
        .chain(shown::all())
        .collect()
}
