//! What was measured, to read.

use crate::means::Means;
use crate::report::{CRITERIA, Row, bytes};
use std::fmt::Write;

/// Everything of the [`report`](crate::report) in columns by method.
pub fn table(rows: &[Row], measured: &Means) -> String {
    let mut text = String::new();
    let say = |text: &mut String, line: String| {
        writeln!(text, "{}", line.trim_end()).expect("a string takes anything");
    };
    let columns = |first: &str, cells: Vec<String>| {
        let cells: Vec<String> = cells.iter().map(|cell| format!("{cell:>21}")).collect();
        format!("{first:<22}{}", cells.concat())
    };
    let of = |cell: fn(&Row) -> String| rows.iter().map(cell).collect::<Vec<_>>();
    say(&mut text, columns("", of(|r| r.method.name().into())));
    say(
        &mut text,
        columns("step of a body, ns", of(|r| format!("{:.0}", r.cost.step))),
    );
    say(
        &mut text,
        columns("memory of a body", of(|r| bytes(r.cost.bytes))),
    );
    say(
        &mut text,
        columns(
            "made once in, s",
            of(|r| format!("{:.2}", r.making.seconds)),
        ),
    );
    say(
        &mut text,
        columns(
            "paper: descent, m/s",
            of(|r| format!("{:.2}", r.means.descent)),
        ),
    );
    say(
        &mut text,
        columns("       drift, m/s", of(|r| format!("{:.2}", r.means.drift))),
    );
    say(
        &mut text,
        columns("       regimes, %", of(|r| r.means.regimes())),
    );
    say(
        &mut text,
        format!(
            "measured: {:.2} m/s, {:.2} m/s, {} (by eye, {} segments)",
            measured.descent,
            measured.drift,
            measured.regimes(),
            measured.falls,
        ),
    );
    say(&mut text, String::new());
    say(
        &mut text,
        "Thesis Table 7.1: its tick or dash, and what is measured".into(),
    );
    for (i, (name, what)) in CRITERIA.iter().enumerate() {
        let cell = |row: &Row| {
            let tick = row.method.thesis().map_or("", |ticks| ticks[i]);
            format!("{} {}", tick, row.cells()[i])
        };
        say(&mut text, format!("{name}: {what}"));
        say(&mut text, columns("", rows.iter().map(cell).collect()));
    }
    for row in rows {
        for (shape, why) in &row.refused {
            say(
                &mut text,
                format!("{} takes no {shape}: {why}", row.method.name()),
            );
        }
    }
    text
}
