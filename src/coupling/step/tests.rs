//! Tests of the step that need both its inside and the façade.

use super::contact_mass;
use super::contact_mass::CloseBodies;
use crate::body::ImmersedBody;
use crate::coupling::{Immersion, RapierSets};
use crate::flow::{GridFlow, Layers, Shear, Uniform, Vortex};
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::hydro::viscous::{StochasticLaw, ThesisLaw, ViscousLaw};
use crate::math::NARROW;
use crate::turbulence::{
    LangevinMode, NoiseStream, SeenFluctuation, Turbulence, TurbulenceState, TurbulentLayer,
    kolmogorov_constant, relative_velocity_after, spin_increment,
};
use rapier3d::prelude::*;
use std::sync::atomic::Ordering;

/// Bodies of every law, thin and thick, centered and not, free and on the ground, of kinds that
/// differ from neighbour to neighbour, in a turbulent flow; their poses after a second.
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
fn wide_and_narrow_registers_give_equal_bits() {
    let wide = poses();
    NARROW.store(true, Ordering::Relaxed);
    let narrow = poses();
    NARROW.store(false, Ordering::Relaxed);
    assert_eq!(wide, narrow);
}

/// No body that is passed over has a contact, or one ahead: plates land on a floor one after the other,
/// in air (where only contacts count) and in water (where pairs that could meet do).
#[test]
fn bodies_that_are_passed_over_touch_nothing() {
    for (fluid, heavy) in [(Fluid::AIR, false), (Fluid::WATER, true)] {
        let mut world = PhysicsWorld::new();
        world.insert(
            RigidBodyBuilder::fixed(),
            ColliderBuilder::cuboid(50.0, 0.1, 50.0),
        );
        let plates: Vec<_> = (0..60)
            .map(|i| {
                let at = Vector::new(i as Real - 30.0, 0.2 + 0.03 * i as Real, 0.0);
                let body = RigidBodyBuilder::dynamic().translation(at);
                let plate = ColliderBuilder::cuboid(0.1, 0.005, 0.1).density(1500.0);
                world.insert(body, plate).0
            })
            .collect();
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, plates[0]).unwrap();
        let mut immersion = Immersion::new(fluid);
        immersion.insert_all(plates.iter().copied(), hydro);
        let (mut near, mut passed, mut crowded) = (0, 0, 0);
        for _ in 0..240 {
            immersion.step(&mut world);
            let sets = RapierSets::of(&mut world);
            let (registry, constants) = (&immersion.registry, &immersion.constants);
            assert_eq!(constants.heavy_fluid, heavy);
            let mut close = CloseBodies::default();
            contact_mass::find_close(registry, heavy, &sets, &mut close);
            for (index, state) in registry.states().iter().enumerate() {
                let state = state.as_ref().unwrap();
                let body = &sets.bodies[state.handle];
                if close.crowded {
                    crowded += 1;
                } else if close.contains(index) {
                    near += 1;
                } else {
                    passed += 1;
                    let shared = constants.get(state.constants).unwrap();
                    assert_eq!(contact_mass::normal(shared, body, &sets), None);
                }
            }
        }
        assert!(
            near > 50 && passed > 500 && crowded > 500,
            "{near} {passed} {crowded}"
        );
    }
}

/// A body that enters another fluid while it touches something meets it anew: what its contacts do is
/// corrected from the first step on.
#[test]
fn contacts_are_corrected_anew_in_another_fluid() {
    let mut world = PhysicsWorld::new();
    world.insert(
        RigidBodyBuilder::fixed(),
        ColliderBuilder::cuboid(1.0, 0.1, 1.0),
    );
    let (plate, _) = world.insert(
        RigidBodyBuilder::dynamic().translation(Vector::Y * 0.106),
        ColliderBuilder::cuboid(0.1, 0.005, 0.1).density(2700.0),
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, plate).unwrap();
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(plate, hydro);
    let corrected = |immersion: &Immersion| {
        let state = immersion.registry.states()[0].as_ref().unwrap();
        state.flight.corrected_contacts
    };
    for _ in 0..20 {
        immersion.step(&mut world);
    }
    assert_eq!(corrected(&immersion), 3);
    immersion.set_fluid(Fluid::AIR);
    immersion.before_step(&mut RapierSets::of(&mut world));
    assert_eq!(corrected(&immersion), 0);
}

