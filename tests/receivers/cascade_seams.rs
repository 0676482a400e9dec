//! Where one cascade ends and the next begins: no worse than beside there, and no texel but a cascade's own.

use crate::atlas_cascades::{EYE, Field, HALF, Sun, TOWARD, inside, sun, view};
use glam::camera::rh::{proj::directx as proj, view::look_to_mat4};
use glam::{DVec3, DVec4, Vec3};
use host::gpu::Gpu;
use shadows::{
    AtlasTile, CascadeFit, CascadeSplit, Cascades, DepthConvention, Kernel, View, glam, wgpu,
};

const SIZE: u32 = 256;
const POINTS: usize = 250_000;
/// Where the camera stands.
const EYES: usize = 6;
/// How many times as many pixels may be wrong at a seam as beside it: room for chance.
const CHANCE: f64 = 1.25;

/// 4, 16 and 64 away: texels of each are four times as wide as those of the one before it.
fn cascades(blend: f32) -> Cascades {
    Cascades {
        count: 3,
        split: CascadeSplit::Practical { lambda: 1.0 },
        distance: 64.0,
        blend,
        fit: CascadeFit::Stable,
        margin: 1.0 / 32.0,
    }
}

/// Whether a post is between a point and the sun.
fn is_shadowed(field: &Field, point: Vec3) -> bool {
    let (half, toward) = (HALF.as_dvec3(), TOWARD.as_dvec3());
    // Farther away none is high enough.
    let reach = 2.0 * HALF.y * TOWARD.length() / TOWARD.y + 2.0;
    field.posts.iter().any(|post| {
        if (post.x - point.x).abs().max((post.z - point.z).abs()) > reach {
            return false;
        }
        let from = point.as_dvec3() - post.as_dvec3();
        let ends = [-half, half].map(|side| (side - from) / toward);
        let (enters, leaves) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        enters.max_element().max(0.0) < leaves.min_element()
    })
}

fn eye(number: usize) -> Vec3 {
    EYE + number as f32 * Vec3::new(3.1, 0.0, -1.7)
}

/// Points around all eyes, and what is so of them.
struct Ground {
    points: Vec<(Vec3, Vec3)>,
    shadowed: Vec<bool>,
}

impl Ground {
    fn new(field: &Field) -> Self {
        let middle = eye(EYES / 2) * Vec3::new(1.0, 0.0, 1.0);
        let points = field.points(POINTS, middle, 32.0);
        let shadowed = points.iter().map(|(point, _)| is_shadowed(field, *point));
        Self {
            shadowed: shadowed.collect(),
            points,
        }
    }
}

/// Wrong points of those in a strip.
#[derive(Clone, Copy, Debug, Default)]
struct Strip {
    points: usize,
    wrong: usize,
}

impl Strip {
    fn rate(self) -> f64 {
        self.wrong as f64 / self.points as f64
    }
}

/// At the end of a cascade: as wide a strip on each side of four of the next one's texels to both sides.
type Strips = [Strip; 3];

fn add(strips: &mut Strips, end: &AtlasTile, ground: &Ground, said: &[f32]) {
    for (((point, _), shadowed), said) in ground.points.iter().zip(&ground.shadowed).zip(said) {
        let strip = match inside(end, *point) - 1.5 {
            16.0..48.0 => 0,
            -16.0..16.0 => 1,
            -48.0..-16.0 => 2,
            _ => continue,
        };
        strips[strip].points += 1;
        strips[strip].wrong += usize::from((*said >= 0.5) == *shadowed);
    }
}

/// How many times as many points are wrong at a seam as in the strips beside it, of which each counts for what of
/// the seam is its cascade's. Of where the two blend, over `blend` texels before the border, half is the next one's.
fn at_seam([near, seam, far]: Strips, blend: f64) -> f64 {
    assert!(near.points.min(seam.points).min(far.points) > 5000);
    let next = (16.0 + 0.5 * blend) / 32.0;
    seam.rate() / ((1.0 - next) * near.rate() + next * far.rate())
}

/// Texels of the first two cascades over which they blend into the next.
fn blend_texels(blend: f32) -> [f64; 2] {
    // A quarter of the way from one end to the next in front of it; tiles are twice as wide as they are far, and
    // a margin and what kernels reach wider.
    [0.75 * f64::from(blend) * 0.5 * f64::from(SIZE) * 0.85; 2]
}

