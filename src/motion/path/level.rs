//! The levels of a fall's search, and the pieces that they make when they are put end to end.

use super::amplitude::chaotic_factor;
use super::curve::UnifiedCurve;
use super::database::Entry;
use super::piece::{Course, Piece};
use super::search_tree::SearchTree;
use super::segment::Glide;
use super::synthesis::Synthesizer;
use crate::motion::Regime;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use rapier3d::na::Vector2;
use std::f64::consts::PI;

/// A level of the search: a pattern, and what it takes from the database.
pub(super) struct Level<'a> {
    regime: Regime,
    glide: Option<(Glide, &'a Entry, f64)>,
    duration: f64,
}

impl Synthesizer {
    /// Draws levels until the time is up.
    pub(super) fn levels(
        &self,
        duration: f64,
        mut regime: impl FnMut(f64, &mut Pcg64Mcg) -> Regime,
        random: &mut Pcg64Mcg,
    ) -> Vec<Level<'_>> {
        let regular = PI / self.frequency;
        let unit = self.units.length / self.units.descent;
        let tree = SearchTree {
            feature: Vector2::new(2.0 * self.amplitude / self.units.length, -regular / unit),
        };
        let mut levels = Vec::new();
        let mut time = 0.0;
        let mut last = if random.random_bool(0.5) {
            Glide::Left
        } else {
            Glide::Right
        };
        while time < duration {
            let regime = regime(time, random);
            let mut level = Level {
                regime,
                glide: None,
                duration: regular,
            };
            if let Some(glide) = SearchTree::branch(regime, last, random) {
                let scale = match regime {
                    Regime::TransitionalChaotic => chaotic_factor(random),
                    _ => 1.0,
                };
                let entry = tree.child(&self.database, glide, scale, random);
                level.duration = entry.segment.duration() * unit;
                level.glide = Some((glide, entry, scale));
                last = glide;
            }
            time += level.duration;
            levels.push(level);
        }
        levels
    }

    /// Puts levels end to end; what goes on in the same spiral, helix or straight fall is one piece.
    pub(super) fn splice<'a>(
        &'a self,
        levels: &[Level<'a>],
        random: &mut Pcg64Mcg,
    ) -> Vec<Piece<'a>> {
        let blend = self.params.blend * PI / self.frequency;
        let mut pieces: Vec<Piece<'a>> = Vec::new();
        let mut start = 0.0;
        let mut index = 0;
        while index < levels.len() {
            let level = &levels[index];
            let mut duration = level.duration;
            let course = if let Some((glide, entry, scale)) = level.glide {
                // A body turns over where it glides on the same way, unless the glides are too short or
                // too different: it would have to spin up or stop at once.
                let over = |neighbour: Option<&Level>| {
                    let neighbour = neighbour.and_then(|level| level.glide);
                    neighbour.is_some_and(|(g, _, s)| {
                        let (small, large) = (s.min(scale), s.max(scale));
                        g == glide && small >= 0.5 && large <= 2.0 * small
                    })
                };
                Course::Glide {
                    segment: entry.segment,
                    flutter: &self.database.flutter()[entry.flutter as usize],
                    tumbling: &self.database.tumbling()[entry.tumbling as usize],
                    swing: scale.min(1.0),
                    over: [
                        over(index.checked_sub(1).map(|i| &levels[i])),
                        over(levels.get(index + 1)),
                    ],
                }
            } else {
                while levels
                    .get(index + 1)
                    .is_some_and(|l| l.regime == level.regime)
                {
                    index += 1;
                    duration += levels[index].duration;
                }
                self.course(level.regime, random)
            };
            let before = pieces
                .last()
                .map(|piece: &Piece| piece.at(piece.duration, &self.units));
            pieces.push(Piece::after(
                before.as_ref(),
                course,
                level.regime,
                start,
                duration,
                blend,
                &self.units,
            ));
            start += duration;
            index += 1;
        }
        pieces
    }

    /// What a regime without a search tree follows (3.8).
    fn course<'a>(&self, regime: Regime, random: &mut Pcg64Mcg) -> Course<'a> {
        let amplitude = self.amplitude;
        let frequency = self.frequency / self.params.slowness;
        let curve = match regime {
            Regime::PeriodicSpiral => {
                UnifiedCurve::spiral(amplitude, frequency, self.units.descent)
            }
            Regime::TransitionalHelix => UnifiedCurve::helix(
                amplitude,
                self.params.ellipticity,
                frequency,
                self.units.descent,
            ),
            _ => return Course::Straight,
        };
        let sense = if random.random_bool(0.5) { 1.0 } else { -1.0 };
        Course::Curve { curve, sense }
    }
}
