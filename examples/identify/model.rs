//! What can be identified: motions with unknown parameters, and the columns of their tracks.

use crate::card;
use crate::free_fall::{Law, Specimen};
use crate::support::track::{Table, Track, ascending};
use rapier3d_immersed::rapier3d::na::{UnitQuaternion, Vector3};
use rapier3d_immersed::reduced::FallingPlate;
use rapier3d_immersed::reduced::Tolerances;
use rapier3d_immersed::{Error, Fluid};
use std::f64::consts::FRAC_PI_2;

/// Writes rows at the times for these parameters, as many as fit.
type Simulate = Box<dyn Fn(&[f64], &[f64], &mut [f64])>;
/// Times and rows of data from a table.
type Read = fn(&str) -> Result<(Vec<f64>, Vec<f64>), String>;
/// (low, high) of each parameter.
type Ranges = Box<dyn Fn(&[f64]) -> Vec<(f64, f64)>>;

/// A motion to look for in a track.
pub struct Model {
    /// Of the data that rows of a table become.
    pub columns: &'static [&'static str],
    pub read: Read,
    /// The coefficients of the force come first.
    pub parameters: &'static [&'static str],
    pub coefficients: usize,
    /// Where to look, given the data.
    pub ranges: Ranges,
    pub simulate: Simulate,
    /// Parameters of the track that is made up, and its length, s.
    pub truth: &'static [f64],
    pub seconds: f64,
    /// Columns of the picture of the path (across, up) and of the attitude.
    pub path: [usize; 2],
    pub attitude: &'static [usize],
    pub attitude_title: &'static str,
}

/// The planar plate. Its parameters have no dimensions: lengths are in half chords `length`, m, speeds
/// in `speed`, m/s.
pub fn plate(inertia_ratio: f64, length: f64, speed: f64) -> Model {
    const TOLERANCES: Tolerances = Tolerances {
        relative: 1e-7,
        absolute: 1e-7,
        max_steps: 20_000,
    };
    let simulate = move |p: &[f64], times: &[f64], out: &mut [f64]| {
        let plate = FallingPlate::with_coefficients(inertia_ratio, [p[0], p[1], p[2], p[3], p[4]]);
        let start = [p[5], p[6], p[7], p[8], p[9], p[10]];
        let times = times[..out.len() / 3].iter().map(|t| t * speed / length);
        let states = plate.trajectory(&start, &times.collect::<Vec<_>>(), TOLERANCES);
        for (row, state) in out.chunks_exact_mut(3).zip(states) {
            row.copy_from_slice(&[state[4] * length, state[5] * length, state[3]]);
        }
    };
    let ranges = move |data: &[f64]| {
        let near = |x: f64, width: f64| (x - width, x + width);
        vec![
            (0.4, 2.5),
            (1.0, 6.0),
            (0.7, 2.5),
            (0.3, 2.0),
            (0.05, 0.6),
            near(0.0, 2.0),
            near(0.0, 2.0),
            near(0.0, 1.5),
            near(data[2], 0.3),
            near(data[0] / length, 0.3),
            near(data[1] / length, 0.3),
        ]
    };
    Model {
        columns: &["x", "y", "angle"],
        read: |text| {
            let table = Table::read(text)?;
            let [t, x, y, angle] = table.columns(["t", "x", "y", "angle"])?;
            ascending(&t)?;
            let rows = (0..t.len()).flat_map(|i| [x[i], y[i], angle[i]]);
            let rows = rows.collect();
            Ok((t, rows))
        },
        parameters: &[
            "C_T", "C_R", "A", "B", "mu", "u0", "v0", "omega0", "angle0", "x0", "y0",
        ],
        coefficients: 5,
        ranges: Box::new(ranges),
        simulate: Box::new(simulate),
        truth: &[
            1.2,
            std::f64::consts::PI,
            1.4,
            1.0,
            0.2,
            0.5,
            -0.2,
            0.1,
            0.4,
            0.0,
            0.0,
        ],
        seconds: 20.0 * length / speed,
        path: [0, 1],
        attitude: &[2],
        attitude_title: "angle, rad",
    }
}

/// The card in air under the thesis's law.
///
/// # Errors
/// If its shape or mass cannot be.
pub fn card(semi_axes: [f64; 3], density_ratio: f64) -> Result<Model, Error> {
    let air = Fluid::new(1.2, 1.5e-5)?;
    let specimen = Specimen::new(semi_axes, air, Law::Thesis)?;
    specimen.body(&[1.0, 1.0, 1.0, density_ratio])?;
    let simulate = move |p: &[f64], times: &[f64], out: &mut [f64]| {
        card::simulate(&specimen, density_ratio, p, times, out);
    };
    let read = |text: &str| {
        let track = Track::read(text)?;
        // The vertical is y in a track and z here.
        let upright = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), FRAC_PI_2);
        let rows = track.places.iter().zip(&track.turns);
        let rows = rows
            .flat_map(|(place, turn)| card::measured((upright * place).into(), &(upright * turn)));
        Ok((track.times.clone(), rows.collect()))
    };
    Ok(Model {
        columns: &card::COLUMNS,
        read,
        parameters: &card::PARAMETERS,
        coefficients: 3,
        ranges: Box::new(card::ranges),
        simulate: Box::new(simulate),
        truth: &card::TRUTH,
        seconds: 0.6,
        path: [0, 2],
        attitude: &[6, 7, 8],
        attitude_title: "normal",
    })
}
