//! On which side of a triangle the light lies, as `volume_light_side.wgsl` decides it.

use glam::{Vec3, Vec4, Vec4Swizzles as _};

/// sign(det(b - a, c - a, light - w a)), and 0 where rounding could have changed the sign; every
/// operation as in the shader, which says where the bound comes from.
///
/// A GPU may fuse a product and a sum into one rounding. Both answers then keep to the bound, but a
/// triangle within the bound of being seen edge-on may be 0 in one and have its sign in the other:
/// two different volumes, both closed, with one picture.
pub(in super::super) fn light_side(a: Vec3, b: Vec3, c: Vec3, light: Vec4, rest: Vec3) -> i8 {
    match clear_side(a, b, c, light, rest) {
        0 => scaled_side(a, b, c, light, rest),
        side => side,
    }
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

#[cold]
fn scaled_side(a: Vec3, b: Vec3, c: Vec3, light: Vec4, rest: Vec3) -> i8 {
    let (mut u, mut v) = (b - a, c - a);
    let toward = light.xyz() - light.w * a;
    let mut r = toward + rest;
    u *= exact_scale(u);
    v *= exact_scale(v);
    let scale = exact_scale(r);
    let r_bound = (toward.abs() + rest.abs()) * scale;
    r *= scale;
    let p = yzx(u) * zxy(v);
    let q = zxy(u) * yzx(v);
    let det = sum((p - q) * r);
    let bound = sum((p.abs() + q.abs()) * r_bound) * (10.0 / 16_777_216.0);
    i8::from(det > bound) - i8::from(det < -bound)
}

/// A power of two that brings the largest component into 1 .. 2.
fn exact_scale(v: Vec3) -> f32 {
    let v = v.abs();
    let exponent = v.x.max(v.y.max(v.z)).to_bits() & 0x7f80_0000;
    f32::from_bits(0x7f00_0000 - exponent.min(0x7e80_0000))
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
                    let whole = scaled_side(a, b, c, light.into(), rest);
                    assert!(short == 0 || short == whole, "{size} {height}");
                    clear += i32::from(short != 0);
                }
            }
        }
        assert!(clear > 1000, "{clear}");
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
