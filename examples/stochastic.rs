//! The stochastic method (thesis chapter 4) end to end: generalised Kirchhoff equations, constant
//! force coefficients, and Langevin turbulence from the k–ε table that the crate ships.
//!
//! ```text
//! cargo run --release --example stochastic -- --out out
//! ```
//!
//! * `paper.svg`: an elliptic piece of paper from two release angles, as Fig. 4.3,
//! * `ellipsoid.svg`: a rubber ellipsoid in water every 50 ms, with its vortical loads and turbulence,
//!   without turbulence, and with Kirchhoff's equations alone, as Fig. 4.5,
//! * `stochastic.json`: what each run did, and the cost per step of the thesis's Table 4.2, all six rows, re-measured.

mod support;

use clap::Parser;
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::na::Matrix3;
use rapier3d_immersed::rapier3d::parry::shape::Ball;
use rapier3d_immersed::training::{BodyInWorld, BodyState};
use rapier3d_immersed::turbulence::{LangevinMode, Turbulence, TurbulenceTable, TurbulentLayer};
use rapier3d_immersed::{
    DryMass, Fluid, HydroProperties, ImmersedBody, RapierSets, StochasticLaw, ViscousLaw,
};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;
use support::cli::{self, Lengths};
use support::picture::{Line, Panel, panels, time_color};
use support::specimen::{ShapeName, Specimen, TiltAxis};
use support::{Quat, Vec3, airplane, from_rapier};

/// The stochastic method's paper and ellipsoid, with and without turbulence.
#[derive(Parser, Debug)]
#[command(name = "stochastic", version)]
struct Options {
    /// Seed of the turbulence
    #[arg(long, value_name = "N", default_value = "1")]
    seed: u64,
    /// Folder for the files
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Print the numbers as JSON instead of a table
    #[arg(long)]
    json: bool,
}

const GRAVITY: f64 = 9.81;

/// What moves the body besides its weight.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Physics {
    /// Kirchhoff's equations alone.
    Kirchhoff,
    /// … with constant drag and lift.
    Viscous,
    /// … and the thesis's random increments of the body's velocity.
    Increments,
    /// … or turbulence of the fluid that the body sees.
    FluidSeen,
}

impl Physics {
    fn name(self) -> &'static str {
        match self {
            Self::Kirchhoff => "Kirchhoff alone",
            Self::Viscous => "no turbulence",
            Self::Increments => "Langevin, the body's velocity (thesis)",
            Self::FluidSeen => "Langevin, the fluid's velocity (default)",
        }
    }
}

/// A body to be dropped.
#[derive(Clone)]
struct Case {
    hydro: HydroProperties,
    dry: DryMass,
    /// U0 of (4.1), m/s, and longest extent, m: the scales of the turbulence.
    u0: f64,
    length: f64,
    fluid: Fluid,
    dt: f64,
    seconds: f64,
}

/// A pose every step.
struct Flight {
    poses: Vec<(Vec3, Quat)>,
    dt: f64,
}

impl Case {
    /// A specimen of the given density, kg/m³, every 5 ms over 1.5 s.
    fn new(specimen: &Specimen, density: f64, fluid: Fluid) -> Self {
        Self {
            hydro: specimen.hydro.clone(),
            dry: specimen.dry_mass(density),
            u0: specimen.u0(density, &fluid, GRAVITY),
            length: specimen.span,
            fluid,
            dt: 0.005,
            seconds: 1.5,
        }
    }

