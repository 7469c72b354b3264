//! Separated solutions of nonlinear and coupled systems, parameters and initial values included
//! (thesis §6.3.3, §6.4).
//!
//! The unknown û = u − u⁰ solves û = ∫₀ᵗ f(u⁰ + û; parameters) dt, collocated in time at Radau
//! points. In this integral form the linearised operator is the identity and a Volterra operator,
//! small over short times, so that the Galerkin projection onto separated functions is close to the
//! best in L²; the skew derivative itself gives no such bound.

use super::alternating::{enrich, project, update};
use super::axis::Axis;
use super::canonical::{Canonical, scale_rows};
use super::operator::{Factor, Operator};
use super::params::PgdParams;
use super::quadratic::{QuadraticSystem, RateTerm, Singularity};
use super::separated::Separated;
use crate::error::Error;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rapier3d::na::{DMatrix, DVector};
use std::sync::Arc;

/// Which components are solved for together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coupling {
    /// All of them: a mode is a vector function of time times functions of the parameters, and Newton's
    /// linearisation contains every product. This is the default.
    #[default]
    Monolithic,
    /// One after the other, each with modes of its own; in products, the other components have their last
    /// values (thesis (6.17)).
    Decoupled,
}

/// Parameters of [`evolve`].
#[derive(Clone, Debug, PartialEq)]
pub struct EvolutionParams {
    /// The enrichment. Its tolerance is on the residual of the integral equation relative to û.
    pub pgd: PgdParams,
    /// How coupled components are treated.
    pub coupling: Coupling,
    /// Number of points of the parameter grid on which the residual is measured; the whole grid
    /// where it has no more. Default 2000.
    pub residual_points: usize,
}

impl Default for EvolutionParams {
    fn default() -> Self {
        Self {
            pgd: PgdParams::default(),
            coupling: Coupling::default(),
            residual_points: 2000,
        }
    }
}

/// How the solution of a system went. A solution that does not converge is no error.
#[derive(Clone, Debug, PartialEq)]
pub struct EvolutionReport {
    /// Modes of û (of all components together when decoupled), those of u⁰ not counted.
    pub modes: usize,
    /// Residual of the integral equation relative to û after each enrichment.
    pub residuals: Vec<f64>,
    /// Whether the last residual met the tolerance and no singularity was found.
    pub converged: bool,
    /// A point of the domain from which the true solution becomes infinite on the way: no
    /// separated representation converges there.
    pub singularity: Option<Singularity>,
}

/// Components that share modes, by their positions, and their û.
struct Group {
    members: Vec<usize>,
    increment: Canonical,
}

struct Problem<'a> {
    system: &'a QuadraticSystem,
    time: &'a Axis,
    integral: Arc<DMatrix<f64>>,
    /// The integral matrix with the rows weighted, as the Galerkin products need it.
    tested_integral: Arc<DMatrix<f64>>,
    metric: Vec<DVector<f64>>,
    initial: Vec<Canonical>,
    groups: Vec<Group>,
}

