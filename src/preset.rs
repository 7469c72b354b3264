//! Settings under which rapier stacks leaves.
//!
//! Rapier's defaults are for bodies of a meter: 5 mm of contact slop, a 2 cm prediction distance and
//! 30 Hz contacts let a pile of leaves 0.3 mm thick collapse into itself. What a pile of 1000 leaves
//! of 7.3 × 4.2 × 0.03 cm does (solid stack: 5.7 mm):
//!
//! | setting | dense pile, awake | height |
//! |---|---|---|
//! | rapier's defaults, 60 Hz | 127 ms/step | 5 mm |
//! | `length_unit` 0.01, 60 Hz | 61–70 ms | 1 mm, collapsed |
//! | **[`leaf_scale`]**, 240 Hz × 8 substeps | 10–15 ms | 34 mm |
//! | 2 mm thick collision proxy, 120 Hz × 4 | 4 ms | 82 mm |
//!
//! The rule behind it: contacts at about 480 Hz need four substeps per period, that is 1920 substeps
//! per second. The bench `pile` lays 1000 such leaves into a tray of 0.4 × 0.4 m in tidy layers, which
//! pack closer than the leaves of the table, which fell: under rapier's defaults they collapse to 1 mm
//! (95th percentile of the heights); under [`leaf_scale`] they hold 13 mm and come to rest (0.3 mm/s
//! root mean square after 4 s; 0.8 mm/s without the fluid), at 1.4 times the cost of the same pile
//! without the fluid. That is too much motion for rapier's sleep threshold, which asks for less than
//! 1 mm/s of *every* leaf of an island; looser heaps, as in the example `falling_leaves`, do fall asleep.

use rapier3d::dynamics::{IntegrationParameters, RigidBodyBuilder, SpringCoefficients};

/// Time step of [`leaf_scale`], s.
pub const LEAF_DT: f32 = 1.0 / 240.0;

/// Settings for leaves, paper, confetti, coins: bodies of centimeters, thinner than a millimeter.
///
/// Sets `dt` to [`LEAF_DT`] with 8 substeps, `length_unit` to a centimeter (which scales slop,
/// prediction distance and sleep threshold), contacts to 480 Hz, and the speed limit back to the
/// 400 m/s that the small length unit would lower to 4.
///
/// ```
/// use rapier3d_immersed::preset;
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// let mut world = PhysicsWorld::new();
/// preset::leaf_scale(&mut world.integration_parameters);
/// assert_eq!(world.integration_parameters.dt, preset::LEAF_DT);
/// // 5 mm of allowed penetration become 0.05 mm, a sixth of a leaf's thickness.
/// assert!((world.integration_parameters.allowed_linear_error() - 5e-5).abs() < 1e-9);
/// ```
pub fn leaf_scale(parameters: &mut IntegrationParameters) {
    let contacts = SpringCoefficients {
        natural_frequency: 480.0,
        ..parameters.contact_softness
    };
    parameters.dt = LEAF_DT;
    parameters.num_solver_iterations = 8;
    parameters.length_unit = 0.01;
    parameters.contact_softness = contacts;
    parameters.static_contact_softness = SpringCoefficients {
        natural_frequency: 480.0,
        ..parameters.static_contact_softness
    };
    parameters.normalized_max_linear_velocity = 400.0 / parameters.length_unit;
}

/// A body builder with the predictive contacts (5 mm) that thin bodies need against each other, where
/// rapier has no continuous collision detection.
///
/// ```
/// use rapier3d_immersed::preset;
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// let mut world = PhysicsWorld::new();
/// let leaf = ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(300.0);
/// let (leaf, _) = world.insert(preset::leaf_body(RigidBodyBuilder::dynamic()), leaf);
/// assert_eq!(world.bodies[leaf].soft_ccd_prediction(), 0.005);
/// ```
pub fn leaf_body(builder: RigidBodyBuilder) -> RigidBodyBuilder {
    builder.soft_ccd_prediction(0.005)
}
