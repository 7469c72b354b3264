//! Solves for the table of added masses of boxes, cylinders, cones and capsules that the crate ships.
//!
//! ```text
//! cargo run --release --features bake,serde-serialize --example added_mass_table -- --out src/hydro/solids
//! ```
//!
//! Each row is one solid by boundary elements: added mass over displaced mass along its three axes, added over displaced
//! inertia about them, and of a cone the coupling of both over displaced mass times height.

mod support;

use clap::Parser;
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::rapier3d::na::{Matrix3, Vector3};
use rapier3d_immersed::rapier3d::parry::shape::{Capsule, Cone, Cuboid, Cylinder, Shape};
use rapier3d_immersed::{AddedMass, Error};
use std::fmt::Write;
use support::cli;
use support::options::{Out, wrote};

/// Relative error to refine to.
const TOLERANCE: f64 = 0.004;

/// Solve for the table of added masses that the crate ships.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    out: Out,
}

/// A solid of the table, along its own axes: that of revolution or the longest edge first.
struct Row {
    name: &'static str,
    /// Logarithms to base 2 of its first edge over the second and the second over the third; of height over diameter.
    ratios: [i32; 2],
    shape: Box<dyn Shape>,
    volume: f64,
    /// Volume times the mean squares of the distances from the planes through the centroid.
    second_moment: Vector3<f64>,
    /// From the shape's origin to its centroid, along its axis.
    centroid: f64,
    height: f64,
}

/// The rows: boxes to 64 : 1 and 4096 times as wide as thick, solids of revolution to 64 : 1 and 1 : 256.
fn rows() -> Vec<Row> {
    let power = |exponent: i32| 2.0_f64.powi(exponent);
    let boxes = (0..=6)
        .flat_map(|i| (0..=12).map(move |j| [i, j]))
        .map(|ratios| {
            let lengths = Vector3::new(power(ratios[0]), 1.0, power(-ratios[1]));
            let half = lengths.map(|length| 0.5 * length as f32);
            let volume = lengths.product();
            Row {
                name: "cuboid",
                ratios,
                shape: Box::new(Cuboid::new(Vector::new(half.x, half.y, half.z))),
                volume,
                second_moment: lengths.component_mul(&lengths) * (volume / 12.0),
                centroid: 0.0,
                height: lengths.x,
            }
        });
    let pi = std::f64::consts::PI;
    let round = |along: f64, across: f64| Vector3::new(along, across, across);
    let cylinders = (-12..=6).map(|i| {
        let h = power(i);
        let volume = pi * 0.25 * h;
        Row {
            name: "cylinder",
            ratios: [i, 0],
            shape: Box::new(Cylinder::new(0.5 * h as f32, 0.5)),
            volume,
            second_moment: round(h * h / 12.0, 1.0 / 16.0) * volume,
            centroid: 0.0,
            height: h,
        }
    });
    let cones = (-8..=6).map(|i| {
        let h = power(i);
        let volume = pi * h / 12.0;
        Row {
            name: "cone",
            ratios: [i, 0],
            shape: Box::new(Cone::new(0.5 * h as f32, 0.5)),
            volume,
            second_moment: round(h * h * 3.0 / 80.0, 3.0 / 80.0) * volume,
            centroid: -0.25 * h,
            height: h,
        }
    });
    let capsules = (0..=6).map(|i| {
        let length = power(i);
        let half = 0.5 * (length - 1.0);
        let (tube, ball) = (pi * 0.5 * half, pi / 6.0);
        let along = tube * half * half / 3.0 + ball * (0.05 + half * half + 0.375 * half);
        Row {
            name: "capsule",
            ratios: [i, 0],
            shape: Box::new(Capsule::new_y(half as f32, 0.5)),
            volume: tube + ball,
            second_moment: round(along, tube / 16.0 + ball * 0.05),
            centroid: 0.0,
            height: length,
        }
    });
    boxes
        .chain(cylinders)
        .chain(cones)
        .chain(capsules)
        .collect()
}

