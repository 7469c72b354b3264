//! The times that the thesis prints and no other example measures, in one run.

use rapier3d_immersed::boundary_element::BoundaryElementParams;
use rapier3d_immersed::flow::{SpectralWind, WindParams};
use rapier3d_immersed::geometry::{Ellipsoid, Surface};
use rapier3d_immersed::motion::path::{SynthesisParams, Synthesizer, TrajectoryDatabase};
use rapier3d_immersed::motion::{Classifier, DimensionlessNumbers, Outline};
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::training::{Experiment, Grid, Sweep};
use rapier3d_immersed::turbulence::{TurbulenceParams, TurbulenceTable};
use rapier3d_immersed::{AddedMass, Error, Fluid, ThesisLaw};
use serde_json::{Map, Value};
use std::f64::consts::PI;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

/// Seconds that something takes, the shortest of `times`.
fn shortest<T>(times: u32, mut work: impl FnMut() -> Result<T, Error>) -> Result<f64, Error> {
    let mut best = f64::INFINITY;
    for _ in 0..times {
        let clock = Instant::now();
        black_box(work()?);
        best = best.min(clock.elapsed().as_secs_f64());
    }
    Ok(best)
}

/// All of them by name: in ms, training in s.
pub fn measure() -> Result<Map<String, Value>, Error> {
    let mut found = Map::new();
    let mut put = |name: &str, value: f64| {
        found.insert(name.into(), value.into());
    };
    for (name, nodes, times) in [
        ("wind, 100 × 100", [100, 100, 1], 5),
        ("wind, 100 × 100 × 100", [100, 100, 100], 1),
    ] {
        let params = WindParams {
            nodes,
            ..WindParams::thesis()
        };
        put(name, 1e3 * shortest(times, || SpectralWind::bake(&params))?);
    }
    let params = TurbulenceParams {
        cells: [32, 32, 8],
        ..TurbulenceParams::thesis()
    };
    put(
        "k–ε, 32 × 32 × 8",
        1e3 * shortest(2, || TurbulenceTable::bake(&params))?,
    );

    let body = Ellipsoid {
        semi_axes: Vector3::new(0.04, 0.02, 0.01),
    };
    let surface = Surface::ellipsoid(&body, 8)?;
    assert_eq!(surface.triangles().len(), 1280, "as the thesis has them");
    let once = BoundaryElementParams {
        tolerance: f64::INFINITY,
        ..BoundaryElementParams::default()
    };
    put(
        "boundary elements, 1280 triangles",
        1e3 * shortest(3, || AddedMass::solve(&surface, &once))?,
    );
    put("synthesized path, step", synthesized_step()?);
    training(&mut put)?;
    Ok(found)
}

/// Looking up where a synthesized leaf is, ms.
fn synthesized_step() -> Result<f64, Error> {
    let leaf = DimensionlessNumbers::new(Outline::Round, 0.042, 0.0002, 800.0, &Fluid::AIR, 9.81)?;
    let database = TrajectoryDatabase::shipped();
    let path = Synthesizer::new(&leaf, 0.073, database, SynthesisParams::default())?.path(1);
    const STEPS: u16 = 10_000;
    let all = shortest(3, || {
        let time = |step| path.duration() * f32::from(step) / f32::from(STEPS);
        Ok((0..STEPS).fold(0.0, |sum, step| sum + path.at(time(step)).position.y))
    })?;
    Ok(1e3 * all / f64::from(STEPS))
}

/// Training on 729 falls and refining them to 4913, and a step of the thesis's card alone.
fn training(put: &mut impl FnMut(&str, f64)) -> Result<(), Error> {
    let card = Experiment::thesis_card(ThesisLaw::new([1.0; 3]))?;
    let steps = card.steps() as f64;
    put(
        "step of a card alone",
        1e3 * shortest(5, || card.run())? / steps,
    );
    let (trained, classifier) = (card.for_training(), Classifier::default());
    let mut sweep = Sweep::new(Grid::of_coefficients(9, PI)?);
    let run = |sweep: &mut Sweep| -> Result<f64, Error> {
        let clock = Instant::now();
        sweep.run_coefficients(&trained, &classifier, |_, _| ControlFlow::Continue(()))?;
        Ok(clock.elapsed().as_secs_f64())
    };
    put("training, 729 falls", run(&mut sweep)?);
    let mut fine = sweep.refined(|sample| sample.pattern())?;
    put("training, refined to 4913", run(&mut fine)?);
    Ok(())
}
