//! Where the wrong pixels of a sun's cascades are, and why: by cascade, by visible surface, and by the size
//! of texels in pixels.
//!
//! ```text
//! cargo run --all-features --example cascade_errors -- --scene valley --size 640x360 TRY..
//! ```
//! Each `TRY` is a list of settings, see [`Try::parse`]; at least one is needed.

use std::collections::BTreeMap;

use anyhow::{Context as _, Result, bail, ensure};
use compare::stage::Stage;
use host::gpu::Gpu;
use host::image::rgb_png;
use host::peer_light::PeerInputs;
use host::peer_map::PeerMap;
use host::peers::WARPED;
use host::pipelines::visibility_module;
use host::renderer::ShadowAccess;
use host::terminal::say;
use host::warped;
use shadows::glam::{DVec3, DVec4, Mat4, Quat};
use shadows::reference::{Hit, Interior, Verdict};
use shadows::{
    AtlasFrame, AtlasLight, AtlasView, CascadeFit, CascadeSplit, Cascades, DirectionalLight,
    Kernel, MapKind, MapSettings, PcfDescriptor, PcfSampler, Radius, ShadowAtlas,
    ShadowAtlasDescriptor, TileSize,
};

/// One way to shadow the sun.
#[derive(Clone, Debug)]
struct Try {
    name: String,
    size: u32,
    cascades: Cascades,
    whole: bool,
    kernel: Kernel,
    reach: f32,
    sampled: bool,
    /// One warped map instead.
    warp: bool,
}

impl Try {
    /// `size:1024,count:4,lambda:0.85,fit:tight,distance:900,margin:0.03,blend:0.1,kernel:hard,reach:1,depths:1`,
    /// or `warp:1,size:2048`, and `depths:1` with that.
    fn parse(text: &str, distance: f32) -> Result<Self> {
        let mut made = Self {
            name: text.into(),
            size: 1024,
            cascades: Cascades {
                distance,
                ..Default::default()
            },
            whole: false,
            kernel: Kernel::Bilinear,
            reach: 12.0,
            sampled: false,
            warp: false,
        };
        for setting in text.split(',').filter(|setting| !setting.is_empty()) {
            let (key, value) = setting.split_once(':').context("KEY:VALUE")?;
            let number = || value.parse::<f32>();
            match key {
                "size" => made.size = value.parse()?,
                "count" => made.cascades.count = value.parse()?,
                "lambda" => made.cascades.split = CascadeSplit::Practical { lambda: number()? },
                "fit" => {
                    made.cascades.fit = match value {
                        "tight" => CascadeFit::Tight,
                        "stable" => CascadeFit::Stable,
                        _ => bail!("stable or tight"),
                    }
                }
                "distance" => made.cascades.distance = number()?,
                "margin" => made.cascades.margin = number()?,
                "blend" => made.cascades.blend = number()?,
                "reach" => made.reach = number()?,
                "warp" => made.warp = number()? > 0.0,
                "depths" => made.sampled = number()? > 0.0,
                "ground" => made.cascades.split = CascadeSplit::Ground { nearest: number()? },
                "whole" => made.whole = number()? > 0.0,
                "kernel" => {
                    made.kernel = match value {
                        "hard" => Kernel::Hard,
                        "2x2" => Kernel::Bilinear,
                        "5x5" => Kernel::Weighted5,
                        _ => bail!("hard, 2x2 or 5x5"),
                    }
                }
                _ => bail!("{key}?"),
            }
        }
        Ok(made)
    }
}

struct Seen {
    visibility: Vec<u8>,
    tiles: Vec<(Mat4, u32)>,
}

