//! Linear waves against what potential flow demands. Central differences over 10⁻⁴ m or s leave about 10⁻⁸ of what
//! they differ.

use crate::{at_surface, gradient, rise};
use rapier3d_immersed::free_surface::{Dispersion, FreeSurface, Sea, Wave, Waves};
use rapier3d_immersed::rapier3d::na::Vector3;
use std::f64::consts::TAU;

const STEP: f64 = 1e-4;

fn water(depth: f64) -> Dispersion {
    Dispersion {
        depth,
        ..Dispersion::default()
    }
}

fn wave(amplitude: f64, wavelength: f64) -> Wave {
    Wave {
        amplitude,
        wavelength,
        direction: [0.6, -0.8],
        phase: 0.7,
    }
}

/// Waves of one length, on water that is infinitely deep, as deep as a third of it, and shallow.
fn single() -> Vec<(Waves, f64)> {
    let of = |depth, amplitude| Waves::new(water(depth), &[wave(amplitude, 6.0)]).unwrap();
    vec![
        (of(f64::INFINITY, 0.2), f64::INFINITY),
        (of(2.0, 0.2), 2.0),
        (of(0.4, 0.05), 0.4),
    ]
}

/// Three waves of all lengths and directions, of 1 for the amplitudes of the steepest.
fn several(share: f64) -> Waves {
    let waves = [
        (0.5, 30.0, [1.0, 0.2], 0.3),
        (0.1, 6.0, [0.5, -0.5], 1.9),
        (0.02, 0.9, [0.7, 0.4], 4.0),
    ];
    let waves = waves.map(|(amplitude, wavelength, direction, phase)| Wave {
        amplitude: amplitude * share,
        wavelength,
        direction,
        phase,
    });
    Waves::new(water(f64::INFINITY), &waves).unwrap()
}

/// Places and times that are not special to any wave.
fn places() -> impl Iterator<Item = (f64, f64, f64)> {
    (0..200).map(|i| {
        let i = f64::from(i);
        (0.37 * i - 5.0, 3.0 - 0.59 * i, 0.53 * i)
    })
}

#[test]
fn slopes_are_the_heights_derivatives() {
    for surface in single()
        .into_iter()
        .map(|(waves, _)| waves)
        .chain([several(1.0)])
    {
        for (x, z, t) in places() {
            let height = |x, z| surface.elevation(x, z, t).height;
            let by_differences = [
                (height(x + STEP, z) - height(x - STEP, z)) / (2.0 * STEP),
                (height(x, z + STEP) - height(x, z - STEP)) / (2.0 * STEP),
            ];
            let slope = surface.elevation(x, z, t).slope;
            for axis in 0..2 {
                assert!((slope[axis] - by_differences[axis]).abs() < 1e-7);
            }
        }
    }
}

