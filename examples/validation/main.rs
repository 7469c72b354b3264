//! How well this crate's bodies fall: every case against measurements and exact results, in one table.
//!
//! ```text
//! cargo run --release --example validation                    # everything, minutes
//! cargo run --release --example validation -- --quick         # fewer and shorter runs, seconds
//! cargo run --release --example validation -- --only drag,plates
//! cargo run --release --features bake --example validation    # added mass by boundary elements too
//! ```
//!
//! The table goes to the terminal, `validation.json` and the pictures to `--out`. A bar that is not met
//! is shown as not met; it does not change the exit code, which is 0 once everything has been
//! computed and written, 2 for a bad flag, 1 if a file cannot be written.

#[path = "../../tests/validation/published/mod.rs"]
mod published;
#[path = "../support/mod.rs"]
mod support;

use clap::Parser;
use published::{Effort, SectionName, report};
use std::process::exit;
use support::options::{Json, Only, Out};

/// Compares this crate with measurements and exact results.
#[derive(Parser)]
#[command(name = "validation", version)]
#[command(mut_arg("out", |out| out.default_value("out/validation")))]
struct Arguments {
    #[command(flatten)]
    only: Only<SectionName>,
    /// Fewer and shorter runs, for a look or a test: seconds
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    json: Json,
    #[command(flatten)]
    out: Out,
}

fn main() {
    let arguments: Arguments = support::cli::parse();
    let effort = if arguments.quick {
        Effort::Quick
    } else {
        Effort::Full
    };
    let mut sections = Vec::new();
    for name in SectionName::chosen(&arguments.only.only) {
        let bar = support::cli::progress(1000, name.title());
        let section = name.compute(effort, &|share| bar.set_position((1000.0 * share) as u64));
        bar.finish_and_clear();
        let section = section.unwrap_or_else(|problem| {
            eprintln!("error: section {}: {problem}", name.name());
            exit(1)
        });
        for (file, svg) in &section.pictures {
            arguments.out.write(file, svg);
        }
        sections.push(section);
    }
    let json = report::json(&sections);
    arguments
        .out
        .write("validation.json", format!("{json:#}\n"));
    if arguments.json.on {
        println!("{json:#}");
        return;
    }
    print!("{}", report::table(&sections));
    println!("\n{}", report::summary(&sections));
    println!(
        "Numbers and pictures are in {}.",
        arguments.out.folder.display()
    );
}
