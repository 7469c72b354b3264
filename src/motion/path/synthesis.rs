//! From a body and a fluid to a fall (thesis § 3.4, § 3.6).

use super::amplitude::normals;
use super::chain::calmed;
use super::database::TrajectoryDatabase;
use super::drift::Drifts;
use super::params::SynthesisParams;
use super::piece::{Instant, Units};
use super::track::{Key, MotionPath};
use crate::error::Error;
use crate::math;
use crate::math::{to_real, to_rotation};
use crate::motion::{DimensionlessNumbers, MotionGraph, Regime};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use rapier3d::math::Real;
use rapier3d::na::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use std::f64::consts::PI;
use std::sync::Arc;

/// Makes falls of one body in one fluid, each from a seed.
///
/// ```
/// use rapier3d_immersed::Fluid;
/// use rapier3d_immersed::motion::path::{SynthesisParams, Synthesizer, TrajectoryDatabase};
/// use rapier3d_immersed::motion::{DimensionlessNumbers, Outline, Regime};
///
/// // A leaf of 7.3 × 4.2 × 0.03 cm that flutters, from 3 m.
/// let numbers = DimensionlessNumbers::new(Outline::Round, 0.042, 3e-4, 400.0, &Fluid::AIR, 9.81)?;
/// let params = SynthesisParams {
///     height: 3.0,
///     main: Some(Regime::PeriodicFlutter),
///     ..SynthesisParams::default()
/// };
/// let leaf = Synthesizer::new(&numbers, 0.073, TrajectoryDatabase::shipped(), params)?;
/// let path = leaf.path(1);
/// assert!((f64::from(path.duration()) - 3.0 / leaf.descent()).abs() < 0.01);
/// let end = path.at(path.duration());
/// assert!((end.position.y + 3.0).abs() < 1e-3);
/// assert_ne!(path, leaf.path(2)); // every seed gives another fall
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Synthesizer {
    pub(super) database: Arc<TrajectoryDatabase>,
    pub(super) params: SynthesisParams,
    pub(super) graph: MotionGraph,
    pub(super) main: Regime,
    pub(super) units: Units,
    /// L/a.
    pub(super) aspect: f64,
    /// Ω, rad/s, and amplitude, m.
    pub(super) frequency: f64,
    pub(super) amplitude: f64,
}

/// Where one motion is spliced to another, and what that has to hide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splice {
    /// The regimes before and after.
    pub regimes: [Regime; 2],
    /// Jump of the velocity, m/s, the derivative of the position.
    pub velocity: f64,
    /// Jump of the attitude, rad.
    pub angle: f64,
}

/// Keyframes that a path may have.
const MOST_KEYS: f64 = 1e6;

impl Synthesizer {
    /// A synthesizer for a body with these numbers and a longest extent of `length` m (the thesis's L; its a
    /// is the numbers' chord).
    ///
    /// # Errors
    /// Those of [`SynthesisParams::check`]; [`Error::InvalidParameter`] if the length is not positive or
    /// the body does not sink; [`Error::OutOfRange`] if the fall would take more than a million
    /// keyframes.
    pub fn new(
        numbers: &DimensionlessNumbers,
        length: f64,
        database: Arc<TrajectoryDatabase>,
        params: SynthesisParams,
    ) -> Result<Self, Error> {
        params.check()?;
        Error::check_positive("length", length)?;
        let ratio = numbers.density_ratio;
        Error::check("density ratio", ratio, ratio > 1.0, "above 1")?;
        let descent = Error::check_positive("u0", numbers.u0)?;
        let chord = Error::check_positive("chord", numbers.length)?;
        let thickness = Error::check_positive("thickness", numbers.thickness)?;
        let keys = params.height / descent / params.interval;
        Error::check_range("keyframes", keys, 0.0, MOST_KEYS)?;
        let main = params
            .main
            .unwrap_or_else(|| params.diagram.regime_of(numbers));
        let aspect = length / chord;
        let frequency = params.frequency * descent / chord;
        let possible: Vec<bool> = Regime::ALL.iter().map(|r| *r <= main).collect();
        let graph = match &params.graph {
            Some(graph) => graph.clone(),
            None => MotionGraph::free_fall(main),
        };
        let strength = params.wind / (params.calming_wind * descent);
        Ok(Self {
            database,
            graph: calmed(&graph, math::exp(-strength * strength))?.restricted(&possible)?,
            main,
            units: Units {
                length: chord,
                descent,
                // U² = (ρ_s/ρ_f − 1) g t, and gravity less buoyancy is (1 − ρ_f/ρ_s) g.
                weight: descent * descent / (thickness * ratio),
            },
            aspect,
            frequency,
            amplitude: params.swing * aspect * descent / frequency,
            params,
        })
    }

