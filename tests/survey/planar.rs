//! Planar shadows: exact on their planes, and nowhere else.

use host::gpu::Gpu;
use host::shapes;
use shadows::error::PlanarRenderError;
use shadows::glam::{Affine3A, Quat, Vec3};
use shadows::{
    Caster, DepthConvention, DirectionalLight, HostInstances, HostMesh, InstanceLayout, Light,
    PlanarFrame, PlanarLight, PlanarShadow, PlanarStatistics, PointLight, SpotLight, wgpu,
};
use wgpu::util::DeviceExt as _;

use crate::planar_host::{Body, FIXED, FLOAT, Found, Stage, Told, at, caster};

fn lamp() -> PointLight {
    PointLight::new(Vec3::new(-1.5, 6.0, 2.0), 40.0)
}

fn sun() -> DirectionalLight {
    DirectionalLight::new(Vec3::new(-0.4, 1.0, 0.3))
}

fn spot() -> SpotLight {
    let position = lamp().position;
    SpotLight::new(position, Vec3::new(0.3, -1.0, -0.35), 0.6, 40.0)
}

fn lights() -> [Light; 3] {
    [lamp().into(), sun().into(), spot().into()]
}

/// Closed and open, resting and in the air, mirrored and flattened.
fn things() -> Vec<Body> {
    let turned = |scale, place| {
        Affine3A::from_scale_rotation_translation(scale, Quat::from_rotation_y(0.5), place)
    };
    vec![
        caster(
            shapes::cube(),
            turned(Vec3::splat(0.6), Vec3::new(-1.6, 0.6, 0.4)),
        ),
        caster(
            shapes::sphere(10),
            turned(Vec3::new(-0.7, 0.6, 0.7), Vec3::new(1.2, 1.7, -0.5)),
        ),
        caster(shapes::fins(3), at(1.8, 0.0, 1.8)),
        caster(
            shapes::cube().tilted(),
            turned(Vec3::new(0.7, 0.0, 0.7), Vec3::new(-0.5, 2.0, -2.0)),
        ),
    ]
}

fn found(gpu: &Gpu, stage: &Stage) -> Found {
    stage.judge(&stage.truth(), &stage.draw(gpu))
}

#[track_caller]
fn assert_exact(gpu: &Gpu, stage: &Stage, what: &str) {
    let found = found(gpu, stage);
    assert!(found.lit > 300 && found.shadowed > 300, "{what}: {found:?}");
    assert_eq!(found.wrong, 0, "{what}: {found:?}");
}

#[test]
fn shadows_are_exact_under_every_light_and_either_outline() {
    let Some(gpu) = Gpu::for_test() else { return };
    for light in lights() {
        for told in [Told::Stencil, Told::Polygon] {
            let stage = Stage {
                told,
                ..Stage::new(light, things())
            };
            assert_exact(&gpu, &stage, &format!("{told:?} {light:?}"));
        }
        // The twin: the light is not where the library is told.
        let mut stage = Stage::new(light, things());
        let truth = stage.truth();
        match &mut stage.light {
            Light::Point(light) => light.position.x += 0.2,
            Light::Spot(light) => light.position.x += 0.2,
            Light::Directional(light) => light.toward_light.x += 0.3,
            _ => unreachable!(),
        }
        assert!(
            stage.judge(&truth, &stage.draw(&gpu)).wrong > 0,
            "{light:?}"
        );
    }
}

#[test]
fn every_depth_convention_format_and_sample_count_agrees() {
    let Some(gpu) = Gpu::for_test() else { return };
    for (depth, orthographic) in [
        (DepthConvention::InfiniteReverse, false),
        (DepthConvention::FiniteReverse, false),
        (DepthConvention::Standard, false),
        (DepthConvention::FiniteReverse, true),
        (DepthConvention::Standard, true),
    ] {
        for (format, samples) in [(FLOAT, 1), (FLOAT, 4), (FIXED, 1)] {
            if !gpu.device.features().contains(format.required_features()) {
                continue;
            }
            let stage = Stage {
                told: Told::Polygon,
                depth,
                format,
                samples,
                orthographic,
                ..Stage::new(lamp(), things())
            };
            let what = format!("{depth:?} {format:?} {samples} {orthographic}");
            assert_exact(&gpu, &stage, &what);
        }
    }
}

