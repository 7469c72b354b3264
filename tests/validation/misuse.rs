//! What a user does wrong at run time is said once, and mended with the next right step.

use crate::support::weightless;
use rapier3d_immersed::flow::Flow;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, RapierSets, Warning};

fn leaf(world: &mut PhysicsWorld) -> (RigidBodyHandle, HydroProperties) {
    let leaf = ColliderBuilder::cuboid(0.0365, 0.000_15, 0.021).density(300.0);
    let body = RigidBodyBuilder::dynamic().rotation(Vector::X * 0.3);
    let (handle, _) = world.insert(body, leaf);
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    (handle, hydro)
}

/// Whoever never calls `after_step` still keeps the force that he set, and is told once.
#[test]
fn a_step_that_is_never_finished() {
    let mut world = weightless();
    let (handle, hydro) = leaf(&mut world);
    let force = Vector::new(1e-4, 0.0, 0.0);
    world.bodies[handle].add_force(force, true);
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert(handle, hydro);
    for _ in 0..10 {
        immersion.before_step(&mut RapierSets::of(&mut world));
        world.step();
    }
    assert_eq!(immersion.warnings(), [Warning::UnfinishedStep]);
    immersion.after_step(&mut RapierSets::of(&mut world));
    assert_eq!(world.bodies[handle].user_force(), force);
}

/// A body that spins far in a step, or that locks alone hold, is moved by its mean velocity: it has that of the
/// step's end all the same where `after_step` never comes.
#[test]
fn velocities_of_a_step_that_is_never_finished() {
    let fall = |finish: bool, locks: LockedAxes| {
        let mut world = PhysicsWorld::new();
        let (handle, hydro) = leaf(&mut world);
        world.bodies[handle].set_locked_axes(locks, true);
        world.bodies[handle].set_angvel(Vector::new(0.0, 200.0, 0.0), true);
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(handle, hydro);
        for _ in 0..20 {
            immersion.before_step(&mut RapierSets::of(&mut world));
            world.step();
            if finish {
                immersion.after_step(&mut RapierSets::of(&mut world));
            }
        }
        immersion.before_step(&mut RapierSets::of(&mut world));
        immersion.after_step(&mut RapierSets::of(&mut world));
        let body = &world.bodies[handle];
        (*body.position(), body.linvel(), body.angvel())
    };
    for locks in [LockedAxes::empty(), LockedAxes::TRANSLATION_LOCKED_X] {
        assert_eq!(fall(true, locks), fall(false, locks), "{locks:?}");
    }
}

/// The set is changed between `before_step` and `after_step`, as a handler of collisions may: another fluid,
/// another description, the body gone and another in its place. A leaf lies on a floor meanwhile, so that
/// there are contacts to correct.
#[test]
fn the_set_changes_within_a_step() {
    type Change = fn(&mut Immersion, &mut PhysicsWorld, RigidBodyHandle, &HydroProperties);
    let changes: [Change; 4] = [
        |immersion, _, _, _| immersion.set_fluid(Fluid::AIR),
        |immersion, _, handle, hydro| immersion.insert(handle, hydro.clone()),
        |immersion, world, handle, hydro| {
            immersion.remove(handle, &mut world.bodies, &mut world.colliders);
            let (other, _) = leaf(world);
            immersion.insert(other, hydro.clone());
            immersion.insert(handle, hydro.clone());
        },
        |immersion, _, handle, _| immersion.set_body_enabled(handle, false),
    ];
    for change in changes {
        let mut world = PhysicsWorld::new();
        let floor = ColliderBuilder::cuboid(10.0, 0.1, 10.0).translation(Vector::Y * -0.12);
        world.insert(RigidBodyBuilder::fixed(), floor);
        let (handle, hydro) = leaf(&mut world);
        let mut immersion = Immersion::new(Fluid::WATER);
        immersion.insert(handle, hydro.clone());
        for _ in 0..60 {
            immersion.before_step(&mut RapierSets::of(&mut world));
            world.step();
            change(&mut immersion, &mut world, handle, &hydro);
            immersion.after_step(&mut RapierSets::of(&mut world));
        }
        let body = &world.bodies[handle];
        assert_eq!(body.user_force(), Vector::ZERO);
        assert!(body.linvel().length() < 10.0, "{}", body.linvel());
    }
}

/// A flow that is NaN in half of space.
struct Broken;

