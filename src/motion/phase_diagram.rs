//! The Re–I* phase diagram: which regime a body falls in (thesis Fig. 3.3).

use super::estimates::FallEstimates;
use super::numbers::DimensionlessNumbers;
use super::pattern::Regime;
use crate::error::Error;
use crate::math;

/// Re (by mean descent) against I* where steady descent ends: Field, Klaus, Moore & Nori, *Nature*
/// 388 (1997), as the public data of Howison et al. (2020) hold them, in order of I*.
const STEADY: [(f64, f64); 17] = [
    (2.027e-4, 140.9),
    (3.241e-4, 156.4),
    (4.965e-4, 161.3),
    (6.413e-4, 161.3),
    (8.644e-4, 158.0),
    (1.165e-3, 145.4),
    (1.729e-3, 126.9),
    (2.095e-3, 116.8),
    (2.621e-3, 106.3),
    (3.385e-3, 97.8),
    (4.372e-3, 94.8),
    (5.708e-3, 89.0),
    (1.191e-2, 89.0),
    (1.475e-2, 92.8),
    (1.988e-2, 98.8),
    (2.918e-2, 108.5),
    (5.246e-2, 135.1),
];
/// I* against Re where flutter becomes chaotic (same source). The first two points make the curve
/// upright: no disc flutters left of it, whatever its I*.
const CHAOTIC: [(f64, f64); 16] = [
    (155.4, 5.676e-2),
    (155.5, 4.051e-2),
    (162.1, 2.609e-2),
    (198.2, 1.845e-2),
    (232.4, 1.446e-2),
    (284.2, 1.293e-2),
    (344.7, 1.144e-2),
    (428.6, 1.013e-2),
    (551.2, 9.759e-3),
    (739.2, 8.971e-3),
    (1016.6, 8.560e-3),
    (1386.3, 8.323e-3),
    (1971.5, 8.560e-3),
    (2899.3, 8.560e-3),
    (8916.9, 9.669e-3),
    (26968.0, 1.092e-2),
];
/// I* against Re where chaotic motion becomes tumbling (same source).
const TUMBLING: [(f64, f64); 7] = [
    (162.5, 3.759e-2),
    (344.4, 3.759e-2),
    (722.5, 3.939e-2),
    (1979.4, 4.014e-2),
    (4584.2, 4.090e-2),
    (11605.0, 4.206e-2),
    (34407.0, 4.491e-2),
];

/// Regimes over Re (by mean descent) and I*.
///
/// Steady, periodic, chaotic and tumbling motion are separated by the curves measured with discs by
/// Field et al. (1997). Helix and spiral have no public numeric boundary: they lie in the periodic
/// region above the Reynolds number where the flutter's amplitude stops growing (Zhong et al. 2013),
/// in the order flutter, helix, spiral as I* falls (Zhong, Chen & Lee 2011). The I* of the spiral is
/// where this crate's own discs begin to circle ([`FallEstimates`]); they do so at Reynolds numbers of
/// some hundred too, whatever was published. Four of 12 000 stay in a helix: its I* is a convention, the
/// geometric mean of the coin and the leaf that the thesis prints ([`PhaseDiagram::THESIS_CASES`]).
///
/// ```
/// use rapier3d_immersed::motion::{PhaseDiagram, Regime};
///
/// let diagram = PhaseDiagram::default();
/// assert_eq!(diagram.regime(50.0, 0.01), Regime::SteadyDescent);
/// assert_eq!(diagram.regime(1000.0, 0.1), Regime::PeriodicTumbling);
/// // The thesis's coin flutters, within the scatter of the measured boundary of chaos.
/// let coin = PhaseDiagram::THESIS_CASES[0];
/// let near = diagram.neighbours(coin.reynolds, coin.i_star, 0.2);
/// assert!(near.contains(&Regime::PeriodicFlutter));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseDiagram {
    /// Re above which periodic motion can leave its plane (default 2000).
    pub helix_reynolds: f64,
    /// I* below which it does so as a helix (default 7.9·10⁻³, a convention).
    pub helix_below: f64,
    /// I* below which it is a spiral (default from own falls, 4.34·10⁻³, with 4 % of them on the wrong side).
    pub spiral_below: f64,
}

impl Default for PhaseDiagram {
    fn default() -> Self {
        Self {
            helix_reynolds: 2000.0,
            helix_below: 7.9e-3,
            spiral_below: FallEstimates::shipped().spiral_below(),
        }
    }
}

/// A named point of the diagram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// What falls.
    pub name: &'static str,
    /// Re as printed.
    pub reynolds: f64,
    /// I* as printed.
    pub i_star: f64,
    /// The main motion pattern, as the thesis reads it off its own diagram.
    pub regime: Regime,
}

