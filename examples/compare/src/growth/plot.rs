//! A quantity's curves, both axes logarithmic.

use anyhow::{Result, anyhow};
use plotters::coord::combinators::LogCoord;
use plotters::prelude::*;

use super::Series;
use super::fit::Fit;
use super::report::slope;
use crate::plot::{COLORS, FONT, Failure, decades, plain};
use host::timer::Clock;

const WIDTH: u32 = 880;
const CHART: u32 = 520;
/// Pixels of a line of the key.
const LINE: i32 = 24;

/// The plot as SVG: filled marks and thick lines for the GPU, hollow marks and thin ones for the
/// CPU, a shape and a colour for each technique, and a grey line that grows linearly.
///
/// # Errors
/// If the plotting library cannot draw it.
pub fn curves(adapter: &str, clock: Clock, series: &Series) -> Result<String> {
    let mut svg = String::new();
    let name = series.quantity.name();
    draw(&mut svg, adapter, clock, series)
        .map_err(|error| anyhow!("growth-{name}.svg: {error}"))?;
    Ok(svg)
}

fn draw(svg: &mut String, adapter: &str, clock: Clock, series: &Series) -> Result<(), Failure> {
    let points = || {
        let curves = series.curves.iter();
        curves.flat_map(|curve| curve.prepare.iter().chain(&curve.work))
    };
    let (left, right) = around(points().map(|point| point.0));
    let (bottom, top) = decades(points().map(|point| point.1));
    let key = LINE as u32 * (series.curves.len() as u32 + 1);
    let root = SVGBackend::with_string(svg, (WIDTH, CHART + key)).into_drawing_area();
    root.fill(&WHITE)?;
    let (upper, lower) = root.split_vertically(CHART);
    let mut chart = ChartBuilder::on(&upper)
        .caption(format!("{}, {adapter}", series.quantity.name()), (FONT, 20))
        .margin(16)
        .margin_right(36)
        .x_label_area_size(52)
        .y_label_area_size(84)
        .build_cartesian_2d((left..right).log_scale(), (bottom..top).log_scale())?;
    chart
        .configure_mesh()
        .x_labels(6)
        .x_desc(series.quantity.unit())
        .y_desc("milliseconds a frame")
        .axis_desc_style((FONT, 18))
        .label_style((FONT, 16))
        .bold_line_style(RGBColor(190, 190, 190))
        .light_line_style(RGBColor(232, 232, 232))
        .x_label_formatter(&|value| plain(*value))
        .y_label_formatter(&|value| plain(*value))
        .draw()?;
    draw_linear(&mut chart, (left, right), (bottom, top))?;
    for (style, curve) in series.curves.iter().enumerate() {
        draw_curve(&mut chart, style, &curve.prepare, false)?;
        draw_curve(&mut chart, style, &curve.work, true)?;
    }
    draw_key(&lower, clock, series)?;
    root.present()?;
    Ok(())
}

type Plot<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<LogCoord<f64>, LogCoord<f64>>>;

/// From the least to the greatest, with a margin.
fn around(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (least, most) = values.fold((f64::INFINITY, 0.0_f64), |(least, most), value| {
        (least.min(value), most.max(value))
    });
    (least / 1.3, most * 1.3)
}

/// What linear would look like, through the upper right corner.
fn draw_linear(
    chart: &mut Plot<'_, '_>,
    (left, right): (f64, f64),
    (bottom, top): (f64, f64),
) -> Result<(), Failure> {
    let start = left.max(bottom / top * right);
    let line = [(start, top * start / right), (right, top)];
    let grey = RGBColor(150, 150, 150).stroke_width(1);
    chart.draw_series(DashedLineSeries::new(line, 6, 5, grey))?;
    Ok(())
}

fn draw_curve(
    chart: &mut Plot<'_, '_>,
    style: usize,
    points: &[(f64, f64)],
    filled: bool,
) -> Result<(), Failure> {
    let color = COLORS[style % COLORS.len()];
    let width = if filled { 3 } else { 1 };
    // Noise may leave a difference at nothing, which has no logarithm.
    let points = points.iter().copied().filter(|point| point.1 > 0.0);
    let points: Vec<(f64, f64)> = points.collect();
    let line = points.iter().copied();
    chart.draw_series(LineSeries::new(line, color.stroke_width(width)))?;
    for point in points {
        let outline = mark(style, color.stroke_width(2));
        chart.draw_series([EmptyElement::at(point) + fill(style, filled) + outline])?;
    }
    Ok(())
}

/// Up, square, diamond or down.
fn corners(style: usize) -> Vec<(i32, i32)> {
    match style % 4 {
        0 => vec![(-6, 5), (6, 5), (0, -7)],
        1 => vec![(-5, -5), (5, -5), (5, 5), (-5, 5)],
        2 => vec![(0, -8), (8, 0), (0, 8), (-8, 0)],
        _ => vec![(-6, -5), (6, -5), (0, 7)],
    }
}

fn mark(style: usize, line: ShapeStyle) -> PathElement<(i32, i32)> {
    let mut closed = corners(style);
    closed.push(closed[0]);
    PathElement::new(closed, line)
}

/// What is hollow is white inside, so that lines end at its edge.
fn fill(style: usize, filled: bool) -> Polygon<(i32, i32)> {
    let color = match filled {
        true => COLORS[style % COLORS.len()],
        false => WHITE,
    };
    Polygon::new(corners(style), color.filled())
}

fn draw_key(
    area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    clock: Clock,
    series: &Series,
) -> Result<(), Failure> {
    let text = |text: String| Text::new(text, (14, -7), (FONT, 16).into_font());
    let clock = match clock {
        Clock::Gpu => "timestamps",
        Clock::Wall => "wall time",
    };
    let head = format!(
        "Filled: GPU ({clock}); hollow: prepare on the CPU; dashed: linear. Slopes of what comes on \
         top of the first point:"
    );
    area.draw(&(EmptyElement::at((16, 8)) + text(head)))?;
    for (style, curve) in series.curves.iter().enumerate() {
        let y = 8 + LINE * (style as i32 + 1);
        let line = COLORS[style % COLORS.len()].stroke_width(2);
        let flat_or = |fit: Option<Fit>| fit.map_or("flat".into(), |fit| slope(Some(fit)));
        let [prepare, work] = curve.added().map(flat_or);
        let label = format!("{}: GPU {work}, prepare {prepare}", curve.kind.name);
        area.draw(
            &(EmptyElement::at((38, y)) + fill(style, true) + mark(style, line) + text(label)),
        )?;
    }
    Ok(())
}
