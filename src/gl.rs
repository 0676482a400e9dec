//! What wgpu's GL back end cannot do and does not say.
//!
//! It guesses a texture's kind from its layers: one layer is no array, and a multiple of six of a square
//! is a cube or an array of cubes. A view of another kind then reads 0 everywhere, without an error.
//! And it makes no texture of several samples that a shader can read.

/// Whether a device is one of that back end.
pub(crate) fn is_gl(device: &wgpu::Device) -> bool {
    device.adapter_info().backend == wgpu::Backend::Gl
}

/// The layers that a texture needs, at least so many, for the back end to take it for an array.
pub(crate) fn array_layers(device: &wgpu::Device, layers: u32) -> u32 {
    let mistaken = layers == 1 || layers.is_multiple_of(6);
    layers + u32::from(is_gl(device) && mistaken)
}
