//! "I have a …": what to use for what falls, flies or floats, a page for each.
//!
//! Every page has some ten lines of code that run as they stand, what accuracy to expect and where that was measured, what it
//! costs, and what goes wrong most often. Common to all of them:
//!
//! * **SI units.** A leaf of 7 cm is 0.07 long and weighs half a gram: a density of 300 kg/m³, not of 1. A world in
//!   centimeters has another fluid: scale the world, not the fluid.
//! * **Small bodies.** Rapier's defaults are for bodies of meters. Falling alone needs nothing; piles of small bodies need
//!   [`preset::leaf_scale`](crate::preset::leaf_scale), which changes the whole world (its time step, too).
//! * **One line per step.** [`Immersion::step`](crate::Immersion::step) stands for `world.step()`; with
//!   `num_solver_iterations = 1` velocities are right, poses only to first order in the step.
//! * **Changes.** A collider or mass that is changed in flight is seen at the next step. Snapshots hold bodies, laws and
//!   time, but neither flows nor turbulence: give those again.
//! * **Cost.** A body of one planform costs some 250 to 470 ns a step on top of rapier's own 560; each further part 45 to 60 ns
//!   (`cargo bench --bench step`, `parts`).

macro_rules! pages {
    ($($page:ident),* $(,)?) => {
        $(pub mod $page { #![doc = include_str!(concat!(stringify!($page), ".md"))] })*
    };
}

pages! {
    leaf, paper, coin, card, confetti, snow, seed, frisbee, arrow, airplane, sail, parachute, rotor, boat, robot, flag,
}
