//! The motion graph of frames (thesis § 3.4.3, after Kovar, Gleicher & Pighin 2002): every frame is a node,
//! and where two frames are alike a splice leads from one to the other.

use super::piece::{Instant, half_turns};
use super::track::MotionPath;
use crate::error::Error;
use crate::math;
use crate::motion::Regime;
use rapier3d::math::{Real, Rotation, Vector};
use rapier3d::na::{Quaternion, UnitQuaternion, Vector3};

/// How splices are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameGraphParams {
    /// Longer and shorter in-plane extent of the body, m, whose ends are compared.
    pub extents: [f64; 2],
    /// Frames from each of the two on that are compared, and over which a splice is blended. Default 4.
    pub window: usize,
    /// Root mean square distance of the compared points, m, up to which frames are alike. Default an eighth of
    /// the shorter extent: with less, few splices are left between regimes, with more they jump further.
    pub threshold: f64,
    /// Time between draws of the next regime, s: half a period.
    pub segment: f64,
}

impl FrameGraphParams {
    /// The defaults for a body of this longer and shorter extent, m, and half period, s.
    pub fn new(extents: [f64; 2], segment: f64) -> Self {
        Self {
            extents,
            window: 4,
            threshold: 0.125 * extents[1],
            segment,
        }
    }

    fn check(&self) -> Result<(), Error> {
        Error::check_positive("longer extent", self.extents[0])?;
        Error::check_positive("shorter extent", self.extents[1])?;
        Error::check_range("window", self.window as f64, 2.0, 1e3)?;
        Error::check_positive("threshold", self.threshold)?;
        Error::check_positive("segment", self.segment)?;
        Ok(())
    }
}

/// An edge between frames that do not follow each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameSplice {
    /// Node that it leaves.
    pub from: usize,
    /// Node that it leads to.
    pub to: usize,
    /// Root mean square distance of the points of the two windows, m.
    pub distance: f64,
    /// Turn about the vertical, rad, that the motion goes on with.
    pub heading: f64,
    /// Jump of the velocity at the splice, m/s, the derivative of the position.
    pub velocity: f64,
    /// Jump of the attitude, rad.
    pub angle: f64,
    /// The half turn of the plate (index into [`half_turns`]) under which the two are alike.
    pub(super) flip: usize,
}

/// One frame.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub instant: Instant,
    pub regime: Regime,
    /// Whether the next node is the next frame of the same clip.
    pub goes_on: bool,
    /// Indices of its splices.
    splices: std::ops::Range<usize>,
    /// Whether some walk from here never ends.
    pub alive: bool,
}

/// Frames of several falls, and the splices between them.
///
/// Candidates are the local minima of a pose distance that lie under a threshold: the points are the center
/// and an end of each in-plane axis over a window of frames, the two windows are moved and turned about the
/// vertical to lie best on each other, and a plate that is turned over is the same plate. Splices never lead
/// to an earlier regime (the hypothesis of thesis § 3.4.1). Frames whose every walk ends are left out.
///
/// Beside the graph of regimes ([`Synthesizer`](super::Synthesizer)) its splices hide half as large a turn or less,
/// but a velocity of half of the descent, where that graph, which splices at turning points, has no jump of the
/// velocity between regimes in a plane: it remains the default.
///
/// ```
/// use rapier3d_immersed::Fluid;
/// use rapier3d_immersed::motion::path::{
///     FrameGraph, FrameGraphParams, SynthesisParams, Synthesizer, TrajectoryDatabase,
/// };
/// use rapier3d_immersed::motion::{DimensionlessNumbers, MotionGraph, Outline, Regime};
///
/// let numbers = DimensionlessNumbers::new(Outline::Round, 0.042, 3e-4, 400.0, &Fluid::AIR, 9.81)?;
/// let params = SynthesisParams { interval: 1.0 / 60.0, ..SynthesisParams::default() };
/// let leaf = Synthesizer::new(&numbers, 0.073, TrajectoryDatabase::shipped(), params)?;
/// let clip = leaf.path_through(&[Regime::PeriodicFlutter], 1)?;
/// let graph = FrameGraph::new(&[clip], FrameGraphParams::new([0.073, 0.042], 0.13))?;
/// // A flutter that goes on as long as one likes, of a clip of two meters.
/// let path = graph.walk(&MotionGraph::always(Regime::PeriodicFlutter as usize, 6)?, 5.0, 1)?;
/// assert!(path.keys().last().unwrap().position.y <= -5.0);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct FrameGraph {
    pub(super) interval: f64,
    pub(super) params: FrameGraphParams,
    pub(super) nodes: Vec<Node>,
    splices: Vec<FrameSplice>,
}

