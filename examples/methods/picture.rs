//! The methods beside each other: stroboscopic pictures to one scale, and films.

use crate::Failure;
use crate::method::Method;
use crate::mover::{Mover, empty, fly};
use crate::prepared::Prepared;
use crate::subject::Start;
use crate::support::picture::{Line, Panel, panels, time_color};
use crate::support::recording::{Recording, RunOptions, run};
use crate::support::scene::Scene;
use crate::support::sheet::Camera;
use crate::support::{Vec3, gif, html};
use plotters::style::RGBColor;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use rapier3d_immersed::motion::{Moment, Pattern, Trajectory};
use rapier3d_immersed::rapier3d::math::{Pose, Vector};
use std::f64::consts::TAU;

/// Height that is shown, m, and the time between two outlines, s.
const HEIGHT: f64 = 1.3;
const BETWEEN: f64 = 1.0 / 15.0;
const DT: f64 = 1.0 / 240.0;

/// One leaf by each method, let go in the same way; the graph-based one begins its fall as it was synthesized.
pub fn strip(prepared: &Prepared) -> Result<String, Failure> {
    // Of the plans, one that begins with what is easily told apart: tumbling.
    let planned = prepared.codebook.series().iter();
    let mut planned = planned.map(|series| series.sequence()[0]);
    let planned = planned.position(|pattern| pattern == Pattern::Autorotation);
    let mut all = Vec::new();
    for method in Method::ALL {
        let start = Start {
            place: Vec3::zeros(),
            release: prepared.subject.release,
            seed: planned.filter(|_| method == Method::Pattern).unwrap_or(0) as u64,
        };
        let fall = fly(prepared, method, &[start], DT, 4.0, HEIGHT)?.swap_remove(0);
        let until = fall.moments.iter().position(|m| m.position.y < -HEIGHT);
        let moments = fall.moments[..until.unwrap_or(fall.moments.len())].to_vec();
        let fall = Trajectory { moments, ..fall };
        let asked = match (method, planned) {
            (Method::Pattern, Some(_)) => ": to tumble",
            _ => "",
        };
        let title = format!("{}{asked}, {:.1} s", method.name(), fall.duration());
        all.push((title, fall));
    }
    let drawn: Vec<Vec<Line>> = all
        .iter()
        .map(|(_, fall)| outlines(fall, prepared))
        .collect();
    let half = |lines: &Vec<Line>| {
        let points = lines.iter().flat_map(|line| &line.points);
        points.map(|p| p.0.abs()).fold(0.0, f64::max)
    };
    let widest = drawn.iter().map(half).fold(0.0, f64::max) + 0.03;
    let pictures: Vec<Panel> = all
        .iter()
        .zip(drawn)
        .map(|((title, _), lines)| Panel {
            title,
            axes: ["m", "height, m"],
            lines,
            dots: Vec::new(),
            window: Some([(-widest, widest), (-HEIGHT - 0.05, 0.08)]),
        })
        .collect();
    let title = "A leaf of 7.3 × 4.2 cm by each method, from the side of its drift, every 1/15 s (blue to yellow)";
    let height = 640.0;
    let width = 90.0 + (height - 130.0) * 2.0 * widest / (HEIGHT + 0.13);
    Ok(panels(title, &pictures, 6, (width as u32, height as u32))?)
}

/// Outlines of an ellipse on a way whose middle is at zero, seen across the direction in which it goes farthest.
fn outlines(fall: &Trajectory, prepared: &Prepared) -> Vec<Line> {
    let extents = prepared.subject.kind.body.hydro.planform.half_extents;
    let along = direction(&fall.moments);
    let side = |p: &Vec3| p.dot(&along);
    let ends = fall.moments.iter().map(|m| side(&m.position));
    let (low, high) = ends.fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
    let view = |p: &Vec3| (side(p) - 0.5 * (low + high), p.y);
    let mut lines = vec![Line {
        points: fall.moments.iter().map(|m| view(&m.position)).collect(),
        color: RGBColor(190, 190, 190),
        width: 1,
    }];
    let every = (BETWEEN / fall.interval).round() as usize;
    let last = fall.moments.len() as f64;
    for (i, moment) in fall.moments.iter().enumerate().step_by(every) {
        let across = moment.normal.cross(&moment.long_axis);
        let point = |k: i32| {
            let (sine, cosine) = (TAU * f64::from(k) / 32.0).sin_cos();
            let out = moment.long_axis * (extents.x * cosine) + across * (extents.y * sine);
            view(&(moment.position + out))
        };
        lines.push(Line {
            points: (0..=32).map(point).collect(),
            color: time_color(i as f64 / last),
            width: 2,
        });
    }
    lines
}

