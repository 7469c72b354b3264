//! A vessel adrift in a random sea: what it does, and what of the waves it follows.

use crate::righting::Vessel;
use crate::support::{Quat, Vec3, scene::pose_parts};
use rapier3d_immersed::free_surface::{Sea, WaveSpectrum, Waves};
use rapier3d_immersed::rapier3d::na::Vector6;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Error, Fluid, Medium};
use rustfft::{FftPlanner, num_complex::Complex64};
use std::f64::consts::TAU;

/// Steps per second, and those between two samples.
const HERTZ: f32 = 60.0;
const EVERY: usize = 6;

/// A voyage that is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Voyage {
    /// Significant height of the waves, m.
    pub height: f64,
    /// Their peak's period, s.
    pub period: f64,
    /// Seed of the sea.
    pub seed: u64,
    /// Angle between bow and the waves' way at first, rad.
    pub heading: f64,
    /// How long, s.
    pub seconds: f64,
}

/// What was recorded, ten times a second, and the periods that the vessel has by itself.
#[derive(Clone, Debug, Default)]
pub struct Record {
    pub times: Vec<f64>,
    /// Of the sea where the vessel is, m.
    pub elevation: Vec<f64>,
    /// Height of the center of mass over its mean, m.
    pub heave: Vec<f64>,
    /// Heel to starboard and rise of the bow, rad.
    pub roll: Vec<f64>,
    pub pitch: Vec<f64>,
    pub poses: Vec<(Vec3, Quat)>,
    /// Largest share of the volume that was under water, and the smallest.
    pub submerged: [f64; 2],
    /// Periods of heave and roll in still water, of stiffness over mass and added mass, s.
    pub periods: [f64; 2],
    /// Wall time of a step, µs.
    pub step: f64,
}

impl Voyage {
    /// The sea.
    ///
    /// # Errors
    /// Those of [`Waves::sea`] and the spectrum.
    pub fn sea(&self) -> Result<Waves, Error> {
        let spectrum = WaveSpectrum::jonswap(self.height, self.period, 3.3)?;
        Waves::sea(&Sea {
            spectrum,
            seed: self.seed,
            ..Sea::default()
        })
    }

    /// Lets a vessel drift; what it does in the first 30 s is not recorded.
    ///
    /// # Errors
    /// Those of [`Voyage::sea`].
    pub fn record(&self, vessel: &Vessel) -> Result<Record, Error> {
        let mut record = Record {
            submerged: [0.0, 1.0],
            periods: periods(vessel),
            ..Record::default()
        };
        let medium = Medium::layered(Fluid::AIR, Fluid::WATER).with_surface(self.sea()?);
        let pose = Pose::new(Vector::ZERO, Vector::Y * self.heading as f32);
        let mut afloat = vessel.afloat(medium, pose, 1.0 / HERTZ);
        let settling = 30 * HERTZ as usize;
        let steps = settling + (self.seconds * f64::from(HERTZ)) as usize;
        let start = std::time::Instant::now();
        for step in 1..=steps {
            afloat.step();
            if step < settling || step % EVERY > 0 {
                continue;
            }
            let body = afloat.body();
            let center = body.center_of_mass();
            let time = afloat.immersion.time();
            let surface = afloat.immersion.medium().surface();
            let elevation = surface.elevation(center.x.into(), center.z.into(), time);
            record.times.push(time);
            record.elevation.push(elevation.height);
            record.heave.push(center.y.into());
            let starboard = body.rotation() * Vector::Z;
            let bow = body.rotation() * Vector::X;
            record
                .roll
                .push(f64::from(-starboard.y).atan2((body.rotation() * Vector::Y).y.into()));
            record.pitch.push(f64::from(bow.y.clamp(-1.0, 1.0)).asin());
            record.poses.push(pose_parts(body.position()));
            let floats = afloat
                .immersion
                .hydrostatics(&afloat.world.bodies, afloat.body);
            let share = floats.map_or(f64::NAN, |floats| floats.submerged_share);
            record.submerged[0] = record.submerged[0].max(share);
            record.submerged[1] = record.submerged[1].min(share);
        }
        record.step = 1e6 * start.elapsed().as_secs_f64() / steps as f64;
        let mean = record.heave.iter().sum::<f64>() / record.heave.len().max(1) as f64;
        record.heave.iter_mut().for_each(|y| *y -= mean);
        Ok(record)
    }
}

