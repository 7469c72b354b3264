//! Bodies on waves.

use super::Pond;
use rapier3d::prelude::*;
use rapier3d_immersed::free_surface::{Dispersion, Sea, Wave, WaveSpectrum, Waves};
use rapier3d_immersed::rapier3d;
use rapier3d_immersed::{Fluid, Medium};
use std::f64::consts::TAU;

/// A light raft of half a meter on a wave of this height and length, and what the wave is: amplitude, ω, k.
fn raft(amplitude: f64, wavelength: f64, hertz: f32) -> (Pond, [f64; 3]) {
    let wave = Wave {
        amplitude,
        wavelength,
        ..Wave::default()
    };
    let mut pond = Pond::new(
        RigidBodyBuilder::dynamic().translation(Vector::Y * amplitude as f32),
        ColliderBuilder::cuboid(0.25, 0.025, 0.25).density(100.0),
        hertz,
    );
    // Nothing to speak of over the water: still air would hold the raft back, whose freeboard is nine times its draft.
    let nothing = Fluid::new(1e-3, 1e-3).unwrap();
    let waves = Waves::new(Dispersion::default(), &[wave]).unwrap();
    pond.immersion
        .set_medium(Medium::layered(nothing, Fluid::WATER).with_surface(waves));
    let k = TAU / wavelength;
    (pond, [amplitude, (9.81 * k).sqrt(), k])
}

/// A light raft on a long wave goes up and down with it, to 1 %, and is carried along by the Stokes drift a²ωk, to
/// 10 % (Stokes 1847): its particles' mean velocity where they are, which the orbital velocities at the level of rest
/// would give half of.
#[test]
fn a_light_raft_follows_a_long_wave_and_drifts() {
    for hertz in [60.0, 240.0] {
        let (mut pond, [a, omega, k]) = raft(0.5, 30.0, hertz);
        let period = TAU / omega;
        // Ten periods to settle, ten to look.
        pond.run((10.0 * period) as f32);
        let start = pond.body().translation().x;
        let (mut least, mut most) = (f32::MAX, f32::MIN);
        for _ in 0..(10.0 * period * f64::from(hertz)).round() as usize {
            pond.immersion.step(&mut pond.world);
            let y = pond.body().translation().y;
            (least, most) = (least.min(y), most.max(y));
        }
        let amplitude = f64::from(most - least) / 2.0;
        let drift = f64::from(pond.body().translation().x - start) / (10.0 * period);
        let stokes = a * a * omega * k;
        println!("{hertz}: amplitude {amplitude} of {a}, drift {drift} of {stokes}");
        assert!((amplitude / a - 1.0).abs() < 0.01, "{hertz}: {amplitude}");
        assert!(
            (drift / stokes - 1.0).abs() < 0.1,
            "{hertz}: {drift} for {stokes}"
        );
    }
}

/// In a random sea crates stay at the surface, whatever the step, and numbers stay numbers.
#[test]
fn crates_ride_a_sea() {
    for hertz in [20.0, 60.0] {
        let spectrum = WaveSpectrum::jonswap(1.5, 5.0, 3.3).unwrap();
        let sea = Waves::sea(&Sea {
            spectrum,
            seed: 3,
            ..Sea::default()
        });
        let mut pond = Pond::new(
            RigidBodyBuilder::dynamic(),
            ColliderBuilder::cuboid(0.5, 0.4, 0.6).density(300.0),
            hertz,
        );
        pond.immersion
            .set_medium(Medium::layered(Fluid::AIR, Fluid::WATER).with_surface(sea.unwrap()));
        let mut deepest = 1.0_f64;
        for i in 0..(60.0 * hertz) as usize {
            pond.immersion.step(&mut pond.world);
            let floats = pond
                .immersion
                .hydrostatics(&pond.world.bodies, pond.body)
                .unwrap();
            let speed = pond.body().linvel().length();
            assert!(speed < 4.0, "{hertz}, step {i}: {speed}");
            if i > (5.0 * hertz) as usize {
                deepest = deepest.min(floats.submerged_share);
                assert!(
                    floats.submerged_share < 0.95,
                    "{hertz}, step {i}: {floats:?}"
                );
            }
        }
        assert!(deepest > 0.02, "{hertz}: {deepest}");
        assert!(!pond.body().is_sleeping());
    }
}
