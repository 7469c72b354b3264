//! The k–ε model where it needs no grid: constants, eddy viscosity, and its source terms in closed form.

use crate::error::Error;
use crate::math;
use rapier3d::math::Real;

/// How strong the turbulence is at one place and time.
///
/// ```
/// use rapier3d_immersed::turbulence::TurbulenceState;
///
/// // A stream of 2 m/s with an intensity of 10 %, whose eddies are 5 cm large.
/// let state = TurbulenceState::from_intensity(2.0, 0.1, 0.05)?;
/// assert!((state.deviation() - 0.2).abs() < 1e-6); // m/s
/// assert!((state.turnover_rate() - 0.804).abs() < 1e-3); // 1/s
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct TurbulenceState {
    /// Turbulent kinetic energy k per mass, half the sum of the three velocity variances, m²/s².
    pub kinetic_energy: Real,
    /// Dissipation rate ε of k, m²/s³.
    pub dissipation: Real,
}

impl TurbulenceState {
    /// k = 3/2 (I U)² and ε = C_μ^¾ k^(3/2)/l, for turbulence of `intensity` I in a flow of `speed` U (m/s)
    /// whose eddies have size `length` l (m). Thesis (4.20) is I = 1.
    ///
    /// # Errors
    /// If a value is negative or not finite, or `length` is zero.
    pub fn from_intensity(speed: Real, intensity: Real, length: Real) -> Result<Self, Error> {
        Error::check_not_negative("speed", speed.into())?;
        Error::check_not_negative("intensity", intensity.into())?;
        Error::check_positive("length", length.into())?;
        let kinetic_energy = 1.5 * (intensity * speed).powi(2);
        let state = Self {
            kinetic_energy,
            dissipation: math::powf(0.09f32, 0.75) * math::powf(kinetic_energy, 1.5) / length,
        };
        Error::check_finite("kinetic_energy", state.kinetic_energy.into())?;
        Error::check_finite("dissipation", state.dissipation.into())?;
        Ok(state)
    }

    /// χ = ε/k, the inverse of the eddies' turnover time, 1/s. It is zero without turbulence.
    pub fn turnover_rate(&self) -> Real {
        if self.kinetic_energy > 0.0 {
            self.dissipation / self.kinetic_energy
        } else {
            0.0
        }
    }

    /// Standard deviation √(2k/3) of one velocity component, m/s.
    pub fn deviation(&self) -> Real {
        (self.kinetic_energy.max(0.0) * (2.0 / 3.0)).sqrt()
    }

    /// Square of the Reynolds number of the Taylor scale, Re_λ² = (20/3) k²/(ε ν), in a fluid of
    /// kinematic viscosity `viscosity` (m²/s).
    pub fn taylor_reynolds_squared(&self, viscosity: Real) -> Real {
        let k = self.kinetic_energy;
        20.0 / 3.0 * k * k / (self.dissipation * viscosity)
    }
}

/// The constants of the k–ε model (thesis §4.4).
///
/// ```
/// use rapier3d_immersed::turbulence::KEpsilon;
///
/// let model = KEpsilon::default();
/// // Without shear k decays as [1 + (C₂ − 1) ε₀t/k₀]^(−1/(C₂ − 1)), in one step or in many.
/// let (k, epsilon) = model.advance(1.0, 1.0, 0.0, 2.0);
/// assert!((k - (1.0 + 0.92 * 2.0_f64).powf(-1.0 / 0.92)).abs() < 1e-12);
/// // In homogeneous shear production comes to exceed dissipation by (C₂ − 1)/(C₁ − 1).
/// let (k, epsilon) = model.advance(k, epsilon, 4.0, 60.0);
/// let production = model.eddy_viscosity(k, epsilon) * 4.0;
/// assert!((production / epsilon - 0.92 / 0.44).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KEpsilon {
    /// C_μ in ν_T = C_μ k²/ε. Default .09.
    pub c_mu: f64,
    /// C₁, production of ε, above 1. Default 1.44.
    pub c1: f64,
    /// C₂, destruction of ε, above 1. Default 1.92.
    pub c2: f64,
    /// Turbulent Prandtl number σ_k of k. Default 1.
    pub sigma_k: f64,
    /// Turbulent Prandtl number σ_ε of ε. Default 1.3.
    pub sigma_epsilon: f64,
}

impl Default for KEpsilon {
    /// The high-Reynolds-number constants of Launder & Sharma (1974).
    fn default() -> Self {
        Self {
            c_mu: 0.09,
            c1: 1.44,
            c2: 1.92,
            sigma_k: 1.0,
            sigma_epsilon: 1.3,
        }
    }
}

