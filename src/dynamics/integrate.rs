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
//! second (test `dynamics::designs`, which also runs each design):
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

use super::constants::InertiaConstants;
use super::integrator::Integrator;
use super::load::Load;
use super::reaction::{Frozen, Reaction};
use crate::math::Scalar;
use crate::math::spatial::{
    Twist, cross, norm, normalized, rotate, select_lt, select_quaternion_lt, turned,
};
use rapier3d::na::{Quaternion, Vector3};

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
    let half = dt * dt.constant(0.5);
    let speed = norm(&motion.velocity.linear);
    let spin = norm(&motion.velocity.angular) * inertia.per_length;
    // The course turns too: at the ends of a swing the body is slow, and the flow changes fast.
    let felt = norm(&motion.rate.linear);
    let course = speed + felt * half + inertia.chord * dt.constant(IDLE) / dt;
    let turns = spin.max(felt / course) * dt.constant(1.0 / integrator.max_turn);
    // A body that starts from rest will have moved by then.
    let way = speed + norm(&load.force) * half;
    let travels = way / (inertia.chord * dt.constant(integrator.max_travel));
    let wanted = dt * turns.max(travels);
    let most = dt.constant(f64::from(integrator.max_substeps.max(1)));
    wanted.ceil().max(dt.constant(1.0)).min(most)
}

/// Advances `motion` by one substep `h`, which may be zero.
#[inline(always)]
pub(crate) fn substep<const SYMMETRIC: bool, T: Scalar, F: Reaction<T>>(
    inertia: &InertiaConstants<T>,
    fluid: &F,
    load: &Load<T>,
    motion: &mut Motion<T>,
    h: T,
    iterations: u32,
) {
    let (zero, half, one) = (h.constant(0.0), h.constant(0.5), h.constant(1.0));
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
    for _ in 0..iterations.max(fluid.least_iterations()) {
        let half_turn = middle.angular * (half * h * inertia.per_length);
        let frozen = Frozen {
            start,
            middle,
            attitude: turned(&motion.attitude, &(half_turn * half)),
        };
        delta = fluid.increment::<SYMMETRIC>(inertia, load, &frozen, h);
        middle = start.add_scaled(&delta, half);
    }

    motion.velocity = start.add_scaled(&delta, one);
    // A lane that is done has h = 0 and keeps its history.
    let done = h.constant(1e-12);
    let per_h = one / h.max(done);
    let old = motion.rate;
    let mut rate = delta.scaled(per_h);
    rate.linear += cross(&middle.angular, &middle.linear) * inertia.per_length;
    motion.rate = old.select_lt(h, done, &rate);
    let per = (one + one) / (motion.last + h);
    let per = zero.select_lt(motion.last, done, per);
    let trend = motion.rate.add_scaled(&old, -one).scaled(per);
    motion.trend = motion.trend.select_lt(h, done, &trend);
    motion.last = motion.last.select_lt(h, done, h);

    let a = middle.angular * (half * h * inertia.per_length);
    let moved = (middle.linear + cross(&a, &middle.linear))
        * (h / (one + a.x * a.x + a.y * a.y + a.z * a.z));
    motion.displacement += rotate(&motion.attitude, &moved);
    // Turning by nothing would still round.
    let turned = turned(&motion.attitude, &a);
    motion.attitude = select_quaternion_lt(&motion.attitude, h, done, &turned);
}

/// Advances `motion` by `dt` in `count` substeps, of which `most` is the largest over the lanes.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub(crate) fn advance<const SYMMETRIC: bool, T: Scalar, F: Reaction<T>>(
    inertia: &InertiaConstants<T>,
    fluid: &F,
    load: &Load<T>,
    motion: &mut Motion<T>,
    dt: T,
    count: T,
    most: u32,
    iterations: u32,
) {
    let start = *motion;
    let h = dt / count;
    let (zero, one) = (dt.constant(0.0), dt.constant(1.0));
    let mut done = zero;
    for _ in 0..most {
        // Lanes that need fewer substeps than their neighbours stand still.
        let h = h.select_lt(done, count, zero);
        substep::<SYMMETRIC, T, F>(inertia, fluid, load, motion, h, iterations);
        done += one;
    }
    keep_finite(&start, motion, dt);
}

