//! Baking the trajectory database: parameter ranges, classes, orientations.

use super::database::{Entry, TrajectoryDatabase, place};
use super::segment::{Glide, HarmonicFlutter, Segment};
use super::tanabe_kaneko::{AngleCurve, Fall, TanabeKaneko};
use crate::error::Error;
use crate::math;
use rapier3d::na::Vector2;
use smartcore::cluster::kmeans::{KMeans, KMeansParameters};
use smartcore::linalg::basic::matrix::DenseMatrix;

/// The parameters of [`TrajectoryDatabase::bake`].
///
/// ```
/// use rapier3d_immersed::motion::path::{DatabaseParams, TrajectoryDatabase};
///
/// let params = DatabaseParams {
///     steps: [4, 2, 8],
///     classes: 4,
///     fluid_shares: vec![0.14],
///     ..DatabaseParams::default()
/// };
/// let (database, report) = TrajectoryDatabase::bake(&params)?;
/// assert_eq!(database.entries().len(), 2 * 4 * 2 * 8); // each segment glides left or right
/// assert!(report.flutter > 0 && report.tumbling > 0);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct DatabaseParams {
    /// Smallest and largest A_x, in U. Default 0.1 and 3.
    pub horizontal: [f64; 2],
    /// Smallest and largest A_y, in U. Default 0.3 and 0.9.
    pub vertical: [f64; 2],
    /// Smallest and largest Ω, in U/L. Default 0.08 and 12: a chaotic segment is up to ten times as
    /// large or small as a regular one.
    pub frequency: [f64; 2],
    /// How many values of each, equally spaced in the logarithm. Default 10, 3, 33.
    pub steps: [usize; 3],
    /// K-means classes. Default 12.
    pub classes: usize,
    /// Seed of the K-means. Default 1.
    pub seed: u64,
    /// Drag rates [A⊥, A∥] whose solutions give the orientations, each at every fluid share. Those
    /// that neither flutter nor tumble are dropped. Default: a grid of 4.1 … 10 and 0.15 … 0.9 that
    /// contains the two of thesis Fig. 3.4.
    pub drag: Vec<[f64; 2]>,
    /// ρ_f L/m of the solutions. Default 0.14, 0.18, 0.24.
    pub fluid_shares: Vec<f64>,
}

impl Default for DatabaseParams {
    fn default() -> Self {
        let across = [4.1, 4.6, 6.0, 8.0, 10.0];
        let pairs = across
            .iter()
            .flat_map(|a| [0.15, 0.5, 0.9].map(|b| [*a, b]));
        Self {
            horizontal: [0.1, 3.0],
            vertical: [0.3, 0.9],
            frequency: [0.08, 12.0],
            steps: [10, 3, 33],
            classes: 12,
            seed: 1,
            drag: pairs.collect(),
            fluid_shares: vec![0.14, 0.18, 0.24],
        }
    }
}

/// How many solutions of (3.4) did what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BakeReport {
    /// Solutions that flutter, of which the angles are kept.
    pub flutter: usize,
    /// Solutions that tumble, of which the angles are kept too.
    pub tumbling: usize,
    /// Solutions that do both. They are dropped, because a chaotic fall is put together from the others.
    pub chaotic: usize,
    /// Solutions without a steady swing (thesis Fig. 3.4b), which are dropped.
    pub straight: usize,
}

/// Length of a solution: 40 s at the default size, of which the second half counts.
const STEP: f64 = 4e-3;
const STEPS: usize = 10_000;
const RELEASE: f64 = 0.3;

