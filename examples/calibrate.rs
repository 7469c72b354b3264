//! Finds the coefficients of the default viscous law: drops plates, discs and papers as they were dropped
//! in published experiments, and searches for what reproduces them best.
//!
//! ```text
//! cargo run --release --features bake,serde-serialize --example calibrate -- --measurements half
//! ```
//!
//! The search is CMA-ES (Hansen 2016) between the bounds of
//! [`searched`](rapier3d_immersed::training::fidelity::searched), on all cores and
//! reproducible from its seed. Every evaluation is appended to a log; started again with the same flags
//! the search reads it and goes on where it stopped.
//!
//! Afterwards it prints the score of each target, on the measurements that were fitted, on those that were
//! not (`--measurements half`), and for releases with other seeds.

mod support;

use clap::{Parser, ValueEnum};
use ganesh::algorithms::gradient_free::cmaes::{CMAES, CMAESConfig};
use ganesh::core::{Callbacks, MaxSteps};
use ganesh::traits::{Algorithm, CostFunction};
use ganesh::{NalgebraProvider, Vector};
use indicatif::ProgressBar;
use rapier3d_immersed::training::Experiment;
use rapier3d_immersed::training::fidelity::{Effort, Fidelity, Part, Report};
use rapier3d_immersed::training::fidelity::{law_at, places, searched};
use rapier3d_immersed::{PhysicalLaw, ViscousLaw};
use std::cell::RefCell;
use std::collections::HashMap;
use std::convert::Infallible;
use std::fs::{File, OpenOptions, read_to_string};
use std::io::Write;
use std::path::{Path, PathBuf};
use support::cli;
use support::options::{Out, Seed};

/// Which measurements the search sees.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Fit {
    /// All of them
    All,
    /// Every second one; the others score the result
    Half,
}

/// Search for the coefficients of the default viscous law; `law.json` and a log are written.
#[derive(Parser)]
#[command(name = "calibrate", version)]
#[command(mut_arg("out", |out| out.default_value("out/calibrate")))]
struct Arguments {
    /// Generations of the search; 0 only scores
    #[arg(long, default_value_t = 200)]
    generations: usize,
    /// Laws per generation
    #[arg(long, default_value_t = 24, value_parser = clap::value_parser!(u64).range(4..10_000))]
    population: u64,
    /// First step of the search, in widths of the bounds
    #[arg(long, default_value = "0.15", value_parser = cli::positive)]
    step: f64,
    #[command(flatten)]
    seed: Seed,
    /// Which measurements the search sees
    #[arg(long, value_enum, default_value = "all")]
    measurements: Fit,
    /// The search drops every n-th disc only
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u64).range(1..100))]
    stride: u64,
    /// Release angles per plate and disc during the search
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u64).range(1..=6))]
    releases: u64,
    /// Drops per set of papers during the search
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..1000))]
    drops: u64,
    /// JSON file of the law to begin with; without it the default law
    #[arg(long)]
    from: Option<PathBuf>,
    #[command(flatten)]
    out: Out,
}

/// The search's view of the measurements, and what it has seen of them.
struct Objective {
    fidelity: Fidelity,
    effort: Effort,
    seen: RefCell<Seen>,
}

struct Seen {
    /// Costs that the log knows, by the places as the log writes them: the shortest digits that tell
    /// numbers apart.
    costs: HashMap<String, f64>,
    log: File,
    best: (f64, Vec<f64>),
    progress: ProgressBar,
}

impl Objective {
    fn cost(&self, places: &[f64]) -> f64 {
        let mut seen = self.seen.borrow_mut();
        let key = places
            .iter()
            .map(f64::to_string)
            .collect::<Vec<_>>()
            .join(" ");
        let known = seen.costs.get(&key).copied();
        let cost = known.unwrap_or_else(|| {
            let law = ViscousLaw::Physical(law_at(places));
            let report = self.fidelity.run(&law, &self.effort, Experiment::run);
            let cost = report.map_or(f64::INFINITY, |report| report.cost().total());
            // Beyond the bounds the law is that at the bounds; coming back costs less.
            let beyond = places.iter().map(|x| (x - x.clamp(0.0, 1.0)).powi(2));
            cost + 2.0 * beyond.sum::<f64>()
        });
        if known.is_none() {
            writeln!(seen.log, "{key} cost {cost} ;")
                .unwrap_or_else(|error| cli::cannot_write(Path::new("--out"), error));
        }
        if cost < seen.best.0 {
            seen.best = (cost, places.to_vec());
            let message = format!("best {cost:.4}");
            seen.progress.set_message(message);
        }
        seen.progress.inc(1);
        cost
    }
}

