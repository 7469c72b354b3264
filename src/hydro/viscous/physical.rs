//! The default law: physical, passive, calibrated against experiments.

use super::coefficients::{Bounds, Coefficient, coefficients};
use super::terms::{Evaluate, ViscousTerms, safe_inverse};
use crate::fluid::Fluid;
use crate::geometry::Ellipsoid;
use crate::hydro::properties::THIN;
use crate::hydro::{HydroProperties, StokesResistance};
use crate::math::{Scalar, scalar_struct};
use rapier3d::na::Vector3;
use std::f64::consts::PI;

coefficients! {
    /// Coefficients of the default viscous law, dimensionless. One set serves every thin body: plates
    /// in water, paper in air, discs of any Reynolds number.
    ///
    /// With n the plate normal, `c` the chord along the motion, `A` the planform area, `AR` the aspect
    /// ratio span²/A, `Re = |u|c/ν`, and the angle of attack `s = sin α = |u·n|/|u|`, the flow is
    /// attached to the share `f = 1/(1 + exp(2(s − s₀)/δ))`, and separated otherwise. All forces use the
    /// velocity relative to the fluid **v** at the center of pressure `p = χ f c u_t/|u|`:
    ///
    /// * drag `−½ρA|v| (C_D0 + C_N sin²α + C_Di) v`: skin friction and edges in `C_D0`; in `C_N` the
    ///   broadside value C_D90 − C_D0 from the measured disc curve, which passes to Stokes as Re → 0, and
    ///   where the flow is attached the suction that a sharp leading edge loses, `2 k_s C_attached`
    ///   (at `k_s` = 1 the force is normal to the plate);
    /// * induced drag `C_Di = k_i C_L²/(π AR)` (linear for C_L ≫ 3) with the lift coefficient C_L of both lifts together, as
    ///   of a finite wing (Prandtl 1918): it is what makes a tumbling disc drift so much less than a
    ///   tumbling strip;
    /// * translational lift `½ρA C_T sin 2α |v|²` ⟂ v, `C_T` from attached (f) to separated flow, each
    ///   reduced by its aspect ratio, absent below the onset of the wake (Re ≈ 100);
    /// * rotational lift `ρAc C_R (1 − ε sin²α) ω_t × v`;
    /// * damping of the rotation by the pressure on the two halves of the plate and by friction;
    /// * the Munk moment of the added mass weakened to `munk`, because separated flow does not recover
    ///   the pressure that makes it; what of the added mass is the same in all directions, and makes no
    ///   moment, is left as it is, and so are bodies that are as thick as wide.
    ///
    /// No term can add energy to body and fluid: drag opposes v, the lifts are perpendicular to it, and
    /// the torque is that of the same force at the same point.
    ///
    /// The numbers come from a global search against falling plates in water (Andersen, Pesavento &
    /// Wang 2005), the regime map of discs (Field et al. 1997) and falling paper (Howison et al. 2020):
    /// [`training::fidelity`](crate::training::fidelity), example `calibrate`. What they reach is in
    /// the table of the example `validation`.
    ///
    /// **It is no wing's law**: what was fitted falls and turns. A plate that is held in a steady stream (sections
    /// `polars` and `gliders` of that example) has 1.5 to 2.1 times the lift slope of Helmbold (1942), 1.5 in two
    /// dimensions and 2.1 at aspect ratio 1; at aspect ratio 6 it stalls at 41° instead of 12° to 15°, with a lift
    /// coefficient of 3.0 instead of 0.8; its center of pressure at 5° is 0.42 chords behind the leading edge instead
    /// of 0.17 to 0.25; stalled, it pushes itself along with 20 to 52 % of the normal force, where a real one is
    /// pressed along its normal alone; and no weighted card glides.
    ///
    /// Bodies that are not plates blend, by thickness, into bluff bodies with drag coefficients from their own
    /// geometry ([`BluffShape`](crate::BluffShape)), with a Magnus force instead of the plate's lifts.
    pub struct PhysicalLaw {
        /// χ: travel of the center of pressure toward the leading edge in attached flow, in chords.
        pressure_travel: 0.0962, NotNegative, search 0.0 to 0.3;
        /// C_attached: lift slope of attached flow, before the aspect ratio's `AR/(AR + λ₁)`.
        attached_lift: 5.12, NotNegative, search 1.5 to 7.0;
        /// λ₁.
        attached_aspect: 2.06, NotNegative, search 0.3 to 6.0;
        /// C_stalled: lift coefficient of separated flow, before `AR/(AR + λ₂)`.
        stalled_lift: 2.0, NotNegative, search 0.2 to 3.0;
        /// λ₂.
        stalled_aspect: 1.1, NotNegative, search 0.0 to 6.0;
        /// s₀: sine of the angle of attack at which the flow stalls.
        stall_sine: 0.835, NotNegative, search 0.2 to 1.5;
        /// δ: width of the stall in sin α.
        stall_width: 0.812, Positive, search 0.05 to 1.2;
        /// C_R: rotational lift, before `AR/(AR + λ_R)`.
        rotational_lift: 1.89, NotNegative, search 0.2 to 4.0;
        /// λ_R.
        rotational_aspect: 6.55, NotNegative, search 0.0 to 12.0;
        /// ε: loss of rotational lift broadside on.
        rotational_stall: 0.176, Unit, search 0.0 to 1.0;
        /// k_M ∈ [0, 1]: share of the added mass's inertial coupling (Munk moment) that plates feel.
        munk: 0.0345, Unit, search 0.0 to 1.0;
        /// k₁: damping of rotation by translation.
        translation_damping: 0.0827, NotNegative, search 0.0 to 1.5;
        /// k₂: damping of rotation by rotation.
        rotation_damping: 3.41, NotNegative, search 0.0 to 10.0;
        /// k_f: skin friction, `k_f Re^−½`.
        friction: 2.46, NotNegative, search 1.0 to 9.0;
        /// k_e: pressure drag of the edges, per thickness over chord.
        edge_drag: 0.0, NotNegative, search 0.0 to 2.0;
        /// Re_L: onset of the wake's lift, `1/(1 + (Re_L/Re)⁷)`.
        lift_onset: 119.0, NotNegative, search 50.0 to 140.0;
        /// Re_D: below it rotation is damped more, `1 + (Re_D/Re)^1.5`.
        damping_onset: 52.9, NotNegative, search 0.0 to 60.0;
        /// k_s: share of the leading edge's suction that attached flow loses: at 1 its force is normal to
        /// the plate.
        suction_loss: 0.877, NotNegative, search 0.0 to 1.3;
        /// k_i: induced drag, in units of the elliptic wing's.
        induced_drag: 1.54, NotNegative, search 0.0 to 3.0;
        /// Lift of spinning bodies that are not plates, the Magnus force, in units of that of a ball:
        /// `C_L = S/(2.32 S + 0.4)` on the shadow of the sphere of the same volume, of radius R, with the
        /// spin ratio `S = R|ω × û|/|u|`. Fitted to baseballs (Nathan, *Am. J. Phys.* 76, 119 (2008): S from
        /// 0.09 to 0.6, Re 1–2·10⁵); its slope 2.5 at small S is not far from creeping flow's 2 (Rubinow &
        /// Keller 1961). Smooth balls near their drag crisis may be deflected the other way.
        magnus: 1.0, NotNegative;
    }
}

