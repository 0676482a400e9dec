//! Every technique over its settings, and advice on which to take.

use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;

use anyhow::{Context as _, Result};
use serde_json::json;
use shadows::reference::{Candidate, ReferenceImage};
use shadows::{
    Bias, Caps, CasterSides, DepthEncoding, Extrusion, Kernel, MapKind, Method,
    ShadowVolumeDescriptor, Silhouettes, wgpu,
};

use crate::args::Techniques;
use crate::date::{date, now};
use crate::measure::{self, median};
use crate::snippet;
use crate::stage::Stage;
use crate::survey::Survey;
use crate::table::{self, ROWS, Row};
use crate::technique::{Config, Technique};
use host::gpu::Gpu;
use host::terminal::note;

/// What was measured of each.
type Surveyed = shadows::reference::Survey<Technique>;

/// Sides of maps in texels.
const SIDES: [u32; 5] = [256, 512, 1024, 2048, 4096];
/// The side at which what else a map may be is tried.
const SIDE: u32 = 1024;

/// A setting beyond the named rows: what is appended to the row's name, and the change.
type Change<T> = (&'static str, fn(&mut T));

/// The techniques over their settings, or all of them if these are the usual. Names begin with a
/// row's.
pub fn techniques(asked: &Techniques) -> Vec<Technique> {
    let mut all = Vec::new();
    for row in ROWS {
        match row.at(SIDE).config {
            Config::Volume(_) => all.push(row.at(SIDE)),
            // How long our drawing of another engine's maps takes says nothing of that engine.
            Config::Peer { .. } if asked.are_usual() => {}
            // Its maps are those of the others.
            Config::Atlas { .. } => {}
            // Cheap on what they are for, and wrong or slow elsewhere: whoever asks knows which it is.
            Config::Survey(_) if asked.are_usual() => {}
            Config::Survey(survey) if !survey.has_texels() => all.push(row.at(SIDE)),
            // The same shadows, read by what should not.
            Config::Survey(Survey::Projected(projected)) if projected.on_casters => {}
            _ if row.name == "cube-1024" => {} // one of the sizes
            // A larger one is baked for minutes, and anew for each round.
            Config::Survey(Survey::Baked(_)) => all.extend(sized(row, &SIDES[..3])),
            _ => all.extend(sized(row, &SIDES)),
        }
    }
    all.extend(cubes().chain(flats()).chain(volumes()));
    let row_of = |name: &str| {
        name.split_once(' ')
            .map_or(name.to_owned(), |(row, _)| row.into())
    };
    all.retain(|technique| match asked.are_usual() {
        // A frame of what is kept, in which nothing moves, is no match for the others.
        true => !technique.config.keeps(),
        false => {
            let row = row_of(&technique.name);
            asked.0.iter().any(|asked| asked.name == row)
        }
    });
    all
}

fn sized<'a>(row: &'a Row, sides: &'a [u32]) -> impl Iterator<Item = Technique> + 'a {
    sides.iter().map(|side| Technique {
        name: format!("{} {side}", row.name).into(),
        ..row.at(*side)
    })
}

fn cubes() -> impl Iterator<Item = Technique> {
    use wgpu::TextureFormat::{Depth16Unorm, Depth24Plus};
    let changes: [Change<Config>; 8] = [
        ("linear", |config| {
            encode(config, DepthEncoding::LinearDistance, None)
        }),
        ("linear 24 bits", |config| {
            encode(config, DepthEncoding::LinearDistance, Some(Depth24Plus));
        }),
        ("linear 16 bits", |config| {
            encode(config, DepthEncoding::LinearDistance, Some(Depth16Unorm));
        }),
        ("24 bits", |config| {
            encode(config, DepthEncoding::MajorAxis, Some(Depth24Plus))
        }),
        ("no bias", |config| set_bias(config, Bias::NONE)),
        ("fourfold bias", |config| set_bias(config, fourfold())),
        ("both sides", |config| set_sides(config, CasterSides::Both)),
        ("far sides", |config| set_sides(config, CasterSides::Far)),
    ];
    changes
        .into_iter()
        .map(|change| changed("cube-2x2", table::cube, change))
}

fn flats() -> impl Iterator<Item = Technique> {
    let changes: [Change<Config>; 4] = [
        ("no bias", |config| set_bias(config, Bias::NONE)),
        ("fourfold bias", |config| set_bias(config, fourfold())),
        ("both sides", |config| set_sides(config, CasterSides::Both)),
        ("far sides", |config| set_sides(config, CasterSides::Far)),
    ];
    changes
        .into_iter()
        .map(|change| changed("flat-2x2", table::flat, change))
}

fn changed(
    row: &str,
    make: fn(u32, Kernel) -> Config,
    (what, change): Change<Config>,
) -> Technique {
    let mut config = make(SIDE, Kernel::default());
    change(&mut config);
    let name = format!("{row} {SIDE}, {what}").into();
    Technique { name, config }
}

fn encode(config: &mut Config, encoding: DepthEncoding, format: Option<wgpu::TextureFormat>) {
    if let Config::Cube { map, sampler } = config {
        (map.encoding, sampler.map) = (encoding, MapKind::Cube(encoding));
        map.settings.format = format.unwrap_or(map.settings.format);
    }
}

fn fourfold() -> Bias {
    let Bias {
        normal_offset,
        constant,
        slope_scale,
        position_ulps,
    } = Bias::default();
    Bias {
        normal_offset: 4.0 * normal_offset,
        constant: 4.0 * constant,
        slope_scale,
        position_ulps,
    }
}

fn set_bias(config: &mut Config, bias: Bias) {
    match config {
        Config::Cube { map, .. } => map.settings.bias = bias,
        Config::Flat { map, .. } => map.settings.bias = bias,
        Config::Volume(_) | Config::Atlas { .. } | Config::Peer { .. } | Config::Survey(_) => {}
    }
}

fn set_sides(config: &mut Config, sides: CasterSides) {
    match config {
        Config::Cube { map, .. } => map.settings.sides = sides,
        Config::Flat { map, .. } => map.settings.sides = sides,
        Config::Volume(_) | Config::Atlas { .. } | Config::Peer { .. } | Config::Survey(_) => {}
    }
}

fn volumes() -> impl Iterator<Item = Technique> {
    let changes: [Change<ShadowVolumeDescriptor<'static>>; 6] = [
        ("z-fail, cpu", |volume| {
            (volume.method, volume.silhouettes) = (Method::ZFail, Silhouettes::Cpu);
        }),
        ("z-fail, compute", |volume| {
            (volume.method, volume.silhouettes) = (Method::ZFail, Silhouettes::Compute);
        }),
        ("z-fail, vertex", |volume| {
            (volume.method, volume.silhouettes) = (Method::ZFail, Silhouettes::Vertex);
        }),
        ("full caps", |volume| volume.caps = Caps::Full),
        ("infinite", |volume| volume.extrusion = Extrusion::Infinite),
        ("no culling", |volume| volume.culling = false),
    ];
    changes.into_iter().map(|(what, change)| {
        let mut volume = table::volume();
        change(&mut volume);
        Technique {
            name: format!("volume {what}").into(),
            config: Config::Volume(volume),
        }
    })
}

/// What to advise.
#[derive(Clone, Copy, Debug)]
pub struct Wishes {
    /// Wrong pixels as a part of those that face the light, at most.
    pub error_at_most: Option<f64>,
    /// Milliseconds a frame, at most.
    pub time_at_most: Option<f64>,
}

/// What a sweep found.
pub struct Swept {
    pub survey: Surveyed,
    /// Half of a configuration's times lie within this part of their median, in the middle
    /// configuration. `None` if there are too few times to tell.
    pub spread: Option<f64>,
    /// What the device refused, and why.
    pub left_out: BTreeMap<Cow<'static, str>, String>,
}

/// Measures techniques in turn. Maps are made anew for each round, as all of them at once would
/// take gigabytes. What the device refuses is told and left out. `step` is called after each.
///
/// # Errors
/// If the device cannot do what a technique needs.
pub fn survey(
    gpu: &Gpu,
    stage: &Stage,
    reference: &ReferenceImage,
    techniques: Vec<Technique>,
    rounds: usize,
    step: &dyn Fn(),
) -> Result<Swept> {
    let refused = RefCell::new(BTreeMap::new());
    let mut samples: HashMap<Cow<'static, str>, Vec<f64>> = HashMap::new();
    let time = |technique: &Technique| -> Result<f64> {
        step();
        if refused.borrow().contains_key(&technique.name) {
            return Ok(f64::NAN);
        }
        let time = measure::once(gpu, stage, technique);
        let time = time.with_context(|| technique.name.to_string())?;
        samples
            .entry(technique.name.clone())
            .or_default()
            .push(time);
        Ok(time)
    };
    let error = |technique: &Technique| {
        let error = measure::error(gpu, stage, reference, technique);
        Ok(error.unwrap_or_else(|reason| {
            let reason = format!("{reason:#}");
            note(&format!("{} is left out: {reason}", technique.name));
            refused.borrow_mut().insert(technique.name.clone(), reason);
            f64::NAN
        }))
    };
    let survey = Surveyed::measure(techniques, rounds, time, error)?;
    let spreads: Vec<f64> = samples.values().map(|times| spread(times)).collect();
    Ok(Swept {
        survey,
        spread: (rounds > 2 && !spreads.is_empty()).then(|| median(&spreads)),
        left_out: refused.into_inner(),
    })
}

/// The part of the median within which half of the times lie.
pub fn spread(times: &[f64]) -> f64 {
    let middle = median(times);
    let away: Vec<f64> = times.iter().map(|time| (time - middle).abs()).collect();
    median(&away) / middle.abs()
}

/// The report: advice, the front, and all of them by time.
pub fn markdown(
    swept: &Swept,
    title: &str,
    [width, height]: [u32; 2],
    rounds: usize,
    wishes: &Wishes,
) -> String {
    let day = date(now());
    let count = by_time(&swept.survey).len();
    let mut out = format!(
        "# Speed against error: {title}\n\n\
         Written by `compare --sweep` on {day}: {count} configurations at {width}x{height} pixels, in \
         {rounds} interleaved rounds, {} frames a turn.{}\n\n",
        measure::FRAMES_AT_ONCE,
        swept.spread.map_or(String::new(), noise),
    );
    for (name, reason) in &swept.left_out {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "`{name}` is left out: {reason}.\n");
    }
    let _ = write_report(&mut out, &swept.survey, wishes);
    out
}

