//! Langevin equations in closed form: what a step of any length does to a fluctuating velocity.
//!
//! The thesis (§4.3) adds random increments to the body's own velocity. The default here is the
//! physical one: the *fluid velocity that the body sees* fluctuates, and the body follows it as its
//! drag and added mass let it, so heavy bodies filter the turbulence and light ones follow.

use super::TurbulenceState;
use crate::math::Scalar;
use rapier3d::math::{Real, Vector};

/// C₀ of the Langevin equation, 6.5 (1 + 140 Re_λ^(−4/3))^(−3/4), of the *square* of the Taylor-scale
/// Reynolds number (see [`TurbulenceState::taylor_reynolds_squared`]).
///
/// Source: Pope (2011), Phys. Fluids 23, 011301; the thesis (4.10)–(4.11) inserts the body's Reynolds
/// number, which overstates C₀. It tends to 6.5 for strong turbulence and to 0 for weak.
///
/// ```
/// use rapier3d_immersed::turbulence::kolmogorov_constant;
///
/// let reynolds: f32 = 100.0;
/// // 6.5 (1 + 140/464)^(−3/4) at Re_λ = 100.
/// assert!((kolmogorov_constant(reynolds * reynolds) - 5.33).abs() < 0.01);
/// ```
#[inline]
pub fn kolmogorov_constant(taylor_reynolds_squared: Real) -> Real {
    let root = cube_root(taylor_reynolds_squared);
    let x = 1.0 + 140.0 / (root * root);
    // x^(−3/4) by square roots, which are several times cheaper than a power.
    let root = x.sqrt();
    6.5 / (root * root.sqrt())
}

/// Cube root of a number ≥ 0 to a few roundings: a first guess from the exponent and two Newton steps,
/// several times cheaper than the library's, and the same on every platform.
#[inline]
fn cube_root(x: Real) -> Real {
    // NaN is treated as zero.
    let x = if x > 1.0e-30 { x.min(1.0e30) } else { 1.0e-30 };
    let guess = Real::from_bits(x.to_bits() / 3 + 709_921_077);
    let guess = (2.0 * guess + x / (guess * guess)) / 3.0;
    (2.0 * guess + x / (guess * guess)) / 3.0
}

/// 1 − e^(−x) by eight terms of its series, accurate to 1e-8 from 0 to .35.
#[inline(always)]
fn lost<T: Scalar>(x: T) -> T {
    let one = x.constant(1.0);
    let mut sum = one;
    for n in (2..9).rev() {
        sum = one - x * x.constant(1.0 / f64::from(n)) * sum;
    }
    x * sum
}

/// e^(−x) and 1 − e^(−2x) for x ≥ 0. The second is m(2 − m) of m = 1 − e^(−x), without cancellation, so that
/// even a step of a millionth of the memory adds the right spread in f32. It takes basic operations only,
/// which are cheap and give the same bits on every platform and in every lane.
#[inline(always)]
fn memory<T: Scalar>(x: T) -> (T, T) {
    let one = x.constant(1.0);
    let short = x.constant(0.35);
    let few = lost(x.min(short));
    let (kept, fresh2) = (one - few, few * (one + (one - few)));
    // Usual steps are short.
    if (-x).all_ge(-0.35) {
        return (kept, fresh2);
    }
    // e^(−x/64) is squared six times; beyond x = 22 nothing is kept.
    let mut long = one - lost(x.min(x.constant(22.0)) * x.constant(1.0 / 64.0));
    for _ in 0..6 {
        long *= long;
    }
    (
        kept.select_lt(x, short, long),
        fresh2.select_lt(x, short, one - long * long),
    )
}

/// e^(−x) and 1 − e^(−x) for x ≥ 0, each without cancellation.
#[inline(always)]
pub(crate) fn decay(x: Real) -> (Real, Real) {
    let (kept, _) = memory(x);
    let gone = if x < 0.35 { lost(x) } else { 1.0 - kept };
    (kept, gone)
}

