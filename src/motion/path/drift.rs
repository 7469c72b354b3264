//! How a fall drifts away from below its release, faster in some regimes than in others.

use super::piece::Piece;

/// The way drifted by each time, with a speed that depends on the regime.
pub(super) struct Drifts {
    /// Beginning of each piece, way drifted until then, speed before it and in it.
    parts: Vec<(f64, f64, [f64; 2])>,
    /// How long the speed takes to change, s.
    blend: f64,
}

impl Drifts {
    /// Drifts at these speeds of the six regimes, in any unit.
    pub fn of(pieces: &[Piece], blend: f64, speeds: [f64; 6]) -> Self {
        let mut drifts = Self {
            parts: Vec::new(),
            blend,
        };
        for piece in pieces {
            let speed = speeds[piece.regime as usize];
            let (drifted, before) = match drifts.parts.is_empty() {
                true => (0.0, speed),
                false => drifts.until(piece.start),
            };
            drifts.parts.push((piece.start, drifted, [before, speed]));
        }
        drifts
    }

    /// Way drifted until a time, s, and its derivative.
    pub fn until(&self, time: f64) -> (f64, f64) {
        let after = self.parts.partition_point(|part| part.0 <= time);
        let (start, drifted, [before, speed]) = self.parts[after.max(1) - 1];
        let t = time - start;
        // The speed changes by the smooth step 3s² − 2s³; its integral is s³ − s⁴/2.
        let s = (t / self.blend).min(1.0);
        let step = s * s * (3.0 - 2.0 * s);
        let left = self.blend * (s - s * s * s * (1.0 - 0.5 * s));
        (
            drifted + speed * t + (before - speed) * left,
            before + (speed - before) * step,
        )
    }
}
