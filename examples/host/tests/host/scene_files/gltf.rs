//! glTF files as they are found.

use std::path::PathBuf;

use serde_json::{Value, json};
use shadows::glam::Vec3;

use super::{assert_loads, assert_refused, model, write};
use host::scene::{self, file};

/// A glTF of three corners at 36 bytes of positions, three u16 indices after them.
pub fn triangle() -> (Value, Vec<u8>) {
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
pub fn glb(name: &str, edit: impl FnOnce(&mut Value, &mut Vec<u8>)) -> PathBuf {
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

/// Appends numbers with an accessor of their own, and says which.
fn append(
    json: &mut Value,
    bytes: &mut Vec<u8>,
    kind: (u32, &str),
    count: usize,
    data: &[u8],
) -> usize {
    let (component, dimensions) = kind;
    let offset = bytes.len();
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    json["buffers"][0]["byteLength"] = bytes.len().into();
    let views = json["bufferViews"].as_array_mut().unwrap();
    views.push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": data.len() }));
    let view = views.len() - 1;
    let accessors = json["accessors"].as_array_mut().unwrap();
    accessors.push(
        json!({ "bufferView": view, "componentType": component, "count": count,
                           "type": dimensions }),
    );
    accessors.len() - 1
}

const FLOAT: u32 = 5126;
const USHORT: u32 = 5123;
const SHORT: u32 = 5122;

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn shorts(numbers: &[i16]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

#[test]
fn what_is_not_made_of_triangles_is_left_out_and_told() {
    for (mode, told) in [(0, "points"), (1, "lines"), (2, "lines"), (3, "lines")] {
        let other = json!({ "attributes": { "POSITION": 0 }, "mode": mode });
        let told = format!("primitives of {told} (1)");
        let beside = glb("beside.glb", |json, _| {
            let primitives = json["meshes"][0]["primitives"].as_array_mut().unwrap();
            primitives.insert(0, other.clone());
        });
        // The mesh is there twice.
        assert_loads(&beside, 2, &[&told]);
        let alone = glb("alone.glb", |json, _| {
            json["meshes"][0]["primitives"] = json!([other])
        });
        assert_refused(&alone, &format!("it has no triangles, only {told}"));
    }
    let bare = glb("attributes.glb", |json, _| {
        let primitives = json["meshes"][0]["primitives"].as_array_mut().unwrap();
        primitives.push(json!({ "attributes": {} }));
    });
    assert_loads(&bare, 2, &["primitives without positions (1)"]);
    assert_loads(&glb("whole.glb", |_, _| ()), 2, &[]);
}

const LIST: u32 = 4;
const STRIP: u32 = 5;
const FAN: u32 = 6;

/// Four corners of a square in the order of a strip, drawn by these indices.
fn square(name: &str, mode: u32, indices: &[i16]) -> PathBuf {
    glb(name, |json, bytes| {
        let corners = floats(&[0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0.]);
        let positions = append(json, bytes, (FLOAT, "VEC3"), 4, &corners);
        let count = indices.len();
        let indices = append(json, bytes, (USHORT, "SCALAR"), count, &shorts(indices));
        json["meshes"][0]["primitives"] = json!([
            { "attributes": { "POSITION": positions }, "indices": indices, "mode": mode } ]);
        json["scenes"][0]["nodes"] = json!([2]);
    })
}

#[test]
fn strips_and_fans_are_triangles() {
    let list = assert_loads(&square("triangles.glb", LIST, &[0, 1, 2, 1, 3, 2]), 2, &[]);
    let strip = assert_loads(&square("strip.glb", STRIP, &[0, 1, 2, 3]), 2, &[]);
    let fan = assert_loads(&square("fan.glb", FAN, &[3, 2, 0, 1]), 2, &[]);
    // Flat normals: all of them look up, whichever corner a triangle begins with.
    for scene in [&list, &strip, &fan] {
        let mesh = &scene.meshes[0];
        assert!(
            mesh.normals.iter().all(|n| *n == [0.0, 0.0, 1.0]),
            "{mesh:?}"
        );
    }
    // The same indices as a list are one triangle too few, and are refused.
    assert_refused(&square("four.glb", LIST, &[0, 1, 2, 3]), "whole triangles");
    assert_refused(
        &square("two.glb", STRIP, &[0, 1]),
        "only primitives without triangles (1)",
    );
}

#[test]
fn without_scenes_all_nodes_are_drawn_and_of_several_the_default() {
    let none = glb("noscene.glb", |json, _| {
        let file = json.as_object_mut().unwrap();
        file.remove("scene");
        file.remove("scenes");
    });
    assert_loads(&none, 3, &[]);
    let several = |default: Option<u32>| {
        glb("scenes.glb", |json, _| {
            json["scenes"] = json!([{ "nodes": [0] }, { "nodes": [3] }]);
            match default {
                Some(scene) => json["scene"] = scene.into(),
                None => drop(json.as_object_mut().unwrap().remove("scene")),
            }
        })
    };
    let told = "scenes that are not the default one (1)";
    assert_loads(&several(Some(1)), 1, &[told]);
    assert_loads(&several(Some(0)), 2, &[told]);
    assert_loads(&several(None), 2, &[told]);
}

/// The node in no scene, drawn at instances with these attributes.
fn instanced(attributes: &[(&str, u32, &str, usize, Vec<u8>)]) -> PathBuf {
    glb("instances.glb", |json, bytes| {
        let mut map = json!({});
        for (name, component, dimensions, count, data) in attributes {
            let accessor = append(json, bytes, (*component, dimensions), *count, data);
            if *component == SHORT {
                json["accessors"][accessor]["normalized"] = true.into();
            }
            map[*name] = accessor.into();
        }
        json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
        json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
        json["scenes"][0]["nodes"] = json!([3]);
        json["nodes"][3]["translation"] = json!([10.0, 0.0, 0.0]);
        json["nodes"][3]["extensions"] =
            json!({ "EXT_mesh_gpu_instancing": { "attributes": map } });
    })
}

#[test]
fn instances_are_drawn_where_they_stand() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let translations = floats(&[0.0, 0.0, 0.0, 0.0, 5.0, 0.0]);
    // None, and a quarter around z.
    let rotations = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half]);
    let packed = [0, 0, 0, 32_767, 0, 0, 23_170, 23_170];
    let scales = floats(&[1.0, 1.0, 1.0, 2.0, 3.0, 1.0]);
    for rotation in [
        ("ROTATION", FLOAT, "VEC4", 2, rotations),
        ("ROTATION", SHORT, "VEC4", 2, shorts(&packed)),
    ] {
        let path = instanced(&[
            ("TRANSLATION", FLOAT, "VEC3", 2, translations.clone()),
            rotation,
            ("SCALE", FLOAT, "VEC3", 2, scales.clone()),
        ]);
        let scene = assert_loads(&path, 2, &[]);
        let corners = scene.objects.iter().map(|object| {
            let corner = Vec3::new(2.0, 0.0, 0.0);
            object.transform.transform_point3(corner)
        });
        let expected = [Vec3::new(12.0, 0.0, 0.0), Vec3::new(10.0, 9.0, 0.0)];
        for (corner, expected) in corners.zip(expected) {
            assert!(
                corner.distance(expected) < 1e-3,
                "{corner} is not {expected}"
            );
        }
    }
    let alone = instanced(&[("SCALE", FLOAT, "VEC3", 2, scales)]);
    assert_loads(&alone, 2, &[]);
    let unequal = instanced(&[
        ("TRANSLATION", FLOAT, "VEC3", 2, translations),
        ("SCALE", FLOAT, "VEC3", 1, floats(&[1.0; 3])),
    ]);
    assert_refused(&unequal, "of one count, not {1, 2}");
    assert_refused(
        &instanced(&[]),
        "node 3: EXT_mesh_gpu_instancing: it needs attributes",
    );
    let missing = glb("missing.glb", |json, _| {
        let extension = json!({ "attributes": { "TRANSLATION": 99 } });
        json["nodes"][1]["extensions"] = json!({ "EXT_mesh_gpu_instancing": extension });
    });
    assert_refused(&missing, "TRANSLATION has no accessor 99");
}