scalar_struct! {
    /// What [`PhysicalLaw`] needs of one body in one fluid. Plate axes, lengths in units of the
    /// body's length scale L, everything divided by its mass scale.
    pub(crate) struct PhysicalConstants<T> {
        /// ½ρA, 1/m.
        dynamic_area: T,
        /// Squared half extent of the planform along x, L².
        extent_x2: T,
        /// Squared half extent of the planform along y, L².
        extent_y2: T,
        /// Product of the two half extents, L².
        extent_product: T,
        /// Planform area, L².
        area: T,
        /// Speed × chord × this = Re.
        reynolds_scale: T,
        broadside_plateau: T,
        broadside_mid: T,
        friction: T,
        edge_drag: T,
        /// Creeping resistance along x, y, z, 1/s.
        creeping: Vector3<T>,
        attached_lift: T,
        attached_aspect: T,
        stalled_lift: T,
        stalled_aspect: T,
        stall_sine: T,
        stall_rate: T,
        rotational_lift: T,
        rotational_aspect: T,
        rotational_stall: T,
        lift_onset: T,
        damping_onset: T,
        pressure_travel: T,
        attached_drag: T,
        induced_drag: T,
        /// Damping of the rotation about x, y, z by the pressure, per speed (1/m) …
        damping_u: Vector3<T>,
        /// … and per spin in units of speed (1/m).
        damping_w: Vector3<T>,
        spin_friction: T,
        /// Creeping resistance to rotation about x, y, z, 1/s.
        creeping_spin: Vector3<T>,
    }
}