impl CostFunction<f64, NalgebraProvider> for Objective {
    fn evaluate(&self, x: &Vector<f64>, _: &()) -> Result<f64, Infallible> {
        let places: Vec<f64> = (0..x.len()).map(|i| x.get(i)).collect();
        Ok(self.cost(&places))
    }
}

fn main() {
    let arguments: Arguments = cli::parse();
    let all = Fidelity::new().expect("the measurements that ship");
    let start = arguments
        .from
        .as_deref()
        .map_or_else(PhysicalLaw::default, load);
    let law = if arguments.generations == 0 {
        start
    } else {
        search(&arguments, &all, &start)
    };
    let law = ViscousLaw::Physical(law);
    let score = |title: &str, fidelity: &Fidelity, seed: u64| {
        let effort = Effort {
            seed,
            drops: 16,
            ..Effort::default()
        };
        match fidelity.run(&law, &effort, Experiment::run) {
            Ok(report) => print(title, &report),
            Err(error) => cli::bad_value("--from", error),
        }
    };
    if arguments.measurements == Fit::Half {
        score("fitted", &all.clone().part(Part::Fitted), 1);
        score("held out", &all.clone().part(Part::HeldOut), 1);
    }
    for seed in [1, 2, 3, 4] {
        score(&format!("all, seed {seed}"), &all, seed);
    }
}

fn load(path: &Path) -> PhysicalLaw {
    let text = read_to_string(path).unwrap_or_else(|error| cli::bad_value("--from", error));
    let law: PhysicalLaw =
        serde_json::from_str(&text).unwrap_or_else(|error| cli::bad_value("--from", error));
    match law.check() {
        Ok(()) => law,
        Err(error) => cli::bad_value("--from", error),
    }
}

fn search(arguments: &Arguments, all: &Fidelity, start: &PhysicalLaw) -> PhysicalLaw {
    let mut fidelity = all.clone();
    if arguments.measurements == Fit::Half {
        fidelity = fidelity.part(Part::Fitted);
    }
    let fidelity = fidelity.thinned(arguments.stride as usize);
    let evaluations = arguments.generations as u64 * arguments.population + 1;
    let (log, costs) = open_log(&arguments.out.path("evaluations.txt"));
    let objective = Objective {
        fidelity,
        effort: Effort {
            releases: arguments.releases as usize,
            drops: arguments.drops as usize,
            ..Effort::default()
        },
        seen: RefCell::new(Seen {
            costs,
            log,
            best: (f64::INFINITY, Vec::new()),
            progress: cli::progress(evaluations, "laws"),
        }),
    };
    let places = places(start);
    let config = CMAESConfig::default()
        .with_population_size(arguments.population as usize)
        .and_then(|config| config.with_initial_sigma(arguments.step))
        .unwrap_or_else(|error| cli::bad_value("--population, --step", error));
    let result = CMAES::<f64>::new(Some(arguments.seed.value)).process(
        &objective,
        &(),
        Vector::from_vec(places),
        config,
        Callbacks::empty().with_terminator(MaxSteps(arguments.generations)),
    );
    if let Err(error) = result {
        cli::bad_value("--generations", error);
    }
    let seen = objective.seen.into_inner();
    seen.progress.finish();
    let law = law_at(&seen.best.1);
    let json = serde_json::to_string_pretty(&law).expect("a law is finite numbers");
    arguments.out.write("law.json", json);
    println!("cost {:.4}", seen.best.0);
    for (coefficient, _) in searched() {
        println!("{:>22} {:.4}", coefficient.name, coefficient.of(&law));
    }
    law
}

