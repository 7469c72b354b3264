//! A thousand leaves rain on a pond: they flutter down, land, float, drift with the current and the breeze, wash ashore
//! and pile up against a log that floats before two posts.
//!
//! ```text
//! cargo run --release --example pond
//! cargo run --release --example pond -- --count 200 --wind 3 --seconds 60
//! ```
//!
//! Writes `pond.html` (a page that plays it), `pond.svg` (moments of it), `pond.glb` (an animation for 3-D tools), `pond.json`
//! (numbers) and, with `--gif`, `pond.gif`.

mod scene;
#[path = "../support/mod.rs"]
mod support;

use clap::Parser;
use rapier3d_immersed::rapier3d::prelude::PhysicsWorld;
use rapier3d_immersed::{Immersion, RapierSets};
use scene::{Channel, Count, Pond};
use serde_json::json;
use std::time::Instant;
use support::film::{Film, FilmArgs, FrameRate};
use support::options::{Count as Leaves, Json, Out, Seconds, Seed, Wind, wrote};
use support::recording::{RunOptions, Stepper, run};
use support::sheet::{Camera, contact_sheet};
use support::{Vec3, cli};

/// Leaves rain on a pond with a current, two banks, a breeze and a log.
#[derive(Parser, Debug)]
#[command(name = "pond", version)]
#[command(mut_arg("count", |count| count.default_value("1000")))]
#[command(mut_arg("seconds", |seconds| seconds.default_value("40")))]
#[command(mut_arg("seed", |seed| seed.default_value("7")))]
#[command(mut_arg("wind", |wind| wind.default_value("0.6")))]
#[command(mut_arg("frame_rate", |rate| rate.default_value("15")))]
struct Options {
    #[command(flatten)]
    count: Leaves,
    #[command(flatten)]
    time: Seconds,
    #[command(flatten)]
    seed: Seed,
    #[command(flatten)]
    wind: Wind,
    /// Current in the middle of the pond, m/s
    #[arg(long, value_name = "M/S", default_value = "0.12", value_parser = cli::not_negative)]
    current: f64,
    #[command(flatten)]
    frame_rate: FrameRate,
    #[command(flatten)]
    film: FilmArgs,
    #[command(flatten)]
    out: Out,
    #[command(flatten)]
    json: Json,
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
    let (leaves, seconds) = (options.count.within(1..=5000), options.time.given());
    let pond = Pond {
        leaves: leaves as usize,
        seed: options.seed.value,
        current: options.current,
        wind: options.wind.speed,
    };
    let built = pond.build();
    let (mut scene, mut immersion) =
        built.unwrap_or_else(|problem| cli::bad_value("--wind/--current", problem));
    let run_options = RunOptions {
        seconds,
        frame_rate: options.frame_rate.hertz,
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
    let steps = seconds / f64::from(scene.world.integration_parameters.dt);
    let cost = times.map(|time| 1e9 * time / steps / scene.pieces.len() as f64);
    let [drift, water] = count.drift;
    if !options.json.on {
        println!("{leaves} leaves, {seconds} s");
        println!("  in the air          {:6}", count.falling);
        println!("  ashore              {:6}", count.ashore);
        println!("  afloat              {:6}", count.afloat);
        println!("    against the log   {:6}", count.at_log);
        println!("    touching nothing  {:6}", count.free);
        println!("  sunk                {:6}", count.sunk);
        println!("  asleep              {:6}", count.asleep);
        println!(
            "drift of those that touch nothing {drift:.3} m/s, of the water there {water:.3} m/s"
        );
        println!(
            "{:.0} ns per body and step, and {:.0} of rapier's own; {:.1} s",
            cost[0], cost[1], recording.wall_time
        );
    }

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
    let end = seconds;
    let moments = [0.0, 1.6, 0.15 * end].map(|time| (time, camera));
    let moments = [
        &moments[..],
        &[(end, camera), (0.5 * end, close), (end, close)],
    ]
    .concat();
    let strip = contact_sheet(&scene, &recording, &moments, 3, (720, 480));
    let strip = strip.unwrap_or_else(|problem| cli::cannot_write("pond.svg".as_ref(), problem));
    let summary = json!({
        "leaves": leaves,
        "seconds_s": seconds,
        "falling": count.falling,
        "ashore": count.ashore,
        "afloat": count.afloat,
        "at_log": count.at_log,
        "free": count.free,
        "sunk": count.sunk,
        "asleep": count.asleep,
        "drift_mps": drift,
        "current_there_mps": water,
        "per_body_and_step_ns": cost[0],
        "rapier_per_body_and_step_ns": cost[1],
    });
    let film = Film {
        name: "pond",
        title: "Leaves on a pond",
        scene: &scene,
        runs: &[("pond", &recording)],
        camera: Some(camera),
        follow: false,
    };
    let mut files = film.write(&options.out, &options.film);
    files.push(options.out.write("pond.svg", strip));
    files.push(options.out.write("pond.json", format!("{summary:#}\n")));
    if options.json.on {
        println!("{summary:#}");
    } else {
        println!("{}", wrote(&files));
    }
}
