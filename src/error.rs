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
    /// A list has the wrong number of entries.
    #[error("{what}: {actual} given where {expected} are needed")]
    WrongLength {
        /// Which list.
        what: &'static str,
        /// How many entries it must have (the least, where more are allowed).
        expected: usize,
        /// How many it has.
        actual: usize,
    },
    /// An entry of a list is not a finite number.
    #[error("{what}: entry {index} is {value}")]
    NotFinite {
        /// Which list.
        what: &'static str,
        /// Position of the entry, from 0.
        index: usize,
        /// The entry.
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

    /// An error if the list has a length other than `expected`.
    pub(crate) fn check_length(what: &'static str, expected: usize, actual: usize) -> Result<(), Self> {
        if expected == actual {
            Ok(())
        } else {
            Err(Self::WrongLength { what, expected, actual })
        }
    }

    /// An error that names the first entry that is not finite.
    pub(crate) fn check_finite(what: &'static str, values: &[f64]) -> Result<(), Self> {
        match values.iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(index) => Err(Self::NotFinite {
                what,
                index,
                value: values[index],
            }),
        }
    }
}
