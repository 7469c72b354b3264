//! The pictures.

use plotters::coord::Shift;
use plotters::prelude::*;
use rapier3d_immersed::flow::{Flow, SpectralWind, WindParams};
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::turbulence::{BakeReport, TurbulenceTable};
use std::path::Path;

type Drawn = Result<(), Box<dyn std::error::Error>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

const RED: RGBColor = RGBColor(200, 30, 30);
const PINK: RGBColor = RGBColor(235, 120, 170);
const BLUE: RGBColor = RGBColor(50, 90, 200);
const INK: RGBColor = RGBColor(25, 25, 25);
const GREEN: RGBColor = RGBColor(20, 140, 90);

/// The thesis's colors: speed relative to the mean wind at that height.
const CLASSES: [(&str, RGBColor); 4] = [
    ("V > 2U", RED),
    ("U < V ≤ 2U", PINK),
    ("U/2 < V ≤ U", BLUE),
    ("V ≤ U/2", INK),
];

fn class(ratio: f32) -> usize {
    [2.0, 1.0, 0.5]
        .iter()
        .position(|limit| ratio > *limit)
        .unwrap_or(3)
}

fn arrow(area: &Area, from: (f64, f64), to: (f64, f64), style: ShapeStyle) -> Drawn {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.hypot(dy);
    let point = |x: f64, y: f64| (x.round() as i32, y.round() as i32);
    area.draw(&PathElement::new(
        vec![point(from.0, from.1), point(to.0, to.1)],
        style,
    ))?;
    if length > 3.0 {
        let (ux, uy) = (dx / length, dy / length);
        let head = (0.35 * length).min(5.0);
        let side = |s: f64| {
            point(
                to.0 - head * ux + s * 0.5 * head * uy,
                to.1 - head * uy - s * 0.5 * head * ux,
            )
        };
        area.draw(&Polygon::new(
            vec![point(to.0, to.1), side(1.0), side(-1.0)],
            style.filled(),
        ))?;
    }
    Ok(())
}

/// Horizontal slices of the wind at two heights, as thesis Fig. 3.12.
pub fn field(path: &Path, wind: &SpectralWind, params: &WindParams) -> Drawn {
    let root = SVGBackend::new(path, (1280, 740)).into_drawing_area();
    root.fill(&WHITE)?;
    let title = format!(
        "Wind field, U = {} m/s at {} m, z0 = {} m; arrows: velocity, color: speed over the mean at that height",
        params.mean_speed, params.reference_height, params.roughness
    );
    root.draw_text(
        &title,
        &("sans-serif", 19).into_text_style(&root).color(&INK),
        (24, 14),
    )?;
    for (i, (name, color)) in CLASSES.iter().enumerate() {
        let x = 330 + 170 * i as i32;
        root.draw(&Rectangle::new([(x, 48), (x + 16, 62)], color.filled()))?;
        root.draw_text(
            name,
            &("sans-serif", 17).into_text_style(&root),
            (x + 24, 46),
        )?;
    }
    let (_, body) = root.split_vertically(72);
    let size = params.size[0];
    for (area, height) in body.split_evenly((1, 2)).iter().zip([2.0f32, 10.0]) {
        let mean = wind.mean().speed(height);
        let mut chart = ChartBuilder::on(area)
            .caption(
                format!("HEIGHT = {height} m, mean {mean:.2} m/s"),
                ("sans-serif", 20),
            )
            .margin(14)
            .margin_right(30)
            .x_label_area_size(38)
            .y_label_area_size(48)
            .build_cartesian_2d(0.0..size, 0.0..size)?;
        chart
            .configure_mesh()
            .disable_mesh()
            .x_desc("along the wind, m")
            .y_desc("across, m")
            .label_style(("sans-serif", 15))
            .draw()?;
        let n = 36;
        let step = size / f64::from(n);
        let plot = chart.plotting_area();
        let scale = 0.9 * step / f64::from(mean);
        for j in 0..n {
            for i in 0..n {
                let (x, y) = ((f64::from(i) + 0.25) * step, (f64::from(j) + 0.5) * step);
                // Across the wind is up × along: −z for wind along x and y up.
                let point = Vector::new(x as f32, height, -y as f32);
                let v = wind.velocity(point, 0.0);
                let color = CLASSES[class(v.length() / mean)].1;
                let end = (x + scale * f64::from(v.x), y - scale * f64::from(v.z));
                let pixel = |p: (f64, f64)| {
                    let (x, y) = plot.map_coordinate(&p);
                    (f64::from(x), f64::from(y))
                };
                arrow(&root, pixel((x, y)), pixel(end), color.stroke_width(1))?;
            }
        }
    }
    root.present()?;
    Ok(())
}

