//! The command line of `compare`.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::Parser;
use clap::error::ErrorKind;
use shadows::glam::{Vec3, Vec4};

use crate::host::scene::LightKind;
use crate::table::{ROWS, Row};

/// The built-in scenes `--scene` knows besides files.
const SCENES: [&str; 3] = ["spheres", "courtyard", "teapot"];
/// What `--technique` calls the few that are compared where nothing else is asked for.
pub const USUAL: &str = "usual";
/// What a mode has no use for: it has scenes, sizes and techniques of its own.
const OF_SCENES: [&str; 12] = [
    "scenes",
    "ground",
    "light",
    "light_kind",
    "range",
    "camera",
    "size",
    "techniques",
    "face",
    "frames",
    "seed",
    "export",
];
/// Textures wider than this are refused by many devices (WebGPU's default limit).
const MAX_SIDE: u32 = 8192;

/// Renders scenes with each shadow technique, measures the error against exact ray casting and the
/// time a frame takes, and writes pictures and a report.
#[derive(Clone, Debug, PartialEq, Parser)]
#[command(name = "compare", disable_help_subcommand = true)]
pub struct Args {
    /// spheres, courtyard, teapot, or an .obj, .gltf or .glb file; may be given several times.
    #[arg(long = "scene", value_name = "NAME|FILE", value_parser = scene, default_value = "spheres")]
    pub scenes: Vec<String>,

    /// Whether a model file is put on a ground square.
    #[arg(long, value_enum, default_value = "auto")]
    pub ground: Ground,

    /// Light in metres, world space; w = 0 makes x,y,z the direction to the light.
    #[arg(long, value_name = "X,Y,Z[,W]", value_parser = light, allow_hyphen_values = true)]
    pub light: Option<Vec4>,

    /// What the light is made into: point, spot or directional. A spot shines from the light's place
    /// at the camera's target, 45 degrees to each side; a directional light in that direction.
    #[arg(long, value_name = "KIND", value_parser = light_kind)]
    pub light_kind: Option<LightKind>,

    /// Distance in metres at which a point light or a spot ends.
    #[arg(long, value_name = "R", value_parser = range, allow_hyphen_values = true)]
    pub range: Option<f32>,

    /// Eye and target in metres, world space, and the vertical field of view in degrees.
    #[arg(
        long,
        value_name = "EX,EY,EZ,TX,TY,TZ[,FOVY]",
        allow_hyphen_values = true
    )]
    pub camera: Option<CameraArg>,

    /// Size of the picture in pixels.
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "1280x720")]
    pub size: [u32; 2],

    /// Techniques to compare, separated by commas: names, beginnings such as cube-*, the usual
    /// few, or all.
    #[arg(long = "technique", value_name = "NAME,..|usual|all", default_value = USUAL)]
    pub techniques: Techniques,

    /// Side of a cube face or of a flat map in texels.
    #[arg(long, value_name = "N", default_value_t = 1024,
          value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SIDE)))]
    pub face: u32,

    /// Rounds of timing; each renders every technique once, in turn.
    #[arg(long, value_name = "N", default_value_t = 8,
          value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub frames: u32,

    /// Start of the random numbers, where any are drawn.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        allow_hyphen_values = true
    )]
    pub seed: u64,

    /// Take the first adapter whose name holds this, in any case.
    #[arg(long, value_name = "SUBSTRING")]
    pub adapter: Option<String>,

    /// Instead of a few techniques, try them all over their settings (--technique leaves out the
    /// others), and write which are both fastest and most exact.
    #[arg(long, group = "mode", conflicts_with_all = ["face", "seed", "export"])]
    pub sweep: bool,

    /// Advise the cheapest with at most this part of the pixels wrong, such as 0.001.
    #[arg(long, value_name = "PART", value_parser = part, requires = "sweep")]
    pub error_at_most: Option<f64>,

    /// Advise the most exact within this time a frame, such as 2ms.
    #[arg(long, value_name = "TIME", value_parser = milliseconds, requires = "sweep")]
    pub time_at_most: Option<f64>,

    /// Also write the scene as PLY and the rendered masks, for other tools to measure.
    #[arg(long)]
    pub export: bool,

    /// Instead of a scene, try every technique on the cases where shadows usually break, and write
    /// a table of which pass. Exits with 1 if one fails that should not.
    #[arg(long, group = "mode", conflicts_with_all = OF_SCENES)]
    pub hard_cases: bool,

    /// Rounds of the hard cases, each with other lights and cameras.
    #[arg(long, value_name = "N", default_value_t = 4, requires = "hard_cases",
          value_parser = clap::value_parser!(u32).range(1..=1_000))]
    pub rounds: u32,

    /// Instead, watch how much the techniques shimmer while light or camera move a little, in
    /// pictures of this size.
    #[arg(long, value_name = "WxH", num_args = 0..=1, default_missing_value = "320x180",
          value_parser = size, group = "mode",
          conflicts_with_all = ["size", "frames", "seed", "export"])]
    pub temporal: Option<[u32; 2]>,

    /// Steps of each path of --temporal.
    #[arg(long, value_name = "N", default_value_t = 64, requires = "temporal",
          value_parser = clap::value_parser!(u32).range(1..=1_000))]
    pub steps: u32,

    /// Instead, measure how cost grows with triangles, casters, meshes, lights, resolution and map
    /// size, each from its least to at most so many times that, but at two amounts at least; all the way where
    /// no number is given.
    #[arg(long, value_name = "TIMES", num_args = 0..=1, default_missing_value = "1000000",
          value_parser = times, group = "mode",
          conflicts_with_all = OF_SCENES.into_iter().filter(|name| *name != "frames"))]
    pub growth: Option<f64>,

    /// Directory for all that is written; made where it is missing.
    #[arg(long, value_name = "DIR", default_value = "target/compare")]
    pub out: PathBuf,
}

