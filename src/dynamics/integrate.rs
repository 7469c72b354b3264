//! One step of one body (or of several, side by side), in the frame that moves with the fluid.
//!
//! # The scheme
//!
//! Extrapolated, linearly implicit midpoint. Over a substep h the matrix N of
//! [`kirchhoff`](super::kirchhoff) is frozen at the velocity extrapolated to the middle, and
//!
//! ```text
//! (𝕄 − θhN) Δν = h (Nν + Q),      θ = ½ for slow bodies, → 1 where drag is stiff
//! ```
//!
//! is solved directly. Multiplying by ν + θΔν shows that without external forces the energy
//! ½ν·𝕄ν cannot grow, *whatever N was frozen at*, because its symmetric part is not positive; with
//! θ = ½ and no drag it is conserved exactly. The attitude moves by the Cayley map of the middle
//! angular velocity; the position by the displacement that conserves the world impulse moment
//! exactly together with it.
//!
//! One force evaluation and one 6×6 solve per substep; second order. The velocity at the middle is
//! extrapolated along a parabola through the last two substeps, which costs nothing and halves to
//! quarters the error. What is extrapolated is the acceleration felt in plate axes, u̇ + ω × u: that
//! the axes turn under the velocity is known without history, and tumbling plates need a third fewer
//! substeps for it. And of N the body's own momentum is left to ω× acting on u (see
//! [`kirchhoff`](super::kirchhoff)), which keeps a heavy body's frozen momentum from turning it, for
//! another factor of two to five.
//!
//! # Designs compared
//!
//! Error of the position after half a second, relative to the path, at 60, 240 and 960 substeps per
//! second (test `dynamics::designs`, which also flies each design):
//!
//! | design | evaluations | leaf in air | steel plate in water | foam plate in water |
//! |---|---|---|---|---|
//! | **linearly implicit midpoint** | 1 | 4e-3, 3e-4, 2e-5 | .03, 2e-3, 2e-4 | .22, .04, .02 |
//! | N frozen twice | 2 | 4e-3, 3e-4, 2e-5 | 5e-3, 5e-4, 3e-5 | .13, .04, 5e-3 |
//! | linearly implicit Euler | 1 | .02, 8e-3, 2e-3 | .11, .03, 9e-3 | .07, .04, .01 |
//! | Runge–Kutta 4 | 4 | 3e-5, 2e-7, 1e-9 | 3e-4, 2e-5, 1e-5 | blows up, blows up, .05 |
//!
//! Runge–Kutta is the most accurate where it is stable, but it is not where a light body drags a
//! heavy fluid along; implicit Euler is stable but damps flutter away. The midpoint scheme is stable
//! everywhere and within a percent for what falls in air at 60 steps/s.

use super::kirchhoff::{Twist, choose, cross};
use crate::body::InertiaConstants;
use crate::hydro::viscous::{Evaluate, ViscousTerms, safe_inverse};
use crate::math::Scalar;
use rapier3d::na::{Quaternion, Vector3};

/// How finely, and how exactly, a step is integrated.
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

/// The moving part of a body: velocities in plate axes, relative to the fluid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion<T> {
    /// Plate axes to world axes.
    pub attitude: Quaternion<T>,
    /// Displacement since the step began, world axes, in the frame of the fluid.
    pub displacement: Vector3<T>,
    /// u and w = ωL.
    pub velocity: Twist<T>,
    /// Acceleration over the last substep, u̇ + ω × u and ẇ; zero where there is no history.
    pub rate: Twist<T>,
    /// Its change per second between the last two substeps.
    pub trend: Twist<T>,
    /// Length of the last substep, s; zero where there is no history.
    pub last: T,
}

/// What acts on a body besides the fluid's resistance, constant over a step. World axes, per unit of
/// the mass scale.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Load<T> {
    /// Weight, buoyancy and user's force, m/s².
    pub force: Vector3<T>,
    /// User's torque over L, m/s².
    pub torque: Vector3<T>,
    /// Buoyancy −ρVg over the mass scale, m/s²; acts at `buoyancy_arm`.
    pub buoyancy: Vector3<T>,
    /// From the center of mass to the center of buoyancy, plate axes, in L.
    pub buoyancy_arm: Vector3<T>,
    /// Half the vorticity of the fluid times L, m/s: the spin at which damping rests.
    pub fluid_spin: Vector3<T>,
    /// Whether torque or buoyancy arm are not zero for some body.
    pub turning: bool,
    /// Whether the fluid's spin is not zero around some body.
    pub spinning: bool,
}

