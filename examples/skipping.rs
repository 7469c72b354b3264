//! A flat stone thrown over water: how often it skips, by the angle between stone and water and by its spin, and how fast
//! an aluminium disc has to be to skip at all.
//!
//! ```text
//! cargo run --release --example skipping
//! cargo run --release --example skipping -- --open    # three throws in the browser
//! ```
//!
//! Prints the counts and writes `skipping.svg`, `skipping.html` (three throws play in a browser) and `skipping.glb`.

#[path = "support/draw.rs"]
#[allow(dead_code, reason = "shared with other examples")]
mod draw;
mod support;

use clap::Parser;
use draw::{Item, Panel, Point};
use plotters::style::RGBColor;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, Medium, ViscousLaw};
use std::error::Error;
use std::f32::consts::TAU;
use support::film::{FilmArgs, FrameRate};
use support::options::{Out, wrote};
use support::reel::Reel;

/// Stones and discs that skip over water.
#[derive(Parser)]
#[command(name = "skipping", version)]
#[command(mut_arg("frame_rate", |rate| rate.default_value("60")))]
struct Options {
    #[command(flatten)]
    frame_rate: FrameRate,
    #[command(flatten)]
    film: FilmArgs,
    #[command(flatten)]
    out: Out,
}

/// A disc: radius and thickness, m, and density, kg/m³.
#[derive(Clone, Copy)]
struct Disc {
    radius: f32,
    thickness: f32,
    density: f32,
}

/// A flat stone of 200 g.
const STONE: Disc = Disc {
    radius: 0.05,
    thickness: 0.01,
    density: 2550.0,
};

/// The disc of Clanet, Hersen & Bocquet, *Nature* 427, 29 (2004).
const ALUMINIUM: Disc = Disc {
    radius: 0.025,
    thickness: 0.00275,
    density: 2700.0,
};

/// How it comes in: speed, m/s, its angle below the horizon and the disc's rise of the front edge over the water, rad, and
/// spin about the disc's axis, turns per second.
#[derive(Clone, Copy)]
struct Throw {
    speed: f32,
    impact: f32,
    attack: f32,
    spin: f32,
}

/// A disc as it is thrown, under a law of the viscous force.
fn thrown(
    disc: Disc,
    throw: Throw,
    law: ViscousLaw,
    hertz: f32,
) -> (PhysicsWorld, Immersion, RigidBodyHandle) {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1.0 / hertz;
    let tilt = Rotation::from_rotation_z(throw.attack);
    let velocity = Vector::new(throw.impact.cos(), -throw.impact.sin(), 0.0) * throw.speed;
    let clear = disc.radius * throw.attack.sin() + disc.thickness;
    let body = RigidBodyBuilder::dynamic()
        .pose(Pose::from_parts(Vector::Y * (1.1 * clear), tilt))
        .linvel(velocity)
        .angvel(tilt * Vector::Y * (TAU * throw.spin));
    let shape = ColliderBuilder::cylinder(0.5 * disc.thickness, disc.radius);
    let (stone, _) = world.insert(body, shape.density(disc.density));
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, stone);
    let body = ImmersedBody::new(hydro.expect("a disc"));
    let mut immersion = Immersion::new(Medium::layered(Fluid::AIR, Fluid::WATER));
    immersion.insert(stone, body.with_law(law).expect("a law of the crate"));
    (world, immersion, stone)
}

/// How often it leaves the water again, until it sinks.
fn skips(disc: Disc, throw: Throw, law: ViscousLaw, hertz: f32) -> usize {
    let (mut world, mut immersion, stone) = thrown(disc, throw, law, hertz);
    let (mut count, mut was_wet) = (0, false);
    for _ in 0..(20.0 * hertz) as usize {
        immersion.step(&mut world);
        let floats = immersion.hydrostatics(&world.bodies, stone);
        let is_wet = floats.is_some_and(|floats| floats.submerged_share > 0.0);
        count += usize::from(was_wet && !is_wet);
        was_wet = is_wet;
        if world.bodies[stone].translation().y < -2.0 * disc.radius {
            break;
        }
    }
    count
}

