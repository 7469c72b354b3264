//! Nothing gains energy from still fluids.

use super::Pond;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rapier3d::prelude::*;
use rapier3d_immersed::rapier3d;
use rapier3d_immersed::rapier3d::na::Vector6;
use rapier3d_immersed::{Fluid, ImmersedBody, ViscousLaw};

/// Energy of a body and its fluids: kinetic with the fluids' added mass, weight, and buoyancy of what is over and under,
/// J.
fn energy(pond: &Pond) -> f64 {
    let body = pond.body();
    let mass = pond.immersion.mass_matrix_of(pond.body).unwrap();
    let back = body.rotation().inverse();
    let (v, w) = (back * body.linvel(), back * body.angvel());
    let v = Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z).map(f64::from);
    let floats = pond
        .immersion
        .hydrostatics(&pond.world.bodies, pond.body)
        .unwrap();
    let dry = pond.immersion.mass_of(pond.body).unwrap().mass;
    let [water, air] = [Fluid::WATER, Fluid::AIR].map(|fluid| f64::from(fluid.density()));
    let height = f64::from(body.center_of_mass().y);
    let whole = floats.submerged_volume / floats.submerged_share.max(1e-12);
    let whole = if floats.submerged_share > 0.0 {
        whole
    } else {
        0.0
    };
    let under = floats.submerged_volume * f64::from(floats.center_of_buoyancy.y);
    // Symmetric bodies: the middle of the volume is the center of mass.
    let displaced = air * whole * height + (water - air) * under;
    0.5 * v.dot(&(mass * v)) + 9.81 * (dry * height - displaced)
}

fn collider(kind: usize, size: [f32; 3], density: f32) -> ColliderBuilder {
    let [x, y, z] = size;
    let shape = match kind {
        0 => ColliderBuilder::cuboid(x, y, z),
        1 => ColliderBuilder::ball(x),
        2 => ColliderBuilder::cylinder(y, x),
        _ => ColliderBuilder::capsule_y(y, x),
    };
    shape.density(density)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 100,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(19),
        ..ProptestConfig::default()
    })]

    /// Random bodies thrown at water, at any step: the energy never grows. What single steps let it, at most a twelfth of it and
    /// of what lifts the body by 10 cm, is taken back: of any eight steps one is within 3 % of the least before.
    #[test]
    fn energy_never_grows(
        kind in 0_usize..4,
        size in prop::array::uniform3(0.01_f32..0.4),
        density in 30.0_f32..1500.0,
        at in -0.3_f32..0.6,
        turn in prop::array::uniform3(-3.0_f32..3.0),
        velocity in prop::array::uniform3(-4.0_f32..4.0),
        spin in prop::array::uniform3(-5.0_f32..5.0),
        hertz in prop::sample::select(vec![240.0_f32, 60.0, 20.0]),
        viscous in any::<bool>(),
    ) {
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::Y * at)
            .rotation(Vector::from(turn))
            .linvel(Vector::from(velocity))
            .angvel(Vector::from(spin));
        let law = if viscous { ViscousLaw::default() } else { ViscousLaw::Inviscid };
        let mut pond = Pond::over(Fluid::WATER, body, collider(kind, size, density), hertz, |hydro| {
            ImmersedBody::new(hydro).with_law(law).unwrap()
        });
        pond.immersion.step(&mut pond.world);
        let scale = pond.immersion.mass_of(pond.body).unwrap().mass * 9.81 * 0.1;
        let mut least = energy(&pond);
        let mut last = std::collections::VecDeque::from([least; 8]);
        for i in 0..(4.0 * hertz) as usize {
            pond.immersion.step(&mut pond.world);
            let now = energy(&pond);
            prop_assert!(now.is_finite());
            let size = scale + least.abs();
            prop_assert!(now < least + size / 12.0, "step {i}: {now} after {least}");
            let before = last.pop_front().unwrap_or(now);
            last.push_back(now);
            let lowest = last.iter().copied().fold(f64::INFINITY, f64::min);
            prop_assert!(lowest < least + 0.03 * size, "steps to {i}: {lowest} after {least}");
            least = least.min(before);
        }
    }
}
