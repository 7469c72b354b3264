//! Systems of ordinary differential equations whose parameters and initial values are coordinates.

use super::axis::Axis;
use super::canonical::Canonical;
use super::dormand_prince::{Tolerances, integrate};
use crate::error::Error;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rapier3d::na::DVector;

/// A function of one parameter: the position of the parameter and the function of its value.
pub type Dependence = (usize, fn(f64) -> f64);

/// A term `coefficient · Π states · Π functions of parameters` of the rate of one component.
#[derive(Clone, Debug)]
pub struct RateTerm {
    /// The component whose rate this is part of.
    pub component: usize,
    /// The constant factor.
    pub coefficient: f64,
    /// Components that are multiplied: none, one or two (twice the same for a square).
    pub states: Vec<usize>,
    /// Functions of parameters that are multiplied.
    pub parameters: Vec<Dependence>,
}

/// A term `coefficient · Π functions of parameters` of the initial value of one component.
#[derive(Clone, Debug)]
pub struct InitialTerm {
    /// The component whose initial value this is part of.
    pub component: usize,
    /// The constant factor.
    pub coefficient: f64,
    /// Functions of parameters that are multiplied.
    pub parameters: Vec<Dependence>,
}

/// u̇ = f(u; parameters) with f at most quadratic in u, every term separated in the parameters.
///
/// Higher powers and other functions of the state become quadratic when products are added as
/// components (u³ = u·w with w = u², ẇ = 2u u̇), and an explicit time when time is one (ṫ = 1).
///
/// ```
/// use rapier3d_immersed::reduced::{Axis, InitialTerm, QuadraticSystem, RateTerm, Tolerances};
///
/// // u̇ = u² from u = a becomes infinite at t = 1/a.
/// let system = QuadraticSystem {
///     components: 1,
///     parameters: vec![Axis::spectral(0.5, 2.0, 8)?],
///     initial: vec![InitialTerm { component: 0, coefficient: 1.0, parameters: vec![(0, |a| a)] }],
///     rates: vec![RateTerm {
///         component: 0,
///         coefficient: 1.0,
///         states: vec![0, 0],
///         parameters: vec![],
///     }],
/// };
/// let state = system.integrate(&[0.5], 1.0, Tolerances::default()).unwrap();
/// assert!((state[0] - 1.0).abs() < 1e-6); // a/(1 − a t)
/// let singularity = system.find_singularity(1.0, 1).unwrap();
/// assert!((singularity.time - 0.5).abs() < 1e-3); // from a = 2, the earliest
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct QuadraticSystem {
    /// Number of components of u.
    pub components: usize,
    /// The coordinates beside time, each with its range and mesh. Initial values that are
    /// unknown are among them.
    pub parameters: Vec<Axis>,
    /// The initial values; components that are not named start at zero.
    pub initial: Vec<InitialTerm>,
    /// The rates; components that are not named are constant.
    pub rates: Vec<RateTerm>,
}

/// A point of the parameter domain from which the solution does not exist for the whole time.
#[derive(Clone, Debug, PartialEq)]
pub struct Singularity {
    /// The values of the parameters.
    pub parameters: Vec<f64>,
    /// When the solution becomes infinite.
    pub time: f64,
}

impl QuadraticSystem {
    /// # Errors
    /// If an index is out of range, a coefficient not finite, a term of degree above two, or a
    /// function of a parameter not finite at one of its nodes.
    pub(crate) fn check(&self) -> Result<(), Error> {
        Error::check_positive("components", self.components as f64)?;
        let index = |parameter, value: usize, limit: usize| {
            if value < limit {
                return Ok(());
            }
            Err(Error::InvalidParameter {
                parameter,
                requirement: "an index of the system",
                value: value as f64,
            })
        };
        let dependences = |all: &[Dependence]| {
            for (position, function) in all {
                index("parameter of a term", *position, self.parameters.len())?;
                let values = self.parameters[*position].sample(function);
                Error::check_all_finite("function of a parameter at its nodes", values.as_slice())?;
            }
            Ok(())
        };
        for axis in &self.parameters {
            axis.check_free_ends()?;
            for weight in axis.weights() {
                Error::check_positive("weight of a parameter's node", *weight)?;
            }
        }
        for term in &self.rates {
            index("component of a rate", term.component, self.components)?;
            Error::check_all_finite("coefficient of a rate", &[term.coefficient])?;
            index("degree of a rate", term.states.len(), 3)?;
            for state in &term.states {
                index("state of a rate", *state, self.components)?;
            }
            dependences(&term.parameters)?;
        }
        for term in &self.initial {
            index(
                "component of an initial value",
                term.component,
                self.components,
            )?;
            Error::check_all_finite("coefficient of an initial value", &[term.coefficient])?;
            dependences(&term.parameters)?;
        }
        Ok(())
    }

