//! Leaves carried off by winds of three speeds, as thesis Fig. 3.14.

use plotters::prelude::*;
use rapier3d_immersed::flow::{SpectralWind, WindParams};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
use std::error::Error;
use std::path::Path;

/// Mean wind speeds at 10 m height, m/s.
pub const SPEEDS: [f64; 3] = [1.0, 3.0, 5.0];
/// Height of the release, m.
const HEIGHT: Real = 10.0;
const LEAVES: usize = 9;

/// Leaves in one wind.
pub struct Paths {
    /// Mean wind at 10 m, m/s.
    pub speed: f64,
    /// Positions of each leaf until it reaches the ground.
    leaves: Vec<Vec<Vector>>,
}

impl Paths {
    /// Drops leaves of 7.3 × 4.2 × 0.03 cm from 10 m height into the wind.
    pub fn fly(params: &WindParams, speed: f64) -> Result<Self, Box<dyn Error>> {
        let wind = SpectralWind::bake(&WindParams {
            mean_speed: speed,
            // The thesis's wind blows from right to left.
            direction: -Vector::X,
            ..params.clone()
        })?;
        let mut world = PhysicsWorld::new();
        let handles: Vec<_> = (0..LEAVES)
            .map(|i| {
                let body = RigidBodyBuilder::dynamic()
                    .translation(Vector::new(0.0, HEIGHT, 3.0 * i as Real))
                    .rotation(Vector::new(0.3 * i as Real, 0.7 * i as Real, 0.2));
                let leaf = ColliderBuilder::cuboid(0.0365, 0.000_15, 0.021).density(350.0);
                world.insert(body, leaf).0
            })
            .collect();
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handles[0])?;
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert_all(handles.iter().copied(), hydro);
        immersion.set_flow(wind);
        let mut leaves = vec![Vec::new(); LEAVES];
        for _ in 0..60 * 60 {
            let mut flying = false;
            for (path, handle) in leaves.iter_mut().zip(&handles) {
                let position = world.bodies[*handle].translation();
                if path.last().is_none_or(|last: &Vector| last.y > 0.0) {
                    path.push(position);
                    flying = true;
                }
            }
            if !flying {
                break;
            }
            immersion.step(&mut world);
        }
        Ok(Self { speed, leaves })
    }

    /// Mean distance covered along the wind, m.
    pub fn drift(&self) -> f32 {
        let ends = self.leaves.iter().filter_map(|path| path.last());
        -ends.map(|end| end.x).sum::<f32>() / LEAVES as f32
    }
}

/// The paths from the side, one panel per wind.
pub fn draw(path: &Path, winds: &[Paths]) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::new(path, (1200, 760)).into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.titled(
        "Leaves in gusty wind from the right, from the side: U at 10 m height",
        ("sans-serif", 22),
    )?;
    let reach = winds.iter().flat_map(|wind| &wind.leaves).flatten();
    let reach = reach.fold(1.0f32, |reach, p| reach.max(-p.x)) * 1.03;
    for (area, wind) in root.split_evenly((winds.len(), 1)).iter().zip(winds) {
        let mut chart = ChartBuilder::on(area)
            .margin(10)
            .caption(format!("U = {} m/s", wind.speed), ("sans-serif", 17))
            .x_label_area_size(34)
            .y_label_area_size(50)
            .build_cartesian_2d(-reach..2.0f32, 0.0f32..HEIGHT * 1.05)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .x_desc("x, m")
            .y_desc("height, m")
            .label_style(("sans-serif", 14))
            .draw()?;
        for (i, leaf) in wind.leaves.iter().enumerate() {
            let color = Palette99::pick(i).stroke_width(1);
            let points = leaf.iter().map(|p| (p.x, p.y.max(0.0)));
            chart.draw_series(LineSeries::new(points, color))?;
        }
    }
    root.present()?;
    Ok(())
}
