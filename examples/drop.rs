//! One body in free fall, no floor: the quickest way to check a published case.
//!
//! ```text
//! cargo run --release --example drop -- --shape plate --size 0.00648,0.00081,0.19 \
//!     --density 2700 --fluid water --release-angle 45 --law default --seconds 4
//! cargo run --release --example drop -- --shape leaf --density 400 --shake --seed 3 --open    # in the browser
//! ```

mod support;

use clap::Parser;
use rapier3d_immersed::training::{BodyState, FallStatistics};
use rapier3d_immersed::{DryMass, Fluid, FreeBody, ImmersedBody};
use serde_json::json;
use std::path::PathBuf;
use support::cli::{self, FluidArgs, bad_value};
use support::fall::{Fall, FallOptions, IntegratorName, shaken};
use support::film::{Film, FilmArgs, FrameRate};
use support::law::{LawName, law};
use support::options::{Json, Material, Out, Seconds, Seed, TimeStep, wrote};
use support::scene::{Kind, Scene};
use support::series::CsvArgs;
use support::shape::ShapeArgs;
use support::specimen::{Specimen, TiltAxis};
use support::{Vec3, picture};

/// One body in free fall through a fluid at rest; statistics over the second half of the run.
///
/// World axes: y is up. At a release angle of 0 a thin body lies flat, its longest extent along x; all others keep the axes of
/// their --size, y up. Without --density or --mass the body has 800 kg/m³. --csv
/// has every step: place, attitude, velocities, and the components of force and torque (N and Nm, world axes).
#[derive(Parser, Debug)]
#[command(name = "drop", version, allow_negative_numbers = true)]
#[command(mut_arg("dt", |dt| dt.default_value("0.004")))]
#[command(mut_arg("seconds", |seconds| seconds.default_value("5")))]
#[command(mut_arg("seed", |seed| seed.requires("shake")))]
struct Options {
    #[command(flatten)]
    body: ShapeArgs,
    #[command(flatten)]
    material: Material,
    /// Mass of the body, kg, instead of --density
    #[arg(long, value_name = "KG", value_parser = cli::positive, conflicts_with = "density")]
    mass: Option<f64>,
    #[command(flatten)]
    fluid: FluidArgs,
    /// Tilt at the release, degrees from horizontal; a positive one lowers the +z side (tilt axis
    /// long) or the +x end (short)
    #[arg(long, value_name = "DEG", default_value = "10", value_parser = cli::finite)]
    release_angle: f64,
    /// Axis of the body that stays horizontal [default: short for an ellipse, otherwise long]
    #[arg(long, value_enum)]
    tilt_axis: Option<TiltAxis>,
    /// Velocity at the release, m/s
    #[arg(long, value_name = "X,Y,Z", default_value = "0,0,0", value_parser = cli::vector,
          allow_hyphen_values = true)]
    velocity: Vec3,
    /// Angular velocity at the release, world axes, rad/s
    #[arg(long, value_name = "X,Y,Z", default_value = "0,0,0", value_parser = cli::vector,
          allow_hyphen_values = true)]
    spin: Vec3,
    /// Law of the viscous force
    #[arg(long, value_enum, default_value = "default")]
    law: LawName,
    /// Coefficients of the law. thesis: C_D,C_L1,C_L2 or sd, zz, az, ar [default: zz];
    /// stochastic: drag,lift[,arm[,damping]]; default: NAME=VALUE,… as the fields of PhysicalLaw
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    coefficients: Option<String>,
    /// Gravity, m/s², downward
    #[arg(long, value_name = "M/S2", default_value = "9.81", value_parser = cli::not_negative)]
    gravity: f64,
    #[command(flatten)]
    step: TimeStep,
    #[command(flatten)]
    time: Seconds,
    /// Shake the release: heading at random, tilt and spin by 2° and 0.1 rad/s (standard deviation)
    #[arg(long)]
    shake: bool,
    #[command(flatten)]
    seed: Seed,
    /// Who integrates: a rapier world (f32), or the crate's own free body (f64)
    #[arg(long, value_enum, default_value = "rapier")]
    integrator: IntegratorName,
    #[command(flatten)]
    csv: CsvArgs,
    /// Draw the trajectory, from the side and from above
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write a page that plays the fall, and a .glb, into --out; --gif and --open do so, too
    #[arg(long)]
    film: bool,
    #[command(flatten)]
    frame_rate: FrameRate,
    #[command(flatten)]
    filmed: FilmArgs,
    #[command(flatten)]
    out: Out,
    #[command(flatten)]
    json: Json,
}

