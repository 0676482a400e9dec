//! A scene in short, to tell whether two machines made the same one.

use host::scene::Scene;

/// A line for each mesh, each object, the camera and each light: what it is, and a number made of its bits; of
/// corners and normals to the next 2^-30, as what should be 0 is 1e-17 here and 2e-17 there, by the platform's
/// sine.
pub fn digest(scene: &Scene) -> Vec<String> {
    let meshes = scene.meshes.iter().map(|mesh| {
        let corners = mesh.positions.iter().chain(&mesh.normals).flatten();
        let steps = corners.map(|x| (f64::from(*x) * f64::from(1 << 30)).round() as i64 as u64);
        let indices = mesh.indices.iter().map(|index| u64::from(*index));
        line(&format!("mesh {}", mesh.name), steps.chain(indices))
    });
    let objects = scene.objects.iter().map(|object| {
        let numbers = object.transform.to_cols_array().into_iter();
        line(
            &format!("object {}", object.name),
            bits(numbers.chain(object.albedo)),
        )
    });
    let camera = &scene.camera;
    let ends = [camera.eye, camera.target].map(|point| point.to_array());
    let numbers = ends.as_flattened().iter().copied();
    let camera = line("camera", bits(numbers.chain([camera.fovy, camera.near])));
    let lights = scene.lights.iter().map(|light| {
        let cone = light
            .cone
            .map(|cone| cone.direction.extend(cone.half_angle));
        let numbers = light.place.to_array().into_iter();
        line(
            "light",
            bits(numbers.chain(cone.unwrap_or_default().to_array())),
        )
    });
    meshes
        .chain(objects)
        .chain([camera])
        .chain(lights)
        .collect()
}

fn bits(numbers: impl Iterator<Item = f32>) -> impl Iterator<Item = u64> {
    numbers.map(|number| number.to_bits().into())
}

/// By FNV-1a (Fowler, Noll and Vo, 1991), a word at a time.
fn line(name: &str, words: impl Iterator<Item = u64>) -> String {
    let start = 0xcbf2_9ce4_8422_2325_u64;
    let hash = words.fold(start, |hash, word| {
        (hash ^ word).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{name} {hash:016x}")
}
