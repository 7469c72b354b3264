//! Parameters of the proper generalised decomposition.

use crate::error::Error;

/// How a separated solution is sought.
#[derive(Clone, Debug, PartialEq)]
pub struct PgdParams {
    /// Most terms of the solution. Default 30.
    pub max_modes: usize,
    /// The enrichment stops when the residual, relative to the source, is at most this. Default 1e-8.
    pub tolerance: f64,
    /// Most rounds over all dimensions in the search of one new term. Default 12.
    pub fixed_point_rounds: usize,
    /// That search also stops when the term changes by less than this fraction (thesis (6.13)). With the
    /// default of 1e-4 a term is rough, which is good enough where updates follow.
    pub fixed_point_tolerance: f64,
    /// Rounds over all dimensions, after each enrichment, in which the factors of *all* terms are
    /// solved for together. 0 is the thesis's algorithm; with a few the terms come close to
    /// the best separation of their number. Default 2.
    pub update_rounds: usize,
    /// Seed of the random starts of the fixed point. Default 1.
    pub seed: u64,
}

impl Default for PgdParams {
    fn default() -> Self {
        Self {
            max_modes: 30,
            tolerance: 1e-8,
            fixed_point_rounds: 12,
            fixed_point_tolerance: 1e-4,
            update_rounds: 2,
            seed: 1,
        }
    }
}

impl PgdParams {
    pub(crate) fn check(&self) -> Result<(), Error> {
        Error::check_positive("max_modes", self.max_modes as f64)?;
        Error::check_positive("fixed_point_rounds", self.fixed_point_rounds as f64)?;
        for (parameter, value) in [
            ("tolerance", self.tolerance),
            ("fixed_point_tolerance", self.fixed_point_tolerance),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(Error::InvalidParameter {
                    parameter,
                    requirement: "finite and not negative",
                    value,
                });
            }
        }
        Ok(())
    }
}
