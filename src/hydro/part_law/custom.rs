//! A law of the user's own, as a closure.

use super::place::{PartPlace, moved, velocity_at};
use crate::error::Error;
use crate::math::Scalar;
use crate::math::spatial::{Blocks, Twist, Wrench, dot, matrix};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;
use rapier3d::na::Vector3;
use std::fmt::{Debug, Formatter};
use std::sync::Arc;

/// How a part moves through the fluid, for a [`CustomLaw`]. Axes and origin are those of the part's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartMotion {
    /// Velocity of the frame's origin relative to the fluid, m/s.
    pub linear: Vector3<f64>,
    /// Angular velocity relative to the fluid, rad/s.
    pub angular: Vector3<f64>,
    /// Density of the fluid, kg/m³.
    pub density: f64,
    /// Its kinematic viscosity, m²/s.
    pub kinematic_viscosity: f64,
}

type Force = dyn Fn(&PartMotion) -> [Vector3<f64>; 2] + Send + Sync;

/// A law of one's own: force, N, and torque about the part's origin, N·m, of a motion.
///
/// It is asked in every substep, body by body: it costs what the call costs. What it answers is frozen over the
/// substep as a resistance and a turning that together give just this force at this velocity, so that the
/// step stays stable at any size; what of the force would give energy to the motion (positive power) is left out.
/// So nothing is driven by it: engines are [`Thruster`](crate::Thruster)s.
///
/// ```
/// use rapier3d_immersed::CustomLaw;
/// use rapier3d_immersed::rapier3d::na::Vector3;
///
/// let drogue = CustomLaw::new(|m| {
///     let drag = m.linear * (-0.5 * m.density * 0.02 * m.linear.norm());
///     [drag, Vector3::zeros()]
/// })?;
/// // A law that pushes forward along the motion gives energy, and is refused.
/// let pump = CustomLaw::new(|m| [m.linear, Vector3::zeros()]);
/// assert!(pump.unwrap_err().to_string().contains("power"));
/// # drop(drogue);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone)]
pub struct CustomLaw(Arc<Force>);

impl CustomLaw {
    /// A law that takes energy at every motion that is tried: some thousand, from creeping to fast, in air and in
    /// water.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] names the power, relative to force times speed, of the worst of those motions if the law
    /// gives energy there, or NaN if it gives no number.
    pub fn new(
        force: impl Fn(&PartMotion) -> [Vector3<f64>; 2] + Send + Sync + 'static,
    ) -> Result<Self, Error> {
        let law = Self::projected(force);
        let worst = law.greatest_power();
        let passive = worst <= 1e-9;
        Error::check("power of a custom law", worst, passive, "not positive")?;
        Ok(law)
    }

    /// Any law: what of it gives energy is left out, without a word.
    pub fn projected(
        force: impl Fn(&PartMotion) -> [Vector3<f64>; 2] + Send + Sync + 'static,
    ) -> Self {
        Self(Arc::new(force))
    }

    /// The greatest power over the motions that are tried, in units of |F||u| + |T||ω|; negative if all take
    /// energy, NaN where it is no number.
    pub fn greatest_power(&self) -> f64 {
        let mut random = Pcg32::seed_from_u64(1);
        let mut greatest = f64::NEG_INFINITY;
        for (density, kinematic_viscosity) in [(1.2, 1.5e-5), (1000.0, 1e-6)] {
            for _ in 0..1000 {
                let mut vector = || {
                    let size = random.random_range(-3.0..2.0_f64);
                    Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)) * 10f64.powf(size)
                };
                let motion = PartMotion {
                    linear: vector(),
                    angular: vector(),
                    density,
                    kinematic_viscosity,
                };
                let [force, torque] = (self.0)(&motion);
                let power = force.dot(&motion.linear) + torque.dot(&motion.angular);
                let size =
                    force.norm() * motion.linear.norm() + torque.norm() * motion.angular.norm();
                let relative = if size == 0.0 { 0.0 } else { power / size };
                if relative.is_nan() {
                    return f64::NAN;
                }
                greatest = greatest.max(relative);
            }
        }
        greatest
    }
}

impl Debug for CustomLaw {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str("CustomLaw")
    }
}

/// Whether both are clones of one.
impl PartialEq for CustomLaw {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// What a step needs of a [`CustomLaw`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PreparedCustom {
    law: CustomLaw,
    density: f64,
    kinematic_viscosity: f64,
    mass: f64,
    length: f64,
}

