//! What a case was measured to be, what it is here, and whether that is good enough.

use serde_json::{Value, json};

/// A quantity with its unit, or a word.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// A number in a unit (empty: dimensionless).
    Number(f64, &'static str),
    /// A regime or another word.
    Word(String),
    /// There is nothing to compare with.
    Absent,
}

/// Whether a bar is met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Within the bar.
    Met,
    /// Outside the bar: shown, not hidden.
    NotMet,
    /// A number without a bar.
    Shown,
}

/// One comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What is compared.
    pub case: String,
    /// By others: measured, or exact.
    pub measured: Quantity,
    /// By this crate.
    pub ours: Quantity,
    /// Relative (a share of the measured value) or, where that is zero or absent, the value itself.
    pub error: Option<f64>,
    /// Largest error that is good enough, if there is a bar.
    pub bar: Option<f64>,
    /// Whether it is met.
    pub verdict: Verdict,
    /// Where the measured value is from, and what is peculiar.
    pub source: String,
}

impl Row {
    /// A number against a measured one (not zero), with a bar on the relative error.
    pub fn number(
        case: impl Into<String>,
        [measured, ours]: [f64; 2],
        unit: &'static str,
        bar: Option<f64>,
        source: impl Into<String>,
    ) -> Self {
        let error = ours / measured - 1.0;
        Self {
            case: case.into(),
            measured: Quantity::Number(measured, unit),
            ours: Quantity::Number(ours, unit),
            error: Some(error),
            bar,
            verdict: judge(error.abs(), bar),
            source: source.into(),
        }
    }

    /// An error, or another quantity that must not exceed `bar`.
    pub fn at_most(
        case: impl Into<String>,
        ours: f64,
        bar: Option<f64>,
        source: impl Into<String>,
    ) -> Self {
        Self {
            case: case.into(),
            measured: Quantity::Absent,
            ours: Quantity::Absent,
            error: Some(ours),
            bar,
            verdict: judge(ours, bar),
            source: source.into(),
        }
    }

    /// A share that must be at least `bar`.
    pub fn share(case: impl Into<String>, ours: f64, bar: f64, source: impl Into<String>) -> Self {
        Self {
            case: case.into(),
            measured: Quantity::Word(format!("at least {:.0} %", 100.0 * bar)),
            ours: Quantity::Number(100.0 * ours, "%"),
            error: None,
            bar: None,
            verdict: if ours >= bar {
                Verdict::Met
            } else {
                Verdict::NotMet
            },
            source: source.into(),
        }
    }

    /// A number that must be in a range; `None` if there is none.
    pub fn within(
        case: impl Into<String>,
        [low, high]: [f64; 2],
        ours: Option<f64>,
        source: impl Into<String>,
    ) -> Self {
        let met = ours.is_some_and(|x| low <= x && x <= high);
        Self {
            case: case.into(),
            measured: Quantity::Word(format!("{} to {}", digits(low), digits(high))),
            ours: ours.map_or(Quantity::Word("none".into()), |x| Quantity::Number(x, "")),
            error: None,
            bar: None,
            verdict: if met { Verdict::Met } else { Verdict::NotMet },
            source: source.into(),
        }
    }

    /// A regime: met if it is the measured one.
    pub fn word(
        case: impl Into<String>,
        [measured, ours]: [&str; 2],
        source: impl Into<String>,
    ) -> Self {
        Self {
            case: case.into(),
            measured: Quantity::Word(measured.into()),
            ours: Quantity::Word(ours.into()),
            error: None,
            bar: None,
            verdict: if measured == ours {
                Verdict::Met
            } else {
                Verdict::NotMet
            },
            source: source.into(),
        }
    }

    /// Something that only has to be true, in words.
    pub fn fact(
        case: impl Into<String>,
        ours: impl Into<String>,
        met: bool,
        source: impl Into<String>,
    ) -> Self {
        Self {
            case: case.into(),
            measured: Quantity::Absent,
            ours: Quantity::Word(ours.into()),
            error: None,
            bar: None,
            verdict: if met { Verdict::Met } else { Verdict::NotMet },
            source: source.into(),
        }
    }

    /// The same without a verdict: for context.
    pub fn shown(self) -> Self {
        Self {
            verdict: Verdict::Shown,
            bar: None,
            ..self
        }
    }
}

/// A number that is not finite meets nothing.
fn judge(error: f64, bar: Option<f64>) -> Verdict {
    match bar {
        None => Verdict::Shown,
        Some(bar) if error <= bar => Verdict::Met,
        Some(_) => Verdict::NotMet,
    }
}

