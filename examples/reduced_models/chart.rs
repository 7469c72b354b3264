//! Line charts in panels, as one SVG file.

use plotters::prelude::*;
use plotters::style::full_palette;
use std::error::Error;
use std::path::Path;

pub use plotters::chart::SeriesLabelPosition;
pub use plotters::style::BLACK;

/// The backend rounds to whole pixels: drawn larger than it is looked at, lines stay smooth.
const SCALE: u32 = 3;
/// Length of a line in the legend.
const LEGEND: i32 = 18 * SCALE as i32;

pub const COLORS: [RGBColor; 6] = [
    full_palette::RED_700,
    full_palette::BLUE_700,
    full_palette::GREEN_700,
    full_palette::DEEPORANGE_600,
    full_palette::PURPLE_600,
    full_palette::GREY_700,
];

#[derive(Clone, Copy, PartialEq)]
pub enum Mark {
    Line,
    Dots,
    LineAndDots,
}

pub struct Series {
    pub label: String,
    pub points: Vec<(f64, f64)>,
    pub color: RGBColor,
    pub mark: Mark,
}

#[derive(Default)]
pub struct Panel {
    pub title: String,
    pub x: String,
    pub y: String,
    pub log_x: bool,
    pub log_y: bool,
    pub equal_axes: bool,
    pub legend: Option<SeriesLabelPosition>,
    pub series: Vec<Series>,
}

impl Panel {
    pub fn new(title: &str, x: &str, y: &str) -> Self {
        Self {
            title: title.into(),
            x: x.into(),
            y: y.into(),
            ..Self::default()
        }
    }

    /// Adds a series; an empty label keeps it out of the legend.
    pub fn add(&mut self, label: &str, color: RGBColor, mark: Mark, points: Vec<(f64, f64)>) {
        self.series.push(Series {
            label: label.into(),
            points,
            color,
            mark,
        });
    }
}

fn power(exponent: f64) -> String {
    if (exponent - exponent.round()).abs() > 1e-6 {
        return String::new();
    }
    let exponent = exponent.round();
    if (0.0..4.0).contains(&exponent) {
        format!("{}", 10_f64.powf(exponent))
    } else {
        format!("1e{exponent}")
    }
}

fn number(x: f64, span: f64) -> String {
    let decimals = (1.0 - span.log10().floor()).clamp(0.0, 4.0) as usize;
    let text = format!("{x:.decimals$}");
    if decimals > 0 {
        text.trim_end_matches('0').trim_end_matches('.').to_string()
    } else {
        text
    }
}

/// The ends of the values with a margin; whole decades on a logarithmic axis.
fn range(values: impl Iterator<Item = f64>, log: bool) -> (f64, f64) {
    let (low, high) = values
        .filter(|v| v.is_finite())
        .fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
    if low > high {
        return (0.0, 1.0);
    }
    if log {
        return (low.floor(), high.ceil().max(low.floor() + 1.0));
    }
    let margin = 0.04 * (high - low).max(1e-9);
    (low - margin, high + margin)
}

/// Draws the panels row by row into `path`.
pub fn draw(path: &Path, columns: usize, panels: &[Panel]) -> Result<(), Box<dyn Error>> {
    let rows = panels.len().div_ceil(columns);
    let (width, height) = (520 * SCALE as usize, 400 * SCALE as usize);
    let size = ((columns * width) as u32, (rows * height) as u32);
    let root = SVGBackend::new(path, size).into_drawing_area();
    root.fill(&WHITE)?;
    for (area, panel) in root.split_evenly((rows, columns)).iter().zip(panels) {
        let map = |(x, y): (f64, f64)| {
            (
                if panel.log_x { x.log10() } else { x },
                if panel.log_y { y.log10() } else { y },
            )
        };
        let all = || {
            panel
                .series
                .iter()
                .flat_map(|s| s.points.iter().map(|p| map(*p)))
        };
        let (mut x, mut y) = (
            range(all().map(|p| p.0), panel.log_x),
            range(all().map(|p| p.1), panel.log_y),
        );
        if panel.equal_axes {
            // The plot area is about 430 by 310 pixels.
            let scale = ((x.1 - x.0) / 430.0).max((y.1 - y.0) / 310.0);
            let widen = |(a, b): (f64, f64), pixels: f64| {
                let half = 0.5 * scale * pixels;
                (0.5 * (a + b) - half, 0.5 * (a + b) + half)
            };
            (x, y) = (widen(x, 430.0), widen(y, 310.0));
        }
        let mut chart = ChartBuilder::on(area)
            .caption(&panel.title, ("sans-serif", 19 * SCALE))
            .margin(10 * SCALE)
            .margin_right(18 * SCALE)
            .x_label_area_size(42 * SCALE)
            .y_label_area_size(62 * SCALE)
            .build_cartesian_2d(x.0..x.1, y.0..y.1)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .x_labels(if panel.log_x {
                2 + (x.1 - x.0) as usize
            } else {
                7
            })
            .y_labels(if panel.log_y {
                2 + (y.1 - y.0) as usize
            } else {
                7
            })
            .x_desc(&panel.x)
            .y_desc(&panel.y)
            .label_style(("sans-serif", 14 * SCALE))
            .axis_desc_style(("sans-serif", 15 * SCALE))
            .x_label_formatter(&|v| {
                if panel.log_x {
                    power(*v)
                } else {
                    number(*v, x.1 - x.0)
                }
            })
            .y_label_formatter(&|v| {
                if panel.log_y {
                    power(*v)
                } else {
                    number(*v, y.1 - y.0)
                }
            })
            .draw()?;
        for series in &panel.series {
            let color = series.color;
            let points: Vec<(f64, f64)> = series
                .points
                .iter()
                .map(|p| map(*p))
                .filter(|p| p.0.is_finite() && p.1.is_finite())
                .collect();
            let mut label = (!series.label.is_empty()).then_some(series.label.clone());
            if series.mark != Mark::Dots {
                let drawn = chart.draw_series(LineSeries::new(
                    points.clone(),
                    color.stroke_width(2 * SCALE),
                ))?;
                if let Some(label) = label.take() {
                    drawn.label(label).legend(move |(x, y)| {
                        PathElement::new(
                            vec![(x, y), (x + LEGEND, y)],
                            color.stroke_width(2 * SCALE),
                        )
                    });
                }
            }
            if series.mark != Mark::Line {
                let radius = if points.len() > 100 { SCALE } else { 3 * SCALE };
                let dots = points
                    .iter()
                    .map(|p| Circle::new(*p, radius, color.filled()));
                let drawn = chart.draw_series(dots)?;
                if let Some(label) = label.take() {
                    drawn.label(label).legend(move |(x, y)| {
                        Circle::new((x + LEGEND / 2, y), 3 * SCALE, color.filled())
                    });
                }
            }
        }
        if panel.series.iter().any(|s| !s.label.is_empty()) {
            chart
                .configure_series_labels()
                .position(
                    panel
                        .legend
                        .clone()
                        .unwrap_or(SeriesLabelPosition::UpperRight),
                )
                .legend_area_size(26 * SCALE)
                .margin(5 * SCALE)
                .label_font(("sans-serif", 14 * SCALE))
                .background_style(WHITE.mix(0.85))
                .border_style(BLACK.mix(0.25))
                .draw()?;
        }
    }
    root.present()?;
    Ok(())
}
