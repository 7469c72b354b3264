//! A windmill: three blades on a hub that turns about the wind's axis.
//!
//! The rotor is one body on a revolute joint, which keeps its spin. Rapier by itself takes it away otherwise: blades of their own on
//! fixed joints lose half of it in 10 s, and a multibody's joint brakes by 0.1 N·m·s unless `Multibody::damping_mut` is set to
//! zero (`tests/machines/windmill.rs` measures it).

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, GREY, RED, Shown, View, drawn};
use crate::stage::{around, single};
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::rapier3d::na::{UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, Part};
use std::f64::consts::FRAC_PI_2;

/// Half length and half chord of a blade, where its middle is, m; the wind along x, m/s.
pub const HALF_LENGTH: f64 = 0.2;
pub const HALF_CHORD: f64 = 0.03;
pub const MIDDLE: f64 = 0.25;
pub const WIND: f32 = 6.0;

pub struct Windmill {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub rotor: RigidBodyHandle,
}

impl Windmill {
    /// Blades pitched by so much (rad) out of the plane in which they turn, each of so many strips.
    ///
    /// # Errors
    /// Those of the description, which these sizes do not give.
    pub fn new(pitch: f64, strips: usize, hz: f32) -> Result<Self, Failure> {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / hz;
        let tower = world.insert_body(RigidBodyBuilder::fixed());
        let hub = ColliderBuilder::ball(0.04).density(1000.0);
        let (rotor, _) = world.insert(RigidBodyBuilder::dynamic(), hub);
        // A blade along y that turns about x: its normal is x, turned by the pitch about its length.
        let blade = SharedShape::cuboid(0.0008, HALF_LENGTH as f32, HALF_CHORD as f32);
        let mut parts = Vec::new();
        for turn in 0..3 {
            let pitched = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), pitch);
            let middle = Vector3::y() * MIDDLE;
            let place = around(&Vector3::x_axis(), f64::from(turn) / 3.0, middle) * pitched;
            let strips = HydroProperties::strips_of_shape(blade.as_ref(), strips)?;
            parts.extend(strips.into_iter().map(|strip| Part::new(strip).at(place)));
            let collider = ColliderBuilder::new(blade.clone())
                .density(300.0)
                .position(single(&place));
            world.insert_collider(collider, Some(rotor));
        }
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, rotor)?;
        let axle = RevoluteJointBuilder::new(Vector::X);
        world.insert_impulse_joint(tower, rotor, axle);
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.set_flow(Uniform::new(WIND, 0.0, 0.0));
        immersion.insert(rotor, ImmersedBody::new(hydro).with_parts(parts));
        Ok(Self {
            world,
            immersion,
            rotor,
        })
    }

    /// Angular velocity about the wind, rad/s, after so many seconds.
    pub fn run(&mut self, seconds: f32) -> f64 {
        let steps = (seconds / self.world.integration_parameters.dt) as usize;
        (0..steps).for_each(|_| self.immersion.step(&mut self.world));
        self.world.bodies[self.rotor].angvel().x.into()
    }
}

pub fn show() -> Result<Shown, Failure> {
    let mut lines = Vec::new();
    let mut curves = Panel::new("angular velocity", "time, s", "rad/s");
    for (degrees, color) in [(20.0_f64, BLUE), (-20.0, RED), (0.0, GREY)] {
        let mut mill = Windmill::new(degrees.to_radians(), 6, 240.0)?;
        let curve: Vec<_> = (0..100)
            .map(|i| (0.1 * f64::from(i), mill.run(0.1)))
            .collect();
        lines.push(format!("pitch {degrees:3}°: {:6.2} rad/s", mill.run(5.0)));
        curves.items.push(Item::Line(curve, color, 2));
    }
    let mill = Windmill::new(FRAC_PI_2 * 0.22, 6, 240.0)?;
    let mut front = Panel::new("against the wind", "−z, m", "y, m").equal();
    front.items = drawn(&mill.world, &[mill.rotor], View::FRONT, BLUE);
    let title = "A windmill of flat blades in a wind of 6 m/s: pitched by 20°, −20° and not at all";
    Ok(Shown::new(title, vec![front, curves], lines))
}
