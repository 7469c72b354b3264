//! Leaves fall into a tray and come to rest on each other, with rapier's own settings and with those that
//! [`preset::leaf_scale`] makes for bodies as small and thin as leaves.
//!
//! ```text
//! cargo run --release --example pile
//! ```
//!
//! Printed every half second: how many leaves still fall, how high the pile is, how fast its leaves move, and
//! how many sleep. Leaves without any gap between them would be `solid` high: a lower pile has sunk into
//! itself.

use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Error, Fluid, HydroProperties, Immersion, preset};

const LEAVES: usize = 200;
/// Half extents of a leaf, m.
const HALF: [Real; 3] = [0.0365, 0.00015, 0.021];
/// Half of the tray's side, m.
const TRAY: Real = 0.1;
const SECONDS: Real = 4.0;

fn run(leaf_scale: bool) -> Result<(), Error> {
    let mut world = PhysicsWorld::new();
    if leaf_scale {
        preset::leaf_scale(&mut world.integration_parameters);
    }
    world.insert(
        RigidBodyBuilder::fixed(),
        ColliderBuilder::cuboid(TRAY, 0.05, TRAY).translation(Vector::Y * -0.05),
    );
    for side in [Vector::X, -Vector::X, Vector::Z, -Vector::Z] {
        let half = Vector::new(TRAY, 0.5, TRAY) - side.abs() * (TRAY - 0.01);
        let wall = ColliderBuilder::cuboid(half.x, half.y, half.z);
        let place = side * (TRAY + 0.01) + Vector::Y * 0.5;
        world.insert(RigidBodyBuilder::fixed(), wall.translation(place));
    }
    let handles: Vec<_> = (0..LEAVES)
        .map(|i| {
            // Two by three at a time, one layer above the other, each turned a little differently.
            let (column, layer) = (i % 6, (i / 6) as Real);
            let [x, z] = [column % 2, column / 2].map(|k| k as Real);
            let place = Vector::new(0.09 * x - 0.045, 0.05 + 0.015 * layer, 0.055 * (z - 1.0));
            let turn = Vector::new(0.2 * (i as Real).sin(), 0.0, 0.2 * (2.0 * i as Real).sin());
            let body = RigidBodyBuilder::dynamic()
                .translation(place)
                .rotation(turn);
            let leaf = ColliderBuilder::cuboid(HALF[0], HALF[1], HALF[2]).density(300.0);
            world.insert(preset::leaf_body(body), leaf).0
        })
        .collect();
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handles[0])?;
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert_all(handles.iter().copied(), hydro);

    let steps = (SECONDS / world.integration_parameters.dt).round() as usize;
    for step in 1..=steps {
        immersion.step(&mut world);
        if step % (steps / 8) != 0 {
            continue;
        }
        let bodies = || handles.iter().map(|handle| &world.bodies[*handle]);
        let mut heights: Vec<Real> = bodies().map(|body| body.translation().y).collect();
        heights.sort_by(Real::total_cmp);
        // Of the lower nineteen in twenty: one leaf that stands against a wall is no pile.
        let height = 1e3 * heights[LEAVES * 19 / 20];
        let flying = bodies().filter(|body| body.linvel().y < -0.2).count();
        let squares = bodies().map(|body| body.linvel().length_squared());
        let speed = 1e3 * (squares.sum::<Real>() / LEAVES as Real).sqrt();
        let asleep = bodies().filter(|body| body.is_sleeping()).count();
        let time = SECONDS * step as Real / steps as Real;
        println!("{time:7.1} {flying:11} {height:11.1} {speed:12.1} {asleep:8}");
    }
    Ok(())
}

fn main() -> Result<(), Error> {
    let volume = 8.0 * HALF[0] * HALF[1] * HALF[2] * LEAVES as Real;
    let solid = 1e3 * volume / (4.0 * TRAY * TRAY);
    for (name, leaf_scale) in [("rapier's defaults", false), ("preset::leaf_scale", true)] {
        println!("{LEAVES} leaves under {name}; solid: {solid:.1} mm");
        println!("time, s   in the air  height, mm  speed, mm/s   asleep");
        run(leaf_scale)?;
    }
    Ok(())
}
