//! The arithmetic of a step: many bodies, in groups that fit the machine's registers, no rapier.

use super::handover::Pace;
use super::kind::{Kind, Route, StepConstants};
use super::slot::Slot;
use super::stream::Stream;
use super::wing::Wing;
use crate::dynamics::Integrator;
use crate::math::{Lanes, MOST_LANES, OnLanes, Row, dispatch};
use fearless_simd::Simd;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::math::{Rotation, Vector};

/// A vector as a row.
#[inline(always)]
pub(super) fn row(v: Vector) -> Row {
    [v.x, v.y, v.z, 0.0]
}

/// The vector of a row.
#[inline(always)]
pub(super) fn vector([x, y, z, _]: Row) -> Vector {
    Vector::new(x, y, z)
}

/// One awake body during one step. World axes unless said otherwise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flyer {
    pub handle: RigidBodyHandle,
    /// Indices of the body's slot and kind.
    pub slot: u32,
    pub kind: u32,
    /// Touches nothing and is held by nothing: velocity and pose are handed over exactly.
    pub free: bool,
    /// Is in contact or held, so that rapier may let it sleep.
    pub may_sleep: bool,
    /// Goes on with the velocity relative to the fluid that was integrated.
    pub goes_on: bool,
    /// Mass that rapier's solver uses, kg; `new_mass` if rapier has to be told.
    pub solver_mass: f32,
    pub new_mass: bool,
    /// Factors on the law's drag, rotational lift and translational lift.
    pub control: [f32; 3],
    /// Share of the world's gravity that the body feels.
    pub gravity_scale: f32,
    /// Index of the body's [`Extra`], `NONE` if it has none.
    pub extra: u32,
    /// Whether a user's torque turns the body.
    pub turned: bool,
    /// What rapier has: attitude (plate axes to world) and velocities.
    pub rapier_attitude: Row,
    pub rapier_linear: Row,
    pub rapier_angular: Row,
}

/// What most bodies have none of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Extra {
    /// Velocities that come on top of what was integrated: what happened to the body since, or all of
    /// its velocity. m/s and rad/s.
    pub linear: Row,
    pub angular: Row,
    /// User's force, N, and torque, N·m.
    pub force: Row,
    pub torque: Row,
}

/// What a step makes of a [`Flyer`]. World axes unless said otherwise.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Landing {
    /// Motion at the end of the step.
    pub motion: Integrated,
    /// Velocities at the end of the step, m/s and rad/s.
    pub end_linear: Row,
    pub end_angular: Row,
    /// Velocities to start from, and the force and torque to apply.
    pub start_linear: Row,
    pub start_angular: Row,
    pub push: Row,
    pub twist: Row,
}

/// The motion of a body as the integrator carries it from step to step: plate axes, relative to the
/// fluid.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct Integrated {
    /// Plate axes to world.
    pub attitude: Row,
    /// u, m/s, and the length of the last substep, s.
    pub linear: Row,
    /// w = ωL, m/s, and the number of substeps in the last step.
    pub angular: Row,
    /// Acceleration over the last substep, u̇ + ω × u and ẇ, m/s² …
    pub linear_rate: Row,
    pub angular_rate: Row,
    /// … and its change between the last two, m/s³.
    pub linear_trend: Row,
    pub angular_trend: Row,
}

impl Integrated {
    /// At rest in the fluid, without history.
    pub fn at(attitude: Rotation) -> Self {
        Self {
            attitude: attitude.to_array(),
            ..Self::default()
        }
    }
}

/// How a step is taken.
#[derive(Clone, Copy)]
pub(super) struct Clock {
    pub dt: f32,
    pub pace: Pace,
    pub gravity: Vector,
    pub integrator: Integrator,
}

/// What the bodies of a batch have in common.
#[derive(Clone, Copy)]
pub(super) struct Air<'a> {
    pub slots: &'a [Option<Slot>],
    pub kinds: &'a [Kind],
    pub extras: &'a [Extra],
    pub clock: &'a Clock,
}

