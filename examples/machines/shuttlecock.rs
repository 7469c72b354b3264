//! A shuttlecock: a cork and sixteen feathers.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, GREY, RED, Shown, View, enlarged};
use rapier3d_immersed::rapier3d::na::{Isometry3, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{CustomLaw, Fluid, HydroProperties, ImmersedBody, Immersion, Part};
use std::f32::consts::TAU;

/// Radius of the cork, and how far the skirt's middle is behind its middle, m.
const CORK: f32 = 0.013;
pub const BEHIND: f32 = 0.045;
/// Feathers: how many; length, width and distance of their middle from the axle, m; slope against it, rad.
const FEATHERS: usize = 16;
const FEATHER: [f32; 2] = [0.062, 0.0115];
const MIDDLE: f32 = 0.021;
const SLOPE: f32 = 0.29;
/// Of the cork and of each feather, kg: 5 g together.
const MASSES: [f32; 2] = [0.003, 0.000_125];
/// Drag coefficient, of feathered and plastic ones in a wind tunnel between 30 and 105 km/h, on the area across the skirt's tips, m²,
/// 28 cm² (Cohen, Texier, Quéré & Clanet, *New J. Phys.* 17, 063001 (2015)): cork first, and for want of a measurement across,
/// where a short cylinder has as much and the skirt shows as much.
pub const DRAG: f64 = 0.62;
pub const AREA: f64 = 28e-4;

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
        let cork = ColliderBuilder::ball(CORK).mass(MASSES[0]);
        let (shuttlecock, _) = world.insert(flying, cork);
        // A feather lies along −x, which its slope turns outward, to y.
        let sloped = Rotation::from_axis_angle(Vector::Z, -SLOPE);
        for i in 0..FEATHERS {
            let around = Rotation::from_axis_angle(Vector::X, TAU * i as f32 / FEATHERS as f32);
            let middle = around * Vector::new(-BEHIND, MIDDLE, 0.0);
            let feather = ColliderBuilder::cuboid(0.5 * FEATHER[0], 0.0001, 0.5 * FEATHER[1])
                .position(Pose::from_parts(middle, around * sloped))
                .mass(MASSES[1]);
            world.insert_collider(feather, Some(shuttlecock));
        }
        // A body of revolution at incidence (Allen & Perkins, NACA Rep. 1048, 1951): drag along the axle, the normal force of slender
        // bodies on their base, and drag across. Plates that do not feel each other are no skirt.
        let law = CustomLaw::new(|m| {
            let along = Vector3::new(m.linear.x, 0.0, 0.0);
            let across = m.linear - along;
            let resisted = along * (DRAG * along.norm())
                + across * (2.0 * along.norm() + DRAG * across.norm());
            [resisted * (-0.5 * m.density * AREA), Vector3::zeros()]
        })?;
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, shuttlecock)?;
        let skirt = Part::new(hydro.clone())
            .at(Isometry3::translation(-f64::from(BEHIND), 0.0, 0.0))
            .with_law(law);
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(shuttlecock, ImmersedBody::new(hydro).with_parts([skirt]));
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
        (cork.dot(self.velocity()) / self.velocity().length())
            .clamp(-1.0, 1.0)
            .acos()
    }
}

pub fn show() -> Result<Shown, Failure> {
    const HZ: f32 = 480.0;
    let thrown = 170f32.to_radians();
    let mut side = Panel::new("every 0.025 s, enlarged 3 times", "x, m", "y, m").equal();
    let mut angle = Panel::new("cork off the path", "time, s", "degrees");
    let mut shuttlecock = Shuttlecock::new(25.0, thrown, HZ)?;
    let mut curve = Vec::new();
    for i in 0..(0.3 * HZ) as u16 {
        if i % 12 == 0 && i <= 84 {
            let color = if i == 0 { RED } else { BLUE };
            let (world, body) = (&shuttlecock.world, shuttlecock.shuttlecock);
            let outlines = enlarged(world, body, View::SIDE, color, (3.0, None));
            side.items.extend(outlines);
        }
        curve.push((
            f64::from(i) / f64::from(HZ),
            shuttlecock.angle().to_degrees().into(),
        ));
        shuttlecock.step();
    }
    angle.items.push(Item::Line(curve, BLUE, 2));
    let mut falling = Shuttlecock::new(0.0, -TAU / 4.0, HZ)?;
    let mut speeds = Panel::new("let fall", "time, s", "m/s");
    let mut curve = Vec::new();
    for i in 0..(4.0 * HZ) as u16 {
        curve.push((
            f64::from(i) / f64::from(HZ),
            f64::from(falling.velocity().length()),
        ));
        falling.step();
    }
    let terminal = f64::from(falling.velocity().length());
    speeds
        .items
        .push(Item::Line(vec![(0.0, 6.7), (4.0, 6.7)], GREY, 1));
    speeds.items.push(Item::Line(curve, BLUE, 2));
    Ok(Shown {
        title: "A shuttlecock thrown tail first at 25 m/s; falling".into(),
        panels: vec![side, angle, speeds],
        lines: vec![format!("falls at {terminal:.2} m/s (measured: 6.7)")],
    })
}
