//! Leaves that rain on the pond land, float or lie ashore, and drift as the water does.

use crate::pond_scene::{Channel, Count, Pond};

/// 50 leaves, 20 s: no number breaks, no leaf is lost or sinks, and those that touch nothing drift with the water where
/// they are: not against it, and no faster than it and a tenth of the breeze make them.
#[test]
fn leaves_land_and_float() {
    let pond = Pond {
        leaves: 50,
        seed: 3,
        current: 0.12,
        wind: 0.6,
    };
    let (mut scene, mut immersion) = pond.build().unwrap();
    let steps = (20.0 / scene.world.integration_parameters.dt) as usize;
    (0..steps).for_each(|_| immersion.step(&mut scene.world));
    let count = Count::of(&scene, &immersion, &Channel { speed: 0.12 });
    println!("{count:?}");
    assert_eq!(count.broken, 0);
    assert_eq!(count.falling + count.sunk, 0, "{count:?}");
    assert_eq!(count.afloat + count.ashore, 50);
    assert!(count.afloat >= 30, "{count:?}");
    let [drift, water] = count.drift;
    assert!(
        count.free > 0 && drift > 0.5 * water && drift < water + 0.06,
        "{count:?}"
    );
    // The log floats where it was put, against its posts.
    let log = &scene.world.bodies[scene.pieces[50].handle];
    let at = log.translation();
    assert!(at.y.abs() < 0.03 && (at.x - 1.38).abs() < 0.04, "{at}");
}