/// How far apart two times may be that are the same.
fn noise(spread: f64) -> String {
    let percent = (100.0 * spread).max(1.0).ceil();
    format!(
        " Half of a configuration's turns take within {percent:.0} % of their median: times that are no \
         farther apart may be the same."
    )
}

fn write_report(out: &mut String, survey: &Surveyed, wishes: &Wishes) -> std::fmt::Result {
    let advice = advice(survey, wishes);
    for advice in &advice {
        writeln!(out, "{advice}\n")?;
    }
    if advice.iter().any(|advice| advice.contains("```rust")) {
        writeln!(out, "{KEPT}\n")?;
    }
    let front = survey.front();
    writeln!(out, "![Time and error](speed-vs-error.svg)\n\n## Front\n")?;
    writeln!(
        out,
        "Configurations that no other beats in both time and error.\n"
    )?;
    write_table(out, &front)?;
    let all = by_time(survey);
    writeln!(out, "\n## All, by time\n")?;
    write_table(out, &all)?;
    writeln!(
        out,
        "\nMilliseconds a frame for shadows alone, medians; wrong pixels in per cent of those that \
         face the light. Every frame is drawn as if everything moved, except with cached maps or \
         kept volumes: those are compared only if requested by name (--technique), and so are the cheap \
         techniques and light maps, as the time of a bake is not part of any frame."
    )
}

