//! Trajectories as SVG: from the side and from above.

use super::Vec3;
use plotters::backend::SVGBackend;
use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::types::RangedCoordf64;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{Circle, Text};
use plotters::series::LineSeries;
use plotters::style::{Color, IntoFont, RGBColor, ShapeStyle, TextStyle, WHITE};
use rapier3d_immersed::motion::{Moment, Trajectory};

/// What can go wrong when drawing.
pub type Failure = String;

type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

fn failure<E: std::error::Error + Send + Sync>(error: DrawingAreaErrorKind<E>) -> Failure {
    error.to_string()
}

/// Dark blue through green to yellow, `s` ∈ [0, 1].
pub fn time_color(s: f64) -> RGBColor {
    const STOPS: [[f64; 3]; 5] = [
        [62.0, 38.0, 120.0],
        [50.0, 90.0, 150.0],
        [32.0, 140.0, 140.0],
        [90.0, 185.0, 90.0],
        [225.0, 195.0, 40.0],
    ];
    let at = s.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let i = (at as usize).min(STOPS.len() - 2);
    let mix = |k: usize| (STOPS[i][k] + (STOPS[i + 1][k] - STOPS[i][k]) * (at - i as f64)) as u8;
    RGBColor(mix(0), mix(1), mix(2))
}

/// A line in a panel: points (m) and colour.
pub struct Line {
    /// Horizontal and vertical coordinates, m.
    pub points: Vec<(f64, f64)>,
    /// Its colour.
    pub color: RGBColor,
    /// Its width, pixels.
    pub width: u32,
}

/// One panel: lines over axes of equal scale.
pub struct Panel<'a> {
    /// Caption.
    pub title: &'a str,
    /// Names of the axes.
    pub axes: [&'a str; 2],
    /// What to draw.
    pub lines: Vec<Line>,
    /// Dots where trajectories end.
    pub dots: Vec<((f64, f64), RGBColor)>,
    /// Both ranges to show; fitted to the lines where absent.
    pub window: Option<[(f64, f64); 2]>,
}

/// The smallest ranges of equal scale that hold all lines in an area of `size` pixels.
fn fitted(panel: &Panel, size: (u32, u32)) -> [(f64, f64); 2] {
    let mut ranges = panel.window.unwrap_or_else(|| {
        let mut ranges = [(f64::INFINITY, f64::NEG_INFINITY); 2];
        for (x, y) in panel.lines.iter().flat_map(|line| &line.points) {
            for (range, value) in ranges.iter_mut().zip([*x, *y]) {
                *range = (range.0.min(value), range.1.max(value));
            }
        }
        ranges
    });
    for range in &mut ranges {
        if range.0 > range.1 {
            *range = (0.0, 0.0);
        }
    }
    let extent = |r: (f64, f64)| (r.1 - r.0) * 1.08;
    let per_pixel = (extent(ranges[0]) / f64::from(size.0))
        .max(extent(ranges[1]) / f64::from(size.1))
        .max(1e-9);
    let grown = |r: (f64, f64), pixels: u32| {
        let (middle, half) = (0.5 * (r.0 + r.1), 0.5 * per_pixel * f64::from(pixels));
        (middle - half, middle + half)
    };
    [grown(ranges[0], size.0), grown(ranges[1], size.1)]
}

/// At most three decimals, and no negative zero.
fn label(value: &f64) -> String {
    let rounded = (value * 1e3).round() / 1e3 + 0.0;
    format!("{rounded}")
}

const MARGIN: u32 = 12;
const LABELS: u32 = 54;

fn chart<'a, 'b>(
    area: &'b Area<'a>,
    [x, y]: [(f64, f64); 2],
) -> Result<Chart<'b, SVGBackend<'a>>, Failure> {
    ChartBuilder::on(area)
        .margin(MARGIN)
        .x_label_area_size(LABELS)
        .y_label_area_size(LABELS)
        .build_cartesian_2d(x.0..x.1, y.0..y.1)
        .map_err(failure)
}

fn draw(area: &Area, panel: &Panel) -> Result<(), Failure> {
    let area = area
        .titled(panel.title, ("sans-serif", 17))
        .map_err(failure)?;
    // How many pixels there are for the lines is known once a chart has been laid out.
    let size = chart(&area, [(0.0, 1.0); 2])?
        .plotting_area()
        .dim_in_pixel();
    let mut chart = chart(&area, fitted(panel, size))?;
    chart
        .configure_mesh()
        .x_labels((size.0 / 70).max(2) as usize)
        .y_labels((size.1 / 60).max(2) as usize)
        .max_light_lines(0)
        .bold_line_style(RGBColor(225, 225, 225))
        .axis_style(RGBColor(120, 120, 120))
        .x_desc(panel.axes[0])
        .y_desc(panel.axes[1])
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .label_style(("sans-serif", 13))
        .draw()
        .map_err(failure)?;
    // The drawing library moves what lies outside onto the edge.
    let [x, y] = fitted(panel, size);
    let inside = |p: &(f64, f64)| (x.0..=x.1).contains(&p.0) && (y.0..=y.1).contains(&p.1);
    for line in &panel.lines {
        let style = ShapeStyle::from(line.color).stroke_width(line.width);
        for part in line
            .points
            .split(|p| !inside(p))
            .filter(|part| part.len() > 1)
        {
            chart
                .draw_series(LineSeries::new(part.iter().copied(), style))
                .map_err(failure)?;
        }
    }
    let dots = panel.dots.iter().filter(|(at, _)| inside(at));
    chart
        .draw_series(dots.map(|(at, color)| Circle::new(*at, 2, color.filled())))
        .map_err(failure)?;
    Ok(())
}