/// Lets a body coast through a step of `dt` that has not led to numbers.
#[inline(always)]
pub(super) fn keep_finite<T: Scalar>(start: &Motion<T>, motion: &mut Motion<T>, dt: T) {
    let zero = dt.constant(0.0);
    // Whatever goes wrong (a law that adds energy, a fluid at 10⁶ m/s) does not reach rapier: NaN fails
    // the comparison, and the body keeps its velocity for this step.
    let size =
        norm(&motion.velocity.linear) + norm(&motion.velocity.angular) + norm(&motion.displacement);
    let limit = dt.constant(1e6);
    let resting = Twist::zero(zero);
    let moved = &motion.displacement;
    let coasting = rotate(&start.attitude, &start.velocity.linear) * dt;
    motion.displacement = select_lt(moved, size, limit, &coasting);
    motion.velocity = motion.velocity.select_lt(size, limit, &start.velocity);
    motion.rate = motion.rate.select_lt(size, limit, &resting);
    motion.trend = motion.trend.select_lt(size, limit, &resting);
    let attitude = normalized(&motion.attitude);
    motion.attitude = select_quaternion_lt(&attitude, size, limit, &start.attitude);
}

#[cfg(test)]
mod tests {
    use super::super::locked::Locks;
    use super::super::reaction::Whole;
    use super::*;
    use crate::body::{DryMass, ImmersedBody};
    use crate::dynamics::constants::BodyConstants;
    use crate::fluid::Fluid;
    use crate::hydro::HydroProperties;
    use crate::hydro::viscous::terms::Evaluate;
    use crate::hydro::viscous::terms::ViscousTerms;
    use rapier3d::math::Vector;
    use rapier3d::na::{Matrix3, Rotation3};
    use rapier3d::parry::shape::Cuboid;

    /// A law without force that notes the velocity at which it is first asked.
    struct Asked(std::cell::Cell<Option<Vector3<f64>>>);

    impl Evaluate<f64> for Asked {
        fn terms(&self, u: &Vector3<f64>, _w: &Vector3<f64>) -> ViscousTerms<f64> {
            if self.0.get().is_none() {
                self.0.set(Some(*u));
            }
            ViscousTerms::none(u.x)
        }
    }

    /// A body that spins without force keeps its velocity in the world, so that in its own axes the velocity
    /// turns against the spin: by a = ½ωh to the middle of a substep, where the law is asked. The axes'
    /// turning is followed to second order, so that a³/6 of the speed is missed, and a⁴/24.
    #[test]
    fn the_middle_velocity_turns_with_the_axes() {
        let hydro = HydroProperties::from_shape(&Cuboid::new(Vector::new(0.04, 0.02, 0.001)));
        let dry = DryMass {
            mass: 1e-3,
            center: Vector3::zeros(),
            inertia: Matrix3::from_diagonal(&Vector3::new(1.3e-7, 5.3e-7, 6.6e-7)),
        };
        let body = ImmersedBody::new(hydro.unwrap());
        let constants = BodyConstants::new(&body, &dry, &Fluid::AIR).unwrap();
        let h = 0.01;
        for a in [0.05, 0.1, 0.2_f64] {
            let velocity = Vector3::new(1.0, 0.5, 0.2);
            let spin = Vector3::new(0.6, -0.48, 0.64) * (2.0 * a / h);
            let mut motion = Motion {
                attitude: Quaternion::new(1.0, 0.0, 0.0, 0.0),
                displacement: Vector3::zeros(),
                velocity: Twist {
                    linear: velocity,
                    angular: spin * constants.length,
                },
                rate: Twist::zero(0.0),
                trend: Twist::zero(0.0),
                last: 0.0,
            };
            let asked = Asked(std::cell::Cell::new(None));
            let inertia = &constants.inertia;
            substep::<false, _, _>(inertia, &Whole(&asked), &unloaded(), &mut motion, h, 1);
            let exact = Rotation3::from_scaled_axis(spin * (-0.5 * h)) * velocity;
            let miss = (asked.0.get().unwrap() - exact).norm();
            let across = spin.normalize().cross(&velocity).norm();
            let expected = a.powi(3) / 6.0 * across;
            assert!(
                (miss / expected - 1.0).abs() < 0.01,
                "{a}: {miss} {expected}"
            );
        }
    }

