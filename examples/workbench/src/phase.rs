//! The phase diagram with a body's marker on it, in the logarithms of its axes.

use crate::kinds::kind;
use crate::methods;
use crate::state::State;
use rapier3d_immersed::motion::{PhaseDiagram, Regime};
use std::ops::RangeInclusive;

/// The diagram, for drawing.
pub struct Phase {
    diagram: PhaseDiagram,
    /// Its curves: points (Re, I*), and whether they were measured.
    pub curves: Vec<(Vec<[f64; 2]>, bool)>,
}

/// Where a body is on the diagram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marker {
    /// I* of its inertia.
    pub i_star: f64,
    /// Re of the mean descent that is expected of it.
    pub expected: f64,
    /// Re of its descent as it is now.
    pub now: f64,
    /// In which regime it is expected to fall.
    pub regime: Regime,
}

impl Phase {
    /// Re that is shown.
    pub const REYNOLDS: RangeInclusive<f64> = 30.0..=40_000.0;
    /// I* that is shown.
    pub const I_STAR: RangeInclusive<f64> = 2e-4..=0.3;
    /// Where the regimes are named: (Re, I*).
    pub const NAMES: [(&'static str, [f64; 2]); 6] = [
        ("steady", [55.0, 2e-3]),
        ("flutter", [480.0, 2.4e-3]),
        ("chaotic", [2300.0, 1.9e-2]),
        ("tumbling", [2300.0, 0.11]),
        ("helix", [8500.0, 5.9e-3]),
        ("spiral", [8500.0, 1.2e-3]),
    ];

    /// A place of the diagram in a unit square, from its lower left corner; what is outside of it is held at its edge.
    pub fn place(&self, reynolds: f64, i_star: f64) -> [f64; 2] {
        let share = |value: f64, range: RangeInclusive<f64>| {
            let (low, high) = range.into_inner();
            ((value.clamp(low, high) / low).ln()) / (high / low).ln()
        };
        [share(reynolds, Self::REYNOLDS), share(i_star, Self::I_STAR)]
    }

    /// Where a body is; `None` where there is no body, or none that sinks.
    pub fn marker(&self, state: &State, body: usize) -> Option<Marker> {
        let of = state.bodies.get(body)?;
        let height = state.world().bodies[state.handle(body)?].center_of_mass().y;
        let kind = kind(of.shape, of.size).ok()?;
        let numbers = methods::numbers(&kind, &state.settings, height.into())?;
        (numbers.density_ratio > 1.0).then(|| Marker {
            i_star: numbers.i_star,
            expected: numbers.reynolds(),
            now: numbers.reynolds_at(of.descent),
            regime: self.diagram.regime_of(&numbers),
        })
    }
}

impl Default for Phase {
    fn default() -> Self {
        let diagram = PhaseDiagram::default();
        let boundaries = diagram.boundaries().into_iter();
        let curves = boundaries.map(|curve| {
            let points = curve.points.into_iter().map(|(re, i)| [re, i]);
            (points.collect(), curve.measured)
        });
        Self {
            curves: curves.collect(),
            diagram,
        }
    }
}
