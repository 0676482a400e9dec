//! The six faces of a cube map: axes, matrices, and which casters each of them sees.

use glam::{DVec3, Mat4, Vec3, Vec4};

use crate::PointLight;
use crate::scene::CasterBounds;

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

/// A mask of the faces whose frusta a caster may touch: 0 if it lies beyond the range.
pub(crate) fn touched_faces(light: &PointLight, caster: &CasterBounds) -> u8 {
    // Made here, not handed over: what was just stored in pieces is slow to load as a whole.
    let centre = caster.centre - light.position.as_dvec3();
    let range = f64::from(light.range);
    let gap = (centre.abs() - caster.half).max(DVec3::ZERO);
    let reach = range + caster.radius;
    if gap.length_squared() > range * range || centre.length_squared() > reach * reach {
        return 0;
    }
    // The planes between faces lie diagonally between two axes, and each is a side of four faces.
    let (DVec3 { x, y, z }, half) = (centre, caster.half);
    let beside = |a: f64, b: f64, half: f64| {
        // How far bounds extend along a diagonal, times its length.
        let room = half.min(caster.radius * std::f64::consts::SQRT_2);
        let (sum, difference) = (a + b, a - b);
        let sides = [
            sum >= -room,
            sum <= room,
            difference >= -room,
            difference <= room,
        ];
        usize::from(sides[0])
            | usize::from(sides[1]) << 1
            | usize::from(sides[2]) << 2
            | usize::from(sides[3]) << 3
    };
    const BESIDE: [[u8; 16]; 3] = [
        faces_beside(CubeFace::PositiveX, CubeFace::PositiveY),
        faces_beside(CubeFace::PositiveX, CubeFace::PositiveZ),
        faces_beside(CubeFace::PositiveY, CubeFace::PositiveZ),
    ];
    BESIDE[0][beside(x, y, half.x + half.y)]
        & BESIDE[1][beside(x, z, half.x + half.z)]
        & BESIDE[2][beside(y, z, half.y + half.z)]
}

/// The faces that may be touched where some of these hold of two coordinates along the axes of two faces:
/// their sum may be 0 or more, or 0 or less (bits 0 and 1), as may their difference (bits 2 and 3).
const fn faces_beside(first: CubeFace, second: CubeFace) -> [u8; 16] {
    let (first, second) = (first as u8, second as u8);
    let mut faces = [0; 16];
    let mut holds = 0;
    while holds < 16 {
        // Forward of each face and backward (the next one), the sides that it has of the four.
        let needs = [
            (first, 0b0101),
            (first + 1, 0b1010),
            (second, 0b1001),
            (second + 1, 0b0110),
        ];
        let mut mask = ALL_FACES;
        let mut of = 0;
        while of < needs.len() {
            let (face, sides) = needs[of];
            if holds as u8 & sides != sides {
                mask &= !(1 << face);
            }
            of += 1;
        }
        faces[holds] = mask;
        holds += 1;
    }
    faces
}

/// The same for every caster within some bounds, if one face has them all to itself.
pub(crate) fn face_of_all(light: &PointLight, around: &CasterBounds) -> Option<u8> {
    let mask = touched_faces(light, around);
    let range = f64::from(light.range);
    let farthest = (around.centre - light.position.as_dvec3()).abs() + around.half;
    let all_in_range = || farthest.length_squared() <= range * range;
    (mask == 0 || mask.is_power_of_two() && all_in_range()).then_some(mask)
}

/// Whether a light, and what lies before the near planes of its faces, is surely outside a caster.
pub(crate) fn clear_of_near(light: &PointLight, caster: &CasterBounds, near: f64) -> bool {
    let gap = (caster.centre - light.position.as_dvec3()).abs() - caster.half;
    gap.max_element() > near * (1.0 + 1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::HalfSpace;

    fn light(range: f32) -> PointLight {
        PointLight::new(Vec3::ZERO, range)
    }

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
            let mask = touched_faces(&light(100.0), &bounds);
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
    fn faces_are_those_that_their_four_planes_leave() {
        let touches = |caster: &CasterBounds, face: CubeFace| {
            let [right, up, forward] = face.axes().map(|axis| axis.as_dvec3());
            let sides = [forward - right, forward + right, forward - up, forward + up];
            sides
                .into_iter()
                .all(|normal| HalfSpace::new(normal, 0.0).touches(caster))
        };
        let by_planes = |caster: &CasterBounds| {
            let touched = CubeFace::ALL
                .into_iter()
                .filter(|face| touches(caster, *face));
            touched.fold(0, |mask, face| mask | face.bit())
        };
        let mut state = 5u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 23) - 1.0
        };
        let mut turned_round = 0;
        for _ in 0..10_000 {
            let centre = DVec3::new(random(), random(), random());
            let half = DVec3::new(random(), random(), random()).abs() * 0.5;
            // A sphere as large as the box needs, or one that is tighter than the box at its corners.
            let radius = half.length() * if random() > 0.0 { 1.0 } else { 0.7 };
            let caster = CasterBounds {
                centre,
                half,
                radius,
            };
            let touched = |caster: &CasterBounds| touched_faces(&light(9.0), caster);
            assert_eq!(touched(&caster), by_planes(&caster), "{caster:?}");
            // The broken twin: seen from the other side.
            let centre = -centre;
            let twin = CasterBounds { centre, ..caster };
            turned_round += usize::from(touched(&twin) != by_planes(&caster));
        }
        assert!(turned_round > 5000, "{turned_round}");
    }

    #[test]
    fn bounds_that_reach_the_near_cube_are_not_clear_of_it() {
        let at = |x: f64| CasterBounds {
            centre: DVec3::new(x, 0.0, 0.0),
            half: DVec3::ONE,
            radius: 1.8,
        };
        assert!(clear_of_near(&light(9.0), &at(1.2), 0.1));
        assert!(!clear_of_near(&light(9.0), &at(1.05), 0.1));
        assert!(!clear_of_near(&light(9.0), &at(0.0), 0.1));
    }

    #[test]
    fn what_lies_beyond_the_range_touches_no_face() {
        let bounds = CasterBounds {
            centre: DVec3::new(5.0, 5.0, 5.0),
            half: DVec3::ONE,
            radius: 1.8,
        };
        assert_eq!(touched_faces(&light(6.8), &bounds), 0);
        assert_ne!(touched_faces(&light(7.0), &bounds), 0);
    }
}