type Change = fn(String) -> String;

fn changed(module: &str, from: &str, to: &str) -> String {
    assert!(module.contains(from), "{from} is nowhere");
    module.replace(from, to)
}

/// A cascade is read up to eight texels beyond its tile.
fn without_room(module: String) -> String {
    let module = changed(&module, "record.middle - (", "record.middle + 9.5 - (");
    changed(
        &module,
        "fn shadows_flat_inside(",
        "fn shadows_flat_inside_tile(",
    ) + "fn shadows_flat_inside(light: ShadowsLight, texel: vec2f) -> bool { return true; }\n"
}

/// The same, whose tiles end all the same: what is beyond is lit.
fn without_margin(module: String) -> String {
    changed(&module, "record.middle - (", "record.middle + 9.5 - (")
}

/// The next cascade, into which one blends, is read from the first one's tile.
fn blends_foreign(module: String) -> String {
    changed(
        &module,
        "let other = shadows_light[first.tiles.y + next];",
        "var other = shadows_light[first.tiles.y + next]; other.tiles.x = first.tiles.x;",
    )
}

/// The same, whether it holds the point or not.
fn blends_unheld(module: String) -> String {
    changed(
        &module,
        "max(share, 1.0 - shadows_cascade_room(other, position) * per_blend)",
        "share",
    )
}

/// The room in the next cascade is taken to be in texels of this one.
fn counts_texels_alike(module: String) -> String {
    changed(&module, " * (record.texels / other.texels)", "")
}

/// Of a kernel, the strips at the ends of the first two cascades.
fn found(
    gpu: &Gpu,
    (field, ground): (&Field, &Ground),
    (kernel, blend): (Kernel, f32),
    change: Change,
) -> [Strips; 2] {
    let mut drawn = Sun::new(gpu, kernel);
    let questions = drawn.changed_questions(gpu, &ground.points, change);
    let mut found = [Strips::default(); 2];
    for at in 0..EYES {
        let lights = sun(cascades(blend), SIZE);
        drawn.draw(gpu, &lights, &view(1.0, eye(at), Vec3::X), &field.casters);
        let tiles = drawn.atlas.tiles(0, 0);
        assert_eq!(tiles.len(), 3);
        let said = drawn.ask(gpu, &questions);
        for (strips, end) in found.iter_mut().zip(&tiles) {
            add(strips, end, ground, &said);
        }
    }
    found
}

#[test]
fn at_the_seams_of_cascades_no_more_is_wrong_than_beside_them() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = Field::new(&gpu);
    let scene = (&field, &Ground::new(&field));
    let twins: [(f32, Change); 2] = [(0.0, without_room), (0.1, blends_foreign)];
    for kernel in [Kernel::Hard, Kernel::Weighted5] {
        for (blend, twin) in twins {
            let strips = found(&gpu, scene, (kernel, blend), |module| module);
            let blends = blend_texels(blend);
            let what = format!("{kernel:?}, blend {blend}: {strips:?}");
            let of_both = [0, 1].map(|end| at_seam(strips[end], blends[end]));
            let of_next = strips.map(|[_, seam, far]| seam.rate() / far.rate());
            println!("{what}\n    {of_both:.2?} {of_next:.2?}");
            assert!(of_both.iter().all(|seam| *seam <= CHANCE), "{what}");
            assert!(of_next.iter().all(|seam| *seam <= 1.0), "{what}");
            let strips = found(&gpu, scene, (kernel, blend), twin);
            let spoilt = [0, 1].map(|end| at_seam(strips[end], blends[end]));
            println!("    twin {spoilt:.2?}");
            assert!(
                spoilt.iter().all(|seam| *seam > 1.5 * CHANCE),
                "{what}, twin: {strips:?}"
            );
        }
    }
}

