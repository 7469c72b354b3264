//! What equal bodies in the same fluid share at run time.

use super::body_mass::BodyMass;
use crate::body::from_rapier::inertia;
use crate::body::{DryMass, ImmersedBody, Thruster};
use crate::dynamics::constants::{BodyConstants, InertiaConstants};
use crate::dynamics::crossing::CrossingConstants;
use crate::dynamics::flow_response::FlowResponse;
use crate::dynamics::part_constants::PartConstants;
use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::part_law::place::CoupledMass;
use crate::hydro::viscous::{LawKind, PreparedLaw};
use crate::interning::{Content, Interned};
use crate::math::spatial::transform;
use crate::math::{Lanes, Scalar, scalar_struct, to_f64, to_quaternion, to_real, to_rotation};
use crate::medium::Medium;
use fearless_simd::Simd;
use rapier3d::dynamics::MassProperties;
use rapier3d::math::{Rotation, Vector};
use rapier3d::na::{Matrix3, Matrix6, UnitQuaternion, Vector3};
use std::hash::{DefaultHasher, Hasher};
use std::sync::Arc;

/// What a step needs of a body's constants: `f32`, or [`Lanes`] of it.
#[derive(Clone, Debug)]
pub(super) struct StepConstants<T> {
    pub inertia: InertiaConstants<T>,
    pub law: PreparedLaw<T>,
    pub scales: Scales<T>,
    pub flow_response: FlowResponse<T>,
}

impl StepConstants<f32> {
    /// Whether every constant is a finite number.
    fn is_finite(&self) -> bool {
        self.inertia.is_finite()
            && self.law.is_finite()
            && self.scales.is_finite()
            && self.flow_response.is_finite()
    }
}

impl<S: Simd> StepConstants<Lanes<S>> {
    /// The same constants in every lane.
    #[inline(always)]
    pub fn splat(simd: S, constants: &StepConstants<f32>) -> Self {
        Self {
            inertia: InertiaConstants::splat(simd, &constants.inertia),
            law: PreparedLaw::splat(simd, &constants.law),
            scales: Scales::splat(simd, &constants.scales),
            flow_response: FlowResponse::splat(simd, &constants.flow_response),
        }
    }

    /// The constants of one body in each lane, all of one [`Route`]. Where nothing flows (`flows` is
    /// false) the response to the flow is the first body's in all lanes: gathering costs, and nobody asks
    /// for it.
    #[inline(always)]
    pub fn gather<'a>(simd: S, flows: bool, of: impl Fn(usize) -> &'a StepConstants<f32>) -> Self {
        let flow_response = if flows {
            FlowResponse::gather(simd, |lane| &of(lane).flow_response)
        } else {
            FlowResponse::splat(simd, &of(0).flow_response)
        };
        Self {
            flow_response,
            inertia: InertiaConstants::gather(simd, |lane| &of(lane).inertia),
            law: PreparedLaw::gather(simd, |lane| &of(lane).law),
            scales: Scales::gather(simd, |lane| &of(lane).scales),
        }
    }
}

scalar_struct! {
    /// How forces and lengths of the world scale to those of the integrator.
    pub(super) struct Scales<T> {
        /// L, m.
        length: T,
        /// 1/mass scale, 1/kg.
        per_mass: T,
        /// 1/(mass scale · L).
        per_mass_length: T,
        /// Body's own mass over the mass scale.
        dry_mass: T,
        /// Displaced mass over the mass scale.
        displaced_mass: T,
        /// Center of mass to center of buoyancy, plate axes, in L.
        buoyancy_arm: Vector3<T>,
        /// Rotational inertia that rapier is given, I + ρA₂₂, plate axes, kg·m².
        rapier_inertia: Matrix3<T>,
    }
}

impl<T: Scalar> Scales<T> {
    /// Torque that causes an angular acceleration in rapier, plate axes.
    #[inline(always)]
    pub fn torque_for(&self, acceleration: &Vector3<T>) -> Vector3<T> {
        transform(&self.rapier_inertia, acceleration)
    }
}

/// Which code a body takes through the step. Bodies of one route are advanced side by side, so that
/// what happens to one never depends on who its neighbours are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Route {
    /// See [`BodyConstants::symmetric`]; not asked of bodies of parts.
    pub symmetric: bool,
    /// The law of the whole; `None` for a body of parts, which have laws of their own.
    law: Option<LawKind>,
    /// Whether a boundary of fluids cuts the body.
    pub crossing: bool,
}

impl Route {
    /// Number of routes.
    pub const COUNT: usize = 2 * LawKind::ALL.len() + 2;

    /// That of bodies of parts.
    const PARTS: Self = Self {
        symmetric: false,
        law: None,
        crossing: false,
    };

    /// That of bodies that a boundary of fluids cuts.
    pub const CROSSING: Self = Self {
        symmetric: false,
        law: None,
        crossing: true,
    };

