//! Which casters go on which faces of a cube map.

use std::collections::HashMap;

use glam::DAffine3;

use super::cube::{CubeFrame, CubeStatistics};
use super::face::{CubeFace, LightBounds};
use crate::mesh::CasterMesh;

/// The rows of a caster's map to positions relative to the light.
pub(super) type Instance = [[f32; 4]; 3];

/// Bytes of one [`Instance`].
pub(super) const INSTANCE_SIZE: u64 = size_of::<Instance>() as u64;

/// The casters of one mesh, face by face.
pub(super) struct Group {
    pub mesh: CasterMesh,
    pub faces: [Vec<Instance>; 6],
}

/// One walk over the casters puts each into all the faces it touches.
pub(super) fn sort_into_faces(frame: &CubeFrame<'_>) -> (Vec<Group>, CubeStatistics) {
    let mut groups: Vec<Group> = Vec::new();
    let mut group_of_mesh = HashMap::new();
    let mut statistics = CubeStatistics::default();
    let light_from_world = DAffine3::from_translation(-frame.light.position.as_dvec3());
    for caster in frame.casters {
        if caster.mesh.triangle_count() == 0 {
            continue;
        }
        let light_from_object = light_from_world * caster.transform();
        let (centre, half) = caster.mesh.bounds().transformed(&light_from_object);
        let radius = caster.mesh.radius_under(&light_from_object.matrix3);
        let bounds = LightBounds {
            centre,
            half,
            radius,
        };
        let mask = bounds.faces(f64::from(frame.light.range));
        if mask == 0 {
            statistics.casters_out_of_range += 1;
            continue;
        }
        statistics.casters_drawn += 1;
        let group = *group_of_mesh.entry(caster.mesh.key()).or_insert_with(|| {
            groups.push(Group {
                mesh: caster.mesh.clone(),
                faces: Default::default(),
            });
            groups.len() - 1
        });
        let rows = instance(&light_from_object);
        for face in CubeFace::ALL {
            if mask & face.bit() != 0 {
                groups[group].faces[face.layer() as usize].push(rows);
            }
        }
    }
    (groups, statistics)
}

fn instance(light_from_object: &DAffine3) -> Instance {
    let linear = light_from_object.matrix3.transpose();
    let offset = light_from_object.translation;
    [
        linear.x_axis.extend(offset.x).as_vec4().to_array(),
        linear.y_axis.extend(offset.y).as_vec4().to_array(),
        linear.z_axis.extend(offset.z).as_vec4().to_array(),
    ]
}
