//! Plates in water: Andersen, Pesavento & Wang (2005).

use super::draw::{self, Item, Panel};
use super::falls::{RUNNERS, Reports, STEPS, median, reports};
use super::report::Row;
use super::runner::Runner;
use super::{Computed, Effort, Failure, Progress};
use plotters::style::RGBColor;
use rapier3d_immersed::ViscousLaw;
use rapier3d_immersed::motion::Regime;
use rapier3d_immersed::training::fidelity::{Fidelity, Plate, PlateFall, PlateResult};

const SOURCE: &str = "Andersen, Pesavento & Wang 2005";
const EXPECTED: &str = "expected between the plates measured";

/// What was measured of a plate, and the same of a fall.
type Quantity = (
    &'static str,
    &'static str,
    fn(&Plate) -> Option<f64>,
    fn(&PlateFall) -> f64,
);
const QUANTITIES: [Quantity; 3] = [
    ("drift", "m/s", |p| p.drift, |f| f.drift),
    ("descent", "m/s", |p| p.descent, |f| f.descent),
    ("spin", "rad/s", |p| p.spin, |f| f.spin),
];

pub fn compute(effort: Effort, progress: Progress) -> Result<Computed, Failure> {
    let measured = Fidelity {
        plates: Plate::targets()?,
        ..Fidelity::default()
    };
    let all = reports(&measured, effort, progress)?;
    let mut rows = Vec::new();
    for (index, plate) in measured.plates.iter().enumerate() {
        let name = format!("plate β = 1/{}", 1.0 / plate.beta);
        for (runner, reports) in RUNNERS.into_iter().zip(&all) {
            let case = |what: &str| format!("{name}, {what}, {}", runner.name());
            let ours = regime(reports, index);
            let words = [plate.regime.to_string(), ours.to_string()];
            let words = words.each_ref().map(String::as_str);
            rows.push(match runner {
                Runner::Alone if plate.observed => Row::word(case("regime"), words, SOURCE),
                Runner::Alone => Row::word(case("regime"), words, EXPECTED),
                _ => {
                    let alone = regime(&all[0], index).to_string();
                    Row::word(
                        case("regime"),
                        [&alone, words[1]],
                        "stand-alone; ".to_owned() + STEPS,
                    )
                }
            });
            for (what, unit, measured, of) in QUANTITIES {
                let Some(measured) = measured(plate) else {
                    continue;
                };
                let mean = |reports: &Reports| median(reports, |r| r.plates[index].mean(of));
                let numbers = [mean(&all[0]), mean(reports)];
                let source = "stand-alone; ".to_owned() + STEPS;
                rows.push(match runner {
                    Runner::Alone => {
                        let pair = [measured, numbers[1]];
                        Row::number(case(what), pair, unit, Some(0.1), SOURCE)
                    }
                    Runner::HalfStep => Row::number(case(what), numbers, unit, None, source),
                    Runner::Rapier(1) => Row::number(case(what), numbers, unit, Some(0.03), source),
                    Runner::Rapier(_) | Runner::Fine(_) => {
                        Row::number(case(what), numbers, unit, Some(0.1), source)
                    }
                });
            }
        }
    }
    Ok((rows, vec![("plates.svg".into(), picture(&measured)?)]))
}

/// The regime that most seeds give.
fn regime(reports: &Reports, index: usize) -> Regime {
    let seen: Vec<Regime> = reports
        .iter()
        .map(|r| PlateResult::regime(&r.plates[index]))
        .collect();
    let count = |regime: &Regime| seen.iter().filter(|other| *other == regime).count();
    let most = seen.iter().max_by_key(|regime| count(regime));
    most.copied().unwrap_or(Regime::SteadyDescent)
}

/// Path of the center and the section at equal times, as in the paper's figure.
fn picture(measured: &Fidelity) -> Result<String, Failure> {
    const SHOWN: f64 = 1.6;
    const GREY: RGBColor = RGBColor(150, 150, 150);
    const BLUE: RGBColor = RGBColor(30, 60, 150);
    let mut panels = Vec::new();
    for plate in &measured.plates {
        let mut experiment = plate.experiment(&ViscousLaw::default(), 45f64.to_radians(), 1)?;
        experiment.seconds = SHOWN;
        let fall = experiment.run()?;
        let shown = fall.between(0.0, experiment.seconds);
        // The plate moves in a vertical plane; which way it drifts is chance, and to the right here.
        let last = shown[shown.len() - 1].position;
        let size = last.x.hypot(last.z).max(1e-9);
        let along = [last.x / size, last.z / size];
        let flat = |x: f64, y: f64, z: f64| (100.0 * (x * along[0] + z * along[1]), 100.0 * y);
        let word = if plate.observed {
            "measured"
        } else {
            "expected"
        };
        let mut panel = Panel::new(
            format!("β = 1/{}: {word} {}", 1.0 / plate.beta, plate.regime),
            "cm",
            "cm",
        )
        .equal();
        let path = shown
            .iter()
            .map(|m| flat(m.position.x, m.position.y, m.position.z));
        panel.items.push(Item::Line(path.collect(), GREY, 1));
        let chord = 0.81e-3 / plate.beta;
        for moment in shown.iter().step_by(6) {
            let across = moment.normal.cross(&moment.long_axis) * (0.5 * chord);
            let ends = [moment.position - across, moment.position + across];
            let ends = ends.iter().map(|p| flat(p.x, p.y, p.z)).collect();
            panel.items.push(Item::Line(ends, BLUE, 2));
        }
        panels.push(panel);
    }
    let title = "Aluminium plates of 0.81 mm in water, default law, released at 45°: the section every 1/40 s for 1.6 s";
    draw::svg(title, &panels, 5, (320, 620))
}
