//! A copy of the crate in which every drawn place asks whether its mutant is active.

use crate::Result;
use crate::sites::Site;
use rand::RngExt;
use rand::SeedableRng;
use rand_pcg::Pcg64;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The first `number` of the candidates in an order that the seed alone decides.
pub fn draw(candidates: &[Site], seed: u64, number: usize) -> Vec<Site> {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut drawn = candidates.to_vec();
    for i in 0..drawn.len() {
        let j = random.random_range(i..drawn.len());
        drawn.swap(i, j);
    }
    drawn.truncate(number);
    drawn
}

/// A changed copy of the crate.
pub struct Copy {
    root: PathBuf,
    pub folder: PathBuf,
    /// The files of the crate.
    names: Vec<String>,
}

/// Where a site's texts ended up in the copy of its file: bytes.
#[derive(Clone, Debug)]
pub struct Place {
    /// Index of the site.
    pub site: usize,
    /// The mutant alone, and the whole with its condition and the original.
    pub mutant: Range<usize>,
    pub whole: Range<usize>,
}

/// The module that the copy gets. `NUMBER` is replaced.
const MODULE: &str = r#"//! Which mutant is active.
#![allow(missing_docs)]

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

const UNREAD: u32 = u32::MAX;
const TRACED: u32 = u32::MAX - 1;
const NONE: u32 = u32::MAX - 2;

static ACTIVE: AtomicU32 = AtomicU32::new(UNREAD);
static REACHED: [AtomicBool; NUMBER] = [const { AtomicBool::new(false) }; NUMBER];

#[inline(always)]
pub(crate) fn active(number: u32) -> bool {
    let active = ACTIVE.load(Relaxed);
    active == number || (active >= TRACED && asked(number))
}

/// Reads the variable, and in a run that is traced notes the number.
#[cold]
#[inline(never)]
fn asked(number: u32) -> bool {
    if ACTIVE.load(Relaxed) == UNREAD {
        let active = match std::env::var("MUTANT").as_deref() {
            Ok("trace") => TRACED,
            Ok(number) => number.parse().unwrap_or(NONE),
            Err(_) => NONE,
        };
        ACTIVE.store(active, Relaxed);
        if active == number {
            return true;
        }
    }
    if ACTIVE.load(Relaxed) == TRACED && !REACHED[number as usize].swap(true, Relaxed) {
        use std::io::Write;
        let path = std::env::var("MUTANTS_REACHED").unwrap_or_default();
        let file = std::fs::OpenOptions::new().create(true).append(true).open(path);
        if let Ok(mut file) = file {
            let _ = file.write_all(format!("{number}\n").as_bytes());
        }
    }
    false
}
"#;

impl Copy {
    /// A copy of what git tracks of the crate, as it is in the working tree, in a folder of `out`.
    pub fn new(root: &Path, out: &Path) -> Result<Self> {
        let root = root
            .canonicalize()
            .map_err(|error| format!("{}: {error}", root.display()))?;
        std::fs::create_dir_all(out).map_err(|error| format!("{}: {error}", out.display()))?;
        let folder = out
            .canonicalize()
            .map_err(|error| error.to_string())?
            .join("crate");
        let listed = Command::new("git")
            .args(["ls-files", "--cached", "--others", "--exclude-standard"])
            .current_dir(&root)
            .output()
            .map_err(|error| format!("git: {error}"))?;
        let names = String::from_utf8_lossy(&listed.stdout);
        let copy = Self {
            root,
            folder,
            names: names.lines().map(str::to_owned).collect(),
        };
        // Those of `src` are written with their mutants.
        for name in copy.names.iter().filter(|name| !name.starts_with("src/")) {
            copy.restore(name)?;
        }
        Ok(copy)
    }

    /// Gives the copy a file as it is in the crate. One that was deleted is still listed.
    fn restore(&self, name: &str) -> Result<()> {
        std::fs::read(self.root.join(name)).map_or(Ok(()), |text| self.write(name, &text))
    }

    /// Writes a file of the copy if it is another one: cargo looks at the time of its last change.
    fn write(&self, name: &str, text: &[u8]) -> Result<()> {
        let to = self.folder.join(name);
        if std::fs::read(&to).is_ok_and(|old| old == text) {
            return Ok(());
        }
        if let Some(parent) = to.parent() {
            std::fs::create_dir_all(parent).map_err(|error| error.to_string())?;
        }
        std::fs::write(&to, text).map_err(|error| format!("{}: {error}", to.display()))
    }

