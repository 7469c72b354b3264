//! A remotely operated vehicle with six thrusters that keeps its depth and its place in a current.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, GREY, RED, Shown, View, drawn, world};
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::rapier3d::na::{Matrix3, Vector3, Vector6};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{AddedMass, Damping, Fluid, HydroProperties, ImmersedBody, Immersion};
use rapier3d_immersed::{Part, Propeller, Thruster};

/// Mass, kg, and moments of inertia, kg·m²; x forward, y up, z to starboard.
pub const MASS: f32 = 11.5;
const INERTIA: Vector = Vector::new(0.26, 0.37, 0.23);
/// Half extents of a box of the volume that it displaces, 1 % more than its mass, m, and how far its middle is above the
/// center of mass, m.
pub const HALF: Vector = Vector::new(0.2, 0.0856, 0.085);
const RIGHTING: f32 = 0.02;
/// Added mass, kg and kg·m², and damping, linear and quadratic, of BlueROV2 (von Benzon et al., *J. Mar. Sci. Eng.* 10, 1898 (2022),
/// table A2).
const ADDED: [f64; 6] = [6.36, 18.69, 7.12, 0.186, 0.222, 0.135];
pub const LINEAR: [f64; 6] = [13.7, 33.0, 0.0, 0.0, 0.0, 0.8];
pub const QUADRATIC: [f64; 6] = [141.0, 190.0, 217.0, 1.19, 1.5, 0.47];
/// Diameter of the propellers, m, K_T = k₀ − k₁ J and K_Q alike; most turns per second.
pub const DIAMETER: f64 = 0.076;
pub const THRUST: [f64; 2] = [0.45, 0.4];
const TORQUE: [f64; 2] = [0.06, 0.05];
const FASTEST: f64 = 60.0;
/// The current: so fast, m/s, and so much of it downward.
pub const CURRENT: f32 = 0.3;
pub const DOWNWARD: f32 = 0.05;
/// Gains of the controller: N/m and N·s/m along each axis, N·m and N·m·s about each.
pub const STIFFNESS: f32 = 250.0;
const BRAKING: f32 = 160.0;
const TURNING: f32 = 20.0;
const CALMING: f32 = 8.0;

pub struct Rov {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub body: RigidBodyHandle,
    thrusters: Vec<Thruster>,
    /// Where it shall be.
    pub target: Vector,
}

