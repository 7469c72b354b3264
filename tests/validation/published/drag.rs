//! Drag of a sphere, and of a disc that moves along its axis, over the Reynolds number.

use super::draw::{self, Item, Panel, Point};
use super::report::Row;
use super::{Computed, Effort, Failure, Progress};
use plotters::style::RGBColor;
use rapier3d_immersed::rapier3d::math::Real;
use rapier3d_immersed::rapier3d::na::{Matrix3, Vector3};
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use rapier3d_immersed::training::{BodyInWorld, BodyState};
use rapier3d_immersed::{DryMass, Error, Fluid, FreeBody, HydroProperties};
use std::f64::consts::PI;

const RADIUS: f64 = 0.1;
const VISCOSITY: f64 = 1e-4;
const GRAVITY: f64 = 9.81;

/// Clift & Gauvin 1971.
fn clift_gauvin(re: f64) -> f64 {
    24.0 / re * (1.0 + 0.15 * re.powf(0.687)) + 0.42 / (1.0 + 42500.0 * re.powf(-1.16))
}

/// The same form with other constants, which the Python library `fluids` gives under the same name, after
/// Barati et al. 2014.
fn refitted(re: f64) -> f64 {
    24.0 / re * (1.0 + 0.152 * re.powf(0.677)) + 0.417 / (1.0 + 5070.0 * re.powf(-0.94))
}

/// Schiller & Naumann 1933 (often dated 1935), Re < 800.
fn schiller_naumann(re: f64) -> f64 {
    24.0 / re * (1.0 + 0.15 * re.powf(0.687))
}

/// Pitter, Pruppacher & Hamielec 1973, 1.5 < Re < 133.
fn pitter(re: f64) -> f64 {
    64.0 / (PI * re) * (1.0 + 0.138 * re.powf(0.792))
}

/// A sphere, or a disc as thin as paper; its axis is y.
struct Body {
    hydro: HydroProperties,
    /// Inertia over mass, m².
    inertia: Matrix3<f64>,
}

impl Body {
    fn sphere() -> Result<Self, Error> {
        let shape = SharedShape::ball(RADIUS as Real);
        Ok(Self {
            hydro: HydroProperties::from_shape(shape.as_ref())?,
            inertia: Matrix3::identity() * (0.4 * RADIUS * RADIUS),
        })
    }

    fn disc() -> Result<Self, Error> {
        let shape = SharedShape::cylinder(5e-4, RADIUS as Real);
        let square = 0.25 * RADIUS * RADIUS;
        Ok(Self {
            hydro: HydroProperties::from_shape(shape.as_ref())?,
            inertia: Matrix3::from_diagonal(&Vector3::new(square, 2.0 * square, square)),
        })
    }

    fn mass(&self, mass: f64) -> DryMass {
        DryMass {
            mass,
            center: Vector3::zeros(),
            inertia: self.inertia * mass,
        }
    }

    /// C_D on πR² of the force on the body as it moves along y.
    fn coefficient(&self, re: f64) -> Result<f64, Error> {
        let fluid = Fluid::new(1.0, VISCOSITY as Real)?;
        let mut body = FreeBody::new(&self.hydro.clone().into(), &self.mass(1e-3), &fluid)?;
        let speed = re * VISCOSITY / (2.0 * RADIUS);
        body.set_velocity(Vector3::new(0.0, -speed, 0.0), Vector3::zeros());
        let force = f64::from(body.forces(Vector3::zeros()).viscous().force.y);
        Ok(force / dynamic_force(speed))
    }

    /// Terminal speed of the body under its weight, which is chosen for the drag at `re`; stand-alone
    /// and in rapier at 1/240 s, over the speed that it should be.
    fn terminal(&self, re: f64, drag: f64) -> Result<[f64; 2], Error> {
        let speed = re * VISCOSITY / (2.0 * RADIUS);
        let displaced = self.hydro.volume;
        let mass = displaced + drag * dynamic_force(speed) / GRAVITY;
        let fluid = Fluid::new(1.0, VISCOSITY as Real)?;
        // Twenty relaxation times.
        let added = self.hydro.added_mass.linear[(1, 1)];
        let relaxation = (mass + added) * speed / (drag * dynamic_force(speed));
        let mut free = FreeBody::new(&self.hydro.clone().into(), &self.mass(mass), &fluid)?;
        for _ in 0..4000 {
            free.step(relaxation / 200.0, Vector3::new(0.0, -GRAVITY, 0.0));
        }
        let release = BodyState::default();
        let (body, mass) = (self.hydro.clone(), self.mass(mass));
        let mut rapier = BodyInWorld::new(body, &mass, fluid, &release, 1.0 / 240.0, GRAVITY)?;
        for _ in 0..((20.0 * relaxation * 240.0) as usize).clamp(240, 48_000) {
            rapier.step();
        }
        let rapier = -rapier.state().velocity.y;
        Ok([-free.linear_velocity().y / speed, rapier / speed])
    }
}

