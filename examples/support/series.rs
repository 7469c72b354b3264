//! Numbers row by row, as a table in a file or as JSON: names with their units.

use super::cli;
use super::options::key;
use clap::Args;
use serde_json::{Map, Value, json};
use std::path::PathBuf;

/// A table in a file.
#[derive(Args, Clone, Debug)]
pub struct CsvArgs {
    /// Write the numbers, row by row, as a table: names with units (t_s, x_m, v_mps, …), y up, quaternions as qx, qy, qz, qw
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
}

impl CsvArgs {
    /// Writes the table if it is asked for.
    pub fn write(&self, table: impl FnOnce() -> String) {
        if let Some(path) = &self.csv {
            cli::write(path, table());
        }
    }
}

/// The fewest digits that tell a number from others: of single precision, if that is where it comes from.
fn digits(x: f64) -> String {
    let single = x as f32;
    if f64::from(single) == x {
        return single.to_string();
    }
    x.to_string()
}

/// A whole number as it is, another with four significant digits.
fn short(x: f64) -> String {
    if x == x.round() && x.abs() < 1e9 {
        return format!("{x}");
    }
    let whole = x.abs().log10().floor() as i32 + 1;
    format!("{x:.*}", (4 - whole).clamp(0, 6) as usize)
}

/// Rows of numbers, of a run or another part of an example each.
pub struct Series {
    /// What the rows' parts are called: "run".
    part: &'static str,
    columns: Vec<String>,
    rows: Vec<(String, Vec<f64>)>,
}

impl Series {
    /// Of columns by name and unit.
    pub fn new(part: &'static str, columns: &[(&str, &str)]) -> Self {
        let columns = columns.iter().map(|(name, unit)| key(name, unit));
        Self {
            part,
            columns: columns.collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row of a part.
    ///
    /// # Panics
    /// If it has not as many numbers as there are columns.
    pub fn push(&mut self, part: &str, row: &[f64]) {
        assert_eq!(row.len(), self.columns.len(), "numbers of a row");
        self.rows.push((part.to_owned(), row.to_vec()));
    }

    /// As comma-separated values; the part is the last column, so that the first is the time.
    pub fn csv(&self) -> String {
        let mut text = format!("{},{}\n", self.columns.join(","), self.part);
        for (part, row) in &self.rows {
            let numbers: Vec<String> = row.iter().map(|x| digits(*x)).collect();
            let part = part.replace(',', ";");
            text += &format!("{},{part}\n", numbers.join(","));
        }
        text
    }

    /// Under their names: part by part, or, if each has a row alone, all of them in one table.
    pub fn text(&self) -> String {
        let padded = |fields: Vec<String>| -> String {
            fields.iter().map(|field| format!("{field:>14}")).collect()
        };
        let header = padded(self.columns.clone());
        let alone = self.rows.windows(2).all(|pair| pair[0].0 != pair[1].0);
        let mut text = String::new();
        let mut last = None;
        for (part, row) in &self.rows {
            if last.is_none() && alone {
                text += &format!("{header}  {}\n", self.part);
            } else if last != Some(part) && !alone {
                text += &format!("{part}\n{header}\n");
            }
            last = Some(part);
            let numbers = padded(row.iter().map(|x| short(*x)).collect());
            match alone {
                true => text += &format!("{numbers}  {part}\n"),
                false => text += &format!("{numbers}\n"),
            }
        }
        text
    }

    /// As a list of objects.
    pub fn json(&self) -> Value {
        let rows = self.rows.iter().map(|(part, row)| {
            let numbers = self
                .columns
                .iter()
                .cloned()
                .zip(row.iter().map(|x| json!(x)));
            let mut object: Map<String, Value> = numbers.collect();
            object.insert(self.part.to_owned(), json!(part));
            Value::Object(object)
        });
        Value::Array(rows.collect())
    }
}
