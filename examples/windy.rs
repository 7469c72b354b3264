//! Leaves fall from a height of 5 m in still and moving air.
//!
//! ```text
//! cargo run --release --example windy
//! ```
//!
//! Printed for each air: how far downwind the leaves come to the ground on average, the nearest and the
//! farthest of them, and how long they take.

use rapier3d_immersed::flow::{Flow, Gust, Layers, LogLaw, Still, Uniform, Vortex};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::turbulence::{Turbulence, TurbulenceState};
use rapier3d_immersed::{Error, Fluid, HydroProperties, Immersion};

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

fn report(air: &str, landings: &[[Real; 2]]) {
    let mut downwind: Vec<Real> = landings.iter().map(|landing| landing[0]).collect();
    downwind.sort_by(Real::total_cmp);
    let [near, far] = [downwind[0], downwind[downwind.len() - 1]];
    let mean = |k: usize| landings.iter().map(|l| l[k]).sum::<Real>() / landings.len() as Real;
    println!(
        "{air:<28} {:8.2} {near:9.2} {far:10.2} {:8.2}",
        mean(0),
        mean(1)
    );
}

fn main() -> Result<(), Error> {
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
    println!("air                          downwind, m: nearest   farthest   time, s");
    report("still", &landings(Still, false)?);
    report("2 m/s everywhere", &landings(uniform, false)?);
    report("2 m/s at 5 m, over grass", &landings(wind, false)?);
    report("… with turbulence", &landings(wind, true)?);
    report("… with a gust of 4 m/s", &landings(gusty, false)?);
    report("a vortex across their way", &landings(vortex, false)?);
    Ok(())
}