/// Square of the speed, m²/s², below which what of a custom law's force is across the motion fades.
const LEAST_SPEED2: f64 = 1e-12;
/// The same below which a resistance does; its square is still a number of single precision.
const TINY: f64 = 1e-18;
/// Rate, 1/s, at which what is across a motion turns it at most: a force on a body at rest (a cambered wing's, say) fades
/// below a speed of force over mass over this. Faster turning would be lost in rounding.
const FASTEST: f64 = 1e4;

impl PreparedCustom {
    pub fn new(
        law: &CustomLaw,
        density: f64,
        kinematic_viscosity: f64,
        mass: f64,
        length: f64,
    ) -> Self {
        Self {
            law: law.clone(),
            density,
            kinematic_viscosity,
            mass,
            length,
        }
    }

    #[inline(always)]
    pub fn matrix<T: Scalar>(&self, place: &PartPlace<T>, v: &Twist<T>, factor: T) -> Blocks<T> {
        let u = place.back(&velocity_at(v, &place.position));
        let w = place.back(&v.angular);
        let [fx, fy, fz, tx, ty, tz] = T::by_lane([u.x, u.y, u.z, w.x, w.y, w.z], |v| {
            let [force, torque] = (self.law.0)(&PartMotion {
                linear: Vector3::new(v[0], v[1], v[2]),
                angular: Vector3::new(v[3], v[4], v[5]) / self.length,
                density: self.density,
                kinematic_viscosity: self.kinematic_viscosity,
            });
            let (force, torque) = (force / self.mass, torque / (self.mass * self.length));
            let all = [force.x, force.y, force.z, torque.x, torque.y, torque.z];
            // What is no number is no force.
            if all.iter().all(|x| x.is_finite()) {
                all
            } else {
                [0.0; 6]
            }
        });
        let own = Twist {
            linear: place.out(&u),
            angular: place.out(&w),
        };
        let force = Wrench {
            force: place.out(&Vector3::new(fx, fy, fz)) * factor,
            torque: place.out(&Vector3::new(tx, ty, tz)) * factor,
        };
        moved(&of_force(&force, &own), &place.position)
    }
}

/// A force and torque on a part at a velocity ν, as a matrix that gives them at that velocity and takes no more
/// energy than they do: what is along u or w and against it is a resistance there; what is across is the skew
/// `(F νᵀ − ν Fᵀ)/|ν|²`. Where only force and torque together take energy, `(F·ν) ν νᵀ/|ν|⁴` is their resistance, and what gives
/// energy (F·ν > 0) is left out.
#[inline(always)]
fn of_force<T: Scalar>(force: &Wrench<T>, v: &Twist<T>) -> Blocks<T> {
    let (u, w) = (&v.linear, &v.angular);
    let (zero, one) = (u.x.constant(0.0), u.x.constant(1.0));
    let least = zero.constant(LEAST_SPEED2);
    let (u2, w2) = (dot(u, u), dot(w, w));
    let (by_u, by_w) = (dot(&force.force, u), dot(&force.torque, w));
    // Both take energy by themselves, or nothing is along either.
    let both = by_u.max(by_w);
    let apart = |power: T| zero.select_lt(zero, both, power);
    let tiny = zero.constant(TINY);
    let resist = |power: T, size2: T| apart(power) / size2.max(tiny) / size2.max(tiny);
    let (along_u, along_w) = (resist(by_u, u2), resist(by_w, w2));
    let across = Wrench {
        force: force.force - u * (along_u * u2),
        torque: force.torque - w * (along_w * w2),
    };
    let size2 = u2 + w2;
    let strength = (dot(&across.force, &across.force) + dot(&across.torque, &across.torque)).sqrt();
    let slow = strength * size2.sqrt() * zero.constant(1.0 / FASTEST);
    let per = one / size2.max(slow).max(least);
    let together = (by_u + by_w).min(zero).select_lt(zero, both, zero) * per * per;
    let block = |f: &Vector3<T>, a: &Vector3<T>, g: &Vector3<T>, b: &Vector3<T>, along: T| {
        let e = |i: usize, j: usize| (f[i] * b[j] - a[i] * g[j]) * per + a[i] * b[j] * along;
        matrix(e)
    };
    let (f, t) = (&across.force, &across.torque);
    Blocks {
        m11: block(f, u, f, u, along_u + together),
        m12: block(f, u, t, w, together),
        m21: block(t, w, f, u, together),
        m22: block(t, w, t, w, along_w + together),
    }
}
