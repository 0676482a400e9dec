//! What is drawn again, and what is not.

use super::ask::{Point, ask};
use super::draw;
use crate::common::shapes::{cuboid, square};
use host::gpu::Gpu;
use shadows::glam::{Affine3A, Vec3};
use shadows::{
    Caster, DirectionalLight, PointLight, ProjectedCaster, ProjectedFrame, ProjectedShadow,
    ProjectedShadowDescriptor, Projector,
};

fn shadow(gpu: &Gpu, layer_size: u32) -> ProjectedShadow {
    let descriptor = ProjectedShadowDescriptor {
        layer_size,
        ..Default::default()
    };
    ProjectedShadow::new(&gpu.device, &descriptor).unwrap()
}

fn at(gpu: &Gpu, x: f32) -> ProjectedCaster {
    let place = Affine3A::from_translation(Vec3::new(x, 1.0, 0.0));
    ProjectedCaster::opaque(cuboid(Vec3::splat(0.3)).caster(&gpu.device, place))
}

const SUN: DirectionalLight = DirectionalLight {
    toward_light: Vec3::Y,
};

/// Whether each projector's own place is dark, and the others' are not.
fn is_right(gpu: &Gpu, shadow: &ProjectedShadow, xs: &[f32]) -> bool {
    (0..xs.len()).all(|projector| {
        let points: Vec<Point> = xs.iter().map(|&x| Point::at(Vec3::X * x)).collect();
        let seen = ask(gpu, shadow, projector, &points);
        let expected = xs
            .iter()
            .map(|x| [f32::from(u8::from(*x != xs[projector])); 3]);
        seen.into_iter().eq(expected)
    })
}

#[test]
fn what_moves_beyond_a_lights_range_has_nothing_drawn_again() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut shadow = shadow(&gpu, 1024);
    let mesh = at(&gpu, 0.0).caster.mesh;
    let mut drawn = |xs: [f32; 2]| {
        let place = |x: f32| Affine3A::from_translation(Vec3::new(x, 1.0, 0.0));
        let caster = |x: f32| ProjectedCaster::opaque(Caster::new(mesh.clone(), place(x)));
        let casters = xs.map(caster);
        let light = PointLight::new(Vec3::Y * 4.0, 8.0);
        draw(&gpu, &mut shadow, &[Projector::new(light, &casters)]);
        shadow.statistics().shadows_drawn
    };
    assert_eq!(drawn([0.0, 50.0]), 1);
    assert_eq!(drawn([0.0, 60.0]), 0);
    assert_eq!(drawn([0.1, 60.0]), 1);
    // What comes into range is drawn.
    assert_eq!(drawn([0.1, 1.0]), 1);
}

#[test]
fn what_has_not_changed_is_not_drawn_again() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut shadow = shadow(&gpu, 1024);
    let casters = [0.0, 4.0, 8.0].map(|x| [at(&gpu, x)]);
    let of = |index: usize| Projector::new(SUN, &casters[index]).with_size(64);
    let mut step = |projectors: &[Projector<'_>], xs: &[f32]| {
        draw(&gpu, &mut shadow, projectors);
        let taken = shadow.statistics();
        assert!(is_right(&gpu, &shadow, xs), "{xs:?}");
        (
            taken.shadows_drawn,
            taken.shadows_kept,
            taken.passes,
            taken.uploaded > 0,
        )
    };
    let all = [of(0), of(1), of(2)];
    assert_eq!(step(&all, &[0.0, 4.0, 8.0]), (3, 0, 7, true));
    for _ in 0..2 {
        assert_eq!(step(&all, &[0.0, 4.0, 8.0]), (0, 3, 0, false));
    }
    // In another order, and without the first: only what shaders are told of them.
    assert_eq!(
        step(&[of(2), of(0), of(1)], &[8.0, 0.0, 4.0]),
        (0, 3, 0, true)
    );
    assert_eq!(step(&[of(0), of(1)], &[0.0, 4.0]), (0, 2, 0, true));
    // One that moves.
    let moved = [at(&gpu, -5.0)];
    let some = [of(0), Projector::new(SUN, &moved).with_size(64)];
    assert_eq!(step(&some, &[0.0, -5.0]), (1, 1, 7, true));
    assert_eq!(step(&[], &[]), (0, 0, 0, true));
    assert_eq!(step(&[], &[]), (0, 0, 0, false));
    // Another colour, light, size or form is another shadow.
    let mut kinds = vec![of(0)];
    let clear = [ProjectedCaster::new(casters[0][0].caster.clone(), [0.5; 3])];
    kinds.push(Projector::new(SUN, &clear).with_size(64));
    kinds.push(
        Projector::new(DirectionalLight::new(Vec3::new(0.1, 1.0, 0.0)), &casters[0]).with_size(64),
    );
    kinds.push(of(0).with_size(128));
    for kind in &kinds {
        draw(&gpu, &mut shadow, std::slice::from_ref(kind));
        assert_eq!(shadow.statistics().shadows_drawn, 1, "{kind:?}");
    }
    draw(&gpu, &mut shadow, &[of(0)]);
    casters[0][0].caster.mesh.bump_revision();
    draw(&gpu, &mut shadow, &[of(0)]);
    assert_eq!(shadow.statistics().shadows_drawn, 1);
}