    /// The regime in which falls end that are high enough.
    pub fn main(&self) -> Regime {
        self.main
    }

    /// The graph that is followed: without regimes beyond the main one, and with less tumbling in wind.
    pub fn graph(&self) -> &MotionGraph {
        &self.graph
    }

    /// U, m/s: mean speed of descent.
    pub fn descent(&self) -> f64 {
        self.units.descent
    }

    /// Amplitude of a regular flutter, and radius of a spiral, m.
    pub fn amplitude(&self) -> f64 {
        self.amplitude
    }

    /// A fall whose regimes the Markov chain draws, one transition per turning point. The same seed
    /// gives the same fall.
    ///
    /// It takes h/U and lands at a turning point, at (r, −h, s), r and s drawn from the
    /// [`Deviation`](super::Deviation)s of its regimes, each for its share of the time. Whoever places it in
    /// the world turns it about the vertical.
    pub fn path(&self, seed: u64) -> MotionPath {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        self.fall(&mut random, self.chain())
    }

    /// The splices of [`path`](Self::path) with the same seed between one regime and the next: what each has
    /// to hide.
    pub fn splices(&self, seed: u64) -> Vec<Splice> {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let levels = self.levels(self.duration(), self.chain(), &mut random);
        let pieces = self.splice(&levels, &mut random);
        let changes = pieces.windows(2).filter(|p| p[0].regime != p[1].regime);
        changes
            .map(|pair| {
                let (velocity, angle) = pair[1].jump();
                Splice {
                    regimes: [pair[0].regime, pair[1].regime],
                    velocity,
                    angle,
                }
            })
            .collect()
    }

    /// Draws regime after regime.
    fn chain(&self) -> impl FnMut(f64, &mut Pcg64Mcg) -> (Regime, f64) {
        let mut state: Option<usize> = None;
        move |_, random| {
            let next = match state {
                None => self.graph.draw_start(random),
                Some(state) => self.graph.draw_next(state, random),
            };
            state = Some(next);
            (Regime::ALL[next], f64::INFINITY)
        }
    }

    /// A fall of chosen regimes, each for an equal share of the time; a short fall does not come to the
    /// last ones.
    ///
    /// ```
    /// # use rapier3d_immersed::Fluid;
    /// # use rapier3d_immersed::motion::path::{SynthesisParams, Synthesizer, TrajectoryDatabase};
    /// # use rapier3d_immersed::motion::{DimensionlessNumbers, Outline, Regime};
    /// # let numbers = DimensionlessNumbers::new(Outline::Round, 0.042, 3e-4, 400.0, &Fluid::AIR, 9.81)?;
    /// # let params = SynthesisParams { height: 3.0, ..SynthesisParams::default() };
    /// # let leaf = Synthesizer::new(&numbers, 0.073, TrajectoryDatabase::shipped(), params)?;
    /// let regimes = [Regime::PeriodicFlutter, Regime::PeriodicTumbling];
    /// assert_eq!(leaf.path_through(&regimes, 1)?.sequence(), regimes);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::WrongLength`] if there is no regime.
    pub fn path_through(&self, regimes: &[Regime], seed: u64) -> Result<MotionPath, Error> {
        let Some(last) = regimes.last() else {
            return Err(Error::WrongLength {
                what: "regimes of the fall",
                expected: 1,
                actual: 0,
            });
        };
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let share = self.duration() / regimes.len() as f64;
        Ok(self.fall(&mut random, |time, _| {
            // The change of regime lies at the turning point that is nearest to the boundary of a share.
            let index = ((time + 0.25 * PI / self.frequency) / share) as usize;
            (
                *regimes.get(index).unwrap_or(last),
                (index + 1) as f64 * share,
            )
        }))
    }

