//! The growth as Markdown and for programs.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::fit::Fit;
use super::quantity::Quantity;
use super::{Curve, Series};
use crate::date;
use host::timer::Clock;

/// The page.
pub fn markdown(title: &str, clock: Clock, rounds: u32, series: &[Series]) -> String {
    let mut out = format!("# How cost grows: {title}\n\n");
    // Writing to a string cannot fail.
    let _ = write_page(&mut out, clock, rounds, series);
    out
}

fn write_page(out: &mut String, clock: Clock, rounds: u32, series: &[Series]) -> std::fmt::Result {
    let clock = match clock {
        Clock::Gpu => "GPU timestamps",
        Clock::Wall => {
            "wall time from the first command to the GPU's end, as this driver's timestamps say \
             nothing (so each holds a submission, too)"
        }
    };
    writeln!(
        out,
        "Written by `compare --growth` on {}: medians of at most {rounds} interleaved rounds, in \
         milliseconds. *Prepare* is the CPU's share (wall time), *GPU* what makes the map or the \
         stencil, by {clock}. *All moving*: every caster moves in every frame; *kept*: none does. \
         All techniques have their default settings.\n\n\
         The **slope** is that of a line through the logarithms by least squares, over the upper \
         half of the range (the points whose amount is at least the geometric mean of the least and \
         the greatest), with its standard error: 1 is linear, 0 does not grow. **On top** is the \
         slope of the additional cost of each point over the first, so that fixed costs (a submission, the \
         draws) do not hide how the rest grows. It determines the words: flat below 0.2, or if the last point \
         is not a quarter above the first; linear from 0.8 to 1.2.\n",
        date::date(date::now()),
    )?;
    writeln!(out, "{}", deviations(series))?;
    for one in series {
        write_series(out, one)?;
    }
    Ok(())
}

/// What grows faster than it should.
fn deviations(series: &[Series]) -> String {
    let steep: Vec<String> = series
        .iter()
        .flat_map(|one| one.curves.iter().map(move |curve| (one.quantity, curve)))
        .flat_map(|(quantity, curve)| {
            let named = curve.added().into_iter().zip(["prepare", "GPU"]);
            let steep = named.filter_map(|(fit, work)| fit.map(|fit| (fit, work)));
            let steep: Vec<_> = steep.filter(|(fit, _)| fit.slope > 1.2).collect();
            steep.into_iter().map(move |(fit, work)| {
                format!(
                    "{} with {} ({work}, {})",
                    curve.kind.name,
                    quantity.name(),
                    slope(Some(fit))
                )
            })
        })
        .collect();
    match steep.is_empty() {
        true => "Nothing here grows faster than linearly.".into(),
        false => format!("Faster than linear: {}.", steep.join("; ")),
    }
}

fn write_series(out: &mut String, series: &Series) -> std::fmt::Result {
    let Series { quantity, curves } = series;
    let name = quantity.name();
    writeln!(
        out,
        "\n## {name}\n\n{}\n\n![Milliseconds by {name}](growth-{name}.svg)\n",
        quantity.about()
    )?;
    writeln!(
        out,
        "| | prepare: slope | on top | | GPU: slope | on top | |\n|---|--:|--:|---|--:|--:|---|"
    )?;
    for curve in curves {
        write!(out, "| {} |", curve.kind.name)?;
        for (fit, added) in curve.fits().into_iter().zip(curve.added()) {
            write!(
                out,
                " {} | {} | {} |",
                slope(fit),
                slope(added),
                word(added)
            )?;
        }
        writeln!(out)?;
    }
    let names = curves.iter().map(|curve| curve.kind.name);
    let heads: Vec<String> = names.map(|name| format!("{name}: prepare | GPU")).collect();
    writeln!(
        out,
        "\n| {} | {} |\n|--:{}|",
        quantity.unit(),
        heads.join(" | "),
        "|--:".repeat(2 * curves.len())
    )?;
    for row in 0..curves.first().map_or(0, |curve| curve.work.len()) {
        write!(out, "| {} |", curves[0].work[row].0)?;
        for curve in curves {
            write!(
                out,
                " {:.3} | {:.2} |",
                curve.prepare[row].1, curve.work[row].1
            )?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// A slope as it is printed.
pub fn slope(fit: Option<Fit>) -> String {
    match fit {
        None => "-".into(),
        Some(Fit { slope, error, .. }) => match error {
            Some(error) => format!("{slope:.2} \u{b1} {error:.2}"),
            None => format!("{slope:.2} (two points)"),
        },
    }
}

fn word(added: Option<Fit>) -> &'static str {
    added.map_or("flat", |fit| fit.word())
}

/// The same for programs.
pub fn json(title: &str, clock: Clock, series: &[Series]) -> serde_json::Result<String> {
    let series: Vec<Value> = series
        .iter()
        .map(|one| {
            json!({
                "quantity": one.quantity.name(),
                "unit": Quantity::unit(one.quantity),
                "curves": one.curves.iter().map(curve).collect::<Vec<_>>(),
            })
        })
        .collect();
    let page = json!({
        "adapter": title,
        "gpu_clock": clock.name(),
        "date": date::date(date::now()),
        "series": series,
    });
    Ok(serde_json::to_string_pretty(&page)? + "\n")
}

fn curve(curve: &Curve) -> Value {
    let fit = |fit: Option<Fit>| {
        fit.map(
            |fit| json!({ "slope": fit.slope, "standard_error": fit.error, "points": fit.points }),
        )
    };
    let ([prepare, work], added) = (curve.fits(), curve.added());
    json!({
        "name": curve.kind.name,
        "prepare_ms": curve.prepare,
        "prepare_fit": fit(prepare),
        "prepare_on_top_fit": fit(added[0]),
        "gpu_ms": curve.work,
        "gpu_fit": fit(work),
        "gpu_on_top_fit": fit(added[1]),
    })
}
