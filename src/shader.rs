//! How every shader of the library becomes a module.

use std::borrow::Cow;

/// A module from WGSL.
pub(crate) fn module<'a>(
    device: &wgpu::Device,
    label: &str,
    wgsl: impl Into<Cow<'a, str>>,
) -> wgpu::ShaderModule {
    let wgsl = wgsl.into();
    #[cfg(feature = "reference")]
    let wgsl = rewriting::rewritten(wgsl);
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(wgsl),
    })
}

/// How tests try what a driver may make of the shaders: WGSL leaves contraction, the order of sums and
/// the last bits of quotients open.
#[cfg(feature = "reference")]
pub mod rewriting {
    use std::borrow::Cow;
    use std::cell::RefCell;

    /// What becomes of a module's text.
    pub type Rewrite = Box<dyn Fn(&str) -> String>;

    thread_local! {
        static REWRITE: RefCell<Option<Rewrite>> = const { RefCell::new(None) };
    }

    /// From now on modules of this thread are made from what `rewrite` gives; `None`: as they are written.
    pub fn set(rewrite: Option<Rewrite>) {
        REWRITE.set(rewrite);
    }

    /// A module's text as it is compiled.
    pub fn rewritten(wgsl: Cow<'_, str>) -> Cow<'_, str> {
        REWRITE.with_borrow(|rewrite| match rewrite {
            Some(rewrite) => rewrite(&wgsl).into(),
            None => wgsl,
        })
    }
}
