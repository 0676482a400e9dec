//! Where casters are relative to their light, for instanced draws.

use glam::{Affine3A, DAffine3, Mat4, Vec3, Vec3A};

use super::buffers::buffer;
use crate::uploads::Uploads;

/// The rows of a caster's map to positions relative to the light.
pub(crate) type Instance = [[f32; 4]; 3];

/// Bytes of one [`Instance`].
pub(crate) const INSTANCE_SIZE: u64 = size_of::<Instance>() as u64;

pub(crate) fn instance(light_from_object: &DAffine3) -> Instance {
    let linear = light_from_object.matrix3.transpose();
    let offset = light_from_object.translation;
    [
        linear.x_axis.extend(offset.x).as_vec4().to_array(),
        linear.y_axis.extend(offset.y).as_vec4().to_array(),
        linear.z_axis.extend(offset.z).as_vec4().to_array(),
    ]
}

/// The rows of a caster as it lies around `origin`: those of the product in f64, bit for bit but for the
/// sign of a zero. A translation
/// leaves the other columns as they are, and one difference of numbers in f32 is rounded once either way
/// (f64 has more than twice their digits: Figueroa, "When is Double Rounding Innocuous?", 1995).
pub(crate) fn instance_around(origin: Vec3, world_from_object: &Affine3A) -> Instance {
    let columns = world_from_object.matrix3;
    let offset = world_from_object.translation - Vec3A::from(origin);
    let rows = Mat4::from_cols(
        columns.x_axis.extend(0.0),
        columns.y_axis.extend(0.0),
        columns.z_axis.extend(0.0),
        offset.extend(1.0),
    )
    .transpose();
    [
        rows.x_axis.to_array(),
        rows.y_axis.to_array(),
        rows.z_axis.to_array(),
    ]
}

/// Bytes that are needed, and that a buffer of the device may have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TooLarge {
    pub size: u64,
    pub limit: u64,
}

/// The instances of all draws of a frame.
#[derive(Debug)]
pub(crate) struct Instances {
    label: String,
    buffer: wgpu::Buffer,
}

impl Instances {
    pub fn new(device: &wgpu::Device, label: &str) -> Self {
        let label = format!("{label} instances");
        Self {
            buffer: Self::make(device, &label, 1),
            label,
        }
    }

    fn make(device: &wgpu::Device, label: &str, count: u64) -> wgpu::Buffer {
        buffer(
            device,
            label,
            count * INSTANCE_SIZE,
            wgpu::BufferUsages::VERTEX,
        )
    }

    /// Makes room for so many.
    pub fn reserve(&mut self, device: &wgpu::Device, count: usize) -> Result<(), TooLarge> {
        let limit = device.limits().max_buffer_size;
        let size = count as u64 * INSTANCE_SIZE;
        if size > limit {
            return Err(TooLarge { size, limit });
        }
        if size > self.buffer.size() {
            let room = (count.next_power_of_two() as u64).min(limit / INSTANCE_SIZE);
            self.buffer = Self::make(device, &self.label, room);
        }
        Ok(())
    }

    /// Uploads so many, after [`reserve`](Self::reserve) for as many.
    pub fn write(
        &self,
        uploads: &mut Uploads,
        count: u64,
        instances: impl Iterator<Item = Instance>,
    ) {
        uploads.write_with(&self.buffer, 0, count * INSTANCE_SIZE, |room| {
            // Each is made where it waits: to gather them first would be one more way through memory.
            let (places, _) = room.into_chunks::<{ size_of::<Instance>() }>();
            for (place, instance) in places.into_iter().zip(instances) {
                place.write(bytemuck::cast(instance));
            }
        });
    }

    pub fn slice(&self, first: u64, count: u32) -> wgpu::BufferSlice<'_> {
        let first = first * INSTANCE_SIZE;
        self.buffer
            .slice(first..first + u64::from(count) * INSTANCE_SIZE)
    }

    pub fn bytes(&self) -> u64 {
        self.buffer.size()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random(state: &mut u32) -> f32 {
        *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (*state >> 8) as f32 / (1 << 23) as f32 - 1.0
    }

    #[test]
    fn rows_around_a_light_are_those_of_the_product_in_f64() {
        let mut state = 3;
        let mut sums_differ = 0;
        for case in 0..20_000 {
            let mut vector = |scale: f32| {
                let mut number = || scale * random(&mut state);
                Vec3::new(number(), number(), number())
            };
            // Near the origin and far from it, and offsets of either size.
            let far = vector(f32::exp2((case % 60) as f32 - 30.0));
            let near = f32::exp2((case / 60 % 40) as f32 - 20.0);
            let (origin, at) = (far + vector(near), far + vector(near));
            let columns = [vector(3.0), vector(1e-3), vector(100.0)];
            let map = Affine3A::from_cols(
                columns[0].into(),
                columns[1].into(),
                columns[2].into(),
                at.into(),
            );
            let linear = glam::DMat3::from_cols_array(&map.matrix3.to_cols_array().map(f64::from));
            let exact = DAffine3::from_mat3_translation(linear, at.as_dvec3());
            let product = DAffine3::from_translation(-origin.as_dvec3()) * exact;
            let bits = |rows: Instance| rows.map(|row| row.map(f32::to_bits));
            let expected = bits(instance(&product));
            assert_eq!(
                bits(instance_around(origin, &map)),
                expected,
                "{origin} {map:?}"
            );
            // The broken twin: a difference of what was rounded before.
            let moved = Affine3A::from_translation(vector(10.0)) * map;
            let by = Vec3::from(moved.translation - map.translation);
            let twin = instance_around(origin + by, &moved);
            sums_differ += usize::from(bits(twin) != expected);
        }
        assert!(sums_differ > 5000, "{sums_differ}");
    }
}
