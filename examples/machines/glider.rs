//! A glider of eight plates, put together in four ways: its glide is the same.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, GREY, RED, Shown, View, advance, drawn, drawn_larger, untouched, world};
use crate::fold::{isometry, strips};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, Part};

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
    /// One body of eight colliders, and a part for each.
    Parts,
    /// One body whose collider is the compound of all.
    Compound,
    /// Eight bodies on fixed joints.
    Jointed,
    /// One body of eight colliders, divided into parts by itself: each half of the wing is a wing of its own.
    Automatic,
}

pub struct Glider {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    /// The fuselage first.
    pub bodies: Vec<RigidBodyHandle>,
}

/// A plate: its shape and what the fluid feels of it, in a frame of its own whose place in the glider is `frame`.
struct Plate {
    shape: SharedShape,
    middle: Pose,
    hydro: HydroProperties,
    frame: Pose,
}

fn plates() -> Result<Vec<Plate>, Failure> {
    let single = |shape: SharedShape, x: f32, y: f32| -> Result<Plate, Failure> {
        let hydro = HydroProperties::from_shape(shape.as_ref())?;
        let (middle, frame) = (Pose::IDENTITY, Pose::translation(x, y, 0.0));
        Ok(Plate {
            shape,
            middle,
            hydro,
            frame,
        })
    };
    let mut plates = vec![
        single(SharedShape::cuboid(0.265, 0.004, 0.004), -0.065, -0.005)?,
        single(SharedShape::cuboid(0.03, 0.04, 0.000_75), TAIL_AT, 0.04)?,
    ];
    let tail = Pose::new(Vector::X * TAIL_AT, Vector::Z * -TAIL_DOWN);
    for (span, chord, count, dihedral, place) in [
        (SPAN, CHORD, 4, DIHEDRAL, Pose::IDENTITY),
        (TAIL_SPAN, TAIL_CHORD, 2, 0.0, tail),
    ] {
        let flat = SharedShape::cuboid(0.5 * chord, 0.5 * THICKNESS, 0.5 * span);
        for (hydro, fold) in strips(&flat, count, dihedral)? {
            let half = 0.5 * span / count as f32;
            plates.push(Plate {
                shape: SharedShape::cuboid(0.5 * chord, 0.5 * THICKNESS, half),
                middle: Pose::translation(0.0, 0.0, hydro.planform.center.z as f32),
                hydro,
                frame: place * fold,
            });
        }
    }
    Ok(plates)
}

impl Glider {
    /// # Errors
    /// Those of the description, which these sizes do not give.
    pub fn new(build: Build, hz: f32) -> Result<Self, Failure> {
        let (mut world, mut immersion) = world(Fluid::AIR, hz);
        let plates = plates()?;
        let start = RigidBodyBuilder::dynamic().linvel(Vector::X * LAUNCH);
        let lead = MassProperties::new(Vector::X * NOSE, NOSE_WEIGHT, Vector::splat(1e-7));
        let fuselage = start.clone().additional_mass_properties(lead);
        let collider = |shape: SharedShape, pose: Pose| untouched(shape, pose).density(BALSA);
        let first = world.insert_body(fuselage);
        let mut bodies = vec![first];
        if build == Build::Jointed {
            // The fuselage's own frame is the glider's; every other plate has its own.
            let rod = collider(plates[0].shape.clone(), plates[0].frame);
            world.insert_collider(rod, Some(first));
            let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, first)?;
            immersion.insert(first, hydro);
            for plate in &plates[1..] {
                let body = start.clone().pose(plate.frame);
                let (body, _) = world.insert(body, collider(plate.shape.clone(), plate.middle));
                let joint = FixedJointBuilder::new().local_frame1(plate.frame * plate.middle);
                world.insert_impulse_joint(first, body, joint.local_frame2(plate.middle));
                immersion.insert(body, plate.hydro.clone());
                bodies.push(body);
            }
            return Ok(Self {
                world,
                immersion,
                bodies,
            });
        }
        let shapes = plates.iter().map(|p| (p.frame * p.middle, p.shape.clone()));
        if build == Build::Compound {
            let whole = SharedShape::compound(shapes.collect());
            world.insert_collider(collider(whole, Pose::IDENTITY), Some(first));
        } else {
            for (at, shape) in shapes {
                world.insert_collider(collider(shape, at), Some(first));
            }
        }
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, first)?;
        let mut body = ImmersedBody::new(hydro);
        if build != Build::Automatic {
            let part = |p: &Plate| Part::new(p.hydro.clone()).at(isometry(&p.frame));
            body = body.with_parts(plates.iter().map(part));
        }
        immersion.insert(first, body);
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
    for (build, color) in [
        (Build::Automatic, GREY),
        (Build::Compound, BLUE),
        (Build::Jointed, RED),
        (Build::Parts, BLUE),
    ] {
        let mut glider = Glider::new(build, 240.0)?;
        let mut points = Vec::new();
        for i in 0..60 {
            let at = View::SIDE.of(glider.run(0.1));
            points.push(at);
            if build == Build::Parts && i % 12 == 6 {
                let (world, bodies) = (&glider.world, &glider.bodies);
                path.items
                    .extend(drawn_larger(world, bodies, View::SIDE, BLUE, (at, 5.0)));
            }
        }
        if build != Build::Automatic {
            path.items.push(Item::Line(points, color, 1));
        }
        glider.run(20.0);
        lines.push(format!("{build:?}: glide ratio {:.3}", glider.glide(20.0)));
    }
    let glider = Glider::new(Build::Parts, 240.0)?;
    let mut above = Panel::new("from above", "x, m", "−z, m").equal();
    above.items = drawn(&glider.world, &glider.bodies, View::ABOVE, BLUE);
    let mut front = Panel::new("from the front", "−z, m", "y, m").equal();
    front.items = drawn(&glider.world, &glider.bodies, View::FRONT, BLUE);
    Ok(Shown {
        title: "A glider of eight plates: one body of parts, one compound collider, eight bodies on joints".into(),
        panels: vec![above, front, path],
        lines,
    })
}
