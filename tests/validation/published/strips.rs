//! Strips that tumble: how fast by thickness and width, and from which mass on.

use super::report::Row;
use super::samara::box_mass;
use super::{Computed, Effort, Failure, Progress};
use rapier3d_immersed::motion::Regime;
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::rapier3d::parry::shape::Cuboid;
use rapier3d_immersed::training::fidelity::{Plate, PlateFall};
use rapier3d_immersed::training::{Experiment, Release};
use rapier3d_immersed::{Error, Fluid, HydroProperties, ImmersedBody};
use std::f64::consts::FRAC_PI_2;

const TUMBLING: &str = "Mahadevan, Ryu & Samuel 1999: Ω ∝ d^½ w⁻¹ of cards in air";
const TRANSITION: &str = "Belmonte, Eisenberg & Moses 1998: strips in a cell, Fr = √(M/ρL²w) of fluid density ρ, chord L, span w";

/// Release angles from lying flat, degrees.
const TILTS: [f64; 6] = [15.0, 60.0, 30.0, 5.0, 45.0, 80.0];
/// Thickness and width of the cards, m: each varies while the other stays.
const THICKNESSES: [f64; 5] = [1.5e-4, 2.0e-4, 2.7e-4, 3.6e-4, 4.8e-4];
const WIDTHS: [f64; 5] = [0.014, 0.017, 0.021, 0.026, 0.032];
/// Density of the cards, kg/m³; their length is so many widths.
const CARD: f64 = 1000.0;
const SLENDER: f64 = 12.0;
/// Strips of steel in water: density, kg/m³, chord, m, and span in chords (between walls there are no tips).
const STEEL: f64 = 7850.0;
const CHORD: f64 = 0.025;
const BETWEEN_WALLS: f64 = 30.0;

/// A strip of length, width and thickness, m, that falls with its length level.
fn strip(size: [f64; 3], density: f64, fluid: Fluid, tilt: f64) -> Result<PlateFall, Error> {
    let [half_x, half_y, half_z] = size.map(|x| (0.5 * x) as f32);
    let shape = Cuboid::new(Vector::new(half_x, half_y, half_z));
    let body = ImmersedBody::new(HydroProperties::from_shape(&shape)?);
    let mass = box_mass(size, density * size.iter().product::<f64>(), [0.0; 3]);
    let mut experiment = Experiment::new(body, mass, fluid);
    experiment.release = Release {
        tilt: tilt.to_radians(),
        tilt_axis: FRAC_PI_2,
        ..Release::default()
    };
    experiment.dt = 1.0 / 480.0;
    experiment.seconds = 6.0;
    // How the fall of a plate is measured does not depend on which plate it is.
    let plate = Plate::new(size[2] / size[1], Regime::PeriodicTumbling)?;
    Ok(plate.measure(&experiment.run()?))
}

/// Exponent p of y ∝ xᵖ by least squares of the logarithms; `None` of fewer than three points.
fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let count = points.len() as f64;
    let logs = || points.iter().map(|(x, y)| (x.ln(), y.ln()));
    let (x, y) = logs().fold((0.0, 0.0), |(x, y), log| (x + log.0, y + log.1));
    let (x, y) = (x / count, y / count);
    let rise: f64 = logs().map(|log| (log.0 - x) * (log.1 - y)).sum();
    let run: f64 = logs().map(|log| (log.0 - x).powi(2)).sum();
    (points.len() > 2).then(|| rise / run)
}

/// The spin of cards of these sizes, of those releases that tumble.
fn spins(cards: &[[f64; 2]], tilts: &[f64]) -> Result<Vec<Option<f64>>, Error> {
    let spin = |[thickness, width]: &[f64; 2]| {
        let size = [SLENDER * width, *width, *thickness];
        let mut tumbling = Vec::new();
        for tilt in tilts {
            let fall = strip(size, CARD, Fluid::AIR, *tilt)?;
            if fall.tumbling > 0.8 {
                tumbling.push(fall.spin);
            }
        }
        let count = tumbling.len();
        Ok((count > 0).then(|| tumbling.iter().sum::<f64>() / count as f64))
    };
    cards.iter().map(spin).collect()
}

/// Share of flips among flips and reversals at a Froude number.
fn flips(froude: f64, tilts: &[f64]) -> Result<f64, Error> {
    let water = Fluid::new(1000.0, 1e-6)?;
    let thickness = froude * froude * CHORD * f64::from(water.density()) / STEEL;
    let size = [BETWEEN_WALLS * CHORD, CHORD, thickness];
    let mut sum = 0.0;
    for tilt in tilts {
        sum += strip(size, STEEL, water, *tilt)?.tumbling;
    }
    Ok(sum / tilts.len() as f64)
}

pub fn compute(effort: Effort, progress: Progress) -> Result<Computed, Failure> {
    let tilts = &TILTS[..effort.choose(6, 2)];
    let mut rows = Vec::new();
    let (width, thickness) = (WIDTHS[2], THICKNESSES[2]);
    for (index, (what, cards, slope)) in [
        ("thickness", THICKNESSES.map(|t| [t, width]), 0.5),
        ("width", WIDTHS.map(|w| [thickness, w]), -1.0),
    ]
    .into_iter()
    .enumerate()
    {
        let spins = spins(&cards, tilts)?;
        let found = cards.iter().zip(&spins);
        let points: Vec<(f64, f64)> = found
            .filter_map(|(card, spin)| spin.map(|spin| (card[index], spin)))
            .collect();
        let case = format!("cards that tumble, exponent of the spin by {what}");
        let range = [slope - 0.1, slope + 0.1];
        rows.push(Row::within(case, range, exponent(&points), TUMBLING));
        progress((index + 1) as f64 / 3.0);
    }
    let froudes =
        (0..effort.choose(21, 11)).map(|i| 0.3 + f64::from(i) * effort.choose(0.04, 0.08));
    let mut before: Option<(f64, f64)> = None;
    let mut crossing = None;
    for froude in froudes {
        let share = flips(froude, tilts)?;
        if let Some((froude_0, share_0)) = before
            && share_0 < 0.5
            && share >= 0.5
            && crossing.is_none()
        {
            crossing = Some(froude_0 + (froude - froude_0) * (0.5 - share_0) / (share - share_0));
        }
        before = Some((froude, share));
    }
    let case = "strips between flutter and tumbling, Froude number";
    rows.push(Row::within(case, [0.62, 0.72], crossing, TRANSITION));
    progress(1.0);
    Ok((rows, Vec::new()))
}
