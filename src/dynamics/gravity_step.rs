//! The first part of the thesis's fractional step (§4.3.2): weight and buoyancy act before the turbulence.

use super::constants::BodyConstants;
use crate::math::spatial::{Twist, Wrench};
use rapier3d::na::{Matrix6, UnitQuaternion, Vector3, Vector6};

/// What weight and buoyancy do in a step to a body that is whole in its fluid. World axes.
pub(crate) struct GravityStep {
    /// Changes of the velocities, m/s and rad/s.
    pub change: Twist<f64>,
    /// Weight and buoyancy, N, and their torque about the center of mass, N·m.
    pub load: Wrench<f64>,
}

impl GravityStep {
    /// `𝕄⁻¹ (F_g, Γ_g) dt`, thesis (4.5) and (4.6) with their signs corrected. `attitude` maps plate axes to the world;
    /// the inverse is that of the [`mass_matrix`](BodyConstants::mass_matrix).
    pub fn of(
        constants: &BodyConstants,
        inverse_mass: &Matrix6<f64>,
        attitude: UnitQuaternion<f64>,
        gravity: Vector3<f64>,
        dt: f64,
    ) -> Self {
        let body = attitude * constants.axes.inverse();
        let gravity = body.inverse() * gravity;
        let force = gravity * (constants.dry.mass - constants.displaced_mass);
        let torque = constants
            .buoyancy_arm
            .cross(&(gravity * -constants.displaced_mass));
        let load = Vector6::from_iterator(force.iter().chain(&torque).copied());
        let change = inverse_mass * load * dt;
        let world = |part: usize| body * change.fixed_rows::<3>(part).into_owned();
        Self {
            change: Twist {
                linear: world(0),
                angular: world(3),
            },
            load: Wrench {
                force: body * force,
                torque: body * torque,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{DryMass, ImmersedBody};
    use crate::fluid::Fluid;
    use crate::hydro::HydroProperties;
    use rapier3d::geometry::SharedShape;
    use rapier3d::na::Matrix3;

    /// A ball in water whose center of mass is a third of its radius off its center, along its own x, which is turned: the
    /// buoyancy at the center turns the heavy end down, with `ρVg × the lever` by hand, and the impulse of force and torque
    /// is the mass matrix times the change.
    #[test]
    fn buoyancy_turns_the_heavy_end_down() {
        let (radius, dt) = (0.1, 0.01);
        let ball = SharedShape::ball(radius);
        let hydro = HydroProperties::from_shape(ball.as_ref()).unwrap();
        let displaced = f64::from(Fluid::WATER.density()) * hydro.volume;
        let lever = f64::from(radius) / 3.0;
        let dry = DryMass {
            mass: 2.0 * displaced,
            center: Vector3::x() * lever,
            inertia: Matrix3::identity() * 0.05,
        };
        let body = ImmersedBody::new(hydro);
        let constants = BodyConstants::new(&body, &dry, &Fluid::WATER).unwrap();
        let mass = constants.mass_matrix();
        let inverse = mass.try_inverse().unwrap();
        // The body's x points along the world's z.
        let frame = UnitQuaternion::from_scaled_axis(Vector3::y() * -std::f64::consts::FRAC_PI_2);
        let gravity = Vector3::y() * -9.81;
        let attitude = frame * constants.axes;
        let step = GravityStep::of(&constants, &inverse, attitude, gravity, dt);
        let force = Vector3::y() * (displaced - dry.mass) * 9.81;
        // From the heavy end, at +z, back to the center, where buoyancy pulls up: r × F = −z × y = +x.
        let torque = Vector3::x() * (lever * displaced * 9.81);
        assert!((step.load.force - force).norm() < 1e-5 * force.norm());
        assert!(
            (step.load.torque - torque).norm() < 1e-5 * torque.norm(),
            "{}",
            step.load.torque
        );
        let back = frame.inverse();
        let (linear, angular) = (back * step.change.linear, back * step.change.angular);
        let change = Vector6::from_iterator(linear.iter().chain(&angular).copied());
        let (force, torque) = (back * force * dt, back * torque * dt);
        let impulse = Vector6::from_iterator(force.iter().chain(&torque).copied());
        assert!((mass * change - impulse).norm() < 1e-5 * impulse.norm());
    }
}