#[test]
fn scale_does_not_matter() {
    let Some(gpu) = Gpu::for_test() else { return };
    for light in [lamp().into(), Light::from(sun())] {
        let one = Stage {
            told: Told::Polygon,
            ..Stage::new(light, things())
        };
        for scale in [1e-4, 0.01, 100.0, 1e5] {
            assert_exact(
                &gpu,
                &one.clone().scaled(scale),
                &format!("{light:?} {scale}"),
            );
        }
    }
}

/// Runs with the shaders as they would be without what cuts off.
pub fn uncut<T>(work: impl FnOnce() -> T) -> T {
    struct Restore;
    impl Drop for Restore {
        fn drop(&mut self) {
            shadows::rewriting::set(None);
        }
    }
    let _restore = Restore;
    shadows::rewriting::set(Some(Box::new(|wgsl| {
        wgsl.replace("shadow.w < 0.0 || shadow.z <= 0.0", "shadow.z == 12345.0")
    })));
    work()
}

#[test]
fn what_is_behind_the_plane_casts_nothing_on_it() {
    let Some(gpu) = Gpu::for_test() else { return };
    // A pole through the ground, in the open, and one that is wholly below it. The ground is seen beside them.
    let pole = |x, y, z| {
        let scale = Vec3::new(0.6, 2.5, 0.6);
        Affine3A::from_scale_rotation_translation(
            scale,
            Quat::from_rotation_z(-0.5),
            Vec3::new(x, y, z),
        )
    };
    for light in lights() {
        let casters = vec![
            caster(shapes::cube(), pole(0.5, 0.4, 0.3)),
            caster(shapes::cube(), pole(-1.0, -4.0, 0.0)),
        ];
        let mut stage = Stage::new(light, casters);
        stage.told = Told::Polygon;
        let right = found(&gpu, &stage);
        assert!(
            right.shadowed > 100 && right.wrong == 0,
            "{light:?}: {right:?}"
        );
        let anti = uncut(|| found(&gpu, &stage));
        assert!(anti.wrong > 50, "{light:?}: an anti-shadow, {anti:?}");
    }
}

#[test]
fn what_is_as_high_as_the_light_or_higher_casts_nothing() {
    let Some(gpu) = Gpu::for_test() else { return };
    // A slab beside the lamp that reaches from below it to above it, a ball above it, and a ball below.
    let slab = Affine3A::from_scale_rotation_translation(
        Vec3::new(0.2, 2.0, 0.8),
        Quat::from_rotation_z(0.3),
        Vec3::new(0.5, 2.6, -0.5),
    );
    let casters = vec![
        caster(shapes::cube(), slab),
        caster(shapes::sphere(8), at(-1.5, 7.0, 2.0)),
        caster(shapes::sphere(8), at(-2.6, 1.2, -0.5)),
    ];
    let low = PointLight::new(Vec3::new(-1.2, 3.0, 0.6), 40.0);
    for told in [Told::Stencil, Told::Polygon] {
        // From far behind what the shadow runs to, so that its other end is behind the camera.
        let stage = Stage {
            told,
            ..Stage::new(low, casters.clone())
        };
        assert_exact(&gpu, &stage, &format!("{told:?}"));
    }
    let mut planar = PlanarShadow::new(&gpu.device, &Stage::new(low, vec![]).descriptor()).unwrap();
    let stage = Stage::new(low, casters);
    stage.prepare(&gpu, &mut planar, &stage.casters(&gpu));
    let counted = planar.statistics();
    let counts = [
        counted.casters_drawn,
        counted.casters_cut,
        counted.casters_behind,
    ];
    assert_eq!(counts, [2, 1, 1], "{counted:?}");
}