/// `q v q*` for a unit quaternion.
#[inline(always)]
pub(crate) fn rotate<T: Scalar>(q: &Quaternion<T>, v: &Vector3<T>) -> Vector3<T> {
    let a = q.coords.xyz();
    let t = cross(&a, v);
    let t = t + t;
    v + t * q.coords.w + cross(&a, &t)
}

/// `q*`
#[inline(always)]
pub(crate) fn conjugate<T: Scalar>(q: &Quaternion<T>) -> Quaternion<T> {
    let q = &q.coords;
    Quaternion::new(q.w, -q.x, -q.y, -q.z)
}

/// `q* v q` for a unit quaternion.
#[inline(always)]
pub(crate) fn rotate_back<T: Scalar>(q: &Quaternion<T>, v: &Vector3<T>) -> Vector3<T> {
    rotate(&conjugate(q), v)
}

/// `q · cay(2a)`: the attitude turned by the body-axes rotation whose half tangent is `a`. As long as
/// `q` is.
#[inline(always)]
fn turned<T: Scalar>(q: &Quaternion<T>, a: &Vector3<T>) -> Quaternion<T> {
    let (q, x, y, z) = (&q.coords, a.x, a.y, a.z);
    let one = x.lit(1.0);
    let per = one / (one + norm2(a)).root();
    Quaternion::new(
        (q.w - q.x * x - q.y * y - q.z * z) * per,
        (q.x + q.w * x + q.y * z - q.z * y) * per,
        (q.y + q.w * y + q.z * x - q.x * z) * per,
        (q.z + q.w * z + q.x * y - q.y * x) * per,
    )
}

/// `q` in the lanes where `a < b`, `other` elsewhere.
#[inline(always)]
fn either<T: Scalar>(q: &Quaternion<T>, a: T, b: T, other: &Quaternion<T>) -> Quaternion<T> {
    let (q, other) = (&q.coords, &other.coords);
    let axis = choose(&q.xyz(), a, b, &other.xyz());
    Quaternion::new(q.w.where_less(a, b, other.w), axis.x, axis.y, axis.z)
}

/// Removes what rounding has done to the length.
#[inline(always)]
fn normalized<T: Scalar>(q: &Quaternion<T>) -> Quaternion<T> {
    let q = q.coords;
    let norm = (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z).root();
    Quaternion::from_vector(q * (norm.lit(1.0) / norm))
}

/// The law of a body in an ideal fluid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inviscid;

impl<T: Scalar> Evaluate<T> for Inviscid {
    #[inline(always)]
    fn least_iterations(&self) -> u32 {
        8
    }

    #[inline(always)]
    fn terms(&self, u: &Vector3<T>, _w: &Vector3<T>) -> ViscousTerms<T> {
        ViscousTerms::none(u.x)
    }
}

/// What moves less than this many chords in a step may change its course as it likes.
const IDLE: f64 = 0.02;

/// Number of equal substeps for a step of `dt`, as a scalar so that lanes can differ.
#[inline(always)]
pub(crate) fn substeps<T: Scalar>(
    inertia: &InertiaConstants<T>,
    motion: &Motion<T>,
    load: &Load<T>,
    dt: T,
    integrator: &Integrator,
) -> T {
    let half = dt * dt.lit(0.5);
    let speed = norm(&motion.velocity.linear);
    let spin = norm(&motion.velocity.angular) * inertia.per_length;
    // The course turns too: at the ends of a swing the body is slow, and the flow changes fast.
    let felt = norm(&motion.rate.linear);
    let course = speed + felt * half + inertia.chord * dt.lit(IDLE) / dt;
    let turns = spin.larger(felt / course) * dt.lit(1.0 / integrator.max_turn);
    // A body that starts from rest will have moved by then.
    let way = speed + norm(&load.force) * half;
    let travels = way / (inertia.chord * dt.lit(integrator.max_travel));
    let wanted = dt * turns.larger(travels);
    let most = dt.lit(f64::from(integrator.max_substeps.max(1)));
    wanted.ceiling().larger(dt.lit(1.0)).smaller(most)
}

#[inline(always)]
fn norm2<T: Scalar>(v: &Vector3<T>) -> T {
    v.x * v.x + v.y * v.y + v.z * v.z
}

#[inline(always)]
fn norm<T: Scalar>(v: &Vector3<T>) -> T {
    norm2(v).root()
}

