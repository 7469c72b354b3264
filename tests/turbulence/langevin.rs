//! The fluctuation that a body sees has the variance and the memory of theory for every time step,
//! whoever computes it.

use rapier3d::math::Vector;
use rapier3d_immersed::rapier3d;
use rapier3d_immersed::turbulence::{
    KEpsilon, NoiseStream, SeenFluctuation, TurbulenceState, kolmogorov_constant,
    relative_velocity_after,
};

const SAMPLES: u64 = 100_000;
const STATE: TurbulenceState = TurbulenceState {
    kinetic_energy: 0.9,
    dissipation: 1.8,
};
const C0: f32 = 4.0;

/// Variance and correlation at `lag` steps over 10⁵ samples, each with its standard error.
///
/// For a stationary Gaussian sequence of correlation ρ(τ) = r^|τ| the error of the estimated variance
/// is σ²√(2/N (1+r²)/(1−r²)); that of the covariance at lag m is Bartlett's
/// σ²√((1/N) Σ (ρ_j² + ρ_{j+m}ρ_{j−m})).
fn check_memory(values: &[f64], variance: f64, r: f64, lag: usize, what: &str) {
    let n = values.len() as f64;
    let found = values.iter().map(|x| x * x).sum::<f64>() / n;
    let error = variance * (2.0 / n * (1.0 + r * r) / (1.0 - r * r)).sqrt();
    let z = (found - variance) / error;
    assert!(
        z.abs() < 3.0,
        "{what}: variance {found}, theory {variance}, {z} errors"
    );

    let pairs = values.iter().zip(&values[lag..]);
    let covariance = pairs.map(|(a, b)| a * b).sum::<f64>() / (n - lag as f64);
    let theory = variance * r.powi(lag as i32);
    let far = (40.0 / -r.ln()).ceil() as i32 + lag as i32;
    let rho = |j: i32| r.powi(j.abs());
    let m = lag as i32;
    let sum: f64 = (-far..=far)
        .map(|j| rho(j).powi(2) + rho(j + m) * rho(j - m))
        .sum();
    let z = (covariance - theory) / (variance * (sum / n).sqrt());
    assert!(
        z.abs() < 3.0,
        "{what}: covariance {covariance}, theory {theory}, {z} errors"
    );
    println!(
        "{what}: variance {found:.4} of {variance:.4}, covariance {covariance:.4} of {theory:.4}"
    );
}

#[test]
fn seen_fluctuation_has_the_variance_and_memory_of_theory_for_every_step() {
    let variance = f64::from(STATE.kinetic_energy) * 2.0 / 3.0;
    let rate = 0.75 * f64::from(C0 * STATE.turnover_rate());
    for (seed, dt) in [0.001f32, 0.01, 1.0 / 60.0, 0.1].into_iter().enumerate() {
        let stream = NoiseStream::new(11, seed as u64);
        let mut seen = SeenFluctuation::stationary(stream.vector(0, 0));
        let values: Vec<f64> = (1..=SAMPLES)
            .map(|step| {
                let noise = stream.vector(step, 0);
                f64::from(seen.advance(&STATE, C0, 0.0, dt, noise).y)
            })
            .collect();
        let r = (-rate * f64::from(dt)).exp();
        // About half a memory away.
        let lag = ((0.5 / rate / f64::from(dt)).round() as usize).max(1);
        check_memory(&values, variance, r, lag, &format!("seen, dt = {dt}"));
    }
}

/// Frozen k and ε: (⅔k) C₀/(C₀ + ⅔) with the thesis's drift (½ + ¾C₀)χ.
#[test]
fn thesis_increments_have_their_own_stationary_variance() {
    let c0 = f64::from(C0);
    let variance = 2.0 / 3.0 * f64::from(STATE.kinetic_energy) * c0 / (c0 + 2.0 / 3.0);
    let rate = (0.5 + 0.75 * c0) * f64::from(STATE.turnover_rate());
    for (seed, dt) in [0.001f32, 0.02, 0.1].into_iter().enumerate() {
        let stream = NoiseStream::new(12, seed as u64);
        let mut v = stream.vector(0, 0) * variance.sqrt() as f32;
        let values: Vec<f64> = (1..=SAMPLES)
            .map(|step| {
                v = relative_velocity_after(v, &STATE, C0, dt, stream.vector(step, 0));
                f64::from(v.z)
            })
            .collect();
        let r = (-rate * f64::from(dt)).exp();
        let lag = ((0.5 / rate / f64::from(dt)).round() as usize).max(1);
        check_memory(&values, variance, r, lag, &format!("thesis, dt = {dt}"));
    }
}