/// The velocity fluctuation of the fluid around one body, as an Ornstein–Uhlenbeck process.
///
/// What is stored is the fluctuation divided by its standard deviation √(2k/3). Its equation
/// dg = −¾C₀χ g dt + √(3/2 C₀χ) dW is thesis (4.8) divided by √(2k/3): the ½χ in the thesis's drift is
/// the decay of k itself. So ⟨u²⟩ = ⅔k per component *exactly*, for steady, decaying or growing
/// k, for every time step; and one step of length dt is many small ones.
///
/// [`Immersion`](crate::Immersion) keeps one for each of its bodies. With one of your own, anything else
/// can drift in the same turbulence:
///
/// ```
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::turbulence::{NoiseStream, SeenFluctuation, TurbulenceState};
/// use rapier3d_immersed::turbulence::kolmogorov_constant;
///
/// let state = TurbulenceState { kinetic_energy: 0.15, dissipation: 0.3 }; // 0.32 m/s, 0.5 s
/// let c0 = kolmogorov_constant(state.taylor_reynolds_squared(1.5e-5));
/// let noise = NoiseStream::new(1, 0);
/// let mut seen = SeenFluctuation::stationary(noise.vector(0, 0));
/// let (mut square, steps) = (0.0, 20_000);
/// for step in 1..=steps {
///     square += seen.advance(&state, c0, 0.0, 0.1, noise.vector(step, 0)).length_squared();
/// }
/// // ½⟨u²⟩ = k, within the error of a mean over some thousand independent values.
/// assert!((0.5 * square / steps as f32 / 0.15 - 1.0).abs() < 0.05);
/// ```
///
/// In space the process knows only the local k: where k varies strongly, fluid tracers (not heavy bodies)
/// would need a drift along ∇k to stay evenly mixed, which is left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct SeenFluctuation {
    /// Fluctuation over standard deviation, world axes. A body for which it is zero starts in quiet fluid.
    pub normalized: Vector,
}

impl SeenFluctuation {
    /// A body that has been in the turbulence for long: `noise` is three standard Gaussian numbers.
    pub fn stationary(noise: Vector) -> Self {
        Self { normalized: noise }
    }

    /// One step of `dt` seconds; returns the velocity fluctuation at its end, m/s, world axes.
    ///
    /// `c0` is [`kolmogorov_constant`] of the state, `noise` three standard Gaussian numbers of this
    /// body and step. `relative_speed` is the body's mean speed through the fluid (m/s): a body that
    /// falls through the eddies sees them pass faster than a tracer does, which shortens the memory
    /// by √(1 + u_r²/(⅔k)) (Csanady 1963, with Lagrangian and Eulerian time scales taken as equal). It is
    /// 0 for a tracer.
    #[inline]
    pub fn advance(
        &mut self,
        state: &TurbulenceState,
        c0: Real,
        relative_speed: Real,
        dt: Real,
        noise: Vector,
    ) -> Vector {
        let eddies = Eddies::new(state, c0, dt);
        let mut seen = self.normalized.to_array();
        let slip2 = relative_speed * relative_speed;
        let fluctuation = pass(&mut seen, &eddies, slip2, noise.to_array());
        self.normalized = Vector::from_array(seen);
        Vector::from_array(fluctuation)
    }
}

/// One step of a normalized fluctuation `seen` through `eddies` at a squared slip (m²/s²); returns the
/// fluctuation at its end, m/s, as [`SeenFluctuation::advance`].
#[inline(always)]
pub(crate) fn pass<T: Scalar>(
    seen: &mut [T; 3],
    eddies: &Eddies<T>,
    slip2: T,
    noise: [T; 3],
) -> [T; 3] {
    let crossing = (slip2.constant(1.0) + slip2 * eddies.per_variance).sqrt();
    let (kept, fresh2) = memory(eddies.decay * crossing);
    let fresh = fresh2.sqrt();
    for axis in 0..3 {
        seen[axis] = seen[axis] * kept + noise[axis] * fresh;
    }
    let [x, y, z] = *seen;
    let deviation = eddies.deviation;
    [x * deviation, y * deviation, z * deviation]
}

/// What a step needs to know of the turbulence: the same for all bodies if it is homogeneous, and zero
/// without turbulence.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eddies<T> {
    /// dt over the memory of a tracer.
    pub decay: T,
    /// Standard deviation of a component, m/s.
    pub deviation: T,
    /// Inverse square of the deviation, s²/m².
    pub per_variance: T,
}

impl Eddies<Real> {
    pub fn new(state: &TurbulenceState, c0: Real, dt: Real) -> Self {
        let k = state.kinetic_energy;
        if k.is_nan() || k <= 0.0 {
            return Self {
                decay: 0.0,
                deviation: 0.0,
                per_variance: 0.0,
            };
        }
        let variance = k * (2.0 / 3.0);
        Self {
            decay: 0.75 * c0 * state.dissipation / k * dt,
            deviation: variance.sqrt(),
            per_variance: 1.0 / variance,
        }
    }
}

