//! Pushes that act on a body and on the fluid that it drags along.

use super::immersion::Immersion;
use crate::math::{to_f64, to_quaternion, to_real};
use rapier3d::dynamics::{LockedAxes, RigidBody, RigidBodyHandle, RigidBodySet};
use rapier3d::math::Vector;
use rapier3d::na::{Matrix6, Vector6};

/// The changes of a body's linear and angular velocity, world axes, when an impulse in N·s acts at `lever`
/// from its center of mass: `Δν = 𝕄⁻¹ (J, r × J)`, 𝕄 being the 6×6 mass of body and fluid in the body's axes. Along locked axes
/// nothing changes, whatever it takes.
pub(super) fn velocity_change(
    mass: &Matrix6<f64>,
    body: &RigidBody,
    impulse: Vector,
    lever: Vector,
) -> Option<(Vector, Vector)> {
    let rotation = to_quaternion(*body.rotation()).to_rotation_matrix();
    let mut turn = Matrix6::zeros();
    turn.fixed_view_mut::<3, 3>(0, 0)
        .copy_from(rotation.matrix());
    turn.fixed_view_mut::<3, 3>(3, 3)
        .copy_from(rotation.matrix());
    let mut mass = turn * mass * turn.transpose();
    let (linear, angular) = (to_f64(impulse), to_f64(lever).cross(&to_f64(impulse)));
    let mut push = Vector6::new(
        linear.x, linear.y, linear.z, angular.x, angular.y, angular.z,
    );
    let locks = body.locked_axes().bits();
    for axis in (0..6).filter(|axis| locks >> axis & 1 == 1) {
        mass.row_mut(axis).fill(0.0);
        mass.column_mut(axis).fill(0.0);
        mass[(axis, axis)] = 1.0;
        push[axis] = 0.0;
    }
    let change = mass.try_inverse()? * push;
    let part = |from| to_real(change.fixed_rows::<3>(from).into_owned());
    let (linear, angular): (Vector, Vector) = (part(0), part(3));
    (linear + angular).is_finite().then_some((linear, angular))
}

// The bits of rapier's locks are those of the rows: three of translation, three of rotation.
const _: () = assert!(LockedAxes::TRANSLATION_LOCKED_X.bits() == 1);
const _: () = assert!(LockedAxes::ROTATION_LOCKED_X.bits() == 8);

impl Immersion {
    /// Pushes a body at its center of mass with an impulse in N·s, world axes, that moves the fluid around it,
    /// too: its velocities change at once by `𝕄⁻¹ (J, 0)`, 𝕄 being [`Immersion::mass_matrix_of`]. Rapier's own
    /// `apply_impulse` pushes a body as if there were no fluid, by J/m: a plate that is pushed broadside on in
    /// water then gets many times the velocity that the impulse is good for.
    ///
    /// For a wanted change of velocity Δv the impulse is `𝕄 (Δv, 0)`, or `m·Δv` with m =
    /// [`DryMass::mass`](crate::DryMass::mass) plus the added mass along Δv. Locked axes keep their velocity. A body that is not in
    /// the fluid gets rapier's impulse. Wakes the body. A link of a multibody does not feel it, as it does not
    /// feel rapier's: rapier moves it by its multibody's generalized velocities alone. Push links by forces.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let (ball, _) = world.insert(RigidBodyBuilder::dynamic(), ColliderBuilder::ball(0.1).density(997.0));
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, ball)?;
    /// let mut immersion = Immersion::new(Fluid::WATER);
    /// immersion.insert(ball, hydro);
    /// immersion.step(&mut world);
    ///
    /// let before = world.bodies[ball].linvel();
    /// let impulse = Vector::X * immersion.mass_of(ball).unwrap().mass as f32;
    /// immersion.apply_impulse(&mut world.bodies, ball, impulse);
    /// // A ball drags half of the water that it displaces along: m·(1 m/s) makes two thirds of 1 m/s.
    /// let change = world.bodies[ball].linvel() - before;
    /// assert!((change.x - 2.0 / 3.0).abs() < 1e-3);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn apply_impulse(
        &mut self,
        bodies: &mut RigidBodySet,
        handle: RigidBodyHandle,
        impulse: Vector,
    ) {
        if let Some(body) = bodies.get(handle) {
            let center = body.center_of_mass();
            self.apply_impulse_at_point(bodies, handle, impulse, center);
        }
    }

    /// The same at a point, m, world axes: velocities change by `𝕄⁻¹ (J, r × J)`, r being the lever from the
    /// center of mass.
    pub fn apply_impulse_at_point(
        &mut self,
        bodies: &mut RigidBodySet,
        handle: RigidBodyHandle,
        impulse: Vector,
        point: Vector,
    ) {
        let Some(body) = bodies.get_mut(handle) else {
            return;
        };
        let state = self.registry.get(handle);
        let immersed = state.filter(|state| state.saved.is_some() && body.is_dynamic());
        let Some(shared) = immersed.and_then(|state| self.constants.get(state.constants)) else {
            body.apply_impulse_at_point(impulse, point, true);
            return;
        };
        let lever = point - body.center_of_mass();
        let mass = state.map_or_else(|| shared.mass_matrix(), |state| state.mass_matrix(shared));
        if let Some((linear, angular)) = velocity_change(&mass, body, impulse, lever) {
            body.set_linvel(body.linvel() + linear, true);
            body.set_angvel(body.angvel() + angular, true);
            // One that slept is not listed as active before rapier's next step.
            self.registry.newcomers.push(handle);
        }
    }
}
