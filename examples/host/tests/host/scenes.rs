//! The built-in scenes and the file loader: what they hold, and that their meshes are sound.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use shadows::glam::{DVec3, Vec3, Vec4};

use host::ply;
use host::scene::plants::Leaves;
use host::scene::valley::valley_with;
use host::scene::{self, LightKind, Mesh, Scene, Time};

/// All built-in ones, the city by night as well.
fn all() -> Vec<Scene> {
    let mut all: Vec<Scene> = scene::NAMES
        .iter()
        .map(|name| scene::load(name, true, None).unwrap())
        .collect();
    all.push(scene::city(Time::Night));
    all
}

/// Leaves and blades of grass are sheets.
fn is_open(mesh: &Mesh) -> bool {
    ["leaves", "grass"].contains(&mesh.name.as_str())
}

/// A scene's meshes that cast.
fn casting(scene: &Scene) -> Vec<&Mesh> {
    let casts = |i: &usize| scene.objects.iter().any(|o| o.mesh == *i && o.casts);
    (0..scene.meshes.len())
        .filter(casts)
        .map(|i| &scene.meshes[i])
        .collect()
}

fn point(mesh: &Mesh, i: u32) -> DVec3 {
    Vec3::from(mesh.positions[i as usize]).as_dvec3()
}

/// Directed edges between places (not vertices: creases repeat those) whose opposite does not occur
/// exactly as often, or that occur more than once.
fn open_edges(mesh: &Mesh) -> usize {
    let place = |i: u32| mesh.positions[i as usize].map(|x| (x + 0.0).to_bits());
    let mut uses: HashMap<_, u32> = HashMap::new();
    for t in mesh.triangles() {
        for k in 0..3 {
            *uses
                .entry((place(t[k]), place(t[(k + 1) % 3])))
                .or_default() += 1;
        }
    }
    let paired = |(a, b): &(_, _)| uses.get(&(*b, *a)) == Some(&1);
    uses.iter().filter(|(e, n)| **n != 1 || !paired(e)).count()
}

/// Six times the volume is the sum of these determinants; positive when wound outward.
fn signed_volume(mesh: &Mesh) -> f64 {
    let det = |t: [u32; 3]| {
        let [a, b, c] = t.map(|i| point(mesh, i));
        a.dot(b.cross(c)) / 6.0
    };
    mesh.triangles().map(det).sum()
}

/// Corners whose normal is not a unit vector or lies on the inner side of its triangle.
fn bad_normals(mesh: &Mesh) -> usize {
    let mut bad = 0;
    for t in mesh.triangles() {
        let [a, b, c] = t.map(|i| point(mesh, i));
        let face = (b - a).cross(c - a).normalize_or_zero();
        for i in t {
            let n = Vec3::from(mesh.normals[i as usize]).as_dvec3();
            let unit = (n.length() - 1.0).abs() < 4.0 * f64::from(f32::EPSILON);
            bad += usize::from(!unit || n.dot(face) <= 0.0);
        }
    }
    bad
}

fn flipped(mesh: &Mesh) -> Mesh {
    let mut mesh = mesh.clone();
    for t in mesh.indices.chunks_exact_mut(3) {
        t.swap(1, 2);
    }
    mesh
}

#[test]
fn casting_meshes_are_closed_and_wound_outward() {
    for scene in all() {
        for mesh in casting(&scene) {
            if scene.name == "teapot" || is_open(mesh) {
                assert!(open_edges(mesh) > 0, "{} is known to be open", mesh.name);
                continue;
            }
            assert_eq!(open_edges(mesh), 0, "{} is not closed", mesh.name);
            assert!(signed_volume(mesh) > 0.0, "{} is inside out", mesh.name);

            // The same checks must notice a hole, one flipped triangle, and a mesh inside out.
            let mut broken = mesh.clone();
            broken.indices.truncate(mesh.indices.len() - 3);
            assert_eq!(open_edges(&broken), 3, "{}", mesh.name);
            let mut broken = mesh.clone();
            broken.indices.swap(0, 1);
            assert!(open_edges(&broken) > 0, "{}", mesh.name);
            assert!(signed_volume(&flipped(mesh)) < 0.0, "{}", mesh.name);
        }
    }
}

#[test]
fn normals_are_unit_and_on_the_outside() {
    for scene in all() {
        for mesh in &scene.meshes {
            assert_eq!(bad_normals(mesh), 0, "{} of {}", mesh.name, scene.name);
            let corners = mesh.indices.len();
            assert_eq!(bad_normals(&flipped(mesh)), corners, "{}", mesh.name);
        }
    }
}

