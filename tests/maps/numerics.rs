//! The figures of docs/numerics.md: `cargo test --test maps numerics -- --nocapture` prints them.

use glam::{DVec2, DVec3, Mat3, Quat, Vec3};
use host::random::Random;
use shadows::{Bias, glam};

const ROUNDS: u32 = 100_000;

fn point(random: &mut Random) -> DVec3 {
    random.point(1.0).as_dvec3()
}

/// A triangle within a unit of `centre` and a light so near to its plane that rounding decides.
fn grazed(random: &mut Random, centre: DVec3) -> ([Vec3; 3], Vec3) {
    let [a, b, c] = [(); 3].map(|()| (centre + point(random)).as_vec3());
    let in_plane = a.as_dvec3()
        + (b - a).as_dvec3() * f64::from(random.within(-1.0, 1.0))
        + (c - a).as_dvec3() * f64::from(random.within(-1.0, 1.0));
    ([a, b, c], in_plane.as_vec3())
}

/// The side of the light, with a normal from one corner as each shader invocation would have it.
fn facing([a, b, c]: [Vec3; 3], light: Vec3) -> bool {
    (b - a).cross(c - a).dot(light - a) > 0.0
}

fn percent(count: u32) -> f64 {
    100.0 * f64::from(count) / f64::from(ROUNDS)
}

#[test]
fn facing_recomputed_from_another_corner_disagrees() {
    let mut random = Random(1);
    let mut recomputed = 0;
    for _ in 0..ROUNDS {
        let ([a, b, c], light) = grazed(&mut random, DVec3::ZERO);
        recomputed += u32::from(facing([a, b, c], light) != facing([b, c, a], light));
    }
    println!(
        "facing from another corner disagrees: {:.1} %",
        percent(recomputed)
    );
    assert!(recomputed > ROUNDS / 100);
}

#[test]
fn a_plane_in_f32_is_wrong_more_often_than_differences_far_from_the_origin() {
    let mut random = Random(2);
    let centre = DVec3::splat(1e3);
    let (mut plane, mut differences) = (0, 0);
    for _ in 0..ROUNDS {
        // Triangles of a hundredth of a unit, and lights as near to them.
        let mut near = || (centre + 0.01 * point(&mut random)).as_vec3();
        let ([a, b, c], light) = ([near(), near(), near()], near());
        let [x, y, z, l] = [a, b, c, light].map(|p| p.as_dvec3());
        let truth = (y - x).cross(z - x).dot(l - x) > 0.0;
        let normal = (b - a).cross(c - a);
        let distance = -normal.dot(a);
        plane += u32::from((normal.dot(light) + distance > 0.0) != truth);
        differences += u32::from(facing([a, b, c], light) != truth);
    }
    println!("a plane in f32, 1e3 out, is wrong: {:.3} %", percent(plane));
    println!(
        "differences, 1e3 out, are wrong: {:.3} %",
        percent(differences)
    );
    assert!(plane > 10 * differences.max(1));
}

/// The least share by which a point at a distance must move away to get another depth.
fn step(distance: f64, depth: impl Fn(f32) -> f32) -> f64 {
    let at = depth(distance as f32);
    let shares = (0..80).map(|i| 2.0_f64.powf(f64::from(i) / 2.0 - 26.0));
    let mut shares = shares.filter(|share| depth((distance * (1.0 + share)) as f32) != at);
    shares.next().unwrap_or(f64::INFINITY)
}

#[test]
fn reverse_depth_keeps_its_relative_steps_and_standard_depth_does_not() {
    let (near, far) = (0.1_f32, 1e4_f32);
    for distance in [1.0, 10.0, 100.0, 1000.0] {
        let reverse = step(distance, |d| near / d);
        let standard = step(distance, |d| far / (far - near) * (1.0 - near / d));
        println!("at {distance} m: reverse {reverse:.1e}, standard {standard:.1e} of the distance");
        assert!(reverse < 1e-6);
        assert!(distance < 100.0 || standard > 100.0 * reverse);
    }
    // A direction, w = 0, is at exactly 0, and behind everything.
    assert_eq!(near / f32::INFINITY, 0.0);
}

/// The unit in which positions are rounded: half of the largest ulp, as a part of a coordinate.
const HALF_ULP: f64 = 1.0 / 16_777_216.0;

/// A triangle as a host draws it: true corners, and what its vertex shader makes of them in f32.
struct Drawn {
    truth: [DVec3; 3],
    world: [Vec3; 3],
    /// Pixels, and distance along the camera's axis.
    screen: [[f32; 3]; 3],
    light: Vec3,
}

