//! H. Xie's thesis beside this crate, item by item: makes `docs/thesis.md` and its pictures.
//!
//! ```text
//! cargo run --release --features bake,serde-serialize --example thesis
//! ```
//!
//! With `-- --render` it only writes the page again, from what was measured last: after its words have changed.
//!
//! Runs the examples that show the thesis's figures, takes the numbers that the thesis prints from what they
//! print, and times what it times: a few minutes. `docs/thesis.json` keeps what was measured, so that a test
//! (`tests/thesis`) can tell whether the page is what this would write.

mod chapter_2_3;
mod chapter_4;
mod chapter_5;
mod chapter_6_7;
mod contents;
mod entry;
mod page;
mod timings;

use clap::Parser;
use contents::{COMMAND, RUNS, chapters};
use entry::{Entry, Ours, Run};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::{Map, Value};
use std::collections::HashMap;
use std::error::Error;
use std::path::Path;
use std::process::Command;

/// Makes `docs/thesis.md` and its pictures.
#[derive(Parser)]
#[command(name = "thesis", version)]
struct Options {
    /// Only write the page again, from what was measured last
    #[arg(long)]
    render: bool,
}

fn main() {
    if let Err(problem) = run(&Options::parse()) {
        eprintln!("error: {problem}");
        std::process::exit(1);
    }
}

fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    if options.render {
        let measured = std::fs::read_to_string(docs.join("thesis.json"))?;
        return write_page(&docs, &serde_json::from_str(&measured)?);
    }
    let style = ProgressStyle::with_template("{msg:>16} {wide_bar} {pos} of {len}")?;
    let bar = ProgressBar::new(RUNS.len() as u64 + 1).with_style(style);
    let mut printed = HashMap::new();
    for run in RUNS {
        bar.set_message(run.example);
        let folder = docs.join("thesis").join(run.example);
        std::fs::create_dir_all(&folder)?;
        printed.insert(run.example, output(run, &folder)?);
        bar.inc(1);
    }
    bar.set_message("times");
    let times = timings::measure()?;
    bar.finish_and_clear();

    let mut measured = Map::new();
    for entry in chapters().iter().flat_map(|chapter| chapter.entries) {
        for number in entry.numbers {
            let value = match number.ours {
                Ours::Quick(_) => continue,
                Ours::Timed(name) => times.get(name).cloned(),
                Ours::Printed(pointer) => from(entry, pointer, &printed)?,
            };
            let key = number.key(entry);
            let value = value.ok_or_else(|| format!("{key}: nothing of that name was measured"))?;
            if measured.insert(key.clone(), value).is_some() {
                return Err(format!("{key}: two numbers of one name").into());
            }
        }
        for (key, pointer) in entry.grid.iter().flat_map(|grid| grid.cells(entry)) {
            let value = from(entry, &pointer, &printed)?;
            measured.insert(
                key,
                value.ok_or_else(|| format!("{}: no {pointer}", entry.name))?,
            );
        }
    }
    keep_only_shown(&docs.join("thesis"))?;
    let measured = Value::Object(measured);
    std::fs::write(docs.join("thesis.json"), format!("{measured:#}\n"))?;
    write_page(&docs, &measured)
}

fn write_page(docs: &Path, measured: &Value) -> Result<(), Box<dyn Error>> {
    let page = page::render(&chapters(), RUNS, COMMAND, measured)?;
    std::fs::write(docs.join("thesis.md"), page)?;
    println!("docs/thesis.md");
    Ok(())
}

/// What an example prints as JSON; its pictures go into the folder.
fn output(run: &Run, folder: &Path) -> Result<Value, Box<dyn Error>> {
    let mut command = Command::new(env!("CARGO"));
    command.args(["run", "--quiet", "--release", "--example", run.example]);
    command
        .args(["--features", FEATURES, "--"])
        .args(run.arguments);
    command.arg("--json").arg("--out").arg(folder);
    let output = command.current_dir(env!("CARGO_MANIFEST_DIR")).output()?;
    if !output.status.success() {
        let words = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{}: {words}", run.example).into());
    }
    Ok(serde_json::from_slice(&output.stdout)?)
}

/// All examples are built with the same features, or each would build the crate anew.
const FEATURES: &str = "bake,serde-serialize";

fn from(
    entry: &Entry,
    pointer: &str,
    printed: &HashMap<&str, Value>,
) -> Result<Option<Value>, String> {
    let example = entry
        .example
        .ok_or_else(|| format!("{}: no example", entry.name))?;
    let output = printed
        .get(example)
        .ok_or_else(|| format!("'{example}' was not run"))?;
    Ok(output.pointer(pointer).cloned())
}

/// Examples also write what the page does not show.
fn keep_only_shown(folder: &Path) -> std::io::Result<()> {
    for run in RUNS {
        for file in std::fs::read_dir(folder.join(run.example))? {
            let file = file?;
            let shown = chapters()
                .iter()
                .flat_map(|chapter| chapter.entries)
                .any(|entry| {
                    entry.example == Some(run.example)
                        && entry.pictures.iter().any(|name| file.file_name() == **name)
                });
            if !shown {
                std::fs::remove_file(file.path())?;
            }
        }
    }
    Ok(())
}
