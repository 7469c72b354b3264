//! The machines are described as the default law, or one of their own, knows them: nothing is said of them.

use crate::anemometer::Anemometer;
use crate::arrow::Arrow;
use crate::boomerang::{Boomerang, RETURNING};
use crate::dart::Dart;
use crate::frisbee::Frisbee;
use crate::glider::{Build, Glider};
use crate::kite::Kite;
use crate::must;
use crate::parachute::Parachute;
use crate::rov::Rov;
use crate::shuttlecock::Shuttlecock;
use crate::twig::{Gusts, Twig};
use crate::weather_vane::WeatherVane;
use crate::windmill::Windmill;
use rapier3d_immersed::Warning;

#[test]
fn machines_are_in_scope() {
    let calm = Gusts {
        mean: 0.0,
        swing: 0.0,
    };
    macro_rules! machines {
        ($($machine:expr),* $(,)?) => {
            vec![$({
                let mut machine = must($machine);
                machine.immersion.step(&mut machine.world);
                (stringify!($machine), machine.immersion.warnings().to_vec())
            }),*]
        };
    }
    let said = machines![
        Anemometer::new(5.0, 240.0),
        Arrow::new(0.1, 240.0),
        Boomerang::new(RETURNING, 240.0),
        Dart::new(0.0, 240.0),
        Frisbee::new(50.0, 240.0),
        Glider::new(Build::Colliders, 240.0),
        Glider::new(Build::Compound, 240.0),
        Glider::new(Build::Jointed, 240.0),
        Kite::new(240.0),
        Parachute::new(240.0),
        Rov::new(240.0),
        Shuttlecock::new(10.0, 0.1, 240.0),
        Twig::new(calm, 240.0),
        WeatherVane::new(0.1, 240.0),
        Windmill::new(0.2, 4, 240.0),
    ];
    for (machine, warnings) in said {
        for warning in warnings {
            let doubt = matches!(
                warning,
                Warning::OutOfScope { .. } | Warning::FarPart { .. }
            );
            assert!(!doubt, "{machine}: {warning}");
        }
    }
}
