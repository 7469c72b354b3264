use rapier3d_immersed::*;
use rapier3d_immersed::rapier3d::prelude::*;
fn main() {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::ZERO;
    world.integration_parameters.dt = 1.0/240.0;
    let (h,_) = world.insert(RigidBodyBuilder::dynamic().linvel(Vector::new(0.3,0.1,-0.2)).angvel(Vector::new(1.0,2.0,-0.5)), ColliderBuilder::cuboid(0.1,0.05,0.02).density(2000.0));
    let hydro = HydroProperties::from_body(&world.bodies,&world.colliders,h).unwrap();
    println!("{hydro:?}");
    let m = DryMass::of_body(&world.bodies,&world.colliders,h).unwrap();
    println!("{m:?}");
    let b = ImmersedBody::new(hydro).with_law(ViscousLaw::Inviscid).unwrap();
    let mut f = FreeBody::new(&b,&m,&Fluid::WATER).unwrap();
    f.set_velocity(rapier3d::na::Vector3::new(0.3,0.1,-0.2), rapier3d::na::Vector3::new(1.0,2.0,-0.5));
    let mut im = Immersion::new(Fluid::WATER);
    im.insert(h,b);
    for i in 0..6 {
        im.step(&mut world);
        f.step(1.0/240.0, rapier3d::na::Vector3::zeros());
        let r=&world.bodies[h];
        println!("{i} v {:?} w {:?} x {:?} q {:?}", r.linvel(), r.angvel(), r.center_of_mass(), r.rotation());
        println!("   {:?} {:?} {:?} {:?}", f.linear_velocity().as_slice(), f.angular_velocity().as_slice(), f.position.as_slice(), f.orientation().coords.as_slice());
        println!("{:?} mass {}", im.warnings(), r.mass());
    }
}
