//! The trajectory database as a file: flat numbers, read with no optional feature, and validated.

use super::database::{Entry, TrajectoryDatabase};
use super::segment::{Glide, HarmonicFlutter, Segment};
use super::tanabe_kaneko::AngleCurve;
use crate::error::Error;
use crate::file::{FileKind, Reader, Writer};
use rapier3d::na::Vector2;

const FILE: FileKind = FileKind {
    name: "trajectory database",
    magic: *b"R3DI-TDB",
    version: 1,
};

/// Entries, classes or curves that a file may hold.
const MOST: u64 = 1 << 20;

impl TrajectoryDatabase {
    /// The bytes of a file that holds this database.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut writer = Writer::default();
        writer.u64(self.entries.len() as u64);
        writer.u64(self.classes.len() as u64);
        writer.u64(self.flutter.len() as u64);
        writer.u64(self.tumbling.len() as u64);
        for entry in &self.entries {
            let flutter = entry.segment.flutter;
            writer.f64(entry.segment.glide.sign());
            writer.f64(flutter.horizontal);
            writer.f64(flutter.vertical);
            writer.f64(flutter.frequency);
            for index in [entry.class, entry.flutter, entry.tumbling] {
                writer.u64(index.into());
            }
        }
        for class in &self.classes {
            writer.f64(class.x);
            writer.f64(class.y);
        }
        for curve in self.flutter.iter().chain(&self.tumbling) {
            writer.f64(curve.slope);
            for angle in curve.angles {
                writer.f64(angle);
            }
        }
        writer.finish(&FILE)
    }

    /// Reads what [`TrajectoryDatabase::to_bytes`] wrote.
    ///
    /// # Errors
    /// If the bytes are of another kind or version, truncated, altered, or describe what
    /// [`TrajectoryDatabase::new`] refuses.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let mut reader = Reader::new(&FILE, bytes)?;
        let [entries, classes, flutter, tumbling] = [
            reader.length("segments of the database", MOST)?,
            reader.length("classes of the database", MOST)?,
            reader.length("flutter curves of the database", MOST)?,
            reader.length("tumbling curves of the database", MOST)?,
        ];
        let numbers = 7 * entries + 2 * classes + (1 + AngleCurve::SAMPLES) * (flutter + tumbling);
        reader.expect_rest(8 * numbers as u64)?;
        let mut read = Vec::with_capacity(entries);
        for _ in 0..entries {
            let sign = reader.f64("glide of a segment")?;
            let valid = sign == 1.0 || sign == -1.0;
            Error::check("glide of a segment", sign, valid, "1 or -1")?;
            let flutter = HarmonicFlutter {
                horizontal: reader.f64("horizontal amplitude")?,
                vertical: reader.f64("vertical amplitude")?,
                frequency: reader.f64("frequency")?,
            };
            let glide = if sign > 0.0 {
                Glide::Right
            } else {
                Glide::Left
            };
            read.push(Entry {
                segment: Segment { flutter, glide },
                class: reader.length("class of a segment", MOST)? as u32,
                flutter: reader.length("flutter curve of a segment", MOST)? as u32,
                tumbling: reader.length("tumbling curve of a segment", MOST)? as u32,
            });
        }
        let mut centers = Vec::with_capacity(classes);
        for _ in 0..classes {
            let across = reader.f64("class of the database")?;
            centers.push(Vector2::new(across, reader.f64("class of the database")?));
        }
        let mut curves = Vec::with_capacity(flutter + tumbling);
        for _ in 0..flutter + tumbling {
            let slope = reader.f64("slope of an angle curve")?;
            let mut angles = [0.0; AngleCurve::SAMPLES];
            for angle in &mut angles {
                *angle = reader.f64("angle of a curve")?;
            }
            curves.push(AngleCurve { slope, angles });
        }
        let tumbling = curves.split_off(flutter);
        Self::new(read, centers, curves, tumbling)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shipped_database_is_valid() {
        let database = TrajectoryDatabase::shipped();
        assert_eq!(
            TrajectoryDatabase::from_bytes(&database.to_bytes()).as_ref(),
            Ok(&*database)
        );
        assert!(database.entries().len() > 1000);
    }

    fn small() -> TrajectoryDatabase {
        let curve = AngleCurve {
            slope: 1.0,
            angles: [0.5; AngleCurve::SAMPLES],
        };
        let entry = |glide| Entry {
            segment: Segment {
                flutter: HarmonicFlutter {
                    horizontal: 1.0,
                    vertical: 0.5,
                    frequency: 2.0,
                },
                glide,
            },
            class: 0,
            flutter: 0,
            tumbling: 0,
        };
        TrajectoryDatabase::new(
            vec![entry(Glide::Left), entry(Glide::Right)],
            vec![Vector2::new(0.0, -1.0)],
            vec![curve.clone()],
            vec![curve],
        )
        .unwrap()
    }

    #[test]
    fn damaged_files_are_refused() {
        let bytes = small().to_bytes();
        assert_eq!(
            TrajectoryDatabase::from_bytes(&bytes).as_ref(),
            Ok(&small())
        );
        for length in 0..bytes.len() {
            assert!(TrajectoryDatabase::from_bytes(&bytes[..length]).is_err());
        }
        for at in 0..bytes.len() {
            let mut altered = bytes.clone();
            altered[at] ^= 0x04;
            assert!(TrajectoryDatabase::from_bytes(&altered).is_err(), "{at}");
        }
    }

    /// Files with the right frame and wrong content are refused.
    #[test]
    fn bad_databases_are_refused() {
        let refused = |change: &dyn Fn(&mut TrajectoryDatabase)| {
            let mut bad = small();
            change(&mut bad);
            assert!(TrajectoryDatabase::from_bytes(&bad.to_bytes()).is_err());
        };
        refused(&|d| d.entries.clear());
        refused(&|d| d.classes.clear());
        refused(&|d| d.flutter.clear());
        refused(&|d| d.entries[1].class = 1);
        refused(&|d| d.classes.push(Vector2::new(1.0, -1.0)));
        refused(&|d| d.entries[1].tumbling = 7);
        refused(&|d| d.entries[0].segment.flutter.frequency = 0.0);
        refused(&|d| d.entries[0].segment.flutter.horizontal = f64::NAN);
        refused(&|d| d.entries[0].segment.flutter.vertical = -1.0);
        refused(&|d| d.tumbling[0].angles[3] = f64::INFINITY);
        refused(&|d| d.flutter[0].slope = -1.0);
        refused(&|d| d.classes[0].x = f64::NAN);
    }
}
