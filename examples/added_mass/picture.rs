//! The potential of the six unit motions on the surface of a body.

use crate::case;
use crate::support::shape::Shaped;
use plotters::prelude::*;
use rapier3d_immersed::boundary_element::BoundaryElementSolution;
use rapier3d_immersed::rapier3d::na::Vector3;
use std::error::Error;
use std::path::Path;

const MOTIONS: [&str; 6] = [
    "moving along x",
    "moving along y",
    "moving along z",
    "turning about x",
    "turning about y",
    "turning about z",
];

/// Blue for negative, white for zero, red for positive, from −1 to 1.
fn color(value: f64) -> RGBColor {
    let fade = |strength: f64, full: u8| {
        (255.0 + (f64::from(full) - 255.0) * strength.clamp(0.0, 1.0)) as u8
    };
    let (r, g, b) = if value > 0.0 {
        (178, 24, 43)
    } else {
        (33, 102, 172)
    };
    let strength = value.abs().sqrt();
    RGBColor(fade(strength, r), fade(strength, g), fade(strength, b))
}

pub fn draw(
    path: &Path,
    body: &Shaped,
    solution: &BoundaryElementSolution,
) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::new(path, (1200, 860)).into_drawing_area();
    root.fill(&WHITE)?;
    let what = if case::is_sheet(body) {
        "jump of the potential, front minus back"
    } else {
        "potential in the fluid"
    };
    let title = format!("{}: {what} ({} panels)", body.name, solution.report.panels);
    let root = root.titled(&title, ("sans-serif", 26))?;
    let (root, legend) = root.split_vertically(770);
    let label = |x| move |text| Text::new(text, (x, 14), ("sans-serif", 17));
    legend.draw(&label(285)("negative"))?;
    legend.draw(&label(835)("positive"))?;
    for i in 0..46 {
        let (x, value) = (365 + 10 * i, f64::from(i) / 22.5 - 1.0);
        legend.draw(&Rectangle::new(
            [(x, 14), (x + 10, 32)],
            color(value).filled(),
        ))?;
    }
    // Seen from the front, the right and above.
    let eye = Vector3::new(0.55, -0.65, 0.52).normalize();
    let right = Vector3::z().cross(&eye).normalize();
    let up = eye.cross(&right);
    let flat = |v: &Vector3<f64>| {
        let v = v - solution.center;
        (v.dot(&right), v.dot(&up))
    };
    let reach = solution
        .vertices
        .iter()
        .map(|v| flat(v).0.abs().max(flat(v).1.abs()))
        .fold(0.0, f64::max)
        * 1.05;
    let mut order: Vec<&[u32; 3]> = solution.triangles.iter().collect();
    let depth = |t: &[u32; 3]| -> f64 {
        t.iter()
            .map(|i| solution.vertices[*i as usize].dot(&eye))
            .sum()
    };
    order.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
    for (motion, area) in root.split_evenly((2, 3)).iter().enumerate() {
        let area = area.titled(MOTIONS[motion], ("sans-serif", 20))?;
        let (width, height) = area.dim_in_pixel();
        let (w, h) = (f64::from(width), f64::from(height));
        let scale = w.min(h) / (2.0 * reach);
        let pixel = |v: &Vector3<f64>| {
            let (x, y) = flat(v);
            ((w / 2.0 + scale * x) as i32, (h / 2.0 - scale * y) as i32)
        };
        let largest = |j: usize| {
            solution
                .potentials
                .iter()
                .map(|p| p[j].abs())
                .fold(0.0, f64::max)
        };
        // Motions that hardly move fluid are left as pale as they are beside the others.
        let group = if motion < 3 { 0..3 } else { 3..6 };
        let overall = group.map(largest).fold(f64::MIN_POSITIVE, f64::max);
        if largest(motion) < 1e-3 * overall {
            let style = ("sans-serif", 17).into_font().color(&BLACK.mix(0.6));
            area.draw(&Text::new(
                "moves no fluid",
                (18, height as i32 - 40),
                style,
            ))?;
        }
        for t in &order {
            let mean = t
                .iter()
                .map(|i| solution.potentials[*i as usize][motion])
                .sum::<f64>()
                / 3.0;
            let corners: Vec<_> = t
                .iter()
                .map(|i| pixel(&solution.vertices[*i as usize]))
                .collect();
            let fill = color(mean / overall);
            area.draw(&Polygon::new(corners.clone(), fill.filled()))?;
            let outline = corners
                .iter()
                .copied()
                .chain([corners[0]])
                .collect::<Vec<_>>();
            area.draw(&PathElement::new(outline, BLACK.mix(0.12).stroke_width(1)))?;
        }
    }
    root.present()?;
    Ok(())
}
