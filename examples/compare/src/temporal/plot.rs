//! Flips a step as a row of marks for each technique.

use anyhow::{Result, anyhow};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{Path, Watched};
use crate::plot::{COLORS, FONT, Failure, decades, plain};

const WIDTH: u32 = 880;
/// Pixels from a technique to the next.
const ROW: u32 = 24;
/// Pixels for the names.
const NAMES: u32 = 250;

/// The plot as SVG: to the right mean flips in excess, logarithmic; each path has a shape and a
/// colour of its own.
///
/// # Errors
/// If the plotting library cannot draw it.
pub fn dots(title: &str, watched: &[Watched]) -> Result<String> {
    let mut svg = String::new();
    draw(&mut svg, title, watched).map_err(|error| anyhow!("temporal.svg: {error}"))?;
    Ok(svg)
}

fn draw(svg: &mut String, title: &str, watched: &[Watched]) -> Result<(), Failure> {
    let paths = || watched.iter().flat_map(|one| &one.paths);
    let (floor, right) = decades(paths().map(|path| path.excess));
    // Nothing has a place of its own, a decade below the least there is.
    let left = floor / 10.0;
    let rows = watched.len() as f64;
    let size = (WIDTH, 150 + ROW * watched.len() as u32);
    let root = SVGBackend::with_string(svg, size).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(title, (FONT, 18))
        .margin(16)
        .margin_right(36)
        .x_label_area_size(52)
        .y_label_area_size(NAMES)
        .build_cartesian_2d((left..right).log_scale(), -rows..0.0)?;
    chart
        .configure_mesh()
        .disable_y_mesh()
        .disable_y_axis()
        .x_desc("flips in excess, in 10,000 pixels a step (less is better)")
        .axis_desc_style((FONT, 18))
        .label_style((FONT, 16))
        .bold_line_style(RGBColor(190, 190, 190))
        .light_line_style(RGBColor(232, 232, 232))
        .x_label_formatter(&|value| plain(*value))
        .draw()?;
    let zero = TextStyle::from((FONT, 16).into_font())
        .color(&BLACK)
        .pos(Pos::new(HPos::Center, VPos::Top));
    let corner = EmptyElement::at((left, -rows));
    chart.draw_series([corner + Text::new("0", (0, 9), zero)])?;
    let name_style = TextStyle::from((FONT, 16).into_font())
        .color(&BLACK)
        .pos(Pos::new(HPos::Right, VPos::Center));
    for (row, one) in watched.iter().enumerate() {
        let y = -0.5 - row as f64;
        let name = format!("{}, {}", one.technique, one.light);
        let at = EmptyElement::at((left, y));
        chart.draw_series([at + Text::new(name, (-12, 0), name_style.clone())])?;
        chart.draw_series([PathElement::new(
            [(left, y), (right, y)],
            RGBColor(232, 232, 232),
        )])?;
        for (style, path) in one.paths.iter().enumerate() {
            let point = (path.excess.clamp(left, right), y);
            chart.draw_series([EmptyElement::at(point) + shape(style)])?;
        }
    }
    draw_key(&root, size.1)?;
    root.present()?;
    Ok(())
}

/// One outline for each path, hollow so that equals show.
fn shape(style: usize) -> PathElement<(i32, i32)> {
    let corners: &[(i32, i32)] = match style {
        0 => &[(-6, 5), (6, 5), (0, -7)],
        1 => &[(-5, -5), (5, -5), (5, 5), (-5, 5)],
        _ => &[(0, -8), (8, 0), (0, 8), (-8, 0)],
    };
    let closed: Vec<(i32, i32)> = corners.iter().chain(&corners[..1]).copied().collect();
    PathElement::new(closed, COLORS[style % COLORS.len()].stroke_width(2))
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn draw_key(root: &Area<'_>, height: u32) -> Result<(), Failure> {
    let y = height as i32 - 24;
    for (style, path) in Path::ALL.into_iter().enumerate() {
        let x = 24 + 76 * style as i32;
        let text = Text::new(path.name(), (12, -7), (FONT, 16).into_font());
        root.draw(&(EmptyElement::at((x, y)) + shape(style) + text))?;
    }
    Ok(())
}
