//! The trajectory database: motion segments with their orientation, found by feature vector (thesis
//! § 3.3.2).

use super::segment::{HarmonicFlutter, Segment};
use super::tanabe_kaneko::AngleCurve;
use crate::error::Error;
use crate::math;
use rand::{Rng, RngExt};
use rapier3d::na::Vector2;
use rstar::RTree;
use rstar::primitives::GeomWithData;
use std::sync::{Arc, LazyLock};

/// A segment of the database.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// The segment, in units of U and a length of the body.
    pub segment: Segment,
    /// K-means class of its feature vector.
    pub class: u32,
    /// Which curve turns it back at its ends, index into [`TrajectoryDatabase::flutter`].
    pub flutter: u32,
    /// Which curve turns it over, index into [`TrajectoryDatabase::tumbling`].
    pub tumbling: u32,
}

/// Segments, the angles along them, and an index by feature vector.
///
/// [`TrajectoryDatabase::shipped`] is the one that ships with the crate; `TrajectoryDatabase::bake` (feature
/// `bake`) makes others.
///
/// ```
/// use rand::SeedableRng;
/// use rand_pcg::Pcg64Mcg;
/// use rapier3d_immersed::motion::path::TrajectoryDatabase;
/// use rapier3d_immersed::rapier3d::na::Vector2;
///
/// // The segment that comes nearest to a glide of two chords to the right and one down.
/// let database = TrajectoryDatabase::shipped();
/// let wanted = Vector2::new(2.0, -1.0);
/// let found = database.find(wanted, 0.0, &mut Pcg64Mcg::seed_from_u64(1));
/// assert!((found.segment.feature() - wanted).norm() < 0.5);
/// assert_eq!(found.class, database.class_of(wanted));
/// ```
#[derive(Clone, Debug)]
pub struct TrajectoryDatabase {
    pub(super) entries: Vec<Entry>,
    pub(super) classes: Vec<Vector2<f64>>,
    pub(super) flutter: Vec<AngleCurve>,
    pub(super) tumbling: Vec<AngleCurve>,
    /// Segments of each class, by place.
    index: Vec<RTree<GeomWithData<[f64; 2], u32>>>,
    /// Mean place of each class.
    centers: Vec<[f64; 2]>,
    flattest: f64,
}

impl PartialEq for TrajectoryDatabase {
    fn eq(&self, other: &Self) -> bool {
        (&self.entries, &self.classes) == (&other.entries, &other.classes)
            && (&self.flutter, &self.tumbling) == (&other.flutter, &other.tumbling)
    }
}

/// The place of a feature vector in the index, where lengths count by ratio, because they span decades.
pub(super) fn place(feature: &Vector2<f64>) -> [f64; 2] {
    let across = math::ln(feature.x.abs() + 1e-3) - math::ln(1e-3);
    [across.copysign(feature.x), math::ln((-feature.y).max(1e-9))]
}

impl TrajectoryDatabase {
    /// A database of these parts.
    ///
    /// # Errors
    /// [`Error::WrongLength`] if there is no entry, class or curve of a kind;
    /// [`Error::InvalidParameter`], [`Error::OutOfRange`] or [`Error::NotFinite`] names what is wrong
    /// with one.
    pub fn new(
        entries: Vec<Entry>,
        classes: Vec<Vector2<f64>>,
        flutter: Vec<AngleCurve>,
        tumbling: Vec<AngleCurve>,
    ) -> Result<Self, Error> {
        for (what, count) in [
            ("segments of the database", entries.len()),
            ("classes of the database", classes.len()),
            ("flutter curves of the database", flutter.len()),
            ("tumbling curves of the database", tumbling.len()),
        ] {
            if count == 0 {
                return Err(Error::WrongLength {
                    what,
                    expected: 1,
                    actual: 0,
                });
            }
        }
        for class in &classes {
            Error::check_all_finite("class of the database", class.as_slice())?;
        }
        for curve in flutter.iter().chain(&tumbling) {
            Error::check_range("slope of an angle curve", curve.slope, 0.0, 1e3)?;
            for angle in curve.angles {
                Error::check_range("angle of a curve", angle, -10.0, 10.0)?;
            }
        }
        for entry in &entries {
            let HarmonicFlutter {
                horizontal,
                vertical,
                frequency,
            } = entry.segment.flutter;
            Error::check_range("horizontal amplitude", horizontal, 0.0, 1e3)?;
            Error::check_range("vertical amplitude", vertical, 0.0, 1e3)?;
            Error::check_range("frequency", frequency, 1e-4, 1e4)?;
            let below = |what, index: u32, count: usize| {
                Error::check_range(what, f64::from(index), 0.0, count as f64 - 1.0)
            };
            below("class of a segment", entry.class, classes.len())?;
            below("flutter curve of a segment", entry.flutter, flutter.len())?;
            below(
                "tumbling curve of a segment",
                entry.tumbling,
                tumbling.len(),
            )?;
        }
        let mut members = vec![Vec::new(); classes.len()];
        let mut flattest = std::f64::consts::FRAC_PI_2;
        for (index, entry) in entries.iter().enumerate() {
            let feature = entry.segment.feature();
            let point = GeomWithData::new(place(&feature), index as u32);
            members[entry.class as usize].push(point);
            flattest = flattest.min(math::atan2(-feature.y, feature.x.abs()));
        }
        let mut centers = Vec::with_capacity(classes.len());
        for (class, members) in members.iter().enumerate() {
            let count = members.len() as f64;
            let some = !members.is_empty();
            Error::check("class of the database", class as f64, some, "of a segment")?;
            let sum = |axis: usize| members.iter().map(|p| p.geom()[axis]).sum::<f64>();
            centers.push([sum(0) / count, sum(1) / count]);
        }
        Ok(Self {
            index: members.into_iter().map(RTree::bulk_load).collect(),
            centers,
            flattest,
            entries,
            classes,
            flutter,
            tumbling,
        })
    }