/// The horizontal direction in which the positions scatter most.
fn direction(moments: &[Moment]) -> Vec3 {
    let mean = moments.iter().map(|m| m.position).sum::<Vec3>() / moments.len() as f64;
    let (mut xx, mut xz, mut zz) = (0.0, 0.0, 0.0);
    for moment in moments {
        let d = moment.position - mean;
        (xx, xz, zz) = (xx + d.x * d.x, xz + d.x * d.z, zz + d.z * d.z);
    }
    let angle = 0.5 * (2.0 * xz).atan2(xx - zz);
    Vec3::new(angle.cos(), 0.0, angle.sin())
}

/// A floor.
pub fn add_floor(scene: &mut Scene) {
    let floor = Pose::from_translation(Vector::new(0.0, -0.05, 0.0));
    scene.add_box(floor, [3.0, 0.1, 3.0], [0.62, 0.58, 0.50]);
}

/// Nine leaves over a floor.
pub fn filmed(prepared: &Prepared, method: Method) -> Result<(Scene, Recording), Failure> {
    let mut random = Pcg64Mcg::seed_from_u64(11);
    let starts: Vec<Start> = (0..9)
        .map(|i| Start {
            place: Vec3::new(
                0.16 * (i % 3 - 1) as f64,
                0.75 + 0.05 * ((i * 4) % 9) as f64,
                0.16 * (i / 3 - 1) as f64,
            ),
            release: prepared.subject.shaken(&mut random),
            seed: i as u64,
        })
        .collect();
    let mut scene = empty(prepared, DT);
    add_floor(&mut scene);
    // Paths that go on below the floor: at its contact each leaf is handed over.
    let mut mover = Mover::release(prepared, method, &mut scene, &starts, 2.2)?;
    let options = RunOptions {
        seconds: 2.6,
        frame_rate: 30.0,
        forces: false,
        message: method.name(),
    };
    let recording = run(&mut scene, &options, &mut mover);
    Ok((scene, recording))
}

/// The films side by side, as a page and as a GIF; and each of them alone from the same place.
pub struct Films {
    pub page: String,
    pub gif: Vec<u8>,
    pub each: Vec<(Method, Vec<u8>)>,
}

pub fn films(prepared: &Prepared) -> Result<Films, Failure> {
    let films: Result<Vec<_>, Failure> = Method::ALL
        .into_iter()
        .map(|method| filmed(prepared, method))
        .collect();
    let mut films = films?;
    // Nearer than all of them would need, because leaves are small: some leave the picture when they are down.
    let camera = Camera {
        eye: Vec3::new(0.55, 0.75, 1.9),
        target: Vec3::new(0.0, 0.5, 0.0),
        field_of_view: 0.66,
    };
    let runs: Vec<_> = films.iter().map(|(scene, run)| (scene, run)).collect();
    let gif = gif::side_by_side(&runs, &camera, 15.0)?;
    // On the page all runs share the colours of their leaves, and nobody is to guess a method from them.
    let colors = [[0.75, 0.30, 0.05], [0.60, 0.45, 0.05], [0.25, 0.40, 0.08]];
    let mut each = Vec::new();
    for (method, (scene, recording)) in Method::ALL.into_iter().zip(&mut films) {
        for (i, color) in scene.colors.iter_mut().enumerate() {
            *color = colors[i % 3];
        }
        let film = gif::side_by_side(&[(scene, recording)], &camera, 15.0)?;
        each.push((method, film));
    }
    let scene = &films[0].0;
    let named: Vec<(&str, &Recording)> = Method::ALL
        .into_iter()
        .zip(&films)
        .map(|(method, (_, run))| (method.name(), run))
        .collect();
    let page = html::page("Leaves by each method", scene, &named);
    Ok(Films { page, gif, each })
}
