//! The figures of docs/numerics.md: `cargo test --test numerics -- --nocapture` prints them.

#[path = "../examples/host/random.rs"]
#[allow(dead_code)]
mod random;

use glam::{DVec3, Vec3};
use random::Random;
use shadows::glam;

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
