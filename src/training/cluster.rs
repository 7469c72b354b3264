//! The thesis's classification: k-means over two numbers of each fall, labels by rule (§ 5.4.2).

use super::sweep::Sample;
#[cfg(feature = "bake")]
use crate::error::Error;
use crate::math;
use crate::motion::Pattern;

/// Which two numbers of a fall are clustered.
///
/// The thesis says of its (d, e) that "the motion patterns can be discriminated correctly" without the
/// orientation. That is not what is found here: against the direct classifier, which sees the orientation, they
/// agree hardly better than by chance, and numbers of the orientation do. Cohen's κ of the four labels
/// (example `patterns`; 9³ falls each, 11³ of the leaf over (0, 2π)³; the falls of the first line are SD 137, AR 15,
/// AZ 130, ZZ 447):
///
/// | falls | [`Path`](Self::Path) | [`Turning`](Self::Turning) | [`Flips`](Self::Flips) |
/// |---|---|---|---|
/// | card, thesis's law | .27 | .73 | .82 |
/// | leaf, thesis's law, to 2π | .17 | .47 | .69 |
/// | card, default law | .04 | .74 | .88 |
/// | leaf, default law | .05 | .68 | .88 |
///
/// A body that shows two patterns only, as a card of twice the mass under the thesis's law does, is cut into four clusters
/// all the same, and none of the three agrees then (κ of 0.1 to 0.2). Of the card under the law as printed
/// ([`ThesisLaw::printed`](crate::ThesisLaw::printed)), whose tumbling is rare, flips give .44 and turning .25. The features were
/// chosen on the falls of the table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Features {
    /// The thesis's: log₁₀(d/L + 0.1) and e, so that one body flung far away (its law pumps energy into some)
    /// does not get a cluster of its own. Labels follow the means of d: the nearest cluster is steady
    /// descent, the farthest autorotation, and of the two between the nearer is the zigzag (thesis Fig. 5.7, by
    /// its list of figures: SD 1.25, ZZ 5.69, AZ 13.72, AR 22.43, taken as cm; the caption itself repeats 1.25 for
    /// AZ).
    #[default]
    Path,
    /// How the body turns ([`AttitudeSpread`](crate::motion::AttitudeSpread)): σ/(σ + 0.05 rad) of the spread σ
    /// of its tilt, and the coherence of its rotation. The cluster whose tilt hardly changes is steady
    /// descent; of the others rotation is the most coherent in autorotation and the least in the zigzag. Nothing of
    /// it is counted by the direct classifier, so that each checks the other.
    Turning,
    /// The same with the share of flips that the direct classifier counts
    /// ([`Observation::tumbling`](crate::motion::Observation::tumbling)) in place of the coherence.
    Flips,
}

/// Spread of the tilt beyond which more of it makes little difference, rad (3°): what a classifier calls a swing
/// is some 12° from end to end.
const STEADY: f64 = 0.05;

impl Features {
    fn of(self, length: f64, sample: &Sample) -> [f64; 2] {
        let tilt = sample.attitude.tilt;
        let swing = tilt / (tilt + STEADY);
        match self {
            Self::Path => [
                math::log10(sample.distance / length + 0.1),
                sample.eccentricity,
            ],
            Self::Turning => [swing, sample.attitude.coherence],
            Self::Flips => [swing, sample.flips],
        }
    }

    /// Puts centers into the order of [`Pattern::ALL`].
    #[cfg(feature = "bake")]
    fn name(self, mut centers: [[f64; 2]; 4]) -> [[f64; 2]; 4] {
        centers.sort_by(|a, b| a[0].total_cmp(&b[0]));
        if self == Self::Path {
            let [steady, zigzag, chaotic, autorotation] = centers;
            return [steady, autorotation, chaotic, zigzag];
        }
        centers[1..].sort_by(|a, b| b[1].total_cmp(&a[1]));
        centers
    }
}

/// Four clusters of falls.
///
/// ```
/// use rapier3d_immersed::motion::{Pattern, Regime};
/// use rapier3d_immersed::training::{Clusters, Features, Sample};
///
/// // Centers of a leaf of L = 3.5 cm at the distances of thesis Fig. 5.7.
/// let [sd, ar, az, zz] = [0.0125, 0.2243, 0.1372, 0.0569].map(|d: f64| [(d / 0.035 + 0.1).log10(), 0.9]);
/// let clusters = Clusters { features: Features::Path, length: 0.035, centers: [sd, ar, az, zz] };
/// let far = Sample {
///     distance: 0.3,
///     eccentricity: 0.9,
///     attitude: Default::default(),
///     flips: 1.0,
///     regime: Regime::PeriodicTumbling,
///     simulated: true,
/// };
/// assert_eq!(clusters.label(&far), Pattern::Autorotation);
/// assert_eq!(clusters.agreement([&far]), 1.0); // the direct classifier says tumbling, too
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Clusters {
    /// What is clustered.
    pub features: Features,
    /// L: length that d is measured in, m.
    pub length: f64,
    /// Centers in the features, in the order of [`Pattern::ALL`].
    pub centers: [[f64; 2]; 4],
}