#[test]
fn every_index_names_a_vertex_and_every_object_a_mesh() {
    for scene in all() {
        for mesh in &scene.meshes {
            assert_eq!(mesh.positions.len(), mesh.normals.len());
            let masked = mesh.mask.len();
            assert!(
                masked == 0 || masked == mesh.positions.len(),
                "{}",
                mesh.name
            );
            assert_eq!(mesh.indices.len() % 3, 0);
            let most = mesh.indices.iter().max().copied();
            assert_eq!(most, Some(mesh.positions.len() as u32 - 1), "{}", mesh.name);
        }
        for object in &scene.objects {
            assert!(object.mesh < scene.meshes.len());
            assert!(object.transform.matrix3.determinant() != 0.0);
        }
    }
}

#[test]
fn the_sphere_scene_is_the_published_one() {
    let scene = scene::spheres();
    let sphere = &scene.meshes[scene.objects[1].mesh];
    assert_eq!(
        (sphere.positions.len(), sphere.triangle_count()),
        (770, 1536)
    );
    assert_eq!(scene.objects.iter().filter(|o| o.casts).count(), 64);
    assert_eq!(scene.caster_triangle_count(), 64 * 1536);
    assert_eq!(scene.triangle_count(), 64 * 1536 + 2);
    assert_eq!(scene.light().place, Vec4::new(0.0, 4.0, 0.0, 1.0));

    // Sphere 5 by hand: r = 2 + 7 sqrt(5.5 / 64), theta = 5 golden angles, second height.
    let r = 2.0 + 7.0 * (5.5_f64 / 64.0).sqrt();
    let theta = 5.0 * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let centre = Vec3::from(scene.objects[6].transform.translation).as_dvec3();
    let expected = DVec3::new(r * theta.cos(), 1.25, r * theta.sin());
    assert!(centre.distance(expected) < 1e-6 * r, "{centre} {expected}");

    // Above every caster's silhouette from the light, as the scene promises for its +Y face.
    let reach = scene.caster_bounds();
    assert!(reach.max.y < f64::from(scene.light().place.y) && reach.min.y > 0.0);
}

#[test]
fn moving_spheres_start_where_they_stand_and_stay_above_the_ground() {
    assert_eq!(scene::spheres_moving(0.0), scene::spheres());
    for step in 1..50 {
        let moved = scene::spheres_moving(0.37 * f64::from(step));
        assert_ne!(moved, scene::spheres());
        assert!(moved.caster_bounds().min.y > 0.0);
    }
}

#[test]
fn scenes_are_the_same_each_time() {
    for name in scene::NAMES {
        let times = scene::times(name).iter().copied().map(Some);
        for time in times.chain([None]) {
            let [first, second] = [(); 2].map(|()| scene::load(name, true, time).unwrap());
            assert_eq!(first, second);
            assert_eq!(first.name, name);
        }
    }
    assert_ne!(
        scene::load("spheres", true, None).unwrap(),
        scene::courtyard()
    );
}

#[test]
fn the_courtyard_is_large_and_shares_its_meshes() {
    let scene = scene::courtyard();
    assert!(scene.caster_triangle_count() > 100_000);
    assert!(scene.meshes.len() < 20 && scene.objects.len() > 80);
    let turned = |o: &scene::Object| o.transform.matrix3.determinant() < 0.0;
    assert!(scene.objects.iter().any(turned), "none is mirrored");
    let ground = scene.objects.iter().find(|o| !o.casts).unwrap();
    let top = scene
        .world_points(ground)
        .map(|p| p.y)
        .fold(f64::MIN, f64::max);
    assert!(top.abs() < 1e-6);
}

/// How often a ray from the point upwards crosses the triangles, by sign: the winding number of
/// closed meshes, 0 outside all of them (Jacobson et al. 2013).
fn winding(scene: &Scene, from: DVec3) -> i32 {
    let mut sum = 0;
    for object in &scene.objects {
        let mesh = &scene.meshes[object.mesh];
        let flip = object.transform.matrix3.determinant() < 0.0;
        let world: Vec<DVec3> = scene.world_points(object).map(|p| p - from).collect();
        for t in mesh.triangles() {
            let [a, b, c] = t.map(|i| world[i as usize]);
            let side = |p: DVec3, q: DVec3| p.x * q.z - p.z * q.x;
            let around = [side(a, b), side(b, c), side(c, a)];
            let all = |s: f64| around.iter().all(|x| x * s > 0.0);
            let crossing: f64 = around.iter().sum();
            let height = (a.y * around[1] + b.y * around[2] + c.y * around[0]) / crossing;
            if (all(1.0) || all(-1.0)) && height > 0.0 {
                sum += if all(-1.0) == flip { -1 } else { 1 };
            }
        }
    }
    sum
}

