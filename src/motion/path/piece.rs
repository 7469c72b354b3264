//! One stretch of a fall in one pattern, and how it is spliced to the one before.

use super::curve::UnifiedCurve;
use super::segment::Segment;
use super::tanabe_kaneko::AngleCurve;
use crate::math;
use crate::motion::Regime;
use rapier3d::na::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// A moment in f64: position and velocity in the fall's frame, attitude of the glide plane's axes (chord
/// x, normal y).
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant {
    pub position: Vector3<f64>,
    pub velocity: Vector3<f64>,
    pub attitude: UnitQuaternion<f64>,
}

/// What a stretch follows.
#[derive(Clone, Copy, Debug)]
pub(super) enum Course<'a> {
    /// A segment between two turning points.
    Glide {
        segment: Segment,
        /// Factor on its lengths and times, which leaves velocities as they are.
        stretch: f64,
        flutter: &'a AngleCurve,
        tumbling: &'a AngleCurve,
        /// Factor on the angles of a turn back: small segments swing little.
        swing: f64,
        /// Whether the body turns over, instead of back, at the beginning and at the end.
        over: [bool; 2],
    },
    /// A spiral or helix, from its first point and tangent on; `sense` is the way it turns.
    Curve { curve: UnifiedCurve, sense: f64 },
    /// A fall straight down.
    Straight,
}

/// Units and gravity of a fall.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    /// Length of the database's unit, m.
    pub length: f64,
    /// U, m/s.
    pub descent: f64,
    /// Gravity less buoyancy, m/s².
    pub weight: f64,
}

/// Tangent of the steepest bank.
const STEEPEST: f64 = 1.2;

/// A step from 0 to 1 that is flat at both ends.
fn smooth(s: f64) -> f64 {
    let s = s.clamp(0.0, 1.0);
    s * s * (3.0 - 2.0 * s)
}

impl Course<'_> {
    /// The moment `t` seconds after the beginning, which is at the origin, without any splice.
    pub fn at(&self, t: f64, duration: f64, units: &Units) -> Instant {
        match self {
            Self::Straight => Instant {
                position: -Vector3::y() * units.descent * t,
                velocity: -Vector3::y() * units.descent,
                attitude: UnitQuaternion::identity(),
            },
            Self::Glide {
                segment,
                stretch,
                flutter,
                tumbling,
                swing,
                over,
            } => {
                let length = units.length * stretch;
                let time = t * units.descent / length;
                let (p, v) = (segment.position(time), segment.velocity(time));
                let share = t / duration;
                // The turn at each end decides about the angle there.
                let [start, end] = over.map(|over| {
                    if over {
                        tumbling.at(share)
                    } else {
                        flutter.at(share) * swing
                    }
                });
                let angle = start + (end - start) * smooth(share);
                Instant {
                    position: Vector3::new(p.x, p.y, 0.0) * length,
                    velocity: Vector3::new(v.x, v.y, 0.0) * units.descent,
                    attitude: UnitQuaternion::from_axis_angle(
                        &Vector3::z_axis(),
                        segment.glide.sign() * angle,
                    ),
                }
            }
            Self::Curve { curve, sense } => {
                // The curve begins at +x along +z; here it begins along +x.
                let place = |v: Vector3<f64>| Vector3::new(v.z, v.y, -v.x * sense);
                let acceleration = place(curve.acceleration(t));
                let (sin, cos) = math::sin_cos(curve.frequency * t);
                let around = place(Vector3::new(-sin, 0.0, cos));
                Instant {
                    position: place(curve.position(t) - curve.position(0.0)),
                    velocity: place(curve.velocity(t)),
                    attitude: banked(&acceleration, &around, units.weight),
                }
            }
        }
    }
}

/// The fluid pushes a thin body along its normal; so the normal points along the force that the path
/// asks for, acceleration less weight (ours: thesis § 3.7 leaves the axis open). The chord follows the
/// circle.
fn banked(acceleration: &Vector3<f64>, around: &Vector3<f64>, weight: f64) -> UnitQuaternion<f64> {
    let bank = acceleration / weight;
    let limit = (1.0 + (bank.norm() / STEEPEST).powi(2)).sqrt();
    let normal = (Vector3::y() + bank / limit).normalize();
    let chord = (around - normal * around.dot(&normal)).normalize();
    let axes = Matrix3::from_columns(&[chord, normal, chord.cross(&normal)]);
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes))
}

/// A stretch of a fall with what joins it to the one before.
#[derive(Clone, Debug)]
pub(super) struct Piece<'a> {
    pub course: Course<'a>,
    pub regime: Regime,
    /// When it begins, s, and how long it lasts, s.
    pub start: f64,
    pub duration: f64,
    origin: Vector3<f64>,
    join: Join,
    /// Half turn about an axis of the plate, under which it looks the same.
    flip: UnitQuaternion<f64>,
}

/// What is left of the motion before a splice: a velocity difference Δv fades as Δv t(1 − t/T)² (no
/// displacement is left), a rotation by a smooth step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Join {
    /// How long the splice takes, s.
    pub blend: f64,
    /// Velocity that the motion before ended with, less this one's.
    pub velocity: Vector3<f64>,
    /// Rotation from this one's first attitude to the last one before.
    pub turn: UnitQuaternion<f64>,
}

