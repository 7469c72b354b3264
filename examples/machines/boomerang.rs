//! A boomerang of four crossed, cambered blades that comes back.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, GREY, RED, Shown, View, drawn};
use crate::stage::{around, single};
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, Part, PolarTable};
use std::f32::consts::FRAC_PI_2;
use std::f64::consts::{PI, TAU};

/// Length, chord and thickness of a blade, m; its wood, kg/m³; its strips.
pub const LENGTH: f64 = 0.2;
pub const CHORD: f64 = 0.04;
const THICKNESS: f64 = 0.002;
const DENSITY: f32 = 500.0;
const STRIPS: usize = 8;
/// How far ahead of the axle a blade's middle line passes, m: lift that is so far ahead lays the plane down, against the
/// damping of its turn, which sets it up.
const AHEAD: f64 = 0.022;
/// Height of the blades' camber over their chord, and their drag without lift.
const CAMBER: f64 = 0.05;
const FRICTION: f64 = 0.02;
/// Where it is thrown from, m.
pub const HAND: Vector = Vector::new(0.0, 1.7, 0.0);

pub struct Boomerang {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub boomerang: RigidBodyHandle,
}

/// How it is thrown: speed, m/s; spin, rad/s; lean of its plane to the side to which it curves, and climb of its path, rad.
pub struct Throw {
    pub speed: f32,
    pub spin: f32,
    pub lean: f32,
    pub climb: f32,
}

/// Coefficients of lift and drag of a blade whose section is an arc of a circle, `2πη(α + 2f/c)` in attached flow (thin-airfoil
/// theory with Helmbold's η), by the angle of attack, rad; the same whichever edge leads. Beyond 12° it stalls,
/// and from 25° on it is a plate (Hoerner).
pub fn section(angle: f64) -> [f64; 2] {
    let aspect = LENGTH / CHORD;
    let slope = TAU * aspect / (2.0 + (aspect * aspect + 4.0).sqrt());
    let (sine, cosine) = angle.sin_cos();
    let lift = slope * (sine + 2.0 * CAMBER);
    let drag = FRICTION + lift * lift / (PI * aspect);
    let attached = [lift * cosine.signum(), drag];
    let normal = 1.98 * sine / (0.56 + 0.44 * sine.abs());
    let plate = [normal * cosine, normal * sine + FRICTION];
    let stalled = ((sine.abs().asin().to_degrees() - 12.0) / 13.0).clamp(0.0, 1.0);
    [0, 1].map(|i| attached[i] + stalled * (plate[i] - attached[i]))
}

impl Boomerang {
    /// Thrown along x; it curves toward −z.
    ///
    /// # Errors
    /// Those of the description, which these sizes do not give.
    pub fn new(throw: Throw, hz: f32) -> Result<Self, Failure> {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / hz;
        // Its axle, y of the body, points to −z, and up by the lean.
        let climbing = Rotation::from_axis_angle(Vector::Z, throw.climb);
        let attitude = climbing * Rotation::from_axis_angle(Vector::X, throw.lean - FRAC_PI_2);
        let thrown = RigidBodyBuilder::dynamic()
            .pose(Pose::from_parts(HAND, attitude))
            .linvel(climbing * Vector::X * throw.speed)
            .angvel(attitude * Vector::Y * throw.spin);
        let boomerang = world.insert_body(thrown);
        let rows = (-180..=180).map(|degree| {
            let [lift, drag] = section(f64::from(degree).to_radians());
            format!("{degree}, {lift}, {drag}\n")
        });
        let table = PolarTable::from_csv(&rows.collect::<String>())?;
        let table = table.with_axes(-Vector3::z(), Vector3::y(), 0.0)?;
        let half = [LENGTH, THICKNESS, CHORD].map(|x| (0.5 * x) as f32);
        let blade = SharedShape::cuboid(half[0], half[1], half[2]);
        let strips = HydroProperties::strips_of_shape(blade.as_ref(), STRIPS)?;
        let mut parts = Vec::new();
        for turn in 0..4 {
            let middle = Vector3::new(0.5 * LENGTH, 0.0, -AHEAD);
            let place = around(&Vector3::y_axis(), f64::from(turn) / 4.0, middle);
            let strips = strips.iter().cloned().map(Part::new);
            parts.extend(strips.map(|strip| strip.at(place).with_law(table.clone())));
            let collider = ColliderBuilder::new(blade.clone()).density(DENSITY);
            world.insert_collider(collider.position(single(&place)), Some(boomerang));
        }
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, boomerang)?;
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(boomerang, ImmersedBody::new(hydro).with_parts(parts));
        Ok(Self {
            world,
            immersion,
            boomerang,
        })
    }

    /// Where it is after each step of so many seconds.
    pub fn path(&mut self, seconds: f32) -> Vec<Vector> {
        let steps = (seconds / self.world.integration_parameters.dt) as usize;
        let each = |_| {
            self.immersion.step(&mut self.world);
            self.world.bodies[self.boomerang].translation()
        };
        (0..steps).map(each).collect()
    }
}

/// A throw that comes back to the hand.
pub const RETURNING: Throw = Throw {
    speed: 18.0,
    spin: 90.0,
    lean: 0.3,
    climb: 0.1,
};

pub fn show() -> Result<Shown, Failure> {
    let mut panels = vec![
        Panel::new("from above, every 0.1 s", "x, m", "−z, m").equal(),
        Panel::new("from the side", "x, m", "y, m").equal(),
    ];
    let mut boomerang = Boomerang::new(RETURNING, 480.0)?;
    let mut path = vec![HAND];
    for _ in 0..15 {
        for (panel, view) in panels.iter_mut().zip([View::ABOVE, View::SIDE]) {
            let outlines = drawn(&boomerang.world, &[boomerang.boomerang], view, BLUE);
            panel.items.extend(outlines);
        }
        path.extend(boomerang.path(0.1));
    }
    for (panel, view) in panels.iter_mut().zip([View::ABOVE, View::SIDE]) {
        let line = path.iter().map(|p| view.of(*p)).collect();
        panel.items.push(Item::Line(line, GREY, 1));
        panel.items.push(Item::Dots(vec![view.of(HAND)], RED, 4));
    }
    let away: Vec<f32> = path.iter().map(|p| (*p - HAND).length()).collect();
    let far = away.iter().fold(0f32, |a, b| a.max(*b));
    let near = away[path.len() / 2..].iter().fold(far, |a, b| a.min(*b));
    let title = "A boomerang of four blades, thrown at 18 m/s from the red dot";
    let lines = vec![format!(
        "{far:.1} m away, and back to {near:.2} m of the hand"
    )];
    Ok(Shown::new(title, panels, lines))
}
