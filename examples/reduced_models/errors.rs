//! Error of a surrogate against horizon, relative to what there is to tell apart.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rapier3d_immersed::reduced::Axis;

/// Horizon and error.
pub type Errors = Vec<(f64, f64)>;

/// Random points of a domain and the true horizontal positions there at the horizons.
pub struct Truth {
    pub horizons: Vec<f64>,
    pub points: Vec<Vec<f64>>,
    positions: Vec<Vec<[f64; 2]>>,
}

impl Truth {
    pub fn new(
        axes: &[Axis],
        horizons: &[f64],
        count: usize,
        mut positions: impl FnMut(&[f64], &[f64]) -> Vec<[f64; 2]>,
    ) -> Self {
        let mut random = Pcg64::seed_from_u64(7);
        let mut point = || -> Vec<f64> {
            axes.iter()
                .map(|axis| random.random_range(axis.start()..axis.end()))
                .collect()
        };
        let points: Vec<Vec<f64>> = (0..count).map(|_| point()).collect();
        Self {
            horizons: horizons.to_vec(),
            positions: points.iter().map(|p| positions(p, horizons)).collect(),
            points,
        }
    }

    /// Error at each horizon relative to the standard deviation of the position over the domain.
    pub fn errors(&self, mut positions: impl FnMut(&[f64], &[f64]) -> Vec<[f64; 2]>) -> Errors {
        let guesses = self.points.iter().map(|p| positions(p, &self.horizons));
        let guesses: Vec<_> = guesses.collect();
        let error = |(h, horizon): (usize, &f64)| {
            let exact = || self.positions.iter().map(|p| p[h]);
            let count = self.positions.len() as f64;
            let mean = [0, 1].map(|k| exact().map(|x| x[k]).sum::<f64>() / count);
            let squared = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
            let spread: f64 = exact().map(|x| squared(x, mean)).sum();
            let errors: f64 = exact().zip(&guesses).map(|(x, g)| squared(x, g[h])).sum();
            (*horizon, (errors / spread).sqrt())
        };
        self.horizons.iter().enumerate().map(error).collect()
    }
}
