//! Plates and discs in a steady stream: lift slope, stall, center of pressure, force along a stalled plate.

use super::draw::{self, Item, Panel};
use super::report::Row;
use super::{Computed, Effort, Failure, Progress};
use plotters::style::RGBColor;
use rapier3d_immersed::ViscousLaw;
use rapier3d_immersed::training::Experiment;
use rapier3d_immersed::training::fidelity::{self, Fidelity, PolarResult, Report, StaticPlate};

const SLOPE: &str = "Helmbold 1942";
const STALL: &str = "flat plates at Re > 10⁴, literature";
const LATTICE: &str = "vortex lattice";
const NORMAL: &str = "separated flow presses along the normal";

/// "rectangle of aspect ratio 6" and so on.
fn name(plate: &StaticPlate) -> String {
    match (plate.round, plate.edgewise_drag) {
        (true, Some(_)) => "throwing disc".into(),
        (true, None) => "thin disc".into(),
        (false, _) => format!("rectangle of aspect ratio {}", plate.aspect),
    }
}

pub fn compute(_effort: Effort, progress: Progress) -> Result<Computed, Failure> {
    let measured = Fidelity {
        polars: StaticPlate::published()?,
        ..Fidelity::default()
    };
    let effort = fidelity::Effort::default();
    let report = measured.run(&ViscousLaw::default(), &effort, Experiment::run)?;
    let mut rows = Vec::new();
    for result in &report.polars {
        plate(result, &mut rows);
    }
    progress(1.0);
    let pictures = vec![("polars.svg".into(), picture(&report)?)];
    Ok((rows, pictures))
}

fn plate(result: &PolarResult, rows: &mut Vec<Row>) {
    let (known, polar) = (&result.plate, &result.polar);
    let case = |what: &str| format!("{}, {what}", name(known));
    let slope = [known.lift_slope, polar.lift_slope()];
    rows.push(Row::number(
        case("lift slope"),
        slope,
        "1/rad",
        Some(0.1),
        SLOPE,
    ));
    let (angle, lift) = polar.stall();
    if let Some(greatest) = known.max_lift {
        let pair = [greatest, lift];
        rows.push(Row::number(
            case("greatest lift"),
            pair,
            "",
            Some(0.15),
            STALL,
        ));
    }
    if let Some([low, high]) = known.stall {
        let bar = [low - 5.0, high + 5.0];
        rows.push(Row::within(case("stall, °"), bar, Some(angle), STALL));
    }
    if let Some(at) = known.pressure_point {
        let bar = [at - 0.04, at + 0.04];
        let ours = Some(polar.pressure_point());
        rows.push(Row::within(
            case("center of pressure at 5°, chords"),
            bar,
            ours,
            LATTICE,
        ));
    }
    rows.push(Row::within(
        case("center of pressure at 90°, chords"),
        [0.499, 0.501],
        Some(polar.points[90].pressure_point),
        "symmetry",
    ));
    let back = polar.pressure_goes_back();
    let word = if back { "goes back" } else { "comes forward" };
    rows.push(Row::fact(
        case("center of pressure from 2° to 90°"),
        word,
        back,
        "from near the quarter to the middle",
    ));
    rows.push(Row::at_most(
        case("force along the stalled plate over the normal force"),
        polar.stalled_thrust().max(0.0),
        Some(0.05),
        NORMAL,
    ));
    if let Some(drag) = known.edgewise_drag {
        let pair = [drag, polar.points[0].drag];
        let source = "Potts & Crowther 2002";
        rows.push(Row::number(case("C_D0"), pair, "", None, source));
    }
}

/// Lift, drag and center of pressure against the angle of attack, with what is known of each plate.
fn picture(report: &Report) -> Result<String, Failure> {
    const COLORS: [RGBColor; 5] = [
        RGBColor(30, 90, 200),
        RGBColor(0, 140, 120),
        RGBColor(200, 120, 0),
        RGBColor(120, 60, 160),
        RGBColor(150, 150, 150),
    ];
    let mut panels = [
        Panel::new(
            "lift: ours (lines), slope (dashed), stall (dots)",
            "°",
            "C_L",
        ),
        Panel::new("drag: ours (lines)", "°", "C_D"),
        Panel::new(
            "center of pressure: ours (lines), vortex lattice (dots)",
            "°",
            "chords",
        ),
    ];
    for (result, color) in report.polars.iter().zip(COLORS) {
        let (known, polar) = (&result.plate, &result.polar);
        let degrees = || polar.points.iter().enumerate().map(|(d, p)| (d as f64, p));
        let lift = degrees().map(|(d, p)| (d, p.lift)).collect();
        let drag = degrees().map(|(d, p)| (d, p.drag)).collect();
        let pressure = degrees().skip(1).map(|(d, p)| (d, p.pressure_point));
        panels[0].items.push(Item::Line(lift, color, 2));
        panels[1].items.push(Item::Line(drag, color, 2));
        panels[2]
            .items
            .push(Item::Line(pressure.collect(), color, 2));
        let steep: f64 = 8.0;
        let slope = vec![(0.0, 0.0), (steep, known.lift_slope * steep.to_radians())];
        panels[0].items.push(Item::Dashed(slope, color));
        if let (Some([low, high]), Some(greatest)) = (known.stall, known.max_lift) {
            let dot = vec![(0.5 * (low + high), greatest)];
            panels[0].items.push(Item::Dots(dot, color, 4));
        }
        if let Some(at) = known.pressure_point {
            panels[2].items.push(Item::Dots(vec![(5.0, at)], color, 4));
        }
    }
    let title = "Thin plates in a steady stream: aspect ratio 1 (blue), 2 (green), 6 (orange), 60 (violet), disc (grey)";
    draw::svg(title, &panels, 3, (480, 420))
}
