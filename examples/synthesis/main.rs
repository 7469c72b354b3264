//! Falls put together from a motion graph: what chapter 3 of H. Xie's thesis shows (Figs. 3.4–3.6, 3.8–3.10,
//! 3.13, 3.15–3.18), recomputed, the last one with collisions.
//!
//! ```text
//! cargo run --release --features bake --example synthesis -- --out out
//! ```
//!
//! * `synthesis_database.svg`: solutions of the model (3.4), and the segments cut from them,
//! * `synthesis_patterns.svg`: a leaf in each regime, **prescribed**,
//! * `synthesis_bodies.svg`: the thesis's coin, paper and leaf through the regimes that the thesis shows of
//!   them, **prescribed**, then as **sampled** from the motion graph at the numbers that are computed for
//!   them, and leaves in wind, sampled,
//! * `synthesis_classes.svg`: the motion classes of this crate's own falls and of tracked ones,
//! * `synthesis_chain.svg`: the states and probabilities of the Markov chain, for each main regime,
//! * `synthesis_wind.svg`: how a trajectory is bent by the wind, step by step,
//! * `synthesis_frames.svg`: the graph of frames beside that of regimes,
//! * `synthesis_tree.svg`, `synthesis_tree.html` (plays in a browser): leaves from a tree, sampled with the main regime that the thesis prints for its
//!   leaf, with collisions.
//!
//! Printed: Re and I* of the three bodies as the thesis prints them and as they are computed, the regime
//! that the phase diagram has for either, and what became of the tree's leaves; with `--json` the numbers behind
//! every figure. `--estimate` makes the file that the chain's probabilities, the deviations and the border of the
//! spiral ship in.

mod chain;
#[path = "../support/draw.rs"]
#[allow(dead_code, reason = "shared with other examples")]
mod draw;
mod estimate;
mod figures;
#[path = "../support/mod.rs"]
mod support;
mod tree;

use clap::Parser;
use rapier3d_immersed::motion::path::{
    DatabaseParams, SynthesisParams, Synthesizer, TrajectoryDatabase,
};
use rapier3d_immersed::motion::{DimensionlessNumbers, Outline, PhaseDiagram};
use rapier3d_immersed::{Error, Fluid};
use serde_json::json;
use std::path::PathBuf;
use std::process::exit;
use std::sync::Arc;
use support::film::FilmArgs;
use support::options::{Count, Json, Out, Seed};

/// Own falls whose motion classes are shown.
const OBSERVED: u64 = 3000;

/// Draws the figures of thesis chapter 3.
#[derive(Parser)]
#[command(name = "synthesis", version)]
#[command(mut_arg("count", |count| count.default_value("40")))]
struct Arguments {
    #[command(flatten)]
    film: FilmArgs,
    #[command(flatten)]
    out: Out,
    #[command(flatten)]
    seed: Seed,
    #[command(flatten)]
    count: Count,
    /// Bake the default database into this file, and do nothing else
    #[arg(long)]
    write_database: Option<PathBuf>,
    /// Estimate transition probabilities, deviations and the border of the spiral into this file from falls
    /// under the default law and tracked ones, and do nothing else
    #[arg(long)]
    estimate: Option<PathBuf>,
    /// Falls that are computed for it
    #[arg(long, default_value_t = 12_000, value_parser = clap::value_parser!(u64).range(100..))]
    falls: u64,
    #[command(flatten)]
    json: Json,
}

/// A worked body of thesis § 3.6.
pub struct Body {
    pub name: &'static str,
    pub numbers: DimensionlessNumbers,
    /// Longest extent, m.
    pub length: f64,
    /// Release height, m.
    pub height: f64,
}

impl Body {
    pub fn synthesizer(
        &self,
        params: SynthesisParams,
        database: &Arc<TrajectoryDatabase>,
    ) -> Result<Synthesizer, Error> {
        let params = SynthesisParams {
            height: self.height,
            ..params
        };
        Synthesizer::new(&self.numbers, self.length, database.clone(), params)
    }
}

/// The coin, the paper and the leaf, in the order of [`PhaseDiagram::THESIS_CASES`]. Densities of paper
/// and leaf are ours.
fn bodies() -> Result<[Body; 3], Error> {
    let body = |name, fluid: Fluid, [length, chord, thickness]: [f64; 3], density, height| {
        let numbers =
            DimensionlessNumbers::new(Outline::Round, chord, thickness, density, &fluid, 9.81)?;
        Ok(Body {
            name,
            numbers,
            length,
            height,
        })
    };
    Ok([
        body(
            "yen coin in water",
            Fluid::WATER,
            [0.02, 0.02, 0.0015],
            2700.0,
            0.5,
        )?,
        body("paper in air", Fluid::AIR, [0.08, 0.02, 0.0001], 800.0, 3.1)?,
        body(
            "leaf in air",
            Fluid::AIR,
            [0.073, 0.042, 0.0003],
            400.0,
            2.0,
        )?,
    ])
}

