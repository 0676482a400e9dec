//! What was found, as JSON for programs and as Markdown for people.

use std::fmt::Write as _;

use serde::Serialize;
use serde_json::Value;
use shadows::mesh::MeshKind;
use shadows::wgpu;

use crate::date::{date, now};
use crate::lamps::Truth;
use crate::measure::{self, Measured};
use crate::soft::{self, Soft};
use crate::stage::Stage;
use crate::survey::Bake;
use host::gpu::{Gpu, describe};

/// report.json. Numbers that were `f32` are written so that they read back as the same `f32`.
#[derive(Serialize)]
pub struct Report {
    pub adapter: Adapter,
    /// Seconds since 1970 when the report was made.
    pub unix_time: u64,
    /// Pixels: width, height.
    pub size: [u32; 2],
    pub camera: Camera,
    /// Those that the techniques shadow, each as far as it can.
    pub lights: Vec<Light>,
    pub scene_name: String,
    pub scene: Vec<Object>,
    /// What the scene's file holds besides.
    pub left_out_of_file: Vec<String>,
    /// Techniques that cannot shadow this light, each with the reason.
    pub left_out: Vec<LeftOut>,
    pub techniques: Vec<Technique>,
    pub reference: Reference,
}

#[derive(Serialize)]
pub struct Adapter {
    pub name: String,
    pub backend: String,
    pub driver: String,
}

#[derive(Serialize)]
pub struct Camera {
    pub eye: [f32; 3],
    pub target: [f32; 3],
    pub up: [f32; 3],
    /// Vertical, radians.
    pub fovy: f32,
    pub near: f32,
    /// Column-major.
    pub clip_from_world: [f32; 16],
    pub depth: &'static str,
}

#[derive(Serialize)]
pub struct Light {
    /// Homogeneous, world space.
    pub place: [f32; 4],
    /// Of a spot, else null.
    pub cone: Option<Cone>,
    pub range: f32,
    /// Where its map's frusta begin.
    pub shadow_near: Option<f32>,
}

#[derive(Serialize)]
pub struct Cone {
    pub direction: [f32; 3],
    /// Radians.
    pub half_angle: f32,
}

#[derive(Serialize)]
pub struct Object {
    pub name: String,
    pub triangles: usize,
    /// "closed" or "general": which shadow volume its mesh gets.
    pub kind: &'static str,
    pub casts: bool,
}

#[derive(Clone, Serialize)]
pub struct LeftOut {
    pub name: String,
    pub reason: &'static str,
}

/// Milliseconds.
#[derive(Serialize)]
pub struct Times {
    pub median: f64,
    pub min: f64,
    /// How many rounds were timed.
    pub samples: usize,
    pub clock: &'static str,
}

#[derive(Serialize)]
pub struct Technique {
    pub name: String,
    /// How many of the lights it shadows.
    pub lights: usize,
    pub settings: Value,
    /// Whether what did not move was kept from frame to frame, as all of it did not.
    pub keeps: bool,
    pub prepare_ms: Times,
    pub generate_ms: Times,
    pub shade_ms: Times,
    /// Median of the rounds' sums of the three.
    pub total_ms: f64,
    pub false_lit: usize,
    pub false_shadow: usize,
    pub false_lit_percent: f64,
    pub false_shadow_percent: f64,
    pub false_lit_interior: usize,
    pub false_shadow_interior: usize,
    pub rmse: f64,
    /// Null for kernels that make no soft edges.
    pub soft: Option<Soft>,
    /// Null for what is found anew in each frame.
    pub bake: Option<Bake>,
    pub bytes: u64,
    pub draws: u64,
    pub triangles_drawn: u64,
}

#[derive(Serialize)]
pub struct Reference {
    pub pixels: usize,
    pub lit_facing: usize,
    pub seconds: f64,
}

