//! A pile of leaves under rapier's defaults and under [`preset::leaf_scale`], with and without air: time
//! per step while it is dense and awake, its height, and how it comes to rest. `cargo bench --bench pile`.

use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, preset};
use std::time::Instant;

const HALF: [Real; 3] = [0.0365, 0.000_15, 0.021];

/// Leaves in layers of 5 × 5 over a tray, dropped together.
fn pile(leaves: usize, leaf_scale: bool) -> (PhysicsWorld, Immersion, Vec<RigidBodyHandle>) {
    let mut world = PhysicsWorld::new();
    if leaf_scale {
        preset::leaf_scale(&mut world.integration_parameters);
    }
    let tray = [
        (Vector::new(0.0, -0.05, 0.0), Vector::new(0.2, 0.05, 0.2)),
        (Vector::new(0.2, 0.1, 0.0), Vector::new(0.01, 0.2, 0.2)),
        (Vector::new(-0.2, 0.1, 0.0), Vector::new(0.01, 0.2, 0.2)),
        (Vector::new(0.0, 0.1, 0.2), Vector::new(0.2, 0.2, 0.01)),
        (Vector::new(0.0, 0.1, -0.2), Vector::new(0.2, 0.2, 0.01)),
    ];
    for (at, half) in tray {
        let body = RigidBodyBuilder::fixed().translation(at);
        world.insert(body, ColliderBuilder::cuboid(half.x, half.y, half.z));
    }
    let handles: Vec<_> = (0..leaves)
        .map(|i| {
            let cell = [i % 5, i / 25, i / 5 % 5].map(|x| x as Real);
            let at = Vector::new(
                0.07 * cell[0] - 0.14,
                0.02 + 0.004 * cell[1],
                0.07 * cell[2] - 0.14,
            );
            let turn = Vector::new(0.1 * (cell[0] - 2.0), i as Real, 0.1 * (cell[2] - 2.0));
            let body = RigidBodyBuilder::dynamic().translation(at).rotation(turn);
            let collider = ColliderBuilder::cuboid(HALF[0], HALF[1], HALF[2]).density(300.0);
            world.insert(preset::leaf_body(body), collider).0
        })
        .collect();
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handles[0]).unwrap();
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert_all(handles.iter().copied(), hydro);
    (world, immersion, handles)
}

fn main() {
    let quick = std::env::args().any(|arg| arg == "--test");
    let (leaves, seconds) = if quick { (50, 0.05) } else { (1000, 4.0) };
    println!(
        "{leaves} leaves, solid stack {:.1} mm",
        8.0 * HALF[0] * HALF[1] * HALF[2] / (0.4 * 0.4) * 1e3 * leaves as Real
    );
    let runs = [
        ("rapier's defaults, 60 Hz", false, true),
        ("leaf_scale, 240 Hz", true, true),
        ("leaf_scale without the fluid", true, false),
    ];
    for (name, leaf_scale, fluid) in runs {
        let (mut world, mut immersion, handles) = pile(leaves, leaf_scale);
        immersion.set_enabled(fluid);
        let steps = (seconds / world.integration_parameters.dt) as usize;
        let mut times = Vec::with_capacity(steps);
        let mut asleep = None;
        for step in 0..steps {
            let start = Instant::now();
            immersion.step(&mut world);
            times.push(start.elapsed().as_secs_f64() * 1e3);
            let sleepers = handles.iter().filter(|h| world.bodies[**h].is_sleeping());
            if asleep.is_none() && sleepers.count() == leaves {
                asleep = Some(step as Real * world.integration_parameters.dt);
            }
        }
        // The middle third: piled up, and not yet asleep.
        let middle = &mut times[steps / 4..steps / 2];
        middle.sort_by(f64::total_cmp);
        let mut heights: Vec<_> = handles
            .iter()
            .map(|handle| world.bodies[*handle].translation().y * 1e3)
            .collect();
        heights.sort_by(Real::total_cmp);
        let squares = handles
            .iter()
            .map(|handle| world.bodies[*handle].linvel().length_squared());
        let speed = (squares.sum::<Real>() / leaves as Real).sqrt();
        println!(
            "{name}: {:.1} ms/step awake (median), height {:.1} mm (95th percentile), moving at \
             {:.2} mm/s (root mean square) at the end, {}",
            middle[middle.len() / 2],
            heights[leaves * 95 / 100],
            speed * 1e3,
            asleep.map_or("not asleep".to_owned(), |t| format!(
                "asleep after {t:.1} s"
            )),
        );
    }
}
