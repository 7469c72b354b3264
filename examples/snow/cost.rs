//! What a flake costs per step, and how that goes with their number.

use crate::drift::Drift;
use crate::fall::Fall;
use rapier3d_immersed::Error;
use std::time::Instant;

/// Steps until all flakes of an emitter are there, and those that are measured.
const BEFORE: usize = 245;
const MEASURED: usize = 30;

/// Median time of a step per flake, ns.
fn measured(fall: &mut Fall, before: usize) -> f64 {
    for _ in 0..before {
        fall.step();
    }
    let mut times: Vec<f64> = (0..MEASURED)
        .map(|_| {
            let begin = Instant::now();
            fall.step();
            1e9 * begin.elapsed().as_secs_f64() / fall.moving() as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[MEASURED / 2]
}

pub fn table(wind: f32) -> Result<(), Error> {
    println!(
        "ns per flake and step of 1/60 s, all of the step, in a turbulent wind over obstacles:"
    );
    println!(
        "{:>9} {:>12} {:>22} {:>22}",
        "flakes", "suspension", "emitter, 9/10 played", "emitter, forces"
    );
    for flakes in [1000, 10_000, 100_000] {
        let mut fine = Fall::Fine(Box::new(Drift::new(flakes, wind, 1)?));
        let fine = measured(&mut fine, 10);
        let played = measured(&mut Fall::large(flakes, wind, 1, 0.9)?, BEFORE);
        let forces = measured(&mut Fall::large(flakes, wind, 1, 0.0)?, BEFORE);
        println!("{flakes:>9} {fine:>12.0} {played:>22.0} {forces:>22.0}");
    }
    Ok(())
}
