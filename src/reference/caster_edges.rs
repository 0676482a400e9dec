//! The light rays beside the edges of casters around a pixel's own ray: rays at fixed places miss what is thin,
//! such as the shadow of a wire, or a gap.

use glam::{DVec2, DVec3, Vec4Swizzles as _};

use super::geometry::{Geometry, Triangle};
use super::image::Lighting;
use super::map_rays::Rays;

/// How far beside an edge its rays are, as a part of a texel.
const BESIDE: f64 = 1e-3;

/// Where around the own ray, at offsets up to `across` and in the units of [`Rays::meet`], what light meets may
/// change: on both sides of each edge of a caster above the tangent plane, where that is nearest to the own ray.
pub(super) fn beside_edges<'a>(
    (geometry, lighting): (&'a Geometry, &Lighting),
    rays: &'a Rays,
    (position, normal): (DVec3, DVec3),
    (across, texel): (f64, f64),
) -> impl Iterator<Item = DVec2> + 'a {
    let light = lighting.light;
    let radius = beam(rays, position, light.xyz() - light.w * position, across);
    let above = move |triangle: &&Triangle| {
        let heights = triangle.corners.map(|corner| normal.dot(corner - position));
        let rounding = 1e-9 * triangle.size().max(position.abs().max_element());
        heights.iter().any(|height| *height > rounding)
    };
    geometry
        .casting_near(position, light, radius)
        .filter(above)
        .flat_map(move |triangle| {
            let [a, b, c] = triangle.corners.map(|corner| rays.place(corner));
            [[a, b], [b, c], [c, a]]
        })
        .filter_map(|[a, b]| nearest(a, b))
        .filter(move |(place, _)| place.length() <= across)
        .flat_map(move |(place, along)| {
            let aside = BESIDE * texel * along.perp();
            [place + aside, place - aside]
        })
}

/// How far, at most, rays at these offsets are from the own one between the light and the plane: infinitely, if one
/// misses the plane.
fn beam(rays: &Rays, position: DVec3, to_light: DVec3, across: f64) -> f64 {
    const AROUND: u32 = 16;
    let along = to_light.normalize();
    let aside = |n: u32| {
        let angle = std::f64::consts::TAU * f64::from(n) / f64::from(AROUND);
        // Of the polygon around the circle.
        let length = across / (std::f64::consts::PI / f64::from(AROUND)).cos();
        let (v, u) = angle.sin_cos();
        let met = rays.meet(length * u, length * v);
        met.map_or(f64::INFINITY, |met| {
            (met - position).reject_from_normalized(along).length()
        })
    };
    (0..AROUND).map(aside).fold(0.0, f64::max)
}

/// Of an edge in homogeneous places, the place nearest to the own ray, and its direction; `None` if the edge is
/// behind the light, or a point as the light sees it.
fn nearest(a: DVec3, b: DVec3) -> Option<(DVec2, DVec2)> {
    let [a, b] = in_front(a, b)?.map(|end| end.truncate() / end.z);
    let edge = b - a;
    let along = edge.try_normalize()?;
    let share = (-a.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
    Some((a + share * edge, along))
}

/// The part of an edge that the light sees: what is nearer to it than a millionth of the farther end is left out.
fn in_front(a: DVec3, b: DVec3) -> Option<[DVec3; 2]> {
    let least = 1e-6 * a.z.max(b.z);
    if least <= 0.0 {
        return None;
    }
    let clipped = |from: DVec3, to: DVec3| match from.z >= least {
        true => from,
        false => from.lerp(to, (least - from.z) / (to.z - from.z)),
    };
    Some([clipped(a, b), clipped(b, a)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_nearest_at_a_foot_or_an_end() {
        let at = |x: f64, y: f64| DVec3::new(x, y, 1.0);
        let (place, along) = nearest(at(-1.0, 2.0), at(3.0, 2.0)).unwrap();
        assert_eq!((place, along), (DVec2::new(0.0, 2.0), DVec2::X));
        let (place, _) = nearest(at(1.0, 2.0), at(3.0, 2.0)).unwrap();
        assert_eq!(place, DVec2::new(1.0, 2.0));
        assert_eq!(nearest(at(1.0, 2.0), at(1.0, 2.0)), None);
    }

    #[test]
    fn of_an_edge_past_the_light_the_part_in_front_counts() {
        let behind = DVec3::new(1.0, 5.0, -1.0);
        let before = DVec3::new(1.0, 1.0, 1.0);
        assert_eq!(nearest(behind, behind), None);
        let (place, along) = nearest(behind, before).unwrap();
        assert_eq!(place, DVec2::ONE);
        assert!(along.y < -0.5 || along.y > 0.5, "{along}");
    }
}
