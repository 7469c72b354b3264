//! When a fall drifts away from below its release.

use super::piece::Piece;
use crate::motion::Regime;

/// When a fall drifts away from below its release: in steady descent a tenth as fast as otherwise.
pub(super) struct Drifts {
    /// Beginning of each piece, time drifted until then, share before it and in it.
    parts: Vec<(f64, f64, [f64; 2])>,
    /// How long the share takes to change, s.
    blend: f64,
}

/// Drift of a steady descent over that of other regimes. Thesis § 3.3.5 says that deviations differ by
/// pattern, without numbers; this one is ours.
const STEADY_DRIFT: f64 = 0.1;

impl Drifts {
    pub fn of(pieces: &[Piece], blend: f64) -> Self {
        let mut drifts = Self {
            parts: Vec::new(),
            blend,
        };
        for piece in pieces {
            let share = match piece.regime {
                Regime::SteadyDescent => STEADY_DRIFT,
                _ => 1.0,
            };
            let (drifted, before) = match drifts.parts.is_empty() {
                true => (0.0, share),
                false => drifts.until(piece.start),
            };
            drifts.parts.push((piece.start, drifted, [before, share]));
        }
        drifts
    }

    /// Time drifted until a time, s, and its derivative.
    pub fn until(&self, time: f64) -> (f64, f64) {
        let after = self.parts.partition_point(|part| part.0 <= time);
        let (start, drifted, [before, share]) = self.parts[after.max(1) - 1];
        let t = time - start;
        // The share changes by the smooth step 3s² − 2s³; its integral is s³ − s⁴/2.
        let s = (t / self.blend).min(1.0);
        let step = s * s * (3.0 - 2.0 * s);
        let left = self.blend * (s - s * s * s * (1.0 - 0.5 * s));
        (
            drifted + share * t + (before - share) * left,
            before + (share - before) * step,
        )
    }
}
