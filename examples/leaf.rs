//! One leaf falls through air, and beside it the same leaf in plain rapier.
//!
//! ```text
//! cargo run --release --example leaf
//! cargo run --release --example leaf -- --open    # both play in the browser
//! ```
//!
//! Printed every tenth of a second: how far each has fallen and drifted and how far it is tilted; at the end, what the fluid
//! changed. Writes `leaf.html` and `leaf.glb`.

mod support;

use clap::Parser;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Error, Fluid, HydroProperties, Immersion};
use support::Vec3;
use support::film::{FilmArgs, FrameRate};
use support::options::{Json, Out, wrote};
use support::reel::Reel;
use support::series::{CsvArgs, Series};
use support::sheet::Camera;

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

/// One leaf falls through air, and beside it the same leaf in plain rapier.
#[derive(Parser)]
#[command(name = "leaf", version)]
struct Options {
    #[command(flatten)]
    frame_rate: FrameRate,
    #[command(flatten)]
    film: FilmArgs,
    #[command(flatten)]
    out: Out,
    #[command(flatten)]
    csv: CsvArgs,
    #[command(flatten)]
    json: Json,
}

fn main() -> Result<(), Error> {
    let options: Options = support::cli::parse();
    let columns = [
        ("t", "s"),
        ("fallen", "m"),
        ("drifted", "m"),
        ("tilt", "deg"),
    ];
    let mut series = Series::new("run", &columns);
    // Where the leaf comes in this time; nothing collides with that floor.
    let film = Reel::new(&Leaf::new(true)?.world, options.frame_rate.hertz);
    let mut film = film.with_floor(-1.6, [4.0, 4.0]);
    let mut ends = Vec::new();
    for (name, immersed) in [("in air", true), ("plain rapier", false)] {
        let mut leaf = Leaf::new(immersed)?;
        film.take(name, &leaf.world);
        for step in 0..=SECONDS * STEPS_PER_SECOND {
            if step > 0 {
                leaf.immersion.step(&mut leaf.world);
            }
            film.keep(&leaf.world, immersed.then_some(&leaf.immersion));
            if step % (STEPS_PER_SECOND / 10) == 0 {
                let time = step as Real / STEPS_PER_SECOND as Real;
                let [fallen, drifted] = leaf.fallen_and_drifted();
                series.push(name, &[time, fallen, drifted, leaf.tilt()].map(f64::from));
            }
        }
        ends.push(leaf.fallen_and_drifted());
    }
    let camera = Camera {
        eye: Vec3::new(0.8, -0.3, 2.6),
        target: Vec3::new(0.0, -0.75, 0.0),
        field_of_view: 0.66,
    };
    let title = ("leaf", "A leaf, let go");
    let files = film.write(title, Some(camera), &options.out, &options.film);
    options.csv.write(|| series.csv());
    if options.json.on {
        println!("{:#}", series.json());
        return Ok(());
    }
    print!("{}", series.text());
    let ([fallen, drifted], [brick, _]) = (ends[0], ends[1]);
    println!(
        "In {SECONDS} s the leaf falls {fallen:.2} m and drifts {drifted:.2} m; plain rapier drops it like a \
         brick: {brick:.1} m."
    );
    println!("{}", wrote(&files));
    Ok(())
}
