//! Viscous forces: drag, translational lift, rotational lift and damping.
//!
//! All laws have one form. The force on the body is
//!
//! ```text
//! f = −(c·1 + S) v + W × v        v = velocity of the pressure point relative to the fluid
//! ```
//!
//! a resistance (`c ≥ 0` from the pressure, `S ≥ 0` from creeping flow) plus a *turning* part that
//! does no work. The integrator evaluates `c`, `S`, `W` and the pressure point once per substep and
//! then solves for the velocity implicitly; because a resistance can only take energy and a
//! turning force none, that is stable at any step size, however wrong the frozen coefficients are.
//!
//! All of it happens in **plate axes**: x along the longest, z along the shortest principal axis of
//! the shape, origin at the body's center of mass.
//!
//! A law is a table of [`coefficients`] and constants that are prepared from it once per body and
//! fluid. This file is the only one that lists them; `CONTRIBUTING.md` shows how to add one.

mod bluff;
pub(crate) mod coefficients;
pub(crate) mod force_factors;
mod inviscid;
mod physical;
mod stochastic;
pub(crate) mod terms;
mod thesis;

pub use coefficients::{Bounds, Coefficient};
pub use force_factors::ForceFactors;
pub use physical::PhysicalLaw;
pub use stochastic::StochasticLaw;
pub use thesis::ThesisLaw;

use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::math::{Lanes, Scalar};
use bluff::{BluffConstants, MixedConstants};
use fearless_simd::Simd;
use inviscid::InviscidConstants;
use physical::PhysicalConstants;
use rapier3d::na::Vector3;
use stochastic::StochasticConstants;
use terms::{Evaluate, ViscousTerms};
use thesis::ThesisConstants;

/// Which law gives the viscous force.
///
/// ```
/// use rapier3d_immersed::{PhysicalLaw, ThesisLaw, ViscousLaw};
///
/// let default = ViscousLaw::default();
/// assert_eq!(default, ViscousLaw::Physical(PhysicalLaw::default()));
/// let flutters = ViscousLaw::Thesis(ThesisLaw::new(ThesisLaw::ZIGZAG));
/// assert!(flutters.check().is_ok());
/// ```
// There is one per description, and most are of the largest variant.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum ViscousLaw {
    /// No viscous force: an ideal fluid, in which the Kirchhoff equations conserve energy and
    /// impulse.
    Inviscid,
    /// The default: calibrated against experiments, passive, right at low Reynolds numbers.
    Physical(PhysicalLaw),
    /// Three components with coefficients that depend on the angle of attack (thesis § 5.3.2).
    Thesis(ThesisLaw),
    /// Constant drag and lift coefficients (thesis § 4.2.2).
    Stochastic(StochasticLaw),
}

impl Default for ViscousLaw {
    fn default() -> Self {
        Self::Physical(PhysicalLaw::default())
    }
}

impl ViscousLaw {
    /// Checks every coefficient.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] names the first that is not finite or out
    /// of its bounds.
    pub fn check(&self) -> Result<(), Error> {
        match self {
            Self::Inviscid => Ok(()),
            Self::Physical(law) => law.check(),
            Self::Thesis(law) => law.check(),
            Self::Stochastic(law) => law.check(),
        }
    }

    /// The coefficients of the law with their names, none in an ideal fluid.
    pub fn coefficients(&self) -> Vec<(&'static str, f64)> {
        fn of<L: Copy>(law: &L, table: &[Coefficient<L>]) -> Vec<(&'static str, f64)> {
            table.iter().map(|row| (row.name, row.of(law))).collect()
        }
        match self {
            Self::Inviscid => Vec::new(),
            Self::Physical(law) => of(law, PhysicalLaw::COEFFICIENTS),
            Self::Thesis(law) => of(law, ThesisLaw::COEFFICIENTS),
            Self::Stochastic(law) => of(law, StochasticLaw::COEFFICIENTS),
        }
    }

    /// How much of the inertial *coupling* of the added mass the law keeps, in [0, 1].
    pub(crate) fn munk_factor(&self, hydro: &HydroProperties) -> f64 {
        match self {
            Self::Physical(law) => law.munk_factor(hydro),
            Self::Inviscid | Self::Thesis(_) | Self::Stochastic(_) => 1.0,
        }
    }