#[test]
fn light_and_camera_are_outside_all_casters() {
    for mut scene in [
        scene::spheres(),
        scene::courtyard(),
        scene::city(Time::Night),
    ] {
        // Leaves have no inside.
        scene.objects.retain(|object| object.casts);
        for light in scene.lights.iter().step_by(scene.lights.len().div_ceil(12)) {
            let light = light.place.truncate().as_dvec3();
            assert_eq!(
                winding(&scene, light),
                0,
                "{}: light at {light}",
                scene.name
            );
        }
        let eye = scene.camera.eye.as_dvec3();
        assert_eq!(winding(&scene, eye), 0, "{}: camera", scene.name);

        // A point that is inside: just off the middle of the first object that casts.
        let object = scene.objects.iter().find(|o| o.casts).unwrap();
        let points = scene.world_points(object).collect::<Vec<_>>();
        let middle = points.iter().sum::<DVec3>() / points.len() as f64;
        let inside = middle + DVec3::new(0.0123, 0.0077, 0.0059);
        assert_ne!(winding(&scene, inside), 0, "{}: inside", scene.name);
    }
}

#[test]
fn links_interlock_without_touching() {
    let scene = scene::courtyard();
    let links = scene.objects.iter().filter(|o| o.name.starts_with("link"));
    let links: Vec<_> = links.collect();
    let pitch: Vec<f64> = links
        .windows(2)
        .map(|w| {
            w[0].transform
                .translation
                .distance(w[1].transform.translation)
        })
        .map(f64::from)
        .collect();
    let radius = |section: f64| 1.45 * (0.085 + section * 0.022);
    // Neighbours of one chain; the steps from one chain to the next are longer.
    let near: Vec<_> = pitch.iter().filter(|p| **p < 2.0 * radius(1.0)).collect();
    assert_eq!(near.len() + 4, links.len(), "four chains");
    for p in near {
        assert!(
            *p < 2.0 * radius(-1.0),
            "{p}: the links would run through each other"
        );
        assert!(
            *p > radius(1.0),
            "{p}: a link would touch the one after the next"
        );
    }
}

#[test]
fn the_teapot_has_its_published_bounds() {
    let teapot = scene::teapot::teapot_mesh(16);
    let bounds = scene::Bounds::of(teapot.positions.iter().map(|p| Vec3::from(*p).as_dvec3()));
    // 3.434 is where the spout's lip reaches, by the tessellation within a thousandth.
    let expected = [(-3.0, 3.434), (0.0, 3.15), (-2.0, 2.0)];
    for (axis, (low, high)) in expected.into_iter().enumerate() {
        assert!((bounds.min[axis] - low).abs() < 1e-3, "{bounds:?}");
        assert!((bounds.max[axis] - high).abs() < 1e-3, "{bounds:?}");
    }
    assert!(signed_volume(&teapot) > 0.0);
    assert!(open_edges(&teapot) > 0, "the teapot is known to be open");
    // 32 patches of 16 x 16 quads, less one triangle per piece around each of the two poles.
    assert_eq!(teapot.triangle_count(), 32 * 16 * 16 * 2 - 2 * 4 * 16);
}

#[test]
fn the_teapot_is_open_only_at_the_edges_of_its_parts() {
    // 4 quarters around the rim and 4 around the lid; 2 halves at each end of handle and spout.
    for pieces in [4, 16] {
        let boundary = open_edges(&scene::teapot::teapot_mesh(pieces));
        assert_eq!(boundary, pieces as usize * (4 + 4 + 2 * 2 + 2 * 2));
    }
}

#[test]
fn the_teapots_normals_are_those_of_a_finer_one() {
    // The difference to the faces' normals falls with the pieces; it would not with wrong normals.
    let worst = |pieces: u32| {
        let mesh = scene::teapot::teapot_mesh(pieces);
        let mut least: f64 = 1.0;
        for t in mesh.triangles() {
            let [a, b, c] = t.map(|i| point(&mesh, i));
            let face = (b - a).cross(c - a).normalize();
            for i in t {
                least = least.min(face.dot(Vec3::from(mesh.normals[i as usize]).as_dvec3()));
            }
        }
        least.acos()
    };
    assert!(worst(48) < 0.5 * worst(16), "{} {}", worst(48), worst(16));
}

