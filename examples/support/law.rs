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
        LawName::Thesis => thesis(coefficients).map(|c| ViscousLaw::Thesis(ThesisLaw::new(c))),
        LawName::ThesisPrinted => {
            thesis(coefficients).map(|c| ViscousLaw::Thesis(ThesisLaw::printed(c)))
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

fn thesis(coefficients: Option<&str>) -> Result<[f64; 3], String> {
    let Some(text) = coefficients else {
        return Ok(ThesisLaw::ZIGZAG);
    };
    match text.trim().to_ascii_lowercase().as_str() {
        "sd" => return Ok(ThesisLaw::STEADY_DESCENT),
        "zz" => return Ok(ThesisLaw::ZIGZAG),
        "az" => return Ok(ThesisLaw::AUTOROTATION_ZIGZAG),
        "ar" => return Ok(ThesisLaw::AUTOROTATION),
        _ => {}
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
        [drag, lift, arm] => Ok(StochasticLaw { drag, lift, arm }),
        _ => Err("this law takes drag,lift or drag,lift,arm".into()),
    }
}

fn physical(text: &str) -> Result<PhysicalLaw, String> {
    let mut law = PhysicalLaw::default();
    for part in text.split(',').filter(|part| !part.trim().is_empty()) {
        let (name, value) = part
            .split_once('=')
            .ok_or_else(|| format!("'{part}' is not NAME=VALUE, as this law takes"))?;
        let value = cli::finite(value).map_err(|problem| format!("'{part}': {problem}"))?;
        let field = match name.trim().replace('-', "_").as_str() {
            "pressure_travel" => &mut law.pressure_travel,
            "attached_lift" => &mut law.attached_lift,
            "attached_aspect" => &mut law.attached_aspect,
            "stalled_lift" => &mut law.stalled_lift,
            "stalled_aspect" => &mut law.stalled_aspect,
            "stall_sine" => &mut law.stall_sine,
            "stall_width" => &mut law.stall_width,
            "rotational_lift" => &mut law.rotational_lift,
            "rotational_aspect" => &mut law.rotational_aspect,
            "rotational_stall" => &mut law.rotational_stall,
            "munk" => &mut law.munk,
            "translation_damping" => &mut law.translation_damping,
            "rotation_damping" => &mut law.rotation_damping,
            "friction" => &mut law.friction,
            "edge_drag" => &mut law.edge_drag,
            "lift_onset" => &mut law.lift_onset,
            "damping_onset" => &mut law.damping_onset,
            "magnus" => &mut law.magnus,
            other => return Err(format!("the default law has no coefficient '{other}'")),
        };
        *field = value;
    }
    Ok(law)
}
