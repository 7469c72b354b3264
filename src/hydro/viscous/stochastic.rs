//! The stochastic method's law: constant drag and lift coefficients (thesis § 4.2.2).

use super::coefficients::{Bounds, Coefficient, coefficients};
use super::terms::{Evaluate, ViscousTerms, safe_inverse};
use super::thesis::pressure_arm;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::math::spatial::norm;
use crate::math::{Scalar, scalar_struct};
use rapier3d::na::Vector3;

coefficients! {
    /// `F = −½ρA|U| (C_d U + C_l U × (N × U)/|N × U|)`, applied at the center of pressure (thesis (4.7));
    /// made for use together with the turbulence of chapter 4.
    ///
    /// The thesis does not say what N is, and gives no numbers and no center of pressure. Ours are N, the
    /// plate normal on the windward side (N·U > 0), and the defaults (the broadside drag of a disc, and a
    /// moderate lift on a quarter of chapter 5's arm); the arm is the one of its chapter 5,
    /// `(1 − sin³α)·a/2` with a the major semi-axis.
    ///
    /// As printed, nothing resists rotation: the thesis's random increments of the spin (4.9) add up without limit, to
    /// a variance of `C₀εt/L²` per axis. By default the drag of the planform resists it, element by element: each has the
    /// force `−½ρC_d|v|v` per area at its own velocity v = u + ω × r, whose moment about an axis in the plate is
    ///
    /// ```text
    /// −½ρC_d ω √(((1 + cos²β) I₂|u|)² + (I₃|ω|)²)        I₂ = ∫d² dA,  I₃ = ∫|d|³ dA,  d from the axis
    /// ```
    ///
    /// where β is the angle between u and the motion of the elements, and the second ω the rotation about both axes in
    /// the plate. It is the integral itself for slow and for fast rotation, and within a tenth of it in between. About
    /// the normal the planform is taken at its radius of gyration, which is a fifth too little for fast rotation.
    /// With [`damping`](Self::damping) = 0 the law is as printed.
    pub struct StochasticLaw {
        /// C_d, constant over the angle of attack.
        drag: 1.17, NotNegative;
        /// C_l, constant over the angle of attack.
        lift: 0.6, Finite;
        /// Center of pressure over that of chapter 5; 0 puts the force at the planform's center.
        arm: 0.25, Finite;
        /// Share of the resistance of rotation that the law's own drag makes, 1 by strip theory; 0 as printed.
        damping: 1.0, NotNegative;
    }
}

impl StochasticLaw {
    pub(crate) fn prepare(
        &self,
        hydro: &HydroProperties,
        fluid: &Fluid,
        mass: f64,
        length: f64,
    ) -> StochasticConstants<f64> {
        let rho = f64::from(fluid.density());
        let plate = &hydro.planform;
        let pressure = 0.5 * rho * self.drag * self.damping / mass;
        let [about_x, about_y]: [f64; 2] = plate.second_moment.into();
        let about_z = about_x + about_y;
        let gyration = (about_z / plate.area).sqrt();
        let third = [
            plate.third_moment.x,
            plate.third_moment.y,
            about_z * gyration,
        ];
        StochasticConstants {
            dynamic_area: 0.5 * rho * plate.area / mass,
            drag: self.drag,
            lift: self.lift,
            arm: self.arm * plate.half_extents.x / length,
            damping_u: Vector3::new(about_x, about_y, about_z) * (pressure / length.powi(2)),
            damping_w: Vector3::from(third) * (pressure / length.powi(3)),
        }
    }
}

scalar_struct! {
    /// What [`StochasticLaw`] needs of one body in one fluid; units as in
    /// [`PhysicalConstants`](super::physical).
    pub(crate) struct StochasticConstants<T> {
        dynamic_area: T,
        drag: T,
        lift: T,
        arm: T,
        /// Resistance of rotation per speed of the body, and per speed of its rotation.
        damping_u: Vector3<T>,
        damping_w: Vector3<T>,
    }
}

impl<T: Scalar> Evaluate<T> for StochasticConstants<T> {
    #[inline(always)]
    fn terms(&self, u: &Vector3<T>, w: &Vector3<T>) -> ViscousTerms<T> {
        let squares = u.component_mul(u);
        let tangential = (squares.x + squares.y).sqrt();
        let speed = norm(u);
        let pressure = self.dynamic_area * speed;
        // −U × (N × U) = (N × U) × U, and |N × U| is the tangential speed. N is ±z; the sign of
        // u_z passes smoothly through zero.
        let windward = u.z * safe_inverse(u.z.abs() + speed.constant(1e-3) * speed);
        let turn = pressure * self.lift * windward * safe_inverse(tangential);
        // Rotation about an axis in the plate moves its elements along the normal; about the normal, those beside the
        // velocity along or against it.
        let per_speed = safe_inverse(speed);
        let by_u = self.damping_u * speed;
        let normal = squares.z * per_speed;
        let (along_x, along_y) = (squares.x * per_speed, squares.y * per_speed);
        let by_u = Vector3::new(
            by_u.x + self.damping_u.x * normal,
            by_u.y + self.damping_u.y * normal,
            by_u.z + self.damping_u.x * along_x + self.damping_u.y * along_y,
        );
        let spin = (w.x * w.x + w.y * w.y).sqrt();
        let by_w = self
            .damping_w
            .component_mul(&Vector3::new(spin, spin, w.z.abs()));
        let squared = by_u.component_mul(&by_u) + by_w.component_mul(&by_w);
        ViscousTerms {
            drag: pressure * self.drag,
            translational_lift: Vector3::new(-u.y * turn, u.x * turn, speed.constant(0.0)),
            arm: pressure_arm(u, self.arm),
            arm_moves: false,
            damping: squared.map(|square| square.sqrt()),
            ..ViscousTerms::none(speed)
        }
    }
}
