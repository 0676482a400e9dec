//! The debug views show what the volumes are.

use host::one_light::OneLight;
use shadows::glam::{Affine3A, DVec2, Vec3, Vec4};
use shadows::{
    Caster, CasterState, DebugColors, Extrusion, HomogeneousLight, Method, ShadowVolumeRenderer,
    VolumeDebug, VolumeDebugDescriptor, wgpu,
};

use crate::passes::{HostPipelines, attach, begin, clear, view_of};
use crate::pictures::{at, lamp, mixed, sun};
use crate::shapes;
use crate::stage::{Body, Stage, WAYS};
use host::gpu::Gpu;

/// A stage, drawn once and ready for its debug views.
pub struct Shown<'a> {
    gpu: &'a Gpu,
    stage: &'a Stage,
    pub renderer: ShadowVolumeRenderer,
    pub casters: Vec<Caster>,
    pub debug: VolumeDebug,
    depth: wgpu::TextureView,
    format: wgpu::TextureFormat,
}

impl<'a> Shown<'a> {
    pub fn new(gpu: &'a Gpu, stage: &'a Stage) -> Self {
        Self::with(gpu, stage, DebugColors::default(), true)
    }

    /// `surfaces`: whether the scene has a depth.
    pub fn with(gpu: &'a Gpu, stage: &'a Stage, colors: DebugColors, surfaces: bool) -> Self {
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let descriptor = VolumeDebugDescriptor {
            label: Some("test"),
            color_format: format,
            depth_stencil_format: stage.format,
            sample_count: stage.samples,
            depth: stage.depth,
            colors,
        };
        let debug = VolumeDebug::new(&gpu.device, &descriptor).unwrap();
        let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
        let casters = stage.casters(gpu);
        stage.prepare(gpu, &mut renderer, &casters);
        let depth = view_of(&gpu.target([stage.side; 2], stage.format, stage.samples));
        let host = HostPipelines::new(gpu, stage);
        let drawn = if surfaces {
            stage.surfaces(gpu)
        } else {
            Vec::new()
        };
        gpu.run(|encoder| {
            renderer.encode(encoder);
            stage.prepass(encoder, &depth, &host, &drawn);
            renderer
                .render(
                    &mut begin(encoder, "stencil", &[], attach(&depth, None)),
                    0,
                    0,
                )
                .unwrap();
        });
        Self {
            gpu,
            stage,
            renderer,
            casters,
            debug,
            depth,
            format,
        }
    }

    /// A view over black, with the depth-stencil buffer read-only: RGBA, 0 to 255.
    pub fn view(&self, draw: impl Fn(&VolumeDebug, &mut wgpu::RenderPass<'_>)) -> Vec<[u8; 4]> {
        let size = [self.stage.side; 2];
        let samples = self.gpu.target(size, self.format, self.stage.samples);
        let picture = self.gpu.target(size, self.format, 1);
        let (samples, resolved) = (view_of(&samples), view_of(&picture));
        let target = match self.stage.samples {
            1 => clear(&resolved, wgpu::Color::TRANSPARENT, None),
            _ => clear(&samples, wgpu::Color::TRANSPARENT, Some(&resolved)),
        };
        let read_only = wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth,
            depth_ops: None,
            stencil_ops: None,
        };
        self.gpu.checked(|| {
            self.gpu.run(|encoder| {
                let mut pass = begin(encoder, "debug", &[Some(target)], read_only);
                draw(&self.debug, &mut pass);
            });
        });
        let bytes = self.gpu.read_texture(&picture, 0, wgpu::TextureAspect::All);
        bytes.as_chunks::<4>().0.to_vec()
    }
}

fn bytes([r, g, b, a]: [f32; 4]) -> [u8; 4] {
    [r, g, b, a].map(|x| (x * 255.0).round() as u8)
}

/// A box around another, and a third of which nothing is in the way.
pub fn nested(light: HomogeneousLight) -> Stage {
    let inner = Affine3A::from_scale(Vec3::splat(0.4));
    Stage::new(
        light,
        vec![
            Body::caster(shapes::cube(), at(-1.2, 2.2, 0.0)),
            Body::caster(shapes::cube(), at(-1.2, 2.2, 0.0) * inner),
            Body::caster(shapes::cube(), at(1.8, 1.2, 0.5)),
        ],
    )
}

