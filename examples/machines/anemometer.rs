//! A cup anemometer: four hemispherical cups on arms about a vertical axle.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, GREEN, GREY, RED, Shown, View, drawn};
use crate::stage::{around, single};
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{DragBox, Fluid, HydroProperties, ImmersedBody, Immersion, Part};
use std::f64::consts::{PI, TAU};

/// Radius of a cup, and of the circle on which its middle goes, m.
pub const CUP: f64 = 0.03;
pub const ARM: f64 = 0.12;
/// Drag coefficients of a hemispherical cup on its opening's area, round side first and open side first (*Aeronautical
/// Engineer's Data Book*, fig. 5.13, after Hoerner).
pub const ROUND_FIRST: f64 = 0.38;
pub const OPEN_FIRST: f64 = 1.42;
/// Of a cup and of an arm, kg.
const MASSES: [f32; 2] = [0.008, 0.004];

pub struct Anemometer {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub rotor: RigidBodyHandle,
}

/// A hemisphere whose round side faces −z, as a convex solid.
fn hemisphere() -> Option<SharedShape> {
    let rings = (0..=6).flat_map(|ring| {
        let (out, along) = (f64::from(ring) * PI / 12.0).sin_cos();
        (0..24).map(move |i| {
            let (sine, cosine) = (f64::from(i) * TAU / 24.0).sin_cos();
            let point = Vector3::new(out * cosine, out * sine, -along) * CUP;
            Vector::new(point.x as f32, point.y as f32, point.z as f32)
        })
    });
    SharedShape::convex_hull(&rings.collect::<Vec<_>>())
}

impl Anemometer {
    /// At rest in a wind along x, m/s.
    ///
    /// # Errors
    /// Those of the description, which these sizes do not give.
    pub fn new(wind: f32, hz: f32) -> Result<Self, Failure> {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / hz;
        let mast = world.insert_body(RigidBodyBuilder::fixed());
        let rotor = world.insert_body(RigidBodyBuilder::dynamic());
        for half in [[ARM as f32, 0.003, 0.003], [0.003, 0.003, ARM as f32]] {
            let arm = ColliderBuilder::cuboid(half[0], half[1], half[2]).mass(2.0 * MASSES[1]);
            world.insert_collider(arm, Some(rotor));
        }
        let cup = hemisphere().ok_or("no hull")?;
        let hydro = HydroProperties::from_shape(cup.as_ref())?;
        let area = PI * CUP * CUP;
        // The round side leads along −z. What pushes along the arm or the axle turns nothing and is left out.
        let law = DragBox::new(
            Vector3::z() * (OPEN_FIRST * area),
            Vector3::z() * (ROUND_FIRST * area),
        )?;
        let mut parts = Vec::new();
        for turn in 0..4 {
            let middle = Vector3::x() * ARM;
            let place = around(&Vector3::y_axis(), f64::from(turn) / 4.0, middle);
            parts.push(Part::new(hydro.clone()).at(place).with_law(law));
            let collider = ColliderBuilder::new(cup.clone())
                .mass(MASSES[0])
                .position(single(&place));
            world.insert_collider(collider, Some(rotor));
        }
        world.insert_impulse_joint(mast, rotor, RevoluteJointBuilder::new(Vector::Y));
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, rotor)?;
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.set_flow(Uniform::new(wind, 0.0, 0.0));
        immersion.insert(rotor, ImmersedBody::new(hydro).with_parts(parts));
        Ok(Self {
            world,
            immersion,
            rotor,
        })
    }

    /// Mean angular velocity over so many seconds, rad/s.
    pub fn run(&mut self, seconds: f32) -> f64 {
        let steps = (seconds / self.world.integration_parameters.dt) as usize;
        let each = |_| {
            self.immersion.step(&mut self.world);
            f64::from(self.world.bodies[self.rotor].angvel().y)
        };
        (0..steps).map(each).sum::<f64>() / steps as f64
    }
}

pub fn show() -> Result<Shown, Failure> {
    let mut lines = Vec::new();
    let mut curves = Panel::new("tip speed over wind", "time, s", "λ");
    for (wind, color) in [(3.0, GREEN), (6.0, BLUE), (12.0, RED)] {
        let mut rotor = Anemometer::new(wind, 240.0)?;
        let curve: Vec<_> = (0..60)
            .map(|i| (0.2 * f64::from(i), rotor.run(0.2) * ARM / f64::from(wind)))
            .collect();
        lines.push(format!("{wind:2} m/s: λ = {:.3}", curve[59].1));
        let at = (9.0, 0.04 + 0.01 * f64::from(wind));
        let label = Item::Label(at, format!("{wind} m/s"), color);
        curves.items.extend([label, Item::Line(curve, color, 2)]);
    }
    let mut above = Panel::new(
        "from above, from rest, after 0.3 s and 0.5 s",
        "x, m",
        "−z, m",
    )
    .equal();
    let mut rotor = Anemometer::new(6.0, 240.0)?;
    for (i, seconds) in [0.3, 0.2, 0.0].into_iter().enumerate() {
        let color = if i == 2 { BLUE } else { GREY };
        above
            .items
            .extend(drawn(&rotor.world, &[rotor.rotor], View::ABOVE, color));
        rotor.run(seconds);
    }
    for y in [-0.1, 0.1] {
        let arrow = vec![
            (-0.3, y),
            (-0.2, y),
            (-0.215, y + 0.01),
            (-0.2, y),
            (-0.215, y - 0.01),
        ];
        above.items.push(Item::Line(arrow, RED, 2));
    }
    above
        .items
        .push(Item::Label((-0.25, 0.14), "wind".into(), RED));
    let title = "A cup anemometer in winds of 3, 6 and 12 m/s";
    Ok(Shown::new(title, vec![above, curves], lines))
}
