//! Tests of the step that need both its inside and the façade.

use super::contact_mass;
use super::workspace::CloseBodies;
use crate::body::ImmersedBody;
use crate::coupling::{Immersion, RapierSets};
use crate::flow::{GridFlow, Layers, Shear, Vortex};
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::hydro::viscous::{StochasticLaw, ThesisLaw, ViscousLaw};
use crate::math::NARROW;
use crate::turbulence::{Turbulence, TurbulenceState};
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
