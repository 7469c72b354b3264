//! Laws that a user brings, against what they say.

use rapier3d_immersed::rapier3d::na::{Isometry3, Matrix3, Matrix6, Vector3, Vector6};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    CustomLaw, Damping, DragBox, DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody, Part,
    PartLaw, PolarRow, PolarTable,
};
use std::f64::consts::PI;

const DENSITY: f64 = 1.2;

fn wide(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z).map(f64::from)
}

/// A body whose one part, at the origin, is under this law; with a mass of 1 kg there.
fn body(hydro: HydroProperties, law: impl Into<PartLaw>) -> FreeBody {
    let part = Part::new(hydro.clone()).with_law(law);
    let body = ImmersedBody::new(hydro).with_parts([part]);
    let mass = DryMass {
        mass: 1.0,
        center: Vector3::zeros(),
        inertia: Matrix3::identity() * 0.01,
    };
    FreeBody::new(&body, &mass, &Fluid::new(DENSITY as f32, 1.5e-5).unwrap()).unwrap()
}

fn load(free: &mut FreeBody, u: Vector3<f64>, w: Vector3<f64>) -> [Vector3<f64>; 2] {
    free.set_velocity(u, w);
    let viscous = free.forces(Vector3::zeros()).viscous();
    [wide(viscous.force), wide(viscous.torque)]
}

/// A table gives its coefficients: lift, drag and moment about the quarter chord of a wing in the xz plane, chord along z, at every
/// angle of its circle, to single precision of the read-out.
#[test]
fn tables_give_what_stands_in_them() {
    let wing = HydroProperties::from_shape(&Cuboid::new(Vector::new(0.5, 0.002, 0.1))).unwrap();
    let (area, chord) = (0.2, 0.2);
    let rows: Vec<PolarRow> = (-18..=18)
        .map(|i| {
            let angle = 10.0 * f64::from(i);
            PolarRow {
                angle,
                lift: (2.0 * angle.to_radians()).sin(),
                drag: 0.01 + angle.to_radians().sin().powi(2),
                moment: -0.2 * angle.to_radians().sin(),
            }
        })
        .collect();
    let table = PolarTable::new(&rows)
        .unwrap()
        .with_axes(Vector3::z(), Vector3::y(), 0.25)
        .unwrap();
    let mut free = body(wing, table);
    for row in &rows {
        let angle = row.angle.to_radians();
        let u = Vector3::new(0.0, -angle.sin(), angle.cos()) * 20.0;
        let [force, torque] = load(&mut free, u, Vector3::zeros());
        let pressure = 0.5 * DENSITY * 400.0 * area;
        let up = Vector3::new(0.0, angle.cos(), angle.sin());
        let along = u / -20.0;
        let exact = (up * row.lift + along * row.drag) * pressure;
        assert!(
            (force - exact).norm() < 1e-4 * pressure,
            "{}: {force} {exact}",
            row.angle
        );
        // Nose up turns z toward y: about −x.
        let reference = Vector3::z() * (0.25 * chord);
        let moment = Vector3::x() * (-pressure * chord * row.moment) + reference.cross(&exact);
        assert!(
            (torque - moment).norm() < 1e-4 * pressure,
            "{}: {torque} {moment}",
            row.angle
        );
    }
}

/// A body of revolution under a table faces wherever it moves, as it turns about its axle; its moments are about its middle, in which
/// the plate's force that continues a table acts.
#[test]
fn tables_of_revolution_face_the_motion() {
    let disc = HydroProperties::from_shape(&Cylinder::new(0.01, 0.1)).unwrap();
    let (area, diameter) = (0.01 * PI, 0.2);
    let table = PolarTable::from_csv("-20, -0.8, 0.3, 0.1\n20, 1.2, 0.3, -0.2").unwrap();
    let table = table.with_revolution(Vector3::y()).unwrap();
    assert!(table.at(70.0, 1e5).moment.abs() < 1e-9);
    let mut free = body(disc, table.clone());
    for degree in [0.0, 50.0, 130.0, 290.0_f64] {
        let (sine, cosine) = degree.to_radians().sin_cos();
        let forward = Vector3::new(cosine, 0.0, sine);
        for angle in [-60.0, -10.0, 0.0, 5.0, 30.0_f64] {
            let (rise, ahead) = angle.to_radians().sin_cos();
            let u = (forward * ahead - Vector3::y() * rise) * 10.0;
            let up = forward * rise + Vector3::y() * ahead;
            let [force, torque] = load(&mut free, u, Vector3::y() * 30.0);
            let row = table.at(angle, 1e5);
            let pressure = 0.5 * DENSITY * 100.0 * area;
            let exact = (up * row.lift - u * (0.1 * row.drag)) * pressure;
            assert!(
                (force - exact).norm() < 1e-3 * pressure,
                "{degree}, {angle}: {force} {exact}"
            );
            let moment = forward.cross(&Vector3::y()) * (pressure * diameter * row.moment);
            assert!(
                (torque - moment).norm() < 1e-3 * pressure * diameter,
                "{degree}, {angle}: {torque} {moment}"
            );
        }
    }
}

