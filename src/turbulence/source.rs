//! Where a body's turbulence comes from.

use super::{KEpsilon, TurbulenceState, TurbulenceTable};
use crate::flow::LogLaw;
use rapier3d::math::{Pose, Real, Vector};
use std::sync::Arc;

/// How strong the turbulence around a body is, at a place and a time: a layer over any mean
/// [`Flow`](crate::flow::Flow).
///
/// ```
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::turbulence::{Turbulence, TurbulenceTable};
/// use std::sync::Arc;
///
/// // The wake of a body 3 cm long that falls at 1 m/s: the table that ships serves every size and speed.
/// let wake = Turbulence::History {
///     table: Arc::new(TurbulenceTable::default_history()),
///     velocity_scale: 1.0,
///     length_scale: 0.03,
/// };
/// let at_release = wake.at(Vector::ZERO, 0.0, 0.0);
/// assert_eq!(at_release.kinetic_energy, 1.5); // 3/2 U₀², thesis (4.20)
/// assert!(wake.at(Vector::ZERO, 1.0, 1.0).kinetic_energy < 0.1);
/// ```
#[derive(Clone, Debug)]
pub enum Turbulence {
    /// The same everywhere and always.
    Homogeneous(TurbulenceState),
    /// It decays without shear from `initial` since the body's release, as the k–ε model does exactly:
    /// k = k₀ [1 + (C₂−1) ε₀t/k₀]^(−1/(C₂−1)).
    Decaying {
        /// The turbulence at the release.
        initial: TurbulenceState,
    },
    /// The equilibrium surface layer under a log-law wind: k = u*²/√C_μ, ε = u*³/(κh).
    SurfaceLayer(LogLaw),
    /// A baked history that starts at the body's release (thesis Fig. 4.2).
    History {
        /// The history, in units of the two scales.
        table: Arc<TurbulenceTable>,
        /// U₀, m/s: the body's mean falling speed, thesis (4.1).
        velocity_scale: Real,
        /// L, m: the body's length.
        length_scale: Real,
    },
    /// A baked field, fixed in the world. A table without a field gives its history.
    Field {
        /// The field, in units of the two scales.
        table: Arc<TurbulenceTable>,
        /// U₀, m/s.
        velocity_scale: Real,
        /// L, m.
        length_scale: Real,
        /// Pose of the field's axes in the world; its stream is along the first of them.
        pose: Pose,
    },
}

/// How turbulence acts on a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LangevinMode {
    /// The velocity of the *fluid* around the body fluctuates, and the body follows as its drag and
    /// added mass let it: a heavy one filters the turbulence, a light one drifts along.
    #[default]
    FluidSeen,
    /// The thesis's way, (4.12)–(4.14): random increments of the *body's* own velocity relative to
    /// the mean flow, and of its spin, whatever its mass, at the beginning of each step: weight, buoyancy and vortical
    /// loads act together after them. The step is exact in the linear velocity, so that statistics do not depend on
    /// dt. The increments relax a falling body's own velocity, too: it falls more slowly than in still fluid, the
    /// thesis's paper by a half. Those of the spin need a law that resists rotation, as all but
    /// [`ViscousLaw::Inviscid`](crate::ViscousLaw::Inviscid) and those as printed do.
    BodyIncrements,
    /// The same increments in the thesis's order (fractional step, §4.3.2): first weight and buoyancy, which lead to
    /// a guess of the velocity; then the increments, of which the relaxation is the guess's; then the vortical loads,
    /// at the velocity that results. What gravity gave is relaxed in the same step: where the increments alone act
    /// on a falling body, its mean velocity is lower than in the other order by `g dt` exactly (`(m − ρV)/(m + ρA) g dt`
    /// in a fluid of weight), so that this is of first order in dt.
    ///
    /// The inertial coupling (Kirchhoff's terms) is solved together with the loads, so that neither it nor they can
    /// add energy at any dt. What touches something, is held by joints or locks, or is cut by a boundary of fluids
    /// moves as under [`BodyIncrements`](Self::BodyIncrements).
    FractionalStep,
}

