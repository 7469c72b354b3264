//! What leaves were steered by, in a file: the crate's codebook, and beside it where each began and what it was to follow.

use crate::asked::Asked;
use crate::stage::Stage;
use crate::support::{Vec3, cli};
use rapier3d_immersed::motion::{Codebook, ControlSeries, Sketch};
use rapier3d_immersed::rapier3d::na::{Quaternion, UnitQuaternion};
use rapier3d_immersed::training::BodyState;
use serde_json::{Value, json};
use std::path::Path;

/// One leaf's part of a codebook.
pub struct Played {
    pub release: BodyState,
    pub sketch: Sketch,
    pub series: ControlSeries,
}

pub fn write(path: &Path, stage: &Stage, played: &[Played]) {
    let series = played.iter().map(|one| one.series.clone()).collect();
    let planned_for = stage.experiment.planned_for();
    let book = Codebook::new(
        "leaf, 7.3 × 4.2 × 0.03 cm, 400 kg/m³, in air",
        planned_for,
        series,
    );
    let book = book.unwrap_or_else(|problem| cli::cannot_write(path, problem));
    cli::write(path, book.to_bytes());
    let rows: Vec<Value> = played
        .iter()
        .map(|one| {
            let points = one.sketch.points().iter().map(|(t, p)| [*t, p.x, p.y, p.z]);
            json!({
                "position": one.release.position.as_slice(),
                "orientation": one.release.orientation.coords.as_slice(),
                "velocity": one.release.velocity.as_slice(),
                "spin": one.release.spin.as_slice(),
                "sketch": points.collect::<Vec<_>>(),
            })
        })
        .collect();
    cli::write(&path.with_extension("json"), format!("{:#}\n", json!(rows)));
}

/// # Errors
/// What of the two files cannot be read.
pub fn read(path: &Path) -> Result<Vec<Asked>, String> {
    let named =
        |path: &Path, problem: &dyn std::fmt::Display| format!("{}: {problem}", path.display());
    let bytes = std::fs::read(path).map_err(|problem| named(path, &problem))?;
    let book = Codebook::from_bytes(&bytes).map_err(|problem| named(path, &problem))?;
    let beside = path.with_extension("json");
    let text = std::fs::read_to_string(&beside).map_err(|problem| named(&beside, &problem))?;
    let rows: Vec<Value> =
        serde_json::from_str(&text).map_err(|problem| named(&beside, &problem))?;
    if rows.len() != book.series().len() {
        let problem = format!("{} leaves, but {} series", rows.len(), book.series().len());
        return Err(named(&beside, &problem));
    }
    let leaves = rows.iter().zip(book.series()).map(|(row, series)| {
        Ok(Asked {
            sketch: sketch(&row["sketch"])?,
            known: Some((release(row)?, series.clone())),
        })
    });
    let leaves: Result<_, String> = leaves.collect();
    leaves.map_err(|problem| named(&beside, &problem))
}

fn numbers<const N: usize>(value: &Value) -> Result<[f64; N], String> {
    serde_json::from_value::<Vec<f64>>(value.clone())
        .ok()
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| format!("{value} is not {N} numbers"))
}

fn release(row: &Value) -> Result<BodyState, String> {
    let vector = |name: &str| numbers::<3>(&row[name]).map(Vec3::from);
    let turn = Quaternion::from_vector(numbers::<4>(&row["orientation"])?.into());
    let state = BodyState {
        position: vector("position")?,
        orientation: UnitQuaternion::new_normalize(turn),
        velocity: vector("velocity")?,
        spin: vector("spin")?,
    };
    state.check().map_err(|problem| problem.to_string())?;
    Ok(state)
}

fn sketch(value: &Value) -> Result<Sketch, String> {
    let rows = value.as_array().ok_or("no sketch")?;
    let point = |row| {
        let [t, x, y, z] = numbers(row)?;
        Ok((t, Vec3::new(x, y, z)))
    };
    let points: Result<_, String> = rows.iter().map(point).collect();
    Sketch::new(points?).map_err(|problem| problem.to_string())
}
