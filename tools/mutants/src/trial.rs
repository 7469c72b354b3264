//! Runs the tests on the mutants.

use crate::compile::Binary;
use crate::report::Outcome;
use crate::{Options, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

/// A test as it is without mutants.
struct Test {
    name: String,
    /// Index of the program that it is in.
    binary: usize,
    /// How long it takes alone, s.
    seconds: f64,
    reached: BTreeSet<usize>,
}

/// The tests, the quickest first.
pub struct Suite<'a> {
    binaries: &'a [Binary],
    tests: Vec<Test>,
}

/// Seconds of tests that are started together: few at first, because most mutants are noticed at once.
const BATCHES: [f64; 4] = [1.0, 5.0, 20.0, 60.0];

impl<'a> Suite<'a> {
    /// Runs each test alone. Those that fail without a mutant, or take too long, are left out and named.
    pub fn measure(binaries: &'a [Binary], sites: usize, options: &Options) -> Result<Self> {
        let out = options
            .out
            .canonicalize()
            .map_err(|error| error.to_string())?;
        let trace = out.join("reached");
        let mut tests = Vec::new();
        let start = Instant::now();
        for (index, binary) in binaries.iter().enumerate() {
            let listed = binary
                .command()
                .args(["--list", "--format", "terse"])
                .output()
                .map_err(|error| format!("{}: {error}", binary.name))?;
            let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
            for name in listed
                .lines()
                .filter_map(|line| line.strip_suffix(": test"))
            {
                if options.without.iter().any(|start| name.starts_with(start)) {
                    continue;
                }
                let _ = std::fs::remove_file(&trace);
                let from = Instant::now();
                let mut command = binary.command();
                command
                    .args(["--exact", name])
                    .env("MUTANT", "trace")
                    .env("MUTANTS_REACHED", &trace);
                let failure = watch(&mut command, Duration::from_secs_f64(options.longest))?;
                let seconds = from.elapsed().as_secs_f64();
                if let Some(failure) = failure {
                    println!(
                        "left out: {} {name}: {failure} without a mutant",
                        binary.name
                    );
                    continue;
                }
                let reached = std::fs::read_to_string(&trace).unwrap_or_default();
                let reached = reached.lines().filter_map(|line| line.parse().ok());
                let name = name.to_owned();
                tests.push(Test {
                    name,
                    binary: index,
                    seconds,
                    reached: reached.filter(|number| *number < sites).collect(),
                });
            }
        }
        tests.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let whole: f64 = tests.iter().map(|test| test.seconds).sum();
        println!(
            "{} tests, {whole:.0} s one after the other; measured in {:.0} s",
            tests.len(),
            start.elapsed().as_secs_f64()
        );
        Ok(Self { binaries, tests })
    }

    /// Runs the tests that reach a mutant until one fails, and fails again, and does not fail without it.
    pub fn attempt(&self, number: usize) -> Result<Outcome> {
        let mut rest: &[&Test] = &self
            .tests
            .iter()
            .filter(|test| test.reached.contains(&number))
            .collect::<Vec<_>>();
        if rest.is_empty() {
            return Ok(Outcome::Unreached);
        }
        let total = rest.len();
        let mut sizes = BATCHES.into_iter();
        let mut size = BATCHES[0];
        while !rest.is_empty() {
            size = sizes.next().unwrap_or(size);
            let mut seconds = 0.0;
            let count = rest
                .iter()
                .take_while(|test| {
                    seconds += test.seconds;
                    seconds <= size
                })
                .count()
                .max(1);
            let (batch, later) = rest.split_at(count);
            rest = later;
            let mut by_binary: BTreeMap<usize, Vec<&Test>> = BTreeMap::new();
            for test in batch {
                by_binary.entry(test.binary).or_default().push(test);
            }
            for (binary, mut tests) in by_binary {
                while let Some(by) = self.failure(binary, &tests, Some(number))? {
                    let is_it = |test: &&Test| test.name == by;
                    let again: Vec<&Test> = match tests.iter().copied().find(is_it) {
                        Some(test) => vec![test],
                        None => tests.clone(),
                    };
                    let fails = self.failure(binary, &again, Some(number))?.is_some();
                    if fails && self.failure(binary, &again, None)?.is_none() {
                        return Ok(Outcome::Killed { by });
                    }
                    println!("not counted, because it comes and goes: {by}");
                    let named = tests.len();
                    tests.retain(|test| test.name != by);
                    if tests.len() == named || tests.is_empty() {
                        break;
                    }
                }
            }
        }
        Ok(Outcome::Survived { tests: total })
    }

    /// The first failure of tests of one program, with a mutant or without.
    fn failure(
        &self,
        binary: usize,
        tests: &[&Test],
        mutant: Option<usize>,
    ) -> Result<Option<String>> {
        let usual: f64 = tests.iter().map(|test| test.seconds).sum();
        let mut command = self.binaries[binary].command();
        command
            .arg("--exact")
            .args(tests.iter().map(|test| &test.name))
            .args(["--test-threads", "2"]);
        if let Some(number) = mutant {
            command.env("MUTANT", number.to_string());
        }
        watch(&mut command, Duration::from_secs_f64(15.0 + 5.0 * usual))
    }
}

/// Runs a program of tests; the test that fails first, or how else it ended early.
fn watch(command: &mut Command, limit: Duration) -> Result<Option<String>> {
    let mut child = command
        .env("RUST_BACKTRACE", "0")
        // Property tests draw the same cases each time, and remember none.
        .env("PROPTEST_RNG_SEED", "16")
        .env("PROPTEST_DISABLE_FAILURE_PERSISTENCE", "1")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .map_err(|error| error.to_string())?;
    let output = child.stdout.take().ok_or("no output")?;
    let (sender, lines) = mpsc::channel();
    let reader = std::thread::spawn(move || {
        for line in BufReader::new(output)
            .lines()
            .map_while(std::result::Result::ok)
        {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    let end = Instant::now() + limit;
    let found = loop {
        match lines.recv_timeout(end.saturating_duration_since(Instant::now())) {
            Ok(line) => {
                let test = line.strip_prefix("test ");
                if let Some(name) = test.and_then(|line| line.strip_suffix(" ... FAILED")) {
                    break Some(name.to_owned());
                }
            }
            Err(RecvTimeoutError::Timeout) => break Some("time out".to_owned()),
            Err(RecvTimeoutError::Disconnected) => break None,
        }
    };
    drop(lines);
    if found.is_some() {
        let _ = child.kill();
    }
    let status = child.wait().map_err(|error| error.to_string())?;
    let _ = reader.join();
    let aborted = || (!status.success()).then(|| "abort".to_owned());
    Ok(found.or_else(aborted))
}
