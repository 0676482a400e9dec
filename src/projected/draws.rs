//! Instanced draws: one for each mesh of each shadow.

use glam::{DAffine3, DVec3, DVec4, Vec3};

use super::descriptor::{ProjectedCaster, Projector};
use super::fit::casting_bounds;
use crate::map::FlatFrame;
use crate::mesh::{CasterMesh, InstanceLayout};

/// `Instance` in projected_caster.wgsl.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Instance {
    x: [f32; 4],
    y: [f32; 4],
    w: [f32; 4],
    transmittance: [f32; 4],
}

pub(super) const INSTANCE_SIZE: u64 = size_of::<Instance>() as u64;

/// All that two draws must share to use the same pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct PipelineKey {
    /// Bytes between positions.
    pub stride: u64,
    pub cull: Option<wgpu::Face>,
    /// The host's transforms, and bytes between them.
    pub places: Option<(InstanceLayout, u64)>,
}

/// One draw call: a mesh, and which rows of the instances are its.
#[derive(Clone, Debug)]
pub(super) struct Draw {
    pub mesh: CasterMesh,
    pub cull: Option<wgpu::Face>,
    pub first_instance: u64,
    pub instance_count: u32,
}

impl Draw {
    pub fn key(&self) -> PipelineKey {
        let places = self.mesh.places();
        PipelineKey {
            stride: self.mesh.layout().0,
            cull: self.cull,
            places: places.map(|places| (places.layout, places.stride)),
        }
    }

    pub fn triangles(&self) -> u64 {
        u64::from(self.mesh.triangle_count()) * u64::from(self.instance_count)
    }
}

/// What puts two casters into one draw, and then their order in it: what is drawn must not depend on the order
/// of the host's list, as every product is rounded to the texture's format.
type Member = (u64, bool, bool, [u32; 16], usize);

/// Appends the draws of one shadow's casters and their instances. Those beyond the light's range are left out.
pub(super) fn list(
    frame: &FlatFrame,
    Projector { light, casters, .. }: &Projector<'_>,
    instances: &mut Vec<Instance>,
    draws: &mut Vec<Draw>,
) {
    let casts = |caster: &ProjectedCaster| casting_bounds(light, &caster.caster).is_some();
    let drawn = casters.iter().enumerate();
    let drawn = drawn.filter(|(_, caster)| casts(caster));
    let rows = Rows::of(frame);
    let mut members: Vec<Member> = drawn
        .map(|(index, caster)| {
            let mesh = &caster.caster.mesh;
            let mirrored = caster.caster.transform().matrix3.determinant() < 0.0;
            let bits = bytemuck::cast::<Instance, [u32; 16]>(rows.instance(caster));
            (mesh.id(), mesh.is_solid(), mirrored, bits, index)
        })
        .collect();
    members.sort_unstable();
    let together = |a: &Member, b: &Member| {
        let single = casters[a.4].caster.mesh.places().is_some();
        (a.0, a.1, a.2) == (b.0, b.1, b.2) && !single
    };
    for run in members.chunk_by(together) {
        let (_, solid, mirrored, _, first) = run[0];
        draws.push(Draw {
            mesh: casters[first].caster.mesh.clone(),
            cull: solid.then(|| away_from_light(mirrored)),
            first_instance: instances.len() as u64,
            instance_count: run.len() as u32,
        });
        instances.extend(
            run.iter()
                .map(|member| bytemuck::cast::<_, Instance>(member.3)),
        );
    }
}

/// What is culled, so that of a solid mesh only what looks away from the light is drawn: once for each time that
/// light leaves it, wherever the light is. The tile's frame is left-handed: what is counter-clockwise seen
/// from the light is clockwise there, a back face.
fn away_from_light(mirrored: bool) -> wgpu::Face {
    match mirrored {
        true => wgpu::Face::Front,
        false => wgpu::Face::Back,
    }
}

/// The rows of clip space from world space, in f64.
struct Rows {
    origin: DVec3,
    x: DVec4,
    y: DVec4,
    w: DVec4,
}

impl Rows {
    fn of(frame: &FlatFrame) -> Self {
        let across = |axis: Vec3| (axis.as_dvec3() * f64::from(frame.scale)).extend(0.0);
        Self {
            origin: frame.origin.as_dvec3(),
            x: across(frame.right),
            y: across(frame.up),
            w: match frame.perspective {
                true => frame.forward.as_dvec3().extend(0.0),
                false => DVec4::W,
            },
        }
    }

    fn instance(&self, caster: &ProjectedCaster) -> Instance {
        let light_from_object =
            DAffine3::from_translation(-self.origin) * caster.caster.transform();
        let (linear, offset) = (light_from_object.matrix3, light_from_object.translation);
        let row = |row: DVec4| {
            let axis = row.truncate();
            let part = linear.transpose() * axis;
            let place = axis.dot(offset) + row.w;
            part.extend(place).as_vec4().to_array()
        };
        let [r, g, b] = caster.transmittance;
        Instance {
            x: row(self.x),
            y: row(self.y),
            w: row(self.w),
            transmittance: [r, g, b, 1.0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Affine3A;

    #[test]
    fn rows_of_an_object_are_those_of_the_frame_after_its_transform() {
        let frame = FlatFrame {
            origin: Vec3::new(1.0, 2.0, 3.0),
            right: Vec3::X,
            up: Vec3::Y,
            forward: Vec3::Z,
            scale: 0.5,
            near: 0.1,
            range: 10.0,
            perspective: true,
        };
        let transform = Affine3A::from_scale_rotation_translation(
            Vec3::new(1.0, 2.0, 0.5),
            glam::Quat::from_rotation_y(0.7),
            Vec3::new(-1.0, 0.5, 8.0),
        );
        let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let adjacency = crate::mesh::Adjacency::new(&corners, &[0, 1, 2]).unwrap();
        let mesh = CasterMesh::new(&device, &corners, &adjacency).unwrap();
        let caster = ProjectedCaster::opaque(crate::Caster::new(mesh, transform));
        let instance = Rows::of(&frame).instance(&caster);
        for corner in [[0.3, -0.2, 0.7], [5.0, 1.0, -2.0]].map(Vec3::from) {
            let expected = frame.clip_from_world() * transform.transform_point3(corner).extend(1.0);
            let row = |row: [f32; 4]| glam::Vec4::from(row).dot(corner.extend(1.0));
            let [x, y, w] = [instance.x, instance.y, instance.w].map(row);
            let off = (expected - glam::Vec4::new(x, y, expected.z, w)).abs();
            assert!(off.max_element() < 1e-5, "{off}");
        }
    }
}
