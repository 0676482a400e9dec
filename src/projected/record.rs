//! What receivers are told of each shadow.

use crate::map::{FlatFrame, Place, buffer};
use crate::support::has_storage;
use crate::uploads::Uploads;

/// What a uniform buffer of shadows holds on devices without storage buffers: within what WebGL 2 binds of
/// one.
pub(super) const UNIFORM_RECORDS: usize = 128;

/// `ShadowsProjected` in WGSL.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct ProjectedRecord {
    position: [f32; 3],
    kind: u32,
    forward: [f32; 3],
    near: f32,
    right: [f32; 3],
    texels: f32,
    down: [f32; 3],
    scale: f32,
    corner: [f32; 2],
    step: f32,
    levels: f32,
    layer: i32,
    padding: [u32; 3],
}

impl ProjectedRecord {
    const PERSPECTIVE: u32 = 1;
    const PARALLEL: u32 = 2;

    /// No shadow: all is lit. What a new buffer holds.
    pub const LIT: Self = Self {
        position: [0.0; 3],
        kind: 0,
        forward: [0.0; 3],
        near: 0.0,
        right: [0.0; 3],
        texels: 0.0,
        down: [0.0; 3],
        scale: 0.0,
        corner: [0.0; 2],
        step: 0.0,
        levels: 0.0,
        layer: 0,
        padding: [0; 3],
    };

    /// A tile in a layer of so many texels along a side.
    pub fn new(frame: &FlatFrame, place: Place, layer_size: u32) -> Self {
        // Powers of two: no rounding.
        let step = 1.0 / layer_size as f32;
        Self {
            position: frame.origin.to_array(),
            kind: match frame.perspective {
                true => Self::PERSPECTIVE,
                false => Self::PARALLEL,
            },
            forward: frame.forward.to_array(),
            near: frame.near,
            right: frame.right.to_array(),
            texels: place.size as f32,
            down: (-frame.up).to_array(),
            scale: frame.scale * 0.5 * place.size as f32,
            corner: [place.x as f32 * step, place.y as f32 * step],
            step,
            levels: place.size.ilog2() as f32,
            layer: place.layer as i32,
            padding: [0; 3],
        }
    }
}

/// Shadows of which shaders of a device can be told.
pub(super) fn most_records(device: &wgpu::Device) -> usize {
    let limits = device.limits();
    let bound = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size);
    match has_storage(device) {
        true => (bound / size_of::<ProjectedRecord>() as u64).min(u64::from(u32::MAX)) as usize,
        false => UNIFORM_RECORDS,
    }
}

/// The records of all shadows, by their place in the frame.
#[derive(Debug)]
pub(super) struct Records {
    buffer: wgpu::Buffer,
    /// What it holds once the uploads are recorded.
    written: Vec<Option<ProjectedRecord>>,
}

impl Records {
    pub fn new(device: &wgpu::Device, label: &str, count: usize) -> Self {
        let storage = has_storage(device);
        let most = most_records(device);
        let count = match storage {
            true => count.max(1).next_power_of_two().min(most),
            false => UNIFORM_RECORDS,
        };
        let usage = match storage {
            true => wgpu::BufferUsages::STORAGE,
            false => wgpu::BufferUsages::UNIFORM,
        };
        let size = (count * size_of::<ProjectedRecord>()) as u64;
        Self {
            buffer: buffer(device, &format!("{label} records"), size, usage),
            written: vec![Some(ProjectedRecord::LIT); count],
        }
    }

    pub fn len(&self) -> usize {
        self.written.len()
    }

    /// Uploads those that are not what they were, and what lies between them. The rest are lit.
    pub fn write(&mut self, uploads: &mut Uploads, records: &[ProjectedRecord]) {
        let wanted = |at: usize| records.get(at).copied().unwrap_or(ProjectedRecord::LIT);
        let differs = |at: &usize| self.written[*at] != Some(wanted(*at));
        let first = (0..self.written.len()).find(differs);
        let last = (0..self.written.len()).rev().find(differs);
        let (Some(first), Some(last)) = (first, last) else {
            return;
        };
        let changed: Vec<ProjectedRecord> = (first..=last).map(wanted).collect();
        for (written, record) in self.written[first..].iter_mut().zip(&changed) {
            *written = Some(*record);
        }
        let offset = (first * size_of::<ProjectedRecord>()) as u64;
        uploads.write(&self.buffer, offset, bytemuck::cast_slice(&changed));
    }

    /// Takes nothing for written.
    pub fn forget(&mut self) {
        self.written.fill(None);
    }

    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wgsl_layout::assert_layout;

    #[test]
    fn the_record_lies_in_memory_as_wgsl_has_it() {
        let text = include_str!("../../shaders/projected_receiver.wgsl");
        assert_layout!(
            text,
            "ShadowsProjected",
            ProjectedRecord,
            position,
            kind,
            forward,
            near,
            right,
            texels,
            down,
            scale,
            corner,
            step,
            levels,
            layer
        );
        assert!(UNIFORM_RECORDS * size_of::<ProjectedRecord>() <= 16_384);
    }
}
