//! The added mass of a shape: what it takes to accelerate the fluid around it.
//!
//! ```text
//! cargo run --release --features bake,serde-serialize --example added_mass -- --shape box --size 0.2,0.1,0.01
//! cargo run --release --features bake,serde-serialize --example added_mass -- --shape airplane
//! cargo run --release --features bake,serde-serialize --example added_mass -- --mesh fish.obj --json
//! cargo run --release --features bake,serde-serialize --example added_mass -- --figure
//! ```

mod case;
mod error_figure;
#[allow(dead_code)]
#[path = "../support/mesh.rs"]
mod mesh;
mod picture;
#[path = "../support/previous.rs"]
mod previous;
mod proxy;

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use rapier3d_immersed::boundary_element::{
    BoundaryElementParams, BoundaryElementProgress, BoundaryElementSolution,
};
use rapier3d_immersed::rapier3d::na::{Matrix3, Vector3};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// As `mesh` has it from the module above.
type Vec3 = Vector3<f64>;

/// Added mass per unit fluid density, about the center of mass of a body of even density.
#[derive(Parser)]
struct Options {
    /// Shape to solve for.
    #[arg(long, value_enum, default_value = "leaf")]
    shape: case::Kind,
    /// Full extents in m, comma separated: x,y,z (box, ellipsoid, leaf), diameter,height (cylinder,
    /// cone, capsule), diameter (ball), side,thickness (airplane).
    #[arg(long, value_delimiter = ',', allow_negative_numbers = true)]
    size: Vec<f64>,
    /// A closed triangle mesh (OBJ or STL) instead of a shape.
    #[arg(long)]
    mesh: Option<PathBuf>,
    /// Metres per unit of the mesh, such as 0.001 for millimetres [default: 1, up to 10 m].
    #[arg(long, requires = "mesh", allow_negative_numbers = true)]
    scale: Option<f64>,
    /// The mesh is a sheet of this thickness, m, and need not be closed.
    #[arg(long, requires = "mesh", allow_negative_numbers = true)]
    thickness: Option<f64>,
    /// Relative error to refine to.
    #[arg(long, default_value_t = 0.01, allow_negative_numbers = true)]
    tolerance: f64,
    /// Most panels to use.
    #[arg(long, default_value_t = 6000)]
    max_panels: usize,
    /// Print JSON, and draw nothing but the figure.
    #[arg(long)]
    json: bool,
    /// Draw the error against thickness, ours beside plain quadrature (thesis, figure 5.2).
    #[arg(long)]
    figure: bool,
    /// Directory for the pictures.
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

fn main() -> ExitCode {
    match run(&Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn run(options: &Options) -> Result<(), String> {
    let failed = |e: std::io::Error| format!("--out {}: {e}", options.out.display());
    if options.figure {
        std::fs::create_dir_all(&options.out).map_err(failed)?;
        let picture = options.out.join("added_mass_error.svg");
        return error_figure::draw(&picture, options.json);
    }
    if options.tolerance.is_nan() || options.tolerance <= 0.0 {
        return Err(format!(
            "--tolerance {}: must be positive",
            options.tolerance
        ));
    }
    let case = match &options.mesh {
        Some(path) => case::Case::load(path, options.scale, options.thickness)?,
        None => case::Case::built_in(options.shape, &options.size)?,
    };
    let params = BoundaryElementParams {
        tolerance: options.tolerance,
        max_panels: options.max_panels,
        ..BoundaryElementParams::default()
    };
    let start = Instant::now();
    let bar = if options.json {
        ProgressBar::hidden()
    } else {
        let style = ProgressStyle::with_template("{msg:>14} {wide_bar} {percent:>3} %");
        ProgressBar::new(1000).with_style(style.map_err(|e| e.to_string())?)
    };
    let progress = |p: BoundaryElementProgress| {
        bar.set_message(format!("{} panels", p.panels));
        bar.set_position((p.share * 1000.0) as u64);
    };
    let solution = case.solve(&params, &progress).map_err(|e| e.to_string())?;
    let seconds = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    if options.json {
        println!("{:#}", json(&case, &solution));
        return Ok(());
    }
    print(&case, &solution, seconds);
    std::fs::create_dir_all(&options.out).map_err(failed)?;
    let path = options.out.join(format!("added_mass_{}.svg", case.name));
    picture::draw(&path, &case, &solution).map_err(|e| format!("--out: {e}"))?;
    println!("surface potential: {}", path.display());
    Ok(())
}

fn rows(m: &Matrix3<f64>) -> Vec<Vec<f64>> {
    m.row_iter().map(|r| r.iter().copied().collect()).collect()
}

fn json(case: &case::Case, solution: &BoundaryElementSolution) -> serde_json::Value {
    serde_json::json!({
        "linear": rows(&solution.added_mass.linear),
        "coupling": rows(&solution.added_mass.coupling),
        "angular": rows(&solution.added_mass.angular),
        "volume": case.volume(),
        "error": solution.report.estimated_error,
        "panels": solution.report.panels,
    })
}

fn print(case: &case::Case, solution: &BoundaryElementSolution, seconds: f64) {
    let (added, report) = (&solution.added_mass, &solution.report);
    println!(
        "{}: added mass per unit density about {:.5?} m",
        case.name,
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
    println!("displaced volume {:.4e} m³", case.volume());
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
    if let Some(error) = proxy::error(case, added) {
        println!(
            "proxy ellipsoid: {:.1} % off for translation, {:.1} % for rotation",
            100.0 * error.linear,
            100.0 * error.angular
        );
    }
}