    fn world(&self, orientation: Quat, physics: Physics, seed: u64) -> BodyInWorld {
        let law = match physics {
            Physics::Kirchhoff => ViscousLaw::Inviscid,
            _ => ViscousLaw::Stochastic(StochasticLaw::default()),
        };
        let body = ImmersedBody::new(self.hydro.clone())
            .with_law(law)
            .expect("the default coefficients are valid");
        let release = BodyState {
            orientation,
            ..BodyState::default()
        };
        let mut world = BodyInWorld::new(body, &self.dry, self.fluid, &release, self.dt, GRAVITY)
            .expect("the thesis's bodies can fly");
        let mode = match physics {
            Physics::Kirchhoff | Physics::Viscous => return world,
            Physics::Increments => LangevinMode::BodyIncrements,
            Physics::FluidSeen => LangevinMode::FluidSeen,
        };
        // The thesis's inflow: the body's mean falling speed (4.1) over its length.
        world.immersion.set_turbulence(TurbulentLayer {
            source: Turbulence::History {
                table: Arc::new(TurbulenceTable::default_history()),
                velocity_scale: self.u0 as f32,
                length_scale: self.length as f32,
            },
            mode,
            seed,
        });
        world
    }

    fn fly(&self, orientation: Quat, physics: Physics, seed: u64) -> Flight {
        let mut world = self.world(orientation, physics, seed);
        let steps = (self.seconds / self.dt).round() as usize;
        let poses = (0..=steps).map(|step| {
            if step > 0 {
                world.step();
            }
            let state = world.state();
            (state.position, state.orientation)
        });
        Flight {
            poses: poses.collect(),
            dt: self.dt,
        }
    }

    /// Mean time of a step of one body's world and of the crate's share in it, s.
    fn cost(&self) -> (f64, f64) {
        let BodyInWorld {
            mut world,
            mut immersion,
            ..
        } = self.world(Quat::identity(), Physics::FluidSeen, 1);
        let steps = 4000;
        let (mut whole, mut own) = (0.0, 0.0);
        for _ in 0..steps {
            let start = Instant::now();
            let sets = &mut RapierSets::of(&mut world);
            immersion.before_step(sets);
            let before = start.elapsed();
            world.step();
            let middle = Instant::now();
            immersion.after_step(&mut RapierSets::of(&mut world));
            own += (before + middle.elapsed()).as_secs_f64();
            whole += start.elapsed().as_secs_f64();
        }
        (whole / f64::from(steps), own / f64::from(steps))
    }
}

impl Flight {
    /// Poses every `seconds`, with their place in the run (0 to 1).
    fn every(&self, seconds: f64) -> impl Iterator<Item = (f64, &(Vec3, Quat))> {
        let stride = ((seconds / self.dt).round() as usize).max(1);
        let last = (self.poses.len() - 1).max(1) as f64;
        let poses = self.poses.iter().enumerate().step_by(stride);
        poses.map(move |(i, pose)| (i as f64 / last, pose))
    }

    fn end(&self) -> Vec3 {
        self.poses.last().map_or(Vec3::zeros(), |pose| pose.0)
    }

    /// Turning of the body summed up over the run, turns.
    fn turns(&self) -> f64 {
        let pairs = self.poses.windows(2);
        pairs.map(|p| p[0].1.angle_to(&p[1].1)).sum::<f64>() / std::f64::consts::TAU
    }

    fn json(&self) -> Value {
        let end = self.end();
        json!({
            "fall": -end.y,
            "drift": end.x.hypot(end.z),
            "turns": self.turns(),
        })
    }
}

/// Outline of an ellipsoid (semi-axes along the body's axes) seen along z.
fn silhouette(semi: Vec3, (center, attitude): &(Vec3, Quat)) -> Vec<(f64, f64)> {
    let r = attitude.to_rotation_matrix();
    let spread = r.matrix() * Matrix3::from_diagonal(&semi.map(|s| s * s)) * r.matrix().transpose();
    let (xx, xy, yy) = (spread[(0, 0)], spread[(0, 1)], spread[(1, 1)]);
    // Cholesky factor of the 2×2 part maps the unit circle onto the outline.
    let l = xx.max(1e-18).sqrt();
    let (m, n) = (xy / l, (yy - xy * xy / xx.max(1e-18)).max(0.0).sqrt());
    (0..=40)
        .map(|i| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / 40.0).sin_cos();
            (center.x + l * cos, center.y + m * cos + n * sin)
        })
        .collect()
}

