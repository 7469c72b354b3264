//! One leaf falls through air, and beside it the same leaf in plain rapier.
//!
//! ```text
//! cargo run --release --example leaf
//! ```
//!
//! Printed every tenth of a second: how far the leaf has fallen and drifted and how far it is tilted, then how
//! far plain rapier's has fallen; at the end, what the fluid changed.

use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Error, Fluid, HydroProperties, Immersion};

const SECONDS: usize = 2;
const STEPS_PER_SECOND: usize = 60;

/// A leaf of 7.3 × 4.2 × 0.03 cm and 300 kg/m³, tilted by 17°, with or without the fluid.
struct Leaf {
    world: PhysicsWorld,
    immersion: Immersion,
    handle: RigidBodyHandle,
}

impl Leaf {
    fn new(immersed: bool) -> Result<Self, Error> {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / STEPS_PER_SECOND as Real;
        let (handle, _) = world.insert(
            RigidBodyBuilder::dynamic().rotation(Vector::X * 0.3),
            ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(300.0),
        );
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle)?;
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(handle, hydro);
        immersion.set_enabled(immersed);
        Ok(Self {
            world,
            immersion,
            handle,
        })
    }

    fn step(&mut self) {
        self.immersion.step(&mut self.world);
    }

    fn body(&self) -> &RigidBody {
        &self.world.bodies[self.handle]
    }

    /// How far it has fallen and how far it is from the plumb line, m.
    fn fallen_and_drifted(&self) -> [Real; 2] {
        let place = self.body().translation();
        [0.0 - place.y, place.with_y(0.0).length()]
    }

    /// Between its normal and the vertical, degrees: beyond 90 it has turned over.
    fn tilt(&self) -> Real {
        let normal = *self.body().rotation() * Vector::Y;
        normal.y.clamp(-1.0, 1.0).acos().to_degrees()
    }
}

fn main() -> Result<(), Error> {
    let (mut leaf, mut plain) = (Leaf::new(true)?, Leaf::new(false)?);
    println!("          in air                          plain rapier");
    println!("time, s   fallen, m   drifted, m   tilt   fallen, m");
    for step in 0..=SECONDS * STEPS_PER_SECOND {
        if step > 0 {
            leaf.step();
            plain.step();
        }
        if step % (STEPS_PER_SECOND / 10) == 0 {
            let time = step as Real / STEPS_PER_SECOND as Real;
            let [fallen, drifted] = leaf.fallen_and_drifted();
            let (tilt, [brick, _]) = (leaf.tilt(), plain.fallen_and_drifted());
            println!("{time:7.1} {fallen:11.2} {drifted:12.2} {tilt:5.0}° {brick:11.2}");
        }
    }
    let [fallen, drifted] = leaf.fallen_and_drifted();
    let [brick, _] = plain.fallen_and_drifted();
    println!(
        "In {SECONDS} s the leaf falls {fallen:.2} m and drifts {drifted:.2} m; plain rapier drops it like a \
         brick: {brick:.1} m."
    );
    Ok(())
}
