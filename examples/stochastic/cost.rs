//! What a step costs: the thesis's Table 4.2, re-measured.

use crate::case::{Case, Physics, Row, table_4_2};
use rapier3d_immersed::RapierSets;
use rapier3d_immersed::training::BodyInWorld;
use serde_json::{Value, json};
use std::time::Instant;

/// Mean time of a step of one body's world and of the crate's share in it, s.
fn cost(case: &Case) -> (f64, f64) {
    let BodyInWorld {
        mut world,
        mut immersion,
        ..
    } = case.world(Physics::Increments, 1);
    let steps = 4000;
    let (mut whole, mut own) = (0.0, 0.0);
    for _ in 0..steps {
        let start = Instant::now();
        let sets = &mut RapierSets::of(&mut world);
        immersion.before_step(sets);
        let before = start.elapsed();
        world.step();
        let middle = Instant::now();
        immersion.after_step(&mut RapierSets::of(&mut world));
        own += (before + middle.elapsed()).as_secs_f64();
        whole += start.elapsed().as_secs_f64();
    }
    (whole / f64::from(steps), own / f64::from(steps))
}

/// All six rows.
pub fn table() -> Vec<Value> {
    let row = |row: &Row| {
        let (whole, own) = cost(&row.case);
        json!({
            "body": row.body,
            "triangles": row.triangles,
            "time_step_ms": 1e3 * row.case.dt,
            "thesis_ms": row.thesis,
            "step_ms": whole * 1e3,
            "crate_ms": own * 1e3,
        })
    };
    table_4_2().iter().map(row).collect()
}

/// As text.
pub fn print(rows: &[Value]) {
    println!(
        "\n{:<16} {:>9} {:>9} {:>16} {:>8} {:>7}",
        "Table 4.2: body", "triangles", "step, ms", "cost, µs: thesis", "whole", "ours"
    );
    for row in rows {
        let number = |key: &str| row[key].as_f64().unwrap_or(f64::NAN);
        let body = row["body"].as_str().unwrap_or_default();
        let (triangles, dt) = (number("triangles"), number("time_step_ms"));
        let [thesis, whole, own] = ["thesis_ms", "step_ms", "crate_ms"].map(|k| 1e3 * number(k));
        println!("{body:<16} {triangles:>9} {dt:>9} {thesis:>16.0} {whole:>8.2} {own:>7.2}");
    }
}