#[test]
fn clip_space_is_reverse_z_with_the_target_in_the_middle() {
    let camera = scene::courtyard().camera;
    let clip = camera.clip_from_world(16.0 / 9.0);
    let target = clip * camera.target.extend(1.0);
    let tolerance = 8.0 * f32::EPSILON * target.w;
    assert!(target.x.abs() < tolerance && target.y.abs() < tolerance);
    let way = (camera.target - camera.eye).normalize();
    let near = clip * (camera.eye + way * camera.near).extend(1.0);
    assert!((near.z / near.w - 1.0).abs() < 1e-4);
    let direction = clip * way.extend(0.0);
    assert_eq!(direction.z, 0.0, "points at infinity lie at depth 0");
}

#[test]
fn overrides_replace_only_what_is_given() {
    let mut scene = scene::spheres();
    scene.override_with(None, None, None);
    assert_eq!(scene, scene::spheres());
    let light = Vec4::new(1.0, 2.0, 3.0, 0.0);
    scene.override_with(Some(light), Some(7.0), Some((Vec3::ONE, Vec3::ZERO, None)));
    assert_eq!((scene.light().place, scene.light().range), (light, 7.0));
    assert_eq!(scene.camera.fovy, scene::spheres().camera.fovy);
    scene.override_with(None, None, Some((Vec3::X, Vec3::ZERO, Some(1.0))));
    assert_eq!((scene.camera.eye, scene.camera.fovy), (Vec3::X, 1.0));
}

#[test]
fn ply_holds_every_vertex_and_triangle_in_world_space() {
    let mut scene = scene::spheres();
    let mirror = shadows::glam::Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    scene.objects.truncate(4);
    scene.objects[2].transform = mirror;
    let path = temporary("spheres.ply");
    ply::write_ply(&path, &scene).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let end = b"end_header\n";
    let header = bytes.windows(end.len()).position(|w| w == end).unwrap() + end.len();
    let text = std::str::from_utf8(&bytes[..header]).unwrap();
    let (vertices, faces) = (4 + 3 * 770, 2 + 3 * 1536);
    assert!(text.starts_with("ply\nformat binary_little_endian 1.0\n"));
    assert!(text.contains(&format!("element vertex {vertices}\nproperty double x\n")));
    assert!(text.contains(&format!("element face {faces}\n")));
    assert_eq!(
        bytes.len(),
        header + vertices * 24 + faces * (1 + 12 + 4 + 1)
    );

    let double = |i: usize| f64::from_le_bytes(bytes[header + 8 * i..][..8].try_into().unwrap());
    let second = scene.world_points(&scene.objects[1]).nth(3).unwrap();
    let read = 3 * (4 + 3);
    assert_eq!([0, 1, 2].map(|k| double(read + k)), second.to_array());

    // The second sphere is mirrored; its first triangle, turned round, still faces outward.
    let face = header + vertices * 24 + (2 + 1536) * 18;
    let index = |k: usize| u32::from_le_bytes(bytes[face + 1 + 4 * k..][..4].try_into().unwrap());
    let corners = [0, 1, 2].map(|k| {
        let i = 3 * index(k) as usize;
        DVec3::new(double(i), double(i + 1), double(i + 2))
    });
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    assert!(normal.dot(corners[0]) > 0.0);
    assert_eq!(bytes[face + 13..face + 18], [2, 0, 0, 0, 1]);
    assert_eq!(
        bytes[header + vertices * 24 + 17],
        0,
        "the ground does not cast"
    );
}

/// A file of this name in a folder of this test run.
fn temporary(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join("scenes");
    std::fs::create_dir_all(&dir).unwrap();
    dir.join(name)
}

#[test]
fn the_city_is_many_casters_of_a_few_meshes() {
    let day = scene::city(Time::Day);
    let casters = day.objects.iter().filter(|object| object.casts).count();
    assert!((1_600..2_300).contains(&casters), "{casters} casters");
    assert!(day.meshes.len() < 100, "{} meshes", day.meshes.len());
    let triangles = day.caster_triangle_count();
    assert!(
        (200_000..600_000).contains(&triangles),
        "{triangles} triangles"
    );
    assert_eq!(day.lights.len(), 1);
    assert_eq!(day.light().kind(), LightKind::Directional);
    assert!(day.objects.iter().all(|object| object.glow == [0.0; 3]));
    // By night it is the same town, and rooms are lit.
    let night = scene::city(Time::Night);
    assert_eq!(night.meshes, day.meshes);
    let places = |scene: &Scene| -> Vec<_> {
        scene
            .objects
            .iter()
            .map(|o| (o.mesh, o.transform))
            .collect()
    };
    assert_eq!(places(&night), places(&day));
    assert!(night.objects.iter().any(|object| object.glow != [0.0; 3]));
}