/// Advances `motion` by one substep `h`, which may be zero.
#[inline(always)]
pub(crate) fn substep<const SYMMETRIC: bool, T: Scalar, L: Evaluate<T>>(
    inertia: &InertiaConstants<T>,
    law: &L,
    load: &Load<T>,
    motion: &mut Motion<T>,
    h: T,
    iterations: u32,
) {
    let (zero, half, one) = (h.lit(0.0), h.lit(0.5), h.lit(1.0));
    let start = motion.velocity;
    let ahead = motion
        .rate
        .add_scaled(&motion.trend, half * (motion.last + half * h));
    let mut middle = start.add_scaled(&ahead, half * h);
    // The axes turn under the velocity: u̇ = a − ω × u, taken halfway to the middle.
    let turns = half * h * inertia.per_length;
    let turned_away = cross(&start.angular, &start.linear) * turns;
    let way = Twist {
        linear: middle.linear - turned_away,
        angular: middle.angular,
    };
    let halfway = start.add_scaled(&way, one).scaled(half);
    middle.linear -= cross(&halfway.angular, &halfway.linear) * turns;
    let mut delta = Twist::zero(h);
    for _ in 0..iterations.max(law.least_iterations()) {
        let half_turn = middle.angular * (half * h * inertia.per_length);
        let attitude = turned(&motion.attitude, &(half_turn * half));
        let fluid_spin = if load.spinning {
            rotate_back(&attitude, &load.fluid_spin)
        } else {
            Vector3::repeat(zero)
        };
        let terms = law.terms(
            &inertia.center_velocity(&middle),
            &(middle.angular - fluid_spin),
        );
        let mut push = Twist {
            linear: rotate_back(&attitude, &load.force),
            angular: Vector3::repeat(zero),
        };
        if load.turning {
            let buoyancy = rotate_back(&attitude, &load.buoyancy);
            push.angular =
                rotate_back(&attitude, &load.torque) + cross(&load.buoyancy_arm, &buoyancy);
        }
        if load.spinning {
            push.angular += terms.damping.component_mul(&fluid_spin);
        }

        // z: decay per substep of the motion as it is, and of the rotation about the axis where it
        // is fastest. θ is just implicit enough that such a decay does not overshoot zero.
        let u = &middle.linear;
        let inertial =
            u.x * u.x * inertia.m11_xx + u.y * u.y * inertia.m11_yy + u.z * u.z * inertia.m11_zz;
        let (s, k) = (&terms.creeping, &terms.damping);
        let along_x = (s.x * inertia.per_m11_xx).larger(k.x * inertia.per_m22_xx);
        let along_y = (s.y * inertia.per_m11_yy).larger(k.y * inertia.per_m22_yy);
        let along_z = (s.z * inertia.per_m11_zz).larger(k.z * inertia.per_m22_zz);
        let slow = along_x.larger(along_y).larger(along_z);
        let pressure = terms.drag * norm2(u) * safe_inverse(inertial);
        let z = h * (pressure + slow);
        let theta = half.larger(one - safe_inverse(z));
        delta = inertia.increment::<SYMMETRIC>(&terms, &start, &middle, &push, h, theta);
        middle = start.add_scaled(&delta, half);
    }

    motion.velocity = start.add_scaled(&delta, one);
    // A lane that is done has h = 0 and keeps its history.
    let done = h.lit(1e-12);
    let per_h = one / h.larger(done);
    let old = motion.rate;
    let mut rate = delta.scaled(per_h);
    rate.linear += cross(&middle.angular, &middle.linear) * inertia.per_length;
    motion.rate = old.where_less(h, done, &rate);
    let per = (one + one) / (motion.last + h);
    let per = zero.where_less(motion.last, done, per);
    let trend = motion.rate.add_scaled(&old, -one).scaled(per);
    motion.trend = motion.trend.where_less(h, done, &trend);
    motion.last = motion.last.where_less(h, done, h);

    let a = middle.angular * (half * h * inertia.per_length);
    let moved = (middle.linear + cross(&a, &middle.linear))
        * (h / (one + a.x * a.x + a.y * a.y + a.z * a.z));
    motion.displacement += rotate(&motion.attitude, &moved);
    // Turning by nothing would still round.
    let turned = turned(&motion.attitude, &a);
    motion.attitude = either(&motion.attitude, h, done, &turned);
}

