//! One body in free fall, no floor: the quickest way to check a published case.
//!
//! ```text
//! cargo run --release --example drop -- --shape plate --size 0.00648,0.00081,0.19 \
//!     --density 2700 --fluid water --release-angle 45 --law default --seconds 4
//! ```

mod support;

use clap::Parser;
use rapier3d_immersed::training::{BodyState, FallStatistics};
use rapier3d_immersed::{DryMass, Fluid, FreeBody, ImmersedBody};
use serde_json::json;
use std::path::PathBuf;
use support::cli::{self, FluidArgs, Lengths, bad_value};
use support::fall::{Fall, FallOptions, IntegratorName, shaken};
use support::law::{LawName, law};
use support::specimen::{ShapeName, Specimen, TiltAxis};
use support::{Vec3, picture};

/// One body in free fall through a fluid at rest; statistics over the second half of the run.
///
/// World axes: y is up. At a release angle of 0 a thin body lies flat, its longest extent along x;
/// boxes and ellipsoids keep the axes of their --size, y up.
#[derive(Parser, Debug)]
#[command(name = "drop", version, allow_negative_numbers = true)]
struct Options {
    /// Shape of the body; may be left out with --mesh
    #[arg(long, value_enum)]
    shape: Option<ShapeName>,
    /// Full extents, m. disc: diameter,thickness; sphere: diameter; ellipse: major,minor,thickness;
    /// plate, box and ellipsoid: x,y,z (a plate's thinnest extent is its thickness in any order)
    #[arg(long, value_name = "A[,B[,C]]", value_parser = cli::lengths, allow_hyphen_values = true)]
    size: Option<Lengths>,
    /// OBJ or STL file for --shape mesh: a closed solid, or an open sheet
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Metres per unit of the --mesh, such as 0.001 for millimetres [default: 1, up to 10 m]
    #[arg(long, value_name = "M", value_parser = cli::positive)]
    scale: Option<f64>,
    /// Thickness given to a --mesh that is an open sheet, m
    #[arg(long, value_name = "M", default_value = "0.0003", value_parser = cli::positive)]
    thickness: f64,
    /// Density of the body, kg/m³ [default: 800]
    #[arg(long, value_name = "KG/M3", value_parser = cli::positive, conflicts_with = "mass")]
    density: Option<f64>,
    /// Mass of the body, kg, instead of --density
    #[arg(long, value_name = "KG", value_parser = cli::positive)]
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
    /// Time step, s
    #[arg(long, value_name = "S", default_value = "0.004", value_parser = cli::positive)]
    dt: f64,
    /// Length of the fall, s
    #[arg(long, value_name = "S", default_value = "5", value_parser = cli::positive)]
    seconds: f64,
    /// Shakes the release: heading at random, tilt and spin by 2° and 0.1 rad/s (standard deviation);
    /// without it the release is exact
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Who integrates: a rapier world (f32), or the crate's own free body (f64)
    #[arg(long, value_enum, default_value = "rapier")]
    integrator: IntegratorName,
    /// Write t, position, quaternion, velocities and the components of the force (world axes, N and N·m) on
    /// every step
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draw the trajectory, from the side and from above
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Print one JSON object instead of the table
    #[arg(long)]
    json: bool,
}

fn main() {
    let options: Options = cli::parse();
    let shape = match (options.shape, &options.mesh) {
        (Some(shape), _) => shape,
        (None, Some(_)) => ShapeName::Mesh,
        (None, None) => bad_value("--shape", "is required, or --mesh FILE"),
    };
    let specimen = Specimen::new(
        shape,
        options.size.as_ref(),
        options.mesh.as_deref(),
        options.scale,
        options.thickness,
    )
    .unwrap_or_else(|(flag, problem)| bad_value(flag, problem));
    let fluid = options.fluid.fluid();
    let density = match options.mass {
        Some(mass) => mass / specimen.volume,
        None => options.density.unwrap_or(800.0),
    };
    let dry = specimen.dry_mass(density);
    let law = law(options.law, options.coefficients.as_deref())
        .unwrap_or_else(|problem| bad_value("--coefficients", problem));
    let body = ImmersedBody::new(specimen.hydro.clone())
        .with_law(law)
        .unwrap_or_else(|error| bad_value("--coefficients", error));
    check(&body, &dry, &fluid);

    let tilt_axis = options.tilt_axis.unwrap_or(TiltAxis::usual(shape));
    let release = BodyState {
        orientation: specimen.released_at(options.release_angle.to_radians(), tilt_axis),
        velocity: options.velocity,
        spin: options.spin,
        ..BodyState::default()
    };
    let release = match options.seed {
        Some(seed) => shaken(release, seed),
        None => release,
    };
    let fall_options = FallOptions {
        gravity: options.gravity,
        dt: options.dt,
        seconds: options.seconds,
        integrator: options.integrator,
        forces: options.csv.is_some(),
    };
    fall_options
        .check()
        .unwrap_or_else(|(flag, problem)| bad_value(flag, problem));
    let fall = Fall::run(&body, &dry, &fluid, &release, &fall_options)
        .unwrap_or_else(|error| bad_value("--density/--size", error));

    if let Some(path) = &options.csv {
        cli::write(path, fall.csv());
    }
    if let Some(path) = &options.svg {
        let chord = specimen.length;
        let picture = picture::fall(&fall.trajectory, chord);
        cli::write(
            path,
            picture.unwrap_or_else(|error| cli::cannot_write(path, error)),
        );
    }
    report(&options, &specimen, &fluid, &dry, &fall);
}

/// Ends the program if the crate refuses the body, before any time is spent.
fn check(body: &ImmersedBody, dry: &DryMass, fluid: &Fluid) {
    if let Err(error) = FreeBody::new(body, dry, fluid) {
        bad_value("--density/--mass/--size", error);
    }
}

fn report(options: &Options, specimen: &Specimen, fluid: &Fluid, dry: &DryMass, fall: &Fall) {
    let statistics = FallStatistics::of(&fall.trajectory);
    let density = dry.mass / specimen.volume;
    let viscosity = f64::from(fluid.kinematic_viscosity());
    let u0 = specimen.u0(density, fluid, options.gravity);
    let reynolds = statistics.mean_descent.abs() * specimen.length / viscosity;
    let reynolds_u0 = u0 * specimen.length / viscosity;
    let i_star = specimen.i_star(density, fluid);
    if options.json {
        let object = json!({
            "mean_descent": statistics.mean_descent,
            "mean_horizontal": statistics.mean_horizontal,
            "rotation_rate": statistics.rotation_rate,
            "flips": statistics.flips,
            "tilt_amplitude": statistics.tilt_amplitude,
            "frequency": statistics.frequency,
            "reynolds": reynolds,
            "reynolds_u0": reynolds_u0,
            "u0": u0,
            "i_star": i_star,
            "stable": fall.stable,
            "mass": dry.mass,
            "density": density,
            "volume": specimen.volume,
            "length": specimen.length,
            "thickness": specimen.thickness,
            "fluid_density": fluid.density(),
            "viscosity": fluid.kinematic_viscosity(),
            "dt": options.dt,
            "seconds": options.seconds,
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
    println!("second half of {} s:", options.seconds);
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
