//! What the page knows of one figure, table or timing.

/// Paths of items from the crate's root as text. A path that leads nowhere does not compile.
macro_rules! api {
    ($($first:ident $(:: $rest:ident)*),* $(,)?) => {{
        $( #[allow(unused_imports)] use rapier3d_immersed::$first $(:: $rest)* as _; )*
        &[$(concat!(stringify!($first) $(, "::", stringify!($rest))*)),*]
    }};
}
pub(super) use api;

use serde_json::Value;

/// A figure, table or timing of the thesis, and what the crate has of it.
pub struct Entry {
    /// As the thesis numbers it: "Fig. 3.3".
    pub name: &'static str,
    /// What it shows, in a few words.
    pub shows: &'static str,
    /// Items of the crate ([`api!`](super::api)); none for what is not computed.
    pub api: &'static [&'static str],
    /// The example that shows it: one of [`RUNS`](super::contents::RUNS).
    pub example: Option<&'static str>,
    /// Pictures that this example writes.
    pub pictures: &'static [&'static str],
    /// Printed numbers and ours.
    pub numbers: &'static [Number],
    /// Words that the entry's example prints, by two names.
    pub grid: Option<Grid>,
    /// What came out otherwise, or what cannot be had, and why.
    pub remark: &'static str,
}

/// A table of what an example prints: its columns and rows, each with a title and its name in the pointer.
pub struct Grid {
    pub columns: &'static [(&'static str, &'static str)],
    pub rows: &'static [(&'static str, &'static str)],
    /// With COLUMN and ROW in place of the names.
    pub pointer: &'static str,
}

impl Grid {
    /// Keys in the file of measured values and pointers into the example's output, row by row.
    pub fn cells(&self, entry: &Entry) -> Vec<(String, String)> {
        let of = |(row, row_name): &(&str, &str)| -> Vec<(String, String)> {
            let cell = |(column, name): &(&str, &str)| {
                let pointer = self
                    .pointer
                    .replace("COLUMN", name)
                    .replace("ROW", row_name);
                (format!("{}: {column}, {row}", entry.name), pointer)
            };
            self.columns.iter().map(cell).collect()
        };
        self.rows.iter().flat_map(of).collect()
    }
}

/// A chapter of the page.
pub struct Chapter {
    pub title: &'static str,
    pub entries: &'static [Entry],
}

/// A printed number beside ours.
pub struct Number {
    /// What is counted, with its unit.
    pub what: &'static str,
    /// As the thesis prints it; empty where it only shows a picture.
    pub printed: &'static str,
    pub ours: Ours,
}

/// Where our number is from.
#[derive(Clone, Copy)]
pub enum Ours {
    /// Computed in no time: by the page's test, too.
    Quick(fn() -> f64),
    /// A place in what the entry's example prints as JSON.
    Printed(&'static str),
    /// A time that `timings` measures, s.
    Timed(&'static str),
}

/// An example, the features that it needs, and its arguments.
pub struct Run {
    pub example: &'static str,
    pub features: &'static str,
    pub arguments: &'static [&'static str],
}

impl Run {
    pub const fn new(
        example: &'static str,
        features: &'static str,
        arguments: &'static [&'static str],
    ) -> Self {
        Self {
            example,
            features,
            arguments,
        }
    }

    /// The command, as a user types it.
    pub fn command(&self) -> String {
        let features = match self.features {
            "" => String::new(),
            some => format!("--features {some} "),
        };
        let arguments: String = self.arguments.iter().map(|a| format!(" {a}")).collect();
        let dashes = if arguments.is_empty() { "" } else { " --" };
        format!(
            "cargo run --release {features}--example {}{dashes}{arguments}",
            self.example
        )
    }
}

impl Number {
    pub const fn new(what: &'static str, printed: &'static str, ours: Ours) -> Self {
        Self {
            what,
            printed,
            ours,
        }
    }

    /// The key of this number in the file of measured ones.
    pub fn key(&self, entry: &Entry) -> String {
        format!("{}: {}", entry.name, self.what)
    }

    /// Our number, from the measured ones if it takes long.
    pub fn value(&self, entry: &Entry, measured: &Value) -> Result<Value, String> {
        if let Ours::Quick(compute) = self.ours {
            return Ok(compute().into());
        }
        let key = self.key(entry);
        let found = measured.get(&key).cloned();
        found.ok_or_else(|| format!("'{key}' is not measured"))
    }
}

impl Entry {
    /// An entry without API, pictures and numbers, to be filled in.
    pub const fn new(name: &'static str, shows: &'static str) -> Self {
        Self {
            name,
            shows,
            api: &[],
            example: None,
            pictures: &[],
            numbers: &[],
            grid: None,
            remark: "",
        }
    }
}
