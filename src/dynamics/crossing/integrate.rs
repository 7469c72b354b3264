//! One step of a body that boundaries of fluids cut.

use super::constants::CrossingConstants;
use super::cut::{Cut, Place, Wetted};
use super::portion::Portion;
use super::reaction::{Fluids, coupled_mass};
use super::transfer::FluidMass;
use crate::dynamics::constants::InertiaConstants;
use crate::dynamics::integrate::{Motion, keep_finite, substep, substeps};
use crate::dynamics::integrator::Integrator;
use crate::dynamics::load::Load;
use crate::dynamics::locked::Locks;
use crate::dynamics::parts::PartNow;
use crate::math::spatial::{Blocks, Wrench, norm};
use rapier3d::na::{Rotation3, UnitQuaternion, Vector3};

/// Substeps that a crossing alone asks for at most: what goes under faster is an impact.
const MOST_SUBSTEPS: f64 = 8.0;
/// Damping of heave by the waves that a body makes, over the critical one: of a half sunk sphere at its own frequency
/// (about; Hulme, *J. Fluid Mech.* 121, 443 (1982) tabulates it, and was not at hand).
const RADIATION: f64 = 0.1;
/// Share of its height that a body moves by in a step that is looked at again.
const LIVELY: f64 = 0.05;
/// Share of its height that a body shall move up or down in a substep.
const TRAVEL: f64 = 0.5;

/// A step of one body. World axes unless said otherwise.
pub(crate) struct CrossingStep<'a> {
    pub constants: &'a CrossingConstants,
    /// The medium at the beginning of the step.
    pub cut: Cut<'a>,
    /// Level axes to world axes.
    pub level: &'a Rotation3<f64>,
    /// Center of mass at the beginning, level axes, m.
    pub center: Vector3<f64>,
    /// Velocity of the fluid that the motion is counted relative to, m/s.
    pub fluid_velocity: Vector3<f64>,
    /// What goes on at each part in each layer, layer by layer, relative to that.
    pub now: &'a [PartNow<f64>],
    /// Acceleration of each layer's fluid, m/s².
    pub accelerations: &'a [Vector3<f64>],
    /// Gravity, m/s², and the user's force, N, and torque, N·m.
    pub gravity: Vector3<f64>,
    pub force: Vector3<f64>,
    pub torque: Vector3<f64>,
    pub locks: Locks<f64>,
    pub dt: f64,
    pub integrator: Integrator,
    /// Inertia with the fluids when the body was last cut.
    pub mass_before: Option<FluidMass>,
    /// The energy that the body had then, if nothing but fluids at rest acts on it.
    pub energy_before: Option<f64>,
}

/// What becomes of it.
pub(crate) struct Moved {
    pub substeps: f64,
    /// How the body was cut in the first and in the last substep.
    pub first: Wetted,
    pub mass: FluidMass,
    /// Energy at the beginning of the step, J.
    pub energy: f64,
    /// Weight, buoyancy and the pressure of accelerating fluids in the first substep, N and N·m about the center of
    /// mass.
    pub load: Wrench<f64>,
    /// How high the body was then, m, and how stiffly the surface held it against heave, N/m, and against a tilt in its
    /// softest direction, N·m.
    pub height: f64,
    pub heave_stiffness: f64,
    pub tilt_stiffness: f64,
}