/// By the paper's matrix, and the rest as wgpu's own example has it.
fn warped(gpu: &Gpu, stage: &Stage, of: &Try) -> Seen {
    let mut map = PeerMap::new(gpu, &WARPED, of.size);
    let access = ShadowAccess {
        module: Some(&map.module()),
        layout: Some(map.bind_group_layout()),
        ..Default::default()
    };
    let lit = stage.renderer.lit_pipeline(gpu, &access);
    let inputs = &stage.inputs;
    let depths = inputs.depths.filter(|_| of.sampled);
    let seen = warped::Seen {
        clip_from_world: inputs.view.clip_from_world(),
        nearest: depths.map(|depths| depths.nearest),
        far: depths.map_or(inputs.seen, |depths| depths.farthest),
    };
    map.prepare(
        gpu,
        &PeerInputs {
            light: inputs.light.xyzw(),
            cone: None,
            range: inputs.range,
            bounds: inputs.receivers,
            seen: Some(seen),
        },
    );
    gpu.run(|encoder| {
        stage.renderer.draw_ambient(encoder, &stage.scene_gpu);
        map.encode(&stage.scene_gpu, encoder);
        let group = Some(map.bind_group());
        stage
            .renderer
            .draw_lit_by(encoder, &stage.scene_gpu, 0, &lit, group);
    });
    Seen {
        visibility: stage.renderer.read_visibility(gpu),
        tiles: vec![(map.clip_from_world(), of.size)],
    }
}

fn shown(gpu: &Gpu, stage: &Stage, of: &Try) -> Result<Seen> {
    if of.warp {
        return Ok(warped(gpu, stage, of));
    }
    let mut atlas = ShadowAtlas::new(
        &gpu.device,
        &ShadowAtlasDescriptor {
            layer_size: of.size.max(2048),
            settings: MapSettings {
                reach: Radius::Texels(of.reach),
                ..Default::default()
            },
            memory: 1 << 30,
            ..Default::default()
        },
    )?;
    let sampler = PcfSampler::new(
        &gpu.device,
        &gpu.queue,
        &PcfDescriptor {
            kernel: of.kernel,
            map: MapKind::ATLAS,
            ..Default::default()
        },
    )?;
    let lit = stage.renderer.lit_pipeline(
        gpu,
        &ShadowAccess {
            module: Some(&visibility_module(&sampler)),
            layout: Some(sampler.bind_group_layout()),
            ..Default::default()
        },
    );
    let sun = DirectionalLight::new(stage.inputs.light.xyzw().truncate());
    let light = AtlasLight::directional(sun, of.cascades).with_size(TileSize::Fixed(of.size));
    let [width, height] = stage.renderer.size();
    let mut view = AtlasView::new(&stage.inputs.view, width, height);
    view.depth_bounds = stage.inputs.depths.filter(|_| of.sampled);
    let views = [view];
    let frame = AtlasFrame {
        lights: &[light],
        casters: &stage.inputs.of_maps(),
        views: if of.whole { &[] } else { &views },
        receivers: Some(stage.inputs.receivers),
    };
    atlas.prepare(&gpu.device, &gpu.queue, &frame)?;
    let group = sampler.bind_group(&gpu.device, &atlas)?;
    gpu.run(|encoder| {
        stage.renderer.draw_ambient(encoder, &stage.scene_gpu);
        atlas.encode_with(encoder, |pass, asked| {
            let first = stage.inputs.casters.len();
            stage.scene_gpu.draw_masked(first, pass, asked);
        });
        stage
            .renderer
            .draw_lit_by(encoder, &stage.scene_gpu, 0, &lit, Some(&group));
    });
    let tiles = atlas.tiles(0, 0);
    Ok(Seen {
        visibility: stage.renderer.read_visibility(gpu),
        tiles: tiles
            .iter()
            .map(|tile| (tile.clip_from_world, tile.size))
            .collect(),
    })
}

/// Sides of a texel at a point, across the light: of its longer one.
fn texel(matrix: &Mat4, size: u32, position: DVec3) -> f64 {
    let rows = matrix.as_dmat4().transpose();
    let clip = matrix.as_dmat4() * position.extend(1.0);
    // Of a warped map it is another at each point, and in each direction.
    let slope = |row: DVec4, at: f64| (row - at / clip.w * rows.w_axis).truncate() / clip.w;
    let slopes = [slope(rows.x_axis, clip.x), slope(rows.y_axis, clip.y)];
    let shortest = slopes
        .map(DVec3::length)
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    2.0 / shortest / f64::from(size)
}

/// The cascade that a point reads.
fn cascade(seen: &Seen, reads: f64, position: DVec3) -> usize {
    let holds = |(matrix, size): &(Mat4, u32)| {
        let clip = matrix.as_dmat4() * DVec4::from((position, 1.0));
        let half = 0.5 * f64::from(*size);
        half - reads - half * clip.x.abs().max(clip.y.abs()) > 0.0 && clip.z <= 1.0
    };
    let last = seen.tiles.len() - 1;
    seen.tiles.iter().position(holds).unwrap_or(last)
}

