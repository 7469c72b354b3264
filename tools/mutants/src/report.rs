//! What became of the mutants.

use crate::Result;
use crate::sites::Site;
use std::collections::BTreeMap;
use std::fmt;
use std::io::Write;
use std::path::{Path, PathBuf};

/// What became of one mutant.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// A test failed, or a program of tests hung or was aborted.
    Killed { by: String },
    /// So many tests that reach it passed.
    Survived { tests: usize },
    /// No test reaches it.
    Unreached,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Killed { by } => write!(f, "killed by {by}"),
            Self::Survived { tests } => write!(f, "survived {tests} tests"),
            Self::Unreached => write!(f, "unreached"),
        }
    }
}

impl Outcome {
    fn parse(text: &str) -> Option<Self> {
        if let Some(by) = text.strip_prefix("killed by ") {
            return Some(Self::Killed { by: by.to_owned() });
        }
        if text == "unreached" {
            return Some(Self::Unreached);
        }
        let tests = text.strip_prefix("survived ")?.strip_suffix(" tests")?;
        let tests = tests.parse().ok()?;
        Some(Self::Survived { tests })
    }
}

/// The outcomes so far, in a file of lines `key<tab>outcome`, of which the last counts.
pub struct Results {
    path: PathBuf,
    outcomes: BTreeMap<String, Outcome>,
}

impl Results {
    pub fn load(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).unwrap_or_default();
        let outcomes = text
            .lines()
            .filter_map(|line| {
                let (key, outcome) = line.rsplit_once('\t')?;
                Some((key.to_owned(), Outcome::parse(outcome)?))
            })
            .collect();
        Ok(Self {
            path: path.to_path_buf(),
            outcomes,
        })
    }

    /// Whether a site has to be tried.
    pub fn wants(&self, site: &Site, retry: bool) -> bool {
        match self.outcomes.get(&site.key()) {
            None => true,
            Some(Outcome::Killed { .. }) => false,
            Some(_) => retry,
        }
    }

    pub fn add(&mut self, site: &Site, outcome: Outcome) -> Result<()> {
        let mut file = std::fs::OpenOptions::new()
            .create(true)
            .append(true)
            .open(&self.path)
            .map_err(|error| error.to_string())?;
        writeln!(file, "{}\t{outcome}", site.key()).map_err(|error| error.to_string())?;
        self.outcomes.insert(site.key(), outcome);
        Ok(())
    }
}

/// Share killed, and the 95 % interval after Wilson (1927).
fn wilson(killed: usize, tried: usize) -> [f64; 3] {
    let (n, z) = (tried.max(1) as f64, 1.96);
    let p = killed as f64 / n;
    let middle = p + z * z / (2.0 * n);
    let half = z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    let whole = 1.0 + z * z / n;
    [p, (middle - half) / whole, (middle + half) / whole]
}

/// Prints how many were killed, and which were not.
pub fn summary(sites: &[Site], results: &Results) {
    let mut by_operator: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
    let mut left = Vec::new();
    for site in sites {
        let Some(outcome) = results.outcomes.get(&site.key()) else {
            continue;
        };
        let [killed, tried] = by_operator.entry(&site.operator).or_default();
        *tried += 1;
        if let Outcome::Killed { .. } = outcome {
            *killed += 1;
        } else {
            left.push((site, outcome));
        }
    }
    println!();
    let mut all = [0, 0];
    for (operator, [killed, tried]) in &by_operator {
        println!("{operator:18} {killed:4} of {tried}");
        if *operator == "named" {
            continue;
        }
        all = [all[0] + killed, all[1] + tried];
    }
    let [share, low, high] = wilson(all[0], all[1]).map(|share| 100.0 * share);
    println!(
        "{:18} {:4} of {}: {share:.1} % (95 %: {low:.1} to {high:.1} %)\n",
        "all drawn", all[0], all[1]
    );
    left.sort_by_key(|(site, _)| (&site.file, site.range.start));
    for (site, outcome) in left {
        println!("{site}: {outcome}");
    }
}

/// Prints how many changes there are to draw from.
pub fn candidates(sites: &[Site]) {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for site in sites {
        *counts.entry(&site.operator).or_default() += 1;
    }
    for (operator, count) in counts {
        println!("{operator:18} {count:5}");
    }
    println!("{:18} {:5}", "all", sites.len());
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wilson's interval of 85 of 100, from tables: 76.7 % to 90.7 %.
    #[test]
    fn interval() {
        let [share, low, high] = wilson(85, 100);
        assert!((share - 0.85).abs() < 1e-12);
        assert!((low - 0.767).abs() < 5e-4 && (high - 0.907).abs() < 5e-4);
    }

    #[test]
    fn outcomes_are_read_as_written() {
        for outcome in [
            Outcome::Killed { by: "a::b".into() },
            Outcome::Survived { tests: 7 },
            Outcome::Unreached,
        ] {
            assert_eq!(Outcome::parse(&outcome.to_string()), Some(outcome));
        }
    }
}
