//! What parts cost: time per body of `before_step` for bodies of one planform and of 1 to 16 parts, in one run.
//! `cargo bench --bench parts`; with a number of parts as argument, a hundred steps of such bodies and nothing else, to count
//! instructions (`0` is the whole as one planform).

use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, Part, RapierSets};
use std::time::Instant;

const BODIES: usize = 10_000;
const STEPS: usize = 100;
/// Strips of a plate; 0 is the plate as it is.
const PARTS: [usize; 6] = [0, 1, 2, 4, 8, 16];

/// Plates that fall through air, far apart, at all attitudes.
fn scene(parts: usize) -> (PhysicsWorld, Immersion) {
    let mut world = PhysicsWorld::new();
    let half = Vector::new(0.0365, 0.000_15, 0.021);
    let handles: Vec<_> = (0..BODIES)
        .map(|i| {
            let cell = [i % 22, i / 22 % 22, i / 484].map(|x| x as Real * 2.0);
            let turn = Vector::new(0.3 + cell[0], 0.7 + cell[1], cell[2]);
            let body = RigidBodyBuilder::dynamic()
                .translation(Vector::from_array(cell))
                .rotation(turn);
            let leaf = ColliderBuilder::cuboid(half.x, half.y, half.z).density(300.0);
            world.insert(body, leaf).0
        })
        .collect();
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handles[0]).unwrap();
    let mut body = ImmersedBody::new(hydro);
    if parts > 0 {
        let strips = HydroProperties::strips_of_shape(&Cuboid::new(half), parts).unwrap();
        body = body.with_parts(strips.into_iter().map(Part::new));
    }
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert_all(handles, body);
    (world, immersion)
}

/// Seconds of one `before_step`.
fn step((world, immersion): &mut (PhysicsWorld, Immersion)) -> f64 {
    let start = Instant::now();
    immersion.before_step(&mut RapierSets::of(world));
    let taken = start.elapsed().as_secs_f64();
    world.step();
    immersion.after_step(&mut RapierSets::of(world));
    taken
}

fn main() {
    if let Some(parts) = std::env::args().find_map(|arg| arg.parse().ok()) {
        let mut scene = scene(parts);
        (0..STEPS).for_each(|_| {
            step(&mut scene);
        });
        return;
    }
    let mut scenes = PARTS.map(scene);
    let mut times = vec![Vec::new(); PARTS.len()];
    for round in 0..STEPS {
        for (scene, times) in scenes.iter_mut().zip(&mut times) {
            let taken = step(scene);
            if round >= 20 {
                times.push(taken * 1e9 / BODIES as f64);
            }
        }
    }
    let medians: Vec<f64> = times
        .iter_mut()
        .map(|times| {
            times.sort_by(f64::total_cmp);
            times[times.len() / 2]
        })
        .collect();
    println!("parts   ns per body   ns per further part");
    println!("whole {:13.0}", medians[0]);
    for (i, parts) in PARTS.iter().enumerate().skip(1) {
        let further = (medians[i] - medians[1]) / (*parts as f64 - 1.0).max(1.0);
        println!("{parts:5} {:13.0} {further:21.1}", medians[i]);
    }
}