/// Solves the system from time 0 to the end of `time` ([`Axis::time`], starting at 0) for all
/// parameters at once. `observe` is given the solution after every enrichment.
///
/// ```
/// use rapier3d_immersed::reduced::{Axis, EvolutionParams, InitialTerm, QuadraticSystem, RateTerm, evolve};
///
/// // u̇ = −k u from u = 1, for every k from 1 to 2 at once.
/// let system = QuadraticSystem {
///     components: 1,
///     parameters: vec![Axis::spectral(1.0, 2.0, 10)?],
///     initial: vec![InitialTerm { component: 0, coefficient: 1.0, parameters: vec![] }],
///     rates: vec![RateTerm {
///         component: 0,
///         coefficient: -1.0,
///         states: vec![0],
///         parameters: vec![(0, |k| k)],
///     }],
/// };
/// let time = Axis::time(0.0, 1.0, 8, 3)?;
/// let (u, report) = evolve(&system, &time, &EvolutionParams::default(), |_, _| ())?;
/// assert!(report.converged);
/// assert!((u.evaluate(&[0.7, 1.3])[0] - (-1.3 * 0.7_f64).exp()).abs() < 1e-5);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
///
/// # Errors
/// If the system names a component or parameter that it does not have, a function of a parameter is not
/// finite, the time axis is not a Radau axis from 0, or a parameter of the method is out of range.
pub fn evolve(
    system: &QuadraticSystem,
    time: &Axis,
    params: &EvolutionParams,
    mut observe: impl FnMut(usize, &Separated),
) -> Result<(Separated, EvolutionReport), Error> {
    params.pgd.check()?;
    Error::check_positive("residual_points", params.residual_points as f64)?;
    system.check()?;
    let mut problem = Problem::new(system, time, params.coupling)?;
    let mut report = EvolutionReport {
        modes: 0,
        residuals: Vec::new(),
        converged: false,
        singularity: system.find_singularity(time.end(), params.pgd.seed),
    };
    let mut random = Pcg64::seed_from_u64(params.pgd.seed);
    let causal = time.causal_blocks();
    for enrichment in 1..=params.pgd.max_modes {
        for g in 0..problem.groups.len() {
            let operator = problem.operator(g);
            let residual = problem.residual(g);
            let metric = problem.metric_of(g);
            let mode = enrich(
                &operator,
                &residual,
                &metric,
                &causal,
                &params.pgd,
                &mut random,
            );
            let mut increment = problem.groups[g].increment.plus(1.0, &mode);
            project(&operator, &problem.source(g), &mut increment);
            problem.groups[g].increment = increment;
        }
        for _ in 0..params.pgd.update_rounds {
            for g in 0..problem.groups.len() {
                let (operator, source) = (problem.operator(g), problem.source(g));
                let metric = problem.metric_of(g);
                update(
                    &operator,
                    &source,
                    &metric,
                    &causal,
                    &mut problem.groups[g].increment,
                );
            }
        }
        let size = problem.relative_residual(params.residual_points, params.pgd.seed);
        report.residuals.push(size);
        if !size.is_finite() {
            break;
        }
        observe(enrichment, &problem.solution()?);
        if size <= params.pgd.tolerance {
            break;
        }
    }
    let last = report.residuals.last();
    report.converged =
        report.singularity.is_none() && last.is_some_and(|r| *r <= params.pgd.tolerance);
    report.modes = problem.groups.iter().map(|g| g.increment.rank()).sum();
    Ok((problem.solution()?, report))
}

impl<'a> Problem<'a> {
    fn new(system: &'a QuadraticSystem, time: &'a Axis, coupling: Coupling) -> Result<Self, Error> {
        let integral = time.integral()?;
        if time.start() != 0.0 {
            return Err(Error::InvalidParameter {
                parameter: "start of the time axis",
                requirement: "0",
                value: time.start(),
            });
        }
        let weights = |axis: &Axis| DVector::from_column_slice(axis.weights());
        let metric: Vec<_> = std::iter::once(time)
            .chain(&system.parameters)
            .map(weights)
            .collect();
        let components = 0..system.components;
        let partition: Vec<Vec<usize>> = match coupling {
            Coupling::Monolithic => vec![components.clone().collect()],
            Coupling::Decoupled => components.clone().map(|c| vec![c]).collect(),
        };
        let group = |members: Vec<usize>| {
            let mut shape: Vec<usize> = metric.iter().map(DVector::len).collect();
            shape[0] *= members.len();
            Group {
                members,
                increment: Canonical::zeros(&shape),
            }
        };
        Ok(Self {
            system,
            time,
            tested_integral: Arc::new(scale_rows(&integral, &metric[0])),
            integral: Arc::new(integral),
            initial: components
                .map(|c| system.initial_tensor(c, time.len()))
                .collect(),
            groups: partition.into_iter().map(group).collect(),
            metric,
        })
    }

    fn metric_of(&self, group: usize) -> Vec<DVector<f64>> {
        let mut metric = self.metric.clone();
        metric[0] = self.metric[0]
            .clone()
            .as_slice()
            .repeat(self.groups[group].members.len())
            .into();
        metric
    }

    /// û of one component.
    fn increment(&self, component: usize) -> Canonical {
        let n = self.time.len();
        let of_group = |group: &Group| {
            let local = group.members.iter().position(|c| *c == component)?;
            let all = &group.increment;
            let mut factors: Vec<_> = (0..all.dimensions())
                .map(|j| all.factors(j).clone())
                .collect();
            factors[0] = factors[0].rows(local * n, n).into_owned();
            Some(Canonical::from_parts(all.weights().to_vec(), factors))
        };
        self.groups
            .iter()
            .find_map(of_group)
            .expect("every component is in a group")
    }

    /// u of one component.
    fn full(&self, component: usize) -> Canonical {
        self.initial[component].plus(1.0, &self.increment(component))
    }

    /// A tensor of one component in the first dimension of its group.
    fn embedded(&self, group: usize, component: usize, tensor: &Canonical) -> Canonical {
        let members = &self.groups[group].members;
        let local = members
            .iter()
            .position(|c| *c == component)
            .expect("component of this group");
        let n = self.time.len();
        let mut factors: Vec<_> = (0..tensor.dimensions())
            .map(|j| tensor.factors(j).clone())
            .collect();
        let mut first = DMatrix::zeros(n * members.len(), tensor.rank());
        first.rows_mut(local * n, n).copy_from(&factors[0]);
        factors[0] = first;
        Canonical::from_parts(tensor.weights().to_vec(), factors)
    }

