//! What a body that is cut by a boundary of fluids keeps from step to step.

use crate::dynamics::constants::BodyConstants;
use crate::dynamics::crossing::{FluidMass, Portion};
use crate::dynamics::parts::PartNow;
use rapier3d::math::{Real, Vector};
use rapier3d::na::{Matrix3, Vector3};

/// The memory of one body. It is made when the body enters a medium of several fluids, so that no step has to.
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct CrossingMemory {
    /// Whether the body was cut in the last step: if not, nothing of the rest counts.
    pub active: bool,
    /// The first of the layers that it was in.
    pub first: u8,
    /// Its inertia with the fluids when it was last cut.
    pub mass: FluidMass,
    /// Where its center of mass shall be after the step, world axes: elsewhere its user has put it.
    pub place: Vector,
    /// The energy that it had at the beginning of the last step, J, and the gravity that this counts on, m/s²;
    /// `None` if other than fluids at rest acted on it.
    pub energy: Option<(f64, Vector)>,
    /// Share of its volume under the free surface.
    pub submerged: Real,
    /// Whether it is as good as at rest, in the world where fluids move, and in balance besides.
    pub slow: bool,
    pub balanced: bool,
    /// What of each part was in each layer, layer by layer, and the velocity of the fluid there, world axes, m/s.
    pub portions: Vec<Portion>,
    pub velocities: Vec<Vector3<f64>>,
    /// What goes on at each part in each layer, and how each layer's fluid accelerates: memory of a step.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub now: Vec<PartNow<f64>>,
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub accelerations: Vec<Vector3<f64>>,
}

impl Default for CrossingMemory {
    fn default() -> Self {
        Self {
            active: false,
            first: 0,
            mass: FluidMass::dry(0.0, Matrix3::zeros()),
            place: Vector::ZERO,
            energy: None,
            submerged: 0.0,
            slow: false,
            balanced: false,
            portions: Vec::new(),
            velocities: Vec::new(),
            now: Vec::new(),
            accelerations: Vec::new(),
        }
    }
}

impl CrossingMemory {
    /// What of a part was in a layer, and the velocity of the fluid there; `None` if the part was not cut there.
    pub fn before(
        &self,
        layer: usize,
        part: usize,
        parts: usize,
    ) -> Option<(Portion, Vector3<f64>)> {
        let number = layer.checked_sub(self.first.into())?;
        let index = number * parts + part;
        let portion = self.portions.get(index)?;
        let known = self.active && portion.share > 0.0;
        known.then_some((*portion, *self.velocities.get(index)?))
    }

    /// A body at a place that was whole in a layer, where these were its constants, gets into another.
    pub fn enter_from(&mut self, constants: &BodyConstants, layer: usize, place: Vector) {
        let to_plate = constants.axes.inverse();
        let added = constants.added_mass.rotated(&to_plate);
        let dry = &constants.dry;
        let inertia = to_plate.matrix() * dry.inertia * constants.axes.matrix();
        let mut mass = FluidMass::dry(dry.mass, inertia);
        mass.add(&added, 1.0, Vector3::zeros());
        *self = Self {
            active: true,
            first: layer as u8,
            mass,
            place,
            energy: None,
            submerged: if layer == 0 { 0.0 } else { 1.0 },
            slow: false,
            balanced: false,
            portions: std::mem::take(&mut self.portions),
            velocities: std::mem::take(&mut self.velocities),
            now: std::mem::take(&mut self.now),
            accelerations: std::mem::take(&mut self.accelerations),
        };
        self.portions.clear();
        self.velocities.clear();
    }

    /// Whether every number can be.
    #[cfg(feature = "serde-serialize")]
    pub fn is_valid(&self) -> bool {
        let portion =
            |own: &Portion| own.share.is_finite() && own.shift.iter().all(|x| x.is_finite());
        self.mass.is_finite()
            && self.submerged.is_finite()
            && self.place.is_finite()
            && self.portions.iter().all(portion)
            && self.velocities.iter().flatten().all(|x| x.is_finite())
    }
}
