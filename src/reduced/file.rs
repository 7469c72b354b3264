//! Saving and loading: magic, version, length, checksum, then the content in postcard's encoding.

use super::separated::Separated;
use super::surrogate::{FlowMap, TrajectorySurrogate};
use super::tensor_train::TensorTrain;
use crate::Error;
use serde::{Serialize, de::DeserializeOwned};

const VERSION: u32 = 1;
/// Magic (8), version (4), length of the content (8), checksum of the content (8); little endian.
const HEADER: usize = 28;

/// FNV-1a, 64 bit: finds any accidental alteration with near certainty; no protection against
/// intended ones, for which the content is validated as well.
fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

fn encode<T: Serialize>(magic: &[u8; 8], value: &T) -> Vec<u8> {
    let content = postcard::to_stdvec(value).expect("plain numbers and lists always encode");
    let mut bytes = Vec::with_capacity(HEADER + content.len());
    bytes.extend_from_slice(magic);
    bytes.extend_from_slice(&VERSION.to_le_bytes());
    bytes.extend_from_slice(&(content.len() as u64).to_le_bytes());
    bytes.extend_from_slice(&checksum(&content).to_le_bytes());
    bytes.extend_from_slice(&content);
    bytes
}

fn decode<T: DeserializeOwned>(
    magic: &[u8; 8],
    what: &'static str,
    bytes: &[u8],
) -> Result<T, Error> {
    let mut found = [0; 8];
    let start = bytes.len().min(8);
    found[..start].copy_from_slice(&bytes[..start]);
    if found != *magic {
        return Err(Error::WrongMagic {
            expected: *magic,
            found,
        });
    }
    if bytes.len() < HEADER {
        return Err(Error::WrongLength {
            what: "bytes of a file's header",
            expected: HEADER,
            actual: bytes.len(),
        });
    }
    let word = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes"));
    let version = u32::from_le_bytes(bytes[8..12].try_into().expect("four bytes"));
    if version != VERSION {
        return Err(Error::WrongVersion {
            expected: VERSION,
            found: version,
        });
    }
    let content = &bytes[HEADER..];
    let length = usize::try_from(word(12)).unwrap_or(usize::MAX);
    Error::check_length("bytes of a file's content", length, content.len())?;
    let (expected, found) = (word(20), checksum(content));
    if expected != found {
        return Err(Error::WrongChecksum { expected, found });
    }
    match postcard::take_from_bytes(content) {
        Ok((value, [])) => Ok(value),
        _ => Err(Error::Undecodable { what, length }),
    }
}

macro_rules! saved {
    ($type:ident, $magic:literal, $what:literal) => {
        impl $type {
            /// This as the bytes of a file.
            pub fn to_bytes(&self) -> Vec<u8> {
                encode($magic, self)
            }

            /// Reads what `to_bytes` wrote.
            ///
            /// # Errors
            /// If the bytes are of another kind or version, truncated, altered, or describe
            /// something inconsistent or not finite.
            pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
                let loaded: Self = decode($magic, $what, bytes)?;
                loaded.check()?;
                Ok(loaded)
            }
        }
    };
}

saved!(Separated, b"R3DI-SEP", "a separated representation");
saved!(TensorTrain, b"R3DI-TTR", "a tensor train");
saved!(TrajectorySurrogate, b"R3DI-TRJ", "a trajectory surrogate");
saved!(FlowMap, b"R3DI-FLO", "a flow map");

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
            Err(Error::WrongMagic { .. })
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