/// The compared points of a window of frames, about their mean: x, y, z, and half of their squares' sum.
struct Window {
    points: [Vec<f64>; 3],
    square: f64,
}

/// Frames that a graph may have: distances of all pairs are computed.
const MOST_FRAMES: f64 = 2e4;

impl Window {
    fn of(nodes: &[Node], [long, short]: [f64; 2], flip: &UnitQuaternion<f64>) -> Self {
        let points = nodes.iter().flat_map(|node| {
            let attitude = node.instant.attitude * flip;
            let center = node.instant.position;
            let ends = [Vector3::x() * (0.5 * long), Vector3::y() * (0.5 * short)];
            [
                center,
                center + attitude * ends[0],
                center + attitude * ends[1],
            ]
        });
        let mut points: Vec<Vector3<f64>> = points.collect();
        let mean = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
        points.iter_mut().for_each(|point| *point -= mean);
        Self {
            square: points.iter().map(|p| p.norm_squared()).sum(),
            points: [0, 1, 2].map(|axis| points.iter().map(|p| p[axis]).collect()),
        }
    }

    /// Mean square distance from another window that is turned about the vertical and moved onto this one,
    /// and the turn, rad.
    fn distance(&self, other: &Self) -> (f64, f64) {
        let [x, y, z] = &self.points;
        let [u, v, w] = &other.points;
        let (mut along, mut across, mut up) = (0.0, 0.0, 0.0);
        for i in 0..x.len() {
            along += x[i] * u[i] + z[i] * w[i];
            across += x[i] * w[i] - z[i] * u[i];
            up += y[i] * v[i];
        }
        // Turned by θ the product of the horizontal parts is along·cos θ + across·sin θ.
        let product = math::hypot(along, across) + up;
        let square = (self.square + other.square - 2.0 * product).max(0.0);
        (square / x.len() as f64, math::atan2(across, along))
    }
}

pub(super) fn about_vertical(heading: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector3::y_axis(), heading)
}

fn wide(v: Vector) -> Vector3<f64> {
    Vector3::from(v.to_array().map(f64::from))
}

fn wide_rotation(q: Rotation) -> UnitQuaternion<f64> {
    let [x, y, z, w] = q.to_array().map(f64::from);
    UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
}