/// A curve of the diagram, for drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// Regimes on its two sides.
    pub between: [Regime; 2],
    /// Points (Re, I*).
    pub points: Vec<(f64, f64)>,
    /// Whether it was measured; otherwise it is a convention or from own falls.
    pub measured: bool,
}

impl PhaseDiagram {
    /// The cases of thesis § 3.6 with Re and I* **as printed**. Those of paper and leaf do not follow from
    /// the thesis's own formulas, which [`DimensionlessNumbers`](super::DimensionlessNumbers) uses.
    pub const THESIS_CASES: [Case; 3] = [
        Case {
            name: "yen coin in water",
            reynolds: 3.55e3,
            i_star: 1.0e-2,
            regime: Regime::PeriodicFlutter,
        },
        Case {
            name: "paper in air",
            reynolds: 6.8e3,
            i_star: 2.2e-3,
            regime: Regime::PeriodicSpiral,
        },
        Case {
            name: "leaf in air",
            reynolds: 1.2e4,
            i_star: 6.3e-3,
            regime: Regime::TransitionalHelix,
        },
    ];

    /// # Errors
    /// [`Error::InvalidParameter`] if a value is not positive and finite, [`Error::OutOfRange`] if
    /// the spiral begins above the helix.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_positive("helix_reynolds", self.helix_reynolds)?;
        Error::check_positive("helix_below", self.helix_below)?;
        Error::check_positive("spiral_below", self.spiral_below)?;
        Error::check_range("spiral_below", self.spiral_below, 0.0, self.helix_below)?;
        Ok(())
    }

    /// The regime at a Reynolds number (by mean descent) and an I*. Beyond the measured range the
    /// curves go on at the value of their ends.
    pub fn regime(&self, reynolds: f64, i_star: f64) -> Regime {
        if reynolds < interpolate(&STEADY, i_star) {
            return Regime::SteadyDescent;
        }
        if reynolds >= CHAOTIC[0].0 && i_star > interpolate(&CHAOTIC, reynolds) {
            return if i_star > interpolate(&TUMBLING, reynolds) {
                Regime::PeriodicTumbling
            } else {
                Regime::TransitionalChaotic
            };
        }
        if reynolds < self.helix_reynolds || i_star >= self.helix_below {
            Regime::PeriodicFlutter
        } else if i_star >= self.spiral_below {
            Regime::TransitionalHelix
        } else {
            Regime::PeriodicSpiral
        }
    }

    /// The regime that a body of these numbers is expected to fall in, before it has fallen: at its I* and
    /// the Reynolds number of its estimated mean descent
    /// ([`DimensionlessNumbers::reynolds`](super::DimensionlessNumbers::reynolds)).
    pub fn regime_of(&self, numbers: &DimensionlessNumbers) -> Regime {
        self.regime(numbers.reynolds(), numbers.i_star)
    }

    /// The other regimes within a factor `1 ± margin` of the point in Re or I*, in order. Measurements
    /// scatter about the curves by a margin of 0.2.
    pub fn neighbours(&self, reynolds: f64, i_star: f64, margin: f64) -> Vec<Regime> {
        let here = self.regime(reynolds, i_star);
        let mut found = Vec::new();
        // The steps are small, because a regime can be narrower than the margin.
        const STEPS: i32 = 8;
        for step in -STEPS..=STEPS {
            let factor = 1.0 + margin * f64::from(step) / f64::from(STEPS);
            for (re, i) in [(reynolds * factor, i_star), (reynolds, i_star * factor)] {
                let there = self.regime(re, i);
                if there != here && !found.contains(&there) {
                    found.push(there);
                }
            }
        }
        found.sort();
        found
    }

    /// The curves, for drawing; conventions end at Re = 30 000.
    pub fn boundaries(&self) -> Vec<Boundary> {
        let swapped = STEADY.iter().map(|(i, re)| (*re, *i)).collect();
        let convention = |i_star: f64| {
            let ends = [self.helix_reynolds, 3.0e4];
            ends.map(|re| (re, i_star)).to_vec()
        };
        let upright = vec![
            (self.helix_reynolds, 1e-4),
            (self.helix_reynolds, self.helix_below),
        ];
        let measured = |between, points| Boundary {
            between,
            points,
            measured: true,
        };
        let drawn = |between, points| Boundary {
            between,
            points,
            measured: false,
        };
        use Regime::*;
        vec![
            measured([SteadyDescent, PeriodicFlutter], swapped),
            measured([PeriodicFlutter, TransitionalChaotic], CHAOTIC.to_vec()),
            measured([TransitionalChaotic, PeriodicTumbling], TUMBLING.to_vec()),
            drawn(
                [PeriodicFlutter, TransitionalHelix],
                convention(self.helix_below),
            ),
            drawn(
                [TransitionalHelix, PeriodicSpiral],
                convention(self.spiral_below),
            ),
            drawn([PeriodicFlutter, PeriodicSpiral], upright),
        ]
    }
}