#[test]
fn counts_have_their_colours() {
    let Some(gpu) = Gpu::for_test() else { return };
    for samples in [1, 4] {
        let stage = Stage {
            samples,
            ..nested(lamp())
        };
        let shown = Shown::new(&gpu, &stage);
        let picture = shown.view(|debug, pass| debug.draw_counts(pass).unwrap());
        let colors = DebugColors::default();
        let of = |count| colors.of_count(count).map_or([0; 4], bytes);
        let counts = Stage {
            samples: 1,
            ..stage.clone()
        }
        .counts(&gpu);
        // What differs between samples is a mixture.
        let pure = |color: &[u8; 4]| samples == 1 || (0..=255).any(|count| of(count) == *color);
        let wrong = |of: &dyn Fn(u8) -> [u8; 4]| {
            let seen = picture.iter().zip(&counts);
            seen.filter(|(color, count)| pure(color) && **color != of(**count))
                .count()
        };
        let number = |count| counts.iter().filter(|c| **c == count).count();
        assert!(number(1) > 1000 && number(2) > 300, "{}", number(2));
        let most = if samples == 1 { 0 } else { 20 };
        assert!(wrong(&of) <= most, "{samples}: {}", wrong(&of));
        // In the colours of counts one higher, almost everything is wrong.
        let off = |count: u8| of(count.wrapping_add(1));
        assert!(wrong(&off) > 60_000, "{}", wrong(&off));
    }
}

#[test]
fn a_box_is_counted_once_and_a_box_in_a_box_twice() {
    let Some(gpu) = Gpu::for_test() else { return };
    let one = Stage::new(
        lamp(),
        vec![Body::caster(shapes::cube(), at(0.0, 2.2, 0.0))],
    );
    let colors = DebugColors::default();
    let picture = |stage: &Stage| {
        Shown::new(&gpu, stage).view(|debug, pass| debug.draw_counts(pass).unwrap())
    };
    let shown = picture(&one);
    let is = |count| bytes(colors.of_count(count).unwrap());
    assert!(shown.iter().all(|c| *c == [0; 4] || *c == is(1)));
    // Where it is coloured, it is in shadow.
    let lit: Vec<u8> = shown
        .iter()
        .map(|c| if *c == [0; 4] { 255 } else { 0 })
        .collect();
    assert_eq!(one.truth().errors(&lit).wrong, 0);
    let shown = picture(&nested(lamp()));
    assert!(shown.iter().filter(|c| **c == is(2)).count() > 300);
}

#[test]
fn high_and_negative_counts_have_colours_of_their_own() {
    let Some(gpu) = Gpu::for_test() else { return };
    let sheets = |count: u32| {
        let sheet = |n| Body::caster(shapes::square(1.0), at(0.0, 1.0 + 2e-5 * n as f32, 0.0));
        Stage::new(
            HomogeneousLight::directional(Vec3::Y),
            (0..count).map(sheet).collect(),
        )
    };
    let colors = DebugColors::default();
    for (count, color) in [
        (7, colors.counts[6]),
        (8, colors.counts[7]),
        (247, colors.counts[7]),
        (248, colors.negative),
        (255, colors.negative),
    ] {
        let stage = sheets(count);
        let picture = Shown::new(&gpu, &stage).view(|debug, pass| debug.draw_counts(pass).unwrap());
        let found = picture.iter().filter(|c| **c == bytes(color)).count();
        assert!(found > 500, "{count}: {found}");
        assert_eq!(colors.of_count(count as u8), Some(color));
    }
}

/// The silhouette edges of a box of half extent 1 in the world, by their definition.
fn box_silhouette(centre: Vec3, light: Vec3) -> Vec<[Vec3; 2]> {
    let toward = light - centre;
    let lit = |axis: usize, sign: f32| toward[axis] * sign > 1.0;
    let mut edges = Vec::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (su, sv) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            if lit(u, su) == lit(v, sv) {
                continue;
            }
            edges.push([-1.0, 1.0].map(|along| {
                let mut corner = Vec3::ZERO;
                corner[axis] = along;
                corner[u] = su;
                corner[v] = sv;
                centre + corner
            }));
        }
    }
    edges
}

fn pixel(stage: &Stage, point: Vec3) -> DVec2 {
    let clip: Vec4 = stage.view().clip_from_world() * point.extend(1.0);
    let side = f64::from(stage.side);
    let (x, y) = (f64::from(clip.x / clip.w), f64::from(clip.y / clip.w));
    DVec2::new((x + 1.0) * 0.5 * side, (1.0 - y) * 0.5 * side)
}

fn distance_to(segment: [DVec2; 2], point: DVec2) -> f64 {
    let along = segment[1] - segment[0];
    let t = (point - segment[0]).dot(along) / along.length_squared();
    (segment[0] + along * t.clamp(0.0, 1.0)).distance(point)
}

