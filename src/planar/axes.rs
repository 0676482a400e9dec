//! The coordinate frame of a plane.

use glam::{DAffine3, DMat3, DVec3, Vec3};

use crate::scene::{Casters, Record};

/// Where a frame's casters are, as coarsely as the origin of a plane needs to know.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Whereabouts {
    /// The frame of the casters that it is of.
    frame: Option<u64>,
    middle: Option<DVec3>,
}

impl Whereabouts {
    /// Looks at the casters again, if they have changed.
    pub fn follow(&mut self, casters: &Casters) {
        let frame = Some(casters.frame());
        if self.frame != frame {
            let middle = middle(casters.records());
            *self = Self { frame, middle };
        }
    }
}

/// The middle of the casters' bounds, on a grid as wide as they are: it stays while they move a little, and so
/// does what is counted from it.
fn middle(records: &[Record]) -> Option<DVec3> {
    let boxes = records.iter().filter(|record| record.casts());
    let corners = boxes.map(|record| {
        let (centre, half) = (record.bounds.centre, record.bounds.half);
        (centre - half, centre + half)
    });
    let (min, max) = corners.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
    let width = (max - min).max_element();
    let cell = (2.0 * width).log2().ceil().exp2();
    let centre = 0.5 * (min + max);
    Some(match cell > 0.0 && cell.is_finite() {
        true => (centre / cell).round() * cell,
        false => centre,
    })
}

/// Two unit vectors along a plane, its unit normal, and the point of it that positions are counted from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlaneAxes {
    pub along: [DVec3; 2],
    pub normal: DVec3,
    pub origin: DVec3,
}

impl PlaneAxes {
    /// `normal`: finite and not 0.
    pub fn new(point: Vec3, normal: Vec3, whereabouts: Whereabouts) -> Self {
        Self::of(point.as_dvec3(), normal.as_dvec3(), whereabouts)
    }

    /// The same in f64.
    pub fn of(point: DVec3, normal: DVec3, whereabouts: Whereabouts) -> Self {
        let normal = normal.normalize();
        let (x, y) = normal.any_orthonormal_pair();
        let near = whereabouts.middle.unwrap_or(point);
        Self {
            along: [x, y],
            normal,
            origin: near - normal.dot(near - point) * normal,
        }
    }

    /// From world space to x and y along the plane and z above it.
    pub fn plane_from_world(&self) -> DAffine3 {
        let [x, y] = self.along;
        let turned = DMat3::from_cols(x, y, self.normal).transpose();
        DAffine3::from_mat3_translation(turned, -(turned * self.origin))
    }

    /// From world space, without the products of large numbers that a translation would take.
    pub fn place(&self, world: DVec3) -> DVec3 {
        let from_origin = world - self.origin;
        let [x, y] = self.along;
        DVec3::new(
            x.dot(from_origin),
            y.dot(from_origin),
            self.normal.dot(from_origin),
        )
    }

    /// A direction of world space.
    pub fn direction(&self, world: DVec3) -> DVec3 {
        let [x, y] = self.along;
        DVec3::new(x.dot(world), y.dot(world), self.normal.dot(world))
    }
}

#[cfg(test)]
mod tests {
    use super::Whereabouts;
    use crate::mesh::{Adjacency, Caster, CasterMesh};
    use crate::scene::Casters;
    use glam::{Affine3A, DVec3, Vec3};

    #[test]
    fn casters_are_looked_at_again_when_they_have_changed() {
        let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
        let adjacency = Adjacency::new(&corners, &[0, 1, 2]).unwrap();
        let mesh = CasterMesh::new(&device, &corners, &adjacency).unwrap();
        let at = |x: f32| {
            let place = Affine3A::from_translation(Vec3::X * x);
            Caster::new(mesh.clone(), place)
        };
        let (mut casters, mut whereabouts) = (Casters::default(), Whereabouts::default());
        let mut middle = |all: &[Caster]| {
            casters.compare(all, &device).unwrap();
            casters.update(all);
            whereabouts.follow(&casters);
            whereabouts.middle
        };
        // On a grid of 4, as they are 2 wide.
        assert_eq!(middle(&[]), None);
        assert_eq!(middle(&[at(8.0)]), Some(DVec3::X * 8.0));
        assert_eq!(middle(&[at(9.0)]), Some(DVec3::X * 8.0));
        assert_eq!(middle(&[at(16.0)]), Some(DVec3::X * 16.0));
        assert_eq!(middle(&[]), None);
    }
}
