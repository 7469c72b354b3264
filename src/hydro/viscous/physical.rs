//! The default law: physical, passive, calibrated against experiments.

use super::coefficients::{Bounds, Coefficient, coefficients};
use super::terms::{Evaluate, ViscousTerms, safe_inverse};
use crate::fluid::Fluid;
use crate::geometry::Ellipsoid;
use crate::hydro::properties::THIN;
use crate::hydro::{HydroProperties, StokesResistance};
use crate::math;
use crate::math::{Scalar, scalar_struct};
use rapier3d::na::{Vector2, Vector3};
use std::f64::consts::PI;

coefficients! {
    /// Coefficients of the default viscous law, dimensionless. One set serves every thin body: plates
    /// in water, paper in air, discs of any Reynolds number, and wings.
    ///
    /// With n the plate normal, `c` the chord along the motion, `A` the planform area, `AR` the aspect
    /// ratio span²/A, `Re = |u|c/ν`, `η = AR/(2 + √(AR² + 4))` (Helmbold 1942), and the angle of attack
    /// `s = sin α = |u·n|/|u|`, the flow is attached to the share `f = 1/(1 + exp(2(s − s_e)/δ))`, and
    /// separated otherwise. All forces use the velocity relative to the fluid **v** at the center of
    /// pressure p:
    ///
    /// * **Stall.** `s_e = min(s₀ + s₁/AR, s_m) + min(k r, s_d)`: small wings stall late. It moves with the *signed*
    ///   pitch rate `r = (c/2|u|) dα/dt` as it does on helicopter blades (Gormont 1973): rotation that
    ///   raises the angle of attack delays the stall, by `s_d` at most, rotation that lowers it hastens
    ///   it. Without this plates that glide well no longer tumble.
    /// * **Normal force** `½ρA C_N |v|²` with `C_N = s [f (2πhη + K_v (1 − η)² s) + (1 − f) 2 (C_s + C_t η² cos⁴α/(1 + (ω_t c/|u|r_t)²))]`:
    ///   Helmbold's lift slope, the vortex lift of the side edges (Polhamus 1966: π for slender wings),
    ///   and separated flow, which pushes more behind a wide plate that keeps its angle than behind one that turns. With sin⁴α it turns into the measured drag coefficient C_D90 broadside on,
    ///   which passes to Stokes as Re → 0. It is applied as a resistance plus a turning force that together
    ///   are normal to the plate, so that a stalled plate does not push itself along; attached flow keeps
    ///   `1 − k_s` of the suction at its leading edge. The turning force fades below the onset of the
    ///   wake (Re ≈ 100).
    /// * **Center of pressure** `p = c u_t/|u| [f χ (1 + (1 − η)⁴)(1 − k_r (1 − η²)² (s/s_e)²) + (1 − f) χ_s] Re/(Re + Re_χ)`: a
    ///   quarter of the chord behind the leading edge in two dimensions, at the leading edge of slender
    ///   wings (Jones 1946), within .02 chord of a vortex lattice between; in creeping flow in the middle. The bubble
    ///   behind a sharp leading edge, which grows toward the stall, moves it back before the lift drops: that is what
    ///   trims a weighted card well below its stall.
    /// * **Rotational lift** `ρAc (πhη/4)(1 − ε sin²α) ω_t × v`: the circulation follows the angle of
    ///   attack at ¾ of the chord (Pistolesi's theorem), so that no coefficient of its own is needed.
    /// * **Induced drag of the rotation** `C_Di = k_i C_L C_R/(π AR)` (linear for C_L ≫ 3), C_R being its
    ///   lift and C_L that of both together: it is what makes a tumbling disc drift so much less than a
    ///   tumbling strip. That of the angle of attack is part of the normal force.
    /// * **Friction** `k_f Re^−½` (two sides of a laminar boundary layer: 2.66) and the drag `k_e t/c` of the
    ///   edges.
    /// * **Damping** of the rotation by the pressure on the two halves of the plate, `½ρC_D90 (I₂ K₁|u| + I₃
    ///   K₂|ω|)` with `K₁ = f k₁ₐ + (1 − f) k₁`, and by friction; about the motion, as a wing that rolls, k₁ₐ is
    ///   `k_p 2πη/C_D90`.
    /// * **Munk moment** of the added mass weakened to `munk`, because separated flow does not recover
    ///   the pressure that makes it; what of the added mass is the same in all directions, and makes no
    ///   moment, is left as it is, and so are bodies that are as thick as wide.
    ///
    /// What rotation adds depends on the aspect ratio: disc and strip want other values of k, C_s, χ_s, ε,
    /// k₁ and k₂. Each of them has a value for wide plates (AR → ∞) and one for narrow ones (AR → 0,
    /// `…_narrow`), and `η²` leads from the one to the other: .09 for discs and squares, .29 at AR 3, .87 for
    /// strips of AR 29.
    ///
    /// No term can add energy to body and fluid: drag opposes v, the lifts are perpendicular to it, and
    /// the torque is that of the same force at the same point.
    ///
    /// The numbers come from a global search against falling plates in water (Andersen, Pesavento &
    /// Wang 2005), the regime map of discs (Field et al. 1997), falling paper (Howison et al. 2020), static
    /// polars and gliders: [`training::fidelity`](crate::training::fidelity), example `calibrate`. What
    /// they reach, and what they miss, is in the table of the example `validation`.
    ///
    /// Bodies that are not plates blend, by thickness, into bluff bodies with drag coefficients from their own
    /// geometry ([`BluffShape`](crate::BluffShape)), with a Magnus force instead of the plate's lifts.
    pub struct PhysicalLaw {
        /// χ: travel of the center of pressure toward the leading edge in attached flow of two dimensions, in
        /// chords; ¼ in theory.
        pressure_travel: 0.241, NotNegative, search 0.22 to 0.28;
        /// h: lift slope over Helmbold's.
        lift_slope: 1.01, NotNegative, search 0.93 to 1.08;
        /// K_v: vortex lift of slender plates; π in theory.
        vortex_lift: 2.95, NotNegative, search 1.0 to 6.0;
        /// C_s: half the slope of the normal force of separated flow; of wide plates.
        stalled_lift: 0.565, NotNegative, search 0.4 to 1.3;
        /// C_s of narrow plates.
        stalled_lift_narrow: 0.997, NotNegative, search 0.4 to 1.2;
        /// C_t: what C_s has more on wide plates that are held past their stall, where C_N rises less than with sin α: 0.95 at
        /// 20° to 1.61 at 45° in two dimensions (`1/(0.222 + 0.283/sin α)`: Hoerner, *Fluid-Dynamic Drag*).
        steady_lift: 0.8, NotNegative;
        /// r_t: rotation, radians per chord of way, at which half of that is lost.
        steady_rate: 0.03, Positive;
        /// s₀: sine of the angle of attack at which the flow stalls in two dimensions.
        stall_sine: 0.136, NotNegative, search 0.08 to 0.35;
        /// s₁: what is added to it per 1/AR.
        stall_aspect: 0.522, NotNegative, search 0.2 to 0.8;
        /// s_m: the sine beyond which it does not stall later: rectangular plates of AR 0.5 stall at 40° (Torres & Mueller,
        /// *AIAA J.* 42, 865 (2004)).
        stall_limit: 0.72, NotNegative, search 0.6 to 0.75;
        /// δ: width of the stall in sin α.
        stall_width: 0.0522, Positive, search 0.03 to 0.25;
        /// k: shift of the stall's sine by the signed pitch rate; of wide plates.
        pitch_stall: 6.69, NotNegative, search 0.0 to 14.0;
        /// k of narrow plates.
        pitch_stall_narrow: 0.0135, NotNegative, search 0.0 to 3.0;
        /// s_d: greatest delay of the stall's sine by rotation.
        stall_delay: 0.0146, NotNegative, search 0.0 to 0.6;
        /// k_r: share of χ that the center of pressure has lost where the flow stalls; of narrow plates. Measured on thin
        /// plates: `0.3 − 3.5 α²` of attached flow that stalls at 14° (Li, Goodwill, Wang & Ristroph, *J. Fluid Mech.*
        /// 937, A9 (2022)), 0.70 of it at the stall. Wide plates that tumble (AR 29) do not show it.
        pressure_retreat: 0.7, Unit, search 0.0 to 1.0;
        /// χ_s: travel of the center of pressure in separated flow, in chords; of wide plates.
        stalled_travel: 0.134, NotNegative, search 0.0 to 0.25;
        /// χ_s of narrow plates.
        stalled_travel_narrow: 0.0349, NotNegative, search 0.0 to 0.25;
        /// Re_χ: below it the center of pressure stays in the middle.
        travel_onset: 19.2, NotNegative, search 10.0 to 40.0;
        /// ε: loss of rotational lift broadside on; of wide plates.
        rotational_stall: 0.0, Unit, search 0.0 to 1.0;
        /// ε of narrow plates.
        rotational_stall_narrow: 0.22, Unit, search 0.0 to 1.0;
        /// k_M ∈ [0, 1]: share of the added mass's inertial coupling (Munk moment) that plates feel.
        munk: 0.108, Unit, search 0.0 to 1.0;
        /// k₁ₐ: damping of pitching by translation in attached flow; 2.5 in theory in two dimensions, and not much less of
        /// slender plates.
        attached_damping: 2.17, NotNegative, search 0.0 to 4.0;
        /// k_p: damping of rolling in attached flow, in units of strip theory's `2πη/C_D90`; of wide plates, where it is 1
        /// in theory.
        roll_damping: 1.59, NotNegative, search 0.4 to 1.6;
        /// k_p of narrow plates; 3/8 in the theory of slender wings (Jones 1946).
        roll_damping_narrow: 0.375, NotNegative;
        /// k₁: damping of rotation by translation in separated flow; of wide plates.
        translation_damping: 0.455, NotNegative, search 0.0 to 4.0;
        /// k₁ of narrow plates.
        translation_damping_narrow: 0.133, NotNegative, search 0.0 to 4.0;
        /// k₂: damping of rotation by rotation; of wide plates.
        rotation_damping: 0.589, NotNegative, search 0.0 to 5.0;
        /// k₂ of narrow plates.
        rotation_damping_narrow: 0.035, NotNegative, search 0.0 to 5.0;
        /// k_f: skin friction, `k_f Re^−½`.
        friction: 2.44, NotNegative, search 2.4 to 5.0;
        /// k_e: pressure drag of the edges, per thickness over chord.
        edge_drag: 0.596, NotNegative, search 0.0 to 2.0;
        /// Re_L: onset of the wake's lift, `1/(1 + (Re_L/Re)⁷)`.
        lift_onset: 90.7, NotNegative, search 50.0 to 140.0;
        /// Re_D: below it rotation is damped more, `1 + (Re_D/Re)^1.5`.
        damping_onset: 40.1, NotNegative, search 0.0 to 60.0;
        /// k_s: share of the leading edge's suction that attached flow loses: at 1 its force is normal to
        /// the plate.
        suction_loss: 0.964, Unit, search 0.6 to 1.0;
        /// k_i: induced drag of the rotation, in units of the elliptic wing's.
        induced_drag: 8.35, NotNegative, search 0.0 to 12.0;
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
        lift_slope: T,
        vortex_lift: T,
        /// At wide plates, and what is added at narrow ones.
        stalled_lift: Vector2<T>,
        steady_lift: T,
        /// 1/r_t.
        steady_rate: T,
        stall_sine: T,
        stall_aspect: T,
        stall_limit: T,
        stall_rate: T,
        pitch_stall: Vector2<T>,
        stall_delay: T,
        pressure_travel: T,
        pressure_retreat: T,
        stalled_travel: Vector2<T>,
        travel_onset: T,
        rotational_stall: Vector2<T>,
        attached_damping: T,
        roll_damping: Vector2<T>,
        translation_damping: Vector2<T>,
        rotation_damping: Vector2<T>,
        lift_onset: T,
        damping_onset: T,
        suction_gain: T,
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

/// Broadside drag coefficient of a rectangle by its slenderness b/a, whichever is longer, linear in a/b between the
/// tabulated 1, 5, 10, ∞ (DNV-RP-C205, appendix E); for a plate that is rounder than a rectangle,
/// `fill` (planform over its box: π/4 for ellipses) leads over to the disc.
fn broadside_drag(slenderness: f64, fill: f64) -> f64 {
    const TABLE: [(f64, f64); 4] = [(0.0, 1.90), (0.1, 1.50), (0.2, 1.20), (1.0, 1.16)];
    let x = slenderness.min(1.0 / slenderness).max(0.0);
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
    let swelling = math::powf(full.min(6.0 / PI), 0.4);
    let half = &hydro.planform.half_extents;
    let mean = math::cbrt(half.product());
    let semi_axes = half.map(|e| e * swelling * math::powf(mean / e, 0.28 * (swelling - 1.0)));
    let bluff = Ellipsoid { semi_axes }.stokes_resistance();
    let mixed = |plate, bluff: Vector3<f64>| bluff.lerp(&plate, plate_share);
    StokesResistance {
        linear: mixed(plate.linear, bluff.linear),
        angular: mixed(plate.angular, bluff.angular),
    }
}

/// A coefficient of narrow plates, and what wide ones have more.
fn between(wide: f64, narrow: f64) -> Vector2<f64> {
    Vector2::new(narrow, wide - narrow)
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
        // edge: the shadow of the proxy in the xz plane, of which a strip has its length.
        let pressure = 0.5 * rho * plateau / mass;
        let edge = a * plate.fraction;
        let edge_on = (PI * edge.powi(3) * c / 4.0, 8.0 / 15.0 * edge.powi(4) * c);
        let flat = [thinness(c / b), thinness(c / a), thinness(b / a)];
        let second = [plate.second_moment.x, plate.second_moment.y, edge_on.0];
        let third = [plate.third_moment.x, plate.third_moment.y, edge_on.1];
        // What of it is no plate is damped as a bluff body.
        let by_u = |i: usize| share * pressure * flat[i] * second[i] / length.powi(2);
        let by_w = |i: usize| share * pressure * flat[i] * third[i] / length.powi(3);
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
            // The edges of slabs are those of the bluff body that they partly are.
            edge_drag: self.edge_drag * (1.0 - hydro.thickness()) * plate.thickness / length,
            creeping: drag,
            lift_slope: self.lift_slope * 2.0 * PI * share,
            vortex_lift: self.vortex_lift * share,
            stalled_lift: between(
                2.0 * share * self.stalled_lift,
                2.0 * share * self.stalled_lift_narrow,
            ),
            steady_lift: 2.0 * share * self.steady_lift,
            steady_rate: 1.0 / self.steady_rate,
            stall_sine: self.stall_sine,
            stall_aspect: self.stall_aspect,
            stall_limit: self.stall_limit,
            stall_rate: 2.0 / self.stall_width,
            pitch_stall: between(self.pitch_stall, self.pitch_stall_narrow),
            stall_delay: self.stall_delay,
            pressure_travel: self.pressure_travel * share,
            pressure_retreat: self.pressure_retreat,
            stalled_travel: between(
                self.stalled_travel * share,
                self.stalled_travel_narrow * share,
            ),
            travel_onset: self.travel_onset,
            rotational_stall: between(self.rotational_stall, self.rotational_stall_narrow),
            attached_damping: self.attached_damping,
            roll_damping: between(self.roll_damping, self.roll_damping_narrow)
                * (2.0 * PI / plateau),
            translation_damping: between(self.translation_damping, self.translation_damping_narrow),
            rotation_damping: between(self.rotation_damping, self.rotation_damping_narrow),
            lift_onset: self.lift_onset,
            damping_onset: self.damping_onset,
            suction_gain: 1.0 - self.suction_loss,
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
        let along_x2 = ux2 / (ux2 + uy2);
        let along_y2 = one - along_x2;
        let span2 = constant(4.0) * (self.extent_x2 * along_y2 + self.extent_y2 * along_x2);
        let per_span = one / span2.sqrt();
        let chord = constant(4.0) * self.extent_product * per_span;
        let per_aspect = self.area * per_span * per_span;
        let re = (speed * chord * self.reynolds_scale).max(constant(1e-4));

        // Helmbold's loss of lift slope, AR/(2 + √(AR² + 4)), and what follows the aspect ratio with it.
        let tips = per_aspect + per_aspect;
        let finite = (one + tips * tips).sqrt() - tips;
        let wide = finite * finite;
        let at_aspect = |of: Vector2<T>| of.x + of.y * wide;
        let slender2 = (one - finite) * (one - finite);

        // How much of the flow is attached, by the center's angle of attack. Rotation that raises it
        // delays the stall, rotation that lowers it hastens it.
        let sine_center = u.z * per_speed;
        let sine_center2 = sine_center * sine_center;
        let turning = (w.y * u.x - w.x * u.y) * per_speed;
        let double2 = constant(4.0) * sine_center2 * (one - sine_center2);
        let rate = turning * sine_center * chord * per_speed / (double2 + constant(0.1)).sqrt();
        let shift = (at_aspect(self.pitch_stall) * rate).min(self.stall_delay);
        let steady = (self.stall_sine + self.stall_aspect * per_aspect).min(self.stall_limit);
        let stall_sine = (steady + shift).max(constant(0.03));
        let stall = self.stall_rate * (sine_center.abs() - stall_sine);
        let attached = one / (one + stall.min(constant(60.0)).exp());

        // Pressure point and its velocity.
        let stalled_travel = at_aspect(self.stalled_travel);
        let narrow = (one - wide) / steady.max(constant(0.03));
        let retreat = self.pressure_retreat * narrow * narrow * sine_center2;
        let attached_travel =
            self.pressure_travel * (one + slender2 * slender2) * (one - retreat).max(zero);
        let travel = (stalled_travel + attached * (attached_travel - stalled_travel))
            * chord
            * per_speed
            * re
            / (re + self.travel_onset);
        let arm = Vector3::new(travel * u.x, travel * u.y, zero);
        let vz = u.z + w.x * arm.y - w.y * arm.x;
        let v_speed = (tangential2 + vz * vz).sqrt();
        let per_v = safe_inverse(v_speed);
        let sine = vz * per_v;
        let sine2 = sine * sine;

        let onset = self.lift_onset / re;
        let onset2 = onset * onset;
        let wake = one / (one + onset2 * onset2 * onset2 * onset);

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
        let across = broadside - edgewise;

        // Normal force over sin α; broadside on it is the drag's.
        let slope = self.lift_slope * finite;
        let spin = (w.x * w.x + w.y * w.y).sqrt();
        let per_chord = spin * chord * per_speed * self.steady_rate;
        let cosine_center2 = one - sine_center2;
        let stalled = at_aspect(self.stalled_lift)
            + self.steady_lift * wide * cosine_center2 * cosine_center2
                / (one + per_chord * per_chord);
        let vortex = self.vortex_lift * slender2 * sine.abs();
        let normal = stalled + attached * (slope + vortex - stalled);
        let normal = normal - sine2 * sine2 * (normal - across).max(zero);
        let translational = self.dynamic_area * wake * sine_center * normal;
        let rotational = self.dynamic_area
            * chord
            * wake
            * constant(0.25)
            * slope
            * (one - at_aspect(self.rotational_stall) * sine2);
        let by_angle = Vector3::new(-u.y, u.x, zero) * translational;
        let by_spin = Vector3::new(rotational * w.x, rotational * w.y, zero);

        let suction = one - self.suction_gain * attached;
        let pressure = across + wake * (suction * normal - across).max(zero);
        // Induced drag of the rotation's lift; that of the angle of attack is in the normal force.
        // Spin along the motion makes no lift.
        let along = safe_inverse(tangential2.sqrt());
        let across_motion = (w.y * u.x - w.x * u.y) * along;
        let turned = rotational * across_motion;
        let lift = (translational * tangential2 * along + turned).abs();
        let turned = turned.abs();
        let dynamic = self.dynamic_area * v_speed;
        let induced = self.induced_drag * lift * turned * per_aspect
            / (dynamic + constant(0.3) * lift).max(tiny);
        let drag = dynamic * (edgewise + pressure * sine2) + induced;

        // Damping. √(Re² + 1) keeps the low-Reynolds increase finite in a body at rest, where the
        // creeping resistance has long taken over.
        let onset = self.damping_onset / (re * re + one).sqrt();
        let stalled_damping = at_aspect(self.translation_damping);
        let rolling = at_aspect(self.roll_damping) * finite - self.attached_damping;
        let by_speed = speed * (one + onset * onset.sqrt());
        let pitching =
            by_speed * (stalled_damping + attached * (self.attached_damping - stalled_damping));
        let rolling = by_speed * attached * rolling;
        let rotation_damping = at_aspect(self.rotation_damping);
        let spin = spin * rotation_damping;
        let spin_z = w.z.abs();
        let friction = self.spin_friction * (speed + chord * spin_z);
        let spin_z = spin_z * rotation_damping;
        ViscousTerms {
            drag,
            creeping: self.creeping,
            translational_lift: by_angle,
            rotational_lift: by_spin,
            arm,
            arm_moves: true,
            offset: Vector3::repeat(zero),
            damping: Vector3::new(
                self.damping_u.x * (pitching + rolling * along_x2)
                    + self.damping_w.x * spin
                    + self.creeping_spin.x,
                self.damping_u.y * (pitching + rolling * along_y2)
                    + self.damping_w.y * spin
                    + self.creeping_spin.y,
                self.damping_u.z * pitching
                    + self.damping_w.z * spin_z
                    + friction
                    + self.creeping_spin.z,
            ),
        }
    }
}