/// Line pixels that lie off the edges, and points of the edges that no line pixel is near.
fn misfits(stage: &Stage, picture: &[[u8; 4]], edges: &[[Vec3; 2]]) -> (usize, usize) {
    let edges: Vec<_> = edges.iter().map(|e| e.map(|p| pixel(stage, p))).collect();
    let side = stage.side as usize;
    let drawn: Vec<DVec2> = (0..picture.len())
        .filter(|&i| picture[i] == [255; 4])
        .map(|i| DVec2::new((i % side) as f64 + 0.5, (i / side) as f64 + 0.5))
        .collect();
    assert!(drawn.len() > 100, "{}", drawn.len());
    let off = |p: &&DVec2| edges.iter().all(|&edge| distance_to(edge, **p) > 1.5);
    let points = edges
        .iter()
        .flat_map(|[a, b]| (0..=20).map(move |i| a.lerp(*b, f64::from(i) / 20.0)));
    let bare = |p: &DVec2| drawn.iter().all(|d| d.distance(*p) > 1.5);
    (
        drawn.iter().filter(off).count(),
        points.filter(bare).count(),
    )
}

#[test]
fn lines_lie_on_the_silhouette_and_cover_it() {
    let Some(gpu) = Gpu::for_test() else { return };
    let centre = Vec3::new(0.3, 1.7, 0.2);
    let light = HomogeneousLight::point(Vec3::new(-2.0, 6.0, 2.5));
    let body = Body::caster(shapes::cube(), Affine3A::from_translation(centre));
    let edges = box_silhouette(centre, light.xyzw().truncate());
    assert_eq!(edges.len(), 6);
    let elsewhere = box_silhouette(centre, Vec3::new(5.0, 1.2, 0.0));
    for silhouettes in WAYS {
        let mut stage = Stage::new(light, vec![body.clone()]);
        stage.savings.silhouettes = silhouettes;
        let shown = Shown::new(&gpu, &stage);
        let picture =
            shown.view(|debug, pass| debug.draw_edges(pass, &shown.renderer, 0, 0).unwrap());
        assert_eq!(misfits(&stage, &picture, &edges), (0, 0), "{silhouettes:?}");
        let (off, bare) = misfits(&stage, &picture, &elsewhere);
        assert!(off > 50 && bare > 20, "{silhouettes:?}: {off}, {bare}");
    }
}

/// How many faces each pixel is covered by, all being equally transparent.
pub fn layers(gpu: &Gpu, stage: &Stage) -> Vec<u32> {
    const OPACITY: f32 = 0.25;
    let white = [1.0, 1.0, 1.0, OPACITY];
    let colors = DebugColors {
        sides_z_pass: white,
        sides_z_fail: white,
        light_caps: white,
        dark_caps: white,
        ..Default::default()
    };
    let shown = Shown::with(gpu, stage, colors, false);
    let picture =
        shown.view(|debug, pass| debug.draw_surfaces(pass, &shown.renderer, 0, 0).unwrap());
    let layers = |color: &[u8; 4]| {
        let left = 1.0 - f32::from(color[3]) / 255.0;
        (left.ln() / (1.0 - OPACITY).ln()).round() as u32
    };
    picture.iter().map(layers).collect()
}

#[test]
fn the_surface_of_a_convex_volume_covers_each_pixel_twice_or_not_at_all() {
    let Some(gpu) = Gpu::for_test() else { return };
    for silhouettes in WAYS {
        let mut stage = Stage::new(
            lamp(),
            vec![Body::caster(shapes::cube(), at(0.0, 2.0, 0.0))],
        );
        stage.range = Some(6.0);
        stage.savings.silhouettes = silhouettes;
        stage.savings.unculled = true;
        stage.savings.extrusion = Extrusion::ToRange;
        stage.savings.method = Method::ZFail;
        let closed = layers(&gpu, &stage);
        assert!(closed.iter().all(|n| [0, 2].contains(n)), "{silhouettes:?}");
        assert!(closed.iter().filter(|n| **n == 2).count() > 2000);
        // z-pass draws no caps: where one is missing, there is one layer.
        stage.savings.method = Method::ZPass;
        let open = layers(&gpu, &stage);
        assert!(
            open.iter().filter(|n| **n == 1).count() > 500,
            "{silhouettes:?}"
        );
    }
}