/// Reduced spectra n S/u*² against f = nz/U.
pub fn spectra(path: &Path, params: &WindParams, spectra: &[Vec<(f64, f64)>; 3]) -> Drawn {
    let root = SVGBackend::new(path, (960, 660)).into_drawing_area();
    root.fill(&WHITE)?;
    let (z, u) = (params.reference_height, params.mean_speed);
    let friction = 0.4 * u / (z / params.roughness).ln();
    let reduced = |n: f64, s: f64| (n * z / u, n * s / (friction * friction));
    let (mut low, mut high) = (f64::INFINITY, 0.0f64);
    for (n, s) in spectra.iter().flatten() {
        let y = reduced(*n, *s).1;
        (low, high) = (low.min(y), high.max(y));
    }
    let first = reduced(spectra[0][0].0, 0.0).0;
    let last = reduced(spectra[0][spectra[0].len() - 1].0, 0.0).0;
    let mut chart = ChartBuilder::on(&root)
        .caption(
            "Gust spectra: synthesized (dots), Kaimal et al. 1972 (lines), -5/3 law (dashed)",
            ("sans-serif", 22),
        )
        .margin(16)
        .x_label_area_size(46)
        .y_label_area_size(70)
        .build_cartesian_2d(
            (0.8 * first..1.3 * last).log_scale(),
            (0.5 * low..2.5 * high).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc("reduced frequency f = n z / U")
        .y_desc("n S(n) / u*²")
        .label_style(("sans-serif", 15))
        .light_line_style(WHITE)
        .draw()?;
    let names = ["u, along the wind", "v, across", "w, vertical"];
    for (c, color) in [RED, BLUE, GREEN].into_iter().enumerate() {
        // Means over twelfths of a decade, so that the dots do not pile up.
        let mut bins = std::collections::BTreeMap::<i64, (f64, f64, f64)>::new();
        for (n, s) in &spectra[c] {
            let (f, y) = reduced(*n, *s);
            let bin = bins.entry((f.log10() * 12.0).floor() as i64).or_default();
            *bin = (bin.0 + f.ln(), bin.1 + y, bin.2 + 1.0);
        }
        let dots = bins
            .values()
            .map(|(f, y, n)| ((f / n).exp(), y / n))
            .map(|point| Circle::new(point, 4, color.filled()));
        chart
            .draw_series(dots)?
            .label(names[c])
            .legend(move |(x, y)| Circle::new((x + 10, y), 4, color.filled()));
        let asked = spectra[c]
            .iter()
            .map(|(n, _)| reduced(*n, super::kaimal(params, c, *n)));
        chart.draw_series(LineSeries::new(asked, color.stroke_width(2)))?;
    }
    let anchor = reduced(spectra[0][0].0, spectra[0][0].1);
    let level = 1.6 * high.max(anchor.1);
    let mid = (first * last).sqrt();
    let slope = [mid, 0.8 * last].map(|f| (f, level * (f / mid).powf(-2.0 / 3.0)));
    chart.draw_series(DashedLineSeries::new(slope, 8, 5, INK.stroke_width(2)))?;
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerMiddle)
        .label_font(("sans-serif", 16))
        .border_style(INK)
        .background_style(WHITE)
        .draw()?;
    root.present()?;
    Ok(())
}

/// ε/k, ε and the rate of strain along the followed particle, as thesis Fig. 4.2.
pub fn history(
    path: &Path,
    plate: &BakeReport,
    thesis: &BakeReport,
    nothing: &BakeReport,
) -> Drawn {
    let root = SVGBackend::new(path, (1000, 860)).into_drawing_area();
    root.fill(&WHITE)?;
    let end = plate.samples.last().map_or(1.0, |sample| sample.time);
    let rows = root.split_evenly((3, 1));
    let rows = rows.iter();
    type Value = fn(&rapier3d_immersed::turbulence::BakeSample) -> f64;
    let panels: [(&str, &str, Value); 3] = [
        (
            "Turbulence along a passive particle, Re = 3800, 32 × 32 × 16 cells: turnover rate",
            "ε/k, U₀/L",
            |s| s.dissipation / s.kinetic_energy,
        ),
        ("Dissipation rate", "ε, U₀³/L", |s| s.dissipation),
        (
            "Rate of strain of the mean flow, which feeds it",
            "√(2S:S), U₀/L",
            |s| s.strain,
        ),
    ];
    for (row, (area, (title, unit, value))) in rows.zip(panels).enumerate() {
        let all = [plate, thesis, nothing];
        let all = all.into_iter().flat_map(|r| &r.samples).map(value);
        let high = all.clone().fold(0.0, f64::max);
        let low = all.filter(|v| *v > 0.0).fold(f64::INFINITY, f64::min);
        let mut builder = ChartBuilder::on(area);
        builder
            .caption(title, ("sans-serif", 20))
            .margin(10)
            .margin_right(30)
            .x_label_area_size(if row == 2 { 40 } else { 24 })
            .y_label_area_size(76);
        // Two of the three fall over decades.
        macro_rules! panel {
            ($range:expr) => {{
                let mut chart = builder.build_cartesian_2d(0.0..end, $range)?;
                chart
                    .configure_mesh()
                    .x_desc(if row == 2 {
                        "time since the release, L/U₀"
                    } else {
                        ""
                    })
                    .y_desc(unit)
                    .y_labels(5)
                    .y_label_formatter(&|y| format!("{}", (y * 1.0e4).round() / 1.0e4))
                    .label_style(("sans-serif", 15))
                    .light_line_style(WHITE)
                    .draw()?;
                for (report, color, label) in [
                    (nothing, BLUE, "no shear: homogeneous decay"),
                    (thesis, GREEN, "a plate's wake, thesis's reduced form"),
                    (plate, RED, "a plate's wake, full form"),
                ] {
                    let line = report.samples.iter().map(|s| (s.time, value(s)));
                    chart
                        .draw_series(LineSeries::new(line, color.stroke_width(2)))?
                        .label(label)
                        .legend(move |(x, y)| {
                            PathElement::new([(x, y), (x + 22, y)], color.stroke_width(3))
                        });
                }
                if let Some(time) = plate.left_box_at {
                    let marks = [(time, 1.0e-9), (time, 1.1 * high)];
                    chart
                        .draw_series(DashedLineSeries::new(marks, 5, 5, INK.stroke_width(1)))?
                        .label("the particle leaves the box (full form)")
                        .legend(|(x, y)| PathElement::new([(x, y), (x + 22, y)], INK));
                }
                if row == 0 {
                    chart
                        .configure_series_labels()
                        .label_font(("sans-serif", 15))
                        .position(SeriesLabelPosition::UpperRight)
                        .background_style(WHITE)
                        .border_style(INK)
                        .draw()?;
                }
            }};
        }
        if row < 2 {
            panel!((0.7 * low..1.4 * high).log_scale());
        } else {
            panel!(0.0..1.1 * high);
        }
    }
    root.present()?;
    Ok(())
}

