//! Changes that are given one by one.

use crate::Result;
use crate::sites::Site;
use std::path::Path;

/// The changes of a list: lines `file | original | mutant`, with the text before the original where that is not
/// unique.
pub fn read(root: &Path, list: &str) -> Result<Vec<Site>> {
    let lines = list
        .lines()
        .filter(|line| !line.starts_with('#') && !line.is_empty());
    lines.map(|line| site(root, line)).collect()
}

fn site(root: &Path, line: &str) -> Result<Site> {
    let parts: Vec<&str> = line.split('|').map(str::trim).collect();
    let (file, original, mutant, before) = match parts[..] {
        [file, original, mutant] => (file, original, mutant, ""),
        [file, original, mutant, before] => (file, original, mutant, before),
        _ => return Err(format!("not `file | original | mutant`: {line}")),
    };
    let text =
        std::fs::read_to_string(root.join(file)).map_err(|error| format!("{file}: {error}"))?;
    let is_it = |at: &usize| text[..*at].trim_end().ends_with(before);
    let found: Vec<usize> = text
        .match_indices(original)
        .map(|(at, _)| at)
        .filter(is_it)
        .collect();
    let [start] = found[..] else {
        return Err(format!(
            "{} times in {file}: {before} {original}",
            found.len()
        ));
    };
    Ok(Site {
        file: file.to_owned(),
        line: text[..start].lines().count().max(1),
        range: start..start + original.len(),
        operator: "named".to_owned(),
        original: original.to_owned(),
        mutant: (!mutant.is_empty()).then(|| mutant.to_owned()),
    })
}
