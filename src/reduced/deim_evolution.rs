//! Trajectories in the span of trained ones, by discrete empirical interpolation of their rates.

use super::deim::Deim;
use crate::error::Error;
use rapier3d::na::{DMatrix, DVector};

/// Parameters of [`DeimEvolution::bake`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeimParams {
    /// Singular values of the snapshots below this times the largest are left out. Default 1e-5.
    pub tolerance: f64,
    /// Most modes. Default 60.
    pub max_modes: usize,
    /// Most rounds of Newton's method. Default 30.
    pub max_rounds: usize,
}

impl Default for DeimParams {
    fn default() -> Self {
        Self {
            tolerance: 1e-5,
            max_modes: 60,
            max_rounds: 30,
        }
    }
}

/// One known trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// The parameters.
    pub parameters: Vec<f64>,
    /// The states at the times, one after the other, the first at the start.
    pub states: Vec<f64>,
}

/// A reduced model of ẋ = f(x; c) that solves the equations where it has to (thesis (6.30), Chaturantabut &
/// Sorensen 2010): the rate over all times is a combination of modes from trained trajectories, whose coefficients
/// make it equal f at as many points (a time and a component) as there are modes.
///
/// It asks for f at those points alone, by Newton's method, and unlike a separated trajectory it knows the
/// equations between the trained parameters. What lies outside of the span of the trained trajectories it cannot follow.
///
/// ```
/// use rapier3d_immersed::reduced::{DeimEvolution, DeimParams, Snapshot};
///
/// // ẋ = −c x² from 1: x = 1/(1 + c t).
/// let times: Vec<f64> = (0..=50).map(|i| 0.02 * f64::from(i)).collect();
/// let rate = |c: &[f64], x: &[f64], out: &mut [f64]| out[0] = -c[0] * x[0] * x[0];
/// let trained = [0.5, 0.8, 1.1, 1.4, 1.7, 2.0].map(|c| Snapshot {
///     parameters: vec![c],
///     states: times.iter().map(|t| 1.0 / (1.0 + c * t)).collect(),
/// });
/// let model = DeimEvolution::bake(1, &trained, rate, &DeimParams::default())?;
/// let (states, converged) = model.solve(&[1.234], &[1.0], rate);
/// assert!(converged && (states[50] - 1.0 / 2.234).abs() < 1e-4);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct DeimEvolution {
    components: usize,
    deim: Deim,
    /// What each mode of the rate adds to the states since the start: its integral.
    integrals: DMatrix<f64>,
    /// Parameters of the snapshots with the coefficients of their rates, from which a solution starts.
    known: Vec<(Vec<f64>, DVector<f64>)>,
    /// Ranges of the parameters.
    ranges: Vec<f64>,
    max_rounds: usize,
}

impl DeimEvolution {
    /// Of trajectories with `components` numbers per state, all at the same times.
    ///
    /// # Errors
    /// Those of [`Deim::new`]; [`Error::WrongLength`] if a snapshot's length is not that of the first.
    pub fn bake(
        components: usize,
        snapshots: &[Snapshot],
        rate: impl Fn(&[f64], &[f64], &mut [f64]),
        params: &DeimParams,
    ) -> Result<Self, Error> {
        Error::check_positive("components", components as f64)?;
        Error::check_positive("number of snapshots", snapshots.len() as f64)?;
        let (rows, count) = (snapshots[0].states.len(), snapshots[0].parameters.len());
        let whole = rows - rows % components;
        Error::check_length("states of a snapshot", whole, rows)?;
        let mut rates = DMatrix::zeros(rows, snapshots.len());
        let mut changes = DMatrix::zeros(rows, snapshots.len());
        for (j, snapshot) in snapshots.iter().enumerate() {
            Error::check_length("states of a snapshot", rows, snapshot.states.len())?;
            Error::check_length("parameters of a snapshot", count, snapshot.parameters.len())?;
            let mut column = rates.column_mut(j);
            let all = column.as_mut_slice().chunks_exact_mut(components);
            for (out, state) in all.zip(snapshot.states.chunks_exact(components)) {
                rate(&snapshot.parameters, state, out);
            }
            for i in 0..rows {
                changes[(i, j)] = snapshot.states[i] - snapshot.states[i % components];
            }
        }
        let deim = Deim::new(&rates, params.tolerance, params.max_modes)?;
        let integrals = changes * deim.combination();
        let coefficients = deim.basis().tr_mul(&rates);
        let of = |k: usize| snapshots.iter().map(move |s| s.parameters[k]);
        let range = |k: usize| of(k).fold(f64::MIN, f64::max) - of(k).fold(f64::MAX, f64::min);
        let known = snapshots.iter().zip(coefficients.column_iter());
        Ok(Self {
            components,
            integrals,
            known: known
                .map(|(s, c)| (s.parameters.clone(), c.into_owned()))
                .collect(),
            ranges: (0..count).map(|k| range(k).max(1e-300)).collect(),
            max_rounds: params.max_rounds,
            deim,
        })
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.deim.modes()
    }

