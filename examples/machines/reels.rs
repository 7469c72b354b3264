//! Each machine as a film: side by side what its pictures compare.

use crate::Failure;
use crate::anemometer::Anemometer;
use crate::arrow::Arrow;
use crate::boomerang::{Boomerang, RETURNING};
use crate::dart::Dart;
use crate::frisbee::Frisbee;
use crate::glider::{Build, Glider};
use crate::kite::Kite;
use crate::parachute::Parachute;
use crate::rov::Rov;
use crate::shuttlecock::Shuttlecock;
use crate::support::reel::Reel;
use crate::twig::{Gusts, Twig};
use crate::weather_vane::WeatherVane;
use crate::windmill::Windmill;
use rapier3d_immersed::Immersion;
use rapier3d_immersed::rapier3d::prelude::*;

/// What can be filmed.
trait Machine {
    fn seen(&self) -> (&PhysicsWorld, &Immersion);
    fn step(&mut self);
}

macro_rules! machines {
    ($($machine:ty),*) => {
        $(impl Machine for $machine {
            fn seen(&self) -> (&PhysicsWorld, &Immersion) {
                (&self.world, &self.immersion)
            }

            fn step(&mut self) {
                self.immersion.step(&mut self.world);
            }
        })*
    };
}

machines!(
    Anemometer,
    Arrow,
    Boomerang,
    Dart,
    Frisbee,
    Glider,
    Kite,
    Parachute,
    Shuttlecock,
    Twig,
    WeatherVane,
    Windmill
);

/// Keeps its place for so many steps, then goes a meter down.
struct Diving(Rov, u32);

impl Machine for Diving {
    fn seen(&self) -> (&PhysicsWorld, &Immersion) {
        (&self.0.world, &self.0.immersion)
    }

    fn step(&mut self) {
        self.1 = self.1.saturating_sub(1);
        self.0.target = Vector::Y * if self.1 > 0 { 0.0 } else { -1.0 };
        self.0.step();
    }
}

/// Whether a machine flies until it comes to the ground at y = 0.
#[derive(Clone, Copy, PartialEq)]
enum Ground {
    None,
    Floor,
}

/// Films runs of a machine, so many frames per second, for so many seconds. On the ground it stays.
fn filmed<M: Machine>(
    rate: f64,
    seconds: f32,
    ground: Ground,
    runs: Vec<(&str, Result<M, Failure>)>,
) -> Result<Reel, Failure> {
    let mut reel: Option<Reel> = None;
    for (name, machine) in runs {
        let mut machine = machine?;
        let (world, _) = machine.seen();
        let steps = (seconds / world.integration_parameters.dt).round() as usize;
        let reel = reel.get_or_insert_with(|| {
            let reel = Reel::new(world, rate);
            match ground {
                Ground::None => reel,
                Ground::Floor => reel.with_floor(0.0, [40.0, 40.0]),
            }
        });
        reel.take(name, world);
        for _ in 0..=steps {
            let (world, immersion) = machine.seen();
            reel.keep(world, Some(immersion));
            let flies = world
                .bodies
                .iter()
                .all(|(_, body)| body.translation().y > 0.0);
            if ground == Ground::None || flies {
                machine.step();
            }
        }
    }
    reel.ok_or_else(|| "nothing to film".into())
}

/// The film of the machine of this name.
pub fn reel(name: &str, rate: f64) -> Result<Reel, Failure> {
    let turned = |degrees: f32| degrees.to_radians();
    match name {
        "dart" => {
            let runs = vec![
                ("wings level", Dart::new(0.0, 240.0)),
                ("rolled by 2°", Dart::new(turned(2.0), 240.0)),
            ];
            filmed(rate, 3.2, Ground::Floor, runs)
        }
        "glider" => {
            let runs = vec![("glides", Glider::new(Build::Colliders, 240.0))];
            filmed(rate, 6.0, Ground::None, runs)
        }
        "kite" => filmed(rate, 12.0, Ground::None, vec![("flies", Kite::new(240.0))]),
        "parachute" => {
            let runs = vec![("falls", Parachute::new(120.0))];
            filmed(rate, 4.0, Ground::None, runs)
        }
        "rov" => {
            let runs = vec![("dives", Rov::new(60.0).map(|rov| Diving(rov, 180)))];
            filmed(rate, 10.0, Ground::None, runs)
        }
        "twig" => {
            let gusts = |mean, swing| Twig::new(Gusts { mean, swing }, 240.0);
            let runs = vec![
                ("2 ± 1 m/s", gusts(2.0, 1.0)),
                ("5 ± 2.5 m/s", gusts(5.0, 2.5)),
            ];
            filmed(rate, 8.0, Ground::None, runs)
        }
        "windmill" => {
            let pitched = |degrees: f64| Windmill::new(degrees.to_radians(), 6, 240.0);
            let runs = vec![("pitch 20°", pitched(20.0)), ("pitch −20°", pitched(-20.0))];
            filmed(rate, 6.0, Ground::None, runs)
        }
        "anemometer" => {
            let runs = vec![
                ("3 m/s", Anemometer::new(3.0, 240.0)),
                ("12 m/s", Anemometer::new(12.0, 240.0)),
            ];
            filmed(rate, 6.0, Ground::None, runs)
        }
        "weather_vane" => {
            let runs = vec![
                ("from 170°", WeatherVane::new(turned(170.0), 240.0)),
                ("from −45°", WeatherVane::new(turned(-45.0), 240.0)),
            ];
            filmed(rate, 4.0, Ground::None, runs)
        }
        "arrow" => {
            let runs = vec![("let go at 10° of yaw", Arrow::new(turned(10.0), 240.0))];
            filmed(rate, 2.0, Ground::None, runs)
        }
        "shuttlecock" => {
            let runs = vec![(
                "thrown tail first",
                Shuttlecock::new(25.0, turned(170.0), 480.0),
            )];
            filmed(rate, 2.0, Ground::None, runs)
        }
        "frisbee" => {
            let runs = vec![
                ("spinning", Frisbee::new(60.0, 240.0)),
                ("not spinning", Frisbee::new(0.0, 240.0)),
            ];
            filmed(rate, 2.6, Ground::Floor, runs)
        }
        "boomerang" => {
            let runs = vec![("returns", Boomerang::new(RETURNING, 480.0))];
            filmed(rate, 2.6, Ground::Floor, runs)
        }
        _ => Err(format!("there is no film of '{name}'").into()),
    }
}