impl Rov {
    /// # Errors
    /// Those of the description, which these numbers do not give.
    pub fn new(hz: f32) -> Result<Self, Failure> {
        let (mut world, mut immersion) = world(Fluid::WATER, hz);
        let mass = MassProperties::new(Vector::ZERO, MASS, INERTIA);
        let frame = ColliderBuilder::cuboid(HALF.x, HALF.y, HALF.z)
            .translation(Vector::Y * RIGHTING)
            .density(0.0);
        let body = RigidBodyBuilder::dynamic().can_sleep(false);
        let (body, _) = world.insert(body.additional_mass_properties(mass), frame);
        let of = |[u, v, w, ..]: [f64; 6]| Vector3::new(u, v, w);
        let [.., p, q, r] = ADDED;
        let density = f64::from(Fluid::WATER.density());
        let added = AddedMass {
            linear: Matrix3::from_diagonal(&(of(ADDED) / density)),
            coupling: Matrix3::zeros(),
            angular: Matrix3::from_diagonal(&(Vector3::new(p, q, r) / density)),
        };
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, body)?;
        let hydro = hydro.with_added_mass(added)?;
        let damping = Damping::diagonal(Vector6::from(LINEAR), Vector6::from(QUADRATIC))?;
        let screw = Propeller::new(DIAMETER, THRUST, TORQUE)?;
        let mut thrusters = Vec::new();
        for (x, z) in [(0.16, 0.11), (0.16, -0.11), (-0.16, 0.11), (-0.16, -0.11)] {
            // Vectored by 45°, so that two and two push along, across, and around.
            let direction = Vector3::new(1.0, 0.0, -f64::signum(x) * f64::signum(z));
            thrusters.push(Thruster::new(Vector3::new(x, 0.0, z), direction)?);
        }
        for z in [0.11, -0.11] {
            thrusters.push(Thruster::new(Vector3::new(0.0, 0.07, z), Vector3::y())?);
        }
        // Of each two one is left-handed, so that their torques cancel.
        let left = Propeller::new(DIAMETER, THRUST, TORQUE.map(|k| -k))?;
        let screws = [screw, left, left, screw, screw, left];
        let handed = thrusters.iter().zip(screws);
        let thrusters: Vec<_> = handed.map(|(t, s)| t.with_propeller(s)).collect();
        let part = Part::new(hydro.clone()).with_law(damping);
        let described = ImmersedBody::new(hydro).with_parts([part]);
        immersion.set_flow(Uniform::new(CURRENT * 0.8, -DOWNWARD, CURRENT * 0.6));
        immersion.insert(body, described.with_thrusters(thrusters.clone()));
        let target = Vector::ZERO;
        Ok(Self {
            world,
            immersion,
            body,
            thrusters,
            target,
        })
    }

    /// The controller and a step: proportional to how far it is off, against how fast it moves.
    pub fn step(&mut self) {
        let body = &self.world.bodies[self.body];
        let back = body.rotation().inverse();
        let force = (self.target - body.translation()) * STIFFNESS - body.linvel() * BRAKING;
        let torque = -body.rotation().to_scaled_axis() * TURNING - body.angvel() * CALMING;
        let (force, torque) = (back * force, back * torque);
        let wide = |v: Vector| Vector3::new(v.x, v.y, v.z).map(f64::from);
        let (force, torque) = (wide(force), wide(torque));
        for (i, thruster) in self.thrusters.iter().enumerate() {
            let (arm, along) = (thruster.point, thruster.direction);
            let lever = arm.cross(&along);
            // Each does its share of what its group can do: the horizontal four, or the vertical two.
            let wanted = if i < 4 {
                0.5 * (along.x * force.x + along.z * force.z) + 0.25 * torque.y / lever.y
            } else {
                0.5 * (force.y + torque.x / lever.x)
            };
            let scale = f64::from(self.immersion.fluid().density()) * DIAMETER.powi(4) * THRUST[0];
            let turns = wanted.signum() * (wanted.abs() / scale).sqrt();
            let turns = turns.clamp(-FASTEST, FASTEST);
            self.immersion.set_thrust(self.body, i, turns);
        }
        self.immersion.step(&mut self.world);
    }

    /// Where it is, after so many seconds.
    pub fn run(&mut self, seconds: f32) -> Vector {
        let steps = (seconds / self.world.integration_parameters.dt).round() as usize;
        (0..steps).for_each(|_| self.step());
        self.world.bodies[self.body].translation()
    }
}

pub fn show() -> Result<Shown, Failure> {
    let mut rov = Rov::new(60.0)?;
    let mut side = Panel::new("from the side", "x, m", "y, m").equal();
    let mut curves = Panel::new("depth, and what is asked for (grey)", "time, s", "y, m");
    let mut off = Panel::new("off its place: depth, and sideways (red)", "time, s", "cm");
    let (mut depth, mut wanted, mut error, mut place) = (vec![], vec![], vec![], vec![]);
    for i in 0..400 {
        rov.target = Vector::Y * if i < 200 { 0.0 } else { -1.0 };
        if [0, 202, 206, 212, 399].contains(&i) {
            let outline = drawn(&rov.world, &[rov.body], View::SIDE, BLUE);
            side.items.extend(outline);
        }
        let at = rov.run(0.1) - rov.target;
        let time = 0.1 * f64::from(i + 1);
        depth.push((time, f64::from(at.y + rov.target.y)));
        wanted.push((time, f64::from(rov.target.y)));
        if i < 200 {
            error.push((time, 100.0 * f64::from(at.y)));
            place.push((time, 100.0 * f64::from(at.with_y(0.0).length())));
        }
    }
    let worst = |of: &[(f64, f64)]| of.iter().map(|(_, y)| y.abs()).fold(0.0, f64::max);
    let (deep, away) = (worst(&error), worst(&place));
    let over = 100.0 * (worst(&depth) - 1.0);
    let lines = vec![
        format!("depth kept within {deep:.2} cm, place within {away:.2} cm"),
        format!("a step of 1 m is overshot by {over:.1} %"),
    ];
    curves.items = vec![Item::Line(wanted, GREY, 1), Item::Line(depth, BLUE, 2)];
    off.items = vec![Item::Line(error, BLUE, 2), Item::Line(place, RED, 2)];
    Ok(Shown {
        title: "An underwater vehicle with six thrusters in a current of 0.3 m/s".into(),
        panels: vec![side, curves, off],
        lines,
    })
}
