//! Saving and loading.

use super::subspace::Subspaces;
use super::sweep::Sweep;
use crate::error::Error;
use crate::file::{FileKind, decode, encode};

const SWEEP: FileKind = FileKind {
    name: "sweep",
    magic: *b"R3DI-SWP",
    version: 2,
};
const SUBSPACES: FileKind = FileKind {
    name: "subspaces",
    magic: *b"R3DI-SUB",
    version: 1,
};

impl Sweep {
    /// The bytes of a file that holds this sweep, complete or not.
    pub fn to_bytes(&self) -> Vec<u8> {
        encode(&SWEEP, self)
    }

    /// Reads what `to_bytes` wrote.
    ///
    /// # Errors
    /// If the bytes are of another kind or version, truncated, altered, or describe something
    /// inconsistent or not finite.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let loaded: Self = decode(&SWEEP, bytes)?;
        loaded.check()?;
        Ok(loaded)
    }
}

impl Subspaces {
    /// This as the bytes of a file.
    pub fn to_bytes(&self) -> Vec<u8> {
        encode(&SUBSPACES, self)
    }

    /// Reads what `to_bytes` wrote.
    ///
    /// # Errors
    /// If the bytes are of another kind or version, truncated, altered, or describe something
    /// inconsistent or not finite.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let loaded: Self = decode(&SUBSPACES, bytes)?;
        loaded.check()?;
        Ok(loaded)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{AttitudeSpread, Pattern, Regime};
    use crate::training::{Grid, Sample};
    use std::ops::ControlFlow;

    #[test]
    fn what_is_saved_is_loaded() {
        let mut sweep = Sweep::new(Grid::of_coefficients(5, 3.0).unwrap());
        let sample = |point: &[f64]| {
            Ok(Sample {
                distance: point[0],
                eccentricity: 0.25,
                attitude: AttitudeSpread::default(),
                flips: 0.0,
                regime: Regime::TransitionalHelix,
                simulated: true,
            })
        };
        sweep.run(sample, |_, _| ControlFlow::Break(())).unwrap();
        let bytes = sweep.to_bytes();
        assert_eq!(Sweep::from_bytes(&bytes).as_ref(), Ok(&sweep));
        let labels = vec![Pattern::Zigzag; 125];
        let subspaces = Subspaces::new(sweep.grid().clone(), labels).unwrap();
        let saved = subspaces.to_bytes();
        assert_eq!(Subspaces::from_bytes(&saved), Ok(subspaces));
        assert!(Subspaces::from_bytes(&bytes).is_err());
        for length in 0..bytes.len() {
            assert!(Sweep::from_bytes(&bytes[..length]).is_err());
        }
        // The frame of the file is right, its content is not.
        let nonsense = |distance, eccentricity| {
            let mut bad = sweep.clone();
            let bad_sample = |_: &[f64]| {
                Ok(Sample {
                    distance,
                    eccentricity,
                    attitude: AttitudeSpread::default(),
                    flips: 0.0,
                    regime: Regime::SteadyDescent,
                    simulated: true,
                })
            };
            bad.run(bad_sample, |_, _| ControlFlow::Continue(()))
                .unwrap();
            Sweep::from_bytes(&bad.to_bytes())
        };
        assert!(nonsense(f64::NAN, 0.5).is_err());
        assert!(nonsense(1.0, 1.5).is_err());
    }
}
