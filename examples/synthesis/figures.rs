//! Figs. 3.4–3.6, 3.1 and 3.8, 3.15–3.17.
//!
//! A **prescribed** fall goes through the regimes that are named, whatever body it is; a **sampled** one
//! through those that the motion graph draws. Titles say which.

use super::Body;
use super::draw::{self, Item, Panel, Point};
use plotters::prelude::RGBColor;
use rand::SeedableRng;
use rapier3d_immersed::flow::{SpectralWind, Still, WindParams};
use rapier3d_immersed::motion::path::{
    Deviation, Fall, Glide, MotionPath, SynthesisParams, TanabeKaneko, TrajectoryDatabase,
    WindResponse,
};
use rapier3d_immersed::motion::{PhaseDiagram, Regime};
use rapier3d_immersed::rapier3d::math::{Real, Vector};
use rapier3d_immersed::rapier3d::na::Vector2;
use std::error::Error;
use std::f64::consts::PI;
use std::path::Path;
use std::sync::Arc;

const GREY: RGBColor = RGBColor(150, 150, 150);
const INK: RGBColor = RGBColor(40, 40, 40);

pub fn color(regime: Regime) -> RGBColor {
    match regime {
        Regime::SteadyDescent => RGBColor(211, 47, 47),
        Regime::PeriodicFlutter => RGBColor(46, 140, 60),
        Regime::TransitionalChaotic => RGBColor(30, 90, 200),
        Regime::PeriodicTumbling => RGBColor(190, 40, 170),
        Regime::TransitionalHelix => RGBColor(230, 130, 20),
        Regime::PeriodicSpiral => RGBColor(0, 150, 160),
    }
}

/// Seen from the side, z a little toward the viewer.
fn side(v: Vector) -> Point {
    let [x, y, z] = v.to_array().map(f64::from);
    (x + 0.35 * z, y - 0.2 * z)
}

/// What the colours mean.
pub fn legend() -> Vec<(String, RGBColor)> {
    let names = Regime::ALL.into_iter();
    names.map(|r| (r.to_string(), color(r))).collect()
}

/// A path in the colours of its regimes, over the body's chord every `every` seconds.
pub fn trace(path: &MotionPath, chord: f64, every: Real) -> Vec<Item> {
    let mut items = Vec::new();
    let mut time = 0.0;
    while time <= path.duration() {
        let key = path.at(time);
        let half = key.attitude * Vector::Y * (0.5 * chord as Real);
        let ends = [key.position - half, key.position + half].map(side);
        items.push(Item::Line(ends.to_vec(), INK, 2));
        time += every;
    }
    for (i, (from, regime)) in path.regimes().iter().enumerate() {
        let to = path.regimes().get(i + 1).map_or(path.duration(), |r| r.0);
        let steps = 400;
        let line = (0..=steps).map(|s| {
            side(
                path.at(from + (to - from) * s as Real / steps as Real)
                    .position,
            )
        });
        items.push(Item::Line(line.collect(), color(*regime), 2));
    }
    items
}

