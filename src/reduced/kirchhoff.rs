//! A body that falls through an ideal fluid, as a quadratic system.

use super::axis::Axis;
use super::quadratic::{InitialTerm, QuadraticSystem, RateTerm};
use crate::error::Error;
use rapier3d::na::{Matrix3, Matrix6, Vector3};

/// A rigid body in potential flow that falls under its weight and turns as it falls (thesis (6.24), with the general
/// mass matrix, gravity and its torque): a [`QuadraticSystem`] of nine components.
///
/// With 𝕄 the mass of body and fluid about the center of mass and (p, h) = 𝕄 (u, ω), all in body axes,
///
/// ```text
/// ṗ = p × ω + (m − ρV) g γ
/// ḣ = h × ω + p × u − ρV r_b × g γ
/// γ̇ = γ × ω                           |γ| = 1, the direction of gravity
/// ```
///
/// γ is a part of the state: in body axes gravity turns as the body does (Poisson's equation), and with it every
/// term is of second degree. Masses may be in any one unit, such as the displaced mass.
///
/// ```
/// use rapier3d_immersed::rapier3d::na::{Matrix6, Vector3};
/// use rapier3d_immersed::reduced::{Axis, KirchhoffBody, Tolerances};
///
/// // Without a fluid a body falls straight down however it spins: |u| after 1 s from rest is g.
/// let stone = KirchhoffBody { mass: Matrix6::identity(), weight: 1.0, buoyancy: Vector3::zeros() };
/// let system = stone.system(&Axis::spectral(0.0, 2.0, 3)?, Vector3::new(0.0, 0.0, -9.81))?;
/// let end = system.integrate(&[0.0, 0.0, 0.0, 2.0, 1.0, 0.5], 1.0, Tolerances::default()).unwrap();
/// assert!((Vector3::new(end[0], end[1], end[2]).norm() - 9.81).abs() < 1e-6);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KirchhoffBody {
    /// 𝕄 about the center of mass: body and added mass, kg, kg·m and kg·m², linear before angular, body axes.
    pub mass: Matrix6<f64>,
    /// m − ρV, kg: negative if the body rises.
    pub weight: f64,
    /// ρV r_b, kg·m: displaced mass times the way from the center of mass to the center of buoyancy, body axes.
    pub buoyancy: Vector3<f64>,
}

