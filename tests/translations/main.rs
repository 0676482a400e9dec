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
        .chain(shown::all())
        .collect()
}
