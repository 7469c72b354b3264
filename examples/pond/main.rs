//! A thousand leaves rain on a pond: they flutter down, land, float, drift with the current and the breeze, wash ashore
//! and pile up against a log that floats before two posts.
//!
//! ```text
//! cargo run --release --example pond
//! cargo run --release --example pond -- --leaves 200 --wind 3 --seconds 60
//! ```
//!
//! Writes `pond.html` (a page that plays it), `pond.svg` (moments of it), `pond.glb` (an animation for 3-D tools) and
//! `summary.json`.

mod scene;
#[path = "../support/mod.rs"]
mod support;

use clap::Parser;
use rapier3d_immersed::rapier3d::prelude::PhysicsWorld;
use rapier3d_immersed::{Immersion, RapierSets};
use scene::{Channel, Count, Pond};
use serde_json::json;
use std::path::PathBuf;
use std::time::Instant;
use support::recording::{RunOptions, Stepper, run};
use support::sheet::{Camera, contact_sheet};
use support::{Vec3, cli, glb, html};

/// Leaves rain on a pond with a current, two banks, a breeze and a log.
#[derive(Parser, Debug)]
#[command(name = "pond", version)]
struct Options {
    /// Number of leaves
    #[arg(long, value_name = "N", default_value = "1000", value_parser = clap::value_parser!(u32).range(1..=5000))]
    leaves: u32,
    /// Simulated time, s
    #[arg(long, value_name = "S", default_value = "40", value_parser = cli::positive)]
    seconds: f64,
    /// Seed of the leaves' release
    #[arg(long, value_name = "N", default_value = "7")]
    seed: u64,
    /// Breeze at a height of 2 m, m/s
    #[arg(long, value_name = "M/S", default_value = "0.6", value_parser = cli::not_negative)]
    wind: f64,
    /// Current in the middle of the pond, m/s
    #[arg(long, value_name = "M/S", default_value = "0.12", value_parser = cli::not_negative)]
    current: f64,
    /// Frames per second of the animation
    #[arg(long, value_name = "HZ", default_value = "15", value_parser = cli::positive)]
    frame_rate: f64,
    /// Folder for the files
    #[arg(long, value_name = "DIR", default_value = "out/pond")]
    out: PathBuf,
}

/// An immersion whose steps are timed.
struct Timed<'a> {
    immersion: &'a mut Immersion,
    /// Seconds that it took, and rapier.
    times: [f64; 2],
}

impl Stepper for Timed<'_> {
    fn step(&mut self, world: &mut PhysicsWorld) {
        let start = Instant::now();
        self.immersion.before_step(&mut RapierSets::of(world));
        let stepped = Instant::now();
        world.step();
        let done = Instant::now();
        self.immersion.after_step(&mut RapierSets::of(world));
        self.times[0] += (done.elapsed() + (stepped - start)).as_secs_f64();
        self.times[1] += (done - stepped).as_secs_f64();
    }
}

fn main() {
    let options: Options = cli::parse();
    let pond = Pond {
        leaves: options.leaves as usize,
        seed: options.seed,
        current: options.current,
        wind: options.wind,
    };
    let built = pond.build();
    let (mut scene, mut immersion) =
        built.unwrap_or_else(|problem| cli::bad_value("--wind/--current", problem));
    let run_options = RunOptions {
        seconds: options.seconds,
        frame_rate: options.frame_rate,
        message: "pond",
        forces: false,
    };
    let mut timed = Timed {
        immersion: &mut immersion,
        times: [0.0; 2],
    };
    let recording = run(&mut scene, &run_options, &mut timed);
    let times = timed.times;
    for warning in immersion.warnings() {
        eprintln!("warning: {warning}");
    }

    let current = Channel {
        speed: options.current as f32,
    };
    let count = Count::of(&scene, &immersion, &current);
    let steps = options.seconds / f64::from(scene.world.integration_parameters.dt);
    let cost = times.map(|time| 1e9 * time / steps / scene.pieces.len() as f64);
    let [drift, water] = count.drift;
    println!("{} leaves, {} s", options.leaves, options.seconds);
    println!("  in the air          {:6}", count.falling);
    println!("  ashore              {:6}", count.ashore);
    println!("  afloat              {:6}", count.afloat);
    println!("    against the log   {:6}", count.at_log);
    println!("    touching nothing  {:6}", count.free);
    println!("  sunk                {:6}", count.sunk);
    println!("  asleep              {:6}", count.asleep);
    println!("drift of those that touch nothing {drift:.3} m/s, of the water there {water:.3} m/s");
    println!(
        "{:.0} ns per body and step, and {:.0} of rapier's own; {:.1} s",
        cost[0], cost[1], recording.wall_time
    );

    let camera = Camera {
        eye: Vec3::new(-2.6, 2.1, 2.3),
        target: Vec3::new(0.05, -0.1, -0.05),
        field_of_view: 0.62,
    };
    let close = Camera {
        eye: Vec3::new(0.35, 0.75, 0.95),
        target: Vec3::new(1.12, -0.02, 0.05),
        field_of_view: 0.72,
    };
    let end = options.seconds;
    let moments = [0.0, 1.6, 0.15 * end].map(|time| (time, camera));
    let moments = [
        &moments[..],
        &[(end, camera), (0.5 * end, close), (end, close)],
    ]
    .concat();
    let strip = contact_sheet(&scene, &recording, &moments, 3, (720, 480));
    let strip = strip.unwrap_or_else(|problem| cli::cannot_write("pond.svg".as_ref(), problem));
    let summary = json!({
        "leaves": options.leaves,
        "falling": count.falling,
        "ashore": count.ashore,
        "afloat": count.afloat,
        "at_log": count.at_log,
        "free": count.free,
        "sunk": count.sunk,
        "asleep": count.asleep,
        "drift": drift,
        "current_there": water,
        "ns_per_body_step": cost[0],
        "ns_of_rapier": cost[1],
    });
    let files = [
        ("pond.svg", strip.into_bytes()),
        ("pond.glb", glb::animation(&scene, &recording)),
        (
            "pond.html",
            html::page("Leaves on a pond", &scene, &[("pond", &recording)]).into(),
        ),
        ("summary.json", format!("{summary:#}\n").into_bytes()),
    ];
    for (name, content) in &files {
        cli::write(&options.out.join(name), content);
    }
    println!(
        "wrote {}/{{pond.html, pond.svg, pond.glb, summary.json}}",
        options.out.display()
    );
}
