//! Viscous laws by name, with their coefficients from the command line.

use super::cli;
use clap::ValueEnum;
use rapier3d_immersed::{PhysicalLaw, StochasticLaw, ThesisLaw, ViscousLaw};

/// Laws by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LawName {
    /// Physical, passive, calibrated against experiments
    Default,
    /// Three components with instantaneous coefficients, regularised and damped
    Thesis,
    /// The same as printed; may blow up
    ThesisPrinted,
    /// Constant drag and lift coefficients
    Stochastic,
    /// An ideal fluid: added mass and buoyancy alone
    Inviscid,
}

/// The law with coefficients given as on the command line of `drop`.
///
/// # Errors
/// What is wrong with the coefficients.
pub fn law(name: LawName, coefficients: Option<&str>) -> Result<ViscousLaw, String> {
    match name {
        LawName::Default => physical(coefficients.unwrap_or("")).map(ViscousLaw::Physical),
        LawName::Thesis => {
            thesis(coefficients, DAMPED).map(|c| ViscousLaw::Thesis(ThesisLaw::new(c)))
        }
        LawName::ThesisPrinted => {
            thesis(coefficients, PRINTED).map(|c| ViscousLaw::Thesis(ThesisLaw::printed(c)))
        }
        LawName::Stochastic => stochastic(coefficients).map(ViscousLaw::Stochastic),
        LawName::Inviscid if coefficients.is_some() => {
            Err("an ideal fluid has no coefficients".into())
        }
        LawName::Inviscid => Ok(ViscousLaw::Inviscid),
    }
}

fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let number = |part: &str| cli::finite(part).map_err(|problem| format!("'{part}' {problem}"));
    text.split(',').map(number).collect()
}

/// Coefficients of steady descent, zigzag, autorotation with zigzag and autorotation under the law as printed …
const PRINTED: [[f64; 3]; 4] = [
    ThesisLaw::STEADY_DESCENT,
    ThesisLaw::ZIGZAG,
    ThesisLaw::AUTOROTATION_ZIGZAG,
    ThesisLaw::AUTOROTATION,
];
/// … and under the damped one, which has none of its own for the last.
const DAMPED: [[f64; 3]; 4] = [
    ThesisLaw::DAMPED_STEADY_DESCENT,
    ThesisLaw::DAMPED_ZIGZAG,
    ThesisLaw::DAMPED_AUTOROTATION_ZIGZAG,
    ThesisLaw::AUTOROTATION,
];

fn thesis(coefficients: Option<&str>, presets: [[f64; 3]; 4]) -> Result<[f64; 3], String> {
    let text = coefficients.unwrap_or("zz");
    let name = text.trim().to_ascii_lowercase();
    if let Some(known) = ["sd", "zz", "az", "ar"].iter().position(|n| *n == name) {
        return Ok(presets[known]);
    }
    match numbers(text)?[..] {
        [a, b, c] => Ok([a, b, c]),
        _ => Err("this law takes three numbers C_D,C_L1,C_L2, or sd, zz, az, ar".into()),
    }
}

fn stochastic(coefficients: Option<&str>) -> Result<StochasticLaw, String> {
    let standard = StochasticLaw::default();
    let Some(text) = coefficients else {
        return Ok(standard);
    };
    match numbers(text)?[..] {
        [drag, lift] => Ok(StochasticLaw {
            drag,
            lift,
            ..standard
        }),
        [drag, lift, arm] => Ok(StochasticLaw {
            drag,
            lift,
            arm,
            ..standard
        }),
        [drag, lift, arm, damping] => Ok(StochasticLaw {
            drag,
            lift,
            arm,
            damping,
        }),
        _ => Err("this law takes drag,lift[,arm[,damping]]".into()),
    }
}

fn physical(text: &str) -> Result<PhysicalLaw, String> {
    let mut law = PhysicalLaw::default();
    for part in text.split(',').filter(|part| !part.trim().is_empty()) {
        let (name, value) = part
            .split_once('=')
            .ok_or_else(|| format!("'{part}' is not NAME=VALUE, as this law takes"))?;
        let value = cli::finite(value).map_err(|problem| format!("'{part}': {problem}"))?;
        law.set(&name.trim().replace('-', "_"), value)
            .map_err(|problem| problem.to_string())?;
    }
    Ok(law)
}