impl Report {
    /// Puts together what was measured on one stage.
    pub fn new(
        gpu: &Gpu,
        stage: &Stage,
        truth: &Truth,
        measured: &[Measured],
        left_out: &[LeftOut],
    ) -> Self {
        let size = stage.renderer.size();
        Self {
            adapter: adapter(&gpu.info),
            unix_time: now(),
            size,
            camera: camera(stage),
            lights: stage.scene.lights.iter().map(Light::new).collect(),
            scene_name: stage.scene.name.clone(),
            scene: objects(stage),
            left_out_of_file: stage.scene.left_out.clone(),
            left_out: left_out.to_vec(),
            techniques: measured.iter().map(Technique::new).collect(),
            reference: Reference {
                pixels: size[0] as usize * size[1] as usize,
                lit_facing: truth.lit_facing(),
                seconds: truth.seconds(),
            },
        }
    }

    /// report.json.
    pub fn json(&self) -> serde_json::Result<String> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// report.md.
    pub fn markdown(&self, gpu: &Gpu, export: bool) -> String {
        let mut out = String::new();
        // Writing to a string cannot fail.
        let _ = self.write_markdown(&mut out, &describe(&gpu.info), export);
        out
    }

    /// A few aligned lines for a terminal.
    pub fn summary(&self) -> String {
        let mut out = format!("{}:", self.scene_name);
        for t in &self.techniques {
            let wrong = t.false_lit_percent + t.false_shadow_percent;
            let interior = t.false_lit_interior + t.false_shadow_interior;
            let _ = write!(
                out,
                "\n  {:<15} {:>9.2} ms  {wrong:>8.4} % wrong, {interior} in the interior",
                t.name, t.total_ms
            );
        }
        out
    }

    fn write_markdown(&self, out: &mut String, adapter: &str, export: bool) -> std::fmt::Result {
        writeln!(out, "# Shadows of the scene “{}”\n", self.scene_name)?;
        writeln!(out, "{adapter}, {}.\n", date(self.unix_time))?;
        self.write_scene(out)?;
        self.write_table(out)?;
        let rows = self.techniques.iter();
        let soft = rows.filter_map(|t| Some((t.name.as_str(), t.soft?)));
        soft::write_table(out, &soft.collect::<Vec<_>>())?;
        for left in &self.left_out {
            writeln!(out, "`{}` is left out: {}.\n", left.name, left.reason)?;
        }
        self.write_legend(out)?;
        self.write_pictures(out, export)
    }

    fn write_scene(&self, out: &mut String) -> std::fmt::Result {
        let triangles: usize = self.scene.iter().map(|object| object.triangles).sum();
        let casters: Vec<&Object> = self.scene.iter().filter(|object| object.casts).collect();
        let casting: usize = casters.iter().map(|object| object.triangles).sum();
        let closed = casters.iter().filter(|c| c.kind == "closed").count();
        let light = match self.lights.as_slice() {
            [only] => only.described(),
            many => described(many),
        };
        writeln!(
            out,
            "{} x {} pixels; {} objects of {triangles} triangles, of which {} cast ({casting} \
             triangles, {closed} closed meshes, {} others). {light}.\n",
            self.size[0],
            self.size[1],
            self.scene.len(),
            casters.len(),
            casters.len() - closed,
        )?;
        match self.left_out_of_file.as_slice() {
            [] => Ok(()),
            others => writeln!(out, "Left out of its file: {}.\n", others.join(", ")),
        }
    }

    fn write_table(&self, out: &mut String) -> std::fmt::Result {
        writeln!(
            out,
            "| technique | total ms | prepare | generate | shade | false lit | false shadow \
             | interior errors | RMSE | memory | draws | triangles |\n\
             |---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|"
        )?;
        for t in &self.techniques {
            writeln!(
                out,
                "| `{}`{} | {:.2} | {:.3} | {:.2} | {:.2} | {:.4} % ({}) | {:.4} % ({}) | {} + {} \
                 | {:.4} | {:.2} MiB | {} | {} |",
                t.name,
                match t.lights {
                    all if all == self.lights.len() => String::new(),
                    some => format!(" ({some} lights)"),
                },
                t.total_ms,
                t.prepare_ms.median,
                t.generate_ms.median,
                t.shade_ms.median,
                t.false_lit_percent,
                t.false_lit,
                t.false_shadow_percent,
                t.false_shadow,
                t.false_lit_interior,
                t.false_shadow_interior,
                t.rmse,
                t.bytes as f64 / f64::from(1 << 20),
                t.draws,
                t.triangles_drawn,
            )?;
        }
        writeln!(out)
    }

