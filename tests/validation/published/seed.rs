//! A maple seed: a body that is neither flat nor even, and spins.

use super::draw::{self, Item, Panel, Point};
use super::report::Row;
use super::samara::{as_one_plate, samara};
use super::{Computed, Effort, Failure, Progress};
use super::{Quat, Vec3};
use plotters::style::RGBColor;
use rapier3d_immersed::training::{BodyInWorld, BodyState};
use rapier3d_immersed::{DryMass, Error, Fluid, FreeBody, ImmersedBody};
use std::f64::consts::{FRAC_PI_2, PI};

const GRAVITY: Vec3 = Vec3::new(0.0, -9.81, 0.0);
const SECONDS: f64 = 5.0;
const SOURCE: &str = "Acer palmatum (Lee, Lee & Sohn 2014)";
/// Its descent, m/s, and spin, rad/s, and the error that ours may have.
const MEASURED: [f64; 2] = [1.2, 131.0];
const BAR: f64 = 0.15;

/// Sixteen ways to let go of it, by turns: about as it hangs from the tree, the nut at the stalk and the wing down; and all
/// over the orientations that there are.
fn release(index: usize) -> Quat {
    let index = index as f64;
    if index % 2.0 == 0.0 {
        let angle = index * PI / 8.0;
        Quat::from_euler_angles(0.3 * angle.cos(), 0.3 * angle.sin(), -FRAC_PI_2)
    } else {
        Quat::from_euler_angles(2.4 * index, (index / 8.0 - 1.0).asin(), 3.9 * index)
    }
}

/// Mean descent, m/s, and spin about the vertical, rad/s, over the last quarter.
fn late(states: &[(f64, f64)]) -> [f64; 2] {
    let last = &states[states.len() * 3 / 4..];
    let spin = last.iter().map(|s| s.1).sum::<f64>() / last.len() as f64;
    let steps = (last.len() - 1) as f64;
    let time = SECONDS * steps / states.len() as f64;
    [(last[0].0 - last[last.len() - 1].0) / time, spin.abs()]
}

/// After every step: height of the center of mass, m, and spin about the vertical, rad/s.
fn alone(
    (body, mass): (ImmersedBody, DryMass),
    index: usize,
    dt: f64,
) -> Result<Vec<(f64, f64)>, Error> {
    let mut seed = FreeBody::new(&body, &mass, &Fluid::AIR)?;
    seed.set_orientation(release(index));
    let step = |_| {
        seed.step(dt, GRAVITY);
        (seed.position.y, seed.angular_velocity().y)
    };
    Ok((0..(SECONDS / dt).round() as usize).map(step).collect())
}

fn in_rapier(index: usize, dt: f64) -> Result<Vec<(f64, f64)>, Error> {
    let (body, mass) = samara()?;
    let release = BodyState {
        orientation: release(index),
        ..BodyState::default()
    };
    let mut seed = BodyInWorld::new(body, &mass, Fluid::AIR, &release, dt, -GRAVITY.y)?;
    let step = |_| {
        seed.step();
        let state = seed.state();
        (state.position.y, state.spin.y)
    };
    Ok((0..(SECONDS / dt).round() as usize).map(step).collect())
}

pub fn compute(effort: Effort, progress: Progress) -> Result<Computed, Failure> {
    const WAYS: [&str; 4] = [
        "stand-alone, 1/1920 s",
        "rapier, 1/240 s",
        "rapier, 1/60 s",
        "as one plate, stand-alone, 1/1920 s",
    ];
    let releases = effort.choose(16, 4);
    let mut rows = Vec::new();
    for (part, name) in WAYS.into_iter().enumerate() {
        let mut spinning = Vec::new();
        for index in 0..releases {
            let states = match part {
                0 => alone(samara()?, index, 1.0 / 1920.0)?,
                1 => in_rapier(index, 1.0 / 240.0)?,
                2 => in_rapier(index, 1.0 / 60.0)?,
                _ => alone(as_one_plate()?, index, 1.0 / 1920.0)?,
            };
            let [descent, spin] = late(&states);
            if spin > 50.0 {
                spinning.push([descent, spin]);
            }
            progress((part * releases + index + 1) as f64 / (WAYS.len() * releases) as f64);
        }
        let share = spinning.len() as f64 / releases as f64;
        let case = format!("maple seed: releases that end in a spin, {name}");
        rows.push(Row::share(case, share, 0.9, "a samara always does"));
        let mean = |k: usize| {
            let count = spinning.len();
            let sum: f64 = spinning.iter().map(|s: &[f64; 2]| s[k]).sum();
            (count > 0).then(|| sum / count as f64)
        };
        let case = |what: &str| format!("maple seed: {what}, {name}");
        let compared = |what: &str, unit: &'static str, k: usize| {
            let ours = mean(k).unwrap_or(f64::NAN);
            Row::number(case(what), [MEASURED[k], ours], unit, Some(BAR), SOURCE)
        };
        rows.push(compared("descent", "m/s", 0));
        rows.push(compared("spin", "rad/s", 1));
    }
    Ok((rows, vec![("seed.svg".into(), picture()?)]))
}

fn picture() -> Result<String, Failure> {
    const GREY: RGBColor = RGBColor(170, 170, 170);
    const BLUE: RGBColor = RGBColor(30, 60, 150);
    const BROWN: RGBColor = RGBColor(140, 90, 40);
    const RED: RGBColor = RGBColor(211, 47, 47);
    let (body, mass) = samara()?;
    let mut seed = FreeBody::new(&body, &mass, &Fluid::AIR)?;
    seed.set_orientation(release(1));
    let mut path = Panel::new("from 0.4 to 0.8 s: wing every 1/240 s, nut", "cm", "cm").equal();
    let (mut tips, mut nuts) = (Vec::new(), Vec::new());
    let (mut descent, mut spin): (Vec<Point>, Vec<Point>) = Default::default();
    // Seen from a little above.
    let flat = |p: Vec3| (100.0 * p.x, 100.0 * (p.y + 0.25 * p.z));
    for step in 0..1440 {
        let at = |x: f64| seed.position + seed.orientation() * (Vec3::x() * x - mass.center);
        let (nut, tip) = (flat(at(0.0)), flat(at(0.034)));
        let time = f64::from(step) / 480.0;
        if (192..384).contains(&step) {
            tips.push(tip);
            if step % 2 == 0 {
                path.items.push(Item::Line(vec![nut, tip], BLUE, 1));
                nuts.push(nut);
            }
        }
        descent.push((time, -seed.linear_velocity().y));
        spin.push((time, seed.angular_velocity().y.abs()));
        seed.step(1.0 / 480.0, GRAVITY);
    }
    path.items.insert(0, Item::Line(tips, GREY, 1));
    path.items.push(Item::Dots(nuts, BROWN, 2));
    let mut speed = Panel::new("descent", "time, s", "m/s");
    speed.items.push(Item::Line(descent, RED, 2));
    let mut rate = Panel::new("spin about the vertical", "time, s", "rad/s");
    rate.items.push(Item::Line(spin, BLUE, 2));
    let title = "A maple seed of 0.14 g, let go as it hangs, wing down: it turns over and spins";
    draw::svg(title, &[path, speed, rate], 3, (400, 620))
}
