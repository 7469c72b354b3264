//! Walks on the motion graph of frames.

use super::frames::{FrameGraph, FrameSplice, about_vertical};
use super::piece::{Instant, Join, half_turns};
use super::track::{Key, MotionPath};
use crate::error::Error;
use crate::math::{to_real, to_rotation};
use crate::motion::{MotionGraph, Regime};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rapier3d::math::Real;
use rapier3d::na::{UnitQuaternion, Vector3};

/// Keys that a walk may have.
const MOST_KEYS: usize = 1_000_000;

impl FrameGraph {
    /// A walk: frame after frame from a release until it has fallen `height` m. Every half period the chain
    /// `graph` draws the regime that follows, and the next splice to it is taken; one that stays takes the next
    /// splice within its regime. The same seed gives the same walk.
    ///
    /// # Errors
    /// [`Error::WrongLength`] if the chain has other than six states, [`Error::InvalidParameter`] if the height
    /// is not positive or no frame has a regime of the chain, [`Error::OutOfRange`] if a million frames do not
    /// fall so far.
    pub fn walk(&self, graph: &MotionGraph, height: f64, seed: u64) -> Result<MotionPath, Error> {
        Error::check_length("states of the motion graph", 6, graph.states())?;
        Error::check_positive("height", height)?;
        let has = |regime: &Regime| self.nodes.iter().any(|n| n.alive && n.regime == *regime);
        let possible: Vec<bool> = Regime::ALL.iter().map(has).collect();
        let chain = graph.restricted(&possible)?;
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut wanted = Some(Regime::ALL[chain.draw_start(&mut random)]);
        let starts = (0..self.nodes.len()).filter(|node| {
            let node = &self.nodes[*node];
            node.alive && Some(node.regime) == wanted
        });
        let starts: Vec<usize> = starts.collect();
        let mut node = starts[random.random_range(0..starts.len())];
        wanted = None;
        let half_turns = half_turns();
        let blend = self.params.window as f64 * self.interval;
        let mut placed = Placement {
            turn: UnitQuaternion::identity(),
            flip: UnitQuaternion::identity(),
            shift: -self.nodes[node].instant.position,
            since: 0,
            join: Join::none(blend),
        };
        let mut keys = Vec::new();
        let mut regimes: Vec<(Real, Regime)> = Vec::new();
        let mut drawn = 0.0;
        while keys.len() < MOST_KEYS {
            let time = keys.len() as f64 * self.interval;
            let now = placed.at(&self.nodes[node].instant, self.interval);
            keys.push(Key {
                position: to_real(now.position),
                velocity: to_real(now.velocity),
                attitude: to_rotation(now.attitude),
            });
            let regime = self.nodes[node].regime;
            if regimes.last().is_none_or(|(_, last)| *last != regime) {
                regimes.push((time as Real, regime));
            }
            if now.position.y <= -height && keys.len() > 1 {
                return MotionPath::new(self.interval as Real, keys, regimes);
            }
            if time - drawn >= self.params.segment {
                drawn += self.params.segment;
                wanted = Some(Regime::ALL[chain.draw_next(regime as usize, &mut random)]);
            }
            let fits = |splice: &&FrameSplice| Some(self.nodes[splice.to].regime) == wanted;
            let mut ways: Vec<&FrameSplice> = self.ways_on(node).filter(fits).collect();
            if ways.is_empty() && !(self.nodes[node].goes_on && self.nodes[node + 1].alive) {
                // The clip ends here: stay in the regime if that can be.
                ways = self.ways_on(node).collect();
                let stays = |splice: &&FrameSplice| self.nodes[splice.to].regime == regime;
                if ways.iter().any(stays) {
                    ways.retain(stays);
                }
            }
            match ways.is_empty() {
                true => node += 1,
                false => {
                    let splice = ways[random.random_range(0..ways.len())];
                    placed = placed.spliced(
                        &now,
                        &self.nodes[splice.to].instant,
                        splice.heading,
                        &half_turns[splice.flip],
                        blend,
                    );
                    // The frame that is spliced to is where the walk already is; it goes on with the next.
                    node = splice.to + 1;
                    wanted = None;
                }
            }
            placed.since += 1;
        }
        let keys = keys.len() as f64;
        Err(Error::check_range("keys of the walk", keys, 0.0, MOST_KEYS as f64 - 1.0).unwrap_err())
    }
}

/// How the frames of a clip are placed in a walk.
struct Placement {
    turn: UnitQuaternion<f64>,
    flip: UnitQuaternion<f64>,
    shift: Vector3<f64>,
    /// Frames since the last splice, and what is left of the motion before.
    since: usize,
    join: Join,
}

impl Placement {
    fn at(&self, frame: &Instant, interval: f64) -> Instant {
        let own = Instant {
            position: self.shift + self.turn * frame.position,
            velocity: self.turn * frame.velocity,
            attitude: self.turn * frame.attitude * self.flip,
        };
        self.join.at(self.since as f64 * interval, &own)
    }

    /// The placement after a splice from where the walk is to a frame that lies `heading` aside.
    fn spliced(
        &self,
        now: &Instant,
        frame: &Instant,
        heading: f64,
        flip: &UnitQuaternion<f64>,
        blend: f64,
    ) -> Self {
        let turn = self.turn * about_vertical(heading);
        // The half turn is of the plate as it is in the clip before, which may itself be turned over.
        let flip = flip * self.flip;
        let attitude = turn * frame.attitude * flip;
        Self {
            turn,
            flip,
            shift: now.position - turn * frame.position,
            since: 0,
            join: Join {
                blend,
                velocity: now.velocity - turn * frame.velocity,
                turn: now.attitude * attitude.inverse(),
            },
        }
    }
}
