//! Speed against error, as a picture that also reads in print and without colour.

use anyhow::{Result, anyhow};
use plotters::coord::combinators::LogCoord;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use shadows::reference::{Candidate, Survey};

use crate::measure::Measured;
use crate::technique::{Config, Technique};

const SIZE: (u32, u32) = (880, 560);
pub const FONT: &str = "sans-serif";
/// Pixels from a mark's middle to its label.
const GAP: i32 = 13;
const LINE_HEIGHT: i32 = 20;
/// About that of the labels' font, to keep labels apart.
const CHARACTER_WIDTH: i32 = 8;
/// The kind of those that have names of their own.
const CHEAP: &str = "cheap";
const DIAMOND: [(i32, i32); 4] = [(0, -10), (10, 0), (0, 10), (-10, 0)];

/// Colours that people with any common colour blindness tell apart (Okabe and Ito, "Color Universal
/// Design", 2008); each comes with a shape of its own.
pub const COLORS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
];

struct Mark<'a> {
    name: &'a str,
    /// Which shape and colour.
    style: usize,
    labelled: bool,
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
    let marks: Vec<Mark<'_>> = measured
        .iter()
        .enumerate()
        .map(|(style, measured)| Mark {
            name: &measured.technique.name,
            style,
            labelled: true,
            time: measured.total_ms(),
            error: measured.wrong_percent(),
        })
        .collect();
    let mut svg = String::new();
    draw(&mut svg, title, &marks, &[]).map_err(|error| anyhow!("speed-vs-error.svg: {error}"))?;
    Ok(svg)
}

/// The plot of a sweep: one mark a configuration, a shape and a colour for each kind, a line along
/// each kind's front; the front of all is labelled.
///
/// # Errors
/// If the plotting library cannot draw it.
pub fn fronts(title: &str, survey: &Survey<Technique>) -> Result<String> {
    let best = survey.front();
    let mut marks = Vec::new();
    let mut lines = Vec::new();
    let mut legend = Vec::new();
    let kinds = [
        ("cube", "cubes \u{25cf}"),
        ("flat", "flat maps \u{25b2}"),
        ("volume", "volumes \u{25a0}"),
        (CHEAP, "cheap and baked \u{25c6}"),
    ];
    for (style, (kind, shape)) in kinds.into_iter().enumerate() {
        let of_kind = survey.candidates().iter();
        let measured = |c: &&Candidate<Technique>| c.time.is_finite() && c.error.is_finite();
        let of_kind = of_kind.filter(measured);
        let of_kind = of_kind.filter(|c| match c.configuration.config {
            Config::Survey(_) => kind == CHEAP,
            _ => c.configuration.name.starts_with(kind),
        });
        let of_kind: Vec<Candidate<&Technique>> = of_kind
            .map(|candidate| Candidate {
                configuration: &candidate.configuration,
                time: candidate.time,
                error: candidate.error,
            })
            .collect();
        if of_kind.is_empty() {
            continue;
        }
        legend.push(shape);
        marks.extend(of_kind.iter().map(|candidate| {
            Mark {
                name: &candidate.configuration.name,
                style,
                labelled: best
                    .iter()
                    .any(|best| best.configuration.name == candidate.configuration.name),
                time: candidate.time,
                error: 100.0 * candidate.error,
            }
        }));
        let front = Survey::new(of_kind);
        let front = front.front();
        lines.push((
            style,
            front.iter().map(|c| (c.time, 100.0 * c.error)).collect(),
        ));
    }
    let title = format!("{title}: {}", legend.join(", "));
    let mut svg = String::new();
    draw(&mut svg, &title, &marks, &lines)
        .map_err(|error| anyhow!("speed-vs-error.svg: {error}"))?;
    Ok(svg)
}

/// A kind's front: its style, and times with errors.
type Line = (usize, Vec<(f64, f64)>);

pub type Failure = Box<dyn std::error::Error>;

