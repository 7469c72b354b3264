//! What floats goes on alike: in two runs, in a copy, from a snapshot, with any number of threads; and whatever stands in a
//! snapshot of it is refused or goes on as numbers.

use rapier3d::prelude::*;
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::free_surface::{Dispersion, Wave, Waves};
use rapier3d_immersed::rapier3d;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, Layer, Medium};

/// Crates on waves, in wind, over brine: afloat, sinking, and falling in.
fn scene(count: usize) -> (PhysicsWorld, Immersion, Vec<RigidBodyHandle>) {
    let mut world = PhysicsWorld::new();
    let handles: Vec<_> = (0..count)
        .map(|i| {
            let at = Vector::new(
                (i % 10) as f32 * 2.0,
                (i % 7) as f32 * 0.3 - 0.9,
                (i / 10) as f32 * 2.0,
            );
            let body = RigidBodyBuilder::dynamic()
                .translation(at)
                .rotation(Vector::X * i as f32);
            let density = 300.0 + 200.0 * (i % 5) as f32;
            world
                .insert(
                    body,
                    ColliderBuilder::cuboid(0.3, 0.2, 0.4).density(density),
                )
                .0
        })
        .collect();
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handles[0]).unwrap();
    let mut immersion = Immersion::new(medium());
    immersion.insert_all(handles.iter().copied(), hydro);
    (world, immersion, handles)
}

fn wind() -> Uniform {
    Uniform::new(4.0, 0.0, 1.0)
}

fn waves() -> Waves {
    let wave = Wave {
        amplitude: 0.2,
        wavelength: 12.0,
        ..Wave::default()
    };
    Waves::new(Dispersion::default(), &[wave]).unwrap()
}

fn medium() -> Medium {
    let wind = Layer::new(Fluid::AIR).with_flow(wind());
    let brine = Fluid::new(1100.0, 1e-6).unwrap();
    let medium = Medium::layered(wind, Fluid::WATER).with_surface(waves());
    medium.with_layer_below(0.8, brine).unwrap()
}

fn run(world: &mut PhysicsWorld, immersion: &mut Immersion, steps: usize) {
    (0..steps).for_each(|_| immersion.step(world));
}

fn bits(world: &PhysicsWorld, handles: &[RigidBodyHandle]) -> Vec<u32> {
    let numbers = handles.iter().flat_map(|handle| {
        let body = &world.bodies[*handle];
        let (at, turn, v, w) = (
            body.translation(),
            body.rotation(),
            body.linvel(),
            body.angvel(),
        );
        let turn = turn.to_array();
        [at.x, at.y, at.z, v.x, v.y, v.z, w.x, w.y, w.z]
            .into_iter()
            .chain(turn)
    });
    numbers.map(f32::to_bits).collect()
}

#[test]
fn two_runs_and_a_copy_are_alike() {
    let whole = |steps| {
        let (mut world, mut immersion, handles) = scene(30);
        run(&mut world, &mut immersion, steps);
        (bits(&world, &handles), world, immersion, handles)
    };
    let (expected, ..) = whole(120);
    let (_, world, immersion, handles) = whole(60);
    let (mut world, mut copy) = (world, immersion.clone());
    run(&mut world, &mut copy, 60);
    assert_eq!(bits(&world, &handles), expected);
}

#[cfg(feature = "parallel")]
#[test]
fn threads_change_nothing() {
    use rapier3d_immersed::rapier3d::rayon::ThreadPoolBuilder;
    let with = |threads| {
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let (mut world, mut immersion, handles) = scene(200);
            run(&mut world, &mut immersion, 60);
            bits(&world, &handles)
        })
    };
    assert_eq!(with(1), with(2));
}

/// A fluid that was coming to rest when the snapshot was made goes on doing so.
#[cfg(feature = "serde-serialize")]
#[test]
fn a_fluid_that_comes_to_rest_does_so_in_a_copy() {
    let (mut world, mut immersion, handles) = scene(30);
    immersion.set_medium(Medium::layered(
        Layer::new(Fluid::AIR),
        Layer::new(Fluid::WATER).with_flow(wind()),
    ));
    run(&mut world, &mut immersion, 60);
    immersion.clear_flow();
    run(&mut world, &mut immersion, 5);
    let snapshot = postcard::to_stdvec(&(&world, &immersion)).unwrap();
    let (mut other, mut restored): (PhysicsWorld, Immersion) =
        postcard::from_bytes(&snapshot).unwrap();
    for step in 0..60 {
        run(&mut world, &mut immersion, 1);
        run(&mut other, &mut restored, 1);
        assert_eq!(bits(&world, &handles), bits(&other, &handles), "{step}");
    }
}

/// A snapshot has all but the flow and the waves. Set again, they leave no trace of it; and neither does a copy of the
/// immersion beside a world that was read.
#[cfg(feature = "serde-serialize")]
#[test]
fn a_restored_snapshot_goes_on_alike() {
    let (mut world, mut immersion, handles) = scene(30);
    run(&mut world, &mut immersion, 60);
    let snapshot = postcard::to_stdvec(&(&world, &immersion)).unwrap();
    let read = || -> (PhysicsWorld, Immersion) { postcard::from_bytes(&snapshot).unwrap() };
    let (mut other, mut restored) = read();
    restored.set_flow(wind());
    restored.set_surface(waves());
    let (mut third, mut copy) = (read().0, immersion.clone());
    run(&mut world, &mut immersion, 60);
    run(&mut other, &mut restored, 60);
    run(&mut third, &mut copy, 60);
    assert_eq!(bits(&world, &handles), bits(&other, &handles));
    assert_eq!(bits(&world, &handles), bits(&third, &handles));
}

#[cfg(feature = "serde-serialize")]
#[test]
fn altered_snapshots_are_refused_or_go_on() {
    let (mut world, mut immersion, _) = scene(2);
    run(&mut world, &mut immersion, 30);
    let written = postcard::to_stdvec(&world).unwrap();
    let (refused, loaded) = crate::fuzz::fuzz(&immersion, |mut loaded: Immersion| {
        let mut world: PhysicsWorld = postcard::from_bytes(&written).unwrap();
        run(&mut world, &mut loaded, 3);
        crate::fuzz::assert_finite(&world);
    });
    println!("{refused} refused, {loaded} loaded");
    assert!(refused > 1000 && loaded > 1000);
}
