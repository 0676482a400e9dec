//! Speed against error, as a picture that also reads in print and without colour.

use anyhow::{Result, anyhow};
use plotters::coord::combinators::LogCoord;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::measure::Measured;

const SIZE: (u32, u32) = (880, 560);
const FONT: &str = "sans-serif";
/// Pixels from a mark's middle to its label.
const GAP: i32 = 15;
const LINE_HEIGHT: i32 = 20;
/// About that of the labels' font, to keep labels apart.
const CHARACTER_WIDTH: i32 = 9;
const DIAMOND: [(i32, i32); 4] = [(0, -10), (10, 0), (0, 10), (-10, 0)];

/// Colours that people with any common colour blindness tell apart (Okabe and Ito, "Color Universal
/// Design", 2008); each comes with a shape of its own.
const COLORS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
];

struct Mark {
    name: &'static str,
    /// Milliseconds.
    time: f64,
    /// Per cent, 0 included.
    error: f64,
}

/// The plot as SVG: milliseconds to the right, per cent of wrong pixels upward, both logarithmic.
///
/// # Errors
/// If the plotting library cannot draw it.
pub fn speed_vs_error(title: &str, measured: &[Measured]) -> Result<String> {
    let marks: Vec<Mark> = measured
        .iter()
        .map(|measured| Mark {
            name: measured.technique.name(),
            time: measured.total_ms(),
            error: measured.wrong_percent(),
        })
        .collect();
    let mut svg = String::new();
    draw(&mut svg, title, &marks).map_err(|error| anyhow!("speed-vs-error.svg: {error}"))?;
    Ok(svg)
}

type Failure = Box<dyn std::error::Error>;

fn draw(svg: &mut String, title: &str, marks: &[Mark]) -> std::result::Result<(), Failure> {
    let (left, right) = decades(marks.iter().map(|mark| mark.time));
    let (floor, top) = decades(marks.iter().map(|mark| mark.error));
    // A place for what no logarithm shows, a decade below the smallest error there is.
    let has_zero = marks.iter().any(|mark| mark.error <= 0.0);
    let bottom = if has_zero { floor / 10.0 } else { floor };

    let root = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(title, (FONT, 22))
        .margin(16)
        .margin_right(36)
        .x_label_area_size(52)
        .y_label_area_size(84)
        .build_cartesian_2d(
            (left..right).log_scale(),
            (bottom..top).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc("milliseconds a frame for shadows (less is better)")
        .y_desc("wrong pixels, % (less is better)")
        .axis_desc_style((FONT, 18))
        .label_style((FONT, 16))
        .bold_line_style(RGBColor(190, 190, 190))
        .light_line_style(RGBColor(232, 232, 232))
        .x_label_formatter(&|value| plain(*value))
        .y_label_formatter(&|value| {
            if has_zero && *value <= bottom * 1.0001 {
                "0".to_owned()
            } else {
                plain(*value)
            }
        })
        .draw()?;
    draw_marks(&mut chart, marks, (left, right), bottom)?;
    root.present()?;
    Ok(())
}

type Plot<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<LogCoord<f64>, LogCoord<f64>>>;

fn draw_marks(
    chart: &mut Plot<'_, '_>,
    marks: &[Mark],
    (left, right): (f64, f64),
    bottom: f64,
) -> std::result::Result<(), Failure> {
    let mut labels: Vec<(i32, i32)> = Vec::new();
    for (place, mark) in marks.iter().enumerate() {
        let point = (mark.time.clamp(left, right), mark.error.max(bottom));
        draw_shape(chart, place, point)?;
        let text = mark.label();
        // On the side with room, and not on top of another label.
        let to_right = point.0 * point.0 < left * right;
        let width = text.len() as i32 * CHARACTER_WIDTH;
        let (x, y) = chart.plotting_area().map_coordinate(&point);
        let start = if to_right { x + GAP } else { x - GAP - width };
        let mut rise = 0;
        while labels
            .iter()
            .any(|l| (l.0 - start).abs() < width && (l.1 - (y - rise)).abs() < LINE_HEIGHT)
        {
            rise += LINE_HEIGHT;
        }
        labels.push((start, y - rise));
        draw_label(chart, point, text, to_right, rise)?;
    }
    Ok(())
}

fn draw_label(
    chart: &mut Plot<'_, '_>,
    point: (f64, f64),
    text: String,
    to_right: bool,
    rise: i32,
) -> std::result::Result<(), Failure> {
    let (side, offset) = if to_right {
        (HPos::Left, GAP)
    } else {
        (HPos::Right, -GAP)
    };
    let style = TextStyle::from((FONT, 17).into_font())
        .color(&BLACK)
        .pos(Pos::new(side, VPos::Center));
    chart.draw_series(std::iter::once(
        EmptyElement::at(point) + Text::new(text, (offset, -rise), style),
    ))?;
    Ok(())
}

fn draw_shape(
    chart: &mut Plot<'_, '_>,
    place: usize,
    point: (f64, f64),
) -> std::result::Result<(), Failure> {
    let style = COLORS[place % COLORS.len()].filled();
    let shape = match place % 4 {
        0 => Circle::new(point, 8, style).into_dyn(),
        1 => TriangleMarker::new(point, 10, style).into_dyn(),
        2 => (EmptyElement::at(point) + Rectangle::new([(-7, -7), (7, 7)], style)).into_dyn(),
        _ => (EmptyElement::at(point) + Polygon::new(DIAMOND.to_vec(), style)).into_dyn(),
    };
    chart.draw_series(std::iter::once(shape))?;
    Ok(())
}

impl Mark {
    fn label(&self) -> String {
        let Self { name, time, error } = self;
        if *error > 0.0 {
            format!("{name}: {} ms, {} %", rounded(*time), rounded(*error))
        } else {
            format!("{name}: {} ms, no wrong pixel", rounded(*time))
        }
    }
}

/// Powers of ten around the values above 0, with a margin; `(0.01, 1.0)` if there are none.
fn decades(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let logs: Vec<f64> = values.filter(|v| *v > 0.0).map(f64::log10).collect();
    if logs.is_empty() {
        return (0.01, 1.0);
    }
    let least = logs.iter().copied().fold(f64::INFINITY, f64::min);
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let low = (least - 0.1).floor() as i32;
    let high = ((most + 0.1).ceil() as i32).max(low + 1);
    (10_f64.powi(low), 10_f64.powi(high))
}

/// Three digits that count.
fn rounded(value: f64) -> String {
    let digits = 2 - value.abs().log10().floor() as i32;
    format!("{value:.*}", digits.clamp(0, 6) as usize)
}

/// A tick: no digits that are zero anyway.
fn plain(value: f64) -> String {
    let digits = (-value.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.digits$}")
}
