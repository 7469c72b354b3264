//! Leaves in rapier, driven by a reduced model of the default law (thesis §7.3) beside the law itself.

use crate::Outcome;
use crate::chart::{COLORS, Mark, Panel, SeriesLabelPosition, draw};
use indicatif::ProgressBar;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::reduced::CrossParams;
use rapier3d_immersed::{
    Fluid, HydroProperties, ImmersedBody, Immersion, Part, SeparatedLaw, ViscousLaw,
};
use std::error::Error;
use std::path::Path;
use std::time::Instant;

/// The leaf of thesis Fig. 5.14, 7.3 × 4.2 cm × 0.3 mm, as a rectangle of paper.
const HALF: Vector = Vector::new(0.0365, 0.00015, 0.021);
const DENSITY: f32 = 300.0;
const LEAVES: usize = 64;
const STEPS: usize = 360;
const RATE: f32 = 120.0;
/// VL/ν of 0.04 m/s to 8 m/s.
const REYNOLDS_NUMBERS: [f64; 2] = [100.0, 20_000.0];

/// Positions of all leaves after each step, and the nanoseconds of a step of one.
struct Fall {
    positions: Vec<Vec<Vector>>,
    nanoseconds: f64,
}

/// Leaves a hundred meters apart, each tilted its own way; `None` leaves them to rapier.
fn fall(body: Option<ImmersedBody>, turned: f32) -> Result<Fall, Box<dyn Error>> {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1.0 / RATE;
    let mut immersion = Immersion::new(Fluid::AIR);
    let mut leaves = Vec::new();
    for i in 0..LEAVES {
        let share = i as f32 / LEAVES as f32;
        let tilt = Vector::new(0.1 + 0.6 * share + turned, 0.0, 0.4 * (7.0 * share).sin());
        let leaf = RigidBodyBuilder::dynamic()
            .translation(Vector::X * (100.0 * i as f32))
            .rotation(tilt);
        let collider = ColliderBuilder::cuboid(HALF.x, HALF.y, HALF.z).density(DENSITY);
        let (leaf, _) = world.insert(leaf, collider);
        if let Some(body) = &body {
            immersion.insert(leaf, body.clone());
        }
        leaves.push(leaf);
    }
    let mut positions = Vec::with_capacity(STEPS);
    let mut seconds = 0.0;
    for _ in 0..STEPS {
        let clock = Instant::now();
        immersion.step(&mut world);
        seconds += clock.elapsed().as_secs_f64();
        let place = |(i, leaf): (usize, &RigidBodyHandle)| {
            world.bodies[*leaf].translation() - Vector::X * (100.0 * i as f32)
        };
        positions.push(leaves.iter().enumerate().map(place).collect());
    }
    Ok(Fall {
        positions,
        nanoseconds: seconds * 1e9 / (STEPS * LEAVES) as f64,
    })
}

impl Fall {
    /// Mean descent, m/s, and mean horizontal way, m, at the end.
    fn means(&self) -> [f64; 2] {
        let last = &self.positions[STEPS - 1];
        let mean = |of: fn(&Vector) -> f32| {
            last.iter().map(|x| f64::from(of(x))).sum::<f64>() / LEAVES as f64
        };
        let seconds = STEPS as f64 / f64::from(RATE);
        [mean(|x| -x.y) / seconds, mean(|x| x.x.hypot(x.z))]
    }

    /// Root mean square distance of the leaves to those of another fall, over time.
    fn apart(&self, other: &Self) -> Vec<(f64, f64)> {
        let both = self.positions.iter().zip(&other.positions).enumerate();
        both.map(|(step, (a, b))| {
            let squares = a.iter().zip(b).map(|(a, b)| (*a - *b).length_squared());
            let mean = squares.map(f64::from).sum::<f64>() / LEAVES as f64;
            ((step + 1) as f64 / f64::from(RATE), mean.sqrt())
        })
        .filter(|(_, distance)| *distance > 1e-7)
        .collect()
    }

    /// Way along x and height of one leaf.
    fn path(&self, leaf: usize) -> Vec<(f64, f64)> {
        let at = |all: &Vec<Vector>| (f64::from(all[leaf].z), f64::from(all[leaf].y));
        self.positions.iter().map(at).collect()
    }
}

pub fn driven(path: &Path, bar: &ProgressBar) -> Outcome {
    let shape = Cuboid::new(HALF);
    let hydro = HydroProperties::from_shape(&shape)?;
    let law = ViscousLaw::default();
    let full = fall(Some(ImmersedBody::new(hydro.clone())), 0.0)?;
    let nudged = fall(Some(ImmersedBody::new(hydro.clone())), 1e-3)?;
    let alone = fall(None, 0.0)?;
    let mut numbers = serde_json::Map::new();
    let row = |fall: &Fall| {
        let [descent, way] = fall.means();
        serde_json::json!({ "ns_per_body_step": fall.nanoseconds, "descent": descent, "way": way })
    };
    numbers.insert("rapier alone".into(), row(&alone));
    numbers.insert("default law".into(), row(&full));
    numbers.insert("default law, tilted by 1e-3 more".into(), row(&nudged));
    let mut paths = Panel::new(
        "three leaves (lines: the law, dots: rank 32)",
        "z, m",
        "y, m",
    );
    let mut distances = Panel::new(
        "distance to the law's leaf",
        "t, s",
        "rms over 64 leaves, m",
    );
    distances.log_y = true;
    for (rank, color) in [
        (8, COLORS[3]),
        (16, COLORS[4]),
        (32, COLORS[0]),
        (60, COLORS[1]),
    ] {
        bar.set_message(format!("driven, rank {rank}"));
        let params = CrossParams {
            tolerance: 1e-3,
            max_rank: rank,
            max_evaluations: 1_000_000,
            rank_growth: 4,
            ..CrossParams::default()
        };
        let clock = Instant::now();
        let (separated, _) = SeparatedLaw::bake(&hydro, law, REYNOLDS_NUMBERS, &params)?;
        let seconds = clock.elapsed().as_secs_f64();
        let [rms, worst] = separated.error();
        let part = Part::new(hydro.clone()).with_law(separated.clone());
        let body = ImmersedBody::new(hydro.clone()).with_parts([part]);
        let driven = fall(Some(body), 0.0)?;
        let mut numbers_of = row(&driven);
        numbers_of["bake_seconds"] = seconds.into();
        numbers_of["error_rms"] = rms.into();
        numbers_of["error_worst"] = worst.into();
        numbers_of["ranks"] = separated.forces().train().ranks().into();
        numbers.insert(format!("separated, rank {rank}"), numbers_of);
        let label = format!("rank {rank}");
        distances.add(&label, color, Mark::Line, driven.apart(&full));
        if rank == 32 {
            for (i, leaf) in [3, 30, 60].into_iter().enumerate() {
                paths.add("", COLORS[i], Mark::Line, full.path(leaf));
                let every = driven.path(leaf).into_iter().step_by(12).collect();
                paths.add("", COLORS[i], Mark::Dots, every);
            }
        }
    }
    let label = "the law, tilted by 0.001 rad more";
    distances.add(label, COLORS[5], Mark::Line, nudged.apart(&full));
    distances.legend = Some(SeriesLabelPosition::LowerRight);
    draw(path, 2, &[paths, distances])?;
    Ok(numbers.into())
}
