//! A leaf that replays a plan in a rapier world, watched.

use rapier3d_immersed::motion::{Classifier, ControlSeries, Moment, Observation, Pattern};
use rapier3d_immersed::training::{BodyInWorld, BodyState, Experiment};
use rapier3d_immersed::{Error, OnContact};

/// A pattern that was planned, between which times, s, and what the leaf did then.
pub struct Dwell {
    pub asked: Pattern,
    pub from: f64,
    pub to: f64,
    pub seen: Observation,
}

/// What the leaf did, and its state at the end.
pub struct Replayed {
    pub dwells: Vec<Dwell>,
    pub end: BodyState,
}

/// Lets the leaf of an experiment replay a series.
///
/// # Errors
/// Those of [`BodyInWorld::new`].
pub fn replayed(leaf: &Experiment, series: &ControlSeries) -> Result<Replayed, Error> {
    // A world of its own here; in yours, `immersion.replay` is the one line.
    let (body, release) = (leaf.body.clone(), leaf.release_state());
    let (dt, gravity) = (leaf.dt, leaf.gravity);
    let mut world = BodyInWorld::new(body, &leaf.mass, leaf.fluid, &release, dt, gravity)?;
    let handle = world.handle;
    world.immersion.replay(handle, series, OnContact::Restart);
    let steps = (series.duration() / dt).round() as usize;
    let moments: Vec<Moment> = (0..steps)
        .map(|_| {
            world.step();
            world.state().moment(&leaf.body.hydro)
        })
        .collect();
    let dwells = series.dwell_times().into_iter();
    let dwells = dwells.map(|(asked, from, to)| {
        let [first, last] = [from, to].map(|time| (time / dt).round() as usize);
        Dwell {
            asked,
            from,
            to,
            seen: Classifier::default().observe(&moments[first..last.min(steps)]),
        }
    });
    Ok(Replayed {
        dwells: dwells.collect(),
        end: world.state(),
    })
}
