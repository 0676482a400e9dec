//! Where resolution is no excuse for the errors of a map.

use shadows::reference::Interior;
use shadows::{CubeShadowMap, Kernel, Radius, ShadowMap};

/// Of a cube map that is read through a kernel.
pub fn of_cube(map: &CubeShadowMap, kernel: Kernel) -> Interior {
    Interior::Map {
        face_size: map.size(),
        kernel_radius: radius_in_texels(kernel),
    }
}

/// Of a flat map as it was last prepared.
pub fn of_flat(map: &ShadowMap, kernel: Kernel) -> Interior {
    match map.clip_from_world() {
        Some(clip_from_world) => Interior::FlatMap {
            clip_from_world,
            size: map.size(),
            kernel_radius: radius_in_texels(kernel),
        },
        // Nothing casts.
        None => Interior::Screen,
    }
}

/// How many texels a kernel reaches, at most: disks are measured on the surface, where texels are
/// up to `sqrt(3)` smaller than straight ahead, and reach to the centre of the texel they hit.
pub fn radius_in_texels(kernel: Kernel) -> f32 {
    match kernel.radius() {
        Radius::Texels(radius) if kernel.uses_pixel() => radius * 3.0_f32.sqrt() + 0.5,
        Radius::Texels(radius) => radius,
        _ => f32::INFINITY, // no pixel is safely interior
    }
}
