//! Do the tests notice? Draws small changes of the crate's code ("mutants"), and counts how many of them some
//! test notices.
//!
//! All drawn mutants are compiled at once (*mutant schemata*): in a copy of the crate each place reads
//! `if crate::mutants::active(7) { changed } else { original }`, and an environment variable says which number
//! is active. What does not compile is left out: it is found by reading the compiler's errors. Each test is run
//! once alone to learn which places it reaches and how long it takes; each mutant is then tried with the tests
//! that reach it, the quickest first, until one fails.
//!
//! ```text
//! cargo run --release --manifest-path tools/mutants/Cargo.toml -- --number 300
//! ```
//!
//! The changes of `named.txt`, which once passed every test, are tried first and counted apart.
//!
//! The folder `--out` keeps everything; the same command goes on where it was stopped. `--retry` tries again
//! what has survived, after tests were added.
//!
//! What is drawn, each site and operator with equal probability:
//!
//! | operator | original | mutant |
//! |---|---|---|
//! | arithmetic | `a + b`, `a * b`, `a += b`, `a *= b`, and back | `a - b`, `a / b`, `a -= b`, `a /= b` |
//! | comparison | `a < b`, `a <= b`, `a == b`, and back | `a >= b`, `a > b`, `a != b` |
//! | logic | `a && b`, `!a`, `true`, `if a`, and back | `a \|\| b`, `a`, `false`, `if !a` |
//! | number | `0.0`, `0.7`, `0`, `1`, `7` | `1.0`, `0.77`, `1`, `0`, `8` |
//! | minus dropped | `-a` | `a` |
//! | minus added | `let x = a`, `field: a`, `x = a` | `let x = -a`, `field: -a`, `x = -a` |
//! | statement dropped | `x = a;`, `x += a;`, `f(a);`, `x.f(a);` | |
//! | arguments swapped | `f(a, b)`, `x.f(a, b)` | `f(b, a)`, `x.f(b, a)` |
//! | call | `a.max(b)`, `a.sin()`, `a.any(f)`, `rotate(q, v)`, and back | `a.min(b)`, `a.cos()`, `a.all(f)`, `rotate_back(q, v)` |
//! | call dropped | `a.abs()`, `a.sqrt()`, `a.inverse()`, `a.transpose()` | `a` |
//!
//! Nothing is drawn in tests, in constants that the compiler evaluates, in patterns and types, in macros (so
//! neither in texts nor in tables of coefficients), in implementations of formatting and serialisation, and in
//! code of features that are off. Boundaries (`<` to `<=`) are not drawn: for real numbers they are equivalent.

mod compile;
mod named;
mod report;
mod schema;
mod sites;
mod trial;

use clap::Parser;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Files of held bodies, which are being rebuilt: drawn from only when asked (`--except ''`).
const UNDER_CONSTRUCTION: [&str; 8] = [
    "src/coupling/step/constraint_impulse.rs",
    "src/coupling/step/energy_budget.rs",
    "src/coupling/step/friction.rs",
    "src/coupling/step/held_motion.rs",
    "src/coupling/step/locked_axes.rs",
    "src/coupling/step/mean_motion.rs",
    "src/coupling/step/write_back.rs",
    "src/dynamics/locked.rs",
];

/// Counts how many small changes of the code the tests notice.
#[derive(Clone, Debug, Parser)]
struct Options {
    /// The crate.
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))]
    root: PathBuf,
    /// Where the copy of the crate and the results go.
    #[arg(long, default_value = "target/mutants")]
    out: PathBuf,
    /// Files and folders that mutants are drawn from.
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "src/dynamics,src/coupling,src/hydro,src/turbulence/langevin.rs"
    )]
    from: Vec<String>,
    /// Files that none are drawn from.
    #[arg(long, value_delimiter = ',', default_values = UNDER_CONSTRUCTION)]
    except: Vec<String>,
    /// Seed of the draw.
    #[arg(long, default_value_t = 16)]
    seed: u64,
    /// Number of mutants that compile.
    #[arg(long, default_value_t = 300)]
    number: usize,
    /// Features of the crate; without `bake` none are drawn in its boundary elements.
    #[arg(long, default_value = "")]
    features: String,
    /// Test binaries besides the unit tests.
    #[arg(long, value_delimiter = ',', default_value = "validation")]
    tests: Vec<String>,
    /// Tests whose names begin so are left out. Energy of held bodies: a rare case fails for any change of a bit.
    #[arg(long, value_delimiter = ',', default_value = "held::energy")]
    without: Vec<String>,
    /// Tests that take longer than this alone, s, are left out.
    #[arg(long, default_value_t = 60.0)]
    longest: f64,
    /// Stop after this many minutes; the same command goes on.
    #[arg(long)]
    minutes: Option<f64>,
    /// Try again what has survived.
    #[arg(long)]
    retry: bool,
    /// Only draw and list what could be drawn, by operator.
    #[arg(long)]
    list: bool,
}

fn main() -> ExitCode {
    match run(&Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// An error is a text for the user.
type Result<T> = std::result::Result<T, String>;

fn run(options: &Options) -> Result<()> {
    let end = options
        .minutes
        .map(|minutes| Instant::now() + Duration::from_secs_f64(60.0 * minutes));
    let features: Vec<&str> = options.features.split(',').collect();
    let candidates = sites::find(&options.root, &options.from, &options.except, &features)?;
    if options.list {
        report::candidates(&candidates);
        return Ok(());
    }
    let named = named::read(&options.root, include_str!("../named.txt"))?;
    let drawn = schema::draw(&candidates, options.seed, 3 * options.number);
    let copy = schema::Copy::new(&options.root, &options.out)?;
    let viable = compile::viable(&copy, named, drawn, options)?;
    let binaries = compile::binaries(&copy, options)?;
    let mut results = report::Results::load(&options.out.join("results.tsv"))?;
    let wanted: Vec<_> = viable
        .iter()
        .enumerate()
        .filter(|(_, site)| results.wants(site, options.retry))
        .collect();
    println!("{} mutants, {} to try", viable.len(), wanted.len());
    if !wanted.is_empty() {
        let suite = trial::Suite::measure(&binaries, viable.len(), options)?;
        for (number, site) in wanted {
            if end.is_some_and(|end| Instant::now() > end) {
                println!("time is up: the same command goes on");
                break;
            }
            let outcome = suite.attempt(number)?;
            println!("{number:4} {site}: {outcome}");
            results.add(site, outcome)?;
        }
    }
    report::summary(&viable, &results);
    Ok(())
}