impl KirchhoffBody {
    /// Of a body of this dry mass (kg), inertia about its own axes (kg·m²) and added masses about the center of volume,
    /// all diagonal, whose center of buoyancy is at `center` from the center of mass, m.
    pub fn symmetric(
        dry: f64,
        inertia: Vector3<f64>,
        added: [Vector3<f64>; 2],
        displaced: f64,
        center: Vector3<f64>,
    ) -> Self {
        let [linear, angular] = added.map(|a| Matrix3::from_diagonal(&a));
        // The center of volume moves with u + ω × r = u − [r] ω.
        let lever = center.cross_matrix();
        let coupling = -linear * lever;
        let turning = Matrix3::from_diagonal(&inertia) + angular - lever * linear * lever;
        let mut mass = Matrix6::zeros();
        let dry_mass = Matrix3::from_diagonal_element(dry);
        mass.fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&(linear + dry_mass));
        mass.fixed_view_mut::<3, 3>(0, 3).copy_from(&coupling);
        mass.fixed_view_mut::<3, 3>(3, 0)
            .copy_from(&coupling.transpose());
        mass.fixed_view_mut::<3, 3>(3, 3).copy_from(&turning);
        Self {
            mass,
            weight: dry - displaced,
            buoyancy: center * displaced,
        }
    }

    /// The system of u (m/s), ω (rad/s) and γ from any of the initial velocities in `initial_velocity`, which are the
    /// six parameters, and under a gravity (m/s²) that starts in this direction of the body's axes.
    ///
    /// # Errors
    /// [`Error::NotFinite`], or [`Error::InvalidParameter`] if the mass matrix is not symmetric and positive or there is no gravity.
    pub fn system(
        &self,
        initial_velocity: &Axis,
        gravity: Vector3<f64>,
    ) -> Result<QuadraticSystem, Error> {
        Error::check_all_finite("mass matrix", self.mass.as_slice())?;
        Error::check_all_finite("gravity", gravity.as_slice())?;
        Error::check_all_finite("buoyancy of a body", self.buoyancy.as_slice())?;
        Error::check_finite("weight of a body", self.weight)?;
        let strength = Error::check_positive("strength of gravity", gravity.norm())?;
        let asymmetry = (self.mass - self.mass.transpose()).amax();
        let symmetric = asymmetry <= 1e-9 * self.mass.amax();
        Error::check("asymmetry of the mass matrix", asymmetry, symmetric, "zero")?;
        let Some(factors) = self.mass.cholesky() else {
            return Err(Error::InvalidParameter {
                parameter: "least eigenvalue of the mass matrix",
                requirement: "positive",
                value: self.mass.symmetric_eigenvalues().min(),
            });
        };
        let per_mass = factors.inverse();
        let forces = self.forces(strength);
        let mut rates = Vec::new();
        for i in 0..6 {
            // The force of each row, through 𝕄⁻¹.
            let through = |terms: &dyn Fn(&Force) -> f64| {
                forces
                    .iter()
                    .enumerate()
                    .map(|(l, force)| per_mass[(i, l)] * terms(force))
                    .sum()
            };
            for a in 0..6 {
                for b in a..6 {
                    push(&mut rates, i, through(&|f| f.quadratic[(a, b)]), &[a, b]);
                }
            }
            for k in 0..3 {
                push(&mut rates, i, through(&|f| f.gravity[k]), &[6 + k]);
            }
        }
        for [i, j, k] in CYCLIC {
            push(&mut rates, 6 + i, 1.0, &[6 + j, 3 + k]);
            push(&mut rates, 6 + i, -1.0, &[6 + k, 3 + j]);
        }
        let velocity = |k| InitialTerm {
            component: k,
            coefficient: 1.0,
            parameters: vec![(k, (|x| x) as fn(f64) -> f64)],
        };
        let direction = |k: usize| InitialTerm {
            component: 6 + k,
            coefficient: gravity[k] / strength,
            parameters: vec![],
        };
        Ok(QuadraticSystem {
            components: 9,
            parameters: vec![initial_velocity.clone(); 6],
            initial: (0..6).map(velocity).chain((0..3).map(direction)).collect(),
            rates,
        })
    }

    /// The right-hand sides of ṗ and ḣ.
    fn forces(&self, strength: f64) -> [Force; 6] {
        let mut forces = [Force::default(); 6];
        for [i, j, k] in CYCLIC {
            // p × ω; then h × ω + p × u. Rows of 𝕄 are those of (p, h).
            forces[i].product(self, 1.0, j, 3 + k);
            forces[i].product(self, -1.0, k, 3 + j);
            forces[3 + i].product(self, 1.0, 3 + j, 3 + k);
            forces[3 + i].product(self, -1.0, 3 + k, 3 + j);
            forces[3 + i].product(self, 1.0, j, k);
            forces[3 + i].product(self, -1.0, k, j);
            forces[i].gravity[i] = self.weight * strength;
            // −ρV r_b × g γ.
            forces[3 + i].gravity[k] = -self.buoyancy[j] * strength;
            forces[3 + i].gravity[j] = self.buoyancy[k] * strength;
        }
        forces
    }
}

const CYCLIC: [[usize; 3]; 3] = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];

/// One component of force or torque: upper triangle of a quadratic form of (u, ω), and a linear one of γ.
#[derive(Clone, Copy, Default)]
struct Force {
    quadratic: Matrix6<f64>,
    gravity: Vector3<f64>,
}

impl Force {
    /// Adds `sign` times row `row` of (p, h) times component `with` of (u, ω).
    fn product(&mut self, body: &KirchhoffBody, sign: f64, row: usize, with: usize) {
        for a in 0..6 {
            self.quadratic[(a.min(with), a.max(with))] += sign * body.mass[(row, a)];
        }
    }
}

/// Adds a term unless it is nothing but rounding.
fn push(rates: &mut Vec<RateTerm>, component: usize, coefficient: f64, states: &[usize]) {
    if coefficient.abs() > 1e-14 {
        rates.push(RateTerm {
            component,
            coefficient,
            states: states.to_vec(),
            parameters: vec![],
        });
    }
}
