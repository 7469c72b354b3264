//! Names of how a body falls.

use std::fmt;

/// Regime of the Re–I* phase diagram (thesis § 3.3.1).
///
/// ```
/// use rapier3d_immersed::motion::{Pattern, Regime};
///
/// assert_eq!(Regime::PeriodicTumbling.abbreviation(), "PT");
/// // Flutter, helix and spiral count as one pattern.
/// assert_eq!(Pattern::from(Regime::PeriodicSpiral), Pattern::Zigzag);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Regime {
    /// The body falls straight down, or glides without oscillation.
    SteadyDescent,
    /// It swings from side to side with a well-defined period.
    PeriodicFlutter,
    /// It tumbles and flutters in turn.
    TransitionalChaotic,
    /// It turns end over end and drifts in one direction.
    PeriodicTumbling,
    /// Its path is a helix, between spiral and flutter.
    TransitionalHelix,
    /// It circles down.
    PeriodicSpiral,
}

impl Regime {
    /// All regimes, in the order of their declaration.
    pub const ALL: [Self; 6] = [
        Self::SteadyDescent,
        Self::PeriodicFlutter,
        Self::TransitionalChaotic,
        Self::PeriodicTumbling,
        Self::TransitionalHelix,
        Self::PeriodicSpiral,
    ];

    /// The thesis's two letters.
    pub const fn abbreviation(self) -> &'static str {
        match self {
            Self::SteadyDescent => "SD",
            Self::PeriodicFlutter => "PF",
            Self::TransitionalChaotic => "TC",
            Self::PeriodicTumbling => "PT",
            Self::TransitionalHelix => "TH",
            Self::PeriodicSpiral => "PS",
        }
    }

    /// Whether falls in it are put together from glides (thesis Fig. 3.7), rather than from a curve.
    pub(crate) const fn has_search_tree(self) -> bool {
        matches!(
            self,
            Self::PeriodicFlutter | Self::TransitionalChaotic | Self::PeriodicTumbling
        )
    }
}

impl fmt::Display for Regime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::SteadyDescent => "steady descent",
            Self::PeriodicFlutter => "flutter",
            Self::TransitionalChaotic => "chaotic",
            Self::PeriodicTumbling => "tumbling",
            Self::TransitionalHelix => "helix",
            Self::PeriodicSpiral => "spiral",
        })
    }
}

/// Motion pattern of the pattern-driven method (thesis § 5.4.2), in the order in which they follow
/// each other.
///
/// ```
/// use rapier3d_immersed::motion::Pattern;
///
/// let plan: Result<Vec<Pattern>, _> = "ZZ AR".split(' ').map(str::parse).collect();
/// assert_eq!(plan.unwrap(), [Pattern::Zigzag, Pattern::Autorotation]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Pattern {
    /// SD: the body falls vertically.
    SteadyDescent,
    /// AR: it tumbles and drifts broadside to one side.
    Autorotation,
    /// AZ: it tumbles and flutters in turn.
    AutorotationZigzag,
    /// ZZ: it flutters; the periodic helix and spiral count as this too (thesis § 5.4.2).
    Zigzag,
}

impl Pattern {
    /// All patterns, in the order in which they follow each other.
    pub const ALL: [Self; 4] = [
        Self::SteadyDescent,
        Self::Autorotation,
        Self::AutorotationZigzag,
        Self::Zigzag,
    ];

    /// Position in [`Pattern::ALL`], and the state of the
    /// [thesis's graph](crate::motion::MotionGraph::thesis).
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The thesis's two letters.
    pub const fn abbreviation(self) -> &'static str {
        match self {
            Self::SteadyDescent => "SD",
            Self::Autorotation => "AR",
            Self::AutorotationZigzag => "AZ",
            Self::Zigzag => "ZZ",
        }
    }
}

impl From<Regime> for Pattern {
    fn from(regime: Regime) -> Self {
        match regime {
            Regime::SteadyDescent => Self::SteadyDescent,
            Regime::PeriodicTumbling => Self::Autorotation,
            Regime::TransitionalChaotic => Self::AutorotationZigzag,
            Regime::PeriodicFlutter | Regime::TransitionalHelix | Regime::PeriodicSpiral => {
                Self::Zigzag
            }
        }
    }
}

impl fmt::Display for Pattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.abbreviation())
    }
}

impl std::str::FromStr for Pattern {
    type Err = UnknownPattern;

    /// Reads the two letters, in either case.
    fn from_str(text: &str) -> Result<Self, UnknownPattern> {
        Self::ALL
            .into_iter()
            .find(|pattern| pattern.abbreviation().eq_ignore_ascii_case(text))
            .ok_or_else(|| UnknownPattern(text.to_string()))
    }
}

/// A text that names no pattern.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is none of SD, AR, AZ, ZZ")]
pub struct UnknownPattern(pub String);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back() {
        for pattern in Pattern::ALL {
            assert_eq!(pattern.to_string().parse(), Ok(pattern));
            assert_eq!(Pattern::ALL[pattern.index()], pattern);
        }
        assert_eq!("zz".parse(), Ok(Pattern::Zigzag));
        assert!("PF".parse::<Pattern>().is_err());
    }
}
