//! A body that something holds in a still fluid without gravity, and plain rapier's twin of it: what the
//! property tests of the energy run.

use crate::support::weightless;
use rapier3d_immersed::rapier3d::na::{Quaternion, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody, Immersion, ViscousLaw,
};

/// What holds the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hold {
    Nothing,
    /// Bits of rapier's `LockedAxes`.
    Locks(u8),
    /// A rope that is never taut.
    SlackRope,
    /// A rope that is taut after half its length.
    Rope,
    Fixed,
    Spherical,
    Revolute,
    Prismatic,
    /// Stiffness such that the body oscillates at some frequency, Hz.
    Spring(f32),
}

/// What a joint holds the body to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum To {
    World,
    /// Another body in the fluid, like it.
    Twin,
    /// The same, as a multibody.
    Link,
}

#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub half: [f32; 3],
    pub density: f32,
    pub fluid: [f32; 2],
    pub law: ViscousLaw,
    pub hold: Hold,
    pub to: To,
    pub dt: f32,
    pub iterations: usize,
    pub own_iterations: usize,
    pub attitude: [f32; 3],
    pub linear: [f32; 3],
    pub angular: [f32; 3],
    pub steps: usize,
}

/// Energies over a run, J.
#[derive(Clone, Copy, Debug)]
pub struct Energies {
    pub start: f64,
    pub most: f64,
    /// First step after which the energy is more than a thousandth above the start.
    pub when: usize,
    pub finite: bool,
}

struct Scene {
    world: PhysicsWorld,
    bodies: Vec<RigidBodyHandle>,
    spring: Option<(f64, f64, [Vector; 2], Option<RigidBodyHandle>)>,
}

fn vector(v: [f32; 3]) -> Vector {
    Vector::from_array(v)
}

