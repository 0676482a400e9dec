//! What the fuzz targets share: numbers with any bits, meshes, scenes, and a device without a
//! driver.

pub mod gpu;
pub mod map;
pub mod mesh;
pub mod scene;

use arbitrary::{Arbitrary, Result, Unstructured};
use shadows::glam::Vec3;

/// Numbers at which arithmetic changes its ways.
const SPECIAL: [f32; 16] = [
    0.0,
    -0.0,
    f32::MIN_POSITIVE,
    1e-45,
    -1e-45,
    1e-20,
    1e-10,
    f32::EPSILON,
    1.0 - f32::EPSILON,
    1e10,
    1e20,
    f32::MAX,
    f32::MIN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
];

/// Any `f32`: mostly a quarter of a small integer, so that points coincide and planes meet, else a
/// special one or any bits.
#[derive(Clone, Copy, Debug)]
pub struct Number(pub f32);

impl<'a> Arbitrary<'a> for Number {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        Ok(Self(match u.arbitrary::<u8>()? {
            0..=239 => f32::from(u.arbitrary::<i8>()?) / 4.0,
            240..=247 => *u.choose(&SPECIAL)?,
            _ => f32::from_bits(u.arbitrary()?),
        }))
    }
}

/// Mostly above 0, up to 32, as ranges and sizes should be; else any [`Number`].
#[derive(Clone, Copy, Debug)]
pub struct Length(pub f32);

impl<'a> Arbitrary<'a> for Length {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        Ok(Self(match u.arbitrary::<u8>()? {
            0..=247 => (f32::from(u.arbitrary::<u8>()?) + 1.0) / 8.0,
            _ => u.arbitrary::<Number>()?.0,
        }))
    }
}

/// Three [`Number`]s.
pub fn vector(numbers: [Number; 3]) -> Vec3 {
    Vec3::from(numbers.map(|number| number.0))
}

/// Between `least` and `most` of something: `arbitrary` alone gives lists of one or two.
pub fn list<'a, T: Arbitrary<'a>>(
    u: &mut Unstructured<'a>,
    least: usize,
    most: usize,
) -> Result<Vec<T>> {
    let count = u.int_in_range(least..=most)?;
    (0..count).map(|_| u.arbitrary()).collect()
}
