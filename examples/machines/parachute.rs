//! A flat round parachute with a load on eight lines.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, GREY, Shown, View, drawn};
use crate::fold::dome;
use crate::stage::{advance, world};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
use std::f32::consts::TAU;

/// Diameter of the canopy laid flat, m.
pub const NOMINAL: f32 = 1.2;
/// What it is when filled with air: a half spheroid of this radius and depth, over the nominal diameter. It is 0.67 to 0.70
/// across (Knacke, *Parachute Recovery Systems*, 1992; recalled); the depth leaves the gores their length.
pub const RADIUS: f32 = 0.35;
const DEPTH: f32 = 0.285;
/// Thickness that stands for the cloth, m. Mass of the
/// canopy and of the load, kg; length of the lines, m.
const CLOTH: f32 = 0.002;
const CANOPY: f32 = 0.05;
pub const LOAD: f32 = 1.0;
const LINES: f32 = 1.2;
/// Radius of the load, m.
pub const BALL: f32 = 0.06;

pub struct Parachute {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub canopy: RigidBodyHandle,
    pub load: RigidBodyHandle,
}

impl Parachute {
    /// # Errors
    /// Those of the description, which these sizes do not give.
    pub fn new(hz: f32) -> Result<Self, Failure> {
        let (mut world, mut immersion) = world(Fluid::AIR, hz);
        let shell =
            ColliderBuilder::new(dome(RADIUS * NOMINAL, DEPTH * NOMINAL, CLOTH)?).mass(CANOPY);
        let (canopy, _) = world.insert(RigidBodyBuilder::dynamic(), shell);
        let (rim, above) = (
            RADIUS * NOMINAL,
            (LINES * LINES - (RADIUS * NOMINAL).powi(2)).sqrt(),
        );
        let body = RigidBodyBuilder::dynamic().translation(Vector::Y * -above);
        let (load, _) = world.insert(body, ColliderBuilder::ball(BALL).mass(LOAD));
        for i in 0..8 {
            let (z, x) = (TAU * i as f32 / 8.0).sin_cos();
            let line = RopeJointBuilder::new(LINES).local_anchor1(Vector::new(x, 0.0, z) * rim);
            world.insert_impulse_joint(canopy, load, line);
        }
        for body in [canopy, load] {
            let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, body)?;
            let volume = hydro.volume;
            immersion.insert(body, hydro);
            if body == canopy {
                // Cloth displaces next to nothing.
                immersion.set_extra_volume(canopy, -volume);
            }
        }
        Ok(Self {
            world,
            immersion,
            canopy,
            load,
        })
    }

    /// Where the load is, after so many seconds.
    pub fn run(&mut self, seconds: f32) -> Vector {
        advance(&mut self.world, &mut self.immersion, seconds);
        self.world.bodies[self.load].translation()
    }

    /// Drag coefficient on the nominal area of what descends steadily at a speed, m/s.
    pub fn drag_coefficient(speed: f64) -> f64 {
        Self::terminal_speed(1.0).powi(2) / speed.powi(2)
    }

    /// The speed of steady descent, m/s, with a drag coefficient on the nominal area.
    pub fn terminal_speed(drag_coefficient: f64) -> f64 {
        let area = std::f64::consts::PI / 4.0 * f64::from(NOMINAL).powi(2);
        let weight = f64::from(CANOPY + LOAD) * 9.81;
        let pressure = weight / (area * drag_coefficient);
        (2.0 * pressure / f64::from(Fluid::AIR.density())).sqrt()
    }
}

pub fn show() -> Result<Shown, Failure> {
    let mut chute = Parachute::new(120.0)?;
    let mut side = Panel::new("every half second", "x, m", "y, m").equal();
    let mut curves = Panel::new("descent; grey: for C_D = 0.75 and 0.80", "time, s", "m/s");
    let mut speed = Vec::new();
    for i in 0..100 {
        let before = chute.run(0.0);
        if i % 10 == 0 && i < 40 {
            let bodies = [chute.canopy, chute.load];
            side.items
                .extend(drawn(&chute.world, &bodies, View::SIDE, BLUE));
            let pose = chute.world.bodies[chute.canopy].position();
            for x in [-RADIUS, RADIUS] {
                let rim = View::SIDE.of(*pose * (Vector::X * (x * NOMINAL)));
                side.items
                    .push(Item::Line(vec![rim, View::SIDE.of(before)], GREY, 1));
            }
        }
        let after = chute.run(0.05);
        speed.push((0.05 * f64::from(i), f64::from(before.y - after.y) / 0.05));
    }
    for published in [0.75, 0.8] {
        let speed = Parachute::terminal_speed(published);
        curves
            .items
            .push(Item::Dashed(vec![(0.0, speed), (5.0, speed)], GREY));
    }
    let last = speed[99].1;
    let coefficient = Parachute::drag_coefficient(last);
    let lines = vec![
        format!(
            "descends at {last:.2} m/s: C_D = {coefficient:.3} on the nominal area (0.75 to 0.80)"
        ),
        format!(
            "published: {:.2} to {:.2} m/s",
            Parachute::terminal_speed(0.8),
            Parachute::terminal_speed(0.75)
        ),
    ];
    curves.items.push(Item::Line(speed, BLUE, 2));
    let title = "A flat round parachute of 1.2 m and 1 kg on eight lines";
    Ok(Shown::new(title, vec![side, curves], lines))
}