/// A turbulence over a mean flow, how it acts, and its seed.
///
/// ```
/// use rapier3d_immersed::turbulence::{LangevinMode, Turbulence, TurbulenceState, TurbulentLayer};
/// use rapier3d_immersed::{Fluid, Immersion};
///
/// let state = TurbulenceState::from_intensity(2.0, 0.1, 0.05)?;
/// let layer = TurbulentLayer { seed: 3, ..Turbulence::Homogeneous(state).into() };
/// assert_eq!(layer.mode, LangevinMode::FluidSeen);
/// Immersion::new(Fluid::AIR).set_turbulence(layer);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct TurbulentLayer {
    /// How strong it is, where and when.
    pub source: Turbulence,
    /// How it acts on bodies.
    pub mode: LangevinMode,
    /// Seed of the noise. Each body has a stream of its own, a pure function of seed, handle and
    /// step, which neither order nor threads can change.
    pub seed: u64,
}

impl From<Turbulence> for TurbulentLayer {
    fn from(source: Turbulence) -> Self {
        Self {
            source,
            mode: LangevinMode::default(),
            seed: 0,
        }
    }
}

impl Turbulence {
    /// The turbulence at `point` (world, m) and `time` (s, of the immersion) around a body released
    /// `age` seconds ago.
    pub fn at(&self, point: Vector, time: f64, age: f64) -> TurbulenceState {
        match self {
            Self::Homogeneous(state) => *state,
            Self::Decaying { initial } => {
                let (k, epsilon) = KEpsilon::default().advance(
                    initial.kinetic_energy.into(),
                    initial.dissipation.into(),
                    0.0,
                    age.max(0.0),
                );
                TurbulenceState {
                    kinetic_energy: k as Real,
                    dissipation: epsilon as Real,
                }
            }
            Self::SurfaceLayer(wind) => TurbulenceState {
                kinetic_energy: wind.turbulent_kinetic_energy(),
                dissipation: wind.dissipation(wind.height(point)),
            },
            Self::History {
                table,
                velocity_scale,
                length_scale,
            } => {
                let t = age * f64::from(velocity_scale / length_scale);
                scaled(table.history_at(t), *velocity_scale, *length_scale)
            }
            Self::Field {
                table,
                velocity_scale,
                length_scale,
                pose,
            } => {
                let t = f64::from(velocity_scale / length_scale);
                let state = match table.field() {
                    Some(field) => {
                        let local = pose.inverse_transform_point(point) / *length_scale;
                        field.at(local, time * t)
                    }
                    None => table.history_at(age * t),
                };
                scaled(state, *velocity_scale, *length_scale)
            }
        }
    }
}

/// A state in units of U₀² and U₀³/L, in SI units.
fn scaled(state: TurbulenceState, velocity: Real, length: Real) -> TurbulenceState {
    let velocity2 = velocity * velocity;
    TurbulenceState {
        kinetic_energy: state.kinetic_energy * velocity2,
        dissipation: state.dissipation * velocity2 * velocity / length,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_agree_where_they_must() {
        let initial = TurbulenceState {
            kinetic_energy: 1.0,
            dissipation: 1.0,
        };
        let decaying = Turbulence::Decaying { initial };
        assert_eq!(decaying.at(Vector::ONE, 5.0, 0.0), initial);
        // k0 = ε0 = 1 decays to .32156 within 2 s.
        let later = decaying.at(Vector::ONE, 5.0, 2.0);
        assert!((later.kinetic_energy - 0.32156).abs() < 1.0e-5);
        let wind = LogLaw::new(Vector::X, Vector::Y, 4.0, 10.0, 0.3).unwrap();
        let layer = Turbulence::SurfaceLayer(wind);
        let low = layer.at(Vector::Y, 0.0, 0.0);
        let high = layer.at(Vector::Y * 10.0, 0.0, 0.0);
        assert!((low.dissipation / high.dissipation - 10.0).abs() < 1.0e-4);
        assert!(layer.at(-Vector::Y, 0.0, 0.0).dissipation.is_finite());
    }

    /// A table is one shape for all bodies: k scales as U₀², ε as U₀³/L, time as L/U₀.
    #[test]
    fn history_scales_with_speed_and_length() {
        let table = Arc::new(TurbulenceTable::default_history());
        let history = |velocity_scale, length_scale| Turbulence::History {
            table: table.clone(),
            velocity_scale,
            length_scale,
        };
        let slow = history(1.0, 1.0).at(Vector::ZERO, 0.0, 1.5);
        let fast = history(2.0, 0.1).at(Vector::ZERO, 0.0, 1.5 * 0.1 / 2.0);
        assert!((fast.kinetic_energy / slow.kinetic_energy - 4.0).abs() < 1.0e-4);
        assert!((fast.dissipation / slow.dissipation - 80.0).abs() < 1.0e-2);
    }
}
