//! A body whose center of mass G is not the center C of its volume: where buoyancy and the pressure of an
//! accelerating flow act, and how much fluid it drags along there.
//!
//! For a body with three planes of symmetry that G leaves along one axis only, everything follows from the
//! added masses about C, by hand: sway along x with velocity v of G, rotation ω about z, and C at (0, d, 0)
//! from G move C by v − dω along x. All of it in an ideal fluid.

use crate::support::weightless;
use rapier3d_immersed::flow::Flow;
use rapier3d_immersed::rapier3d::na::{Matrix3, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody, Immersion, ViscousLaw,
};

/// Half extents, m: the plate's axes are not the frame's (its longest axis is z, its shortest y).
const HALF: [f64; 3] = [0.10, 0.06, 0.15];
/// From G to C, m, along y.
const ARM: f64 = 0.03;
/// Moment of inertia about z through G, kg·m²; the others are larger.
const INERTIA: f64 = 0.05;

/// The body in one plane: what its equations of motion consist of.
struct Planar {
    mass: f64,
    displaced: f64,
    /// Added mass along x and added moment of inertia about z, both about C.
    sway: f64,
    turn: f64,
}

fn shape() -> HydroProperties {
    let [x, y, z] = HALF.map(|half| half as Real);
    HydroProperties::from_shape(&Cuboid::new(Vector::new(x, y, z))).unwrap()
}

/// Neutrally buoyant in water, G below the middle of the box.
fn body() -> (ImmersedBody, DryMass, Planar) {
    let hydro = shape();
    let rho = f64::from(Fluid::WATER.density());
    let planar = Planar {
        mass: rho * hydro.volume,
        displaced: rho * hydro.volume,
        sway: rho * hydro.added_mass.linear[(0, 0)],
        turn: rho * hydro.added_mass.angular[(2, 2)],
    };
    let dry = DryMass {
        mass: planar.mass,
        center: Vector3::y() * -ARM,
        inertia: Matrix3::from_diagonal(&Vector3::new(1.2, 1.1, 1.0)) * INERTIA,
    };
    let body = ImmersedBody::new(hydro);
    (body.with_law(ViscousLaw::Inviscid).unwrap(), dry, planar)
}

/// A body under another law whose center of mass is off its middle in all three directions.
pub(super) fn lopsided(law: ViscousLaw) -> (ImmersedBody, DryMass) {
    let (body, mut dry, _) = body();
    dry.center = Vector3::new(0.02, -ARM, 0.01);
    dry.mass *= 1.3;
    (body.with_law(law).unwrap(), dry)
}

/// The same body in rapier.
fn inserted(world: &mut PhysicsWorld, turn: Vector) -> (RigidBodyHandle, ImmersedBody, Planar) {
    let (_, dry, planar) = body();
    let moments = dry.inertia.diagonal();
    let moments = Vector::new(moments.x as Real, moments.y as Real, moments.z as Real);
    let center = Vector::Y * -ARM as Real;
    let [x, y, z] = HALF.map(|half| half as Real);
    let (handle, _) = world.insert(
        RigidBodyBuilder::dynamic().rotation(turn),
        ColliderBuilder::cuboid(x, y, z).mass_properties(MassProperties::new(
            center,
            dry.mass as Real,
            moments,
        )),
    );
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let body = ImmersedBody::new(hydro);
    (handle, body.with_law(ViscousLaw::Inviscid).unwrap(), planar)
}

impl Planar {
    /// Metacentric period of small oscillations. With v eliminated by the momentum along x, which is
    /// conserved, `m v + A (v − dω) = 0`, the energy is ½Jω² + ½ρVg d θ².
    fn period(&self, gravity: f64) -> f64 {
        let reduced = self.mass * self.sway / (self.mass + self.sway);
        let inertia = INERTIA + self.turn + ARM * ARM * reduced;
        std::f64::consts::TAU * (inertia / (self.displaced * gravity * ARM)).sqrt()
    }

    /// v̇ and ω̇ per acceleration of the fluid along x: the pressure gradient pushes with ρV, the added mass
    /// with A times the acceleration relative to the fluid, both at C.
    fn response(&self) -> [f64; 2] {
        let push = self.displaced + self.sway;
        self.acceleration(push, -ARM * push)
    }

    /// v̇ and ω̇ under a force along x at G and a torque about z.
    ///
    /// ```text
    /// (m + A) v̇ − A d ω̇ = F
    /// −A d v̇ + (I + A₂₂ + A d²) ω̇ = T
    /// ```
    fn acceleration(&self, force: f64, torque: f64) -> [f64; 2] {
        let (m11, m12) = (self.mass + self.sway, -self.sway * ARM);
        let m22 = INERTIA + self.turn + self.sway * ARM * ARM;
        let determinant = m11 * m22 - m12 * m12;
        [
            (force * m22 - m12 * torque) / determinant,
            (m11 * torque - m12 * force) / determinant,
        ]
    }
}

