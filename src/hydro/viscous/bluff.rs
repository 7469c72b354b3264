//! Bodies that are not plates: drag by direction, Magnus force, and damping that is alike about like axes.
//!
//! The force along each plate axis is a resistance of its own,
//!
//! ```text
//! F_i = −½ρ A_i C_i(Re, sign uᵢ) uᵢ √(Σ_j k_ij u_j²),        k_ij = min(1, C_j A_j / C_i A_i)
//! ```
//!
//! with shadow A and drag coefficient C of [`BluffShape`](crate::hydro::BluffShape). Along an axis that is
//! the published coefficient; between axes a cube or a sphere has the same drag area all around (all k = 1),
//! and a long rod feels across what flows across alone (k → 0; the cross-flow principle of Hoerner,
//! *Fluid-Dynamic Drag*, 3-11), so that it drifts along itself when it falls askew. A resistance along each
//! axis can only take energy.
//!
//! The coefficient's course over the Reynolds number Re (on the sphere of the same volume) is that of a sphere,
//! Clift & Gauvin's without Stokes's term, which the creeping resistance has, and what other shapes
//! have more or less comes up with `Re/(Re + 120)`, as a disc's 1.17 does. Past Re = 3–4·10⁵ round shoulders
//! lose nearly four fifths of their drag.
//!
//! The force acts at the pressure point of the direction of motion, `Σ (uᵢ/|u|)² lᵢ(sign uᵢ)`: behind the
//! center of a cone that flies apex first, which keeps it there. In creeping flow it is the center.

use super::physical::{PhysicalConstants, PhysicalLaw};
use super::terms::{Evaluate, ViscousTerms, safe_inverse};
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::hydro::bluff_shape::{BluffShape, SPHERE};
use crate::math;
use crate::math::spatial::{cross, norm};
use crate::math::{Lanes, Scalar, scalar_struct};
use fearless_simd::Simd;
use rapier3d::na::{Matrix3, Vector3};
use std::f64::consts::PI;

/// Lift of a spinning ball by its spin ratio, `S/(2.32 S + 0.4)`: see
/// [`PhysicalLaw::magnus`](super::PhysicalLaw::magnus).
const MAGNUS: (f64, f64) = (2.32, 0.4);
/// Reynolds number at which half of what a shape drags more than a sphere has come: a disc's 1.17 in place of
/// a sphere's 0.78 at Re = 133 (Pitter, Pruppacher & Hamielec 1973).
const EXCESS_ONSET: f64 = 120.0;
/// Reynolds numbers between which a smooth sphere's drag falls, and the share that it loses, from 0.47 to 0.10
/// (Achenbach 1972: 0.46 at 3.0·10⁵, 0.20 at 3.5·10⁵, 0.07–0.10 at 4–8·10⁵).
const CRISIS: (f64, f64, f64) = (3.0e5, 3.9e5, 0.785);
/// Pressure that brakes a rotation, over that of the same motion straight on: of rotation by translation and
/// by itself. A guess: quasi-steady pressure has 2 and 1, plates were fitted with far less and more.
const TURNING: (f64, f64) = (0.5, 1.0);
/// Drag coefficient of the faces of a body that rotates.
const TURNING_DRAG: f64 = 1.1;
/// Skin friction of a rotation by translation: a baseball of 40 m/s loses its spin in 40 s (measured: 30 s).
const FRICTION: f64 = 0.005;

scalar_struct! {
    /// What the law needs of a body that is not purely a plate, besides [`PhysicalConstants`]. Plate axes,
    /// lengths in units of the body's length scale L, everything divided by its mass scale, and by the share of it that is
    /// no plate.
    pub(crate) struct BluffConstants<T> {
        /// Share of the plate's drag; the rest is that of a bluff body.
        plate_share: T,
        /// ½ρA along x, y, z, 1/m.
        shadow: Vector3<T>,
        /// ½ρA(C − 0.45) for motion along the axes and against them, 1/m.
        excess_along: Vector3<T>,
        excess_against: Vector3<T>,
        /// Share of the drag that is lost past the drag crisis.
        crisis_along: Vector3<T>,
        crisis_against: Vector3<T>,
        /// k: rows are the axes of the force, columns those of the motion.
        shares: Matrix3<T>,
        /// From the planform's center to the pressure point, L: one column for each axis of the motion.
        points_along: Matrix3<T>,
        points_against: Matrix3<T>,
        /// Speed × this = Re on the volume's diameter.
        reynolds_scale: T,
        /// ½ρπR³ of the ball whose Magnus force the body has, 1/m, and R, L.
        magnus: T,
        magnus_radius: T,
        /// Damping of the rotation about x, y, z per speed (1/m) and per spin in units of speed (1/m).
        damping_u: Vector3<T>,
        damping_w: Vector3<T>,
    }
}

