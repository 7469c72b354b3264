//! Panels of lines, dots and labels, side by side, as SVG.

use plotters::backend::SVGBackend;
use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use rapier3d_immersed::motion::Pattern;
use std::error::Error;
use std::path::Path;

pub type Point = (f64, f64);

/// The thesis's colours: red SD, magenta AR, blue AZ, green ZZ.
pub fn color(pattern: Pattern) -> RGBColor {
    match pattern {
        Pattern::SteadyDescent => RGBColor(211, 47, 47),
        Pattern::Autorotation => RGBColor(190, 40, 170),
        Pattern::AutorotationZigzag => RGBColor(30, 90, 200),
        Pattern::Zigzag => RGBColor(46, 140, 60),
    }
}

/// Something in a panel, in its coordinates; sizes in pixels.
pub enum Item {
    Line(Vec<Point>, RGBColor, u32),
    Dashed(Vec<Point>, RGBColor),
    Dots(Vec<Point>, RGBColor, u32),
    /// Filled boxes between two corners.
    Boxes(Vec<(Point, Point)>, RGBColor),
    Label(Point, String, RGBColor),
}

pub struct Panel {
    pub title: String,
    /// Names of the axes; without them nothing is drawn around the panel.
    pub axes: Option<[String; 2]>,
    pub logarithmic: bool,
    /// The same scale along both axes.
    pub equal: bool,
    /// Ranges; fitted to the items where absent.
    pub window: Option<[Point; 2]>,
    pub items: Vec<Item>,
}

impl Panel {
    pub fn new(title: impl Into<String>, x: &str, y: &str) -> Self {
        Self {
            title: title.into(),
            axes: Some([x.into(), y.into()]),
            logarithmic: false,
            equal: false,
            window: None,
            items: Vec::new(),
        }
    }

    /// A panel without axes and with equal scales.
    pub fn bare(title: impl Into<String>) -> Self {
        Self {
            axes: None,
            equal: true,
            ..Self::new(title, "", "")
        }
    }

    pub fn equal(mut self) -> Self {
        self.equal = true;
        self
    }

    fn points(&self) -> impl Iterator<Item = Point> + '_ {
        self.items.iter().flat_map(|item| match item {
            Item::Line(points, ..) | Item::Dashed(points, _) | Item::Dots(points, ..) => {
                points.clone()
            }
            Item::Boxes(boxes, _) => boxes.iter().flat_map(|(a, b)| [*a, *b]).collect(),
            Item::Label(at, ..) => vec![*at],
        })
    }

    /// Ranges for an area of `size` pixels.
    fn ranges(&self, size: (u32, u32)) -> [Point; 2] {
        let mut ranges = self.window.unwrap_or_else(|| {
            let mut ranges = [(f64::INFINITY, f64::NEG_INFINITY); 2];
            for (x, y) in self.points() {
                for (range, value) in ranges.iter_mut().zip([x, y]) {
                    *range = (range.0.min(value), range.1.max(value));
                }
            }
            ranges.map(|(low, high)| {
                let pad = (0.05 * (high - low)).max(1e-9);
                if self.logarithmic || low > high {
                    (low.clamp(1e-9, 1e9), high.clamp(1e-8, 1e10))
                } else {
                    (low - pad, high + pad)
                }
            })
        });
        if self.equal {
            let per_pixel = ((ranges[0].1 - ranges[0].0) / f64::from(size.0))
                .max((ranges[1].1 - ranges[1].0) / f64::from(size.1));
            for (range, pixels) in ranges.iter_mut().zip([size.0, size.1]) {
                let middle = 0.5 * (range.0 + range.1);
                let half = 0.5 * per_pixel * f64::from(pixels);
                *range = (middle - half, middle + half);
            }
        }
        ranges
    }
}

/// Draws panels of `size` pixels each in rows of `columns` into an SVG file, under a title.
pub fn write(
    path: &Path,
    title: &str,
    panels: &[Panel],
    columns: usize,
    size: (u32, u32),
) -> Result<(), Box<dyn Error>> {
    write_with_legend(path, title, &[], panels, columns, size)
}

/// The same with what the colours mean to the right of the title.
pub fn write_with_legend(
    path: &Path,
    title: &str,
    legend: &[(String, RGBColor)],
    panels: &[Panel],
    columns: usize,
    size: (u32, u32),
) -> Result<(), Box<dyn Error>> {
    let svg = svg_with_legend(title, legend, panels, columns, size)?;
    Ok(std::fs::write(path, svg)?)
}

/// The panels as a string.
pub fn svg(
    title: &str,
    panels: &[Panel],
    columns: usize,
    size: (u32, u32),
) -> Result<String, Box<dyn Error>> {
    svg_with_legend(title, &[], panels, columns, size)
}