/// Between Reynolds numbers coefficients are linear in the logarithm, beyond them constant.
#[test]
fn tables_by_reynolds_number() {
    let row = |angle: f64, drag: f64| PolarRow {
        angle,
        lift: 0.0,
        drag,
        moment: 0.0,
    };
    let slow = [row(-90.0, 0.4), row(0.0, 0.4), row(90.0, 0.4)];
    let fast = [row(-90.0, 0.2), row(0.0, 0.2), row(90.0, 0.2)];
    let table = PolarTable::by_reynolds_number(&[(1e4, &slow), (1e6, &fast)]).unwrap();
    for (re, drag) in [(1e3, 0.4), (1e4, 0.4), (1e5, 0.3), (1e6, 0.2), (1e8, 0.2)] {
        assert!((table.at(30.0, re).drag - drag).abs() < 1e-9, "{re}");
    }
    assert!(PolarTable::by_reynolds_number(&[(1e6, &slow), (1e4, &fast)]).is_err());
    assert!(PolarTable::by_reynolds_number(&[]).is_err());
}

/// Tables that cannot be: the error names the row or the number.
#[test]
fn bad_tables_are_named() {
    for (text, named) in [
        ("", "0"),
        ("0, 0.1, 0.01", "1"),
        ("0, 0.1, 0.01\n0, 0.2, 0.01", "0"),
        ("-10, 0.1, 0.01\n10, 0.2, -0.01", "-0.01"),
        ("-10, 0.1, 0.01\n190, 0.2, 0.01", "190"),
        ("-100, 0.1, 0.01\n100, 0.2, 0.01", "200"),
        ("0, 0.1, 0.01\n10, NaN, 0.01", "NaN"),
        ("0, 0.1, 0.01\n10, x, 0.01", "row 2"),
        ("0, 0.1, 0.01\n10, 0.2", "row 2"),
        ("re = many\n0, 0.1, 0.01", "many"),
        ("mach = 2\n0, 0.1, 0.01", "mach"),
    ] {
        let error = PolarTable::from_csv(text).unwrap_err().to_string();
        assert!(error.contains(named), "{text:?}: {error}");
    }
    let good = || PolarTable::from_csv("angle, cl, cd\n-5, -0.5, 0.01\n5, 0.5, 0.01").unwrap();
    assert!((good().at(2.5, 1e5).lift - 0.25).abs() < 1e-9);
    assert!(
        good()
            .with_axes(Vector3::zeros(), Vector3::y(), 0.25)
            .is_err()
    );
    assert!(good().with_axes(Vector3::y(), Vector3::y(), 0.25).is_err());
    assert!(good().with_axes(Vector3::x(), Vector3::y(), 3.0).is_err());
    assert!(
        good()
            .with_axes(Vector3::x() * f64::NAN, Vector3::y(), 0.0)
            .is_err()
    );
}

/// Drag areas by direction, at the center of the box and not at that of mass.
#[test]
fn boxes_drag_by_direction() {
    let hull = HydroProperties::from_shape(&Cuboid::new(Vector::new(0.5, 0.3, 0.2))).unwrap();
    let drag = DragBox::new(Vector3::new(0.1, 0.5, 0.7), Vector3::new(0.2, 0.5, 0.3)).unwrap();
    let mut free = body(hull, drag.at(Vector3::new(0.0, 0.1, 0.0)).unwrap());
    for (u, area) in [
        (Vector3::x() * 3.0, 0.1),
        (Vector3::x() * -3.0, 0.2),
        (Vector3::z() * 3.0, 0.7),
        (Vector3::z() * -3.0, 0.3),
    ] {
        let [force, torque] = load(&mut free, u, Vector3::zeros());
        let exact = u * (-0.5 * DENSITY * area * 3.0);
        assert!((force - exact).norm() < 1e-5, "{u}: {force} {exact}");
        let moment = Vector3::new(0.0, 0.1, 0.0).cross(&exact);
        assert!((torque - moment).norm() < 1e-5, "{u}: {torque} {moment}");
    }
}

