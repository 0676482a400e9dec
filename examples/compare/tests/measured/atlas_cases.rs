//! The hard cases of an atlas: each fails if what it is about is broken.

use shadows::glam::Vec3;

use compare::hard::atlas::{Frames, play};
use compare::hard::cases;
use compare::hard::expect::Expect;
use compare::table::named;
use host::gpu::Gpu;
use host::random::Random;

type Module = fn(String) -> String;

fn changed(module: &str, from: &str, to: &str) -> String {
    assert!(module.contains(from), "{from} is nowhere");
    module.replace(from, to)
}

/// What it does not say for the kernel's own reasons: texels beyond a tile's sides are read like its own.
fn beyond_flat_tiles(module: String) -> String {
    let module = changed(
        &module,
        "fn shadows_flat_gathers(",
        "fn shadows_flat_gathers_none(",
    );
    let module = changed(
        &module,
        "fn shadows_flat_inside(",
        "fn shadows_flat_inside_none(",
    );
    module
        + "fn shadows_flat_gathers(light: ShadowsLight, corner: vec2f, reach: f32) -> bool { return true; }
fn shadows_flat_inside(light: ShadowsLight, texel: vec2f) -> bool { return true; }\n"
}

/// The same of a point light's faces: their neighbours in the texture are read for those in the world.
fn beyond_faces(module: String) -> String {
    let faces = "return all(abs(corner) < vec2f(receiver.light.texels - 0.5 - reach));";
    changed(&module, faces, "return true;")
}

/// Tiles are taken to lie 16 texels beside where they are.
fn beside_the_tile(module: String) -> String {
    let units = "let units = vec2f(vec2u(packed, packed >> 10u) & vec2u(1023u));";
    changed(
        &module,
        units,
        "let units = vec2f((vec2u(packed, packed >> 10u) + 1u) & vec2u(1023u));",
    )
}

/// Cascades are read up to their sides and beyond.
fn beyond_cascades(module: String) -> String {
    changed(&module, "record.middle - (", "record.middle + 9.5 - (")
}

/// The next cascade is read from the tile of the one before it.
fn blends_foreign(module: String) -> String {
    changed(
        &module,
        "let other = shadows_light[first.tiles.y + next];",
        "var other = shadows_light[first.tiles.y + next]; other.tiles.x = record.tiles.x;",
    )
}

/// There is no cascade but the first.
fn first_cascade(module: String) -> String {
    changed(&module, "(first.kind >> 8u) & 15u", "0u")
}

/// Planes of receivers face the light.
fn without_slope(module: String) -> String {
    changed(
        &module,
        "receiver.slope = n.yz * (light.texel * select(-per_length, per_length, derived.facing > 0.0));",
        "receiver.slope = vec2f(0.0);",
    )
}

/// Every view reads the first one's cascades: there are three lights.
fn first_view(module: String) -> String {
    changed(
        &module,
        "shadows_visibility(at.light",
        "shadows_visibility(at.light % 3u",
    )
}

fn as_it_is(module: String) -> String {
    module
}

/// What the case that begins so goes through in its first round.
fn case(start: &str) -> Vec<Frames> {
    let case = cases::all().find(|case| case.name.starts_with(start));
    case.unwrap().frames.unwrap()(&mut Random(0))
}

/// Wrong interior pixels of the frames as a broken atlas or shader draws them.
fn wrong(gpu: &Gpu, truth: &Frames, drawn: &Frames, technique: &str, change: Module) -> usize {
    let technique = named(technique, 512).unwrap();
    let truth = truth.truth().unwrap();
    let shown = play(gpu, drawn, &technique, change).unwrap();
    let judged = shown.iter().map(|light| {
        let found = light.judge("", &truth, &light.visibility, Expect::Exact);
        found.unwrap().interior()
    });
    judged.sum()
}

#[test]
fn shaders_that_read_what_is_not_a_lights_own_fail() {
    let Some(gpu) = Gpu::for_test() else { return };
    let broken: [(&str, &str, Module); 11] = [
        ("Tiles beside", "atlas-hard", beyond_flat_tiles),
        ("Tiles beside", "atlas-5x5", beyond_flat_tiles),
        ("Tiles beside", "atlas-5x5", beyond_faces),
        ("Memory", "atlas-2x2", beside_the_tile),
        ("A light becomes", "atlas-2x2", beside_the_tile),
        ("Cascades end", "atlas-5x5", beyond_cascades),
        ("Cascades end", "atlas-2x2", blends_foreign),
        ("Cascades of other", "atlas-2x2", first_cascade),
        ("Cascades wait", "atlas-2x2", first_cascade),
        ("Long view", "atlas-2x2", without_slope),
        ("Two views of", "atlas-2x2", first_view),
    ];
    for (start, technique, change) in broken {
        let frames = case(start);
        let counts = frames
            .iter()
            .map(|frames| wrong(&gpu, frames, frames, technique, change));
        let counts: Vec<usize> = counts.collect();
        println!("{start}, {technique}: {counts:?}");
        assert!(
            counts.iter().sum::<usize>() > 20,
            "{start}, {technique}: {counts:?}"
        );
    }
}

/// Changes what is drawn, and not what is true.
type Drawn = fn(Frames) -> Frames;

/// Plates so far away are not in any tile.
fn without_plates(mut frames: Frames) -> Frames {
    let plates = frames.scene.objects.iter_mut().rev().take(4);
    plates.for_each(|plate| plate.casts = false);
    frames
}

/// Tiles are seen before their turn has come.
fn without_rest(mut frames: Frames) -> Frames {
    frames
        .frames
        .retain(|frame| frame.judged || frame.moved != Vec3::ZERO);
    frames.came_about = None;
    frames
}

/// Far cascades show casters where they were before the walk.
fn with_stale_cascades(mut frames: Frames) -> Frames {
    let passing = frames.frames.iter_mut().filter(|frame| !frame.judged);
    passing.for_each(|frame| frame.moved = Vec3::new(2.0, 0.0, 1.0));
    frames
}

#[test]
fn atlases_that_show_what_was_or_nothing_fail() {
    let Some(gpu) = Gpu::for_test() else { return };
    let broken: [(&str, Drawn); 3] = [
        ("Casters far", without_plates),
        ("Casters move", without_rest),
        ("Cascades wait", with_stale_cascades),
    ];
    for (start, change) in broken {
        let truths = case(start);
        for (truth, drawn) in truths.iter().zip(case(start)) {
            let wrong = wrong(&gpu, truth, &change(drawn), "atlas-2x2", as_it_is);
            assert!(wrong > 20, "{start}, {}: {wrong}", truth.what);
        }
    }
}

/// What is not tried at all is an error, and not a row of zeros.
#[test]
fn frames_in_which_nothing_comes_about_are_refused() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut frames = case("Memory").remove(0);
    frames.atlas.memory *= 40;
    let technique = named("atlas-hard", 512).unwrap();
    let refused = play(&gpu, &frames, &technique, as_it_is).err().unwrap();
    assert!(
        refused.to_string().contains("did not come about"),
        "{refused}"
    );
}
