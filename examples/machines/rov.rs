//! A remotely operated vehicle with six thrusters that keeps its depth and its place in a current.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, GREY, RED, Shown, View, drawn, greatest};
use crate::stage::{steps, untouched, world};
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{AddedMass, Damping, Fluid, HydroProperties, ImmersedBody, Immersion};
use rapier3d_immersed::{Part, Propeller, Thruster};

/// Mass, kg, and moments of inertia, kg·m²; x forward, y up, z to starboard.
pub const MASS: f32 = 11.5;
const INERTIA: Vector = Vector::new(0.26, 0.37, 0.23);
/// Half extents of a box of the volume that it displaces, 1 % more than its mass, and how far that is above the center of mass, m.
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
/// The current: so fast, m/s, and so much downward.
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
        let body = RigidBodyBuilder::dynamic().additional_mass_properties(mass);
        let frame = SharedShape::cuboid(HALF.x, HALF.y, HALF.z);
        let frame = untouched(frame, Pose::translation(0.0, RIGHTING, 0.0)).density(0.0);
        let (body, _) = world.insert(body.can_sleep(false), frame);
        let [u, v, w, p, q, r] = ADDED.map(|mass| mass / f64::from(Fluid::WATER.density()));
        let added = AddedMass::diagonal(Vector3::new(u, v, w), Vector3::new(p, q, r));
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, body)?;
        let hydro = hydro.with_added_mass(added)?;
        let damping = Damping::diagonal(LINEAR.into(), QUADRATIC.into())?;
        let mut thrusters = Vec::new();
        let screw = |hand: f64| Propeller::new(DIAMETER, THRUST, TORQUE.map(|k| hand * k));
        for (x, z) in [(0.16, 0.11), (0.16, -0.11), (-0.16, 0.11), (-0.16, -0.11)] {
            // Vectored by 45°: two and two push along, across, and around. Half are left-handed.
            let hand = f64::signum(x * z);
            let thruster = Thruster::new(Vector3::new(x, 0.0, z), Vector3::new(1.0, 0.0, -hand))?;
            thrusters.push(thruster.with_propeller(screw(hand)?));
        }
        for z in [0.11, -0.11] {
            let thruster = Thruster::new(Vector3::new(0.0, 0.07, z), Vector3::y())?;
            thrusters.push(thruster.with_propeller(screw(f64::signum(z))?));
        }
        let part = Part::new(hydro.clone()).with_law(damping);
        let described = ImmersedBody::new(hydro).with_parts([part]);
        immersion.set_flow(Uniform::new(CURRENT * 0.8, -DOWNWARD, CURRENT * 0.6));
        immersion.insert(body, described.with_thrusters(thrusters.clone()));
        Ok(Self {
            world,
            immersion,
            body,
            thrusters,
            target: Vector::ZERO,
        })
    }

    /// The controller and a step: proportional to how far it is off, against how fast it moves.
    pub fn step(&mut self) {
        let body = &self.world.bodies[self.body];
        let back = body.rotation().inverse();
        let force = (self.target - body.translation()) * STIFFNESS - body.linvel() * BRAKING;
        let torque = -body.rotation().to_scaled_axis() * TURNING - body.angvel() * CALMING;
        let wide = |v: Vector| Vector3::new(v.x, v.y, v.z).map(f64::from);
        let (force, torque) = (wide(back * force), wide(back * torque));
        for (i, thruster) in self.thrusters.iter().enumerate() {
            let along = thruster.direction;
            let lever = thruster.point.cross(&along);
            // Each does its share of what its group can do: the horizontal four, or the vertical two.
            let wanted = if i < 4 {
                0.5 * (along.x * force.x + along.z * force.z) + 0.25 * torque.y / lever.y
            } else {
                0.5 * (force.y + torque.x / lever.x)
            };
            let scale = f64::from(Fluid::WATER.density()) * DIAMETER.powi(4) * THRUST[0];
            let turns = wanted.signum() * (wanted.abs() / scale).sqrt().min(FASTEST);
            self.immersion.set_thrust(self.body, i, turns);
        }
        self.immersion.step(&mut self.world);
    }

    /// Where it is, after so many seconds.
    pub fn run(&mut self, seconds: f32) -> Vector {
        (0..steps(&self.world, seconds)).for_each(|_| self.step());
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
            let outlines = drawn(&rov.world, &[rov.body], View::SIDE, BLUE);
            side.items.extend(outlines);
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
    let (deep, away) = (greatest(&error), greatest(&place));
    let over = 100.0 * greatest(&depth) - 100.0;
    let lines = vec![
        format!("depth kept within {deep:.2} cm, place within {away:.2} cm"),
        format!("a step of 1 m is overshot by {over:.1} cm"),
    ];
    curves.items = vec![Item::Line(wanted, GREY, 1), Item::Line(depth, BLUE, 2)];
    off.items = vec![Item::Line(error, BLUE, 2), Item::Line(place, RED, 2)];
    let title = "An underwater vehicle with six thrusters in a current of 0.3 m/s";
    Ok(Shown::new(title, vec![side, curves, off], lines))
}