/// Panels side by side, each `size` pixels, in rows of `columns`, under a title.
///
/// # Errors
/// What the drawing library says.
pub fn panels(
    title: &str,
    panels: &[Panel],
    columns: usize,
    size: (u32, u32),
) -> Result<String, Failure> {
    let rows = panels.len().div_ceil(columns);
    let mut svg = String::new();
    let whole = (size.0 * columns as u32, size.1 * rows as u32 + 40);
    {
        let root = SVGBackend::with_string(&mut svg, whole).into_drawing_area();
        root.fill(&WHITE).map_err(failure)?;
        let style = TextStyle::from(("sans-serif", 20).into_font());
        root.draw(&Text::new(title, (16, 10), style))
            .map_err(failure)?;
        let (_, below) = root.split_vertically(40);
        for (area, panel) in below.split_evenly((rows, columns)).iter().zip(panels) {
            draw(area, panel)?;
        }
        root.present().map_err(failure)?;
    }
    Ok(svg)
}

/// The fall of one body: from the side, looking across its drift, and from above; coloured by time
/// from blue to yellow, with strokes that show the body's chord (m).
///
/// # Errors
/// What the drawing library says.
pub fn fall(fall: &Trajectory, chord: f64) -> Result<String, Failure> {
    const SIZE: (u32, u32) = (470, 820);
    let moments = &fall.moments;
    let Some((first, last)) = moments.first().zip(moments.last()) else {
        return Err("there is nothing to draw".into());
    };
    let along = drift_direction(moments);
    let side = |p: &Vec3| (p.dot(&along), p.y);
    let above = |p: &Vec3| (p.x, p.z);
    let mut sides = Panel {
        title: "from the side",
        axes: ["along the drift, m", "height, m"],
        lines: by_time(moments, side),
        dots: Vec::new(),
        window: None,
    };
    let aboves = Panel {
        title: "from above",
        axes: ["x, m", "z, m"],
        lines: by_time(moments, above),
        dots: vec![
            (above(&first.position), time_color(0.0)),
            (above(&last.position), time_color(1.0)),
        ],
        window: None,
    };
    // Strokes of at least 16 pixels.
    let range = fitted(&sides, SIZE)[0];
    let stroke_pixels = chord * f64::from(SIZE.0) / (range.1 - range.0);
    let enlarged = (16.0 / stroke_pixels).max(1.0).ceil();
    let toward = along.cross(&Vec3::y());
    let every = (moments.len() / 110).max(1);
    for (i, moment) in moments.iter().enumerate().step_by(every) {
        let stroke = toward.cross(&moment.normal) * (0.5 * chord * enlarged);
        let ends = [moment.position - stroke, moment.position + stroke];
        sides.lines.push(Line {
            points: ends.iter().map(side).collect(),
            color: time_color(i as f64 / moments.len() as f64),
            width: 2,
        });
    }
    let title = match enlarged as u32 {
        1 => format!("{:.3} s of free fall", fall.duration()),
        n => format!(
            "{:.3} s of free fall; the strokes show the chord {n} times its size",
            fall.duration()
        ),
    };
    panels(&title, &[sides, aboves], 2, SIZE)
}

/// Polylines of one colour each, 48 of them over the whole time.
fn by_time(moments: &[Moment], project: impl Fn(&Vec3) -> (f64, f64)) -> Vec<Line> {
    const PIECES: usize = 48;
    const POINTS: usize = 1500;
    let thin = (moments.len() / POINTS).max(1);
    let points: Vec<(f64, f64)> = moments
        .iter()
        .step_by(thin)
        .map(|s| project(&s.position))
        .collect();
    let length = points.len().div_ceil(PIECES).max(1);
    (0..points.len().saturating_sub(1))
        .step_by(length)
        .map(|i| Line {
            points: points[i..(i + length + 1).min(points.len())].to_vec(),
            color: time_color(i as f64 / points.len() as f64),
            width: 1,
        })
        .collect()
}

/// The horizontal direction in which the positions scatter most.
fn drift_direction(moments: &[Moment]) -> Vec3 {
    let count = moments.len() as f64;
    let mean = moments.iter().map(|s| s.position).sum::<Vec3>() / count;
    let (mut xx, mut xz, mut zz) = (0.0, 0.0, 0.0);
    for moment in moments {
        let d = moment.position - mean;
        xx += d.x * d.x;
        xz += d.x * d.z;
        zz += d.z * d.z;
    }
    let angle = 0.5 * (2.0 * xz).atan2(xx - zz);
    Vec3::new(angle.cos(), 0.0, angle.sin())
}
