//! The figures of the thesis's section 4.6.

use crate::case::{Case, Flight, Look, Physics};
use crate::support::picture::{Line, Panel, time_color};
use crate::support::{Quat, Vec3};
use plotters::style::RGBColor;
use rapier3d_immersed::rapier3d::na::Matrix3;

/// A picture's two directions of the three of the world.
type View = fn(&Vec3) -> (f64, f64);

pub const FROM_THE_SIDE: View = |v| (v.x, v.y);
pub const FROM_ABOVE: View = |v| (v.x, -v.z);
/// Along x, which the side's picture shows from left to right.
pub const ALONG: View = |v| (v.z, v.y);

const GREY: RGBColor = RGBColor(170, 170, 170);

/// Outline of an ellipsoid with these semi-axes along the body's axes.
fn ellipse(semi: Vec3, center: Vec3, attitude: Quat, view: View) -> Vec<(f64, f64)> {
    let r = attitude.to_rotation_matrix();
    let spread = r.matrix() * Matrix3::from_diagonal(&semi.map(|s| s * s)) * r.matrix().transpose();
    // The picture's directions, seen as vectors.
    let [first, second] = [0, 1].map(|which| {
        Vec3::from_fn(|i, _| {
            let of = view(&Vec3::from_fn(|j, _| f64::from(u8::from(i == j))));
            [of.0, of.1][which]
        })
    });
    let along = |a: &Vec3, b: &Vec3| a.dot(&(spread * b));
    let (xx, xy, yy) = (
        along(&first, &first).max(1e-18),
        along(&first, &second),
        along(&second, &second),
    );
    // Cholesky factor of the 2×2 part maps the unit circle onto the outline.
    let l = xx.sqrt();
    let (m, n) = (xy / l, (yy - xy * xy / xx).max(0.0).sqrt());
    let (x, y) = view(&center);
    let point = |i: i32| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / 40.0).sin_cos();
        (x + l * cos, y + m * cos + n * sin)
    };
    (0..=40).map(point).collect()
}

/// How a figure's panels are drawn.
#[derive(Clone, Copy)]
pub struct Style {
    /// Time between two outlines, s.
    pub every: f64,
    pub view: View,
    /// What is shown of both directions, m.
    pub window: [(f64, f64); 2],
}

/// The path and the body's outlines, blue to yellow in time.
pub fn strobe(title: &'static str, case: &Case, flight: &Flight, style: Style) -> Panel<'static> {
    let view = style.view;
    let across = if view(&Vec3::x()).0 == 0.0 {
        "z, m"
    } else {
        "x, m"
    };
    let up = if view(&Vec3::y()).1 == 0.0 {
        "−z, m"
    } else {
        "height, m"
    };
    let path = flight.states.iter().map(|state| view(&state.position));
    let mut lines = vec![Line {
        points: path.collect(),
        color: GREY,
        width: 1,
    }];
    let stride = ((style.every / flight.dt).round() as usize).max(1);
    let last = (flight.states.len() - 1) as f64;
    for (i, state) in flight.states.iter().enumerate().step_by(stride) {
        let (place, turn) = (state.position, state.orientation);
        let outlines = match &case.look {
            Look::Ellipsoid(semi) => vec![ellipse(*semi, place, turn, view)],
            Look::Lines(faces) => {
                let seen = |v: &Vec3| view(&(place + turn * v));
                let closed = |face: &Vec<Vec3>| face.iter().chain(face.first()).map(seen).collect();
                faces.iter().map(closed).collect()
            }
        };
        lines.extend(outlines.into_iter().map(|points| Line {
            points,
            color: time_color(i as f64 / last),
            width: 1,
        }));
    }
    Panel {
        title,
        axes: [across, up],
        lines,
        dots: Vec::new(),
        window: Some(style.window),
    }
}

/// Where so many runs end, from above; the release is at the middle.
pub fn endings(case: &Case, physics: Physics, count: u64) -> Panel<'static> {
    let end = |seed| FROM_ABOVE(&case.fly(physics, seed).way());
    Panel {
        title: physics.name(),
        axes: ["x, m", "−z, m"],
        lines: Vec::new(),
        dots: (0..count)
            .map(|seed| (end(seed), RGBColor(50, 90, 150)))
            .collect(),
        window: Some([(-0.4, 0.4); 2]),
    }
}
