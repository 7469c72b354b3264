//! Snow in a turbulent wind over a wall and a boulder (thesis § 7.3: suspensions), a hundred thousand flakes at a time.
//!
//! ```text
//! cargo run --release --example snow                                # fine snow: a `Suspension`
//! cargo run --release --example snow -- --by emitter --seconds 2    # large flakes: rapier's bodies, by an `Emitter`
//! cargo run --release --example snow -- --cost                      # ns per flake and step of both, from 1,000 on
//! ```
//!
//! Fine snow (0.3 mm, Re 6) is of particles that drag, weight, wind and turbulence move; large flakes (discs of 6 mm, Re 200) are bodies
//! that fall by paths from the motion graph and, where they touch something, by the force model. Writes `snow.gif`. Printed: what falls and how,
//! how many have settled, and what a flake costs per step.

mod cost;
mod drift;
mod fall;
#[path = "../support/mod.rs"]
mod support;
mod view;

use clap::{Parser, ValueEnum};
use drift::Drift;
use fall::Fall;
use std::path::PathBuf;
use std::time::Instant;
use support::cli;
use view::Film;

/// Flakes fall in a turbulent wind and settle.
#[derive(Parser, Debug)]
#[command(name = "snow", version)]
struct Options {
    /// What moves the flakes
    #[arg(long, value_enum, default_value = "suspension")]
    by: Means,
    /// Flakes in the air
    #[arg(long, value_name = "N", default_value = "100000", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    flakes: u32,
    /// Wind at a height of 2 m, m/s
    #[arg(long, value_name = "M/S", default_value = "1.5", value_parser = cli::positive)]
    wind: f64,
    /// Simulated time, s
    #[arg(long, value_name = "S", default_value = "6", value_parser = cli::positive)]
    seconds: f64,
    /// Seed of places and turbulence
    #[arg(long, value_name = "N", default_value = "1")]
    seed: u64,
    /// Print what a flake costs per step by the number of flakes, and do nothing else
    #[arg(long)]
    cost: bool,
    /// Folder for the film
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
}

/// What moves the flakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Means {
    /// Fine snow: particles with drag, weight, wind and turbulence
    Suspension,
    /// Large flakes: bodies of rapier, nine in ten on synthesized paths, the others by forces
    Emitter,
}

fn main() -> Result<(), rapier3d_immersed::Error> {
    let options: Options = cli::parse();
    if options.cost {
        return cost::table(options.wind as f32);
    }
    let (wind, seed) = (options.wind as f32, options.seed);
    let mut fall = match options.by {
        Means::Suspension => Fall::Fine(Box::new(Drift::new(options.flakes, wind, seed)?)),
        Means::Emitter => Fall::large(options.flakes, wind, seed, [4.0, 0.9])?,
    };
    println!("{}", fall.described());
    let mut film = Film::new(&fall::world(fall::DT));
    let steps = (options.seconds / f64::from(fall::DT)).ceil() as u64;
    let bar = cli::progress(steps, "snow");
    let (mut spent, mut flakes) = (0.0, 0.0);
    for step in 0..steps {
        let begin = Instant::now();
        fall.step();
        spent += begin.elapsed().as_secs_f64();
        flakes += fall.moving() as f64;
        if step % 4 == 0 {
            film.expose(fall.places());
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    let path = options.out.join("snow.gif");
    cli::write(&path, film.developed(4.0 * fall::DT));
    println!(
        "{steps} steps of {:.0} flakes: {:.0} ns per flake and step, {:.1} ms per step; {} settled; {}",
        flakes / steps as f64,
        1e9 * spent / flakes,
        1e3 * spent / steps as f64,
        fall.settled(),
        path.display(),
    );
    Ok(())
}