    /// ∫ of nodal rates, tested: the contribution of a rate term to the source.
    fn tested_rate(&self, term: &RateTerm, states: Canonical) -> Canonical {
        let mut vectors = vec![DVector::repeat(self.time.len(), 1.0)];
        let profile = self.system.profile(&term.parameters);
        vectors.extend(
            profile
                .iter()
                .zip(&self.metric[1..])
                .map(|(f, w)| f.component_mul(w)),
        );
        let scaled = states.scaled(term.coefficient, &vectors);
        let mut factors: Vec<_> = (0..scaled.dimensions())
            .map(|j| scaled.factors(j).clone())
            .collect();
        factors[0] = self.tested_integral.as_ref() * &factors[0];
        Canonical::from_parts(scaled.weights().to_vec(), factors)
    }

    fn ones(&self) -> Canonical {
        let ones: Vec<DVector<f64>> = self
            .metric
            .iter()
            .map(|w| DVector::repeat(w.len(), 1.0))
            .collect();
        let shape: Vec<usize> = ones.iter().map(DVector::len).collect();
        let mut tensor = Canonical::zeros(&shape);
        tensor.push(1.0, &ones).expect("the shape is its own");
        tensor
    }

    /// The sum over the rate terms of a group, each with the tensor that `states` gives for it.
    fn sum_of_rates(&self, group: usize, states: impl Fn(&RateTerm) -> Canonical) -> Canonical {
        let mut sum = Canonical::zeros(&self.groups[group].increment.shape());
        for term in &self.system.rates {
            if self.groups[group].members.contains(&term.component) {
                let tested = self.tested_rate(term, states(term));
                sum = sum.plus(1.0, &self.embedded(group, term.component, &tested));
            }
        }
        sum
    }

    /// The residual ∫ f(u) − û, tested.
    fn residual(&self, group: usize) -> Canonical {
        let rates = self.sum_of_rates(group, |term| match term.states[..] {
            [] => self.ones(),
            [a] => self.full(a),
            [a, b, ..] => self.full(a).hadamard(&self.full(b)),
        });
        let increment = &self.groups[group].increment;
        let tested = increment.clone().scaled(1.0, &self.metric_of(group));
        rates.plus(-1.0, &tested)
    }

    /// The right-hand side of Newton's linearisation for the whole û of a group: the rates at
    /// û minus the linear operator's part of them, in which the products û·û cancel but for one.
    fn source(&self, group: usize) -> Canonical {
        let inside = |c: usize| self.groups[group].members.contains(&c);
        self.sum_of_rates(group, |term| match term.states[..] {
            [] => self.ones(),
            [a] if inside(a) => self.initial[a].clone(),
            [a] => self.full(a),
            [a, b, ..] => match (inside(a), inside(b)) {
                (true, true) => {
                    let initial = self.initial[a].hadamard(&self.initial[b]);
                    initial.plus(-1.0, &self.increment(a).hadamard(&self.increment(b)))
                }
                (true, false) => self.initial[a].hadamard(&self.full(b)),
                (false, true) => self.full(a).hadamard(&self.initial[b]),
                (false, false) => self.full(a).hadamard(&self.full(b)),
            },
        })
    }

    /// Newton's linearisation: the identity minus the integral of the Jacobian.
    fn operator(&self, group: usize) -> Operator {
        let members = &self.groups[group].members;
        let mut operator = Operator::zero(&self.groups[group].increment.shape());
        let identity = self
            .metric_of(group)
            .into_iter()
            .map(Factor::Diagonal)
            .collect();
        let built = "built from the same axes";
        operator.push(identity).expect(built);
        for term in &self.system.rates {
            let Some(row) = members.iter().position(|c| *c == term.component) else {
                continue;
            };
            let profile = self.system.profile(&term.parameters);
            for (slot, state) in term.states.iter().enumerate() {
                let Some(column) = members.iter().position(|c| c == state) else {
                    continue;
                };
                let others: Vec<_> = (0..term.states.len()).filter(|s| *s != slot).collect();
                let other = match others[..] {
                    [other, ..] => self.full(term.states[other]),
                    [] => self.ones(),
                };
                for mode in 0..other.rank() {
                    let scale =
                        other.factors(0).column(mode) * (-term.coefficient * other.weights()[mode]);
                    let mut factors = vec![Factor::Block {
                        row,
                        column,
                        components: members.len(),
                        matrix: self.tested_integral.clone(),
                        scale,
                    }];
                    for (j, function) in profile.iter().enumerate() {
                        let values = other.factors(j + 1).column(mode).component_mul(function);
                        factors.push(Factor::Diagonal(values.component_mul(&self.metric[j + 1])));
                    }
                    operator.push(factors).expect(built);
                }
            }
        }
        operator
    }