/// Figs. 3.4–3.6: solutions of (3.4), segments and their classes, a flutter with its orientation.
pub fn database(out: &Path, database: &TrajectoryDatabase) -> Result<(), Box<dyn Error>> {
    let mut panels = Vec::new();
    for (across, along, share) in [(4.1, 0.9, 0.14), (4.6, 0.9, 0.05), (4.6, 0.15, 0.14)] {
        let model = TanabeKaneko {
            across,
            along,
            fluid_share: share,
            ..TanabeKaneko::default()
        };
        let states = model.solve(0.3, 4e-3, 5000);
        let fall = Fall::of(&states);
        let mut panel = Panel::bare(format!("A⊥ {across}, A∥ {along}, ρL/m {share}: {fall:?}"));
        let shown = &states[..2200];
        let line = shown.iter().map(|s| (s[0], s[1]));
        panel.items.push(Item::Line(line.collect(), GREY, 1));
        for state in shown.iter().step_by(40) {
            let (sin, cos) = state[2].sin_cos();
            let ends = [-0.5, 0.5].map(|h| (state[0] + h * cos, state[1] + h * sin));
            panel.items.push(Item::Line(ends.to_vec(), INK, 2));
        }
        panels.push(panel);
    }
    let mut segments = Panel::new("segments by class (3.6)", "x / L", "y / L");
    segments.window = Some([(-4.0, 4.0), (-8.0, 0.5)]);
    let query = Vector2::new(1.2, -PI);
    let mut classes = Panel::new(
        "K-means classes (right glides); x: a query, black: drawn for it",
        "across / L",
        "descent / L",
    );
    classes.logarithmic = true;
    for (index, entry) in database.entries().iter().enumerate() {
        let hue = f64::from(entry.class) * 2.399;
        let part = |shift: f64| (127.0 + 110.0 * (hue + shift).cos()) as u8;
        let color = RGBColor(part(0.0), part(2.1), part(4.2));
        let feature = entry.segment.feature();
        if feature.x > 0.0 {
            let dot = vec![(feature.x, -feature.y)];
            classes.items.push(Item::Dots(dot, color, 3));
        }
        if index % 13 == 0 && feature.x.abs() < 4.0 && feature.y > -8.0 {
            let time = entry.segment.duration();
            let line = (0..=30).map(|i| {
                let p = entry.segment.position(time * f64::from(i) / 30.0);
                (p.x, p.y)
            });
            segments.items.push(Item::Line(line.collect(), color, 1));
        }
    }
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
    for _ in 0..60 {
        let drawn = database.find(query, 0.15, &mut random).segment.feature();
        let dot = vec![(drawn.x, -drawn.y)];
        classes.items.push(Item::Dots(dot, INK, 4));
    }
    let cross = Item::Label((query.x, -query.y), "x".into(), RGBColor(211, 47, 47));
    classes.items.push(cross);
    let mut oriented = Panel::bare("a flutter with orientations from (3.4)");
    let entry = database
        .entries()
        .iter()
        .filter(|e| e.segment.glide == Glide::Right)
        .min_by(|a, b| {
            let score = |f: f64, h: f64| (f.ln().powi(2) + (h / 1.4).ln().powi(2)).abs();
            let of = |e: &&rapier3d_immersed::motion::path::Entry| {
                score(e.segment.flutter.frequency, e.segment.flutter.horizontal)
            };
            of(a).total_cmp(&of(b))
        });
    if let Some(entry) = entry {
        let curve = &database.flutter()[entry.flutter as usize];
        let mut start = (0.0, 0.0);
        for level in 0..5 {
            let sign = if level % 2 == 0 { 1.0 } else { -1.0 };
            for i in 0..=12 {
                let share = f64::from(i) / 12.0;
                let p = entry.segment.position(share * entry.segment.duration());
                let (x, y) = (start.0 + sign * p.x, start.1 + p.y);
                let (sin, cos) = (sign * curve.at(share)).sin_cos();
                let ends = [-0.5, 0.5].map(|h| (x + h * cos, y + h * sin));
                oriented.items.push(Item::Line(ends.to_vec(), INK, 2));
            }
            let line = (0..=40).map(|i| {
                let p = entry
                    .segment
                    .position(f64::from(i) / 40.0 * entry.segment.duration());
                (start.0 + sign * p.x, start.1 + p.y)
            });
            let line = Item::Line(line.collect(), RGBColor(211, 47, 47), 1);
            oriented.items.push(line);
            let feature = entry.segment.feature();
            start = (start.0 + sign * feature.x, start.1 + feature.y);
        }
    }
    panels.extend([segments, classes, oriented]);
    let title = "Trajectory database (thesis Figs. 3.4–3.6)";
    let path = out.join("synthesis_database.svg");
    draw::write(&path, title, &panels, 3, (420, 420))
}