#[test]
fn nothing_falls_beyond_the_outline() {
    let Some(gpu) = Gpu::for_test() else { return };
    for told in [Told::Stencil, Told::Polygon] {
        // A small table that receives, over a floor that does not, and casts nothing.
        let thing = caster(
            shapes::cube(),
            at(1.2, 2.0, 0.1) * Affine3A::from_scale(Vec3::splat(0.5)),
        );
        let mut stage = Stage::new(sun(), vec![thing]);
        stage.told = told;
        stage.grounds.clear();
        stage.bodies[1].mark = 0;
        stage.add_ground(1.0, at(0.8, 1.0, -0.1));
        let inside = |stage: &Stage| {
            let truth = stage.truth();
            let picture = stage.draw(&gpu);
            let found = stage.judge(&truth, &picture);
            let pixels = (0..).zip(truth.classes().zip(&picture));
            // Of the floor, everything is lit that is seen.
            let beyond = pixels.filter(|&(pixel, (_, value))| {
                let hit = truth.hit(pixel % stage.side, pixel / stage.side);
                *value == 0 && hit.is_some_and(|hit| hit.object == 1)
            });
            (found, beyond.count())
        };
        let (found, beyond) = inside(&stage);
        assert!(
            found.shadowed > 50 && found.wrong == 0,
            "{told:?} {found:?}"
        );
        assert_eq!(beyond, 0, "{told:?}");
        // The twin: the outline is said to be larger than it is.
        let mut wide = stage.clone();
        match told {
            Told::Stencil => wide.bodies[1].mark = 1,
            Told::Polygon => {
                // A floor in the plane itself.
                wide.bodies[1].transform = at(0.0, 1.0, 0.0);
                let centre = Vec3::new(0.8, 1.0, -0.1);
                for corner in &mut wide.grounds[0].corners {
                    *corner = centre + 5.0 * (*corner - centre);
                }
            }
        }
        assert!(inside(&wide).1 > 50, "{told:?}");
    }
}

#[test]
fn an_outline_may_have_any_form() {
    let Some(gpu) = Gpu::for_test() else { return };
    // A star of which the tips receive and the middle, by the even-odd rule, does not.
    let star: Vec<Vec3> = (0..5)
        .map(|tip| {
            let (x, z) = (std::f32::consts::TAU * 0.4 * tip as f32).sin_cos();
            Vec3::new(4.0 * x, 0.0, 4.0 * z)
        })
        .collect();
    let roof = caster(shapes::square(30.0), at(0.0, 20.0, 0.0));
    let high = PointLight::new(Vec3::new(0.0, 30.0, 0.0), 100.0);
    let mut stage = Stage::new(high, vec![roof]);
    stage.told = Told::Polygon;
    stage.grounds[0].corners = star;
    let picture = stage.draw(&gpu);
    let truth = stage.truth();
    let dark = |x: f64, z: f64| {
        let clip =
            stage.view().clip_from_world().as_dmat4() * shadows::glam::DVec4::new(x, 0.0, z, 1.0);
        let pixel = |at: f64| ((0.5 + 0.5 * at / clip.w) * f64::from(stage.side)) as usize;
        let (column, row) = (pixel(clip.x), pixel(-clip.y));
        assert!(truth.hit(column as u32, row as u32).is_some());
        picture[row * stage.side as usize + column] == 0
    };
    assert!(dark(0.0, 3.2) && dark(3.0, 1.0), "the tips");
    assert!(
        !dark(0.0, 0.0) && !dark(0.0, -3.2),
        "the middle, and outside"
    );
}

#[test]
fn a_plane_does_not_fight_with_the_surface_that_lies_in_it() {
    let Some(gpu) = Gpu::for_test() else { return };
    let turn = Quat::from_axis_angle(Vec3::new(1.0, 0.4, -0.7).normalize(), 0.35);
    let mut fought = 0;
    for premultiplied in [false, true] {
        let mut stage = Stage::new(lamp(), things()[1..2].to_vec());
        stage.grounds.clear();
        stage.bodies.pop();
        stage.told = Told::Polygon;
        stage.premultiplied = premultiplied;
        stage.add_ground(
            6.0,
            Affine3A::from_rotation_translation(turn, Vec3::new(0.3, -0.7, 0.2)),
        );
        assert_exact(&gpu, &stage, &format!("premultiplied: {premultiplied}"));
        stage.bias = Some([0.0, 0.0]);
        fought += found(&gpu, &stage).wrong;
    }
    assert!(fought > 0, "the bias has nothing to do here");
}