#[test]
fn an_extension_that_is_needed_and_not_read_is_named() {
    let with = |field: &str, extension: &str| {
        glb("extension.glb", |json, _| {
            json["extensionsUsed"] = json!([extension]);
            json[field] = json!([extension]);
        })
    };
    for extension in [
        "KHR_draco_mesh_compression",
        "EXT_meshopt_compression",
        "NEW_one",
    ] {
        let reason = format!("it requires the extension {extension}, which is not read here");
        assert_refused(&with("extensionsRequired", extension), &reason);
        // What a file can do without is told.
        let told = format!("extension {extension} (1)");
        assert_loads(&with("extensionsUsed", extension), 2, &[&told]);
    }
    for harmless in [
        "KHR_materials_unlit",
        "KHR_texture_transform",
        "KHR_lights_punctual",
    ] {
        assert_loads(&with("extensionsRequired", harmless), 2, &[]);
    }
    let packed = glb("packed.glb", |json, _| {
        json["accessors"][0]
            .as_object_mut()
            .unwrap()
            .remove("bufferView");
    });
    assert_refused(&packed, "accessors[0].bufferView: Missing");
}

#[test]
fn positions_of_few_bits_are_read() {
    let quantized = |normalized: bool, numbers: &[i16]| {
        let path = glb("quantized.glb", |json, bytes| {
            let positions = append(json, bytes, (SHORT, "VEC3"), 3, &shorts(numbers));
            json["accessors"][positions]["normalized"] = normalized.into();
            json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
            json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
            json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = positions.into();
        });
        assert_loads(&path, 2, &[]).meshes[0].positions.clone()
    };
    let [a, b, c] = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
    assert_eq!(quantized(false, &[0, 0, 0, 2, 0, 0, 0, 2, 0]), [a, b, c]);
    let [b, c] = [b, c].map(|p| p.map(|x| x / 2.0));
    let most = i16::MAX;
    assert_eq!(
        quantized(true, &[0, 0, 0, most, 0, 0, 0, most, 0]),
        [a, b, c]
    );
}