/// From here on what moves in its own plane drags so little along that the solver cannot tell it beside the broadside
/// added mass: 1 % of the displaced mass.
const THINNEST: i32 = 7;

/// Added over displaced mass of a box in its own plane, and over displaced inertia about its normal, as they go on beyond
/// [`THINNEST`] by the logarithm of two blunt edges: in proportion to t ln(c/t) of thickness t and chord c.
fn edgewise(at_thinnest: f64, exponent: i32) -> f64 {
    let beyond = f64::from(exponent - THINNEST);
    at_thinnest * (-beyond).exp2() * f64::from(exponent) / f64::from(THINNEST)
}

/// The seven numbers of a solid, and the error that the solver estimates.
fn solved(row: &Row) -> Result<([f64; 7], f64), Error> {
    let (own, report) = AddedMass::of_shape(row.shape.as_ref(), Vector::ZERO, TOLERANCE)?;
    // Rapier's axis of revolution is y; a box's first edge is x.
    let round = row.name != "cuboid";
    let added = if round {
        let cycle = Matrix3::new(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0);
        let turned = |m: Matrix3<f64>| cycle * m * cycle.transpose();
        AddedMass {
            linear: turned(own.linear),
            coupling: turned(own.coupling),
            angular: turned(own.angular),
        }
        .about(Vector3::new(row.centroid, 0.0, 0.0))
    } else {
        own
    };
    let linear = added.linear.diagonal() / row.volume;
    let m = &row.second_moment;
    let displaced = Vector3::new(m.y + m.z, m.z + m.x, m.x + m.y);
    let mut angular = added.angular.diagonal().component_div(&displaced);
    let (mut linear, mut coupling) = (linear, 0.0);
    if round {
        // What facets and rounding make of symmetry.
        linear = Vector3::new(
            linear.x,
            0.5 * (linear.y + linear.z),
            0.5 * (linear.y + linear.z),
        );
        let across = 0.5 * (angular.y + angular.z);
        angular = Vector3::new(0.0, across, across);
    }
    if row.name == "cone" {
        coupling =
            0.5 * (added.coupling[(1, 2)] - added.coupling[(2, 1)]) / (row.volume * row.height);
    }
    let numbers = [
        linear.x, linear.y, linear.z, angular.x, angular.y, angular.z, coupling,
    ];
    Ok((numbers, report.estimated_error.unwrap_or(f64::INFINITY)))
}

fn main() {
    let arguments: Arguments = cli::parse();
    let rows = rows();
    let bar = cli::progress(rows.len() as u64, "solids");
    let mut text = String::from(
        "# Written by: cargo run --release --features bake,serde-serialize --example added_mass_table\n\
         # Added mass over displaced mass, added over displaced inertia, coupling over displaced mass times height,\n\
         # about the centroid; axes: the longest edge first, or that of revolution, toward the apex.\n\
         solid,log2_ratio,log2_second_ratio,k_1,k_2,k_3,k_about_1,k_about_2,k_about_3,coupling\n",
    );
    let (mut worst, mut thinnest) = (0.0_f64, [0.0; 7]);
    for row in &rows {
        let (mut numbers, error) = solved(row)
            .unwrap_or_else(|error| cli::bad_value(row.name, format!("{:?}: {error}", row.ratios)));
        worst = worst.max(error);
        if row.name == "cuboid" && row.ratios[1] == THINNEST {
            thinnest = numbers;
        } else if row.name == "cuboid" && row.ratios[1] > THINNEST {
            for i in [0, 1, 5] {
                numbers[i] = edgewise(thinnest[i], row.ratios[1]);
            }
        }
        write!(text, "{},{},{}", row.name, row.ratios[0], row.ratios[1])
            .expect("a string takes all");
        for value in numbers {
            write!(text, ",{value:.5e}").expect("a string takes all");
        }
        text.push('\n');
        bar.inc(1);
    }
    bar.finish();
    let path = arguments.out.write("added_mass.csv", text);
    println!("{} rows, estimated errors to {worst:.1e}", rows.len());
    println!("{}", wrote(&[path]));
}
