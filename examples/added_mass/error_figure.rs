//! Error against thickness, as thesis Fig. 5.2, for bodies of 7.3 × 4.2 cm (the sizes there are not stated)
//! from 3 cm down to 0.1 mm.

use crate::previous;
use plotters::prelude::*;
use rapier3d_immersed::AddedMass;
use rapier3d_immersed::boundary_element::BoundaryElementParams;
use rapier3d_immersed::geometry::{Ellipsoid, Surface};
use rapier3d_immersed::rapier3d::na::{Matrix6, Vector3};
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use serde_json::json;
use std::path::Path;

/// Thicknesses, cm.
const THICKNESS: [f64; 10] = [3.0, 2.0, 1.3, 0.6, 0.3, 0.1, 0.06, 0.03, 0.02, 0.01];
/// Cells of the ellipsoid's mesh (20 cells²: 1280 panels) and of the cylinder's.
const ELLIPSOID_CELLS: usize = 8;
const CYLINDER_CELLS: usize = 9;

struct Row {
    thickness: f64,
    previous: f64,
    ours: f64,
}

/// `‖K − K_a‖ / ‖K_a‖` with lengths in cm, about the thesis's scale.
fn error(found: &Matrix6<f64>, exact: &Matrix6<f64>) -> f64 {
    (found - exact).norm() / exact.norm()
}

fn once(surface: &Surface) -> Result<Matrix6<f64>, String> {
    let params = BoundaryElementParams {
        tolerance: f64::INFINITY,
        ..BoundaryElementParams::default()
    };
    let solved = AddedMass::solve(surface, &params).map_err(|e| e.to_string())?;
    Ok(solved.0.to_matrix6())
}

fn naive(surface: &Surface) -> Result<Matrix6<f64>, String> {
    previous::added_mass(surface).ok_or_else(|| "the plain method's equations are singular".into())
}

fn ellipsoids() -> Result<Vec<Row>, String> {
    let row = |thickness: &f64| {
        let body = Ellipsoid {
            semi_axes: Vector3::new(3.65, 2.1, thickness / 2.0),
        };
        let surface = Surface::ellipsoid(&body, ELLIPSOID_CELLS).map_err(|e| e.to_string())?;
        let exact = body.added_mass().to_matrix6();
        Ok(Row {
            thickness: *thickness,
            previous: error(&naive(&surface)?, &exact),
            ours: error(&once(&surface)?, &exact),
        })
    };
    THICKNESS.iter().map(row).collect()
}

/// Cylinders of 4.2 cm diameter have no closed form: the reference is our own method, refined to
/// 0.1 % and extrapolated.
fn cylinders() -> Result<Vec<Row>, String> {
    let row = |thickness: &f64| {
        let shape = SharedShape::cylinder((thickness / 2.0) as f32, 2.1);
        let failed = |e: rapier3d_immersed::Error| e.to_string();
        let surface = Surface::panelled(shape.as_ref(), CYLINDER_CELLS).map_err(failed)?;
        let (exact, report) =
            AddedMass::of_shape(shape.as_ref(), Default::default(), 0.001).map_err(failed)?;
        if !report.converged {
            eprintln!(
                "reference at {thickness} cm: error {:?}",
                report.estimated_error
            );
        }
        let exact = exact.to_matrix6();
        Ok(Row {
            thickness: *thickness,
            previous: error(&naive(&surface)?, &exact),
            ours: error(&once(&surface)?, &exact),
        })
    };
    THICKNESS.iter().map(row).collect()
}

/// Draws the figure, and prints its numbers.
pub fn draw(path: &Path, as_json: bool) -> Result<(), String> {
    let series = [
        ("ellipsoid 7.3 × 4.2 cm", ellipsoids()?),
        ("cylinder ⌀ 4.2 cm", cylinders()?),
    ];
    plot(path, &series).map_err(|e| format!("--out {}: {e}", path.display()))?;
    if as_json {
        let of = |rows: &[Row]| -> Vec<_> {
            let row = |r: &Row| json!({ "thickness_cm": r.thickness, "previous": r.previous, "ours": r.ours });
            rows.iter().map(row).collect()
        };
        let [(_, ellipsoids), (_, cylinders)] = &series;
        println!(
            "{:#}",
            json!({ "ellipsoid": of(ellipsoids), "cylinder": of(cylinders) })
        );
        return Ok(());
    }
    for (name, rows) in &series {
        println!("{name}\n  thickness, cm   previous method      ours");
        for row in rows {
            println!(
                "  {:>13} {:>15.2} % {:>9.3} %",
                row.thickness,
                100.0 * row.previous,
                100.0 * row.ours
            );
        }
    }
    println!("figure: {}", path.display());
    Ok(())
}

fn plot(path: &Path, series: &[(&str, Vec<Row>)]) -> Result<(), Box<dyn std::error::Error>> {
    let root = SVGBackend::new(path, (1200, 560)).into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.titled(
        "Error of the added mass against thickness, same panels",
        ("sans-serif", 26),
    )?;
    for ((name, rows), area) in series.iter().zip(root.split_evenly((1, 2))) {
        let mut chart = ChartBuilder::on(&area)
            .caption(name, ("sans-serif", 22))
            .margin(14)
            .x_label_area_size(44)
            .y_label_area_size(74)
            .build_cartesian_2d((0.008..4.0).log_scale(), (1e-4..100.0).log_scale())?;
        chart
            .configure_mesh()
            .x_desc("thickness, cm")
            .y_desc("‖K − Kₐ‖ / ‖Kₐ‖")
            .label_style(("sans-serif", 16))
            .light_line_style(BLACK.mix(0.05))
            .x_label_formatter(&|x| format!("{x}"))
            .y_label_formatter(&|y| format!("{} %", 100.0 * y))
            .draw()?;
        type Value = fn(&Row) -> f64;
        let curves: [(&str, RGBColor, Value); 2] = [
            (
                "constant panels, plain quadrature",
                RGBColor(178, 24, 43),
                |r| r.previous,
            ),
            ("this crate", RGBColor(33, 102, 172), |r| r.ours),
        ];
        for (label, color, value) in curves {
            let points: Vec<_> = rows.iter().map(|r| (r.thickness, value(r))).collect();
            chart
                .draw_series(LineSeries::new(points.clone(), color.stroke_width(2)))?
                .label(label)
                .legend(move |(x, y)| {
                    PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2))
                });
            chart.draw_series(points.iter().map(|p| Circle::new(*p, 4, color.filled())))?;
        }
        // A leaf.
        chart.draw_series([PathElement::new(
            [(0.03, 1e-4), (0.03, 100.0)],
            BLACK.mix(0.4).stroke_width(1),
        )])?;
        chart.draw_series([Text::new("leaf", (0.032, 60.0), ("sans-serif", 15))])?;
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.9))
            .border_style(BLACK.mix(0.3))
            .label_font(("sans-serif", 15))
            .draw()?;
    }
    root.present()?;
    Ok(())
}
