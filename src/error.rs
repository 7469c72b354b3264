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
    /// A file does not start with the magic bytes of its kind.
    #[error("not a file of this kind: it starts with {found:02x?} instead of {expected:02x?}")]
    WrongMagic {
        /// How the file must start.
        expected: [u8; 8],
        /// How it starts (zeros where it is shorter).
        found: [u8; 8],
    },
    /// A file was written by another version of the format.
    #[error("file format version {found}, but this crate reads {expected}")]
    WrongVersion {
        /// The version this crate reads.
        expected: u32,
        /// The version of the file.
        found: u32,
    },
    /// The bytes of a file are not the ones that were written.
    #[error("the file was altered: checksum {found:016x}, but its header says {expected:016x}")]
    WrongChecksum {
        /// What the header says.
        expected: u64,
        /// What its content gives.
        found: u64,
    },
    /// The content of a file cannot be decoded, although its checksum is right.
    #[error("cannot decode {what} from {length} bytes")]
    Undecodable {
        /// What should be in the file.
        what: &'static str,
        /// Length of the content in bytes.
        length: usize,
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
    pub(crate) fn check_length(
        what: &'static str,
        expected: usize,
        actual: usize,
    ) -> Result<(), Self> {
        if expected == actual {
            Ok(())
        } else {
            Err(Self::WrongLength {
                what,
                expected,
                actual,
            })
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
