//! The four methods of the thesis beside each other, and beside them the default law and plain rapier: its Table 7.1
//! filled in from measurement, and its questionnaire to be asked again.
//!
//! ```text
//! cargo run --release --features bake,serde-serialize --example methods -- --out out
//! ```
//!
//! * A table: time and memory per body, what is made beforehand, falls of paper (24 mm circles) beside the measured ones of
//!   `tests/data/paper`, and for each of the thesis's seven criteria a number beside its tick.
//! * `methods.svg`: a leaf by each method, every 1/15 s, to one scale.
//! * `methods.html` and, with `--gif`, `methods.gif`: nine leaves by each, side by side in the order of the table.
//! * `scoring.html`: the questionnaire of § 7.2 with films in random order. It sends nothing; answers are saved as CSV, and
//!   E of (7.1) is computed from one's own and others' files.
//!
//! What each method is here: *graph-based* `motion::path::Synthesizer` and `playback`; *stochastic* `StochasticLaw` in
//! Langevin turbulence of the shipped table; *pattern-driven* the default law with factors from a codebook of plans
//! (`training`), both along the transitions that were measured: what paper does in them is given, not forecast; *reduced* a `SeparatedLaw` of the default law, of rank 32.

mod control;
mod cost;
mod fidelity;
mod means;
mod measured;
mod memory;
mod method;
mod mover;
mod picture;
mod prepared;
mod reach;
mod report;
mod scoring;
mod stability;
mod subject;
#[path = "../support/mod.rs"]
mod support;
mod table;
mod tracks;

use clap::Parser;
use means::Means;
use method::Method;
use prepared::Prepared;
use rapier3d_immersed::motion::MotionGraph;
use report::Row;
use std::process::ExitCode;
use subject::Subject;
use support::cli;
use support::film::FilmArgs;
use support::options::{Json, Out};

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// The methods of the thesis side by side: cost, fidelity, control, films and the questionnaire.
#[derive(Parser)]
#[command(name = "methods", version)]
struct Options {
    #[command(flatten)]
    film: FilmArgs,
    #[command(flatten)]
    out: Out,
    /// Measure nothing, only draw
    #[arg(long)]
    films_only: bool,
    #[command(flatten)]
    json: Json,
}

fn main() -> ExitCode {
    let options: Options = cli::parse();
    match run(&options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("error: {problem}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: &Options) -> Result<(), Failure> {
    let leaf = Prepared::new(Subject::leaf()?, None, MotionGraph::thesis())?;
    let [regimes, patterns] = measured::graphs()?;
    let paper = Prepared::new(Subject::paper()?, Some(regimes), patterns)?;
    if !options.films_only {
        let measured = measured::means()?;
        let rows = measure(&leaf, &paper, &measured)?;
        if options.json.on {
            println!("{:#}", report::json(&rows, &measured));
        } else {
            print!("{}", table::table(&rows, &measured));
        }
    }
    draw(options, &leaf, &paper)
}

fn measure(leaf: &Prepared, paper: &Prepared, measured: &Means) -> Result<Vec<Row>, Failure> {
    let bar = cli::progress(Method::ALL.len() as u64, "measured");
    let costs = cost::costs(leaf)?;
    let mut rows = Vec::new();
    for (method, cost) in Method::ALL.into_iter().zip(costs) {
        let means = Means::of(&fidelity::falls(paper, method, fidelity::FALLS)?);
        rows.push(Row {
            method,
            cost,
            making: leaf.making(method),
            errors: means.errors(measured),
            means,
            stability: stability::stability(leaf, method)?,
            landing: control::landing(leaf, method)?,
            sequence: control::sequence(leaf, method)?,
            refused: reach::refused(method),
            shapes: reach::tried(),
            gap: reach::joined(leaf, method)?,
        });
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(rows)
}

fn draw(options: &Options, leaf: &Prepared, paper: &Prepared) -> Result<(), Failure> {
    let path = |name: &str| options.out.path(name);
    cli::write(&path("methods.svg"), picture::strip(leaf)?);
    let films = picture::films(leaf)?;
    cli::write(&path("methods.html"), &films.page);
    if options.film.gif {
        cli::write(&path("methods.gif"), &films.gif);
    }
    if options.film.open {
        cli::open(&path("methods.html"));
    }
    let tracks = tracks::films(paper)?;
    let mut leaves = films.each;
    let judged: Vec<scoring::Film> = tracks
        .beside
        .into_iter()
        .map(|(key, track)| {
            let own = leaves.iter().position(|(method, _)| method.key() == key);
            let own = own.map(|i| leaves.swap_remove(i));
            scoring::Film {
                key,
                name: own
                    .as_ref()
                    .map_or("repeat of the measured fall", |(m, _)| m.name()),
                track,
                leaves: own.map(|(_, gif)| gif),
            }
        })
        .collect();
    cli::write(
        &path("scoring.html"),
        scoring::page(&tracks.measured, &judged),
    );
    Ok(())
}