impl Flow for Broken {
    fn velocity(&self, point: Vector, _time: f64) -> Vector {
        Vector::X * if point.x > 0.0 { 1.0 } else { Real::NAN }
    }
}

/// Where the flow is no number the fluid stays as it was, which is said once for each body.
#[test]
fn a_flow_that_is_no_number() {
    let mut world = weightless();
    let mut immersion = Immersion::new(Fluid::AIR);
    let handles = [-1.0, 1.0].map(|x| {
        let (handle, hydro) = leaf(&mut world);
        world.bodies[handle].set_translation(Vector::X * x, true);
        immersion.insert(handle, hydro);
        handle
    });
    immersion.set_flow(Broken);
    for _ in 0..30 {
        immersion.step(&mut world);
    }
    let body = handles[0];
    assert_eq!(immersion.warnings(), [Warning::FlowNotFinite { body }]);
    assert_eq!(world.bodies[body].linvel(), Vector::ZERO);
    assert!(world.bodies[handles[1]].linvel().x > 0.1);
}

/// A body that is inserted in two immersions is in the first that steps; the second says so once, and leaves
/// it alone to the bit until the first has given it back.
#[test]
fn one_body_in_two_immersions() {
    let run = |immersions: usize| {
        let mut world = PhysicsWorld::new();
        let (body, hydro) = leaf(&mut world);
        let mut all = vec![Immersion::new(Fluid::AIR), Immersion::new(Fluid::WATER)];
        all.truncate(immersions);
        all.iter_mut().for_each(|i| i.insert(body, hydro.clone()));
        let step = |all: &mut [Immersion], world: &mut PhysicsWorld| {
            for immersion in all.iter_mut() {
                immersion.before_step(&mut RapierSets::of(world));
            }
            world.step();
            for immersion in all.iter_mut() {
                immersion.after_step(&mut RapierSets::of(world));
            }
        };
        (0..60).for_each(|_| step(&mut all, &mut world));
        let velocity = world.bodies[body].linvel();
        (world, all, body, velocity)
    };
    let (.., alone) = run(1);
    let (mut world, mut all, body, both) = run(2);
    assert_eq!(both, alone);
    assert_eq!(all[0].warnings(), []);
    assert_eq!(all[1].warnings(), [Warning::ImmersedTwice { body }]);
    assert!(all[1].mass_of(body).is_none());

    all[0].remove(body, &mut world.bodies, &mut world.colliders);
    all[1].step(&mut world);
    let mass = all[1].mass_of(body).expect("in the fluid of the second");
    let own = 300.0 * 0.073 * 0.000_3 * 0.042;
    assert!((mass.mass / own - 1.0).abs() < 1e-5, "{}", mass.mass);
    assert_eq!(all[1].warnings().len(), 1);
}

/// Rapier's invalid handle has the index 2³² − 1: no table is made that long.
#[test]
fn the_invalid_handle_is_passed_over() {
    let mut world = weightless();
    let (_, hydro) = leaf(&mut world);
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert(RigidBodyHandle::invalid(), hydro);
    assert_eq!(immersion.len(), 0);
    immersion.step(&mut world);
    assert_eq!(immersion.control(RigidBodyHandle::invalid()), None);
}

/// Four thousand leaves of as many sizes come and go, eight at a time: what is kept of them does not grow.
#[cfg(feature = "serde-serialize")]
#[test]
fn what_has_gone_is_forgotten() {
    let mut world = weightless();
    let (_, mut hydro) = leaf(&mut world);
    let mut immersion = Immersion::new(Fluid::AIR);
    let mut alive = std::collections::VecDeque::new();
    let mut sizes = Vec::new();
    for i in 0..4000 {
        let (handle, _) = leaf(&mut world);
        hydro.volume *= 1.0 + 1e-7;
        immersion.insert(handle, hydro.clone());
        immersion.step(&mut world);
        alive.push_back(handle);
        if alive.len() > 8 {
            let gone = alive.pop_front().unwrap();
            immersion.remove(gone, &mut world.bodies, &mut world.colliders);
            world.remove_body(gone);
        }
        if i % 1000 == 999 {
            sizes.push(postcard::to_stdvec(&immersion).unwrap().len());
        }
    }
    // Eight bodies and some thirty descriptions of half a kilobyte each.
    assert!(sizes.iter().all(|size| *size < 40_000), "{sizes:?}");
}