    /// How fast each regime drifts, relative to the fastest: as far as it deviates.
    fn drift_speeds(&self) -> [f64; 6] {
        // Something has to take up what is missing to the landing where nothing deviates.
        const SLOWEST: f64 = 1e-3;
        let means = self.params.deviations.map(|d| d.distance(1.0, 1.0));
        let most = means.into_iter().fold(0.0, f64::max);
        means.map(|mean| match most > 0.0 {
            true => (mean / most).max(SLOWEST),
            false => 1.0,
        })
    }

    /// Time of a fall, s: h/U.
    fn duration(&self) -> f64 {
        self.params.height / self.units.descent
    }

    fn fall(
        &self,
        random: &mut Pcg64Mcg,
        regime: impl FnMut(f64, &mut Pcg64Mcg) -> (Regime, f64),
    ) -> MotionPath {
        let duration = self.duration();
        let levels = self.levels(duration, regime, random);
        let pieces = self.splice(&levels, random);
        let blend = self.params.blend * PI / self.frequency;
        let normal = normals(random);
        let landings = self
            .params
            .deviations
            .map(|d| d.landing(self.aspect, self.params.height, normal));
        let [along, across] = [0, 1].map(|axis| {
            let speeds = landings.map(|landing| landing[axis] / duration);
            Drifts::of(&pieces, blend, speeds).until(duration).0
        });
        let drifts = Drifts::of(&pieces, blend, self.drift_speeds());
        let landing = Vector3::new(along, -self.params.height, across);
        let at = |time: f64| {
            let after = pieces.partition_point(|piece| piece.start <= time);
            let piece = &pieces[after.max(1) - 1];
            piece.at(time - piece.start, &self.units)
        };
        // The distance that is missing to the landing is spread over the fall; its height is only rounding.
        let drift = (landing - at(duration).position) / drifts.until(duration).0;
        let count = (duration / self.params.interval).ceil().max(1.0);
        let interval = duration / count;
        // This turns plate axes (long axis x, normal z) into the glide plane's (long axis z, normal y).
        let axes = Matrix3::from_columns(&[Vector3::z(), Vector3::x(), Vector3::y()]);
        let axes = Rotation3::from_matrix_unchecked(axes);
        let axes = UnitQuaternion::from_rotation_matrix(&axes);
        let keys = (0..=count as usize).map(|i| {
            let time = i as f64 * interval;
            let Instant {
                position,
                velocity,
                attitude,
            } = at(time);
            let (drifted, share) = drifts.until(time);
            Key {
                position: to_real(position + drift * drifted),
                velocity: to_real(velocity + drift * share),
                attitude: to_rotation(attitude * axes),
            }
        });
        let mut regimes: Vec<(Real, Regime)> = Vec::new();
        for piece in &pieces {
            if piece.start < duration && regimes.last().is_none_or(|(_, r)| *r != piece.regime) {
                regimes.push((piece.start as Real, piece.regime));
            }
        }
        MotionPath::new(interval as Real, keys.collect(), regimes)
            .expect("finite parameters give finite keys")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fluid::Fluid;
    use crate::motion::Outline;
    use crate::motion::path::Deviation;
    use crate::motion::path::motion_classes;

    /// A leaf like the thesis's: 7.3 × 4.2 cm, 0.3 mm, 400 kg/m³.
    fn leaf(params: SynthesisParams) -> Synthesizer {
        let numbers =
            DimensionlessNumbers::new(Outline::Round, 0.042, 0.0003, 400.0, &Fluid::AIR, 9.81)
                .unwrap();
        Synthesizer::new(&numbers, 0.073, TrajectoryDatabase::shipped(), params).unwrap()
    }

    #[test]
    fn the_same_seed_gives_the_same_fall() {
        let leaf = leaf(SynthesisParams::default());
        assert_eq!(leaf.path(7), leaf.path(7));
        assert_ne!(leaf.path(7), leaf.path(8));
    }

    /// Everything between keyframes is what the velocities say, for every motion class: positions follow
    /// their velocities to second order (acceleration · interval²/12), and no attitude jumps.
    #[test]
    fn every_class_can_be_generated_and_is_smooth() {
        let leaf = leaf(SynthesisParams {
            height: 6.0,
            main: Some(Regime::PeriodicSpiral),
            interval: 1.0 / 480.0,
            ..SynthesisParams::default()
        });
        let classes = motion_classes(Regime::PeriodicSpiral);
        assert_eq!(classes.len(), 63);
        for (seed, class) in classes.iter().enumerate() {
            let path = leaf.path_through(class, seed as u64).unwrap();
            assert_eq!(&path.sequence(), class);
            let h = path.interval();
            for pair in path.keys().windows(2) {
                let mean = (pair[0].velocity + pair[1].velocity) * 0.5;
                let jump = (pair[1].position - pair[0].position - mean * h).length();
                // The tolerance is one percent of the smaller extent.
                assert!(jump < 0.00042, "{class:?} {jump}");
            }
        }
    }

    /// A steady fall that deviates a tenth as far as a flutter drifts a tenth as far, and a fall of both
    /// drifts in its second half: velocities are derivatives there too (the test above).
    #[test]
    fn steady_descent_hardly_drifts() {
        let leaf = leaf(SynthesisParams {
            deviations: Regime::ALL.map(|regime| Deviation {
                coefficient: match regime {
                    Regime::SteadyDescent => 0.1,
                    _ => 1.0,
                },
                mean: 0.3,
                width: 0.0,
                across: 0.0,
            }),
            main: Some(Regime::PeriodicFlutter),
            ..SynthesisParams::default()
        });
        let at = |regimes: &[Regime], share: f32| {
            let path = leaf.path_through(regimes, 1).unwrap();
            path.at(path.duration() * share).position.x
        };
        let (sd, pf) = (Regime::SteadyDescent, Regime::PeriodicFlutter);
        let landing = 0.3 * 0.073 / 0.042 * 2.0;
        assert!((at(&[pf], 1.0) - landing).abs() < 1e-5);
        assert!((at(&[sd], 1.0) - 0.1 * landing).abs() < 1e-5);
        let half = at(&[sd, pf], 0.5);
        // The regimes change at the turning point nearest to the middle, an eighth of a second away.
        assert!(half.abs() < 0.15 * landing, "{half}");
    }

    #[test]
    fn impossible_requests_are_refused() {
        let numbers =
            DimensionlessNumbers::new(Outline::Round, 0.042, 0.0003, 400.0, &Fluid::AIR, 9.81)
                .unwrap();
        let refused = |change: &dyn Fn(&mut SynthesisParams)| {
            let mut params = SynthesisParams::default();
            change(&mut params);
            let database = TrajectoryDatabase::shipped();
            assert!(Synthesizer::new(&numbers, 0.073, database, params).is_err());
        };
        refused(&|p| p.height = 0.0);
        refused(&|p| p.height = f64::NAN);
        refused(&|p| p.height = 1e9);
        refused(&|p| p.graph = Some(MotionGraph::thesis()));
        refused(&|p| p.deviations[3].width = -1.0);
        refused(&|p| p.interval = 0.0);
        refused(&|p| p.wind = f64::INFINITY);
        let light =
            DimensionlessNumbers::new(Outline::Round, 0.04, 3e-4, 400.0, &Fluid::WATER, 9.81)
                .unwrap();
        let params = SynthesisParams::default();
        let database = TrajectoryDatabase::shipped();
        assert!(Synthesizer::new(&light, 0.073, database, params).is_err());
        assert!(
            leaf(SynthesisParams::default())
                .path_through(&[], 1)
                .is_err()
        );
    }
}
