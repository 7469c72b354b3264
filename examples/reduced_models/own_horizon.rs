//! The crate's own dynamics, separated: trajectories, forces, and a flow map where the motion stays
//! in a plane. Error against horizon, off the grid.

use super::errors::{Errors, Truth};
use super::force_coefficients::SeparatedFall;
use super::free_fall::{Domain, GRAVITY, Specimen};
use indicatif::ProgressBar;
use rapier3d_immersed::rapier3d::na::{UnitQuaternion, Vector3};
use rapier3d_immersed::reduced::Axis;
use rapier3d_immersed::reduced::Tolerances;
use rapier3d_immersed::reduced::{CrossParams, Motions};
use rapier3d_immersed::reduced::{FlowMap, TrajectorySurrogate};
use std::error::Error;
use std::f64::consts::{FRAC_PI_2, PI};

pub const TRAJECTORY: &str = "separated trajectory";
pub const FLOW_MAP: &str = "separated flow map, iterated";
pub const FORCES: &str = "separated forces, integrated";

/// s, of the card and of the plate.
const CARD_HORIZONS: [f64; 6] = [0.1, 0.2, 0.5, 1.0, 2.0, 3.0];
const PLATE_HORIZONS: [f64; 6] = [0.12, 0.24, 0.48, 1.2, 2.4, 4.8];
/// Length of a step of the plate's flow map, s.
const MAP_STEP: f64 = 0.04;

/// s. At 5e-4 the integrator's own error would hide that of the card's forces: .02 instead of .005 of the
/// spread after 2 s.
const TRUE_STEP: f64 = 1e-4;

/// What a failed fall writes: the cross approximation refuses it.
const REFUSED: [f64; 2] = [f64::NAN; 2];

fn truth(
    specimen: &Specimen,
    domain: &Domain,
    horizons: &[f64],
    count: usize,
) -> Result<Truth, Box<dyn Error>> {
    let axes = domain.axes([2, 2, 2])?;
    let mut specimen = specimen.clone();
    specimen.step = TRUE_STEP;
    Ok(Truth::new(&axes, horizons, count, |p, times| {
        let positions = specimen.positions(p, times);
        positions.unwrap_or_else(|_| vec![REFUSED; times.len()])
    }))
}

/// One surrogate of whole trajectories per horizon, each with the same budget.
fn trajectories(
    specimen: &Specimen,
    domain: &Domain,
    truth: &Truth,
    params: &CrossParams,
    elements_per_second: f64,
) -> Result<Errors, Box<dyn Error>> {
    let mut errors = Vec::new();
    for (h, end) in truth.horizons.iter().enumerate() {
        let elements = (end * elements_per_second).ceil() as usize;
        let time = Axis::elements(0.0, *end, elements, 6)?;
        let model = |p: &[f64], times: &[f64], out: &mut [f64]| {
            let positions = specimen.positions(p, times);
            let positions = positions.unwrap_or_else(|_| vec![REFUSED; times.len()]);
            out.copy_from_slice(positions.as_flattened());
        };
        let axes = domain.axes([5, 7, 9])?;
        let (surrogate, _) = TrajectorySurrogate::bake(time, 2, axes, model, params)?;
        let all = truth.errors(|p, times| {
            let positions = surrogate.evaluate(p, times);
            positions.chunks_exact(2).map(|x| [x[0], x[1]]).collect()
        });
        errors.push(all[h]);
    }
    Ok(errors)
}

/// The forces as a tensor train, the equations of motion as they are.
fn forces(
    specimen: &Specimen,
    domain: &Domain,
    truth: &Truth,
    motions: Motions,
    speeds: (f64, f64),
    params: &CrossParams,
) -> Result<Errors, Box<dyn Error>> {
    // The acceleration is linear in the coefficients.
    let axes = domain.body_axes(2, 4)?;
    let (separated, _) = SeparatedFall::bake(specimen, motions, speeds, axes, params)?;
    let tolerances = Tolerances {
        relative: 1e-6,
        absolute: 1e-6,
        max_steps: 50_000,
    };
    Ok(truth.errors(|p, times| {
        let (angle, parameters) = p.split_last().expect("an angle");
        let orientation = specimen.orientation(*angle);
        separated.positions(parameters, orientation, times, tolerances)
    }))
}

/// Motion in the plane y–z: velocity along chord and normal, spin, angle of the chord, and y.
fn step(specimen: &Specimen, parameters: &[f64], x: &[f64; 5]) -> Option<[f64; 5]> {
    let mut body = specimen.body(parameters).ok()?;
    let at = |angle: f64| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angle);
    body.set_orientation(at(x[3]));
    let linear = at(x[3]) * Vector3::new(0.0, x[0], x[1]);
    body.set_velocity(linear, Vector3::x() * x[2]);
    for _ in 0..(MAP_STEP / specimen.step).round() as usize {
        body.step(specimen.step, GRAVITY);
    }
    let turned = (at(x[3]).inverse() * body.orientation()).scaled_axis().x;
    let u = body.orientation().inverse() * body.linear_velocity();
    Some([
        u.y,
        u.z,
        body.angular_velocity().x,
        x[3] + turned,
        x[4] + body.position.y,
    ])
}