fn main() {
    let arguments: Arguments = support::cli::parse();
    if let Err(error) = run(&arguments) {
        eprintln!("error: {error}");
        exit(1)
    }
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn std::error::Error>> {
    if let Some(path) = &arguments.estimate {
        let tracked = tracked_falls()?;
        let bar = support::cli::progress(arguments.falls, "falls of discs");
        let table = estimate::table(arguments.falls, &tracked, || bar.inc(1))?;
        bar.finish_and_clear();
        std::fs::write(path, table)
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
        return Ok(());
    }
    if let Some(path) = &arguments.write_database {
        let (database, report) = TrajectoryDatabase::bake(&DatabaseParams::default())?;
        std::fs::write(path, database.to_bytes())
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
        println!(
            "{} segments; solutions: {report:?}",
            database.entries().len()
        );
        return Ok(());
    }
    std::fs::create_dir_all(&arguments.out.folder)
        .map_err(|error| format!("cannot create {}: {error}", arguments.out.folder.display()))?;
    let database = TrajectoryDatabase::shipped();
    let bodies = bodies()?;
    let diagram = PhaseDiagram::default();
    let mut rows = Vec::new();
    for (body, case) in bodies.iter().zip(PhaseDiagram::THESIS_CASES) {
        let numbers = &body.numbers;
        let printed = diagram.regime(case.reynolds, case.i_star).to_string();
        let computed = diagram.regime_of(numbers).to_string();
        if !arguments.json.on {
            println!(
                "{}: printed Re {:.3e}, I* {:.2e} ({printed}; the thesis sees {}); computed Re {:.3e} by its (3.3), \
                 U {:.3} m/s, and {:.3e} of the mean descent, I* {:.2e} ({computed})",
                body.name,
                case.reynolds,
                case.i_star,
                case.regime,
                numbers.reynolds_u0,
                numbers.u0,
                numbers.reynolds(),
                numbers.i_star,
            );
        }
        rows.push(json!({
            "body": body.name,
            "thesis": {
                "reynolds": case.reynolds,
                "i_star": case.i_star,
                "regime": case.regime.to_string(),
                "regime_by_the_diagram": printed,
            },
            "computed": {
                "u0_m_per_s": numbers.u0,
                "reynolds_u0": numbers.reynolds_u0,
                "descent_m_per_s": numbers.broadside_descent(),
                "reynolds": numbers.reynolds(),
                "i_star": numbers.i_star,
                "regime": computed,
            },
        }));
    }
    let (out, seed) = (&arguments.out.folder, arguments.seed.value);
    figures::database(out, &database)?;
    figures::patterns(out, &bodies[2], &database, seed)?;
    figures::bodies(out, &bodies, &database, seed)?;
    let bar = support::cli::progress(OBSERVED, "falls of discs");
    let falls = estimate::falls(0, OBSERVED, || bar.inc(1))?;
    bar.finish_and_clear();
    let classes = chain::classes(out, &falls, &tracked_falls()?)?;
    let chain = chain::chain(out)?;
    let wind = chain::bent(out, &bodies[2], &database, seed)?;
    let frames = chain::frames(out, &bodies[2], &database, seed)?;
    let report = tree::draw(
        (&arguments.out, &arguments.film),
        &bodies[2],
        &database,
        arguments.count.within(1..=2000).into(),
        seed,
    )?;
    let all = json!({
        "bodies": rows,
        "classes": classes,
        "chain": chain,
        "wind": wind,
        "frames": frames,
        "tree": report,
    });
    if arguments.json.on {
        println!("{all:#}");
    } else {
        println!(
            "classes: {} of {} own falls",
            all["classes"]["own_classes"], OBSERVED
        );
        println!("frames: {frames}", frames = all["frames"]);
        println!("tree: {}", all["tree"]);
    }
    Ok(())
}

/// The table of tracked falls.
fn tracked_falls() -> Result<String, String> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/paper/falls.csv");
    std::fs::read_to_string(path).map_err(|error| format!("cannot read {path}: {error}"))
}