fn draw(
    svg: &mut String,
    title: &str,
    marks: &[Mark<'_>],
    lines: &[Line],
) -> std::result::Result<(), Failure> {
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
        .build_cartesian_2d((left..right).log_scale(), (bottom..top).log_scale())?;
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
    for (style, line) in lines {
        let points = line.iter();
        let points = points.map(|&(time, error)| (time.clamp(left, right), error.max(bottom)));
        let color = COLORS[style % COLORS.len()];
        chart.draw_series(LineSeries::new(points, color.stroke_width(2)))?;
    }
    draw_marks(&mut chart, marks, (left, right), bottom)?;
    root.present()?;
    Ok(())
}

type Plot<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<LogCoord<f64>, LogCoord<f64>>>;

fn draw_marks(
    chart: &mut Plot<'_, '_>,
    marks: &[Mark<'_>],
    (left, right): (f64, f64),
    bottom: f64,
) -> std::result::Result<(), Failure> {
    let places = marks.iter();
    let points: Vec<(f64, f64)> = places
        .map(|mark| (mark.time.clamp(left, right), mark.error.max(bottom)))
        .collect();
    let area = chart.plotting_area();
    let pixels: Vec<(i32, i32)> = points.iter().map(|p| area.map_coordinate(p)).collect();
    let mut labels = Labels::new(area.get_pixel_range().0, &pixels);
    for (place, mark) in marks.iter().enumerate() {
        draw_shape(chart, mark, points[place])?;
        if !mark.labelled {
            continue;
        }
        let text = mark.label();
        let (offset, line) = labels.place(pixels[place], &text);
        let style = TextStyle::from((FONT, 17).into_font())
            .color(&BLACK)
            .pos(Pos::new(HPos::Center, VPos::Center));
        if let Some(end) = line {
            let line = PathElement::new(vec![(0, 0), end], BLACK.mix(0.5));
            chart.draw_series([EmptyElement::at(points[place]) + line])?;
        }
        chart.draw_series([EmptyElement::at(points[place]) + Text::new(text, offset, style)])?;
    }
    Ok(())
}

/// The labels of a plot, none over another or over a mark.
pub struct Labels {
    xs: std::ops::Range<i32>,
    taken: Vec<Box2>,
}

impl Labels {
    /// Around these marks, between those pixels.
    pub fn new(xs: std::ops::Range<i32>, marks: &[(i32, i32)]) -> Self {
        let taken = marks.iter().map(|&p| Box2::around(p, GAP, GAP)).collect();
        Self { xs, taken }
    }

    /// Where a label goes from its mark, and the end of the line to it if it is too far away to be seen as
    /// the mark's own.
    pub fn place(&mut self, mark: (i32, i32), text: &str) -> ((i32, i32), Option<(i32, i32)>) {
        let half = text.len() as i32 * CHARACTER_WIDTH / 2;
        let offset = free_offset(mark, half, &self.xs, &self.taken);
        let middle = (mark.0 + offset.0, mark.1 + offset.1);
        self.taken.push(Box2::around(middle, half, LINE_HEIGHT / 2));
        let far = offset.1.abs() > GAP + LINE_HEIGHT;
        let end = (offset.0, offset.1 - offset.1.signum() * LINE_HEIGHT / 2);
        (offset, far.then_some(end))
    }
}

/// A box of pixels.
#[derive(Clone, Copy)]
struct Box2 {
    min: (i32, i32),
    max: (i32, i32),
}

impl Box2 {
    fn around((x, y): (i32, i32), half_width: i32, half_height: i32) -> Self {
        Self {
            min: (x - half_width, y - half_height),
            max: (x + half_width, y + half_height),
        }
    }

    fn overlaps(&self, other: &Self) -> bool {
        let apart = self.max.0 <= other.min.0
            || other.max.0 <= self.min.0
            || self.max.1 <= other.min.1
            || other.max.1 <= self.min.1;
        !apart
    }
}

/// Where a label goes, from its mark: right, left, above or below, whichever is free first, else
/// ever farther away.
fn free_offset(
    mark: (i32, i32),
    half: i32,
    xs: &std::ops::Range<i32>,
    taken: &[Box2],
) -> (i32, i32) {
    let aside = GAP + half;
    let step = GAP + LINE_HEIGHT / 2;
    let near = [(aside, 0), (-aside, 0), (0, -step), (0, step)];
    let corners = [
        (aside, -step),
        (-aside, -step),
        (aside, step),
        (-aside, step),
    ];
    // Farther up or down, moved aside as far as the picture's edges make it.
    let inward = (xs.start + half - mark.0).max(0) + (xs.end - half - mark.0).min(0);
    let farther = (2..).flat_map(|n| [(inward, -n * step), (inward, n * step)]);
    let mut offsets = near.into_iter().chain(corners).chain(farther);
    let free = offsets.find(|offset| {
        let label = Box2::around(
            (mark.0 + offset.0, mark.1 + offset.1),
            half,
            LINE_HEIGHT / 2,
        );
        let inside = label.min.0 >= xs.start && label.max.0 <= xs.end;
        (inside || offset.1.abs() > step) && !taken.iter().any(|other| label.overlaps(other))
    });
    free.unwrap_or((aside, 0))
}

fn draw_shape(
    chart: &mut Plot<'_, '_>,
    mark: &Mark<'_>,
    point: (f64, f64),
) -> std::result::Result<(), Failure> {
    let style = COLORS[mark.style % COLORS.len()].filled();
    let at = EmptyElement::at(point);
    // Many marks without labels are small.
    let size = if mark.labelled { 7 } else { 4 };
    let square = [(-size, -size), (size, size)];
    match mark.style % 4 {
        0 => drop(chart.draw_series([Circle::new(point, size + 1, style)])?),
        1 => drop(chart.draw_series([TriangleMarker::new(point, size + 4, style)])?),
        2 => drop(chart.draw_series([at + Rectangle::new(square, style)])?),
        _ => drop(chart.draw_series([at + Polygon::new(DIAMOND, style)])?),
    }
    Ok(())
}

impl Mark<'_> {
    fn label(&self) -> String {
        let Self {
            name, time, error, ..
        } = self;
        if *error > 0.0 {
            format!("{name}: {} ms, {} %", rounded(*time), rounded(*error))
        } else {
            format!("{name}: {} ms, no wrong pixel", rounded(*time))
        }
    }
}

/// Powers of ten around the values above 0, with a margin; `(0.01, 1.0)` if there are none.
pub fn decades(values: impl Iterator<Item = f64>) -> (f64, f64) {
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
pub fn plain(value: f64) -> String {
    let digits = (-value.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.digits$}")
}