/// Somewhere far away, turned, before a camera nearby.
fn drawn(random: &mut Random) -> Option<Drawn> {
    let turn = Quat::from_axis_angle(
        random.point(1.0).normalize_or(Vec3::X),
        random.within(0.0, 6.0),
    );
    let linear = Mat3::from_quat(turn) * random.within(0.5, 2.0);
    let far = 10.0_f32.powf(random.within(2.0, 6.0));
    let place = random.point(1.0) * far;
    let corners = [(); 3].map(|()| random.point(4.0));
    let truth = corners.map(|p| linear.as_dmat3() * p.as_dvec3() + place.as_dvec3());
    // One product after another, as a matrix times a vector is.
    let world =
        corners.map(|p| linear.x_axis * p.x + linear.y_axis * p.y + linear.z_axis * p.z + place);
    let screen = truth.map(|p| {
        let eye = p - place.as_dvec3() + DVec3::new(0.0, 0.0, 12.0);
        let at = eye.truncate() * 700.0 / eye.z;
        [640.0 + at.x as f32, 360.0 + at.y as f32, eye.z as f32]
    });
    // A triangle seen from its edge is all edges.
    let [a, b, c] = screen.map(|[x, y, _]| DVec2::new(x.into(), y.into()));
    let area = (b - a).perp_dot(c - a).abs();
    let longest = (b - a).length().max((c - a).length()).max((c - b).length());
    let inside = screen
        .iter()
        .all(|s| s[0] > 0.0 && s[0] < 1280.0 && s[1] > 0.0 && s[1] < 720.0);
    let normal = (truth[1] - truth[0])
        .cross(truth[2] - truth[0])
        .normalize_or_zero();
    (inside && area > 0.2 * longest * longest && normal != DVec3::ZERO).then_some(Drawn {
        truth,
        world,
        screen,
        light: place + Vec3::new(5.0, 9.0, 4.0),
    })
}

/// A value at a pixel as textbooks have it, in f32: value / w over 1 / w, each a sum over the corners
/// (Heckbert and Moreton, "Interpolation for Polygon Texture Mapping and Shading", 1991).
fn interpolated(screen: &[[f32; 3]; 3], values: [f32; 3], weights: [f32; 3]) -> f32 {
    let [a, b, c] = [0, 1, 2].map(|i| weights[i] * (1.0 / screen[i][2]));
    (a * values[0] + b * values[1] + c * values[2]) * (1.0 / (a + b + c))
}

/// How far a receiver's position is off its plane, in [`HALF_ULP`]s of what its coordinates come to
/// along the normal: the bound that receivers add is so much of `position_ulps`.
fn off_plane(random: &mut Random) -> Option<f64> {
    let Drawn {
        truth,
        world,
        screen,
        light,
    } = drawn(random)?;
    let normal = (truth[1] - truth[0]).cross(truth[2] - truth[0]).normalize();
    let weights = [(); 3].map(|()| random.within(0.05, 1.0));
    let sum: f32 = weights.iter().sum();
    let weights = weights.map(|weight| weight / sum);
    let axis = |axis: usize| interpolated(&screen, world.map(|p| p[axis]), weights);
    let position = Vec3::new(axis(0), axis(1), axis(2)).as_dvec3();
    let off = normal.dot(position - truth[0]).abs();
    let from_light = position - light.as_dvec3();
    let coordinates = position.abs() + from_light.abs();
    Some(off / (HALF_ULP * normal.abs().dot(coordinates)))
}

#[test]
fn receivers_are_off_their_planes_by_no_more_than_the_bias_in_ulps() {
    let mut random = Random(4);
    let mut off: Vec<f64> = Vec::new();
    while off.len() < ROUNDS as usize {
        off.extend(off_plane(&mut random));
    }
    off.sort_by(f64::total_cmp);
    let [median, most, worst] =
        [0.5, 0.999, 1.0].map(|part| off[((off.len() - 1) as f64 * part) as usize]);
    println!("receivers off their planes, in halves of an ulp: {median:.2}, {most:.2}, {worst:.2}");
    // An ulp, as `position_ulps` counts, is two halves.
    let bound = 2.0 * f64::from(Bias::default().position_ulps);
    assert!(worst < bound, "{worst}");
    // The broken twin: a quarter of it. (Rasterisers that are less exact than this take half.)
    assert!(worst > 0.25 * bound, "{worst}");
}
