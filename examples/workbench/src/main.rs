//! The workbench: in a window, or without one for a film or a picture of a saved scene.
//!
//! ```text
//! cargo run --release --manifest-path examples/workbench/Cargo.toml
//! cargo run --release --manifest-path examples/workbench/Cargo.toml -- examples/workbench/scenes/leaves.json --to leaves.html
//! ```

use clap::Parser;
use immersed_workbench::{Bench, Change, Command, Rain};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// A workbench for bodies in air and water.
#[derive(Parser)]
#[command(name = "immersed-workbench", version)]
struct Options {
    /// A saved scene to begin with
    scene: Option<PathBuf>,
    /// Makes a film of the scene from its beginning (.html, .gif, .glb), or a picture of it (.png), instead of a window
    #[arg(long, value_name = "FILE", requires = "scene")]
    to: Option<PathBuf>,
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
    match &options.scene {
        Some(scene) => bench.apply(Command::Load(scene.clone()))?,
        None => bench.apply(Command::Change(Change::Rain(Rain::default())))?,
    }
    match &options.to {
        Some(path) if path.extension().is_some_and(|kind| kind == "png") => picture(bench, path),
        Some(path) => film(bench, path.clone()),
        None => open(bench),
    }
}

fn film(mut bench: Bench, path: PathBuf) -> Result<String, String> {
    let steps = bench.state().step;
    bench.apply(Command::Rewind(f64::MAX))?;
    bench.apply(Command::Record(true))?;
    bench.apply(Command::Step(steps))?;
    bench.apply(Command::Film(path))?;
    Ok(bench.message)
}

#[cfg(feature = "window")]
fn picture(bench: Bench, path: &Path) -> Result<String, String> {
    let drawn = immersed_workbench::window::write_picture(bench, path);
    kiss3d::pollster::block_on(drawn)?;
    Ok(format!("{} written", path.display()))
}

#[cfg(feature = "window")]
fn open(bench: Bench) -> Result<String, String> {
    kiss3d::pollster::block_on(immersed_workbench::window::open(bench));
    Ok(String::new())
}

#[cfg(not(feature = "window"))]
fn picture(_: Bench, _: &Path) -> Result<String, String> {
    open(Bench::default())
}

#[cfg(not(feature = "window"))]
fn open(_: Bench) -> Result<String, String> {
    Err("this was built without its window: it makes films of scenes, with --to".into())
}