/// The velocity of one wave is the gradient of φ = (aω/k) cosh k(y + h)/sinh kh sin θ, so that the water is conserved and
/// does not turn; its particles accelerate as the pressure of Bernoulli's equation pushes them,
/// DU/Dt = −∇(p/ρ + gy) = ∇(∂φ/∂t + ½U²).
#[test]
fn water_is_a_potential_flow() {
    for (surface, depth) in single() {
        let Wave {
            amplitude,
            wavelength,
            direction: [dx, dz],
            phase,
        } = surface.waves()[0];
        let k = TAU / wavelength;
        let omega = TAU / surface.dispersion().period(wavelength).unwrap();
        // φ, and its derivative in time.
        let potential = |p: Vector3<f64>, t: f64| {
            let theta = k * (dx * p.x + dz * p.z) - omega * t + phase;
            let decay = if depth.is_finite() {
                (k * (p.y + depth)).cosh() / (k * depth).sinh()
            } else {
                (k * p.y).exp()
            };
            let scale = amplitude * omega / k * decay;
            [scale * theta.sin(), -omega * scale * theta.cos()]
        };
        for (x, z, t) in places() {
            for share in [0.0, 0.1, 0.5, 0.99] {
                let y = -share * depth.min(6.0);
                let point = Vector3::new(x, y, z);
                let along = |of: &dyn Fn(Vector3<f64>) -> f64| {
                    Vector3::from_fn(|axis, _| {
                        let step = Vector3::ith(axis, STEP);
                        (of(point + step) - of(point - step)) / (2.0 * STEP)
                    })
                };
                let velocity = surface.velocity(&point, t);
                let exact = along(&|p| potential(p, t)[0]);
                assert!((velocity - exact).norm() < 1e-7, "{velocity} {exact}");

                let gradient = gradient(&surface, point, t, STEP);
                assert!(gradient.trace().abs() < 1e-7);
                assert!((gradient - gradient.transpose()).norm() < 1e-7);

                let ahead = surface.velocity(&point, t + STEP);
                let change = (ahead - surface.velocity(&point, t - STEP)) / (2.0 * STEP);
                let acceleration = change + gradient * velocity;
                let pushed =
                    along(&|p| potential(p, t)[1] + 0.5 * surface.velocity(&p, t).norm_squared());
                assert!(
                    (acceleration - pushed).norm() < 1e-6,
                    "{acceleration} {pushed}"
                );
            }
        }
    }
}

/// At the level of rest the surface rises with the water, and the weight of what is above drives it: ∂η/∂t = w,
/// ∂u/∂t = −g∂η/∂x. The second holds by the dispersion only.
#[test]
fn surface_and_water_go_together() {
    for (surface, _) in single() {
        for (x, z, t) in places() {
            let level = Vector3::new(x, 0.0, z);
            let up = surface.velocity(&level, t).y;
            assert!((up - rise(&surface, x, z, t)).abs() < 1e-7);
            let ahead = surface.velocity(&level, t + STEP);
            let change = (ahead - surface.velocity(&level, t - STEP)) / (2.0 * STEP);
            let [sx, sz] = surface.elevation(x, z, t).slope;
            assert!((change.x + 9.81 * sx).abs() < 1e-6, "{change} {sx}");
            assert!((change.z + 9.81 * sz).abs() < 1e-6, "{change} {sz}");
        }
    }
}

/// Root mean square of what is left of ∂η/∂t + u·∇η − w at the surface, of the divergence and of the curl just below it,
/// over those of ∂η/∂t and the velocity's gradient.
fn left_over(surface: &Waves) -> [f64; 3] {
    let mut sums = [0.0; 5];
    for (x, z, t) in places() {
        let point = at_surface(surface, x, z, t);
        let velocity = surface.velocity(&point, t);
        let [sx, sz] = surface.elevation(x, z, t).slope;
        let rise = rise(surface, x, z, t);
        let kinematic = rise + velocity.x * sx + velocity.z * sz - velocity.y;
        let gradient = gradient(surface, point - Vector3::y() * 0.01, t, STEP);
        let curl = (gradient - gradient.transpose()).norm_squared();
        let terms = [
            kinematic * kinematic,
            rise * rise,
            gradient.trace().powi(2),
            curl,
            gradient.norm_squared(),
        ];
        for (sum, term) in sums.iter_mut().zip(terms) {
            *sum += term;
        }
    }
    let [kinematic, rise, divergence, curl, all] = sums;
    [kinematic / rise, divergence / all, curl / all].map(f64::sqrt)
}

