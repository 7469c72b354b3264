//! Inertia of a body and of the fluids that it is in, and what its change does to the velocity.
//!
//! While a body goes under its added mass grows from 𝕄₀ to 𝕄₁ = 𝕄₀ + D. Of what it does to the velocity
//! three things are known:
//!
//! * A fast entry is an impact: the momentum stays, `𝕄₁ν₁ = 𝕄₀ν₀`, and half of the energy that the fluid would have
//!   goes into spray (von Kármán 1929).
//! * A fast exit leaves the fluid behind: ν₁ = ν₀.
//! * In between, as where a ship heaves, nothing splashes and the energy stays: the force is ½ν·𝕄'ν.
//!
//! All three are `(𝕄̄ + ½cD) Δν = −cDν₀` with the mean mass 𝕄̄ = ½(𝕄₀ + 𝕄₁) and c = 1, 0 and ½ (the last to the
//! third order in D). c goes from ½ to 1 or 0 with the Froude number of the crossing, its speed over √(g × the body's
//! height).

use crate::hydro::AddedMass;
use crate::math::spatial::{Blocks, Twist, Wrench};
use rapier3d::na::{Matrix3, Matrix6, Rotation3, Vector3};

/// Froude numbers of a crossing up to which the energy stays, and from which it is an impact.
const SLOW: f64 = 0.25;
const FAST: f64 = 1.0;

/// Inertia about the center of mass: plate axes, kg, kg·m, kg·m².
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(crate) struct FluidMass {
    pub linear: Matrix3<f64>,
    pub coupling: Matrix3<f64>,
    pub angular: Matrix3<f64>,
}

impl FluidMass {
    /// That of the body alone.
    pub fn dry(mass: f64, inertia: Matrix3<f64>) -> Self {
        Self {
            linear: Matrix3::from_diagonal_element(mass),
            coupling: Matrix3::zeros(),
            angular: inertia,
        }
    }

    /// Adds an added mass per unit density about a point, times `density`.
    pub fn add(&mut self, added: &AddedMass, density: f64, point: Vector3<f64>) {
        let about = added.about(-point);
        self.linear += about.linear * density;
        self.coupling += about.coupling * density;
        self.angular += about.angular * density;
    }

    /// As the 6×6 matrix of an integrator with these scales.
    pub fn scaled(&self, mass: f64, length: f64) -> Self {
        Self {
            linear: self.linear / mass,
            coupling: self.coupling / (mass * length),
            angular: self.angular / (mass * length * length),
        }
    }

    fn blocks(&self, factor: f64) -> Blocks<f64> {
        let m12 = self.coupling * factor;
        Blocks {
            m11: self.linear * factor,
            m12,
            m21: m12.transpose(),
            m22: self.angular * factor,
        }
    }

    /// As a 6×6 matrix in other axes, which `axes` maps these to.
    pub fn to_matrix6(self, axes: &Rotation3<f64>) -> Matrix6<f64> {
        AddedMass {
            linear: self.linear,
            coupling: self.coupling,
            angular: self.angular,
        }
        .rotated(axes)
        .to_matrix6()
    }

    /// Momentum and angular momentum at a velocity.
    pub fn momentum(&self, v: &Twist<f64>) -> Wrench<f64> {
        self.blocks(1.0).apply(v)
    }

    /// Kinetic energy at a velocity, J.
    pub fn energy(&self, v: &Twist<f64>) -> f64 {
        let momentum = self.momentum(v);
        0.5 * (momentum.force.dot(&v.linear) + momentum.torque.dot(&v.angular))
    }

    /// Whether no entry is infinite or no number.
    #[cfg(feature = "serde-serialize")]
    pub fn is_finite(&self) -> bool {
        let all = self
            .linear
            .iter()
            .chain(&self.coupling)
            .chain(&self.angular);
        all.into_iter().all(|x| x.is_finite())
    }

    /// The velocity after the inertia has changed from this to `to`, in a crossing of this Froude number.
    pub fn transfer(&self, to: &Self, v: &Twist<f64>, froude: f64) -> Twist<f64> {
        let change = Self {
            linear: to.linear - self.linear,
            coupling: to.coupling - self.coupling,
            angular: to.angular - self.angular,
        };
        let gained = change.energy(v);
        if gained == 0.0 {
            return *v;
        }
        let fast = ((froude - SLOW) / (FAST - SLOW)).clamp(0.0, 1.0);
        let kept = 0.5 * (1.0 + fast * gained.signum());
        // 𝕄̄ + ½cD = 𝕄₀ + ½(1 + c)D.
        let mut system = self.blocks(1.0);
        system.add(&change.blocks(0.5 * (1.0 + kept)));
        let right = change.momentum(v).scaled(-kept);
        let after = v.add_scaled(&system.solve(&right), 1.0);
        // What a change of the energy's third order would add is taken back: nothing gains energy by a crossing.
        let (before, now) = (self.energy(v), to.energy(&after));
        if now > before && before > 0.0 {
            after.scaled((before / now).sqrt())
        } else {
            after
        }
    }
}