/// Exponent and factor of the disc's drag between creeping flow and its plateau:
/// `C_D = (64/πRe)(1 + 0.138 Re^0.792)` for Re < 133 (Pitter, Pruppacher & Hamielec 1973), of which
/// the first term is Stokes's and is part of the creeping resistance.
const DISC_MID: (f64, f64) = (64.0 / PI * 0.138, 0.792 - 1.0);
/// Reynolds number above which the mid range has long passed below the plateau (69 % of it).
const MID_ENDS: f64 = 400.0;
/// Broadside drag coefficient of a disc above Re ≈ 10³ (Hoerner, *Fluid-Dynamic Drag*).
const DISC_PLATEAU: f64 = 1.17;

/// Broadside drag coefficient of a rectangle by its slenderness b/a ≥ 1, linear in a/b between the
/// tabulated 1, 5, 10, ∞ (DNV-RP-C205, appendix E); for a plate that is rounder than a rectangle,
/// `fill` (planform over its box: π/4 for ellipses) leads over to the disc.
fn broadside_drag(slenderness: f64, fill: f64) -> f64 {
    const TABLE: [(f64, f64); 4] = [(0.0, 1.90), (0.1, 1.50), (0.2, 1.20), (1.0, 1.16)];
    let x = (1.0 / slenderness).clamp(0.0, 1.0);
    let rectangle = TABLE.windows(2).find(|w| x <= w[1].0).map_or(1.16, |w| {
        w[0].1 + (w[1].1 - w[0].1) * (x - w[0].0) / (w[1].0 - w[0].0)
    });
    let roundness = ((1.0 - fill) / (1.0 - PI / 4.0)).clamp(0.0, 1.0);
    rectangle + roundness * (DISC_PLATEAU - 1.16)
}

/// 1 for thin, 0 for as thick as wide: C¹ between the ratios ¼ and 1, so that every plate of the
/// calibration (thinner than 1/7) is purely a plate.
fn thinness(ratio: f64) -> f64 {
    let t = ((ratio - 0.25) / 0.75).clamp(0.0, 1.0);
    1.0 - t * t * (3.0 - 2.0 * t)
}

/// Resistance in creeping flow, along the planform's axes: that of the proxy for ellipsoids and plates.
///
/// A fuller body than an ellipsoid, one that fills more of its box, is as an ellipsoid of its half extents eᵢ
/// swollen by `s (ē/eᵢ)^(0.28 (s − 1))`, with `s = (6/π fill)^0.4` and ē the geometric mean of the three: to 2 % along and
/// across cylinders from 2 to 30 diameters long (Tirado & García de la Torre, *J. Chem. Phys.* 71, 2581 (1979))
/// and for a cube (whose radius in creeping flow is 0.66 edges).
fn creeping_resistance(hydro: &HydroProperties, plate_share: f64) -> StokesResistance {
    let plate = hydro.proxy.stokes_resistance();
    let full = hydro.box_fill() * 6.0 / PI;
    if plate_share == 1.0 || full <= 1.0 {
        return plate;
    }
    let swelling = full.min(6.0 / PI).powf(0.4);
    let half = &hydro.planform.half_extents;
    let mean = half.product().cbrt();
    let semi_axes = half.map(|e| e * swelling * (mean / e).powf(0.28 * (swelling - 1.0)));
    let bluff = Ellipsoid { semi_axes }.stokes_resistance();
    let mixed = |plate, bluff: Vector3<f64>| bluff.lerp(&plate, plate_share);
    StokesResistance {
        linear: mixed(plate.linear, bluff.linear),
        angular: mixed(plate.angular, bluff.angular),
    }
}

impl PhysicalLaw {
    /// Share of the added mass's coupling that a body feels: `munk` for plates and other squat bodies with
    /// edges, behind which the flow is separated, all of it for long ones and for round ones.
    pub(super) fn munk_factor(&self, hydro: &HydroProperties) -> f64 {
        let semi_axes = &hydro.proxy.semi_axes;
        let squat = 1.0 - thinness(semi_axes.y / semi_axes.x);
        let edged = hydro.bluff.as_ref().map_or(0.0, |shape| {
            1.0 - shape.roundness[0].z.min(shape.roundness[1].z)
        });
        let separated = Self::plate_share(hydro).max(squat * edged);
        separated * self.munk + (1.0 - separated)
    }

    /// How much of a plate a body is: purely up to a thickness of a quarter of its width, which no plate
    /// of the calibration reaches (they are thinner than 1/7), and none from a half on, as thick as a hemisphere.
    pub(super) fn plate_share(hydro: &HydroProperties) -> f64 {
        let semi_axes = &hydro.proxy.semi_axes;
        let t = ((semi_axes.z / semi_axes.y - THIN) / THIN).clamp(0.0, 1.0);
        1.0 - t * t * (3.0 - 2.0 * t)
    }

