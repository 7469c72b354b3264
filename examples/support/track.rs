//! Tracks as tables. Columns are named after what they hold, with the unit after an underscore: `t_s,x_m,y_m,z_m,qx,qy,qz,qw`, the
//! columns and the order of the quaternion (scalar last) of the TUM format of trajectories, whose own files, without names and parted
//! by blanks, are read, too. World axes, y up.

use super::{Quat, Vec3, cli};
use clap::Args;
use rapier3d_immersed::rapier3d::na::Quaternion;
use rapier3d_immersed::training::BodyState;
use std::path::PathBuf;

/// What every row of a track of ours begins with.
pub const COLUMNS: &str =
    "t_s,x_m,y_m,z_m,qx,qy,qz,qw,vx_mps,vy_mps,vz_mps,wx_radps,wy_radps,wz_radps";

/// Columns of a file in the TUM format.
const TUM: [&str; 8] = ["t", "x", "y", "z", "qx", "qy", "qz", "qw"];

/// Units in those that columns are read in: s, m, rad.
const UNITS: [(&str, f64); 7] = [
    ("s", 1.0),
    ("ms", 1e-3),
    ("m", 1.0),
    ("cm", 1e-2),
    ("mm", 1e-3),
    ("rad", 1.0),
    ("deg", std::f64::consts::PI / 180.0),
];

/// States at times (s) as a table, with more columns of these names.
pub fn csv<'a>(
    more: &[String],
    rows: impl Iterator<Item = (f64, &'a BodyState, Vec<String>)>,
) -> String {
    let mut header = vec![COLUMNS.to_owned()];
    header.extend(more.iter().cloned());
    let mut text = header.join(",") + "\n";
    for (time, state, more) in rows {
        let (x, q) = (state.position, state.orientation.coords);
        let (v, w) = (state.velocity, state.spin);
        let own = [
            time, x.x, x.y, x.z, q.x, q.y, q.z, q.w, v.x, v.y, v.z, w.x, w.y, w.z,
        ];
        let mut fields: Vec<String> = own.iter().map(f64::to_string).collect();
        fields.extend(more);
        text.push_str(&fields.join(","));
        text.push('\n');
    }
    text
}

/// A table with named columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Names, and the units in those that columns are read in.
    columns: Vec<(String, f64)>,
    /// Numbers of the lines, and their values.
    rows: Vec<(usize, Vec<String>)>,
}

impl Table {
    /// Reads a table whose values are parted by commas, semicolons, tabs or blanks; what follows a `#` is a comment. The first row
    /// names the columns; without names, eight columns are those of the TUM format.
    ///
    /// # Errors
    /// The row and what is wrong with it.
    pub fn read(text: &str) -> Result<Self, String> {
        let lines = text.lines().enumerate();
        let mut rows = lines
            .map(|(i, line)| (i + 1, line.split('#').next().unwrap_or_default().trim()))
            .filter(|(_, line)| !line.is_empty())
            .map(|(row, line)| (row, fields(line)))
            .peekable();
        let Some((_, first)) = rows.peek() else {
            return Err("there is no row".into());
        };
        let columns: Vec<(String, f64)> = if first[0].parse::<f64>().is_ok() {
            if first.len() != TUM.len() {
                return Err("there is no row that names the columns".into());
            }
            TUM.iter().map(|name| ((*name).to_owned(), 1.0)).collect()
        } else {
            let (_, first) = rows.next().expect("it was peeked at");
            first.iter().map(|name| named(name)).collect()
        };
        let rows = rows.map(|(row, values)| {
            if values.len() != columns.len() {
                let (own, all) = (values.len(), columns.len());
                return Err(format!("row {row} has {own} values for {all} columns"));
            }
            Ok((row, values.into_iter().map(str::to_owned).collect()))
        });
        Ok(Self {
            rows: rows.collect::<Result<_, _>>()?,
            columns,
        })
    }

