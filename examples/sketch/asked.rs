//! What each leaf is asked to do.

use crate::options::Options;
use crate::stage::Stage;
use crate::support::{Vec3, cli};
use crate::svg;
use rapier3d_immersed::Error;
use rapier3d_immersed::motion::{Classifier, ControlSeries, MotionGraph, Sketch};
use rapier3d_immersed::training::{
    BodyState, Experiment, Grid, Planner, PlannerParams, Subspaces, Sweep,
};
use std::ops::ControlFlow;
use std::path::Path;

/// Time between the points that a drawn line is followed through, s.
const SPACING: f64 = 0.1;
/// Height of the start, m.
const HEIGHT: f64 = 2.0;
/// Factors per axis that are tried to learn which make which pattern.
const NODES: usize = 6;

/// A path, and with what it is flown if that is known before.
pub struct Asked {
    pub sketch: Sketch,
    pub known: Option<(BodyState, ControlSeries)>,
}

/// What the command line asks for, leaf by leaf. A bad request ends the program.
pub fn asked(options: &Options, stage: &Stage) -> Vec<Asked> {
    let least = options.land.len().max(1) as u32;
    options.count.check(1..=200);
    let count = options.count.count.unwrap_or(least);
    let shift = |index: u32| options.spread * (f64::from(index) - 0.5 * f64::from(count - 1));
    let follow = |sketch| Asked {
        sketch,
        known: None,
    };
    if !options.patterns.is_empty() {
        let planned = patterns(options, stage, count, shift);
        return planned.unwrap_or_else(|problem| cli::bad_value("--patterns", problem));
    }
    if let Some(path) = &options.sketch {
        let drawn = read(path, options, &stage.experiment);
        let drawn = drawn.unwrap_or_else(|problem| {
            cli::bad_value("--sketch", format!("{}: {problem}", path.display()))
        });
        return (0..count)
            .map(|index| {
                let points = drawn.points().iter().map(|(t, p)| (*t, p + shift(index)));
                follow(Sketch::new(points.collect()).expect("the times are those of a sketch"))
            })
            .collect();
    }
    let height = options.height.unwrap_or(HEIGHT);
    let places = match &options.land[..] {
        [] => &[[0.4, 0.2]],
        places => places,
    };
    (0..count)
        .map(|index| {
            let [x, z] = places[index as usize % places.len()];
            let start = shift(index) + Vec3::y() * height;
            let end = Vec3::new(x, 0.0, z);
            let sketch = Sketch::landing(&stage.experiment, start, &options.pass, end);
            follow(sketch.unwrap_or_else(|problem| cli::bad_value("--land/--pass", problem)))
        })
        .collect()
}

/// A sketch from a file.
fn read(path: &Path, options: &Options, leaf: &Experiment) -> Result<Sketch, String> {
    let text = std::fs::read_to_string(path).map_err(|problem| problem.to_string())?;
    let is_table = path
        .extension()
        .is_some_and(|kind| kind.eq_ignore_ascii_case("csv"));
    if is_table {
        return Sketch::from_csv(&text).map_err(|problem| problem.to_string());
    }
    let line = svg::points(&svg::path_data(&text)?)?;
    let (first, last) = (line[0], line[line.len() - 1]);
    let descent = last[1] - first[1];
    if descent <= 0.0 {
        return Err("the path ends no lower than it begins".into());
    }
    // The drawing's height is the fall's.
    let height = options.height.unwrap_or(HEIGHT);
    let unit = height / descent;
    let place = |[x, y]: svg::Point| Vec3::new((x - first[0]) * unit, (last[1] - y) * unit, 0.0);
    let line: Vec<Vec3> = line.into_iter().map(place).collect();
    let pace = || Sketch::landing(leaf, Vec3::y() * height, &[], Vec3::zeros());
    let seconds = match options.pace {
        Some(seconds) => seconds,
        None => pace().map_err(|problem| problem.to_string())?.duration(),
    };
    at_equal_times(&line, seconds).map_err(|problem| problem.to_string())
}

/// A line that is followed at a constant speed.
fn at_equal_times(line: &[Vec3], seconds: f64) -> Result<Sketch, Error> {
    let mut ways = vec![0.0];
    for pair in line.windows(2) {
        ways.push(ways[ways.len() - 1] + (pair[1] - pair[0]).norm());
    }
    let whole = ways[ways.len() - 1];
    let count = (seconds / SPACING).ceil().max(1.0);
    let points = (0..=count as usize).map(|index| {
        let share = index as f64 / count;
        let way = share * whole;
        let i = ways.partition_point(|w| *w < way).clamp(1, line.len() - 1);
        let piece = (ways[i] - ways[i - 1]).max(1e-12);
        (
            share * seconds,
            line[i - 1].lerp(&line[i], (way - ways[i - 1]) / piece),
        )
    });
    Sketch::new(points.collect())
}

/// Plans for a leaf that falls in a series of patterns, each from a seed of its own.
fn patterns(
    options: &Options,
    stage: &Stage,
    count: u32,
    shift: impl Fn(u32) -> Vec3,
) -> Result<Vec<Asked>, Error> {
    let leaf = &stage.experiment;
    let mut sweep = Sweep::new(Grid::of_coefficients(NODES, 3.0)?);
    let classifier = Classifier::default();
    sweep.run_coefficients(leaf, &classifier, |_, _| ControlFlow::Continue(()))?;
    let subspaces = Subspaces::new(sweep.grid().clone(), sweep.patterns()?)?;
    let graph = MotionGraph::thesis();
    let planner = Planner::new(leaf.clone(), subspaces, &graph, PlannerParams::default())?;
    (0..count)
        .map(|index| {
            let plan =
                planner.plan_sequence(&options.patterns, options.seed.value + u64::from(index))?;
            let depth = plan.fall.moments.iter().map(|m| -m.position.y);
            let depth = depth.fold(0.1, f64::max);
            let start = shift(index) + Vec3::y() * options.height.unwrap_or(depth);
            // The planned fall, down to the floor.
            let every = (0.05 / plan.fall.interval).round().max(1.0) as usize;
            let moments = plan.fall.moments.iter().enumerate().step_by(every);
            let points: Vec<(f64, Vec3)> = moments
                .map(|(i, moment)| (i as f64 * plan.fall.interval, start + moment.position))
                .take_while(|(_, place)| place.y > 0.0)
                .collect();
            let mut release = leaf.release_state();
            release.position = start;
            Ok(Asked {
                sketch: Sketch::new(points)?,
                known: Some((release, plan.series)),
            })
        })
        .collect()
}
