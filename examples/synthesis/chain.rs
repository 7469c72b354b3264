//! Figs. 3.9 (b), 3.10 and 3.13, and the graph of frames (§ 3.4.3) beside that of regimes, with their numbers.

use super::Body;
use super::draw::{self, Item, Panel, Point};
use super::estimate::{self, Fall};
use super::figures::{color, legend, trace};
use plotters::prelude::RGBColor;
use rapier3d_immersed::flow::{Flow, SpectralWind, WindParams};
use rapier3d_immersed::motion::path::{
    Deviation, FrameGraph, FrameGraphParams, MotionPath, SynthesisParams, TrajectoryDatabase,
    WindResponse,
};
use rapier3d_immersed::motion::{EstimateSource, FallEstimates, MotionGraph, Regime};
use rapier3d_immersed::rapier3d::math::{Real, Vector};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::sync::Arc;

const GREY: RGBColor = RGBColor(150, 150, 150);
const INK: RGBColor = RGBColor(40, 40, 40);

/// A motion class, and how many falls show it.
type Class = (Vec<Regime>, usize);

/// The classes, those of most falls first.
fn counted(sequences: impl Iterator<Item = Vec<Regime>>) -> Vec<Class> {
    let mut counts = HashMap::new();
    for mut sequence in sequences {
        sequence.dedup();
        *counts.entry(sequence).or_insert(0) += 1;
    }
    let mut classes: Vec<Class> = counts.into_iter().collect();
    classes.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    classes
}

fn class_panel(title: String, classes: &[Class], whole: usize) -> Panel {
    let mut panel = Panel::bare(title);
    panel.equal = false;
    let rows = 12.0;
    panel.window = Some([(-2.2, 6.2), (-rows, 0.5)]);
    for (row, (sequence, count)) in classes.iter().take(rows as usize).enumerate() {
        let y = -(row as f64) - 0.5;
        let share = format!("{:.1} %", 100.0 * *count as f64 / whole as f64);
        panel.items.push(Item::Label((-1.1, y), share, INK));
        for (column, regime) in sequence.iter().enumerate() {
            let x = column as f64;
            let corners = ((x, y - 0.38), (x + 0.92, y + 0.38));
            panel.items.push(Item::Boxes(vec![corners], color(*regime)));
            let name = regime.abbreviation().to_string();
            let white = RGBColor(255, 255, 255);
            panel.items.push(Item::Label((x + 0.46, y), name, white));
        }
    }
    panel
}

/// Fig. 3.9 (b): the motion classes of own and of tracked falls.
pub fn classes(out: &Path, falls: &[Fall], tracked: &str) -> Result<Value, Box<dyn Error>> {
    let own = counted(falls.iter().map(|fall| fall.labels.clone()));
    let tracks = counted(estimate::tracked_sequences(tracked)?.into_iter());
    let papers: usize = tracks.iter().map(|(_, count)| count).sum();
    let increasing = |sequence: &[Regime]| sequence.windows(2).all(|pair| pair[0] < pair[1]);
    let kept: usize = own
        .iter()
        .filter(|(s, _)| increasing(s))
        .map(|(_, n)| n)
        .sum();
    let seven: usize = own.iter().take(7).map(|(_, n)| n).sum();
    let panels = [
        class_panel(
            format!(
                "{} own falls of discs: 12 of {} classes",
                falls.len(),
                own.len()
            ),
            &own,
            falls.len(),
        ),
        class_panel(
            format!("{papers} tracked falls of paper, without their beginnings"),
            &tracks,
            papers,
        ),
    ];
    let path = out.join("synthesis_classes.svg");
    let title = "Motion classes observed (thesis Fig. 3.9 b)";
    draw::write_with_legend(&path, title, &legend(), &panels, 2, (620, 460))?;
    let list = |classes: &[Class]| -> Vec<Value> {
        let row = |(sequence, count): &Class| {
            let names: Vec<&str> = sequence.iter().map(|r| r.abbreviation()).collect();
            json!({ "class": names.join(" "), "falls": count })
        };
        classes.iter().take(12).map(row).collect()
    };
    Ok(json!({
        "own_falls": falls.len(),
        "own_classes": own.len(),
        "own_share_of_the_seven_commonest": seven as f64 / falls.len() as f64,
        "own_share_that_strictly_increases": kept as f64 / falls.len() as f64,
        "own": list(&own),
        "tracked_falls": papers,
        "tracked": list(&tracks),
    }))
}

