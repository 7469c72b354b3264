//! The planner's objective and its exact minimum (thesis (5.27)–(5.29)).
//!
//! The three forces are linear in the control parameters c̃, so that the difference between the change
//! of velocity that they cause in an interval, dE₁ = A c̃, and the one that turbulence asks for, dE₂ = b,
//! is a least-squares problem of three unknowns. A subspace is a union of boxes, and over each box the
//! minimum of a convex quadratic is found exactly by trying which bounds are active: no annealing is
//! needed.

use crate::dynamics::FreeBody;
use crate::flow::FlowSample;
use crate::hydro::viscous::ForceFactors;
use crate::math::to_f64;
use rapier3d::na::{Matrix2, Matrix3, Vector2, Vector3};

/// A box of control parameters: low and high by parameter.
pub type ControlBox = [[f64; 2]; 3];

/// The planner's objective in one interval, ‖A c̃ − b‖² + μ‖c̃ − c̃₀‖².
///
/// ```
/// use rapier3d_immersed::rapier3d::na::{Matrix3, Vector3};
/// use rapier3d_immersed::training::EnergyObjective;
///
/// let objective = EnergyObjective {
///     gains: Matrix3::identity(),
///     target: Vector3::new(0.5, 2.0, 0.5),
///     previous: Vector3::zeros(),
///     inertia: 1e-9,
/// };
/// // Of the unit box, the point nearest to the target lies on a face.
/// let minimum = objective.minimum(&[[[0.0, 1.0]; 3]]).unwrap();
/// assert!((minimum - Vector3::new(0.5, 1.0, 0.5)).norm() < 1e-6);
/// assert!((objective.cost(&minimum) - 1.0).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyObjective {
    /// A: change of velocity per unit of each control parameter, m/s, column by column.
    pub gains: Matrix3<f64>,
    /// b: change of velocity that the turbulence asks for, m/s.
    pub target: Vector3<f64>,
    /// c̃₀: the parameters before.
    pub previous: Vector3<f64>,
    /// μ, (m/s)². Where the flow leaves a parameter undetermined (no lift at α = 0), the tie goes to
    /// the one before.
    pub inertia: f64,
}

/// μ over the mean diagonal of AᵀA: large enough for a unique minimum in f64, small enough not to matter.
const TIE: f64 = 1e-6;

impl EnergyObjective {
    /// The objective at the state of `body` over the next `interval` seconds, in a fluid that moves with `flow`;
    /// velocities below are relative to it. As in the thesis the
    /// forces are those at the *intermediate* velocity X*, after the interval without viscous forces.
    ///
    /// `random` is three standard Gaussian numbers ξ; `kolmogorov` is C_k, `dissipation` ε (m²/s³) and
    /// `frequency` χ = ε/k (1/s) of the turbulence: b = √(C_kε) ξ√τ − ¼(2 + 3C_k) χ u* τ (5.29).
    pub fn at(
        body: &FreeBody,
        gravity: Vector3<f64>,
        flow: &FlowSample,
        interval: f64,
        random: Vector3<f64>,
        [kolmogorov, dissipation, frequency]: [f64; 3],
    ) -> Self {
        let previous = Vector3::from(<[f64; 3]>::from(body.control));
        let mut ahead = body.clone();
        ahead.control = [0.0; 3].into();
        ahead.step_in(interval, gravity, flow);
        let relative = ahead.linear_velocity() - to_f64(flow.velocity);
        // Forces are those in a fluid at rest.
        ahead.set_velocity(relative, ahead.angular_velocity());
        ahead.control = ForceFactors::default();
        let forces = ahead.forces(gravity);
        let gain = |force| to_f64(force) * (interval / body.mass());
        let gains = Matrix3::from_columns(&[
            gain(forces.drag.force),
            gain(forces.rotational_lift.force),
            gain(forces.translational_lift.force),
        ]);
        let diffusion = (kolmogorov * dissipation * interval).sqrt();
        let drift = 0.25 * (2.0 + 3.0 * kolmogorov) * frequency * interval;
        Self {
            gains,
            target: random * diffusion - relative * drift,
            previous,
            inertia: TIE * gains.norm_squared() / 3.0 + f64::MIN_POSITIVE,
        }
    }

    /// The objective at c̃, (m/s)².
    pub fn cost(&self, control: &Vector3<f64>) -> f64 {
        (self.gains * control - self.target).norm_squared()
            + self.inertia * (control - self.previous).norm_squared()
    }