/// Whether a model file gets a ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Ground {
    /// A square under its lowest point.
    Auto,
    /// None.
    None,
}

/// At least one technique, none twice, in the order given.
#[derive(Clone, Debug, PartialEq)]
pub struct Techniques(pub Vec<&'static Row>);

impl Techniques {
    /// Whether these are those that nobody asked for by name.
    pub fn are_usual(&self) -> bool {
        self.0
            .iter()
            .copied()
            .eq(ROWS.iter().filter(|row| row.usual))
    }
}

impl FromStr for Techniques {
    type Err = String;

    fn from_str(list: &str) -> Result<Self, String> {
        let mut chosen: Vec<&'static Row> = Vec::new();
        for name in list.split(',') {
            let wanted = |row: &&Row| match (name, name.strip_suffix('*')) {
                ("all", _) => true,
                (USUAL, _) => row.usual,
                (_, Some(start)) => row.name.starts_with(start),
                _ => row.name == name,
            };
            let mut rows = ROWS.iter().filter(wanted).peekable();
            if rows.peek().is_none() {
                let names: Vec<&str> = ROWS.iter().map(|row| row.name).collect();
                let names = names.join(", ");
                return Err(format!(
                    "no technique {name:?}; known are {names}, {USUAL}, all, and beginnings such \
                     as cube-*"
                ));
            }
            for row in rows {
                if !chosen.contains(&row) {
                    chosen.push(row);
                }
            }
        }
        Ok(Self(chosen))
    }
}

/// What `--camera` replaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraArg {
    /// Centre of projection, world space.
    pub eye: Vec3,
    /// Middle of the picture, world space.
    pub target: Vec3,
    /// Vertical field of view in radians.
    pub fovy: Option<f32>,
}

impl FromStr for CameraArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let n = numbers(text, 6..=7)?;
        let eye = Vec3::new(n[0], n[1], n[2]);
        let target = Vec3::new(n[3], n[4], n[5]);
        if eye == target {
            return Err("eye and target are the same point".into());
        }
        if eye.x == target.x && eye.z == target.z {
            return Err("the target is straight above or below the eye; move it sideways".into());
        }
        let fovy = match n.get(6) {
            Some(degrees) if *degrees > 0.0 && *degrees < 180.0 => Some(degrees.to_radians()),
            Some(degrees) => {
                return Err(format!(
                    "field of view {degrees} is not between 0 and 180 degrees"
                ));
            }
            None => None,
        };
        Ok(Self { eye, target, fovy })
    }
}

impl Args {
    /// `--camera` as eye, target and field of view in radians.
    pub fn camera_override(&self) -> Option<(Vec3, Vec3, Option<f32>)> {
        self.camera.map(|c| (c.eye, c.target, c.fovy))
    }

    /// Each scene with the directory for its results: `out` itself for a single one, else a folder
    /// of `out` by the scene's name, numbered where two files share it.
    pub fn scene_dirs(&self) -> Vec<(&str, PathBuf)> {
        if let [only] = self.scenes.as_slice() {
            return vec![(only, self.out.clone())];
        }
        let mut taken: Vec<PathBuf> = Vec::new();
        for scene in &self.scenes {
            let stem = Path::new(scene).file_stem().unwrap_or_default();
            let numbered = |n: u32| match n {
                1 => self.out.join(stem),
                n => self.out.join(format!("{}-{n}", stem.to_string_lossy())),
            };
            let free = (1..).map(numbered).find(|dir| !taken.contains(dir));
            taken.extend(free);
        }
        self.scenes.iter().map(String::as_str).zip(taken).collect()
    }
}

