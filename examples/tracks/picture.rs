//! Pictures of measured falls and this crate's.

use super::draw::{self, Item, Panel};
use super::fits::FallFit;
use super::forecast::{Forecast, KNOWN, PHYSICAL, defaults, moved, straight_on};
use super::measured::{Fall, RATE};
use plotters::style::RGBColor;
use rapier3d_immersed::rapier3d::na::Vector3;
use std::error::Error;

const BLACK: RGBColor = RGBColor(40, 40, 40);
const GREY: RGBColor = RGBColor(165, 165, 165);
const RED: RGBColor = RGBColor(211, 47, 47);
const BLUE: RGBColor = RGBColor(30, 90, 200);

type Failure = Box<dyn Error + Send + Sync>;

fn text(problem: Box<dyn Error>) -> Failure {
    problem.to_string().into()
}

fn title(fall: &Fall) -> String {
    fall.name.replace('_', " ")
}

/// Side views, across the measured drift: tracks, and forecasts until they are a diameter off, with the paper
/// edge on.
pub fn paths(falls: &[Fall], forecasts: &[Forecast]) -> Result<String, Failure> {
    let mut panels = Vec::new();
    for (fall, forecast) in falls.iter().zip(forecasts) {
        let moved = fall.positions[fall.positions.len() - 1] - fall.positions[0];
        let across = Vector3::new(moved.x, moved.y, 0.0).normalize();
        let seen_along = across.cross(&Vector3::z());
        let at = |p: &Vector3<f64>| (across.dot(p), p.z);
        let line = |path: &[Vector3<f64>]| path.iter().map(at).collect::<Vec<_>>();
        let end = forecast
            .divergence
            .map_or(fall.positions.len(), |t| (t * RATE).round() as usize + 1);
        let mut panel = Panel::new(title(fall), "along the drift, m", "height, m").equal();
        panel.items.push(Item::Line(line(&fall.positions), GREY, 1));
        panel
            .items
            .push(Item::Dots(line(&fall.positions), BLACK, 1));
        let ours = &forecast.seen.positions;
        for (frame, p) in ours[..end].iter().enumerate().step_by(3) {
            // The line in which the paper's plane meets the view's.
            let trace = forecast.seen.normals[frame].cross(&seen_along);
            let Some(trace) = trace.try_normalize(1e-3) else {
                continue;
            };
            let half = trace * fall.radius;
            let edge = vec![at(&(p - half)), at(&(p + half))];
            let color = if frame < KNOWN { RED } else { BLUE };
            panel.items.push(Item::Line(edge, color, 1));
        }
        panel.items.push(Item::Line(line(&ours[..KNOWN]), RED, 2));
        panel
            .items
            .push(Item::Line(line(&ours[KNOWN - 1..end]), BLUE, 2));
        panels.push(panel);
    }
    let legend = [
        ("measured".to_string(), BLACK),
        ("ours, fitted state".to_string(), RED),
        ("ours, forecast until a diameter off".to_string(), BLUE),
    ];
    let title = "Falling paper: tracks of Howison et al. (2020), and the default law";
    svg(title, &legend, &panels, 4, (330, 430))
}

/// Errors over time, and what was identified.
pub fn errors(falls: &[Fall], forecasts: &[Forecast], fits: &[FallFit]) -> Result<String, Failure> {
    let mut panels = Vec::new();
    for small in [true, false] {
        let which = if small { "16 to 24 mm" } else { "42 and 44 mm" };
        let title = format!("papers of {which}: medians (thick), each");
        let mut panel = Panel::new(title, "time from the first frame, s", "distance, diameters");
        panel.window = Some([(0.0, 0.8), (0.0, 3.0)]);
        let chosen = |fall: &Fall| (fall.radius < 0.03) == small;
        let mut sets: [Vec<Vec<f64>>; 3] = Default::default();
        for (i, (fall, forecast)) in falls.iter().zip(forecasts).enumerate() {
            if !chosen(fall) {
                continue;
            }
            let off = |path: &[Vector3<f64>]| -> Vec<f64> {
                let pairs = path.iter().zip(&fall.positions);
                pairs
                    .map(|(a, b)| (a - b).norm() / fall.diameter())
                    .collect()
            };
            sets[0].push(off(&moved(fall, &falls[i ^ 1])));
            sets[1].push(off(&straight_on(fall)));
            sets[2].push(off(&forecast.seen.positions));
        }
        for (set, color) in sets.iter().zip([BLACK, GREY, BLUE]) {
            let point = |(i, e): (usize, &f64)| (i as f64 / RATE, *e);
            for errors in set {
                let line = errors.iter().enumerate().map(point);
                panel.items.push(Item::Line(
                    line.take_while(|p| p.0 <= 0.8 && p.1 < 3.0).collect(),
                    color,
                    1,
                ));
            }
            let frames = set.iter().map(Vec::len).min().unwrap_or(0);
            let median = (0..frames).map(|i| {
                let mut errors: Vec<f64> = set.iter().map(|e| e[i]).collect();
                errors.sort_by(f64::total_cmp);
                (i as f64 / RATE, errors[errors.len() / 2])
            });
            let median: Vec<_> = median.take_while(|p| p.1 < 3.0 && p.0 <= 0.8).collect();
            panel.items.push(Item::Line(median, color, 4));
        }
        let known = (KNOWN - 1) as f64 / RATE;
        panel
            .items
            .push(Item::Dashed(vec![(known, 0.0), (known, 3.0)], RED));
        panel
            .items
            .push(Item::Dashed(vec![(0.0, 1.0), (0.8, 1.0)], RED));
        panels.push(panel);
    }
    for (k, name) in PHYSICAL.coefficients.iter().enumerate() {
        let title = format!("{name} fitted, ± a deviation (grey: at the end of its range)");
        let mut panel = Panel::new(title, "fall, in the order of the table", name);
        let (low, high) = PHYSICAL.ranges[k];
        panel.window = Some([
            (0.0, falls.len() as f64 + 1.0),
            (low - 0.05 * high, 1.05 * high),
        ]);
        let own = fits
            .iter()
            .filter(|f| f.law == PHYSICAL.name && f.fall == f.coefficients_of);
        for (i, fit) in own.enumerate() {
            let (x, value) = ((i + 1) as f64, fit.parameters[k]);
            let deviation = fit.deviations[k];
            let ends = [value - deviation, value + deviation].map(|y| (x, y.clamp(low, high)));
            let color = if fit.at_bound.contains(&k) {
                GREY
            } else {
                BLUE
            };
            panel.items.push(Item::Line(ends.to_vec(), color, 2));
            panel.items.push(Item::Dots(vec![(x, value)], color, 4));
        }
        let calibrated = defaults()[k];
        let line = vec![(0.0, calibrated), (falls.len() as f64 + 1.0, calibrated)];
        panel.items.push(Item::Dashed(line, BLACK));
        panels.push(panel);
    }
    let legend = [
        ("the repeat".to_string(), BLACK),
        ("straight on".to_string(), GREY),
        ("ours".to_string(), BLUE),
        ("frames known; one diameter".to_string(), RED),
    ];
    svg(
        "Forecasts and coefficients (dashed: the default law's)",
        &legend,
        &panels,
        3,
        (470, 380),
    )
}

fn svg(
    title: &str,
    legend: &[(String, RGBColor)],
    panels: &[Panel],
    columns: usize,
    size: (u32, u32),
) -> Result<String, Failure> {
    draw::svg_with_legend(title, legend, panels, columns, size).map_err(text)
}