/// What a tile says of a point of level ground: `None` where that is a matter of rounding and bias.
fn stored(layer: &[f32], side: u32, tile: &AtlasTile, point: DVec3) -> Option<bool> {
    let clip = |point: DVec3| tile.clip_from_world.as_dmat4() * DVec4::from((point, 1.0));
    let half = 0.5 * f64::from(tile.size);
    let own = clip(point);
    let place = [half * (1.0 + own.x), half * (1.0 - own.y)];
    let texel = place.map(f64::floor);
    if place.iter().any(|at| (at - at.round()).abs() < 1e-3) {
        return None;
    }
    // The ground's depth at the texel's centre: linear over the map.
    let [x, z] = [DVec3::X, DVec3::Z].map(|axis| clip(point + axis) - own);
    let normal = x.truncate().cross(z.truncate());
    let aside = [0, 1].map(|axis| (texel[axis] + 0.5 - place[axis]) / half);
    let ground = own.z - (normal.x * aside[0] - normal.y * aside[1]) / normal.z;
    let at = [0, 1].map(|axis| [tile.x, tile.y][axis] + texel[axis] as u32);
    let stored = f64::from(layer[(at[1] * side + at[0]) as usize]);
    let depth_of_texel = (normal.x.abs() + normal.y.abs()) / normal.z.abs() / half;
    let away = stored - ground;
    (away.abs() < 1e-3 * depth_of_texel || away.abs() > depth_of_texel)
        .then_some(away > 0.5 * depth_of_texel)
}

/// The atlas's layers, and how many texels they have along a side.
fn layers(gpu: &Gpu, texture: &wgpu::Texture) -> (Vec<Vec<f32>>, u32) {
    let layers = (0..texture.depth_or_array_layers()).map(|layer| {
        let bytes = gpu.read_texture(texture, layer, wgpu::TextureAspect::DepthOnly);
        bytemuck::pod_collect_to_vec(&bytes)
    });
    (layers.collect(), texture.width())
}

#[test]
fn every_point_reads_the_texel_of_its_own_cascade() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = Field::new(&gpu);
    let ground = Ground::new(&field);
    let mut drawn = Sun::new(&gpu, Kernel::Hard);
    let lights = sun(cascades(0.0), SIZE);
    drawn.draw(
        &gpu,
        &lights,
        &view(1.0, eye(EYES / 2), Vec3::X),
        &field.casters,
    );
    let tiles = drawn.atlas.tiles(0, 0);
    let (layers, side) = layers(&gpu, drawn.atlas.texture());
    // As the shader chooses, but for points within rounding of a border.
    let expected = |point: Vec3| {
        let rooms: Vec<f64> = tiles.iter().map(|tile| inside(tile, point) - 1.5).collect();
        let at = rooms.iter().position(|room| *room > 0.0)?;
        let unsure = rooms[..=at].iter().any(|room| room.abs() < 1e-2);
        let tile = &tiles[at];
        let layer = &layers[tile.layer as usize];
        stored(layer, side, tile, point.as_dvec3()).filter(|_| !unsure)
    };
    let expected: Vec<Option<bool>> = ground.points.iter().map(|(p, _)| expected(*p)).collect();
    let sure = expected.iter().flatten().count();
    assert!(sure > POINTS * 9 / 10, "{sure} points");
    let foreign = |change: Change| {
        let questions = drawn.changed_questions(&gpu, &ground.points, change);
        let said = drawn.ask(&gpu, &questions);
        let answers = said.iter().zip(&expected);
        answers
            .filter(|(said, expected)| expected.is_some_and(|blocked| (**said < 0.5) != blocked))
            .count()
    };
    assert_eq!(foreign(|module| module), 0);
    for twin in [without_room, without_margin] {
        let count = foreign(twin);
        assert!(count > 100, "{count}");
    }
}