impl<'a> Air<'a> {
    #[inline(always)]
    pub fn motion(&self, flyer: &Flyer) -> &'a Integrated {
        const REST: &Integrated = &Integrated {
            attitude: [0.0, 0.0, 0.0, 1.0],
            linear: [0.0; 4],
            angular: [0.0; 4],
            linear_rate: [0.0; 4],
            angular_rate: [0.0; 4],
            linear_trend: [0.0; 4],
            angular_trend: [0.0; 4],
        };
        let slot = self.slots.get(flyer.slot as usize).and_then(Option::as_ref);
        slot.map_or(REST, |slot| &slot.flight.motion)
    }

    #[inline(always)]
    pub fn extra(&self, flyer: &Flyer) -> &Extra {
        const NOTHING: &Extra = &Extra {
            linear: [0.0; 4],
            angular: [0.0; 4],
            force: [0.0; 4],
            torque: [0.0; 4],
        };
        self.extras.get(flyer.extra as usize).unwrap_or(NOTHING)
    }
}

/// Bodies that are sorted by their number of substeps, so that few lanes stand still.
const WINDOW: usize = 64;

/// Advances `flyers`, whose kinds must all be of the same `route`, with the widest instructions that
/// the machine has; they round alike on all machines. `streams` has one entry per flyer, or none.
pub(super) fn fly(
    flyers: &[Flyer],
    streams: &[Stream],
    landings: &mut [Landing],
    route: Route,
    air: Air,
) {
    dispatch(Flock {
        flyers,
        streams,
        landings,
        route,
        air,
    });
}

struct Flock<'a> {
    flyers: &'a [Flyer],
    streams: &'a [Stream],
    landings: &'a mut [Landing],
    route: Route,
    air: Air<'a>,
}

impl OnLanes for Flock<'_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let air = self.air;
        // The kind that the last group was of.
        let mut last: Option<(u32, StepConstants<Lanes<S>>)> = None;
        let windows = self.flyers.chunks(WINDOW);
        let landings = self.landings.chunks_mut(WINDOW);
        for (number, (flyers, landings)) in windows.zip(landings).enumerate() {
            let from = number * WINDOW;
            let streams = self.streams.get(from..from + flyers.len());
            let order = by_substeps(flyers, air);
            for group in order[..flyers.len()].chunks(Lanes::<S>::COUNT) {
                // A last group that is not full repeats its last body.
                let index: [usize; MOST_LANES] =
                    std::array::from_fn(|lane| group[lane.min(group.len() - 1)].into());
                let bodies: [&Flyer; MOST_LANES] = std::array::from_fn(|lane| &flyers[index[lane]]);
                let kind = |lane: usize| &air.kinds[bodies[lane].kind as usize];
                let first = bodies[0].kind;
                let mixed;
                let constants = if bodies.iter().any(|flyer| flyer.kind != first) {
                    mixed = StepConstants::gather(simd, |lane| &kind(lane).step);
                    &mixed
                } else {
                    match &mut last {
                        Some((kind, constants)) if *kind == first => constants,
                        other => {
                            let constants = StepConstants::splat(simd, &kind(0).step);
                            &other.insert((first, constants)).1
                        }
                    }
                };
                Wing {
                    simd,
                    bodies,
                    kept: std::array::from_fn(|lane| air.motion(bodies[lane])),
                    constants,
                    symmetric: self.route.symmetric,
                    turned_by_buoyancy: (0..MOST_LANES).any(|lane| kind(lane).buoyancy_turns),
                    streams,
                    index,
                    landings: &mut *landings,
                    air,
                }
                .fly();
            }
        }
    }
}

