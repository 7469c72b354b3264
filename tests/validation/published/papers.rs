//! Paper circles and hexagons in air: Howison, Hughes & Iida (2020).

use super::draw::{self, Item, Panel};
use super::falls::{RUNNERS, Reports, STEPS, median, reports};
use super::report::Row;
use super::runner::Runner;
use super::{Computed, Effort, Failure, Progress};
use plotters::style::RGBColor;
use rapier3d_immersed::training::fidelity::{Cut, Fidelity, PaperDrop, PaperFall, TumblingShare};

const SOURCE: &str = "Howison, Hughes & Iida 2020";
/// I* between which the measured share of tumbling crosses one half.
const CROSSING: [f64; 2] = [0.043, 0.049];

fn name(drop: &PaperDrop) -> String {
    let cut = match drop.cut {
        Cut::Circle => "circle",
        Cut::Hexagon => "hexagon",
    };
    let release = if drop.edge_down { "edge down" } else { "flat" };
    format!("{cut} of {:.1} mm, {release}", 1e3 * drop.radius)
}

/// Measured mean and deviation, and the same of a fall.
type Quantity = (
    &'static str,
    f64,
    fn(&PaperDrop) -> [f64; 2],
    fn(&PaperFall) -> f64,
);
const QUANTITIES: [Quantity; 2] = [
    (
        "descent",
        0.1,
        |d| [d.descent, d.descent_deviation],
        |f| f.descent,
    ),
    ("drift", 0.3, |d| [d.drift, d.drift_deviation], |f| f.drift),
];

pub fn compute(effort: Effort, progress: Progress) -> Result<Computed, Failure> {
    let measured = Fidelity {
        papers: PaperDrop::measured()?,
        shares: TumblingShare::measured()?,
        ..Fidelity::default()
    };
    let all = reports(&measured, effort, progress)?;
    let mut rows = Vec::new();
    for (index, drop) in measured.papers.iter().enumerate() {
        for (what, bar, measured, of) in QUANTITIES {
            let ours = median(&all[0], |r| r.papers[index].mean(of));
            let case = format!("{}, {what}, stand-alone", name(drop));
            let pair = [measured(drop)[0], ours];
            rows.push(Row::number(case, pair, "m/s", Some(bar), SOURCE));
        }
    }
    for (runner, reports) in RUNNERS.into_iter().zip(&all) {
        let sets = measured.papers.len();
        for (what, _, _, of) in QUANTITIES {
            let mean = |reports: &Reports| {
                let of_set = |set: usize| median(reports, |r| r.papers[set].mean(of));
                (0..sets).map(of_set).sum::<f64>() / sets as f64
            };
            let bar = match runner {
                Runner::Alone | Runner::HalfStep => None,
                Runner::Rapier(1) => Some(0.03),
                Runner::Rapier(_) | Runner::Fine(_) => Some(0.1),
            };
            if runner != Runner::Alone {
                let case = format!("papers, mean {what} of all sets, {}", runner.name());
                let pair = [mean(&all[0]), mean(reports)];
                let source = format!("stand-alone; {STEPS}");
                rows.push(Row::number(case, pair, "m/s", bar, source));
            }
        }
        let crossing = crossing(reports);
        let case = format!("I* where half of the circles tumble, {}", runner.name());
        let row = Row::within(case, CROSSING, crossing, SOURCE);
        rows.push(if runner == Runner::HalfStep {
            row.shown()
        } else {
            row
        });
    }
    let picture = picture(&measured, &all[0])?;
    Ok((rows, vec![("papers.svg".into(), picture)]))
}

/// Median over the seeds that have one; none if fewer than half have.
fn crossing(reports: &Reports) -> Option<f64> {
    let mut found: Vec<f64> = reports
        .iter()
        .filter_map(|r| r.tumbling_crossing())
        .collect();
    found.sort_by(f64::total_cmp);
    (2 * found.len() >= reports.len()).then(|| found[found.len() / 2])
}

fn picture(measured: &Fidelity, reports: &Reports) -> Result<String, Failure> {
    const BLUE: RGBColor = RGBColor(30, 90, 200);
    const RED: RGBColor = RGBColor(211, 47, 47);
    let mut panels = Vec::new();
    for (what, _, target, of) in QUANTITIES {
        let title = format!("{what}: measured mean and deviation (red), ours (blue)");
        let mut panel = Panel::new(title, "set, in the order of the table", "m/s");
        panel.window = Some([(0.0, 10.0), (0.0, 1.1)]);
        for (index, drop) in measured.papers.iter().enumerate() {
            let x = (index + 1) as f64;
            let [mean, deviation] = target(drop);
            let bar = vec![(x - 0.12, mean - deviation), (x - 0.12, mean + deviation)];
            panel.items.push(Item::Line(bar, RED, 2));
            panel.items.push(Item::Dots(vec![(x - 0.12, mean)], RED, 5));
            let ours = median(reports, |r| r.papers[index].mean(of));
            panel
                .items
                .push(Item::Dots(vec![(x + 0.12, ours)], BLUE, 5));
        }
        panels.push(panel);
    }
    let title = "share of tumbling: measured (red), ours (blue)";
    let mut panel = Panel::new(title, "I*", "share");
    panel.window = Some([(0.03, 0.082), (0.0, 1.05)]);
    let mut lines = [Vec::new(), Vec::new()];
    for (index, share) in measured.shares.iter().enumerate() {
        lines[0].push((share.i_star, share.share));
        let ours = median(reports, |r| r.shares[index].share());
        lines[1].push((share.i_star, ours));
    }
    for (line, color) in lines.into_iter().zip([RED, BLUE]) {
        panel.items.push(Item::Dots(line.clone(), color, 5));
        panel.items.push(Item::Line(line, color, 1));
    }
    panels.push(panel);
    draw::svg(
        "Paper in air: Howison et al. 2020 and the default law",
        &panels,
        3,
        (430, 460),
    )
}