/// The states of one chain on a circle, what follows what with which probability.
fn chain_panel(main: Regime) -> Panel {
    let graph = MotionGraph::free_fall(main);
    let note = match main {
        Regime::TransitionalHelix => " (convention: the spiral's)",
        _ => "",
    };
    let mut panel = Panel::bare(format!("main regime {}{note}", main.abbreviation()));
    panel.window = Some([(-1.9, 1.9), (-1.5, 1.5)]);
    let place = |state: usize| {
        let angle = PI / 2.0 - TAU * state as f64 / 6.0;
        (angle.cos(), angle.sin())
    };
    let shown = |state: usize| state <= main as usize && graph.is_reachable(state);
    for from in (0..6).filter(|from| shown(*from)) {
        for to in (from + 1..6).filter(|to| shown(*to)) {
            let p = graph.probability(from, to);
            if p < 0.001 {
                continue;
            }
            let ((ax, ay), (bx, by)) = (place(from), place(to));
            let (dx, dy) = (bx - ax, by - ay);
            let length = dx.hypot(dy);
            let (dx, dy) = (dx / length, dy / length);
            let start = (ax + 0.2 * dx, ay + 0.2 * dy);
            let end = (bx - 0.2 * dx, by - 0.2 * dy);
            let width = (1.0 + 6.0 * p).round() as u32;
            let tint = color(Regime::ALL[from]);
            panel.items.push(Item::Line(vec![start, end], tint, width));
            for sign in [-1.0, 1.0] {
                let barb = (
                    end.0 - 0.1 * dx - sign * 0.05 * dy,
                    end.1 - 0.1 * dy + sign * 0.05 * dx,
                );
                panel
                    .items
                    .push(Item::Line(vec![end, barb], tint, width.max(2)));
            }
            // Off the middle, where lines cross, and not beside the label of the state before.
            let share = if from == 1 { 0.15 } else { 0.3 };
            let at = (
                start.0 + share * (end.0 - start.0),
                start.1 + share * (end.1 - start.1),
            );
            let aside = (at.0 - 0.17 * dy, at.1 + 0.17 * dx);
            panel.items.push(Item::Label(aside, percent(p), INK));
        }
    }
    for (state, regime) in Regime::ALL.into_iter().enumerate() {
        let (x, y) = place(state);
        let tint = match shown(state) {
            true => color(regime),
            false => RGBColor(225, 225, 225),
        };
        panel.items.push(Item::Dots(vec![(x, y)], tint, 19));
        let white = RGBColor(255, 255, 255);
        let name = regime.abbreviation().to_string();
        panel.items.push(Item::Label((x, y), name, white));
        if shown(state) {
            let stay = format!("stays {}", percent(graph.probability(state, state)));
            // Beside a node, or above and below it.
            let at = match x.abs() > 0.1 {
                true => (x + 0.62 * x.signum(), y),
                false => (x, 1.3 * y),
            };
            panel.items.push(Item::Label(at, stay, color(regime)));
        }
    }
    panel
}

fn percent(p: f64) -> String {
    match p {
        p if p >= 0.9995 => "100 %".into(),
        p if p >= 0.0995 => format!("{:.0} %", 100.0 * p),
        p => format!("{:.1} %", 100.0 * p),
    }
}