/// The least speed, m/s, at which the aluminium disc skips, coming in at 20°, by the angle between disc and water, degrees.
fn least_speeds(law: ViscousLaw) -> Vec<Point> {
    let angles = (1..=14).map(|i| 5.0 * i as f32);
    let least = |attack: f32| {
        let skipping = |speed: &f32| {
            let throw = Throw {
                speed: *speed,
                impact: 20_f32.to_radians(),
                attack: attack.to_radians(),
                spin: 65.0,
            };
            skips(ALUMINIUM, throw, law, 2000.0) > 0
        };
        let speed = (2..=48).map(|i| 0.25 * i as f32).find(skipping)?;
        Some((attack.into(), speed.into()))
    };
    angles.filter_map(least).collect()
}

fn counted() -> Panel {
    let mut map = Panel::new(
        "skips of a stone of 200 g at 12 m/s, coming in at 15°",
        "angle between stone and water, degrees",
        "spin, turns per second",
    );
    map.window = Some([(8.75, 41.25), (-1.0, 17.0)]);
    println!("skips by angle between stone and water (10 to 40°) and spin (turns per second):");
    for row in 0..=8 {
        let spin = 2.0 * row as f32;
        let mut line = String::new();
        for column in 0..=12 {
            let attack = 10.0 + 2.5 * column as f32;
            let throw = Throw {
                speed: 12.0,
                impact: 15_f32.to_radians(),
                attack: attack.to_radians(),
                spin,
            };
            let count = skips(STONE, throw, ViscousLaw::default(), 1000.0);
            line += &format!("{count:4}");
            let (x, y) = (f64::from(attack), f64::from(spin));
            let corners: (Point, Point) = ((x - 1.25, y - 1.0), (x + 1.25, y + 1.0));
            map.items.push(Item::Boxes(vec![corners], shade(count)));
            let ink = RGBColor(60, 60, 60);
            map.items.push(Item::Label((x, y), count.to_string(), ink));
        }
        println!("{spin:5.0} {line}");
    }
    map
}

/// Three throws of the stone.
fn film(options: &Options) -> Vec<std::path::PathBuf> {
    let mut film: Option<Reel> = None;
    for (name, attack, spin) in [
        ("20° and spinning", 20_f32, 10.0),
        ("20°, no spin", 20.0, 0.0),
        ("40° and spinning", 40.0, 10.0),
    ] {
        let throw = Throw {
            speed: 12.0,
            impact: 15_f32.to_radians(),
            attack: attack.to_radians(),
            spin,
        };
        let (mut world, mut immersion, _) = thrown(STONE, throw, ViscousLaw::default(), 1000.0);
        let film = film.get_or_insert_with(|| {
            Reel::new(&world, options.frame_rate.hertz).with_water([60.0, 60.0])
        });
        film.take(name, &world);
        film.shoot(&mut world, &mut immersion, 2.0);
    }
    let title = ("skipping", "A flat stone of 200 g at 12 m/s");
    let film = film.expect("throws were filmed");
    film.write(title, None, &options.out, &options.film)
}

fn main() -> Result<(), Box<dyn Error>> {
    let options: Options = support::cli::parse();
    let mut files = film(&options);
    let map = counted();
    let mut least = Panel::new(
        "least speed of a disc that skips: ours (blue), its impact alone (grey), measured (red)",
        "angle between disc and water, degrees",
        "m/s",
    );
    let (blue, grey, red) = (
        RGBColor(30, 90, 200),
        RGBColor(150, 150, 150),
        RGBColor(211, 47, 47),
    );
    println!("least speed of the disc that skips, with and without viscous forces (degrees, m/s):");
    least.window = Some([(0.0, 75.0), (0.0, 12.0)]);
    least.items.push(Item::Dots(vec![(20.0, 2.5)], red, 6));
    for (law, color) in [(ViscousLaw::Inviscid, grey), (ViscousLaw::default(), blue)] {
        let curve = least_speeds(law);
        println!("{curve:?}");
        least.items.push(Item::Dots(curve.clone(), color, 4));
        least.items.push(Item::Line(curve, color, 2));
    }
    let svg = draw::svg("Skipping stones", &[map, least], 2, (720, 460))?;
    files.push(options.out.write("skipping.svg", svg));
    println!("{}", wrote(&files));
    Ok(())
}

/// White for none to blue for ten.
fn shade(count: usize) -> RGBColor {
    let s = (count as f64 / 10.0).min(1.0).sqrt();
    let mix = |from: f64, to: f64| (from + (to - from) * s) as u8;
    RGBColor(mix(250.0, 90.0), mix(250.0, 140.0), mix(250.0, 200.0))
}