#[test]
fn nothing_is_darkened_twice() {
    let Some(gpu) = Gpu::for_test() else { return };
    let ball = |x, y| caster(shapes::sphere(8), at(x, y, 0.0));
    // Shadows that overlap, each of a mesh that covers itself twice.
    let stage = Stage::new(sun(), vec![ball(0.0, 1.5), ball(0.8, 1.4)]);
    let light = PlanarLight {
        shade: [0.4; 3],
        ..PlanarLight::new(sun())
    };
    let values = |picture: Vec<u8>| {
        let mut values = picture;
        values.sort_unstable();
        values.dedup();
        values
    };
    assert_eq!(values(stage.darken(&gpu, &[light], false)), [102, 255]);
    // The twin: where the stencil is set back between them, both darken.
    assert_eq!(values(stage.darken(&gpu, &[light], true)), [41, 102, 255]);
    // Two lights darken each by its own shade.
    let other = PlanarLight {
        shade: [0.8; 3],
        ..PlanarLight::new(PointLight::new(Vec3::new(3.0, 6.0, -1.0), 40.0))
    };
    let both = values(stage.darken(&gpu, &[light, other], false));
    assert_eq!(both, [82, 102, 204, 255]);
}

#[test]
fn where_a_light_does_not_reach_nothing_is_darkened() {
    let Some(gpu) = Gpu::for_test() else { return };
    let narrow = SpotLight {
        half_angle: 0.35,
        ..spot()
    };
    let short = PointLight {
        range: 6.4,
        ..lamp()
    };
    for (light, all_around) in [
        (Light::from(narrow), Light::from(lamp())),
        (short.into(), lamp().into()),
    ] {
        let stage = Stage::new(light, things());
        let truth = stage.truth();
        let dark = |light: Light| {
            let light = PlanarLight {
                shade: [0.0; 3],
                ..PlanarLight::new(light)
            };
            let picture = stage.darken(&gpu, &[light], false);
            let classes = truth.classes().zip(picture);
            let beyond = classes.filter(|&(class, value)| {
                class == shadows::reference::Class::OutOfRange && value == 0
            });
            beyond.count()
        };
        let edge = 2 * stage.side as usize / 10;
        assert!(dark(light) < edge, "{light:?}: {}", dark(light));
        assert!(dark(all_around) > 5 * edge, "{light:?}: the twin");
        assert_eq!(found(&gpu, &stage).wrong, 0, "{light:?}");
    }
}

#[test]
fn a_light_in_the_plane_or_behind_it_casts_nothing() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = |light: Light| Stage::new(light, things());
    for (light, behind) in [
        (PointLight::new(Vec3::new(3.0, -2.0, 0.0), 40.0).into(), 1),
        (PointLight::new(Vec3::new(3.0, 0.0, 0.0), 40.0).into(), 1),
        (DirectionalLight::new(Vec3::new(1.0, 0.0, 0.2)).into(), 1),
        (DirectionalLight::new(Vec3::new(1.0, -0.5, 0.2)).into(), 1),
        (Light::from(lamp()), 0),
    ] {
        let stage = stage(light);
        let mut planar = PlanarShadow::new(&gpu.device, &stage.descriptor()).unwrap();
        let picture = stage.draw_with(&gpu, &mut planar, &stage.casters(&gpu));
        assert_eq!(planar.statistics().lights_behind, behind, "{light:?}");
        assert_eq!(picture.contains(&0), behind == 0, "{light:?}");
        assert_eq!(stage.judge(&stage.truth(), &picture).wrong, 0, "{light:?}");
    }
}

#[test]
fn several_planes_receive_each_its_own() {
    let Some(gpu) = Gpu::for_test() else { return };
    for told in [Told::Stencil, Told::Polygon] {
        let thing = caster(shapes::sphere(10), at(-0.5, 1.2, -0.5));
        let corner = PointLight::new(Vec3::new(2.5, 4.0, 3.0), 40.0);
        let mut stage = Stage::new(corner, vec![thing]);
        stage.told = told;
        // A wall at the back, and a ramp.
        let wall = Quat::from_rotation_x(std::f32::consts::FRAC_PI_2);
        stage.add_ground(
            6.0,
            Affine3A::from_rotation_translation(wall, Vec3::new(0.0, 0.0, -2.5)),
        );
        let ramp = Quat::from_rotation_z(-0.6);
        stage.add_ground(
            1.5,
            Affine3A::from_rotation_translation(ramp, Vec3::new(-3.2, 0.5, -0.8)),
        );
        assert_exact(&gpu, &stage, &format!("{told:?}"));
        // The twin: a plane is forgotten.
        let truth = stage.truth();
        let mut planar = PlanarShadow::new(&gpu.device, &stage.descriptor()).unwrap();
        let mut fewer = stage.clone();
        fewer.grounds.pop();
        fewer.grounds.pop();
        let picture = fewer.draw_with(&gpu, &mut planar, &stage.casters(&gpu));
        assert!(stage.judge(&truth, &picture).wrong > 0, "{told:?}");
    }
}