/// What the light's rays meet around a point, as the map has them: six texels along a side, with its texels'
/// borders; `#` where a ray is blocked on its way to the point's tangent plane, `o` at the centres of texels
/// where it is not, `@` where it is, `+` at the point. Masks count as opaque.
fn close_up(stage: &Stage, hit: &Hit, matrix: Mat4, size: u32) -> String {
    const PER_TEXEL: i32 = 8;
    let matrix = matrix.as_dmat4();
    let half = 0.5 * f64::from(size);
    let clip = |point: DVec3| matrix * DVec4::from((point, 1.0));
    // In texels, y downwards.
    let place = |clip: DVec4| [half * (1.0 + clip.x), half * (1.0 - clip.y)];
    let own = place(clip(hit.position));
    let corner = own.map(|at| at.floor() - 2.0);
    // Depth of the tangent plane: linear over the map.
    let sides = hit.normal.any_orthonormal_pair();
    let [a, b] = [sides.0, sides.1].map(|side| clip(hit.position + side) - clip(hit.position));
    let across = DVec3::new(a.x, a.y, a.z).cross(DVec3::new(b.x, b.y, b.z));
    let plane = |[x, y]: [f64; 2]| {
        let [dx, dy] = [(x - own[0]) / half, -(y - own[1]) / half];
        clip(hit.position).z - (across.x * dx + across.y * dy) / across.z
    };
    let mut near = Vec::new();
    for (number, object) in stage
        .scene
        .objects
        .iter()
        .enumerate()
        .filter(|(_, o)| o.casts)
    {
        let mesh = &stage.scene.meshes[object.mesh];
        for triangle in mesh.triangles() {
            let corners = triangle.map(|i| clip(object.world_point(mesh.positions[i as usize])));
            let places = corners.map(place);
            let beside = |axis: usize| {
                let all = places.map(|at| at[axis] - corner[axis]);
                all.iter().all(|at| *at < 0.0) || all.iter().all(|at| *at > 6.0)
            };
            if !beside(0) && !beside(1) {
                near.push((number, places, corners.map(|corner| corner.z)));
            }
        }
    }
    let mut blockers = BTreeMap::new();
    let mut rows = Vec::new();
    for row in 0..6 * PER_TEXEL {
        let mut line = String::new();
        for column in 0..6 * PER_TEXEL {
            let at = [column, row].map(|n| (f64::from(n) + 0.5) / f64::from(PER_TEXEL));
            let at = [corner[0] + at[0], corner[1] + at[1]];
            let is_middle = |n: i32| n % PER_TEXEL == PER_TEXEL / 2;
            let middle = is_middle(row) && is_middle(column);
            let at = match middle {
                true => at.map(|at| at.floor() + 0.5),
                false => at,
            };
            let depth = plane(at);
            let mut nearest = depth + 1e-9;
            for (number, places, depths) in &near {
                if let Some(met) = depth_at(places, depths, at).filter(|met| *met > nearest) {
                    nearest = met;
                    *blockers.entry(*number).or_insert(0.0_f64) =
                        (met - depth).max(blockers.get(number).copied().unwrap_or(0.0));
                }
            }
            let blocked = nearest > depth + 1e-9;
            let is_own = [0, 1]
                .iter()
                .all(|&axis| (at[axis] - own[axis]).abs() <= 0.5 / f64::from(PER_TEXEL));
            line.push(match (middle, blocked) {
                (true, true) => '@',
                (true, false) => 'o',
                _ if is_own => '+',
                (_, true) => '#',
                _ if column % PER_TEXEL == 0 || row % PER_TEXEL == 0 => ':',
                _ => '.',
            });
        }
        rows.push(line);
    }
    let range = 1.0 / matrix.row(2).truncate().length();
    for (number, above) in blockers {
        let object = &stage.scene.objects[number];
        rows.push(format!(
            "  {} ({}): up to {:.4} above, texel {:.4}",
            stage.scene.meshes[object.mesh].name,
            object.name,
            above * range,
            2.0 / matrix.row(0).truncate().length() / f64::from(size),
        ));
    }
    rows.join("\n")
}

