//! A diamond kite on a line, with a bridle and a tail.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, GREY, RED, Shown, View, drawn};
use crate::fold::{raised, sheet, strips};
use crate::stage::{advance, double, immerse, untouched, world};
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, Part};

/// Span and height of the diamond, and where its spars cross below the top, m; its mass, kg.
const SPAN: f32 = 0.9;
const HEIGHT: f32 = 0.8;
const CROSSING: f32 = 0.25;
const MASS: f32 = 0.07;
const DIHEDRAL: f32 = 0.15;
/// The point where the legs of the bridle meet: so far below the top, and in front of the sail, m.
const BRIDLE: [f32; 2] = [0.18, 0.25];
const TOW: Vector = Vector::new(CROSSING - BRIDLE[0], BRIDLE[1], 0.0);
/// A fin at its foot, without which it turns about its line: half extents, how far its middle is behind the sail, m; kg.
const FIN: [f32; 2] = [0.12, 0.15];
const FIN_BEHIND: f32 = 0.05;
const FIN_MASS: f32 = 0.003;
/// The line, m, and the wind along x, m/s.
pub const LINE: f32 = 15.0;
pub const WIND: f32 = 6.0;
/// Bows of the tail: how many, how far apart, m, and the mass of each, kg.
const BOWS: usize = 4;
const APART: f32 = 0.2;
const BOW: f32 = 0.001;

pub struct Kite {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub kite: RigidBodyHandle,
    pub tail: Vec<RigidBodyHandle>,
}

impl Kite {
    /// # Errors
    /// Those of the description, which these sizes do not give.
    pub fn new(hz: f32) -> Result<Self, Failure> {
        let (mut world, mut immersion) = world(Fluid::AIR, hz);
        let ground = world.insert_body(RigidBodyBuilder::fixed());
        // The sail's frame: x toward the top, y its face, toward the line; the origin at the crossing.
        let (top, low, tip) = (CROSSING, CROSSING - HEIGHT, 0.5 * SPAN);
        let flat = sheet(&[[top, 0.0], [0.0, tip], [low, 0.0], [0.0, -tip]], 1e-3)?;
        let mut parts = strips(&flat, 8, -DIHEDRAL)?;
        // Its top leans into the wind, not quite level.
        let turn = Rotation::from_rotation_z(2.95) * Rotation::from_rotation_x(0.02);
        let pose = Pose::from_parts(Vector::new(0.4, 0.92, 0.0) * LINE - turn * TOW, turn);
        let kite = world.insert_body(RigidBodyBuilder::dynamic().pose(pose).can_sleep(false));
        for side in [tip, -tip] {
            let half = sheet(&[[top, 0.0], [0.0, side], [low, 0.0]], 1e-3)?;
            let half = untouched(half, raised(side > 0.0, -DIHEDRAL)).mass(0.5 * MASS);
            world.insert_collider(half, Some(kite));
        }
        let fin = SharedShape::cuboid(FIN[0], FIN[1], 5e-4);
        let at = Pose::translation(low, -FIN_BEHIND, 0.0);
        let hydro = HydroProperties::from_shape(fin.as_ref())?;
        parts.push(Part::new(hydro).at(double(&at)));
        world.insert_collider(untouched(fin, at).mass(FIN_MASS), Some(kite));
        world.insert_impulse_joint(ground, kite, RopeJointBuilder::new(LINE).local_anchor2(TOW));
        immersion.set_flow(Uniform::new(WIND, 0.0, 0.0));
        immerse(&world, &mut immersion, kite, Some(parts))?;
        let mut tail = Vec::new();
        let (mut before, mut anchor) = (kite, Vector::X * low);
        for _ in 0..BOWS {
            let from = *world.bodies[before].position() * anchor;
            let body = RigidBodyBuilder::dynamic().translation(from - Vector::Y * APART);
            let bow = untouched(SharedShape::cuboid(0.02, 0.03, 5e-4), Pose::IDENTITY);
            let (body, _) = world.insert(body.can_sleep(false), bow.mass(BOW));
            let string = SphericalJointBuilder::new().local_anchor1(anchor);
            world.insert_impulse_joint(before, body, string.local_anchor2(Vector::Y * APART));
            immerse(&world, &mut immersion, body, None)?;
            tail.push(body);
            (before, anchor) = (body, Vector::ZERO);
        }
        Ok(Self {
            world,
            immersion,
            kite,
            tail,
        })
    }

