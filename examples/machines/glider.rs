//! A glider of eight plates, put together in three ways: its glide is the same.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, RED, Shown, View, enlarged, seen};
use crate::fold::strips;
use crate::stage::{advance, double, immerse, single, untouched, world};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, Part};

/// Of the wing, m; rad.
const SPAN: f32 = 0.6;
const CHORD: f32 = 0.1;
const THICKNESS: f32 = 0.002;
const DIHEDRAL: f32 = 0.1;
/// Of the tailplane, m; its leading edge is down by so much, rad.
const TAIL_SPAN: f32 = 0.2;
const TAIL_CHORD: f32 = 0.05;
const TAIL_AT: f32 = -0.3;
const TAIL_DOWN: f32 = 0.045;
/// Balsa, kg/m³; lead in the nose, kg, and where, m.
const BALSA: f32 = 150.0;
const NOSE_WEIGHT: f32 = 0.010;
const NOSE: f32 = 0.2;
/// Speed of the launch, m/s: about that of the glide.
const LAUNCH: f32 = 5.0;

/// How the plates are put together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Build {
    /// One body of eight colliders, which is divided into parts by itself.
    Colliders,
    /// One body whose collider is the compound of all, divided likewise.
    Compound,
    /// Eight bodies on fixed joints, those of a wing each with the aspect ratio of the whole wing.
    Jointed,
}

pub struct Glider {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    /// The fuselage first.
    pub bodies: Vec<RigidBodyHandle>,
}

/// The plates, the fuselage first: the shape of each, its middle in the frame of its part, and the part.
fn plates() -> Result<Vec<(SharedShape, Pose, Part)>, Failure> {
    let mut plates = Vec::new();
    let rod = (SharedShape::cuboid(0.265, 0.004, 0.004), -0.065, -0.005);
    let fin = (SharedShape::cuboid(0.03, 0.04, 7.5e-4), TAIL_AT, 0.04);
    for (shape, x, y) in [rod, fin] {
        let part = Part::new(HydroProperties::from_shape(shape.as_ref())?);
        let part = part.at(double(&Pose::translation(x, y, 0.0)));
        plates.push((shape, Pose::IDENTITY, part));
    }
    let tail = Pose::new(Vector::X * TAIL_AT, Vector::Z * -TAIL_DOWN);
    for (span, chord, count, dihedral, place) in [
        (SPAN, CHORD, 4, DIHEDRAL, Pose::IDENTITY),
        (TAIL_SPAN, TAIL_CHORD, 2, 0.0, tail),
    ] {
        let strip = |span| SharedShape::cuboid(0.5 * chord, 0.5 * THICKNESS, 0.5 * span);
        for part in strips(&strip(span), count, dihedral)? {
            let middle = Pose::translation(0.0, 0.0, part.hydro.planform.center.z as f32);
            let at = double(&place) * part.pose;
            plates.push((strip(span / count as f32), middle, part.at(at)));
        }
    }
    Ok(plates)
}

impl Glider {
    /// # Errors
    /// Those of the description, which these sizes do not give.
    pub fn new(build: Build, hz: f32) -> Result<Self, Failure> {
        let (mut world, mut immersion) = world(Fluid::AIR, hz);
        let start = RigidBodyBuilder::dynamic().linvel(Vector::X * LAUNCH);
        let lead = MassProperties::new(Vector::X * NOSE, NOSE_WEIGHT, Vector::splat(1e-7));
        let first = world.insert_body(start.clone().additional_mass_properties(lead));
        let mut bodies = vec![first];
        let mut shapes = Vec::new();
        for (i, (shape, middle, part)) in plates()?.into_iter().enumerate() {
            let frame = single(&part.pose);
            if build != Build::Jointed || i == 0 {
                shapes.push((frame * middle, shape));
                continue;
            }
            let collider = untouched(shape, middle).density(BALSA);
            let (body, _) = world.insert(start.clone().pose(frame), collider);
            let joint = FixedJointBuilder::new().local_frame1(frame * middle);
            world.insert_impulse_joint(first, body, joint.local_frame2(middle));
            immersion.insert(body, part.hydro);
            bodies.push(body);
        }
        if build == Build::Compound {
            shapes = vec![(Pose::IDENTITY, SharedShape::compound(shapes))];
        }
        for (at, shape) in shapes {
            world.insert_collider(untouched(shape, at).density(BALSA), Some(first));
        }
        immerse(&world, &mut immersion, first, None)?;
        Ok(Self {
            world,
            immersion,
            bodies,
        })
    }

    /// Where the fuselage is, after so many seconds.
    pub fn run(&mut self, seconds: f32) -> Vector {
        advance(&mut self.world, &mut self.immersion, seconds);
        self.world.bodies[self.bodies[0]].translation()
    }

    /// Glide ratio over `seconds` from now on: how far it comes per height.
    pub fn glide(&mut self, seconds: f32) -> f64 {
        let from = self.run(0.0);
        let way = self.run(seconds) - from;
        f64::from(-way.with_y(0.0).length() / way.y)
    }
}

pub fn show() -> Result<Shown, Failure> {
    let mut lines = Vec::new();
    let mut path = Panel::new("path (jointed: red), drawn larger", "x, m", "y, m").equal();
    for build in [Build::Compound, Build::Jointed, Build::Colliders] {
        let color = if build == Build::Jointed { RED } else { BLUE };
        let mut glider = Glider::new(build, 240.0)?;
        let mut points = Vec::new();
        for i in 0..60 {
            points.push(View::SIDE.of(glider.run(0.1)));
            if build == Build::Colliders && i % 12 == 6 {
                let (world, body) = (&glider.world, glider.bodies[0]);
                path.items
                    .extend(enlarged(world, body, View::SIDE, BLUE, (5.0, None)));
            }
        }
        path.items.push(Item::Line(points, color, 1));
        glider.run(20.0);
        lines.push(format!("{build:?}: glide ratio {:.3}", glider.glide(20.0)));
    }
    let glider = Glider::new(Build::Colliders, 240.0)?;
    let seen = |title, labels, view| seen(title, labels, &glider.world, &glider.bodies, view);
    let above = seen("from above", ["x, m", "−z, m"], View::ABOVE);
    let front = seen("from the front", ["−z, m", "y, m"], View::FRONT);
    let title = "A glider of eight plates: one body of colliders, one compound collider, eight bodies on joints";
    Ok(Shown::new(title, vec![above, front, path], lines))
}