/// Linear waves are wrong by their steepness: half as high, they are half as wrong.
#[test]
fn errors_are_of_the_order_of_the_steepness() {
    let several = |share| left_over(&several(share));
    let one = |share: f64| {
        let wave = wave(0.2 * share, 6.0);
        left_over(&Waves::new(water(f64::INFINITY), &[wave]).unwrap())
    };
    println!(
        "one wave of steepness .21: {:?}, half: {:?}",
        one(1.0),
        one(0.5)
    );
    println!(
        "three waves of .1 to .14: {:?}, half: {:?}",
        several(1.0),
        several(0.5)
    );
    // To second order the first is −a²kω sin 2θ, over aω sin θ.
    let steepness = 0.02 * TAU / 6.0;
    let found = one(0.1)[0];
    assert!(
        (found / steepness - 1.0).abs() < 0.05,
        "{found} {steepness}"
    );
    for of in [0, 1, 2] {
        let (full, half, quarter) = (several(0.5)[of], several(0.25)[of], several(0.125)[of]);
        assert!((full / half - 2.0).abs() < 0.4 && (half / quarter - 2.0).abs() < 0.2);
    }
    assert!((one(0.5)[0] / one(0.25)[0] - 2.0).abs() < 0.2);
}

/// Velocity with which a particle drifts that the water carries along the surface (or the level `at`, m), over `periods` of a
/// wave.
fn drift(surface: &Waves, at: Option<f64>, duration: f64, step: f64) -> f64 {
    let velocity = |x: f64, t: f64| {
        let point = match at {
            None => at_surface(surface, x, 0.0, t),
            Some(y) => Vector3::new(x, y, 0.0),
        };
        surface.velocity(&point, t).x
    };
    let (mut x, steps) = (0.0, (duration / step).round() as usize);
    for i in 0..steps {
        let t = i as f64 * step;
        let a = velocity(x, t);
        let b = velocity(x + 0.5 * step * a, t + 0.5 * step);
        let c = velocity(x + 0.5 * step * b, t + 0.5 * step);
        let d = velocity(x + step * c, t + step);
        x += step * (a + 2.0 * b + 2.0 * c + d) / 6.0;
    }
    x / (steps as f64 * step)
}

/// What floats drifts with Stokes' a²ωk cosh 2kh/(2 sinh² kh), in deep water a²ωk (Stokes 1847); half of it (in deep water)
/// comes from the velocity's growth toward the crest, which a particle at the level of rest does not feel.
#[test]
fn floating_particles_drift_as_stokes_says() {
    for (depth, steepness) in [(f64::INFINITY, 0.05), (f64::INFINITY, 0.1), (1.0, 0.04)] {
        let k = TAU / 6.0;
        let (amplitude, water) = (steepness / k, water(depth));
        let wave = Wave {
            amplitude,
            wavelength: 6.0,
            ..Wave::default()
        };
        let surface = Waves::new(water, &[wave]).unwrap();
        let period = water.period(6.0).unwrap();
        let shape = if depth.is_finite() {
            (2.0 * k * depth).cosh() / (2.0 * (k * depth).sinh().powi(2))
        } else {
            1.0
        };
        let stokes = steepness * steepness * TAU / period / k * shape;
        let found = drift(&surface, None, 500.0 * period, period / 40.0);
        println!(
            "depth {depth}, ka {steepness}: drift {:.4} of Stokes'",
            found / stokes
        );
        assert!((found / stokes - 1.0).abs() < 0.1, "{found} {stokes}");
        if depth.is_infinite() {
            let level = drift(&surface, Some(0.0), 500.0 * period, period / 40.0);
            assert!((level / stokes - 0.5).abs() < 0.05, "{level} {stokes}");
        }
    }
}

/// The drifts of a swell and of the waves that run on it add up.
#[test]
fn drifts_add_up() {
    let waves = [(0.4, 40.0), (0.05, 4.0)].map(|(amplitude, wavelength)| Wave {
        amplitude,
        wavelength,
        ..Wave::default()
    });
    let water = water(f64::INFINITY);
    let stokes = waves.map(|wave| {
        let (k, period) = (
            TAU / wave.wavelength,
            water.period(wave.wavelength).unwrap(),
        );
        wave.amplitude.powi(2) * k * TAU / period
    });
    let found = drift(&Waves::new(water, &waves).unwrap(), None, 4000.0, 0.04);
    println!("{:.4} of {stokes:?}", found / (stokes[0] + stokes[1]));
    assert!((found / (stokes[0] + stokes[1]) - 1.0).abs() < 0.1);
}