    /// Where the legs of the bridle meet.
    pub fn tow_point(&self) -> Vector {
        *self.world.bodies[self.kite].position() * TOW
    }

    /// Angle of the line above the ground, degrees, after so many seconds.
    pub fn run(&mut self, seconds: f32) -> f64 {
        advance(&mut self.world, &mut self.immersion, seconds);
        let at = self.tow_point();
        f64::from(at.y.atan2(at.x.hypot(at.z)).to_degrees())
    }

    /// Lift, drag and weight of the kite and its tail as they are now, N.
    pub fn loads(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for body in self.tail.iter().chain([&self.kite]) {
            if let Some(forces) = self.immersion.forces(&self.world.bodies, *body) {
                let fluid = forces.viscous().force + forces.buoyancy.force;
                let each = [fluid.y, fluid.x, -forces.weight.force.y];
                (0..3).for_each(|i| sum[i] += f64::from(each[i]));
            }
        }
        sum
    }
}

pub fn show() -> Result<Shown, Failure> {
    let mut kite = Kite::new(240.0)?;
    let mut side = Panel::new("the line after 20 s", "x, m", "y, m").equal();
    let mut near = Panel::new("the kite and its tail", "x, m", "y, m").equal();
    let mut curves = Panel::new("line, and its loads (red)", "time, s", "degrees");
    curves.window = Some([(0.0, 20.0), (60.0, 80.0)]);
    let (mut angle, mut statics) = (vec![], vec![]);
    for i in 0..400 {
        let time = 0.05 * f64::from(i + 1);
        angle.push((time, kite.run(0.05)));
        let [lift, drag, weight] = kite.loads();
        statics.push((time, (lift - weight).atan2(drag).to_degrees()));
    }
    let line = [(0.0, 0.0), View::SIDE.of(kite.tow_point())];
    side.items.push(Item::Line(line.to_vec(), GREY, 1));
    // The legs of the bridle, from the top and the foot of the sail, and the string of the tail.
    let pose = kite.world.bodies[kite.kite].position();
    let [top, foot] = [CROSSING, CROSSING - HEIGHT].map(|x| View::SIDE.of(*pose * (Vector::X * x)));
    let place = |bow: &RigidBodyHandle| View::SIDE.of(kite.world.bodies[*bow].translation());
    let bows = [foot].into_iter().chain(kite.tail.iter().map(place));
    let strings = [vec![top, line[1], foot], bows.collect()];
    near.items
        .extend(strings.map(|points| Item::Line(points, GREY, 1)));
    let all = [&[kite.kite], &kite.tail[..]].concat();
    for items in [&mut side.items, &mut near.items] {
        items.extend(drawn(&kite.world, &all, View::SIDE, BLUE));
    }
    let ([lift, drag, weight], stands, loads) = (kite.loads(), angle[399].1, statics[399].1);
    let lines = vec![
        format!("the line stands at {stands:.2}°, its loads at {loads:.2}°"),
        format!("lift {lift:.2} N, drag {drag:.2} N, weight {weight:.2} N"),
    ];
    curves.items = vec![Item::Line(statics, RED, 1), Item::Line(angle, BLUE, 2)];
    let title = "A kite with a bridle and a tail on a line of 15 m in a wind of 6 m/s";
    Ok(Shown::new(title, vec![side, near, curves], lines))
}
