//! Loading models from files: what is read, how it is placed, and what is refused in one line.

use std::path::{Path, PathBuf};

mod gltf;
mod gltf_broken;
mod obj;

use host::scene::{self, Scene, file};

/// A tetrahedron of four corners, wound outward.
const TETRAHEDRON: &str = "o tetra\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n\
                           f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

fn write(name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join("scene_files");
    std::fs::create_dir_all(&dir).unwrap();
    let path = dir.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

/// The one line that a user sees, after checking that it is one and names the file.
fn refusal(path: &Path) -> String {
    let error = file(path, true).expect_err("should be refused");
    let line = format!("{error:#}");
    assert!(!line.contains('\n'), "{line}");
    assert!(line.contains(&path.display().to_string()), "{line}");
    line
}

#[track_caller]
fn assert_refused(path: &Path, reason: &str) {
    let line = refusal(path);
    assert!(line.contains(reason), "{line}");
}

fn model(scene: &Scene) -> Vec<&scene::Object> {
    scene.objects.iter().filter(|o| o.casts).collect()
}

#[test]
fn an_obj_is_loaded_and_put_on_a_ground() {
    let scene = file(&write("tetra.obj", TETRAHEDRON), true).unwrap();
    assert_eq!(scene.name, "tetra");
    let [object] = model(&scene)[..] else {
        panic!("one object")
    };
    assert_eq!(scene.meshes[object.mesh].triangle_count(), 4);
    // No normals in the file, and every edge is sharp: each face keeps its own.
    assert_eq!(scene.meshes[object.mesh].positions.len(), 12);
    let ground = scene.objects.iter().find(|o| !o.casts).unwrap();
    for p in scene.world_points(ground) {
        assert_eq!(p.y, 0.0);
        assert!(p.x.abs().max(p.z.abs()) > 2.0, "wider than the model");
    }

    let bare = file(&write("bare.obj", TETRAHEDRON), false).unwrap();
    assert_eq!(bare.objects.len(), 1);
    assert_eq!(bare.triangle_count(), 4);
}

#[test]
fn the_picture_of_a_model_does_not_depend_on_its_unit() {
    let scaled = |k: f64| {
        let text = format!("v 0 0 0\nv {k} 0 0\nv 0 {k} 0\nv 0 0 {k}\nf 1 2 3\nf 1 3 4\n");
        file(&write(&format!("unit{k}.obj"), text), true).unwrap()
    };
    let [metre, large] = [1.0, 1024.0].map(scaled);
    let same = |a: f32, b: f32| (a * 1024.0 - b).abs() <= 4.0 * f32::EPSILON * b.abs();
    assert!(same(metre.light().range, large.light().range));
    assert!(same(metre.camera.near, large.camera.near));
    for i in 0..3 {
        assert!(same(metre.light().place[i], large.light().place[i]));
        assert!(same(metre.camera.eye[i], large.camera.eye[i]));
        assert!(!same(metre.camera.eye[i], 1.01 * large.camera.eye[i]));
    }
}

#[test]
fn the_whole_model_is_in_the_picture_and_in_range() {
    for (name, text) in [
        (
            "flat.obj",
            "v -9 1 -3\nv 9 1 -3\nv 9 1 3\nv -9 1 3\nf 4 3 2 1\n",
        ),
        ("tall.obj", "v 0 -5 100\nv 1 -5 100\nv 0 20 100\nf 1 2 3\n"),
    ] {
        let scene = file(&write(name, text), true).unwrap();
        let clip = scene.camera.clip_from_world(16.0 / 9.0);
        let object = model(&scene)[0];
        for p in scene.world_points(object) {
            let p = p.as_vec3();
            let c = clip * p.extend(1.0);
            assert!(c.w > scene.camera.near && c.x.abs() < c.w && c.y.abs() < c.w);
            let distance = p.distance(scene.light().place.truncate());
            assert!(distance < scene.light().range);
        }
    }
}

/// Triangles without a ground, and what is said to be left out.
#[track_caller]
fn assert_loads(path: &Path, triangles: usize, left_out: &[&str]) -> Scene {
    let scene = file(path, false).unwrap_or_else(|error| panic!("{error:#}"));
    assert_eq!(scene.triangle_count(), triangles);
    assert_eq!(scene.left_out, left_out);
    scene
}

#[test]
fn what_is_no_model_is_refused() {
    assert_refused(Path::new("/none/such.obj"), "cannot read the file");
    assert_refused(Path::new("/none/such.glb"), "cannot read the file");
    assert_refused(&write("model.stl", "solid"), ".obj, .gltf or .glb");
}