impl BluffConstants<f64> {
    /// What a body that is not purely a plate has; `None` for plates. `mass` and `length` are its scales.
    pub(super) fn of(
        law: &PhysicalLaw,
        hydro: &HydroProperties,
        fluid: &Fluid,
        mass: f64,
        length: f64,
    ) -> Option<Self> {
        let plate_share = PhysicalLaw::plate_share(hydro);
        (plate_share != 1.0).then(|| Self::new(law, hydro, fluid, plate_share, mass, length))
    }

    fn new(
        law: &PhysicalLaw,
        hydro: &HydroProperties,
        fluid: &Fluid,
        plate_share: f64,
        mass: f64,
        length: f64,
    ) -> Self {
        let rho = f64::from(fluid.density());
        let nu = f64::from(fluid.kinematic_viscosity());
        let [a, b, c]: [f64; 3] = hydro.proxy.semi_axes.into();
        let radius = math::cbrt(a * b * c);
        let unknown = || BluffShape::of_ellipsoid(&hydro.proxy);
        let shape = hydro.bluff.clone().unwrap_or_else(unknown);
        let rest = 1.0 - plate_share;
        // The faces of a slab that is nearly a plate face its edgewise motion like those of a brick: only the
        // broad side's drag is the plate's.
        let edges = hydro.thickness().max(rest);
        let weights = Vector3::new(edges, edges, rest);
        let shadow = shape.shadow.component_mul(&weights) * (0.5 * rho / mass);
        let excess = |side: usize| shape.drag[side].map(|c| c - SPHERE).component_mul(&shadow);
        let crisis = |side: usize| shape.roundness[side] * CRISIS.2;
        let to_plate = hydro.planform.axes.inverse();
        let center = to_plate * (hydro.planform.center - hydro.centroid);
        let points = |side: usize| {
            let columns = shape.pressure_point[side].map(|p| (p - center) * (rest / length));
            // What rounding leaves of a symmetric body's would cost it the shorter way through the step.
            Matrix3::from_columns(&columns).map(|x| if x.abs() < 1e-3 { 0.0 } else { x })
        };
        let pressure = 0.5 * rho * TURNING_DRAG * rest / mass;
        let friction = shape.friction_moment * (0.5 * rho * FRICTION * rest / mass);
        Self {
            plate_share,
            shadow,
            excess_along: excess(0),
            excess_against: excess(1),
            crisis_along: crisis(0),
            crisis_against: crisis(1),
            shares: Matrix3::from_fn(|i, j| if i == j { 1.0 } else { shape.share(i, j) }),
            points_along: points(0),
            points_against: points(1),
            reynolds_scale: 2.0 * radius / nu,
            magnus: law.magnus * rest * 0.5 * rho * PI * radius.powi(3) / (mass * length),
            magnus_radius: radius / length,
            damping_u: (shape.second_moment * (pressure * TURNING.0) + friction) / length.powi(2),
            damping_w: shape.third_moment * (pressure * TURNING.1 / length.powi(3)),
        }
    }

    /// Whether the force acts on the planform's center whatever the motion.
    fn centered(&self) -> bool {
        self.points_along.amax() == 0.0 && self.points_against.amax() == 0.0
    }
}

/// A body that is partly a plate, or not at all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MixedConstants<T> {
    plate: PhysicalConstants<T>,
    bluff: BluffConstants<T>,
}

impl MixedConstants<f64> {
    pub fn new(plate: PhysicalConstants<f64>, bluff: BluffConstants<f64>) -> Self {
        Self { plate, bluff }
    }

    /// Whether the force acts on the planform's center whatever the motion.
    pub fn centered(&self) -> bool {
        self.bluff.centered()
    }