/// Figs. 3.1 and 3.8: the six regimes from the side and from above, each prescribed, and what release angle
/// and variety change.
pub fn patterns(
    out: &Path,
    leaf: &Body,
    database: &Arc<TrajectoryDatabase>,
    seed: u64,
) -> Result<(), Box<dyn Error>> {
    let synthesizer = leaf.synthesizer(
        SynthesisParams {
            main: Some(Regime::PeriodicSpiral),
            ..SynthesisParams::default()
        },
        database,
    )?;
    let (mut sides, mut tops) = (Vec::new(), Vec::new());
    for regime in Regime::ALL {
        let path = synthesizer.path_through(&[regime], seed)?;
        let mut panel = Panel::bare(format!(
            "{} {regime}, prescribed, {} m",
            regime.abbreviation(),
            leaf.height
        ));
        panel.items = trace(&path, 1.5 * leaf.numbers.length, 0.035);
        sides.push(panel);
        let mut top = Panel::bare(format!("{} from above, no drift", regime.abbreviation()));
        top.window = Some([(-0.12, 0.12), (-0.12, 0.12)]);
        // The drift over whole turns of spiral and helix (at a third of U/a), or over the whole fall.
        let count = match regime {
            Regime::TransitionalHelix | Regime::PeriodicSpiral => {
                let turn = std::f64::consts::TAU * 3.0 * leaf.numbers.length / leaf.numbers.u0;
                (turn / f64::from(path.interval())).round() as usize
            }
            _ => path.keys().len() - 1,
        };
        let keys = &path.keys()[path.keys().len() - 1 - count..];
        let [first, last] = [keys[0].position, keys[count].position];
        let line: Vec<Point> = keys
            .iter()
            .enumerate()
            .map(|(i, key)| {
                let p = key.position - first - (last - first) * (i as Real / count as Real);
                (f64::from(p.x), f64::from(p.z))
            })
            .collect();
        // In the middle of the panel.
        let range = |of: fn(&Point) -> f64| {
            let low = line.iter().map(of).fold(f64::INFINITY, f64::min);
            let high = line.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
            0.5 * (low + high)
        };
        let (x, z) = (range(|p| p.0), range(|p| p.1));
        let line: Vec<Point> = line.iter().map(|p| (p.0 - x, p.1 - z)).collect();
        if regime == Regime::SteadyDescent {
            top.items
                .push(Item::Dots(vec![(0.0, 0.0)], color(regime), 4));
        }
        top.items.push(Item::Line(line, color(regime), 2));
        let scale = vec![(-0.05, -0.11), (0.05, -0.11)];
        top.items.push(Item::Line(scale, GREY, 2));
        top.items
            .push(Item::Label((0.0, -0.1), "10 cm".into(), GREY));
        tops.push(top);
    }
    sides.extend(tops);
    for degrees in [20.0f64, 50.0, 80.0] {
        let params = SynthesisParams {
            main: Some(Regime::TransitionalChaotic),
            release_angle: Some(degrees.to_radians()),
            ..SynthesisParams::default()
        };
        let path = leaf
            .synthesizer(params, database)?
            .path_through(&[Regime::TransitionalChaotic], seed)?;
        let mut panel = Panel::bare(format!("chaotic, prescribed, released at {degrees}°"));
        panel.items = trace(&path, 1.5 * leaf.numbers.length, 0.035);
        sides.push(panel);
    }
    for variety in [0.0, 0.05, 0.5] {
        let params = SynthesisParams {
            main: Some(Regime::PeriodicFlutter),
            variety,
            ..SynthesisParams::default()
        };
        let path = leaf
            .synthesizer(params, database)?
            .path_through(&[Regime::PeriodicFlutter], seed)?;
        let mut panel = Panel::bare(format!("flutter, prescribed, variety {variety}"));
        panel.items = trace(&path, 1.5 * leaf.numbers.length, 0.035);
        sides.push(panel);
    }
    let title = "A leaf in each regime as prescribed (thesis Figs. 3.1 and 3.8), released at angles, and with variety";
    let path = out.join("synthesis_patterns.svg");
    draw::write(&path, title, &sides, 6, (270, 330))
}

