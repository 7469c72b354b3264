//! A weather vane: a tail fin and a counterweight on a rod that turns about a vertical axle.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, GREEN, GREY, RED, Shown, View, drawn};
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
use std::f32::consts::FRAC_PI_2;

/// The tail fin's height and chord, and its middle behind the axle, m. Its lift acts a quarter of the chord behind its
/// leading edge.
pub const HEIGHT: f32 = 0.2;
pub const CHORD: f32 = 0.1;
pub const BEHIND: f32 = 0.2;
/// Half length and radius of the rod, m.
const ROD: [f32; 2] = [0.25, 0.004];
/// Of the fin, the rod and the counterweight, kg.
const MASSES: [f32; 3] = [0.012, 0.010, 0.0096];
/// Against x, m/s.
pub const WIND: f32 = 6.0;

pub struct WeatherVane {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub vane: RigidBodyHandle,
}

impl WeatherVane {
    /// At rest, its head turned out of the wind by so much, rad.
    ///
    /// # Errors
    /// Those of the description, which these sizes do not give.
    pub fn new(angle: f32, hz: f32) -> Result<Self, Failure> {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / hz;
        let mast = world.insert_body(RigidBodyBuilder::fixed());
        // Rapier would let it fall asleep a fraction of a degree out of the wind.
        let turned = RigidBodyBuilder::dynamic()
            .rotation(Vector::Y * angle)
            .can_sleep(false);
        let fin = ColliderBuilder::cuboid(0.5 * CHORD, 0.5 * HEIGHT, 0.0005)
            .translation(Vector::X * -BEHIND)
            .mass(MASSES[0]);
        let (vane, _) = world.insert(turned, fin);
        // Rapier's cylinders stand along y.
        let rod = ColliderBuilder::cylinder(ROD[0], ROD[1])
            .rotation(Vector::Z * -FRAC_PI_2)
            .mass(MASSES[1]);
        world.insert_collider(rod, Some(vane));
        let weight = ColliderBuilder::ball(0.012)
            .translation(Vector::X * ROD[0])
            .mass(MASSES[2]);
        world.insert_collider(weight, Some(vane));
        world.insert_impulse_joint(mast, vane, RevoluteJointBuilder::new(Vector::Y));
        // The fin becomes a part, the rod with its weight another.
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, vane)?;
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.set_flow(Uniform::new(-WIND, 0.0, 0.0));
        immersion.insert(vane, hydro);
        Ok(Self {
            world,
            immersion,
            vane,
        })
    }

    pub fn step(&mut self) {
        self.immersion.step(&mut self.world);
    }

    /// Angle from the wind to its head, rad.
    pub fn angle(&self) -> f64 {
        let head = self.world.bodies[self.vane].rotation() * Vector::X;
        f64::from(-head.z).atan2(head.x.into())
    }

    /// Time and angle in each step of so many seconds.
    pub fn curve(&mut self, seconds: f32) -> Vec<(f64, f64)> {
        let dt = self.world.integration_parameters.dt;
        let each = |i| {
            let now = (f64::from(dt) * i as f64, self.angle());
            self.step();
            now
        };
        (0..(seconds / dt) as usize).map(each).collect()
    }
}

pub fn show() -> Result<Shown, Failure> {
    let mut lines = Vec::new();
    let mut angles = Panel::new("head off the wind", "time, s", "degrees");
    for (degrees, color) in [(170.0_f32, RED), (90.0, BLUE), (-45.0, GREEN)] {
        let curve = WeatherVane::new(degrees.to_radians(), 240.0)?.curve(4.0);
        let curve: Vec<_> = curve.iter().map(|(t, a)| (*t, a.to_degrees())).collect();
        let last = curve.last().map_or(f64::NAN, |(_, angle)| *angle);
        lines.push(format!("from {degrees:4}° to {last:5.2}° in 4 s"));
        angles.items.push(Item::Line(curve, color, 2));
    }
    let mut above = Panel::new("from above, every 0.15 s from 90°", "x, m", "−z, m").equal();
    let mut vane = WeatherVane::new(FRAC_PI_2, 240.0)?;
    for i in 0..5 {
        let color = if i == 4 { BLUE } else { GREY };
        let outlines = drawn(&vane.world, &[vane.vane], View::ABOVE, color);
        above.items.extend(outlines);
        (0..36).for_each(|_| vane.step());
    }
    for y in [-0.2, 0.2] {
        let arrow = vec![
            (0.5, y),
            (0.35, y),
            (0.38, y + 0.015),
            (0.35, y),
            (0.38, y - 0.015),
        ];
        above.items.push(Item::Line(arrow, RED, 2));
    }
    above
        .items
        .push(Item::Label((0.42, 0.26), "wind".into(), RED));
    let mut side = Panel::new("from the side, at rest", "x, m", "y, m").equal();
    let rest = WeatherVane::new(0.0, 240.0)?;
    side.items = drawn(&rest.world, &[rest.vane], View::SIDE, BLUE);
    let title = "A weather vane in a wind of 6 m/s, let go at 170°, 90° and −45°";
    Ok(Shown::new(title, vec![side, above, angles], lines))
}
