//! Axis-aligned bounds.

use glam::{DAffine3, DVec3, Vec3};

/// An axis-aligned box, in the mesh's own space unless stated otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest x, y, z.
    pub min: Vec3,
    /// Largest x, y, z.
    pub max: Vec3,
}

impl Bounds {
    /// The smallest box around some points, or `None` if there are none.
    pub fn of_points(points: impl IntoIterator<Item = Vec3>) -> Option<Self> {
        points.into_iter().fold(None, |bounds, point| {
            Some(match bounds {
                None => Self {
                    min: point,
                    max: point,
                },
                Some(Self { min, max }) => Self {
                    min: min.min(point),
                    max: max.max(point),
                },
            })
        })
    }

    /// Radius of the smallest sphere around this box's centre that holds some points, rounded up.
    pub(crate) fn radius_of(&self, points: impl IntoIterator<Item = Vec3>) -> f32 {
        let centre = (self.min.as_dvec3() + self.max.as_dvec3()) * 0.5;
        let squared = points
            .into_iter()
            .map(|point| point.as_dvec3().distance_squared(centre))
            .fold(0.0, f64::max);
        (squared.sqrt() as f32).next_up()
    }

    /// The box around this box under an affine map, as centre and half extents in f64.
    ///
    /// Tight for the eight corners: half extents are |M| applied to the old ones.
    pub fn transformed(&self, map: &DAffine3) -> (DVec3, DVec3) {
        let centre = (self.min.as_dvec3() + self.max.as_dvec3()) * 0.5;
        let half = (self.max.as_dvec3() - self.min.as_dvec3()) * 0.5;
        let linear = map.matrix3;
        let extent = linear.x_axis.abs() * half.x
            + linear.y_axis.abs() * half.y
            + linear.z_axis.abs() * half.z;
        (map.transform_point3(centre), extent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_box_is_still_enclosed() {
        let bounds = Bounds {
            min: Vec3::new(-1.0, 0.0, 2.0),
            max: Vec3::new(3.0, 1.0, 5.0),
        };
        let map = DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7)
            * DAffine3::from_scale(DVec3::new(-2.0, 0.01, 3.0));
        let (centre, half) = bounds.transformed(&map);
        for corner in 0..8 {
            let pick = |bit: i32, axis: usize| {
                f64::from(if corner & bit == 0 {
                    bounds.min[axis]
                } else {
                    bounds.max[axis]
                })
            };
            let point = map.transform_point3(DVec3::new(pick(1, 0), pick(2, 1), pick(4, 2)));
            assert!((point - centre).abs().cmple(half + 1e-12).all());
        }
    }
}