    /// The constants of one body as far as it is a plate. `mass` and `length` are its scales.
    pub(crate) fn prepare(
        &self,
        hydro: &HydroProperties,
        fluid: &Fluid,
        mass: f64,
        length: f64,
    ) -> PhysicalConstants<f64> {
        let rho = f64::from(fluid.density());
        let nu = f64::from(fluid.kinematic_viscosity());
        let plate = &hydro.planform;
        let proxy = &hydro.proxy;
        let [a, b, c]: [f64; 3] = proxy.semi_axes.into();
        // A strip has its share of the whole's resistance; what turning it across the span takes comes from where it is.
        let mut creeping = creeping_resistance(hydro, Self::plate_share(hydro));
        if plate.fraction != 1.0 {
            creeping.linear *= plate.fraction;
            creeping
                .angular
                .component_mul_assign(&Vector3::new(plate.fraction, 0.0, 0.0));
        }
        let whole_area = plate.area / plate.fraction;
        let drag = creeping.linear * (rho * nu / mass);
        let spin_drag = creeping.angular * (rho * nu / (mass * length * length));
        let share = Self::plate_share(hydro);

        let slenderness = plate.half_extents.x / plate.half_extents.y;
        let fill = whole_area / (4.0 * plate.half_extents.x * plate.half_extents.y);
        let plateau = broadside_drag(slenderness, fill);
        // Pressure on the two halves of a plate that rotates: ½ρC (I₂ k₁|u| + I₃ k₂|ω|), per axis
        // by how flat the body is seen along it. Spinning about z, a flat plate shows only its
        // edge: the shadow of the proxy in the xz plane.
        let pressure = 0.5 * rho * plateau / mass;
        let edge_on = (PI * a.powi(3) * c / 4.0, 8.0 / 15.0 * a.powi(4) * c);
        let flat = [thinness(c / b), thinness(c / a), thinness(b / a)];
        let second = [plate.second_moment.x, plate.second_moment.y, edge_on.0];
        let third = [plate.third_moment.x, plate.third_moment.y, edge_on.1];
        // What of it is no plate is damped as a bluff body.
        let by_u = |i: usize| {
            share * (pressure * flat[i] * second[i] * self.translation_damping / length.powi(2))
        };
        let by_w = |i: usize| {
            share * (pressure * flat[i] * third[i] * self.rotation_damping / length.powi(3))
        };
        PhysicalConstants {
            dynamic_area: 0.5 * rho * plate.area / mass,
            extent_x2: (plate.half_extents.x / length).powi(2),
            extent_y2: (plate.half_extents.y / length).powi(2),
            extent_product: plate.half_extents.x * plate.half_extents.y / (length * length),
            area: whole_area / (length * length),
            reynolds_scale: length / nu,
            broadside_plateau: plateau,
            broadside_mid: DISC_MID.0 * plateau / DISC_PLATEAU,
            friction: self.friction,
            edge_drag: self.edge_drag * plate.thickness / length,
            creeping: drag,
            attached_lift: self.attached_lift * share,
            attached_aspect: self.attached_aspect,
            stalled_lift: self.stalled_lift * share,
            stalled_aspect: self.stalled_aspect,
            stall_sine: self.stall_sine,
            stall_rate: 2.0 / self.stall_width,
            rotational_lift: self.rotational_lift * share,
            rotational_aspect: self.rotational_aspect,
            rotational_stall: self.rotational_stall,
            lift_onset: self.lift_onset,
            damping_onset: self.damping_onset,
            pressure_travel: self.pressure_travel * share,
            attached_drag: 2.0 * self.suction_loss,
            induced_drag: self.induced_drag / PI,
            damping_u: Vector3::new(by_u(0), by_u(1), by_u(2)),
            damping_w: Vector3::new(by_w(0), by_w(1), by_w(2)),
            spin_friction: share * 0.005 * rho * (plate.second_moment.x + plate.second_moment.y)
                / (mass * length * length),
            creeping_spin: spin_drag,
        }
    }
}

