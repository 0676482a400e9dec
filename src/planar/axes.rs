//! A plane's own frame of coordinates.

use glam::{DAffine3, DMat3, DVec3, Vec3};

use crate::scene::Record;

/// Where a frame's casters are, as coarsely as the origin of a plane needs to know.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Whereabouts(Option<DVec3>);

impl Whereabouts {
    /// The middle of the casters' bounds, on a grid as wide as they are: it stays while they move a little, and so
    /// does what is counted from it.
    pub fn of(records: &[Record]) -> Self {
        let boxes = records.iter().filter(|record| record.casts());
        let corners = boxes.map(|record| {
            let (centre, half) = (record.bounds.centre, record.bounds.half);
            (centre - half, centre + half)
        });
        let all = corners.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        Self(all.map(|(min, max)| {
            let width = (max - min).max_element();
            let cell = (2.0 * width).log2().ceil().exp2();
            let centre = 0.5 * (min + max);
            match cell > 0.0 && cell.is_finite() {
                true => (centre / cell).round() * cell,
                false => centre,
            }
        }))
    }
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
        let near = whereabouts.0.unwrap_or(point);
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