#[test]
fn bounds_of_positions_may_be_missing_or_wrong() {
    let missing = glb("bounds.glb", |json, _| {
        json["accessors"][0].as_object_mut().unwrap().remove("min");
        json["accessors"][0]["max"] = json!(["much"]);
    });
    let whole = assert_loads(&glb("bounded.glb", |_, _| ()), 2, &[]);
    assert_eq!(assert_loads(&missing, 2, &[]).meshes, whole.meshes);
}

#[test]
fn a_node_may_flatten_its_mesh() {
    let flat = glb("zero.glb", |json, _| {
        json["nodes"][1]["scale"] = json!([1.0, 0.0, 1.0])
    });
    let scene = assert_loads(&flat, 2, &[]);
    let heights = scene.objects.iter().map(|object| {
        let heights: Vec<f64> = scene.world_points(object).map(|p| p.y).collect();
        heights.iter().copied().fold(f64::MIN, f64::max) - heights[0]
    });
    let mut heights: Vec<f64> = heights.collect();
    heights.sort_by(f64::total_cmp);
    assert_eq!(heights, [0.0, 2.0]);
}

#[test]
fn skins_and_morph_targets_are_told() {
    let path = glb("skin.glb", |json, _| {
        json["skins"] = json!([{ "joints": [0] }]);
        json["nodes"][1]["skin"] = 0.into();
        json["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": 0 }]);
    });
    let told = [
        "primitives' morph targets (1)",
        "skins, their meshes standing as modelled (1)",
    ];
    assert_loads(&path, 2, &told);
}