impl<T: Scalar> Evaluate<T> for PhysicalConstants<T> {
    #[inline(always)]
    fn terms(&self, u: &Vector3<T>, w: &Vector3<T>) -> ViscousTerms<T> {
        let constant = |value| u.x.constant(value);
        let (zero, one) = (constant(0.0), constant(1.0));
        let tangential2 = u.x * u.x + u.y * u.y;
        let speed = (tangential2 + u.z * u.z).sqrt();
        let per_speed = safe_inverse(speed);

        // Span across the motion, and the chord through the center along it: an ellipse's product
        // of the two is the same in every direction. For motion along n any direction will do.
        let tiny = constant(1e-12);
        let (ux2, uy2) = (u.x * u.x + tiny, u.y * u.y + tiny);
        let span2 = constant(4.0) * (self.extent_x2 * uy2 + self.extent_y2 * ux2) / (ux2 + uy2);
        let chord = constant(4.0) * self.extent_product / span2.sqrt();
        let aspect = span2 / self.area;
        let re = (speed * chord * self.reynolds_scale).max(constant(1e-3));

        // How much of the flow is attached, by the center's angle of attack.
        let stall = self.stall_rate * (u.z.abs() * per_speed - self.stall_sine);
        let attached = one / (one + stall.exp());

        // Pressure point and its velocity. Separated flow presses on the center.
        // In creeping flow there is no such point: a body keeps its tilt. All of the travel is there from
        // Re = 100 on, where the calibration begins.
        let inertial = (constant(1.1) * re / (re + constant(10.0))).min(one);
        let travel = self.pressure_travel * attached * chord * per_speed * inertial;
        let arm = Vector3::new(travel * u.x, travel * u.y, zero);
        let vz = u.z + w.x * arm.y - w.y * arm.x;
        let v_speed = (tangential2 + vz * vz).sqrt();
        let per_v = safe_inverse(v_speed);
        let sine = vz * per_v;
        let sine2 = sine * sine;

        // Lifts: W of the force W × v.
        let onset = self.lift_onset / re;
        let onset2 = onset * onset;
        let wake = one / (one + onset2 * onset2 * onset2 * onset);
        let slope = self.attached_lift * aspect / (aspect + self.attached_aspect);
        let stalled = self.stalled_lift * aspect / (aspect + self.stalled_aspect);
        let density_area = self.dynamic_area + self.dynamic_area;
        let translational = density_area * wake * sine * (stalled + attached * (slope - stalled));
        let rotational = density_area * chord * self.rotational_lift * wake * aspect
            / (aspect + self.rotational_aspect)
            * (one - self.rotational_stall * sine2);
        let by_angle = Vector3::new(-u.y, u.x, zero) * translational;
        let by_spin = Vector3::new(rotational * w.x, rotational * w.y, zero);

        // Drag of the plate. Its creeping part is the linear resistance; what is left broadside is
        // the larger of the disc's mid range and its plateau.
        let mid = if re.all_ge(MID_ENDS) {
            zero
        } else {
            let power = (re.ln() * constant(DISC_MID.1)).exp();
            (self.broadside_mid * power).select_lt(re, constant(MID_ENDS), zero)
        };
        let creeping_share = self.creeping.z * per_speed / self.dynamic_area;
        let broadside = mid.max(self.broadside_plateau - creeping_share);
        let edgewise = self.friction / re.sqrt() + self.edge_drag / chord;
        // Attached flow that does not turn round the sharp edge pulls the lift back to the normal;
        // broadside on there is no such flow.
        let across = broadside - edgewise;
        let behind = (self.attached_drag * slope - across).max(zero);
        let normal = across + wake * attached * (one - sine2) * behind;
        // Induced drag of both lifts, C_L²/(π AR (1 + 0.3 C_L)): linear where C_L is large, so that a
        // body that hardly does more than spin does not lose its whole velocity at once.
        let (wx, wy) = (by_angle.x + by_spin.x, by_angle.y + by_spin.y);
        let lift = (wx * wx + wy * wy).sqrt();
        let dynamic = self.dynamic_area * v_speed;
        let induced =
            self.induced_drag * lift * lift / (aspect * (dynamic + constant(0.3) * lift).max(tiny));
        let drag = dynamic * (edgewise + normal * sine2) + induced;

        // Damping. √(Re² + 1) keeps the low-Reynolds increase finite in a body at rest, where the
        // creeping resistance has long taken over.
        let onset = self.damping_onset / (re * re + one).sqrt();
        let by_speed = speed * (one + onset * onset.sqrt());
        let spin = (w.x * w.x + w.y * w.y).sqrt();
        let spin_z = w.z.abs();
        let friction = self.spin_friction * (speed + chord * spin_z);
        ViscousTerms {
            drag,
            creeping: self.creeping,
            translational_lift: by_angle,
            rotational_lift: by_spin,
            arm,
            arm_moves: true,
            offset: Vector3::repeat(zero),
            damping: Vector3::new(
                self.damping_u.x * by_speed + self.damping_w.x * spin + self.creeping_spin.x,
                self.damping_u.y * by_speed + self.damping_w.y * spin + self.creeping_spin.y,
                self.damping_u.z * by_speed
                    + self.damping_w.z * spin_z
                    + friction
                    + self.creeping_spin.z,
            ),
        }
    }
}
