//! A run in a few numbers, and two runs side by side.

use super::Vec3;
use super::recording::{Recording, median};
use super::scene::{Scene, pose_parts};
use serde_json::{Value, json};
use std::fmt::Write;

/// A run in a few numbers.
#[derive(Clone, Copy, Debug)]
pub struct Summary {
    /// Pieces that have landed.
    pub landed: usize,
    /// Median time from the release to the first contact, s.
    pub fall_time: f64,
    /// Median height fallen over that time, m/s.
    pub descent: f64,
    /// Median horizontal distance between release and first contact, m.
    pub drift: f64,
    /// Root mean square distance of the landing places from their mean, m.
    pub spread: f64,
    /// Median number of turns of the normal before the first contact.
    pub turns: f64,
    /// Height below which 95 % of the pieces lie that have not landed on an obstacle, m.
    pub pile_height: f64,
    /// Share of the pieces that are at rest at the end.
    pub at_rest: f64,
    /// Median time of a step while more than half of the pieces fall, ms.
    pub falling_step: f64,
    /// Median time of a step thereafter, ms.
    pub landed_step: f64,
    /// Wall time of the run, s.
    pub wall_time: f64,
}

impl Summary {
    /// Of a recorded run.
    pub fn of(scene: &Scene, recording: &Recording) -> Self {
        let fates = &recording.fates;
        let down: Vec<_> = fates
            .iter()
            .zip(&scene.pieces)
            .filter_map(|(fate, piece)| Some((fate.landed?, fate, piece)))
            .collect();
        let flat = |v: Vec3| v.x.hypot(v.z);
        let count = down.len().max(1) as f64;
        let mean = down.iter().map(|(_, fate, _)| fate.landed_at).sum::<Vec3>() / count;
        let variance = down
            .iter()
            .map(|(_, fate, _)| flat(fate.landed_at - mean).powi(2))
            .sum::<f64>()
            / count;
        let mut heights: Vec<f64> = down
            .iter()
            .map(|(_, fate, _)| fate.end)
            .filter(|end| !over_obstacle(scene, end))
            .map(|end| end.y)
            .collect();
        heights.sort_by(f64::total_cmp);
        let lower = (heights.len() as f64 * 0.95) as usize;
        Self {
            landed: down.len(),
            fall_time: median(down.iter().map(|(time, ..)| *time).collect()),
            descent: median(
                down.iter()
                    .map(|(time, fate, piece)| (piece.release.y - fate.landed_at.y) / time)
                    .collect(),
            ),
            drift: median(
                down.iter()
                    .map(|(_, fate, piece)| flat(fate.landed_at - piece.release))
                    .collect(),
            ),
            spread: variance.sqrt(),
            turns: median(down.iter().map(|(_, fate, _)| fate.turns).collect()),
            pile_height: heights.get(lower).copied().unwrap_or(0.0),
            at_rest: fates.iter().filter(|fate| fate.at_rest).count() as f64
                / fates.len().max(1) as f64,
            falling_step: recording.falling_step,
            landed_step: recording.landed_step,
            wall_time: recording.wall_time,
        }
    }

    /// As a JSON object.
    pub fn json(&self) -> Value {
        json!({
            "landed": self.landed,
            "fall_time_s": self.fall_time,
            "descent_mps": self.descent,
            "drift_m": self.drift,
            "spread_m": self.spread,
            "turns": self.turns,
            "pile_height_m": self.pile_height,
            "at_rest": self.at_rest,
            "falling_step_ms": self.falling_step,
            "landed_step_ms": self.landed_step,
            "wall_time_s": self.wall_time,
        })
    }
}

/// Whether a point lies above (or in) an obstacle other than the floor, within 8 cm.
fn over_obstacle(scene: &Scene, point: &Vec3) -> bool {
    scene.obstacles.iter().skip(1).any(|obstacle| {
        let (position, turn) = pose_parts(&obstacle.pose);
        let corners = obstacle.look.solid.vertices().iter();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for corner in corners.map(|v| position + turn * v) {
            for (k, value) in [corner.x, corner.z].into_iter().enumerate() {
                low[k] = low[k].min(value - 0.08);
                high[k] = high[k].max(value + 0.08);
            }
        }
        (low[0]..high[0]).contains(&point.x) && (low[1]..high[1]).contains(&point.z)
    })
}

/// The summary as a table, beside that of the same scene in plain rapier.
pub fn table(immersed: &Summary, plain: Option<&Summary>) -> String {
    type Row = (&'static str, fn(&Summary) -> f64, usize, &'static str);
    let rows: [Row; 11] = [
        ("pieces landed", |s| s.landed as f64, 0, ""),
        ("fall time, median", |s| s.fall_time, 2, "s"),
        ("speed of descent, median", |s| s.descent, 2, "m/s"),
        ("drift, median", |s| s.drift, 3, "m"),
        ("spread of landing places", |s| s.spread, 3, "m"),
        ("turns before landing, median", |s| s.turns, 2, ""),
        ("pile height (95 %)", |s| 1e3 * s.pile_height, 1, "mm"),
        ("at rest at the end", |s| 1e2 * s.at_rest, 0, "%"),
        ("time per step, falling", |s| s.falling_step, 3, "ms"),
        ("time per step, landed", |s| s.landed_step, 3, "ms"),
        ("wall time", |s| s.wall_time, 1, "s"),
    ];
    let mut text = format!("{:<32}{:>12}", "", "immersed");
    if plain.is_some() {
        write!(text, "{:>14}", "plain rapier").expect("a string takes anything");
    }
    for (name, value, digits, unit) in rows {
        write!(text, "\n{name:<32}{:>12.digits$}", value(immersed))
            .expect("a string takes anything");
        if let Some(plain) = plain {
            write!(text, "{:>14.digits$}", value(plain)).expect("a string takes anything");
        }
        write!(text, " {unit}").expect("a string takes anything");
    }
    text.push('\n');
    text
}