    /// Puts these mutants into the copy, and no others; where they are, by file.
    pub fn mutate(&self, sites: &[Site]) -> Result<BTreeMap<String, Vec<Place>>> {
        let mut by_file: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (number, site) in sites.iter().enumerate() {
            by_file.entry(&site.file).or_default().push(number);
        }
        for name in self.names.iter().filter(|name| name.starts_with("src/")) {
            if !by_file.contains_key(name.as_str()) && name != "src/lib.rs" {
                self.restore(name)?;
            }
        }
        let mut places = BTreeMap::new();
        for (name, mut numbers) in by_file {
            let text = std::fs::read_to_string(self.root.join(name))
                .map_err(|error| format!("{name}: {error}"))?;
            // Outer ones first.
            numbers.sort_by_key(|number| {
                let range = &sites[*number].range;
                (range.start, std::cmp::Reverse(range.end), *number)
            });
            let mut writer = Writer {
                text: &text,
                sites,
                output: String::new(),
                places: Vec::new(),
            };
            writer.write(0..text.len(), &numbers);
            self.write(name, writer.output.as_bytes())?;
            places.insert(name.to_owned(), writer.places);
        }
        let module = MODULE.replace("NUMBER", &sites.len().max(1).to_string());
        self.write("src/mutants.rs", module.as_bytes())?;
        let lib = std::fs::read_to_string(self.root.join("src/lib.rs"))
            .map_err(|error| error.to_string())?;
        let at = lib
            .find("\nmod ")
            .or(lib.find("\npub mod "))
            .ok_or("src/lib.rs has no module")?;
        let lib = format!("{}\nmod mutants;{}", &lib[..at], &lib[at..]);
        self.write("src/lib.rs", lib.as_bytes())?;
        Ok(places)
    }
}

/// Writes one file with its mutants.
struct Writer<'a> {
    text: &'a str,
    sites: &'a [Site],
    output: String,
    places: Vec<Place>,
}

impl Writer<'_> {
    /// Writes a part of the original, with the sites in it, outer ones first.
    fn write(&mut self, part: Range<usize>, numbers: &[usize]) {
        let mut at = part.start;
        let mut rest = numbers;
        while let Some(first) = rest.first() {
            let range = self.sites[*first].range.clone();
            self.output.push_str(&self.text[at..range.start]);
            let same = rest
                .iter()
                .take_while(|number| self.sites[**number].range == range)
                .count();
            let inside = rest
                .iter()
                .take_while(|number| self.sites[**number].range.start < range.end)
                .count();
            self.site(range.clone(), &rest[..same], &rest[same..inside]);
            rest = &rest[inside..];
            at = range.end;
        }
        self.output.push_str(&self.text[at..part.end]);
    }

    /// Writes one place with the mutants of all of it, and those inside its original.
    fn site(&mut self, range: Range<usize>, same: &[usize], inside: &[usize]) {
        let from = self.output.len();
        let is_statement = same
            .iter()
            .all(|number| self.sites[*number].mutant.is_none());
        let mut mutants = Vec::new();
        if !is_statement {
            self.output.push('(');
        }
        for number in same {
            self.output
                .push_str(&format!("if crate::mutants::active({number}) {{ "));
            let start = self.output.len();
            self.output
                .push_str(self.sites[*number].mutant.as_deref().unwrap_or_default());
            mutants.push((*number, start..self.output.len()));
            self.output.push_str(" } else ");
        }
        self.output.push_str("{ ");
        self.write(range, inside);
        self.output
            .push_str(if is_statement { " }" } else { " })" });
        for (site, mutant) in mutants {
            let whole = from..self.output.len();
            self.places.push(Place {
                site,
                mutant,
                whole,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn site(range: Range<usize>, mutant: Option<&str>) -> Site {
        Site {
            file: String::new(),
            line: 1,
            range,
            operator: String::new(),
            original: String::new(),
            mutant: mutant.map(str::to_owned),
        }
    }

    /// Sites inside of others, two at one place, and a statement.
    #[test]
    fn sites_nest() {
        let text = "x = a + b * 2;";
        let sites = [
            site(4..13, Some("a - b * 2")),
            site(12..13, Some("3")),
            site(0..14, None),
            site(4..13, Some("-(a + b * 2)")),
        ];
        let mut writer = Writer {
            text,
            sites: &sites,
            output: String::new(),
            places: Vec::new(),
        };
        writer.write(0..text.len(), &[2, 0, 3, 1]);
        assert_eq!(
            writer.output,
            "if crate::mutants::active(2) {  } else { x = (if crate::mutants::active(0) { a - b * 2 } \
             else if crate::mutants::active(3) { -(a + b * 2) } else { a + b * \
             (if crate::mutants::active(1) { 3 } else { 2 }) }); }"
        );
        for place in &writer.places {
            let mutant = &writer.output[place.mutant.clone()];
            assert_eq!(
                mutant,
                sites[place.site].mutant.as_deref().unwrap_or_default()
            );
        }
    }
}