/// The time of the full oscillation of which `angle_after` tells the angles, step by step.
fn period(dt: f64, mut angle_after: impl FnMut() -> f64) -> f64 {
    let (mut last, mut time, mut first) = (f64::NAN, 0.0, None);
    let mut crossings = 0;
    loop {
        let angle = angle_after();
        time += dt;
        assert!(time < 60.0, "it does not swing back");
        if angle * last < 0.0 {
            let at = time - dt * angle / (angle - last);
            crossings += 1;
            match first {
                None => first = Some(at),
                Some(first) if crossings == 3 => return at - first,
                Some(_) => {}
            }
        }
        last = angle;
    }
}

/// It swings about the upright position with the metacentric period: 1e-5 of it are what the amplitude of
/// 0.01 rad (6e-6) and the step of a thousandth of it (3e-6) change.
#[test]
fn metacentric_period_of_a_free_body() {
    let (body, dry, planar) = body();
    let exact = planar.period(9.81);
    let mut body = FreeBody::new(&body, &dry, &Fluid::WATER).unwrap();
    body.set_orientation(UnitQuaternion::from_scaled_axis(Vector3::z() * 0.01));
    let dt = exact / 1000.0;
    let found = period(dt, || {
        body.step(dt, Vector3::y() * -9.81);
        body.orientation().scaled_axis().z
    });
    assert!((found / exact - 1.0).abs() < 1e-5, "{found} {exact}");
}

/// The same through rapier, whose single precision and the amplitude of 0.05 rad (2e-4) leave 5e-4. The
/// swing's axis lies askew in the world.
#[test]
fn metacentric_period_through_rapier() {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1.0 / 240.0;
    let course = Rotation::from_rotation_y(0.7);
    let tilt = course * Rotation::from_rotation_z(0.05);
    let (handle, body, planar) = inserted(&mut world, tilt.to_scaled_axis());
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(handle, body);
    let exact = planar.period(9.81);
    let found = period(1.0 / 240.0, || {
        immersion.step(&mut world);
        let turn = course.inverse() * *world.bodies[handle].rotation();
        f64::from(2.0 * turn.z)
    });
    assert!((found / exact - 1.0).abs() < 5e-4, "{found} {exact}");
}

/// Buoyancy acts at C: its torque about G is d × (−ρVg), in every attitude.
#[test]
fn torque_of_buoyancy() {
    let mut world = PhysicsWorld::new();
    let turn = Vector::new(0.4, -0.8, 1.1);
    let (handle, body, planar) = inserted(&mut world, turn);
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(handle, body);
    immersion.step(&mut world);
    let rapier = &world.bodies[handle];
    let forces = immersion.forces(&world.bodies, handle).unwrap();
    let lift = Vector::Y * (planar.displaced * 9.81) as Real;
    let arm = *rapier.rotation() * Vector::Y * ARM as Real;
    let torque = arm.cross(lift);
    assert!((forces.buoyancy.force - lift).length() < 1e-5 * lift.length());
    assert!((forces.buoyancy.torque - torque).length() < 1e-5 * lift.length() * ARM as Real);
}

/// A body swings alike, to the bit, whether it is alone or first or last among others of no arm, with which it
/// takes the step side by side (their axes of inertia are askew, so that they take the same route).
#[test]
fn neighbours_without_arm_do_not_matter() {
    let pose = |before: usize, after: usize| {
        let mut world = PhysicsWorld::new();
        let mut immersion = Immersion::new(Fluid::WATER);
        let mut straight = |world: &mut PhysicsWorld, count: usize| {
            for i in 0..count {
                let at = Vector::new(0.0, 5.0, 3.0 * (1 + i + before) as Real);
                let [x, y, z] = HALF.map(|half| half as Real);
                let moments = Vector::new(0.06, 0.055, 0.05);
                let askew = Rotation::from_scaled_axis(Vector::new(0.3, 0.2, 0.1));
                let mass =
                    MassProperties::with_principal_inertia_frame(Vector::ZERO, 7.2, moments, askew);
                let (handle, _) = world.insert(
                    RigidBodyBuilder::dynamic().translation(at),
                    ColliderBuilder::cuboid(x, y, z).mass_properties(mass),
                );
                let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle);
                let body = ImmersedBody::new(hydro.unwrap());
                immersion.insert(handle, body.with_law(ViscousLaw::Inviscid).unwrap());
            }
        };
        straight(&mut world, before);
        let (handle, body, _) = inserted(&mut world, Vector::new(0.3, 0.2, 0.4));
        straight(&mut world, after);
        immersion.insert(handle, body);
        (0..60).for_each(|_| immersion.step(&mut world));
        let swung = world.bodies[handle].angvel();
        assert!(swung.length() > 0.1, "{swung}");
        *world.bodies[handle].position()
    };
    let alone = pose(0, 0);
    assert_eq!(pose(0, 3), alone);
    assert_eq!(pose(3, 0), alone);
}