#[test]
fn surfaces_have_the_colours_of_their_methods_and_hide_behind_the_scene() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut stage = mixed(sun());
    let of = |stage: &Stage, colors: DebugColors| {
        let shown = Shown::with(&gpu, stage, colors, true);
        shown.view(|debug, pass| debug.draw_surfaces(pass, &shown.renderer, 0, 0).unwrap())
    };
    let (red, green) = ([1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]);
    let colors = DebugColors {
        sides_z_pass: red,
        sides_z_fail: green,
        light_caps: [0.0; 4],
        dark_caps: [0.0; 4],
        ..Default::default()
    };
    let number =
        |picture: &[[u8; 4]], color| picture.iter().filter(|c| **c == bytes(color)).count();
    for (method, own, other) in [(Method::ZPass, red, green), (Method::ZFail, green, red)] {
        stage.savings.method = method;
        let picture = of(&stage, colors);
        assert!(
            number(&picture, own) > 1000,
            "{method:?}: {}",
            number(&picture, own)
        );
        assert_eq!(number(&picture, other), 0, "{method:?}");
        // The ground hides what is below it: there is more of the same volumes without.
        let shown = Shown::with(&gpu, &stage, colors, false);
        let all =
            shown.view(|debug, pass| debug.draw_surfaces(pass, &shown.renderer, 0, 0).unwrap());
        let [seen, all] = [&picture, &all].map(|p| number(p, own));
        assert!(all > seen + 500, "{method:?}: {seen} of {all}");
    }
}

#[test]
fn casters_have_the_colours_of_what_was_decided_for_them() {
    let Some(gpu) = Gpu::for_test() else { return };
    // Straight below the eye's line to the light a caster needs z-fail; one beside it does not; one
    // is out of range; and the shadow of one goes away from the view.
    let places = [
        (Vec3::new(0.3, 4.6, 5.0), 0.3, CasterState::ZFail),
        (Vec3::new(-1.5, 0.8, 0.0), 0.5, CasterState::ZPass),
        (Vec3::new(2.8, 0.8, -2.6), 0.5, CasterState::OutOfRange),
    ];
    let stage = |silhouettes| {
        let body = |(centre, half, _): (Vec3, f32, CasterState)| {
            let place = Affine3A::from_translation(centre);
            Body::caster(
                shapes::cube(),
                place * Affine3A::from_scale(Vec3::splat(half)),
            )
        };
        let mut stage = Stage::new(
            HomogeneousLight::point(Vec3::new(-0.4, 4.2, 1.0)),
            places.into_iter().map(body).collect(),
        );
        stage.range = Some(4.6);
        stage.savings.silhouettes = silhouettes;
        stage
    };
    let colors = DebugColors {
        casters_z_pass: [0.0, 1.0, 0.0, 1.0],
        casters_z_fail: [1.0, 0.0, 0.0, 1.0],
        casters_out_of_range: [0.0, 0.0, 1.0, 1.0],
        ..Default::default()
    };
    for silhouettes in WAYS {
        let stage = stage(silhouettes);
        let mut shown = Shown::with(&gpu, &stage, colors, true);
        let view = stage.view();
        let frame = OneLight {
            range: stage.range,
            ..OneLight::new(&view, stage.light, &shown.casters)
        };
        let states = shown.renderer.caster_states(0, 0);
        assert_eq!(states, places.map(|(_, _, state)| state), "{silhouettes:?}");
        let (debug, renderer) = (&mut shown.debug, &shown.renderer);
        frame
            .with(|frame| debug.prepare(&gpu.device, frame, renderer, 0, 0))
            .unwrap();
        let picture = shown.view(|debug, pass| debug.draw_casters(pass));
        let at = |point| {
            let p = pixel(&stage, point);
            picture[p.y as usize * stage.side as usize + p.x as usize]
        };
        for (centre, _, state) in places {
            assert_eq!(
                at(centre),
                bytes(colors.of_state(state).unwrap()),
                "{state:?}"
            );
        }
        // Whoever swaps two casters sees it.
        assert!(at(places[0].0) != at(places[1].0));
    }
}

#[test]
fn every_convention_and_way_draws_without_complaint() {
    let Some(gpu) = Gpu::for_test() else { return };
    for depth in crate::choices::depths(&gpu) {
        for silhouettes in WAYS {
            let mut stage = mixed(lamp());
            stage.depth = depth;
            stage.savings.silhouettes = silhouettes;
            let mut shown = Shown::new(&gpu, &stage);
            let view = stage.view();
            let frame = OneLight::new(&view, stage.light, &shown.casters);
            let (debug, renderer) = (&mut shown.debug, &shown.renderer);
            frame
                .with(|frame| debug.prepare(&gpu.device, frame, renderer, 0, 0))
                .unwrap();
            let picture = shown.view(|debug, pass| {
                debug.draw_casters(pass);
                debug.draw_surfaces(pass, &shown.renderer, 0, 0).unwrap();
                debug.draw_edges(pass, &shown.renderer, 0, 0).unwrap();
            });
            let drawn = picture.iter().filter(|c| **c != [0; 4]).count();
            assert!(drawn > 5000, "{depth:?}, {silhouettes:?}: {drawn}");
        }
    }
}
