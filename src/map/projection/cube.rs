//! The six faces of a cube map: axes, matrices, and which casters each of them sees.

use glam::{DVec3, Mat4, Vec3, Vec4};

use crate::scene::{CasterBounds, HalfSpace};

/// A face of a cube map, in the order of its array layers. Exhaustive: there are six.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum CubeFace {
    /// +X, layer 0.
    PositiveX,
    /// -X, layer 1.
    NegativeX,
    /// +Y, layer 2.
    PositiveY,
    /// -Y, layer 3.
    NegativeY,
    /// +Z, layer 4.
    PositiveZ,
    /// -Z, layer 5.
    NegativeZ,
}

impl CubeFace {
    /// All faces in the order of their layers.
    pub const ALL: [Self; 6] = [
        Self::PositiveX,
        Self::NegativeX,
        Self::PositiveY,
        Self::NegativeY,
        Self::PositiveZ,
        Self::NegativeZ,
    ];

    /// The array layer, 0 to 5.
    pub fn layer(self) -> u32 {
        self as u32
    }

    /// This face's bit in a mask of faces.
    pub(crate) fn bit(self) -> u8 {
        1 << self as u8
    }

    /// Right, up and forward in world space, as WebGPU's cube sampling has them: `s` grows to the
    /// right, `t` down. The frame is left-handed, so triangles change their winding on the map.
    pub(crate) fn axes(self) -> [Vec3; 3] {
        match self {
            Self::PositiveX => [Vec3::NEG_Z, Vec3::Y, Vec3::X],
            Self::NegativeX => [Vec3::Z, Vec3::Y, Vec3::NEG_X],
            Self::PositiveY => [Vec3::X, Vec3::NEG_Z, Vec3::Y],
            Self::NegativeY => [Vec3::X, Vec3::Z, Vec3::NEG_Y],
            Self::PositiveZ => [Vec3::X, Vec3::Y, Vec3::Z],
            Self::NegativeZ => [Vec3::NEG_X, Vec3::Y, Vec3::NEG_Z],
        }
    }

    /// Clip space from positions relative to the light: 90 degrees, infinite reverse-Z.
    ///
    /// All entries but `near` are 0 or ±1, so the product is a permutation and rounds nothing:
    /// clip w is the distance along the major axis, and depth is `near / w`.
    pub(crate) fn clip_from_light(self, near: f32) -> Mat4 {
        let [right, up, forward] = self.axes();
        Mat4::from_cols(
            right.extend(0.0),
            up.extend(0.0),
            Vec4::new(0.0, 0.0, 0.0, near),
            forward.extend(0.0),
        )
        .transpose()
    }
}

/// A mask of all six faces.
pub(crate) const ALL_FACES: u8 = 0b11_1111;

/// A mask of the faces whose frusta a caster may touch, given relative to the light: 0 if it lies
/// beyond the range.
pub(crate) fn touched_faces(caster: &CasterBounds, range: f64) -> u8 {
    let gap = (caster.centre.abs() - caster.half).max(DVec3::ZERO);
    if gap.length_squared() > range * range || caster.centre.length() - caster.radius > range {
        return 0;
    }
    CubeFace::ALL
        .into_iter()
        .filter(|face| touches(caster, *face))
        .fold(0, |mask, face| mask | face.bit())
}

/// Whether any point may satisfy `|right| <= forward` and `|up| <= forward`.
fn touches(caster: &CasterBounds, face: CubeFace) -> bool {
    let [right, up, forward] = face.axes().map(|axis| axis.as_dvec3());
    let sides = [forward - right, forward + right, forward - up, forward + up];
    sides.into_iter().all(|normal| {
        let side = HalfSpace {
            normal,
            length: std::f64::consts::SQRT_2,
            offset: 0.0,
        };
        side.touches(caster)
    })
}

/// Whether the light, and what lies before the near planes of its faces, is surely outside a caster
/// given relative to the light.
pub(crate) fn clear_of_near(caster: &CasterBounds, near: f64) -> bool {
    let gap = caster.centre.abs() - caster.half;
    gap.max_element() > near * (1.0 + 1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frames_are_those_of_cube_sampling() {
        // The table of the WebGPU (and Vulkan, and OpenGL) specification: sc, tc and the major
        // axis of a direction, face by face.
        let direction = Vec3::new(0.3, -0.2, 0.1);
        let expected = [
            (-direction.z, -direction.y),
            (direction.z, -direction.y),
            (direction.x, direction.z),
            (direction.x, -direction.z),
            (direction.x, -direction.y),
            (-direction.x, -direction.y),
        ];
        for (face, (sc, tc)) in CubeFace::ALL.into_iter().zip(expected) {
            let [_, _, forward] = face.axes();
            let clip = face.clip_from_light(0.5) * (direction + forward * 2.0).extend(1.0);
            assert_eq!((clip.x, -clip.y), (sc, tc), "{face:?}");
            assert_eq!(clip.z, 0.5);
            assert!((clip.w - (2.0 + direction.dot(forward))).abs() < 1e-6);
        }
    }

    #[test]
    fn culling_keeps_every_face_a_point_of_the_box_falls_on() {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 23) - 1.0
        };
        let mut culled = 0;
        for _ in 0..2000 {
            let centre = DVec3::new(random(), random(), random()) * 3.0;
            let half = DVec3::new(random(), random(), random()).abs();
            let bounds = CasterBounds {
                centre,
                half,
                radius: half.length(),
            };
            let mask = touched_faces(&bounds, 100.0);
            culled += 6 - mask.count_ones();
            for _ in 0..20 {
                let point = centre + half * DVec3::new(random(), random(), random());
                let face = CubeFace::ALL
                    .into_iter()
                    .max_by(|a, b| {
                        let along = |f: &CubeFace| f.axes()[2].as_dvec3().dot(point);
                        along(a).total_cmp(&along(b))
                    })
                    .unwrap();
                assert!(mask & face.bit() != 0, "{point} on {face:?}, {bounds:?}");
            }
        }
        assert!(culled > 2000, "culls next to nothing: {culled}");
    }

    #[test]
    fn bounds_that_reach_the_near_cube_are_not_clear_of_it() {
        let at = |x: f64| CasterBounds {
            centre: DVec3::new(x, 0.0, 0.0),
            half: DVec3::ONE,
            radius: 1.8,
        };
        assert!(clear_of_near(&at(1.2), 0.1));
        assert!(!clear_of_near(&at(1.05), 0.1));
        assert!(!clear_of_near(&at(0.0), 0.1));
    }

    #[test]
    fn what_lies_beyond_the_range_touches_no_face() {
        let bounds = CasterBounds {
            centre: DVec3::new(5.0, 5.0, 5.0),
            half: DVec3::ONE,
            radius: 1.8,
        };
        assert_eq!(touched_faces(&bounds, 6.8), 0);
        assert_ne!(touched_faces(&bounds, 7.0), 0);
    }
}