/// Of several contacts the strongest decides the mass: a box that stands on the floor and just touches a wall
/// shows the mass that it has along the vertical.
#[test]
fn the_strongest_contact_has_the_normal() {
    let mut world = PhysicsWorld::new();
    let floor = ColliderBuilder::cuboid(1.0, 0.1, 1.0);
    world.insert(RigidBodyBuilder::fixed(), floor);
    let wall = ColliderBuilder::cuboid(0.1, 1.0, 1.0).friction(0.0);
    world.insert(
        RigidBodyBuilder::fixed().translation(Vector::X * 0.201),
        wall,
    );
    let (handle, _) = world.insert(
        RigidBodyBuilder::dynamic().translation(Vector::Y * 0.15),
        ColliderBuilder::cuboid(0.1, 0.05, 0.1).density(2700.0),
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(handle, hydro);
    for _ in 0..30 {
        immersion.step(&mut world);
    }
    let sets = RapierSets::of(&mut world);
    let state = immersion.registry.states()[0].as_ref().unwrap();
    let shared = immersion.constants.get(state.constants).unwrap();
    let body = &sets.bodies[handle];
    assert_eq!(sets.narrow_phase.contact_pairs().count(), 2);
    let normal = contact_mass::normal(shared, body, &sets).unwrap();
    assert!(normal.y.abs() > 0.99, "{normal}");
}

/// Normals that point opposite ways are one direction to a mass: a box between two walls shows the mass that it
/// has across them.
#[test]
fn opposite_contacts_are_one_direction() {
    let mut world = PhysicsWorld {
        gravity: Vector::ZERO,
        ..PhysicsWorld::new()
    };
    for side in [-0.2, 0.2] {
        let wall = ColliderBuilder::cuboid(0.1, 1.0, 1.0).translation(Vector::X * side);
        world.insert(RigidBodyBuilder::fixed(), wall);
    }
    let (handle, _) = world.insert(
        RigidBodyBuilder::dynamic(),
        ColliderBuilder::cuboid(0.0999, 0.05, 0.1).density(2700.0),
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(handle, hydro);
    for _ in 0..3 {
        immersion.step(&mut world);
    }
    let sets = RapierSets::of(&mut world);
    let state = immersion.registry.states()[0].as_ref().unwrap();
    let shared = immersion.constants.get(state.constants).unwrap();
    let normal = contact_mass::normal(shared, &sets.bodies[handle], &sets).unwrap();
    assert!(normal.x.abs() > 0.99, "{normal}");
}

/// What a fast, heavy ball sees of the turbulence is the process of `SeenFluctuation` with the noise of its own
/// stream, number by number, whichever way it flies: its slip, here averaged once more, shortens the memory.
#[test]
fn a_body_sees_the_fluctuation_of_its_own_stream() {
    for direction in [
        Vector::X,
        Vector::Y,
        Vector::Z,
        Vector::new(0.6, -0.48, 0.64),
    ] {
        let dt = 1.0 / 240.0;
        let mut world = PhysicsWorld {
            gravity: Vector::ZERO,
            ..PhysicsWorld::new()
        };
        world.integration_parameters.dt = dt;
        let (handle, _) = world.insert(
            RigidBodyBuilder::dynamic().linvel(direction * 3.0),
            ColliderBuilder::ball(0.01).density(1e5),
        );
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(handle, hydro);
        let wind = Vector::new(0.5, 0.2, -0.3);
        immersion.set_flow(Uniform::new(wind.x, wind.y, wind.z));
        let state = TurbulenceState {
            kinetic_energy: 0.6,
            dissipation: 1.5,
        };
        immersion.set_turbulence(TurbulentLayer {
            seed: 5,
            ..Turbulence::Homogeneous(state).into()
        });
        let viscosity = Fluid::AIR.kinematic_viscosity();
        let c0 = kolmogorov_constant(state.taylor_reynolds_squared(viscosity));
        let noise = NoiseStream::new(5, u64::from(handle.into_raw_parts().0));
        let mut seen = SeenFluctuation::stationary(noise.vector(0, 0));
        let mut slip = direction * 3.0 - wind;
        let mut fluctuation = Vector::ZERO;
        // Weight of a step in an average over ten memories of a tracer, ¾C₀ε/k each.
        let share = 0.75 * c0 * state.dissipation / state.kinetic_energy * dt / 10.0;
        for step in 0..60 {
            let now = world.bodies[handle].linvel() - wind - fluctuation;
            slip += (now - slip) * (share / (1.0 + share));
            let draw = u32::from(step == 0);
            let noise = noise.vector(step, draw);
            fluctuation = seen.advance(&state, c0, slip.length(), dt, noise);
            immersion.step(&mut world);
            let flight = &immersion.registry.states()[0].as_ref().unwrap().flight;
            let found = flight.turbulence.fluctuation;
            // A few hundred roundings.
            let miss = (found - fluctuation).length();
            assert!(miss < 1e-4, "{step}: {found} {fluctuation}");
            let miss = (flight.fluid_velocity - wind - found).length();
            assert!(miss < 1e-6, "{step}: {}", flight.fluid_velocity);
        }
    }
}

/// In the thesis's mode a step changes a heavy ball's velocity by the increments of two independent draws of its
/// stream, one for each of velocity and spin: what the fluid does in the meantime is a thousandth of that.
#[test]
fn increments_are_two_draws() {
    let mut world = PhysicsWorld {
        gravity: Vector::ZERO,
        ..PhysicsWorld::new()
    };
    let start = Vector::new(0.2, -0.1, 0.3);
    let (handle, _) = world.insert(
        RigidBodyBuilder::dynamic().linvel(start),
        ColliderBuilder::ball(0.05).density(1e5),
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let size = hydro.planform.half_extents.x as Real;
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert(handle, hydro);
    let state = TurbulenceState {
        kinetic_energy: 0.6,
        dissipation: 1.5,
    };
    immersion.set_turbulence(TurbulentLayer {
        seed: 5,
        mode: LangevinMode::BodyIncrements,
        ..Turbulence::Homogeneous(state).into()
    });
    immersion.step(&mut world);
    let viscosity = Fluid::AIR.kinematic_viscosity();
    let c0 = kolmogorov_constant(state.taylor_reynolds_squared(viscosity));
    let noise = NoiseStream::new(5, u64::from(handle.into_raw_parts().0));
    let dt = world.integration_parameters.dt;
    let linear = relative_velocity_after(start, &state, c0, dt, noise.vector(0, 0));
    let angular = spin_increment(&state, c0, size, dt, noise.vector(0, 1));
    let body = &world.bodies[handle];
    let miss = (body.linvel() - linear).length();
    assert!(miss < 1e-3 * linear.length(), "{} {linear}", body.linvel());
    let miss = (body.angvel() - angular).length();
    assert!(
        miss < 1e-3 * angular.length(),
        "{} {angular}",
        body.angvel()
    );
}