/// Reads the command line. On a mistake, writes one line to stderr and exits with code 2; on
/// `--help`, writes the help to stdout and exits with code 0.
pub fn parse() -> Args {
    match try_parse_from(std::env::args_os()) {
        Ok(args) => args,
        Err(error) if error.kind() == ErrorKind::DisplayHelp => error.exit(),
        Err(error) => {
            eprintln!("{}", one_line(&error));
            std::process::exit(2)
        }
    }
}

/// Reads a command line whose first item is the program's name. A scene given twice is kept once.
///
/// # Errors
/// What clap says; `kind()` is `DisplayHelp` where help was asked for. [`one_line`] shortens it.
pub fn try_parse_from<T: Into<OsString> + Clone>(
    items: impl IntoIterator<Item = T>,
) -> Result<Args, clap::Error> {
    let mut args = Args::try_parse_from(items)?;
    let mut seen: Vec<String> = Vec::new();
    args.scenes.retain(|scene| {
        let new = !seen.contains(scene);
        seen.extend(new.then(|| scene.clone()));
        new
    });
    Ok(args)
}

/// What is wrong, without clap's usage and hints.
pub fn one_line(error: &clap::Error) -> String {
    let text = error.to_string();
    let lines = text.lines().map(str::trim);
    let told = lines.take_while(|l| !l.starts_with("Usage:") && !l.starts_with("For more"));
    told.filter(|l| !l.is_empty()).collect::<Vec<_>>().join(" ")
}

fn scene(text: &str) -> Result<String, String> {
    let ending = Path::new(text).extension().and_then(|e| e.to_str());
    let is_file = ending.is_some_and(|e| {
        ["obj", "gltf", "glb"]
            .iter()
            .any(|known| e.eq_ignore_ascii_case(known))
    });
    if is_file || SCENES.contains(&text) {
        return Ok(text.into());
    }
    let names = SCENES.join(", ");
    Err(format!(
        "no such scene; known are {names}, and .obj, .gltf or .glb files"
    ))
}

fn light(text: &str) -> Result<Vec4, String> {
    let n = numbers(text, 3..=4)?;
    let w = n.get(3).copied().unwrap_or(1.0);
    if w != 0.0 && w != 1.0 {
        return Err(format!(
            "w is {w}; it must be 1 (a point) or 0 (a direction)"
        ));
    }
    let light = Vec4::new(n[0], n[1], n[2], w);
    if light == Vec4::ZERO {
        return Err("a direction cannot be 0,0,0".into());
    }
    Ok(light)
}

fn light_kind(text: &str) -> Result<LightKind, String> {
    match text {
        "point" => Ok(LightKind::Point),
        "spot" => Ok(LightKind::Spot),
        "directional" => Ok(LightKind::Directional),
        _ => Err("it must be point, spot or directional".into()),
    }
}

fn range(text: &str) -> Result<f32, String> {
    let range = number(text)?;
    if range > 0.0 {
        Ok(range)
    } else {
        Err("it must be above 0".into())
    }
}

fn part(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(part) if (0.0..=1.0).contains(&part) => Ok(part),
        _ => Err("it must be a number from 0 to 1".into()),
    }
}

fn times(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(times) if times >= 1.0 => Ok(times),
        _ => Err("it must be a number of at least 1".into()),
    }
}

fn milliseconds(text: &str) -> Result<f64, String> {
    let number = text
        .strip_suffix("ms")
        .and_then(|number| number.parse().ok());
    let time = number.filter(|time: &f64| time.is_finite() && *time > 0.0);
    time.ok_or_else(|| "it must be milliseconds above 0, such as 2ms or 0.5ms".into())
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |s: &str| s.parse().ok().filter(|n| (1..=MAX_SIDE).contains(n));
    let sides = text.split_once(['x', 'X']);
    match sides.map(|(w, h)| (side(w), side(h))) {
        Some((Some(w), Some(h))) => Ok([w, h]),
        _ => Err(format!("expected WIDTHxHEIGHT, each from 1 to {MAX_SIDE}")),
    }
}

fn number(text: &str) -> Result<f32, String> {
    let number: Result<f32, _> = text.trim().parse();
    let number = number.map_err(|_| format!("{text:?} is not a number"))?;
    if number.is_finite() {
        Ok(number)
    } else {
        Err(format!("{text} is not finite"))
    }
}

fn numbers(text: &str, count: std::ops::RangeInclusive<usize>) -> Result<Vec<f32>, String> {
    let numbers: Vec<f32> = text.split(',').map(number).collect::<Result<_, _>>()?;
    if count.contains(&numbers.len()) {
        return Ok(numbers);
    }
    let [least, most] = [count.start(), count.end()];
    Err(format!(
        "expected {least} or {most} numbers, got {}",
        numbers.len()
    ))
}
