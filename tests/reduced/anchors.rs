//! Known answers that any separated representation must reproduce: the truncation error of the
//! singular value decomposition, exact ranks, and partial differential equations with exact
//! solutions.

use rapier3d::na::{DMatrix, DVector};
use rapier3d_immersed::reduced::Canonical;
use rapier3d_immersed::reduced::{Axis, Quadrature};
use rapier3d_immersed::reduced::{Factor, Operator};
use rapier3d_immersed::reduced::{PgdParams, solve};
use std::f64::consts::PI;

fn metric(axes: &[&Axis]) -> Vec<DVector<f64>> {
    axes.iter()
        .map(|a| DVector::from_column_slice(a.weights()))
        .collect()
}

fn identity(metric: &[DVector<f64>]) -> Operator {
    let shape: Vec<usize> = metric.iter().map(DVector::len).collect();
    let mut operator = Operator::zero(&shape);
    operator
        .push(metric.iter().cloned().map(Factor::Diagonal).collect())
        .unwrap();
    operator
}

/// With the identity as operator, n updated terms of a two-dimensional function leave exactly what
/// the singular value decomposition leaves (Eckart & Young 1936): compared with nalgebra's.
#[test]
fn two_dimensions_give_the_svd() {
    let x = Axis::spectral(0.0, 1.0, 20).unwrap();
    let y = Axis::elements(-1.0, 2.0, 8, 2).unwrap();
    let metric = metric(&[&x, &y]);
    let f = |x: f64, y: f64| 1.0 / (1.0 + x + y * y) + (3.0 * x * y).sin();
    let data = DMatrix::from_fn(x.len(), y.len(), |i, j| f(x.nodes()[i], y.nodes()[j]));
    let mut source = Canonical::zeros(&[x.len(), y.len()]);
    for j in 0..y.len() {
        let mut unit = DVector::zeros(y.len());
        unit[j] = metric[1][j];
        source
            .push(1.0, &[data.column(j).component_mul(&metric[0]), unit])
            .unwrap();
    }
    let weighted = DMatrix::from_fn(x.len(), y.len(), |i, j| {
        data[(i, j)] * (metric[0][i] * metric[1][j]).sqrt()
    });
    let mut values: Vec<f64> = weighted
        .svd(false, false)
        .singular_values
        .iter()
        .copied()
        .collect();
    values.sort_by(|a, b| b.total_cmp(a));
    let total = values.iter().map(|v| v * v).sum::<f64>().sqrt();
    let params = PgdParams {
        max_modes: 6,
        tolerance: 0.0,
        update_rounds: 30,
        ..PgdParams::default()
    };
    let (_, report) = solve(&identity(&metric), &source, &metric, &params).unwrap();
    for (n, residual) in report.residuals.iter().enumerate() {
        let best = values[n + 1..].iter().map(|v| v * v).sum::<f64>().sqrt() / total;
        println!("{} modes: {residual:.3e}, best {best:.3e}", n + 1);
        assert!(
            *residual < best * 1.01 + 1e-12,
            "{} modes: {residual:e}, best {best:e}",
            n + 1
        );
        assert!(
            *residual > best * 0.999 - 1e-12,
            "below the optimum: {residual:e} < {best:e}"
        );
    }
}

/// A function of rank three in five dimensions is found with three terms.
#[test]
fn a_rank_three_function_takes_three_modes() {
    let axis = Axis::spectral(-1.0, 1.0, 9).unwrap();
    let metric = metric(&[&axis; 5]);
    let mut source = Canonical::zeros(&[9; 5]);
    for k in 0..3 {
        let factor = |j: usize| {
            let phase = (k * k * 5 + j) as f64;
            axis.sample(|x| (1.3 * phase + x * (1.0 + 1.5 * k as f64)).cos())
                .component_mul(&metric[j])
        };
        source
            .push(1.0 + k as f64, &[0, 1, 2, 3, 4].map(factor))
            .unwrap();
    }
    let params = PgdParams {
        tolerance: 1e-10,
        update_rounds: 300,
        ..PgdParams::default()
    };
    let (_, report) = solve(&identity(&metric), &source, &metric, &params).unwrap();
    assert!(report.converged, "{report:?}");
    assert_eq!(report.modes, 3, "{report:?}");
}

/// −Δu = f on the unit hypercube in six dimensions. With f = 6π² Π sin πxⱼ the solution is the
/// product itself; with f the sum of two eigenfunctions it has two terms, each divided by its
/// eigenvalue. The error is that of the spectral element with fourteen points, below 1e-9.
#[test]
fn poisson_in_six_dimensions() {
    let axis = Axis::spectral(0.0, 1.0, 14)
        .unwrap()
        .with_zero_start()
        .with_zero_end();
    let n = axis.len();
    let metric = metric(&[&axis; 6]);
    let mass = Factor::Dense(axis.matrix(Quadrature::Gauss(16), 0, 0, |_| 1.0));
    let stiffness = Factor::Dense(axis.matrix(Quadrature::Gauss(16), 1, 1, |_| 1.0));
    let mut operator = Operator::zero(&[n; 6]);
    for direction in 0..6 {
        let factor = |j| {
            if j == direction {
                stiffness.clone()
            } else {
                mass.clone()
            }
        };
        operator.push((0..6).map(factor).collect()).unwrap();
    }
    let load = |k: f64| axis.load(Quadrature::Gauss(20), move |x| (k * PI * x).sin());
    let mut source = Canonical::zeros(&[n; 6]);
    source.push(6.0 * PI * PI, &vec![load(1.0); 6]).unwrap();
    let mut second = vec![load(1.0); 6];
    second[2] = load(2.0);
    second[4] = load(2.0);
    source.push(0.5, &second).unwrap();
    let params = PgdParams {
        update_rounds: 10,
        ..PgdParams::default()
    };
    let (solution, report) = solve(&operator, &source, &metric, &params).unwrap();
    assert!(report.converged, "{report:?}");
    assert_eq!(report.modes, 2);
    let exact = |point: &[f64; 6]| {
        let product: f64 = point.iter().map(|x| (PI * x).sin()).product();
        // sin 2a = 2 sin a cos a turns two of the first mode's factors into the second's.
        let second = product * 4.0 * (PI * point[2]).cos() * (PI * point[4]).cos();
        product + 0.5 / (12.0 * PI * PI) * second
    };
    for index in [
        [3, 4, 5, 6, 7, 8],
        [1, 2, 3, 1, 2, 3],
        [6; 6],
        [9, 9, 2, 4, 1, 5],
    ] {
        let point = index.map(|i| axis.nodes()[i]);
        let error = (solution.at(&index) - exact(&point)).abs();
        assert!(error < 1e-9, "{index:?}: {error:e}");
    }
}
