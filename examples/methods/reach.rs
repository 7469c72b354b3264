//! How far a method reaches: other shapes, and bodies that are joined.

use crate::Failure;
use crate::method::Method;
use crate::mover::{Mover, empty};
use crate::prepared::Prepared;
use crate::subject::{GRAVITY, Start, shapes};
use crate::support::recording::Stepper;
use crate::support::scene::pose_parts;
use crate::support::{Vec3, to_rapier};
use rapier3d_immersed::motion::path::{SynthesisParams, Synthesizer, TrajectoryDatabase};
use rapier3d_immersed::motion::{Classifier, DimensionlessNumbers, Pattern};
use rapier3d_immersed::rapier3d::geometry::SharedShape;
use rapier3d_immersed::rapier3d::prelude::SphericalJointBuilder;
use rapier3d_immersed::reduced::CrossParams;
use rapier3d_immersed::training::{BodyInWorld, BodyState, Experiment, Grid, Release, Sweep};
use rapier3d_immersed::{
    DryMass, Fluid, HydroProperties, ImmersedBody, OnContact, Part, SeparatedLaw, StochasticLaw,
    ViscousLaw,
};
use std::ops::ControlFlow;

/// kg/m³ of the shapes.
const DENSITY: f64 = 300.0;
const DT: f64 = 1.0 / 120.0;

/// The shapes that a method cannot take, and why.
pub fn refused(method: Method) -> Vec<(&'static str, String)> {
    let tried = shapes().into_iter().filter_map(|(name, shape)| {
        let problem = takes(method, &shape).err()?;
        Some((name, problem.to_string()))
    });
    tried.collect()
}

/// Number of shapes that are tried.
pub fn tried() -> usize {
    shapes().len()
}

fn takes(method: Method, shape: &SharedShape) -> Result<(), Failure> {
    if method == Method::Plain {
        return Ok(());
    }
    let hydro = HydroProperties::from_shape(shape.as_ref())?;
    let dry = DryMass::of_shape(shape.as_ref(), DENSITY)?;
    let body = ImmersedBody::new(hydro.clone());
    match method {
        Method::Plain | Method::Law => falls(body, &dry),
        Method::Stochastic => {
            let law = ViscousLaw::Stochastic(StochasticLaw::default());
            falls(body.with_law(law)?, &dry)
        }
        Method::Graph => {
            let numbers = DimensionlessNumbers::of(&hydro, &dry, &Fluid::AIR, GRAVITY)?;
            let length = 2.0 * hydro.planform.half_extents.x;
            let (database, params) = (TrajectoryDatabase::shipped(), SynthesisParams::default());
            Synthesizer::new(&numbers, length, database, params)?.path(1);
            Ok(())
        }
        Method::Pattern => {
            let experiment = Experiment {
                seconds: 2.0,
                ..Experiment::new(body, dry, Fluid::AIR)
            };
            let mut sweep = Sweep::new(Grid::of_coefficients(3, 3.0)?);
            let classifier = Classifier::default();
            sweep.run_coefficients(&experiment, &classifier, |_, _| ControlFlow::Continue(()))?;
            let mut seen: Vec<Pattern> = sweep.patterns()?;
            seen.sort_by_key(|pattern| pattern.index());
            seen.dedup();
            match seen.len() {
                0 | 1 => Err("one pattern for all factors: nothing to plan".into()),
                _ => Ok(()),
            }
        }
        Method::Reduced => {
            let params = CrossParams {
                tolerance: 1e-3,
                max_rank: 12,
                max_evaluations: 100_000,
                rank_growth: 4,
                ..CrossParams::default()
            };
            let law = ViscousLaw::default();
            let (separated, _) = SeparatedLaw::bake(&hydro, law, [1e2, 1e5], &params)?;
            let error = separated.error()[0];
            if error > 0.5 {
                return Err(format!("error {error:.2} of the force at rank 12").into());
            }
            let part = Part::new(hydro).with_law(separated);
            falls(body.with_parts([part]), &dry)
        }
    }
}

/// For a second, to a finite state.
fn falls(body: ImmersedBody, dry: &DryMass) -> Result<(), Failure> {
    let release = BodyState::default();
    let mut world = BodyInWorld::new(body, dry, Fluid::AIR, &release, DT, GRAVITY)?;
    for _ in 0..120 {
        world.step();
    }
    match world.state() {
        state if state.is_finite() && state.position.y < 0.0 => Ok(()),
        state => Err(format!("after a second it is at {}", state.position).into()),
    }
}

/// Two of the bodies with their ends joined fall for two seconds: the largest distance between the ends, m.
pub fn joined(prepared: &Prepared, method: Method) -> Result<f64, Failure> {
    let subject = &prepared.subject;
    let end = 0.5 * subject.length;
    let release = Release {
        spin: Vec3::zeros(),
        ..subject.release
    };
    let turn = release.orientation(&subject.kind.body.hydro);
    let start = |place| Start {
        place,
        release,
        seed: 0,
    };
    let starts = [
        start(Vec3::zeros()),
        start(turn * Vec3::x() * subject.length),
    ];
    let mut scene = empty(prepared, DT);
    let mut mover = Mover::release(prepared, method, &mut scene, &starts, 4.0)?;
    let [a, b] = [0, 1].map(|i| scene.pieces[i].handle);
    let anchors = [end, -end].map(|x| to_rapier(&(Vec3::x() * x)));
    let joint = SphericalJointBuilder::new()
        .local_anchor1(anchors[0])
        .local_anchor2(anchors[1])
        .contacts_enabled(false);
    scene.world.insert_impulse_joint(a, b, joint);
    // The second one plays no fall of its own: the joint takes it along.
    mover.players.stop(b, mover.immersion.as_mut());
    // What a joint holds replays only if it is told to ignore that.
    if let (Method::Pattern, Some(immersion)) = (method, &mut mover.immersion) {
        let series = &prepared.codebook.series()[0];
        for handle in [a, b] {
            immersion.replay(handle, series, OnContact::Ignore);
        }
    }
    let mut largest = 0.0_f64;
    for step in 0..240 {
        mover.step(&mut scene.world);
        let [p, q] = [(a, end), (b, -end)].map(|(handle, x)| {
            let (place, turn) = pose_parts(scene.world.bodies[handle].position());
            place + turn * (Vec3::x() * x)
        });
        let gap = (p - q).norm();
        if !gap.is_finite() {
            return Ok(f64::NAN);
        }
        // A graph-based fall begins in an attitude of its own, which the joint first has to pull together.
        if step >= 60 {
            largest = largest.max(gap);
        }
    }
    Ok(largest)
}
