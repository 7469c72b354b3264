//! "Flutter, then tumble": a fall is planned as a series of factors on a leaf's drag and lifts, and the leaf
//! replays it in a rapier world.
//!
//! ```text
//! cargo run --release --example pattern
//! ```
//!
//! Printed: for which share of the factors the leaf does what; the planned patterns with their times, and in
//! how many of six slightly different releases they came out; then what the leaf did in rapier meanwhile.

#[path = "support/replay.rs"]
mod replay;

use rapier3d_immersed::motion::{Classifier, MotionGraph, Pattern};
use rapier3d_immersed::training::{
    Experiment, Grid, Planner, PlannerParams, Subspaces, Sweep, thin_ellipsoid,
};
use rapier3d_immersed::{Error, Fluid};
use replay::{Dwell, replayed};
use std::ops::ControlFlow;

/// What is asked for.
const SEQUENCE: [Pattern; 2] = [Pattern::Zigzag, Pattern::Autorotation];
/// Seed of the plan.
const SEED: u64 = 1;

/// The thesis's patterns in words.
fn name(pattern: Pattern) -> &'static str {
    match pattern {
        Pattern::SteadyDescent => "steady descent",
        Pattern::Autorotation => "tumbling",
        Pattern::AutorotationZigzag => "both in turn",
        Pattern::Zigzag => "flutter",
    }
}

fn main() -> Result<(), Error> {
    // A leaf of 7.3 × 4.2 × 0.03 cm, 400 kg/m³; its long axis stays nearly horizontal.
    let (hydro, mass) = thin_ellipsoid([0.0365, 0.021, 0.00015], 400.0)?;
    let mut leaf = Experiment::new(hydro, mass, Fluid::AIR);
    leaf.release.tilt_axis = 80f64.to_radians();

    // Offline: what does it do for which factors? Each of the 6³ falls takes three seconds of its time.
    let mut sweep = Sweep::new(Grid::of_coefficients(6, 3.0)?);
    sweep.run_coefficients(&leaf, &Classifier::default(), |_, _| {
        ControlFlow::Continue(())
    })?;
    let subspaces = Subspaces::new(sweep.grid().clone(), sweep.patterns()?)?;
    println!("{} falls, factors from 0 to 3:", sweep.simulated());
    for (pattern, share) in Pattern::ALL.iter().zip(subspaces.volume_fractions()) {
        println!("  {:<16} {:3.0} %", name(*pattern), 100.0 * share);
    }

    let graph = MotionGraph::thesis();
    let planner = Planner::new(leaf.clone(), subspaces, &graph, PlannerParams::default())?;
    let plan = planner.plan_sequence(&SEQUENCE, SEED)?;

    // At run time.
    let replayed = replayed(&leaf, &plan.series)?;

    println!("planned         from   to, s  came out in   in rapier: turns over, back, which is");
    for (dwell, report) in replayed.dwells.iter().zip(&plan.dwells) {
        let Dwell {
            asked,
            from,
            to,
            seen,
        } = dwell;
        println!(
            "{:<14} {from:5.2} {to:7.2} {:>8} of {} {:>23} {:>5}  {}",
            name(*asked),
            report.shown,
            report.releases,
            seen.flips,
            seen.reversals,
            name(seen.regime.into()),
        );
    }
    let end = replayed.end.position;
    let drift = end.x.hypot(end.z);
    println!(
        "After {:.2} s it is {:.2} m down and {drift:.2} m aside.",
        plan.series.duration(),
        -end.y
    );
    Ok(())
}