    /// All routes, in the order of their indices.
    pub fn all() -> impl Iterator<Item = Self> {
        let of_law = |law: &LawKind| [false, true].map(|symmetric| (symmetric, *law));
        let all = LawKind::ALL.iter().flat_map(of_law);
        let all = all.map(|(symmetric, law)| Self {
            symmetric,
            law: Some(law),
            crossing: false,
        });
        all.chain([Self::PARTS, Self::CROSSING])
    }

    /// Index among all routes, less than [`COUNT`](Self::COUNT).
    pub fn index(self) -> usize {
        match self.law {
            Some(law) => 2 * law as usize + usize::from(self.symmetric),
            None => Self::COUNT - 2 + usize::from(self.crossing),
        }
    }

    /// Whether it is that of bodies of parts.
    pub fn has_parts(self) -> bool {
        self.law.is_none()
    }
}

/// One description with one set of mass properties in one fluid.
#[derive(Clone, Debug)]
pub(super) struct SharedConstants {
    /// What pushes it by itself.
    pub thrusters: Arc<[Thruster]>,
    pub constants: BodyConstants,
    pub step: StepConstants<f32>,
    /// Plate axes to the body's frame.
    pub axes: Rotation,
    pub route: Route,
    /// Whether buoyancy has a torque.
    pub buoyancy_turns: bool,
    /// Whether some motion drags more than half of the body's own mass along.
    pub heavy_fluid: bool,
    /// Inertia of body and fluid, where the body is whole in it.
    pub mass: BodyMass,
    /// The parts, if there is more than the whole, and the added mass that couples.
    pub parts: Vec<PartConstants<f32>>,
    pub coupled_mass: CoupledMass<f32>,
    /// What rapier is given while nothing touches the body.
    free: MassProperties,
}

impl SharedConstants {
    /// # Errors
    /// Those of [`BodyConstants::new`]; [`Error::BeyondSinglePrecision`].
    fn new(
        body: &ImmersedBody,
        thrusters: &Arc<[Thruster]>,
        dry: &DryMass,
        fluid: &Fluid,
    ) -> Result<Self, Error> {
        let constants = BodyConstants::new(body, dry, fluid)?;
        let (mass, length) = (constants.mass, constants.length);
        let arm = constants.axes.inverse() * constants.buoyancy_arm / length;
        let whole = constants.mass_matrix();
        // Whether a push at the center of mass turns the body: A₁₂ ≠ 0.
        let coupled = constants.added_mass.coupling.norm() > 1e-6 * mass * length;
        let with_fluid = BodyMass::of(whole, coupled).ok_or(Error::UnphysicalAddedMass)?;
        let turn = constants.axes.inverse().matrix()
            * whole.fixed_view::<3, 3>(3, 3)
            * constants.axes.matrix();
        let route = if constants.parts.is_empty() {
            Route {
                symmetric: constants.symmetric,
                law: Some(constants.law.kind()),
                crossing: false,
            }
        } else {
            Route::PARTS
        };
        let scales = Scales {
            length,
            per_mass: 1.0 / mass,
            per_mass_length: 1.0 / (mass * length),
            dry_mass: dry.mass / mass,
            displaced_mass: constants.displaced_mass / mass,
            buoyancy_arm: arm,
            rapier_inertia: Matrix3::from_fn(|i, j| turn[(i.min(j), i.max(j))]),
        };
        let flow_response = FlowResponse::new(&constants, &with_fluid.inverse);
        let parts: Vec<_> = constants.parts.iter().map(PartConstants::rounded).collect();
        let coupled_mass = constants.coupled.rounded();
        let step = StepConstants {
            inertia: constants.inertia.rounded(),
            law: constants.law.rounded(),
            scales: scales.rounded(),
            flow_response: flow_response.rounded(),
        };
        let finite = parts.iter().all(PartConstants::is_finite) && coupled_mass.is_finite();
        if !(step.is_finite() && finite) {
            return Err(Error::BeyondSinglePrecision { mass, length });
        }
        Ok(Self {
            free: wet(&constants, dry.mass).to_mass_properties(),
            thrusters: thrusters.clone(),
            parts,
            coupled_mass,
            step,
            axes: to_rotation(UnitQuaternion::from_rotation_matrix(&constants.axes)),
            route,
            buoyancy_turns: arm.amax() > 1e-7,
            heavy_fluid: constants.added_mass.linear.symmetric_eigenvalues().max() > 0.5 * dry.mass,
            mass: with_fluid,
            constants,
        })
    }

    /// The 6×6 mass of body and fluid about the center of mass, body axes.
    pub fn mass_matrix(&self) -> Matrix6<f64> {
        self.constants.mass_matrix()
    }

    /// What rapier is given: the scalar mass it can use, and I + ρA₂₂.
    pub fn wet(&self, mass: f64) -> DryMass {
        wet(&self.constants, mass)
    }

