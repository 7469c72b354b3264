use rapier3d_immersed::rapier3d::na::*;
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use rapier3d_immersed::*;
fn plate(l: f64, span: f64, t: f64, rho: f64) -> (ImmersedBody, DryMass) {
    let shape = SharedShape::cuboid((l / 2.) as f32, (t / 2.) as f32, (span / 2.) as f32);
    let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
    let m = rho * l * span * t;
    let inertia = Matrix3::from_diagonal(&Vector3::new(
        t * t + span * span,
        l * l + span * span,
        l * l + t * t,
    )) * (m / 12.);
    (
        hydro.into(),
        DryMass {
            mass: m,
            center: Vector3::zeros(),
            inertia,
        },
    )
}
fn main() {
    let arg = |i: usize| -> f64 { std::env::args().nth(i).unwrap().parse().unwrap() };
    let water = Fluid::WATER;
    for (l, t, name) in [
        (0.00648, 0.00081, "1/8"),
        (0.0081, 0.00081, "1/10"),
        (0.01134, 0.00081, "1/14"),
    ] {
        for dt in [1e-3, 1. / 240., 1. / 60.] {
            print!("{name} dt {dt:.5}: ");
            for a in [5, 20, 45] {
                let (b, m) = plate(l, arg(4), t, 2700.);
                let mut f = FreeBody::new(&b, &m, &water).unwrap();
                f.integrator.max_turn = arg(1);
                f.integrator.max_travel = arg(2);
                f.integrator.iterations = arg(3) as u32;
                f.set_orientation(UnitQuaternion::from_axis_angle(
                    &Vector3::z_axis(),
                    (a as f64).to_radians(),
                ));
                let g = Vector3::new(0., -9.81, 0.);
                let n = (12.0 / dt) as usize;
                let (mut p0, mut ang) = (f.position, 0.0);
                let mut half = 0;
                for i in 0..n {
                    f.step(dt, g);
                    if i == n / 2 {
                        p0 = f.position;
                        half = i;
                        ang = 0.0;
                    }
                    ang += f.angular_velocity().z * dt;
                }
                let tt = (n - half) as f64 * dt;
                let v = (f.position - p0) / tt;
                print!(" [{:.1} {:.1} {:.1}]", v.x * 100., v.y * 100., ang / tt);
            }
            println!();
        }
    }
}