/// Indices of a window's flyers, by the substeps that they took last.
#[inline(always)]
fn by_substeps(flyers: &[Flyer], air: Air) -> [u8; WINDOW] {
    const CLASSES: u8 = 16;
    let mut classes = [0; WINDOW];
    let mut starts = [0_u8; CLASSES as usize + 1];
    for (flyer, class) in flyers.iter().zip(&mut classes) {
        *class = (air.motion(flyer).angular[3] as u8).min(CLASSES - 1);
        starts[usize::from(*class) + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut order = [0; WINDOW];
    for (index, class) in classes[..flyers.len()].iter().enumerate() {
        let place = &mut starts[usize::from(*class)];
        order[usize::from(*place) % WINDOW] = index as u8;
        *place += 1;
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::{GridFlow, Layers, Shear, Vortex};
    use crate::math::NARROW;
    use crate::turbulence::{Turbulence, TurbulenceState};
    use crate::{Fluid, HydroProperties, ImmersedBody, Immersion, RapierSets};
    use crate::{StochasticLaw, ThesisLaw, ViscousLaw};
    use rapier3d::prelude::*;
    use std::sync::atomic::Ordering;

    /// Bodies of every law, thin and thick, centered and not, free and on the ground, of kinds that
    /// differ from neighbour to neighbour, in a turbulent stream; their poses after a second.
    fn poses() -> Vec<[u32; 7]> {
        let mut world = PhysicsWorld::new();
        let ground = ColliderBuilder::cuboid(10.0, 0.5, 10.0).translation(Vector::Y * -0.6);
        world.insert(RigidBodyBuilder::fixed(), ground);
        let mut immersion = Immersion::new(Fluid::AIR);
        let shear = Shear {
            origin: Vector::ZERO,
            velocity: Vector::X,
            across: Vector::Y,
            rate: Vector::Z,
        };
        let vortex = Vortex::new(Vector::ZERO, Vector::Y, 1.0, 0.5).unwrap();
        let spacing = Vector::splat(0.3);
        let periodic = [true, false, true];
        let grid = GridFlow::sampled(&vortex, 0.0, [9; 3], periodic, -Vector::ONE, spacing);
        immersion.set_flow(Layers::new().with(shear).with(grid.unwrap()));
        immersion.set_turbulence(Turbulence::Decaying {
            initial: TurbulenceState {
                kinetic_energy: 0.2,
                dissipation: 0.3,
            },
        });
        let laws = [
            ViscousLaw::default(),
            ViscousLaw::Thesis(ThesisLaw::new(ThesisLaw::ZIGZAG)),
            ViscousLaw::Stochastic(StochasticLaw::default()),
            ViscousLaw::Inviscid,
        ];
        let mut handles = vec![];
        for i in 0..103_usize {
            let x = i as f32;
            let height = if i % 5 == 0 { 0.02 } else { 2.0 };
            let body = RigidBodyBuilder::dynamic()
                .translation(Vector::new(0.3 * (x % 10.0), height, 0.03 * x))
                .rotation(Vector::new(x, 0.3 * x, 0.7))
                .linvel(Vector::new(x % 3.0, 0.0, x % 2.0));
            let thickness = if i % 3 == 0 { 0.02 } else { 0.000_3 };
            let size = 0.02 + 0.002 * (x % 4.0);
            let mut leaf = ColliderBuilder::cuboid(1.5 * size, thickness, size).density(300.0);
            if i % 7 == 0 {
                leaf = leaf.mass_properties(MassProperties::new(
                    Vector::new(0.3 * size, 0.0, 0.0),
                    1e-3,
                    Vector::new(1e-7, 3e-7, 2e-7),
                ));
            }
            let handle = world.insert(body, leaf).0;
            let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle);
            let body = ImmersedBody::new(hydro.unwrap()).with_law(laws[i / 2 % laws.len()]);
            immersion.insert(handle, body.unwrap());
            handles.push(handle);
        }
        for _ in 0..60 {
            immersion.before_step(&mut RapierSets::of(&mut world));
            world.step();
            immersion.after_step(&mut RapierSets::of(&mut world));
        }
        let pose = |handle: &RigidBodyHandle| {
            let Pose {
                translation: t,
                rotation: q,
                ..
            } = *world.bodies[*handle].position();
            [t.x, t.y, t.z, q.x, q.y, q.z, q.w].map(f32::to_bits)
        };
        handles.iter().map(pose).collect()
    }

    /// To the bit: what happens to a body does not depend on the machine's registers.
    #[test]
    fn wide_and_narrow_registers_fly_alike() {
        let wide = poses();
        NARROW.store(true, Ordering::Relaxed);
        let narrow = poses();
        NARROW.store(false, Ordering::Relaxed);
        assert_eq!(wide, narrow);
    }
}
