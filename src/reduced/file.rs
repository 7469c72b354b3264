//! Saving and loading, in postcard's encoding.

use super::separated::Separated;
use super::separated_forces::SeparatedForces;
use super::surrogate::{FlowMap, TrajectorySurrogate};
use super::tensor_train::TensorTrain;
use crate::error::Error;
use crate::file::{FileKind, decode, encode};

macro_rules! saved {
    ($type:ident, $magic:literal, $name:literal) => {
        impl $type {
            const FILE: FileKind = FileKind {
                name: $name,
                magic: *$magic,
                version: 1,
            };

            /// The bytes of a file that holds this.
            pub fn to_bytes(&self) -> Vec<u8> {
                encode(&Self::FILE, self)
            }

            /// Reads what `to_bytes` wrote.
            ///
            /// # Errors
            /// If the bytes are of another kind or version, truncated, altered, or describe
            /// something inconsistent or not finite.
            pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
                let loaded: Self = decode(&Self::FILE, bytes)?;
                loaded.check()?;
                Ok(loaded)
            }
        }
    };
}

saved!(Separated, b"R3DI-SEP", "separated representation");
saved!(TensorTrain, b"R3DI-TTR", "tensor train");
saved!(TrajectorySurrogate, b"R3DI-TRJ", "trajectory surrogate");
saved!(FlowMap, b"R3DI-FLO", "flow map");
saved!(SeparatedForces, b"R3DI-SFO", "separated forces");

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reduced::axis::Axis;
    use crate::reduced::canonical::Canonical;
    use crate::reduced::cross::CrossParams;

    fn example() -> Separated {
        let axes = vec![
            Axis::time(0.0, 1.0, 2, 3).unwrap(),
            Axis::elements(0.0, 1.0, 4, 2).unwrap(),
        ];
        let mut tensor = Canonical::zeros(&[2 * axes[0].len(), axes[1].len()]);
        let first: Vec<f64> = (0..2 * axes[0].len()).map(|i| (i as f64).sin()).collect();
        tensor
            .push(2.0, &[first.into(), axes[1].sample(f64::exp)])
            .unwrap();
        Separated::new(2, axes, &tensor).unwrap()
    }

    #[test]
    fn a_round_trip_changes_nothing() {
        let separated = example();
        assert_eq!(
            Separated::from_bytes(&separated.to_bytes()).unwrap(),
            separated
        );
    }

    /// Every truncation and every altered byte is refused, without a panic.
    #[test]
    fn damaged_files_are_refused() {
        let bytes = example().to_bytes();
        for length in 0..bytes.len() {
            assert!(
                Separated::from_bytes(&bytes[..length]).is_err(),
                "{length} bytes"
            );
        }
        for at in 0..bytes.len() {
            for flip in [1, 0x80] {
                let mut altered = bytes.clone();
                altered[at] ^= flip;
                assert!(Separated::from_bytes(&altered).is_err(), "byte {at}");
            }
        }
        let mut longer = bytes.clone();
        longer.push(0);
        assert!(Separated::from_bytes(&longer).is_err());
        assert!(matches!(
            TensorTrain::from_bytes(&bytes),
            Err(Error::WrongFileKind { .. })
        ));
    }

    #[test]
    fn surrogates_are_saved_and_checked() {
        let axes = || vec![Axis::spectral(0.0, 1.0, 4).unwrap(); 2];
        let params = CrossParams::default();
        let map = |s: &[f64], p: &[f64], out: &mut [f64]| out[0] = s[0] * p[0];
        let (state, parameters) = (axes()[..1].to_vec(), axes()[..1].to_vec());
        let (flow, _) = FlowMap::bake(0.1, state, parameters, 0, map, &params).unwrap();
        assert_eq!(FlowMap::from_bytes(&flow.to_bytes()).unwrap(), flow);
        let model = |p: &[f64], times: &[f64], out: &mut [f64]| {
            out.iter_mut()
                .zip(times)
                .for_each(|(out, t)| *out = p[0] * t + p[1]);
        };
        let time = Axis::spectral(0.0, 1.0, 3).unwrap();
        let (surrogate, _) = TrajectorySurrogate::bake(time, 1, axes(), model, &params).unwrap();
        assert!((surrogate.evaluate(&[0.5, 0.2], &[0.8])[0] - 0.6).abs() < 1e-12);
        assert_eq!(
            TrajectorySurrogate::from_bytes(&surrogate.to_bytes()).unwrap(),
            surrogate
        );
        let refused = FlowMap {
            step: f64::NAN,
            ..flow.clone()
        };
        assert!(FlowMap::from_bytes(&refused.to_bytes()).is_err());
        let refused = FlowMap {
            components: 3,
            ..flow
        };
        assert!(FlowMap::from_bytes(&refused.to_bytes()).is_err());
        let mut refused = surrogate.clone();
        refused.train.cores[1].right += 1;
        assert!(TrajectorySurrogate::from_bytes(&refused.to_bytes()).is_err());
        let refused = TrajectorySurrogate {
            components: 2,
            ..surrogate
        };
        assert!(TrajectorySurrogate::from_bytes(&refused.to_bytes()).is_err());
    }

    /// Content with a right checksum that is no valid representation.
    #[test]
    fn invalid_content_is_refused() {
        let refused = |change: fn(&mut Separated)| {
            let mut separated = example();
            change(&mut separated);
            Separated::from_bytes(&separated.to_bytes()).unwrap_err()
        };
        assert!(matches!(
            refused(|s| s.weights[0] = f64::NAN),
            Error::NotFinite { .. }
        ));
        assert!(matches!(
            refused(|s| s.factors[1][2] = f64::INFINITY),
            Error::NotFinite { .. }
        ));
        assert!(matches!(
            refused(|s| s.components = 3),
            Error::WrongLength { .. }
        ));
        assert!(matches!(
            refused(|s| s.components = usize::MAX),
            Error::WrongLength { .. }
        ));
        assert!(matches!(
            refused(|s| s.components = 0),
            Error::InvalidParameter { .. }
        ));
        assert!(matches!(
            refused(|s| {
                s.factors.pop();
            }),
            Error::WrongLength { .. }
        ));
        // An axis that cannot be built does not decode.
        let mut bytes = postcard::to_stdvec(&example()).unwrap();
        let position = bytes
            .windows(8)
            .position(|w| w == 0.5_f64.to_le_bytes())
            .unwrap();
        bytes[position..position + 8].copy_from_slice(&f64::NAN.to_le_bytes());
        assert!(postcard::from_bytes::<Separated>(&bytes).is_err());
    }
}
