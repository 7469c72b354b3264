//! Bodies on waves.

use super::Pond;
use rapier3d::prelude::*;
use rapier3d_immersed::free_surface::{Elevation, FreeSurface, Sea, WaveSpectrum, Waves};
use rapier3d_immersed::rapier3d;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::{Fluid, Medium};
use std::f64::consts::TAU;

/// A wave of Stokes to second order in its steepness ka, on deep water: the linear wave with η = a cos θ + ½ka² cos 2θ.
/// Its surface moves as the water in it does to third order; that of a linear wave alone does so to second order only,
/// which is the order of the drift.
#[derive(Clone, Copy)]
struct StokesWave {
    amplitude: f64,
    wavenumber: f64,
}

impl StokesWave {
    fn frequency(&self) -> f64 {
        let steepness = self.wavenumber * self.amplitude;
        (9.81 * self.wavenumber * (1.0 + steepness * steepness)).sqrt()
    }

    fn phase(&self, x: f64, time: f64) -> f64 {
        self.wavenumber * x - self.frequency() * time
    }
}

impl FreeSurface for StokesWave {
    fn elevation(&self, x: f64, _z: f64, time: f64) -> Elevation {
        let (phase, k) = (self.phase(x, time), self.wavenumber);
        let second = 0.5 * k * self.amplitude.powi(2);
        Elevation {
            height: self.amplitude * phase.cos() + second * (2.0 * phase).cos(),
            slope: [
                -k * (self.amplitude * phase.sin() + 2.0 * second * (2.0 * phase).sin()),
                0.0,
            ],
        }
    }

    fn velocity(&self, point: &Vector3<f64>, time: f64) -> Vector3<f64> {
        let phase = self.phase(point.x, time);
        let speed = self.amplitude * self.frequency() * (self.wavenumber * point.y).exp();
        Vector3::new(phase.cos(), phase.sin(), 0.0) * speed
    }

    fn highest(&self) -> f64 {
        2.0 * self.amplitude
    }
}

/// A raft of half a meter on a wave of 30 m goes up and down with it, to 1 %, and is carried along by the Stokes drift
/// a²ωk, to 10 % (Stokes 1847): the mean velocity of the water's particles in the surface, of which the orbital
/// velocities at the level of rest would give half. Over the water is nothing to speak of: still air would hold it back.
#[test]
fn a_raft_follows_a_long_wave_and_drifts() {
    let wave = StokesWave {
        amplitude: 0.25,
        wavenumber: TAU / 30.0,
    };
    let (a, omega, k) = (wave.amplitude, wave.frequency(), wave.wavenumber);
    let period = TAU / omega;
    for hertz in [60.0, 240.0] {
        let start = RigidBodyBuilder::dynamic()
            .translation(Vector::Y * a as f32)
            .linvel(Vector::X * (a * omega) as f32);
        let raft = ColliderBuilder::cuboid(0.25, 0.05, 0.25).density(500.0);
        let mut pond = Pond::new(start, raft, hertz);
        let nothing = Fluid::new(1e-3, 1e-3).unwrap();
        pond.immersion
            .set_medium(Medium::layered(nothing, Fluid::WATER).with_surface(wave));
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