/// Half turns about x change the signs of the velocities in body axes alone: the equal state with
/// the angle within (−π/2, π/2), and the sign.
fn reduced(x: &[f64; 5]) -> ([f64; 5], f64) {
    let turns = (x[3] / PI).round();
    let sign = if turns % 2.0 == 0.0 { 1.0 } else { -1.0 };
    let inside = [sign * x[0], sign * x[1], x[2], x[3] - turns * PI, 0.0];
    (inside, sign)
}

/// The largest velocities and spin over the domain, with a margin of a fifth.
fn reach(specimen: &Specimen, truth: &Truth) -> Result<[f64; 3], Box<dyn Error>> {
    let end = truth.horizons[truth.horizons.len() - 1];
    let times: Vec<f64> = (1..=500).map(|i| end * f64::from(i) / 500.0).collect();
    let mut most = [0.0_f64; 3];
    for point in &truth.points {
        specimen.fall(point, &times, |body| {
            let u = body.orientation().inverse() * body.linear_velocity();
            let all = [u.y, u.z, body.angular_velocity().x];
            most.iter_mut()
                .zip(all)
                .for_each(|(most, x)| *most = most.max(x.abs()));
        })?;
    }
    Ok(most.map(|x| 1.2 * x))
}

/// The plate's flow map over a short time, iterated.
fn flow_map(
    specimen: &Specimen,
    domain: &Domain,
    truth: &Truth,
    params: &CrossParams,
) -> Result<Errors, Box<dyn Error>> {
    let most = reach(specimen, truth)?;
    let mut state = Vec::new();
    for most in most {
        // Kinks of |ω|ω and at rest fall on the ends of elements.
        state.push(Axis::elements(-most, most, 2, 6)?);
    }
    state.push(Axis::spectral(-FRAC_PI_2, FRAC_PI_2, 11)?);
    let model = |s: &[f64], p: &[f64], change: &mut [f64]| {
        let start = [s[0], s[1], s[2], s[3], 0.0];
        let end = step(specimen, p, &start).unwrap_or([f64::NAN; 5]);
        for k in 0..5 {
            change[k] = end[k] - start[k];
        }
    };
    let axes = domain.body_axes(2, 5)?;
    let (map, _) = FlowMap::bake(MAP_STEP, state, axes, 1, model, params)?;
    let mut scratch = Vec::new();
    Ok(truth.errors(|p, times| {
        let mut x = [0.0, 0.0, 0.0, p[1], 0.0];
        let mut change = [0.0; 5];
        let mut steps = 0;
        times
            .iter()
            .map(|time| {
                while steps < (time / MAP_STEP).round() as usize {
                    let (inside, sign) = reduced(&x);
                    map.change(&inside[..4], &p[..1], &mut change, &mut scratch);
                    for (k, sign) in [sign, sign, 1.0, 1.0, 1.0].into_iter().enumerate() {
                        x[k] += sign * change[k];
                    }
                    steps += 1;
                }
                [0.0, x[4]]
            })
            .collect()
    }))
}

/// One panel's curves: what was separated, and its errors.
pub type Curves = Vec<(&'static str, Errors)>;

/// The card in air under the thesis's law.
pub fn card(domain: &Domain, bar: &ProgressBar) -> Result<Curves, Box<dyn Error>> {
    let specimen = Specimen::card()?;
    let truth = truth(&specimen, domain, &CARD_HORIZONS, 60)?;
    bar.set_message(format!("{}: trajectories", domain.name));
    let few = CrossParams {
        max_evaluations: 3000,
        ..CrossParams::default()
    };
    let mut finer = specimen.clone();
    finer.step = 2.5e-4;
    let trajectories = trajectories(&finer, domain, &truth, &few, 10.0)?;
    bar.set_message(format!("{}: forces", domain.name));
    let many = CrossParams {
        max_evaluations: 1_500_000,
        rank_growth: 4,
        max_rank: 60,
        ..CrossParams::default()
    };
    let forces = forces(
        &specimen,
        domain,
        &truth,
        Motions::Turned,
        (0.05, 6.0),
        &many,
    )?;
    Ok(vec![(TRAJECTORY, trajectories), (FORCES, forces)])
}

/// The plate in water under the default law.
pub fn plate(domain: &Domain, bar: &ProgressBar) -> Result<Curves, Box<dyn Error>> {
    let specimen = Specimen::plate()?;
    let truth = truth(&specimen, domain, &PLATE_HORIZONS, 100)?;
    bar.set_message(format!("{}: trajectories", domain.name));
    let few = CrossParams {
        max_evaluations: 3000,
        ..CrossParams::default()
    };
    let trajectories = trajectories(&specimen, domain, &truth, &few, 8.0)?;
    bar.set_message(format!("{}: flow map, forces", domain.name));
    let many = CrossParams {
        max_evaluations: 100_000,
        rank_growth: 4,
        max_rank: 60,
        ..CrossParams::default()
    };
    let flow_map = flow_map(&specimen, domain, &truth, &many)?;
    let speeds = (0.002, 2.0);
    let more = CrossParams {
        max_evaluations: 400_000,
        ..many
    };
    let forces = forces(&specimen, domain, &truth, Motions::InPlane, speeds, &more)?;
    Ok(vec![
        (TRAJECTORY, trajectories),
        (FLOW_MAP, flow_map),
        (FORCES, forces),
    ])
}
