//! Impacts in an ideal fluid conserve momentum of body and fluid, P = 𝕄₁₁u + 𝕄₁₂ω in world axes, and its
//! moment, together with those of what strikes it, whatever the direction and the lever. Nothing has
//! friction; bodies bounce, so that they part, because a contact that lasts is corrected in its first steps
//! only. The 6×6 mass is put together here by hand.

use crate::support::weightless;
use rapier3d_immersed::rapier3d::na::{
    Matrix3, Matrix6, Quaternion, UnitQuaternion, Vector3, Vector6,
};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{AddedMass, Fluid, HydroProperties, ImmersedBody, Immersion, ViscousLaw};

/// Mass of what strikes, kg.
const STRIKER: Real = 3.0;

fn to_f64(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z).map(f64::from)
}

/// Momentum and moment of momentum about the origin of a body whose 6×6 mass about its center of mass, along
/// its own axes, is `mass`.
fn momentum(body: &RigidBody, mass: &Matrix6<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let q = body.rotation();
    let q = Quaternion::new(q.w, q.x, q.y, q.z).cast::<f64>();
    let turn = UnitQuaternion::from_quaternion(q);
    let (v, w) = (to_f64(body.linvel()), to_f64(body.angvel()));
    let (v, w) = (turn.inverse() * v, turn.inverse() * w);
    let p = mass * Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z);
    let linear = turn * p.fixed_rows::<3>(0).into_owned();
    let angular = turn * p.fixed_rows::<3>(3).into_owned();
    let arm = to_f64(body.center_of_mass());
    (linear, angular + arm.cross(&linear))
}

/// A ball, not immersed, that flies towards `target` along `direction` and reaches it in 0.1 s.
fn striker(
    world: &mut PhysicsWorld,
    target: Vector,
    direction: Vector,
    speed: Real,
) -> RigidBodyHandle {
    let (radius, way) = (0.05, direction.normalize() * speed);
    world
        .insert(
            RigidBodyBuilder::dynamic()
                .translation(target - way * 0.1 - direction.normalize() * radius)
                .linvel(way),
            ColliderBuilder::ball(radius)
                .mass(STRIKER)
                .friction(0.0)
                .restitution(0.5),
        )
        .0
}

/// A ball (every blow is central) whose added mass differs from axis to axis, struck five times from different
/// sides, 0.4 s apart: each time it takes the whole of what the striker loses, and nothing across it, although
/// only the first steps of a contact are corrected: the next contact counts anew.
#[test]
fn blows_on_a_body_of_directional_mass() {
    let mut world = weightless();
    world.integration_parameters.dt = 1.0 / 240.0;
    let (radius, dry) = (0.1, 2.0);
    let attitude = Vector::new(0.5, -0.3, 0.8);
    let (target, _) = world.insert(
        RigidBodyBuilder::dynamic().rotation(attitude),
        ColliderBuilder::ball(radius)
            .mass(dry)
            .friction(0.0)
            .restitution(0.5),
    );
    let hydro = HydroProperties::from_shape(&Ball::new(radius)).unwrap();
    let added = Vector3::new(1e-3, 4e-3, 2e-2);
    let turning = Vector3::repeat(1e-5);
    let hydro = hydro.with_added_mass(AddedMass::diagonal(added, turning));
    let body = ImmersedBody::new(hydro.unwrap());
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(target, body.with_law(ViscousLaw::Inviscid).unwrap());
    let rho = f64::from(Fluid::WATER.density());
    let mut mass = Matrix6::zeros();
    for i in 0..3 {
        mass[(i, i)] = f64::from(dry) + rho * added[i];
        mass[(i + 3, i + 3)] = 0.4 * f64::from(dry * radius * radius) + rho * turning[i];
    }
    let mut before = Vector3::zeros();
    for direction in [
        Vector::new(1.0, 0.2, -0.4),
        Vector::new(-0.3, -1.0, 0.6),
        Vector::new(0.5, 0.7, 0.7),
        Vector::new(-0.6, 0.3, -1.0),
        Vector::new(0.1, -0.8, 0.5),
    ] {
        let at = world.bodies[target].translation() + world.bodies[target].linvel() * 0.1;
        let way = direction.normalize();
        let ball = striker(&mut world, at - way * radius, way, 0.5);
        let incoming = to_f64(world.bodies[ball].linvel());
        for _ in 0..96 {
            immersion.step(&mut world);
        }
        let (momentum, _) = momentum(&world.bodies[target], &mass);
        let lost = (incoming - to_f64(world.bodies[ball].linvel())) * f64::from(STRIKER);
        assert!(lost.norm() > 0.5, "{lost}");
        let miss = (momentum - before - lost).norm();
        assert!(miss < 0.005 * lost.norm(), "{miss} {momentum} {lost}");
        before = momentum;
        world.remove_body(ball);
    }
}