/// In a sea of waves down to a sixtieth of the peak's length, the water at the surface is about as fast as at the
/// level of rest, where its variance is Σ½a²ω². Waves that went on as e^ky above it would make it many times faster.
#[test]
fn short_waves_do_not_explode_on_long_ones() {
    let spectrum = rapier3d_immersed::free_surface::WaveSpectrum::jonswap(2.5, 7.0, 3.3).unwrap();
    let sea = Waves::sea(&Sea {
        spectrum,
        waves: 100,
        cutoff: 8.0,
        ..Sea::default()
    })
    .unwrap();
    let (mut square, mut most, mut exploded): (f64, f64, f64) = (0.0, 0.0, 0.0);
    let count = 4000;
    for i in 0..count {
        let t = 1.7 * f64::from(i);
        let point = at_surface(&sea, 0.0, 0.0, t);
        let speed = sea.velocity(&point, t).norm();
        square += speed * speed / f64::from(count);
        most = most.max(speed);
        let up: f64 = sea
            .waves()
            .iter()
            .map(|wave| {
                let (k, period) = (
                    TAU / wave.wavelength,
                    sea.dispersion().period(wave.wavelength).unwrap(),
                );
                let omega = TAU / period;
                wave.amplitude * omega * (k * point.y).exp() * (wave.phase - omega * t).sin()
            })
            .sum();
        exploded = exploded.max(up.abs());
    }
    let exact: f64 = sea
        .waves()
        .iter()
        .map(|wave| {
            (wave.amplitude * TAU / sea.dispersion().period(wave.wavelength).unwrap()).powi(2)
        })
        .sum();
    let ratio = (square / exact).sqrt();
    let deviation = (0.5 * exact).sqrt();
    println!(
        "rms {ratio:.3}, most {:.2}σ, by e^ky {:.0}σ",
        most / deviation,
        exploded / deviation
    );
    // Three components would be √(χ²) with 2 effective ones: one in 4000 is beyond 4σ.
    assert!((ratio - 1.0).abs() < 0.15 && most < 6.0 * deviation);
    assert!(
        exploded > 20.0 * deviation,
        "the test must be able to fail: {exploded}"
    );
}

/// Nothing moves up or down at the bottom, and nothing moves in the deep.
#[test]
fn water_rests_below() {
    for (surface, depth) in single() {
        for (x, z, t) in places() {
            if depth.is_finite() {
                let bottom = surface.velocity(&Vector3::new(x, -depth, z), t);
                let below = surface.velocity(&Vector3::new(x, -3.0 * depth, z), t);
                assert!(bottom.y.abs() < 1e-12 && bottom == below);
            } else {
                let level = surface.velocity(&Vector3::new(x, 0.0, z), t);
                let deep = surface.velocity(&Vector3::new(x, -3.0, z), t);
                assert!((deep - level * (-0.5 * TAU).exp()).norm() < 1e-12);
                assert!(surface.velocity(&Vector3::new(x, -1e9, z), t).norm() < 1e-15);
            }
        }
    }
}

/// Places that are none give numbers, not NaN.
#[test]
fn every_place_has_a_surface() {
    let surface = several(1.0);
    for bad in [f64::NAN, f64::INFINITY, -1e300, 1e12] {
        for place in [[bad, 1.0, 2.0], [1.0, bad, 2.0], [1.0, 2.0, bad]] {
            let [x, z, t] = place;
            let elevation = surface.elevation(x, z, t);
            assert!(elevation.height.abs() <= surface.highest());
            assert!(
                surface
                    .velocity(&Vector3::new(x, bad, z), t)
                    .iter()
                    .all(|v| v.is_finite())
            );
        }
    }
}
