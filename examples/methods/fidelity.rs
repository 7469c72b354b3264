//! Falls of paper by each method, beside the measured ones.

use crate::Failure;
use crate::method::Method;
use crate::mover::{apart, fly};
use crate::prepared::Prepared;
use crate::subject::Start;
use crate::support::from_rapier;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use rapier3d_immersed::motion::Trajectory;

/// Falls per method that means are taken of.
pub const FALLS: u64 = 64;
const DT: f64 = 1.0 / 240.0;

/// So many falls of the paper, let go as by the robot.
pub fn falls(prepared: &Prepared, method: Method, count: u64) -> Result<Vec<Trajectory>, Failure> {
    let mut random = Pcg64Mcg::seed_from_u64(3);
    let starts: Vec<Start> = (0..count)
        .map(|seed| Start {
            place: from_rapier(apart(seed as usize)),
            release: prepared.subject.shaken(&mut random),
            seed,
        })
        .collect();
    fly(prepared, method, &starts, DT, 4.0, 1.2)
}
