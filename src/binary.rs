//! The frame of every file that this module's tables are saved in: magic, version, payload, checksum.
//!
//! Tables are flat arrays of `f32`, and the one that ships inside the crate has to load with no
//! optional feature, so they have a format of their own instead of a serialization library's:
//!
//! ```text
//! magic    8 bytes
//! version  u32, little-endian
//! payload  u64 header fields, f64 scalars, f32 arrays, little-endian, as each table documents
//! checksum u64, FNV-1a of everything before it
//! ```

use crate::Error;
use rapier3d::math::{Real, Vector};

/// Kind of file, as it appears in errors, and how it starts.
pub(crate) struct FileKind {
    pub name: &'static str,
    pub magic: [u8; 8],
    pub version: u32,
}

const PREFIX: usize = 12;
const CHECKSUM: usize = 8;

/// FNV-1a, 64 bits: catches altered files; it is no signature.
fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// Writes one file.
pub(crate) struct Writer(Vec<u8>);

impl Writer {
    pub fn new(kind: &FileKind) -> Self {
        let mut bytes = kind.magic.to_vec();
        bytes.extend(kind.version.to_le_bytes());
        Self(bytes)
    }

    pub fn u64(&mut self, value: u64) {
        self.0.extend(value.to_le_bytes());
    }

    pub fn f64(&mut self, value: f64) {
        self.0.extend(value.to_le_bytes());
    }

    pub fn f32(&mut self, value: f32) {
        self.0.extend(value.to_le_bytes());
    }

    pub fn finish(mut self) -> Vec<u8> {
        let sum = checksum(&self.0);
        self.0.extend(sum.to_le_bytes());
        self.0
    }
}

/// Reads one file; the payload is consumed from the front.
pub(crate) struct Reader<'a> {
    kind: &'a FileKind,
    whole: usize,
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    /// Checks magic, version and checksum.
    pub fn new(kind: &'a FileKind, bytes: &'a [u8]) -> Result<Self, Error> {
        let file = kind.name;
        if bytes.len() < 8 || bytes[..8] != kind.magic {
            return Err(Error::WrongFileKind { file });
        }
        if bytes.len() < PREFIX + CHECKSUM {
            return Err(Error::WrongFileLength {
                file,
                expected: (PREFIX + CHECKSUM) as u64,
                found: bytes.len() as u64,
            });
        }
        let mut version = [0; 4];
        version.copy_from_slice(&bytes[8..PREFIX]);
        let found = u32::from_le_bytes(version);
        if found != kind.version {
            return Err(Error::UnsupportedFileVersion {
                file,
                found,
                supported: kind.version,
            });
        }
        Ok(Self {
            kind,
            whole: bytes.len(),
            rest: &bytes[PREFIX..],
        })
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        // The checksum at the end is never payload.
        if self.rest.len() < N + CHECKSUM {
            return Err(Error::WrongFileLength {
                file: self.kind.name,
                expected: (self.whole - self.rest.len() + N + CHECKSUM) as u64,
                found: self.whole as u64,
            });
        }
        let (head, rest) = self.rest.split_at(N);
        self.rest = rest;
        let mut value = [0; N];
        value.copy_from_slice(head);
        Ok(value)
    }

    pub fn u64(&mut self) -> Result<u64, Error> {
        Ok(u64::from_le_bytes(self.take()?))
    }

    /// A length, at most `limit` (so that products of lengths cannot overflow).
    pub fn length(&mut self, parameter: &'static str, limit: u64) -> Result<usize, Error> {
        let value = self.u64()?;
        Error::check(
            parameter,
            value as f64,
            value <= limit,
            "no larger than the format allows",
        )?;
        Ok(value as usize)
    }

    /// Three lengths.
    pub fn lengths(&mut self, parameter: &'static str, limit: u64) -> Result<[usize; 3], Error> {
        let mut next = || self.length(parameter, limit);
        Ok([next()?, next()?, next()?])
    }

    /// Three numbers.
    pub fn three(&mut self, parameter: &'static str) -> Result<[f64; 3], Error> {
        let mut next = || self.f64(parameter);
        Ok([next()?, next()?, next()?])
    }

    /// A vector, stored as three f64.
    pub fn vector(&mut self, parameter: &'static str) -> Result<Vector, Error> {
        let vector = self.three(parameter)?.map(|x| x as Real);
        for x in vector {
            Error::check_finite(parameter, x.into())?;
        }
        Ok(Vector::from_array(vector))
    }

    pub fn f64(&mut self, parameter: &'static str) -> Result<f64, Error> {
        Error::check_finite(parameter, f64::from_le_bytes(self.take()?))
    }

    pub fn f32(&mut self, parameter: &'static str) -> Result<f32, Error> {
        let value = f32::from_le_bytes(self.take()?);
        Error::check_finite(parameter, f64::from(value))?;
        Ok(value)
    }

    /// Checks that exactly `bytes` of payload remain, *before* anything is allocated for them,
    /// then the checksum of the whole file.
    pub fn expect_payload(&self, whole: &[u8], bytes: u64) -> Result<(), Error> {
        let file = self.kind.name;
        let expected = (self.whole - self.rest.len()) as u64 + bytes + CHECKSUM as u64;
        if expected != self.whole as u64 {
            return Err(Error::WrongFileLength {
                file,
                expected,
                found: self.whole as u64,
            });
        }
        let (content, sum) = whole.split_at(whole.len() - CHECKSUM);
        let mut declared = [0; CHECKSUM];
        declared.copy_from_slice(sum);
        let declared = u64::from_le_bytes(declared);
        let found = checksum(content);
        if found != declared {
            return Err(Error::AlteredFile {
                file,
                declared,
                found,
            });
        }
        Ok(())
    }
}