/// ⟨u²⟩ = ⅔k(t) at every instant of decaying turbulence, with steps from 1/1000 to 1/10 s. The thesis's form,
/// with the ½ in the drift, must agree for short steps, where freezing k during one does no harm.
#[test]
fn decaying_turbulence_keeps_its_variance_at_two_thirds_k() {
    let model = KEpsilon::default();
    let (k0, e0) = (
        f64::from(STATE.kinetic_energy),
        f64::from(STATE.dissipation),
    );
    for (dt, bodies) in [(0.001f32, 2_000u64), (0.02, 20_000), (0.1, 20_000)] {
        let steps = (1.0 / dt).round() as u64;
        let states: Vec<TurbulenceState> = (1..=steps)
            .map(|step| {
                let (k, e) = model.advance(k0, e0, 0.0, step as f64 * f64::from(dt));
                TurbulenceState {
                    kinetic_energy: k as f32,
                    dissipation: e as f32,
                }
            })
            .collect();
        let (mut seen_sum, mut thesis_sum) = (0.0, 0.0);
        for body in 0..bodies {
            let stream = NoiseStream::new(13, body);
            let start = stream.vector(0, 0);
            let mut seen = SeenFluctuation::stationary(start);
            let mut last = Vector::ZERO;
            let mut thesis = start * STATE.deviation();
            for (step, state) in states.iter().enumerate() {
                let noise = stream.vector(step as u64 + 1, 0);
                last = seen.advance(state, C0, 0.0, dt, noise);
                thesis = relative_velocity_after(thesis, state, C0, dt, noise);
            }
            seen_sum += f64::from(last.length_squared());
            thesis_sum += f64::from(thesis.length_squared());
        }
        let n = 3.0 * bodies as f64;
        let theory = 2.0 / 3.0 * f64::from(states.last().unwrap().kinetic_energy);
        let error = theory * (2.0 / n).sqrt();
        let z = (seen_sum / n - theory) / error;
        assert!(z.abs() < 3.0, "dt {dt}: {z} standard errors");
        if dt < 0.01 {
            let z = (thesis_sum / n - theory) / error;
            assert!(z.abs() < 3.0, "thesis's form, dt {dt}: {z} standard errors");
        }
        println!(
            "dt {dt}: ⟨u²⟩ {:.5}, ⅔k {theory:.5}, thesis {:.5}",
            seen_sum / n,
            thesis_sum / n
        );
    }
}

/// Many bodies on one, two and four threads, forward and backward: the same bits.
#[test]
fn threads_and_order_do_not_matter() {
    let run = |body: u64| {
        let stream = NoiseStream::new(99, body);
        let mut seen = SeenFluctuation::stationary(stream.vector(0, 0));
        let mut sum = Vector::ZERO;
        for step in 1..50 {
            sum += seen.advance(&STATE, C0, 0.2, 0.01, stream.vector(step, 0));
        }
        sum.to_array().map(f32::to_bits)
    };
    let serial: Vec<_> = (0..256).map(run).collect();
    let mut backward: Vec<_> = (0..256).rev().map(run).collect();
    backward.reverse();
    assert_eq!(serial, backward);
    for threads in [2usize, 4] {
        let share = 256 / threads as u64;
        let parts: Vec<Vec<_>> = std::thread::scope(|scope| {
            let handles: Vec<_> = (0..threads as u64)
                .map(|t| scope.spawn(move || (t * share..(t + 1) * share).map(run).collect()))
                .collect();
            handles.into_iter().map(|h| h.join().unwrap()).collect()
        });
        assert_eq!(serial, parts.concat());
    }
}

/// A sphere of response time τ in the seen velocity (linear drag) has the variance
/// σ² T/(T + τ): Tchen (1947), Hinze (1975) §5.7, for an exponential memory T. A tracer follows.
#[test]
fn heavy_bodies_filter_and_tracers_follow() {
    let state = STATE;
    let c0 = kolmogorov_constant(state.taylor_reynolds_squared(1.0e-4));
    let memory = 1.0 / (0.75 * c0 * state.turnover_rate());
    let (dt, steps, bodies) = (memory / 50.0, 2_000u64, 120u64);
    for ratio in [0.0f32, 1.0, 4.0] {
        let tau = ratio * memory;
        // Exact response to the velocity held over a step.
        let kept = if tau > 0.0 { (-dt / tau).exp() } else { 0.0 };
        let (mut sum, mut count) = (0.0, 0.0);
        for body in 0..bodies {
            let stream = NoiseStream::new(21, body);
            let mut seen = SeenFluctuation::stationary(stream.vector(0, 0));
            let mut v = Vector::ZERO;
            for step in 1..=steps {
                let u = seen.advance(&state, c0, 0.0, dt, stream.vector(step, 0));
                v = u + (v - u) * kept;
                if step > 1_000 {
                    sum += f64::from(v.length_squared());
                    count += 3.0;
                }
            }
        }
        let found = sum / count / f64::from(state.deviation()).powi(2);
        let theory = 1.0 / (1.0 + f64::from(ratio));
        // 360 series of 20 memories, at least 2 independent values each: 3 standard errors
        // of √(2/1440·(1+ratio)) plus the error O(dt/memory) of holding u over a step.
        let tolerance = theory * (3.0 * (2.0 / 1440.0 * (1.0 + f64::from(ratio))).sqrt() + 0.02);
        assert!(
            (found - theory).abs() < tolerance,
            "τ/T = {ratio}: {found}, theory {theory}"
        );
        println!("τ/T = {ratio}: {found:.4}, theory {theory:.4}");
    }
}
