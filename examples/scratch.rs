use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::*;
fn main() {
    let count = 400usize;
    let mut world = PhysicsWorld::new();
    let hs: Vec<_> = (0..count)
        .map(|i| {
            let cell = [i % 8, i / 8 % 8, i / 64].map(|x| x as Real * 0.5);
            let turn = Vector::new(0.3 + cell[0], 0.7 + cell[1], cell[2]);
            world
                .insert(
                    RigidBodyBuilder::dynamic()
                        .translation(Vector::from_array(cell) + Vector::Y * 100.0)
                        .rotation(turn),
                    ColliderBuilder::cuboid(0.0365, 0.000_15, 0.021).density(300.0),
                )
                .0
        })
        .collect();
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, hs[0]).unwrap();
    let mut im = Immersion::new(Fluid::AIR);
    if let Some(x) = std::env::args().nth(1) {
        im.integrator.max_turn = x.parse().unwrap();
    }
    if let Some(x) = std::env::args().nth(2) {
        im.integrator.max_travel = x.parse().unwrap();
    }
    im.insert_all(hs.iter().copied(), hydro);
    for _ in 0..120 {
        im.step(&mut world);
    }
    let mut s = 0.0;
    let mut v = 0.0;
    for h in &hs {
        s += world.bodies[*h].angvel().length();
        v += world.bodies[*h].linvel().length();
    }
    println!("mean spin {} speed {}", s / count as f32, v / count as f32);
}
