//! What can be asked for: a place to land, and a sequence of patterns.

use crate::Failure;
use crate::method::Method;
use crate::mover::{Mover, apart, empty, fly, player};
use crate::prepared::Prepared;
use crate::subject::Start;
use crate::support::replay::replayed;
use crate::support::{Vec3, from_rapier, to_rapier};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use rapier3d_immersed::RapierSets;
use rapier3d_immersed::motion::path::MotionPath;
use rapier3d_immersed::motion::{Classifier, Moment, Pattern, Regime, Sketch, Trajectory};
use rapier3d_immersed::rapier3d::prelude::RigidBodyBuilder;
use rapier3d_immersed::training::{FollowParams, Release};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Where to land: so far below the release and aside of it, m, in so many directions.
const DEPTH: f64 = 2.0;
const ASIDE: f64 = 0.3;
const TARGETS: u32 = 6;
/// Falls whose landings are looked through, or that are left to themselves.
const FALLS: u64 = 64;
/// Sequences that are asked for.
const SEQUENCES: u64 = 8;
const DT: f64 = 1.0 / 120.0;

fn target(index: u32) -> Vec3 {
    let angle = TAU * f64::from(index) / f64::from(TARGETS);
    Vec3::new(ASIDE * angle.cos(), -DEPTH, ASIDE * angle.sin())
}

/// Mean distance of the landings from where they were asked for, m. What cannot be steered lands where it
/// lands, the heading of its release at random.
pub fn landing(prepared: &Prepared, method: Method) -> Result<f64, Failure> {
    let errors: Result<Vec<f64>, Failure> = match method {
        Method::Pattern => (0..TARGETS).map(|i| steered(prepared, target(i))).collect(),
        Method::Graph => (0..TARGETS).map(|i| chosen(prepared, target(i))).collect(),
        _ => unsteered(prepared, method),
    };
    let errors = errors?;
    Ok(errors.iter().sum::<f64>() / errors.len() as f64)
}

fn unsteered(prepared: &Prepared, method: Method) -> Result<Vec<f64>, Failure> {
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let starts: Vec<Start> = (0..FALLS)
        .map(|seed| Start {
            place: from_rapier(apart(seed as usize)),
            release: prepared.subject.shaken(&mut random),
            seed,
        })
        .collect();
    let falls = fly(prepared, method, &starts, DT, 6.0, DEPTH)?;
    let landed = falls.iter().filter_map(|fall| {
        let end = fall.moments.iter().find(|m| m.position.y < -DEPTH)?;
        let goal = target(0);
        Some((end.position.x - goal.x).hypot(end.position.z - goal.z))
    });
    Ok(landed.collect())
}

/// The factors are sought with which rapier's own body passes through the target.
fn steered(prepared: &Prepared, target: Vec3) -> Result<f64, Failure> {
    let experiment = prepared.subject.experiment();
    let sketch = Sketch::landing(&experiment, Vec3::zeros(), &[], target)?;
    let collider = prepared.subject.collider();
    let followed = sketch.follow(&experiment, collider, &FollowParams::default())?;
    let last = followed.at_points.last();
    Ok(*last.ok_or("a sketch without points")?)
}

/// Of falls that were drawn, the one that lands as far aside as the target is turned toward it and played.
fn chosen(prepared: &Prepared, target: Vec3) -> Result<f64, Failure> {
    let synthesizer = prepared.synthesizer(DEPTH)?;
    let end = |path: &MotionPath| from_rapier(path.at(path.duration()).position);
    let off = |path: &MotionPath| (end(path).x.hypot(end(path).z) - ASIDE).abs();
    let paths = (0..FALLS).map(|seed| synthesizer.path(seed));
    let best = paths.min_by(|a, b| off(a).total_cmp(&off(b)));
    let path = Arc::new(best.ok_or("no fall was drawn")?);
    // A turn about y by this takes the landing's direction to the target's.
    let angle = |p: &Vec3| p.z.atan2(p.x);
    let release = Release {
        heading: angle(&end(&path)) - angle(&target),
        ..prepared.subject.release
    };
    let start = Start {
        place: Vec3::zeros(),
        release,
        seed: 0,
    };
    let mut scene = empty(prepared, DT);
    let mut mover = Mover::release(prepared, Method::Graph, &mut scene, &[], DEPTH)?;
    let player = player(prepared, path.clone(), &start);
    let pose = player.release(to_rapier(&prepared.subject.kind.dry.center));
    let body = RigidBodyBuilder::dynamic().pose(pose);
    let (handle, _) = scene.world.insert(body, prepared.subject.collider());
    mover.players.play(handle, &player)?;
    for _ in 0..(f64::from(path.duration()) / DT).round() as usize {
        mover
            .players
            .before_step(&mut RapierSets::of(&mut scene.world), None);
        scene.world.step();
    }
    let landed = from_rapier(scene.world.bodies[handle].center_of_mass());
    Ok((landed - target).norm())
}

/// Share of the patterns of a sequence that the direct classifier sees where they were asked for; `None` if none can be.
pub fn sequence(prepared: &Prepared, method: Method) -> Result<Option<f64>, Failure> {
    let mut shown = Vec::new();
    for seed in 1..=SEQUENCES {
        match method {
            Method::Pattern => shown.extend(planned(prepared, seed)?),
            Method::Graph => shown.extend(synthesized(prepared, seed)?),
            _ => return Ok(None),
        }
    }
    let count = shown.iter().filter(|shown| **shown).count();
    Ok(Some(count as f64 / shown.len() as f64))
}

fn planned(prepared: &Prepared, seed: u64) -> Result<Vec<bool>, Failure> {
    let plan = prepared
        .planner
        .plan_sequence(&[Pattern::Zigzag, Pattern::Autorotation], seed)?;
    let replayed = replayed(&prepared.subject.experiment(), &plan.series)?;
    let dwells = replayed.dwells.iter();
    Ok(dwells
        .map(|dwell| Pattern::from(dwell.seen.regime) == dwell.asked)
        .collect())
}

fn synthesized(prepared: &Prepared, seed: u64) -> Result<Vec<bool>, Failure> {
    // High enough for as long dwells as the planner's.
    let synthesizer = prepared.synthesizer(3.0)?;
    let asked = [Regime::PeriodicFlutter, Regime::PeriodicTumbling];
    let path = synthesizer.path_through(&asked, seed)?;
    let steps = (f64::from(path.duration()) / DT) as usize;
    let moments: Vec<Moment> = (0..steps)
        .map(|i| {
            let key = path.at((i as f64 * DT) as f32);
            Moment {
                position: from_rapier(key.position),
                normal: from_rapier(key.attitude * rapier_axis(2)),
                long_axis: from_rapier(key.attitude * rapier_axis(0)),
            }
        })
        .collect();
    let fall = Trajectory {
        interval: DT,
        moments,
    };
    let changes: Vec<usize> = path
        .regimes()
        .iter()
        .map(|(time, _)| (f64::from(*time) / DT) as usize)
        .chain([steps])
        .collect();
    let parts = path.regimes().iter().zip(changes.windows(2));
    Ok(parts
        .map(|((_, regime), ends)| {
            let seen = Classifier::default().observe(&fall.moments[ends[0]..ends[1].min(steps)]);
            seen.regime == *regime
        })
        .collect())
}

fn rapier_axis(axis: usize) -> rapier3d_immersed::rapier3d::math::Vector {
    to_rapier(&Vec3::ith(axis, 1.0))
}
