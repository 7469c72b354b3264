//! The added mass of a shape: what it takes to accelerate the fluid around it.
//!
//! ```text
//! cargo run --release --features bake,serde-serialize --example added_mass -- --shape box --size 0.2,0.1,0.01
//! cargo run --release --features bake,serde-serialize --example added_mass -- --shape airplane
//! cargo run --release --features bake,serde-serialize --example added_mass -- --mesh fish.obj --scale 0.001 --json
//! cargo run --release --features bake,serde-serialize --example added_mass -- --figure
//! ```

mod case;
mod error_figure;
mod picture;
#[path = "../support/previous.rs"]
mod previous;
#[path = "../support/mod.rs"]
mod support;
mod without;

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use rapier3d_immersed::boundary_element::{
    BoundaryElementParams, BoundaryElementProgress, BoundaryElementSolution,
};
use rapier3d_immersed::rapier3d::na::Matrix3;
use std::process::ExitCode;
use std::time::Instant;
use support::cli;
use support::options::{Json, Out};
use support::shape::{ShapeArgs, Shaped};

/// Added mass per unit fluid density, about the center of mass of a body of even density.
#[derive(Parser)]
#[command(name = "added_mass", version)]
struct Options {
    #[command(flatten)]
    body: ShapeArgs,
    /// Relative error to refine to
    #[arg(long, value_name = "SHARE", default_value = "0.01", value_parser = cli::positive,
          allow_negative_numbers = true)]
    tolerance: f64,
    /// Most panels to use
    #[arg(long, value_name = "N", default_value = "6000")]
    max_panels: usize,
    /// Draw the error against thickness, ours beside plain quadrature (thesis, figure 5.2)
    #[arg(long)]
    figure: bool,
    #[command(flatten)]
    out: Out,
    #[command(flatten)]
    json: Json,
}

fn main() -> ExitCode {
    match run(&cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn run(options: &Options) -> Result<(), String> {
    let folder = &options.out.folder;
    let failed = |e: std::io::Error| format!("--out {}: {e}", folder.display());
    if options.figure {
        std::fs::create_dir_all(folder).map_err(failed)?;
        let picture = options.out.path("added_mass_error.svg");
        return error_figure::draw(&picture, options.json.on);
    }
    let body = options.body.shaped();
    let params = BoundaryElementParams {
        tolerance: options.tolerance,
        max_panels: options.max_panels,
        ..BoundaryElementParams::default()
    };
    let start = Instant::now();
    let bar = if options.json.on {
        ProgressBar::hidden()
    } else {
        let style = ProgressStyle::with_template("{msg:>14} {wide_bar} {percent:>3} %");
        ProgressBar::new(1000).with_style(style.map_err(|e| e.to_string())?)
    };
    let progress = |p: BoundaryElementProgress| {
        bar.set_message(format!("{} panels", p.panels));
        bar.set_position((p.share * 1000.0) as u64);
    };
    let solution = case::solve(&body, &params, &progress).map_err(|e| e.to_string())?;
    let seconds = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    if options.json.on {
        println!("{:#}", json(&body, &solution));
        return Ok(());
    }
    print(&body, &solution, seconds);
    std::fs::create_dir_all(folder).map_err(failed)?;
    let path = options.out.path(&format!("added_mass_{}.svg", body.name));
    picture::draw(&path, &body, &solution).map_err(|e| format!("--out: {e}"))?;
    println!("surface potential: {}", path.display());
    Ok(())
}

fn rows(m: &Matrix3<f64>) -> Vec<Vec<f64>> {
    m.row_iter().map(|r| r.iter().copied().collect()).collect()
}

fn json(body: &Shaped, solution: &BoundaryElementSolution) -> serde_json::Value {
    serde_json::json!({
        "linear_m3": rows(&solution.added_mass.linear),
        "coupling_m4": rows(&solution.added_mass.coupling),
        "angular_m5": rows(&solution.added_mass.angular),
        "center_m": solution.center.as_slice(),
        "volume_m3": case::volume(body),
        "error": solution.report.estimated_error,
        "panels": solution.report.panels,
    })
}

fn print(body: &Shaped, solution: &BoundaryElementSolution, seconds: f64) {
    let (added, report) = (&solution.added_mass, &solution.report);
    println!(
        "{}: added mass per unit density about {:.5?} m",
        body.name,
        solution.center.as_slice()
    );
    for (name, unit, block) in [
        ("linear", "m³", &added.linear),
        ("coupling", "m⁴", &added.coupling),
        ("angular", "m⁵", &added.angular),
    ] {
        println!("{name}, {unit}");
        // Below a millionth of the largest entry there is only quadrature.
        let floor = block.amax() * 1e-6;
        for row in block.row_iter() {
            let entry = |x: &f64| format!("{:>12.4e}", if x.abs() < floor { 0.0 } else { *x });
            println!("  {}", row.iter().map(entry).collect::<Vec<_>>().join(" "));
        }
    }
    let percent = |e: Option<f64>| e.map_or("unknown".into(), |e| format!("{:.2} %", 100.0 * e));
    println!("displaced volume {:.4e} m³", case::volume(body));
    println!(
        "estimated error {}{}, asymmetry {:.0e}, {} panels, {seconds:.2} s",
        percent(report.estimated_error),
        if report.converged {
            ""
        } else {
            " (tolerance not reached)"
        },
        report.asymmetry,
        report.panels,
    );
    if let Some(error) = without::error(body, added) {
        println!(
            "without boundary elements ({}): {:.1} % off for translation, {:.1} % for rotation",
            error.source,
            100.0 * error.linear,
            100.0 * error.angular
        );
    }
}