/// Tight fits end toward the eye, too: there a cascade's band lies where the next one says nothing.
#[test]
fn a_point_that_the_next_cascade_does_not_hold_is_its_own_cascades_alone() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = Field::new(&gpu);
    let ground = Ground::new(&field);
    let mut drawn = Sun::new(&gpu, Kernel::Hard);
    // All equally long, 21, and half of that turns into the next one; longer than what is seen is wide.
    let tight = Cascades {
        fit: CascadeFit::Tight,
        split: CascadeSplit::Practical { lambda: 0.0 },
        ..cascades(0.5)
    };
    let narrow = proj::perspective_infinite_reverse(0.3, 1.6, 1.0);
    let camera = look_to_mat4(EYE - 25.0 * Vec3::X, Vec3::X, Vec3::Y);
    let view = View::new(narrow * camera, DepthConvention::InfiniteReverse).unwrap();
    drawn.draw(&gpu, &sun(tight, SIZE), &view, &field.casters);
    let tiles = drawn.atlas.tiles(0, 0);
    let (layers, side) = layers(&gpu, drawn.atlas.texture());
    let is_blocked = |point: Vec3| {
        let rooms: Vec<f64> = tiles.iter().map(|tile| inside(tile, point) - 1.5).collect();
        let at = rooms.iter().position(|room| *room > 0.0)?;
        let texel =
            2.0 / f64::from(tiles[at].clip_from_world.row(0).truncate().length() * SIZE as f32);
        // The half of the band in which the next one has the greater part.
        let is_unheld =
            rooms[at] < 0.5 * 10.5 / texel && rooms.get(at + 1).is_some_and(|next| *next < -1e-2);
        let is_sure = rooms[..=at].iter().all(|room| room.abs() > 1e-2);
        let tile = &tiles[at];
        let layer = &layers[tile.layer as usize];
        let known = stored(layer, side, tile, point.as_dvec3());
        known.filter(|_| is_unheld && is_sure)
    };
    let expected: Vec<Option<bool>> = ground
        .points
        .iter()
        .map(|(point, _)| is_blocked(*point))
        .collect();
    let blocked = expected.iter().filter(|blocked| **blocked == Some(true));
    let blocked = blocked.count();
    let wrong = |change: Change| {
        let questions = drawn.changed_questions(&gpu, &ground.points, change);
        let said = drawn.ask(&gpu, &questions);
        let answers = said.iter().zip(&expected);
        let own = |blocked: bool| if blocked { 0.0 } else { 1.0 };
        answers
            .filter(|(said, expected)| expected.is_some_and(|blocked| **said != own(blocked)))
            .count()
    };
    let (mended, twin) = (wrong(|module| module), wrong(blends_unheld));
    println!("{blocked} in shadow, {mended} wrong, twin {twin}");
    assert!(blocked > 100, "{blocked} points");
    assert_eq!(mended, 0);
    // The broken twin: beyond the next one's tile all is lit.
    assert!(twin > blocked / 2, "{twin} of {blocked}");
}

/// By its end a cascade has become the next one, however much wider that one's texels are: else the picture would
/// jump there.
#[test]
fn at_its_end_a_cascade_has_turned_into_the_next() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = Field::new(&gpu);
    let ground = Ground::new(&field);
    let mut drawn = Sun::new(&gpu, Kernel::Hard);
    let tight = Cascades {
        fit: CascadeFit::Tight,
        ..cascades(0.5)
    };
    // Half of the 3 and of the 12 units that they are long.
    let bands = [1.5, 6.0];
    let view = view(1.0, EYE, Vec3::X);
    drawn.draw(&gpu, &sun(tight, SIZE), &view, &field.casters);
    let tiles = drawn.atlas.tiles(0, 0);
    let (layers, side) = layers(&gpu, drawn.atlas.texture());
    let next_is_blocked = |point: Vec3| {
        let room = |tile: &AtlasTile| {
            let texels = tile.clip_from_world.row(0).truncate().length() * SIZE as f32;
            (inside(tile, point) - 1.5) * 2.0 / f64::from(texels)
        };
        let rooms: Vec<f64> = tiles.iter().map(room).collect();
        let at = rooms.iter().position(|room| *room > 0.0)?;
        let band = *bands.get(at)?;
        let is_at_end = rooms[at] < 0.1 * band && rooms[at + 1] > band;
        let is_sure = rooms[..=at].iter().all(|room| room.abs() > 1e-3);
        let next = &tiles[at + 1];
        let layer = &layers[next.layer as usize];
        stored(layer, side, next, point.as_dvec3()).filter(|_| is_at_end && is_sure)
    };
    let next: Vec<Option<bool>> = ground
        .points
        .iter()
        .map(|(point, _)| next_is_blocked(*point))
        .collect();
    let known = next.iter().flatten().count();
    let others = |change: Change| {
        let questions = drawn.changed_questions(&gpu, &ground.points, change);
        let said = drawn.ask(&gpu, &questions);
        let is_other = |said: f32, blocked: bool| (said - f32::from(!blocked)).abs() > 0.11;
        said.iter()
            .zip(&next)
            .filter(|(said, next)| next.is_some_and(|blocked| is_other(**said, blocked)))
            .count()
    };
    let (mended, twin) = (others(|module| module), others(counts_texels_alike));
    println!("{known} at an end, {mended} another's, twin {twin}");
    assert!(known > 1000, "{known} points");
    assert_eq!(mended, 0);
    // The broken twin: the next one's texels are taken to be as wide.
    assert!(twin > 20, "{twin} of {known}");
}
