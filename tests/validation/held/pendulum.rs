//! Pendulums under water: what swings on joints has the inertia of body and fluid.

use rapier3d_immersed::rapier3d::na::{Matrix2, Vector2};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, ViscousLaw};

const GRAVITY: f64 = 9.81;
/// Half lengths of the upper and the lower link, m; both are 4 cm wide and 2 cm thick (the swing is along that).
const HALF_LENGTHS: [f64; 2] = [0.10, 0.16];
const HALF_WIDTH: f32 = 0.02;
const HALF_THICKNESS: f32 = 0.01;
const DENSITIES: [f32; 2] = [2000.0, 3000.0];

/// What a link swings with: length from hinge to hinge, mass with added mass across, inertia with the fluid's,
/// and weight less buoyancy.
#[derive(Clone, Copy, Debug)]
struct Link {
    length: f64,
    mass: f64,
    inertia: f64,
    weight: f64,
}

struct Pendulum {
    world: PhysicsWorld,
    immersion: Immersion,
    handles: [RigidBodyHandle; 2],
    links: [Link; 2],
}

impl Pendulum {
    fn new(hz: f32, multibody: bool, angle: f32) -> Self {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / hz;
        let mut immersion = Immersion::new(Fluid::WATER);
        let mut above = world.insert_body(RigidBodyBuilder::fixed());
        let turn = Rotation::from_axis_angle(Vector::Z, angle);
        let mut hinge = Vector::ZERO;
        let mut anchor = Vector::ZERO;
        let parts = [0, 1].map(|i| {
            let half = HALF_LENGTHS[i] as f32;
            let down = turn * (Vector::Y * -half);
            let body = RigidBodyBuilder::dynamic()
                .can_sleep(false)
                .pose(Pose::from_parts(hinge + down, turn));
            let shape = ColliderBuilder::cuboid(HALF_THICKNESS, half, HALF_WIDTH)
                .density(DENSITIES[i])
                .collision_groups(InteractionGroups::none());
            let (handle, _) = world.insert(body, shape);
            let joint = RevoluteJointBuilder::new(Vector::Z)
                .local_anchor1(anchor)
                .local_anchor2(Vector::Y * half);
            if multibody {
                world.insert_multibody_joint(above, handle, joint).unwrap();
            } else {
                world.insert_impulse_joint(above, handle, joint);
            }
            let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle);
            let hydro = hydro.unwrap();
            let rho = f64::from(Fluid::WATER.density());
            let sides = [HALF_THICKNESS, half, HALF_WIDTH].map(|x| 2.0 * f64::from(x));
            let dry = f64::from(DENSITIES[i]) * sides.iter().product::<f64>();
            let link = Link {
                length: sides[1],
                mass: dry + rho * hydro.added_mass.linear[(0, 0)],
                inertia: dry * (sides[0].powi(2) + sides[1].powi(2)) / 12.0
                    + rho * hydro.added_mass.angular[(2, 2)],
                weight: (dry - rho * hydro.volume) * GRAVITY,
            };
            let ideal = ImmersedBody::new(hydro).with_law(ViscousLaw::Inviscid);
            immersion.insert(handle, ideal.unwrap());
            hinge += down * 2.0;
            anchor = Vector::Y * -half;
            above = handle;
            (handle, link)
        });
        Self {
            world,
            immersion,
            handles: parts.map(|(handle, _)| handle),
            links: parts.map(|(_, link)| link),
        }
    }

    fn angles(&self) -> Vector2<f64> {
        let angle = |handle: RigidBodyHandle| {
            let down = *self.world.bodies[handle].rotation() * Vector::NEG_Y;
            f64::from(down.x).asin()
        };
        Vector2::new(angle(self.handles[0]), angle(self.handles[1]))
    }

    /// Lagrange's equations of small angles, M θ̈ = −K θ: the modes' squared frequencies and shapes.
    fn modes(&self) -> [(f64, Vector2<f64>); 2] {
        let [upper, lower] = self.links;
        let (a, b) = (0.5 * upper.length, 0.5 * lower.length);
        let coupling = lower.mass * upper.length * b;
        let mass = Matrix2::new(
            upper.mass * a * a + upper.inertia + lower.mass * upper.length.powi(2),
            coupling,
            coupling,
            lower.mass * b * b + lower.inertia,
        );
        let stiffness = Vector2::new(
            upper.weight * a + lower.weight * upper.length,
            lower.weight * b,
        );
        let half = mass.cholesky().unwrap().l().try_inverse().unwrap();
        let eigen =
            (half * Matrix2::from_diagonal(&stiffness) * half.transpose()).symmetric_eigen();
        [0, 1].map(|i| {
            let shape = half.transpose() * eigen.eigenvectors.column(i);
            (eigen.eigenvalues[i], shape)
        })
    }
}

