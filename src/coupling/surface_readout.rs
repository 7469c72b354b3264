//! What is read out of a body in a medium of several fluids.

use super::body_state::BodyState;
use super::environment::Environment;
use super::equipment::PartState;
use super::shared_constants::ConstantsTable;
use crate::dynamics::ForceBreakdown;
use crate::dynamics::crossing::{CrossingConstants, Cut, Hydrostatics, Place};
use crate::dynamics::forces::Instant;
use crate::dynamics::parts::PartNow;
use crate::math::spatial::Twist;
use crate::math::{to_f64, to_quaternion, to_real, vector};
use rapier3d::dynamics::RigidBody;
use rapier3d::na::{Rotation3, UnitQuaternion};

/// A body among the layers of its medium now.
pub(super) struct AmongLayers<'a> {
    constants: &'a CrossingConstants,
    state: &'a BodyState,
    environment: &'a Environment,
    body: &'a RigidBody,
    cut: Cut<'a>,
    place: Place,
    level: Rotation3<f64>,
    attitude: UnitQuaternion<f64>,
}

impl<'a> AmongLayers<'a> {
    /// `None` in a single fluid, and for a body that is not immersed.
    pub fn of(
        state: &'a BodyState,
        constants: &'a ConstantsTable,
        environment: &'a Environment,
        body: &'a RigidBody,
    ) -> Option<Self> {
        state.saved.as_ref()?;
        let crossing = constants.crossing(state.constants)?;
        let medium = &environment.medium;
        let (center, radius) = (body.center_of_mass(), crossing.whole.radius as f32);
        let (first, last) = medium.layers_within(center, radius, 0.0, environment.time);
        let axes = &constants.get(state.constants)?.constants.axes;
        let attitude = to_quaternion(*body.rotation()) * UnitQuaternion::from_rotation_matrix(axes);
        let level = medium.axes();
        Some(Self {
            constants: crossing,
            state,
            environment,
            body,
            cut: Cut {
                medium,
                time: environment.time,
                first,
                count: last + 1 - first,
            },
            place: Place::new(medium.to_level(&level, center), &attitude, &level),
            level,
            attitude,
        })
    }

    /// The uppermost that the body may be in.
    pub fn first(&self) -> usize {
        self.cut.first
    }

    /// Whether the body may be in more than one.
    pub fn is_cut(&self) -> bool {
        self.cut.count > 1
    }

    pub fn hydrostatics(&self) -> Hydrostatics {
        let origin = self.environment.medium.level();
        Hydrostatics::of(self.constants, &self.cut, &self.place, &self.level, origin)
    }

    /// The forces on the body, or on one of its parts.
    pub fn forces(&self, part: Option<usize>) -> ForceBreakdown {
        let (c, state, body) = (self.constants, self.state, self.body);
        let center = body.center_of_mass();
        let frame = self.environment.mean_flow(self.cut.first, center).velocity;
        let parts = c.part_count();
        let rows = (0..self.cut.count * parts).map(|index| {
            let (layer, i) = (self.cut.first + index / parts, index % parts);
            let none = PartState::default();
            let equipment = state.equipment.as_ref();
            let own = equipment
                .and_then(|known| known.parts.get(i))
                .unwrap_or(&none);
            let of_part = c.parts.get(i).unwrap_or(&c.whole);
            let at = center + to_real(self.attitude * of_part.middle);
            let seen = self.environment.mean_flow(layer, at);
            let control = state.control.factors;
            let mut factors = own.factors;
            factors.drag *= control.drag;
            factors.rotational_lift *= control.rotational_lift;
            factors.translational_lift *= control.translational_lift;
            PartNow {
                velocity: to_f64(seen.velocity - frame),
                spin: to_f64(seen.vorticity) * (0.5 * c.length),
                factors: factors.into(),
                ..PartNow::at_rest(own.deflection.into())
            }
        });
        let plate_axes = |row| to_f64(vector(row));
        let motion = &state.flight.motion;
        let back = self.attitude.inverse();
        let now = Instant {
            attitude: self.attitude,
            velocity: Twist {
                linear: back * to_f64(body.linvel() - frame),
                angular: back * to_f64(body.angvel()) * c.length,
            },
            rate: Twist {
                linear: plate_axes(motion.linear_rate),
                angular: plate_axes(motion.angular_rate),
            },
            gravity: to_f64(self.environment.gravity * body.gravity_scale()),
            parts: rows.collect(),
        };
        let mut found = c.forces(&self.cut, &self.place, &self.level, &now, part);
        if part.is_none()
            && let Some(equipment) = &state.equipment
        {
            found.thrust = equipment.thrust;
            found.buoyancy = found.buoyancy + equipment.buoyancy;
        }
        found
    }
}
