//! A law of the user's own, as a closure.

use super::frozen_force::of_each;
use super::place::PartPlace;
use crate::error::Error;
use crate::math;
use crate::math::Scalar;
use crate::math::spatial::{Blocks, Twist};
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
                    Vector3::from_fn(|_, _| random.random_range(-1.0..1.0))
                        * math::powf(10f64, size)
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
        of_each(place, v, factor, |u, w| {
            let [force, torque] = (self.law.0)(&PartMotion {
                linear: *u,
                angular: w / self.length,
                density: self.density,
                kinematic_viscosity: self.kinematic_viscosity,
            });
            [force / self.mass, torque / (self.mass * self.length)]
        })
    }
}
