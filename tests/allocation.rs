//! A steady step allocates nothing of its own: counted by the allocator itself.
//!
//! Rapier lists every body that is accessed mutably, and throws that list away in each step: the list's
//! growth is what remains, the same as for a loop that only touches the bodies.

use rapier3d_immersed::flow::{Flow, Uniform};
use rapier3d_immersed::free_surface::{Sea, Waves};
use rapier3d_immersed::motion::Regime;
use rapier3d_immersed::motion::path::{Key, MotionPath, WindResponse};
use rapier3d_immersed::playback::{Drive, MotionPlayer, MotionPlayers, Particle, Suspension};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::reduced::CrossParams;
use rapier3d_immersed::turbulence::{Turbulence, TurbulenceState};
use rapier3d_immersed::{
    Fluid, HydroProperties, ImmersedBody, Immersion, Layer, Medium, Part, RapierSets, SeparatedLaw,
    ViscousLaw,
};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: hands every call on to the system allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// How many times memory is asked for meanwhile.
fn allocations(work: impl FnOnce()) -> usize {
    let start = ALLOCATIONS.load(Ordering::Relaxed);
    work();
    ALLOCATIONS.load(Ordering::Relaxed) - start
}

/// The same for touching each body once, when rapier's list is empty, as it is after a step.
fn touching(world: &mut PhysicsWorld, leaves: &[RigidBodyHandle]) -> usize {
    world.step();
    let count = allocations(|| {
        for leaf in leaves {
            world.bodies.get_mut(*leaf);
        }
    });
    world.step();
    count
}

/// In turn: the counter is one for all threads.
#[test]
fn steps_allocate_nothing() {
    let strips = |hydro| {
        let plate = Cuboid::new(Vector::new(0.04, 0.0003, 0.02));
        let strips = HydroProperties::strips_of_shape(&plate, 3).unwrap();
        ImmersedBody::new(hydro).with_parts(strips.into_iter().map(Part::new))
    };
    before_and_after_allocate_nothing_in_flight(ImmersedBody::new, false);
    before_and_after_allocate_nothing_in_flight(strips, true);
    before_and_after_allocate_nothing_in_flight(separated, false);
    for kinematic in [true, false] {
        players_allocate_nothing(kinematic);
    }
    for waves in [false, true] {
        floating_allocates_nothing(waves);
    }
    suspensions_allocate_nothing();
}

/// Snow in turbulent wind that settles on the ground.
fn suspensions_allocate_nothing() {
    let mut world = PhysicsWorld::new();
    world.insert(
        RigidBodyBuilder::fixed(),
        ColliderBuilder::cuboid(99.0, 0.5, 99.0),
    );
    world.step();
    let state = TurbulenceState::from_intensity(1.0, 0.3, 0.5).unwrap();
    let air = Layer::new(Fluid::AIR)
        .with_flow(Uniform::new(1.0, 0.0, 0.0))
        .with_turbulence(Turbulence::Homogeneous(state));
    let mut snow = Suspension::new(air, Particle::sphere(3e-4, 200.0).unwrap()).unwrap();
    for i in 0..1000 {
        snow.insert(Vector::Y * (0.5 + 0.002 * i as Real), Vector::ZERO);
    }
    snow.step_in_world(0.02, &world);
    let count = allocations(|| (0..50).for_each(|_| snow.step_in_world(0.02, &world)));
    let settled = snow
        .particles()
        .iter()
        .filter(|flake| flake.settled)
        .count();
    assert!((10..900).contains(&settled), "{settled}");
    assert_eq!(count, 0);
}

/// Crates that bob, on still water and on a sea.
fn floating_allocates_nothing(waves: bool) {
    let mut world = PhysicsWorld::new();
    let crates: Vec<_> = (0..100)
        .map(|i| {
            let at = Vector::new(i as Real * 5.0, 0.2, 0.0);
            let body = RigidBodyBuilder::dynamic().translation(at).rotation(at);
            let shape = ColliderBuilder::cuboid(0.5, 0.4, 0.6).density(400.0);
            world.insert(body, shape).0
        })
        .collect();
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, crates[0]).unwrap();
    let mut medium = Medium::layered(Fluid::AIR, Fluid::WATER);
    if waves {
        medium = medium.with_surface(Waves::sea(&Sea::default()).unwrap());
    }
    let mut immersion = Immersion::new(medium);
    immersion.insert_all(crates.iter().copied(), hydro);
    for _ in 0..60 {
        immersion.step(&mut world);
    }
    // Disturbed by steps of rapier alone, some jump out of the water: lists of disturbances and of those in the air grow.
    for _ in 0..60 {
        touching(&mut world, &crates);
        immersion.step(&mut world);
    }
    let (mut ours, mut least) = (0, 0);
    for _ in 0..30 {
        let awake = |body: &&RigidBodyHandle| !world.bodies[**body].is_sleeping();
        assert!(crates.iter().filter(awake).count() > 90);
        least += touching(&mut world, &crates);
        ours += allocations(|| immersion.before_step(&mut RapierSets::of(&mut world)));
        world.step();
        ours += allocations(|| immersion.after_step(&mut RapierSets::of(&mut world)));
    }
    assert!(
        (2 * least..=2 * least + 2).contains(&ours),
        "{waves}: {ours} {least}"
    );
}