impl TrajectoryDatabase {
    /// Bakes a database and says which solutions gave its orientations.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] names a parameter that cannot be;
    /// [`Error::WrongLength`] if no solution flutters, or none tumbles, or there are fewer segments
    /// than classes.
    pub fn bake(params: &DatabaseParams) -> Result<(Self, BakeReport), Error> {
        let values = |name, range: [f64; 2], count: usize| -> Result<Vec<f64>, Error> {
            Error::check_positive(name, range[0])?;
            Error::check_range(name, range[1], range[0], 1e3)?;
            Error::check_range("steps", count as f64, 1.0, 1e3)?;
            let span = (count.max(2) - 1) as f64;
            let ratio = range[1] / range[0];
            Ok((0..count)
                .map(|i| range[0] * math::powf(ratio, i as f64 / span))
                .collect())
        };
        let horizontal = values("horizontal amplitude", params.horizontal, params.steps[0])?;
        let vertical = values("vertical amplitude", params.vertical, params.steps[1])?;
        let frequency = values("frequency", params.frequency, params.steps[2])?;
        let (flutter, tumbling, report) = orientations(params)?;
        let mut segments = Vec::new();
        for glide in [Glide::Left, Glide::Right] {
            for horizontal in &horizontal {
                for vertical in &vertical {
                    for frequency in &frequency {
                        let flutter = HarmonicFlutter {
                            horizontal: *horizontal,
                            vertical: *vertical,
                            frequency: *frequency,
                        };
                        segments.push(Segment { flutter, glide });
                    }
                }
            }
        }
        let (labels, classes) = classify(&segments, params)?;
        let entries = segments.iter().zip(labels).map(|(segment, class)| {
            let feature = segment.feature();
            let slope = feature.x.abs() / -feature.y;
            Entry {
                segment: *segment,
                class,
                flutter: closest(&flutter, slope),
                tumbling: closest(&tumbling, slope),
            }
        });
        let database = Self::new(entries.collect(), classes, flutter, tumbling)?;
        Ok((database, report))
    }
}

/// The curve of the most similar slope.
fn closest(curves: &[AngleCurve], slope: f64) -> u32 {
    let difference = |curve: &AngleCurve| (curve.slope - slope).abs();
    let mut best = 0;
    for (index, curve) in curves.iter().enumerate() {
        if difference(curve) < difference(&curves[best]) {
            best = index;
        }
    }
    best as u32
}

type Orientations = (Vec<AngleCurve>, Vec<AngleCurve>, BakeReport);

fn orientations(params: &DatabaseParams) -> Result<Orientations, Error> {
    let (mut flutter, mut tumbling) = (Vec::new(), Vec::new());
    let mut report = BakeReport::default();
    for fluid_share in &params.fluid_shares {
        for [across, along] in &params.drag {
            let model = TanabeKaneko {
                across: *across,
                along: *along,
                fluid_share: *fluid_share,
                ..TanabeKaneko::default()
            };
            model.check()?;
            let states = model.solve(RELEASE, STEP, STEPS);
            match (Fall::of(&states), AngleCurve::of(&states)) {
                (Fall::Flutter, Some((_, curve))) => flutter.push(curve),
                (Fall::Tumbling, Some((_, curve))) => tumbling.push(curve),
                (Fall::Chaotic, _) => report.chaotic += 1,
                _ => report.straight += 1,
            }
        }
    }
    for (what, count) in [
        ("solutions that flutter", flutter.len()),
        ("solutions that tumble", tumbling.len()),
    ] {
        if count == 0 {
            return Err(Error::WrongLength {
                what,
                expected: 1,
                actual: 0,
            });
        }
    }
    (report.flutter, report.tumbling) = (flutter.len(), tumbling.len());
    Ok((flutter, tumbling, report))
}

