//! Motion patterns in pictures: the phase diagram with a body of your own on it, and what chapter 5 of
//! H. Xie's thesis shows (Figs. 5.5–5.16), recomputed. With `--json` the numbers behind every figure, by its number.
//!
//! ```text
//! cargo run --release --features bake,serde-serialize --example patterns -- --out out
//! ```

mod card;
#[path = "../support/draw.rs"]
#[allow(dead_code, reason = "shared with other examples")]
mod draw;
mod falls;
mod phase;
#[path = "../support/mod.rs"]
mod support;
mod training;

use clap::Parser;
use draw::Panel;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rapier3d_immersed::training::Experiment;
use rapier3d_immersed::{Error, ThesisLaw, ViscousLaw};
use serde_json::json;
use std::f64::consts::PI;
use std::path::PathBuf;
use std::process::ExitCode;
use support::cli;
use support::options::{Count, Json, Out, Seed};
use training::Trained;

/// Draws the phase diagram, with a body of your own on it, and the figures of thesis chapter 5; --count leaves fall from its tree.
#[derive(Parser)]
#[command(name = "patterns", version)]
#[command(mut_arg("count", |count| count.default_value("12")))]
#[command(mut_arg("density", |density| density.default_value("400")))]
struct Arguments {
    #[command(flatten)]
    out: Out,
    #[command(flatten)]
    body: phase::BodyArguments,
    #[command(flatten)]
    seed: Seed,
    #[command(flatten)]
    count: Count,
    /// Only the phase diagram
    #[arg(long)]
    phase_only: bool,
    /// Also count the labels that the time step and the release change (half a minute)
    #[arg(long)]
    step_error: bool,
    #[command(flatten)]
    json: Json,
}

/// Where pictures and words go.
pub struct Context {
    out: PathBuf,
    quiet: bool,
}

impl Context {
    pub fn write(
        &self,
        file: &str,
        title: &str,
        panels: &[Panel],
        columns: usize,
        size: (u32, u32),
    ) {
        let path = self.out.join(file);
        if let Err(error) = draw::write(&path, title, panels, columns, size) {
            eprintln!("error: cannot write {}: {error}", path.display());
            std::process::exit(1);
        }
    }

    pub fn say(&self, line: impl std::fmt::Display) {
        if !self.quiet {
            println!("{line}");
        }
    }
}

/// A progress bar; silent where there is no terminal.
pub fn bar(steps: u64, message: &'static str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr_with_hz(8));
    let style = ProgressStyle::with_template("{msg:8} [{bar:40}] {percent:>3}% {eta_precise}");
    bar.set_style(style.expect("the template is fixed"));
    bar.set_message(message);
    bar
}

fn main() -> ExitCode {
    let arguments: Arguments = cli::parse();
    arguments.count.check(1..=1000);
    if let Err(error) = std::fs::create_dir_all(&arguments.out.folder) {
        eprintln!("error: --out {}: {error}", arguments.out.folder.display());
        return ExitCode::FAILURE;
    }
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// The leaf that is planned with: under the default law, released about its long axis, as leaves fall.
fn default_leaf() -> Result<Experiment, Error> {
    let mut leaf = Experiment::thesis_leaf(ThesisLaw::new([1.0; 3]))?;
    leaf.body.law = ViscousLaw::default();
    leaf.release.tilt_axis = 80f64.to_radians();
    Ok(leaf)
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let seed = arguments.seed.value;
    let context = Context {
        out: arguments.out.folder.clone(),
        quiet: arguments.json.on,
    };
    let phase = phase::draw(&context, &arguments.body)?;
    if arguments.phase_only {
        if arguments.json.on {
            println!("{:#}", json!({ "phase": phase }));
        }
        return Ok(());
    }
    let unit = ThesisLaw::new([1.0; 3]);
    let card = Experiment::thesis_card(unit)?;
    let leaf = Experiment::thesis_leaf(unit)?;
    let free_leaf = default_leaf()?;
    let mut free_card = card.clone();
    free_card.body.law = ViscousLaw::default();
    free_card.release = free_leaf.release;
    let trainee = |experiment: &Experiment| experiment.clone().for_training();
    let trained = [
        Trained::new("card, thesis law", &trainee(&card), 9, PI, seed)?,
        Trained::new(
            "leaf, thesis law, to 2π",
            &trainee(&leaf),
            11,
            2.0 * PI,
            seed,
        )?,
        Trained::new("card, default law", &trainee(&free_card), 9, PI, seed)?,
        Trained::new("leaf, default law", &trainee(&free_leaf), 9, PI, seed)?,
    ];
    let clusters = training::clusters(&context, &trained);
    let (_, card_subspaces) = training::subspaces(
        &context,
        &trainee(&card),
        &trained[0],
        false,
        "fig_5_10_thesis_law.svg",
    )?;
    let (leaf_space, leaf_subspaces) = training::subspaces(
        &context,
        &free_leaf,
        &trained[3],
        true,
        "fig_5_10_default_law.svg",
    )?;
    let planner = falls::planner(&free_leaf, &leaf_space)?;
    let (fig_5_6, fig_5_12) = card::four_patterns(&context)?;
    let (fig_5_14, fig_5_15) = falls::leaf(&context, &planner, seed)?;
    let numbers = json!({
        "phase": phase,
        "fig_5_7": clusters,
        "fig_5_8": trained.iter().map(Trained::counts).collect::<Vec<_>>(),
        "fig_5_9": training::sampling(&context, &trainee(&card))?,
        "fig_5_10": [card_subspaces, leaf_subspaces],
        "fig_5_11": card::graph(&context),
        "fig_5_12": fig_5_12,
        "fig_5_5": falls::helix(&context)?,
        "fig_5_6": fig_5_6,
        "fig_5_13": falls::effects(&context, seed)?,
        "fig_5_14": fig_5_14,
        "fig_5_15": fig_5_15,
        "fig_5_16": falls::tree(&context, &planner, seed, arguments.count.within(1..=1000).into())?,
        "sketches": falls::sketches(&context, &free_leaf, seed)?,
        "step_error": if arguments.step_error {
            json!([training::step_error(&card)?, training::step_error(&free_leaf)?])
        } else {
            json!(null)
        },
    });
    if arguments.json.on {
        println!("{numbers:#}");
    } else {
        println!("pictures are in {}", arguments.out.folder.display());
    }
    Ok(())
}
