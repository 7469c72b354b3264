//! Paths that are drawn: points of lines and curves against their formulas, and what is wrong with others.

use crate::svg::{path_data, points};

fn close(a: [f64; 2], b: [f64; 2]) -> bool {
    // Numbers of a path are read in single precision.
    (a[0] - b[0]).abs() < 1e-4 && (a[1] - b[1]).abs() < 1e-4
}

#[test]
fn lines_are_read_absolute_and_relative() {
    let corners = [
        [10.0, 20.0],
        [30.0, 20.0],
        [30.0, 50.0],
        [25.0, 45.0],
        [10.0, 20.0],
    ];
    for data in [
        "M 10 20 L 30 20 30,50 25 45 Z",
        "m10,20 l20,0 0,30 -5-5z",
        "M10 20H30v30l-5-5Z",
    ] {
        let found = points(data).unwrap();
        assert_eq!(found.len(), corners.len(), "{data}");
        assert!(
            found.iter().zip(corners).all(|(a, b)| close(*a, b)),
            "{data}: {found:?}"
        );
    }
}

/// Halfway a cubic is at (a + 3b + 3c + d)/8, a quadratic at (a + 2b + c)/4; smooth ones begin with the mirrored control point.
#[test]
fn curves_are_those_of_bezier() {
    let halfway = |data: &str, curve: usize| points(data).unwrap()[24 * curve + 12];
    for data in ["M0 0C0 8 8 16 16 8", "m0 0c0 8 8 16 16 8"] {
        assert!(close(
            halfway(data, 0),
            [(24.0 + 16.0) / 8.0, (24.0 + 48.0 + 8.0) / 8.0]
        ));
    }
    // From (16, 8) with the control point (24, 0), to (40, 8) over (32, 0).
    for data in [
        "M0 0C0 8 8 16 16 8S32 0 40 8",
        "M0 0C0 8 8 16 16 8s16-8 24 0",
    ] {
        let middle = [(16.0 + 72.0 + 96.0 + 40.0) / 8.0, (8.0 + 8.0) / 8.0];
        assert!(close(halfway(data, 1), middle));
    }
    assert!(close(halfway("M0 0Q8 16 16 0", 0), [8.0, 8.0]));
    assert!(close(halfway("M0 0Q8 16 16 0T32 0", 1), [24.0, -8.0]));
}

#[test]
fn what_is_no_drawing_is_named() {
    let wrong = |data: &str| points(data).unwrap_err();
    assert!(wrong("L 1 1").contains("command 1"));
    assert!(wrong("M 0 0 A 1 1 0 0 0 5 5").contains("arcs"));
    assert!(wrong("M 0 0 L 1 1 M 2 2").contains("command 3"));
    assert!(wrong("M 0 0 C 1 1 2 2").contains("4 numbers, not 6"));
    assert!(wrong("M 0 0").contains("second point"));
    assert!(wrong("M 0 0 X 1 1").contains("path data"));
    let file = "<svg><path id='a' d='M0 0L1 2'/><path d='M5 5L6 6'/></svg>";
    assert_eq!(path_data(file).unwrap(), "M0 0L1 2");
    assert_eq!(path_data("M0 0L1 2").unwrap(), "M0 0L1 2");
    assert!(
        path_data("<svg><rect/></svg>")
            .unwrap_err()
            .contains("no <path>")
    );
    let turned = "<svg><path d='M0 0L1 2' transform='rotate(9)'/></svg>";
    assert!(path_data(turned).unwrap_err().contains("transform"));
}
