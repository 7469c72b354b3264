//! Saving and loading added mass, in postcard's encoding.

use super::AddedMass;
use crate::error::Error;
use crate::file::{FileKind, decode, encode};

const FILE: FileKind = FileKind {
    name: "added mass",
    magic: *b"R3DI-ADM",
    version: 1,
};

impl AddedMass {
    /// The bytes of a file.
    pub fn to_bytes(&self) -> Vec<u8> {
        encode(&FILE, self)
    }

    /// Reads what [`AddedMass::to_bytes`] wrote.
    ///
    /// # Errors
    /// Of the file: [`Error::WrongFileKind`], [`Error::UnsupportedFileVersion`],
    /// [`Error::WrongFileLength`], [`Error::AlteredFile`], [`Error::UndecodableFile`]; of its
    /// content: [`Error::UnphysicalAddedMass`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let added: Self = decode(&FILE, bytes)?;
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
            Err(Error::UnsupportedFileVersion {
                file: "added mass",
                found: 9,
                supported: 1
            })
        );
    }
}
