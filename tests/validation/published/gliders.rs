//! Cards with their center of mass ahead of the middle, thrown along their chord.

use super::report::Row;
use super::{Computed, Effort, Failure, Progress};
use rapier3d_immersed::training::Experiment;
use rapier3d_immersed::training::fidelity::{self, Fidelity, Glider, GliderResult};
use rapier3d_immersed::{PhysicalLaw, ViscousLaw};

const SOURCE: &str =
    "thrown level, 20° up and down, with and without 2° of roll; 0 if one turns over";
const SURVIVES: &str = "least glide ratio of all flights, each coefficient ± 1 %";

pub fn compute(effort: Effort, progress: Progress) -> Result<Computed, Failure> {
    let cards = Fidelity {
        gliders: Glider::cards()?,
        ..Fidelity::default()
    };
    let flights = fidelity::Effort::default();
    let fly = |law: PhysicalLaw| {
        let report = cards.run(&ViscousLaw::Physical(law), &flights, Experiment::run);
        report.map(|report| report.gliders)
    };
    let mut rows = Vec::new();
    let usual = fly(PhysicalLaw::default())?;
    for result in &usual {
        let forward = result.glider.forward;
        let case = |what: &str| format!("card weighted {forward:.2} chords ahead, {what}");
        let mean = Row::within(
            case("mean glide ratio"),
            [3.0, 6.0],
            Some(result.mean()),
            SOURCE,
        );
        rows.push(if forward > 0.19 { mean } else { mean.shown() });
        let least = Row::within(
            case("least glide ratio"),
            [3.0, 6.0],
            Some(result.least()),
            SOURCE,
        );
        rows.push(if forward > 0.19 { least } else { least.shown() });
    }
    progress(0.1);
    if effort == Effort::Full {
        let count = PhysicalLaw::COEFFICIENTS.len();
        let mut least = usual.iter().map(GliderResult::least).fold(0.0, f64::max);
        for (index, row) in PhysicalLaw::COEFFICIENTS.iter().enumerate() {
            for factor in [0.99, 1.01] {
                let mut law = PhysicalLaw::default();
                law.set(row.name, row.of(&law) * factor)?;
                let best = fly(law)?
                    .iter()
                    .map(GliderResult::least)
                    .fold(0.0, f64::max);
                least = f64::min(least, best);
            }
            progress(0.1 + 0.9 * (index + 1) as f64 / count as f64);
        }
        let case = "best card, every coefficient off by 1 %, least glide ratio";
        rows.push(Row::within(case, [3.0, 6.0], Some(least), SURVIVES));
    }
    Ok((rows, Vec::new()))
}