#[test]
fn meshes_in_buffers_of_the_host_cast_like_others() {
    let Some(gpu) = Gpu::for_test() else { return };
    let shape = shapes::cube().tilted();
    let places = [at(-1.5, 0.9, 0.0), at(1.5, 1.8, -1.0), at(0.3, 1.1, 2.0)];
    let small = Affine3A::from_scale(Vec3::splat(0.5));
    let bodies = places.map(|place| caster(shape.clone(), place * small));
    let stage = Stage::new(lamp(), bodies.to_vec());
    let buffer = |contents: &[u8], usage| {
        let descriptor = wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage,
        };
        gpu.device.create_buffer_init(&descriptor)
    };
    let vertices = buffer(
        bytemuck::cast_slice(&shape.positions),
        wgpu::BufferUsages::VERTEX,
    );
    let indices = buffer(
        bytemuck::cast_slice(&shape.indices),
        wgpu::BufferUsages::INDEX,
    );
    let points =
        |positions: &[[f32; 3]]| positions.iter().map(|&p| Vec3::from(p)).collect::<Vec<_>>();
    let mesh = HostMesh {
        vertices: &vertices,
        stride: 12,
        offset: 0,
        indices: &indices,
        index_format: wgpu::IndexFormat::Uint32,
        index_offset: 0,
        index_count: shape.indices.len() as u32,
        bounds: shadows::mesh::Bounds::of_points(points(&shape.positions)).unwrap(),
    };
    let mesh = shadows::CasterMesh::from_host(&gpu.device, &mesh).unwrap();
    let all = shadows::mesh::Bounds {
        min: Vec3::splat(-4.0),
        max: Vec3::splat(4.0),
    };
    for layout in [InstanceLayout::Columns4x4, InstanceLayout::Rows3x4] {
        let words: Vec<f32> = bodies
            .iter()
            .flat_map(|body| {
                let columns = shadows::glam::Mat4::from(body.transform);
                match layout {
                    InstanceLayout::Columns4x4 => columns.to_cols_array().to_vec(),
                    _ => columns.transpose().to_cols_array()[..12].to_vec(),
                }
            })
            .collect();
        let transforms = buffer(bytemuck::cast_slice(&words), wgpu::BufferUsages::VERTEX);
        let instances = HostInstances {
            buffer: &transforms,
            layout,
            stride: (words.len() / 3 * 4) as u64,
            offset: 0,
            count: 3,
            bounds: all,
        };
        let forest = mesh.at_places(&instances).unwrap();
        let casters = [Caster::new(forest, Affine3A::IDENTITY)];
        let mut planar = PlanarShadow::new(&gpu.device, &stage.descriptor()).unwrap();
        let picture = stage.draw_with(&gpu, &mut planar, &casters);
        let found = stage.judge(&stage.truth(), &picture);
        assert!(
            found.shadowed > 300 && found.wrong == 0,
            "{layout:?} {found:?}"
        );
    }
}