    /// The exact minimum over a union of boxes; `None` if there is no box.
    pub fn minimum(&self, boxes: &[ControlBox]) -> Option<Vector3<f64>> {
        let gram = self.gains.transpose() * self.gains + Matrix3::identity() * self.inertia;
        let rhs = self.gains.transpose() * self.target + self.previous * self.inertia;
        let inverse = gram.try_inverse()?;
        let free = inverse * rhs;
        let free_cost = self.cost(&free);
        // If one parameter is held and the others are free, the objective grows by distance²/(G⁻¹)ᵢᵢ.
        let bound = |cell: &ControlBox| {
            let grow = |i: usize| {
                let away = free[i].clamp(cell[i][0], cell[i][1]) - free[i];
                away * away / inverse[(i, i)]
            };
            free_cost + grow(0).max(grow(1)).max(grow(2))
        };
        let mut best: Option<(f64, Vector3<f64>)> = None;
        for cell in boxes {
            if best.is_some_and(|(cost, _)| bound(cell) >= cost) {
                continue;
            }
            let candidate = minimum_in(&gram, &rhs, &free, cell);
            let cost = self.cost(&candidate);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, candidate));
            }
        }
        best.map(|(_, control)| control)
    }
}

/// The minimum of ½cᵀGc − rᵀc in a box, G positive definite with the unbounded minimum `free`: the best of
/// the stationary points on the box's inside, faces, edges and corners that lie in the box.
fn minimum_in(
    gram: &Matrix3<f64>,
    rhs: &Vector3<f64>,
    free: &Vector3<f64>,
    cell: &ControlBox,
) -> Vector3<f64> {
    let inside = |i: usize, x: f64| x >= cell[i][0] && x <= cell[i][1];
    if (0..3).all(|i| inside(i, free[i])) {
        return *free;
    }
    let value = |c: &Vector3<f64>| 0.5 * c.dot(&(gram * c)) - rhs.dot(c);
    let mut best = (f64::INFINITY, *free);
    let mut consider = |c: Vector3<f64>| {
        let value = value(&c);
        if value < best.0 {
            best = (value, c);
        }
    };
    for held in 0..3 {
        let (j, k) = ((held + 1) % 3, (held + 2) % 3);
        for bound in cell[held] {
            // On a face two parameters are free.
            let part = Matrix2::new(gram[(j, j)], gram[(j, k)], gram[(j, k)], gram[(k, k)]);
            let r = Vector2::new(
                rhs[j] - gram[(j, held)] * bound,
                rhs[k] - gram[(k, held)] * bound,
            );
            if let Some(inverse) = part.try_inverse() {
                let x = inverse * r;
                if inside(j, x[0]) && inside(k, x[1]) {
                    let mut c = Vector3::zeros();
                    (c[held], c[j], c[k]) = (bound, x[0], x[1]);
                    consider(c);
                }
            }
            // On an edge one parameter is free; clamping it gives the corners.
            for other in cell[j] {
                let x = (rhs[k] - gram[(k, held)] * bound - gram[(k, j)] * other) / gram[(k, k)];
                let mut c = Vector3::zeros();
                (c[held], c[j], c[k]) = (bound, other, x.clamp(cell[k][0], cell[k][1]));
                consider(c);
            }
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    fn objective(random: &mut Pcg64Mcg) -> EnergyObjective {
        let mut number = || random.random_range(-1.0..1.0);
        let gains = Matrix3::from_fn(|_, _| number());
        let target = Vector3::from_fn(|_, _| 2.0 * number());
        EnergyObjective {
            gains,
            target,
            previous: Vector3::repeat(0.5),
            inertia: 1e-6,
        }
    }

    /// The minimum lies in a box, and no point of an even search of every box is better.
    #[test]
    fn nothing_beats_the_minimum() {
        let mut random = Pcg64Mcg::seed_from_u64(2);
        for _ in 0..200 {
            let objective = objective(&mut random);
            let boxes: Vec<ControlBox> = (0..6)
                .map(|_| {
                    [0; 3].map(|_| {
                        let low = random.random_range(0.0..2.0);
                        [low, low + random.random_range(0.1..1.0)]
                    })
                })
                .collect();
            let minimum = objective.minimum(&boxes).unwrap();
            let member = |cell: &ControlBox| {
                (0..3).all(|i| minimum[i] >= cell[i][0] && minimum[i] <= cell[i][1])
            };
            assert!(boxes.iter().any(member));
            let least = objective.cost(&minimum);
            for cell in &boxes {
                for n in 0..1000 {
                    let at = |i: usize, step: i32| {
                        let s = f64::from(step) / 9.0;
                        cell[i][0] * (1.0 - s) + cell[i][1] * s
                    };
                    let c = Vector3::new(at(0, n % 10), at(1, n / 10 % 10), at(2, n / 100));
                    assert!(objective.cost(&c) >= least - 1e-12);
                }
            }
        }
    }

    /// Where a force is absent its parameter does not matter, and keeps its value.
    #[test]
    fn an_undetermined_parameter_stays() {
        let objective = EnergyObjective {
            gains: Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 1.0)),
            target: Vector3::new(0.7, 0.3, 5.0),
            previous: Vector3::new(0.1, 0.9, 0.1),
            inertia: 1e-9,
        };
        let minimum = objective.minimum(&[[[0.0, 2.0]; 3]]).unwrap();
        assert!(
            (minimum - Vector3::new(0.7, 0.9, 2.0)).norm() < 1e-6,
            "{minimum}"
        );
        assert_eq!(objective.minimum(&[]), None);
    }
}