impl FrameGraph {
    /// The graph of the frames of these falls, their keys, which must be the same time apart.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] names a parameter that cannot be, an interval that
    /// differs from the first one's, or more than 20 000 frames; [`Error::WrongLength`] if there is no fall, or
    /// no splice between them that a walk without end could take.
    pub fn new(clips: &[MotionPath], params: FrameGraphParams) -> Result<Self, Error> {
        params.check()?;
        let none = |what| Error::WrongLength {
            what,
            expected: 1,
            actual: 0,
        };
        let first = clips.first().ok_or(none("falls of the frame graph"))?;
        let interval = f64::from(first.interval());
        let frames: usize = clips.iter().map(|clip| clip.keys().len()).sum();
        Error::check_range("frames of the graph", frames as f64, 2.0, MOST_FRAMES)?;
        let mut nodes = Vec::with_capacity(frames);
        let mut ends = Vec::new();
        for clip in clips {
            let own = f64::from(clip.interval());
            let alike = (own / interval - 1.0).abs() < 0.05;
            Error::check("interval of a fall", own, alike, "that of the first one")?;
            let last = clip.keys().len() - 1;
            nodes.extend(clip.keys().iter().enumerate().map(|(i, key)| Node {
                instant: Instant {
                    position: wide(key.position),
                    velocity: wide(key.velocity),
                    attitude: wide_rotation(key.attitude),
                },
                regime: clip.regime_at(i as Real * clip.interval()),
                goes_on: i < last,
                splices: 0..0,
                alive: true,
            }));
            ends.push(nodes.len());
        }
        let mut graph = Self {
            interval,
            params,
            nodes,
            splices: Vec::new(),
        };
        graph.find_splices(&ends);
        graph.leave_out_dead_ends();
        if !graph.nodes.iter().any(|node| node.alive) {
            return Err(none("frames from which a walk need not end"));
        }
        Ok(graph)
    }

    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.nodes.len()
    }

    /// Frames from which a walk need not end.
    pub fn frames_in_use(&self) -> usize {
        self.nodes.iter().filter(|node| node.alive).count()
    }

    /// The regime of a frame.
    pub fn regime(&self, frame: usize) -> Regime {
        self.nodes[frame].regime
    }

    /// The splices, by the frame that they leave.
    pub fn splices(&self) -> &[FrameSplice] {
        &self.splices
    }

    /// The local minima under the threshold of the distances of all pairs of windows. `ends` are the ends
    /// of the clips.
    fn find_splices(&mut self, ends: &[usize]) {
        let window = self.params.window;
        let flips = half_turns();
        let windows_of = |flip: &UnitQuaternion<f64>| -> Vec<Option<Window>> {
            let mut windows = Vec::with_capacity(self.nodes.len());
            for end in ends {
                for start in windows.len()..*end {
                    let whole = start + window <= *end;
                    windows.push(whole.then(|| {
                        Window::of(
                            &self.nodes[start..start + window],
                            self.params.extents,
                            flip,
                        )
                    }));
                }
            }
            windows
        };
        let windows = flips.map(|flip| windows_of(&flip));
        let far = (f64::INFINITY, 0.0, 0);
        let threshold = self.params.threshold * self.params.threshold;
        let row = |from: usize| -> Vec<(f64, f64, usize)> {
            let Some(own) = &windows[0][from] else {
                return vec![far; self.nodes.len()];
            };
            let best = |to: usize| {
                let forward = self.nodes[to].regime >= self.nodes[from].regime;
                // A window overlaps with its own neighbours.
                if !forward || from.abs_diff(to) < 2 * window {
                    return far;
                }
                let distances = windows.iter().enumerate().filter_map(|(flip, windows)| {
                    let (square, heading) = own.distance(windows[to].as_ref()?);
                    Some((square, heading, flip))
                });
                distances.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or(far)
            };
            (0..self.nodes.len()).map(best).collect()
        };
        let mut splices = Vec::new();
        let mut ranges = Vec::with_capacity(self.nodes.len());
        // Rows before, at and after the one that is looked at.
        let mut rows = [vec![far; self.nodes.len()], row(0), Vec::new()];
        for from in 0..self.nodes.len() {
            rows[2] = match from + 1 < self.nodes.len() {
                true => row(from + 1),
                false => vec![far; self.nodes.len()],
            };
            let begin = splices.len();
            for to in 0..self.nodes.len() {
                let (square, heading, flip) = rows[1][to];
                let around = to.saturating_sub(1)..(to + 2).min(self.nodes.len());
                let least = rows
                    .iter()
                    .all(|row| row[around.clone()].iter().all(|other| square <= other.0));
                if square <= threshold && least {
                    splices.push(self.splice(from, to, square.sqrt(), heading, flip));
                }
            }
            ranges.push(begin..splices.len());
            rows.rotate_left(1);
        }
        self.splices = splices;
        for (node, range) in self.nodes.iter_mut().zip(ranges) {
            node.splices = range;
        }
    }

    fn splice(
        &self,
        from: usize,
        to: usize,
        distance: f64,
        heading: f64,
        flip: usize,
    ) -> FrameSplice {
        let [before, after] = [from, to].map(|node| &self.nodes[node].instant);
        let turn = about_vertical(heading);
        FrameSplice {
            from,
            to,
            distance,
            heading,
            velocity: (before.velocity - turn * after.velocity).norm(),
            angle: before
                .attitude
                .angle_to(&(turn * after.attitude * half_turns()[flip])),
            flip,
        }
    }

    /// Leaves out, until nothing changes, what neither goes on nor is left by a splice.
    fn leave_out_dead_ends(&mut self) {
        loop {
            let mut changed = false;
            for node in (0..self.nodes.len()).rev() {
                let goes_on = self.nodes[node].goes_on && self.nodes[node + 1].alive;
                let leads_on = || self.ways_on(node).next().is_some();
                if self.nodes[node].alive && !goes_on && !leads_on() {
                    self.nodes[node].alive = false;
                    changed = true;
                }
            }
            if !changed {
                return;
            }
        }
    }

    /// The splices that leave a node for one after which a walk can go on.
    pub(super) fn ways_on(&self, node: usize) -> impl Iterator<Item = &FrameSplice> {
        let splices = &self.splices[self.nodes[node].splices.clone()];
        // A window is longer than a frame, so that there is a next one.
        splices
            .iter()
            .filter(|splice| self.nodes[splice.to + 1].alive)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{to_real, to_rotation};
    use crate::motion::MotionGraph;
    use crate::motion::path::Key;

    /// A fall of `count` keys 0.01 s apart that swings along a heading, from `start` radians of its period on.
    fn swinging(count: usize, start: f64, heading: f64, regime: Regime) -> MotionPath {
        let turn = about_vertical(heading);
        let keys = (0..count).map(|i| {
            let t = 0.01 * i as f64;
            let phase = 10.0 * t + start;
            let roll = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.6 * phase.sin());
            let lying =
                UnitQuaternion::from_axis_angle(&Vector3::x_axis(), -0.5 * std::f64::consts::PI);
            Key {
                position: to_real(turn * Vector3::new(0.05 * phase.sin(), -t, 0.0)),
                velocity: to_real(turn * Vector3::new(0.5 * phase.cos(), -1.0, 0.0)),
                attitude: to_rotation(turn * roll * lying),
            }
        });
        MotionPath::new(0.01, keys.collect(), vec![(0.0, regime)]).unwrap()
    }

    fn params() -> FrameGraphParams {
        FrameGraphParams {
            threshold: 2e-3,
            ..FrameGraphParams::new([0.08, 0.04], 0.3)
        }
    }

    /// The same swing, begun 21 frames later and along another heading: the splices between the two lead to the
    /// same phase, with the turn between the headings, and hide nothing; or half a period on, which under a half
    /// turn about the vertical looks alike, and is no whole number of frames.
    #[test]
    fn splices_of_the_same_motion_hide_nothing() {
        let clips = [
            swinging(100, 0.0, 0.3, Regime::PeriodicFlutter),
            swinging(100, 2.1, 1.4, Regime::PeriodicTumbling),
        ];
        // With these alone every walk ends with the second clip, as splices only lead forward.
        let exact = FrameGraphParams {
            threshold: 1e-5,
            ..params()
        };
        assert!(FrameGraph::new(&clips, exact).is_err());
        let graph = FrameGraph::new(&clips, params()).unwrap();
        let mut same = 0;
        for splice in graph.splices() {
            assert!(splice.distance <= 2e-3);
            assert!(graph.regime(splice.to) >= graph.regime(splice.from));
            if splice.from >= 100 || splice.to < 100 {
                continue;
            }
            let frames = splice.from as f64 - (splice.to as f64 - 100.0 + 21.0);
            let half_periods = 0.1 * frames / std::f64::consts::PI;
            let off = (half_periods - half_periods.round()).abs();
            assert!(off < 0.1, "{splice:?}");
            if frames == 0.0 {
                assert!((splice.heading + 1.1).abs() < 1e-3, "{splice:?}");
                // Angles of rotations in f32.
                assert!(splice.velocity < 1e-3 && splice.angle < 2e-3, "{splice:?}");
                same += 1;
            }
        }
        assert!(same > 10, "{same}");
        assert!(graph.frames_in_use() > 100 && graph.frames_in_use() < 200);
    }

    /// A walk is continuous: positions follow their velocities, across splices too.
    #[test]
    fn walks_are_continuous() {
        let clips = [swinging(150, 0.0, 0.0, Regime::PeriodicFlutter)];
        let graph = FrameGraph::new(&clips, params()).unwrap();
        let chain = MotionGraph::always(Regime::PeriodicFlutter as usize, 6).unwrap();
        let path = graph.walk(&chain, 10.0, 3).unwrap();
        assert!(path.duration() > 8.0);
        for pair in path.keys().windows(2) {
            let mean = (pair[0].velocity + pair[1].velocity) * 0.5;
            let jump = (pair[1].position - pair[0].position - mean * 0.01).length();
            // Acceleration's change over the interval: 0.05 · 10³ · 0.01³/12, and the blend's.
            assert!(jump < 1e-4, "{jump}");
            assert!(pair[0].attitude.angle_between(pair[1].attitude) < 0.2);
        }
        assert_eq!(path, graph.walk(&chain, 10.0, 3).unwrap());
        assert_ne!(path, graph.walk(&chain, 10.0, 4).unwrap());
        assert!(graph.walk(&chain, -1.0, 3).is_err());
        let tumbling = MotionGraph::always(Regime::PeriodicTumbling as usize, 6).unwrap();
        // What the clips do not show cannot be walked; the chain's probability goes to what they do.
        assert!(graph.walk(&tumbling, 1.0, 3).is_ok());
        assert!(graph.walk(&MotionGraph::thesis(), 1.0, 3).is_err());
    }

    #[test]
    fn bad_graphs_are_refused() {
        let clip = swinging(50, 0.0, 0.0, Regime::PeriodicFlutter);
        let new = |params| FrameGraph::new(std::slice::from_ref(&clip), params).is_err();
        assert!(FrameGraph::new(&[], params()).is_err());
        assert!(new(FrameGraphParams {
            window: 1,
            ..params()
        }));
        assert!(new(FrameGraphParams {
            threshold: 0.0,
            ..params()
        }));
        assert!(new(FrameGraphParams {
            segment: f64::NAN,
            ..params()
        }));
        assert!(new(FrameGraphParams {
            extents: [0.1, -0.1],
            ..params()
        }));
        let other = MotionPath::new(0.02, clip.keys().to_vec(), clip.regimes().to_vec()).unwrap();
        assert!(FrameGraph::new(&[clip.clone(), other], params()).is_err());
    }
}
