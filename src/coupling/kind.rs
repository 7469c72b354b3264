//! Kinds: what equal bodies in the same fluid share at run time.

use crate::Error;
use crate::body::{BodyConstants, DryMass, ImmersedBody, InertiaConstants, LawConstants};
use crate::fluid::Fluid;
use crate::hydro::viscous::physical::PhysicalConstants;
use crate::hydro::viscous::stochastic::StochasticConstants;
use crate::hydro::viscous::thesis::ThesisConstants;
use crate::math::{scalar_struct, to_f64, to_quaternion, to_real, to_rotation};
use rapier3d::dynamics::MassProperties;
use rapier3d::math::{Rotation, Vector};
use rapier3d::na::{Matrix3, Matrix6, UnitQuaternion, Vector6};

/// The law's constants in rapier's precision.
#[derive(Clone, Debug)]
pub(super) enum LawLanes {
    Inviscid,
    Physical(PhysicalConstants<f32>),
    Thesis(ThesisConstants<f32>),
    Stochastic(StochasticConstants<f32>),
}

scalar_struct! {
    /// How forces and lengths of the world scale to those of the integrator.
    pub(super) struct Scales {
        /// L, m.
        length,
        /// 1/mass scale, 1/kg.
        per_mass,
        /// 1/(mass scale · L).
        per_mass_length,
        /// Body's own mass over the mass scale.
        dry_mass,
        /// Displaced mass over the mass scale.
        displaced_mass,
        /// Center of mass to center of buoyancy, plate axes, in L.
        arm_x,
        arm_y,
        arm_z,
    }
}

/// One description with one set of mass properties in one fluid.
#[derive(Clone, Debug)]
pub(super) struct Kind {
    /// Index of the description.
    pub description: u32,
    pub constants: BodyConstants,
    pub inertia: InertiaConstants<f32>,
    pub law: LawLanes,
    pub scales: Scales<f32>,
    /// Plate axes to the body's frame.
    pub axes: Rotation,
    /// Rotational inertia that rapier is given, I + ρA₂₂, plate axes, kg·m².
    pub rotational_inertia: [[f32; 3]; 3],
    /// Inverse of the 6×6 mass of body and fluid about the center of mass, body axes.
    pub inverse_mass: Matrix6<f64>,
    /// Whether a push at the center of mass turns the body (A₁₂ ≠ 0).
    pub coupled: bool,
}

impl Kind {
    /// # Errors
    /// Those of [`BodyConstants::new`].
    pub fn new(
        description: u32,
        body: &ImmersedBody,
        dry: &DryMass,
        fluid: &Fluid,
    ) -> Result<Self, Error> {
        let constants = BodyConstants::new(body, dry, fluid)?;
        let law = match &constants.law {
            LawConstants::Inviscid => LawLanes::Inviscid,
            LawConstants::Physical(law) => LawLanes::Physical(PhysicalConstants::from_f64(law)),
            LawConstants::Thesis(law) => LawLanes::Thesis(ThesisConstants::from_f64(law)),
            LawConstants::Stochastic(law) => {
                LawLanes::Stochastic(StochasticConstants::from_f64(law))
            }
        };
        let (mass, length) = (constants.mass, constants.length);
        let arm = constants.axes.inverse() * constants.buoyancy_arm / length;
        let scales = Scales {
            length,
            per_mass: 1.0 / mass,
            per_mass_length: 1.0 / (mass * length),
            dry_mass: dry.mass / mass,
            displaced_mass: constants.displaced_mass / mass,
            arm_x: arm.x,
            arm_y: arm.y,
            arm_z: arm.z,
        };
        let mut whole = constants.added_mass.to_matrix6();
        let mut linear = whole.fixed_view_mut::<3, 3>(0, 0);
        linear += Matrix3::from_diagonal_element(dry.mass);
        let mut angular = whole.fixed_view_mut::<3, 3>(3, 3);
        angular += dry.inertia;
        let inverse_mass = whole.try_inverse().ok_or(Error::UnphysicalAddedMass)?;
        let coupling = constants.added_mass.coupling.norm();
        let plate = constants.axes.inverse().matrix()
            * whole.fixed_view::<3, 3>(3, 3)
            * constants.axes.matrix();
        Ok(Self {
            description,
            inertia: InertiaConstants::from_f64(&constants.inertia),
            law,
            scales: Scales::from_f64(&scales),
            axes: to_rotation(UnitQuaternion::from_rotation_matrix(&constants.axes)),
            rotational_inertia: std::array::from_fn(|i| {
                std::array::from_fn(|j| plate[(i, j)] as f32)
            }),
            inverse_mass,
            coupled: coupling > 1e-6 * mass * length,
            constants,
        })
    }

    /// What rapier is given: the scalar mass it can use, and I + ρA₂₂.
    pub fn rapier_mass_properties(&self, mass: f64) -> MassProperties {
        let dry = &self.constants.dry;
        DryMass {
            mass,
            center: dry.center,
            inertia: dry.inertia + self.constants.added_mass.angular,
        }
        .to_mass_properties()
    }

    /// Velocity change (world axes) of a body whose attitude (body to world) is `attitude` when the
    /// fluid around it changes its velocity by `change`: `𝕄⁻¹ (ρV + ρA) ΔU`, the pressure gradient
    /// and the added mass of an accelerating flow. A neutrally buoyant body follows exactly.
    pub fn pushed_by(&self, attitude: Rotation, change: Vector) -> (Vector, Vector) {
        let rotation = to_quaternion(attitude);
        let u = rotation.inverse() * to_f64(change);
        let c = &self.constants;
        let pressure = u * c.displaced_mass;
        let impulse = c.added_mass.linear * u + pressure;
        let moment = c.added_mass.coupling.transpose() * u + c.buoyancy_arm.cross(&pressure);
        let velocity = self.inverse_mass
            * Vector6::new(
                impulse.x, impulse.y, impulse.z, moment.x, moment.y, moment.z,
            );
        (
            to_real(rotation * velocity.fixed_rows::<3>(0)),
            to_real(rotation * velocity.fixed_rows::<3>(3)),
        )
    }

    /// Whether another body would be of this kind.
    pub fn is(&self, description: u32, dry: &DryMass) -> bool {
        self.description == description && self.constants.dry == *dry
    }
}