/// The damping of BlueROV2 as it is published (von Benzon et al., *J. Mar. Sci. Eng.* 10, 1898 (2022), table A2) in each degree of
/// freedom, and off-diagonal entries, of a frame that is turned and off the center of mass.
#[test]
fn damping_in_six_degrees_of_freedom() {
    let linear = Vector6::new(13.7, 0.0, 33.0, 0.0, 0.8, 0.0);
    let quadratic = Vector6::new(141.0, 217.0, 190.0, 1.19, 0.47, 1.5);
    let mut coupled = Matrix6::from_diagonal(&linear);
    (coupled[(1, 5)], coupled[(5, 1)]) = (0.7, -0.7);
    let damping = Damping::new(coupled, Matrix6::from_diagonal(&quadratic)).unwrap();
    let hull = HydroProperties::from_shape(&Cuboid::new(Vector::new(0.2, 0.15, 0.1))).unwrap();
    let pose = Isometry3::new(Vector3::new(0.1, 0.0, -0.2), Vector3::new(0.3, 0.2, -0.4));
    let part = Part::new(hull.clone()).at(pose).with_law(damping);
    let body = ImmersedBody::new(hull).with_parts([part]);
    let mass = DryMass {
        mass: 13.5,
        center: Vector3::zeros(),
        inertia: Matrix3::identity() * 0.3,
    };
    let mut free = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
    for i in 0..30 {
        let i = f64::from(i);
        let u = Vector3::new(i.sin(), (1.3 * i).cos(), (0.7 * i).sin());
        let w = Vector3::new((2.1 * i).cos(), (0.4 * i).sin(), (1.9 * i).cos());
        let [force, torque] = load(&mut free, u, w);
        let arm = pose.translation.vector;
        let back = pose.rotation.inverse();
        let (v, spin) = (back * (u + w.cross(&arm)), back * w);
        let nu = Vector6::new(v.x, v.y, v.z, spin.x, spin.y, spin.z);
        let resisted = -(coupled * nu + quadratic.component_mul(&nu.component_mul(&nu.abs())));
        let exact = pose.rotation * resisted.fixed_rows::<3>(0);
        let moment = pose.rotation * resisted.fixed_rows::<3>(3) + arm.cross(&exact);
        assert!(
            (force - exact).norm() < 1e-5 * exact.norm(),
            "{i}: {force} {exact}"
        );
        assert!(
            (torque - moment).norm() < 1e-5 * moment.norm().max(1.0),
            "{i}"
        );
    }
}

/// A closure's force is the force, where it takes energy; and a sphere under the closure of Stokes's law settles at his
/// velocity, at any step.
#[test]
fn closures_are_asked() {
    let radius = 0.01;
    let ball = HydroProperties::from_shape(&Ball::new(radius as f32)).unwrap();
    let stokes = move |m: &rapier3d_immersed::PartMotion| {
        let viscosity = m.density * m.kinematic_viscosity;
        [
            m.linear * (-6.0 * PI * viscosity * radius),
            m.angular * (-8.0 * PI * viscosity * radius.powi(3)),
        ]
    };
    let law = CustomLaw::new(stokes).unwrap();
    let oil = Fluid::new(900.0, 1e-3).unwrap();
    let dry = DryMass {
        mass: 0.02,
        center: Vector3::zeros(),
        inertia: Matrix3::identity() * 1e-6,
    };
    let part = Part::new(ball.clone()).with_law(law);
    let body = ImmersedBody::new(ball.clone()).with_parts([part]);
    for dt in [1e-3, 0.1, 1.0] {
        let mut free = FreeBody::new(&body, &dry, &oil).unwrap();
        free.set_velocity(Vector3::zeros(), Vector3::x() * 5.0);
        for _ in 0..(10.0 / dt) as usize {
            free.step(dt, Vector3::y() * -9.81);
        }
        let weight = (dry.mass - 900.0 * ball.volume) * 9.81;
        let exact = weight / (6.0 * PI * 0.9 * radius);
        let found = -free.linear_velocity().y;
        assert!((found / exact - 1.0).abs() < 1e-6, "{dt}: {found} {exact}");
        // Damped at 22/s, to where the force fades.
        assert!(free.angular_velocity().norm() < 1e-5, "{dt}");
    }
}