fn scene(case: &Case) -> Scene {
    let mut world = weightless();
    world.integration_parameters.dt = case.dt;
    world.integration_parameters.num_solver_iterations = case.iterations;
    let groups = InteractionGroups::none();
    let half = vector(case.half);
    let collider = || {
        ColliderBuilder::cuboid(half.x, half.y, half.z)
            .density(case.density)
            .collision_groups(groups)
    };
    let mut linear = vector(case.linear);
    let mut angular = vector(case.angular);
    let mut locks = LockedAxes::empty();
    if let Hold::Locks(bits) = case.hold {
        locks = LockedAxes::from_bits_truncate(bits);
        for i in 0..3 {
            if bits >> i & 1 == 1 {
                linear[i] = 0.0;
            }
            if bits >> (i + 3) & 1 == 1 {
                angular[i] = 0.0;
            }
        }
    }
    let reach = half.length();
    let attitude = Rotation::from_scaled_axis(vector(case.attitude));
    // The anchor on the body, off its axes.
    let anchor = half * Vector::new(0.9, -0.7, 0.8);
    let jointed = !matches!(case.hold, Hold::Nothing | Hold::Locks(_));
    let at_anchor = matches!(
        case.hold,
        Hold::Fixed | Hold::Spherical | Hold::Revolute | Hold::Prismatic
    );
    if at_anchor && case.to == To::World {
        // Velocities that the joint allows.
        match case.hold {
            Hold::Fixed => (linear, angular) = (Vector::ZERO, Vector::ZERO),
            Hold::Prismatic => {
                angular = Vector::ZERO;
                linear = attitude * Vector::X * linear.x;
            }
            Hold::Revolute => {
                angular = attitude * Vector::X * angular.x;
                linear = -angular.cross(attitude * anchor);
            }
            _ => linear = -angular.cross(attitude * anchor),
        }
    }
    let builder = RigidBodyBuilder::dynamic()
        .rotation(vector(case.attitude))
        .linvel(linear)
        .angvel(angular)
        .locked_axes(locks)
        .additional_solver_iterations(case.own_iterations)
        .can_sleep(false);
    let (body, _) = world.insert(builder.clone(), collider());
    let mut bodies = vec![body];
    let mut spring = None;
    if jointed {
        let anchored = attitude * anchor;
        let other = match case.to {
            To::World => {
                let at = if at_anchor {
                    Pose::from_parts(anchored, attitude)
                } else {
                    Pose::from_translation(anchored)
                };
                world.insert_body(RigidBodyBuilder::fixed().pose(at))
            }
            _ => {
                // Turned by half a turn about the joint's axis, at the same velocity field.
                let own = attitude * Rotation::from_rotation_x(std::f32::consts::PI);
                let at = anchored - own * anchor;
                let builder = builder
                    .clone()
                    .translation(at)
                    .rotation(own.to_scaled_axis())
                    .linvel(linear + angular.cross(at));
                let (other, _) = world.insert(builder, collider());
                bodies.push(other);
                other
            }
        };
        let own_anchor = if case.to == To::World {
            Vector::ZERO
        } else {
            anchor
        };
        let turn = if case.to == To::World {
            Rotation::IDENTITY
        } else {
            Rotation::from_rotation_x(std::f32::consts::PI)
        };
        let frame = |at: Vector, turn: Rotation| Pose::from_parts(at, turn);
        let (first, second) = (frame(own_anchor, Rotation::IDENTITY), frame(anchor, turn));
        // Locked axes of a generic joint at the anchor; X is the free one of hinge and slider.
        let rigid = |mask: JointAxesMask| {
            GenericJointBuilder::new(mask)
                .local_frame1(first)
                .local_frame2(second)
                .build()
        };
        let joint: GenericJoint = match case.hold {
            Hold::SlackRope => RopeJointBuilder::new(1e4 * reach)
                .local_anchor1(own_anchor)
                .local_anchor2(anchor)
                .into(),
            Hold::Rope => RopeJointBuilder::new(0.5 * reach)
                .local_anchor1(own_anchor)
                .local_anchor2(anchor)
                .into(),
            Hold::Fixed => rigid(JointAxesMask::LOCKED_FIXED_AXES),
            Hold::Spherical => rigid(JointAxesMask::LOCKED_SPHERICAL_AXES),
            Hold::Revolute => rigid(JointAxesMask::LOCKED_REVOLUTE_AXES),
            Hold::Prismatic => rigid(JointAxesMask::LOCKED_PRISMATIC_AXES),
            Hold::Spring(frequency) => {
                let mass = 8.0 * half.x * half.y * half.z * case.density;
                let stiffness = mass * (frequency * std::f32::consts::TAU).powi(2);
                let length = 0.3 * reach;
                spring = Some((
                    f64::from(stiffness),
                    f64::from(length),
                    [own_anchor, anchor],
                    (case.to == To::World).then_some(other),
                ));
                SpringJointBuilder::new(length, stiffness, 0.0)
                    .local_anchor1(own_anchor)
                    .local_anchor2(anchor)
                    .into()
            }
            _ => unreachable!(),
        };
        if case.to == To::Link {
            let joint = world.insert_multibody_joint(other, body, joint).unwrap();
            let bodies = &world.bodies;
            let (multibody, _) = world.multibody_joints.get_mut(joint).unwrap();
            multibody.forward_kinematics(bodies, true);
            // The root moves freely, the rest slides and turns as fast.
            let root = [angular, linear].map(|v| v.to_array());
            let root = [root[1], root[0]].concat();
            let most = root.iter().map(|x| x.abs()).fold(0.0, f32::max);
            for (i, part) in multibody.generalized_velocity_mut().iter_mut().enumerate() {
                let own = [0.3, -0.2, 0.5].map(|x| x * most.min(10.0));
                *part = root.get(i).copied().unwrap_or(own[i % 3]);
            }
            for link in multibody.links() {
                let v = multibody.body_jacobian(link.link_id()) * multibody.generalized_velocity();
                let body = &mut world.bodies[link.rigid_body_handle()];
                body.set_linvel(Vector::new(v[0], v[1], v[2]), true);
                body.set_angvel(Vector::new(v[3], v[4], v[5]), true);
            }
        } else {
            world.insert_impulse_joint(other, body, joint);
        }
    }
    Scene {
        world,
        bodies,
        spring,
    }
}

