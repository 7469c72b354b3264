//! The nonlinear examples of thesis §6.4 as ready systems: fixtures of tests, benches and figures.

use super::axis::Axis;
use super::quadratic::{Dependence, InitialTerm, QuadraticSystem, RateTerm};

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
    -terminal * (9.81 * t / terminal).tanh()
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

/// An ellipsoid in potential flow whose attitude is held fixed for gravity (thesis (6.24)): body
/// velocity (m/s) and spin (rad/s) in body axes; the parameters are their six initial values.
///
/// The inertia is that of the homogeneous ellipsoid with semi-axes 3, 2, 1 m and 1100 kg/m³ in
/// water of 1000 kg/m³, the added mass Lamb's: coefficients .18526, .36454, 1.36153 of the
/// displaced mass in translation, .38327, .70824, .05990 of the displaced fluid's own moments of
/// inertia in rotation. Gravity, 9.81 m/s², points along the body's (−1, 2, −2)/3.
pub fn kirchhoff_ellipsoid(initial_velocity: &Axis) -> QuadraticSystem {
    let density = 1.1;
    // Everything is per displaced mass: V ρ_f = 1.
    let squares = [9.0, 4.0, 1.0];
    let added = [0.18526, 0.36454, 1.36153];
    let added_rotation = [0.38327, 0.70824, 0.05990];
    let next = |i: usize, by: usize| (i + by) % 3;
    let mass: [f64; 3] = std::array::from_fn(|i| density + added[i]);
    let inertia: [f64; 3] = std::array::from_fn(|i| {
        (density + added_rotation[i]) * (squares[next(i, 1)] + squares[next(i, 2)]) / 5.0
    });
    let gravity = [-1.0, 2.0, -2.0].map(|g| (density - 1.0) * 9.81 * g / 3.0);
    let mut rates = Vec::new();
    for i in 0..3 {
        let (j, k) = (next(i, 1), next(i, 2));
        // This is component i of (M u) × ω and of (J ω) × ω + (M u) × u.
        rates.push(rate(i, gravity[i] / mass[i], &[], &[]));
        rates.push(rate(i, mass[j] / mass[i], &[j, 3 + k], &[]));
        rates.push(rate(i, -mass[k] / mass[i], &[k, 3 + j], &[]));
        rates.push(rate(
            3 + i,
            (inertia[j] - inertia[k]) / inertia[i],
            &[3 + j, 3 + k],
            &[],
        ));
        rates.push(rate(3 + i, (mass[j] - mass[k]) / inertia[i], &[j, k], &[]));
    }
    QuadraticSystem {
        components: 6,
        parameters: vec![initial_velocity.clone(); 6],
        initial: unknown_initial_values(6),
        rates,
    }
}

#[cfg(test)]
mod tests {
    use super::super::dormand_prince::Tolerances;
    use super::*;

    /// Without gravity the system is Kirchhoff's: it keeps ½ uᵀMu + ½ ωᵀJω and |M u|.
    #[test]
    fn kirchhoff_keeps_energy_and_impulse() {
        let mut system = kirchhoff_ellipsoid(&Axis::spectral(0.0, 1.0, 3).unwrap());
        system.rates.retain(|term| !term.states.is_empty());
        let mass = [1.1 + 0.18526, 1.1 + 0.36454, 1.1 + 1.36153];
        let inertia = [1.48327, 1.80824 * 2.0, 1.15990 * 2.6];
        let invariants = |x: &[f64]| {
            let both = mass.iter().chain(&inertia).zip(x);
            let energy: f64 = both.map(|(m, v)| m * v * v).sum();
            let impulse: f64 = mass.iter().zip(x).map(|(m, u)| (m * u).powi(2)).sum();
            [energy, impulse]
        };
        let start = [0.9, 0.3, 0.7, 0.2, 0.8, 0.6];
        let tolerances = Tolerances {
            relative: 1e-12,
            absolute: 1e-12,
            ..Tolerances::default()
        };
        let end = system.integrate(&start, 5.0, tolerances).unwrap();
        for (a, b) in invariants(&start).iter().zip(invariants(&end)) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
    }

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