    /// The states at the trained times, one after the other, and whether Newton's method has converged. It starts from the
    /// trained trajectory of the nearest parameters, and never leads away from the equations.
    ///
    /// # Panics
    /// If `start` has not as many numbers as a state, or a snapshot other parameters.
    pub fn solve(
        &self,
        parameters: &[f64],
        start: &[f64],
        rate: impl Fn(&[f64], &[f64], &mut [f64]),
    ) -> (Vec<f64>, bool) {
        assert_eq!(start.len(), self.components, "one number per component");
        let mut a = self.nearest(parameters);
        let mut residual = self.residual(&a, parameters, start, &rate);
        let mut converged = false;
        for _ in 0..self.max_rounds {
            let jacobian = self.jacobian(&a, parameters, start, &rate);
            let Some(step) = jacobian.lu().solve(&residual) else {
                break;
            };
            // Halved until it leads toward the equations.
            let mut share = 1.0;
            let better = loop {
                let next = &a - &step * share;
                let found = self.residual(&next, parameters, start, &rate);
                if found.norm() < residual.norm() {
                    break Some((next, found));
                }
                share *= 0.5;
                if share < 1e-4 {
                    break None;
                }
            };
            let small = step.norm() * share <= 1e-8 * (a.norm() + 1.0);
            if let Some(better) = better {
                (a, residual) = better;
            }
            if small || share < 1e-4 {
                converged = small;
                break;
            }
        }
        let changes = &self.integrals * &a;
        let states = changes.iter().enumerate();
        let states = states.map(|(i, x)| start[i % self.components] + x);
        (states.collect(), converged)
    }

    fn nearest(&self, parameters: &[f64]) -> DVector<f64> {
        let distance = |known: &[f64]| -> f64 {
            let both = known.iter().zip(parameters).zip(&self.ranges);
            both.map(|((a, b), range)| ((a - b) / range).powi(2)).sum()
        };
        let all = self.known.iter();
        let nearest = all.min_by(|a, b| distance(&a.0).total_cmp(&distance(&b.0)));
        nearest.map_or_else(|| DVector::zeros(self.modes()), |(_, a)| a.clone())
    }

    /// The state at the time of a point, written into `state`, and the component that the point is of.
    fn state_at(&self, point: usize, a: &DVector<f64>, start: &[f64], state: &mut [f64]) -> usize {
        let first = point - point % self.components;
        for (k, x) in state.iter_mut().enumerate() {
            *x = start[k] + (self.integrals.row(first + k) * a)[0];
        }
        point % self.components
    }

    /// What the rate of the modes has more than f at the points.
    fn residual(
        &self,
        a: &DVector<f64>,
        parameters: &[f64],
        start: &[f64],
        rate: &impl Fn(&[f64], &[f64], &mut [f64]),
    ) -> DVector<f64> {
        let (mut state, mut out) = (vec![0.0; self.components], vec![0.0; self.components]);
        DVector::from_iterator(
            self.modes(),
            self.deim.points().iter().map(|point| {
                let component = self.state_at(*point, a, start, &mut state);
                rate(parameters, &state, &mut out);
                (self.deim.basis().row(*point) * a)[0] - out[component]
            }),
        )
    }

    fn jacobian(
        &self,
        a: &DVector<f64>,
        parameters: &[f64],
        start: &[f64],
        rate: &impl Fn(&[f64], &[f64], &mut [f64]),
    ) -> DMatrix<f64> {
        let mut jacobian = self.deim.basis().select_rows(self.deim.points());
        let (mut state, mut out) = (vec![0.0; self.components], vec![0.0; self.components]);
        for (i, point) in self.deim.points().iter().enumerate() {
            let component = self.state_at(*point, a, start, &mut state);
            let first = point - component;
            for k in 0..self.components {
                let (x, step) = (state[k], 1e-6 * (1.0 + state[k].abs()));
                let mut at = |x: f64| {
                    state[k] = x;
                    rate(parameters, &state, &mut out);
                    out[component]
                };
                let slope = (at(x + step) - at(x - step)) / (2.0 * step);
                state[k] = x;
                let mut row = jacobian.row_mut(i);
                row -= self.integrals.row(first + k) * slope;
            }
        }
        jacobian
    }
}