/// ½ρv²πR² in a fluid of unit density.
fn dynamic_force(speed: f64) -> f64 {
    0.5 * speed * speed * PI * RADIUS * RADIUS
}

pub fn compute(effort: Effort, progress: Progress) -> Result<Computed, Failure> {
    let (sphere, disc) = (Body::sphere()?, Body::disc()?);
    let mut rows = Vec::new();
    for re in [0.1, 1.0, 10.0, 100.0, 300.0, 1e3, 1e4, 1e5] {
        let ours = sphere.coefficient(re)?;
        rows.push(Row::number(
            format!("sphere C_D, Re {re}"),
            [clift_gauvin(re), ours],
            "",
            Some(0.02),
            "Clift & Gauvin 1971",
        ));
        let mut other = |measured, source| {
            let case = format!("sphere C_D, Re {re}");
            rows.push(Row::number(case, [measured, ours], "", None, source));
        };
        if re < 800.0 {
            other(schiller_naumann(re), "Schiller & Naumann 1933");
        }
        let source = "refit 24/Re(1 + .152Re^.677) + .417/(1 + 5070Re^-.94)";
        other(refitted(re), source);
    }
    progress(0.1);
    let exponents: &[i32] = effort.choose(&[-1, 0, 1, 2, 3, 4, 5], &[0, 3]);
    for (i, exponent) in exponents.iter().enumerate() {
        let re = 10f64.powi(*exponent);
        let [alone, rapier] = sphere.terminal(re, clift_gauvin(re))?;
        let mut row = |runner: &str, ours: f64| {
            let case = format!("sphere's terminal speed over the curve's, Re {re}, {runner}");
            let source = "Clift & Gauvin 1971";
            rows.push(Row::number(case, [1.0, ours], "", Some(0.02), source));
        };
        row("stand-alone", alone);
        row("rapier 1/240 s", rapier);
        progress(0.1 + 0.9 * (i + 1) as f64 / exponents.len() as f64);
    }
    for re in [2.0, 5.0, 10.0, 30.0, 100.0, 130.0] {
        rows.push(Row::number(
            format!("disc broadside C_D, Re {re}"),
            [pitter(re), disc.coefficient(re)?],
            "",
            Some(0.02),
            "Pitter, Pruppacher & Hamielec 1973",
        ));
    }
    for re in [1e3, 3e3, 1e4, 1e5] {
        rows.push(Row::number(
            format!("disc broadside C_D, Re {re}"),
            [1.17, disc.coefficient(re)?],
            "",
            Some(0.02),
            "Hoerner, Fluid-Dynamic Drag",
        ));
    }
    let pictures = vec![("drag.svg".into(), picture(&sphere, &disc)?)];
    Ok((rows, pictures))
}

fn picture(sphere: &Body, disc: &Body) -> Result<String, Failure> {
    const BLUE: RGBColor = RGBColor(30, 90, 200);
    const GREY: RGBColor = RGBColor(150, 150, 150);
    const RED: RGBColor = RGBColor(211, 47, 47);
    let curve = |body: &Body| -> Result<Vec<Point>, Error> {
        let at = |i| 10f64.powf(f64::from(i) / 20.0);
        (-20..=100)
            .map(|i| Ok((at(i), body.coefficient(at(i))?)))
            .collect()
    };
    let dots = |res: &[f64], law: fn(f64) -> f64| {
        let points: Vec<Point> = res.iter().map(|re| (*re, law(*re))).collect();
        points
    };
    let decades: Vec<f64> = (-2..=10).map(|i| 10f64.powf(f64::from(i) / 2.0)).collect();
    let low: Vec<f64> = (1..=10).map(|i| 1.5 * 1.55f64.powi(i)).collect();
    let mut panels = Vec::new();
    for (title, body, dots) in [
        (
            "sphere: ours (line), Clift & Gauvin 1971 (dots)",
            sphere,
            dots(&decades, clift_gauvin),
        ),
        (
            "disc, broadside: ours (line), Pitter et al. 1973 and 1.17 (dots), Stokes (dashed)",
            disc,
            [
                dots(&low, pitter),
                dots(&[1e3, 3e3, 1e4, 3e4, 1e5], |_| 1.17),
            ]
            .concat(),
        ),
    ] {
        let stokes = if std::ptr::eq(body, sphere) {
            24.0
        } else {
            64.0 / PI
        };
        let mut panel = Panel::new(title, "Reynolds number", "C_D");
        panel.logarithmic = true;
        panel.window = Some([(0.1, 1e5), (0.1, 400.0)]);
        let creeping = vec![(0.1, stokes / 0.1), (stokes / 0.1, 0.1)];
        panel.items = vec![
            Item::Dashed(creeping, GREY),
            Item::Line(curve(body)?, BLUE, 2),
            Item::Dots(dots, RED, 4),
        ];
        panels.push(panel);
    }
    draw::svg("Drag coefficients", &panels, 2, (640, 480))
}
