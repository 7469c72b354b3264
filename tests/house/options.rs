//! The command lines of the examples: an option that several have is declared once, so that its name, unit and meaning are the same
//! everywhere.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// An option as a field declares it: its long name, and the file.
fn declared(path: &Path, found: &mut BTreeMap<String, Vec<String>>) {
    for entry in fs::read_dir(path).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            declared(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).unwrap();
            for name in long_names(&text) {
                let file = path.display().to_string();
                found.entry(name).or_default().push(file);
            }
        }
    }
}

/// Names of the options that a file declares: that of `long = "…"`, or of the field.
fn long_names(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    for (at, _) in text.match_indices("#[arg(") {
        let rest = &text[at + "#[arg(".len()..];
        // Value parsers have brackets, too; the attribute ends its line.
        let Some((inside, after)) = rest.split_once(")]\n") else {
            continue;
        };
        let mut words = inside.split([',', '\n']).map(str::trim);
        let Some(long) = words.find(|word| *word == "long" || word.starts_with("long =")) else {
            continue;
        };
        let field = || after.split_once(':').map(|(before, _)| before.trim());
        let name = match long.split_once('"') {
            Some((_, name)) => name.trim_end_matches('"').to_owned(),
            None => {
                let field = field().unwrap_or_default();
                field.trim_start_matches("pub ").replace('_', "-")
            }
        };
        names.push(name);
    }
    names
}

#[test]
fn an_option_is_declared_once() {
    let mut found = BTreeMap::new();
    declared(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("examples"),
        &mut found,
    );
    for name in [
        "shape",
        "size",
        "seed",
        "out",
        "json",
        "release-angle",
        "box",
    ] {
        assert!(found.contains_key(name), "--{name} was not read: {found:?}");
    }
    found.retain(|_, files| files.len() > 1);
    assert!(found.is_empty(), "declared more than once: {found:#?}");
}

/// Nothing but clap reads a command line: what has no options has no `args`.
#[test]
fn command_lines_are_declared() {
    fn look(path: &Path, found: &mut Vec<String>) {
        for entry in fs::read_dir(path).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                look(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "rs")
                && fs::read_to_string(&path).unwrap().contains("env::args")
            {
                found.push(path.display().to_string());
            }
        }
    }
    let mut found = Vec::new();
    look(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("examples"),
        &mut found,
    );
    assert!(found.is_empty(), "{found:?}");
}