impl Join {
    /// Nothing is left of anything before.
    pub fn none(blend: f64) -> Self {
        Self {
            blend,
            velocity: Vector3::zeros(),
            turn: UnitQuaternion::identity(),
        }
    }

    /// The motion `own` as it looks `t` seconds after the splice.
    pub fn at(&self, t: f64, own: &Instant) -> Instant {
        let left = (1.0 - t / self.blend).max(0.0);
        let share = 1.0 - smooth(1.0 - left);
        Instant {
            position: own.position + self.velocity * (t * left * left),
            velocity: own.velocity + self.velocity * (left * (left - 2.0 * t / self.blend)),
            attitude: self.turn.powf(share) * own.attitude,
        }
    }
}

/// Half turns about the axes of a plate, under which it looks the same, and none.
pub(super) fn half_turns() -> [UnitQuaternion<f64>; 4] {
    let half = |axis| UnitQuaternion::from_axis_angle(&axis, std::f64::consts::PI);
    [
        UnitQuaternion::identity(),
        half(Vector3::x_axis()),
        half(Vector3::y_axis()),
        half(Vector3::z_axis()),
    ]
}

impl<'a> Piece<'a> {
    /// A piece after one that ended at `before`: it starts where that ended, and is [joined](Join) to it. A
    /// piece shorter than the splice leaves the rest to the next one.
    pub fn after(
        before: Option<&Instant>,
        course: Course<'a>,
        regime: Regime,
        start: f64,
        duration: f64,
        blend: f64,
        units: &Units,
    ) -> Self {
        let own = course.at(0.0, duration, units);
        let mut piece = Self {
            course,
            regime,
            start,
            duration,
            origin: Vector3::zeros(),
            join: Join::none(blend),
            flip: UnitQuaternion::identity(),
        };
        if let Some(before) = before {
            piece.origin = before.position;
            piece.join.velocity = before.velocity - own.velocity;
            let away =
                |flip: &UnitQuaternion<f64>| (own.attitude * flip).angle_to(&before.attitude);
            for flip in half_turns() {
                if away(&flip) < away(&piece.flip) - 1e-9 {
                    piece.flip = flip;
                }
            }
            piece.join.turn = before.attitude * (own.attitude * piece.flip).inverse();
        }
        piece
    }

    /// The moment `t` seconds after the beginning.
    pub fn at(&self, t: f64, units: &Units) -> Instant {
        let mut own = self.course.at(t, self.duration, units);
        own.position += self.origin;
        own.attitude *= self.flip;
        self.join.at(t, &own)
    }

    /// What the splice has to hide: the jump of the velocity, m/s, and of the attitude, rad.
    pub fn jump(&self) -> (f64, f64) {
        (self.join.velocity.norm(), self.join.turn.angle())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body in a steady turn leans inward by atan(a/g'), and its chord follows the path.
    #[test]
    fn bank_of_a_turn() {
        let attitude = banked(&Vector3::new(0.3, 0.0, 0.0), &Vector3::z(), 10.0);
        let normal = attitude * Vector3::y();
        // The limit of the bank changes it to second order, by (0.03/1.2)²/2.
        assert!((normal.x / normal.y / 0.03 - 1.0).abs() < 1e-3);
        assert!((attitude * Vector3::x() - Vector3::z()).norm() < 1e-6);
        let steep = banked(&Vector3::new(1e6, 0.0, 0.0), &Vector3::z(), 10.0) * Vector3::y();
        assert!((steep.x / steep.y - STEEPEST).abs() < 1e-3);
    }

    /// The splice from a straight fall to a spiral is continuous in position, velocity and attitude,
    /// velocity is the derivative of position within it, and no displacement is left.
    #[test]
    fn splice() {
        let units = Units {
            length: 0.04,
            descent: 1.0,
            weight: 9.0,
        };
        let straight = Piece::after(
            None,
            Course::Straight,
            Regime::SteadyDescent,
            0.0,
            0.5,
            0.2,
            &units,
        );
        let end = straight.at(0.5, &units);
        let course = Course::Curve {
            curve: UnifiedCurve::spiral(0.06, 8.0, 1.0),
            sense: -1.0,
        };
        let spiral = Piece::after(
            Some(&end),
            course,
            Regime::PeriodicSpiral,
            0.5,
            2.0,
            0.2,
            &units,
        );
        let first = spiral.at(0.0, &units);
        assert!((first.position - end.position).norm() < 1e-15);
        assert!((first.velocity - end.velocity).norm() < 1e-15);
        assert!(first.attitude.angle_to(&end.attitude) < 1e-7);
        for i in 1..100 {
            let (t, h) = (0.01 * f64::from(i), 1e-6);
            let at = |t| spiral.at(t, &units).position;
            let slope = (at(t + h) - at(t - h)) / (2.0 * h);
            // Where the splice ends the second derivative jumps: h times that.
            assert!((slope - spiral.at(t, &units).velocity).norm() < 2e-5);
        }
        let own = course.at(1.0, 2.0, &units);
        assert!((spiral.at(1.0, &units).position - end.position - own.position).norm() < 1e-15);
    }
}
