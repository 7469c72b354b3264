//! The same result, bit for bit: in two runs, for any number of threads, whoever else flies, and
//! after a snapshot.

use rapier3d_immersed::rapier3d::na;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    Fluid, Hinge, HydroProperties, ImmersedBody, Immersion, Part, StochasticLaw, ThesisLaw,
    Thruster, ViscousLaw,
};

/// Leaves of several kinds and laws over a floor.
fn scene(count: usize) -> (PhysicsWorld, Immersion, Vec<RigidBodyHandle>) {
    let mut world = PhysicsWorld::new();
    let mut immersion = Immersion::new(Fluid::AIR);
    let laws = [
        ViscousLaw::default(),
        ViscousLaw::Thesis(ThesisLaw::new(ThesisLaw::ZIGZAG)),
        ViscousLaw::Stochastic(StochasticLaw::default()),
    ];
    let handles = (0..count).map(|i| {
        let x = i as Real;
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::new(
                0.2 * (x % 30.0),
                0.2 + 0.05 * (x % 7.0),
                0.006 * x,
            ))
            .rotation(Vector::new(x, 0.3 * x, 0.0));
        let wide = 0.02 + 0.005 * (i % 3) as Real;
        let handle = world
            .insert(
                body,
                ColliderBuilder::cuboid(0.04, 0.0005, wide).density(200.0),
            )
            .0;
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
        let mut body = ImmersedBody::new(hydro).with_law(laws[i % 7 % 3]).unwrap();
        // Some are of parts, of which one is a flap, or have an engine.
        if i % 4 == 3 {
            let plate = Cuboid::new(Vector::new(0.04, 0.0005, wide));
            let strips = HydroProperties::strips_of_shape(&plate, 2 + i % 3).unwrap();
            let hinge = Hinge::new(Default::default(), na::Vector3::x()).unwrap();
            let flap = |strip| Part::new(strip).with_hinge(hinge);
            body = body.with_parts(strips.into_iter().map(flap));
        } else if i % 9 == 4 {
            let engine = Thruster::new(Default::default(), na::Vector3::x()).unwrap();
            body = body.with_thrusters([engine]);
        }
        immersion.insert(handle, body);
        immersion.set_deflection(handle, i % 2, 0.1 * (i % 5) as f32);
        immersion.set_thrust(handle, 0, 1e-3);
        handle
    });
    let handles = handles.collect();
    world.insert(
        RigidBodyBuilder::fixed().translation(Vector::Y * -0.5),
        ColliderBuilder::cuboid(20.0, 0.5, 20.0),
    );
    (world, immersion, handles)
}

fn bits(world: &PhysicsWorld, handles: &[RigidBodyHandle]) -> Vec<u32> {
    let numbers = handles.iter().flat_map(|handle| {
        let body = &world.bodies[*handle];
        [
            body.translation().to_array().to_vec(),
            body.rotation().to_array().to_vec(),
            body.linvel().to_array().to_vec(),
            body.angvel().to_array().to_vec(),
        ]
        .concat()
    });
    numbers.map(f32::to_bits).collect()
}

fn run(count: usize, steps: usize) -> Vec<u32> {
    let (mut world, mut immersion, handles) = scene(count);
    for _ in 0..steps {
        immersion.step(&mut world);
    }
    bits(&world, &handles)
}

#[test]
fn two_runs_agree() {
    assert_eq!(run(50, 120), run(50, 120));
}

/// A body's flight does not depend on which other bodies are advanced beside it.
#[test]
fn neighbours_do_not_matter() {
    let (mut world, mut immersion, handles) = scene(23);
    let (mut fewer, mut rest, same) = scene(23);
    // Only flight: nothing to collide with.
    for (world, handles) in [(&mut world, &handles), (&mut fewer, &same)] {
        for handle in handles {
            let high = world.bodies[*handle].translation() * 20.0 + Vector::Y * 100.0;
            world.bodies[*handle].set_translation(high, true);
        }
    }
    for handle in same.iter().skip(1).step_by(2) {
        fewer.remove_body(*handle);
    }
    for _ in 0..100 {
        immersion.step(&mut world);
        rest.step(&mut fewer);
    }
    let kept: Vec<_> = handles.iter().step_by(2).copied().collect();
    let same: Vec<_> = same.iter().step_by(2).copied().collect();
    assert_eq!(bits(&world, &kept), bits(&fewer, &same));
}

#[cfg(feature = "parallel")]
#[test]
fn one_thread_and_two_agree() {
    use rapier3d_immersed::rapier3d::rayon::ThreadPoolBuilder;
    let with_threads = |threads| {
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        // More bodies than one task takes.
        pool.install(|| run(1500, 40))
    };
    assert_eq!(with_threads(1), with_threads(2));
}

#[cfg(feature = "serde-serialize")]
#[test]
fn a_restored_snapshot_goes_on_alike() {
    let (mut world, mut immersion, handles) = scene(50);
    for _ in 0..60 {
        immersion.step(&mut world);
    }
    let snapshot = postcard::to_stdvec(&(&world, &immersion)).unwrap();
    let (mut other, mut restored): (PhysicsWorld, Immersion) =
        postcard::from_bytes(&snapshot).unwrap();
    // A copy beside a world that was read is as good.
    let (mut third, mut copy): (PhysicsWorld, Immersion) = (
        postcard::from_bytes::<(PhysicsWorld, Immersion)>(&snapshot)
            .unwrap()
            .0,
        immersion.clone(),
    );
    for _ in 0..60 {
        immersion.step(&mut world);
        restored.step(&mut other);
        copy.step(&mut third);
    }
    assert_eq!(bits(&world, &handles), bits(&other, &handles));
    assert_eq!(bits(&world, &handles), bits(&third, &handles));
}
