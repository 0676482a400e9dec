//! On which side of a triangle the light lies, as `volume_light_side.wgsl` decides it.

use glam::{DVec3, Vec3, Vec4, Vec4Swizzles as _};

/// sign(det(b - a, c - a, light - w a)), as in the shader, which says where the bound of its rounding
/// comes from; where that could have changed the sign, the same once more in f64.
///
/// The shader, which has no f64, answers 0 there, as if the triangle were seen edge-on. So may a GPU
/// that fuses a product and a sum into one rounding. These are two different volumes, both closed,
/// and with one picture unless the light is at the very skin of the triangle.
pub(crate) fn light_side(a: Vec3, b: Vec3, c: Vec3, light: Vec4, rest: Vec3) -> i8 {
    match clear_side(a, b, c, light, rest) {
        0 => exact_side([a, b, c].map(Vec3::as_dvec3), light, rest),
        side => side,
    }
}

/// In f64, and 0 where even that could round to another sign. Numbers of f32 neither over- nor
/// underflow in products of three.
#[cold]
fn exact_side([a, b, c]: [DVec3; 3], light: Vec4, rest: Vec3) -> i8 {
    let (u, v) = (b - a, c - a);
    let light = light.as_dvec4();
    let rest = rest.as_dvec3();
    let toward = light.xyz() - light.w * a;
    let r = toward + rest;
    let p = DVec3::new(u.y * v.z, u.z * v.x, u.x * v.y);
    let q = DVec3::new(u.z * v.y, u.x * v.z, u.y * v.x);
    let det = (p - q).dot(r);
    let bound = (p.abs() + q.abs()).dot(toward.abs() + rest.abs()) * (5.0 * f64::EPSILON);
    i8::from(det > bound) - i8::from(det < -bound)
}

/// The same without scaling: 0 unless the sign is beyond doubt.
///
/// Scaling by powers of two changes nothing but the exponents while nothing over- or underflows.
/// What overflows compares false; what underflows below 2^-149, times a light nearer than 2^40, is
/// far below a bound that exceeds 2^-90. Twice the bound makes up for it.
#[inline]
fn clear_side(a: Vec3, b: Vec3, c: Vec3, light: Vec4, rest: Vec3) -> i8 {
    const SMALLEST: f32 = f32::from_bits((127 - 90) << 23);
    const FARTHEST: f32 = f32::from_bits((127 + 40) << 23);
    let (u, v) = (b - a, c - a);
    let toward = light.xyz() - light.w * a;
    let r_bound = toward.abs() + rest.abs();
    let p = yzx(u) * zxy(v);
    let q = zxy(u) * yzx(v);
    let det = sum((p - q) * (toward + rest));
    let bound = sum((p.abs() + q.abs()) * r_bound) * (20.0 / 16_777_216.0);
    let clear = (bound > SMALLEST) & (sum(r_bound) < FARTHEST) & (det.abs() > bound);
    i8::from(clear & (det > 0.0)) - i8::from(clear & (det < 0.0))
}

fn sum(v: Vec3) -> f32 {
    (v.x + v.y) + v.z
}

fn yzx(v: Vec3) -> Vec3 {
    Vec3::new(v.y, v.z, v.x)
}

fn zxy(v: Vec3) -> Vec3 {
    Vec3::new(v.z, v.x, v.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn side(a: [f32; 3], b: [f32; 3], c: [f32; 3], light: [f32; 4]) -> i8 {
        light_side(a.into(), b.into(), c.into(), light.into(), Vec3::ZERO)
    }

    #[test]
    fn the_shortcut_says_nothing_else() {
        // Every exponent, and triangles that are seen more and more nearly edge-on.
        let mut clear = 0;
        for exponent in -60..60 {
            let size = (exponent as f32).exp2();
            for step in 0..60 {
                let height = size * (-(step as f32) * 0.5).exp2();
                for light in [
                    [0.3 * size, 0.2 * size, height, 1.0],
                    [0.3, 0.7, -height, 0.0],
                ] {
                    let a = Vec3::splat(0.1 * size);
                    let (b, c) = (a + Vec3::new(size, 0.0, 0.1 * size), a + size * Vec3::Y);
                    let rest = Vec3::splat(height * 1e-9);
                    let short = clear_side(a, b, c, light.into(), rest);
                    let corners = [a, b, c].map(Vec3::as_dvec3);
                    let whole = exact_side(corners, light.into(), rest);
                    assert!(short == 0 || short == whole, "{size} {height}");
                    clear += i32::from(short != 0);
                }
            }
        }
        assert!(clear > 1000, "{clear}");
    }

    #[test]
    fn a_light_at_the_skin_has_a_side() {
        // Tilted, so that every product rounds; the light a billionth of its size above its middle.
        let [a, b, c] = [[0.3, 0.9, -0.4], [-0.7, 0.1, 0.6], [0.5, -0.8, 0.2]].map(Vec3::from);
        let normal = (b - a).cross(c - a).normalize().as_dvec3();
        let middle = (a.as_dvec3() + b.as_dvec3() + c.as_dvec3()) / 3.0;
        for (height, side) in [(1e-9, 1), (-1e-9, -1), (1e-3, 1)] {
            let light = middle + normal * height;
            let rounded = light.as_vec3();
            let rest = (light - rounded.as_dvec3()).as_vec3();
            let found = |rest| light_side(a, b, c, rounded.extend(1.0), rest);
            assert_eq!(found(rest), side, "{height}");
            // In f32 it would have none.
            let short = clear_side(a, b, c, rounded.extend(1.0), rest);
            assert_eq!(short, if height == 1e-3 { side } else { 0 });
        }
    }

    #[test]
    fn the_side_of_the_light_has_a_sign_and_a_plane_has_none() {
        let (a, b, c) = ([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        for scale in [1e-30_f32, 1.0, 1e30] {
            let [a, b, c] = [a, b, c].map(|p| p.map(|x: f32| x * scale));
            assert_eq!(side(a, b, c, [0.3, 0.2, 0.5 * scale, 1.0]), 1);
            assert_eq!(side(a, b, c, [0.3, 0.2, -0.5 * scale, 1.0]), -1);
            assert_eq!(side(a, b, c, [5.0, 7.0, 0.0, 1.0]), 0);
            assert_eq!(side(a, c, b, [0.0, 0.0, 1.0, 0.0]), -1);
            assert_eq!(side(a, b, b, [0.3, 0.2, 0.5, 1.0]), 0);
        }
    }
}