/// A uniform stream that speeds up from rest.
struct SpeedingUp(Vector);

impl Flow for SpeedingUp {
    fn velocity(&self, _point: Vector, time: f64) -> Vector {
        self.0 * time as Real
    }
}

/// A flow that speeds up across the axis through G and C turns the body: its moment acts at C. The body
/// turns by 3e-3 rad and moves through the fluid at a hundredth of what would matter, which is the tolerance.
#[test]
fn an_accelerating_flow_turns_the_body() {
    for sign in [1.0, -1.0] {
        let mut world = weightless();
        world.integration_parameters.dt = 1.0 / 240.0;
        let turn = Rotation::from_scaled_axis(Vector::new(0.5, 0.9, -0.3));
        let (handle, body, planar) = inserted(&mut world, turn.to_scaled_axis());
        let mut immersion = Immersion::new(Fluid::WATER);
        let acceleration = 0.1 * sign;
        immersion.set_flow(SpeedingUp(turn * Vector::X * acceleration));
        immersion.insert(handle, body);
        for _ in 0..25 {
            immersion.step(&mut world);
        }
        // The flow is read at the start of each step, and it is known from the second on.
        let speed = f64::from(acceleration) * 24.0 / 240.0;
        let [linear, angular] = planar.response().map(|per| (per * speed) as Real);
        let rapier = &world.bodies[handle];
        let v = turn.inverse() * rapier.linvel() - Vector::X * linear;
        let w = turn.inverse() * rapier.angvel() - Vector::Z * angular;
        assert!(angular.abs() > 0.02, "{angular}");
        assert!(v.length() < 0.003 * linear.abs(), "{v} {linear}");
        assert!(w.length() < 0.003 * angular.abs(), "{w} {angular}");
    }
}

/// A user's force and torque move body and fluid together, and each turns and shifts the body. The tolerance is
/// that of the flow above.
#[test]
fn forces_of_the_user() {
    for (force, torque) in [(2.0, 0.0), (0.0, -0.05), (-1.0, 0.03)] {
        let mut world = weightless();
        world.integration_parameters.dt = 1.0 / 240.0;
        let turn = Rotation::from_scaled_axis(Vector::new(0.5, 0.9, -0.3));
        let (handle, body, planar) = inserted(&mut world, turn.to_scaled_axis());
        let mut immersion = Immersion::new(Fluid::WATER);
        immersion.insert(handle, body);
        let rapier = &mut world.bodies[handle];
        rapier.add_force(turn * Vector::X * force as Real, true);
        rapier.add_torque(turn * Vector::Z * torque as Real, true);
        for _ in 0..24 {
            immersion.step(&mut world);
        }
        let [linear, angular] = planar
            .acceleration(force, torque)
            .map(|a| (a * 0.1) as Real);
        let rapier = &world.bodies[handle];
        let v = turn.inverse() * rapier.linvel() - Vector::X * linear;
        let w = turn.inverse() * rapier.angvel() - Vector::Z * angular;
        // A torque moves G by little, the body's turning C by more.
        let speed = linear.abs() + angular.abs() * ARM as Real;
        assert!(v.length() < 0.003 * speed, "{v} {linear}");
        assert!(w.length() < 0.003 * angular.abs(), "{w} {angular}");
    }
}

/// The impulse of a body that moves with velocity u of a point O and turns with ω is A (u + ω × c), where c
/// leads from O to the center C of its volume, at which nothing couples: wherever the shape lies in its
/// frame.
#[test]
fn added_mass_of_a_shape_off_the_origin() {
    let [x, y, z] = HALF.map(|half| half as Real);
    let at = Vector::new(0.3, -0.2, 0.5);
    let part = (
        Pose::from_parts(at, Rotation::IDENTITY),
        SharedShape::cuboid(x, y, z),
    );
    let moved = HydroProperties::from_shape(&Compound::new(vec![part])).unwrap();
    let centered = shape().added_mass;
    let c = Vector3::new(at.x, at.y, at.z).map(f64::from);
    assert!((moved.centroid - c).norm() < 1e-6);
    let (u, w) = (Vector3::new(0.4, -1.0, 0.2), Vector3::new(0.7, 0.5, -0.9));
    let impulse = centered.linear * (u + w.cross(&c));
    let moment = centered.angular * w + c.cross(&impulse);
    let found = moved.added_mass;
    let size = impulse.norm();
    assert!((found.linear * u + found.coupling * w - impulse).norm() < 1e-5 * size);
    let found = found.coupling.transpose() * u + found.angular * w;
    assert!((found - moment).norm() < 1e-5 * moment.norm());
}