/// The log, to be appended to, and what is in it. Lines that are not whole (the last one, of a search that
/// was killed) are dropped.
fn open_log(path: &Path) -> (File, HashMap<String, f64>) {
    let text = read_to_string(path).unwrap_or_default();
    let entry = |line: &str| {
        let (key, cost) = line.strip_suffix(" ;")?.split_once(" cost ")?;
        Some((key.to_string(), cost.parse().ok()?))
    };
    let (mut whole, mut costs) = (String::new(), HashMap::new());
    for line in text.lines() {
        if let Some((key, cost)) = entry(line) {
            costs.insert(key, cost);
            whole.push_str(line);
            whole.push('\n');
        }
    }
    cli::write(path, whole);
    let log = OpenOptions::new().append(true).open(path);
    (
        log.unwrap_or_else(|error| cli::cannot_write(path, error)),
        costs,
    )
}

fn print(title: &str, report: &Report) {
    let cost = report.cost();
    println!("\n{title}: cost {:.3}: {cost:.3?}", cost.total());
    let percent = |ours: f64, measured: f64| 100.0 * (ours / measured - 1.0);
    for result in &report.plates {
        let plate = &result.plate;
        print!(
            "  plate 1/{:<4.1} {:?}: {:.2} of flips",
            1.0 / plate.beta,
            plate.regime,
            result.mean(|f| f.tumbling)
        );
        let quantities = [
            ("drift", plate.drift, result.mean(|f| f.drift)),
            ("descent", plate.descent, result.mean(|f| f.descent)),
            ("spin", plate.spin, result.mean(|f| f.spin)),
        ];
        for (name, measured, ours) in quantities {
            if let Some(measured) = measured {
                print!(", {name} {:+.1} %", percent(ours, measured));
            }
        }
        println!();
    }
    let map = &report.discs;
    let [steady, periodic, chaotic, tumbling] = map.agreement_by_class().map(|x| 100.0 * x);
    println!(
        "  discs {:.1} % (steady {steady:.0}, periodic {periodic:.0}, chaotic {chaotic:.0}, tumbling {tumbling:.0}), {:.0} % of misses within 20 %",
        100.0 * map.agreement(),
        100.0 * map.near_misses(0.2)
    );
    for result in &report.papers {
        let drop = &result.drop;
        println!(
            "  {:?} {:.1} mm, edge {}: descent {:+.1} %, drift {:+.1} %",
            drop.cut,
            1e3 * drop.radius,
            if drop.edge_down { "down" } else { "level" },
            percent(result.mean(|f| f.descent), drop.descent),
            percent(result.mean(|f| f.drift), drop.drift)
        );
    }
    let shares = report.shares.iter();
    let shares: Vec<String> = shares
        .map(|r| format!("{:.2} ({:.2})", r.share(), r.measured.share))
        .collect();
    println!(
        "  tumbling {}; crossing {:.4}",
        shares.join(", "),
        report.tumbling_crossing().unwrap_or(f64::NAN)
    );
    for result in &report.polars {
        let (plate, polar) = (&result.plate, &result.polar);
        let (angle, lift) = polar.stall();
        let kind = if plate.round { "disc" } else { "rectangle" };
        let along: Vec<String> = [5, 15, 30, 45, 60, 90]
            .iter()
            .map(|degree| (degree, polar.points[*degree]))
            .map(|(degree, at)| {
                format!(
                    "{degree}° {:.2}/{:.2}/{:.2}",
                    at.lift, at.drag, at.pressure_point
                )
            })
            .collect();
        println!(
            "  {kind} AR {:.2}: slope {:+.1} %, greatest lift {lift:.2} ({:.2}) at {angle}°, C_D0 {:.3}, pressure at 5° {:.3} ({:.3}), goes back {}, stalled thrust {:.3}; C_L/C_D/x_p: {}",
            plate.aspect,
            percent(polar.lift_slope(), plate.lift_slope),
            plate.max_lift.unwrap_or(f64::NAN),
            polar.points[0].drag,
            polar.pressure_point(),
            plate.pressure_point.unwrap_or(f64::NAN),
            polar.pressure_goes_back(),
            polar.stalled_thrust(),
            along.join(", ")
        );
    }
    for result in &report.gliders {
        let flights: Vec<String> = result
            .falls
            .iter()
            .map(|fall| format!("{:.1}", fall.glide()))
            .collect();
        println!(
            "  glider, center of mass {:.3} chords ahead: glide ratios {}",
            result.glider.forward,
            flights.join(", ")
        );
    }
}