pub fn svg_with_legend(
    title: &str,
    legend: &[(String, RGBColor)],
    panels: &[Panel],
    columns: usize,
    size: (u32, u32),
) -> Result<String, Box<dyn Error>> {
    let mut svg = String::new();
    let rows = panels.len().div_ceil(columns);
    let whole = (size.0 * columns as u32, size.1 * rows as u32 + 44);
    {
        let root = SVGBackend::with_string(&mut svg, whole).into_drawing_area();
        root.fill(&WHITE)?;
        root.draw(&Text::new(title.to_string(), (16, 12), ("sans-serif", 20)))?;
        let mut right = whole.0 as i32 - 16;
        for (name, color) in legend.iter().rev() {
            let style = ("sans-serif", 15).into_font().color(color);
            right -= root.estimate_text_size(name, &style)?.0 as i32 + 8;
            root.draw(&Text::new(name.clone(), (right, 15), style))?;
            let line = vec![(right - 28, 22), (right - 6, 22)];
            root.draw(&PathElement::new(line, color.stroke_width(3)))?;
            right -= 44;
        }
        let (_, below) = root.split_vertically(44);
        for (area, panel) in below.split_evenly((rows, columns)).iter().zip(panels) {
            let area = area.titled(&panel.title, ("sans-serif", 16))?;
            let [labels, side] = if panel.axes.is_some() {
                [46, 58]
            } else {
                [4; 2]
            };
            let (width, height) = area.dim_in_pixel();
            let inner = (width - side - 20, height - labels - 20);
            let [x, y] = panel.ranges(inner);
            let mut builder = ChartBuilder::on(&area);
            builder
                .margin(10)
                .x_label_area_size(labels)
                .y_label_area_size(side);
            if panel.logarithmic {
                let x = (x.0..x.1).log_scale();
                let y = (y.0..y.1).log_scale();
                fill(builder.build_cartesian_2d(x, y)?, panel, power)?;
            } else {
                fill(
                    builder.build_cartesian_2d(x.0..x.1, y.0..y.1)?,
                    panel,
                    plain,
                )?;
            }
        }
        root.present()?;
    }
    Ok(svg)
}

fn plain(value: &f64) -> String {
    format!("{}", (value * 1e3).round() / 1e3 + 0.0)
}

fn power(value: &f64) -> String {
    let exponent = value.log10().floor();
    let leading = value / 10f64.powf(exponent);
    if (1e-2..1e4).contains(value) {
        plain(value)
    } else {
        format!("{leading:.0}e{exponent}")
    }
}

fn fill<X, Y>(
    mut chart: ChartContext<SVGBackend, Cartesian2d<X, Y>>,
    panel: &Panel,
    number: fn(&f64) -> String,
) -> Result<(), Box<dyn Error>>
where
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    if let Some([x, y]) = &panel.axes {
        chart
            .configure_mesh()
            .max_light_lines(0)
            .bold_line_style(RGBColor(228, 228, 228))
            .axis_style(RGBColor(120, 120, 120))
            .x_labels(6)
            .y_labels(6)
            .x_desc(x)
            .y_desc(y)
            .x_label_formatter(&number)
            .y_label_formatter(&number)
            .label_style(("sans-serif", 13))
            .draw()?;
    }
    for item in &panel.items {
        match item {
            Item::Line(points, color, width) => {
                let style = ShapeStyle::from(*color).stroke_width(*width);
                chart.draw_series(LineSeries::new(points.iter().copied(), style))?;
            }
            Item::Dashed(points, color) => {
                let style = ShapeStyle::from(*color).stroke_width(2);
                let dashes = DashedLineSeries::new(points.iter().copied(), 7, 5, style);
                chart.draw_series(dashes)?;
            }
            Item::Dots(points, color, size) => {
                let dot = |p: &Point| Circle::new(*p, *size, color.filled());
                chart.draw_series(points.iter().map(dot))?;
            }
            Item::Boxes(boxes, color) => {
                let shape = |(a, b): &(Point, Point)| Rectangle::new([*a, *b], color.filled());
                chart.draw_series(boxes.iter().map(shape))?;
            }
            Item::Label(at, text, color) => {
                let style = ("sans-serif", 15)
                    .into_font()
                    .color(color)
                    .pos(Pos::new(HPos::Center, VPos::Center));
                chart.draw_series([Text::new(text.clone(), *at, style)])?;
            }
        }
    }
    Ok(())
}

/// A point of space seen from above and aside: right, up.
pub fn isometric([x, y, z]: [f64; 3]) -> Point {
    let (turn, tilt) = (0.55f64, 0.42f64);
    let right = x * turn.cos() - y * turn.sin();
    let away = x * turn.sin() + y * turn.cos();
    (right, z * tilt.cos() + away * tilt.sin())
}

/// How far away a point is in the isometric view.
pub fn depth([x, y, z]: [f64; 3]) -> f64 {
    let (turn, tilt) = (0.55f64, 0.42f64);
    (x * turn.sin() + y * turn.cos()) * tilt.cos() - z * tilt.sin()
}

/// A cube's edges from the origin to `limit`, with the axes' names.
pub fn cube(limit: f64, names: [&str; 3]) -> Vec<Item> {
    let grey = RGBColor(150, 150, 150);
    let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|bit| bit as f64 * limit);
    let mut items = Vec::new();
    for a in 0..8usize {
        for axis in 0..3 {
            let b = a | 1 << axis;
            if b != a {
                let ends = vec![isometric(corner(a)), isometric(corner(b))];
                items.push(Item::Line(ends, grey, 1));
            }
        }
    }
    for (axis, name) in names.into_iter().enumerate() {
        let mut at = [[0.0, -0.12, 0.0], [1.12, 0.0, 0.0], [-0.1, 0.0, 0.0]][axis];
        at[axis] = 0.55;
        let at = isometric(at.map(|x: f64| x * limit));
        items.push(Item::Label(at, name.into(), RGBColor(90, 90, 90)));
    }
    items
}
