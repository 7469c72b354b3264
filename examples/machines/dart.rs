//! A paper dart: folded wings with a keel, thrown across a room.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, RED, Shown, View, drawn};
use crate::fold::{raised, sheet, strips};
use crate::stage::{advance, double, immerse, world};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, Part};

/// Length and span of the wings, depth of the keel, m.
const LENGTH: f32 = 0.2;
const SPAN: f32 = 0.26;
const KEEL: f32 = 0.035;
/// How far the wings are up, and their rear edges bent up, rad.
const DIHEDRAL: f32 = 0.2;
const BENT: f32 = 0.17;
/// Half extents of a bent edge and where its middle is along the span, m.
const EDGE: [f32; 2] = [0.006, 0.04];
const EDGE_AT: f32 = 0.06;
/// Wings of one layer and a keel of two of paper of 80 g/m², which is not flat: with its folds, one layer takes up so
/// much, m. What is left of a sheet of A4 (5 g) is folded into the nose, kg, m.
const LAYER: f32 = 4e-4;
const PAPER: f32 = 0.08 / LAYER;
const FOLDED: f32 = 0.0021;
const FOLDED_AT: f32 = 0.07;
/// How it is thrown: level, at about the speed of its glide, m/s, from this height, m.
pub const SPEED: f32 = 3.0;
pub const HEIGHT: f32 = 1.8;

pub struct Dart {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub body: RigidBodyHandle,
}

impl Dart {
    /// Thrown with the right wing down by so much, rad.
    ///
    /// # Errors
    /// Those of the description, which these sizes do not give.
    pub fn new(roll: f32, hz: f32) -> Result<Self, Failure> {
        let (mut world, mut immersion) = world(Fluid::AIR, hz);
        let (nose, tip) = (0.5 * LENGTH, 0.5 * SPAN);
        let folds = MassProperties::new(Vector::X * FOLDED_AT, FOLDED, Vector::splat(1e-6));
        let body = RigidBodyBuilder::dynamic()
            .pose(Pose::new(Vector::Y * HEIGHT, Vector::X * roll))
            .linvel(Vector::X * SPEED)
            .additional_mass_properties(folds);
        let body = world.insert_body(body);
        let flat = sheet(&[[nose, 0.0], [-nose, tip], [-nose, -tip]], LAYER)?;
        let mut parts = strips(&flat, 8, DIHEDRAL)?;
        let edge = SharedShape::cuboid(EDGE[0], 0.5 * LAYER, EDGE[1]);
        for right in [true, false] {
            let side = if right { 1.0 } else { -1.0 };
            let half = sheet(&[[nose, 0.0], [-nose, side * tip], [-nose, 0.0]], LAYER)?;
            let fold = raised(right, DIHEDRAL);
            let bent = Pose::new(Vector::new(-nose, 0.0, EDGE_AT * side), Vector::Z * -BENT);
            let bent = fold * bent * Pose::translation(-EDGE[0], 0.0, 0.0);
            for (shape, at) in [(half, fold), (edge.clone(), bent)] {
                let part = HydroProperties::from_shape(shape.as_ref())?;
                if at == bent {
                    parts.push(Part::new(part).at(double(&at)));
                }
                let collider = ColliderBuilder::new(shape).density(PAPER).position(at);
                world.insert_collider(collider, Some(body));
            }
        }
        let keel = sheet(
            &[[nose, 0.0], [-nose, 0.0], [-nose, KEEL], [0.0, KEEL]],
            2.0 * LAYER,
        )?;
        let down = Pose::rotation(Vector::X * std::f32::consts::FRAC_PI_2);
        let part = HydroProperties::from_shape(keel.as_ref())?;
        parts.push(Part::new(part).at(double(&down)));
        let keel = ColliderBuilder::new(keel).density(PAPER).position(down);
        world.insert_collider(keel, Some(body));
        immerse(&world, &mut immersion, body, Some(parts))?;
        Ok(Self {
            world,
            immersion,
            body,
        })
    }

    /// Its center of mass after so many seconds.
    pub fn run(&mut self, seconds: f32) -> Vector {
        advance(&mut self.world, &mut self.immersion, seconds);
        self.world.bodies[self.body].center_of_mass()
    }
}

/// Thrown with the right wing down by so much, rad: its center of mass every 1/60 s, m, until it is on the floor.
///
/// # Errors
/// Those of [`Dart::new`].
pub fn flight(roll: f32, mut each: impl FnMut(&Dart)) -> Result<Vec<Vector>, Failure> {
    let mut dart = Dart::new(roll, 240.0)?;
    let mut points = vec![dart.run(0.0)];
    while points[points.len() - 1].y > 0.0 && points.len() < 600 {
        each(&dart);
        points.push(dart.run(1.0 / 60.0));
    }
    Ok(points)
}

pub fn show() -> Result<Shown, Failure> {
    let mut lines = Vec::new();
    let mut side = Panel::new("from the side", "x, m", "y, m").equal();
    let mut above = Panel::new("from above", "x, m", "−z, m").equal();
    for (roll, color) in [(0.0_f32, BLUE), (0.035, RED)] {
        let mut panels = [(&mut side, View::SIDE), (&mut above, View::ABOVE)];
        let mut count = 0;
        let points = flight(roll, |dart| {
            for (panel, view) in panels.iter_mut().filter(|_| count % 20 == 0) {
                panel
                    .items
                    .extend(drawn(&dart.world, &[dart.body], *view, color));
            }
            count += 1;
        })?;
        for (panel, view) in panels {
            let line = points.iter().map(|p| view.of(*p)).collect();
            panel.items.push(Item::Line(line, color, 1));
        }
        let (end, degrees) = (points[points.len() - 1], roll.to_degrees());
        lines.push(format!(
            "rolled by {degrees:.0}°: lands {:.2} m ahead, {:.2} m to the right, after {:.2} s",
            end.x,
            end.z,
            points.len() as f32 / 60.0
        ));
    }
    let title = "A paper dart, thrown level at 3 m/s: wings level (blue), rolled by 2° (red)";
    Ok(Shown::new(title, vec![side, above], lines))
}
