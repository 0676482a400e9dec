//! Bad input: which receiver, which triangle, what to do.

use glam::{DAffine3, DVec3, Vec3};
use shadows::error::{LightError, LightMapError as E};
use shadows::reference::ReferenceScene;
use shadows::reference::bake::{
    BakeDescriptor, BakedLight, Emitter, LightMap, LightMapLayout, LightMapReceiver, TexelRectangle,
};
use shadows::{DirectionalLight, PointLight, glam};

const POSITIONS: [[f32; 3]; 4] = [[0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
const UVS: [[f32; 2]; 4] = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
const INDICES: [u32; 6] = [0, 1, 2, 0, 2, 3];

fn place(x: u32, width: u32) -> TexelRectangle {
    TexelRectangle {
        x,
        y: 0,
        width,
        height: 8,
    }
}

fn receiver() -> LightMapReceiver<'static> {
    LightMapReceiver {
        positions: &POSITIONS,
        indices: &INDICES,
        uvs: &UVS,
        transform: DAffine3::IDENTITY,
        rectangle: place(8, 8),
        two_sided: false,
    }
}

/// The error of a second receiver beside a sound one.
fn error(second: LightMapReceiver<'_>) -> E {
    let first = LightMapReceiver {
        rectangle: place(0, 8),
        ..receiver()
    };
    let told = LightMapLayout::new([16, 8], &[first, second]).unwrap_err();
    if !matches!(told, E::PlacesOverlap { .. }) {
        assert!(told.to_string().contains("receiver 1"), "{told}");
    }
    told
}

#[test]
fn sound_receivers_pass() {
    let first = LightMapReceiver {
        rectangle: place(0, 8),
        ..receiver()
    };
    let layout = LightMapLayout::new([16, 8], &[first, receiver()]).unwrap();
    assert_eq!(layout.covered_texels(), 16 * 8);
    // Two squares without a gap: what lies along their border is read by both.
    assert_eq!(layout.crowded_texels(), 2 * 8);
    let alone = LightMapLayout::new([16, 8], &[first]).unwrap();
    assert_eq!((alone.covered_texels(), alone.crowded_texels()), (8 * 8, 0));
    assert_eq!(
        LightMapLayout::new([1, 1], &[]).unwrap().covered_texels(),
        0
    );
}

#[test]
fn texture_coordinates_are_blamed_by_triangle() {
    let with = |uvs: &[[f32; 2]]| error(LightMapReceiver { uvs, ..receiver() });
    let moved = |vertex: usize, uv: [f32; 2]| {
        let mut uvs = UVS;
        uvs[vertex] = uv;
        with(&uvs)
    };
    assert_eq!(
        with(&[]),
        E::UvCount {
            receiver: 1,
            uvs: 0,
            vertices: 4
        }
    );
    for uv in [[1.0001, 0.0], [0.5, -1e-7], [f32::INFINITY, 0.0]] {
        let told = E::Uv {
            receiver: 1,
            triangle: 1,
            uv,
        };
        assert_eq!(moved(3, uv), told);
    }
    assert!(matches!(
        moved(1, [f32::NAN, 0.5]),
        E::Uv {
            receiver: 1,
            triangle: 0,
            ..
        }
    ));
    let told = E::UvNoArea {
        receiver: 1,
        triangle: 1,
    };
    assert_eq!(moved(3, [0.25, 0.25]), told);
    assert_eq!(moved(3, [0.0, 0.0]), told);
    // Folded over the diagonal.
    let told = E::UvOverlap {
        receiver: 1,
        triangles: [0, 1],
    };
    assert_eq!(moved(3, [0.1, 0.9]), told);
}

#[test]
fn triangles_that_nobody_sees_need_no_texture_coordinates() {
    let positions = [[0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.5, 0.0, 0.5]];
    let thin = LightMapReceiver {
        positions: &positions,
        uvs: &[[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [f32::NAN; 2]],
        ..receiver()
    };
    let layout = LightMapLayout::new([16, 8], &[thin]).unwrap();
    assert_eq!(layout.coverage().iter().sum::<f32>(), 32.0);
    // The twin: with an area it does.
    let positions = [[0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.5, 0.0, 0.4]];
    assert!(matches!(
        error(LightMapReceiver {
            positions: &positions,
            ..thin
        }),
        E::Uv { triangle: 1, .. }
    ));
}

#[test]
fn meshes_are_blamed_by_receiver() {
    let told = E::IndexCount {
        receiver: 1,
        count: 5,
    };
    let indices = &INDICES[..5];
    assert_eq!(
        error(LightMapReceiver {
            indices,
            ..receiver()
        }),
        told
    );
    let indices = &[0, 1, 2, 0, 2, 4];
    let told = E::IndexOutOfRange {
        receiver: 1,
        triangle: 1,
        index: 4,
        vertices: 4,
    };
    assert_eq!(
        error(LightMapReceiver {
            indices,
            ..receiver()
        }),
        told
    );
    let transform = DAffine3::from_translation(DVec3::new(0.0, f64::NAN, 0.0));
    let told = E::Position {
        receiver: 1,
        vertex: 0,
    };
    assert_eq!(
        error(LightMapReceiver {
            transform,
            ..receiver()
        }),
        told
    );
}

#[test]
fn places_in_the_map_are_checked() {
    for rectangle in [place(9, 8), place(8, 0), place(u32::MAX, 2)] {
        let told = E::Place {
            receiver: 1,
            rectangle,
            size: [16, 8],
        };
        assert_eq!(
            error(LightMapReceiver {
                rectangle,
                ..receiver()
            }),
            told
        );
    }
    let rectangle = place(7, 8);
    assert_eq!(
        error(LightMapReceiver {
            rectangle,
            ..receiver()
        }),
        E::PlacesOverlap { receivers: [0, 1] }
    );
    for size in [[0, 8], [8, 8193]] {
        assert_eq!(LightMapLayout::new(size, &[]).unwrap_err(), E::Size(size));
    }
}

#[test]
fn lights_and_samples_are_checked() {
    let scene = ReferenceScene::new(&[]).unwrap();
    let layout = LightMapLayout::new([16, 8], &[receiver()]).unwrap();
    let bake = |light: &BakedLight, samples| {
        let descriptor = BakeDescriptor {
            samples,
            ..Default::default()
        };
        scene.bake(&layout, light, &descriptor)
    };
    let lamp = BakedLight::new(PointLight::new(Vec3::Y, 10.0));
    let sun = BakedLight::new(DirectionalLight::new(Vec3::Y));
    assert_eq!(bake(&lamp, 0).unwrap_err(), E::Samples);
    let wrong = BakedLight::new(PointLight::new(Vec3::Y, 0.0));
    assert_eq!(
        bake(&wrong, 1).unwrap_err(),
        E::Light(LightError::Range(0.0))
    );
    for radius in [0.0, -1.0, f32::INFINITY] {
        let light = lamp.with_emitter(Emitter::Sphere { radius });
        assert_eq!(bake(&light, 1).unwrap_err(), E::Radius(radius));
    }
    let sides = |a, b| Emitter::Rectangle { half_sides: [a, b] };
    for (light, emitter, right) in [
        (lamp, sides(Vec3::X, Vec3::Z), true),
        (lamp, sides(Vec3::X, 2.0 * Vec3::X), false),
        (lamp, sides(Vec3::X, Vec3::NAN), false),
        (sun, sides(Vec3::X, Vec3::Z), false),
    ] {
        let baked = bake(&light.with_emitter(emitter), 1);
        let refused = matches!(baked, Err(E::Rectangle { .. }));
        assert_eq!((baked.is_ok(), refused), (right, !right));
    }
    let map = bake(&lamp, 1).unwrap();
    assert_eq!(LightMap::rgba8(&[]).unwrap_err(), E::Channels(0));
    assert_eq!(LightMap::rgba8(&[&map; 5]).unwrap_err(), E::Channels(5));
    let half = map.half().unwrap();
    let told = E::OtherSize([[16, 8], [8, 4]]);
    assert_eq!(LightMap::rgba8(&[&map, &half]).unwrap_err(), told);
}
