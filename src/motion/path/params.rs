//! The parameters of synthesized falls.

use super::amplitude::Deviation;
use crate::error::Error;
use crate::motion::phase_diagram::Case;
use crate::motion::{MotionGraph, PhaseDiagram, Regime};

/// How falls are synthesized.
#[derive(Clone, Debug, PartialEq)]
pub struct SynthesisParams {
    /// h: height of release, m. Default 2.
    pub height: f64,
    /// The main regime; `None` (the default) looks it up in `diagram`
    /// ([`PhaseDiagram::regime_of`]).
    pub main: Option<Regime>,
    /// The phase diagram.
    pub diagram: PhaseDiagram,
    /// Which regime follows which; `None` (the default) takes [`MotionGraph::free_fall`] of the main regime.
    pub graph: Option<MotionGraph>,
    /// How far falls land from below their release, by [regime](Regime::ALL); a fall of several lands as far
    /// away as each does in its share of the time. Default [`Deviation::of`] each.
    pub deviations: [Deviation; 6],
    /// Ω over U/a: angular frequency of flutter and tumbling, Ω ~ √((ρ_s/ρ_f − 1) g b)/a (thesis § 3.3.5 has
    /// √b/a, after Mahadevan, Ryu & Samuel 1999). Default 1, a convention: flutters of this crate's discs have
    /// 2.3 in the median, tumbling ones 1.5 (`frequency` in the [`FallEstimates`](crate::motion::FallEstimates)).
    pub frequency: f64,
    /// Amplitude AΩ of the horizontal velocity of a swing, in U L/a. With the A_0 of (3.10) a swing would be just
    /// as fast as the fall drifts away, so that nothing would ever swing back. Default 0.75, a convention:
    /// flutters of this crate's discs have 0.45 in the median, spirals 1.0 (`swing` in the estimates).
    pub swing: f64,
    /// How much slower a spiral or helix turns than a flutter swings. Default 3, a convention: spirals of this
    /// crate's discs are small and fast, 4.3 U/a in the median.
    pub slowness: f64,
    /// ε of the helix. Default 0.3.
    pub ellipticity: f64,
    /// How long a splice takes, in half periods π/Ω. Default 0.5.
    pub blend: f64,
    /// Angle of the chord to the horizontal at the release, rad, positive with the edge toward +x down:
    /// the body is let go so, glides toward its lower edge, and the feature vector V_0 of thesis § 3.3.5,
    /// of the first glide and of all chaotic ones, has this orientation (our reading: along the chord;
    /// no flatter than the flattest segment of the database). `None` (the default) for the attitude that
    /// the first pattern begins with, either way, and the V_0 that amplitude and frequency give.
    pub release_angle: Option<f64>,
    /// Share of a K-means class among which a segment is drawn, the nearest of it first: 0 takes the
    /// nearest, 1 any of its class. With the default of 0.05 no two swings of a fall are alike.
    pub variety: f64,
    /// Mean wind, m/s: tumbling and chaotic motion become rarer in it. Default 0.
    pub wind: f64,
    /// Wind, in U, at which they are e times as unlikely; their probabilities fall as
    /// exp(−(wind/(this·U))²). Default 1.5. Form and number are ours, chosen so that the leaf of thesis
    /// Fig. 3.17, which says no more than that, hardly tumbles any more at 3 m/s: what is tested is that falls
    /// do as they say, not that leaves do.
    pub calming_wind: f64,
    /// Time between keyframes at most, s. Default 1/120.
    pub interval: f64,
}

impl Default for SynthesisParams {
    fn default() -> Self {
        Self {
            height: 2.0,
            main: None,
            diagram: PhaseDiagram::default(),
            graph: None,
            deviations: Regime::ALL.map(Deviation::of),
            frequency: 1.0,
            swing: 0.75,
            slowness: 3.0,
            ellipticity: 0.3,
            blend: 0.5,
            release_angle: None,
            variety: 0.05,
            wind: 0.0,
            calming_wind: 1.5,
            interval: 1.0 / 120.0,
        }
    }
}

impl SynthesisParams {
    /// Falls in the regime that a [case of the thesis](PhaseDiagram::THESIS_CASES) shows at the numbers
    /// that it prints, whatever the diagram says of those that are computed for the body. Two of its
    /// three bodies have quite other numbers, and its coin lies just beyond flutter.
    ///
    /// ```
    /// use rapier3d_immersed::motion::path::SynthesisParams;
    /// use rapier3d_immersed::motion::{PhaseDiagram, Regime};
    ///
    /// let coin = SynthesisParams::of_case(&PhaseDiagram::THESIS_CASES[0]);
    /// assert_eq!(coin.main, Some(Regime::PeriodicFlutter));
    /// ```
    pub fn of_case(case: &Case) -> Self {
        Self {
            main: Some(case.regime),
            ..Self::default()
        }
    }

    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] names the value that cannot be;
    /// [`Error::WrongLength`] if the graph has other than six states.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_positive("height", self.height)?;
        self.diagram.check()?;
        if let Some(graph) = &self.graph {
            graph.check()?;
            Error::check_length("states of the motion graph", 6, graph.states())?;
        }
        for deviation in &self.deviations {
            deviation.check()?;
        }
        Error::check_positive("frequency", self.frequency)?;
        Error::check_not_negative("swing", self.swing)?;
        Error::check_positive("slowness", self.slowness)?;
        Error::check_range("ellipticity", self.ellipticity, 0.0, 10.0)?;
        Error::check_range("blend", self.blend, 1e-3, 10.0)?;
        if let Some(angle) = self.release_angle {
            let most = std::f64::consts::FRAC_PI_2;
            Error::check_range("release angle", angle, -most, most)?;
        }
        Error::check_range("variety", self.variety, 0.0, 1.0)?;
        Error::check_not_negative("wind", self.wind)?;
        Error::check_positive("calming wind", self.calming_wind)?;
        Error::check_range("interval", self.interval, 1e-4, 0.1)?;
        Ok(())
    }
}