    /// ‖û − ∫f(u)‖ / ‖û‖ over nodes of the parameter grid, all of them or a random sample.
    fn relative_residual(&self, points: usize, seed: u64) -> f64 {
        let axes = &self.system.parameters;
        let all = axes
            .iter()
            .try_fold(1_usize, |n, axis| n.checked_mul(axis.len()));
        let exhaustive = all.filter(|n| *n <= points);
        let increments: Vec<Canonical> = (0..self.system.components)
            .map(|c| self.increment(c))
            .collect();
        let mut random = Pcg64::seed_from_u64(seed);
        let (mut squares, mut norm) = (0.0, 0.0);
        let times = self.time.len();
        let mut rates = vec![DVector::zeros(times); self.system.components];
        let mut rate = vec![0.0; self.system.components];
        for point in 0..exhaustive.unwrap_or(points) {
            let mut rest = point;
            let mut index = |axis: &Axis| {
                if exhaustive.is_none() {
                    return random.random_range(0..axis.len());
                }
                let i = rest % axis.len();
                rest /= axis.len();
                i
            };
            let indices: Vec<usize> = axes.iter().map(&mut index).collect();
            let nodes = axes.iter().zip(&indices);
            let weight: f64 = nodes.clone().map(|(axis, i)| axis.weights()[*i]).product();
            let parameters: Vec<f64> = nodes.map(|(axis, i)| axis.nodes()[*i]).collect();
            let initial = self.system.initial_state(&parameters);
            let values: Vec<DVector<f64>> = increments
                .iter()
                .map(|increment| {
                    let product = |mode: usize| {
                        let factors = indices.iter().enumerate();
                        increment.weights()[mode]
                            * factors
                                .map(|(j, i)| increment.factors(j + 1)[(*i, mode)])
                                .product::<f64>()
                    };
                    increment.factors(0)
                        * DVector::from_fn(increment.rank(), |mode, _| product(mode))
                })
                .collect();
            for t in 0..times {
                let state: Vec<f64> = values.iter().zip(&initial).map(|(v, i)| v[t] + i).collect();
                self.system.rate(&parameters, &state, &mut rate);
                rates
                    .iter_mut()
                    .zip(&rate)
                    .for_each(|(all, one)| all[t] = *one);
            }
            for (value, rate) in values.iter().zip(&rates) {
                let residual = self.integral.as_ref() * rate - value;
                for t in 0..times {
                    let w = weight * self.metric[0][t];
                    squares += w * residual[t] * residual[t];
                    norm += w * value[t] * value[t];
                }
            }
        }
        if squares == 0.0 {
            return 0.0;
        }
        (squares / norm).sqrt()
    }

    /// u as a function, its initial value included.
    fn solution(&self) -> Result<Separated, Error> {
        let time = self.time.clone().with_free_ends();
        let (n, components) = (self.time.len(), self.system.components);
        let mut shape: Vec<usize> = self.metric.iter().map(DVector::len).collect();
        shape[0] = time.len() * components;
        let mut all = Canonical::zeros(&shape);
        for (c, initial) in self.initial.iter().enumerate() {
            let mut factors: Vec<_> = (0..initial.dimensions())
                .map(|j| initial.factors(j).clone())
                .collect();
            factors[0] = DMatrix::zeros(shape[0], initial.rank());
            factors[0].rows_mut(c * time.len(), time.len()).fill(1.0);
            all = all.plus(
                1.0,
                &Canonical::from_parts(initial.weights().to_vec(), factors),
            );
        }
        for group in &self.groups {
            let mut increment = group.increment.clone();
            increment.sort();
            let mut factors: Vec<_> = (0..increment.dimensions())
                .map(|j| increment.factors(j).clone())
                .collect();
            let mut first = DMatrix::zeros(shape[0], increment.rank());
            for (local, c) in group.members.iter().enumerate() {
                // The increment vanishes at the start, which the free axis has a node for.
                let rows = factors[0].rows(local * n, n);
                first.rows_mut(c * time.len() + 1, n).copy_from(&rows);
            }
            factors[0] = first;
            all = all.plus(
                1.0,
                &Canonical::from_parts(increment.weights().to_vec(), factors),
            );
        }
        let axes = std::iter::once(time).chain(self.system.parameters.iter().cloned());
        Separated::new(components, axes.collect(), &all)
    }
}
