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
use std::time::Instant;
use support::cli;
use support::options::{Count, Out, Seconds, Seed, Wind};
use view::Film;

/// Flakes fall in a turbulent wind and settle.
#[derive(Parser, Debug)]
#[command(name = "snow", version)]
#[command(mut_arg("count", |count| count.default_value("100000")))]
#[command(mut_arg("wind", |wind| wind.default_value("1.5")))]
#[command(mut_arg("seconds", |seconds| seconds.default_value("6")))]
struct Options {
    /// What moves the flakes
    #[arg(long, value_enum, default_value = "suspension")]
    by: Means,
    #[command(flatten)]
    count: Count,
    #[command(flatten)]
    wind: Wind,
    #[command(flatten)]
    time: Seconds,
    #[command(flatten)]
    seed: Seed,
    /// Print what a flake costs per step by the number of flakes, and do nothing else
    #[arg(long)]
    cost: bool,
    #[command(flatten)]
    out: Out,
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
    let (wind, seed) = (options.wind.speed as f32, options.seed.value);
    if wind <= 0.0 {
        cli::bad_value("--wind", "there has to be some: it makes the turbulence");
    }
    if options.cost {
        return cost::table(wind);
    }
    let flakes = options.count.within(1..=1_000_000);
    let mut fall = match options.by {
        Means::Suspension => Fall::Fine(Box::new(Drift::new(flakes, wind, seed)?)),
        Means::Emitter => Fall::large(flakes, wind, seed, [4.0, 0.9])?,
    };
    println!("{}", fall.described());
    let mut film = Film::new(&fall::world(fall::DT));
    let steps = (options.time.given() / f64::from(fall::DT)).ceil() as u64;
    let bar = cli::progress(steps, "snow");
    let (mut spent, mut moved) = (0.0, 0.0);
    for step in 0..steps {
        let begin = Instant::now();
        fall.step();
        spent += begin.elapsed().as_secs_f64();
        moved += fall.moving() as f64;
        if step % 4 == 0 {
            film.expose(fall.places());
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    let path = options
        .out
        .write("snow.gif", film.developed(4.0 * fall::DT));
    println!(
        "{steps} steps of {:.0} flakes: {:.0} ns per flake and step, {:.1} ms per step; {} settled; {}",
        moved / steps as f64,
        1e9 * spent / moved,
        1e3 * spent / steps as f64,
        fall.settled(),
        path.display(),
    );
    Ok(())
}