    /// The database that ships with the crate: `DatabaseParams::default()`, as
    /// `cargo run --release --features bake --example synthesis -- --write-database PATH` bakes it.
    pub fn shipped() -> Arc<Self> {
        static DATABASE: LazyLock<Arc<TrajectoryDatabase>> = LazyLock::new(|| {
            Arc::new(
                TrajectoryDatabase::from_bytes(include_bytes!("database.bin"))
                    .expect("the shipped database is valid, as a test asserts"),
            )
        });
        DATABASE.clone()
    }

    /// The segments.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Centers of the classes: mean feature vectors.
    pub fn classes(&self) -> &[Vector2<f64>] {
        &self.classes
    }

    /// Angles of segments that turn back.
    pub fn flutter(&self) -> &[AngleCurve] {
        &self.flutter
    }

    /// Angles of segments that turn over.
    pub fn tumbling(&self) -> &[AngleCurve] {
        &self.tumbling
    }

    /// Angle to the horizontal of the flattest feature vector, rad.
    pub(super) fn flattest(&self) -> f64 {
        self.flattest
    }

    /// The class of a feature vector: the one whose mean is nearest, by ratio of lengths.
    pub fn class_of(&self, feature: Vector2<f64>) -> u32 {
        let here = place(&feature);
        let distance = |center: &[f64; 2]| math::hypot(center[0] - here[0], center[1] - here[1]);
        let mut best = 0;
        for (class, center) in self.centers.iter().enumerate() {
            if distance(center) < distance(&self.centers[best]) {
                best = class;
            }
        }
        best as u32
    }

    /// A segment of the class of a feature vector: drawn among the share `variety` ∈ [0, 1] of the class
    /// that is nearest to the vector by ratio of lengths. With 0 it is the nearest; of several with the
    /// same feature vector (they differ in A_y) one is drawn.
    pub fn find(&self, feature: Vector2<f64>, variety: f64, random: &mut impl Rng) -> &Entry {
        let index = &self.index[self.class_of(feature) as usize];
        let near = (variety * index.size() as f64) as usize;
        let rank = random.random_range(0..near.clamp(1, index.size()));
        let place = place(&feature);
        let drawn = index.nearest_neighbor_iter(place).nth(rank);
        let drawn =
            drawn.expect("a class has at least one segment, and the rank is below its size");
        let mut equal: Vec<u32> = index
            .locate_all_at_point(*drawn.geom())
            .map(|point| point.data)
            .collect();
        equal.sort_unstable();
        let chosen = equal[random.random_range(0..equal.len())];
        &self.entries[chosen as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    fn distance(a: &Vector2<f64>, b: &Vector2<f64>) -> f64 {
        let (a, b) = (place(a), place(b));
        (a[0] - b[0]).hypot(a[1] - b[1])
    }

    fn queries() -> impl Iterator<Item = Vector2<f64>> {
        let mut random = Pcg64Mcg::seed_from_u64(3);
        (0..200).map(move |_| {
            let across = random.random_range(-4.0..4.0);
            Vector2::new(across, -random.random_range(0.1..20.0))
        })
    }

    /// The index of a class finds what a search through all of its segments finds.
    #[test]
    fn the_nearest_of_the_class_is_found() {
        let database = TrajectoryDatabase::shipped();
        let mut random = Pcg64Mcg::seed_from_u64(4);
        for feature in queries() {
            let class = database.class_of(feature);
            let found = database.find(feature, 0.0, &mut random);
            assert_eq!(found.class, class);
            let members = database.entries().iter().filter(|e| e.class == class);
            let distances = members.map(|e| distance(&e.segment.feature(), &feature));
            let least = distances.fold(f64::MAX, f64::min);
            assert_eq!(distance(&found.segment.feature(), &feature), least);
        }
    }

    /// What is drawn is of the query's class and among its nearest, and all of them come up; with
    /// variety 1 any segment of the class may.
    #[test]
    fn variety_draws_within_the_class() {
        let database = TrajectoryDatabase::shipped();
        let mut random = Pcg64Mcg::seed_from_u64(5);
        for feature in queries().take(8) {
            let class = database.class_of(feature);
            let members = database.entries().iter().filter(|e| e.class == class);
            let mut distances: Vec<f64> = members
                .map(|e| distance(&e.segment.feature(), &feature))
                .collect();
            distances.sort_by(f64::total_cmp);
            for variety in [0.1, 1.0] {
                let count = (variety * distances.len() as f64) as usize;
                let mut seen = std::collections::BTreeSet::new();
                for _ in 0..6000 {
                    let found = database.find(feature, variety, &mut random);
                    assert_eq!(found.class, class);
                    let away = distance(&found.segment.feature(), &feature);
                    assert!(away <= distances[count - 1]);
                    seen.insert(away.to_bits());
                }
                let mut near: Vec<u64> = distances[..count].iter().map(|d| d.to_bits()).collect();
                near.dedup();
                assert_eq!(seen.len(), near.len());
            }
        }
    }

    /// The classes are those of K-means: every segment is nearest to the mean of its own.
    #[test]
    fn segments_belong_to_their_class() {
        let database = TrajectoryDatabase::shipped();
        for entry in database.entries() {
            assert_eq!(database.class_of(entry.segment.feature()), entry.class);
        }
    }
}