impl Scene {
    fn spring_energy(&self) -> f64 {
        let Some((stiffness, length, [other_anchor, anchor], other)) = self.spring else {
            return 0.0;
        };
        let other = other.unwrap_or_else(|| self.bodies[1]);
        let end = self.world.bodies[self.bodies[0]].position() * anchor;
        let start = self.world.bodies[other].position() * other_anchor;
        let stretch = f64::from((end - start).length()) - length;
        0.5 * stiffness * stretch * stretch
    }

    fn run(
        &mut self,
        steps: usize,
        mut step: impl FnMut(&mut PhysicsWorld),
        energy: impl Fn(&RigidBody) -> f64,
    ) -> Energies {
        let total = |scene: &Self| {
            let bodies = scene.bodies.iter().map(|h| energy(&scene.world.bodies[*h]));
            bodies.sum::<f64>() + scene.spring_energy()
        };
        let start = total(self);
        let mut energies = Energies {
            start,
            most: start,
            when: 0,
            finite: true,
        };
        for n in 1..=steps {
            step(&mut self.world);
            let now = total(self);
            let finite = self.bodies.iter().all(|h| {
                let body = &self.world.bodies[*h];
                body.linvel().is_finite()
                    && body.angvel().is_finite()
                    && body.rotation().is_finite()
                    && body.translation().is_finite()
            });
            energies.finite &= finite && now.is_finite() && self.world.quarantine().is_empty();
            if now > energies.start * 1.001 && energies.when == 0 {
                energies.when = n;
            }
            energies.most = energies.most.max(now);
        }
        energies
    }
}

/// Energies of the body in fluid (with that of the fluid), and of its twin under plain rapier, whose mass
/// and inertia are those that rapier sees in the fluid.
pub fn run(case: &Case) -> (Energies, Energies) {
    let fluid = Fluid::new(case.fluid[0], case.fluid[1]).unwrap();
    let mut wet = scene(case);
    let handle = wet.bodies[0];
    let world = &wet.world;
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle).unwrap();
    let dry = DryMass::of_body(&world.bodies, &world.colliders, handle).unwrap();
    let body = ImmersedBody::new(hydro).with_law(case.law).unwrap();
    let free = FreeBody::new(&body, &dry, &fluid).unwrap();
    let mut immersion = Immersion::new(fluid);
    immersion.insert_all(wet.bodies.iter().copied(), body);
    let energy = |body: &RigidBody| {
        let mut free = free.clone();
        let q = body.rotation();
        let q = Quaternion::new(q.w, q.x, q.y, q.z).cast::<f64>();
        let wide = |v: Vector| Vector3::new(v.x, v.y, v.z).cast::<f64>();
        free.set_orientation(UnitQuaternion::new_normalize(q));
        free.set_velocity(wide(body.linvel()), wide(body.angvel()));
        free.kinetic_energy()
    };
    let in_fluid = wet.run(case.steps, |world| immersion.step(world), energy);

    let mut plain = scene(case);
    let seen = wet.world.bodies[handle].mass_properties().local_mprops;
    for handle in plain.bodies.clone() {
        let collider = plain.world.bodies[handle].colliders()[0];
        plain.world.colliders[collider].set_mass_properties(seen);
        let body = &mut plain.world.bodies[handle];
        body.set_allow_fast_rotation(true);
        body.recompute_mass_properties_from_colliders(&plain.world.colliders);
    }
    let energy = |body: &RigidBody| {
        let properties = &body.mass_properties().local_mprops;
        let inertia = properties.principal_inertia();
        let frame = *body.rotation() * properties.principal_inertia_local_frame;
        let own = frame.inverse() * body.angvel();
        let turning = (own * own).dot(inertia);
        0.5 * f64::from(properties.mass() * body.linvel().length_squared() + turning)
    };
    let under_rapier = plain.run(case.steps, |world| world.step(), energy);
    (in_fluid, under_rapier)
}