/// The depth of a triangle at a place of the map.
fn depth_at(places: &[[f64; 2]; 3], depths: &[f64; 3], at: [f64; 2]) -> Option<f64> {
    let twice = |a: [f64; 2], b: [f64; 2]| {
        (a[0] - at[0]) * (b[1] - at[1]) - (a[1] - at[1]) * (b[0] - at[0])
    };
    let [a, b, c] = *places;
    let weights = [twice(b, c), twice(c, a), twice(a, b)];
    let inside = weights.iter().all(|w| *w >= 0.0) || weights.iter().all(|w| *w <= 0.0);
    let area: f64 = weights.iter().sum();
    let sum: f64 = weights.iter().zip(depths).map(|(w, d)| w * d).sum();
    (inside && area != 0.0).then(|| sum / area)
}

#[derive(Default, Clone)]
struct Tally {
    pixels: usize,
    lit: usize,
    shadow: usize,
    interior: usize,
    ratios: Vec<f64>,
}

impl Tally {
    fn add(&mut self, verdict: Verdict, interior: bool, ratio: f64) {
        self.pixels += 1;
        match verdict {
            Verdict::FalseLit | Verdict::FalseLitInterior => self.lit += 1,
            Verdict::FalseShadow | Verdict::FalseShadowInterior => self.shadow += 1,
            _ => {}
        }
        self.interior += usize::from(interior);
        self.ratios.push(ratio);
    }

    fn line(&mut self, all: usize) -> String {
        self.ratios.sort_by(f64::total_cmp);
        let median = self.ratios.get(self.ratios.len() / 2).copied();
        let per = |count: usize, of: usize| 100.0 * count as f64 / of.max(1) as f64;
        format!(
            "{:6.2} % of pixels, wrong {:6.2} % of these ({:5.2} % of all: {:5.2} lit, {:5.2} dark), interior {}, texel/pixel {:.2}",
            per(self.pixels, all),
            per(self.lit + self.shadow, self.pixels),
            per(self.lit + self.shadow, all),
            per(self.lit, all),
            per(self.shadow, all),
            self.interior,
            median.unwrap_or(0.0)
        )
    }
}

