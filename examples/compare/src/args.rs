//! The command line of `compare`.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::error::ErrorKind;
use clap::{CommandFactory as _, FromArgMatches as _, Parser};
use shadows::glam::{Vec3, Vec4};

use crate::table::{ROWS, Row};
use host::scene::{LightKind, Time};
use host::terminal::note;

// By their paths, as a test takes this file for itself.
#[path = "args/mode.rs"]
mod mode;
#[path = "args/values.rs"]
mod values;

use values::{
    MAX_SIDE, camera, light, light_kind, milliseconds, part, range, scene_name, size, time, times,
};

/// The most lights that are compared where nothing else is asked for.
pub const LIGHTS: usize = 16;
/// What `--technique` calls the few that are compared where nothing else is asked for.
pub const USUAL: &str = "usual";
/// Renders scenes with each shadow technique, measures the error against exact ray casting and the
/// time a frame takes, and writes pictures and a report.
#[derive(Clone, Debug, PartialEq, Parser)]
#[command(name = "compare", disable_help_subcommand = true)]
pub struct Args {
    /// spheres, courtyard, teapot, city, valley, valley-leaves, floor, or an .obj, .gltf or .glb file; may be given
    /// several times.
    #[arg(long = "scene", value_name = "NAME|FILE", value_parser = scene_name, default_value = "spheres")]
    pub scenes: Vec<String>,

    /// Whether a model file is put on a ground square.
    #[arg(long, value_enum, default_value = "auto")]
    pub ground: Ground,

    /// When it is, in scenes that have days and nights (city): day or night.
    #[arg(long, value_name = "WHEN", value_parser = time)]
    pub time: Option<Time>,

    /// How many of the scene's lights are lit, the first of its list; without it up to 16.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000))]
    pub lights: Option<u32>,

    /// One light instead of the scene's, in metres, world space; w = 0 makes x,y,z the direction to the
    /// light.
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
        value_parser = camera,
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
    #[arg(long, group = "mode")]
    pub sweep: bool,

    /// Advise the cheapest with at most this part of the pixels wrong, such as 0.001.
    #[arg(long, value_name = "PART", value_parser = part)]
    pub error_at_most: Option<f64>,

    /// Advise the most exact within this time a frame, such as 2ms.
    #[arg(long, value_name = "TIME", value_parser = milliseconds)]
    pub time_at_most: Option<f64>,

    /// Also write the scene as PLY and the rendered masks, for other tools to measure.
    #[arg(long)]
    pub export: bool,

    /// Instead of a scene, try every technique on the cases where shadows usually break, and write
    /// a table of which pass. Exits with 1 if one fails that should not.
    #[arg(long, group = "mode")]
    pub hard_cases: bool,

    /// Of the hard cases only those whose name begins with this, and no bad input; may be given several times.
    #[arg(long = "case", value_name = "NAME")]
    pub cases: Vec<String>,

    /// Rounds of the hard cases, each with other lights and cameras.
    #[arg(long, value_name = "N", default_value_t = 4,
          value_parser = clap::value_parser!(u32).range(1..=1_000))]
    pub rounds: u32,

    /// Instead, watch how much the techniques shimmer while light or camera move a little, in
    /// pictures of this size.
    #[arg(long, value_name = "WxH", num_args = 0..=1, default_missing_value = "320x180",
          value_parser = size, group = "mode")]
    pub temporal: Option<[u32; 2]>,

    /// Steps of each path of --temporal.
    #[arg(long, value_name = "N", default_value_t = 64,
          value_parser = clap::value_parser!(u32).range(1..=1_000))]
    pub steps: u32,

    /// Instead, measure how cost grows with triangles, casters, meshes, lights, views, resolution and map
    /// size, each from its least to at most so many times that, but at two amounts at least; all the way where
    /// no number is given.
    #[arg(long, value_name = "TIMES", num_args = 0..=1, default_missing_value = "1000000",
          value_parser = times, group = "mode")]
    pub growth: Option<f64>,

    /// Instead, draw the scenes and the hard cases with the shaders' arithmetic as drivers may choose it:
    /// names, separated by commas, or all, as where none is given. Exits with 1 if a hard case fails that
    /// should not.
    #[arg(long, value_name = "NAME,..|all", num_args = 0..=1, default_missing_value = "all",
          value_delimiter = ',', group = "mode")]
    pub arithmetic: Option<Vec<String>>,

    /// Instead, set what receivers cost on a GPU, as `cargo bench --bench shader_cost -- --out FILE`
    /// counts it, against what they get wrong: every kernel, and other engines' receivers in our
    /// rendition.
    #[arg(long, value_name = "FILE", group = "mode")]
    pub cost: Option<PathBuf>,

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

impl Args {
    /// Whether a few techniques are compared, which is the only mode that takes several lights.
    pub fn compares(&self) -> bool {
        mode::compares(self)
    }

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
            note(&one_line(&error));
            std::process::exit(2)
        }
    }
}

/// Reads a command line whose first item is the program's name. A scene given twice is kept once.
///
/// # Errors
/// What clap says, or that an option is of no use to what is asked for; `kind()` is `DisplayHelp` where
/// help was asked for. [`one_line`] shortens it.
pub fn try_parse_from<T: Into<OsString> + Clone>(
    items: impl IntoIterator<Item = T>,
) -> Result<Args, clap::Error> {
    let mut command = Args::command();
    let matches = command.try_get_matches_from_mut(items)?;
    let mut args = Args::from_arg_matches(&matches).map_err(|e| e.format(&mut command))?;
    mode::check(&args, &matches, &mut command)?;
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
