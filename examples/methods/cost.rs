//! Time per body and step, and memory per body, over those of plain rapier.

use crate::Failure;
use crate::memory::held;
use crate::method::Method;
use crate::mover::{Mover, apart, empty};
use crate::prepared::Prepared;
use crate::subject::Start;
use crate::support::from_rapier;
use crate::support::recording::{Stepper, median};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use std::time::Instant;

const BODIES: usize = 1000;
const STEPS: usize = 240;
const DT: f64 = 1.0 / 120.0;

/// Of one body.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cost {
    /// Median over the steps, ns: all of the step, and what is beyond plain rapier's.
    pub step: f64,
    pub extra: f64,
    /// Held beyond plain rapier's, with the path or plan that is the body's own.
    pub bytes: f64,
}

/// Of each method, steps by turns: what else the machine does meets all of them.
pub fn costs(prepared: &Prepared) -> Result<[Cost; 6], Failure> {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let starts: Vec<Start> = (0..BODIES)
        .map(|i| Start {
            place: from_rapier(apart(i)),
            release: prepared.subject.shaken(&mut random),
            seed: i as u64,
        })
        .collect();
    let mut worlds = Vec::new();
    let mut bytes = [0.0; 6];
    for (method, bytes) in Method::ALL.into_iter().zip(&mut bytes) {
        let before = held();
        let mut scene = empty(prepared, DT);
        // Long enough for all steps.
        let mut mover = Mover::release(prepared, method, &mut scene, &starts, 5.0)?;
        for _ in 0..4 {
            mover.step(&mut scene.world);
        }
        *bytes = (held() - before) as f64 / BODIES as f64;
        worlds.push((scene, mover));
    }
    let mut times = vec![Vec::new(); 6];
    for _ in 0..STEPS {
        for ((scene, mover), times) in worlds.iter_mut().zip(&mut times) {
            let clock = Instant::now();
            mover.step(&mut scene.world);
            times.push(clock.elapsed().as_secs_f64() * 1e9 / BODIES as f64);
        }
    }
    let mut costs = [Cost::default(); 6];
    for ((cost, times), held) in costs.iter_mut().zip(times).zip(bytes) {
        cost.step = median(times);
        cost.bytes = held - bytes[0];
    }
    let plain = costs[0].step;
    for cost in &mut costs {
        cost.extra = cost.step - plain;
    }
    Ok(costs)
}