/// ln(cosh x + r sinh x) for x, r ≥ 0, which neither overflows nor cancels.
fn ln_cosh_sinh(x: f64, r: f64) -> f64 {
    // cosh x + r sinh x = e^x (1 + (r − 1)(1 − e^{−2x})/2)
    x + math::ln_1p(0.5 * (r - 1.0) * -math::exp_m1(-2.0 * x))
}

impl KEpsilon {
    /// Checks the constants.
    ///
    /// # Errors
    /// If one is not finite, C_μ, σ_k or σ_ε not positive, or C₁ or C₂ not above 1.
    pub fn validate(&self) -> Result<(), Error> {
        Error::check_positive("c_mu", self.c_mu)?;
        Error::check_positive("sigma_k", self.sigma_k)?;
        Error::check_positive("sigma_epsilon", self.sigma_epsilon)?;
        for (name, c) in [("c1", self.c1), ("c2", self.c2)] {
            Error::check(name, c, c.is_finite() && c > 1.0, "finite and above 1")?;
        }
        Ok(())
    }

    /// Eddy viscosity ν_T = C_μ k²/ε, m²/s; zero without turbulence.
    pub fn eddy_viscosity(&self, k: f64, epsilon: f64) -> f64 {
        if k > 0.0 && epsilon > 0.0 {
            self.c_mu * k * k / epsilon
        } else {
            0.0
        }
    }

