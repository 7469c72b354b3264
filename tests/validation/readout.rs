//! The components of the force add up to what moves the body.

use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    Fluid, HydroProperties, ImmersedBody, Immersion, StochasticLaw, ViscousLaw,
};

/// m dv/dt = weight + buoyancy + added mass + drag + lifts over each small step, in water, where
/// every component matters. The acceleration is that of the step just made, the forces those at its
/// end: the difference is first order in dt.
#[test]
fn components_add_up_to_the_acceleration() {
    for law in [
        ViscousLaw::default(),
        ViscousLaw::Stochastic(StochasticLaw::default()),
    ] {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / 2000.0;
        let (handle, _) = world.insert(
            RigidBodyBuilder::dynamic().rotation(Vector::new(0.4, 0.0, 0.1)),
            ColliderBuilder::cuboid(0.05, 0.002, 0.03).density(2000.0),
        );
        let mass = world.bodies[handle].mass();
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let mut immersion = Immersion::new(Fluid::WATER);
        let body = ImmersedBody::new(hydro).with_law(law).unwrap();
        immersion.insert(handle, body);
        assert!(immersion.forces(&world.bodies, handle).is_none());
        let mut most_drag: Real = 0.0;
        for step in 0..3000 {
            let before = world.bodies[handle].linvel();
            immersion.step(&mut world);
            if step % 100 != 99 {
                continue;
            }
            let acceleration =
                (world.bodies[handle].linvel() - before) / world.integration_parameters.dt;
            let f = immersion.forces(&world.bodies, handle).unwrap();
            let sum = f.added_mass
                + f.drag
                + f.translational_lift
                + f.rotational_lift
                + f.damping
                + f.buoyancy
                + f.weight;
            let largest = f.weight.force.length();
            let miss = (sum.force - acceleration * mass).length();
            assert!(miss < 0.03 * largest, "{step}: {miss} of {largest}: {f:?}");
            most_drag = most_drag.max(f.drag.force.length() / largest);
            assert!((0.0..=1.571).contains(&f.angle_of_attack));
        }
        let f = immersion.forces(&world.bodies, handle).unwrap();
        assert!(most_drag > 0.1);
        assert!((f.buoyancy.force.y / (mass / 2000.0 * 997.0 * 9.81) - 1.0).abs() < 1e-3);
    }
}
