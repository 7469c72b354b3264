use rapier3d_immersed::*;
use rapier3d_immersed::rapier3d::na::*;
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
fn plate(l: f64, span: f64, t: f64, rho: f64) -> (ImmersedBody, DryMass) {
    let shape = SharedShape::cuboid((l/2.) as f32, (t/2.) as f32, (span/2.) as f32);
    let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
    let m = rho*l*span*t;
    let inertia = Matrix3::from_diagonal(&Vector3::new(t*t+span*span, l*l+span*span, l*l+t*t)) * (m/12.);
    (hydro.into(), DryMass{mass:m, center: Vector3::zeros(), inertia})
}
fn main() {
    let water = Fluid::WATER;
    for (l, t, name) in [(0.00648, 0.00081,"1/8"),(0.0081,0.00081,"1/10"),(0.01134,0.00081,"1/14")] {
      for dt in [1e-4, 1./240.,1./60.] {
        let (b, m) = plate(l, 0.19, t, 2700.);
        let mut f = FreeBody::new(&b,&m,&water).unwrap();
        f.set_orientation(UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.2));
        let g = Vector3::new(0.,-9.81,0.);
        let n = (8.0/dt) as usize;
        let (mut p0, mut ang) = (f.position, 0.0);
        let mut half=0;
        for i in 0..n { f.step(dt,g); if i==n/2 {p0=f.position; half=i; ang=0.0;} ang += f.angular_velocity().z*dt; }
        let tt = (n-half) as f64*dt;
        let v = (f.position-p0)/tt;
        println!("{name} dt {dt:.5}: vx {:.2} vy {:.2} w {:.2}", v.x*100.,v.y*100., ang/tt);
      }
    }
    // kirchhoff invariants
    for it in [1,2,4,8] { for dt in [1e-2,1e-3,1e-4] {
        let s = SharedShape::cuboid(0.1,0.05,0.02);
        let hydro = HydroProperties::from_shape(s.as_ref()).unwrap();
        let b = ImmersedBody::new(hydro).with_law(ViscousLaw::Inviscid).unwrap();
        let m = DryMass{mass:1.0,center:Vector3::zeros(),inertia:Matrix3::from_diagonal(&Vector3::new(0.002,0.003,0.004))};
        let mut f = FreeBody::new(&b,&m,&water).unwrap();
        f.integrator.iterations=it; f.integrator.max_substeps=1;
        f.set_velocity(Vector3::new(0.3,0.1,-0.2), Vector3::new(1.0,2.0,-0.5));
        let (e,p,l)=(f.kinetic_energy(),f.impulse(),f.impulse_moment());
        for _ in 0..(10.0/dt) as usize { f.step(dt, Vector3::zeros()); }
        println!("it {it} dt {dt} dE {:.1e} dP {:.1e} dL {:.1e}", f.kinetic_energy()/e-1., (f.impulse()-p).norm()/p.norm(), (f.impulse_moment()-l).norm()/l.norm());
    }}
}
