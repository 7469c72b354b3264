//! The thesis's law: three components with instantaneous coefficients (§ 5.3.2).

use super::coefficients::{Bounds, Coefficient, coefficients};
use super::physical::PhysicalLaw;
use super::terms::{Evaluate, ViscousTerms, safe_inverse};
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::math::spatial::{cross, norm};
use crate::math::{Scalar, scalar_struct};
use rapier3d::na::Vector3;
use std::f64::consts::PI;

coefficients! {
    /// Drag, rotational lift and translational lift with coefficients that follow the angle of attack,
    /// `(C_D sin²α, C_L1 sin 2α, C_L2 cos 2α)`, along û, ω × u and (ω × u) × u (thesis (5.15)–(5.17)).
    ///
    /// The control parameters C̃ are meant to be varied: chapter 5 of the thesis trains motion patterns
    /// over them. As printed the law is undefined where ω ∥ u, and it pumps energy into light bodies (a
    /// card of 300 kg/m³ spins up past 1000 rad/s); the two constructors differ in what they do about
    /// that. The default is [`ThesisLaw::new`] with [`ThesisLaw::ZIGZAG`].
    pub struct ThesisLaw {
        /// C_D: drag coefficient broadside on.
        drag: 0.31, NotNegative;
        /// C_L1: amplitude of the lift along ω × u.
        rotational_lift: 0.91, Finite;
        /// C_L2: amplitude of the lift along (ω × u) × u.
        translational_lift: 0.61, Finite;
        /// κ: the unit vector of ω × u is regularised to `ω × u / (|ω × u| + κ |u|²/L)`, with L the
        /// major semi-axis, so that the lifts fade where the body hardly turns.
        regularisation: 0.02, NotNegative;
        /// Share of a plate's rotational damping, that of the default law with k₁ = 0.0827 and k₂ = 3.41; at
        /// least 0.
        damping: 0.3, NotNegative;
    }
}

/// k₁ and k₂ of the rotational damping, of which the law takes a share: an earlier calibration of the
/// default law, with which this crate's figures of the thesis were made.
const DAMPING: [f64; 2] = [0.0827, 3.41];

impl ThesisLaw {
    /// The law for use: regularised and damped. C̃ = (C_D, C_L1, C_L2).
    pub fn new([drag, rotational_lift, translational_lift]: [f64; 3]) -> Self {
        Self {
            drag,
            rotational_lift,
            translational_lift,
            ..Self::default()
        }
    }

    /// The law as printed, for comparison with the thesis: regularised by 10⁻⁹ only, undamped.
    /// **It can blow up**: the body then keeps its velocity and attitude for a step rather than
    /// take on a NaN.
    pub fn printed(coefficients: [f64; 3]) -> Self {
        Self {
            regularisation: 1e-9,
            damping: 0.0,
            ..Self::new(coefficients)
        }
    }

    /// Steady descent of the card of thesis Fig. 5.6a, for [`ThesisLaw::printed`]: the direct classifier sees it
    /// on [`Experiment::thesis_card`](crate::training::Experiment::thesis_card) in each of 21 releases from 9°
    /// to 11°, in falls of 3 s.
    pub const STEADY_DESCENT: [f64; 3] = [1.81, 0.31, 0.31];
    /// Zigzag of the card of thesis Fig. 5.6c, for [`ThesisLaw::printed`]: seen in 21 of 21 releases, as a spiral,
    /// which the thesis counts as a zigzag.
    pub const ZIGZAG: [f64; 3] = [0.31, 0.91, 0.61];
    /// Autorotation with zigzag (chaotic) of the card of thesis Fig. 5.6b, for [`ThesisLaw::printed`]: seen in
    /// 21 of 21 releases.
    pub const AUTOROTATION_ZIGZAG: [f64; 3] = [0.61, 1.81, 1.21];
    /// Autorotation (tumbling) of the card of thesis Fig. 5.6d, for [`ThesisLaw::printed`]: seen in 12 of 21
    /// releases, that of 10° among them; 8 of the others are chaotic.
    pub const AUTOROTATION: [f64; 3] = [0.61, 2.71, 0.91];
    /// Steady descent of the same card under [`ThesisLaw::new`], which is damped; printed for it:
    /// [`ThesisLaw::STEADY_DESCENT`], here the same. Seen in 21 of 21 releases.
    pub const DAMPED_STEADY_DESCENT: [f64; 3] = Self::STEADY_DESCENT;
    /// Zigzag of the same card under [`ThesisLaw::new`]. With the printed (0.31, 0.91, 0.61) it comes to rest
    /// broadside on; this is the nearest point of the grid 0.01 + 0.3 k, from which the printed ones are, that
    /// shows it in 21 of 21 releases.
    pub const DAMPED_ZIGZAG: [f64; 3] = [0.31, 0.91, 0.91];
    /// Autorotation with zigzag of the same card under [`ThesisLaw::new`]; with the printed (0.61, 1.81, 1.21)
    /// it spirals. Found as [`ThesisLaw::DAMPED_ZIGZAG`]; seen in 21 of 21 releases.
    ///
    /// For autorotation there is none: of 140 points around the printed (0.61, 2.71, 0.91), with drag to 1.21 and
    /// lifts to 5 and 0.91, none makes the card tumble on (six half turns in 2 s) in more than one of three
    /// releases. Take the law as printed, or the default law.
    pub const DAMPED_AUTOROTATION_ZIGZAG: [f64; 3] = [0.61, 3.01, 1.21];
    /// Fit to the data of Ju et al. 2013 on flapping flight (thesis Fig. 5.4, data 1).
    pub const FIG_5_4_DATA_1: [f64; 3] = [0.26, 2.98, 0.59];
    /// Fit to the data of Wu & Popović 2003 on bird flight (thesis Fig. 5.4, data 2).
    pub const FIG_5_4_DATA_2: [f64; 3] = [2.0, 1.02, 0.70];
    /// Fit to the data of Okamoto, Fujisawa & Miura 2009 on Japanese kites (thesis Fig. 5.4, data 3).
    pub const FIG_5_4_DATA_3: [f64; 3] = [2.70, 1.31, 0.0];
    /// Andersen, Pesavento & Wang 2005, middle of the ranges of thesis Table 5.1.
    pub const ANDERSEN_2005: [f64; 3] = [1.82, 1.0, 1.25];
    /// Paoletti & Mahadevan 2011 (thesis Table 5.1).
    pub const PAOLETTI_2011: [f64; 3] = [0.4, 1.2, PI];
    /// Varshney, Chang & Wang 2013 (thesis Table 5.1).
    pub const VARSHNEY_2013: [f64; 3] = [1.06, 0.92, 0.32];
    /// Huang et al. 2013 (thesis Table 5.1), in the table's columns as printed. A public program after that
    /// paper has 4.5 as its coefficient of translational lift and 1.8 as that of rotational lift: the table
    /// seems to name the two lifts the other way round than (5.15) does.
    pub const HUANG_2013: [f64; 3] = [0.3, 4.5, 1.8];
    /// Hu & Wang 2014, middle of the ranges of thesis Table 5.1.
    pub const HU_2014: [f64; 3] = [1.9, PI, PI / 2.0];

