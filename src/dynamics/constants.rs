//! The constants of one body in one fluid, made once and used in every step.

use super::part_constants::{BodyFrame, PartConstants, coupled_mass};
use crate::body::{DryMass, ImmersedBody};
use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::AddedMass;
use crate::hydro::part_law::place::CoupledMass;
use crate::hydro::viscous::PreparedLaw;
use crate::math::scalar_struct;
use rapier3d::na::{Matrix3, Matrix6, Rotation3, Vector3};

scalar_struct! {
    /// Inertia of body and fluid in **plate axes** about the center of mass.
    ///
    /// To stay far from the ends of f32's range for bodies from 1 µg to 1 t, masses are in units of
    /// a mass scale and lengths in units of a length scale L; angular velocities are carried as
    /// `w = ωL`, in m/s like the linear velocity.
    pub(crate) struct InertiaConstants<T> {
        /// 𝕄₁₁ = m + ρA₁₁.
        m11: Matrix3<T>,
        /// 𝕄₁₂ = ρA₁₂.
        m12: Matrix3<T>,
        /// 𝕄₂₂ = I + ρA₂₂.
        m22: Matrix3<T>,
        /// Inverses of the diagonals of 𝕄₁₁ and 𝕄₂₂.
        per_m11: Vector3<T>,
        per_m22: Vector3<T>,
        /// The body's own mass.
        dry_mass: T,
        /// Share of the added mass's coupling that is felt …
        munk: T,
        /// … and its isotropic part, felt whole, which acts at the center of volume.
        isotropic: T,
        /// From the center of mass to the center of volume, L.
        volume_center: Vector3<T>,
        /// From the center of mass to the planform's center, L.
        center: Vector3<T>,
        /// 1/L, 1/m.
        per_length: T,
        /// Chord that convection is measured by, m.
        chord: T,
    }
}

/// Everything about a body in one fluid that does not change from step to step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BodyConstants {
    /// Mass scale, kg.
    pub mass: f64,
    /// Length scale L, m.
    pub length: f64,
    /// Maps plate axes to the body's frame.
    pub axes: Rotation3<f64>,
    pub inertia: InertiaConstants<f64>,
    pub law: PreparedLaw<f64>,
    /// Whether 𝕄 is diagonal and the planform centered on the center of mass, to f32 rounding.
    pub symmetric: bool,
    /// Mass of the displaced fluid ρV, kg.
    pub displaced_mass: f64,
    /// From the center of mass to the center of buoyancy, m, body axes.
    pub buoyancy_arm: Vector3<f64>,
    /// Added mass times density about the center of mass, body axes.
    pub added_mass: AddedMass,
    pub dry: DryMass,
    /// (b² − c²)/(b² + c²), (c² − a²)/(c² + a²), (a² − b²)/(a² + b²) of the proxy's semi-axes.
    pub straining: Vector3<f64>,
    /// The parts, if there is more than the whole.
    pub parts: Vec<PartConstants<f64>>,
    pub coupled: CoupledMass<f64>,
    /// Density of the fluid, kg/m³.
    pub density: f64,
}

impl BodyConstants {
    /// # Errors
    /// Those of [`DryMass::check`], [`HydroProperties::check`](crate::HydroProperties::check) and
    /// [`ViscousLaw::check`](crate::ViscousLaw::check).
    pub fn new(body: &ImmersedBody, dry: &DryMass, fluid: &Fluid) -> Result<Self, Error> {
        dry.check()?;
        body.check_numbers()?;
        let hydro = &body.hydro;
        let rho = f64::from(fluid.density());
        let about_center = hydro.added_mass_about(dry.center);
        if !about_center.is_physical() {
            return Err(Error::UnphysicalAddedMass);
        }
        let added_mass = AddedMass {
            linear: about_center.linear * rho,
            coupling: about_center.coupling * rho,
            angular: about_center.angular * rho,
        };
        let axes = hydro.planform.axes;
        let plate = added_mass.rotated(&axes.inverse());
        let turn = axes.inverse();
        let dry_inertia = turn.matrix() * dry.inertia * axes.matrix();

        let mass = dry.mass + plate.linear.trace() / 3.0;
        let extents = hydro.planform.half_extents;
        let length = extents.x.max(1e-9);
        let m11 = mirrored((plate.linear + Matrix3::from_diagonal_element(dry.mass)) / mass);
        let m12 = plate.coupling / (mass * length);
        let m22 = mirrored((plate.angular + dry_inertia) / (mass * length * length));
        let center = turn * (hydro.planform.center - dry.center) / length;
        let volume_center = turn * (hydro.centroid - dry.center) / length;
        let munk = body.law.munk_factor(hydro);
        let isotropic = hydro.thickness() * rho * hydro.isotropic_added_mass() / mass;
        let inertia = InertiaConstants {
            m11,
            m12,
            m22,
            per_m11: m11.diagonal().map(|m| 1.0 / m),
            per_m22: m22.diagonal().map(|m| 1.0 / m),
            dry_mass: dry.mass / mass,
            munk,
            isotropic,
            volume_center,
            center,
            per_length: 1.0 / length,
            chord: 2.0 * extents.y,
        };
        let diagonal = |m: &Matrix3<f64>| {
            let rest = m - Matrix3::from_diagonal(&m.diagonal());
            (0..3).all(|i| rest.row(i).amax() <= 1e-7 * m[(i, i)])
        };
        let squares = hydro.proxy.semi_axes.map(|s| s * s);
        let straining = Vector3::from_fn(|i, _| {
            let (b2, c2) = (squares[(i + 1) % 3], squares[(i + 2) % 3]);
            (b2 - c2) / (b2 + c2)
        });
        let law = body.law.prepare(hydro, fluid, mass, length);
        let centered = center.amax() <= 1e-7 && volume_center.amax() * isotropic <= 1e-7;
        let centered = centered && law.centered();
        let symmetric = diagonal(&m11) && diagonal(&m22) && m12.amax() <= 1e-7 && centered;
        let frame = BodyFrame {
            center: dry.center,
            axes,
            mass,
            length,
        };
        let parts = body.parts.iter();
        Ok(Self {
            parts: parts
                .map(|part| PartConstants::new(part, body, fluid, &frame))
                .collect(),
            coupled: coupled_mass(body, rho, &frame),
            density: rho,
            mass,
            length,
            axes,
            inertia,
            law,
            symmetric,
            displaced_mass: rho * hydro.volume,
            buoyancy_arm: hydro.centroid - dry.center,
            added_mass,
            dry: *dry,
            straining,
        })
    }

    /// The 6×6 mass of body and fluid about the center of mass, body axes.
    pub fn mass_matrix(&self) -> Matrix6<f64> {
        let mut whole = self.added_mass.to_matrix6();
        let mut linear = whole.fixed_view_mut::<3, 3>(0, 0);
        linear += Matrix3::from_diagonal_element(self.dry.mass);
        let mut angular = whole.fixed_view_mut::<3, 3>(3, 3);
        angular += self.dry.inertia;
        whole
    }
}

/// A symmetric matrix whose lower triangle repeats the upper one to the bit.
fn mirrored(m: Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| m[(i.min(j), i.max(j))])
}
