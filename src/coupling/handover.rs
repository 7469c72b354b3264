//! How the motion that the crate integrated is handed to rapier.
//!
//! Rapier's solver takes n substeps of h = dt/n. In each it first adds `F h/m_s` to the velocity and
//! then moves the body by the new velocity. A constant force that makes up the difference Δ of the
//! velocities therefore moves the body by `v₀ + Δ(n+1)/2n` on average, not by the mean velocity:
//! the velocity is right but the pose runs ahead by Δ·dt/2n.
//!
//! A **free** body gets both right: its velocity is first set to `v₁ − Δ'` with `Δ' = (v₁ − v̄)·2n/(n−1)`,
//! so that after the force both the last velocity v₁ and the mean velocity v̄ are those that were
//! integrated. The same holds for the rotation, where the product of rapier's n small (Cayley)
//! rotations is matched to 2·10⁻⁶ rad; what is left is made up for in the next step, because the
//! attitude that the crate integrates is kept.
//!
//! A body in **contact** or held by a joint gets a force alone, since setting velocities would keep a
//! pile from coming to rest.

use super::kind::Kind;
use rapier3d::math::{Real, Rotation, Vector};

/// What rapier's body had, what it shall have.
pub(super) struct Target {
    /// Time step, s, and rapier's number of substeps.
    pub dt: Real,
    pub substeps: usize,
    /// Plate axes to world, now and at the end of the step.
    pub attitude: Rotation,
    pub end_attitude: Rotation,
    /// Velocities now.
    pub linear: Vector,
    pub angular: Vector,
    /// Velocities at the end of the step.
    pub end_linear: Vector,
    pub end_angular: Vector,
    /// Displacement of the center of mass over the step.
    pub displacement: Vector,
    /// Mass that rapier's solver uses.
    pub solver_mass: Real,
}

/// What rapier's body is given before the step.
pub(super) struct Handover {
    /// Velocities to start from; `None` leaves the body's own.
    pub start: Option<(Vector, Vector)>,
    /// Total force, without subtracting what rapier adds by itself, N.
    pub force: Vector,
    /// Torque, N·m.
    pub torque: Vector,
}

impl Target {
    /// Velocity and pose exact: for bodies that touch nothing.
    pub fn free(&self, kind: &Kind) -> Handover {
        if self.substeps < 2 {
            return self.by_force(kind);
        }
        let n = self.substeps as Real;
        let gain = 2.0 * n / (n - 1.0);
        let mean = self.displacement / self.dt;
        let push = (self.end_linear - mean) * gain;

        // Mean angular velocity whose Cayley steps turn the body as far. Rotations about an axis
        // that turns do not commute; what that leaves, to first order the Magnus expansion's second
        // term, is found by trying.
        let turn = self.end_attitude * self.attitude.inverse();
        let mut spin = cayley_rate(turn, n, self.dt);
        let mut twist = (self.end_angular - spin) * gain;
        let mut left = (twist.cross(spin) * (self.dt * self.dt / 12.0)).length();
        let mut tries = 0;
        while left > TURN_TOLERANCE && tries < 6 {
            let missing = turn * self.turned(spin, twist).inverse();
            let missing = cayley_rate(missing, n, self.dt);
            // Inverse left Jacobian of the rotation: what to add to its vector so that the product
            // changes by `missing`.
            let angle = spin * self.dt;
            let across = angle.cross(missing);
            let correction = missing - across * 0.5 + angle.cross(across) / 12.0;
            spin += correction;
            twist = (self.end_angular - spin) * gain;
            left = correction.length() * self.dt;
            tries += 1;
        }
        Handover {
            start: Some((self.end_linear - push, self.end_angular - twist)),
            force: push * (self.solver_mass / self.dt),
            torque: self.torque(kind, twist),
        }
    }

    /// Velocity exact, by a force alone: for bodies in contact.
    pub fn by_force(&self, kind: &Kind) -> Handover {
        Handover {
            start: None,
            force: (self.end_linear - self.linear) * (self.solver_mass / self.dt),
            torque: self.torque(kind, self.end_angular - self.angular),
        }
    }

    /// How rapier's substeps turn a body that reaches `end_angular` by a constant twist, with mean
    /// angular velocity `spin`.
    fn turned(&self, spin: Vector, twist: Vector) -> Rotation {
        let n = self.substeps as Real;
        let half_step = 0.5 * self.dt / n;
        let mut turned = Rotation::IDENTITY;
        for k in 1..=self.substeps {
            let share = k as Real / n - (n + 1.0) / (2.0 * n);
            let a = (spin + twist * share) * half_step;
            turned = (Rotation::from_xyzw(a.x, a.y, a.z, 1.0) * turned).normalize();
        }
        turned
    }

    /// The torque that changes rapier's angular velocity by `change` over the step.
    fn torque(&self, kind: &Kind, change: Vector) -> Vector {
        let c = self.attitude.inverse() * change;
        let [x, y, z] = kind
            .rotational_inertia
            .map(|row| row[0] * c.x + row[1] * c.y + row[2] * c.z);
        self.attitude * Vector::new(x, y, z) / self.dt
    }
}

/// Angle, rad, by which rapier's attitude may miss the integrated one after a step.
const TURN_TOLERANCE: Real = 2e-6;

/// Angular velocity that, kept up over `n` of rapier's Cayley steps in `dt`, makes the rotation
/// `turn`.
fn cayley_rate(turn: Rotation, n: Real, dt: Real) -> Vector {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let axis = Vector::new(turn.x, turn.y, turn.z);
    let sine = axis.length();
    if sine < 1e-12 {
        return Vector::ZERO;
    }
    let half_angle = sine.atan2(turn.w);
    axis * (2.0 * n * (half_angle / n).tan() / (dt * sine))
}