#[test]
fn a_thousand_lights_of_mixed_kinds_are_lit_by_night_lamps_near_the_eye_first() {
    let night = scene::city(Time::Night);
    assert_eq!(night.lights.len(), 1_000);
    let eye = night.camera.eye;
    for lamp in &night.lights[..16] {
        assert_eq!(lamp.kind(), LightKind::Point);
        assert!(lamp.place.truncate().distance(eye) < 60.0);
    }
    let of = |kind| {
        night
            .lights
            .iter()
            .filter(|light| light.kind() == kind)
            .count()
    };
    let [points, spots] = [of(LightKind::Point), of(LightKind::Spot)];
    assert!(
        points > 200 && spots > 200,
        "{points} points, {spots} spots"
    );
    assert_eq!(points + spots, 1_000);
    let mut ranges: Vec<f32> = night.lights.iter().map(|light| light.range).collect();
    ranges.sort_by(f32::total_cmp);
    ranges.dedup();
    assert!(ranges.len() >= 4, "ranges {ranges:?}");
    let far = night
        .lights
        .iter()
        .map(|light| light.place.truncate().distance(eye));
    assert!(far.fold(0.0, f32::max) > 120.0);
    // No two at one place.
    let mut places: Vec<[u32; 3]> = night
        .lights
        .iter()
        .map(|light| light.place.truncate().to_array().map(f32::to_bits))
        .collect();
    places.sort_unstable();
    places.dedup();
    assert_eq!(places.len(), 1_000);
}

#[test]
fn the_valley_is_a_kilometre_of_land_whose_blocks_share_their_edges() {
    let valley = scene::valley();
    let land: Vec<&Mesh> = valley
        .meshes
        .iter()
        .filter(|mesh| mesh.name.starts_with("ground"))
        .collect();
    let points = land.iter().flat_map(|mesh| &mesh.positions);
    let bounds = scene::Bounds::of(points.map(|p| Vec3::from(*p).as_dvec3()));
    assert_eq!((bounds.size().x, bounds.size().z), (1000.0, 1000.0));
    // Every corner of the surface inside the land's outline belongs to the surface all around.
    let place = |mesh: &Mesh, i: u32| mesh.positions[i as usize].map(f32::to_bits);
    let mut uses: HashMap<_, i32> = HashMap::new();
    for mesh in &land {
        for t in mesh.triangles() {
            let up = t.iter().all(|i| mesh.normals[*i as usize][1] > 0.0);
            for k in 0..if up { 3 } else { 0 } {
                let (a, b) = (place(mesh, t[k]), place(mesh, t[(k + 1) % 3]));
                *uses.entry((a, b)).or_default() += 1;
                *uses.entry((b, a)).or_default() -= 1;
            }
        }
    }
    let half = 500.0_f32;
    let outline = |p: &[u32; 3]| {
        let [x, _, z] = p.map(f32::from_bits);
        x.abs() == half || z.abs() == half
    };
    let open = uses.iter().filter(|(_, n)| **n != 0);
    let inner = open
        .clone()
        .filter(|((a, b), _)| !(outline(a) && outline(b)));
    assert_eq!(inner.count(), 0);
    assert!(open.count() > 400, "the outline itself is open");
}

#[test]
fn leaves_are_of_one_kind_and_everything_else_of_the_valley_is_the_same() {
    let [solid, masked] = [Leaves::Solid, Leaves::Masked].map(valley_with);
    assert!(solid.meshes.iter().all(|mesh| mesh.mask.is_empty()));
    let mut crowns = 0;
    for (a, b) in solid.meshes.iter().zip(&masked.meshes) {
        match a.name.as_str() {
            "leaves" => {
                crowns += 1;
                assert_eq!(b.mask.len(), b.positions.len());
            }
            _ => assert_eq!(a, b),
        }
    }
    assert!(crowns >= 8);
    assert_eq!(solid.objects, masked.objects);
    let casters = solid.objects.iter().filter(|object| object.casts).count();
    assert!(casters > 1_000, "{casters} casters");
    let triangles = solid.caster_triangle_count();
    assert!(
        (200_000..600_000).contains(&triangles),
        "{triangles} triangles"
    );
}
