//! The picture: a panel for each kind of light, instructions to the right, wrong pixels upward.

use anyhow::{Result, anyhow};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use shadows::reference::{Candidate, Survey};

use super::report::heading;
use super::{Costs, Found, Lit};
use crate::plot::{COLORS, FONT, Failure, Labels, plain};

const SIZE: (u32, u32) = (960, 1380);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// # Errors
/// If the plotting library cannot draw it.
pub fn svg(costs: &Costs) -> Result<String> {
    let mut svg = String::new();
    draw(&mut svg, costs).map_err(|error| anyhow!("cost-vs-error.svg: {error}"))?;
    Ok(svg)
}

fn draw(svg: &mut String, costs: &Costs) -> std::result::Result<(), Failure> {
    let root = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let lit: Vec<&Lit> = costs.lit.iter().filter(|l| !l.found.is_empty()).collect();
    let first = costs.scenes.first().map_or("", String::as_str);
    for (area, lit) in root.split_evenly((lit.len(), 1)).iter().zip(lit) {
        panel(area, lit, first)?;
    }
    root.present()?;
    Ok(())
}

/// From the least to the greatest, with some room.
fn span(values: impl Iterator<Item = f64> + Clone, room: f64) -> (f64, f64) {
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let most = values.fold(f64::NEG_INFINITY, f64::max);
    (least.max(1e-4) / room, most.max(1e-4) * room)
}

fn panel(area: &Area<'_>, lit: &Lit, scene: &str) -> std::result::Result<(), Failure> {
    let (left, right) = span(lit.found.iter().map(|f| f.count.valu as f64), 1.6);
    let (bottom, top) = span(lit.found.iter().map(|f| f.wrong(0)), 1.35);
    let title = format!(
        "{}, {scene}: this library\u{2019}s kernels \u{25cf}, our rendition of others \u{25b2}",
        heading(lit.light)
    );
    let mut chart = ChartBuilder::on(area)
        .caption(title, (FONT, 20))
        .margin(12)
        .margin_right(30)
        .x_label_area_size(50)
        .y_label_area_size(80)
        .build_cartesian_2d((left..right).log_scale(), (bottom..top).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("VALU instructions; beside the name: texture instructions")
        .y_desc("wrong pixels, %")
        .axis_desc_style((FONT, 17))
        .label_style((FONT, 15))
        .bold_line_style(RGBColor(190, 190, 190))
        .light_line_style(RGBColor(232, 232, 232))
        .x_label_formatter(&|value| plain(*value))
        .y_label_formatter(&|value| format!("{value:.2}"))
        .draw()?;
    for (style, other) in [(0, false), (1, true)] {
        let line = front(lit, other);
        chart.draw_series(LineSeries::new(line, COLORS[style].stroke_width(2)))?;
    }
    let points: Vec<(f64, f64)> = lit.found.iter().map(point).collect();
    let plotting = chart.plotting_area();
    let pixels: Vec<(i32, i32)> = points.iter().map(|p| plotting.map_coordinate(p)).collect();
    let mut labels = Labels::new(plotting.get_pixel_range().0, &pixels);
    for ((found, &at), &pixel) in lit.found.iter().zip(&points).zip(&pixels) {
        let best = !found.is_beaten_by(&lit.found);
        let style = COLORS[usize::from(found.other)].filled();
        let size = if best { 8 } else { 5 };
        match found.other {
            false => drop(chart.draw_series([Circle::new(at, size, style)])?),
            true => drop(chart.draw_series([TriangleMarker::new(at, size + 2, style)])?),
        }
        let name = found.name.trim_start_matches("peer/");
        let (_, name) = name.split_once('/').unwrap_or(("", name));
        let text = format!("{name}, {} tex", found.count.texture);
        let (offset, line) = labels.place(pixel, &text);
        if let Some(end) = line {
            let line = PathElement::new(vec![(0, 0), end], BLACK.mix(0.4));
            chart.draw_series([EmptyElement::at(at) + line])?;
        }
        let style = TextStyle::from((FONT, 15).into_font())
            .color(&BLACK)
            .pos(Pos::new(HPos::Center, VPos::Center));
        chart.draw_series([EmptyElement::at(at) + Text::new(text, offset, style)])?;
    }
    Ok(())
}

fn point(found: &Found) -> (f64, f64) {
    (found.count.valu.max(1) as f64, found.wrong(0).max(1e-4))
}

/// Those of a group that no other beats in VALU instructions and error.
fn front(lit: &Lit, other: bool) -> Vec<(f64, f64)> {
    let group = lit.found.iter().filter(|found| found.other == other);
    let candidates = group.map(|found| Candidate {
        configuration: point(found),
        time: found.count.valu as f64,
        error: found.wrong(0),
    });
    let survey = Survey::new(candidates.collect());
    let front = survey.front();
    front.iter().map(|best| best.configuration).collect()
}
