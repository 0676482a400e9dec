//! What shaders are told of planes, lights and views.

use glam::{DVec3, DVec4, Mat4};

use crate::map::{UNIFORM_STRIDE, buffer};
use crate::planar::axes::PlaneAxes;
use crate::planar::casters::largest;
use crate::planar::light::PlaneLight;
use crate::uploads::Uploads;

/// `ShadowsPlanarUniform` in WGSL.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct PlanarUniform {
    clip_from_plane: [[f32; 4]; 3],
    slope: [f32; 4],
    shade: [f32; 4],
    place: [f32; 4],
    cone: [f32; 4],
}

impl PlanarUniform {
    pub fn new(
        clip_from_world: &Mat4,
        axes: &PlaneAxes,
        light: &PlaneLight,
        shade: [f32; 3],
    ) -> Self {
        let rows = [0, 1, 2, 3].map(|row| clip_from_world.row(row).as_dvec4());
        Self::of_rows(&rows, axes, light, shade)
    }

    /// The same for a matrix by its rows, in f64.
    pub fn of_rows(
        rows: &[DVec4; 4],
        axes: &PlaneAxes,
        light: &PlaneLight,
        shade: [f32; 3],
    ) -> Self {
        let [red, green, blue] = shade;
        let narrow = |vector: DVec3, w: f64| vector.extend(w).as_vec4().to_array();
        let (axis, cosine) = light.cone.unwrap_or((DVec3::ZERO, -1.0));
        let slope = light.slope.extend(light.inverse_height());
        let place = light.place.unwrap_or_default();
        Self {
            clip_from_plane: clip_from_plane(rows, axes),
            slope: narrow(slope, 0.0),
            shade: [red, green, blue, 1.0],
            place: narrow(place, light.inverse_range()),
            cone: narrow(axis, cosine),
        }
    }
}

/// What x, y and 1 of a point of the plane come to in clip space.
fn clip_from_plane(rows: &[DVec4; 4], axes: &PlaneAxes) -> [[f32; 4]; 3] {
    let [x, y] = axes.along;
    let columns = [x.extend(0.0), y.extend(0.0), axes.origin.extend(1.0)];
    columns.map(|column| rows.map(|row| row.dot(column) as f32))
}

/// Uniforms of one buffer, picked by dynamic offset.
#[derive(Debug)]
pub(crate) struct DynamicUniforms<T> {
    label: String,
    buffer: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    /// What they hold once the uploads are recorded.
    written: Vec<Option<T>>,
}

impl<T: bytemuck::Pod + PartialEq> DynamicUniforms<T> {
    pub fn new(device: &wgpu::Device, label: &str) -> Self {
        let label = format!("{label} uniforms");
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(&label),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: true,
                    min_binding_size: wgpu::BufferSize::new(size_of::<T>() as u64),
                },
                count: None,
            }],
        });
        let (buffer, group) = make::<T>(device, &label, &layout, 1);
        Self {
            label,
            buffer,
            layout,
            group,
            written: vec![None],
        }
    }

    /// Bytes that so many take.
    pub fn size(count: usize) -> u64 {
        (count as u64).saturating_mul(UNIFORM_STRIDE)
    }

    /// Makes room for so many; those that were written are written again.
    pub fn reserve(&mut self, device: &wgpu::Device, count: usize) {
        if count > self.written.len() {
            let most = (largest(device) / UNIFORM_STRIDE) as usize;
            let count = count.next_power_of_two().min(most.max(count));
            (self.buffer, self.group) = make::<T>(device, &self.label, &self.layout, count);
            self.written = vec![None; count];
        }
    }

    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    pub fn bytes(&self) -> u64 {
        self.buffer.size()
    }

    /// Uploads one, if it is not what it was.
    pub fn write(&mut self, uploads: &mut Uploads, index: usize, uniform: T) {
        if self.written[index].replace(uniform) != Some(uniform) {
            let offset = index as u64 * UNIFORM_STRIDE;
            uploads.write(&self.buffer, offset, bytemuck::bytes_of(&uniform));
        }
    }

    /// Takes nothing for written.
    pub fn forget(&mut self) {
        self.written.fill(None);
    }

    pub fn bind(&self, pass: &mut wgpu::RenderPass<'_>, index: usize) {
        pass.set_bind_group(0, &self.group, &[index as u32 * UNIFORM_STRIDE as u32]);
    }
}

fn make<T>(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    count: usize,
) -> (wgpu::Buffer, wgpu::BindGroup) {
    let size = count as u64 * UNIFORM_STRIDE;
    let buffer = buffer(device, label, size, wgpu::BufferUsages::UNIFORM);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &buffer,
                offset: 0,
                size: wgpu::BufferSize::new(size_of::<T>() as u64),
            }),
        }],
    });
    (buffer, group)
}

#[cfg(test)]
mod tests {
    use super::PlanarUniform;
    use crate::wgsl_layout::assert_layout;

    #[test]
    fn the_shader_has_the_same_layout() {
        assert_layout!(
            crate::wgsl::PLANAR_CASTER,
            "ShadowsPlanarUniform",
            PlanarUniform,
            clip_from_plane,
            slope,
            shade,
            place,
            cone,
        );
    }
}
