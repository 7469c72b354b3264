//! Leaves fall into a tray and come to rest on each other, with rapier's own settings and with those that
//! [`preset::leaf_scale`] makes for bodies as small and thin as leaves.
//!
//! ```text
//! cargo run --release --example pile
//! cargo run --release --example pile -- --open    # both piles play in the browser
//! ```
//!
//! Printed every half second: how many leaves still fall, how high the pile is, how fast its leaves move, and
//! how many sleep; and how high leaves without any gap between them would be: a lower pile has sunk into
//! itself. Writes `pile.html` and `pile.glb`.

mod support;

use clap::Parser;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Error, Fluid, HydroProperties, Immersion, preset};
use support::Vec3;
use support::film::{FilmArgs, FrameRate};
use support::options::{Json, Out, wrote};
use support::reel::Reel;
use support::scene::corners;
use support::series::{CsvArgs, Series};
use support::sheet::Camera;

const LEAVES: usize = 200;
/// Half extents of a leaf, m.
const HALF: [Real; 3] = [0.0365, 0.00015, 0.021];
/// Half of the tray's side, m.
const TRAY: Real = 0.1;
const SECONDS: Real = 4.0;

/// Leaves fall into a tray, under rapier's defaults and the leaf-scale preset.
#[derive(Parser)]
#[command(name = "pile", version)]
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

/// What is written of a run.
struct Kept {
    film: Option<Reel>,
    frame_rate: f64,
    series: Series,
}

fn run(name: &str, leaf_scale: bool, kept: &mut Kept) -> Result<(), Error> {
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

    // Of the tray only the floor is shown: its walls would hide the leaves.
    let film = kept.film.get_or_insert_with(|| {
        Reel::new(&world, kept.frame_rate).showing(|solid| corners(solid)[1].y < 0.1)
    });
    film.take(name, &world);
    film.keep(&world, Some(&immersion));
    let steps = (SECONDS / world.integration_parameters.dt).round() as usize;
    for step in 1..=steps {
        immersion.step(&mut world);
        film.keep(&world, Some(&immersion));
        if step % (steps / 8) != 0 {
            continue;
        }
        let bodies = || handles.iter().map(|handle| &world.bodies[*handle]);
        let mut heights: Vec<Real> = bodies().map(|body| body.translation().y).collect();
        heights.sort_by(Real::total_cmp);
        // Of the lower nineteen in twenty: one leaf that stands against a wall is no pile.
        let height = 1e3 * heights[LEAVES * 19 / 20];
        let flying = bodies().filter(|body| body.linvel().y < -0.2).count() as Real;
        let squares = bodies().map(|body| body.linvel().length_squared());
        let speed = 1e3 * (squares.sum::<Real>() / LEAVES as Real).sqrt();
        let asleep = bodies().filter(|body| body.is_sleeping()).count() as Real;
        let time = SECONDS * step as Real / steps as Real;
        let row = [time, flying, height, speed, asleep].map(f64::from);
        kept.series.push(name, &row);
    }
    Ok(())
}

fn main() -> Result<(), Error> {
    let options: Options = support::cli::parse();
    let columns = [
        ("t", "s"),
        ("flying", ""),
        ("height", "mm"),
        ("speed", "mm/s"),
        ("asleep", ""),
    ];
    let mut kept = Kept {
        film: None,
        frame_rate: options.frame_rate.hertz,
        series: Series::new("run", &columns),
    };
    let volume = 8.0 * HALF[0] * HALF[1] * HALF[2] * LEAVES as Real;
    let solid = 1e3 * volume / (4.0 * TRAY * TRAY);
    for (name, leaf_scale) in [("rapier's defaults", false), ("preset::leaf_scale", true)] {
        run(name, leaf_scale, &mut kept)?;
    }
    let film = kept.film.expect("two piles were filmed");
    let title = ("pile", "Leaves in a tray");
    let camera = Camera {
        eye: Vec3::new(0.35, 0.3, 0.6),
        target: Vec3::new(0.0, 0.06, 0.0),
        field_of_view: 0.66,
    };
    let files = film.write(title, Some(camera), &options.out, &options.film);
    options.csv.write(|| kept.series.csv());
    if options.json.on {
        println!("{:#}", kept.series.json());
        return Ok(());
    }
    println!("{LEAVES} leaves; without any gap between them the pile would be {solid:.1} mm high");
    print!("{}", kept.series.text());
    println!("{}", wrote(&files));
    Ok(())
}
