//! glTF files that are broken, or not all there.

use serde_json::json;

use super::gltf::{glb, triangle};
use super::{assert_loads, assert_refused, refusal, write};
use host::scene::file;

#[test]
fn a_file_of_numbers_that_is_not_there_is_named() {
    let with = |uri: &str, length: u32| {
        let (mut json, _) = triangle();
        json["buffers"][0] = json!({ "uri": uri, "byteLength": length });
        write("bins.gltf", json.to_string())
    };
    write("there %.bin", triangle().1);
    assert_loads(&with("there%20%25.bin", 44), 2, &[]);
    assert_refused(
        &with("not%20there.bin", 44),
        "cannot read \"not%20there.bin\"",
    );
    assert_refused(
        &with("there%20%25.bin", 45),
        "\"there%20%25.bin\" has 44 bytes, and 45 are promised",
    );
    assert_refused(&with("%ff.bin", 44), "\"%ff.bin\" is no name of a file");
    assert_refused(
        &with("http://a/b.bin", 44),
        "cannot read \"http://a/b.bin\"",
    );
    assert_refused(&with("data:x;base64,????", 44), "cannot read buffer 0");
    let blob = glb("blob.glb", |json, _| {
        json["buffers"] = json!([{ "byteLength": 44 }, { "byteLength": 4 }])
    });
    assert_refused(&blob, "cannot read its binary part");
}

#[test]
fn broken_gltf_is_refused_with_the_reason() {
    assert_refused(&write("broken.gltf", "{ \"asset\": "), "not a valid glTF");
    assert_refused(&write("broken.glb", "glTF"), "not a valid glTF");
    let path = glb("index.glb", |_, bytes| bytes[40] = 9);
    assert_refused(&path, "mesh \"tri\": index 9 is out of range");
    let path = glb("nan.glb", |_, bytes| {
        bytes[12..16].copy_from_slice(&f32::NAN.to_le_bytes());
    });
    assert_refused(
        &path,
        "mesh \"tri\": vertex 1 has a coordinate that is not finite",
    );
    let path = glb("far.glb", |json, _| {
        json["nodes"][0]["scale"] = json!([1e38, 1.0, 1.0]);
        json["nodes"][1]["scale"] = json!([1e38, 1.0, 1.0]);
    });
    assert_refused(&path, "node 1: its transform is not finite");
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
    let path = glb("accessor.glb", |json, _| {
        json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 7.into()
    });
    assert_refused(&path, "accessor 7, and there are 2");
    for (place, value) in [
        ("byteOffset", u64::MAX),
        ("byteLength", u64::MAX),
        ("byteOffset", 40),
    ] {
        let path = glb("sums.glb", |json, _| {
            json["bufferViews"][0][place] = value.into()
        });
        refusal(&path);
    }
    let path = glb("many.glb", |json, _| {
        json["accessors"][0]["count"] = u64::MAX.into()
    });
    refusal(&path);
}
