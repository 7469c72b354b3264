//! A frisbee: a disc with a rim, under its published coefficients, kept level by its spin.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, RED, Shown, View, enlarged};
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    Fluid, HydroProperties, ImmersedBody, Immersion, Part, PolarRow, PolarTable,
};

/// Radius and height, m; mass, kg; inertia about the axle and across it, kg·m²: S. A. Hummel, *Frisbee Flight
/// Simulation and Throw Biomechanics* (M.Sc. thesis, UC Davis, 2003).
pub const RADIUS: f32 = 0.1345;
const HEIGHT: f32 = 0.02;
const MASS: f32 = 0.175;
pub const AXIAL: f32 = 0.002_35;
const ACROSS: f32 = 0.001_22;
/// Of the throw: speed, m/s, and the nose's angle above the path, rad.
const SPEED: f32 = 12.0;
const ANGLE: f32 = 0.15;

pub struct Frisbee {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub frisbee: RigidBodyHandle,
}

/// Hummel's coefficients `C_L = .33 + 1.9α`, `C_D = .18 + .69(α + 4°)²`, `C_M = −.08 + .43α` up to 30°, and
/// linearly on to a disc broadside, of which drag alone is left.
///
/// # Errors
/// None with these numbers.
pub fn coefficients() -> Result<PolarTable, Failure> {
    let broadside = |angle| PolarRow {
        angle,
        lift: 0.0,
        drag: 1.17,
        moment: 0.0,
    };
    let mut rows = vec![broadside(-90.0), broadside(90.0)];
    rows.extend((-30..=30).map(|degree| {
        let angle = f64::from(degree).to_radians();
        PolarRow {
            angle: degree.into(),
            lift: 0.33 + 1.9 * angle,
            drag: 0.18 + 0.69 * (angle + 4f64.to_radians()).powi(2),
            moment: -0.08 + 0.43 * angle,
        }
    }));
    Ok(PolarTable::new(&rows)?.with_revolution(Vector3::y())?)
}

impl Frisbee {
    /// Thrown along x, spinning about its upper side's direction, rad/s.
    ///
    /// # Errors
    /// Those of the description, which these sizes do not give.
    pub fn new(spin: f32, hz: f32) -> Result<Self, Failure> {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / hz;
        let attitude = Rotation::from_axis_angle(Vector::Z, ANGLE);
        let thrown = RigidBodyBuilder::dynamic()
            .rotation(Vector::Z * ANGLE)
            .translation(Vector::Y * 1.5)
            .linvel(Vector::X * SPEED)
            .angvel(attitude * Vector::Y * spin);
        // The rim makes it heavier about its axle than a plain disc.
        let inertia = Vector::new(ACROSS, AXIAL, ACROSS);
        let disc = ColliderBuilder::cylinder(0.5 * HEIGHT, RADIUS)
            .mass_properties(MassProperties::new(Vector::ZERO, MASS, inertia));
        let (frisbee, _) = world.insert(thrown, disc);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, frisbee)?;
        let part = Part::new(hydro.clone()).with_law(coefficients()?);
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(frisbee, ImmersedBody::new(hydro).with_parts([part]));
        Ok(Self {
            world,
            immersion,
            frisbee,
        })
    }

    pub fn step(&mut self) {
        self.immersion.step(&mut self.world);
    }

    /// The direction of its upper side.
    pub fn up(&self) -> Vector {
        self.world.bodies[self.frisbee].rotation() * Vector::Y
    }

    pub fn position(&self) -> Vector {
        self.world.bodies[self.frisbee].translation()
    }
}

pub fn show() -> Result<Shown, Failure> {
    const HZ: f32 = 240.0;
    let mut lines = Vec::new();
    let mut side = Panel::new("every 0.15 s, enlarged 2.5 times", "x, m", "y, m").equal();
    let mut above = Panel::new("from above", "x, m", "−z, m").equal();
    let mut tilt = Panel::new("upper side off the vertical", "time, s", "degrees");
    for (spin, color) in [(60.0, BLUE), (0.0, RED)] {
        let mut frisbee = Frisbee::new(spin, HZ)?;
        let (mut path, mut angles, mut i) = (Vec::new(), Vec::new(), 0u16);
        while frisbee.position().y > 0.0 && i < 2000 {
            if i % 36 == 0 {
                for (panel, view) in [(&mut side, View::SIDE), (&mut above, View::ABOVE)] {
                    let large = (2.5, None);
                    let items = enlarged(&frisbee.world, frisbee.frisbee, view, color, large);
                    panel.items.extend(items);
                }
            }
            path.push(View::SIDE.of(frisbee.position()));
            angles.push((
                f64::from(i) / f64::from(HZ),
                frisbee.up().y.acos().to_degrees().into(),
            ));
            frisbee.step();
            i += 1;
        }
        lines.push(format!(
            "spinning at {spin:2} rad/s: {:.1} m in {:.2} s",
            frisbee.position().x,
            f32::from(i) / HZ
        ));
        side.items.push(Item::Line(path, color, 1));
        tilt.items.push(Item::Line(angles, color, 2));
    }
    let title = "A frisbee thrown at 12 m/s from 1.5 m: spinning (blue) and not (red)";
    Ok(Shown::new(title, vec![side, above, tilt], lines))
}