impl CrossingStep<'_> {
    /// Advances the motion by the step. `portions` is memory, and has what of the body is in which layer in the last
    /// substep.
    pub fn advance(&self, motion: &mut Motion<f64>, portions: &mut Vec<Portion>) -> Moved {
        let start = *motion;
        let up = self.level * Vector3::y();
        // Buoyancy goes up, whatever else gravity does.
        let gravity = -self.gravity.dot(&up);
        let mut mass = self.mass_before;
        let mut first = None;
        let (mut count, mut done) = (1.0, 0.0);
        let (mut energy, mut first_height) = (0.0, 0.0);
        let mut first_load = Wrench {
            force: Vector3::zeros(),
            torque: Vector3::zeros(),
        };
        while done < count {
            let guess = self.dt / count;
            let place = self.place(motion, done * guess);
            // The surface moves with the fluid that the motion is counted relative to: where the body is now, and in
            // between, it is where it is now.
            let cut = Cut {
                time: self.cut.time + done * guess,
                ..self.cut
            };
            let wetted = cut.cut(self.constants, &place, portions);
            let height = self.height(&place);
            let rise = (place.turn * motion.velocity.linear).y;
            self.change_mass(mass, &wetted.mass, motion, rise, gravity * height);
            mass = Some(wetted.mass);
            let load = self.load(&wetted, &place, gravity, up, portions);
            let inertia = self.inertia(&wetted.mass);
            if first.is_none() {
                let before = self.energy_before;
                energy = self.hold_energy(before, &wetted, &place, gravity, motion);
                first_load = self.act(&load, motion);
                first_height = height;
                let wanted = substeps(&inertia, motion, &load, self.dt, &self.integrator);
                let rise = (place.turn * motion.velocity.linear).y;
                let crossing = (rise.abs() * self.dt / (TRAVEL * height)).ceil();
                let most = f64::from(self.integrator.max_substeps.max(1)).min(MOST_SUBSTEPS);
                count = wanted.max(crossing.min(most)).max(1.0);
                first = Some(wetted);
            }
            let h = self.dt / count;
            let fluids = &self.constants.fluids[self.cut.first..][..self.cut.count];
            let parts = self.constants.part_count();
            let in_layers = portions.chunks(parts).zip(fluids);
            let in_layers = in_layers.map(|(own, fluid)| (self.constants.of_body(own), fluid));
            let stiffness = self.stiffness(&wetted, &place, gravity, rise, h);
            let reaction = Fluids {
                fluids,
                portions,
                now: self.now,
                length: self.constants.length,
                coupled: coupled_mass(in_layers, self.constants.length),
                radiation: self.constants.radiation(&stiffness, &wetted.mass),
                stiffness,
            };
            let iterations = self.integrator.iterations;
            substep::<false, _, _>(&inertia, &reaction, &load, motion, h, iterations);
            done += 1.0;
        }
        keep_finite(&start, motion, self.dt);
        // What moves far through a boundary in a step is looked at once more at its end: a stiffness that was taken where
        // the body was is not that of where it is.
        let moved_far = norm(&motion.displacement) > LIVELY * first_height
            || norm(&motion.velocity.angular) * self.dt > LIVELY * first_height;
        if self.energy_before.is_some() && moved_far {
            let place = self.place(motion, self.dt);
            let cut = Cut {
                time: self.cut.time + self.dt,
                ..self.cut
            };
            let wetted = cut.cut(self.constants, &place, portions);
            let rise = (place.turn * motion.velocity.linear).y;
            let square_of_wave = gravity * self.height(&place);
            self.change_mass(mass, &wetted.mass, motion, rise, square_of_wave);
            mass = Some(wetted.mass);
            energy = self.hold_energy(Some(energy), &wetted, &place, gravity, motion);
        }
        let dry = FluidMass::dry(self.constants.dry_mass, self.constants.dry_inertia);
        let first = first.unwrap_or_else(|| Wetted::nothing(dry));
        let [xx, xz, zz] = first.waterplane.second;
        Moved {
            substeps: count,
            heave_stiffness: gravity * first.waterplane.area,
            // A bound from below on the smaller eigenvalue.
            tilt_stiffness: gravity * (xx.min(zz) - xz.abs()),
            first,
            mass: mass.unwrap_or(dry),
            energy,
            load: first_load,
            height: first_height,
        }
    }

    /// Where the body is some time after the beginning.
    fn place(&self, motion: &Motion<f64>, time: f64) -> Place {
        let moved = motion.displacement + self.fluid_velocity * time;
        let center = self.center + self.level.inverse() * moved;
        let attitude = UnitQuaternion::new_normalize(motion.attitude);
        Place::new(center, &attitude, self.level)
    }

    /// How high the body is, m.
    fn height(&self, place: &Place) -> f64 {
        let up = place.turn.row(1).transpose();
        2.0 * up.component_mul(&self.constants.semi_axes).norm()
    }

    /// What the change of the added mass since the body was last cut does to its velocity.
    fn change_mass(
        &self,
        before: Option<FluidMass>,
        now: &FluidMass,
        motion: &mut Motion<f64>,
        rise: f64,
        square_of_wave: f64,
    ) {
        let Some(before) = before else {
            return;
        };
        let length = self.constants.length;
        let mut velocity = motion.velocity;
        velocity.angular /= length;
        let froude = if square_of_wave > 0.0 {
            rise.abs() / square_of_wave.sqrt()
        } else {
            f64::INFINITY
        };
        let after = before.transfer(now, &velocity, froude);
        motion.velocity.linear = after.linear;
        motion.velocity.angular = after.angular * length;
    }

    /// The energy of body and fluids, J. Where it has grown since the body was last cut, and nothing but fluids at rest
    /// acts on it, as much is taken from the motion.
    fn hold_energy(
        &self,
        before: Option<f64>,
        wetted: &Wetted,
        place: &Place,
        gravity: f64,
        motion: &mut Motion<f64>,
    ) -> f64 {
        let mut velocity = motion.velocity;
        velocity.angular /= self.constants.length;
        let kinetic = wetted.mass.energy(&velocity);
        // Gravity that is off the medium's up works along the level, too.
        let pull = self.level.inverse() * self.gravity;
        let weight = -pull.dot(&place.center) * self.constants.dry_mass;
        let potential = weight + gravity * wetted.potential;
        let energy = kinetic + potential;
        match before {
            Some(before) if energy > before && kinetic > 0.0 => {
                let left = (kinetic - (energy - before)).max(0.0);
                motion.velocity = motion.velocity.scaled((left / kinetic).sqrt());
                potential + left
            }
            _ => energy,
        }
    }

    fn inertia(&self, mass: &FluidMass) -> InertiaConstants<f64> {
        let scaled = mass.scaled(self.constants.mass, self.constants.length);
        InertiaConstants {
            m11: scaled.linear,
            m12: scaled.coupling,
            m22: scaled.angular,
            per_m11: scaled.linear.diagonal().map(|m| 1.0 / m),
            per_m22: scaled.angular.diagonal().map(|m| 1.0 / m),
            ..self.constants.inertia
        }
    }

    /// Weight, buoyancy, the user's force and the pressure of accelerating fluids, in units of the integrator.
    fn load(
        &self,
        wetted: &Wetted,
        place: &Place,
        gravity: f64,
        up: Vector3<f64>,
        portions: &[Portion],
    ) -> Load<f64> {
        let c = self.constants;
        let buoyancy = up * (gravity * wetted.displaced_mass / c.mass);
        let mut arm = Vector3::zeros();
        if wetted.displaced_mass > 0.0 {
            arm = wetted.displaced_moment / (wetted.displaced_mass * c.length);
        }
        let mut force = self.gravity * c.dry_mass + self.force;
        let mut torque = self.torque;
        let fluids = c.fluids[self.cut.first..].iter();
        let parts = c.part_count();
        for ((acceleration, fluid), own) in self
            .accelerations
            .iter()
            .zip(fluids)
            .zip(portions.chunks(parts))
        {
            if *acceleration == Vector3::zeros() {
                continue;
            }
            let Portion { share, shift } = c.of_body(own);
            let (volume, middle) = (share * c.whole.volume, c.whole.middle + shift);
            let to_plate = place.turn.transpose() * self.level.inverse().matrix();
            let acceleration = to_plate * acceleration;
            let added = c.added_mass.about(-middle);
            let pushed =
                (added.linear * acceleration * share + acceleration * volume) * fluid.density;
            let turned = (added.coupling.transpose() * acceleration * share
                + middle.cross(&acceleration) * volume)
                * fluid.density;
            force += to_plate.transpose() * pushed;
            torque += to_plate.transpose() * turned;
        }
        Load {
            force: force / c.mass + buoyancy,
            torque: torque / (c.mass * c.length),
            buoyancy,
            buoyancy_arm: arm,
            fluid_spin: Vector3::zeros(),
            stretching: Vector3::zeros(),
            shearing: Vector3::zeros(),
            strain_response: Vector3::zeros(),
            turning: true,
            spinning: false,
            straining: false,
            locks: self.locks,
        }
    }

    /// A load in N and N·m, world axes.
    fn act(&self, load: &Load<f64>, motion: &Motion<f64>) -> Wrench<f64> {
        let applied = load.applied(&motion.attitude);
        let attitude = UnitQuaternion::new_normalize(motion.attitude);
        Wrench {
            force: attitude * applied.force * self.constants.mass,
            torque: attitude * applied.torque * (self.constants.mass * self.constants.length),
        }
    }

    /// The hydrostatic stiffness in units of the integrator, limited to what the body can still displace in a substep.
    fn stiffness(
        &self,
        wetted: &Wetted,
        place: &Place,
        gravity: f64,
        rise: f64,
        h: f64,
    ) -> Blocks<f64> {
        let room = wetted.room[usize::from(rise > 0.0)];
        let way = 0.5 * h * rise.abs() * wetted.waterplane.area;
        let gravity = gravity.max(0.0);
        let held = if way > room { room / way } else { 1.0 };
        self.constants.stiffness(wetted, place, gravity * held)
    }
}

impl CrossingConstants {
    /// The hydrostatic stiffness in units of the integrator.
    pub(super) fn stiffness(&self, wetted: &Wetted, place: &Place, gravity: f64) -> Blocks<f64> {
        let length = self.length;
        let k = wetted.stiffness(place, gravity / self.mass);
        Blocks {
            m11: k.m11,
            m12: k.m12 / length,
            m21: k.m21 / length,
            m22: k.m22 / (length * length),
        }
    }

    /// Damping over stiffness, s. Heave is damped by [`RADIATION`], slower motions less as their frequencies.
    pub(super) fn radiation(&self, stiffness: &Blocks<f64>, mass: &FluidMass) -> f64 {
        let heave = stiffness.m11.trace();
        if !self.radiates || heave <= 0.0 {
            return 0.0;
        }
        let mean = mass.linear.trace() / (3.0 * self.mass);
        2.0 * RADIATION * (mean / heave).sqrt()
    }
}