/// Turbulent kinetic energy in the middle plane at the end of the bake, and the particle's path.
pub fn stream(path: &Path, table: &TurbulenceTable, plate: &BakeReport) -> Drawn {
    let field = table
        .field()
        .ok_or("the table was baked without its field")?;
    let root = SVGBackend::new(path, (900, 860)).into_drawing_area();
    root.fill(&WHITE)?;
    let [nx, ny, nz] = field.dims();
    let h = 4.0 / nx as f64;
    let (width, breadth) = (nx as f64 * h, ny as f64 * h);
    let mut chart = ChartBuilder::on(&root)
        .caption(
            "Turbulent kinetic energy behind the plate (log color, U₀²) and the particle that is followed",
            ("sans-serif", 20),
        )
        .margin(14)
            .margin_right(30)
        .x_label_area_size(44)
        .y_label_area_size(52)
        .build_cartesian_2d(0.0..width, 0.0..breadth)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .x_desc("along the stream, L")
        .y_desc("across, L")
        .label_style(("sans-serif", 15))
        .draw()?;
    let states = field.frame(field.frames() - 1);
    let most = states
        .iter()
        .map(|state| f64::from(state.kinetic_energy))
        .fold(0.0, f64::max);
    let least = states
        .iter()
        .map(|state| f64::from(state.kinetic_energy))
        .fold(most, f64::min);
    let shade = |t: f64| ViridisRGB.get_color(t.clamp(0.0, 1.0));
    let color = |k: f64| shade((k / least).ln() / (most / least).ln().max(1.0e-9));
    let cells = (0..ny).flat_map(|j| (0..nx).map(move |i| (i, j)));
    chart.draw_series(cells.map(|(i, j)| {
        let k = f64::from(states[((nz / 2) * ny + j) * nx + i].kinetic_energy);
        let (x, y) = (i as f64 * h, j as f64 * h);
        Rectangle::new([(x, y), (x + h, y + h)], color(k).filled())
    }))?;
    let (x, y) = (width / 3.0, breadth / 2.0);
    chart.draw_series([Rectangle::new(
        [(x - 0.5 * h, y - 0.5), (x + 0.5 * h, y + 0.5)],
        INK.filled(),
    )])?;
    let trail = plate
        .samples
        .iter()
        .filter(|s| s.position[0] <= width)
        .map(|s| (s.position[0], s.position[1]));
    chart.draw_series(LineSeries::new(trail.clone(), WHITE.stroke_width(3)))?;
    chart.draw_series(trail.step_by(5).map(|p| Circle::new(p, 4, WHITE.filled())))?;
    let plot = chart.plotting_area();
    let (x, y) = plot.map_coordinate(&(width, breadth));
    root.draw(&Rectangle::new(
        [(x - 130, y + 8), (x - 8, y + 144)],
        INK.filled(),
    ))?;
    for i in 0..5 {
        let t = 1.0 - 0.25 * f64::from(i);
        let k = least * (most / least).powf(t);
        let top = y + 14 + 25 * i;
        root.draw(&Rectangle::new(
            [(x - 122, top), (x - 98, top + 22)],
            shade(t).filled(),
        ))?;
        let style = ("sans-serif", 16).into_text_style(&root).color(&WHITE);
        root.draw_text(&format!("k = {k:.2}"), &style, (x - 90, top + 2))?;
    }
    root.present()?;
    Ok(())
}
