//! The parachute.

use crate::parachute::{BALL, NOMINAL, Parachute, RADIUS};
use rapier3d_immersed::rapier3d::prelude::*;

/// An open cup drags 1.42 on its mouth (Matthews, *Aeronautical Engineer's Data Book*, fig. 5.13), which is 0.70 of the nominal
/// diameter across, and the load's ball 0.45: 0.70 on the nominal area. The crate's own cup has 1.39, this shallower one
/// 1.35, and sixteen gores are 3 % less than their circle: within 8 %.
///
/// Flat round parachutes have 0.75 to 0.80 (Knacke, *Parachute Recovery Systems*, 1992; recalled). This one misses that by 14 to
/// 19 %, and descends 8 to 11 % too fast. Half of it is in the comparison: a rigid open cup with the published mouth has no
/// more than 0.70.
#[test]
fn descends_as_its_mouth_says() {
    let mut chute = Parachute::new(120.0).unwrap();
    chute.run(5.0);
    let before = chute.run(0.0);
    let after = chute.run(5.0);
    let speed = f64::from(before.y - after.y) / 5.0;
    let found = Parachute::drag_coefficient(speed);
    let share = |radius: f32| f64::from(2.0 * radius).powi(2);
    let load = share(BALL / NOMINAL);
    let exact = 1.42 * share(RADIUS) + 0.45 * load;
    assert!((found / exact - 1.0).abs() < 0.08, "{found} {exact}");
    assert!((0.60..0.75).contains(&found), "{found}");
    let upright = *chute.world.bodies[chute.canopy].rotation() * Vector::Y;
    assert!(upright.y > 0.95, "{upright}");
    assert_eq!(chute.immersion.warnings(), []);
}