    /// The same as rapier's mass properties.
    pub fn rapier_properties(&self, mass: f64) -> MassProperties {
        let mut properties = self.free;
        if mass != self.constants.dry.mass {
            properties.inv_mass = if mass == 0.0 { 0.0 } else { 1.0 / mass as f32 };
        }
        properties
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
        let theirs = inertia(rapier);
        to_real(rotation * (theirs * acceleration))
    }
}

fn wet(constants: &BodyConstants, mass: f64) -> DryMass {
    let dry = &constants.dry;
    DryMass {
        mass,
        center: dry.center,
        inertia: dry.inertia + constants.added_mass.angular,
    }
}

/// One description with one set of mass properties in each fluid of a medium.
#[derive(Clone, Debug)]
struct InMedium {
    /// Index of the description, and the description.
    description: u32,
    body: ImmersedBody,
    /// In the uppermost fluid, and in the others.
    first: SharedConstants,
    others: Vec<SharedConstants>,
    /// What it needs where a boundary of fluids cuts it.
    crossing: Option<CrossingConstants>,
}

impl InMedium {
    fn new(
        description: u32,
        body: &ImmersedBody,
        dry: &DryMass,
        medium: &Medium,
    ) -> Result<Self, Error> {
        if medium.has_surface() {
            body.check_hulls()?;
        }
        let thrusters = body.thrusters.as_slice().into();
        let mut in_fluids = medium
            .fluids()
            .map(|fluid| SharedConstants::new(body, &thrusters, dry, fluid));
        // A medium has a fluid.
        let first = in_fluids.next();
        let first = first.unwrap_or(Err(Error::UnphysicalAddedMass))?;
        Ok(Self {
            description,
            body: body.clone(),
            others: in_fluids.collect::<Result<_, _>>()?,
            crossing: CrossingConstants::new(body, dry, medium, &first.constants),
            first,
        })
    }

    /// Whether a body of this description and mass would share them. An index may have been given to
    /// another description since, so that the description itself is compared, too.
    fn is(&self, description: u32, body: &ImmersedBody, dry: &DryMass) -> bool {
        self.description == description && self.first.constants.dry == *dry && self.body == *body
    }
}

impl Content for InMedium {
    fn hash_content(&self, hasher: &mut DefaultHasher) {
        hash_key(self.description, &self.first.constants.dry, hasher);
    }
}

fn hash_key(description: u32, dry: &DryMass, hasher: &mut DefaultHasher) {
    hasher.write_u32(description);
    dry.hash_content(hasher);
}

/// Bits of an index that tell bodies apart; those above are the layer of the medium.
const PLACE_BITS: u32 = 28;

/// The layer of the medium whose constants an index is that of.
#[inline(always)]
pub(super) fn layer_of(index: u32) -> usize {
    (index >> PLACE_BITS) as usize
}

/// The index of the constants of the same body in another layer.
#[inline(always)]
pub(super) fn in_layer(index: u32, layer: usize) -> u32 {
    index & ((1 << PLACE_BITS) - 1) | (layer as u32) << PLACE_BITS
}

/// The constants of all bodies that are in the medium, equal ones once.
#[derive(Clone, Debug, Default)]
pub(super) struct ConstantsTable {
    entries: Interned<InMedium>,
    /// Whether one of them drags much fluid along.
    pub heavy_fluid: bool,
}

impl ConstantsTable {
    /// Index of the constants of a body with this description and mass in the uppermost fluid, which are made if
    /// there are none yet. `used` gives the indices that are in use.
    ///
    /// # Errors
    /// Those of [`SharedConstants::new`].
    pub fn intern<U: IntoIterator<Item = u32>>(
        &mut self,
        description: u32,
        body: &ImmersedBody,
        dry: &DryMass,
        medium: &Medium,
        used: impl FnOnce() -> U,
    ) -> Result<u32, Error> {
        let mut hasher = DefaultHasher::new();
        hash_key(description, dry, &mut hasher);
        let is = |known: &InMedium| known.is(description, body, dry);
        if let Some(place) = self.entries.find(hasher.finish(), is) {
            return Ok(place);
        }
        let constants = InMedium::new(description, body, dry, medium)?;
        let mut all = std::iter::once(&constants.first).chain(&constants.others);
        self.heavy_fluid |= all.any(|shared| shared.heavy_fluid);
        let places = || used().into_iter().map(|index| in_layer(index, 0));
        Ok(self.entries.add(constants, places))
    }

    /// The constants at an index that [`ConstantsTable::intern`] has returned, or at that of another layer, as long
    /// as it is in use.
    #[inline(always)]
    pub fn get(&self, index: u32) -> Option<&SharedConstants> {
        let entry = self.entries.get(in_layer(index, 0))?;
        match layer_of(index) {
            0 => Some(&entry.first),
            layer => entry.others.get(layer - 1),
        }
    }

    /// What a body needs where a boundary of fluids cuts it; `None` in a single fluid.
    #[inline(always)]
    pub fn crossing(&self, index: u32) -> Option<&CrossingConstants> {
        self.entries.get(in_layer(index, 0))?.crossing.as_ref()
    }

    /// Forgets all, as when the medium has changed.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}
