//! The one error type of this crate.

/// What can be wrong with an input, found when something is built, baked or loaded.
///
/// Every variant names the offending value. Nothing in the run-time step returns an error.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A scalar parameter is outside of what the physics allows.
    #[error("{parameter} must be {requirement}, but is {value}")]
    InvalidParameter {
        /// Name of the parameter, as in the public API.
        parameter: &'static str,
        /// What the parameter has to satisfy, e.g. `"positive and finite"`.
        requirement: &'static str,
        /// The value that was given.
        value: f64,
    },
}

impl Error {
    /// `value` if it is positive and finite, otherwise the error that names it.
    pub(crate) fn check_positive(parameter: &'static str, value: f64) -> Result<f64, Self> {
        if value > 0.0 && value.is_finite() {
            Ok(value)
        } else {
            Err(Self::InvalidParameter {
                parameter,
                requirement: "positive and finite",
                value,
            })
        }
    }
}
