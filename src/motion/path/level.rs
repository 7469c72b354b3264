//! The levels of a fall's search, and the pieces that they make when they are put end to end.

use super::amplitude::{SMALLEST_FACTOR, chaotic_factor};
use super::curve::UnifiedCurve;
use super::database::Entry;
use super::piece::{Course, Instant, Piece};
use super::search_tree::SearchTree;
use super::segment::Glide;
use super::synthesis::Synthesizer;
use crate::math;
use crate::motion::Regime;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use rapier3d::na::{UnitQuaternion, Vector2, Vector3};
use std::f64::consts::PI;

/// A level of the search: a pattern, and what it takes from the database.
pub(super) struct Level<'a> {
    regime: Regime,
    glide: Option<(Glide, &'a Entry, f64)>,
    /// How long it lasts, s.
    duration: f64,
    /// Factor on the lengths and times of its segment.
    stretch: f64,
}

impl Synthesizer {
    /// Draws levels until the time is up, and stretches them to end with it: a fall lands at a turning
    /// point. There the height is that of a steady descent, between them it is not, so that a segment
    /// cut short would make all the others too fast or too slow.
    ///
    /// `regime` gives the regime that follows at a time and when, at the latest, another one shall.
    pub(super) fn levels(
        &self,
        duration: f64,
        mut regime: impl FnMut(f64, &mut Pcg64Mcg) -> (Regime, f64),
        random: &mut Pcg64Mcg,
    ) -> Vec<Level<'_>> {
        let regular = PI / self.frequency;
        let unit = self.units.length / self.units.descent;
        let feature = Vector2::new(2.0 * self.amplitude / self.units.length, -regular / unit);
        let tree = |feature| SearchTree {
            feature,
            variety: self.params.variety,
        };
        let regular_tree = tree(feature);
        // This is V_0 of thesis § 3.3.5.
        let released = tree(match self.params.release_angle {
            Some(angle) => {
                let angle = angle.abs().max(self.database.flattest());
                Vector2::new(math::cos(angle), -math::sin(angle)) * feature.norm()
            }
            None => feature,
        });
        let mut levels: Vec<Level<'_>> = Vec::new();
        let mut time = 0.0;
        let mut last = match self.params.release_angle {
            Some(angle) if angle != 0.0 => Glide::toward(angle),
            _ if random.random_bool(0.5) => Glide::Left,
            _ => Glide::Right,
        };
        while levels.is_empty() || duration - time > 0.5 * regular {
            let (regime, until) = regime(time, random);
            let mut level = Level {
                regime,
                glide: None,
                duration: regular,
                stretch: 1.0,
            };
            let first = levels.iter().all(|level| level.glide.is_none());
            let branch = match self.params.release_angle {
                // The first glide is toward the edge that is low at the release.
                Some(_) if first => regime.has_search_tree().then_some(last),
                _ => SearchTree::branch(regime, last, random),
            };
            if let Some(glide) = branch {
                // No segment of a chaotic fall is longer than what is left for it.
                let most = ((until.min(duration) - time) / regular).max(SMALLEST_FACTOR);
                let scale = match regime {
                    Regime::TransitionalChaotic => chaotic_factor(random).min(most),
                    _ => 1.0,
                };
                let tree = match regime {
                    Regime::TransitionalChaotic => &released,
                    _ if first => &released,
                    _ => &regular_tree,
                };
                let entry = tree.child(&self.database, glide, scale, random);
                level.duration = entry.segment.duration() * unit;
                level.glide = Some((glide, entry, scale));
                last = glide;
            }
            time += level.duration;
            levels.push(level);
        }
        let stretch = duration / time;
        for level in &mut levels {
            level.duration *= stretch;
            level.stretch = stretch;
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
                // A glide r times as long has A_y/r, so that its vertical oscillation is no larger than a
                // regular one's. The height then follows a steady descent everywhere, not only at turning
                // points.
                let mut segment = entry.segment;
                segment.flutter.vertical /= scale.max(1.0);
                Course::Glide {
                    segment,
                    stretch: level.stretch,
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
            let before = match pieces.last() {
                Some(piece) => Some(piece.at(piece.duration, &self.units)),
                None => self.release(&course, duration),
            };
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

    /// The release: the chord at the release angle, velocity and place as the first stretch has them.
    fn release(&self, first: &Course, duration: f64) -> Option<Instant> {
        let angle = self.params.release_angle?;
        Some(Instant {
            attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -angle),
            ..first.at(0.0, duration, &self.units)
        })
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