#[test]
fn without_the_cache_all_is_drawn_every_frame() {
    let Some(gpu) = Gpu::for_test() else { return };
    let descriptor = ProjectedShadowDescriptor {
        cache: false,
        ..Default::default()
    };
    let mut shadow = ProjectedShadow::new(&gpu.device, &descriptor).unwrap();
    let casters = [at(&gpu, 0.0)];
    for _ in 0..2 {
        draw(&gpu, &mut shadow, &[Projector::new(SUN, &casters)]);
        assert_eq!(shadow.statistics().shadows_drawn, 1);
    }
}

#[test]
fn what_was_not_encoded_or_submitted_is_drawn_later() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut shadow = shadow(&gpu, 1024);
    let casters = [0.0, 4.0].map(|x| [at(&gpu, x)]);
    let of = |index: usize| Projector::new(SUN, &casters[index]).with_size(64);
    let projectors = [of(0), of(1)];
    let prepare = |shadow: &mut ProjectedShadow| {
        let frame = ProjectedFrame {
            projectors: &projectors,
        };
        shadow.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    };
    prepare(&mut shadow);
    draw(&gpu, &mut shadow, &projectors);
    let taken = shadow.statistics();
    assert!(taken.not_encoded && taken.shadows_drawn == 2);
    assert!(is_right(&gpu, &shadow, &[0.0, 4.0]));
    // Another order is told to shaders by copies alone. Where those are dropped all is done again.
    let swapped = [of(1), of(0)];
    let frame = ProjectedFrame {
        projectors: &swapped,
    };
    shadow.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    let mut dropped = gpu.device.create_command_encoder(&Default::default());
    shadow.encode(&mut dropped);
    drop(dropped);
    assert!(is_right(&gpu, &shadow, &[0.0, 4.0]), "as it was");
    draw(&gpu, &mut shadow, &swapped);
    let taken = shadow.statistics();
    assert!(taken.encoder_dropped && taken.shadows_drawn == 2 && !taken.not_encoded);
    assert!(is_right(&gpu, &shadow, &[4.0, 0.0]));
    draw(&gpu, &mut shadow, &swapped);
    assert_eq!(shadow.statistics().shadows_kept, 2);
    shadow.invalidate();
    draw(&gpu, &mut shadow, &swapped);
    assert_eq!(shadow.statistics().shadows_drawn, 2);
}

#[test]
fn tiles_move_where_there_is_no_other_room_and_layers_come_when_needed() {
    let Some(gpu) = Gpu::for_test() else { return };
    let descriptor = ProjectedShadowDescriptor {
        layer_size: 64,
        memory: 2 * 4 * (64 * 64 * 4 / 3 + 1),
        ..Default::default()
    };
    let mut shadow = ProjectedShadow::new(&gpu.device, &descriptor).unwrap();
    let xs: Vec<f32> = (0..5).map(|index| 3.0 * index as f32).collect();
    let casters: Vec<[ProjectedCaster; 1]> = xs.iter().map(|&x| [at(&gpu, x)]).collect();
    let of = |index: usize, size| Projector::new(SUN, &casters[index]).with_size(size);
    draw(&gpu, &mut shadow, &[of(0, 32)]);
    assert_eq!(shadow.statistics().layers, 1);
    let five: Vec<Projector<'_>> = (0..5).map(|index| of(index, 32)).collect();
    draw(&gpu, &mut shadow, &five);
    assert_eq!(shadow.statistics().layers, 2);
    assert!(is_right(&gpu, &shadow, &xs));
    // Two small ones stay in one layer and one in the other: a whole layer is free only if they move.
    draw(&gpu, &mut shadow, &[of(0, 32), of(4, 32), of(1, 64)]);
    assert!(is_right(&gpu, &shadow, &[xs[0], xs[4], xs[1]]));
    assert_eq!(shadow.statistics().shadows_drawn, 3);
    assert_eq!(shadow.texture().depth_or_array_layers(), 2);
    // A mesh of another kind in the same texture.
    let floor = square(0.2).caster(
        &gpu.device,
        Affine3A::from_translation(Vec3::new(40.0, 1.0, 0.0)),
    );
    let floor = [ProjectedCaster::opaque(Caster { ..floor })];
    draw(
        &gpu,
        &mut shadow,
        &[of(0, 32), Projector::new(SUN, &floor).with_size(16)],
    );
    assert!(is_right(&gpu, &shadow, &[xs[0], 40.0]));
}
