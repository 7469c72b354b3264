//! Leaves that follow what was drawn for them (thesis § 7.3): a sketch from a file, a landing point, or a series of patterns;
//! several at once, with obstacles and wind.
//!
//! ```text
//! cargo run --release --features bake,serde-serialize --example sketch
//! cargo run --release --features bake,serde-serialize --example sketch -- --sketch examples/sketch/data/swing.svg --count 3
//! cargo run --release --features bake,serde-serialize --example sketch -- --land 0.5,0 --land -0.5,0 --uniform-wind 1,0,0
//! cargo run --release --features bake,serde-serialize --example sketch -- --patterns zz,ar --count 4 --obstacle 0,1,0,0.2
//! cargo run --release --features bake,serde-serialize --example sketch -- --load out/sketch.book
//! ```
//!
//! Sketches and landing points are followed while the world runs, so that what steers a leaf knows the wind and where obstacles
//! and other leaves have put it. Series of patterns are planned before, for a leaf alone in still air. Either can be saved
//! (`--save`) and played again without planning (`--load`), in the same world or another.
//!
//! Writes `sketch.svg` (asked paths dashed, flown ones, asked landing points and real ones), `sketch.html` (plays in a browser), `sketch.glb`
//! and, with `--gif`, `sketch.gif`. Printed for each leaf: mean and largest distance from its sketch, distance of the place where it
//! landed, when it met an obstacle, and the time that it all took.

mod asked;
mod book;
#[path = "../support/draw.rs"]
#[allow(dead_code, reason = "shared with other examples")]
mod draw;
mod guided;
mod options;
mod outcome;
mod stage;
#[path = "../support/mod.rs"]
mod support;
mod svg;

use options::Options;
use outcome::Outcome;
use stage::Stage;
use std::time::Instant;
use support::cli;
use support::film::Film;
use support::recording::{RunOptions, run};

/// Time after the last sketch's end, for leaves to come to rest, s.
const REST: f64 = 1.0;

fn main() {
    let options: Options = cli::parse();
    let stage = Stage::new(&options);
    let begin = Instant::now();
    let (asked, source) = match &options.load {
        Some(path) => {
            let read = book::read(path).unwrap_or_else(|text| cli::bad_value("--load", text));
            (read, "played again")
        }
        None => (asked::asked(&options, &stage), "followed"),
    };
    let (mut scene, mut guided) = stage.set(&options, asked);
    let ends = guided.asked.iter().map(|asked| asked.sketch.duration());
    let run_options = RunOptions {
        seconds: ends.fold(0.0, f64::max) + REST,
        frame_rate: options.frame_rate.hertz,
        forces: true,
        message: "sketches",
    };
    let recording = run(&mut scene, &run_options, &mut guided);
    let seconds = begin.elapsed().as_secs_f64();
    let (outcomes, played) = guided.outcomes(&scene, &recording);
    let film = Film {
        name: "sketch",
        title: "Sketches",
        scene: &scene,
        runs: &[("flown", &recording)],
        camera: None,
        follow: false,
    };
    let files = film.write(&options.out, &options.film);
    let picture = outcome::picture(&stage, &outcomes);
    options.out.write("sketch.svg", picture);
    if let Some(path) = &options.save {
        book::write(path, &stage, &played);
    }
    println!("leaf   off its sketch, cm    landed");
    println!("        mean       most    off, cm");
    for (index, outcome) in outcomes.iter().enumerate() {
        println!("{:<4} {outcome}", index + 1);
    }
    let mean = outcomes.iter().map(Outcome::mean).sum::<f64>() / outcomes.len() as f64;
    println!(
        "{} leaves of 7.3 cm {source} in {seconds:.1} s: {:.1} cm from their sketches on average; {}",
        outcomes.len(),
        100.0 * mean,
        files[0].display(),
    );
}