/// Linear between the logarithms of a table's points, constant beyond its ends.
fn interpolate(table: &[(f64, f64)], x: f64) -> f64 {
    let after = table.partition_point(|(at, _)| *at <= x);
    if after == 0 {
        return table[0].1;
    }
    if after == table.len() {
        return table[after - 1].1;
    }
    let ((x0, y0), (x1, y1)) = (table[after - 1], table[after]);
    let s = math::ln(x / x0) / math::ln(x1 / x0);
    y0 * math::powf(y1 / y0, s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use Regime::*;

    /// Values of the same curves read at round numbers, independently of the typed points.
    #[test]
    fn curves_pass_through_values_read_at_round_numbers() {
        let close = |a: f64, b: f64, tolerance: f64| (a / b - 1.0).abs() < tolerance;
        // They were read to two or three digits.
        for (re, i) in [
            (250.0, 0.0139),
            (500.0, 0.0099),
            (1e3, 0.0086),
            (5e3, 0.0091),
            (1e4, 0.0098),
        ] {
            assert!(close(interpolate(&CHAOTIC, re), i, 0.02), "{re}");
        }
        for (re, i) in [(500.0, 0.0385), (2000.0, 0.0401), (2e4, 0.0435)] {
            assert!(close(interpolate(&TUMBLING, re), i, 0.01), "{re}");
        }
        for (i, re) in [(5e-4, 161.0), (0.002, 119.0), (0.01, 89.0), (0.03, 110.0)] {
            assert!(close(interpolate(&STEADY, i), re, 0.02), "{i}");
        }
    }

    /// The coin of thesis § 3.6 flutters at (3.55e3, 1.0e-2). The measured curve of chaos is below it there
    /// (the published table has .0086 at Re = 2000 and .0091 at 5000), by more than a tenth and by less than
    /// the fifth within which discs scatter about it.
    #[test]
    fn the_thesis_coin_is_next_to_flutter() {
        let diagram = PhaseDiagram::default();
        assert_eq!(diagram.regime(3.55e3, 1.0e-2), TransitionalChaotic);
        assert_eq!(diagram.neighbours(3.55e3, 1.0e-2, 0.1), []);
        assert_eq!(diagram.neighbours(3.55e3, 1.0e-2, 0.2), [PeriodicFlutter]);
    }

    /// As I* falls above Re = 2000: tumbling, chaos and periodic motion in the order of Field et al. (1997),
    /// the latter as flutter, helix and spiral (Zhong, Chen & Lee 2011), each once.
    #[test]
    fn regimes_follow_each_other_as_published() {
        let diagram = PhaseDiagram::default();
        for reynolds in [2.5e3, 5e3, 2e4] {
            let i_star = (0..400).map(|step| 0.2 * 0.98f64.powi(step));
            let mut seen: Vec<Regime> = i_star.map(|i| diagram.regime(reynolds, i)).collect();
            seen.dedup();
            let published = [
                PeriodicTumbling,
                TransitionalChaotic,
                PeriodicFlutter,
                TransitionalHelix,
                PeriodicSpiral,
            ];
            assert_eq!(seen, published, "{reynolds}");
        }
    }

    /// What is a convention only divides the periodic motion that was measured: wherever helix and spiral
    /// are put, steady, chaotic and tumbling motion stay where they are, and below the given Reynolds number
    /// nothing leaves its plane.
    #[test]
    fn conventions_only_divide_what_is_periodic() {
        let other = PhaseDiagram {
            helix_reynolds: 300.0,
            helix_below: 3e-2,
            spiral_below: 1e-3,
        };
        let spatial = |regime| matches!(regime, TransitionalHelix | PeriodicSpiral);
        let (mut periodic, mut moved) = (0, 0);
        for step in 0..60 {
            let reynolds = 20.0 * 1.14f64.powi(step);
            for step in 0..60 {
                let i_star = 3e-4 * 1.12f64.powi(step);
                let here = PhaseDiagram::default().regime(reynolds, i_star);
                let there = other.regime(reynolds, i_star);
                let is_periodic = here == PeriodicFlutter || spatial(here);
                assert_eq!(is_periodic, there == PeriodicFlutter || spatial(there));
                assert!(is_periodic || here == there, "{reynolds} {i_star}");
                assert!(reynolds >= 2000.0 || !spatial(here), "{reynolds} {i_star}");
                assert!(reynolds >= 300.0 || !spatial(there), "{reynolds} {i_star}");
                periodic += u32::from(is_periodic);
                moved += u32::from(here != there);
            }
        }
        assert!(periodic > 500 && moved > 100, "{periodic} {moved}");
    }

    #[test]
    fn bad_conventions_are_refused() {
        let bad = PhaseDiagram {
            spiral_below: 1.0,
            ..PhaseDiagram::default()
        };
        assert!(bad.check().is_err());
        assert!(PhaseDiagram::default().check().is_ok());
    }
}
