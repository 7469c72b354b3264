//! The nonlinear examples of thesis §6.4 as ready systems: fixtures of tests, benches and figures.

use super::axis::Axis;
use super::kirchhoff::KirchhoffBody;
use super::quadratic::{Dependence, InitialTerm, QuadraticSystem, RateTerm};
use crate::error::Error;
use crate::math;
use rapier3d::na::Vector3;

fn rate(
    component: usize,
    coefficient: f64,
    states: &[usize],
    parameters: &[Dependence],
) -> RateTerm {
    RateTerm {
        component,
        coefficient,
        states: states.to_vec(),
        parameters: parameters.to_vec(),
    }
}

/// Component k starts at parameter k.
fn unknown_initial_values(count: usize) -> Vec<InitialTerm> {
    let term = |k| InitialTerm {
        component: k,
        coefficient: 1.0,
        parameters: vec![(k, |x| x)],
    };
    (0..count).map(term).collect()
}

/// k(u̇ + 1) = 10 from u = 0 (thesis (6.18)); the parameter is k. [`linear_solution`] is its solution.
///
/// ```
/// use rapier3d_immersed::reduced::Axis;
/// use rapier3d_immersed::reduced::example_systems::{linear, linear_solution};
///
/// let system = linear(Axis::spectral(1.0, 10.0, 8)?);
/// let mut rate = [0.0];
/// system.rate(&[4.0], &[0.0], &mut rate);
/// assert!((rate[0] - linear_solution(1.0, 4.0)).abs() < 1e-12); // the rate is constant
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
pub fn linear(k: Axis) -> QuadraticSystem {
    QuadraticSystem {
        components: 1,
        parameters: vec![k],
        initial: vec![],
        rates: vec![
            rate(0, 10.0, &[], &[(0, |k| 1.0 / k)]),
            rate(0, -1.0, &[], &[]),
        ],
    }
}

/// The solution of [`linear`], t (10/k − 1).
pub fn linear_solution(t: f64, k: f64) -> f64 {
    t * (10.0 / k - 1.0)
}

/// A body in free fall against quadratic drag (thesis (6.20)), upward velocity in m/s; the
/// parameter is C_D. ρ_f = 1.23 kg/m³, g = 9.81 m/s², A = 0.5 m², m = 0.1 kg (thesis Fig. 6.4).
/// [`falling_body_solution`] is its solution.
pub fn falling_body(drag: Axis) -> QuadraticSystem {
    QuadraticSystem {
        components: 1,
        parameters: vec![drag],
        initial: vec![],
        rates: vec![
            rate(0, -9.81, &[], &[]),
            rate(0, 1.23 * 0.5 / (2.0 * 0.1), &[0, 0], &[(0, |drag| drag)]),
        ],
    }
}

/// The solution of [`falling_body`], −u_T tanh(g t / u_T) with the terminal velocity u_T (thesis §6.4.2).
pub fn falling_body_solution(t: f64, drag: f64) -> f64 {
    let terminal = (2.0 * 0.1 * 9.81 / (1.23 * drag * 0.5_f64)).sqrt();
    -terminal * math::tanh(9.81 * t / terminal)
}

/// u̇₁ + u₂u₃ = 1, u̇₂ + u₁u₃ = 2, u̇₃ + u₁u₂ = 3 (thesis (6.22)); the parameters are the three
/// initial values. From (0, 1, 1) it is singular at t = 0.953.
pub fn coupled_triple(initial_value: &Axis) -> QuadraticSystem {
    let equation = |k: usize, source: f64, a: usize, b: usize| {
        [rate(k, source, &[], &[]), rate(k, -1.0, &[a, b], &[])]
    };
    QuadraticSystem {
        components: 3,
        parameters: vec![initial_value.clone(); 3],
        initial: unknown_initial_values(3),
        rates: [
            equation(0, 1.0, 1, 2),
            equation(1, 2.0, 0, 2),
            equation(2, 3.0, 0, 1),
        ]
        .concat(),
    }
}

/// The body of [`kirchhoff_ellipsoid`].
///
/// A homogeneous ellipsoid with semi-axes 3, 2, 1 m and 1100 kg/m³ in water of 1000 kg/m³, but that its center of
/// buoyancy is (0.05, −0.1, 0.15) m from its center of mass, as of one with ballast. The added mass is Lamb's: coefficients
/// .18526, .36454, 1.36153 of the displaced mass in translation, .38327, .70824, .05990 of the displaced
/// fluid's own moments of inertia in rotation, about the center of volume. Masses are in units of the displaced mass.
pub fn ballasted_ellipsoid() -> KirchhoffBody {
    let density = 1.1;
    let moments = Vector3::new(5.0, 10.0, 13.0) / 5.0;
    let added = [
        Vector3::new(0.18526, 0.36454, 1.36153),
        Vector3::new(0.38327, 0.70824, 0.05990).component_mul(&moments),
    ];
    let center = Vector3::new(0.05, -0.1, 0.15);
    KirchhoffBody::symmetric(density, moments * density, added, 1.0, center)
}

/// An ellipsoid that falls through an ideal fluid (thesis (6.24)): body velocity (m/s), spin (rad/s) and the
/// direction of gravity, in body axes; the parameters are the six initial velocities.
///
/// It is [`ballasted_ellipsoid`]. Gravity, 9.81 m/s², is along the body's (−1, 2, −2)/3 at the start, and turns in the body's
/// axes as the body turns: the thesis prints f_g and τ_g "in terms of initial velocity state" and no such equation.
///
/// # Errors
/// Those of [`KirchhoffBody::system`], which this body gives no cause for.
pub fn kirchhoff_ellipsoid(initial_velocity: &Axis) -> Result<QuadraticSystem, Error> {
    let gravity = Vector3::new(-1.0, 2.0, -2.0) * (9.81 / 3.0);
    ballasted_ellipsoid().system(initial_velocity, gravity)
}

#[cfg(test)]
mod tests {
    use super::super::dormand_prince::Tolerances;
    use super::*;

    #[test]
    fn solutions_satisfy_their_equations() {
        let axis = Axis::spectral(0.5, 2.0, 3).unwrap();
        for (system, solution) in [
            (linear(axis.clone()), linear_solution as fn(f64, f64) -> f64),
            (falling_body(axis), falling_body_solution),
        ] {
            let end = system
                .integrate(&[1.3], 0.7, Tolerances::default())
                .unwrap();
            assert!((end[0] - solution(0.7, 1.3)).abs() < 1e-7);
        }
    }
}
