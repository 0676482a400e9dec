//! What flipped, as Markdown.

use std::fmt::Write as _;

use super::path::TEXELS;
use super::{Path, Plan, Watched};
use crate::date;

/// The page: what was watched, the figures, and how they are to be read.
pub fn markdown(title: &str, plan: &Plan<'_>, watched: &[Watched]) -> String {
    let mut out = format!("# How much shadows shimmer: {title}\n\n");
    // Writing to a string cannot fail.
    let _ = write_page(&mut out, plan, watched);
    out
}

fn write_page(out: &mut String, plan: &Plan<'_>, watched: &[Watched]) -> std::fmt::Result {
    let ([width, height], steps) = (plan.size, plan.steps);
    writeln!(
        out,
        "Written by `compare --temporal` on {}: {width} x {height} pixels, maps of {} texels a side, \
         {steps} small steps on each path. **A flip in excess is a pixel that a technique shows lit \
         in one step and in shadow in the next (or the reverse) although exact ray casting says the \
         same in both.** Each step has its own reference. A technique without errors flips nothing, \
         and neither does a static picture.\n",
        date::date(date::now()),
        plan.side,
    )?;
    writeln!(
        out,
        "- **light**: the light moves sideways by 0.3 texels of a map of {TEXELS} texels a step; the \
        camera does not move, so a pixel sees the same surface point all the time.\n\
         - **camera**: the camera moves sideways and a little forward, from a tenth of a pixel to a \
         pixel a step. A pixel is compared with itself: the ragged shadow edges of a map that is \
         fixed in the world move over the pixels and flip some, as the eye would see it.\n\
         - **pan**: the picture moves by exactly a pixel a step (a shifted lens), and each surface \
         point is compared with itself: anything fixed in the world flips nothing, so this shows maps that \
         move with the camera, and noise.\n"
    )?;
    writeln!(
        out,
        "Flips in 10,000 pixels that face the light, a step: mean, (worst step), and those that jump \
         by more than half of full light (soft kernels often cross one half by a little). The last \
         row for each light shows what the reference flips: the shadows' own motion.\n\n\
         ![Flips a step](temporal.svg)"
    )?;
    for light in lights(watched) {
        write_table(out, light, watched)?;
    }
    Ok(())
}

/// Each kind of light once, in order.
fn lights(watched: &[Watched]) -> Vec<&'static str> {
    let mut lights: Vec<&str> = watched.iter().map(|one| one.light).collect();
    lights.dedup();
    lights
}

fn write_table(out: &mut String, light: &str, watched: &[Watched]) -> std::fmt::Result {
    let names = Path::ALL.map(|path| format!("{} | jumps", path.name()));
    writeln!(
        out,
        "\n## A {light} light\n\n| technique | {} |\n|---{}|",
        names.join(" | "),
        "|--:".repeat(2 * names.len())
    )?;
    let rows = || watched.iter().filter(|one| one.light == light);
    for one in rows() {
        write!(out, "| `{}` |", one.technique)?;
        for path in &one.paths {
            write!(
                out,
                " {:.2} ({:.1}) | {:.2} |",
                path.excess, path.worst, path.jumps
            )?;
        }
        writeln!(out)?;
    }
    if let Some(one) = rows().next() {
        write!(out, "| *the reference itself* |")?;
        for path in &one.paths {
            write!(out, " *{:.2}* | |", path.of_reference)?;
        }
        writeln!(out)?;
    }
    Ok(())
}
