//! Loading models from files: what is read, how it is placed, and what is refused in one line.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use shadows::glam::Vec3;

#[allow(dead_code, unused_imports)]
#[path = "../examples/host/scene/mod.rs"]
mod scene;

use scene::{Scene, file};

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

/// A glTF of three corners at 36 bytes of positions, three u16 indices after them.
fn triangle() -> (Value, Vec<u8>) {
    let mut bytes = Vec::new();
    for x in [0.0_f32, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0, 0.0] {
        bytes.extend(x.to_le_bytes());
    }
    for i in [0_u16, 1, 2, 0] {
        bytes.extend(i.to_le_bytes());
    }
    let json = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [
            { "translation": [5.0, 0.0, 0.0], "children": [1, 2] },
            { "mesh": 0, "scale": [-1.0, 1.0, 1.0] },
            { "mesh": 0, "translation": [0.0, 3.0, 0.0] },
            { "mesh": 0, "name": "in no scene" }
        ],
        "meshes": [{ "name": "tri", "primitives": [
            { "attributes": { "POSITION": 0 }, "indices": 1 } ] }],
        "buffers": [{ "byteLength": 44 }],
        "bufferViews": [
            { "buffer": 0, "byteLength": 36 },
            { "buffer": 0, "byteOffset": 36, "byteLength": 6 }
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
              "min": [0.0, 0.0, 0.0], "max": [2.0, 2.0, 0.0] },
            { "bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR" }
        ]
    });
    (json, bytes)
}

