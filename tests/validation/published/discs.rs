//! The map of falling discs: Field, Klaus, Moore & Nori (1997).

use super::draw::{self, Item, Panel, Point};
use super::falls::{RUNNERS, Reports, median, reports};
use super::report::Row;
use super::runner::Runner;
use super::{Computed, Effort, Failure, Progress};
use plotters::style::RGBColor;
use rapier3d_immersed::motion::{PhaseDiagram, Regime};
use rapier3d_immersed::training::fidelity::{Disc, DiscFall, Fidelity};

const CLASSES: [(Regime, RGBColor); 4] = [
    (Regime::SteadyDescent, RGBColor(214, 90, 80)),
    (Regime::PeriodicFlutter, RGBColor(70, 160, 80)),
    (Regime::TransitionalChaotic, RGBColor(60, 110, 210)),
    (Regime::PeriodicTumbling, RGBColor(190, 60, 170)),
];

pub fn compute(effort: Effort, progress: Progress) -> Result<Computed, Failure> {
    let all = Fidelity {
        discs: Disc::measured()?,
        ..Fidelity::default()
    };
    let measured = effort.choose(all.clone(), all.thinned(12));
    let all = reports(&measured, effort, progress)?;
    let source = "Field et al. 1997, curves of the measured map at our own mean descent";
    let same = "stand-alone; dt is 0.08 diameters at the broadside speed";
    let agreement = |reports: &Reports| median(reports, |r| r.discs.agreement());
    let mut rows = Vec::new();
    for (runner, reports) in RUNNERS.into_iter().zip(&all) {
        let case = |what: &str| format!("discs, {what}, {}", runner.name());
        let share = agreement(reports);
        rows.push(match runner {
            Runner::Alone => Row::share(case("agreement with the map"), share, 0.85, source),
            Runner::HalfStep => {
                let moved = (share - agreement(&all[0])).abs();
                Row::at_most(case("agreement moves by"), moved, Some(0.02), same)
            }
            Runner::Rapier(_) | Runner::Fine(_) => {
                let bar = if runner == Runner::Rapier(1) {
                    0.03
                } else {
                    0.1
                };
                let pair = [agreement(&all[0]), share].map(|s| 100.0 * s);
                Row::number(case("agreement"), pair, "%", Some(bar), same)
            }
        });
        for (class, (regime, _)) in CLASSES.iter().enumerate() {
            let share = median(reports, |r| r.discs.agreement_by_class()[class]);
            let row = Row::share(case(&regime.to_string()), share, 0.7, source);
            rows.push(if runner == Runner::Alone {
                row
            } else {
                row.shown()
            });
        }
        let near = median(reports, |r| r.discs.near_misses(0.2));
        let row = Row::share(case("misses within 20 % of a boundary"), near, 0.7, source);
        rows.push(if runner == Runner::Alone {
            row
        } else {
            row.shown()
        });
    }
    let falls = &all[0][0].discs.falls;
    let picture = picture(&measured.discs, falls)?;
    Ok((rows, vec![("discs.svg".into(), picture)]))
}

/// Smallest I* of the picture.
const LOWEST: f64 = 4e-4;

fn color(regime: Regime) -> RGBColor {
    let class = CLASSES.iter().find(|(class, _)| *class == regime);
    class.map_or(RGBColor(0, 0, 0), |(_, color)| *color)
}

fn map(title: &str) -> Panel {
    let mut panel = Panel::new(title, "Reynolds number by mean descent", "I*");
    panel.logarithmic = true;
    panel.window = Some([(15.0, 4e4), (LOWEST, 0.3)]);
    for boundary in PhaseDiagram::default().boundaries() {
        if boundary.measured {
            let grey = RGBColor(120, 120, 120);
            let inside = |p: &Point| p.1 >= LOWEST;
            let points = boundary.points.into_iter().filter(inside).collect();
            panel.items.push(Item::Line(points, grey, 2));
        }
    }
    panel
}

fn picture(discs: &[Disc], falls: &[DiscFall]) -> Result<String, Failure> {
    let mut measured = map("measured, and the curves drawn through it");
    let mut ours =
        map("ours at our own Reynolds number; black: not what the measured map says there");
    for (regime, color) in CLASSES {
        let of = discs.iter().filter(|disc| disc.regime == regime);
        let points = of.map(|disc| (disc.reynolds, disc.i_star)).collect();
        measured.items.push(Item::Dots(points, color, 4));
    }
    let at = |fall: &DiscFall| -> Point { (fall.reynolds, fall.i_star) };
    let misses = falls.iter().filter(|fall| fall.regime != fall.expected);
    let black = RGBColor(0, 0, 0);
    ours.items
        .push(Item::Dots(misses.map(at).collect(), black, 5));
    for fall in falls {
        ours.items
            .push(Item::Dots(vec![at(fall)], color(fall.regime), 3));
    }
    for panel in [&mut measured, &mut ours] {
        for (i, (regime, color)) in CLASSES.into_iter().enumerate() {
            let height = 0.2 / 1.35f64.powi(i as i32);
            panel
                .items
                .push(Item::Label((50.0, height), regime.to_string(), color));
        }
    }
    let title = "Falling discs: Field et al. 1997 and the default law";
    draw::svg(title, &[measured, ours], 2, (640, 560))
}