/// Periods of heave and roll in still water, s: stiffness ρ g A_w and m g GM over mass and added mass that the crate reads out.
fn periods(vessel: &Vessel) -> [f64; 2] {
    let medium = Medium::layered(Fluid::AIR, Fluid::WATER);
    let mut afloat = vessel.afloat(medium, Pose::IDENTITY, 1.0 / HERTZ);
    afloat.step();
    let (bodies, body) = (&afloat.world.bodies, afloat.body);
    let floats = afloat.immersion.hydrostatics(bodies, body);
    let mass = afloat.immersion.mass_matrix_of(body);
    let (Some(floats), Some(mass)) = (floats, mass) else {
        return [f64::NAN; 2];
    };
    let center = afloat.body().center_of_mass();
    let buoyancy = f64::from(floats.center_of_buoyancy.y - center.y);
    let weight = 9.81 * vessel.dry.mass;
    let stiffness = [
        9.81 * f64::from(Fluid::WATER.density()) * floats.waterplane_area,
        weight * (floats.metacentric_radii[0] + buoyancy),
    ];
    let inverse = mass.try_inverse().unwrap_or_default();
    let unit = |axis: usize| Vector6::ith(axis, 1.0);
    let mobility = [1, 3].map(|axis| unit(axis).dot(&(inverse * unit(axis))));
    [0, 1].map(|i| TAU / (stiffness[i] * mobility[i]).sqrt())
}

/// Four standard deviations: the significant value from trough to crest.
pub fn significant(series: &[f64]) -> f64 {
    let count = series.len().max(1) as f64;
    let mean = series.iter().sum::<f64>() / count;
    let square = series.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
    4.0 * square.sqrt()
}

/// How much of a cause there is in an effect, by frequency (Hz): |S_xy|/S_xx of overlapping pieces of 51.2 s under Hann's
/// window, where the cause has at least a fiftieth of its peak.
pub fn response(cause: &[f64], effect: &[f64]) -> Vec<(f64, f64)> {
    const PIECE: usize = 512;
    const BAND: usize = 2;
    let plan = FftPlanner::new().plan_fft_forward(PIECE);
    let transformed = |series: &[f64]| {
        let sample = |(i, x): (usize, &f64)| {
            let window = 0.5 - 0.5 * (TAU * i as f64 / PIECE as f64).cos();
            Complex64::new(x * window, 0.0)
        };
        let mut piece: Vec<_> = series.iter().enumerate().map(sample).collect();
        plan.process(&mut piece);
        piece
    };
    let bands = PIECE / 2 / BAND;
    let mut power = vec![0.0; bands];
    let mut cross = vec![Complex64::new(0.0, 0.0); bands];
    let starts = (0..).map(|i| i * PIECE / 2);
    for start in starts.take_while(|start| start + PIECE <= cause.len()) {
        let [x, y] = [cause, effect].map(|series| transformed(&series[start..start + PIECE]));
        for (i, (x, y)) in x.iter().zip(&y).enumerate().take(bands * BAND) {
            power[i / BAND] += x.norm_sqr();
            cross[i / BAND] += x.conj() * y;
        }
    }
    let peak = power.iter().fold(0.0, |a: f64, b| a.max(*b));
    let hertz = f64::from(HERTZ) / EVERY as f64;
    let band = |i: usize| {
        let frequency = (i as f64 + 0.5 - 0.5 / BAND as f64) * BAND as f64 * hertz / PIECE as f64;
        (frequency, cross[i].norm() / power[i])
    };
    (1..bands)
        .filter(|i| power[*i] > 0.02 * peak)
        .map(band)
        .collect()
}
