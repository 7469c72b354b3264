//! An arrow: a shaft with a heavy point and two crossed fins, let go askew.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, GREY, RED, Shown, View, enlarged};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
use std::f32::consts::FRAC_PI_2;

/// Length and radius of the shaft, m.
pub const LENGTH: f32 = 0.7;
const RADIUS: f32 = 0.003;
/// Each fin, from tip to tip across the shaft and along it, and its thickness, m. Its lift acts a quarter of the chord behind
/// its leading edge.
pub const SPAN: f32 = 0.05;
pub const CHORD: f32 = 0.04;
const THICKNESS: f32 = 0.0004;
/// Of the shaft, the point and each fin, kg: 25 g together.
const MASSES: [f32; 3] = [0.013, 0.010, 0.001];
pub const SPEED: f32 = 20.0;

pub struct Arrow {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub arrow: RigidBodyHandle,
}

impl Arrow {
    /// Flying along x without weight, its point turned to the side by so much, rad.
    ///
    /// # Errors
    /// Those of the description, which these sizes do not give.
    pub fn new(yaw: f32, hz: f32) -> Result<Self, Failure> {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::ZERO;
        world.integration_parameters.dt = 1.0 / hz;
        let flying = RigidBodyBuilder::dynamic()
            .rotation(Vector::Y * yaw)
            .linvel(Vector::X * SPEED);
        // Rapier's cylinders stand along y.
        let shaft = ColliderBuilder::cylinder(0.5 * LENGTH, RADIUS)
            .rotation(Vector::Z * -FRAC_PI_2)
            .mass(MASSES[0]);
        let (arrow, _) = world.insert(flying, shaft);
        let point = ColliderBuilder::ball(2.0 * RADIUS)
            .translation(Vector::X * (0.5 * LENGTH))
            .mass(MASSES[1]);
        world.insert_collider(point, Some(arrow));
        let half = [0.5 * CHORD, 0.5 * SPAN, 0.5 * THICKNESS];
        for fin in [[half[0], half[1], half[2]], [half[0], half[2], half[1]]] {
            let fin = ColliderBuilder::cuboid(fin[0], fin[1], fin[2])
                .translation(Vector::X * (0.5 * (CHORD - LENGTH)))
                .mass(MASSES[2]);
            world.insert_collider(fin, Some(arrow));
        }
        // The shaft with its point, and each of the fins, become a part.
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, arrow)?;
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(arrow, hydro);
        Ok(Self {
            world,
            immersion,
            arrow,
        })
    }

    pub fn step(&mut self) {
        self.immersion.step(&mut self.world);
    }

    /// Angle from its path to its point, rad, positive to the left as seen from above.
    pub fn yaw(&self) -> f64 {
        let body = &self.world.bodies[self.arrow];
        let (points, flies) = (body.rotation() * Vector::X, body.linvel());
        (flies.cross(points).dot(Vector::Y) / flies.length())
            .asin()
            .into()
    }

    /// Time and angle from its path in each step of so many seconds.
    pub fn curve(&mut self, seconds: f32) -> Vec<(f64, f64)> {
        let dt = self.world.integration_parameters.dt;
        let steps = (seconds / dt) as usize;
        let each = |i| {
            let now = (f64::from(dt) * i as f64, self.yaw());
            self.step();
            now
        };
        (0..steps).map(each).collect()
    }
}

pub fn show() -> Result<Shown, Failure> {
    const HZ: f32 = 240.0;
    let yaw = 10f32.to_radians();
    let mut above = Panel::new("from above, every 0.05 s, row by row", "m", "m").equal();
    let mut arrow = Arrow::new(yaw, HZ)?;
    for row in 0..9 {
        let place = (1.0, Some((0.0, -0.12 * f64::from(row))));
        let items = enlarged(&arrow.world, arrow.arrow, View::ABOVE, BLUE, place);
        above.items.extend(items);
        (0..12).for_each(|_| arrow.step());
    }
    let curve = Arrow::new(yaw, HZ)?.curve(1.2);
    let degrees = |curve: &[(f64, f64)]| -> Vec<_> {
        curve.iter().map(|(t, a)| (*t, a.to_degrees())).collect()
    };
    let mut angle = Panel::new("point off the path", "time, s", "degrees");
    angle
        .items
        .push(Item::Line(vec![(0.0, 0.0), (1.2, 0.0)], GREY, 1));
    angle.items.push(Item::Line(degrees(&curve), RED, 2));
    let after = curve[HZ as usize].1.to_degrees();
    let title = "An arrow of 0.7 m and 25 g at 20 m/s, let go at 10° of yaw";
    let lines = vec![format!("after 1 s {after:.2}° off its path (less than 2°)")];
    Ok(Shown::new(title, vec![above, angle], lines))
}