fn main() {
    let options: Options = cli::parse();
    let shaped = options.body.shaped();
    let specimen =
        Specimen::new(&shaped).unwrap_or_else(|problem| bad_value("--shape/--size", problem));
    let fluid = options.fluid.fluid();
    let density = match options.mass {
        Some(mass) => mass / specimen.volume,
        None => options.material.density.unwrap_or(800.0),
    };
    let dry = specimen.dry_mass(density);
    let law = law(options.law, options.coefficients.as_deref())
        .unwrap_or_else(|problem| bad_value("--coefficients", problem));
    let body = ImmersedBody::new(specimen.hydro.clone())
        .with_law(law)
        .unwrap_or_else(|error| bad_value("--coefficients", error));
    check(&body, &dry, &fluid);

    let tilt_axis = options.tilt_axis.unwrap_or(TiltAxis::usual(shaped.shape));
    let release = BodyState {
        orientation: specimen.released_at(options.release_angle.to_radians(), tilt_axis),
        velocity: options.velocity,
        spin: options.spin,
        ..BodyState::default()
    };
    let release = match options.shake {
        true => shaken(release, options.seed.value),
        false => release,
    };
    let filmed = options.film || options.filmed.gif || options.filmed.open;
    let fall_options = FallOptions {
        gravity: options.gravity,
        dt: options.step.given(),
        seconds: options.time.given(),
        integrator: options.integrator,
        forces: options.csv.csv.is_some() || filmed,
    };
    fall_options
        .check()
        .unwrap_or_else(|(flag, problem)| bad_value(flag, problem));
    let fall = Fall::run(&body, &dry, &fluid, &release, &fall_options)
        .unwrap_or_else(|error| bad_value("--density/--size", error));

    options.csv.write(|| fall.csv());
    if let Some(path) = &options.svg {
        let chord = specimen.length;
        let picture = picture::fall(&fall.trajectory, chord);
        cli::write(
            path,
            picture.unwrap_or_else(|error| cli::cannot_write(path, error)),
        );
    }
    report(&options, &specimen, &fluid, &dry, &fall);
    if filmed {
        film(&options, &shaped.name, &specimen, dry.mass, &fall);
    }
}

/// The fall as a page.
fn film(options: &Options, name: &str, specimen: &Specimen, mass: f64, fall: &Fall) {
    let mut scene = Scene::new(Default::default());
    scene.world.gravity.y = -options.gravity as f32;
    scene.kinds.push(Kind::seen(specimen.solid.clone(), mass));
    scene.add_seen(0, [0.62, 0.24, 0.04]);
    let recording = fall.recording(options.frame_rate.hertz);
    let files = Film {
        name: "drop",
        title: &format!("{name}, let go"),
        scene: &scene,
        runs: &[("immersed", &recording)],
        camera: None,
        follow: true,
    }
    .write(&options.out, &options.filmed);
    if !options.json.on {
        println!("{}", wrote(&files));
    }
}

/// Ends the program if the crate refuses the body, before any time is spent.
fn check(body: &ImmersedBody, dry: &DryMass, fluid: &Fluid) {
    if let Err(error) = FreeBody::new(body, dry, fluid) {
        bad_value("--density/--mass/--size", error);
    }
}

fn report(options: &Options, specimen: &Specimen, fluid: &Fluid, dry: &DryMass, fall: &Fall) {
    /// Weightless bodies have numbers, too.
    const GRAVITY: f64 = 9.81;
    let statistics = FallStatistics::of(&fall.trajectory);
    let density = dry.mass / specimen.volume;
    let viscosity = f64::from(fluid.kinematic_viscosity());
    let numbers = specimen
        .numbers(density, fluid, GRAVITY)
        .unwrap_or_else(|error| bad_value("--density/--size", error));
    let u0 = numbers.u0 * (options.gravity / GRAVITY).sqrt();
    let reynolds = statistics.mean_descent.abs() * specimen.length / viscosity;
    let reynolds_u0 = u0 * specimen.length / viscosity;
    let i_star = numbers.i_star;
    let (seconds, dt) = (options.time.given(), options.step.given());
    if options.json.on {
        let object = json!({
            "mean_descent_mps": statistics.mean_descent,
            "mean_horizontal_mps": statistics.mean_horizontal,
            "rotation_rate_radps": statistics.rotation_rate,
            "flips": statistics.flips,
            "tilt_amplitude_rad": statistics.tilt_amplitude,
            "frequency_hz": statistics.frequency,
            "reynolds": reynolds,
            "reynolds_u0": reynolds_u0,
            "u0_mps": u0,
            "i_star": i_star,
            "stable": fall.stable,
            "mass_kg": dry.mass,
            "density_kgpm3": density,
            "volume_m3": specimen.volume,
            "length_m": specimen.length,
            "thickness_m": specimen.thickness,
            "fluid_density_kgpm3": fluid.density(),
            "viscosity_m2ps": fluid.kinematic_viscosity(),
            "dt_s": dt,
            "seconds_s": seconds,
        });
        println!("{object:#}");
        return;
    }
    let rows = [
        ("mean descent", statistics.mean_descent, "m/s"),
        ("mean horizontal drift", statistics.mean_horizontal, "m/s"),
        ("rotation rate", statistics.rotation_rate, "rad/s"),
        ("tilt amplitude", statistics.tilt_amplitude, "rad"),
        ("frequency", statistics.frequency, "Hz"),
        ("Re (mean descent)", reynolds, ""),
        ("Re (U0)", reynolds_u0, ""),
        ("U0", u0, "m/s"),
        ("I*", i_star, ""),
        ("mass", dry.mass, "kg"),
        ("length L", specimen.length, "m"),
        ("thickness t", specimen.thickness, "m"),
    ];
    println!("second half of {seconds} s:");
    for (name, value, unit) in rows {
        println!("  {name:<24}{:>14} {unit}", format_number(value));
    }
    println!("  {:<24}{:>14}", "flips", statistics.flips);
    println!("  {:<24}{:>14}", "stable", fall.stable);
}

/// Five significant digits, without an exponent where that is readable.
fn format_number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-3..1e5).contains(&size) {
        let whole = if size < 1.0 {
            0
        } else {
            size.log10() as usize + 1
        };
        format!("{value:.*}", 5_usize.saturating_sub(whole))
    } else {
        format!("{value:.4e}")
    }
}