    fn write_legend(&self, out: &mut String) -> std::fmt::Result {
        writeln!(
            out,
            "Times are medians of {} rounds in milliseconds, the techniques in turn within each \
             round: *prepare* on the CPU; *generate*, the map or the volumes with their \
             stencil pass; *shade*, the lit pass less the lit pass without shadows (noise can make \
             it negative, and so can a stencil test that spares more than it costs). {}\n",
            self.techniques.first().map_or(0, |t| t.generate_ms.samples),
            match self.techniques.first().map(|t| t.generate_ms.clock) {
                Some("gpu") => "*generate* and *shade* are GPU time between two timestamps.",
                _ => "All are wall time, from the first command recorded until the device is done.",
            }
        )?;
        writeln!(
            out,
            "Errors are in per cent (and pixels) of the {} {}, \
             against rays cast in f64 ({:.1} s). *Interior errors* (false lit + false shadow) are \
             those that resolution cannot excuse: a pixel, and for maps 1.5 texels and the \
             kernel's radius, away from any edge.\n",
            self.reference.lit_facing,
            match self.lights.len() {
                1 => "pixels whose surface faces the light",
                _ => {
                    "pairs of a pixel and a light that its surface faces within range: a pixel counts \
                     once for each such light, right or wrong (a technique that cannot do all lights \
                     is judged by those it can)"
                }
            },
            self.reference.seconds
        )?;
        for t in &self.techniques {
            let settings = t.settings.as_object().into_iter().flatten();
            let list: Vec<String> = settings
                .map(|(name, value)| match (value.as_str(), value.as_f64()) {
                    (Some(text), _) => format!("{} {text}", name.replace('_', " ")),
                    // They are f32: as f64 they would show digits that nobody chose.
                    (_, Some(number)) => format!("{} {}", name.replace('_', " "), number as f32),
                    _ => format!("{} {value}", name.replace('_', " ")),
                })
                .collect();
            writeln!(out, "- `{}`: {}{}", t.name, list.join(", "), baked(t.bake))?;
        }
        writeln!(out)
    }

    fn write_pictures(&self, out: &mut String, export: bool) -> std::fmt::Result {
        writeln!(out, "![Time and error](speed-vs-error.svg)\n")?;
        writeln!(
            out,
            "[The reference's visibility](reference.visibility.png), [which surfaces face the \
             light](coverage.png){}. Error pictures: red is false lit, blue false shadow.\n",
            if export {
                ", [the scene](scene.ply)"
            } else {
                ""
            }
        )?;
        for t in &self.techniques {
            let name = &t.name;
            writeln!(out, "## {name}\n")?;
            writeln!(
                out,
                "![{name}]({name}.shaded.png)\n\n![its errors]({name}.error.png)\n\n\
                 [Its visibility]({name}.visibility.png)\n"
            )?;
        }
        Ok(())
    }
}

impl Technique {
    fn new(measured: &Measured) -> Self {
        let error = &measured.error;
        Self {
            name: measured.technique.name.to_string(),
            lights: measured.lights,
            settings: measured.technique.settings(),
            keeps: measured.technique.config.keeps(),
            prepare_ms: Times::new(&measured.prepare),
            generate_ms: Times::new(&measured.generate),
            shade_ms: Times::new(&measured.shade),
            total_ms: measured.total_ms(),
            false_lit: error.false_lit,
            false_shadow: error.false_shadow,
            false_lit_percent: measure::percent(error.false_lit, error),
            false_shadow_percent: measure::percent(error.false_shadow, error),
            false_lit_interior: error.false_lit_interior,
            false_shadow_interior: error.false_shadow_interior,
            rmse: error.rmse,
            soft: measured.soft,
            bake: measured.bake,
            bytes: measured.cost.bytes,
            draws: measured.cost.draws,
            triangles_drawn: measured.cost.triangles,
        }
    }
}