/// The rows of one section and its pictures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// As on the command line.
    pub name: &'static str,
    /// What it is about.
    pub title: &'static str,
    /// Its comparisons.
    pub rows: Vec<Row>,
    /// Pictures: file name without folder, and SVG.
    pub pictures: Vec<(String, String)>,
}

impl Section {
    /// Number of rows with this verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.rows.iter().filter(|r| r.verdict == verdict).count()
    }
}

impl Quantity {
    fn text(&self) -> String {
        match self {
            Self::Number(value, unit) => format!("{} {unit}", digits(*value)).trim_end().into(),
            Self::Word(word) => word.clone(),
            Self::Absent => "–".into(),
        }
    }

    fn json(&self) -> Value {
        match self {
            Self::Number(value, unit) => json!({"value": value, "unit": unit}),
            Self::Word(word) => json!(word),
            Self::Absent => Value::Null,
        }
    }
}

/// Four digits; powers of ten where there would be many zeros.
pub fn digits(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".into()
    } else if !(1e-3..1e5).contains(&size) {
        format!("{value:.2e}")
    } else {
        let decimals = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{value:.decimals$}")
    }
}

/// An error as a percentage, signed if it may have either sign.
fn percent(error: f64) -> String {
    let value = 100.0 * error;
    if value != 0.0 && value.abs() < 0.01 {
        format!("{value:.1e} %")
    } else if value.abs() < 10.0 {
        format!("{value:.2} %")
    } else {
        format!("{value:.0} %")
    }
}

impl Row {
    fn cells(&self) -> [String; 6] {
        let verdict = match self.verdict {
            Verdict::Met => "met",
            Verdict::NotMet => "NOT MET",
            Verdict::Shown => "",
        };
        let error = match (self.error, self.bar) {
            (Some(error), Some(bar)) => format!("{} (bar {})", percent(error), percent(bar)),
            (Some(error), None) => percent(error),
            (None, _) => "–".into(),
        };
        [
            self.case.clone(),
            self.measured.text(),
            self.ours.text(),
            error,
            verdict.into(),
            self.source.clone(),
        ]
    }
}

const HEADS: [&str; 6] = ["case", "measured", "ours", "error", "verdict", "source"];

/// All sections as one Markdown table each, aligned for reading in a terminal.
pub fn table(sections: &[Section]) -> String {
    let mut text = String::new();
    for section in sections {
        let rows: Vec<[String; 6]> = section.rows.iter().map(Row::cells).collect();
        let width = |i: usize| {
            let longest = rows.iter().map(|row| row[i].chars().count()).max();
            longest.unwrap_or(0).max(HEADS[i].len())
        };
        let widths: [usize; 6] = std::array::from_fn(width);
        let line = |cells: [&str; 6]| {
            let padded: Vec<String> = cells
                .iter()
                .zip(widths)
                .map(|(cell, width)| format!("{cell}{}", " ".repeat(width - cell.chars().count())))
                .collect();
            format!("| {} |\n", padded.join(" | "))
        };
        text += &format!("\n{}: {}\n\n", section.name, section.title);
        text += &line(HEADS);
        text += &format!("|{}|\n", widths.map(|w| "-".repeat(w + 2)).join("|"));
        for row in &rows {
            text += &line(row.each_ref().map(String::as_str));
        }
    }
    text
}

/// One line: how many bars are met.
pub fn summary(sections: &[Section]) -> String {
    let total = |verdict| sections.iter().map(|s| s.count(verdict)).sum::<usize>();
    let (met, missed) = (total(Verdict::Met), total(Verdict::NotMet));
    format!(
        "{met} of {} bars are met, {} numbers have none.",
        met + missed,
        total(Verdict::Shown)
    )
}

/// The same for machines.
pub fn json(sections: &[Section]) -> Value {
    let row = |row: &Row| {
        json!({
            "case": row.case,
            "measured": row.measured.json(),
            "ours": row.ours.json(),
            "error": row.error,
            "bar": row.bar,
            "verdict": match row.verdict {
                Verdict::Met => "met",
                Verdict::NotMet => "not met",
                Verdict::Shown => "shown",
            },
            "source": row.source,
        })
    };
    let sections: Vec<Value> = sections
        .iter()
        .map(|s| {
            json!({
                "name": s.name,
                "title": s.title,
                "rows": s.rows.iter().map(row).collect::<Vec<_>>(),
                "pictures": s.pictures.iter().map(|(name, _)| name).collect::<Vec<_>>(),
            })
        })
        .collect();
    json!({ "sections": sections })
}