    /// The nearest constants in f32.
    pub fn rounded(&self) -> MixedConstants<f32> {
        MixedConstants {
            plate: self.plate.rounded(),
            bluff: self.bluff.rounded(),
        }
    }
}

impl MixedConstants<f32> {
    /// Whether every constant is a finite number.
    pub fn is_finite(&self) -> bool {
        self.plate.is_finite() && self.bluff.is_finite()
    }
}

impl<S: Simd> MixedConstants<Lanes<S>> {
    /// The same constants in every lane.
    #[inline(always)]
    pub fn splat(simd: S, constants: &MixedConstants<f32>) -> Self {
        Self {
            plate: PhysicalConstants::splat(simd, &constants.plate),
            bluff: BluffConstants::splat(simd, &constants.bluff),
        }
    }

    /// The constants of one body in each lane.
    #[inline(always)]
    pub fn gather<'a>(simd: S, of: impl Fn(usize) -> &'a MixedConstants<f32>) -> Self {
        Self {
            plate: PhysicalConstants::gather(simd, |lane| &of(lane).plate),
            bluff: BluffConstants::gather(simd, |lane| &of(lane).bluff),
        }
    }
}

impl<T: Scalar> Evaluate<T> for MixedConstants<T> {
    #[inline(always)]
    fn terms(&self, u: &Vector3<T>, w: &Vector3<T>) -> ViscousTerms<T> {
        let mut terms = self.plate.terms(u, w);
        terms.drag *= self.bluff.plate_share;
        self.bluff.add_to(&mut terms, u, w);
        terms
    }
}

impl<T: Scalar> BluffConstants<T> {
    #[inline(always)]
    fn add_to(&self, terms: &mut ViscousTerms<T>, u: &Vector3<T>, w: &Vector3<T>) {
        let constant = |value| u.x.constant(value);
        let (zero, one) = (constant(0.0), constant(1.0));
        let squares = u.component_mul(u);
        let speed2 = squares.x + squares.y + squares.z;
        let speed = speed2.sqrt();
        let re = speed * self.reynolds_scale;

        let log_re = re.max(constant(1e-3)).ln();
        let sphere = constant(3.6) * (log_re * constant(-0.313)).exp()
            + constant(0.42) / (one + constant(42500.0) * (log_re * constant(-1.16)).exp());
        let onset = re / (re + constant(EXCESS_ONSET));
        let lost = if (constant(CRISIS.0) - re).all_ge(0.0) {
            zero
        } else {
            let t = (re - constant(CRISIS.0)) * constant(1.0 / (CRISIS.1 - CRISIS.0));
            let t = t.max(zero).min(one);
            t * t * (constant(3.0) - t - t)
        };
        let by_sign = |i: usize, along: &Vector3<T>, against: &Vector3<T>| {
            against[i].select_lt(u[i], zero, along[i])
        };
        let resistance = |i: usize| {
            let excess = by_sign(i, &self.excess_along, &self.excess_against);
            let crisis = by_sign(i, &self.crisis_along, &self.crisis_against);
            let k = &self.shares;
            let felt = k[(i, 0)] * squares.x + k[(i, 1)] * squares.y + k[(i, 2)] * squares.z;
            (self.shadow[i] * sphere + excess * onset) * (one - crisis * lost) * felt.sqrt()
        };
        terms.creeping += Vector3::new(resistance(0), resistance(1), resistance(2));

        let per_speed2 = safe_inverse(speed2);
        for i in 0..3 {
            // Creeping flow presses on the center.
            let share = squares[i] * per_speed2 * onset;
            let point = |row: usize| {
                let (along, against) = (self.points_along[(row, i)], self.points_against[(row, i)]);
                against.select_lt(u[i], zero, along) * share
            };
            terms.offset += Vector3::new(point(0), point(1), point(2));
        }

        // ½ρπR²u² C_L(S) along ω × u.
        let across = norm(&cross(w, u)) * self.magnus_radius;
        let per = constant(MAGNUS.0) * across + constant(MAGNUS.1) * speed2;
        terms.rotational_lift += w * (self.magnus * speed2 * safe_inverse(per));

        let by_spin = self.damping_w.component_mul(&w.map(|w| w.abs()));
        terms.damping += self.damping_u * speed + by_spin;
    }
}
