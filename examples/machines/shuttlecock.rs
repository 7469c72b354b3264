//! A shuttlecock: a cork and sixteen feathers.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, GREY, RED, Shown, View, enlarged};
use rapier3d_immersed::rapier3d::na::{Isometry3, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{CustomLaw, Fluid, HydroProperties, ImmersedBody, Immersion, Part};
use std::f32::consts::TAU;
use std::f64::consts::PI;

/// Distances behind the cork's middle, and radii there, m: the cork, and the skirt to its tips.
const ALONG: [f64; 6] = [-0.013, 0.013, 0.0285, 0.044, 0.0595, 0.075];
const RADIUS: [f64; 6] = [0.0, 0.013, 0.017, 0.0215, 0.0255, 0.03];
/// Feathers: how many; length and width, and where the middle of one is, m; slope against the axle, rad.
const FEATHERS: usize = 16;
const FEATHER: [f32; 2] = [0.062, 0.0115];
const MIDDLE: Vector = Vector::new(-0.045, 0.021, 0.0);
const SLOPE: f32 = 0.29;
/// Of the cork and of each feather, kg: 5 g together.
const MASSES: [f32; 2] = [0.003, 0.000_125];
/// Drag coefficient of feathered and plastic ones in a wind tunnel between 30 and 105 km/h, on the area across the tips (28 cm²: Cohen,
/// Texier, Quéré & Clanet, *New J. Phys.* 17, 063001 (2015)); and of a short cylinder across (Matthews).
const DRAG: [f64; 2] = [0.62, 0.65];

/// The cork and four rings of the skirt: how far behind the cork's middle each is, m; by how much the area across the axle grows
/// from its front to its back, and what it shows to the side, m².
pub fn rings() -> impl Iterator<Item = [f64; 3]> {
    (0..5).map(|i| {
        let (from, to) = (RADIUS[i], RADIUS[i + 1]);
        let grows = PI * (to * to - from * from);
        let side = (from + to) * (ALONG[i + 1] - ALONG[i]);
        [0.5 * (ALONG[i] + ALONG[i + 1]), grows, side]
    })
}

/// Force on a ring over the density, m⁴/s², at a velocity in the body's axes, of bodies of revolution at incidence (Allen & Perkins,
/// NACA Rep. 1048 (1951); recalled): drag along the axle, the normal force of slender bodies where they grow, and drag across.
pub fn force([_, grows, side]: [f64; 3], velocity: &Vector3<f64>) -> Vector3<f64> {
    let along = Vector3::new(velocity.x, 0.0, 0.0);
    let across = velocity - along;
    let (forward, aside) = (along.norm(), across.norm());
    let resisted = along * (DRAG[0] * grows * forward)
        + across * (2.0 * grows * forward + DRAG[1] * side * aside);
    resisted * -0.5
}

pub struct Shuttlecock {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub shuttlecock: RigidBodyHandle,
}

impl Shuttlecock {
    /// Flying along x at a speed, m/s, its cork turned away from that by an angle, rad.
    ///
    /// # Errors
    /// Those of the description, which these sizes do not give.
    pub fn new(speed: f32, angle: f32, hz: f32) -> Result<Self, Failure> {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / hz;
        let flying = RigidBodyBuilder::dynamic()
            .rotation(Vector::Z * angle)
            .linvel(Vector::X * speed);
        let cork = ColliderBuilder::ball(RADIUS[1] as f32).mass(MASSES[0]);
        let (shuttlecock, _) = world.insert(flying, cork);
        // A feather lies along −x, which its slope turns outward, to y.
        let sloped = Rotation::from_axis_angle(Vector::Z, -SLOPE);
        for i in 0..FEATHERS {
            let around = Rotation::from_axis_angle(Vector::X, TAU * i as f32 / FEATHERS as f32);
            let feather = ColliderBuilder::cuboid(0.5 * FEATHER[0], 0.0001, 0.5 * FEATHER[1])
                .position(Pose::from_parts(around * MIDDLE, around * sloped))
                .mass(MASSES[1]);
            world.insert_collider(feather, Some(shuttlecock));
        }
        // Plates that do not feel each other are no skirt: it consists of rings instead.
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, shuttlecock)?;
        let mut parts = Vec::new();
        for ring in rings() {
            let law =
                CustomLaw::new(move |m| [force(ring, &m.linear) * m.density, Vector3::zeros()])?;
            let place = Isometry3::translation(-ring[0], 0.0, 0.0);
            parts.push(Part::new(hydro.clone()).at(place).with_law(law));
        }
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(shuttlecock, ImmersedBody::new(hydro).with_parts(parts));
        Ok(Self {
            world,
            immersion,
            shuttlecock,
        })
    }

    pub fn step(&mut self) {
        self.immersion.step(&mut self.world);
    }

    pub fn velocity(&self) -> Vector {
        self.world.bodies[self.shuttlecock].linvel()
    }

    /// Angle between its path and its cork, rad.
    pub fn angle(&self) -> f32 {
        let cork = self.world.bodies[self.shuttlecock].rotation() * Vector::X;
        cork.angle_between(self.velocity())
    }

    /// Time and what is asked for in each step of so many seconds.
    fn curve(&mut self, seconds: f32, of: fn(&Self) -> f32) -> Vec<(f64, f64)> {
        let dt = self.world.integration_parameters.dt;
        let each = |i| {
            self.step();
            (f64::from(dt) * f64::from(i), of(self).into())
        };
        (1..(seconds / dt) as u32).map(each).collect()
    }
}

pub fn show() -> Result<Shown, Failure> {
    const HZ: f32 = 480.0;
    let thrown = || Shuttlecock::new(25.0, 170f32.to_radians(), HZ);
    let mut side = Panel::new("every 0.025 s, enlarged 3 times", "x, m", "y, m").equal();
    let mut shuttlecock = thrown()?;
    for i in 0..8 {
        let color = if i == 0 { RED } else { BLUE };
        let (world, body) = (&shuttlecock.world, shuttlecock.shuttlecock);
        let outlines = enlarged(world, body, View::SIDE, color, (3.0, None));
        side.items.extend(outlines);
        (0..12).for_each(|_| shuttlecock.step());
    }
    let mut angle = Panel::new("cork off the path", "time, s", "degrees");
    let curve = thrown()?.curve(0.4, |now| now.angle().to_degrees());
    angle.items.push(Item::Line(curve, BLUE, 2));
    let mut speeds = Panel::new("let fall (grey: measured)", "time, s", "m/s");
    let mut falling = Shuttlecock::new(0.0, -TAU / 4.0, HZ)?;
    let curve = falling.curve(4.0, |now| now.velocity().length());
    let measured = Item::Line(vec![(0.0, 6.7), (4.0, 6.7)], GREY, 1);
    speeds.items.extend([measured, Item::Line(curve, BLUE, 2)]);
    let terminal = falling.velocity().length();
    let title = "A shuttlecock thrown tail first at 25 m/s, and let fall";
    let lines = vec![format!("falls at {terminal:.2} m/s (measured: 6.7)")];
    Ok(Shown::new(title, vec![side, angle, speeds], lines))
}
