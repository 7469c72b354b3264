//! In a fluid at rest without gravity the energy of body and fluid never grows: random bodies, fluids and
//! time steps under the default law.

use super::Vec3;
use super::report::Row;
use super::{Computed, Effort, Failure, Progress};
use rand::{RngExt, SeedableRng};
use rapier3d_immersed::rapier3d::na::Matrix3;
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use rapier3d_immersed::{DryMass, Fluid, FreeBody, HydroProperties};

pub fn compute(effort: Effort, progress: Progress) -> Result<Computed, Failure> {
    let bodies = effort.choose(20_000, 300);
    let steps = 200;
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
    let (mut worst, mut grown, mut alive) = (f64::NEG_INFINITY, 0usize, 0usize);
    for i in 0..bodies {
        let mut log = |low: f64, high: f64| random.random_range(low.ln()..high.ln()).exp();
        let size = [log(1e-3, 10.0), log(1e-3, 10.0), log(1e-4, 1.0)];
        let rho = log(1.0, 1400.0);
        let density = rho * log(1e-3, 1e4);
        let fluid = Fluid::new(rho as f32, log(1e-6, 1e-2) as f32)?;
        let dt = log(1e-3, 0.05);
        let (speed, spin) = (log(1e-3, 50.0), log(1e-2, 200.0));
        let mut direction = || {
            let v = Vec3::from_fn(|_, _| random.random_range(-1.0..1.0));
            v.normalize()
        };
        let (linear, angular) = (direction() * speed, direction() * spin);
        let half = size.map(|x| (0.5 * x) as f32);
        let shape = SharedShape::cuboid(half[0], half[1], half[2]);
        let hydro = HydroProperties::from_shape(shape.as_ref())?;
        let mass = density * size.iter().product::<f64>();
        let [x, y, z] = size.map(|x| x * x / 12.0);
        let dry = DryMass {
            mass,
            center: Vec3::zeros(),
            inertia: Matrix3::from_diagonal(&Vec3::new(y + z, z + x, x + y)) * mass,
        };
        let mut body = FreeBody::new(&hydro.into(), &dry, &fluid)?;
        body.set_velocity(linear, angular);
        let start = body.kinetic_energy();
        let mut energy = start;
        for _ in 0..steps {
            body.step(dt, Vec3::zeros());
            let now = body.kinetic_energy();
            // Below a millionth of a millionth of the start there is only rounding.
            if energy > 1e-12 * start {
                let growth = now / energy - 1.0;
                worst = worst.max(growth);
                grown += usize::from(growth > 1e-9);
            }
            alive += usize::from(now.is_finite());
            energy = now;
        }
        if i % 100 == 0 {
            progress(i as f64 / bodies as f64);
        }
    }
    let title = format!("{bodies} random bodies × {steps} steps");
    let source = "second law of thermodynamics; the bar is rounding";
    let share = alive as f64 / (bodies * steps) as f64;
    let finite = format!("{:.1} % of the states", 100.0 * share);
    Ok((
        vec![
            Row::at_most(
                format!("{title}: largest growth of the energy in a step"),
                worst,
                Some(1e-9),
                source,
            ),
            Row::fact(
                format!("{title}: steps in which the energy grew"),
                grown.to_string(),
                grown == 0,
                source,
            ),
            Row::fact(
                format!("{title}: finite"),
                finite,
                share == 1.0,
                "nothing blows up",
            ),
        ],
        Vec::new(),
    ))
}
