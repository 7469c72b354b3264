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
use rapier3d_immersed::{AddedMass, Error, Solid};
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
    solid: Solid,
    shape: Box<dyn Shape>,
}

/// The rows: boxes to 64 : 1 and 4096 times as wide as thick, solids of revolution to 64 : 1 and 1 : 4096.
fn rows() -> Vec<Row> {
    let power = |exponent: i32| 2.0_f64.powi(exponent);
    let boxes = (0..=6).flat_map(|i| (0..=12).map(move |j| [i, j]));
    let boxes = boxes.map(|ratios| {
        let lengths = Vector3::new(power(ratios[0]), 1.0, power(-ratios[1]));
        let half = lengths.map(|length| 0.5 * length as f32);
        Row {
            name: "cuboid",
            ratios,
            solid: Solid::Cuboid { lengths },
            shape: Box::new(Cuboid::new(Vector::new(half.x, half.y, half.z))),
        }
    });
    // Of a diameter of 1 m.
    let radius = 0.5;
    let cylinders = (-12..=6).map(|i| Row {
        name: "cylinder",
        ratios: [i, 0],
        solid: Solid::Cylinder {
            radius,
            height: power(i),
        },
        shape: Box::new(Cylinder::new(0.5 * power(i) as f32, 0.5)),
    });
    let cones = (-8..=6).map(|i| Row {
        name: "cone",
        ratios: [i, 0],
        solid: Solid::Cone {
            radius,
            height: power(i),
        },
        shape: Box::new(Cone::new(0.5 * power(i) as f32, 0.5)),
    });
    let capsules = (0..=6).map(|i| Row {
        name: "capsule",
        ratios: [i, 0],
        solid: Solid::Capsule {
            radius,
            length: power(i),
        },
        shape: Box::new(Capsule::new_y(0.5 * (power(i) - 1.0) as f32, 0.5)),
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
    // Rapier's axis of revolution is y; a box's first edge is x. A cone's centroid is a quarter of its height from its
    // base, and rapier's origin half of it.
    let round = row.name != "cuboid";
    let centroid = match row.solid {
        Solid::Cone { height, .. } => -0.25 * height,
        _ => 0.0,
    };
    let added = if round {
        let cycle = Matrix3::new(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0);
        let turned = |m: Matrix3<f64>| cycle * m * cycle.transpose();
        AddedMass {
            linear: turned(own.linear),
            coupling: turned(own.coupling),
            angular: turned(own.angular),
        }
        .about(Vector3::x() * centroid)
    } else {
        own
    };
    let (volume, m) = (row.solid.volume(), row.solid.second_moment());
    let linear = added.linear.diagonal() / volume;
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
    if let Solid::Cone { height, .. } = row.solid {
        let both = added.coupling[(1, 2)] - added.coupling[(2, 1)];
        coupling = 0.5 * both / (volume * height);
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