/// A plate whose center of mass is off its middle, so that a push at the one turns it (A₁₂ ≠ 0), struck
/// off both: momentum and its moment are conserved. Head-on, what is missed is first order in dt and 3e-4.
/// At a slant, parry keeps the contact's point until it is a millimeter or two out of place (it does so for
/// plain rapier's bodies, too), which is a lever of the impulse in the moment.
#[test]
fn eccentric_oblique_blow_on_a_coupled_body() {
    let half = Vector3::new(0.2, 0.15, 0.02);
    let offset = Vector3::new(0.06, -0.03, 0.0);
    let moments = Vector3::new(0.02, 0.03, 0.05);
    let dry = 3.0;
    for (x, y, slant) in [
        (0.14, -0.08, 0.0),
        (-0.1, 0.06, 0.0),
        (0.14, -0.08, 0.4),
        (-0.1, 0.06, -0.3),
    ] {
        let mut world = weightless();
        world.integration_parameters.dt = 1.0 / 240.0;
        let attitude = Rotation::from_scaled_axis(Vector::new(0.5, -0.3, 0.8));
        let real = |v: Vector3<f64>| Vector::new(v.x as Real, v.y as Real, v.z as Real);
        let [a, b, c] = real(half).to_array();
        let properties = MassProperties::new(real(offset), dry as Real, real(moments));
        let (plate, _) = world.insert(
            RigidBodyBuilder::dynamic().rotation(attitude.to_scaled_axis()),
            ColliderBuilder::cuboid(a, b, c)
                .mass_properties(properties)
                .friction(0.0)
                .restitution(0.5),
        );
        // About the middle nothing couples; the added mass about the center of mass follows from the
        // velocity u − ω × s of the middle, s = `offset`: rows and columns of A₁₁ [s]× by hand.
        let hydro = HydroProperties::from_shape(&Cuboid::new(real(half))).unwrap();
        let rho = f64::from(Fluid::WATER.density());
        let added = hydro.added_mass.linear.diagonal() * rho;
        let turning = hydro.added_mass.angular.diagonal() * rho;
        let s = offset;
        let lever = Matrix3::new(0.0, -s.z, s.y, s.z, 0.0, -s.x, -s.y, s.x, 0.0);
        let linear = Matrix3::from_diagonal(&added);
        let coupling = linear * lever;
        let mut mass = Matrix6::zeros();
        let mut block = |i, j, m: Matrix3<f64>| mass.fixed_view_mut::<3, 3>(i, j).copy_from(&m);
        block(0, 0, linear + Matrix3::identity() * dry);
        block(0, 3, coupling);
        block(3, 0, coupling.transpose());
        block(
            3,
            3,
            Matrix3::from_diagonal(&(moments + turning)) + lever.transpose() * linear * lever,
        );

        let body = HydroProperties::from_body(&world.bodies, &world.colliders, plate).unwrap();
        let body = ImmersedBody::new(body);
        let mut immersion = Immersion::new(Fluid::WATER);
        immersion.insert(plate, body.with_law(ViscousLaw::Inviscid).unwrap());
        let way = attitude * Vector::new(slant, -0.5 * slant, -1.0);
        let at = attitude * Vector::new(x, y, 0.02);
        let ball = striker(&mut world, at, way, 0.5);
        let total = |world: &PhysicsWorld| {
            let (p, h) = momentum(&world.bodies[plate], &mass);
            let ball = &world.bodies[ball];
            let own = to_f64(ball.linvel()) * f64::from(STRIKER);
            (p + own, h + to_f64(ball.center_of_mass()).cross(&own))
        };
        let (p, h) = total(&world);
        for _ in 0..48 {
            immersion.step(&mut world);
        }
        let (p_after, h_after) = total(&world);
        let (taken, turned) = momentum(&world.bodies[plate], &mass);
        assert!(
            taken.norm() > 0.5 && turned.norm() > 0.1,
            "{taken} {turned}"
        );
        let miss = (p_after - p).norm();
        assert!(miss < 1e-3 * taken.norm(), "{miss}");
        let out_of_place = if slant == 0.0 { 0.0 } else { 0.0025 };
        let twist = (h_after - h).norm();
        let most = 1e-3 * turned.norm() + out_of_place * taken.norm();
        assert!(twist < most, "{slant}: {twist} {most}");
    }
}
