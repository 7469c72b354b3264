//! Leaves fall from a height of 5 m in still and moving air.
//!
//! ```text
//! cargo run --release --example windy
//! ```
//!
//! Printed for each air: how far downwind the leaves come to the ground on average, the nearest and the
//! farthest of them, and how long they take.

mod support;

use clap::Parser;
use rapier3d_immersed::flow::{Flow, Gust, Layers, LogLaw, Still, Uniform, Vortex};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::turbulence::{Turbulence, TurbulenceState};
use rapier3d_immersed::{Error, Fluid, HydroProperties, Immersion};
use support::options::Json;
use support::series::{CsvArgs, Series};

const LEAVES: usize = 50;
const HEIGHT: Real = 5.0;
const STEPS_PER_SECOND: usize = 120;
/// The leaves are down long before, s.
const LONGEST: usize = 60;

/// How far downwind of its release (m) and when (s) each leaf comes down.
fn landings(flow: impl Flow + 'static, turbulent: bool) -> Result<Vec<[Real; 2]>, Error> {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1.0 / STEPS_PER_SECOND as Real;
    let handles: Vec<_> = (0..LEAVES)
        .map(|i| {
            let body = RigidBodyBuilder::dynamic()
                .translation(Vector::new(0.0, HEIGHT, 0.5 * i as Real))
                .rotation(Vector::new(0.3, 0.7 * i as Real, 0.02 * i as Real));
            let leaf = ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(400.0);
            world.insert(body, leaf).0
        })
        .collect();
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handles[0])?;
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert_all(handles.iter().copied(), hydro);
    immersion.set_flow(flow);
    if turbulent {
        // Fluctuations of 0.6 m/s in eddies of half a meter.
        let state = TurbulenceState::from_intensity(2.0, 0.3, 0.5)?;
        immersion.set_turbulence(Turbulence::Homogeneous(state));
    }
    let mut landed = vec![None; LEAVES];
    for step in 0..LONGEST * STEPS_PER_SECOND {
        immersion.step(&mut world);
        let time = (step + 1) as Real / STEPS_PER_SECOND as Real;
        for (landed, handle) in landed.iter_mut().zip(&handles) {
            let place = world.bodies[*handle].translation();
            if landed.is_none() && place.y < 0.0 {
                *landed = Some([place.x, time]);
            }
        }
        if landed.iter().all(Option::is_some) {
            break;
        }
    }
    Ok(landed.into_iter().flatten().collect())
}

/// Leaves fall from a height of 5 m in still and moving air.
#[derive(Parser)]
#[command(name = "windy", version)]
struct Options {
    #[command(flatten)]
    csv: CsvArgs,
    #[command(flatten)]
    json: Json,
}

/// How far downwind on average, the nearest and the farthest, m, and when on average, s.
fn report(series: &mut Series, air: &str, landings: &[[Real; 2]]) {
    let mut downwind: Vec<Real> = landings.iter().map(|landing| landing[0]).collect();
    downwind.sort_by(Real::total_cmp);
    let [near, far] = [downwind[0], downwind[downwind.len() - 1]];
    let mean = |k: usize| landings.iter().map(|l| l[k]).sum::<Real>() / landings.len() as Real;
    series.push(air, &[mean(0), near, far, mean(1)].map(f64::from));
}

fn main() -> Result<(), Error> {
    let options: Options = support::cli::parse();
    // 2 m/s at 5 m over grass, along x.
    let wind = LogLaw::new(Vector::X, Vector::Y, 2.0, HEIGHT, 0.03)?;
    let gust = Gust {
        velocity: Vector::X * 4.0,
        start: 1.0,
        duration: 2.0,
        ..Gust::default()
    };
    let gusty = Layers::new().with(wind).with(gust);
    let vortex = Vortex::new(Vector::new(1.0, 2.5, 0.0), Vector::Z, 6.0, 0.5)?;
    let uniform = Uniform::new(2.0, 0.0, 0.0);
    let columns = [
        ("downwind", "m"),
        ("nearest", "m"),
        ("farthest", "m"),
        ("time", "s"),
    ];
    let mut series = Series::new("air", &columns);
    let all = &mut series;
    report(all, "still", &landings(Still, false)?);
    report(all, "2 m/s everywhere", &landings(uniform, false)?);
    report(all, "2 m/s at 5 m, over grass", &landings(wind, false)?);
    report(all, "… with turbulence", &landings(wind, true)?);
    report(all, "… with a gust of 4 m/s", &landings(gusty, false)?);
    report(all, "a vortex across their way", &landings(vortex, false)?);
    options.csv.write(|| series.csv());
    if options.json.on {
        println!("{:#}", series.json());
    } else {
        print!("{}", series.text());
    }
    Ok(())
}
