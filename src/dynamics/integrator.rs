//! How a step of rapier is divided.

/// How finely a step is divided, and how exactly each part is solved.
///
/// # How many substeps
///
/// A regime is more sensitive than a path. At four times the step of the measured falls
/// ([`fidelity`](crate::training::fidelity); plates at 60 steps/s), against their own result at the fine
/// step (tumbling plate 15.8, 12.0 cm/s, 15.1 rad/s; fluttering plate 8.9 cm/s; 92.0 % of the discs):
///
/// | `max_travel`, `max_turn` | plate 1/8: drift, descent, spin | 1/14: descent | discs | substeps |
/// |---|---|---|---|---|
/// | 0.6, 0.6 | 0.9, 8.8, 0.7 (flutters) | 5.0 | 77.1 % | 1.2 |
/// | 0.4, 0.2 | 15.9, 11.7, 15.1 | 8.9 | 89.2 % | 2.0 |
/// | **0.3, 0.2** | 15.8, 11.9, 15.1 | 8.9 | 91.8 % | 2.2 |
/// | 0.3, 0.6 | 13.0, 12.7, 12.2 | 7.7 | 89.9 % | |
/// | 0.15, 0.1 | 15.8, 12.1, 15.1 | 8.9 | 91.8 % | 4.0 |
///
/// (The last column is the mean over 10 000 leaves that fall through air at 60 steps/s; each substep
/// takes some 25 ns of each leaf's step.) At the ends of its swings a plate is slow and the flow around
/// it changes fastest, so it is the turning of the body's *course* that `max_turn` limits there: without
/// that the fluttering plate needs twice the substeps. Under 0.3, 0.2 with u̇ itself extrapolated the
/// chaotic plate 1/11 flutters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Integrator {
    /// A substep turns the body, and its course through the fluid, by at most this angle, rad (default
    /// 0.2).
    pub max_turn: f64,
    /// A substep moves the body by at most this many chords (default 0.3; at 0.6 the step costs less, but
    /// plates at 60 steps/s flutter that should tumble).
    pub max_travel: f64,
    /// Never more substeps than this in one step (default 16): accuracy gives way, stability does
    /// not depend on it.
    pub max_substeps: u32,
    /// Evaluations of N per substep (default 1). Each further one re-freezes N at the middle that
    /// the last solve found; in the limit momentum and energy are conserved together. In an ideal
    /// fluid, where that is what counts, at least 8 are made.
    pub iterations: u32,
}

impl Integrator {
    /// Substeps of a tenth of a chord with two evaluations each: for falls that are compared, labeled or
    /// trained with.
    pub const FINE: Self = Self {
        max_turn: 0.2,
        max_travel: 0.1,
        max_substeps: 64,
        iterations: 2,
    };
}

impl Default for Integrator {
    fn default() -> Self {
        Self {
            max_turn: 0.2,
            max_travel: 0.3,
            max_substeps: 16,
            iterations: 1,
        }
    }
}