/// K-means over the places of the feature vectors, the best of several seeded starts: labels and the
/// mean feature vector of each class that is not empty.
fn classify(
    segments: &[Segment],
    params: &DatabaseParams,
) -> Result<(Vec<u32>, Vec<Vector2<f64>>), Error> {
    const STARTS: u64 = 4;
    let most = segments.len() as f64;
    Error::check_range("classes", params.classes as f64, 2.0, most)?;
    let features: Vec<Vector2<f64>> = segments.iter().map(Segment::feature).collect();
    let places: Vec<Vec<f64>> = features.iter().map(|f| place(f).to_vec()).collect();
    let few = Error::WrongLength {
        what: "different segments of the database",
        expected: params.classes,
        actual: segments.len(),
    };
    let matrix = DenseMatrix::from_2d_vec(&places).map_err(|_| few.clone())?;
    let mut best: Option<(f64, Vec<i32>)> = None;
    for start in 0..STARTS {
        let parameters = KMeansParameters {
            k: params.classes,
            max_iter: 200,
            seed: Some(params.seed.wrapping_add(start)),
        };
        let fit = KMeans::<f64, i32, _, Vec<i32>>::fit(&matrix, parameters);
        let Ok(labels) = fit.and_then(|fit| fit.predict(&matrix)) else {
            continue;
        };
        let mut sums = vec![[0.0; 3]; params.classes];
        for (place, label) in places.iter().zip(&labels) {
            let sum = &mut sums[*label as usize];
            for (s, x) in sum.iter_mut().zip([place[0], place[1], 1.0]) {
                *s += x;
            }
        }
        let scatter: f64 = places
            .iter()
            .zip(&labels)
            .map(|(place, label)| {
                let [x, y, count] = sums[*label as usize];
                (place[0] - x / count).powi(2) + (place[1] - y / count).powi(2)
            })
            .sum();
        if best.as_ref().is_none_or(|(least, _)| scatter < *least) {
            best = Some((scatter, labels));
        }
    }
    let (_, labels) = best.ok_or(few)?;
    let mut used: Vec<i32> = labels.clone();
    used.sort_unstable();
    used.dedup();
    let labels: Vec<u32> = labels
        .iter()
        .map(|label| used.binary_search(label).unwrap_or(0) as u32)
        .collect();
    let mut classes = vec![(Vector2::zeros(), 0.0); used.len()];
    for (feature, label) in features.iter().zip(&labels) {
        let (sum, count) = &mut classes[*label as usize];
        *sum += feature;
        *count += 1.0;
    }
    let classes = classes.into_iter().map(|(sum, count)| sum / count);
    Ok((labels, classes.collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shipped file is what the defaults bake; angles are compared to what another machine's
    /// trigonometry may change in a solution that is not chaotic.
    #[test]
    fn the_shipped_database_is_the_default() {
        let (baked, report) = TrajectoryDatabase::bake(&DatabaseParams::default()).unwrap();
        let shipped = TrajectoryDatabase::shipped();
        assert_eq!(baked.entries(), shipped.entries());
        assert_eq!(baked.flutter().len(), shipped.flutter().len());
        for (a, b) in baked.flutter().iter().zip(shipped.flutter()) {
            assert!((a.slope - b.slope).abs() < 1e-6);
        }
        let drops = report.chaotic + report.straight;
        assert_eq!(report.flutter + report.tumbling + drops, 45);
        assert!(
            report.flutter >= 3 && report.tumbling >= 3 && drops >= 3,
            "{report:?}"
        );
    }

    /// Classes gather what is alike: no segment of a class glides the other way.
    #[test]
    fn classes_know_left_from_right() {
        let database = TrajectoryDatabase::shipped();
        for entry in database.entries() {
            let center = database.classes()[entry.class as usize];
            assert_eq!(center.x > 0.0, entry.segment.glide == Glide::Right);
        }
    }

    #[test]
    fn impossible_parameters_are_refused() {
        let refused = |change: &dyn Fn(&mut DatabaseParams)| {
            let mut params = DatabaseParams::default();
            change(&mut params);
            assert!(TrajectoryDatabase::bake(&params).is_err());
        };
        refused(&|p| p.frequency = [0.0, 1.0]);
        refused(&|p| p.horizontal = [2.0, 1.0]);
        refused(&|p| p.vertical[1] = f64::NAN);
        refused(&|p| p.steps[1] = 0);
        refused(&|p| p.classes = 1);
        refused(&|p| p.classes = 1_000_000);
        refused(&|p| p.drag = vec![[-1.0, 0.5]]);
        refused(&|p| p.drag = vec![[10.0, 0.9]]);
        refused(&|p| p.drag.clear());
    }
}