/// A double pendulum of unequal links in an ideal fluid, let go at 3° from rest, follows its Lagrange equations with the added
/// mass of both links within 2 % of the amplitude over 5 s (nine swings; of the dry masses it would be out of phase after
/// two): on impulse joints and as a multibody, at 240 and 1000 Hz.
#[test]
fn double_pendulum_under_water() {
    const START: f64 = 0.05;
    for (hz, multibody) in [
        (240.0, false),
        (1000.0, false),
        (240.0, true),
        (1000.0, true),
    ] {
        let mut pendulum = Pendulum::new(hz, multibody, START as f32);
        let modes = pendulum.modes();
        let shapes = columns(&modes);
        let start = shapes.try_inverse().unwrap() * Vector2::repeat(START);
        let mut worst = 0.0_f64;
        for step in 1..=(5.0 * hz) as usize {
            pendulum.immersion.step(&mut pendulum.world);
            let time = step as f64 / f64::from(hz);
            let swing = |i: usize| start[i] * (modes[i].0.sqrt() * time).cos();
            let exact = shapes * Vector2::new(swing(0), swing(1));
            worst = worst.max((pendulum.angles() - exact).amax() / START);
        }
        assert_eq!(pendulum.immersion.warnings(), []);
        println!("{hz} {multibody}: {worst}");
        assert!(worst < 0.02, "{hz} {multibody}: {worst}");
    }
}

fn columns(modes: &[(f64, Vector2<f64>); 2]) -> Matrix2<f64> {
    Matrix2::from_columns(&[modes[0].1, modes[1].1])
}

/// What a robot's arm that is held out level asks of its joint: the torque of its weight in air, of its weight less buoyancy in water;
/// the joint's own impulse says so.
#[test]
fn an_arm_is_lighter_under_water() {
    for (fluid, share) in [(None, 1.0), (Some(Fluid::WATER), 1.0 - 997.0 / 2700.0)] {
        let mut world = PhysicsWorld::new();
        let base = world.insert_body(RigidBodyBuilder::fixed());
        let body = RigidBodyBuilder::dynamic()
            .can_sleep(false)
            .translation(Vector::X * 0.3);
        let shape = ColliderBuilder::cuboid(0.3, 0.02, 0.02).density(2700.0);
        let (arm, _) = world.insert(body, shape);
        let joint = FixedJointBuilder::new().local_anchor2(Vector::X * -0.3);
        let joint = world.insert_impulse_joint(base, arm, joint);
        let mut immersion = Immersion::new(fluid.unwrap_or(Fluid::AIR));
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, arm).unwrap();
        immersion.insert(arm, hydro);
        immersion.set_enabled(fluid.is_some());
        (0..240).for_each(|_| immersion.step(&mut world));
        let impulse = world.impulse_joints.get(joint).unwrap().impulses;
        let force = impulse[1] / world.integration_parameters.dt;
        let weight = 2700.0 * 0.6 * 0.04 * 0.04 * 9.81;
        assert!(
            (f64::from(force.abs()) / (weight * share) - 1.0).abs() < 0.02,
            "{force} {}",
            weight * share
        );
    }
}