/// Players in wind, with contacts looked for.
fn players_allocate_nothing(kinematic: bool) {
    let key = |t: Real| Key {
        position: Vector::Y * -t,
        velocity: -Vector::Y,
        attitude: Rotation::from_axis_angle(Vector::X, t),
    };
    let keys = (0..=100).map(|i| key(0.1 * i as Real)).collect();
    let regimes = vec![(0.0, Regime::SteadyDescent)];
    let path = Arc::new(MotionPath::new(0.1, keys, regimes).unwrap());
    let mut world = PhysicsWorld::new();
    let mut players = MotionPlayers::new();
    let wind: Arc<dyn Flow> = Arc::new(Uniform::new(1.0, 0.0, 0.0));
    players
        .set_wind(Some((wind, WindResponse::default())))
        .unwrap();
    let leaves: Vec<_> = (0..100)
        .map(|i| {
            let mut player = MotionPlayer::new(path.clone(), Vector::X * i as Real);
            let mut body = RigidBodyBuilder::dynamic();
            if kinematic {
                player.drive = Drive::Kinematic;
                body = RigidBodyBuilder::kinematic_position_based();
            }
            let (leaf, _) = world.insert(
                body.pose(player.release(Vector::ZERO)),
                ColliderBuilder::cuboid(0.04, 0.0003, 0.02).density(300.0),
            );
            players.play(leaf, &player).unwrap();
            leaf
        })
        .collect();
    for _ in 0..20 {
        players.before_step(&mut RapierSets::of(&mut world), None);
        world.step();
    }
    let (mut ours, mut least) = (0, 0);
    for _ in 0..100 {
        least += touching(&mut world, &leaves);
        ours += allocations(|| players.before_step(&mut RapierSets::of(&mut world), None));
        world.step();
    }
    assert_eq!(players.len(), leaves.len());
    assert_eq!(ours, least, "kinematic: {kinematic}");
}

/// Under a reduced model of the default law.
fn separated(hydro: HydroProperties) -> ImmersedBody {
    let params = CrossParams {
        max_rank: 8,
        max_evaluations: 10_000,
        ..CrossParams::default()
    };
    let law = ViscousLaw::default();
    let (law, _) = SeparatedLaw::bake(&hydro, law, [100.0, 1e4], &params).unwrap();
    let part = Part::new(hydro.clone()).with_law(law);
    ImmersedBody::new(hydro).with_parts([part])
}

fn before_and_after_allocate_nothing_in_flight(
    body: impl Fn(HydroProperties) -> ImmersedBody,
    turbulent: bool,
) {
    let mut world = PhysicsWorld::new();
    let leaves: Vec<_> = (0..100)
        .map(|i| {
            let at = Vector::new(i as Real, 50.0, 0.0);
            // So far apart that none meet: a contact changes the solver's mass, which rapier lists.
            let body = RigidBodyBuilder::dynamic()
                .translation(at * 10.0)
                .rotation(at);
            world
                .insert(
                    body,
                    ColliderBuilder::cuboid(0.04, 0.0003, 0.02).density(300.0),
                )
                .0
        })
        .collect();
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaves[0]).unwrap();
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.set_flow(rapier3d_immersed::flow::Uniform::new(1.0, 0.0, 0.0));
    if turbulent {
        immersion.set_turbulence(Turbulence::Homogeneous(TurbulenceState {
            kinetic_energy: 0.1,
            dissipation: 0.05,
        }));
    }
    immersion.insert_all(leaves.iter().copied(), body(hydro));
    // Lists grow to their size.
    for _ in 0..200 {
        immersion.step(&mut world);
    }
    let (mut ours, mut least) = (0, 0);
    for _ in 0..100 {
        least += touching(&mut world, &leaves);
        ours += allocations(|| immersion.before_step(&mut RapierSets::of(&mut world)));
        world.step();
        ours += allocations(|| immersion.after_step(&mut RapierSets::of(&mut world)));
    }
    // Once before and once after the step; a list may still grow if more leaves turn fast at once than ever before.
    assert!(
        (2 * least..=2 * least + 2).contains(&ours),
        "{ours} {least}"
    );
}
