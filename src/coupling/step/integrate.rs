//! The third stage: the equations of motion of many bodies, in groups that fit the machine's registers.
//! Rapier is not needed for it.

use super::lane_group::LaneGroup;
use super::stage_data::{SeenFlow, StepInput, StepOutput};
use super::workspace::Batched;
use crate::coupling::shared_constants::{Route, StepConstants};
use crate::math::{Lanes, MOST_LANES, OnLanes, dispatch};
use fearless_simd::Simd;

/// Integrates the bodies of a batch, whose constants must all be of one `route`, with the widest
/// instructions that the machine has; they round alike on all machines. `flows` has one entry per body,
/// or none.
pub(super) fn integrate(
    inputs: &[StepInput],
    flows: &[SeenFlow],
    outputs: &mut Vec<StepOutput>,
    route: Route,
    batched: Batched,
) {
    outputs.resize(inputs.len(), StepOutput::default());
    #[cfg(feature = "parallel")]
    {
        use rapier3d::rayon::prelude::*;
        /// Bodies per task: enough to be worth handing to another thread.
        const TASK: usize = 256;
        if inputs.len() > TASK {
            inputs
                .par_chunks(TASK)
                .zip(outputs.par_chunks_mut(TASK))
                .enumerate()
                .for_each(|(number, (inputs, outputs))| {
                    let from = number * TASK;
                    let flows = flows.get(from..from + inputs.len()).unwrap_or_default();
                    dispatch(Integrate {
                        inputs,
                        flows,
                        outputs,
                        route,
                        batched,
                    });
                });
            return;
        }
    }
    dispatch(Integrate {
        inputs,
        flows,
        outputs,
        route,
        batched,
    });
}

/// Number of bodies that are sorted by their substeps, so that few lanes stand still.
const WINDOW: usize = 64;

struct Integrate<'a> {
    inputs: &'a [StepInput],
    flows: &'a [SeenFlow],
    outputs: &'a mut [StepOutput],
    route: Route,
    batched: Batched<'a>,
}

impl OnLanes for Integrate<'_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let batched = self.batched;
        // The constants of the last group, and their index.
        let mut last: Option<(u32, StepConstants<Lanes<S>>)> = None;
        let windows = self.inputs.chunks(WINDOW);
        let outputs = self.outputs.chunks_mut(WINDOW);
        for (number, (inputs, outputs)) in windows.zip(outputs).enumerate() {
            let from = number * WINDOW;
            let flows = self.flows.get(from..from + inputs.len());
            let mut order = by_substeps(inputs, batched);
            let order = &mut order[..inputs.len()];
            // Bodies of parts are advanced beside their equals only.
            if self.route.has_parts() {
                order.sort_by_key(|index| inputs[usize::from(*index)].constants);
            }
            let equal = |a: &u8, b: &u8| {
                let constants = |index: &u8| inputs[usize::from(*index)].constants;
                !self.route.has_parts() || constants(a) == constants(b)
            };
            let groups = order.chunk_by(equal);
            for group in groups.flat_map(|equal| equal.chunks(Lanes::<S>::COUNT)) {
                // A last group that is not full repeats its last body.
                let index: [usize; MOST_LANES] =
                    std::array::from_fn(|lane| group[lane.min(group.len() - 1)].into());
                let bodies: [&StepInput; MOST_LANES] =
                    std::array::from_fn(|lane| &inputs[index[lane]]);
                let first = bodies[0].constants;
                // All indices are those of this step's preparation, so that none is ever missing.
                let Some(of_first) = batched.constants.get(first) else {
                    continue;
                };
                let shared = |lane: usize| {
                    let index = bodies[lane].constants;
                    batched.constants.get(index).unwrap_or(of_first)
                };
                let mixed;
                let constants = if bodies.iter().any(|input| input.constants != first) {
                    let of = |lane| &shared(lane).step;
                    mixed = StepConstants::gather(simd, flows.is_some(), of);
                    &mixed
                } else {
                    match &mut last {
                        Some((index, constants)) if *index == first => constants,
                        other => {
                            let constants = StepConstants::splat(simd, &shared(0).step);
                            &other.insert((first, constants)).1
                        }
                    }
                };
                LaneGroup {
                    simd,
                    bodies,
                    motions: std::array::from_fn(|lane| batched.motion(bodies[lane])),
                    constants,
                    symmetric: self.route.symmetric,
                    parts: self.route.has_parts().then_some(of_first),
                    buoyancy_turns: (0..MOST_LANES).any(|lane| shared(lane).buoyancy_turns),
                    flows,
                    index,
                    outputs: &mut *outputs,
                    batched,
                }
                .step();
            }
        }
    }
}

/// Indices of a window's bodies, by the substeps that they took last.
#[inline(always)]
fn by_substeps(inputs: &[StepInput], batched: Batched) -> [u8; WINDOW] {
    const CLASSES: u8 = 16;
    let mut classes = [0; WINDOW];
    let mut starts = [0_u8; CLASSES as usize + 1];
    for (input, class) in inputs.iter().zip(&mut classes) {
        *class = (batched.motion(input).substeps as u8).min(CLASSES - 1);
        starts[usize::from(*class) + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut order = [0; WINDOW];
    for (index, class) in classes[..inputs.len()].iter().enumerate() {
        let place = &mut starts[usize::from(*class)];
        order[usize::from(*place) % WINDOW] = index as u8;
        *place += 1;
    }
    order
}