    /// A law that resists along one axis only: the motion along it, or the rotation about it.
    struct Along {
        creeping: Vector3<f64>,
        damping: Vector3<f64>,
    }

    impl Evaluate<f64> for Along {
        fn terms(&self, u: &Vector3<f64>, _w: &Vector3<f64>) -> ViscousTerms<f64> {
            ViscousTerms {
                creeping: self.creeping,
                damping: self.damping,
                ..ViscousTerms::none(u.x)
            }
        }
    }

    /// θ is just so implicit that a stiff decay, here of z = 10 per substep, comes to zero in it and not beyond,
    /// whatever the axis: 1 − z/(1 + θz) = 0 at θ = 1 − 1/z. Slow ones, z = 0.1, are halfway implicit.
    #[test]
    fn decay_does_not_overshoot() {
        let shape = Cuboid::new(Vector::new(0.04, 0.02, 0.001));
        let dry = DryMass {
            mass: 1e-3,
            center: Vector3::zeros(),
            inertia: Matrix3::from_diagonal(&Vector3::new(1.3e-7, 5.3e-7, 6.6e-7)),
        };
        let body = ImmersedBody::new(HydroProperties::from_shape(&shape).unwrap());
        let constants = BodyConstants::new(&body, &dry, &Fluid::WATER).unwrap();
        let inertia = &constants.inertia;
        let h = 0.01;
        for axis in 0..6 {
            for (z, left) in [(10.0, 0.0), (0.1, 1.0 - 0.1 / 1.05)] {
                let mut along = [Vector3::zeros(), Vector3::zeros()];
                let mut start = along;
                let (turns, i) = (axis / 3, axis % 3);
                let mass = [&inertia.m11, &inertia.m22][turns][(i, i)];
                along[turns][i] = z / h * mass;
                start[turns][i] = 1e-3;
                let law = Along {
                    creeping: along[0],
                    damping: along[1],
                };
                let mut motion = Motion {
                    attitude: Quaternion::new(1.0, 0.0, 0.0, 0.0),
                    displacement: Vector3::zeros(),
                    velocity: Twist {
                        linear: start[0],
                        angular: start[1],
                    },
                    rate: Twist::zero(0.0),
                    trend: Twist::zero(0.0),
                    last: 0.0,
                };
                substep::<false, _, _>(inertia, &Whole(&law), &unloaded(), &mut motion, h, 1);
                let end = [motion.velocity.linear, motion.velocity.angular];
                let found = end[turns][i] / 1e-3;
                assert!((found - left).abs() < 1e-9, "{axis} {z}: {found} {left}");
            }
        }
    }

    /// Nothing acts on the body.
    fn unloaded() -> Load<f64> {
        Load {
            force: Vector3::zeros(),
            torque: Vector3::zeros(),
            buoyancy: Vector3::zeros(),
            buoyancy_arm: Vector3::zeros(),
            fluid_spin: Vector3::zeros(),
            stretching: Vector3::zeros(),
            shearing: Vector3::zeros(),
            strain_response: Vector3::zeros(),
            turning: false,
            spinning: false,
            straining: false,
            locks: Locks::none(0.0),
        }
    }

    /// A law that returns NaN.
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
        let load = unloaded();
        let before = motion.velocity;
        advance::<false, _, _>(
            inertia,
            &Whole(&NotANumber),
            &load,
            &mut motion,
            0.01,
            1.0,
            1,
            1,
        );
        assert_eq!(motion.velocity, before);
        assert_eq!(
            (motion.rate, motion.trend),
            (Twist::zero(0.0), Twist::zero(0.0))
        );
        advance::<false, _, _>(
            inertia,
            &Whole(&constants.law),
            &load,
            &mut motion,
            0.01,
            1.0,
            1,
            1,
        );
        assert_ne!(motion.velocity, before);
    }
}
