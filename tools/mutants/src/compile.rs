//! Builds the copy, and finds what does not compile.

use crate::schema::{Copy, Place};
use crate::sites::Site;
use crate::{Options, Result};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::process::Command;

/// Most rounds of building and leaving out: the compiler shows some errors only where there are no others.
const ROUNDS: usize = 40;

/// The named sites, which must compile, and the first of the drawn ones that do, in the order of the draw. The
/// copy has just these then.
pub fn viable(
    copy: &Copy,
    named: Vec<Site>,
    drawn: Vec<Site>,
    options: &Options,
) -> Result<Vec<Site>> {
    let first = named.len();
    let mut drawn = [named, drawn].concat();
    for round in 0..ROUNDS {
        let places = copy.mutate(&drawn)?;
        let errors = errors(copy, options)?;
        if errors.is_empty() {
            println!("{} of those drawn compile", drawn.len() - first);
            if drawn.len() - first > options.number {
                drawn.truncate(first + options.number);
                copy.mutate(&drawn)?;
            }
            return Ok(drawn);
        }
        let mut guilty = BTreeSet::new();
        for error in &errors {
            let mut found = blame(error, &places);
            if found.is_empty() {
                let text = error["rendered"].as_str().unwrap_or_default();
                return Err(format!("an error that belongs to no mutant:\n{text}"));
            }
            // Where several are at one place it is not a named one.
            if found.iter().any(|number| *number >= first) {
                found.retain(|number| *number >= first);
            }
            guilty.extend(found);
        }
        println!(
            "round {round}: {} errors, {} left out",
            errors.len(),
            guilty.len()
        );
        let mut number = 0;
        drawn.retain(|_| {
            number += 1;
            !guilty.contains(&(number - 1))
        });
    }
    Err(format!("does not compile after {ROUNDS} rounds"))
}

/// The compiler's errors.
fn errors(copy: &Copy, options: &Options) -> Result<Vec<Value>> {
    let arguments = [
        "check",
        "--lib",
        "--message-format=json",
        "--features",
        &options.features,
    ];
    let messages = cargo(copy, &arguments)?;
    let is_error = |message: &Value| message["level"] == "error" && !spans(message).is_empty();
    Ok(messages
        .into_iter()
        .filter(|message| message["reason"] == "compiler-message")
        .map(|mut message| message["message"].take())
        .filter(is_error)
        .collect())
}

/// Runs cargo on the copy; its messages.
fn cargo(copy: &Copy, arguments: &[&str]) -> Result<Vec<Value>> {
    let output = Command::new("cargo")
        .args(arguments)
        .current_dir(&copy.folder)
        .output()
        .map_err(|error| format!("cargo: {error}"))?;
    let messages: Vec<Value> = String::from_utf8_lossy(&output.stdout)
        .lines()
        .filter_map(|line| serde_json::from_str(line).ok())
        .collect();
    if messages.is_empty() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    Ok(messages)
}

fn spans(message: &Value) -> &[Value] {
    message["spans"].as_array().map_or(&[], Vec::as_slice)
}

/// The sites that an error comes from: those in whose mutant it points, else the innermost ones around it, else
/// those on its lines.
fn blame(error: &Value, places: &BTreeMap<String, Vec<Place>>) -> BTreeSet<usize> {
    let empty = Vec::new();
    let mut around: Option<(usize, BTreeSet<usize>)> = None;
    let mut inside = BTreeSet::new();
    for primary in [true, false] {
        for span in spans(error)
            .iter()
            .filter(|span| span["is_primary"] == primary)
        {
            let places = span["file_name"]
                .as_str()
                .and_then(|name| places.get(name))
                .unwrap_or(&empty);
            let number = |name: &str| span[name].as_u64().unwrap_or(0) as usize;
            let (start, end) = (number("byte_start"), number("byte_end"));
            for place in places {
                if place.mutant.start <= start && end <= place.mutant.end && start < end {
                    inside.insert(place.site);
                }
                if place.whole.start <= start && end <= place.whole.end {
                    let size = place.whole.len();
                    match &mut around {
                        Some((smallest, sites)) if *smallest == size => {
                            sites.insert(place.site);
                        }
                        Some((smallest, _)) if *smallest < size => {}
                        _ => around = Some((size, [place.site].into())),
                    }
                }
            }
        }
        if !inside.is_empty() {
            return inside;
        }
        if let Some((_, sites)) = around.take() {
            return sites;
        }
    }
    // The error may point at a whole function's body or at a use of what a mutant has made.
    let mut near = BTreeSet::new();
    for span in spans(error) {
        let places = span["file_name"]
            .as_str()
            .and_then(|name| places.get(name))
            .unwrap_or(&empty);
        let at = span["byte_start"].as_u64().unwrap_or(0) as usize;
        let before = places.iter().filter(|place| place.whole.start < at);
        let nearest = before.max_by_key(|place| place.whole.start);
        near.extend(nearest.map(|place| place.site));
    }
    near
}

/// One program of tests.
pub struct Binary {
    pub name: String,
    path: PathBuf,
    folder: PathBuf,
}

impl Binary {
    /// Runs it where cargo would.
    pub fn command(&self) -> Command {
        let mut command = Command::new(&self.path);
        command.current_dir(&self.folder);
        command
    }
}

/// Builds the tests.
pub fn binaries(copy: &Copy, options: &Options) -> Result<Vec<Binary>> {
    let mut arguments = vec![
        "test",
        "--no-run",
        "--message-format=json",
        "--features",
        &options.features,
        "--lib",
    ];
    for test in &options.tests {
        arguments.extend(["--test", test]);
    }
    let messages = cargo(copy, &arguments)?;
    if let Some(error) = messages
        .iter()
        .find(|message| message["message"]["level"] == "error")
    {
        return Err(error["message"]["rendered"]
            .as_str()
            .unwrap_or_default()
            .to_owned());
    }
    let built = messages
        .iter()
        .filter(|message| message["profile"]["test"] == true);
    built
        .filter_map(|message| {
            let name = message["target"]["name"].as_str()?;
            Some((name, message["executable"].as_str()?))
        })
        .map(|(name, built)| {
            // Another build in the same target folder would replace it.
            let path = copy.folder.with_file_name(format!("tests-{name}"));
            std::fs::copy(built, &path).map_err(|error| format!("{built}: {error}"))?;
            Ok(Binary {
                name: name.to_owned(),
                path,
                folder: copy.folder.clone(),
            })
        })
        .collect()
}
