//! Saving and loading added mass: magic, version, length, checksum, content in postcard's encoding.

use super::AddedMass;
use crate::Error;
use serde::{Serialize, de::DeserializeOwned};

const VERSION: u32 = 1;
/// Magic (8), version (4), length of the content (8), checksum of the content (8); little endian.
const HEADER: usize = 28;
const MAGIC: [u8; 8] = *b"R3DI-ADM";

/// FNV-1a, 64 bit: finds accidental alteration; intended ones are for the content's own checks.
fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

pub(crate) fn encode<T: Serialize>(magic: &[u8; 8], value: &T) -> Vec<u8> {
    let content = postcard::to_stdvec(value).expect("plain numbers and lists always encode");
    let mut bytes = Vec::with_capacity(HEADER + content.len());
    bytes.extend(magic);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend((content.len() as u64).to_le_bytes());
    bytes.extend(checksum(&content).to_le_bytes());
    bytes.extend(content);
    bytes
}

pub(crate) fn decode<T: DeserializeOwned>(
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
    let wrong_length = |expected, actual| Error::WrongLength {
        what: "bytes of a file",
        expected,
        actual,
    };
    if bytes.len() < HEADER {
        return Err(wrong_length(HEADER, bytes.len()));
    }
    let word = |at: usize| {
        let mut word = [0; 8];
        word.copy_from_slice(&bytes[at..at + 8]);
        u64::from_le_bytes(word)
    };
    let version = u32::from_le_bytes([bytes[8], bytes[9], bytes[10], bytes[11]]);
    if version != VERSION {
        return Err(Error::WrongVersion {
            expected: VERSION,
            found: version,
        });
    }
    let content = &bytes[HEADER..];
    let length = usize::try_from(word(12)).unwrap_or(usize::MAX);
    if length != content.len() {
        return Err(wrong_length(length.saturating_add(HEADER), bytes.len()));
    }
    let (expected, found) = (word(20), checksum(content));
    if expected != found {
        return Err(Error::WrongChecksum { expected, found });
    }
    match postcard::take_from_bytes(content) {
        Ok((value, [])) => Ok(value),
        _ => Err(Error::Undecodable { what, length }),
    }
}

impl AddedMass {
    /// The bytes of a file.
    pub fn to_bytes(&self) -> Vec<u8> {
        encode(&MAGIC, self)
    }

    /// Reads what [`AddedMass::to_bytes`] wrote.
    ///
    /// # Errors
    /// Of the file: [`Error::WrongMagic`], [`Error::WrongVersion`], [`Error::WrongLength`],
    /// [`Error::WrongChecksum`], [`Error::Undecodable`]; of its content:
    /// [`Error::UnphysicalAddedMass`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let added: Self = decode(&MAGIC, "an added mass", bytes)?;
        if added.is_physical() {
            Ok(added)
        } else {
            Err(Error::UnphysicalAddedMass)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier3d::na::Vector3;

    #[test]
    fn round_trip_and_refusals() {
        let added = AddedMass::diagonal(Vector3::new(1.0, 2.0, 3.0), Vector3::new(0.1, 0.2, 0.0));
        let bytes = added.to_bytes();
        assert_eq!(AddedMass::from_bytes(&bytes), Ok(added));
        for cut in 0..bytes.len() {
            assert!(AddedMass::from_bytes(&bytes[..cut]).is_err());
        }
        for byte in 0..bytes.len() {
            let mut altered = bytes.clone();
            altered[byte] ^= 1;
            assert!(AddedMass::from_bytes(&altered).is_err(), "byte {byte}");
        }
        let negative = AddedMass::diagonal(Vector3::new(-1.0, 2.0, 3.0), Vector3::zeros());
        assert_eq!(
            AddedMass::from_bytes(&negative.to_bytes()),
            Err(Error::UnphysicalAddedMass)
        );
        let mut other = bytes;
        other[8] = 9;
        assert_eq!(
            AddedMass::from_bytes(&other),
            Err(Error::WrongVersion {
                expected: 1,
                found: 9
            })
        );
    }
}