/// Writes it as binary glTF, after `edit`.
fn glb(name: &str, edit: impl FnOnce(&mut Value, &mut Vec<u8>)) -> PathBuf {
    let (mut json, mut binary) = triangle();
    edit(&mut json, &mut binary);
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((12 + 8 + json.len() as u32 + 8 + binary.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &binary)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    write(name, bytes)
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
fn normals_of_an_obj_are_kept_where_they_can_be_used() {
    let with = |n: &str| {
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn {n}\nf 1//1 2//1 3//1\nf 3//1 2//1 1//1\n")
    };
    let kept = file(&write("kept.obj", with("0 3 4")), false).unwrap();
    let [x, y, z] = kept.meshes[0].normals[0];
    assert!(x == 0.0 && (y - 0.6).abs() < 1e-6 && (z - 0.8).abs() < 1e-6);
    let made = file(&write("made.obj", with("0 0 0")), false).unwrap();
    assert_eq!(made.meshes[0].normals[0], [0.0, 0.0, 1.0]);
}

#[test]
fn polygons_groups_and_missing_materials_of_an_obj_are_read() {
    let text = "mtllib none.mtl\no a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl no\nf 1 2 3 4\n\
                o b\nf -4 -3 -2\nl 1 2\n";
    let scene = file(&write("groups.obj", text), false).unwrap();
    let counts: Vec<_> = scene.meshes.iter().map(|m| m.triangle_count()).collect();
    assert_eq!(counts, [2, 1]);
}

#[test]
fn the_picture_of_a_model_does_not_depend_on_its_unit() {
    let scaled = |k: f64| {
        let text = format!("v 0 0 0\nv {k} 0 0\nv 0 {k} 0\nv 0 0 {k}\nf 1 2 3\nf 1 3 4\n");
        file(&write(&format!("unit{k}.obj"), text), true).unwrap()
    };
    let [metre, large] = [1.0, 1024.0].map(scaled);
    let same = |a: f32, b: f32| (a * 1024.0 - b).abs() <= 4.0 * f32::EPSILON * b.abs();
    assert!(same(metre.range, large.range));
    assert!(same(metre.camera.near, large.camera.near));
    for i in 0..3 {
        assert!(same(metre.light[i], large.light[i]));
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
            let distance = p.distance(scene.light.truncate());
            assert!(distance < scene.range);
        }
    }
}

#[test]
fn a_gltf_keeps_its_nodes_transforms_and_shares_its_meshes() {
    let scene = file(&glb("nodes.glb", |_, _| ()), true).unwrap();
    let objects = model(&scene);
    assert_eq!(objects.len(), 2, "the node in no scene is not drawn");
    assert_eq!(objects[0].mesh, objects[1].mesh);
    let mut corners: Vec<_> = objects
        .iter()
        .map(|o| {
            o.transform
                .transform_point3(Vec3::new(2.0, 0.0, 0.0))
                .to_array()
        })
        .collect();
    corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
    assert_eq!(corners, [[3.0, 0.0, 0.0], [7.0, 3.0, 0.0]]);
    let mirrored = |o: &&&scene::Object| o.transform.matrix3.determinant() < 0.0;
    assert_eq!(objects.iter().filter(mirrored).count(), 1);
    assert_eq!(scene.meshes[objects[0].mesh].normals, [[0.0, 0.0, 1.0]; 3]);
}

#[test]
fn a_gltf_without_indices_and_one_in_json_are_read() {
    let bare = glb("list.glb", |json, _| {
        let primitive = json["meshes"][0]["primitives"][0].as_object_mut().unwrap();
        primitive.remove("indices");
    });
    assert_eq!(file(&bare, false).unwrap().meshes[0].indices, [0, 1, 2]);

    let (mut json, bytes) = triangle();
    write("triangle.bin", bytes);
    json["buffers"][0]["uri"] = "triangle.bin".into();
    let path = write("triangle.gltf", json.to_string());
    assert_eq!(file(&path, false).unwrap().triangle_count(), 2);
}

#[test]
fn broken_files_are_refused_with_the_reason() {
    assert_refused(Path::new("/none/such.obj"), "cannot read the file");
    assert_refused(Path::new("/none/such.glb"), "cannot read the file");
    assert_refused(&write("model.stl", "solid"), ".obj, .gltf or .glb");
    assert_refused(&write("latin.obj", b"o caf\xe9\nv 0 0 0\n"), "not UTF-8");
    assert_refused(&write("empty.obj", ""), "no triangles");
    assert_refused(&write("points.obj", "v 0 0 0\nv 1 0 0\n"), "no triangles");
    assert_refused(&write("word.obj", "v 0 zero 0\n"), "position parse error");
    assert_refused(&write("broken.gltf", "{ \"asset\": "), "not a valid glTF");
    assert_refused(&write("broken.glb", "glTF"), "not a valid glTF");
}

#[test]
fn broken_geometry_is_refused_with_the_reason() {
    let with = |face: &str| format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{face}\n");
    assert_refused(&write("range.obj", with("f 1 2 4")), "out of bounds");
    let nan = with("v NaN 0 0\nf 1 2 4");
    assert_refused(&write("nan.obj", nan), "not finite");
    let infinite = with("v 1e39 0 0\nf 1 2 4");
    assert_refused(&write("infinite.obj", infinite), "not finite");
    let point = "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n";
    assert_refused(&write("point.obj", point), "at one point");
    let huge = "v 3e38 0 0\nv -3e38 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_refused(&write("huge.obj", huge), "too large");
    assert!(file(&write("right.obj", with("f 1 2 3")), true).is_ok());
}

#[test]
fn broken_gltf_geometry_is_refused_with_the_reason() {
    let path = glb("strip.glb", |json, _| {
        json["meshes"][0]["primitives"][0]["mode"] = 5.into();
    });
    assert_refused(&path, "only triangle lists");
    let path = glb("index.glb", |_, bytes| bytes[40] = 9);
    assert_refused(&path, "index 9 is out of range");
    let path = glb("nan.glb", |_, bytes| {
        bytes[12..16].copy_from_slice(&f32::NAN.to_le_bytes());
    });
    assert_refused(&path, "vertex 1 has a coordinate that is not finite");
    let path = glb("none.glb", |json, _| {
        json["scenes"][0]["nodes"] = json!([3])
    });
    assert!(file(&path, true).is_ok());
    let path = glb("bare.glb", |json, _| json["scenes"][0]["nodes"] = json!([]));
    assert_refused(&path, "no triangles");
    let path = glb("pair.glb", |json, _| {
        json["accessors"][1]["count"] = 2.into()
    });
    assert_refused(&path, "whole triangles");
}

#[test]
fn gltf_files_that_would_make_the_reader_panic_are_refused() {
    let path = glb("short.glb", |json, _| {
        json["bufferViews"][0]["byteLength"] = 30.into()
    });
    assert_refused(&path, "outside its buffer");
    let path = glb("type.glb", |json, _| {
        json["accessors"][0]["type"] = "VEC2".into()
    });
    refusal(&path);
    let path = glb("float.glb", |json, _| {
        json["accessors"][1]["componentType"] = 5126.into()
    });
    assert_refused(&path, "wrong type");
    let path = glb("zero.glb", |json, _| {
        json["accessors"][0]["count"] = 0.into()
    });
    refusal(&path);
    let path = glb("cut.glb", |_, bytes| bytes.truncate(20));
    assert_refused(&path, "buffers");
    let path = glb("loop.glb", |json, _| {
        json["nodes"][2]["children"] = json!([0])
    });
    assert_refused(&path, "do not form trees");
}