/// Figs. 3.15–3.17: the thesis's bodies through the regimes that it shows of them, prescribed; the same
/// bodies sampled at the numbers that are computed for them; and the leaf in wind, sampled so too.
pub fn bodies(
    out: &Path,
    bodies: &[Body; 3],
    database: &Arc<TrajectoryDatabase>,
    seed: u64,
) -> Result<(), Box<dyn Error>> {
    let shown: [&[Regime]; 3] = [
        &[Regime::PeriodicFlutter],
        &[Regime::PeriodicTumbling, Regime::PeriodicSpiral],
        &[
            Regime::SteadyDescent,
            Regime::PeriodicTumbling,
            Regime::TransitionalHelix,
        ],
    ];
    let (mut prescribed, mut sampled) = (Vec::new(), Vec::new());
    for ((body, case), regimes) in bodies.iter().zip(PhaseDiagram::THESIS_CASES).zip(shown) {
        // Deviations are proportional to L/a; the slender paper would land four meters away.
        let deviations = Regime::ALL.map(|regime| Deviation {
            coefficient: body.numbers.length / body.length,
            ..Deviation::of(regime)
        });
        let own = SynthesisParams {
            deviations,
            ..SynthesisParams::default()
        };
        let thesis = SynthesisParams {
            deviations,
            ..SynthesisParams::of_case(&case)
        };
        let own = body.synthesizer(own, database)?;
        let thesis = body.synthesizer(thesis, database)?;
        // A chord of less than a fiftieth of the height would hardly be seen.
        let enlarged = (0.02 * body.height / body.numbers.length).max(1.0).round();
        let names: Vec<&str> = regimes.iter().map(|r| r.abbreviation()).collect();
        let (re, i_star) = (body.numbers.reynolds(), body.numbers.i_star);
        let height = match enlarged > 1.0 {
            true => format!("y, m (chords × {enlarged})"),
            false => "y, m".to_string(),
        };
        let title = format!("{}: prescribed {}", body.name, names.join(", "));
        let mut panel = Panel::new(title, "x, m", &height).equal();
        let path = thesis.path_through(regimes, seed)?;
        let chord = enlarged * body.numbers.length;
        panel.items = trace(&path, chord, path.duration() / 40.0);
        prescribed.push(panel);
        let title = format!("{}: eight sampled, Re {re:.0}, I* {i_star:.2e}", body.name);
        let mut panel = Panel::new(title, "x, m", "y, m").equal();
        for fall in 0..8 {
            let trace = trace(&own.path(seed + fall), body.numbers.length, Real::INFINITY);
            panel.items.extend(trace);
        }
        sampled.push(panel);
    }
    let mut panels = prescribed;
    panels.extend(sampled);
    let leaf = &bodies[2];
    for speed in [0.0, 3.0, 5.0] {
        let params = SynthesisParams {
            wind: speed,
            ..SynthesisParams::default()
        };
        let synthesizer = leaf.synthesizer(params, database)?;
        let title = format!("eight leaves sampled, wind of {speed} m/s from the right (Fig. 3.17)");
        let mut panel = Panel::new(title, "x, m", "y, m");
        panel.window = Some([
            [(-3.5, 3.5), (-6.5, 0.5), (-11.5, 0.5)][(speed / 2.0) as usize],
            (-2.3, 0.1),
        ]);
        for fall in 0..8 {
            let mut path = synthesizer.path(seed + fall);
            if speed > 0.0 {
                let wind = SpectralWind::bake(&WindParams {
                    direction: -Vector::X,
                    mean_speed: speed,
                    reference_height: 2.0,
                    roughness: 0.3,
                    seed,
                    ..WindParams::default()
                })?;
                let response = WindResponse {
                    mean_speed: speed as Real,
                    ..WindResponse::default()
                };
                path = path.in_wind(&wind, Vector::Y * 2.0, fall as Real, 0.0, &response)?;
            } else {
                path = path.in_wind(
                    &Still,
                    Vector::ZERO,
                    fall as Real,
                    0.0,
                    &WindResponse::default(),
                )?;
            }
            let trace = trace(&path, leaf.numbers.length, Real::INFINITY);
            panel.items.extend(trace);
        }
        panels.push(panel);
    }
    let title = "The thesis's bodies (Figs. 3.15–3.17), prescribed and sampled";
    let path = out.join("synthesis_bodies.svg");
    draw::write_with_legend(&path, title, &legend(), &panels, 3, (430, 470))
}