    pub(crate) fn prepare(
        &self,
        hydro: &HydroProperties,
        fluid: &Fluid,
        mass: f64,
        length: f64,
    ) -> ThesisConstants<f64> {
        let rho = f64::from(fluid.density());
        let default = PhysicalLaw::default().prepare(hydro, fluid, mass, length);
        let major = hydro.planform.half_extents.x / length;
        ThesisConstants {
            dynamic_area: 0.5 * rho * hydro.planform.area / mass,
            drag: self.drag,
            rotational_lift: self.rotational_lift,
            translational_lift: self.translational_lift,
            // |ω × u| is compared in units of speed², hence the division by the major semi-axis.
            regularisation: self.regularisation / major,
            major,
            damping_u: default.damping_u * (self.damping * DAMPING[0]),
            damping_w: default.damping_w * (self.damping * DAMPING[1]),
            creeping_spin: default.creeping_spin * self.damping,
        }
    }
}

scalar_struct! {
    /// What [`ThesisLaw`] needs of one body in one fluid; units as in
    /// [`PhysicalConstants`](super::physical).
    pub(crate) struct ThesisConstants<T> {
        dynamic_area: T,
        drag: T,
        rotational_lift: T,
        translational_lift: T,
        regularisation: T,
        /// Major semi-axis, in L.
        major: T,
        damping_u: Vector3<T>,
        damping_w: Vector3<T>,
        creeping_spin: Vector3<T>,
    }
}

/// Torque arm of the thesis's laws, `(1 − sin³α)·a/2` for the semi-axis `a` (thesis, text after (5.18):
/// `(1 − sin³α)·a/4` for the whole axis, a quarter of it in ideal flow). That it points along the in-plane
/// velocity is ours: the thesis gives its length only.
#[inline(always)]
pub(super) fn pressure_arm<T: Scalar>(u: &Vector3<T>, semi_axis: T) -> Vector3<T> {
    let tangential = (u.x * u.x + u.y * u.y).sqrt();
    let speed = norm(u);
    let sine = u.z.abs() * safe_inverse(speed);
    let length = (sine.constant(1.0) - sine * sine * sine) * semi_axis * sine.constant(0.5);
    let per_speed = length * safe_inverse(tangential);
    Vector3::new(u.x * per_speed, u.y * per_speed, u.z.constant(0.0))
}

impl<T: Scalar> Evaluate<T> for ThesisConstants<T> {
    #[inline(always)]
    fn terms(&self, u: &Vector3<T>, w: &Vector3<T>) -> ViscousTerms<T> {
        let tangential2 = u.x * u.x + u.y * u.y;
        let speed2 = tangential2 + u.z * u.z;
        let speed = speed2.sqrt();
        let per_speed2 = safe_inverse(speed2);
        let sine2 = u.z * u.z * per_speed2;
        let sine_double = speed.constant(2.0) * u.z.abs() * tangential2.sqrt() * per_speed2;
        let cosine_double = (tangential2 - u.z * u.z) * per_speed2;

        let turning = cross(w, u);
        let size = norm(&turning);
        let per_turning = safe_inverse(size + self.regularisation * speed2);
        // ê2 = (ω × u)/|…| and ê3 = ((ω × u) × u)/|…| are W × u with W along ω and ω × u.
        let rotational =
            self.dynamic_area * speed2 * self.rotational_lift * sine_double * per_turning;
        let translational =
            self.dynamic_area * speed * self.translational_lift * cosine_double * per_turning;

        let spin = (w.x * w.x + w.y * w.y).sqrt();
        let spin_z = w.z.abs();
        ViscousTerms {
            drag: self.dynamic_area * speed * self.drag * sine2,
            creeping: Vector3::repeat(speed.constant(0.0)),
            translational_lift: turning * translational,
            rotational_lift: w * rotational,
            arm: pressure_arm(u, self.major),
            offset: Vector3::repeat(speed.constant(0.0)),
            arm_moves: false,
            damping: Vector3::new(
                self.damping_u.x * speed + self.damping_w.x * spin + self.creeping_spin.x,
                self.damping_u.y * speed + self.damping_w.y * spin + self.creeping_spin.y,
                self.damping_u.z * speed + self.damping_w.z * spin_z + self.creeping_spin.z,
            ),
        }
    }
}
