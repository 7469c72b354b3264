//! A track of one's own beside the default law's fall from its start.

use crate::support::cli::{self, FluidArgs};
use crate::support::fall::{Fall, FallOptions, IntegratorName};
use crate::support::film::{Film, FilmArgs};
use crate::support::options::{Material, wrote};
use crate::support::recording::Recording;
use crate::support::scene::{Kind, Scene};
use crate::support::shape::ShapeArgs;
use crate::support::specimen::Specimen;
use crate::support::track::{Track, TrackArgs};
use crate::support::{Quat, Vec3};
use crate::{Arguments, Failure};
use clap::Args;
use rapier3d_immersed::ImmersedBody;
use rapier3d_immersed::training::BodyState;
use serde_json::json;

/// m/s².
const GRAVITY: f64 = 9.81;
/// Longest step, s.
const STEP: f64 = 1.0 / 240.0;

/// A track and its body.
#[derive(Args)]
pub struct OwnArgs {
    #[command(flatten)]
    pub track: TrackArgs,
    #[command(flatten)]
    body: ShapeArgs,
    #[command(flatten)]
    material: Material,
    #[command(flatten)]
    fluid: FluidArgs,
    #[command(flatten)]
    film: FilmArgs,
}

/// Place, attitude and velocities in the first frame: those of the parabola through the first three.
fn start(track: &Track) -> BodyState {
    let [t0, t1, t2] = [0, 1, 2].map(|i| track.times[i]);
    let slope = |a: Vec3, b: Vec3| {
        a / (t1 - t0) - (b / (t2 - t0) - a / (t1 - t0)) * ((t1 - t0) / (t2 - t1))
    };
    let moved = |i: usize| track.places[i] - track.places[0];
    let turned = |i: usize| (track.turns[i] * track.turns[0].inverse()).scaled_axis();
    BodyState {
        position: track.places[0],
        orientation: track.turns[0],
        velocity: slope(moved(1), moved(2)),
        spin: slope(turned(1), turned(2)),
    }
}

/// Prints how far both are apart, and writes the page.
pub fn compare(text: &str, arguments: &Arguments) -> Result<(), Failure> {
    let own = &arguments.own;
    let track = Track::read(text).unwrap_or_else(|problem| cli::bad_value("--track", problem));
    if track.times.len() < 4 {
        cli::bad_value("--track", "less than four rows");
    }
    let shaped = own.body.shaped();
    let body = Specimen::new(&shaped)?;
    let dry = body.dry_mass(own.material.density.unwrap_or(800.0));
    let begin = track.times[0];
    let seconds = track.times[track.times.len() - 1] - begin;
    // A whole number of steps in the track's mean interval.
    let interval = seconds / (track.times.len() - 1) as f64;
    let options = FallOptions {
        gravity: GRAVITY,
        dt: interval / (interval / STEP).ceil(),
        seconds,
        integrator: IntegratorName::Rapier,
        forces: false,
    };
    if let Err((_, problem)) = options.check() {
        cli::bad_value("--track", problem);
    }
    let immersed = ImmersedBody::new(body.hydro.clone());
    let fall = Fall::run(
        &immersed,
        &dry,
        &own.fluid.fluid(),
        &start(&track),
        &options,
    )?;
    let ours: Vec<(Vec3, Quat)> = track
        .times
        .iter()
        .map(|time| {
            let step = ((time - begin) / options.dt).round() as usize;
            let state = &fall.states[step.min(fall.states.len() - 1)];
            (state.position, state.orientation)
        })
        .collect();
    let both = ours.iter().zip(track.places.iter().zip(&track.turns));
    let apart: Vec<f64> = both
        .clone()
        .map(|((p, _), (q, _))| (p - q).norm())
        .collect();
    let turned: Vec<f64> = both.map(|((_, p), (_, q))| p.angle_to(q)).collect();
    let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let parted = apart.iter().position(|x| *x > body.length);
    let parted = parted.map(|frame| track.times[frame] - begin);

    let mut scene = Scene::new(Default::default());
    scene.kinds.push(Kind::seen(body.solid.clone(), dry.mass));
    scene.add_seen(0, [0.62, 0.24, 0.04]);
    let recording = |places: Vec<(Vec3, Quat)>| Recording {
        times: track.times.iter().map(|time| time - begin).collect(),
        frames: places.into_iter().map(|place| vec![place]).collect(),
        ..Recording::default()
    };
    let measured = track
        .places
        .iter()
        .copied()
        .zip(track.turns.iter().copied());
    let runs = [recording(measured.collect()), recording(ours)];
    let film = Film {
        name: "track",
        title: "A track, and the default law from its start",
        scene: &scene,
        runs: &[("track", &runs[0]), ("ours", &runs[1])],
        camera: None,
        follow: true,
    };
    let files = film.write(&arguments.out, &own.film);
    if arguments.json.on {
        let numbers = json!({
            "seconds_s": seconds,
            "rows": track.times.len(),
            "parted_s": parted,
            "largest_distance_m": most(&apart),
            "largest_angle_rad": most(&turned),
        });
        println!("{numbers:#}");
        return Ok(());
    }
    println!(
        "{}: {} rows, {seconds:.3} s; ours is at most {:.4} m and {:.1}° away, and {}",
        shaped.name,
        track.times.len(),
        most(&apart),
        most(&turned).to_degrees(),
        match parted {
            Some(time) => format!("its length ({:.4} m) away after {time:.3} s", body.length),
            None => format!("never its length ({:.4} m)", body.length),
        }
    );
    println!("{}", wrote(&files));
    Ok(())
}