impl Clusters {
    /// Pattern of the nearest center.
    pub fn label(&self, sample: &Sample) -> Pattern {
        let at = self.features.of(self.length, sample);
        let distance =
            |center: &[f64; 2]| (center[0] - at[0]).powi(2) + (center[1] - at[1]).powi(2);
        let mut best = 0;
        for i in 1..4 {
            if distance(&self.centers[i]) < distance(&self.centers[best]) {
                best = i;
            }
        }
        Pattern::ALL[best]
    }

    /// Share of samples for which the direct classifier says the same.
    pub fn agreement<'a>(&self, samples: impl IntoIterator<Item = &'a Sample>) -> f64 {
        let (mut same, mut count) = (0usize, 0usize);
        for sample in samples {
            same += usize::from(self.label(sample) == sample.pattern());
            count += 1;
        }
        same as f64 / count.max(1) as f64
    }

    /// Cohen's κ of the labels against those of the direct classifier: 1 if they are the same, 0 if they agree as
    /// often as by chance; 0 too if either has one label only.
    pub fn kappa<'a>(&self, samples: impl IntoIterator<Item = &'a Sample>) -> f64 {
        let table = self.confusion(samples).map(|row| row.map(|n| n as f64));
        let whole: f64 = table.iter().flatten().sum();
        let same: f64 = (0..4).map(|i| table[i][i]).sum();
        let chance = |i: usize| {
            let column: f64 = table.iter().map(|row| row[i]).sum();
            table[i].iter().sum::<f64>() * column / whole
        };
        let chance: f64 = (0..4).map(chance).sum();
        if whole > chance {
            (same - chance) / (whole - chance)
        } else {
            0.0
        }
    }

    /// How often each pair of labels occurs: row by this clustering, column by the direct classifier,
    /// both in the order of [`Pattern::ALL`].
    pub fn confusion<'a>(&self, samples: impl IntoIterator<Item = &'a Sample>) -> [[usize; 4]; 4] {
        let mut table = [[0; 4]; 4];
        for sample in samples {
            table[self.label(sample).index()][sample.pattern().index()] += 1;
        }
        table
    }
}

#[cfg(feature = "bake")]
impl Clusters {
    /// Finds the clusters of samples in the thesis's (d, e) by k-means, the best of several seeded starts.
    ///
    /// ```
    /// use rapier3d_immersed::motion::Regime;
    /// use rapier3d_immersed::training::{Clusters, Sample};
    ///
    /// let sample = |distance| Sample {
    ///     distance,
    ///     eccentricity: 0.9,
    ///     attitude: Default::default(),
    ///     flips: 0.0,
    ///     regime: Regime::PeriodicFlutter,
    ///     simulated: true,
    /// };
    /// let near_and_far = [0.01, 0.011, 0.05, 0.055, 0.15, 0.16, 0.4, 0.42].map(sample);
    /// let clusters = Clusters::find(&near_and_far, 0.035, 1)?;
    /// let labels = near_and_far.map(|sample| clusters.label(&sample).abbreviation());
    /// assert_eq!(labels, ["SD", "SD", "ZZ", "ZZ", "AZ", "AZ", "AR", "AR"]);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if `length` (m) is not positive or a sample's d or e is not finite;
    /// [`Error::WrongLength`] if there are fewer than four samples; [`Error::TooFewClusters`] if they
    /// take less than four different values.
    pub fn find(samples: &[Sample], length: f64, seed: u64) -> Result<Self, Error> {
        Self::find_by(Features::Path, samples, length, seed)
    }

    /// [`Clusters::find`] in other numbers of the falls. The length, m, matters to [`Features::Path`] alone.
    ///
    /// # Errors
    /// Those of [`Clusters::find`].
    pub fn find_by(
        features: Features,
        samples: &[Sample],
        length: f64,
        seed: u64,
    ) -> Result<Self, Error> {
        use smartcore::cluster::kmeans::{KMeans, KMeansParameters};
        use smartcore::linalg::basic::matrix::DenseMatrix;
        const STARTS: u64 = 8;
        Error::check_positive("length", length)?;
        if samples.len() < 4 {
            return Err(Error::WrongLength {
                what: "samples to cluster",
                expected: 4,
                actual: samples.len(),
            });
        }
        let mut points = Vec::with_capacity(samples.len());
        for sample in samples {
            Error::check_not_negative("distance", sample.distance)?;
            Error::check_range("eccentricity", sample.eccentricity, 0.0, 1.0)?;
            Error::check_not_negative("tilt", sample.attitude.tilt)?;
            Error::check_range("coherence", sample.attitude.coherence, 0.0, 1.0)?;
            Error::check_range("flips", sample.flips, 0.0, 1.0)?;
            points.push(features.of(length, sample).to_vec());
        }
        let mut best: Option<(f64, [[f64; 2]; 4])> = None;
        let matrix = DenseMatrix::from_2d_vec(&points);
        for start in 0..STARTS {
            let parameters = KMeansParameters {
                k: 4,
                max_iter: 200,
                seed: Some(seed.wrapping_add(start)),
            };
            let Ok(matrix) = &matrix else { break };
            let Ok(fit) = KMeans::<f64, i32, _, Vec<i32>>::fit(matrix, parameters) else {
                continue;
            };
            let Ok(labels) = fit.predict(matrix) else {
                continue;
            };
            if let Some(found) = centers(&points, &labels)
                && best.is_none_or(|(scatter, _)| found.0 < scatter)
            {
                best = Some(found);
            }
        }
        let (_, centers) = best.ok_or(Error::TooFewClusters)?;
        Ok(Self {
            features,
            length,
            centers: features.name(centers),
        })
    }
}

