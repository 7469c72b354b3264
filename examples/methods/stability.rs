//! A thousand wild falls with a coarse step: does anything blow up?

use crate::Failure;
use crate::method::Method;
use crate::mover::{Mover, apart, empty};
use crate::prepared::Prepared;
use crate::subject::{GRAVITY, Start};
use crate::support::recording::Stepper;
use crate::support::scene::pose_parts;
use crate::support::{Vec3, from_rapier};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use rapier3d_immersed::FreeBody;
use rapier3d_immersed::rapier3d::prelude::RigidBody;
use serde_json::{Value, json};

const FALLS: usize = 1000;
const STEPS: usize = 90;
const DT: f64 = 1.0 / 30.0;

/// How the falls of one method went.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stability {
    /// Falls with a number that is none.
    pub broken: usize,
    /// Falls that at some time had more than 5 % more kinetic energy than they began with and gravity gave.
    pub gaining: usize,
    /// The largest kinetic energy over what there was to have.
    pub worst: f64,
}

impl Stability {
    pub fn json(&self) -> Value {
        json!({
            "falls": FALLS,
            "not_finite": self.broken,
            "gain_energy": self.gaining,
            "largest_energy_ratio": self.worst,
        })
    }

    /// Falls that went wrong in either way.
    pub fn count(&self) -> usize {
        self.broken + self.gaining
    }
}

/// Of the body alone, J.
fn kinetic_energy(prepared: &Prepared, body: &RigidBody) -> f64 {
    let dry = &prepared.subject.kind.dry;
    let (_, turn) = pose_parts(body.position());
    let (v, w) = (from_rapier(body.linvel()), from_rapier(body.angvel()));
    let spin: Vec3 = turn.inverse() * w;
    0.5 * (dry.mass * v.norm_squared() + spin.dot(&(dry.inertia * spin)))
}

/// Of body and fluid at the release, J.
fn released(prepared: &Prepared, method: Method, start: &Start) -> Result<f64, Failure> {
    let subject = &prepared.subject;
    let mut body = FreeBody::new(&prepared.body(method)?, &subject.kind.dry, &subject.fluid)?;
    body.set_orientation(start.release.orientation(&subject.kind.body.hydro));
    body.set_velocity(start.release.velocity, start.release.spin);
    Ok(body.kinetic_energy())
}

/// Any attitude, any velocity, three seconds.
pub fn stability(prepared: &Prepared, method: Method) -> Result<Stability, Failure> {
    let subject = &prepared.subject;
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let starts: Vec<Start> = (0..FALLS)
        .map(|i| Start {
            place: from_rapier(apart(i)),
            release: subject.wild(&mut random),
            seed: i as u64,
        })
        .collect();
    let mut scene = empty(prepared, DT);
    let mut mover = Mover::release(prepared, method, &mut scene, &starts, 4.0)?;
    let dry = &subject.kind.dry;
    let volume = subject.kind.body.hydro.volume;
    let buoyant = match method {
        Method::Plain => 0.0,
        _ => f64::from(subject.fluid.density()) * volume,
    };
    let weight = (dry.mass - buoyant) * GRAVITY;
    // Of a step's worth of gravity.
    let slack = dry.mass * (GRAVITY * DT).powi(2);
    let mut given = Vec::new();
    for (start, piece) in starts.iter().zip(&scene.pieces) {
        let own = kinetic_energy(prepared, &scene.world.bodies[piece.handle]);
        let with_fluid = released(prepared, method, start)?;
        let energy = if method == Method::Plain {
            own
        } else {
            own.max(with_fluid)
        };
        given.push((energy, piece.release.y));
    }
    let mut stability = Stability::default();
    let (mut broken, mut gaining) = (vec![false; FALLS], vec![false; FALLS]);
    for _ in 0..STEPS {
        mover.step(&mut scene.world);
        for (i, piece) in scene.pieces.iter().enumerate() {
            let body = &scene.world.bodies[piece.handle];
            let energy = kinetic_energy(prepared, body);
            let fallen = given[i].1 - from_rapier(body.center_of_mass()).y;
            let ratio = energy / (given[i].0 + (weight * fallen).max(0.0) + slack);
            if !ratio.is_finite() {
                broken[i] = true;
                continue;
            }
            gaining[i] |= ratio > 1.05;
            stability.worst = stability.worst.max(ratio);
        }
    }
    let count = |of: &[bool]| of.iter().filter(|x| **x).count();
    (stability.broken, stability.gaining) = (count(&broken), count(&gaining));
    Ok(stability)
}
