//! What floating bodies cost: time per body and step of 10,000 crates of 12 triangles on a level surface and on a sea of 64
//! waves, beside plain rapier and bodies far over the water, in one run. `cargo bench --bench floating`; with a name as
//! argument (`far`, `level`, `sea`) 20 steps of 1,000 crates in that scene and nothing else, to count instructions.

use rapier3d_immersed::free_surface::{Sea, WaveSpectrum, Waves};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, Medium, RapierSets};
use std::time::Instant;

const BODIES: usize = 10_000;
const STEPS: usize = 60;
const SCENES: [&str; 4] = ["air alone", "far", "level", "sea"];

struct Scene {
    world: PhysicsWorld,
    immersion: Immersion,
}

/// Crates in rows, 3 m apart, that bob.
fn scene(name: &str, bodies: usize) -> Scene {
    let mut world = PhysicsWorld::new();
    let far = matches!(name, "far" | "air alone");
    let height = if far { 1000.0 } else { 0.1 };
    let handles: Vec<_> = (0..bodies)
        .map(|i| {
            let at = Vector::new((i % 100) as Real * 3.0, height, (i / 100) as Real * 3.0);
            let body = RigidBodyBuilder::dynamic()
                .translation(at)
                .rotation(Vector::new(0.1, i as Real, 0.2));
            world
                .insert(body, ColliderBuilder::cuboid(0.5, 0.4, 0.6).density(400.0))
                .0
        })
        .collect();
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handles[0]).unwrap();
    let mut medium = Medium::layered(Fluid::AIR, Fluid::WATER);
    if name == "sea" {
        let spectrum = WaveSpectrum::jonswap(1.0, 5.0, 3.3).unwrap();
        medium = medium.with_surface(
            Waves::sea(&Sea {
                spectrum,
                ..Sea::default()
            })
            .unwrap(),
        );
    }
    if name == "air alone" {
        medium = Fluid::AIR.into();
    }
    let mut immersion = Immersion::new(medium);
    immersion.insert_all(handles, hydro);
    Scene { world, immersion }
}

/// Nanoseconds per body of what the immersion does in a step, and of rapier's own.
fn step(scene: &mut Scene) -> [f64; 2] {
    let Scene { world, immersion } = scene;
    let start = Instant::now();
    immersion.before_step(&mut RapierSets::of(world));
    let mut own = start.elapsed().as_secs_f64();
    let start = Instant::now();
    world.step();
    let rapier = start.elapsed().as_secs_f64();
    let start = Instant::now();
    immersion.after_step(&mut RapierSets::of(world));
    own += start.elapsed().as_secs_f64();
    [own, rapier].map(|time| time * 1e9 / BODIES as f64)
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn main() {
    let named = std::env::args().find(|arg| SCENES.contains(&arg.as_str()));
    if let Some(name) = named {
        let mut scene = scene(&name, 1_000);
        (0..20).for_each(|_| {
            step(&mut scene);
        });
        return;
    }
    let mut scenes = SCENES.map(|name| scene(name, BODIES));
    let mut times = vec![[Vec::new(), Vec::new()]; SCENES.len()];
    for round in 0..STEPS {
        for (scene, times) in scenes.iter_mut().zip(&mut times) {
            let taken = step(scene);
            if round >= 10 {
                for (times, taken) in times.iter_mut().zip(taken) {
                    times.push(taken);
                }
            }
        }
    }
    println!(
        "{:12} {:>22} {:>18}",
        "scene", "immersion, ns per body", "rapier, ns"
    );
    for (name, [own, rapier]) in SCENES.iter().zip(times) {
        println!("{name:12} {:22.0} {:18.0}", median(own), median(rapier));
    }
}
