//! The page as Markdown.

use super::entry::{Chapter, Entry, Number, Ours, Run};
use serde_json::Value;
use std::fmt::Write;

const HEAD: &str = "# The thesis and this crate

H. Xie, *Immersed Rigid Body Dynamics in Computer Graphics*, JAIST 2015, item by item: what each figure, table and timing shows, where the
crate has it, and the printed number beside ours. The equations follow the thesis with its errata corrected; the documentation of each
module says which. Numbers and pictures are of one run of

```text
COMMAND
```

";

/// The whole page.
pub fn render(
    chapters: &[&Chapter],
    runs: &[Run],
    command: &str,
    measured: &Value,
) -> Result<String, String> {
    let mut page = HEAD.replace("COMMAND", command);
    for chapter in chapters {
        write!(page, "## {}\n\n", chapter.title).expect("a string takes all");
        for entry in chapter.entries {
            section(&mut page, entry, runs, measured)?;
        }
    }
    while page.ends_with("\n\n") {
        page.pop();
    }
    Ok(page)
}

fn section(page: &mut String, entry: &Entry, runs: &[Run], measured: &Value) -> Result<(), String> {
    let mut put = |text: String| page.push_str(&text);
    put(format!("### {}: {}\n\n", entry.name, entry.shows));
    let api: Vec<String> = entry.api.iter().map(|item| format!("`{item}`")).collect();
    let mut facts = Vec::new();
    if !api.is_empty() {
        facts.push(api.join(", "));
    }
    if let Some(example) = entry.example {
        let run = runs.iter().find(|run| run.example == example);
        let run = run.ok_or_else(|| format!("{}: nothing runs '{example}'", entry.name))?;
        facts.push(format!("`{}`", run.command()));
    }
    if !facts.is_empty() {
        put(format!("{}\n\n", facts.join(" · ")));
    }
    if !entry.numbers.is_empty() {
        put("| | thesis | here |\n|---|---|---|\n".into());
        for number in entry.numbers {
            let ours = shown(number, &number.value(entry, measured)?);
            put(format!(
                "| {} | {} | {ours} |\n",
                number.what, number.printed
            ));
        }
        put("\n".into());
    }
    if let Some(grid) = &entry.grid {
        let titles: Vec<&str> = grid.columns.iter().map(|(title, _)| *title).collect();
        put(format!(
            "| | {} |\n|---{}|\n",
            titles.join(" | "),
            "|---".repeat(titles.len())
        ));
        let cells = grid.cells(entry);
        for ((row, _), cells) in grid.rows.iter().zip(cells.chunks(titles.len())) {
            let found = cells
                .iter()
                .map(|(key, _)| measured.get(key).and_then(Value::as_str));
            let found: Option<Vec<&str>> = found.collect();
            let found = found.ok_or_else(|| format!("{}: {row} is not measured", entry.name))?;
            put(format!("| {row} | {} |\n", found.join(" | ")));
        }
        put("\n".into());
    }
    if !entry.remark.is_empty() {
        put(format!("{}\n\n", entry.remark));
    }
    if let Some(example) = entry.example {
        for picture in entry.pictures {
            put(format!(
                "![{}: {}](thesis/{example}/{picture})\n\n",
                entry.name, entry.shows
            ));
        }
    }
    Ok(())
}

/// A number with three digits, as people write it.
fn shown(number: &Number, value: &Value) -> String {
    if value.is_u64() {
        return value.to_string();
    }
    let Some(x) = value.as_f64() else {
        return value
            .as_str()
            .map_or_else(|| value.to_string(), str::to_owned);
    };
    // Clocks do not give three digits twice.
    let digits = if matches!(number.ours, Ours::Timed(_)) {
        2
    } else {
        3
    };
    if x == 0.0 {
        return "0".into();
    }
    let power = x.abs().log10().floor() as i32;
    if (-3..5).contains(&power) {
        let decimals = (digits - 1 - power).max(0) as usize;
        return format!("{x:.decimals$}");
    }
    let raised: String = power
        .to_string()
        .chars()
        .map(|c| {
            "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"
                .chars()
                .nth(c.to_digit(10).map_or(10, |d| d as usize))
                .expect("a digit")
        })
        .collect();
    format!("{:.1} × 10{raised}", x / 10f64.powi(power))
}
