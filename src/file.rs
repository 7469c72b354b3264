//! The frame of every file of this crate: kind, version, length and checksum before the content.
//!
//! ```text
//! magic    8 bytes
//! version  u32
//! length   u64, bytes of content
//! checksum u64, FNV-1a of the content
//! content
//! ```
//!
//! All little-endian. What is small and structured is encoded by postcard ([`encode`], [`decode`]).
//! Tables are flat arrays of `f32` written by a [`Writer`]: the one that ships inside the crate has
//! to load with no optional feature.

use crate::error::Error;
use rapier3d::math::{Real, Vector};

/// Kind of file, as it appears in errors, and how it starts.
pub(crate) struct FileKind {
    pub name: &'static str,
    pub magic: [u8; 8],
    pub version: u32,
}

const HEADER: usize = 28;

/// FNV-1a, 64 bits: finds accidental alteration; it is no signature, so content is validated too.
fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// The file with this content.
fn seal(kind: &FileKind, content: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER + content.len());
    bytes.extend(kind.magic);
    bytes.extend(kind.version.to_le_bytes());
    bytes.extend((content.len() as u64).to_le_bytes());
    bytes.extend(checksum(content).to_le_bytes());
    bytes.extend(content);
    bytes
}

/// The content of a file, if it is of this kind, complete and unaltered.
fn open<'a>(kind: &FileKind, bytes: &'a [u8]) -> Result<&'a [u8], Error> {
    let file = kind.name;
    let mut rest = bytes;
    if take(&mut rest) != Some(kind.magic) {
        return Err(Error::WrongFileKind { file });
    }
    let wrong_length = |expected| Error::WrongFileLength {
        file,
        expected,
        found: bytes.len() as u64,
    };
    let short = || wrong_length(HEADER as u64);
    let version = u32::from_le_bytes(take(&mut rest).ok_or_else(short)?);
    if version != kind.version {
        return Err(Error::UnsupportedFileVersion {
            file,
            found: version,
            supported: kind.version,
        });
    }
    let length = u64::from_le_bytes(take(&mut rest).ok_or_else(short)?);
    let declared = u64::from_le_bytes(take(&mut rest).ok_or_else(short)?);
    if length != rest.len() as u64 {
        return Err(wrong_length(length.saturating_add(HEADER as u64)));
    }
    let found = checksum(rest);
    if found != declared {
        return Err(Error::AlteredFile {
            file,
            declared,
            found,
        });
    }
    Ok(rest)
}

/// The first `N` bytes, which are consumed.
fn take<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (head, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*head)
}

/// A file with `value` in postcard's encoding.
#[cfg(feature = "serde-serialize")]
pub(crate) fn encode<T: serde::Serialize>(kind: &FileKind, value: &T) -> Vec<u8> {
    let content = postcard::to_stdvec(value).expect("plain numbers and lists always encode");
    seal(kind, &content)
}

/// Reads what [`encode`] wrote; whether the value makes sense is for the caller to check.
#[cfg(feature = "serde-serialize")]
pub(crate) fn decode<T: serde::de::DeserializeOwned>(
    kind: &FileKind,
    bytes: &[u8],
) -> Result<T, Error> {
    let content = open(kind, bytes)?;
    match postcard::take_from_bytes(content) {
        Ok((value, [])) => Ok(value),
        _ => Err(Error::UndecodableFile {
            file: kind.name,
            length: content.len(),
        }),
    }
}

/// Writes the content of a table.
#[derive(Default)]
pub(crate) struct Writer(Vec<u8>);

impl Writer {
    pub fn u64(&mut self, value: u64) {
        self.0.extend(value.to_le_bytes());
    }

    pub fn f64(&mut self, value: f64) {
        self.0.extend(value.to_le_bytes());
    }

    pub fn f32(&mut self, value: f32) {
        self.0.extend(value.to_le_bytes());
    }

    pub fn finish(self, kind: &FileKind) -> Vec<u8> {
        seal(kind, &self.0)
    }
}

/// Reads the content of a table, consumed from the front.
pub(crate) struct Reader<'a> {
    kind: &'a FileKind,
    whole: usize,
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    /// Checks kind, version, length and checksum.
    pub fn new(kind: &'a FileKind, bytes: &'a [u8]) -> Result<Self, Error> {
        Ok(Self {
            kind,
            whole: bytes.len(),
            rest: open(kind, bytes)?,
        })
    }

    /// The file should have this many bytes more than were read so far.
    fn wrong_length(&self, more: u64) -> Error {
        Error::WrongFileLength {
            file: self.kind.name,
            expected: (self.whole - self.rest.len()) as u64 + more,
            found: self.whole as u64,
        }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        take(&mut self.rest).ok_or_else(|| self.wrong_length(N as u64))
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

    /// Checks that exactly `bytes` of content remain, *before* anything is allocated for them.
    pub fn expect_rest(&self, bytes: u64) -> Result<(), Error> {
        if bytes == self.rest.len() as u64 {
            Ok(())
        } else {
            Err(self.wrong_length(bytes))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KIND: FileKind = FileKind {
        name: "test",
        magic: *b"R3DITEST",
        version: 7,
    };

    #[test]
    fn each_fault_has_its_own_error() {
        let bytes = seal(&KIND, b"content");
        assert_eq!(open(&KIND, &bytes), Ok(&b"content"[..]));
        assert_eq!(
            open(&KIND, b"other"),
            Err(Error::WrongFileKind { file: "test" })
        );
        let altered = |at: usize| {
            let mut altered = bytes.clone();
            altered[at] ^= 1;
            open(&KIND, &altered).unwrap_err()
        };
        assert!(matches!(altered(0), Error::WrongFileKind { .. }));
        assert_eq!(
            altered(8),
            Error::UnsupportedFileVersion {
                file: "test",
                found: 6,
                supported: 7
            }
        );
        assert!(matches!(altered(12), Error::WrongFileLength { .. }));
        assert!(matches!(altered(20), Error::AlteredFile { .. }));
        assert!(matches!(altered(30), Error::AlteredFile { .. }));
        for length in 8..bytes.len() {
            let expected = if length < HEADER { HEADER } else { bytes.len() };
            assert_eq!(
                open(&KIND, &bytes[..length]),
                Err(Error::WrongFileLength {
                    file: "test",
                    expected: expected as u64,
                    found: length as u64
                })
            );
        }
    }

    #[test]
    fn tables_are_read_as_written_and_no_further() {
        let mut writer = Writer::default();
        writer.u64(3);
        writer.f64(0.5);
        writer.f32(f32::NAN);
        let bytes = writer.finish(&KIND);
        let mut reader = Reader::new(&KIND, &bytes).unwrap();
        assert_eq!(reader.length("count", 3), Ok(3));
        assert_eq!(reader.f64("half"), Ok(0.5));
        assert_eq!(reader.expect_rest(4), Ok(()));
        let expected = bytes.len() as u64 + 4;
        let found = bytes.len() as u64;
        let longer = Error::WrongFileLength {
            file: "test",
            expected,
            found,
        };
        assert_eq!(reader.expect_rest(8), Err(longer));
        assert!(reader.f32("number").is_err());
        assert!(matches!(reader.u64(), Err(Error::WrongFileLength { .. })));
    }
}