/// The thesis's mode: the body's velocity relative to the local mean flow after `dt` seconds of
/// dv = −(½ + ¾C₀)χ v dt + √(C₀ε) dW, thesis (4.12) with the exact update instead of (4.14)'s Euler step.
///
/// `noise` is three standard Gaussian numbers. With frozen k and ε the variance of v tends to
/// (⅔k) C₀/(C₀ + ⅔).
#[inline]
pub fn relative_velocity_after(
    relative_velocity: Vector,
    state: &TurbulenceState,
    c0: Real,
    dt: Real,
    noise: Vector,
) -> Vector {
    let alpha = (0.5 + 0.75 * c0) * state.turnover_rate();
    let (kept, fresh2) = memory(alpha * dt);
    let variance = if alpha > 0.0 {
        c0 * state.dissipation / (2.0 * alpha)
    } else {
        0.0
    };
    relative_velocity * kept + noise * (variance * fresh2).sqrt()
}

/// The thesis's mode: random change of the body's spin in `dt` seconds, √(C₀ε dt)/L, rad/s.
///
/// Thesis (4.13) without the length L of the body (m) would be a velocity. This only adds spin; the vortical
/// loads take it away again (thesis §4.3.2).
#[inline]
pub fn spin_increment(
    state: &TurbulenceState,
    c0: Real,
    length: Real,
    dt: Real,
    noise: Vector,
) -> Vector {
    noise * ((c0 * state.dissipation * dt).max(0.0).sqrt() / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The formula of Pope (2011), evaluated independently at five Reynolds numbers, to three digits.
    #[test]
    fn kolmogorov_constant_of_the_taylor_scale() {
        for (reynolds, c0) in [
            (50.0, 4.25),
            (100.0, 5.33),
            (200.0, 5.97),
            (500.0, 6.33),
            (1000.0, 6.43),
        ] {
            let found = kolmogorov_constant(reynolds * reynolds);
            assert!((found - c0).abs() < 5.1e-3, "{reynolds}: {found}");
        }
        assert!(kolmogorov_constant(0.0) < 1.0e-12);
        assert_eq!(kolmogorov_constant(f32::INFINITY), 6.5);
        for x in [1.0e-20f32, 0.37, 1.0, 8.0, 2.5e4, 7.7e20] {
            assert!((cube_root(x) / x.cbrt() - 1.0).abs() < 1.0e-5, "{x}");
        }
    }

    #[test]
    fn memory_is_accurate_for_any_step() {
        for x in [
            0.0f32, 1.0e-9, 1.0e-5, 0.01, 0.049, 0.051, 0.1, 0.349, 0.351, 1.0, 5.0, 90.0,
        ] {
            let (kept, fresh2) = memory(x);
            let y = f64::from(x);
            // Six squarings of a number that is rounded to 6e-8 make 64 roundings of the result.
            assert!(
                (f64::from(kept) - (-y).exp()).abs() < 4.0e-6 * (-y).exp() + 1.0e-9,
                "{x}"
            );
            let exact = -(-2.0 * y).exp_m1();
            assert!(
                (f64::from(fresh2) - exact).abs() <= 4.0e-6 * exact,
                "{x}: {fresh2} {exact}"
            );
            let (kept, gone) = decay(x);
            let exact = -(-y).exp_m1();
            assert!(
                (f64::from(gone) - exact).abs() <= 4.0e-6 * exact,
                "{x}: {gone}"
            );
            assert!((kept + gone - 1.0).abs() < 2.0e-7);
        }
    }

    /// One long step has the same memory and the same spread as many short ones.
    #[test]
    fn steps_compose() {
        let state = TurbulenceState {
            kinetic_energy: 0.6,
            dissipation: 2.0,
        };
        let one = |dt: f32, n: u32| {
            // The memory shows in a start without noise, the spread with a noise of one in every step.
            let mut seen = SeenFluctuation::stationary(Vector::X);
            let mut thesis = Vector::X;
            let (mut spread, mut thesis_spread) = (0.0, 0.0);
            for _ in 0..n {
                seen.advance(&state, 4.0, 0.3, dt, Vector::ZERO);
                thesis = relative_velocity_after(thesis, &state, 4.0, dt, Vector::ZERO);
                let mut fresh = SeenFluctuation::default();
                fresh.advance(&state, 4.0, 0.3, dt, Vector::X);
                let kept = {
                    let mut s = SeenFluctuation::stationary(Vector::X);
                    s.advance(&state, 4.0, 0.3, dt, Vector::ZERO);
                    s.normalized.x
                };
                spread = spread * kept * kept + fresh.normalized.x.powi(2);
                let fresh = relative_velocity_after(Vector::ZERO, &state, 4.0, dt, Vector::X).x;
                let kept = relative_velocity_after(Vector::X, &state, 4.0, dt, Vector::ZERO).x;
                thesis_spread = thesis_spread * kept * kept + fresh * fresh;
            }
            [seen.normalized.x, thesis.x, spread, thesis_spread]
        };
        for (a, b) in one(0.1, 1).into_iter().zip(one(0.001, 100)) {
            // The tolerance is a hundred f32 roundings of 6e-8.
            assert!((a - b).abs() < 1.0e-5, "{a} {b}");
        }
    }

    /// One step keeps e^(−x) of the fluctuation and adds √(1 − e^(−2x)) of the noise, x = ¾C₀χ dt √(1 + u²/(⅔k))
    /// with the speed u through the eddies; in the thesis's mode e^(−y), y = (½ + ¾C₀)χ dt, and a share of the
    /// variance ½C₀ε/(½ + ¾C₀)χ. By hand, for short steps and long ones.
    #[test]
    fn one_step() {
        let state = TurbulenceState {
            kinetic_energy: 0.6,
            dissipation: 2.0,
        };
        let (k, epsilon, c0) = (0.6_f64, 2.0, 4.0);
        for (dt, speed) in [(0.01, 0.0), (0.01, 2.5), (0.3, 0.4), (0.3, 2.5), (2.0, 1.5)] {
            let deviation = (2.0 / 3.0 * k).sqrt();
            let x = 0.75 * c0 * epsilon / k * dt * (1.0 + speed * speed / (2.0 / 3.0 * k)).sqrt();
            let (kept, fresh) = ((-x).exp(), (-(-2.0 * x).exp_m1()).sqrt());
            let mut seen = SeenFluctuation::stationary(Vector::new(1.0, -0.5, 0.0));
            let noise = Vector::new(0.3, 0.0, -2.0);
            let (dt32, speed32) = (dt as Real, speed as Real);
            let found = seen.advance(&state, c0 as Real, speed32, dt32, noise);
            let exact = [kept + 0.3 * fresh, -0.5 * kept, -2.0 * fresh];
            for axis in 0..3 {
                let miss = f64::from(found[axis]) - deviation * exact[axis];
                assert!(miss.abs() < 1e-5, "{dt} {speed}: {found}");
                let miss = f64::from(seen.normalized[axis]) - exact[axis];
                assert!(miss.abs() < 1e-5, "{dt} {speed}: {}", seen.normalized);
            }

            let alpha = (0.5 + 0.75 * c0) * epsilon / k;
            let variance = c0 * epsilon / (2.0 * alpha);
            let kept = (-alpha * dt).exp();
            let fresh = (-variance * (-2.0 * alpha * dt).exp_m1()).sqrt();
            let v = Vector::new(1.0, -0.5, 0.0);
            let found = relative_velocity_after(v, &state, c0 as Real, dt32, noise);
            let exact = [kept + 0.3 * fresh, -0.5 * kept, -2.0 * fresh];
            for axis in 0..3 {
                let miss = f64::from(found[axis]) - exact[axis];
                assert!(miss.abs() < 1e-5, "{dt}: {found}");
            }
            let found = spin_increment(&state, c0 as Real, 0.2, dt32, noise);
            let exact = (c0 * epsilon * dt).sqrt() / 0.2;
            assert!((f64::from(found.z) / exact + 2.0).abs() < 1e-5, "{found}");
        }
    }

    #[test]
    fn no_turbulence_is_no_fluctuation() {
        let still = TurbulenceState::default();
        let mut seen = SeenFluctuation::stationary(Vector::ONE);
        assert_eq!(
            seen.advance(&still, 0.0, 0.0, 0.1, Vector::ONE),
            Vector::ZERO
        );
        assert!(seen.normalized.is_finite());
        let v = relative_velocity_after(Vector::X, &still, 0.0, 0.1, Vector::ONE);
        assert_eq!(v, Vector::X);
        assert_eq!(
            spin_increment(&still, 6.5, 0.1, 0.1, Vector::ONE),
            Vector::ZERO
        );
    }
}