/// Fig. 3.10: the chain's states and probabilities for each main regime, and all estimates behind them.
pub fn chain(out: &Path) -> Result<Value, Box<dyn Error>> {
    let panels: Vec<Panel> = Regime::ALL.into_iter().map(chain_panel).collect();
    let path = out.join("synthesis_chain.svg");
    let title = "Markov chain, by half periods, of own falls (thesis Fig. 3.10)";
    draw::write_with_legend(&path, title, &legend(), &panels, 3, (430, 400))?;
    let estimates = FallEstimates::shipped();
    let one = |quantity: &str, source, main| {
        let row = estimates.find(quantity, source, [main, None, None]);
        row.map(|row| json!({ "value": row.value, "error": row.error, "count": row.count }))
    };
    let by_regime = Regime::ALL.map(|main| {
        let graph = MotionGraph::free_fall(main);
        let rows: Vec<Vec<f64>> = (0..6)
            .map(|from| (0..6).map(|to| graph.probability(from, to)).collect())
            .collect();
        let start: Vec<f64> = (0..6).map(|state| graph.start(state)).collect();
        let used = Deviation::of(main);
        let [own, tracks] = [EstimateSource::Own, EstimateSource::Tracks].map(|source| {
            let of = |quantity| one(quantity, source, Some(main));
            json!({ "B": of("deviation_mean"), "C": of("deviation_width") })
        });
        let own_falls = |quantity| one(quantity, EstimateSource::Own, Some(main));
        let value = json!({
            "falls": own_falls("falls"),
            "start": start,
            "P": rows,
            "B": used.mean,
            "C": used.width,
            "own": own,
            "tracks": tracks,
            "frequency": own_falls("frequency"),
            "swing": own_falls("swing"),
        });
        (main.abbreviation().to_string(), value)
    });
    let alone = |quantity| one(quantity, EstimateSource::Own, None);
    Ok(json!({
        "by_main_regime": serde_json::Map::from_iter(by_regime),
        "backward_share": alone("backward_share"),
        "spiral_below": alone("spiral_below"),
        "spiral_wrong_side": alone("spiral_wrong_side"),
    }))
}

