//! Kinds: what equal bodies in the same fluid share at run time.

use crate::Error;
use crate::body::{BodyConstants, DryMass, ImmersedBody, InertiaConstants, LawConstants};
use crate::fluid::Fluid;
use crate::hydro::viscous::physical::PhysicalConstants;
use crate::hydro::viscous::stochastic::StochasticConstants;
use crate::hydro::viscous::thesis::ThesisConstants;
use crate::math::{Lanes, scalar_struct, to_f64, to_quaternion, to_real, to_rotation};
use rapier3d::dynamics::MassProperties;
use rapier3d::math::{Rotation, Vector};
use rapier3d::na::{Matrix3, Matrix6, UnitQuaternion, Vector3, Vector6};

/// The law's constants in rapier's precision.
#[derive(Clone, Debug)]
pub(super) enum LawLanes {
    Inviscid,
    /// The default law for a body that is purely a plate to it …
    Plate(PhysicalConstants<f32>),
    /// … and for one that is not.
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
        /// Rotational inertia that rapier is given, I + ρA₂₂, plate axes, kg·m²: upper triangle.
        turn_xx,
        turn_xy,
        turn_xz,
        turn_yy,
        turn_yz,
        turn_zz,
    }
}

impl Scales<Lanes> {
    /// Torque that causes an angular acceleration in rapier, plate axes.
    #[inline(always)]
    pub fn turn(&self, a: &Vector3<Lanes>) -> Vector3<Lanes> {
        Vector3::new(
            self.turn_xx * a.x + self.turn_xy * a.y + self.turn_xz * a.z,
            self.turn_xy * a.x + self.turn_yy * a.y + self.turn_yz * a.z,
            self.turn_xz * a.x + self.turn_yz * a.y + self.turn_zz * a.z,
        )
    }
}

/// Which code a body takes through the step. Bodies of one route are advanced side by side, so that
/// what happens to one never depends on who its neighbours are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Route {
    /// See [`BodyConstants::symmetric`].
    pub symmetric: bool,
    law: u8,
}

impl Route {
    /// Number of routes.
    pub const COUNT: usize = 10;

    /// All routes, in the order of their indices.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..Self::COUNT as u8).map(|index| Self {
            symmetric: index % 2 == 1,
            law: index / 2,
        })
    }

    /// Index among all routes.
    pub fn index(self) -> usize {
        usize::from(self.law * 2 + u8::from(self.symmetric))
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
    pub route: Route,
    /// Whether buoyancy has a torque.
    pub buoyancy_turns: bool,
    /// Whether some motion drags more than half of the body's own mass along.
    pub heavy_fluid: bool,
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
            LawConstants::Physical(law) => {
                let lanes = PhysicalConstants::from_f64(law);
                if law.plate_share == 1.0 {
                    LawLanes::Plate(lanes)
                } else {
                    LawLanes::Physical(lanes)
                }
            }
            LawConstants::Thesis(law) => LawLanes::Thesis(ThesisConstants::from_f64(law)),
            LawConstants::Stochastic(law) => {
                LawLanes::Stochastic(StochasticConstants::from_f64(law))
            }
        };
        let (mass, length) = (constants.mass, constants.length);
        let arm = constants.axes.inverse() * constants.buoyancy_arm / length;
        let mut whole = constants.added_mass.to_matrix6();
        let mut linear = whole.fixed_view_mut::<3, 3>(0, 0);
        linear += Matrix3::from_diagonal_element(dry.mass);
        let mut angular = whole.fixed_view_mut::<3, 3>(3, 3);
        angular += dry.inertia;
        let inverse_mass = whole.try_inverse().ok_or(Error::UnphysicalAddedMass)?;
        let coupling = constants.added_mass.coupling.norm();
        let turn = constants.axes.inverse().matrix()
            * whole.fixed_view::<3, 3>(3, 3)
            * constants.axes.matrix();
        let route = Route {
            symmetric: constants.symmetric,
            law: match law {
                LawLanes::Inviscid => 0,
                LawLanes::Plate(_) => 1,
                LawLanes::Physical(_) => 2,
                LawLanes::Thesis(_) => 3,
                LawLanes::Stochastic(_) => 4,
            },
        };
        let scales = Scales {
            length,
            per_mass: 1.0 / mass,
            per_mass_length: 1.0 / (mass * length),
            dry_mass: dry.mass / mass,
            displaced_mass: constants.displaced_mass / mass,
            arm_x: arm.x,
            arm_y: arm.y,
            arm_z: arm.z,
            turn_xx: turn[(0, 0)],
            turn_xy: turn[(0, 1)],
            turn_xz: turn[(0, 2)],
            turn_yy: turn[(1, 1)],
            turn_yz: turn[(1, 2)],
            turn_zz: turn[(2, 2)],
        };
        Ok(Self {
            description,
            inertia: InertiaConstants::from_f64(&constants.inertia),
            law,
            scales: Scales::from_f64(&scales),
            axes: to_rotation(UnitQuaternion::from_rotation_matrix(&constants.axes)),
            route,
            buoyancy_turns: arm.amax() > 1e-7,
            heavy_fluid: constants.added_mass.linear.symmetric_eigenvalues().max() > 0.5 * dry.mass,
            inverse_mass,
            coupled: coupling > 1e-6 * mass * length,
            constants,
        })
    }

    /// What rapier is given: the scalar mass it can use, and I + ρA₂₂.
    pub fn wet(&self, mass: f64) -> DryMass {
        let dry = &self.constants.dry;
        DryMass {
            mass,
            center: dry.center,
            inertia: dry.inertia + self.constants.added_mass.angular,
        }
    }

    /// The torque that causes in rapier, whose inertia tensor is `rapier`'s, what `torque` would
    /// cause with the right one. World axes; `attitude` maps the body's frame to the world.
    pub fn torque_for(
        &self,
        rapier: &MassProperties,
        attitude: Rotation,
        torque: Vector,
    ) -> Vector {
        let rotation = to_quaternion(attitude);
        let torque = rotation.inverse() * to_f64(torque);
        let right = self.wet(1.0).inertia;
        let acceleration = right
            .try_inverse()
            .map_or(torque * 0.0, |inverse| inverse * torque);
        let theirs = super::from_rapier::inertia(rapier);
        to_real(rotation * (theirs * acceleration))
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
