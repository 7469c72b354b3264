//! What a flake costs per step, and how that goes with their number.

use crate::drift::Drift;
use crate::fall::Fall;
use rapier3d_immersed::Error;
use std::time::Instant;

/// Time in which an emitter lets its flakes in, s, the steps until all are there, and those that are measured.
const WITHIN: f32 = 0.25;
const BEFORE: usize = 20;
const MEASURED: usize = 20;

/// Least time of a step per flake, ns: what else the machine does only adds to it.
fn measured(fall: &mut Fall, before: usize) -> f64 {
    for _ in 0..before {
        fall.step();
    }
    let times = (0..MEASURED).map(|_| {
        let begin = Instant::now();
        fall.step();
        1e9 * begin.elapsed().as_secs_f64() / fall.moving() as f64
    });
    times.fold(f64::INFINITY, f64::min)
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
        let fine = measured(&mut fine, BEFORE);
        let played = measured(&mut Fall::large(flakes, wind, 1, [WITHIN, 0.9])?, BEFORE);
        let forces = measured(&mut Fall::large(flakes, wind, 1, [WITHIN, 0.0])?, BEFORE);
        println!("{flakes:>9} {fine:>12.0} {played:>22.0} {forces:>22.0}");
    }
    Ok(())
}
