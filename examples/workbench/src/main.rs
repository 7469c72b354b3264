//! The workbench without a window: a film of a saved scene.
//!
//! ```text
//! cargo run --manifest-path examples/workbench/Cargo.toml -- examples/workbench/scenes/leaves.json --page leaves.html
//! ```

use clap::Parser;
use immersed_workbench::{Bench, Command};
use std::path::PathBuf;
use std::process::ExitCode;

/// Plays a saved scene from its beginning.
#[derive(Parser)]
#[command(name = "immersed-workbench", version)]
struct Options {
    /// A saved scene
    scene: PathBuf,
    /// The film: a .html, .gif or .glb file
    #[arg(long, value_name = "FILE", default_value = "bench.html")]
    page: PathBuf,
}

fn main() -> ExitCode {
    match run(&Options::parse()) {
        Ok(message) => {
            println!("{message}");
            ExitCode::SUCCESS
        }
        Err(problem) => {
            eprintln!("error: {problem}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: &Options) -> Result<String, String> {
    let mut bench = Bench::default();
    bench.apply(Command::Load(options.scene.clone()))?;
    let steps = bench.state().step;
    bench.apply(Command::Rewind(f64::MAX))?;
    bench.apply(Command::Record(true))?;
    bench.apply(Command::Step(steps))?;
    bench.apply(Command::Film(options.page.clone()))?;
    Ok(bench.message)
}
