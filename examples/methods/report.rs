//! All that was measured, with a number for each cell of thesis Table 7.1; and all of it as JSON.

use crate::cost::Cost;
use crate::means::Means;
use crate::memory::Making;
use crate::method::Method;
use crate::stability::Stability;
use serde_json::{Map, Value, json};

/// Of one method.
pub struct Row {
    pub method: Method,
    pub cost: Cost,
    pub making: Making,
    pub means: Means,
    /// Of descent, drift and regimes.
    pub errors: [f64; 3],
    pub stability: Stability,
    /// m.
    pub landing: f64,
    pub sequence: Option<f64>,
    /// Shapes that it does not take, of how many.
    pub refused: Vec<(&'static str, String)>,
    pub shapes: usize,
    /// Distance of joined ends, m.
    pub gap: f64,
}

/// The criteria of thesis Table 7.1 in its order, each with what is measured for it.
pub const CRITERIA: [(&str, &str); 7] = [
    ("Adaptive geometries", "shapes that it takes"),
    ("Data-independence", "bytes held, made of so many samples"),
    (
        "Computation cost",
        "ns per body and step beyond plain rapier's",
    ),
    (
        "Simulation fidelity",
        "paper, 24 mm: errors of descent, drift, regimes",
    ),
    (
        "Controllability",
        "distance from a target 2 m below; sequence shown",
    ),
    (
        "Simulation stability",
        "falls of 1000 at 1/30 s that gain energy; most",
    ),
    ("Extensibility", "gap of two joined leaves"),
];

/// Number with a unit of bytes.
pub fn bytes(count: f64) -> String {
    match count {
        n if n.abs() < 1e3 => format!("{n:.0} B"),
        n if n.abs() < 1e6 => format!("{:.1} kB", 1e-3 * n),
        n => format!("{:.1} MB", 1e-6 * n),
    }
}

impl Row {
    /// A cell of Table 7.1 for each criterion.
    pub fn cells(&self) -> [String; 7] {
        let [descent, drift, regimes] = self.errors.map(|error| 100.0 * error);
        let samples = self.making.samples;
        let shown = self
            .sequence
            .map(|share| format!(", {:.0} %", 100.0 * share));
        [
            format!("{} of {}", self.shapes - self.refused.len(), self.shapes),
            match samples {
                0 => "none".into(),
                _ => format!("{}, {samples}", bytes(self.making.bytes as f64)),
            },
            format!("{:.0} ns", self.cost.extra),
            format!("{descent:+.0} %, {drift:+.0} %, {regimes:.0} %"),
            format!(
                "{:.0} cm{}",
                100.0 * self.landing,
                shown.unwrap_or_default()
            ),
            format!("{}; {:.2}", self.stability.count(), self.stability.worst),
            format!("{:.1} mm", 1e3 * self.gap),
        ]
    }

    fn json(&self) -> Value {
        let [descent, drift, regimes] = self.errors;
        let refused: Map<String, Value> = self
            .refused
            .iter()
            .map(|(name, why)| ((*name).into(), json!(why)))
            .collect();
        let criteria: Map<String, Value> = CRITERIA
            .iter()
            .zip(self.cells())
            .enumerate()
            .map(|(i, ((name, what), cell))| {
                let thesis = self.method.thesis().map(|ticks| ticks[i]);
                let key = name.to_lowercase().replace([' ', '-'], "_");
                (
                    key,
                    json!({ "what": what, "measured": cell, "thesis": thesis }),
                )
            })
            .collect();
        json!({
            "name": self.method.name(),
            "cost": {
                "step_ns": self.cost.step,
                "beyond_plain_ns": self.cost.extra,
                "bytes_per_body": self.cost.bytes,
            },
            "making": {
                "seconds": self.making.seconds,
                "bytes": self.making.bytes,
                "samples": self.making.samples,
            },
            "paper": self.means.json(),
            "errors": { "descent": descent, "drift": drift, "regimes": regimes },
            "stability": self.stability.json(),
            "landing_error": self.landing,
            "sequence_shown": self.sequence,
            "shapes_taken": self.shapes - self.refused.len(),
            "shapes_refused": refused,
            "joint_gap": self.gap,
            "table_7_1": criteria,
        })
    }
}

pub fn json(rows: &[Row], measured: &Means) -> Value {
    let methods: Map<String, Value> = rows
        .iter()
        .map(|row| (row.method.key().into(), row.json()))
        .collect();
    json!({ "measured": measured.json(), "methods": methods })
}
