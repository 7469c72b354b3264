//! Bodies at the surface between two fluids.

mod changed;
mod energy;
mod exact;
mod layers;
mod repeats;
mod together;
mod waves;

use rapier3d::prelude::*;
use rapier3d_immersed::rapier3d;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, Medium, ViscousLaw};

/// Air over water, and one body in it.
struct Pond {
    world: PhysicsWorld,
    immersion: Immersion,
    body: RigidBodyHandle,
}

impl Pond {
    fn new(body: RigidBodyBuilder, collider: ColliderBuilder, hertz: f32) -> Self {
        Self::over(Fluid::WATER, body, collider, hertz, |hydro| hydro.into())
    }

    fn over(
        water: Fluid,
        body: RigidBodyBuilder,
        collider: ColliderBuilder,
        hertz: f32,
        describe: impl Fn(HydroProperties) -> ImmersedBody,
    ) -> Self {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / hertz;
        let (body, _) = world.insert(body, collider);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, body).unwrap();
        let mut immersion = Immersion::new(Medium::layered(Fluid::AIR, water));
        immersion.insert(body, describe(hydro));
        Self {
            world,
            immersion,
            body,
        }
    }

    fn run(&mut self, seconds: f32) {
        let steps = (seconds / self.world.integration_parameters.dt).round() as usize;
        (0..steps).for_each(|_| self.immersion.step(&mut self.world));
    }

    fn body(&self) -> &RigidBody {
        &self.world.bodies[self.body]
    }
}

/// A body in an ideal fluid: no viscous force, and no waves.
fn ideal(hydro: HydroProperties) -> ImmersedBody {
    ImmersedBody::new(hydro)
        .with_law(ViscousLaw::Inviscid)
        .unwrap()
}
