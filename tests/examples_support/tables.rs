//! Tracks are read from tables of ours and of others.

use crate::support::series::Series;
use crate::support::track::{Table, Track};
use crate::support::{Quat, Vec3};

#[test]
fn columns_are_found_by_name_and_turned_into_si() {
    let text = "# a plate\nframe; t_ms; angle (deg); y [cm]; x_mm; area1_px; vx_mps; note\n1;0;90;100;0;7;1;\n2;10;-90;98;5;8;1;\n";
    let table = Table::read(text).unwrap();
    let [t, x, y, angle] = table.columns(["t", "x", "y", "angle"]).unwrap();
    assert_eq!(t, [0.0, 0.01]);
    assert!((y[1] - 0.98).abs() < 1e-12 && (x[1] - 0.005).abs() < 1e-12);
    assert!((angle[0] - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    // A unit that is not turned into others stays a part of the name.
    assert!(table.columns(["area1_px", "vx_mps"]).is_ok());
    let missing = table.columns(["z"]).unwrap_err();
    assert!(
        missing.contains("'z'") && missing.contains("angle"),
        "{missing}"
    );
    let empty = table.columns(["note"]).unwrap_err();
    assert!(
        empty.contains("note is ''") && empty.contains("row 3"),
        "{empty}"
    );
}

/// The TUM format: no names, blanks, the scalar of the quaternion last.
#[test]
fn a_file_in_the_tum_format_is_a_track() {
    let half = 0.5_f64.sqrt();
    let text = format!(
        "# timestamp tx ty tz qx qy qz qw\n1.5 0.1 2 0 0 0 0 1\n1.6 0.2 1.9 -0.1 0 {half} 0 {half}\n"
    );
    let track = Track::read(&text).unwrap();
    assert_eq!(track.times, [1.5, 1.6]);
    assert_eq!(track.places[1], Vec3::new(0.2, 1.9, -0.1));
    let quarter = Quat::from_axis_angle(&Vec3::y_axis(), std::f64::consts::FRAC_PI_2);
    assert!(track.turns[1].angle_to(&quarter) < 1e-7);
}

#[test]
fn bad_tables_say_where() {
    let wrong = |text: &str| Track::read(text).unwrap_err();
    let header = "t_s,x_m,y_m,z_m,qx,qy,qz,qw";
    assert!(wrong("").contains("no row"));
    assert!(wrong("0,0,0\n").contains("names"));
    assert!(wrong(&format!("{header}\n0,0,0,0,0,0,0\n")).contains("row 2 has 7 values for 8"));
    assert!(wrong(&format!("{header}\n0,0,a,0,0,0,0,1\n")).contains("row 2: y is 'a'"));
    assert!(wrong(&format!("{header}\n0,0,inf,0,0,0,0,1\n")).contains("row 2: y is 'inf'"));
    let back = format!("{header}\n0,0,0,0,0,0,0,1\n0,0,0,0,0,0,0,1\n");
    assert!(wrong(&back).contains("do not ascend at 0 s"));
    let zero = format!("{header}\n0,0,0,0,0,0,0,0\n");
    assert!(wrong(&zero).contains("quaternion is zero at 0 s"));
}

/// The same numbers as text, as a table that is read again, and as JSON.
#[test]
fn a_series_carries_its_units() {
    let mut series = Series::new("run", &[("t", "s"), ("height", "mm"), ("asleep", "")]);
    series.push("first, plain", &[0.5, 1234.5678, 3.0]);
    series.push("first, plain", &[1.0, 0.012_345, 4.0]);
    series.push("second", &[0.5, -7.0, 0.0]);
    let text = series.text();
    let words: Vec<Vec<&str>> = text
        .lines()
        .map(|l| l.split_whitespace().collect())
        .collect();
    assert_eq!(words[1], ["t_s", "height_mm", "asleep"]);
    assert_eq!(words[2], ["0.5000", "1235", "3"]);
    assert_eq!(words[3], ["1", "0.01235", "4"]);
    assert_eq!(words[4], ["second"]);
    let csv = series.csv();
    assert_eq!(csv.lines().next(), Some("t_s,height_mm,asleep,run"));
    assert!(csv.lines().nth(1).unwrap().ends_with(",first; plain"));
    let mut single = Series::new("run", &[("t", "s"), ("x", "m")]);
    single.push("one", &[f64::from(0.1_f32), 0.1]);
    assert_eq!(single.csv().lines().nth(1), Some("0.1,0.1,one"));
    let json = series.json();
    assert_eq!(json[1]["height_mm"], 0.012_345);
    assert_eq!(json[2]["run"], "second");

    let mut alone = Series::new("air", &[("downwind", "m")]);
    alone.push("still", &[0.1]);
    alone.push("wind", &[2.0]);
    assert_eq!(alone.text().lines().count(), 3);
    assert!(alone.text().lines().nth(2).unwrap().ends_with("2  wind"));
}