    /// (k, ε) after `dt` (s) of production and dissipation at a fixed rate of strain, thesis (4.18)–(4.19).
    ///
    /// `strain2` is 2 S:S of the mean flow, 1/s². The equations for k and ε together have the closed
    /// solution used here: χ = ε/k obeys χ̇ = (C₁−1)C_μ 2S:S − (C₂−1)χ², which is a Riccati equation
    /// without k, and k̇/k = C_μ 2S:S/χ − χ. So both stay positive for any `dt`, homogeneous
    /// decay is exact, and many small steps are one large one. k = 0 or ε = 0 stays as it is: without
    /// turbulence there is no eddy viscosity to produce any. Growth is cut off at 1e30.
    pub fn advance(&self, k: f64, epsilon: f64, strain2: f64, dt: f64) -> (f64, f64) {
        if k <= 0.0 || epsilon <= 0.0 {
            return (k.max(0.0), epsilon.max(0.0));
        }
        let chi = epsilon / k;
        let a = (self.c1 - 1.0) * self.c_mu * strain2;
        let b = self.c2 - 1.0;
        // With χ = ẏ/(b y) and 1/χ = ż/(a z) both become linear equations of second order.
        let lambda = (a * b).sqrt();
        let x = lambda * dt;
        let (ln_y, ln_z) = if x > 1.0e-9 {
            (
                ln_cosh_sinh(x, b * chi / lambda),
                ln_cosh_sinh(x, a / (chi * lambda)),
            )
        } else {
            (math::ln_1p(b * chi * dt), 0.0)
        };
        // ∫C_μ 2S:S/χ dt = ln z/(C₁−1) and ∫χ dt = ln y/(C₂−1). Without strain ln z is 0.
        let growth = ln_z / (self.c1 - 1.0) - ln_y / (self.c2 - 1.0);
        let k = (k * math::exp(growth)).min(1.0e30);
        let chi = if x > 1.0e-9 {
            let (equilibrium, t) = ((a / b).sqrt(), math::tanh(x));
            equilibrium * (chi + equilibrium * t) / (equilibrium + chi * t)
        } else {
            chi / (1.0 + b * chi * dt)
        };
        (k, (chi * k).min(1.0e30))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// k = k₀[1 + (C₂−1)ε₀t/k₀]^(−1/(C₂−1)) for k₀ = ε₀ = 1: values computed independently, to five digits.
    #[test]
    fn homogeneous_decay_is_exact_for_any_step() {
        let model = KEpsilon::default();
        for (t, exact) in [
            (0.5, 0.66276),
            (1.0, 0.49211),
            (2.0, 0.32156),
            (5.0, 0.15373),
            (10.0, 0.08011),
        ] {
            for steps in [1, 7, 1000] {
                let mut state = (1.0, 1.0);
                for _ in 0..steps {
                    state = model.advance(state.0, state.1, 0.0, t / f64::from(steps));
                }
                assert!((state.0 - exact).abs() < 6.0e-6, "{t} {steps} {}", state.0);
                // ε = ε₀ (k/k₀)^C₂
                assert!((state.1 / state.0.powf(1.92) - 1.0).abs() < 1.0e-10);
            }
        }
    }

    /// The closed form agrees with the equations themselves, solved in tiny steps by Runge–Kutta of order 4.
    #[test]
    fn pure_shear_matches_runge_kutta() {
        let model = KEpsilon::default();
        let rate = |k: f64, e: f64, s2: f64| {
            let production = model.eddy_viscosity(k, e) * s2;
            (
                production - e,
                e / k * (model.c1 * production - model.c2 * e),
            )
        };
        for (k0, e0, s2, t) in [
            (1.0, 1.0, 9.0, 3.0),
            (0.2, 3.0, 400.0, 0.7),
            (2.0, 0.05, 0.3, 10.0),
            (1.0, 1.0, 1.0e-8, 2.0),
        ] {
            let (mut k, mut e) = (k0, e0);
            let n = 20_000;
            let h = t / f64::from(n);
            for _ in 0..n {
                let a = rate(k, e, s2);
                let b = rate(k + 0.5 * h * a.0, e + 0.5 * h * a.1, s2);
                let c = rate(k + 0.5 * h * b.0, e + 0.5 * h * b.1, s2);
                let d = rate(k + h * c.0, e + h * c.1, s2);
                k += h / 6.0 * (a.0 + 2.0 * b.0 + 2.0 * c.0 + d.0);
                e += h / 6.0 * (a.1 + 2.0 * b.1 + 2.0 * c.1 + d.1);
            }
            let (ke, ee) = model.advance(k0, e0, s2, t);
            assert!((ke / k - 1.0).abs() < 1.0e-7, "{ke} {k}");
            assert!((ee / e - 1.0).abs() < 1.0e-7, "{ee} {e}");
        }
    }

    /// Homogeneous shear tends to ε/k = S√(C_μ(C₁−1)/(C₂−1)), whence production over dissipation is
    /// (C₂−1)/(C₁−1) = 2.09 (Pope, Turbulent Flows, §10.4.2).
    #[test]
    fn homogeneous_shear_reaches_popes_equilibrium() {
        let model = KEpsilon::default();
        let (k, e) = model.advance(1.0, 40.0, 4.0, 60.0);
        let ratio = model.eddy_viscosity(k, e) * 4.0 / e;
        assert!((ratio - 0.92 / 0.44).abs() < 1.0e-9, "{ratio}");
    }

    #[test]
    fn any_step_keeps_both_positive_and_finite() {
        let model = KEpsilon::default();
        for k in [1.0e-12, 1.0, 1.0e6] {
            for e in [1.0e-12, 1.0, 1.0e8] {
                for s2 in [0.0, 1.0e-20, 1.0, 1.0e10] {
                    for dt in [1.0e-9, 1.0, 1.0e9] {
                        let (k1, e1) = model.advance(k, e, s2, dt);
                        assert!(k1 >= 0.0 && k1.is_finite(), "{k} {e} {s2} {dt}: {k1}");
                        assert!(e1 >= 0.0 && e1.is_finite(), "{k} {e} {s2} {dt}: {e1}");
                    }
                }
            }
        }
        assert_eq!(model.advance(0.0, 0.0, 1.0, 1.0), (0.0, 0.0));
    }

    /// Thesis (4.20) with I = 1: k₀ = 3/2 U₀², and Re_λ from its definition u'λ/ν, λ² = 15νu'²/ε.
    #[test]
    fn initial_state_and_taylor_scale() {
        let state = TurbulenceState::from_intensity(0.5, 1.0, 0.02).unwrap();
        assert!((state.kinetic_energy - 0.375).abs() < 1.0e-6);
        assert!((state.dissipation - 0.164_317 * 0.229_640 / 0.02).abs() < 1.0e-4);
        let (u, nu) = (state.deviation(), 1.5e-5);
        let lambda = (15.0 * nu * u * u / state.dissipation).sqrt();
        let reynolds = u * lambda / nu;
        assert!((state.taylor_reynolds_squared(nu).sqrt() / reynolds - 1.0).abs() < 1.0e-5);
        assert!(TurbulenceState::from_intensity(-1.0, 1.0, 0.1).is_err());
        assert!(TurbulenceState::from_intensity(1.0, f32::NAN, 0.1).is_err());
        assert!(TurbulenceState::from_intensity(1.0, 1.0, 0.0).is_err());
        assert!(TurbulenceState::from_intensity(1.0e30, 1.0, 0.1).is_err());
        assert_eq!(TurbulenceState::default().turnover_rate(), 0.0);
    }

    #[test]
    fn bad_constants_are_errors() {
        let bad = |change: fn(&mut KEpsilon)| {
            let mut model = KEpsilon::default();
            change(&mut model);
            model.validate().is_err()
        };
        assert!(KEpsilon::default().validate().is_ok());
        assert!(bad(|m| m.c_mu = -0.1));
        assert!(bad(|m| m.c1 = 1.0));
        assert!(bad(|m| m.c2 = f64::NAN));
        assert!(bad(|m| m.sigma_k = 0.0));
    }
}