/// The path and, every `seconds`, the body's outline.
fn strobe(title: &'static str, semi: Vec3, flight: &Flight, seconds: f64) -> Panel<'static> {
    let path = flight.poses.iter().map(|(p, _)| (p.x, p.y)).collect();
    let mut lines = vec![Line {
        points: path,
        color: plotters::style::RGBColor(170, 170, 170),
        width: 1,
    }];
    lines.extend(flight.every(seconds).map(|(at, pose)| Line {
        points: silhouette(semi, pose),
        color: time_color(at),
        width: 1,
    }));
    Panel {
        title,
        axes: ["x, m", "height, m"],
        lines,
        dots: Vec::new(),
        window: None,
    }
}

fn specimen(shape: ShapeName, size: &[f64]) -> Specimen {
    Specimen::new(shape, Some(&Lengths(size.to_vec())), None, None, 0.0)
        .expect("the thesis's sizes")
}

/// Density of paper, kg/m³.
const PAPER: f64 = 800.0;
/// Density of rubber, kg/m³; the thesis does not say.
const RUBBER: f64 = 1100.0;
/// Full extents of the rubber ellipsoid, m.
const ELLIPSOID: [f64; 3] = [0.08, 0.02, 0.04];

/// The rubber ellipsoid as the fluid feels a mesh of so many triangles around it and rings of them.
fn meshed_ellipsoid(around: u32, rings: u32) -> Case {
    let (vertices, triangles) = Ball::new(0.5).to_trimesh(around, rings);
    let stretch = Vec3::from(ELLIPSOID);
    let vertices: Vec<Vec3> = vertices
        .into_iter()
        .map(|v| from_rapier(v).component_mul(&stretch))
        .collect();
    let mesh = Surface::new(&vertices, &triangles).expect("a ball's mesh is closed");
    Case {
        hydro: HydroProperties::from_surface(&mesh, Vec3::zeros()),
        ..Case::new(
            &specimen(ShapeName::Ellipsoid, &ELLIPSOID),
            RUBBER,
            Fluid::WATER,
        )
    }
}

/// The folded airplane with its own mass.
fn folded_airplane() -> Case {
    let kind = airplane::kind(PAPER).expect("the thesis's airplane");
    let ratio = PAPER / f64::from(Fluid::AIR.density());
    Case {
        hydro: kind.body.hydro.clone(),
        dry: kind.dry,
        u0: ((ratio - 1.0) * GRAVITY * airplane::THICKNESS).sqrt(),
        length: airplane::SIDE,
        fluid: Fluid::AIR,
        dt: 0.005,
        seconds: 1.5,
    }
}

/// Table 4.2 of the thesis, all six rows, and the same re-measured.
fn table_4_2(paper: &Case) -> Vec<Value> {
    // The thesis does not say which ellipsoids: ours are that of Fig. 4.5, of as many triangles (twice
    // those around, times the rings less one).
    let (coarse, fine) = (meshed_ellipsoid(20, 9), meshed_ellipsoid(40, 17));
    let airplane = folded_airplane();
    let rows = [
        ("ellipsoid 1", 320, 0.001, 1.59, &coarse),
        ("ellipsoid 1", 320, 0.005, 1.63, &coarse),
        ("ellipsoid 1", 320, 0.010, 1.65, &coarse),
        ("ellipsoid 2", 1280, 0.005, 1.71, &fine),
        ("piece of paper", 1024, 0.005, 1.73, paper),
        ("paper airplane", 288, 0.005, 1.86, &airplane),
    ];
    let row = |(body, triangles, dt, thesis, case): (_, _, _, _, &Case)| {
        let (whole, own) = Case { dt, ..case.clone() }.cost();
        json!({
            "body": body,
            "triangles": triangles,
            "time_step_ms": 1e3 * dt,
            "thesis_ms": thesis,
            "step_ms": whole * 1e3,
            "crate_ms": own * 1e3,
        })
    };
    rows.into_iter().map(row).collect()
}

fn main() {
    let options: Options = cli::parse();
    let mut report = serde_json::Map::new();

    let ellipse = specimen(ShapeName::Ellipse, &[0.08, 0.02, 0.0001]);
    let paper = Case::new(&ellipse, PAPER, Fluid::AIR);
    let semi = Vec3::new(0.04, 0.00005, 0.01);
    let mut pictures = Vec::new();
    for angle in [75.0f64, 30.0] {
        let release = ellipse.released_at(angle.to_radians(), TiltAxis::Short);
        for physics in [Physics::Viscous, Physics::Increments, Physics::FluidSeen] {
            let flight = paper.fly(release, physics, options.seed);
            report.insert(
                format!("paper, {angle}°, {}", physics.name()),
                flight.json(),
            );
            pictures.push(strobe(physics.name(), semi, &flight, 0.04));
        }
    }
    let title = "Paper of 8 × 2 × 0.01 cm in air, every 40 ms; released at 75° (top) and 30°";
    let svg = panels(title, &pictures, 3, (420, 420)).expect("lines can be drawn");
    cli::write(&options.out.join("paper.svg"), svg);

    let ellipsoid = specimen(ShapeName::Ellipsoid, &ELLIPSOID);
    let ellipsoid = Case::new(&ellipsoid, RUBBER, Fluid::WATER);
    let semi = Vec3::new(0.04, 0.01, 0.02);
    let tilt = Quat::from_axis_angle(&Vec3::z_axis(), -30f64.to_radians())
        * Quat::from_axis_angle(&Vec3::x_axis(), 10f64.to_radians());
    let runs = [
        Physics::Kirchhoff,
        Physics::Viscous,
        Physics::Increments,
        Physics::FluidSeen,
    ];
    let pictures = runs.map(|physics| {
        let flight = ellipsoid.fly(tilt, physics, options.seed);
        report.insert(format!("ellipsoid, {}", physics.name()), flight.json());
        strobe(physics.name(), semi, &flight, 0.05)
    });
    let title = "Rubber ellipsoid (semi-axes 1, 2, 4 cm) sinking in water, every 50 ms";
    let svg = panels(title, &pictures, 4, (340, 640)).expect("lines can be drawn");
    cli::write(&options.out.join("ellipsoid.svg"), svg);

    let costs = table_4_2(&paper);
    let text = json!({ "runs": report, "cost": costs });
    let content = format!("{text:#}\n");
    cli::write(&options.out.join("stochastic.json"), &content);
    if options.json {
        print!("{content}");
        return;
    }
    println!(
        "{:<55} {:>8} {:>8} {:>7}",
        "run", "fall, m", "drift, m", "turns"
    );
    for (name, run) in &report {
        let number = |key: &str| run[key].as_f64().unwrap_or(f64::NAN);
        let (fall, drift, turns) = (number("fall"), number("drift"), number("turns"));
        println!("{name:<55} {fall:>8.2} {drift:>8.2} {turns:>7.1}");
    }
    println!(
        "\n{:<16} {:>9} {:>9} {:>16} {:>8} {:>7}",
        "Table 4.2: body", "triangles", "step, ms", "cost, µs: thesis", "whole", "ours"
    );
    for cost in &costs {
        let number = |key: &str| cost[key].as_f64().unwrap_or(f64::NAN);
        let body = cost["body"].as_str().unwrap_or_default();
        let (triangles, dt) = (number("triangles"), number("time_step_ms"));
        let [thesis, whole, own] = ["thesis_ms", "step_ms", "crate_ms"].map(|k| 1e3 * number(k));
        println!("{body:<16} {triangles:>9} {dt:>9} {thesis:>16.0} {whole:>8.2} {own:>7.2}");
    }
    let out = options.out.display();
    println!("wrote {out}/paper.svg, {out}/ellipsoid.svg, {out}/stochastic.json");
}