/// Fig. 3.13: how a trajectory is bent by the wind. At every step the fall's own motion leads from p₀ to p′, and
/// the wind from there to p₁.
pub fn bent(
    out: &Path,
    leaf: &Body,
    database: &Arc<TrajectoryDatabase>,
    seed: u64,
) -> Result<Value, Box<dyn Error>> {
    let params = SynthesisParams {
        main: Some(Regime::PeriodicFlutter),
        interval: 0.04,
        ..SynthesisParams::default()
    };
    let fall = leaf
        .synthesizer(params, database)?
        .path_through(&[Regime::PeriodicFlutter], seed)?;
    let wind = SpectralWind::bake(&WindParams {
        direction: Vector::X,
        mean_speed: 1.5,
        reference_height: 2.0,
        roughness: 0.3,
        seed,
        ..WindParams::default()
    })?;
    let release = Vector::Y * 2.0;
    let response = WindResponse {
        mean_speed: 1.5,
        ..WindResponse::default()
    };
    let blown = fall.in_wind(&wind, release, 0.0, 0.0, &response)?;
    let flat = |p: Vector| -> Point { (f64::from(p.x), f64::from(p.y)) };
    let red = RGBColor(211, 47, 47);
    let blue = RGBColor(30, 90, 200);
    let curve = |path: &MotionPath| -> Vec<Point> {
        let time = |i: i32| path.duration() * i as Real / 600.0;
        (0..=600).map(|i| flat(path.at(time(i)).position)).collect()
    };
    let mut whole = Panel::new(
        "f(t) in still air (black), f'(t) in wind (red)",
        "x, m",
        "y, m",
    )
    .equal();
    whole.items.push(Item::Line(curve(&fall), INK, 2));
    whole.items.push(Item::Line(curve(&blown), red, 2));
    for i in (0..fall.keys().len()).step_by(8) {
        let ends = [&fall, &blown].map(|path| flat(path.keys()[i].position));
        whole.items.push(Item::Dashed(ends.to_vec(), GREY));
    }
    // The construction, step by step.
    let h = fall.interval();
    let mut steps = Panel::new(
        "step by step: black p₀ to p' (the fall), blue p' to p₁ (the wind), red the Bézier curves",
        "x, m",
        "y, m",
    )
    .equal();
    let mut point = Vector::ZERO;
    let mut speeds = Vec::new();
    let count = 6;
    for i in 0..count {
        let fallen = point + fall.keys()[i + 1].position - fall.keys()[i].position;
        let u = wind.velocity(release + point, i as f64 * f64::from(h));
        let next = fallen + u * h;
        steps
            .items
            .push(Item::Line([point, fallen].map(flat).to_vec(), INK, 2));
        steps
            .items
            .push(Item::Line([fallen, next].map(flat).to_vec(), blue, 2));
        steps.items.push(Item::Dots(vec![flat(next)], blue, 4));
        speeds.push(f64::from(u.length()));
        point = next;
    }
    let until = count as Real * h;
    let line = (0..=200).map(|i| flat(blown.at(until * i as Real / 200.0).position));
    steps.items.push(Item::Line(line.collect(), red, 2));
    let path = out.join("synthesis_wind.svg");
    let title = "A flutter bent by a wind of 1.5 m/s from the left (thesis Fig. 3.13)";
    draw::write(&path, title, &[whole, steps], 2, (640, 560))?;
    let landing = |path: &MotionPath| path.at(path.duration()).position.x;
    Ok(json!({
        "mean_wind_m_per_s": 1.5,
        "interval_s": h,
        "landing_in_still_air_m": landing(&fall),
        "landing_in_wind_m": landing(&blown),
        "wind_of_the_first_steps_m_per_s": speeds,
    }))
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(s, n), v| (s + v * v, n + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

/// The jumps of splices to another regime: of the velocity, m/s, and of the attitude, rad.
struct Jumps {
    frames: Vec<Point>,
    regimes: Vec<Point>,
}

fn jump(points: &[Point]) -> Value {
    json!({
        "splices": points.len(),
        "velocity_rms_m_per_s": rms(points.iter().map(|p| p.0)),
        "attitude_rms_rad": rms(points.iter().map(|p| p.1)),
    })
}

/// The graph of frames beside that of regimes, with regimes in a plane (main regime PT) and with all (PS): what the
/// splices to another regime have to hide, and eight falls of each.
pub fn frames(
    out: &Path,
    leaf: &Body,
    database: &Arc<TrajectoryDatabase>,
    seed: u64,
) -> Result<Value, Box<dyn Error>> {
    let (red, blue) = (RGBColor(211, 47, 47), RGBColor(30, 90, 200));
    let (mut panels, mut numbers) = (Vec::new(), serde_json::Map::new());
    for main in [Regime::PeriodicTumbling, Regime::PeriodicSpiral] {
        let params = SynthesisParams {
            main: Some(main),
            ..SynthesisParams::default()
        };
        let synthesizer = leaf.synthesizer(params, database)?;
        let clips = Regime::ALL[..=main as usize].iter();
        let clips = clips.map(|regime| synthesizer.path_through(&[*regime], seed));
        let clips = clips.collect::<Result<Vec<_>, _>>()?;
        let half_period = PI * leaf.numbers.length / leaf.numbers.u0;
        let extents = [leaf.length, leaf.numbers.length];
        let graph = FrameGraph::new(&clips, FrameGraphParams::new(extents, half_period))?;
        let splices = graph.splices().iter();
        let changes = splices.filter(|s| graph.regime(s.from) != graph.regime(s.to));
        let jumps = Jumps {
            frames: changes.map(|s| (s.velocity, s.angle)).collect(),
            regimes: (0..400)
                .flat_map(|i| synthesizer.splices(seed + i))
                .map(|splice| (splice.velocity, splice.angle))
                .collect(),
        };
        let degrees = |points: &[Point]| points.iter().map(|(v, a)| (*v, a.to_degrees())).collect();
        let title = format!("up to {main}: regimes (red), frames (blue)");
        let mut jumped = Panel::new(title, "jump of the velocity, m/s", "of the attitude, °");
        jumped
            .items
            .push(Item::Dots(degrees(&jumps.frames), blue, 2));
        jumped
            .items
            .push(Item::Dots(degrees(&jumps.regimes), red, 3));
        let chain = MotionGraph::free_fall(main);
        let mut walked = Panel::new("eight walks on the graph of frames", "x, m", "y, m").equal();
        let mut drawn = Panel::new("eight falls on the graph of regimes", "x, m", "y, m").equal();
        for i in 0..8 {
            let walk = graph.walk(&chain, leaf.height, seed + i)?;
            let fall = synthesizer.path(seed + i);
            for (panel, path) in [(&mut walked, walk), (&mut drawn, fall)] {
                let trace = trace(&path, leaf.numbers.length, Real::INFINITY);
                panel.items.extend(trace);
            }
        }
        panels.extend([jumped, walked, drawn]);
        let value = json!({
            "frames": graph.frames(),
            "frames_in_use": graph.frames_in_use(),
            "splices": graph.splices().len(),
            "of_frames": jump(&jumps.frames),
            "of_regimes": jump(&jumps.regimes),
        });
        numbers.insert(main.abbreviation().into(), value);
    }
    let path = out.join("synthesis_frames.svg");
    let title = "Splices of frames and of regimes (thesis § 3.4.3)";
    draw::write_with_legend(&path, title, &legend(), &panels, 3, (430, 400))?;
    Ok(Value::Object(numbers))
}