fn main() -> Result<()> {
    let mut scene = "valley".to_owned();
    let mut size = [640, 360];
    let mut tries = Vec::new();
    let mut out = std::path::PathBuf::from("target/cascade-errors");
    let mut inside = false;
    let mut turn = 0.0_f32;
    let mut down_sun = 0.0_f32;
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut value = || args.next().context("a value");
        match arg.as_str() {
            "--scene" => scene = value()?,
            "--size" => {
                let text = value()?;
                let (w, h) = text.split_once('x').context("WxH")?;
                size = [w.parse()?, h.parse()?];
            }
            "--out" => out = value()?.into(),
            "--interior" => inside = true,
            // Of the camera where it stands, degrees to the left.
            "--turn" => turn = value()?.parse()?,
            // What it looks at is seen from so many metres toward the sun.
            "--down-sun" => down_sun = value()?.parse()?,
            _ => tries.push(arg),
        }
    }
    ensure!(!tries.is_empty(), "no try");
    let gpu = Gpu::new(None)?;
    let mut scene = host::scene::load(&scene, false, None)?;
    let camera = &mut scene.camera;
    let turned = Quat::from_rotation_y(turn.to_radians()) * (camera.target - camera.eye);
    camera.target = camera.eye + turned;
    if down_sun > 0.0 {
        camera.eye = camera.target + down_sun * scene.lights[0].place.truncate().normalize();
    }
    let stage = Stage::new(&gpu, scene, size)?;
    let start = std::time::Instant::now();
    let truth = stage.reference(|_| ())?;
    say(&format!("reference {:.1} s", start.elapsed().as_secs_f64()))?;
    let bounds = stage.inputs.depths;
    let b = stage.scene.bounds();
    say(&format!(
        "{bounds:?} seen {} scene {:?}",
        stage.inputs.seen,
        b.size()
    ))?;
    let camera = &stage.scene.camera;
    let axis = (camera.target - camera.eye).as_dvec3().normalize();
    let per_pixel = 2.0 * f64::from(camera.fovy * 0.5).tan() / f64::from(size[1]);
    std::fs::create_dir_all(&out)?;
    let all = truth.lit_facing();
    let groups: Vec<String> = stage
        .scene
        .objects
        .iter()
        .map(|object| stage.scene.meshes[object.mesh].name.clone())
        .collect();
    for (number, text) in tries.iter().enumerate() {
        let of = Try::parse(text, 1.5 * stage.inputs.seen)?;
        let seen = shown(&gpu, &stage, &of)?;
        let kernel_radius = host::interior::radius_in_texels(of.kernel);
        let found = truth.compare(&seen.visibility, Interior::Screen)?;
        // Each cascade by its own texels.
        let own: Vec<_> = match inside {
            false => Vec::new(),
            true => seen
                .tiles
                .iter()
                .map(|&(clip_from_world, size)| {
                    let interior = Interior::FlatMap {
                        clip_from_world,
                        size,
                        kernel_radius,
                    };
                    truth.compare(&seen.visibility, interior)
                })
                .collect::<Result<_, _>>()?,
        };
        let mut total = Tally::default();
        let mut shown_up = 0;
        let mut by_cascade: BTreeMap<usize, Tally> = BTreeMap::new();
        let mut by_group: BTreeMap<&str, Tally> = BTreeMap::new();
        let mut picture = Vec::new();
        for (pixel, verdict) in found.verdicts.iter().enumerate() {
            let [x, y] = [pixel as u32 % size[0], pixel as u32 / size[0]];
            let Some(hit) = truth.hit(x, y) else {
                picture.push([90, 100, 120]);
                continue;
            };
            let reads = match of.kernel {
                Kernel::Weighted5 => 3.5,
                Kernel::Bilinear => 2.5,
                _ => 1.5,
            };
            let at = cascade(&seen, reads, hit.position);
            let (matrix, tile) = seen.tiles[at];
            let texel = texel(&matrix, tile, hit.position);
            let depth = axis.dot(hit.position - camera.eye.as_dvec3());
            let ratio = texel / (depth * per_pixel);
            let interior = own.get(at).is_some_and(|own| {
                matches!(
                    own.verdicts[pixel],
                    Verdict::FalseLitInterior | Verdict::FalseShadowInterior
                )
            });
            let tint = [[200, 80, 80], [80, 200, 80], [80, 80, 200], [200, 200, 80]][at % 4];
            let right = if seen.visibility[pixel] >= 128 { 3 } else { 6 };
            let color = match verdict {
                Verdict::NotCounted => [40, 40, 40],
                Verdict::Right => tint.map(|c: u8| c / right),
                Verdict::FalseLit | Verdict::FalseLitInterior => [255, 255, 255],
                Verdict::FalseShadow | Verdict::FalseShadowInterior => [255, 0, 255],
            };
            picture.push(color);
            if interior && shown_up < 6 {
                shown_up += 1;
                let facing = hit
                    .normal
                    .dot(stage.inputs.light.xyzw().truncate().as_dvec3().normalize());
                say(&format!(
                    "{verdict:?} at {x},{y} {} N.L {facing:.4} cascade {at}",
                    groups[hit.object as usize]
                ))?;
                // A close-up takes the map's matrix as affine.
                match of.warp {
                    true => say("no close-up: the map is warped")?,
                    false => say(&close_up(&stage, &hit, matrix, tile))?,
                }
            }
            if *verdict != Verdict::NotCounted {
                total.add(*verdict, interior, ratio);
                by_cascade
                    .entry(at)
                    .or_default()
                    .add(*verdict, interior, ratio);
                by_group
                    .entry(&groups[hit.object as usize])
                    .or_default()
                    .add(*verdict, interior, ratio);
            }
        }
        say(&format!("== {}\n   all       {}", of.name, total.line(all)))?;
        for (at, tally) in &mut by_cascade {
            let (matrix, tile) = seen.tiles[*at];
            let mut line = format!("   cascade {at} {}", tally.line(all));
            // A warped map has no one width.
            if !of.warp {
                let width = 2.0 / matrix.row(0).truncate().length();
                let texel = width / tile as f32;
                line += &format!(", width {width:.1} texel {texel:.4}");
            }
            say(&line)?;
        }
        for (group, tally) in &mut by_group {
            if tally.pixels * 200 > all {
                say(&format!("   {group:10} {}", tally.line(all)))?;
            }
        }
        std::fs::write(out.join(format!("{number}.png")), rgb_png(size, &picture)?)?;
    }
    Ok(())
}