    /// The law's constants for one body in one fluid. `mass` and `length` are the body's scales.
    pub(crate) fn prepare(
        &self,
        hydro: &HydroProperties,
        fluid: &Fluid,
        mass: f64,
        length: f64,
    ) -> PreparedLaw<f64> {
        match self {
            Self::Inviscid => PreparedLaw::Inviscid(InviscidConstants::new()),
            Self::Physical(law) => {
                let plate = law.prepare(hydro, fluid, mass, length);
                match BluffConstants::of(law, hydro, fluid, mass, length) {
                    Some(bluff) => PreparedLaw::Mixed(MixedConstants::new(plate, bluff)),
                    None => PreparedLaw::Plate(plate),
                }
            }
            Self::Thesis(law) => PreparedLaw::Thesis(law.prepare(hydro, fluid, mass, length)),
            Self::Stochastic(law) => {
                PreparedLaw::Stochastic(law.prepare(hydro, fluid, mass, length))
            }
        }
    }
}

/// Defines [`PreparedLaw`] and [`LawKind`] from one list of variants.
macro_rules! prepared_laws {
    ($($(#[$doc:meta])* $variant:ident($constants:ident),)+) => {
        /// A law's constants for one body in one fluid: `f64`, `f32`, or [`Lanes`] of it.
        // There is one per set of equal bodies, and most are of the largest variant: a box would save
        // nothing.
        #[allow(clippy::large_enum_variant)]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) enum PreparedLaw<T> {
            $($(#[$doc])* $variant($constants<T>),)+
        }

        /// Which code evaluates a law: bodies of one kind can be advanced side by side.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) enum LawKind {
            $($variant,)+
        }

        impl LawKind {
            /// All kinds, in the order of their numbers.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)+];
        }

        impl<T> PreparedLaw<T> {
            /// Which code evaluates it.
            pub fn kind(&self) -> LawKind {
                match self {
                    $(Self::$variant(_) => LawKind::$variant,)+
                }
            }
        }

        impl PreparedLaw<f64> {
            /// The nearest constants in f32.
            pub fn rounded(&self) -> PreparedLaw<f32> {
                match self {
                    $(Self::$variant(law) => PreparedLaw::$variant(law.rounded()),)+
                }
            }
        }

        impl PreparedLaw<f32> {
            /// Whether every constant is a finite number.
            pub fn is_finite(&self) -> bool {
                match self {
                    $(Self::$variant(law) => law.is_finite(),)+
                }
            }
        }

        impl<S: Simd> PreparedLaw<Lanes<S>> {
            /// The same constants in every lane.
            #[inline(always)]
            pub fn splat(simd: S, law: &PreparedLaw<f32>) -> Self {
                match law {
                    $(PreparedLaw::$variant(law) => Self::$variant($constants::splat(simd, law)),)+
                }
            }

            /// The constants of one body in each lane. All must be of one kind; where one is not, the
            /// first body's stand in for its own.
            #[inline(always)]
            pub fn gather<'a>(simd: S, of: impl Fn(usize) -> &'a PreparedLaw<f32>) -> Self {
                match of(0) {
                    $(PreparedLaw::$variant(first) => {
                        Self::$variant($constants::gather(simd, |lane| match of(lane) {
                            PreparedLaw::$variant(law) => law,
                            _ => first,
                        }))
                    })+
                }
            }
        }

        impl<T: Scalar> Evaluate<T> for PreparedLaw<T> {
            #[inline(always)]
            fn least_iterations(&self) -> u32 {
                match self {
                    $(Self::$variant(law) => law.least_iterations(),)+
                }
            }

            #[inline(always)]
            fn terms(&self, u: &Vector3<T>, w: &Vector3<T>) -> ViscousTerms<T> {
                match self {
                    $(Self::$variant(law) => law.terms(u, w),)+
                }
            }
        }
    };
}

impl PreparedLaw<f64> {
    /// Whether the law's force acts on a point of the planform whatever the motion.
    pub fn centered(&self) -> bool {
        match self {
            Self::Mixed(law) => law.centered(),
            _ => true,
        }
    }
}

prepared_laws! {
    /// An ideal fluid.
    Inviscid(InviscidConstants),
    /// The default law for a body that is purely a plate to it …
    Plate(PhysicalConstants),
    /// … and for one that is not.
    Mixed(MixedConstants),
    /// The thesis's law of chapter 5.
    Thesis(ThesisConstants),
    /// The thesis's law of chapter 4.
    Stochastic(StochasticConstants),
}
