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
    /// The bytes do not start like a file of the expected kind.
    #[error("not a {file} file")]
    WrongFileKind {
        /// Kind of file that was expected, e.g. `"turbulence table"`.
        file: &'static str,
    },
    /// The file was written by a version of this crate that this one cannot read.
    #[error("{file} file has version {found}, but only version {supported} can be read")]
    UnsupportedFileVersion {
        /// Kind of file.
        file: &'static str,
        /// The version that the file declares.
        found: u32,
        /// The version that this crate reads and writes.
        supported: u32,
    },
    /// The file is shorter or longer than its header declares.
    #[error("{file} file should have {expected} bytes, but has {found}")]
    WrongFileLength {
        /// Kind of file.
        file: &'static str,
        /// Bytes that the header asks for (at least a whole header).
        expected: u64,
        /// Bytes that there are.
        found: u64,
    },
    /// The file was altered or damaged after it was written.
    #[error("{file} file has checksum {found:016x}, but declares {declared:016x}")]
    AlteredFile {
        /// Kind of file.
        file: &'static str,
        /// Checksum in the file.
        declared: u64,
        /// Checksum of what the file contains.
        found: u64,
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

    /// `value` if it is zero or positive, and finite, otherwise the error that names it.
    pub(crate) fn check_not_negative(parameter: &'static str, value: f64) -> Result<f64, Self> {
        Self::check(
            parameter,
            value,
            value >= 0.0 && value.is_finite(),
            "zero or positive, and finite",
        )
    }

    /// `value` if it is finite, otherwise the error that names it.
    pub(crate) fn check_finite(parameter: &'static str, value: f64) -> Result<f64, Self> {
        Self::check(parameter, value, value.is_finite(), "finite")
    }

    /// `value` if it is `valid`, otherwise the error that names it and says what it has to be.
    pub(crate) fn check(
        parameter: &'static str,
        value: f64,
        valid: bool,
        requirement: &'static str,
    ) -> Result<f64, Self> {
        if valid {
            Ok(value)
        } else {
            Err(Self::InvalidParameter {
                parameter,
                requirement,
                value,
            })
        }
    }
}
