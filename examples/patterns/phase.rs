//! The phase diagram with a body on it.

use crate::Context;
use crate::draw::{Item, Panel};
use crate::support::cli::{self, FluidArgs};
use crate::support::options::Material;
use crate::support::shape::ShapeArgs;
use crate::support::specimen::Specimen;
use clap::Args;
use plotters::style::RGBColor;
use rapier3d_immersed::Error;
use rapier3d_immersed::motion::{PhaseDiagram, Regime};
use serde_json::{Value, json};

/// The user's body.
#[derive(Args)]
pub struct BodyArguments {
    #[command(flatten)]
    shape: ShapeArgs,
    #[command(flatten)]
    material: Material,
    #[command(flatten)]
    fluid: FluidArgs,
}

fn shade(regime: Regime) -> RGBColor {
    match regime {
        Regime::SteadyDescent => RGBColor(250, 226, 224),
        Regime::PeriodicFlutter => RGBColor(222, 241, 222),
        Regime::TransitionalChaotic => RGBColor(221, 231, 250),
        Regime::PeriodicTumbling => RGBColor(245, 222, 242),
        Regime::TransitionalHelix => RGBColor(240, 244, 205),
        Regime::PeriodicSpiral => RGBColor(252, 238, 210),
    }
}

pub fn draw(context: &Context, arguments: &BodyArguments) -> Result<Value, Error> {
    let fluid = arguments.fluid.fluid();
    let body = Specimen::new(&arguments.shape.shaped())
        .unwrap_or_else(|problem| cli::bad_value("--shape/--size", problem));
    let density = arguments.material.density.expect("it has a default");
    let numbers = body.numbers(density, &fluid, 9.81)?;
    let descent = numbers.broadside_descent();
    let reynolds = numbers.reynolds();
    let diagram = PhaseDiagram::default();
    let regime = diagram.regime_of(&numbers);
    let near = diagram.neighbours(reynolds, numbers.i_star, 0.2);

    let (low, high): ([f64; 2], [f64; 2]) = ([20.0, 2e-4], [5e4, 0.3]);
    let mut panel = Panel::new("", "Re = U L/ν, U the mean descent", "I*");
    panel.logarithmic = true;
    panel.window = Some([(low[0], high[0]), (low[1], high[1])]);
    // Shades, row by row.
    const CELLS: usize = 160;
    let at = |axis: usize, cell: usize| {
        low[axis] * (high[axis] / low[axis]).powf(cell as f64 / CELLS as f64)
    };
    for row in 0..CELLS {
        let (bottom, top) = (at(1, row), at(1, row + 1));
        let middle = (bottom * top).sqrt();
        let mut from = 0;
        for cell in 0..CELLS {
            let here = diagram.regime((at(0, cell) * at(0, cell + 1)).sqrt(), middle);
            let next = (at(0, cell + 1) * at(0, (cell + 2).min(CELLS))).sqrt();
            if cell + 1 == CELLS || diagram.regime(next, middle) != here {
                let corners = ((at(0, from), bottom), (at(0, cell + 1), top));
                panel.items.push(Item::Boxes(vec![corners], shade(here)));
                from = cell + 1;
            }
        }
    }
    let black = RGBColor(40, 40, 40);
    for boundary in diagram.boundaries() {
        panel.items.push(if boundary.measured {
            Item::Line(boundary.points, black, 2)
        } else {
            let inside = boundary.points.into_iter();
            let inside = inside.map(|(re, i)| (re, i.max(low[1])));
            Item::Dashed(inside.collect(), black)
        });
    }
    for (regime, re, i_star) in [
        (Regime::SteadyDescent, 45.0, 4e-3),
        (Regime::PeriodicFlutter, 600.0, 2e-3),
        (Regime::TransitionalChaotic, 2500.0, 1.9e-2),
        (Regime::PeriodicTumbling, 500.0, 0.12),
        (Regime::TransitionalHelix, 3000.0, 5.3e-3),
        (Regime::PeriodicSpiral, 6000.0, 7e-4),
    ] {
        let name = format!("{regime} ({})", regime.abbreviation());
        panel.items.push(Item::Label((re, i_star), name, black));
    }
    let grey = RGBColor(90, 90, 90);
    for case in PhaseDiagram::THESIS_CASES {
        panel
            .items
            .push(Item::Dots(vec![(case.reynolds, case.i_star)], grey, 4));
        let above = (case.reynolds, case.i_star * 1.14);
        panel.items.push(Item::Label(above, case.name.into(), grey));
    }
    let red = RGBColor(211, 30, 30);
    panel
        .items
        .push(Item::Dots(vec![(reynolds, numbers.i_star)], red, 7));
    let above = (reynolds, numbers.i_star * 1.2);
    panel
        .items
        .push(Item::Label(above, "your body".into(), red));
    let title = "Phase diagram: measured (solid), convention (dashed); grey: cases as the thesis prints them";
    context.write("phase_diagram.svg", title, &[panel], 1, (900, 640));
    let near: Vec<String> = near.iter().map(Regime::to_string).collect();
    context.say(format!(
        "your body: U0 {:.3} m/s, Re(U0) {:.0}, I* {:.2e}; about {descent:.2} m/s broadside, Re {reynolds:.0}: \
         {regime}{}",
        numbers.u0,
        numbers.reynolds_u0,
        numbers.i_star,
        if near.is_empty() {
            String::new()
        } else {
            format!(", within 20 % of {}", near.join(", "))
        }
    ));
    Ok(json!({
        "u0": numbers.u0,
        "reynolds_u0": numbers.reynolds_u0,
        "i_star": numbers.i_star,
        "descent_estimate": descent,
        "reynolds_estimate": reynolds,
        "regime": regime.abbreviation(),
    }))
}
