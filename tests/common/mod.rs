//! What several tests need: a device without a driver, and WGSL under naga.
#![allow(dead_code)] // each test uses its own part

pub mod own_pass;
pub mod rays;
pub mod shapes;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use shadows::wgpu;

/// wgpu's own validation, without any driver.
pub fn noop() -> (wgpu::Device, wgpu::Queue) {
    noop_with(wgpu::Features::empty(), wgpu::Limits::defaults())
}

pub fn noop_with(
    required_features: wgpu::Features,
    required_limits: wgpu::Limits,
) -> (wgpu::Device, wgpu::Queue) {
    wgpu::Device::noop(&wgpu::DeviceDescriptor {
        required_features,
        required_limits,
        ..Default::default()
    })
}

/// Two devices of one adapter without a driver. (wgpu tells devices apart only within an instance.)
pub fn two_noop_devices() -> [(wgpu::Device, wgpu::Queue); 2] {
    pollster::block_on(async {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::NOOP,
            backend_options: wgpu::BackendOptions {
                noop: wgpu::NoopBackendOptions::enabled(),
                ..Default::default()
            },
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapter = instance.request_adapter(&Default::default()).await.unwrap();
        let first = adapter.request_device(&Default::default()).await.unwrap();
        [
            first,
            adapter.request_device(&Default::default()).await.unwrap(),
        ]
    })
}

/// Runs `work` and gives the validation error that it caused, if any.
pub fn validation_error(device: &wgpu::Device, work: impl FnOnce()) -> Option<String> {
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    work();
    pollster::block_on(scope.pop()).map(|error| error.to_string())
}

/// Parses and validates WGSL as a device without any optional capability would.
pub fn validate(wgsl: &str) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|e| e.emit_to_string(wgsl))?;
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|e| e.emit_to_string(wgsl))?;
    Ok(module)
}

/// Translates WGSL to the GLSL that wgpu's GL back end would run on OpenGL ES 3.1.
pub fn to_glsl(wgsl: &str, entry_point: &str) -> Result<String, String> {
    translate(wgsl, entry_point, 310, false)
}

/// The same in WebGL 2.
pub fn to_webgl(wgsl: &str, entry_point: &str) -> Result<String, String> {
    translate(wgsl, entry_point, 300, true)
}

fn translate(
    wgsl: &str,
    entry_point: &str,
    version: u16,
    is_webgl: bool,
) -> Result<String, String> {
    use naga::back::glsl;
    let module = validate(wgsl)?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|e| e.to_string())?;
    let mut text = String::new();
    let options = glsl::Options {
        version: glsl::Version::Embedded { version, is_webgl },
        ..Default::default()
    };
    let pipeline = glsl::PipelineOptions {
        shader_stage: naga::ShaderStage::Fragment,
        entry_point: entry_point.to_owned(),
        multiview: None,
    };
    glsl::Writer::new(
        &mut text,
        &module,
        &info,
        &options,
        &pipeline,
        naga::proc::BoundsCheckPolicies::default(),
    )
    .and_then(|mut writer| writer.write())
    .map_err(|e| e.to_string())?;
    Ok(text)
}

/// Byte offsets of a WGSL struct's members by name, and its size.
pub fn layout(module: &naga::Module, name: &str) -> (Vec<(String, u32)>, u32) {
    let (_, ty) = module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref() == Some(name))
        .unwrap_or_else(|| panic!("no struct {name}"));
    let naga::TypeInner::Struct { members, span } = &ty.inner else {
        panic!("{name} is no struct")
    };
    let offsets = members
        .iter()
        .map(|m| (m.name.clone().unwrap_or_default(), m.offset))
        .collect();
    (offsets, *span)
}