#[test]
fn only_what_moved_is_uploaded() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut stage = Stage::new(lamp(), things());
    stage.told = Told::Polygon;
    let mut casters = stage.casters(&gpu);
    let mut planar = PlanarShadow::new(&gpu.device, &stage.descriptor()).unwrap();
    let first = stage.draw_with(&gpu, &mut planar, &casters);
    let uploaded = |planar: &PlanarShadow| planar.statistics().uploaded;
    assert!(uploaded(&planar) >= 4 * 48 + 112);
    assert_eq!(stage.draw_with(&gpu, &mut planar, &casters), first);
    assert_eq!(uploaded(&planar), 0, "nothing moved");
    casters[1].world_from_object.translation.x -= 0.1;
    let moved = stage.draw_with(&gpu, &mut planar, &casters);
    assert_eq!(uploaded(&planar), 48, "one caster");
    stage.bodies[1].transform = casters[1].world_from_object;
    assert_eq!(stage.judge(&stage.truth(), &moved).wrong, 0);
    assert!(stage.judge(&stage.truth(), &first).wrong > 0, "the twin");
    stage.light = PointLight::new(Vec3::new(-1.0, 6.0, 2.0), 40.0).into();
    let lit = stage.draw_with(&gpu, &mut planar, &casters);
    assert_eq!(uploaded(&planar), 112, "the light");
    assert_eq!(stage.judge(&stage.truth(), &lit).wrong, 0);
    // One that goes, and one of another mesh in its place.
    casters.swap(0, 2);
    casters.pop();
    stage.bodies.swap(0, 2);
    stage.bodies.remove(3);
    stage.grounds[0].body = 3;
    let fewer = stage.draw_with(&gpu, &mut planar, &casters);
    assert_eq!(stage.judge(&stage.truth(), &fewer).wrong, 0);
    // All move, of which the first does not lie first in the buffer.
    for (caster, body) in casters.iter_mut().zip(&mut stage.bodies) {
        caster.world_from_object.translation.z += 0.3;
        body.transform = caster.world_from_object;
    }
    let moved = stage.draw_with(&gpu, &mut planar, &casters);
    assert_eq!(uploaded(&planar), 3 * 48);
    assert_eq!(stage.judge(&stage.truth(), &moved).wrong, 0);
    assert!(stage.judge(&stage.truth(), &fewer).wrong > 0, "the twin");
}

#[test]
fn forgotten_calls_are_told_and_made_good() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage::new(lamp(), things());
    let casters = stage.casters(&gpu);
    let mut planar = PlanarShadow::new(&gpu.device, &stage.descriptor()).unwrap();
    let render = |planar: &PlanarShadow, place: [usize; 3]| {
        let host = crate::planar_host::HostGpu::new(&gpu, &stage);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let [light, plane, view] = place;
        planar.render(&mut host.begin(&mut encoder, None), light, plane, view)
    };
    assert_eq!(render(&planar, [0; 3]), Err(PlanarRenderError::NotEncoded));
    stage.prepare(&gpu, &mut planar, &casters);
    assert_eq!(render(&planar, [0; 3]), Err(PlanarRenderError::NotEncoded));
    stage.prepare(&gpu, &mut planar, &casters);
    assert!(planar.statistics().not_encoded && planar.statistics().uploaded > 0);
    let mut dropped = gpu.device.create_command_encoder(&Default::default());
    planar.encode(&mut dropped);
    drop(dropped);
    assert_eq!(render(&planar, [0; 3]), Err(PlanarRenderError::Dropped));
    let picture = stage.draw_with(&gpu, &mut planar, &casters);
    assert!(planar.statistics().encoder_dropped);
    assert_eq!(stage.judge(&stage.truth(), &picture).wrong, 0);
    // What the host declares lost is not drawn, not even if it is encoded, before it is prepared.
    assert_eq!(render(&planar, [0; 3]), Ok(()));
    planar.invalidate();
    gpu.run(|encoder| planar.encode(encoder));
    assert_eq!(render(&planar, [0; 3]), Err(PlanarRenderError::NotEncoded));
    let picture = stage.draw_with(&gpu, &mut planar, &casters);
    assert!(planar.statistics().uploaded > 0 && !planar.statistics().not_encoded);
    assert_eq!(stage.judge(&stage.truth(), &picture).wrong, 0);
    for (place, what) in [
        ([1, 0, 0], "light"),
        ([0, 1, 0], "plane"),
        ([0, 0, 1], "view"),
    ] {
        let error = PlanarRenderError::NoSuch {
            what,
            asked: 1,
            count: 1,
        };
        assert_eq!(render(&planar, place), Err(error));
    }
    // A frame of nothing.
    let nothing = PlanarFrame::default();
    planar.prepare(&gpu.device, &gpu.queue, &nothing).unwrap();
    let counted = planar.statistics();
    assert_eq!(
        counted.casters_drawn,
        PlanarStatistics::default().casters_drawn
    );
}