/// What the advised Rust does that what was timed does not.
const KEPT: &str = "The times are of frames in which everything moves. With the code above, as by \
    default, anything static is kept from frame to frame, and costs less than that.";

/// Those that were measured, the fastest first.
fn by_time(survey: &Surveyed) -> Vec<&Candidate<Technique>> {
    let measured = survey.candidates().iter();
    let mut all: Vec<_> = measured
        .filter(|candidate| candidate.time.is_finite())
        .collect();
    all.sort_by(|a, b| a.time.total_cmp(&b.time));
    all
}

fn write_table(out: &mut String, rows: &[&Candidate<Technique>]) -> std::fmt::Result {
    writeln!(out, "| | ms | wrong |\n|---|--:|--:|")?;
    for Candidate {
        configuration,
        time,
        error,
    } in rows
    {
        let name = &configuration.name;
        writeln!(out, "| `{name}` | {time:.2} | {:.4} % |", 100.0 * error)?;
    }
    Ok(())
}

/// A paragraph with a snippet for each wish.
pub fn advice(survey: &Surveyed, wishes: &Wishes) -> Vec<String> {
    let tell = |wish: String, found: Option<&Candidate<Technique>>| match found {
        Some(Candidate {
            configuration,
            time,
            error,
        }) => format!(
            "{wish}: `{}`, {time:.2} ms, {:.4} % wrong.\n\n```rust\n{}```",
            configuration.name,
            100.0 * error,
            snippet::of(&configuration.config)
        ),
        None => format!("{wish}: none."),
    };
    let cheapest = wishes.error_at_most.map(|limit| {
        let wish = format!("The cheapest with at most {} % wrong pixels", 100.0 * limit);
        tell(wish, survey.cheapest(limit))
    });
    let most_exact = wishes.time_at_most.map(|limit| {
        let wish = format!("The most exact within {limit} ms a frame");
        tell(wish, survey.most_exact(limit))
    });
    cheapest.into_iter().chain(most_exact).collect()
}

/// The front and the advice for a terminal.
pub fn summary(survey: &Surveyed, scene: &str, wishes: &Wishes) -> String {
    let mut out = format!(
        "{scene}: {} configurations; the front:",
        by_time(survey).len()
    );
    for Candidate {
        configuration,
        time,
        error,
    } in survey.front()
    {
        let name = &configuration.name;
        let _ = write!(
            out,
            "\n  {name:<24} {time:>9.2} ms  {:>8.4} % wrong",
            100.0 * error
        );
    }
    for advice in advice(survey, wishes) {
        let _ = write!(out, "\n{advice}");
    }
    out
}

/// The same for programs, by time.
pub fn json(survey: &Surveyed) -> serde_json::Result<String> {
    let front = survey.front();
    let all = by_time(survey);
    let rows: Vec<_> = all
        .into_iter()
        .map(|candidate| {
            json!({
                "name": candidate.configuration.name,
                "ms": candidate.time,
                "wrong": candidate.error,
                "front": front.iter().any(|other| std::ptr::eq(*other, candidate)),
                "settings": candidate.configuration.settings(),
                "rust": snippet::of(&candidate.configuration.config),
            })
        })
        .collect();
    Ok(serde_json::to_string_pretty(&rows)? + "\n")
}