    /// The columns of these names, in s, m and rad.
    ///
    /// # Errors
    /// The column that is missing, or the row in which it has no finite number.
    pub fn columns<const N: usize>(&self, names: [&str; N]) -> Result<[Vec<f64>; N], String> {
        let mut all = names.map(|_| Vec::new());
        for (name, found) in names.iter().zip(&mut all) {
            let at = self.columns.iter().position(|(own, _)| own == name);
            let at = at.ok_or_else(|| {
                let names: Vec<&str> = self.columns.iter().map(|(name, _)| &name[..]).collect();
                format!("there is no column '{name}', but {}", names.join(", "))
            })?;
            for (row, values) in &self.rows {
                match values[at].parse::<f64>() {
                    Ok(number) if number.is_finite() => found.push(number * self.columns[at].1),
                    _ => {
                        let value = &values[at];
                        return Err(format!("row {row}: {name} is '{value}', no finite number"));
                    }
                }
            }
        }
        Ok(all)
    }
}

/// The values of a row.
fn fields(line: &str) -> Vec<&str> {
    if line.contains([',', ';', '\t']) {
        line.split([',', ';', '\t']).map(str::trim).collect()
    } else {
        line.split_whitespace().collect()
    }
}

/// A column's name without its unit, and the unit.
fn named(name: &str) -> (String, f64) {
    let parts: Vec<&str> = name
        .split(|c: char| !c.is_alphanumeric())
        .filter(|part| !part.is_empty())
        .collect();
    let known = |unit: &&str| UNITS.iter().find(|(symbol, _)| symbol == unit);
    match parts.split_last() {
        Some((unit, rest)) if !rest.is_empty() => match known(unit) {
            Some((_, factor)) => (rest.join("_"), *factor),
            None => (parts.join("_"), 1.0),
        },
        _ => (parts.concat(), 1.0),
    }
}

/// Whether times ascend.
///
/// # Errors
/// Where they do not.
pub fn ascending(times: &[f64]) -> Result<(), String> {
    match times.windows(2).find(|pair| pair[0] >= pair[1]) {
        Some(pair) => Err(format!("the times do not ascend at {} s", pair[1])),
        None => Ok(()),
    }
}

/// A track from a file.
#[derive(Args, Clone, Debug)]
pub struct TrackArgs {
    /// Track to read: a table with columns t_s, x_m, y_m, z_m, qx, qy, qz, qw (y is up), as drop --csv writes it, or a file in
    /// the TUM format
    #[arg(long, value_name = "FILE")]
    pub track: Option<PathBuf>,
}

impl TrackArgs {
    /// The file's text, if one is asked for; the program ends if it cannot be read.
    pub fn text(&self) -> Option<String> {
        let path = self.track.as_deref()?;
        let text = std::fs::read_to_string(path);
        Some(text.unwrap_or_else(|problem| {
            cli::bad_value("--track", format!("{}: {problem}", path.display()))
        }))
    }
}

/// A body's way: its places, m, and attitudes at times, s.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// s, in ascending order.
    pub times: Vec<f64>,
    /// m.
    pub places: Vec<Vec3>,
    /// Attitudes of the body's own axes.
    pub turns: Vec<Quat>,
}

impl Track {
    /// Reads a track: columns t, x, y, z, qx, qy, qz, qw among whatever others.
    ///
    /// # Errors
    /// What is missing or wrong.
    pub fn read(text: &str) -> Result<Self, String> {
        let table = Table::read(text)?;
        let [t, x, y, z, qx, qy, qz, qw] = table.columns(TUM)?;
        ascending(&t)?;
        let turns = (0..t.len()).map(|i| {
            let turn = Quaternion::new(qw[i], qx[i], qy[i], qz[i]);
            let norm = turn.norm();
            (norm > 1e-9)
                .then(|| Quat::new_normalize(turn))
                .ok_or_else(|| format!("the quaternion is zero at {} s", t[i]))
        });
        Ok(Self {
            places: (0..t.len()).map(|i| Vec3::new(x[i], y[i], z[i])).collect(),
            turns: turns.collect::<Result<_, _>>()?,
            times: t,
        })
    }
}
