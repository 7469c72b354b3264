//! Fits to the measured falls, kept in a file (`tests/data/paper/fits.csv`).

use super::forecast::{DEFAULT, Family, Forecast, PHYSICAL, THESIS, identify};
use super::measured::{Fall, Paper, STATE};
use rapier3d_immersed::Error;

const HEADER: &str =
    "fall,law,coefficients_of,residual,converged,parameter,value,deviation,at_bound";
const SHIPPED: &str = include_str!("../../tests/data/paper/fits.csv");
pub const FAMILIES: [&Family; 3] = [&DEFAULT, &PHYSICAL, &THESIS];

/// What a law with free coefficients came to on one fall.
#[derive(Clone, Debug, PartialEq)]
pub struct FallFit {
    pub fall: String,
    /// Name of a [`Family`].
    pub law: String,
    /// The fall that the coefficients were fitted to: this one, or its repeat.
    pub coefficients_of: String,
    /// Root of the mean squared residual, in standard deviations of the data.
    pub residual: f64,
    pub converged: bool,
    /// Coefficients of the family, then the [`STATE`], then the scales of both cameras' areas.
    pub parameters: Vec<f64>,
    pub deviations: Vec<f64>,
    pub at_bound: Vec<usize>,
}

/// Names of the parameters of a fit.
fn names(family: &Family) -> Vec<&'static str> {
    [family.coefficients, &STATE, &["scale 1", "scale 2"]].concat()
}

impl FallFit {
    /// Coefficients and state.
    ///
    /// # Errors
    /// Those of [`identify`].
    pub fn new(fall: &Fall, family: &Family, start: Option<&[f64]>) -> Result<Self, Error> {
        let found = identify(&Paper::new(fall)?, fall, family, None, start)?;
        Ok(Self {
            fall: fall.name.into(),
            law: family.name.into(),
            coefficients_of: fall.name.into(),
            residual: found.reduced_residual,
            converged: found.converged,
            parameters: found.parameters,
            deviations: found.deviations,
            at_bound: found.at_bound,
        })
    }

    /// The state alone: the coefficients are those of another fit.
    ///
    /// # Errors
    /// Those of [`identify`].
    pub fn of_state(fall: &Fall, family: &Family, other: &Self) -> Result<Self, Error> {
        let (coefficients, _) = other.split(family);
        let found = identify(&Paper::new(fall)?, fall, family, Some(coefficients), None)?;
        let count = coefficients.len();
        Ok(Self {
            fall: fall.name.into(),
            law: family.name.into(),
            coefficients_of: other.fall.clone(),
            residual: found.reduced_residual,
            converged: found.converged,
            parameters: [coefficients, &found.parameters].concat(),
            deviations: [vec![0.0; count], found.deviations].concat(),
            at_bound: found.at_bound.iter().map(|k| k + count).collect(),
        })
    }

    /// The fall that goes on from the estimated state.
    ///
    /// # Errors
    /// Those of [`Paper`].
    pub fn forecast(&self, fall: &Fall, family: &Family) -> Result<Forecast, Error> {
        let (coefficients, state) = self.split(family);
        Forecast::new(&Paper::new(fall)?, fall, (family.law)(coefficients), state)
    }

    /// Coefficients, and the state after them.
    pub fn split(&self, family: &Family) -> (&[f64], &[f64]) {
        let (coefficients, rest) = self.parameters.split_at(family.coefficients.len());
        (coefficients, &rest[..STATE.len()])
    }

    /// Those of the file.
    ///
    /// # Errors
    /// What cannot be read.
    pub fn shipped() -> Result<Vec<Self>, String> {
        let mut fits: Vec<Self> = Vec::new();
        let mut lines = SHIPPED.lines();
        if lines.next() != Some(HEADER) {
            return Err(format!("fits.csv: the header is not {HEADER}"));
        }
        for line in lines {
            let bad = |what: &str| format!("fits.csv: {line}: {what}");
            let cells: Vec<&str> = line.split(',').collect();
            let [
                fall,
                law,
                of,
                residual,
                converged,
                _,
                value,
                deviation,
                at_bound,
            ] = cells[..]
            else {
                return Err(bad("not nine fields"));
            };
            let number = |text: &str| text.parse::<f64>().map_err(|_| bad(text));
            if fits
                .last()
                .is_none_or(|f| (&*f.fall, &*f.law, &*f.coefficients_of) != (fall, law, of))
            {
                fits.push(Self {
                    fall: fall.into(),
                    law: law.into(),
                    coefficients_of: of.into(),
                    residual: number(residual)?,
                    converged: converged == "true",
                    parameters: Vec::new(),
                    deviations: Vec::new(),
                    at_bound: Vec::new(),
                });
            }
            let fit = fits.last_mut().expect("there is one now");
            if at_bound == "true" {
                fit.at_bound.push(fit.parameters.len());
            }
            fit.parameters.push(number(value)?);
            fit.deviations.push(number(deviation)?);
        }
        Ok(fits)
    }

    /// As the file has them.
    pub fn csv(fits: &[Self]) -> String {
        let mut text = format!("{HEADER}\n");
        for fit in fits {
            let family = FAMILIES.into_iter().find(|f| f.name == fit.law);
            let names = family.map(names).unwrap_or_default();
            for (k, name) in names.into_iter().enumerate() {
                text += &format!(
                    "{},{},{},{:.3},{},{name},{:.6},{:.6},{}\n",
                    fit.fall,
                    fit.law,
                    fit.coefficients_of,
                    fit.residual,
                    fit.converged,
                    fit.parameters[k],
                    fit.deviations[k],
                    fit.at_bound.contains(&k),
                );
            }
        }
        text
    }
}
