//! OBJ files as they are found: written by many programs, on many systems.

use super::{assert_loads, assert_refused, write};
use host::scene::{Mesh, Scene, file};

const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// Three corners and what follows.
fn with(rest: &str) -> String {
    format!("{CORNERS}{rest}\n")
}

fn only(scene: &Scene) -> &Mesh {
    let [mesh] = scene.meshes.as_slice() else {
        panic!("{} meshes", scene.meshes.len())
    };
    mesh
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
fn materials_without_a_name_and_libraries_that_are_missing_do_no_harm() {
    for rest in [
        "usemtl \nf 1 2 3",
        "usemtl\nf 1 2 3",
        "mtllib\nmtllib none such.mtl\nusemtl none\nf 1 2 3",
    ] {
        assert_loads(&write("usemtl.obj", with(rest)), 1, &[]);
    }
}

#[test]
fn text_that_is_not_utf_8_spoils_no_more_than_a_name() {
    let comment = [b"# caf\xe9\n".as_slice(), with("f 1 2 3").as_bytes()].concat();
    let scene = assert_loads(&write("latin1.obj", comment), 1, &[]);
    let plain = assert_loads(&write("latin1.obj", with("f 1 2 3")), 1, &[]);
    assert_eq!(scene.meshes, plain.meshes);
    let named = [b"o caf\xe9\n".as_slice(), with("f 1 2 3").as_bytes()].concat();
    assert_eq!(
        only(&file(&write("name.obj", named), false).unwrap()).name,
        "café"
    );
    assert_eq!(
        only(
            &file(
                &write("name.obj", "o café\n".to_owned() + &with("f 1 2 3")),
                false
            )
            .unwrap()
        )
        .name,
        "café"
    );
}

#[test]
fn lines_end_as_on_any_system_and_may_go_on_after_a_backslash() {
    let text = with("f 1 2 3");
    let plain = assert_loads(&write("ends.obj", &text), 1, &[]);
    for other in [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        text.trim_end().to_owned(),
        format!("\u{feff}{text}"),
        text.replace("2 3", "2 \\\n 3"),
        text.replace("2 3", "2\\\r\n3 # the last"),
        text.replace("f ", "\t f  "),
        format!("# C:\\\n{text}"),
    ] {
        let scene = assert_loads(&write("ends.obj", &other), 1, &[]);
        assert_eq!(scene.meshes, plain.meshes, "{other:?}");
    }
    // A backslash elsewhere goes on with nothing.
    assert_refused(
        &write("ends.obj", text.replace("2 3", "2\\3")),
        "\"2\\\\3\" is not an index",
    );
}

#[test]
fn weights_colours_and_texture_coordinates_are_skipped() {
    let plain = assert_loads(&write("plain.obj", with("f 1 2 3")), 1, &[]);
    for (corners, face) in [
        ("v 0 0 0 1\nv 1 0 0 0\nv 0 1 0 2\n", "f 1 2 3"),
        ("v 0 0 0 1 0 0\nv 1 0 0 .5 .5 .5 1\nv 0 1 0 x\n", "f 1 2 3"),
        (
            "v 0 0 0\nvt 0.5\nv 1 0 0\nvt 0 0 0\nv 0 1 0\n",
            "f 1/1 2/2 3/9",
        ),
        // Neither of what these faces speak of is in the file.
        (CORNERS, "f 1/1/1 2/2/2 3/3/3"),
        (CORNERS, "f 1//1 2//2 3//3"),
        (CORNERS, "f 1/ 2/ 3//"),
    ] {
        let scene = assert_loads(&write("more.obj", format!("{corners}{face}\n")), 1, &[]);
        assert_eq!(scene.meshes, plain.meshes, "{corners}{face}");
    }
}

#[test]
fn what_is_no_face_is_left_out_and_told() {
    let elements = [
        ("l 1 2", "line elements (1)"),
        ("l 1/1 2/2", "line elements (1)"),
        // Of three points: no triangle.
        ("l 1 2 3\nl 3 1", "line elements (2)"),
        ("p 1\np 2 3", "point elements (2)"),
        ("f 1 2", "faces of fewer than three corners (1)"),
        ("curv2 1 2\nend", "free-form curves and surfaces (1)"),
    ];
    for (element, told) in elements {
        assert_loads(
            &write("element.obj", with(&format!("f 1 2 3\n{element}"))),
            1,
            &[told],
        );
        assert_refused(&write("alone.obj", with(element)), &format!("only {told}"));
    }
    assert_loads(
        &write("element.obj", with("f 1 2 3\ns off\nlod 1\n")),
        1,
        &[],
    );
    assert_refused(&write("empty.obj", ""), "it has no triangles");
    assert_refused(&write("points.obj", CORNERS), "it has no triangles");
}

/// Twice the area of each triangle, as seen from +z, negative where it faces away.
fn areas(mesh: &Mesh) -> Vec<f32> {
    let area = |t: [u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    mesh.triangles().map(area).collect()
}

#[test]
fn a_polygon_covers_what_its_outline_encloses() {
    // An L of area 3, begun where a fan would run outside of it; and with a point more on a side.
    let corners = "v 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nv 1 0 0\n";
    for (face, triangles) in [("f 1 2 3 4 5 6", 4), ("f 1 2 3 4 5 6 7", 5)] {
        let scene = assert_loads(
            &write("l.obj", format!("{corners}{face}\n")),
            triangles,
            &[],
        );
        let areas = areas(only(&scene));
        assert!(areas.iter().all(|area| *area >= 0.0), "{areas:?}");
        assert_eq!(areas.iter().sum::<f32>(), 6.0);
    }
    // The same as triangles of a fan: those cover more, and face both ways.
    let fan = "f 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 6\n";
    let scene = assert_loads(&write("fan.obj", format!("{corners}{fan}")), 4, &[]);
    assert!(areas(only(&scene)).iter().any(|area| *area < 0.0));
    // Seen from behind it turns the other way.
    let scene = assert_loads(
        &write("back.obj", format!("{corners}f 6 5 4 3 2 1\n")),
        4,
        &[],
    );
    assert!(areas(only(&scene)).iter().all(|area| *area <= 0.0));
}

#[test]
fn a_convex_polygon_is_the_fan_of_its_first_corner() {
    let corners = "v 0 0 0\nv 2 0 0\nv 3 1 1\nv 2 2 1\nv 0 2 0\n";
    let polygon = assert_loads(
        &write("five.obj", format!("{corners}f 1 2 3 4 5\n")),
        3,
        &[],
    );
    let fan = format!("{corners}f 1 2 3\nf 1 3 4\nf 1 4 5\n");
    let fan = assert_loads(&write("five.obj", fan), 3, &[]);
    assert_eq!(polygon.meshes, fan.meshes);
}

#[test]
fn an_outline_that_crosses_itself_is_told() {
    let corners = "v 0 0 0\nv 3 0 0\nv 0 2 0\nv 1 2 0\nv 1 1 0\n";
    let told = "outlines that cross themselves or have no area, filled as fans (1)";
    assert_loads(
        &write("bow.obj", format!("{corners}f 1 2 3 4\nf 1 2 4\n")),
        3,
        &[told],
    );
    assert_loads(
        &write("bow.obj", format!("{corners}f 1 2 4 3\nf 1 2 4\n")),
        3,
        &[],
    );
}

#[test]
fn indices_may_count_from_the_end() {
    let absolute = with("vn 0 0 1\nf 1//1 2//1 3//1\nv 5 5 5\n");
    let relative = with("vn 0 0 1\nf -3//-1 -2//-1 -1//-1\nv 5 5 5\n");
    let [absolute, relative] =
        [absolute, relative].map(|text| file(&write("sign.obj", text), false));
    assert_eq!(absolute.unwrap().meshes, relative.unwrap().meshes);
}

#[test]
fn a_bad_face_is_named_by_its_line() {
    for (face, reason) in [
        (
            "f 1 2 4",
            "line 4, \"f 1 2 4\": it asks for vertex 4, and there are 3",
        ),
        ("f 1 2 0", "line 4, \"f 1 2 0\": index 0"),
        ("f 1 2 -4", "line 4, \"f 1 2 -4\": index -4"),
        ("f 1 2 x", "\"x\" is not an index"),
        ("f 1 2 99999999999999999999", "is not an index"),
        ("f 1/1/1/1 2 3", "more than three indices"),
        (
            "vn 0 0 1\nf 1//1 2//1 3//2",
            "line 5, \"f 1//1 2//1 3//2\": it asks for normal 2",
        ),
        ("vn 0 0 1\nf 1//1 2//1 3//-2", "line 5"),
        (
            "\n# more\nf 1 2 \\\n\\\n3\n\nf 1 2 7",
            "line 10, \"f 1 2 7\"",
        ),
    ] {
        assert_refused(&write("face.obj", with(face)), reason);
    }
    let long = with(&format!("f 1 2 3{}", " 4".repeat(1000)));
    let line = super::refusal(&write("long.obj", long));
    assert!(
        line.contains("...\": it asks") && line.len() < 300,
        "{line}"
    );
    assert!(file(&write("right.obj", with("f 1 2 3")), true).is_ok());
    // Vertices that come later are there, too.
    assert_loads(&write("later.obj", format!("f 1 2 3\n{CORNERS}")), 1, &[]);
}

#[test]
fn numbers_that_are_none_are_named_by_their_line() {
    assert_refused(
        &write("word.obj", "v 0 zero 0\n"),
        "line 1, \"v 0 zero 0\": \"zero\" is not a number",
    );
    assert_refused(
        &write("two.obj", with("v 1 2")),
        "line 4, \"v 1 2\": three numbers",
    );
    for number in ["NaN", "inf", "-1e39"] {
        let broken = format!("v {number} 0 0");
        let used = with(&format!("{broken}\nf 1 2 3\nf 1 2 4"));
        let line = super::refusal(&write("broken.obj", used));
        assert!(
            line.contains("line 6") && line.contains("is not finite"),
            "{line}"
        );
        assert!(line.contains(&format!("line 4, \"{broken}\"")), "{line}");
        // Where no face asks for it, it is not there.
        assert_loads(
            &write("unused.obj", with(&format!("{broken}\nf 1 2 3"))),
            1,
            &[],
        );
    }
}

#[test]
fn models_without_extent_are_refused() {
    let point = "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n";
    assert_refused(&write("point.obj", point), "at one point");
    let huge = "v 3e38 0 0\nv -3e38 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_refused(&write("huge.obj", huge), "too large");
}