    /// The initial state at these parameters.
    pub fn initial_state(&self, parameters: &[f64]) -> Vec<f64> {
        let mut state = vec![0.0; self.components];
        for term in &self.initial {
            state[term.component] += term.coefficient * product(&term.parameters, parameters);
        }
        state
    }

    /// Writes the rate of the state.
    pub fn rate(&self, parameters: &[f64], state: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for term in &self.rates {
            let states: f64 = term.states.iter().map(|s| state[*s]).product();
            out[term.component] +=
                term.coefficient * states * product(&term.parameters, parameters);
        }
    }

    /// Solves for one point of the parameter domain with the adaptive integrator.
    ///
    /// # Errors
    /// The singularity, if the solution does not reach `time`.
    pub fn integrate(
        &self,
        parameters: &[f64],
        time: f64,
        tolerances: Tolerances,
    ) -> Result<Vec<f64>, Singularity> {
        let mut state = self.initial_state(parameters);
        let rate = |_: f64, x: &[f64], out: &mut [f64]| self.rate(parameters, x, out);
        let reached = integrate(rate, 0.0, time, &mut state, tolerances);
        if reached < time || !state.iter().all(|x| x.abs() < 1e12) {
            return Err(Singularity {
                parameters: parameters.to_vec(),
                time: reached,
            });
        }
        Ok(state)
    }

    /// Looks for points from which the solution becomes infinite before `time`: at all corners of
    /// the parameter domain (at most 2¹⁰ of them) and at 256 random points. The earliest is
    /// returned.
    pub fn find_singularity(&self, time: f64, seed: u64) -> Option<Singularity> {
        let d = self.parameters.len();
        let corner = |bits: usize| -> Vec<f64> {
            let ends = self.parameters.iter().enumerate();
            ends.map(|(j, axis)| {
                if bits >> j & 1 == 0 {
                    axis.start()
                } else {
                    axis.end()
                }
            })
            .collect()
        };
        let mut random = Pcg64::seed_from_u64(seed);
        let mut inside = || -> Vec<f64> {
            let axes = self.parameters.iter();
            axes.map(|axis| random.random_range(axis.start()..axis.end()))
                .collect()
        };
        let corners = (0..1 << d.min(10)).map(corner);
        let tolerances = Tolerances {
            relative: 1e-7,
            absolute: 1e-9,
            ..Tolerances::default()
        };
        let points: Vec<_> = corners.chain((0..256).map(|_| inside())).collect();
        let singular = points
            .iter()
            .filter_map(|p| self.integrate(p, time, tolerances).err());
        singular.min_by(|a, b| a.time.total_cmp(&b.time))
    }

    /// Nodal values of the product of functions of parameters, one vector per parameter.
    pub(crate) fn profile(&self, dependences: &[Dependence]) -> Vec<DVector<f64>> {
        let mut factors: Vec<DVector<f64>> = self
            .parameters
            .iter()
            .map(|axis| axis.sample(|_| 1.0))
            .collect();
        for (position, function) in dependences {
            factors[*position].component_mul_assign(&self.parameters[*position].sample(function));
        }
        factors
    }

    /// The initial value of a component, constant over `times` nodes.
    pub(crate) fn initial_tensor(&self, component: usize, times: usize) -> Canonical {
        let nodes = self.parameters.iter().map(Axis::len);
        let shape: Vec<usize> = std::iter::once(times).chain(nodes).collect();
        let mut tensor = Canonical::zeros(&shape);
        for term in self.initial.iter().filter(|t| t.component == component) {
            let mut factors = vec![DVector::repeat(times, 1.0)];
            factors.extend(self.profile(&term.parameters));
            tensor
                .push(term.coefficient, &factors)
                .expect("built from the same axes");
        }
        tensor
    }
}

fn product(dependences: &[Dependence], parameters: &[f64]) -> f64 {
    dependences
        .iter()
        .map(|(position, function)| function(parameters[*position]))
        .product()
}