/// Advances `motion` by `dt` in `count` substeps, of which `most` is the largest over the lanes.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub(crate) fn advance<const SYMMETRIC: bool, T: Scalar, L: Evaluate<T>>(
    inertia: &InertiaConstants<T>,
    law: &L,
    load: &Load<T>,
    motion: &mut Motion<T>,
    dt: T,
    count: T,
    most: u32,
    iterations: u32,
) {
    let start = *motion;
    let h = dt / count;
    let (zero, one) = (dt.lit(0.0), dt.lit(1.0));
    let mut done = zero;
    for _ in 0..most {
        // Lanes that need fewer substeps than their neighbours stand still.
        let h = h.where_less(done, count, zero);
        substep::<SYMMETRIC, T, L>(inertia, law, load, motion, h, iterations);
        done += one;
    }
    // Whatever goes wrong (a law that pumps, a fluid at 10⁶ m/s), rapier never sees it: NaN fails
    // the comparison, and the body coasts through this step.
    let size =
        norm(&motion.velocity.linear) + norm(&motion.velocity.angular) + norm(&motion.displacement);
    let limit = dt.lit(1e6);
    let resting = Twist::zero(zero);
    let moved = &motion.displacement;
    let coasting = rotate(&start.attitude, &start.velocity.linear) * dt;
    motion.displacement = choose(moved, size, limit, &coasting);
    motion.velocity = motion.velocity.where_less(size, limit, &start.velocity);
    motion.rate = motion.rate.where_less(size, limit, &resting);
    motion.trend = motion.trend.where_less(size, limit, &resting);
    let attitude = normalized(&motion.attitude);
    motion.attitude = either(&attitude, size, limit, &start.attitude);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::BodyConstants;
    use crate::{DryMass, Fluid, HydroProperties, ImmersedBody};
    use rapier3d::math::Vector;
    use rapier3d::na::{Matrix3, UnitQuaternion};
    use rapier3d::parry::shape::Cuboid;

    /// The lanes' own rotation against nalgebra's.
    #[test]
    fn rotation_agrees_with_nalgebra() {
        let q = UnitQuaternion::from_euler_angles(0.3, -1.0, 2.0);
        let raw = Quaternion::new(q.w, q.i, q.j, q.k);
        let v = Vector3::new(1.0, -2.0, 0.5);
        assert!((rotate(&raw, &v) - q * v).norm() < 1e-14);
        assert!((rotate_back(&raw, &v) - q.inverse() * v).norm() < 1e-14);
        let small = Vector3::new(0.01, -0.02, 0.03);
        let cayley = q * UnitQuaternion::from_quaternion(Quaternion::new(1.0, 0.01, -0.02, 0.03));
        let turned = UnitQuaternion::new_unchecked(turned(&raw, &small));
        assert!(turned.angle_to(&cayley) < 1e-7);
    }

    /// A law that has gone mad.
    struct NotANumber;

    impl Evaluate<f64> for NotANumber {
        fn terms(&self, u: &Vector3<f64>, _w: &Vector3<f64>) -> ViscousTerms<f64> {
            ViscousTerms {
                drag: f64::NAN,
                ..ViscousTerms::none(u.x)
            }
        }
    }

    /// A step that went wrong leaves nothing behind, so that the next one can go right.
    #[test]
    fn not_a_number_is_forgotten() {
        let hydro = HydroProperties::from_shape(&Cuboid::new(Vector::new(0.04, 0.02, 0.001)));
        let dry = DryMass {
            mass: 1e-3,
            center: Vector3::zeros(),
            inertia: Matrix3::from_diagonal(&Vector3::new(1.3e-7, 5.3e-7, 6.6e-7)),
        };
        let body = ImmersedBody::new(hydro.unwrap());
        let constants = BodyConstants::new(&body, &dry, &Fluid::AIR).unwrap();
        let inertia = &constants.inertia;
        let mut motion = Motion {
            attitude: Quaternion::new(1.0, 0.0, 0.0, 0.0),
            displacement: Vector3::zeros(),
            velocity: Twist {
                linear: Vector3::new(1.0, 0.5, 0.2),
                angular: Vector3::new(0.1, 0.0, 0.3),
            },
            rate: Twist::zero(0.0),
            trend: Twist::zero(0.0),
            last: 0.01,
        };
        let load = Load {
            force: Vector3::zeros(),
            torque: Vector3::zeros(),
            buoyancy: Vector3::zeros(),
            buoyancy_arm: Vector3::zeros(),
            fluid_spin: Vector3::zeros(),
            turning: false,
            spinning: false,
        };
        let before = motion.velocity;
        advance::<false, _, _>(inertia, &NotANumber, &load, &mut motion, 0.01, 1.0, 1, 1);
        assert_eq!(motion.velocity, before);
        assert_eq!(
            (motion.rate, motion.trend),
            (Twist::zero(0.0), Twist::zero(0.0))
        );
        advance::<false, _, _>(inertia, &Inviscid, &load, &mut motion, 0.01, 1.0, 1, 1);
        assert_ne!(motion.velocity, before);
    }
}