impl Adapter {
    /// On one line.
    pub fn described(&self) -> String {
        format!("{} ({}, {})", self.name, self.backend, self.driver)
    }
}

impl Times {
    fn new(times: &measure::Times) -> Self {
        Self {
            median: times.median(),
            min: times.min(),
            samples: times.samples.len(),
            clock: times.clock.name(),
        }
    }
}

fn adapter(info: &wgpu::AdapterInfo) -> Adapter {
    Adapter {
        name: info.name.clone(),
        backend: format!("{:?}", info.backend),
        driver: format!("{} {}", info.driver, info.driver_info)
            .trim()
            .to_owned(),
    }
}

fn camera(stage: &Stage) -> Camera {
    let camera = &stage.scene.camera;
    Camera {
        eye: camera.eye.to_array(),
        target: camera.target.to_array(),
        up: [0.0, 1.0, 0.0],
        fovy: camera.fovy,
        near: camera.near,
        clip_from_world: stage.inputs.view.clip_from_world().to_cols_array(),
        depth: "reverse-z-infinite",
    }
}

fn objects(stage: &Stage) -> Vec<Object> {
    let scene = &stage.scene;
    let objects = scene.objects.iter();
    objects
        .map(|object| Object {
            name: object.name.clone(),
            triangles: scene.meshes[object.mesh].triangle_count(),
            kind: match stage.scene_gpu.meshes[object.mesh].kind {
                MeshKind::Closed => "closed",
                MeshKind::General => "general",
            },
            casts: object.casts,
        })
        .collect()
}

impl Light {
    fn new(light: &host::scene::Light) -> Self {
        Self {
            place: light.place.to_array(),
            cone: light.cone.map(|cone| Cone {
                direction: cone.direction.to_array(),
                half_angle: cone.half_angle,
            }),
            range: light.range,
            shadow_near: light.near,
        }
    }

    fn described(&self) -> String {
        let [x, y, z, w] = self.place;
        match (&self.cone, w) {
            (_, 0.0) => format!("Directional light from ({x}, {y}, {z})"),
            (None, _) => format!("Point light at ({x}, {y}, {z}), range {}", self.range),
            (Some(cone), _) => format!(
                "Spot at ({x}, {y}, {z}), range {}, {:.0} degrees to each side of the direction \
                 {:?}; what is outside its cone does not count",
                self.range,
                cone.half_angle.to_degrees(),
                cone.direction
            ),
        }
    }
}

/// What was done before the frames that were timed.
fn baked(bake: Option<Bake>) -> String {
    let Some(bake) = bake else {
        return String::new();
    };
    let centimetres = 100.0 * bake.texel;
    format!(
        "; unwrapped and baked once, in {:.1} s, which is in no frame's time; a texel is {centimetres:.2} cm of a surface at \
         most, and {:.0} % of them are filled",
        bake.seconds, bake.filled_percent
    )
}

/// How many lights of which kind.
fn described(lights: &[Light]) -> String {
    let spots = lights.iter().filter(|light| light.cone.is_some()).count();
    let suns = lights.iter().filter(|light| light.place[3] == 0.0).count();
    let counted = [
        (lights.len() - spots - suns, "points"),
        (spots, "spots"),
        (suns, "directional"),
    ];
    let counted = counted.iter().filter(|(count, _)| *count > 0);
    let counted: Vec<String> = counted
        .map(|(count, kind)| format!("{count} {kind}"))
        .collect();
    format!("{} lights: {}", lights.len(), counted.join(", "))
}
