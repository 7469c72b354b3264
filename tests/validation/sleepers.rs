//! A sleeping body wakes when the fluid around it changes so that it could be moved, and else sleeps on.

use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::turbulence::{Turbulence, TurbulenceState};
use rapier3d_immersed::{Fluid, HydroProperties, Immersion};

/// A body that sleeps on a floor, in a fluid that flows along x at `speed`.
fn sleeping(
    collider: ColliderBuilder,
    fluid: Fluid,
    speed: Real,
) -> (PhysicsWorld, Immersion, RigidBodyHandle) {
    let mut world = PhysicsWorld::new();
    let floor = ColliderBuilder::cuboid(50.0, 0.5, 50.0).translation(Vector::Y * -0.5);
    world.insert(RigidBodyBuilder::fixed(), floor);
    let (handle, _) = world.insert(
        RigidBodyBuilder::dynamic().translation(Vector::Y * 0.06),
        collider,
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let mut immersion = Immersion::new(fluid);
    immersion.insert(handle, hydro);
    if speed != 0.0 {
        immersion.set_flow(Uniform::new(speed, 0.0, 0.0));
    }
    for _ in 0..120 {
        immersion.step(&mut world);
    }
    world.bodies[handle].sleep();
    (0..2).for_each(|_| immersion.step(&mut world));
    assert!(world.bodies[handle].is_sleeping());
    (world, immersion, handle)
}

/// In how many steps the body wakes, of 40.
fn wakes(
    world: &mut PhysicsWorld,
    immersion: &mut Immersion,
    handle: RigidBodyHandle,
) -> Option<usize> {
    (0..40).find(|_| {
        immersion.step(world);
        !world.bodies[handle].is_sleeping()
    })
}

fn ball() -> ColliderBuilder {
    ColliderBuilder::ball(0.05).density(1100.0)
}

fn water(density: Real) -> Fluid {
    Fluid::new(density, 1e-6).unwrap()
}

type Change = fn(&mut Immersion, &mut PhysicsWorld);

/// Each change is one by which the ball, of 100 kg/m³ more than the water, is moved; sleeping bodies are
/// looked at once in sixteen steps.
#[test]
fn changes_that_move_a_body_wake_it() {
    let changes: [(&str, Real, Change); 7] = [
        ("wind turns", 0.5, |i, _| {
            i.set_flow(Uniform::new(-0.5, 0.0, 0.0))
        }),
        ("wind rises", 0.0, |i, _| {
            i.set_flow(Uniform::new(0.0, 2.0, 0.0))
        }),
        ("wind ends", 1.0, |i, _| i.clear_flow()),
        ("wind of zero", 1.0, |i, _| {
            i.set_flow(Uniform::new(0.0, 0.0, 0.0))
        }),
        ("denser fluid", 0.0, |i, _| i.set_fluid(water(1260.0))),
        ("turbulence", 0.0, |i, _| {
            i.set_turbulence(Turbulence::Homogeneous(TurbulenceState {
                kinetic_energy: 1.0,
                dissipation: 1.0,
            }));
        }),
        ("gravity", 0.0, |_, world| world.gravity = Vector::Y * 9.81),
    ];
    for (name, speed, change) in changes {
        let (mut world, mut immersion, handle) = sleeping(ball(), water(1000.0), speed);
        change(&mut immersion, &mut world);
        let woke = wakes(&mut world, &mut immersion, handle);
        assert!(woke.is_some_and(|steps| steps < 16), "{name}: {woke:?}");
    }
}

/// What cannot move it lets it sleep: the same again, a breath, a little turbulence.
#[test]
fn changes_that_do_not_let_it_sleep() {
    let changes: [(&str, Real, Change); 5] = [
        ("the same wind", 0.2, |i, _| {
            i.set_flow(Uniform::new(0.2, 0.0, 0.0))
        }),
        ("a breath", 0.0, |i, _| {
            i.set_flow(Uniform::new(0.05, 0.0, 0.0))
        }),
        ("no wind, of none", 0.0, |i, _| i.clear_flow()),
        ("a little turbulence", 0.0, |i, _| {
            i.set_turbulence(Turbulence::Homogeneous(TurbulenceState {
                kinetic_energy: 1e-4,
                dissipation: 1e-4,
            }));
        }),
        ("gravity, by a tenth", 0.0, |_, world| world.gravity *= 1.1),
    ];
    for (name, speed, change) in changes {
        let (mut world, mut immersion, handle) = sleeping(ball(), water(1000.0), speed);
        change(&mut immersion, &mut world);
        assert_eq!(wakes(&mut world, &mut immersion, handle), None, "{name}");
    }
}

/// To end the flow is to set one of zero: a ball that flies feels the fluid stop alike, to the bit, also
/// after the crate has ceased to look at it.
#[test]
fn no_flow_is_a_flow_of_zero() {
    let fall = |change: fn(&mut Immersion)| {
        let mut world = PhysicsWorld::new();
        let (handle, _) = world.insert(RigidBodyBuilder::dynamic(), ball());
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let mut immersion = Immersion::new(Fluid::WATER);
        immersion.insert(handle, hydro);
        immersion.set_flow(Uniform::new(1.0, 0.0, 0.0));
        (0..60).for_each(|_| immersion.step(&mut world));
        let before = world.bodies[handle].linvel();
        change(&mut immersion);
        immersion.step(&mut world);
        let after = world.bodies[handle].linvel();
        (0..60).for_each(|_| immersion.step(&mut world));
        (before, after, *world.bodies[handle].position())
    };
    let cleared = fall(Immersion::clear_flow);
    assert_eq!(cleared, fall(|i| i.set_flow(Uniform::new(0.0, 0.0, 0.0))));
    // The pressure of the fluid that stops, (ρV + ρV/2) ΔU over m + ρV/2, is most of it.
    let (rho, added) = (997.0 / 1100.0, 0.5 * 997.0 / 1100.0);
    let jump = (rho + added) / (1.0 + added);
    let felt = cleared.0.x - cleared.1.x;
    assert!((felt - jump).abs() < 0.05, "{felt} for {jump} m/s");
}

/// The limit is a pressure of a quarter of the weight: ½ρA U² of a wind that rises, ½ρA ⅔k of turbulence. A
/// twentieth less lets the ball sleep, a twentieth more wakes it.
#[test]
fn a_quarter_of_the_weight_wakes() {
    let area = std::f32::consts::PI * 0.05 * 0.05;
    let volume = 4.0 / 3.0 * area * 0.05;
    let limit = 0.25 * 100.0 * volume * 9.81 / (0.5 * 1000.0 * area);
    for (share, wanted) in [(0.95, false), (1.05, true)] {
        let (mut world, mut immersion, handle) = sleeping(ball(), water(1000.0), 0.0);
        immersion.set_flow(Uniform::new(0.0, 0.0, (share * limit).sqrt()));
        let woke = wakes(&mut world, &mut immersion, handle).is_some();
        assert_eq!(woke, wanted, "wind, {share}");
        let (mut world, mut immersion, handle) = sleeping(ball(), water(1000.0), 0.0);
        immersion.set_turbulence(Turbulence::Homogeneous(TurbulenceState {
            kinetic_energy: 1.5 * share * limit,
            dissipation: 1.0,
        }));
        let woke = wakes(&mut world, &mut immersion, handle).is_some();
        assert_eq!(woke, wanted, "turbulence, {share}");
    }
}

/// A body that falls asleep again in turbulence that woke it is not woken by that which it knows.
#[test]
fn known_turbulence_lets_it_sleep() {
    let (mut world, mut immersion, handle) = sleeping(ball(), water(1000.0), 0.0);
    immersion.set_turbulence(Turbulence::Homogeneous(TurbulenceState {
        kinetic_energy: 1.0,
        dissipation: 1.0,
    }));
    assert!(wakes(&mut world, &mut immersion, handle).is_some());
    world.bodies[handle].sleep();
    assert_eq!(wakes(&mut world, &mut immersion, handle), None);
}

/// To end the turbulence where nothing flows is to set a flow of zero, too: to the bit, and the fluid's
/// fluctuation comes to rest within the next step.
#[test]
fn no_turbulence_is_a_fluid_that_stops() {
    let fall = |still: bool| {
        let mut world = PhysicsWorld::new();
        let (handle, _) = world.insert(RigidBodyBuilder::dynamic(), ball());
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let mut immersion = Immersion::new(Fluid::WATER);
        immersion.insert(handle, hydro);
        immersion.set_turbulence(Turbulence::Homogeneous(TurbulenceState {
            kinetic_energy: 1.0,
            dissipation: 1.0,
        }));
        (0..60).for_each(|_| immersion.step(&mut world));
        if still {
            immersion.set_flow(Uniform::new(0.0, 0.0, 0.0));
        }
        let before = world.bodies[handle].linvel();
        immersion.clear_turbulence();
        immersion.step(&mut world);
        let after = world.bodies[handle].linvel();
        (0..60).for_each(|_| immersion.step(&mut world));
        (before, after, *world.bodies[handle].position())
    };
    let cleared = fall(false);
    assert_eq!(cleared, fall(true));
    assert!((cleared.0 - cleared.1).length() > 0.2, "{cleared:?}");
}
