//! Sketches from tables in text.

use super::sketch::Sketch;
use crate::error::Error;
use rapier3d::na::Vector3;

/// Lengths in m and times in s by their symbols.
const UNITS: [(&str, f64); 5] = [
    ("m", 1.0),
    ("cm", 1e-2),
    ("mm", 1e-3),
    ("s", 1.0),
    ("ms", 1e-3),
];

/// What a column holds (0 the time, 1 to 3 the place) and its unit; none of what is not read.
type Column = Option<(usize, f64)>;

impl Sketch {
    /// Reads a sketch from a table: time and place of one point per row, in s and m, world axes, y up.
    ///
    /// A first row may name the columns (t or time, x, y, z, in any order, z may be missing) with units, in brackets of any
    /// kind or after an underscore: s, ms, m, cm, mm. Columns of other names (an attitude, velocities) are not read. Values are parted
    /// by commas, semicolons or tabs; what follows a `#` is a comment.
    ///
    /// ```
    /// use rapier3d_immersed::motion::Sketch;
    ///
    /// let sketch = Sketch::from_csv("t (ms), x (cm), y (cm)\n0, 0, 200\n500, 15, 160\n1000, 0, 120")?;
    /// assert_eq!(sketch.duration(), 1.0);
    /// assert!((sketch.points()[1].1.y - 1.6).abs() < 1e-12);
    ///
    /// let error = Sketch::from_csv("0, 0, 2, 0\n0.5, 0.l5, 1.6, 0").unwrap_err();
    /// assert_eq!(error.to_string(), r#"row 2 of the table cannot be read: "0.l5""#);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::UnreadableRow`] has the value that is none, or the row that has too few or too many; those of [`Sketch::new`].
    pub fn from_csv(text: &str) -> Result<Self, Error> {
        let rows = text
            .lines()
            .map(|line| line.split('#').next().unwrap_or_default().trim())
            .filter(|line| !line.is_empty())
            .zip(1..);
        let mut columns: Vec<Column> = (0..4).map(|index| Some((index, 1.0))).collect();
        let mut points = Vec::new();
        for (line, row) in rows {
            let values: Vec<&str> = line.split([',', ';', '\t']).map(str::trim).collect();
            let unreadable = |text: &str| Error::UnreadableRow {
                row,
                text: text.to_owned(),
            };
            let first = values[0];
            if row == 1 && first.starts_with(char::is_alphabetic) && first.parse::<f64>().is_err() {
                columns = header(&values).map_err(unreadable)?;
                continue;
            }
            if values.len() != columns.len() {
                return Err(unreadable(line));
            }
            let mut point = [0.0; 4];
            for (value, column) in values.iter().zip(&columns) {
                let Some((place, unit)) = column else {
                    continue;
                };
                let number: f64 = value.parse().map_err(|_| unreadable(value))?;
                point[*place] = number * unit;
            }
            let [time, x, y, z] = point;
            points.push((time, Vector3::new(x, y, z)));
        }
        Self::new(points)
    }
}

/// What the columns of a header hold; what is wrong in it otherwise.
fn header<'a>(names: &[&'a str]) -> Result<Vec<Column>, &'a str> {
    let mut columns: Vec<Column> = Vec::new();
    for name in names {
        let column = column(name)?;
        if column.is_some_and(|(place, _)| holds(&columns, place)) {
            return Err(name);
        }
        columns.push(column);
    }
    if (0..3).all(|place| holds(&columns, place)) {
        Ok(columns)
    } else {
        Err(names[0])
    }
}

fn holds(columns: &[Column], place: usize) -> bool {
    columns.iter().flatten().any(|(own, _)| *own == place)
}

/// What a column of this name holds.
fn column(name: &str) -> Result<Column, &str> {
    let mut parts = name
        .split(|c: char| !c.is_alphanumeric())
        .filter(|part| !part.is_empty());
    let place = match parts.next().ok_or(name)?.to_ascii_lowercase().as_str() {
        "t" | "time" => 0,
        "x" => 1,
        "y" => 2,
        "z" => 3,
        _ => return Ok(None),
    };
    let Some(unit) = parts.next() else {
        return Ok(Some((place, 1.0)));
    };
    // A time has a unit of time, a place one of length.
    let units = if place == 0 { &UNITS[3..] } else { &UNITS[..3] };
    let known = units.iter().find(|(symbol, _)| *symbol == unit);
    match (known, parts.next()) {
        (Some((_, factor)), None) => Ok(Some((place, *factor))),
        _ => Err(name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read_with_their_units() {
        let plain = "# a swing\n0,0,2,0\n0.5, 0.15, 1.6, -0.2 # there\n\n1,0,1.2,0\n";
        let named = "z [mm];time_ms;y(cm);x\n0;0;200;0\n-200;500;160;0.15\n0;1000;120;0";
        let [plain, named] = [plain, named].map(|text| Sketch::from_csv(text).unwrap());
        for ((t, p), (u, q)) in plain.points().iter().zip(named.points()) {
            assert!((t - u).abs() < 1e-12 && (p - q).norm() < 1e-12);
        }
        assert_eq!(plain.points()[1], (0.5, Vector3::new(0.15, 1.6, -0.2)));
        // Of a track with more in it, the times and places are read.
        let more = "t_s,qw,x_m,y_m,z_m,vx_mps,note\n0,1,0,2,0,,let go\n0.5,1,0.15,1.6,-0.2,0.3,\n1,1,0,1.2,0,0,";
        assert_eq!(Sketch::from_csv(more).unwrap(), plain);
    }

    /// What is wrong is named.
    #[test]
    fn bad_tables_are_refused() {
        let wrong = |text: &str| Sketch::from_csv(text).unwrap_err().to_string();
        assert!(wrong("").contains("points of the sketch"));
        assert!(wrong("t,x,y\n0,0,0").contains("points of the sketch"));
        assert!(wrong("0,0,0,0\n1,a,0,0").ends_with("row 2 of the table cannot be read: \"a\""));
        assert!(wrong("0,0,0,0\n1,0,0").contains("\"1,0,0\""));
        assert!(wrong("t,x (kg),y\n0,0,0\n1,0,0").contains("\"x (kg)\""));
        assert!(wrong("t (m),x,y\n0,0,0\n1,0,0").contains("\"t (m)\""));
        assert!(wrong("t,x,x\n0,0,0\n1,0,0").contains("\"x\""));
        assert!(wrong("t,x,z\n0,0,0\n1,0,0").contains("row 1"));
        assert!(wrong("t,x,y\n0,0,0\n0,1,0").contains("time of a point"));
        assert!(wrong("t,x,y\n0,0,0\n1,nan,0").contains("point of the sketch"));
        assert!(wrong("t,x,y\n0,0,0\n1,1e400,0").contains("point of the sketch"));
    }
}