/// Centers of labelled points and their scatter; `None` if a label is missing.
#[cfg(feature = "bake")]
fn centers(points: &[Vec<f64>], labels: &[i32]) -> Option<(f64, [[f64; 2]; 4])> {
    let mut sums = [[0.0; 3]; 4];
    for (point, label) in points.iter().zip(labels) {
        let sum = &mut sums[usize::try_from(*label).ok()?];
        for (s, x) in sum.iter_mut().zip([point[0], point[1], 1.0]) {
            *s += x;
        }
    }
    if sums.iter().any(|[_, _, count]| *count == 0.0) {
        return None;
    }
    let centers = sums.map(|[x, y, count]| [x / count, y / count]);
    let scatter = points.iter().zip(labels).map(|(point, label)| {
        let center = centers[*label as usize];
        (point[0] - center[0]).powi(2) + (point[1] - center[1]).powi(2)
    });
    Some((scatter.sum(), centers))
}

#[cfg(all(test, feature = "bake"))]
mod tests {
    use super::*;
    use crate::motion::{AttitudeSpread, Regime};
    use rand::{RngExt, SeedableRng};

    /// Four clouds around the values of thesis Fig. 5.7 are found and named by it.
    #[test]
    fn the_printed_patterns_are_named() {
        use Regime::*;
        let printed = [
            (0.0125, 0.72, SteadyDescent),
            (0.0569, 0.79, PeriodicFlutter),
            (0.1372, 0.93, TransitionalChaotic),
            (0.2243, 0.92, PeriodicTumbling),
        ];
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(3);
        let mut samples = Vec::new();
        for (d, e, regime) in printed {
            for _ in 0..50 {
                let mut spread = |size: f64| 1.0 + size * (random.random_range(0.0..2.0) - 1.0);
                samples.push(Sample {
                    distance: d * spread(0.15),
                    eccentricity: e * spread(0.02),
                    attitude: AttitudeSpread::default(),
                    flips: 0.0,
                    regime,
                    simulated: true,
                });
            }
        }
        let clusters = Clusters::find(&samples, 0.02, 1).unwrap();
        assert_eq!(clusters.agreement(&samples), 1.0);
        assert_eq!(clusters, Clusters::find(&samples, 0.02, 1).unwrap());
        let table = clusters.confusion(&samples);
        assert!((0..4).all(|i| table[i][i] == 50));
        assert_eq!(
            Clusters::find(&vec![samples[0]; 9], 0.02, 1),
            Err(Error::TooFewClusters)
        );
        assert!(Clusters::find(&samples[..3], 0.02, 1).is_err());
        assert!(Clusters::find(&samples, 0.0, 1).is_err());
    }

    /// Clouds of steady, tumbling, mixed and swinging falls are named by how they turn, and a tilt or coherence
    /// that cannot be is refused.
    #[test]
    fn turning_is_named() {
        use Regime::*;
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(4);
        let mut samples = Vec::new();
        for (tilt, turning, regime) in [
            (0.005, 0.3, SteadyDescent),
            (0.3, 0.1, PeriodicFlutter),
            (0.4, 0.5, TransitionalChaotic),
            (0.45, 0.95, PeriodicTumbling),
        ] {
            for _ in 0..50 {
                let mut spread = |size: f64| 1.0 + size * (random.random_range(0.0..2.0) - 1.0);
                samples.push(Sample {
                    distance: spread(0.9),
                    eccentricity: 0.5,
                    attitude: AttitudeSpread {
                        tilt: tilt * spread(0.2),
                        coherence: turning * spread(0.05),
                    },
                    flips: turning * spread(0.05),
                    regime,
                    simulated: true,
                });
            }
        }
        for features in [Features::Turning, Features::Flips] {
            let clusters = Clusters::find_by(features, &samples, 0.02, 1).unwrap();
            assert_eq!(clusters.agreement(&samples), 1.0, "{features:?}");
            assert_eq!(clusters.kappa(&samples), 1.0);
        }
        // Distances that say nothing: κ of 200 such falls is 0 with a standard deviation of some 0.04.
        let path = Clusters::find(&samples, 0.02, 1).unwrap();
        assert!(path.kappa(&samples).abs() < 0.15);
        let mut bad = samples.clone();
        bad[0].attitude.coherence = f64::NAN;
        assert!(Clusters::find_by(Features::Turning, &bad, 0.02, 1).is_err());
        bad[0].attitude = AttitudeSpread {
            tilt: -1.0,
            coherence: 0.0,
        };
        assert!(Clusters::find_by(Features::Turning, &bad, 0.02, 1).is_err());
    }
}
